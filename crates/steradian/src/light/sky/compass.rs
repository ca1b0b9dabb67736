//! Directions of the compass in a scene.

use crate::math::{Dir, Vec3};

/// On which side the picture shows +x when it shows +z ahead and +y above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handedness {
    /// On the right, as pbrt's cameras have it.
    Left,
    /// On the left: scenes that mirror their camera, which is how most modellers count.
    Right,
}

/// Up, north and east of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Compass {
    up: Dir,
    north: Vec3,
    east: Vec3,
}

impl Compass {
    /// The compass of which `azimuth` [°, from north through east] is the horizontal direction nearest to `reference`. East is
    /// to the right of who looks north in the picture, whence the handedness. `None` where `reference` is parallel to `up`.
    pub fn new(up: Dir, reference: Vec3, azimuth: f32, handedness: Handedness) -> Option<Self> {
        let ahead = *Dir::new(reference - *up * up.dot(reference))?;
        let right = match handedness {
            Handedness::Left => up.cross(ahead),
            Handedness::Right => ahead.cross(*up),
        };
        let (sin, cos) = azimuth.to_radians().sin_cos();
        Some(Self { up, north: ahead * cos - right * sin, east: ahead * sin + right * cos })
    }

    /// To the zenith.
    pub fn up(&self) -> Dir {
        self.up
    }

    /// The direction at an elevation and azimuth [°].
    pub fn direction(&self, elevation: f64, azimuth: f64) -> Dir {
        let (sin_e, cos_e) = elevation.to_radians().sin_cos();
        let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
        let level = self.north.as_dvec3() * cos_a + self.east.as_dvec3() * sin_a;
        let d = self.up.as_dvec3() * sin_e + level * cos_e;
        Dir::new_unchecked(d.normalize().as_vec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Point, Transform};

    fn close(a: Dir, b: Vec3) -> bool {
        (*a - b).length() < 1e-6
    }

    #[test]
    fn north_is_ahead_and_east_to_the_right_as_a_camera_shows_it() {
        let compass = Compass::new(Dir::Z, Vec3::new(0.0, 2.0, 5.0), 0.0, Handedness::Right).unwrap();
        assert!(close(compass.direction(0.0, 0.0), Vec3::Y) && close(compass.direction(0.0, 90.0), Vec3::X));
        assert!(
            close(compass.direction(90.0, 12.0), Vec3::Z) && close(compass.direction(0.0, 180.0), -Vec3::Y)
        );
        // pbrt's camera that looks along z with y up has x on its right.
        let up = Dir::new(Vec3::Y).unwrap();
        let compass = Compass::new(up, Vec3::Z, 0.0, Handedness::Left).unwrap();
        let east = compass.direction(0.0, 90.0);
        let camera = Transform::look_at(Point::ORIGIN, Point(Vec3::Z), Vec3::Y).unwrap();
        assert!(close(east, Vec3::X) && camera.vector(*east).x > 0.99);
        assert!(!camera.swaps_handedness());
    }

    #[test]
    fn the_reference_may_point_to_any_azimuth() {
        // A house whose +y looks east: north is to the left of +y.
        let compass = Compass::new(Dir::Z, Vec3::Y, 90.0, Handedness::Right).unwrap();
        assert!(close(compass.direction(0.0, 90.0), Vec3::Y) && close(compass.direction(0.0, 0.0), -Vec3::X));
        assert!(Compass::new(Dir::Z, Vec3::Z, 0.0, Handedness::Left).is_none());
    }
}
