//! Affine and projective transforms that carry their inverse.

use super::bounds::Bounds3;
use super::ray::{BoundedPoint, Ray};
use super::vector::{Dir, Normal, Point, Vec3};
use glam::{DMat4, Mat4, Vec4};
use std::ops::Mul;

/// A 4×4 transform with its inverse. Named `target_from_source` in code.
///
/// The inverse is computed once in f64; composition multiplies in f64 as well, so that long chains of
/// scene-file transforms do not drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    m: Mat4,
    inverse: Mat4,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { m: Mat4::IDENTITY, inverse: Mat4::IDENTITY };

    /// A transform from its matrix (column vectors: p' = M p); `None` when the matrix is singular or not finite.
    pub fn from_matrix(m: Mat4) -> Option<Self> {
        Self::from_matrix_f64(m.as_dmat4())
    }

    fn from_matrix_f64(m: DMat4) -> Option<Self> {
        if !m.is_finite() {
            return None;
        }
        let inverse = m.inverse();
        let pair = Self { m: m.as_mat4(), inverse: inverse.as_mat4() };
        (m.determinant() != 0.0 && pair.inverse.is_finite()).then_some(pair)
    }

    /// Translation by `v`.
    pub fn translate(v: Vec3) -> Self {
        Self { m: Mat4::from_translation(v), inverse: Mat4::from_translation(-v) }
    }

    /// Scaling along the axes; `None` when a factor is zero or not finite.
    pub fn scale(v: Vec3) -> Option<Self> {
        Self::from_matrix(Mat4::from_scale(v))
    }

    /// Rotation by `degrees` about `axis`, counter-clockwise seen from its tip; `None` for a zero axis.
    pub fn rotate(degrees: f32, axis: Vec3) -> Option<Self> {
        let axis = Dir::new(axis)?;
        let m = DMat4::from_axis_angle(axis.as_dvec3().normalize(), f64::from(degrees).to_radians());
        Some(Self { m: m.as_mat4(), inverse: m.transpose().as_mat4() })
    }

    /// `camera_from_world` for a camera at `eye` that looks at `target`, left-handed as in pbrt
    /// (x right, y up, z forward); `None` when the view direction is zero or parallel to `up`.
    pub fn look_at(eye: Point, target: Point, up: Vec3) -> Option<Self> {
        let forward = Dir::new(target - eye)?.as_dvec3();
        let right = Dir::new(up)?.as_dvec3().cross(forward);
        if right.length() < 1e-6 {
            return None;
        }
        let right = right.normalize();
        let new_up = forward.cross(right);
        let world_from_camera = DMat4::from_cols(
            right.extend(0.0),
            new_up.extend(0.0),
            forward.extend(0.0),
            eye.as_dvec3().extend(1.0),
        );
        Self::from_matrix_f64(world_from_camera).map(|t| t.inverse())
    }

    /// Perspective projection with field of view `fov` degrees onto the z = 1 plane, near and far planes
    /// mapped to z = 0 and 1; `None` unless 0 < fov < 180 and 0 < near < far.
    pub fn perspective(fov: f32, near: f32, far: f32) -> Option<Self> {
        if !(fov > 0.0 && fov < 180.0 && near > 0.0 && far > near) {
            return None;
        }
        let (n, f) = (f64::from(near), f64::from(far));
        let s = 1.0 / (f64::from(fov).to_radians() * 0.5).tan();
        let m = DMat4::from_cols_array(&[
            s,
            0.0,
            0.0,
            0.0, //
            0.0,
            s,
            0.0,
            0.0, //
            0.0,
            0.0,
            f / (f - n),
            1.0, //
            0.0,
            0.0,
            -f * n / (f - n),
            0.0,
        ]);
        Self::from_matrix_f64(m)
    }

    /// The inverse transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { m: self.inverse, inverse: self.m }
    }

    /// The matrix.
    pub fn matrix(&self) -> &Mat4 {
        &self.m
    }

    /// The inverse matrix.
    pub fn inverse_matrix(&self) -> &Mat4 {
        &self.inverse
    }

    /// Whether this is exactly the identity.
    pub fn is_identity(&self) -> bool {
        self.m == Mat4::IDENTITY
    }

    /// Whether the transform mirrors: right-handed frames become left-handed.
    pub fn swaps_handedness(&self) -> bool {
        glam::Mat3::from_mat4(self.m).determinant() < 0.0
    }

    /// Applies to a point, with the homogeneous division where the transform is projective.
    #[inline]
    pub fn point(&self, p: Point) -> Point {
        transformed(&self.m, p)
    }

    /// [`Transform::point`] of the inverse.
    #[inline]
    pub fn point_back(&self, p: Point) -> Point {
        transformed(&self.inverse, p)
    }

    /// Applies to a vector (translation does not act).
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.m.transform_vector3(v)
    }

    /// Applies to a direction and normalises; `None` only when the transform flattens it to nothing.
    pub fn direction(&self, d: Dir) -> Option<Dir> {
        Dir::new(self.vector(*d))
    }

    /// Applies to a normal (inverse transpose), not normalised.
    #[inline]
    pub fn normal_vector(&self, n: Vec3) -> Vec3 {
        products(&self.inverse, n)
    }

    /// [`Transform::normal_vector`] of the inverse.
    #[inline]
    pub fn normal_vector_back(&self, n: Vec3) -> Vec3 {
        products(&self.m, n)
    }

    /// Applies to a normal and normalises; `None` when the result has no length.
    pub fn normal(&self, n: Normal) -> Option<Normal> {
        Normal::new(self.normal_vector(*n))
    }

    /// Applies to a ray; parametric distances are preserved.
    pub fn ray(&self, r: &Ray) -> Ray {
        Ray { o: self.point(r.o), d: self.vector(r.d), time: r.time }
    }

    /// Applies to a point with error bounds: the old bound is carried over, the new rounding added.
    pub fn bounded_point(&self, b: &BoundedPoint) -> BoundedPoint {
        let abs = |c: Vec4| c.truncate().abs();
        let (x, y, z, w) = (abs(self.m.x_axis), abs(self.m.y_axis), abs(self.m.z_axis), abs(self.m.w_axis));
        let p = b.p.abs();
        let magnitude = x * p.x + y * p.y + z * p.z + w;
        let carried = x * b.error.x + y * b.error.y + z * b.error.z;
        let g3 = super::float::gamma(3);
        BoundedPoint { p: self.point(b.p), error: carried * (g3 + 1.0) + magnitude * g3 }
    }

    /// Smallest axis-aligned box around the transformed box.
    pub fn bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() {
            return *b;
        }
        Bounds3::from_points(b.corners().map(|c| self.point(c)))
    }
}

