//! Shape classes.

use super::args::{Args, Many};
use crate::scene::desc::{CurveBasis, CurveDesc, CurveKind, MeshDesc, ShapeKind};
use crate::scene::text::{ParamType, Text};

const CLASSES: &[&str] =
    &["plymesh", "trianglemesh", "bilinearmesh", "sphere", "disk", "cylinder", "curve", "loopsubdiv"];
const V3_CLASSES: &[&str] = &["cone", "hyperboloid", "paraboloid", "heightfield", "heightfield2", "nurbs"];

/// More refinements than this would make over a million faces of each one.
const MAX_SUBDIVISION: u32 = 10;
/// A subdivision with more faces than this would take tens of gigabytes.
const MAX_SUBDIVIDED: usize = 1 << 26;

/// Reads the parameters of a shape class; `None` when the class or something needed is missing (and reported).
pub(super) fn shape(class: &Text, args: &mut Args<'_>) -> Option<ShapeKind> {
    match class.value.as_str() {
        "plymesh" => ply_mesh(args),
        "trianglemesh" => triangle_mesh(args),
        "bilinearmesh" => bilinear_mesh(args),
        "sphere" => {
            let radius = args.positive("radius", 1.0);
            let span = args.span_of("zmin");
            let (z_min, z_max) = (args.float("zmin", -radius), args.float("zmax", radius));
            if z_min.clamp(-radius, radius) == z_max.clamp(-radius, radius) {
                args.error(span, "nothing of the sphere lies between \"zmin\" and \"zmax\"");
            }
            Some(ShapeKind::Sphere { radius, z_min, z_max, phi_max: phi_max(args) })
        }
        "disk" => {
            let height = args.float("height", 0.0);
            let radius = args.positive("radius", 1.0);
            let inner_radius = args.non_negative("innerradius", 0.0);
            Some(ShapeKind::Disk { height, radius, inner_radius, phi_max: phi_max(args) })
        }
        "cylinder" => {
            let radius = args.positive("radius", 1.0);
            let (z_min, z_max) = (args.float("zmin", -1.0), args.float("zmax", 1.0));
            Some(ShapeKind::Cylinder { radius, z_min, z_max, phi_max: phi_max(args) })
        }
        "curve" => curve(args),
        "loopsubdiv" => loop_subdivision(args),
        _ => {
            args.unknown_class("shape", class, CLASSES, V3_CLASSES);
            None
        }
    }
}

fn phi_max(args: &mut Args<'_>) -> f32 {
    args.float_where("phimax", 360.0, |v| v > 0.0, "positive").min(360.0)
}

fn ply_mesh(args: &mut Args<'_>) -> Option<ShapeKind> {
    let displaced = args.has("displacement");
    let displacement = args.span_of("displacement");
    args.float_param_opt("displacement");
    args.positive("edgelength", 1.0);
    if displaced {
        args.ctx.unsupported(displacement, "displacement of plymesh shapes");
    }
    let file = args.file("filename");
    if file.is_none() {
        args.missing("filename");
    }
    Some(ShapeKind::PlyMesh { file: file? })
}

fn triangle_mesh(args: &mut Args<'_>) -> Option<ShapeKind> {
    mesh(args, 3).map(ShapeKind::TriangleMesh)
}

fn bilinear_mesh(args: &mut Args<'_>) -> Option<ShapeKind> {
    let emission = args.file("emissionfilename");
    Some(ShapeKind::BilinearMesh { mesh: mesh(args, 4)?, emission })
}

/// A mesh whose elements have `corners` vertices.
fn mesh(args: &mut Args<'_>, corners: usize) -> Option<MeshDesc> {
    let indices = args.ints("indices");
    let p = args.points("P");
    let n = args.vectors("N", ParamType::Normal);
    let s = if corners == 3 { args.vectors("S", ParamType::Vector3) } else { None };
    let uv = args.points2("uv");
    let face_indices = args.ints("faceIndices");
    let Some(p) = p else {
        args.missing("P");
        return None;
    };
    let count = p.values.len();
    let indices = match indices {
        Some(indices) => vertex_indices(args, indices, count, corners)?,
        None if count == corners => (0..corners as u32).collect(),
        None => {
            args.missing("indices");
            return None;
        }
    };
    let faces = indices.len() / corners;
    Some(MeshDesc {
        n: per_vertex(args, "N", n, count),
        s: per_vertex(args, "S", s, count),
        uv: per_vertex(args, "uv", uv, count),
        face_indices: match face_indices {
            Some(f) if !f.values.is_empty() && f.values.len() != faces => {
                let message = format!("\"faceIndices\" has {} values for {faces} faces", f.values.len());
                args.error(f.span, message);
                Vec::new()
            }
            Some(f) => f.values,
            None => Vec::new(),
        },
        indices,
        p: p.values,
    })
}

