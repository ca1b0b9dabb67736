//! Rays, and points that know how far they may be from the surface they were computed on.

use super::vector::{Dir, Normal, Point, Vec3};

/// A half-line. `d` is not necessarily normalised; parametric distances are in units of |d|.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Origin.
    pub o: Point,
    /// Direction, finite and not zero.
    pub d: Vec3,
    /// Time within the shutter interval [s].
    pub time: f32,
}

impl Ray {
    /// The point at parametric distance `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Point {
        self.o + self.d * t
    }
}

/// A computed point with a conservative bound on its rounding error, per axis.
///
/// Rays that leave a surface start outside this box along the geometric normal, which rules out
/// self-intersection at any scale without an epsilon (Wächter's argument; pbrt-v4 book, 6.8).
#[derive(Clone, Copy, Debug)]
pub struct BoundedPoint {
    /// The computed position.
    pub p: Point,
    /// Bound on |true − computed|, not negative, in scene units.
    pub error: Vec3,
}

impl BoundedPoint {
    /// A point that is exact by definition, such as the position of a point light.
    #[inline]
    pub fn exact(p: Point) -> Self {
        Self { p, error: Vec3::ZERO }
    }

    /// Origin for a ray that leaves towards `w`: moved along `n` to the side of `w`, out of the error box.
    #[inline]
    pub fn offset_origin(&self, n: Normal, w: Vec3) -> Point {
        // The sum below rounds too, by half an ulp of each coordinate: the box grows by twice that.
        let distance = n.abs().dot(self.error + self.p.abs() * f32::EPSILON);
        let distance = if w.dot(*n) < 0.0 { -distance } else { distance };
        self.p + n * distance
    }

    /// Ray that leaves this point in direction `w`.
    #[inline]
    pub fn spawn(&self, n: Normal, w: Dir, time: f32) -> Ray {
        Ray { o: self.offset_origin(n, *w), d: *w, time }
    }

    /// Ray from this point towards `to`, where t = 1 is the target, moved off its own surface.
    ///
    /// `n` and `to_n` are the geometric normals; a target without a surface has `to_n` = `None`.
    #[inline]
    pub fn spawn_to(&self, n: Normal, to: &BoundedPoint, to_n: Option<Normal>, time: f32) -> Ray {
        let o = self.offset_origin(n, to.p - self.p);
        let target = match to_n {
            Some(to_n) => to.offset_origin(to_n, o - to.p),
            None => to.p,
        };
        Ray { o, d: target - o, time }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::{Vec2, warp};

    #[test]
    fn rays_start_beyond_the_plane_through_any_point_of_the_box_of_errors() {
        let mut rng = Pcg32::new(16, 2);
        for case in 0..10_000 {
            let mut unit = || warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let (n, w, p) = (Normal::new_unchecked(unit()), unit(), unit() * 10.0_f32.powi(case % 21 - 10));
            let error = unit().abs() * p.length() * [0.0, 1e-7, 1e-3][case as usize % 3];
            let o = BoundedPoint { p: Point(p), error }.offset_origin(n, w);
            // The corner of the box that lies farthest on the side of the ray.
            let side = f64::from(w.dot(*n)).signum();
            let (n, o) = (n.as_dvec3() * side, o.as_dvec3());
            let corner = p.as_dvec3() + error.as_dvec3() * n.signum();
            assert!((o - corner).dot(n) > 0.0, "{p} {error} {n}: {o}");
        }
    }
}
