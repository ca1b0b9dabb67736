//! Relief that is shaded but not built: displacement along the normal, and maps of normals.

use crate::image::{Image, Wrap};
use crate::math::{Footprint, Frame, LocalDir, Normal, Shading, SurfacePoint, Vec2, Vec3};

/// Step in u or v where the footprint is unknown [parameter units].
const DEFAULT_STEP: f32 = 5e-4;

/// The shading geometry of a surface displaced along its normal by `displacement` [scene units], by forward
/// differences over half a footprint (Blinn 1978; pbrt-v4 book, 10.5.3). `None` where it has no normal.
pub(super) fn bump(
    point: &SurfacePoint,
    footprint: &Footprint,
    displacement: impl Fn(&SurfacePoint) -> f32,
) -> Option<Shading> {
    let step = |dx: f32, dy: f32| match 0.5 * (dx.abs() + dy.abs()) {
        d if d > 0.0 => d,
        _ => DEFAULT_STEP,
    };
    let du = step(footprint.duvdx.x, footprint.duvdy.x);
    let dv = step(footprint.duvdx.y, footprint.duvdy.y);
    let shifted = |offset: Vec3, duv: Vec2| {
        let mut p = *point;
        p.p.p = p.p.p + offset;
        p.uv += duv;
        displacement(&p)
    };
    let s = &point.shading;
    let here = displacement(point);
    let along_u = shifted(s.dpdu * du, Vec2::new(du, 0.0));
    let along_v = shifted(s.dpdv * dv, Vec2::new(0.0, dv));
    let dpdu = s.dpdu + s.n * ((along_u - here) / du) + s.dndu * here;
    let dpdv = s.dpdv + s.n * ((along_v - here) / dv) + s.dndv * here;
    perturbed(point, dpdu, dpdv)
}

/// The shading geometry under a map of normals, given in the shading frame as 2 c − 1 (red along ∂p/∂u).
/// `None` where the map has no normal.
pub(super) fn normal_map(point: &SurfacePoint, map: &Image) -> Option<Shading> {
    let st = Vec2::new(point.uv.x, 1.0 - point.uv.y);
    let channel = |c| 2.0 * map.bilerp_channel(st, c, Wrap::REPEAT) - 1.0;
    let local = LocalDir::new(Vec3::new(channel(0), channel(1), channel(2)))?;
    let s = &point.shading;
    let n = *Frame::from_z_x(s.n, s.dpdu).to_world(local);
    let dpdu = (s.dpdu - n * n.dot(s.dpdu)).normalize_or_zero() * s.dpdu.length();
    let dpdv = n.cross(dpdu).normalize_or_zero() * s.dpdv.length();
    perturbed(point, dpdu, dpdv)
}

fn perturbed(point: &SurfacePoint, dpdu: Vec3, dpdv: Vec3) -> Option<Shading> {
    let n = Normal::new(dpdu.cross(dpdv))?.facing(*point.ng);
    Some(Shading { n, dpdu, dpdv, ..point.shading })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Layout;
    use crate::math::{BoundedPoint, Point};

    /// A sphere of radius `r` at (θ, φ) with u = φ, v = θ; outward normal.
    fn sphere(r: f32, theta: f32, phi: f32) -> SurfacePoint {
        let n = crate::math::warp::spherical_direction(theta, phi);
        let dndu = Vec3::new(-n.y, n.x, 0.0);
        let (st, ct) = theta.sin_cos();
        let dndv = Vec3::new(ct * phi.cos(), ct * phi.sin(), -st);
        let normal = Normal::new(n).unwrap();
        SurfacePoint {
            p: BoundedPoint::exact(Point(n * r)),
            ng: normal,
            uv: Vec2::new(phi, theta),
            dpdu: dndu * r,
            dpdv: dndv * r,
            shading: Shading { n: normal, dpdu: dndu * r, dpdv: dndv * r, dndu, dndv },
            time: 0.0,
            face: 0,
        }
    }

    #[test]
    fn bumped_sphere_has_the_normal_of_the_displaced_surface() {
        // r(θ) = 2 + 0.1 sin 3θ: a surface of revolution whose normal is r r̂ − r'(θ) θ̂, normalised.
        let (theta, phi) = (1.1_f32, 0.4);
        let point = sphere(2.0, theta, phi);
        let shading = bump(&point, &Footprint::ZERO, |p| 0.1 * (3.0 * p.uv.y).sin()).unwrap();
        let radius = 2.0 + 0.1 * (3.0 * theta).sin();
        let slope = 0.3 * (3.0 * theta).cos();
        let expected = (*point.ng * radius - point.shading.dndv * slope).normalize();
        // Forward differences err by step · r'' / 2 / r = 2.5e-4 · 0.9 / 2.
        assert!((*shading.n - expected).length() < 3e-4, "{:?} {expected:?}", shading.n);
    }

    #[test]
    fn flat_displacement_leaves_a_sphere_a_sphere() {
        let point = sphere(2.0, 0.8, 2.0);
        let shading = bump(&point, &Footprint::ZERO, |_| 0.5).unwrap();
        assert!((*shading.n - *point.ng).length() < 1e-6);
        // A sphere of radius 2.5: all lengths grow by a quarter.
        assert!((shading.dpdu.length() / point.dpdu.length() - 1.25).abs() < 1e-5);
    }

    #[test]
    fn mapped_normals_tilt_towards_the_tangents_and_v_points_up() {
        let tilt = 0.5_f32;
        // Two rows: the upper tilts along u, the lower along v; 2 c − 1 decodes them.
        let (a, b) = ([tilt.sin(), 0.0, tilt.cos()], [0.0, tilt.sin(), tilt.cos()]);
        let texels = a.iter().chain(&b).map(|x| 0.5 * (x + 1.0)).collect();
        let map = Image::from_f32(1, 2, Layout::Rgb, texels).unwrap();
        let mut point = sphere(1.0, 1.0, 0.7);
        let (t, b) = (point.dpdu.normalize(), point.ng.cross(point.dpdu).normalize());
        for (v, tangent) in [(0.75, t), (0.25, b)] {
            point.uv = Vec2::new(0.5, v);
            let shading = normal_map(&point, &map).unwrap();
            let expected = *point.ng * tilt.cos() + tangent * tilt.sin();
            assert!((*shading.n - expected).length() < 1e-5, "{v}: {:?}", shading.n);
            assert!(shading.dpdu.dot(*shading.n).abs() < 1e-5);
        }
    }
}
