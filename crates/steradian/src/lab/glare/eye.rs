//! Where an eye is, where it looks, and on which side its right is.

use crate::math::{Dir, Point, Vec3};
use crate::scene::RenderJob;
use glam::DVec3;

/// An eye in the world of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Where it is [scene units].
    pub point: [f64; 3],
    /// To its right, a unit vector.
    pub right: [f64; 3],
    /// Upwards, a unit vector.
    pub up: [f64; 3],
    /// Along the line of sight, a unit vector.
    pub ahead: [f64; 3],
}

/// How the axes of a scene's world are arranged: which side of someone who looks along z with y upwards x points to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handedness {
    /// To the right, as in pbrt.
    Left,
    /// To the left, as in most other programs; scenes that come from them say so by a mirrored camera.
    Right,
}

/// Why there is no such eye.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EyeError {
    /// A vector has no length, or a number is not finite.
    #[error("the line of sight and the upward direction need a length")]
    NoDirection,
    /// Up is ahead.
    #[error("the upward direction must not lie along the line of sight")]
    Parallel,
}

impl Handedness {
    /// That of a scene's world, by its camera, whose own x is always to the right.
    pub fn of(job: &RenderJob) -> Self {
        let placement = job.scene.camera().placement().start();
        if placement.swaps_handedness() == job.world_from_render.swaps_handedness() {
            Self::Left
        } else {
            Self::Right
        }
    }
}

impl Eye {
    /// An eye at a point, looking along `ahead`, with `up` upwards; the vectors need not have unit length nor be perpendicular.
    ///
    /// # Errors
    /// When they do not define directions.
    pub fn new(
        point: [f64; 3],
        ahead: [f64; 3],
        up: [f64; 3],
        handedness: Handedness,
    ) -> Result<Self, EyeError> {
        let direction = |v: DVec3| v.try_normalize().ok_or(EyeError::NoDirection);
        let ahead = direction(ahead.into())?;
        let up = direction(up.into())?;
        let right = match handedness {
            Handedness::Left => up.cross(ahead),
            Handedness::Right => ahead.cross(up),
        };
        if !DVec3::from(point).is_finite() {
            return Err(EyeError::NoDirection);
        }
        if !(right.length() > 1e-6) {
            return Err(EyeError::Parallel);
        }
        let right = right.normalize();
        let up = match handedness {
            Handedness::Left => ahead.cross(right),
            Handedness::Right => right.cross(ahead),
        };
        Ok(Self { point, right: right.into(), up: up.into(), ahead: ahead.into() })
    }

    /// A direction (right, up, ahead) in the world.
    pub fn to_world(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        (DVec3::from(self.right) * x + DVec3::from(self.up) * y + DVec3::from(self.ahead) * z).into()
    }

    /// The place and a direction (right, up, ahead) in the space in which rays are traced; `None` for a degenerate placement.
    pub(super) fn in_render_space(&self, job: &RenderJob, direction: [f64; 3]) -> Option<(Point, Dir)> {
        let to_render = job.world_from_render.inverse();
        let vec = |v: [f64; 3]| DVec3::from(v).as_vec3();
        let p = to_render.point(Point(vec(self.point)));
        let d: Vec3 = to_render.vector(vec(self.to_world(direction)));
        Some((p, Dir::new(d)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_is_right_in_both_kinds_of_world() {
        let eye = |h| Eye::new([0.0; 3], [0.0, 0.0, 2.0], [0.0, 1.0, 0.5], h).unwrap();
        // Looking along z with y up: x is to the right in pbrt's world, to the left in the other.
        assert_eq!(eye(Handedness::Left).right, [1.0, 0.0, 0.0]);
        assert_eq!(eye(Handedness::Right).right, [-1.0, 0.0, 0.0]);
        for h in [Handedness::Left, Handedness::Right] {
            assert_eq!((eye(h).up, eye(h).ahead), ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
        }
    }

    #[test]
    fn eyes_that_look_nowhere_are_refused() {
        let new = |ahead, up| Eye::new([0.0; 3], ahead, up, Handedness::Left);
        assert_eq!(new([0.0; 3], [0.0, 1.0, 0.0]), Err(EyeError::NoDirection));
        assert_eq!(new([0.0, 1.0, 0.0], [0.0, 2.0, 0.0]), Err(EyeError::Parallel));
        assert!(Eye::new([f64::NAN; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Handedness::Left).is_err());
    }
}
