//! The differential geometry of a surface at one point: what textures, materials and lights are evaluated at.

use super::ray::BoundedPoint;
use super::vector::{Normal, Vec2, Vec3};

/// A point of a surface with its parametrisation and its shading geometry, in render space.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position with its rounding bound.
    pub p: BoundedPoint,
    /// Geometric normal; points to the outside as orientation and handedness define it.
    pub ng: Normal,
    /// Surface parameters.
    pub uv: Vec2,
    /// ∂p/∂u of the geometric surface.
    pub dpdu: Vec3,
    /// ∂p/∂v of the geometric surface.
    pub dpdv: Vec3,
    /// Shading geometry: interpolated or perturbed.
    pub shading: Shading,
    /// Time [s].
    pub time: f32,
    /// Face index of the mesh element, for per-face data; zero elsewhere.
    pub face: u32,
}

/// The frame in which scattering is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Shading {
    /// Shading normal, in the hemisphere of the geometric normal.
    pub n: Normal,
    /// ∂p/∂u of the shading surface.
    pub dpdu: Vec3,
    /// ∂p/∂v of the shading surface.
    pub dpdv: Vec3,
    /// ∂n/∂u.
    pub dndu: Vec3,
    /// ∂n/∂v.
    pub dndv: Vec3,
}

/// How a surface point moves when the picture position moves by one pixel: the texture footprint.
#[derive(Clone, Copy, Debug, Default)]
pub struct Footprint {
    /// ∂p/∂x per pixel [scene units].
    pub dpdx: Vec3,
    /// ∂p/∂y per pixel [scene units].
    pub dpdy: Vec3,
    /// ∂(u, v)/∂x per pixel.
    pub duvdx: Vec2,
    /// ∂(u, v)/∂y per pixel.
    pub duvdy: Vec2,
}

impl Footprint {
    /// No extent: textures are looked up at their finest level.
    pub const ZERO: Self = Self { dpdx: Vec3::ZERO, dpdy: Vec3::ZERO, duvdx: Vec2::ZERO, duvdy: Vec2::ZERO };

    /// The footprint on a surface from the motion of its point, by least squares in the tangent plane
    /// (pbrt-v4 book, 10.1.1). Derivatives that do not exist become zero.
    pub fn project(dpdx: Vec3, dpdy: Vec3, dpdu: Vec3, dpdv: Vec3) -> Self {
        use super::float::difference_of_products as dop;
        let (uu, uv, vv) = (dpdu.dot(dpdu), dpdu.dot(dpdv), dpdv.dot(dpdv));
        let inv = 1.0 / dop(uu, vv, uv, uv);
        let inv = if inv.is_finite() { inv } else { 0.0 };
        let solve = |d: Vec3| {
            let (a, b) = (dpdu.dot(d), dpdv.dot(d));
            let limit = |x: f32| if x.is_finite() { x.clamp(-1e8, 1e8) } else { 0.0 };
            Vec2::new(limit(dop(vv, a, uv, b) * inv), limit(dop(uu, b, uv, a) * inv))
        };
        Self { dpdx, dpdy, duvdx: solve(dpdx), duvdy: solve(dpdy) }
    }
}
