//! How a surface point becomes a place in a texture.

use super::input::TextureContext;
use crate::math::{Point, Transform, Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// A point of a two-dimensional texture with its motion per pixel.
#[derive(Clone, Copy, Debug)]
pub struct TexCoord2d {
    /// (s, t).
    pub st: Vec2,
    /// ∂(s, t)/∂x per pixel.
    pub dstdx: Vec2,
    /// ∂(s, t)/∂y per pixel.
    pub dstdy: Vec2,
}

/// A point of a three-dimensional texture with its motion per pixel, in texture space.
#[derive(Clone, Copy, Debug)]
pub struct TexCoord3d {
    /// Position.
    pub p: Vec3,
    /// ∂p/∂x per pixel.
    pub dpdx: Vec3,
    /// ∂p/∂y per pixel.
    pub dpdy: Vec3,
}

/// A map of surface points to two texture coordinates (pbrt-v4 book, 10.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping2d {
    /// (s, t) = scale · (u, v) + delta.
    Uv {
        /// Factors on u and v.
        scale: Vec2,
        /// Offsets.
        delta: Vec2,
    },
    /// (s, t) = (θ/π, φ/2π) of the texture-space point, θ from +z, φ from +x, in [0, 1].
    Spherical {
        /// Render space to texture space.
        texture_from_render: Transform,
    },
    /// (s, t) = (1/2 + φ/2π with φ in [−π, π] from +x, z) of the texture-space point.
    Cylindrical {
        /// Render space to texture space.
        texture_from_render: Transform,
    },
    /// (s, t) = (p · v1, p · v2) + delta of the texture-space point p.
    Planar {
        /// Render space to texture space.
        texture_from_render: Transform,
        /// Axis of s.
        v1: Vec3,
        /// Axis of t.
        v2: Vec3,
        /// Offsets.
        delta: Vec2,
    },
}

impl Mapping2d {
    /// (s, t) = (u, v).
    pub const UV: Self = Self::Uv { scale: Vec2::ONE, delta: Vec2::ZERO };

    /// The texture coordinates of a surface point.
    pub fn map(&self, at: &TextureContext) -> TexCoord2d {
        match self {
            Self::Uv { scale, delta } => TexCoord2d {
                st: *scale * at.point.uv + *delta,
                dstdx: *scale * at.footprint.duvdx,
                dstdy: *scale * at.footprint.duvdy,
            },
            Self::Spherical { texture_from_render } => spherical(&map_3d(texture_from_render, at)),
            Self::Cylindrical { texture_from_render } => cylindrical(&map_3d(texture_from_render, at)),
            Self::Planar { texture_from_render, v1, v2, delta } => {
                let c = map_3d(texture_from_render, at);
                let project = |v: Vec3| Vec2::new(v1.dot(v), v2.dot(v));
                TexCoord2d { st: project(c.p) + *delta, dstdx: project(c.dpdx), dstdy: project(c.dpdy) }
            }
        }
    }
}

/// A map of surface points to three texture coordinates: the point itself in texture space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapping3d {
    /// Render space to texture space.
    pub texture_from_render: Transform,
}

impl Mapping3d {
    /// The texture coordinates of a surface point.
    pub fn map(&self, at: &TextureContext) -> TexCoord3d {
        map_3d(&self.texture_from_render, at)
    }
}

fn map_3d(texture_from_render: &Transform, at: &TextureContext) -> TexCoord3d {
    let Point(p) = texture_from_render.point(at.point.p.p);
    TexCoord3d {
        p,
        dpdx: texture_from_render.vector(at.footprint.dpdx),
        dpdy: texture_from_render.vector(at.footprint.dpdy),
    }
}

/// θ and φ have no derivative on the axis: the footprint there is taken as zero.
fn spherical(c: &TexCoord3d) -> TexCoord2d {
    let p = c.p;
    let rho2 = p.x * p.x + p.y * p.y;
    let rho = rho2.sqrt();
    let r2 = rho2 + p.z * p.z;
    let theta = rho.atan2(p.z);
    let phi = p.y.atan2(p.x);
    let dtheta = Vec3::new(p.x * p.z / rho, p.y * p.z / rho, -rho) / r2;
    let dphi = Vec3::new(-p.y, p.x, 0.0) / rho2;
    let differential = |d: Vec3| finite(Vec2::new(dtheta.dot(d) * FRAC_1_PI, dphi.dot(d) / TAU));
    TexCoord2d {
        st: Vec2::new(theta * FRAC_1_PI, if phi < 0.0 { phi + TAU } else { phi } / TAU),
        dstdx: differential(c.dpdx),
        dstdy: differential(c.dpdy),
    }
}

