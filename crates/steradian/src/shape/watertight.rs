//! Ray–triangle intersection without cracks along shared edges.
//!
//! The decision whether a ray passes a triangle is made in the sheared space of Woop, Benthin and Wald (2013):
//! a vertex is sheared by the same operations whichever triangle it belongs to, and the sign of an edge function
//! is the exact sign for the sheared vertices, so that two triangles always agree about their common edge.
//! Distance and barycentric coordinates of a hit are then computed in f64 from the original vertices.

use super::contract::PrimHit;
use crate::math::{Point, Ray};
use glam::DVec3;

/// A ray prepared for triangle tests: axis permutation and shear that make its direction +z or −z.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    /// Axes that become x, y and z; z is the one with the largest |d|.
    pub axes: [usize; 3],
    /// Shear factors −d_x/d_z and −d_y/d_z, to relative accuracy 2 ε; zero below [`STILL`].
    pub factors: [f32; 2],
    /// Origin in permuted axes.
    pub origin: [f32; 3],
    /// 1/d_z: turns depths into parametric distances, to relative accuracy 1.5 ε.
    pub inverse_z: f32,
    /// Direction in permuted axes.
    pub d: [f32; 3],
}

/// Components of the direction below this part of the largest count as zero wherever it is decided what a ray passes:
/// their products would leave the range of floats, and with it every bound on their rounding.
pub const STILL: f32 = 1e-18;

/// From which side a triangle is seen along +z of the sheared space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The edge functions are positive.
    Positive,
    /// The edge functions are negative.
    Negative,
}

impl Side {
    /// 1 or −1.
    #[inline(always)]
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

impl Shear {
    /// Prepares `ray`, whose direction must be finite and not zero.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let a = ray.d.abs();
        let first = usize::from(a.y > a.x);
        let z = if a.z > a.x.max(a.y) { 2 } else { first };
        Self::along(ray, z, 1.0 / ray.d[z])
    }

    /// [`Shear::new`] for a caller who knows already the first axis `z` with the largest |d| and 1/d there.
    #[inline(always)]
    pub fn along(ray: &Ray, z: usize, inverse_z: f32) -> Self {
        const NEXT: [usize; 5] = [0, 1, 2, 0, 1];
        let axes = [NEXT[z + 1], NEXT[z + 2], z];
        let (d, origin) = (ray.d.to_array(), ray.o.0.to_array());
        let (d, origin) = (axes.map(|axis| d[axis]), axes.map(|axis| origin[axis]));
        let factor = |d: f32| if (d * inverse_z).abs() < STILL { 0.0 } else { -d * inverse_z };
        Self { axes, factors: [factor(d[0]), factor(d[1])], origin, inverse_z, d }
    }

    /// Projects a vertex along the ray. Every rounding here is part of the watertightness argument: whoever
    /// repeats the computation (the SIMD packet test) must use the same operations, unfused.
    #[inline(always)]
    fn project(&self, p: [f32; 3]) -> [f32; 2] {
        let z = p[2] - self.origin[2];
        [(p[0] - self.origin[0]) + self.factors[0] * z, (p[1] - self.origin[1]) + self.factors[1] * z]
    }

    /// Intersects the triangle `v` at 0 < t ≤ `t_max`; `None` also for a triangle that is degenerate or seen edge-on.
    #[inline]
    pub fn intersect(&self, v: [Point; 3], t_max: f32) -> Option<PrimHit> {
        let corners = v.map(|p| p.0.to_array());
        let permuted = self.axes.map(|axis| corner_lanes(|k| corners[k][axis]));
        self.locate(&permuted, self.exact_side(&permuted)?, t_max)
    }

    /// From which side the ray passes a triangle, its coordinates in the order of [`Shear::axes`], by the exact signs
    /// of the edge functions; `None` when it misses, or when all three vanish and there is nothing to hit.
    pub fn exact_side(&self, permuted: &Permuted) -> Option<Side> {
        let [u, v, w] = self.edges(permuted);
        let (negative, positive) = ((u < 0.0) | (v < 0.0) | (w < 0.0), (u > 0.0) | (v > 0.0) | (w > 0.0));
        match (positive, negative) {
            (true, false) => Some(Side::Positive),
            (false, true) => Some(Side::Negative),
            _ => None,
        }
    }

    /// The edge functions with their exact signs.
    fn edges(&self, [x, y, z]: &Permuted) -> [f64; 3] {
        let [a, b, c] = [0, 1, 2].map(|k| self.project([x[k], y[k], z[k]]));
        [edge(c, b), edge(a, c), edge(b, a)]
    }

