//! Surface points for tests: the plane z = const with (u, v) along x and y.

use crate::math::{BoundedPoint, Footprint, Normal, Point, Shading, SurfacePoint, Vec2, Vec3};

/// A point of the plane.
pub(super) fn surface_point(p: Point, uv: Vec2) -> SurfacePoint {
    let shading = Shading { n: Normal::Z, dpdu: Vec3::X, dpdv: Vec3::Y, dndu: Vec3::ZERO, dndv: Vec3::ZERO };
    SurfacePoint {
        p: BoundedPoint::exact(p),
        ng: Normal::Z,
        uv,
        dpdu: Vec3::X,
        dpdv: Vec3::Y,
        shading,
        time: 0.0,
        face: 0,
    }
}

/// A square footprint of this width in (u, v) and in space.
pub(super) fn footprint(width: f32) -> Footprint {
    Footprint { dpdx: Vec3::X * width, dpdy: Vec3::Y * width, duvdx: Vec2::X * width, duvdy: Vec2::Y * width }
}