fn vertex_indices(
    args: &mut Args<'_>,
    indices: Many<i32>,
    points: usize,
    corners: usize,
) -> Option<Vec<u32>> {
    let Many { values, span } = indices;
    if !values.len().is_multiple_of(corners) {
        args.error(span, format!("\"indices\" needs {corners} values a face, found {}", values.len()));
        return None;
    }
    if let Some(at) = values.iter().position(|&i| usize::try_from(i).map_or(true, |i| i >= points)) {
        let message =
            format!("\"indices\": value {} is {}, but \"P\" has {points} points", at + 1, values[at]);
        args.error(span, message);
        return None;
    }
    Some(bytemuck::cast_vec(values))
}

/// Values that must be as many as the points, or none.
fn per_vertex<T>(args: &mut Args<'_>, name: &str, many: Option<Many<T>>, points: usize) -> Vec<T> {
    match many {
        Some(m) if !m.values.is_empty() && m.values.len() != points => {
            let message = format!("\"{name}\" has {} values, but \"P\" has {points} points", m.values.len());
            args.error(m.span, message);
            Vec::new()
        }
        Some(m) => m.values,
        None => Vec::new(),
    }
}

fn curve(args: &mut Args<'_>) -> Option<ShapeKind> {
    let width = args.non_negative("width", 1.0);
    let width = [args.non_negative("width0", width), args.non_negative("width1", width)];
    let degree = args.count("degree", 3, 2..=3);
    let bases = [("bezier", CurveBasis::Bezier), ("bspline", CurveBasis::BSpline)];
    let basis = args.choice("basis", CurveBasis::Bezier, &bases);
    let kinds = [("flat", CurveKind::Flat), ("cylinder", CurveKind::Cylinder), ("ribbon", CurveKind::Ribbon)];
    let kind = args.choice("type", CurveKind::Flat, &kinds);
    let split_depth = args.count("splitdepth", 3, 0..=10);
    let n = args.vectors("N", ParamType::Normal);
    let Some(p) = args.points("P") else {
        args.missing("P");
        return None;
    };
    let (count, d) = (p.values.len(), degree as usize);
    let segments = match basis {
        CurveBasis::Bezier if count > d && (count - 1).is_multiple_of(d) => (count - 1) / d,
        CurveBasis::BSpline if count > d => count - d,
        CurveBasis::Bezier => {
            let demand = format!("{} and then {d} for every further segment", d + 1);
            args.error(p.span, format!("a bezier curve of degree {d} needs {demand} points, found {count}"));
            return None;
        }
        CurveBasis::BSpline => {
            args.error(
                p.span,
                format!("a bspline of degree {d} needs at least {} points, found {count}", d + 1),
            );
            return None;
        }
    };
    let n = match (kind, n) {
        (CurveKind::Ribbon, None) => {
            args.missing("N");
            return None;
        }
        (CurveKind::Ribbon, Some(n)) if n.values.len() != segments + 1 => {
            let message = format!(
                "\"N\" needs {} normals for {segments} segments, found {}",
                segments + 1,
                n.values.len()
            );
            args.error(n.span, message);
            return None;
        }
        (CurveKind::Ribbon, Some(n)) => n.values,
        (CurveKind::Flat | CurveKind::Cylinder, Some(n)) => {
            args.ctx.diagnostics.warning(n.span, "\"N\" is ignored: only curves of type ribbon use normals");
            Vec::new()
        }
        (CurveKind::Flat | CurveKind::Cylinder, None) => Vec::new(),
    };
    Some(ShapeKind::Curve(CurveDesc { p: p.values, basis, degree, kind, width, n, split_depth }))
}

fn loop_subdivision(args: &mut Args<'_>) -> Option<ShapeKind> {
    let span = args.span_of("levels");
    let levels = args.count("levels", 3, 0..=MAX_SUBDIVISION);
    args.choice("scheme", (), &[("loop", ())]);
    let (indices, p) = (args.ints("indices"), args.points("P"));
    if indices.is_none() {
        args.missing("indices");
    }
    if p.is_none() {
        args.missing("P");
    }
    let (indices, p) = (indices?, p?);
    let indices = vertex_indices(args, indices, p.values.len(), 3)?;
    let faces = (indices.len() / 3).saturating_mul(1 << (2 * levels));
    if faces > MAX_SUBDIVIDED {
        args.error(span, format!("subdivision would make {faces} faces, more than {MAX_SUBDIVIDED}"));
        return None;
    }
    Some(ShapeKind::LoopSubdivision { levels, p: p.values, indices })
}
