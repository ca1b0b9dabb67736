//! Patterns that need no input: how much of the second of two textures is seen at a point.

use super::input::TextureContext;
use super::mapping::{Mapping2d, Mapping3d, TexCoord2d};
use super::noise::noise;
use crate::math::{Dir, Vec2, Vec3};

/// A weight in [0, 1] that depends on the surface point alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// 1 − |n·d| for the geometric normal n and this direction d in render space: pbrt-v4's `directionmix`.
    Direction(Dir),
    /// Unit squares of (s, t), 0 where ⌊s⌋ + ⌊t⌋ is even and 1 elsewhere, averaged over the footprint.
    Checkerboard(Mapping2d),
    /// Unit cubes of texture space, averaged over the footprint.
    Checkerboard3d(Mapping3d),
    /// 1 inside random dots, at most one in each unit square of (s, t).
    Dots(Mapping2d),
}

impl Pattern {
    /// The weight at a surface point.
    pub fn weight(&self, at: &TextureContext) -> f32 {
        match self {
            Self::Direction(d) => 1.0 - at.point.ng.cos_to(*d).abs().min(1.0),
            Self::Checkerboard(mapping) => checkerboard(&mapping.map(at)),
            Self::Checkerboard3d(mapping) => {
                let c = mapping.map(at);
                let extent = c.dpdx.abs().max(c.dpdy.abs());
                let wave = (0..3).map(|i| square_wave(c.p[i], FILTER_WIDTH * extent[i])).product::<f32>();
                0.5 - 0.5 * wave
            }
            Self::Dots(mapping) => f32::from(u8::from(inside_dot(mapping.map(at).st))),
        }
    }
}

/// Half-width of the triangle filter in footprints: one and a half pixels on each side (pbrt-v4 book, 10.5.2).
const FILTER_WIDTH: f32 = 1.5;

fn checkerboard(c: &TexCoord2d) -> f32 {
    let extent = c.dstdx.abs().max(c.dstdy.abs()) * FILTER_WIDTH;
    0.5 - 0.5 * square_wave(c.st.x, extent.x) * square_wave(c.st.y, extent.y)
}

/// The square wave +1 on [0, 1), −1 on [1, 2), period 2, under a triangle filter of half-width `r`.
///
/// A triangle is a box convolved with itself, so the result is a second difference of the wave's second
/// antiderivative S: (S(x+r) − 2 S(x) + S(x−r))/r² (pbrt-v4 book, 10.5.2). It cancels badly for small r,
/// hence f64.
fn square_wave(x: f32, r: f32) -> f32 {
    let (x, r) = (f64::from(x), f64::from(r));
    if (x - r).floor() == (x + r).floor() {
        return if x.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
    }
    let antiderivative = |x: f64| {
        let period = (x / 2.0).floor();
        let f = x - 2.0 * period;
        period + if f < 1.0 { f * f / 2.0 } else { 2.0 * f - 1.0 - f * f / 2.0 }
    };
    let second_difference = antiderivative(x + r) - 2.0 * antiderivative(x) + antiderivative(x - r);
    (second_difference / (r * r)).clamp(-1.0, 1.0) as f32
}

/// Radius of a dot, in cells.
const DOT_RADIUS: f32 = 0.35;

/// Half of the cells have a dot, shifted at random as far as it stays inside (pbrt-v4 book, 10.6.1).
///
/// The numbers are where in the noise the random decisions of a cell are read; they are pbrt-v4's, as the
/// pattern depends on them.
fn inside_dot(st: Vec2) -> bool {
    let cell = (st + 0.5).floor();
    let random = |dx: f32, dy: f32| noise(Vec3::new(cell.x + dx, cell.y + dy, 0.5));
    if random(0.5, 0.5) <= 0.0 {
        return false;
    }
    let max_shift = 0.5 - DOT_RADIUS;
    let center = cell + max_shift * Vec2::new(random(1.5, 2.8), random(4.5, 9.8));
    (st - center).length_squared() < DOT_RADIUS * DOT_RADIUS
}

#[cfg(test)]
mod tests {
    use super::super::specimen;
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::{Footprint, Point, Transform};

    fn weight(pattern: &Pattern, uv: Vec2, width: f32) -> f32 {
        let point = specimen::surface_point(Point(uv.extend(0.3)), uv);
        let footprint = specimen::footprint(width);
        pattern.weight(&TextureContext { point: &point, footprint: &footprint })
    }

