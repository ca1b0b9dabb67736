//! Orthonormal frames: from world to the local shading frame and back.

use super::vector::{Dir, LocalDir, Normal, Vec3};

/// A right-handed orthonormal basis; `n` becomes the local z axis.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// First tangent, local x.
    pub s: Vec3,
    /// Second tangent, local y.
    pub t: Vec3,
    /// Normal, local z.
    pub n: Vec3,
}

impl Frame {
    /// A frame around `n` with arbitrary tangents, continuous but for z = 0 (Duff et al. 2017, listing 3).
    #[inline]
    pub fn from_z(n: impl Into<Vec3>) -> Self {
        let n: Vec3 = n.into();
        let sign = 1.0_f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            s: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// A frame around `n` whose x axis is `x` made orthogonal to it (Gram–Schmidt); when `x` is parallel
    /// to `n` or not finite, the tangents are those of [`Frame::from_z`].
    #[inline]
    pub fn from_z_x(n: Normal, x: Vec3) -> Self {
        let n_vec: Vec3 = n.into();
        let orthogonal = |x: Vec3| x - n_vec * n_vec.dot(x);
        let mut s = orthogonal(x);
        if s.length_squared() < 1e-3 * x.length_squared() {
            // The difference of nearly parallel vectors has lost its digits.
            s = Dir::new(s).map_or(s, |s| orthogonal(*s));
        }
        match Dir::new(s) {
            Some(s) => Self { s: *s, t: n_vec.cross(*s), n: n_vec },
            None => Self::from_z(n),
        }
    }

    /// World to local.
    #[inline]
    pub fn to_local(&self, v: Dir) -> LocalDir {
        LocalDir::new_unchecked(Vec3::new(v.dot(self.s), v.dot(self.t), v.dot(self.n)))
    }

    /// Local to world.
    #[inline]
    pub fn to_world(&self, v: LocalDir) -> Dir {
        Dir::new_unchecked(self.s * v.x + self.t * v.y + self.n * v.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_axis_nearly_along_the_normal_still_gives_an_orthonormal_frame() {
        let n = Normal::new(Vec3::new(0.3, -0.4, 0.8)).unwrap();
        for tilt in [1e-1, 1e-3, 1e-5, 1e-6, 1e-7] {
            let f = Frame::from_z_x(n, *n * 3.0 + Vec3::new(tilt, 0.0, 0.0));
            assert!(f.s.dot(f.n).abs() < 1e-6 && f.s.dot(f.t).abs() < 1e-6, "{tilt}");
            assert!((f.s.length() - 1.0).abs() < 1e-6 && (f.t.length() - 1.0).abs() < 1e-6, "{tilt}");
        }
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_invertible(x in -1.0f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0) {
            prop_assume!(Vec3::new(x, y, z).length() > 1e-3);
            let n = Normal::new(Vec3::new(x, y, z)).unwrap();
            for f in [Frame::from_z(n), Frame::from_z_x(n, Vec3::new(1.0, 2.0, -0.5))] {
                prop_assert!(f.s.dot(f.t).abs() < 1e-5 && f.s.dot(f.n).abs() < 1e-5);
                prop_assert!((f.s.cross(f.t) - f.n).length() < 1e-5);
                let d = Dir::new(Vec3::new(0.3, -0.5, 0.7)).unwrap();
                prop_assert!((*f.to_world(f.to_local(d)) - *d).length() < 1e-5);
            }
        }
    }
}
