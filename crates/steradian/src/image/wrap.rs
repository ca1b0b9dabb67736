//! What lies beyond the edge of a picture.

/// What a coordinate beyond the edge of one axis refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisWrap {
    /// The picture is tiled.
    Repeat,
    /// Nothing: zero in every channel.
    Black,
    /// The nearest edge texel.
    Clamp,
}

/// What texel coordinates beyond the picture refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Each axis by itself.
    Axes {
        /// Horizontally.
        s: AxisWrap,
        /// Vertically.
        t: AxisWrap,
    },
    /// The square is the equal-area octahedral map of a sphere (Clarberg 2008): beyond an edge the
    /// picture continues through the same edge, mirrored about the edge's middle.
    OctahedralSphere,
}

impl Wrap {
    /// Tiled on both axes.
    pub const REPEAT: Self = Self::Axes { s: AxisWrap::Repeat, t: AxisWrap::Repeat };
    /// Zero beyond all edges.
    pub const BLACK: Self = Self::Axes { s: AxisWrap::Black, t: AxisWrap::Black };
    /// The nearest edge texel on both axes.
    pub const CLAMP: Self = Self::Axes { s: AxisWrap::Clamp, t: AxisWrap::Clamp };

    /// Reads pbrt-v4's names: `repeat`, `black`, `clamp`, `octahedralsphere`; `None` for anything else.
    pub fn parse(name: &str) -> Option<Self> {
        match name {
            "repeat" => Some(Self::REPEAT),
            "black" => Some(Self::BLACK),
            "clamp" => Some(Self::CLAMP),
            "octahedralsphere" => Some(Self::OctahedralSphere),
            _ => None,
        }
    }

    /// The texel that (x, y) of a picture of `width` × `height` refers to; `None` for black.
    pub(crate) fn resolve(self, x: i32, y: i32, width: u32, height: u32) -> Option<[u32; 2]> {
        if x >= 0 && y >= 0 && (x as u32) < width && (y as u32) < height {
            return Some([x as u32, y as u32]);
        }
        match self {
            Self::Axes { s, t } => Some([s.resolve(x, width)?, t.resolve(y, height)?]),
            Self::OctahedralSphere => {
                let (x, y) = cross_edge(i64::from(x), i64::from(y), width, height);
                let (y, x) = cross_edge(y, x, height, width);
                // Further out than one picture only for footprints that see the whole sphere.
                let clamp = |v: i64, n: u32| v.clamp(0, i64::from(n) - 1) as u32;
                Some([clamp(x, width), clamp(y, height)])
            }
        }
    }
}

impl AxisWrap {
    /// Two coordinates, most often both inside.
    #[inline]
    pub(crate) fn resolve_both(self, x: [i32; 2], n: u32) -> [Option<u32>; 2] {
        x.map(|x| if (x as u32) < n { Some(x as u32) } else { self.resolve(x, n) })
    }

    fn resolve(self, x: i32, n: u32) -> Option<u32> {
        if self == Self::Repeat && n.is_power_of_two() {
            // The remainder of two's complement.
            return Some(x as u32 & (n - 1));
        }
        let (x, n) = (i64::from(x), i64::from(n));
        match self {
            Self::Repeat => Some(x.rem_euclid(n) as u32),
            Self::Clamp => Some(x.clamp(0, n - 1) as u32),
            Self::Black => (0..n).contains(&x).then_some(x as u32),
        }
    }
}

/// Reflects `a` at the edges of its axis, which reverses the other axis.
fn cross_edge(a: i64, b: i64, n: u32, m: u32) -> (i64, i64) {
    let (n, m) = (i64::from(n), i64::from(m));
    if a < 0 {
        (-1 - a, m - 1 - b)
    } else if a >= n {
        (2 * n - 1 - a, m - 1 - b)
    } else {
        (a, b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec2;
    use crate::math::warp::equal_area_square_to_sphere;

    #[test]
    fn each_axis_wraps_by_its_own_rule() {
        let wrap = Wrap::Axes { s: AxisWrap::Repeat, t: AxisWrap::Clamp };
        assert_eq!(wrap.resolve(-1, -7, 4, 3), Some([3, 0]));
        assert_eq!(wrap.resolve(9, 5, 4, 3), Some([1, 2]));
        assert_eq!(Wrap::BLACK.resolve(-1, 0, 4, 3), None);
        assert_eq!(Wrap::BLACK.resolve(3, 2, 4, 3), Some([3, 2]));
    }

    #[test]
    fn extreme_coordinates_stay_inside() {
        for wrap in [Wrap::REPEAT, Wrap::CLAMP, Wrap::OctahedralSphere] {
            for x in [i32::MIN, i32::MAX] {
                for y in [i32::MIN, 0, i32::MAX] {
                    let [x, y] = wrap.resolve(x, y, 5, 5).unwrap();
                    assert!(x < 5 && y < 5, "{wrap:?}");
                }
            }
        }
    }

    #[test]
    fn octahedral_neighbours_across_an_edge_are_neighbours_on_the_sphere() {
        let n = 64;
        let direction = |[x, y]: [u32; 2]| {
            equal_area_square_to_sphere(Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / n as f32)
        };
        for i in 0..n as i32 {
            for (inside, outside) in [
                ([0, i], [-1, i]),
                ([n as i32 - 1, i], [n as i32, i]),
                ([i, 0], [i, -1]),
                ([i, n as i32 - 1], [i, n as i32]),
            ] {
                let a = direction(inside.map(|v| v as u32));
                let b = direction(Wrap::OctahedralSphere.resolve(outside[0], outside[1], n, n).unwrap());
                // A texel spans about √(4π/n²) = 0.055 rad; the map stretches it at most twice.
                assert!(a.dot(b) > 0.11_f32.cos(), "{inside:?} -> {outside:?}: {a} {b}");
            }
        }
    }
}