    #[test]
    fn cells_alternate_in_the_plane_and_in_space() {
        let plane = Pattern::Checkerboard(Mapping2d::UV);
        let space = Pattern::Checkerboard3d(Mapping3d { texture_from_render: Transform::IDENTITY });
        for (x, y, expected) in
            [(0.5, 0.5, 0.0), (1.5, 0.5, 1.0), (1.5, 1.5, 0.0), (-0.5, 0.5, 1.0), (-1.5, -2.5, 1.0)]
        {
            assert_eq!(weight(&plane, Vec2::new(x, y), 0.0), expected, "{x} {y}");
            assert_eq!(weight(&space, Vec2::new(x, y), 0.0), expected, "{x} {y}");
        }
    }

    #[test]
    fn a_footprint_of_many_cells_sees_half_of_each() {
        let mut rng = Pcg32::new(1, 1);
        for _ in 0..200 {
            let uv = Vec2::new(rng.next_f32(), rng.next_f32()) * 20.0 - 10.0;
            let w = weight(&Pattern::Checkerboard(Mapping2d::UV), uv, 50.0);
            // The filtered wave is at most 1/(2 r²) ≈ 9e-5 for r = 75.
            assert!((w - 0.5).abs() < 1e-4, "{uv}: {w}");
        }
    }

    #[test]
    fn the_filter_is_the_convolution_with_a_triangle() {
        let mut rng = Pcg32::new(2, 1);
        for _ in 0..200 {
            let (x, r) = (rng.next_f32() * 8.0 - 4.0, 0.01 + 2.0 * rng.next_f32());
            let n = 20_000;
            let exact: f64 = (0..n)
                .map(|i| {
                    let u = f64::from(2 * i + 1) / f64::from(n) - 1.0;
                    let wave =
                        if (f64::from(x) + u * f64::from(r)).rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
                    wave * (1.0 - u.abs()) * 2.0 / f64::from(n)
                })
                .sum();
            assert!((f64::from(square_wave(x, r)) - exact).abs() < 1e-3, "x {x} r {r}");
        }
    }

    #[test]
    fn tiny_footprints_at_an_edge_stay_between_the_cells() {
        for exponent in 1..30 {
            let r = 0.5_f32.powi(exponent);
            for x in [1.0, 101.0, 1001.0] {
                // Centred on an edge, the triangle sees both sides alike.
                assert!(square_wave(x, r).abs() < 1e-3, "x {x} r {r}: {}", square_wave(x, r));
            }
        }
    }

    #[test]
    fn dots_cover_their_share_of_the_plane() {
        let mut rng = Pcg32::new(4, 1);
        let n = 40_000;
        let inside = (0..n).filter(|_| inside_dot(Vec2::new(rng.next_f32(), rng.next_f32()) * 256.0)).count();
        // About half of the cells have a dot of area π 0.35²; the fraction of positive noise is measured.
        let cells = 256 * 256;
        let with_dot = (0..cells)
            .filter(|i| noise(Vec3::new((i % 256) as f32 + 0.5, (i / 256) as f32 + 0.5, 0.5)) > 0.0)
            .count();
        let expected = with_dot as f64 / f64::from(cells) * std::f64::consts::PI * 0.35 * 0.35;
        let share = inside as f64 / f64::from(n);
        let four_sigma = 4.0 * (expected * (1.0 - expected) / f64::from(n)).sqrt();
        assert!((share - expected).abs() < four_sigma, "{share} for {expected}");
    }

    #[test]
    fn direction_weight_is_zero_along_the_normal_and_one_across() {
        let point = specimen::surface_point(Point::ORIGIN, Vec2::ZERO);
        let at = TextureContext { point: &point, footprint: &Footprint::ZERO };
        let direction = |v| Pattern::Direction(Dir::new(v).unwrap()).weight(&at);
        assert_eq!(direction(Vec3::Z), 0.0);
        assert_eq!(direction(-Vec3::Z), 0.0);
        assert_eq!(direction(Vec3::X), 1.0);
        assert!((direction(Vec3::new(0.0, 1.0, 1.0)) - (1.0 - 0.5_f32.sqrt())).abs() < 1e-6);
    }
}