impl Mul for Transform {
    type Output = Self;
    /// `a * b` applies `b` first.
    fn mul(self, rhs: Self) -> Self {
        Self {
            m: (self.m.as_dmat4() * rhs.m.as_dmat4()).as_mat4(),
            inverse: (rhs.inverse.as_dmat4() * self.inverse.as_dmat4()).as_mat4(),
        }
    }
}

#[inline]
fn transformed(m: &Mat4, p: Point) -> Point {
    let h: Vec4 = *m * p.0.extend(1.0);
    if h.w == 1.0 { Point(h.truncate()) } else { Point(h.truncate() / h.w) }
}

/// The products of `n` with the first three columns: the transposed matrix applied to it.
#[inline]
fn products(m: &Mat4, n: Vec3) -> Vec3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate().dot(n));
    Vec3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_matrices_are_refused() {
        assert!(Transform::scale(Vec3::new(1.0, 0.0, 1.0)).is_none());
        assert!(Transform::from_matrix(Mat4::from_cols_array(&[f32::NAN; 16])).is_none());
        assert!(Transform::rotate(30.0, Vec3::ZERO).is_none());
        assert!(Transform::look_at(Point::ORIGIN, Point::ORIGIN, Vec3::Y).is_none());
        assert!(Transform::look_at(Point::ORIGIN, Point::new(0.0, 1.0, 0.0), Vec3::Y).is_none());
    }

    #[test]
    fn look_at_puts_the_target_on_the_positive_z_axis() {
        let t = Transform::look_at(Point::new(1.0, 2.0, 3.0), Point::new(4.0, 6.0, 3.0), Vec3::Z).unwrap();
        let p = t.point(Point::new(4.0, 6.0, 3.0));
        assert!((*p - Vec3::new(0.0, 0.0, 5.0)).length() < 1e-5, "{p:?}");
        let eye = t.point(Point::new(1.0, 2.0, 3.0));
        assert!(eye.length() < 1e-5);
    }

    #[test]
    fn normals_stay_perpendicular_under_uneven_scaling() {
        let t =
            Transform::scale(Vec3::new(3.0, 0.5, 1.0)).unwrap() * Transform::rotate(33.0, Vec3::ONE).unwrap();
        let n = Normal::new(Vec3::new(1.0, 2.0, 3.0)).unwrap();
        let tangent = Vec3::new(2.0, -1.0, 0.0);
        assert!(t.normal(n).unwrap().dot(t.vector(tangent)).abs() < 1e-5);
    }

    #[test]
    fn transformed_points_are_within_their_error() {
        let mut rng = crate::math::hash::Pcg32::new(17, 4);
        for case in 0..10_000 {
            let mut place = || Vec3::from_array([0; 3].map(|_| rng.next_f32() - 0.5));
            let t = Transform::translate(place() * [0.0, 1.0, 1e4][case % 3])
                * Transform::rotate(360.0 * place().x, place()).unwrap()
                * Transform::scale(place().abs() + 0.1).unwrap();
            let (p, error) = (place(), place().abs() * [0.0, 1e-6][case % 2]);
            let b = t.bounded_point(&BoundedPoint { p: Point(p), error });
            // Where the true point may be, at the corner of its box that goes farthest along each axis.
            let m = t.matrix().as_dmat4();
            for axis in 0..3 {
                let row = m.row(axis).truncate();
                let p = row.dot(p.as_dvec3() + error.as_dvec3() * row.signum()) + m.w_axis[axis];
                let lost = (p - f64::from(b.p[axis])).abs();
                assert!(lost <= f64::from(b.error[axis]), "{lost} {}", b.error);
            }
        }
    }
}
