//! Sampling single triangles of a mesh, as emitters are.

use super::contract::{ReferencePoint, ShapeSample, ShapeSampleToward, area_density_toward};
use super::mesh::{self, TriangleMesh};
use super::spherical::SphericalTriangle;
use crate::math::{Dir, Normal, Point, SurfacePoint, Vec2, warp};
use crate::units::{PdfArea, PdfSolidAngle};
use glam::DVec3;

/// Solid angles [sr] for which directions are sampled uniformly: below, area sampling is as good and cheaper;
/// above, the reference point nearly touches the triangle. The limits are those of pbrt-v4.
const SPHERICAL_SAMPLING: std::ops::RangeInclusive<f64> = 3e-4..=6.22;

/// Squared ratio of longest edge to distance below which area sampling is as good as well: cosθ/r² then varies by
/// less over the triangle than what the light falls on. Our deviation from pbrt-v4, worth a tenth of a render's time.
const SMALL: f64 = 0.25;

/// Smallest cosine weight of a corner, so that light from a little above the shading horizon keeps a chance.
pub(super) const MIN_CORNER_WEIGHT: f32 = 0.01;

impl TriangleMesh {
    /// Chooses a point uniformly by area; `None` for a triangle without area.
    pub fn sample_area(&self, triangle: u32, u: Vec2) -> Option<ShapeSample> {
        let corners = self.corners(triangle);
        self.sample_area_of(triangle, corners, mesh::cross(corners), u)
    }

    fn sample_area_of(
        &self,
        triangle: u32,
        corners: [Point; 3],
        area_vector: DVec3,
        u: Vec2,
    ) -> Option<ShapeSample> {
        let [_, b1, b2] = warp::uniform_triangle(u);
        let b = [b1, b2];
        Some(ShapeSample {
            p: mesh::blend(corners.map(|p| p.as_dvec3()), b),
            n: self.oriented(area_vector, triangle, b)?,
            uv: self.uv_at(triangle, b),
            density: area_density(area_vector),
        })
    }

    /// Chooses a point by the solid angle at `from`, with the cosine at a shading normal warped in.
    pub fn sample_toward(&self, triangle: u32, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        let corners = self.corners(triangle);
        let area_vector = mesh::cross(corners);
        let Some(seen) = seen_from(corners, area_vector, from) else {
            return self.sample_area_of(triangle, corners, area_vector, u)?.toward(from);
        };
        let (u, warp_pdf) = match from.ns {
            Some(ns) => {
                let w = corner_weights(seen.corners, ns);
                let warped = warp::bilinear(u, w);
                (warped, warp::bilinear_pdf(warped, w))
            }
            None => (u, 1.0),
        };
        let b = seen.sample(u)?.map(|b| b as f32);
        let p = mesh::blend(corners.map(|p| p.as_dvec3()), b);
        let density = PdfSolidAngle(warp_pdf / seen.solid_angle as f32);
        Some(ShapeSampleToward {
            p,
            n: self.oriented(area_vector, triangle, b)?,
            uv: self.uv_at(triangle, b),
            wi: Dir::new(p.p - from.p.p)?,
            density,
        })
    }

    /// Density of [`TriangleMesh::sample_toward`] for the direction `wi`, which meets the triangle at `hit`.
    pub fn pdf_toward(
        &self,
        triangle: u32,
        from: &ReferencePoint,
        wi: Dir,
        hit: &SurfacePoint,
    ) -> PdfSolidAngle {
        let corners = self.corners(triangle);
        let area_vector = mesh::cross(corners);
        let Some(seen) = seen_from(corners, area_vector, from) else {
            return area_density_toward(area_density(area_vector), from, wi, hit);
        };
        let uniform = (1.0 / seen.solid_angle) as f32;
        let Some(ns) = from.ns else { return PdfSolidAngle(uniform) };
        // Normalised in f64: the inversion divides by the area of a sub-triangle.
        let w = wi.as_dvec3().normalize();
        let Some(u) = seen.invert(w) else {
            return PdfSolidAngle(uniform);
        };
        PdfSolidAngle(uniform * warp::bilinear_pdf(u, corner_weights(seen.corners, ns)))
    }
}

/// Density of points uniform over a triangle with that area vector.
fn area_density(area_vector: DVec3) -> PdfArea {
    PdfArea((2.0 / area_vector.length()) as f32)
}

/// The triangle as seen from the reference point if it is to be sampled by solid angle.
#[inline]
fn seen_from(corners: [Point; 3], area_vector: DVec3, from: &ReferencePoint) -> Option<SphericalTriangle> {
    let o = from.p.p.as_dvec3();
    let offsets = corners.map(|p| p.as_dvec3() - o);
    let [a, b, c] = offsets;
    let edge = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let distance = a.length_squared().min(b.length_squared()).min(c.length_squared());
    if area_vector == DVec3::ZERO || edge < SMALL * distance {
        return None;
    }
    SphericalTriangle::new(offsets).filter(|s| SPHERICAL_SAMPLING.contains(&s.solid_angle))
}

/// Cosines to the shading normal at the corners of the sample square: u.x = 0 is the edge v₀v₁ and u.y = 0 the
/// corner v₁, so that the square's lower side is one point.
fn corner_weights(corners: [DVec3; 3], ns: Normal) -> [f32; 4] {
    let weight = |d: DVec3| (d.as_vec3().dot(*ns)).abs().max(MIN_CORNER_WEIGHT);
    let [w0, w1, w2] = corners.map(weight);
    [w1, w1, w0, w2]
}
