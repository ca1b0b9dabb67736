//! Transforms that move between two keyframes during the shutter interval.

use super::bounds::Bounds3;
use super::transform::Transform;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3, Mat4};

/// A transform with a start and an end keyframe; between them translation and stretch are linear
/// and rotation is spherical-linear (Shoemake & Duff 1992, polar decomposition).
#[derive(Clone, Debug)]
pub struct AnimatedTransform {
    start: Transform,
    end: Transform,
    times: [f32; 2],
    motion: Option<Box<[Keyframe; 2]>>,
}

#[derive(Clone, Copy, Debug)]
struct Keyframe {
    translation: DVec3,
    rotation: DQuat,
    stretch: DMat3,
}

impl Keyframe {
    fn decompose(t: &Transform) -> Self {
        let m = t.matrix().as_dmat4();
        let linear = DMat3::from_mat4(m);
        // Higham's iteration: averaging with the inverse transpose converges to the nearest rotation.
        let mut r = linear;
        for _ in 0..100 {
            let next = (r + r.inverse().transpose()) * 0.5;
            let change = (next - r).abs();
            r = next;
            if change.to_cols_array().iter().fold(0.0_f64, |a, &b| a.max(b)) < 1e-10 {
                break;
            }
        }
        // A mirroring transform has a rotation part with determinant −1: the mirror belongs to the stretch.
        if r.determinant() < 0.0 {
            r *= -1.0;
        }
        Self {
            translation: m.w_axis.truncate(),
            rotation: DQuat::from_mat3(&r),
            stretch: r.inverse() * linear,
        }
    }
}

impl AnimatedTransform {
    /// A transform that moves from `start` at `times[0]` to `end` at `times[1]` [s].
    pub fn new(start: Transform, end: Transform, times: [f32; 2]) -> Self {
        let motion = (start != end && times[0] < times[1]).then(|| {
            let (a, mut b) = (Keyframe::decompose(&start), Keyframe::decompose(&end));
            if a.rotation.dot(b.rotation) < 0.0 {
                b.rotation = -b.rotation;
            }
            Box::new([a, b])
        });
        Self { start, end, times, motion }
    }

    /// A transform that does not move.
    pub fn fixed(t: Transform) -> Self {
        Self { start: t, end: t, times: [0.0, 1.0], motion: None }
    }

    /// Whether the transform changes with time.
    pub fn is_animated(&self) -> bool {
        self.motion.is_some()
    }

    /// The transform at the start of the interval.
    pub fn start(&self) -> &Transform {
        &self.start
    }

    /// The transform at the end of the interval.
    pub fn end(&self) -> &Transform {
        &self.end
    }

    /// The keyframe times [s].
    pub fn times(&self) -> [f32; 2] {
        self.times
    }

    /// The transform at `time`, held at the ends outside the interval.
    pub fn at(&self, time: f32) -> Transform {
        match self.blended(time) {
            Ok(m) => Transform::from_matrix(m).unwrap_or(self.start),
            Err(held) => *held,
        }
    }

    /// The inverse of [`AnimatedTransform::at`] to the precision of f64, for points and vectors.
    pub fn inverse_at(&self, time: f32) -> DAffine3 {
        let inverse = |m: &Mat4| DAffine3::from_mat4(m.as_dmat4()).inverse();
        match self.blended(time) {
            Ok(m) => {
                let found = inverse(&m);
                let exists = found.matrix3.as_mat3().is_finite() && found.translation.as_vec3().is_finite();
                if exists { found } else { inverse(self.start.matrix()) }
            }
            Err(held) => inverse(held.matrix()),
        }
    }

    /// The matrix between the keyframes at `time`, or the keyframe that holds there.
    ///
    /// Both keyframes are invertible; a blend that is singular (a mirror passing through zero) shows the start.
    fn blended(&self, time: f32) -> Result<Mat4, &Transform> {
        let Some(keys) = &self.motion else { return Err(&self.start) };
        if time <= self.times[0] {
            return Err(&self.start);
        }
        if time >= self.times[1] {
            return Err(&self.end);
        }
        let x = f64::from((time - self.times[0]) / (self.times[1] - self.times[0]));
        let [a, b] = &**keys;
        let stretch = a.stretch * (1.0 - x) + b.stretch * x;
        let linear = DMat3::from_quat(a.rotation.slerp(b.rotation, x)) * stretch;
        let mut m = DMat4::from_mat3(linear);
        m.w_axis = a.translation.lerp(b.translation, x).extend(1.0);
        Ok(m.as_mat4())
    }

    /// What `f` makes of the transform at `time`; one that does not move is not copied.
    #[inline]
    pub fn through<T>(&self, time: f32, f: impl FnOnce(&Transform) -> T) -> T {
        if self.motion.is_none() { f(&self.start) } else { f(&self.at(time)) }
    }

