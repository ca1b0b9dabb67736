//! Sampling single triangles of a mesh, as emitters are.

use super::contract::{ReferencePoint, ShapeSample, ShapeSampleToward, area_density_toward};
use super::mesh::{Facet, TriangleMesh};
use super::rounding;
use super::spherical::SphericalTriangle;
use crate::math::{Dir, Normal, Point, SurfacePoint, Vec2, Vec3, warp};
use crate::units::{PdfArea, PdfSolidAngle};

/// Solid angles [sr] for which directions are sampled uniformly: below, area sampling is as good and cheaper;
/// above, the reference point nearly touches the triangle.
const SPHERICAL_SAMPLING: std::ops::RangeInclusive<f32> = 1e-3..=6.22;

/// Squared ratio of an edge to the distance of the centroid below which area sampling is as good as well: cosθ/r² then varies
/// by less over the triangle than what the light falls on. Our deviation from pbrt-v4, worth a tenth of a render's time.
const SMALL: f32 = 0.5;

/// Smallest cosine weight of a corner, so that light from a little above the shading horizon keeps a chance.
pub(super) const MIN_CORNER_WEIGHT: f32 = 0.01;

/// A triangle's plane and size.
struct Plane {
    /// Unit normal on the side from which the corners appear counter-clockwise.
    n: Normal,
    /// Of points uniform over the triangle.
    density: PdfArea,
}

impl Plane {
    /// `None` for a triangle without area.
    #[inline]
    fn new(facet: &Facet) -> Option<Self> {
        let area_vector = facet.area_vector();
        let n = rounding::normalized(area_vector)?;
        // The component along the unit vector is the length, without another root.
        Some(Self { n, density: PdfArea(2.0 / area_vector.as_vec3().dot(*n)) })
    }
}

impl TriangleMesh {
    /// Chooses a point uniformly by area; `None` for a triangle without area.
    pub fn sample_area(&self, triangle: u32, u: Vec2) -> Option<ShapeSample> {
        let facet = Facet::new(self.corners(triangle));
        let plane = Plane::new(&facet)?;
        Some(self.sample_area_of(triangle, &facet, &plane, u))
    }

    #[inline(always)]
    fn sample_area_of(&self, triangle: u32, facet: &Facet, plane: &Plane, u: Vec2) -> ShapeSample {
        let [_, b1, b2] = warp::uniform_triangle(u);
        let b = [b1, b2];
        ShapeSample {
            p: facet.point(b),
            n: self.outward(plane.n, triangle, b),
            uv: self.uv_at(triangle, b),
            density: plane.density,
        }
    }

    /// Chooses a point by the solid angle at `from`, with the cosine at a shading normal warped in.
    #[inline(always)]
    pub fn sample_toward(&self, triangle: u32, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        let corners = self.corners(triangle);
        let facet = Facet::new(corners);
        let plane = Plane::new(&facet)?;
        if is_large_from(corners, from)
            && let Some(seen) = seen_from(corners, from)
        {
            return self.sample_directions(triangle, &facet, &plane, &seen, from, u);
        }
        self.sample_area_of(triangle, &facet, &plane, u).toward(from)
    }

    fn sample_directions(
        &self,
        triangle: u32,
        facet: &Facet,
        plane: &Plane,
        seen: &SphericalTriangle,
        from: &ReferencePoint,
        u: Vec2,
    ) -> Option<ShapeSampleToward> {
        let (u, warp_pdf) = match from.ns {
            Some(ns) => {
                let w = corner_weights(seen.corners, ns);
                let warped = warp::bilinear(u, w);
                (warped, warp::bilinear_pdf(warped, w))
            }
            None => (u, 1.0),
        };
        let b = seen.sample(u)?;
        let p = facet.point(b);
        Some(ShapeSampleToward {
            p,
            n: self.outward(plane.n, triangle, b),
            uv: self.uv_at(triangle, b),
            wi: Dir::new(p.p - from.p.p)?,
            density: PdfSolidAngle(warp_pdf / seen.solid_angle),
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
        let Some(plane) = Plane::new(&Facet::new(corners)) else { return PdfSolidAngle(0.0) };
        let seen = if is_large_from(corners, from) { seen_from(corners, from) } else { None };
        let Some(seen) = seen else {
            return area_density_toward(plane.density, from, wi, hit);
        };
        let uniform = 1.0 / seen.solid_angle;
        let Some(ns) = from.ns else { return PdfSolidAngle(uniform) };
        let Some(u) = seen.invert(*wi) else { return PdfSolidAngle(uniform) };
        PdfSolidAngle(uniform * warp::bilinear_pdf(u, corner_weights(seen.corners, ns)))
    }
}

/// Whether the triangle may be near enough for its directions to be sampled.
#[inline]
fn is_large_from([a, b, c]: [Point; 3], from: &ReferencePoint) -> bool {
    let (e1, e2) = (b - a, c - a);
    let edge = e1.length_squared().max(e2.length_squared());
    let centroid = (a - from.p.p) + (e1 + e2) * (1.0 / 3.0);
    edge >= SMALL * centroid.length_squared()
}

/// The triangle as seen from the reference point if it is to be sampled by solid angle.
fn seen_from(corners: [Point; 3], from: &ReferencePoint) -> Option<SphericalTriangle> {
    SphericalTriangle::new(corners.map(|p| p - from.p.p))
        .filter(|s| SPHERICAL_SAMPLING.contains(&s.solid_angle))
}

/// Cosines to the shading normal at the corners of the sample square: u.x = 0 is the edge v₀v₁ and u.y = 0 the
/// corner v₁, so that the square's lower side is one point.
fn corner_weights(corners: [Vec3; 3], ns: Normal) -> [f32; 4] {
    let weight = |d: Vec3| d.dot(*ns).abs().max(MIN_CORNER_WEIGHT);
    let [w0, w1, w2] = corners.map(weight);
    [w1, w1, w0, w2]
}
