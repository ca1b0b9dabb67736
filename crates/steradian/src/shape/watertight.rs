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
    d: [f32; 3],
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
    #[inline(always)]
    fn sign(self) -> f64 {
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
        let permuted = v.map(|p| {
            let p = p.0.to_array();
            self.axes.map(|axis| p[axis])
        });
        self.locate(&permuted, self.exact_side(&permuted)?, t_max)
    }

    /// From which side the ray passes a triangle, its coordinates in the order of [`Shear::axes`], by the exact signs
    /// of the edge functions; `None` when it misses, or when all three vanish and there is nothing to hit.
    pub fn exact_side(&self, permuted: &[[f32; 3]; 3]) -> Option<Side> {
        let [u, v, w] = self.edges(permuted);
        let (negative, positive) = ((u < 0.0) | (v < 0.0) | (w < 0.0), (u > 0.0) | (v > 0.0) | (w > 0.0));
        match (positive, negative) {
            (true, false) => Some(Side::Positive),
            (false, true) => Some(Side::Negative),
            _ => None,
        }
    }

    /// The edge functions with their exact signs.
    fn edges(&self, permuted: &[[f32; 3]; 3]) -> [f64; 3] {
        let [a, b, c] = permuted.map(|p| self.project(p));
        [edge(c, b), edge(a, c), edge(b, a)]
    }

    /// Distance and barycentrics where the ray passes a triangle, its coordinates in the order of [`Shear::axes`],
    /// from `side`, which is decided already; `None` unless 0 < t ≤ `t_max` and the origin lies in front.
    #[inline(always)]
    pub fn locate(&self, permuted: &[[f32; 3]; 3], side: Side, t_max: f32) -> Option<PrimHit> {
        let wide = |p: [f32; 3]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
        let (o, d) = (wide(self.origin), wide(self.d));
        let [a, b, c] = permuted.map(|p| wide(p) - o);

        // The origin must be in front: the sign of n·(a − o) is used only when it exceeds its rounding bound, so
        // that a ray that starts on the triangle does not meet it again.
        let (e1, e2) = (b - a, c - a);
        let distance = e1.cross(e2).dot(a);
        let (m1, m2) = (e1.abs(), e2.abs());
        let magnitude =
            DVec3::new(m1.y * m2.z + m1.z * m2.y, m1.z * m2.x + m1.x * m2.z, m1.x * m2.y + m1.y * m2.x);
        const ROUNDING: f64 = 8.0 * f64::EPSILON;
        // n·d has the sign −side·sign(d_z): the edge functions sum to minus twice the signed area seen along d.
        let side_sign = side.sign();
        if distance * -side_sign.copysign(side_sign * d.z) <= ROUNDING * magnitude.dot(a.abs()) {
            return None;
        }

        // Projected along d and scaled by d_z, which saves a division and cancels.
        let project = |p: DVec3| [p.x * d.z - d.x * p.z, p.y * d.z - d.y * p.z];
        let (pa, pb, pc) = (project(a), project(b), project(c));
        let area = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1] - p[1] * q[0]) * side_sign;
        let (mut u, mut v, mut w) = (area(pc, pb), area(pa, pc), area(pb, pa));
        let mut sum = u + v + w;
        if !(u.min(v).min(w) >= 0.0 && sum > 0.0 && sum.is_finite()) {
            // In f64 the ray passes beside the triangle, or sees it edge-on: keep the decision, and with it the place, which
            // for a needle may be anywhere along it.
            [u, v, w] = self.edges(permuted).map(|e| e * side_sign);
            sum = u + v + w;
        }
        let scale = 1.0 / (sum * d.z);
        let t = ((u * a.z + v * b.z + w * c.z) * scale) as f32;
        let inverse = scale * d.z;
        (t > 0.0 && t <= t_max).then_some(PrimHit { t, u: (v * inverse) as f32, v: (w * inverse) as f32 })
    }
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
    use crate::math::Vec3;

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
}
