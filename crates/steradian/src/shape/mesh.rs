//! Indexed triangle meshes, stored in render space.

use super::contract::{Orientation, PrimHit, ShapeError};
use super::{rounding, validate};
use crate::math::{Bounds3, Frame, Normal, Point, Shading, SurfacePoint, Transform, Vec2, Vec3};
use glam::DVec3;

/// What a triangle mesh is made of, in object space. Empty attribute arrays mean "not given".
#[derive(Clone, Debug, Default)]
pub struct MeshData {
    /// Vertex indices of each triangle.
    pub indices: Vec<[u32; 3]>,
    /// Vertex positions.
    pub positions: Vec<Point>,
    /// Shading normals per vertex, of any length.
    pub normals: Vec<Vec3>,
    /// Shading tangents per vertex.
    pub tangents: Vec<Vec3>,
    /// Texture coordinates per vertex.
    pub uvs: Vec<Vec2>,
    /// One number per triangle for per-face data.
    pub face_indices: Vec<u32>,
}

/// A triangle mesh in render space.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    indices: Vec<[u32; 3]>,
    positions: Vec<Point>,
    normals: Vec<Vec3>,
    tangents: Vec<Vec3>,
    uvs: Vec<Vec2>,
    face_indices: Vec<u32>,
    flip: bool,
}

/// The uv coordinates of a triangle whose mesh has none.
const DEFAULT_UVS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::ONE];

