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
    /// Shear factors −d_x/d_z and −d_y/d_z.
    pub factors: [f32; 2],
    /// Origin in permuted axes.
    pub origin: [f32; 3],
    /// 1/d_z: turns depths into parametric distances, to relative accuracy 1.5 ε.
    pub inverse_z: f32,
    d: DVec3,
}

impl Shear {
    /// Prepares `ray`, whose direction must be finite and not zero.
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let a = ray.d.abs();
        let axes = if a.x > a.y && a.x > a.z {
            [1, 2, 0]
        } else if a.y > a.z && a.y >= a.x {
            [2, 0, 1]
        } else {
            [0, 1, 2]
        };
        let permuted = |v: [f32; 3]| axes.map(|axis| v[axis]);
        let (d, origin) = (permuted(ray.d.to_array()), permuted(ray.o.to_array()));
        Self {
            axes,
            factors: [-d[0] / d[2], -d[1] / d[2]],
            origin,
            inverse_z: 1.0 / d[2],
            d: DVec3::from(d.map(f64::from)),
        }
    }

    /// Projects a vertex along the ray. Every rounding here is part of the watertightness argument: whoever
    /// repeats the computation (the SIMD packet test) must use the same operations, unfused.
    #[inline]
    fn project(&self, p: [f32; 3]) -> [f32; 2] {
        let z = p[2] - self.origin[2];
        [(p[0] - self.origin[0]) + self.factors[0] * z, (p[1] - self.origin[1]) + self.factors[1] * z]
    }

    /// Intersects the triangle `v` at 0 < t ≤ `t_max`; `None` also for a triangle that is degenerate or seen edge-on.
    #[inline]
    pub fn intersect(&self, [a, b, c]: [Point; 3], t_max: f32) -> Option<PrimHit> {
        let permuted = |p: Point| {
            let p = p.0.to_array();
            [p[self.axes[0]], p[self.axes[1]], p[self.axes[2]]]
        };
        self.intersect_permuted([permuted(a), permuted(b), permuted(c)], t_max)
    }

    /// [`Shear::intersect`] for a triangle whose coordinates are in the order of [`Shear::axes`] already.
    #[inline]
    pub fn intersect_permuted(&self, permuted: [[f32; 3]; 3], t_max: f32) -> Option<PrimHit> {
        let (a, b, c) = (self.project(permuted[0]), self.project(permuted[1]), self.project(permuted[2]));
        let edges = [edge(c, b), edge(a, c), edge(b, a)];
        let [u, v, w] = edges;
        let (negative, positive) = ((u < 0.0) | (v < 0.0) | (w < 0.0), (u > 0.0) | (v > 0.0) | (w > 0.0));
        if negative == positive {
            // Either a miss, or all three vanish: nothing to hit.
            return None;
        }
        let side = if positive { 1.0 } else { -1.0 };
        self.locate(permuted, edges, side, t_max)
    }

    /// Distance and barycentrics of a pass that is already decided; rejects hits behind or at the origin.
    #[inline]
    fn locate(&self, v: [[f32; 3]; 3], edges: [f64; 3], side: f64, t_max: f32) -> Option<PrimHit> {
        let wide = |p: [f32; 3]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
        let o = wide(self.origin);
        let (a, b, c) = (wide(v[0]) - o, wide(v[1]) - o, wide(v[2]) - o);

        // The origin must be in front: the sign of n·(a − o) is used only when it exceeds its rounding bound, so
        // that a ray that starts on the triangle does not meet it again.
        let (e1, e2) = (b - a, c - a);
        let distance = e1.cross(e2).dot(a);
        let (m1, m2) = (e1.abs(), e2.abs());
        let magnitude =
            DVec3::new(m1.y * m2.z + m1.z * m2.y, m1.z * m2.x + m1.x * m2.z, m1.x * m2.y + m1.y * m2.x);
        const ROUNDING: f64 = 8.0 * f64::EPSILON;
        // n·d has the sign −side·sign(d_z): the edge functions sum to minus twice the signed area seen along d.
        if -distance * side * self.d.z.signum() <= ROUNDING * magnitude.dot(a.abs()) {
            return None;
        }

        let inv_z = 1.0 / self.d.z;
        let (sx, sy) = (-self.d.x * inv_z, -self.d.y * inv_z);
        let project = |p: DVec3| [p.x + sx * p.z, p.y + sy * p.z];
        let (pa, pb, pc) = (project(a), project(b), project(c));
        let area = |p: [f64; 2], q: [f64; 2]| ((p[0] * q[1] - p[1] * q[0]) * side).max(0.0);
        let (mut u, mut v, mut w) = (area(pc, pb), area(pa, pc), area(pb, pa));
        let mut sum = u + v + w;
        if !(sum > 0.0 && sum.is_finite()) {
            // Exactly edge-on in f64 although the sheared f32 triangle has an area: keep the decision.
            [u, v, w] = edges.map(|e| e * side);
            sum = u + v + w;
        }
        let inv = 1.0 / sum;
        let (b1, b2) = (v * inv, w * inv);
        let t = ((u * inv) * a.z + b1 * b.z + b2 * c.z) * inv_z;
        let t = t as f32;
        (t > 0.0 && t <= t_max).then_some(PrimHit { t, u: b1 as f32, v: b2 as f32 })
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