    /// Distance and barycentrics where the ray passes a triangle, its coordinates in the order of [`Shear::axes`],
    /// from `side`, which is decided already; `None` unless 0 < t ≤ `t_max` and the origin lies in front.
    #[inline(always)]
    pub fn locate(&self, permuted: &Permuted, side: Side, t_max: f32) -> Option<PrimHit> {
        let d = self.d.map(f64::from);
        // A lane per corner, relative to the origin.
        let relative = |axis: usize| {
            let o = f64::from(self.origin[axis]);
            four(|k| f64::from(permuted[axis][k]) - o)
        };
        let (x, y, z) = (relative(0), relative(1), relative(2));
        // Projected along d and scaled by d_z, which saves a division and cancels.
        let (px, py) = (four(|k| x[k] * d[2] - d[0] * z[k]), four(|k| y[k] * d[2] - d[1] * z[k]));
        // The edge function opposite to each corner.
        let (before, after) = ([2, 0, 1, 2], [1, 2, 0, 1]);
        let sign = side.sign();
        let areas = four(|k| (px[before[k]] * py[after[k]] - py[before[k]] * px[after[k]]) * sign);
        let [mut u, mut v, mut w, _] = areas;
        let mut sum = u + v + w;
        let mut depth = u * z[0] + v * z[1] + w * z[2];

        // The origin must be in front: `depth` has the sign of t d_z where it exceeds its rounding.
        let size = four(|k| larger(larger(x[k].abs(), y[k].abs()), z[k].abs()));
        let size = larger(larger(size[0], size[2]), size[1]);
        let rounding = (size * size * size) * (d[2] * d[2]) * ROUNDING_OF_DEPTH;
        let is_inside = u.min(v).min(w) >= 0.0 && sum > 0.0 && sum.is_finite();
        if !(is_inside && depth.abs() > rounding) {
            if !self.is_in_front(permuted, sign) {
                return None;
            }
            if !is_inside {
                // In f64 the ray passes beside the triangle, or sees it edge-on: keep the decision, and with it the place,
                // which for a needle may be anywhere along it.
                [u, v, w] = self.edges(permuted).map(|e| e * sign);
                sum = u + v + w;
                depth = u * z[0] + v * z[1] + w * z[2];
            }
        }
        let scale = 1.0 / (sum * d[2]);
        let t = (depth * scale) as f32;
        let inverse = scale * d[2];
        (t > 0.0 && t <= t_max).then_some(PrimHit { t, u: (v * inverse) as f32, v: (w * inverse) as f32 })
    }

    /// Whether the plane of a triangle lies ahead, for n·d of the sign −`side`·sign(d_z): the edge functions sum to minus
    /// twice the signed area seen along d.
    ///
    /// The sign of n·(a − o) counts only where it exceeds its rounding bound, so that a ray that starts on the triangle
    /// does not meet it again.
    #[cold]
    fn is_in_front(&self, permuted: &Permuted, side: f64) -> bool {
        const ROUNDING: f64 = 8.0 * f64::EPSILON;
        let [a, b, c] = [0, 1, 2].map(|k| {
            let relative = |axis: usize| f64::from(permuted[axis][k]) - f64::from(self.origin[axis]);
            DVec3::new(relative(0), relative(1), relative(2))
        });
        let (e1, e2) = (b - a, c - a);
        let distance = e1.cross(e2).dot(a);
        let (m1, m2) = (e1.abs(), e2.abs());
        let magnitude =
            DVec3::new(m1.y * m2.z + m1.z * m2.y, m1.z * m2.x + m1.x * m2.z, m1.x * m2.y + m1.y * m2.x);
        distance * -side.copysign(side * f64::from(self.d[2])) > ROUNDING * magnitude.dot(a.abs())
    }
}

/// The coordinates of a triangle's corners, axis by axis in the order of [`Shear::axes`]; the fourth lane repeats the
/// first, so that whole vectors can be loaded.
pub type Permuted = [[f32; 4]; 3];

/// A lane for each corner, and the first again.
#[inline(always)]
pub fn corner_lanes(coordinate: impl Fn(usize) -> f32) -> [f32; 4] {
    [coordinate(0), coordinate(1), coordinate(2), coordinate(0)]
}

/// Bound on the rounding of the sum of areas times depths in [`Shear::locate`], per cube of the largest |coordinate| and
/// square of d_z; 288 ε and the rounding of the sum itself, rounded up.
pub const ROUNDING_OF_DEPTH: f64 = 512.0 * f64::EPSILON;

/// The larger of two, as one instruction: the second where one is NaN.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn four(f: impl Fn(usize) -> f64) -> [f64; 4] {
    [f(0), f(1), f(2), f(3)]
}