impl TriangleMesh {
    /// Transforms a mesh to render space and checks it: every position finite, every index in range, every
    /// attribute array empty or of full length.
    pub fn new(
        data: MeshData,
        render_from_object: &Transform,
        orientation: Orientation,
    ) -> Result<Self, ShapeError> {
        let MeshData { mut indices, mut positions, mut normals, mut tangents, mut uvs, face_indices } = data;
        let count = positions.len();
        validate::check_length("normals", normals.len(), count)?;
        validate::check_length("tangents", tangents.len(), count)?;
        validate::check_length("uvs", uvs.len(), count)?;
        validate::check_length("face indices", face_indices.len(), indices.len())?;
        validate::check_indices(&indices, count)?;
        validate::transform_positions(&mut positions, render_from_object)?;
        validate::transform_normals(&mut normals, render_from_object, orientation)?;
        for (index, s) in tangents.iter_mut().enumerate() {
            *s = render_from_object.vector(*s);
            if !s.is_finite() {
                return Err(ShapeError::NotFinite { what: "tangent", index });
            }
        }
        validate::check_uvs(&uvs)?;
        let flip = orientation.flips_normals(render_from_object);
        // Readers grow their lists and leave up to half of the room unused.
        indices.shrink_to_fit();
        positions.shrink_to_fit();
        normals.shrink_to_fit();
        uvs.shrink_to_fit();
        Ok(Self { indices, positions, normals, tangents, uvs, face_indices, flip })
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> u32 {
        self.indices.len() as u32
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Bytes held on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.indices[..])
            + size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.tangents[..])
            + size_of_val(&self.uvs[..])
            + size_of_val(&self.face_indices[..])
    }

    /// Of [`TriangleMesh::heap_bytes`], what is neither a vertex position nor an index.
    pub fn attribute_bytes(&self) -> usize {
        self.heap_bytes() - size_of_val(&self.indices[..]) - size_of_val(&self.positions[..])
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [Point; 3] {
        self.gather(&self.positions, triangle)
    }

    /// Smallest box around all triangles.
    pub fn bounds(&self) -> Bounds3 {
        let used = self.indices.iter().flatten().map(|&i| self.positions[i as usize]);
        Bounds3::from_points(used)
    }

    /// Area of a triangle [scene units²].
    pub fn area(&self, triangle: u32) -> f32 {
        (0.5 * cross(self.corners(triangle)).length()) as f32
    }

    #[inline]
    fn gather<T: Copy>(&self, values: &[T], triangle: u32) -> [T; 3] {
        let [a, b, c] = self.indices[triangle as usize];
        [values[a as usize], values[b as usize], values[c as usize]]
    }

    #[inline]
    fn corner_uvs(&self, triangle: u32) -> [Vec2; 3] {
        if self.uvs.is_empty() { DEFAULT_UVS } else { self.gather(&self.uvs, triangle) }
    }

    /// Texture coordinates at barycentric (b₁, b₂).
    #[inline]
    pub fn uv_at(&self, triangle: u32, b: [f32; 2]) -> Vec2 {
        interpolate(self.corner_uvs(triangle), b)
    }

    /// The interpolated shading normal before normalisation; `None` when the mesh has none or they cancel.
    fn shading_normal(&self, triangle: u32, b: [f32; 2]) -> Option<Normal> {
        if self.normals.is_empty() {
            return None;
        }
        Normal::new(interpolate(self.gather(&self.normals, triangle), b))
    }

    /// The geometric normal at barycentric (b₁, b₂): on the side of the shading normal if the mesh has normals,
    /// else from the winding and the orientation. `None` for a triangle without area.
    pub fn geometric_normal(&self, triangle: u32, b: [f32; 2]) -> Option<Normal> {
        self.oriented(cross(self.corners(triangle)), triangle, b)
    }

    /// The geometric normal from the triangle's area vector.
    #[inline]
    fn oriented(&self, area_vector: DVec3, triangle: u32, b: [f32; 2]) -> Option<Normal> {
        Some(self.outward(rounding::normalized(area_vector)?, triangle, b))
    }

    /// The normal `n` of the winding or its opposite, as the mesh has it.
    #[inline(always)]
    pub(super) fn outward(&self, n: Normal, triangle: u32, b: [f32; 2]) -> Normal {
        if !self.normals.is_empty() {
            let ns = interpolate(self.gather(&self.normals, triangle), b);
            return n.facing(ns);
        }
        if self.flip { -n } else { n }
    }

    /// The point at barycentric (b₁, b₂). It lies in the plane of the triangle but for the final rounding.
    pub fn point_at(&self, triangle: u32, b: [f32; 2]) -> crate::math::BoundedPoint {
        Facet::new(self.corners(triangle)).point(b)
    }

    /// Differential geometry at a hit.
    #[inline(always)]
    pub fn surface(&self, triangle: u32, hit: &PrimHit, time: f32) -> SurfacePoint {
        let b = [hit.u, hit.v];
        let facet = Facet::new(self.corners(triangle));
        // A triangle that can be hit has an area; the fallback keeps a misuse finite.
        let ng = self.oriented(facet.area_vector(), triangle, b).unwrap_or(Normal::Z);
        let face = self.face_indices.get(triangle as usize).copied().unwrap_or(0);
        let p = facet.point(b);
        if self.uvs.is_empty() {
            // What the general case makes of [`DEFAULT_UVS`].
            let (dpdu, dpdv) = (facet.e1.as_vec3(), (facet.e2 - facet.e1).as_vec3());
            let shading = self.shading(triangle, b, ng, dpdu, dpdv);
            return SurfacePoint { p, ng, uv: Vec2::new(b[0] + b[1], b[1]), dpdu, dpdv, shading, time, face };
        }
        let uvs = self.gather(&self.uvs, triangle);
        let (dpdu, dpdv) = parametrisation(uvs, &facet);
        let shading = self.shading(triangle, b, ng, dpdu, dpdv);
        SurfacePoint { p, ng, uv: interpolate(uvs, b), dpdu, dpdv, shading, time, face }
    }

    #[inline(always)]
    fn shading(&self, triangle: u32, b: [f32; 2], ng: Normal, dpdu: Vec3, dpdv: Vec3) -> Shading {
        if self.normals.is_empty() && self.tangents.is_empty() {
            return Shading { n: ng, dpdu, dpdv, dndu: Vec3::ZERO, dndv: Vec3::ZERO };
        }
        self.smooth_shading(triangle, b, ng, dpdu)
    }

    #[inline(never)]
    fn smooth_shading(&self, triangle: u32, b: [f32; 2], ng: Normal, dpdu: Vec3) -> Shading {
        let n = self.shading_normal(triangle, b).unwrap_or(ng);
        let tangent = if self.tangents.is_empty() {
            dpdu
        } else {
            let s = interpolate(self.gather(&self.tangents, triangle), b);
            if s.length_squared() > 0.0 { s } else { dpdu }
        };
        let bitangent = n.cross(tangent);
        let (dpdu, dpdv) = if bitangent.length_squared() > 0.0 {
            (bitangent.cross(*n), bitangent)
        } else {
            let frame = Frame::from_z(n);
            (frame.s, frame.t)
        };
        let (mut dndu, mut dndv) = (Vec3::ZERO, Vec3::ZERO);
        if !self.normals.is_empty() {
            let [n0, n1, n2] = self.gather(&self.normals, triangle).map(|n| n.as_dvec3());
            match uv_derivatives(self.corner_uvs(triangle), n1 - n0, n2 - n0) {
                Some((du, dv)) => (dndu, dndv) = (du.as_vec3(), dv.as_vec3()),
                // Without a parametrisation the change of the normal still has a plane, which is what a
                // texture footprint needs (pbrt-v4 book, 6.5.3).
                None => {
                    if let Some(dn) = rounding::normalized((n2 - n0).cross(n1 - n0)) {
                        let frame = Frame::from_z(dn);
                        (dndu, dndv) = (frame.s, frame.t);
                    }
                }
            }
        }
        Shading { n, dpdu, dpdv, dndu, dndv }
    }
}

