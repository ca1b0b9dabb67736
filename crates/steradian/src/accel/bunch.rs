//! Parts of curves, eight at a time: which of them may a ray meet?
//!
//! The box around a thin part that runs askew is mostly empty. A capsule around its chord is not, and to pass by a capsule
//! takes little more than to pass by a box. The code has no branches, so that the compiler works on all lanes at once, and
//! no fused operation, so that the answer is the same with any instructions.

use crate::math::{Ray, float};
use crate::shape::curve::Capsule;

/// Parts of a bunch.
pub(super) const STRANDS: usize = 8;

/// Capsules around up to eight parts of curves, coordinate by coordinate; unused lanes repeat the last.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Bunch {
    middle: [[f32; STRANDS]; 3],
    chord: [[f32; STRANDS]; 3],
    reach: [f32; STRANDS],
    radius: [f32; STRANDS],
}

/// Lanes, in ascending order: a byte each, which is one or zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LaneSet(u64);

impl LaneSet {
    #[inline(always)]
    pub(super) fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl Iterator for LaneSet {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        (self.0 != 0).then(|| {
            let lane = self.0.trailing_zeros() / 8;
            self.0 &= self.0 - 1;
            lane
        })
    }
}

/// Bound on the rounding of the products below, relative to those of the lengths.
const ROUNDING: f32 = 8.0 * float::MACHINE_EPSILON;

/// Part by which squares are enlarged, so that the square of their roots' sum with that of an error is covered: for any s
/// and e, (s + e)² ≤ (1 + 1/16)·s² + 17·e².
const SLACK: f32 = 1.0 + 1.0 / 16.0;
const ERRORS: f32 = 17.0 * ROUNDING * ROUNDING;

impl Bunch {
    /// The bunch of the first of those capsules, one at least.
    pub(super) fn new(mut capsules: impl Iterator<Item = Capsule>) -> Self {
        let row = [0.0; STRANDS];
        let mut bunch = Self { middle: [row; 3], chord: [row; 3], reach: row, radius: row };
        let mut last = None;
        for lane in 0..STRANDS {
            last = capsules.next().or(last);
            if let Some(Capsule { middle, chord, reach, radius }) = last {
                for axis in 0..3 {
                    bunch.middle[axis][lane] = middle[axis];
                    bunch.chord[axis][lane] = chord[axis];
                }
                (bunch.reach[lane], bunch.radius[lane]) = (reach, radius);
            }
        }
        bunch
    }

    /// The capsules that the ray may meet at 0 < t ≤ `t_max`: none is left out that it does meet, and none about which nothing
    /// can be said within the range of floats.
    ///
    /// With w from the ray's origin to the middle, c the chord and d the direction, the ray passes the middle at the distance
    /// |d × w| / |d|, and the line through the chord at |d × w · c| / |d × c|.
    #[inline(always)]
    pub(super) fn near(&self, ray: &Ray, t_max: f32) -> LaneSet {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.o.0.to_array(), ray.d.to_array());
        let length_squared = ray.d.length_squared();
        let (ball, before) = (length_squared * SLACK, length_squared.sqrt() * SLACK);
        let farthest = t_max * length_squared * (1.0 + 16.0 * ROUNDING);
        let mut near = [0_u8; STRANDS];
        for (i, near) in near.iter_mut().enumerate() {
            let [wx, wy, wz] = [self.middle[0][i] - ox, self.middle[1][i] - oy, self.middle[2][i] - oz];
            let [cx, cy, cz] = [self.chord[0][i], self.chord[1][i], self.chord[2][i]];
            let (reach, radius) = (self.reach[i], self.radius[i]);
            let radius_squared = radius * radius;
            let along = dx * wx + dy * wy + dz * wz;
            let [kx, ky, kz] = [dy * wz - dz * wy, dz * wx - dx * wz, dx * wy - dy * wx];
            let across = kx * kx + ky * ky + kz * kz;
            // (|d| |w|)², by Lagrange's identity.
            let error = (across + along * along) * ERRORS;
            let beside = across > radius_squared * ball + error + f32::MIN_POSITIVE;
            let volume = kx * cx + ky * cy + kz * cz;
            let [nx, ny, nz] = [dy * cz - dz * cy, dz * cx - dx * cz, dx * cy - dy * cx];
            let area = nx * nx + ny * ny + nz * nz;
            // The chord is no longer than twice the radius.
            let passing = volume * volume
                > reach * area * (reach * SLACK) + radius_squared * (4.0 * error) + f32::MIN_POSITIVE;
            let margin = radius * before;
            let behind = along < -margin;
            let beyond = along - margin > farthest;
            // False where lengths are beyond the range of floats.
            let certain = error < f32::INFINITY;
            *near = u8::from(!(certain & (beside | passing | behind | beyond)));
        }
        LaneSet(u64::from_le_bytes(near))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::{Point, Transform, Vec2, Vec3, warp};
    use crate::shape::curve::{Basis, Degree, Profile};
    use crate::shape::{Curve, CurveData, CurveSegment, Orientation};

