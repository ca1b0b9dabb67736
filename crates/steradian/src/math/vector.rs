//! Points, unit directions and normals as distinct types over one storage.

use std::ops::{Add, Deref, Mul, Neg, Sub};

pub use glam::{Vec2, Vec3};

/// A position in world space; lengths are scene units.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct Point(pub Vec3);

/// A unit vector in world space, pointing *away* from the surface it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Dir(Vec3);

/// A unit surface normal in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Normal(Vec3);

/// A unit vector in the local shading frame, in which z is the shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct LocalDir(Vec3);

impl Point {
    /// The origin.
    pub const ORIGIN: Self = Self(Vec3::ZERO);

    /// A point from its coordinates.
    #[inline]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self(Vec3::new(x, y, z))
    }

    /// Squared distance to `other`.
    #[inline]
    pub fn distance_squared(self, other: Self) -> f32 {
        self.0.distance_squared(other.0)
    }
}

impl Deref for Point {
    type Target = Vec3;
    #[inline]
    fn deref(&self) -> &Vec3 {
        &self.0
    }
}

impl Sub for Point {
    type Output = Vec3;
    #[inline]
    fn sub(self, rhs: Self) -> Vec3 {
        self.0 - rhs.0
    }
}

impl Add<Vec3> for Point {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Vec3) -> Self {
        Self(self.0 + rhs)
    }
}

impl Sub<Vec3> for Point {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Vec3) -> Self {
        Self(self.0 - rhs)
    }
}

/// The operations that every unit-vector type shares.
macro_rules! unit_vector {
    ($T:ident) => {
        impl $T {
            /// The +z axis.
            pub const Z: Self = Self(Vec3::Z);

            /// Normalises `v`; `None` when its length is zero, infinite or NaN.
            #[inline]
            pub fn new(v: Vec3) -> Option<Self> {
                let squared = v.length_squared();
                // Well inside the range of f32, where no square has lost digits. False for NaN.
                if (1e-24..1e24).contains(&squared) {
                    return Some(Self(v * (1.0 / squared.sqrt())));
                }
                Self::rescaled(v)
            }

            /// Scaling by the largest component first keeps tiny and huge vectors in range.
            #[cold]
            fn rescaled(v: Vec3) -> Option<Self> {
                let scale = v.abs().max_element();
                if !(scale > 0.0 && v.is_finite()) {
                    return None;
                }
                let v = v / scale;
                Some(Self(v / v.length()))
            }

            /// Wraps a vector that is a unit vector already (checked in debug builds to 0.1 %).
            #[inline]
            pub fn new_unchecked(v: Vec3) -> Self {
                debug_assert!((v.length_squared() - 1.0).abs() < 2e-3, "not a unit vector: {v:?}");
                Self(v)
            }

            /// Cosine of the angle to `other`, which must be a unit vector.
            #[inline]
            pub fn cos_to(self, other: impl Into<Vec3>) -> f32 {
                self.0.dot(other.into())
            }
        }

        impl Deref for $T {
            type Target = Vec3;
            #[inline]
            fn deref(&self) -> &Vec3 {
                &self.0
            }
        }

        impl From<$T> for Vec3 {
            #[inline]
            fn from(v: $T) -> Vec3 {
                v.0
            }
        }

        impl Neg for $T {
            type Output = Self;
            #[inline]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl Mul<f32> for $T {
            type Output = Vec3;
            #[inline]
            fn mul(self, rhs: f32) -> Vec3 {
                self.0 * rhs
            }
        }
    };
}

unit_vector!(Dir);
unit_vector!(Normal);
unit_vector!(LocalDir);

impl From<Normal> for Dir {
    #[inline]
    fn from(n: Normal) -> Self {
        Self(n.0)
    }
}

impl Normal {
    /// This normal or its opposite, whichever lies in the hemisphere of `v`.
    #[must_use]
    #[inline]
    pub fn facing(self, v: Vec3) -> Self {
        if self.0.dot(v) < 0.0 { -self } else { self }
    }
}

impl LocalDir {
    /// Cosine of the polar angle, signed: negative under the surface.
    #[inline]
    pub fn cos_theta(self) -> f32 {
        self.0.z
    }

    /// |cos θ|.
    #[inline]
    pub fn abs_cos_theta(self) -> f32 {
        self.0.z.abs()
    }

    /// cos² θ.
    #[inline]
    pub fn cos2_theta(self) -> f32 {
        self.0.z * self.0.z
    }

    /// sin² θ, not below zero.
    #[inline]
    pub fn sin2_theta(self) -> f32 {
        (1.0 - self.cos2_theta()).max(0.0)
    }

    /// Whether both directions lie strictly on the same side of the surface.
    #[inline]
    pub fn same_hemisphere(self, other: Self) -> bool {
        self.0.z * other.0.z > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_without_length_is_refused() {
        assert!(Dir::new(Vec3::ZERO).is_none());
        assert!(Dir::new(Vec3::new(f32::NAN, 0.0, 1.0)).is_none());
        assert!(Dir::new(Vec3::splat(f32::INFINITY)).is_none());
    }

    #[test]
    fn tiny_and_huge_vectors_normalise() {
        for scale in [1e-38_f32, 1e-20, 1.0, 1e20, 3e38] {
            let d = Dir::new(Vec3::new(0.6, 0.0, 0.8) * scale).unwrap();
            assert!((d.x - 0.6).abs() < 1e-6 && (d.z - 0.8).abs() < 1e-6, "{scale}: {d:?}");
        }
    }
}