/// The edge function p × q, with the exact sign: products of two f32 are exact in f64, so the difference is
/// zero only when the products are equal.
#[inline]
fn edge(p: [f32; 2], q: [f32; 2]) -> f64 {
    f64::from(p[0]) * f64::from(q[1]) - f64::from(p[1]) * f64::from(q[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::{Vec2, Vec3, warp};

    fn hit(v: [Point; 3], o: Vec3, d: Vec3) -> Option<PrimHit> {
        Shear::new(&Ray { o: Point(o), d, time: 0.0 }).intersect(v, f32::INFINITY)
    }

    const TRIANGLE: [Point; 3] =
        [Point::new(0.0, 0.0, 0.0), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];

    #[test]
    fn hits_report_distance_and_barycentrics() {
        for permutation in 0..3 {
            let p = |v: Vec3| match permutation {
                0 => v,
                1 => Vec3::new(v.z, v.x, v.y),
                _ => Vec3::new(v.y, v.z, v.x),
            };
            let v = TRIANGLE.map(|q| Point(p(*q)));
            for side in [1.0, -1.0] {
                let h =
                    hit(v, p(Vec3::new(0.25, 0.5, 3.0 * side)), p(Vec3::new(0.0, 0.0, -2.0 * side))).unwrap();
                assert_eq!((h.t, h.u, h.v), (1.5, 0.25, 0.5));
                assert!(
                    hit(v, p(Vec3::new(0.25, 0.5, 3.0 * side)), p(Vec3::new(0.0, 0.0, 2.0 * side))).is_none()
                );
            }
        }
    }

    #[test]
    fn a_ray_in_the_plane_or_from_the_plane_misses() {
        assert!(hit(TRIANGLE, Vec3::new(-1.0, 0.25, 0.0), Vec3::X).is_none());
        assert!(hit(TRIANGLE, Vec3::new(0.25, 0.25, 0.0), Vec3::new(0.1, 0.2, 1.0)).is_none());
    }

    #[test]
    fn degenerate_triangles_are_never_hit() {
        let line = [Point::ORIGIN, Point::new(1.0, 1.0, 1.0), Point::new(2.0, 2.0, 2.0)];
        assert!(hit(line, Vec3::new(1.0, 1.0, 5.0), -Vec3::Z).is_none());
        assert!(hit([Point::ORIGIN; 3], Vec3::new(0.0, 0.0, 5.0), -Vec3::Z).is_none());
    }

    #[test]
    fn a_ray_through_a_shared_edge_or_vertex_meets_a_triangle() {
        let q = Point::new(1.0, 1.0, 0.0);
        let other = [TRIANGLE[1], q, TRIANGLE[2]];
        for i in 0..=100 {
            let x = i as f32 * 0.01;
            let target = Vec3::new(x, 1.0 - x, 0.0);
            for o in [Vec3::new(0.3, 0.2, 1.0), Vec3::new(-7.0, 3.0, 1e-3), Vec3::new(2.0, 9.0, -1e4)] {
                let d = target - o;
                assert!(hit(TRIANGLE, o, d).is_some() || hit(other, o, d).is_some(), "{x} {o}");
            }
        }
    }

    #[test]
    fn a_ray_from_a_point_exactly_in_the_plane_of_a_triangle_misses_it() {
        let mut rng = Pcg32::new(12, 5);
        for case in 0..4000 {
            // Whole numbers: the origin is a corner plus multiples of 1/32 of two edges, inside and without rounding.
            let mut whole =
                |n: u32| Vec3::from_array([0; 3].map(|_| (rng.next_u32() % (2 * n)) as f32 - n as f32));
            let (a, e1, e2) = (whole(1 << 22), whole(1 << 17), whole(1 << 17));
            let (i, j) = (1 + rng.next_u32() % 15, 1 + rng.next_u32() % 15);
            let o = a + e1 * i as f32 + e2 * j as f32;
            let d = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let scale = [1.0, 2.0_f32.powi(-60), 2.0_f32.powi(60)][case % 3];
            let v = [a, a + e1 * 32.0, a + e2 * 32.0].map(|p| Point(p * scale));
            assert_eq!(hit(v, o * scale, d), None, "{v:?} {o} {d}");
        }
    }

    #[test]
    fn a_triangle_is_met_from_however_little_in_front_of_it() {
        // The depth is below the rounding of the areas by which it is weighed: the plane has to decide.
        let v = [Point::new(-1.0, -0.7, 0.0), Point::new(1.3, -0.9, 0.0), Point::new(0.1, 1.1, 0.0)];
        for exponent in 1..=30 {
            let z = 10.0_f32.powi(-exponent);
            for side in [1.0, -1.0] {
                let o = Vec3::new(0.1, -0.2, z * side);
                let d = Vec3::new(0.3, 0.2, -0.9 * side);
                let h = hit(v, o, d).expect("in front");
                assert!((h.t / (z / 0.9) - 1.0).abs() < 1e-6, "{z}: {h:?}");
                assert_eq!(hit(v, o, -d), None, "{z}");
            }
        }
    }
}