    /// One piece in four parts.
    fn bunch(points: [Vec3; 4], widths: [f32; 2]) -> (Bunch, Vec<CurveSegment>) {
        let data = CurveData {
            points: points.map(Point).to_vec(),
            basis: Basis::Bezier,
            degree: Degree::Cubic,
            profile: Profile::Flat,
            normals: vec![],
            widths,
            split_depth: 2,
        };
        let curve = Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
        let parts: Vec<_> = (0..curve.segment_count()).map(|k| curve.segment(k)).collect();
        (Bunch::new(parts.iter().map(CurveSegment::capsule)), parts)
    }

    fn met(parts: &[CurveSegment], ray: &Ray, t_max: f32) -> Vec<u32> {
        let meets = |part: &CurveSegment| part.intersect(ray, t_max).is_some();
        (0..).zip(parts).filter(|(_, part)| meets(part)).map(|(lane, _)| lane).collect()
    }

    #[test]
    fn no_part_that_a_ray_meets_is_left_out() {
        let mut rng = Pcg32::new(31, 2);
        let mut count = 0;
        for case in 0..4000 {
            let mut place = || Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 2.0 - 1.0;
            // Bent ones, straight ones, such that turn back, and points.
            let points = match case % 4 {
                0 => [place(), place(), place(), place()],
                1 => {
                    let (a, b) = (place(), place());
                    [0.0, 0.2, 0.8, 1.0].map(|x| a.lerp(b, x))
                }
                2 => {
                    let (a, b) = (place(), place());
                    [a, b, a, b]
                }
                _ => [place(); 4],
            };
            let scale = [1e-18, 1e-9, 1.0, 1e9, 1e18][case / 4 % 5];
            let width = [0.3, 0.02, 0.001][case % 3];
            let (target, mut d) = (points[case % 4].lerp(points[1], rng.next_f32()), Vec3::ZERO);
            let around = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let (bunch, parts) = bunch(points.map(|p| p * scale), [width * scale, 0.5 * width * scale]);
            // From far and near, along the curve, and just past its edge.
            let far = [0.1, 2.0, 100.0][case / 60 % 3];
            let target = target + around * (0.5 * width * rng.next_f32());
            while d == Vec3::ZERO {
                let side = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
                d = if case % 7 == 0 { points[3] - points[0] } else { side };
                if case % 28 == 7 {
                    d = -side;
                }
            }
            let d = d.normalize();
            let length = [1.0, 1e-10, 1e10][case / 20 % 3];
            let ray = Ray { o: Point((target - d * far) * scale), d: d * length, time: 0.0 };
            for part in [0.999, 1.0, 1.001, f32::INFINITY] {
                let t_max = far * scale / length * part;
                let near: Vec<u32> = bunch.near(&ray, t_max).collect();
                for lane in met(&parts, &ray, t_max) {
                    count += 1;
                    assert!(near.contains(&lane), "case {case}: {ray:?} {t_max} {points:?}");
                }
            }
        }
        assert!(count > 2000, "{count}");
    }

