//! From the statement of one shape to geometry in render space.

use crate::math::Transform;
use crate::scene::desc::{CurveBasis, CurveDesc, CurveKind, FileRef, MeshDesc, ShapeKind};
use crate::scene::diagnostic::Diagnostics;
use crate::scene::files::{FileSystem, reason};
use crate::scene::import::ply;
use crate::scene::source::Span;
use crate::shape::curve::{Basis, Degree, Profile};
use crate::shape::{
    BilinearMesh, Curve, CurveData, Cylinder, Disk, MeshData, Orientation, PatchData, Shape, ShapeError,
    Sphere, TriangleMesh, loop_subdivision,
};

/// The shapes that one statement makes; none when it is faulty, which is reported.
pub(super) fn build(
    kind: ShapeKind,
    orientation: Orientation,
    render_from_object: &Transform,
    files: &dyn FileSystem,
    span: Span,
    diagnostics: &mut Diagnostics,
) -> Vec<Shape> {
    let t = render_from_object;
    let mut place = span;
    let built = match kind {
        ShapeKind::PlyMesh { file } => {
            place = file.span;
            ply(&file, t, orientation, files)
        }
        ShapeKind::TriangleMesh(mesh) => {
            TriangleMesh::new(triangles(mesh), t, orientation).map(|m| vec![Shape::Mesh(m)]).map_err(text)
        }
        ShapeKind::BilinearMesh { mesh, emission: _ } => {
            BilinearMesh::new(patches(mesh), t, orientation).map(|m| vec![Shape::Bilinear(m)]).map_err(text)
        }
        ShapeKind::Sphere { radius, z_min, z_max, phi_max } => {
            Sphere::new(radius, z_min, z_max, phi_max, t, orientation)
                .map(|s| vec![Shape::Sphere(Box::new(s))])
                .map_err(text)
        }
        ShapeKind::Disk { height, radius, inner_radius, phi_max } => {
            Disk::new(height, radius, inner_radius, phi_max, t, orientation)
                .map(|s| vec![Shape::Disk(Box::new(s))])
                .map_err(text)
        }
        ShapeKind::Cylinder { radius, z_min, z_max, phi_max } => {
            Cylinder::new(radius, z_min, z_max, phi_max, t, orientation)
                .map(|s| vec![Shape::Cylinder(Box::new(s))])
                .map_err(text)
        }
        ShapeKind::Curve(curve) => {
            Curve::new(curve_data(curve), t, orientation).map(|c| vec![Shape::Curve(c)]).map_err(text)
        }
        ShapeKind::LoopSubdivision { levels, p, indices } => {
            loop_subdivision::refine(&p, indices.as_chunks::<3>().0, levels)
                .and_then(|refined| TriangleMesh::new(refined, t, orientation))
                .map(|m| vec![Shape::Mesh(m)])
                .map_err(text)
        }
    };
    built.unwrap_or_else(|message| {
        diagnostics.error(place, message);
        Vec::new()
    })
}

fn triangles(mesh: MeshDesc) -> MeshData {
    MeshData {
        indices: groups(mesh.indices),
        positions: mesh.p,
        normals: mesh.n,
        tangents: mesh.s,
        uvs: mesh.uv,
        face_indices: face_numbers(mesh.face_indices),
    }
}

/// The indices in groups, in the same memory; the importer has checked that there is no remainder.
fn groups<const N: usize>(mut indices: Vec<u32>) -> Vec<[u32; N]>
where
    [u32; N]: bytemuck::Pod,
{
    indices.shrink_to_fit();
    bytemuck::try_cast_vec(indices).unwrap_or_else(|(_, indices)| indices.as_chunks::<N>().0.to_vec())
}

fn patches(mesh: MeshDesc) -> PatchData {
    PatchData {
        indices: groups(mesh.indices),
        positions: mesh.p,
        normals: mesh.n,
        uvs: mesh.uv,
        face_indices: face_numbers(mesh.face_indices),
    }
}

fn curve_data(desc: CurveDesc) -> CurveData {
    CurveData {
        points: desc.p,
        basis: match desc.basis {
            CurveBasis::Bezier => Basis::Bezier,
            CurveBasis::BSpline => Basis::BSpline,
        },
        degree: if desc.degree == 2 { Degree::Quadratic } else { Degree::Cubic },
        profile: match desc.kind {
            CurveKind::Flat => Profile::Flat,
            CurveKind::Cylinder => Profile::Cylinder,
            CurveKind::Ribbon => Profile::Ribbon,
        },
        normals: desc.n,
        widths: desc.width,
        split_depth: desc.split_depth,
    }
}

/// Triangles and patches of a PLY file; each keeps its own copy of the vertices that it needs.
fn ply(
    file: &FileRef,
    t: &Transform,
    orientation: Orientation,
    files: &dyn FileSystem,
) -> Result<Vec<Shape>, String> {
    let failed = |e: &dyn std::fmt::Display| format!("cannot read mesh {}: {e}", file.path.display());
    let bytes = files.read(&file.path).map_err(|e| failed(&reason(&e)))?;
    let mesh = ply::parse(&bytes).map_err(|e| failed(&e))?;
    let mut shapes = Vec::new();
    if !mesh.quads.is_empty() {
        let data = PatchData {
            indices: mesh.quads,
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            uvs: mesh.uvs.clone(),
            face_indices: mesh.quad_numbers,
        };
        shapes.push(Shape::Bilinear(BilinearMesh::new(data, t, orientation).map_err(|e| failed(&e))?));
    }
    if !mesh.triangles.is_empty() {
        let data = MeshData {
            indices: mesh.triangles,
            positions: mesh.positions,
            normals: mesh.normals,
            tangents: Vec::new(),
            uvs: mesh.uvs,
            face_indices: mesh.triangle_numbers,
        };
        shapes.push(Shape::Mesh(TriangleMesh::new(data, t, orientation).map_err(|e| failed(&e))?));
    }
    Ok(shapes)
}

fn face_numbers(numbers: Vec<i32>) -> Vec<u32> {
    numbers.into_iter().map(i32::cast_unsigned).collect()
}

fn text(e: ShapeError) -> String {
    e.to_string()
}