    /// A box around `b` at every time of the interval.
    pub fn motion_bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() {
            return *b;
        }
        let Some(keys) = &self.motion else { return self.start.bounds(b) };
        // Between two samples a corner deviates from the chord by at most (step²/8)·max|second derivative|.
        // Rotation contributes |p| ω², and the products of the linear terms 2 ω |v| (all per unit of the interval).
        const STEPS: u32 = 32;
        let mut total = Bounds3::EMPTY;
        for i in 0..=STEPS {
            let x = i as f32 / STEPS as f32;
            let time = self.times[0] + (self.times[1] - self.times[0]) * x;
            total = total.union(self.at(time).bounds(b));
        }
        let [k0, k1] = &**keys;
        let omega = 2.0 * k0.rotation.dot(k1.rotation).clamp(-1.0, 1.0).acos();
        let reach = b.corners().iter().fold(0.0_f64, |r, c| {
            let c = c.as_dvec3();
            r.max((k0.stretch * c).length()).max((k1.stretch * c).length())
        });
        let second_derivative = omega * omega * reach + 4.0 * omega * reach;
        let step = 1.0 / f64::from(STEPS);
        total.expand((second_derivative * step * step / 8.0) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::{Point, Vec3};

    fn spin() -> AnimatedTransform {
        let end = Transform::translate(Vec3::new(3.0, 0.0, 1.0)) * Transform::rotate(170.0, Vec3::Y).unwrap();
        AnimatedTransform::new(Transform::scale(Vec3::new(1.0, 2.0, 1.0)).unwrap(), end, [0.0, 2.0])
    }

    #[test]
    fn keyframes_are_met_exactly_and_held_outside() {
        let a = spin();
        assert_eq!(a.at(-1.0), *a.start());
        assert_eq!(a.at(0.0), *a.start());
        assert_eq!(a.at(5.0), *a.end());
    }

    #[test]
    fn the_inverse_undoes_the_transform_at_every_time() {
        let a = spin();
        for i in -10..=210 {
            let time = i as f32 * 0.01;
            let p = Point::new(0.3, -1.2, 2.5);
            let back = a.inverse_at(time).transform_point3(a.at(time).point(p).as_dvec3());
            assert!((back - p.as_dvec3()).length() < 1e-5, "{time}: {back}");
        }
    }

    #[test]
    fn motion_bounds_contain_every_time() {
        let a = spin();
        let b = Bounds3 { min: Point::new(-1.0, -2.0, 0.5), max: Point::new(4.0, 1.0, 2.0) };
        let m = a.motion_bounds(&b);
        for i in 0..=1000 {
            let t = a.at(i as f32 * 0.002);
            for c in b.corners() {
                let p = t.point(c);
                assert!(
                    p.cmpge(*m.min - 1e-4).all() && p.cmple(*m.max + 1e-4).all(),
                    "{i}: {p:?} outside {m:?}"
                );
            }
        }
    }

    #[test]
    fn halfway_rotation_is_half_the_angle() {
        let a = AnimatedTransform::new(
            Transform::IDENTITY,
            Transform::rotate(90.0, Vec3::Z).unwrap(),
            [0.0, 1.0],
        );
        let p = a.at(0.5).point(Point::new(1.0, 0.0, 0.0));
        let h = std::f32::consts::FRAC_1_SQRT_2;
        assert!((*p - Vec3::new(h, h, 0.0)).length() < 1e-6, "{p:?}");
    }

    #[test]
    fn what_is_seen_through_a_placement_is_seen_at_its_time() {
        let a = spin();
        for time in [-1.0, 0.0, 0.3, 1.0, 1.9, 2.0, 3.0] {
            assert_eq!(a.through(time, |t| *t), a.at(time), "{time}");
        }
        let still = AnimatedTransform::fixed(*a.end());
        assert_eq!(still.through(0.5, |t| *t), *a.end());
    }

    #[test]
    fn a_placement_that_shrinks_to_nothing_shows_its_start_there_both_ways() {
        // A mirror in a plane is one in the origin and half a turn about its normal: halfway nothing has any extent.
        let start = Transform::translate(Vec3::new(0.0, 2.0, 0.0));
        let mirror = start * Transform::scale(Vec3::new(-1.0, 1.0, 1.0)).unwrap();
        let a = AnimatedTransform::new(start, mirror, [0.0, 1.0]);
        assert_eq!(a.at(0.5), start);
        let p = Point::new(0.3, -1.2, 2.5);
        let back = a.inverse_at(0.5).transform_point3(start.point(p).as_dvec3());
        assert!((back - p.as_dvec3()).length() < 1e-6, "{back}");
    }
}