    #[test]
    fn rays_beside_behind_and_beyond_pass_by() {
        let points = [0.0, 1.0, 2.0, 3.0].map(|x| Vec3::new(x, x, 0.0));
        let (bunch, _) = bunch(points, [0.02; 2]);
        let along = Vec3::new(1.0, 1.0, 0.0).normalize();
        let across = Vec3::new(1.0, -1.0, 0.0).normalize();
        let d = Vec3::new(0.0, 0.3, -1.0);
        let near = |at: Vec3, t: f32, t_max: f32| {
            let n = bunch.near(&Ray { o: Point(at - d * t), d, time: 0.0 }, t_max);
            (0..4).map(|lane| u32::from(n.clone().any(|l| l == lane))).collect::<Vec<_>>()
        };
        // In the middle of the second of four parts; the ray runs askew to the curve.
        let center = along * (3.0 * 2.0_f32.sqrt() * 0.375);
        assert_eq!(near(center, 5.0, f32::INFINITY), [0, 1, 0, 0]);
        let normal = d.cross(along).normalize();
        assert_eq!(near(center + normal * 0.0099, 5.0, f32::INFINITY), [0, 1, 0, 0]);
        assert_eq!(near(center + normal * 0.011, 5.0, f32::INFINITY), [0; 4], "beside it");
        assert_eq!(near(center + across * 0.05, 5.0, f32::INFINITY), [0; 4]);
        assert_eq!(near(center, -2.0, f32::INFINITY), [0; 4], "behind the origin");
        assert_eq!(near(center, 5.0, 4.0), [0; 4], "beyond the end");
        assert_eq!(near(center, 5.0, 5.1), [0, 1, 0, 0]);
    }

    /// Straight curves of two units, which lie around the origin, where their own numbers hardly round, or far from it; the ray
    /// ends where it meets them.
    #[test]
    fn rounding_leaves_out_no_part_whose_end_or_edge_a_ray_meets_from_afar() {
        let mut rng = Pcg32::new(14, 9);
        let mut count = 0;
        for case in 0..40_000 {
            let mut direction = || warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let (d, away) = (direction(), direction());
            // Along the ray, across, and askew.
            let chord = [d, d.cross(away).normalize_or_zero(), direction()][case % 3];
            let edge = d.cross(chord).normalize_or_zero();
            let far = 10.0_f32.powf(8.0 * rng.next_f32());
            // Of any width, or such that rounding counts.
            let width = match case / 3 % 2 {
                0 => 10.0_f32.powf(-7.0 * rng.next_f32()),
                _ => far * f32::EPSILON * 10.0_f32.powf(3.0 * rng.next_f32() - 1.0),
            };
            let place = [1.0, -1.0, 2.0 * rng.next_f32() - 1.0][case / 6 % 3];
            let side = [0.0, 0.5, -0.5][case / 18 % 3];
            // Also where products leave the range of floats.
            let (scale, length) = match case % 5 {
                0 => (3.4e19 * (1.0 + 0.01 * rng.next_f32()) / far, 1e19),
                _ => (1.0, 1.0),
            };
            let (away, from) = if case % 4 == 1 { (away * far, 3.0) } else { (Vec3::ZERO, far) };
            let points = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0].map(|x| (away + chord * x) * scale);
            let (bunch, parts) = bunch(points, [width * scale; 2]);
            let target = away + chord * place + edge * (side * width);
            let ray = Ray { o: Point((target - d * from) * scale), d: d * length, time: 0.0 };
            for (lane, part) in (0..).zip(&parts) {
                let Some(h) = part.intersect(&ray, f32::INFINITY) else { continue };
                count += 1;
                assert_eq!(part.intersect(&ray, h.t), Some(h), "case {case}: {ray:?} {points:?} {width}");
                for t_max in [h.t, h.t.next_up(), f32::INFINITY] {
                    let near = bunch.near(&ray, t_max).any(|l| l == lane);
                    assert!(near, "case {case}: {ray:?} {t_max} {points:?} {width}");
                }
            }
        }
        assert!(count > 8000, "{count}");
    }
}