fn cylindrical(c: &TexCoord3d) -> TexCoord2d {
    let p = c.p;
    let dphi = Vec3::new(-p.y, p.x, 0.0) / (p.x * p.x + p.y * p.y);
    let differential = |d: Vec3| finite(Vec2::new(dphi.dot(d) / TAU, d.z));
    TexCoord2d {
        st: Vec2::new((PI + p.y.atan2(p.x)) / TAU, p.z),
        dstdx: differential(c.dpdx),
        dstdy: differential(c.dpdy),
    }
}

fn finite(v: Vec2) -> Vec2 {
    if v.is_finite() { v } else { Vec2::ZERO }
}

#[cfg(test)]
mod tests {
    use super::super::specimen;
    use super::*;
    use crate::math::{Footprint, warp};
    use proptest::prelude::*;

    fn at(mapping: Mapping2d, p: Vec3, dpdx: Vec3) -> TexCoord2d {
        let point = specimen::surface_point(Point(p), Vec2::new(0.25, 0.75));
        let footprint = Footprint { dpdx, ..specimen::footprint(0.1) };
        mapping.map(&TextureContext { point: &point, footprint: &footprint })
    }

    #[test]
    fn uv_scales_point_and_footprint() {
        let mapping = Mapping2d::Uv { scale: Vec2::new(4.0, -2.0), delta: Vec2::new(0.5, 1.0) };
        let c = at(mapping, Vec3::ZERO, Vec3::ZERO);
        assert_eq!(c.st, Vec2::new(1.5, -0.5));
        assert_eq!((c.dstdx, c.dstdy), (Vec2::new(0.4, 0.0), Vec2::new(0.0, -0.2)));
    }

    proptest! {
        /// Each mapping can be undone from its definition, and its differentials are its slope.
        #[test]
        fn spatial_mappings_invert_and_their_differentials_are_their_slopes(
            x in -3.0_f32..3.0, y in -3.0_f32..3.0, z in -3.0_f32..3.0,
            dx in -1.0_f32..1.0, dy in -1.0_f32..1.0, dz in -1.0_f32..1.0,
        ) {
            prop_assume!(x * x + y * y > 0.1);
            let texture_from_render = Transform::rotate(40.0, Vec3::new(1.0, 2.0, 3.0)).unwrap()
                * Transform::translate(Vec3::new(0.5, -1.0, 2.0));
            let local = Vec3::new(x, y, z);
            let render = texture_from_render.inverse().point(Point(local)).0;
            let d = Vec3::new(dx, dy, dz);
            let d_render = texture_from_render.inverse().vector(d);

            let spherical = Mapping2d::Spherical { texture_from_render };
            let c = at(spherical, render, d_render);
            let back = warp::spherical_direction(c.st.x * PI, c.st.y * TAU) * local.length();
            prop_assert!((back - local).length() < 1e-4, "{back} {local}");

            let cylindrical = Mapping2d::Cylindrical { texture_from_render };
            let k = at(cylindrical, render, d_render);
            let phi = k.st.x * TAU - PI;
            let back = Vec3::new(phi.cos() * x.hypot(y), phi.sin() * x.hypot(y), k.st.y);
            prop_assert!((back - local).length() < 1e-4, "{back} {local}");

            let h = 1e-3;
            for (mapping, c) in [(spherical, c), (cylindrical, k)] {
                let moved = |s: f32| {
                    let p = texture_from_render.inverse().point(Point(local + d * s)).0;
                    at(mapping, p, Vec3::ZERO).st
                };
                let slope = (moved(h) - moved(-h)) / (2.0 * h);
                // Across the seam the coordinate jumps by one.
                prop_assume!(slope.abs().max_element() < 100.0);
                prop_assert!((slope - c.dstdx).length() < 5e-3, "{mapping:?} {slope} {}", c.dstdx);
            }
        }
    }

    #[test]
    fn planar_reads_the_coordinates_along_its_axes() {
        let mapping = Mapping2d::Planar {
            texture_from_render: Transform::translate(Vec3::X),
            v1: Vec3::new(0.0, 2.0, 0.0),
            v2: Vec3::X,
            delta: Vec2::new(0.0, 0.5),
        };
        let c = at(mapping, Vec3::new(3.0, 4.0, 5.0), Vec3::new(0.1, 0.2, 0.3));
        assert!((c.st - Vec2::new(8.0, 4.5)).length() < 1e-5);
        assert!((c.dstdx - Vec2::new(0.4, 0.1)).length() < 1e-6);
    }

    #[test]
    fn the_axis_has_no_footprint_instead_of_nan() {
        let texture_from_render = Transform::IDENTITY;
        for mapping in
            [Mapping2d::Spherical { texture_from_render }, Mapping2d::Cylindrical { texture_from_render }]
        {
            let c = at(mapping, Vec3::Z, Vec3::X);
            assert!(c.st.is_finite() && c.dstdx == Vec2::ZERO, "{mapping:?} {c:?}");
        }
    }
}