/// Twice the area vector of a triangle; points to the side from which the corners appear counter-clockwise.
pub(super) fn cross([a, b, c]: [Point; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}

/// A triangle by a corner and the edges that leave it, in f64.
pub(super) struct Facet {
    p0: DVec3,
    e1: DVec3,
    e2: DVec3,
    /// Sum of the corners' absolute coordinates.
    reach: Vec3,
}

impl Facet {
    #[inline]
    pub(super) fn new([a, b, c]: [Point; 3]) -> Self {
        let p0 = a.as_dvec3();
        Self { p0, e1: b.as_dvec3() - p0, e2: c.as_dvec3() - p0, reach: a.abs() + b.abs() + c.abs() }
    }

    /// Twice the area vector; points to the side from which the corners appear counter-clockwise.
    #[inline]
    pub(super) fn area_vector(&self) -> DVec3 {
        self.e1.cross(self.e2)
    }

    /// The point at barycentric (b₁, b₂).
    #[inline]
    pub(super) fn point(&self, b: [f32; 2]) -> crate::math::BoundedPoint {
        let p = self.p0 + self.e1 * f64::from(b[0]) + self.e2 * f64::from(b[1]);
        // What is added up is a corner and two differences from it.
        rounding::bounded(p, self.reach * 3.0)
    }
}

/// ∂p/∂u and ∂p/∂v of a triangle; of some frame in its plane where its parametrisation is degenerate.
#[inline(never)]
fn parametrisation(uvs: [Vec2; 3], facet: &Facet) -> (Vec3, Vec3) {
    uv_derivatives(uvs, facet.e1, facet.e2)
        .map(|(du, dv)| (du.as_vec3(), dv.as_vec3()))
        .filter(|(du, dv)| du.is_finite() && dv.is_finite() && du.cross(*dv).length_squared() > 0.0)
        .unwrap_or_else(|| {
            let frame = Frame::from_z(rounding::normalized(facet.area_vector()).unwrap_or(Normal::Z));
            (frame.s, frame.t)
        })
}

/// Value at barycentric (b₁, b₂) of corner values.
#[inline]
pub(super) fn interpolate<T>(v: [T; 3], b: [f32; 2]) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T> + Copy,
{
    v[0] * (1.0 - b[0] - b[1]) + v[1] * b[0] + v[2] * b[1]
}

/// ∂x/∂u and ∂x/∂v of a linear quantity that differs by `d1` and `d2` from the first corner to the others; `None` when the
/// parametrisation is degenerate.
#[inline]
fn uv_derivatives(uvs: [Vec2; 3], d1: DVec3, d2: DVec3) -> Option<(DVec3, DVec3)> {
    let (a, b) = (uvs[1].as_dvec2() - uvs[0].as_dvec2(), uvs[2].as_dvec2() - uvs[0].as_dvec2());
    let determinant = a.x * b.y - a.y * b.x;
    // The threshold of pbrt-v4, so that the same triangles lose their parametrisation.
    if determinant.abs() < 1e-9 {
        return None;
    }
    let inv = 1.0 / determinant;
    Some(((d1 * b.y - d2 * a.y) * inv, (d2 * a.x - d1 * b.x) * inv))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_triangle() -> MeshData {
        MeshData {
            indices: vec![[0, 1, 2]],
            positions: vec![Point::ORIGIN, Point::new(2.0, 0.0, 0.0), Point::new(0.0, 3.0, 0.0)],
            ..Default::default()
        }
    }

    #[test]
    fn defective_meshes_are_refused_with_the_culprit() {
        let t = Transform::IDENTITY;
        let new = |d| TriangleMesh::new(d, &t, Orientation::AsDefined).map(|_| ());
        let mut d = one_triangle();
        d.positions[1] = Point::new(f32::NAN, 0.0, 0.0);
        assert_eq!(new(d), Err(ShapeError::NotFinite { what: "vertex", index: 1 }));
        let mut d = one_triangle();
        d.indices[0][2] = 3;
        assert_eq!(new(d), Err(ShapeError::IndexOutOfRange { face: 0, vertex: 3, count: 3 }));
        let mut d = one_triangle();
        d.uvs = vec![Vec2::ZERO; 2];
        assert_eq!(new(d), Err(ShapeError::WrongLength { what: "uvs", found: 2, expected: 3 }));
        let overflow = Transform::scale(Vec3::splat(3e38)).unwrap();
        let overflown = TriangleMesh::new(one_triangle(), &overflow, Orientation::AsDefined).map(|_| ());
        assert_eq!(overflown, Err(ShapeError::NotFinite { what: "vertex", index: 1 }));
    }

    #[test]
    fn the_normal_follows_winding_orientation_and_handedness() {
        let mirror = Transform::scale(Vec3::new(-1.0, 1.0, 1.0)).unwrap();
        let n = |t: &Transform, o| {
            TriangleMesh::new(one_triangle(), t, o).unwrap().geometric_normal(0, [0.3, 0.3])
        };
        assert_eq!(n(&Transform::IDENTITY, Orientation::AsDefined), Some(Normal::Z));
        assert_eq!(n(&Transform::IDENTITY, Orientation::Reversed), Some(-Normal::Z));
        // Mirroring reverses the winding in render space; the flip restores the object's own outside.
        assert_eq!(n(&mirror, Orientation::AsDefined), Some(Normal::Z));
        assert_eq!(n(&mirror, Orientation::Reversed), Some(-Normal::Z));
    }

    #[test]
    fn vertex_normals_decide_the_side() {
        let mut d = one_triangle();
        d.normals = vec![Vec3::new(0.1, 0.2, -1.0); 3];
        let m = TriangleMesh::new(d, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
        let s = m.surface(0, &PrimHit { t: 1.0, u: 0.2, v: 0.3 }, 0.0);
        assert_eq!(s.ng, -Normal::Z);
        assert!(s.shading.n.dot(*s.ng) > 0.9);
        assert!(s.shading.n.dot(s.shading.dpdu).abs() < 1e-6);
    }

    #[test]
    fn derivatives_reproduce_the_parametrisation() {
        let mut d = one_triangle();
        d.uvs = vec![Vec2::new(0.2, 0.1), Vec2::new(0.9, 0.3), Vec2::new(0.4, 0.8)];
        let uvs = d.uvs.clone();
        let m = TriangleMesh::new(d, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
        let s = m.surface(0, &PrimHit { t: 1.0, u: 0.25, v: 0.5 }, 0.0);
        // p is linear in uv: walking from the hit by Δuv to each corner must reach that corner.
        for (uv, p) in uvs.iter().zip([Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 3.0]) {
            let d = *uv - s.uv;
            let reached = *s.p.p + s.dpdu * d.x + s.dpdv * d.y;
            assert!((reached - p).length() < 1e-5, "{reached} {p}");
        }
    }
}
