//! `steradian info` and `steradian check`.

use crate::Failure;
use crate::args;
use crate::load::{self, Verbosity};
use crate::output::{note, print};
use std::fmt::Write as _;
use steradian::scene::{Disk, IntegratorSettings, RenderJob, Severity};
use steradian::shape::Shape;

/// Describes the compiled scene; what is unsupported or doubtful is part of the description.
pub(crate) fn info(arguments: &args::Inspect) -> Result<(), Failure> {
    let job = load::read(&arguments.scenes)?.compile(Verbosity::All)?;
    Ok(print(&describe(&job))?)
}

/// Reports all problems, compiling included, and says how many there are.
pub(crate) fn check(arguments: &args::Inspect) -> Result<(), Failure> {
    let mut loading = load::read(&arguments.scenes)?;
    if let Some(desc) = loading.imported.scene.take() {
        // The compiled scene is of no interest here, what it takes to make it is.
        let _ = steradian::scene::compile(desc, &Disk, &mut loading.imported.diagnostics);
    }
    loading.report(Verbosity::All);
    let diagnostics = &loading.imported.diagnostics;
    let count = |severity| diagnostics.iter().filter(|d| d.severity == severity).count();
    let counted = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    note(&format!(
        "{}, {}, {}",
        counted(diagnostics.error_count(), "error"),
        counted(count(Severity::Warning), "warning"),
        counted(count(Severity::Notice), "notice")
    ));
    if diagnostics.has_errors() { Err(Failure::Reported) } else { Ok(()) }
}

fn describe(job: &RenderJob) -> String {
    let scene = &job.scene;
    let mut out = String::new();
    let mut line = |name: &str, value: String| {
        // Writing to a String does not fail.
        let _ = writeln!(out, "{name:22}{value}");
    };
    let [w, h] = job.film.resolution;
    line("picture", format!("{w} × {h}, {} samples per pixel, {:?}", job.sampling.spp, job.sampling.kind));
    let integrator = match &job.integrator {
        IntegratorSettings::Path(p) => format!("path, at most {} bounces", p.max_depth),
        IntegratorSettings::Classic(_) => job.integrator.name().to_owned(),
    };
    line("integrator", integrator);
    let stats = scene.accel().stats();
    let b = scene.accel().bounds();
    if !b.is_empty() {
        let t = &job.world_from_render;
        let world = t.bounds(&b);
        let metres = world.diagonal() * job.meters_per_unit;
        line("bounds (world)", format!("{} to {}", point(*world.min), point(*world.max)));
        line("size", format!("{} m", point(metres)));
    }
    let prims: u64 = scene.shapes().iter().map(|s| u64::from(s.prim_count())).sum();
    line("shapes", format!("{} with {prims} primitives", scene.shapes().len()));
    line("triangles", stats.triangles.to_string());
    line("other primitives", stats.other_prims.to_string());
    line("instances", stats.instances.to_string());
    line(
        "hierarchy",
        format!("{} nodes, {} levels, {:?}", stats.nodes, stats.depth, scene.accel().instructions()),
    );
    let parts =
        [stats.node_bytes, stats.packet_bytes, stats.heap_bytes - stats.node_bytes - stats.packet_bytes];
    let [nodes, triangles, other] = parts.map(mebibytes);
    let whole = mebibytes(stats.heap_bytes);
    line("memory, hierarchy", format!("{whole}: nodes {nodes}, triangles {triangles}, other {other}"));
    let geometry: usize = scene.shapes().iter().map(Shape::heap_bytes).sum();
    line("memory, geometry", mebibytes(geometry));
    if stats.triangles > 0 {
        let bare = geometry - scene.shapes().iter().map(attribute_bytes).sum::<usize>();
        let each = |bytes: usize| bytes as f64 / stats.triangles as f64;
        let (resident, peak) = (each(bare + stats.heap_bytes), each(bare + stats.peak_bytes));
        line(
            "memory per triangle",
            format!("{resident:.1} B, while building at most {peak:.1} B (without normals and uv)"),
        );
    }
    line("memory, pictures", mebibytes(scene.textures().image_bytes()));
    let (_, radius) = b.bounding_sphere();
    line("lights", scene.lights().len().to_string());
    let mut total = (0.0, 0.0);
    // Powers of lights in scene units scale with the square of the unit's length.
    let area = job.meters_per_unit * job.meters_per_unit;
    for (i, light) in scene.lights().iter().enumerate() {
        let p = light.power(radius);
        let (watts, lumens) = (p.watts * area, p.lumens * area);
        total = (total.0 + watts, total.1 + lumens);
        if i < SHOWN_LIGHTS {
            line(&format!("  {}", light.kind()), format!("{watts:.4e} W  {lumens:.4e} lm"));
        } else if i == SHOWN_LIGHTS {
            line("  …", format!("{} more", scene.lights().len() - SHOWN_LIGHTS));
        }
    }
    line("light in total", format!("{:.4e} W  {:.4e} lm (360–830 nm)", total.0, total.1));
    out.trim_end().to_owned()
}

/// Bytes of a mesh that are neither vertices nor indices.
fn attribute_bytes(shape: &Shape) -> usize {
    match shape {
        Shape::Mesh(mesh) => mesh.attribute_bytes(),
        _ => 0,
    }
}

/// Lights that are listed one by one.
const SHOWN_LIGHTS: usize = 32;

fn point(v: steradian::math::Vec3) -> String {
    format!("({:.5}, {:.5}, {:.5})", v.x, v.y, v.z)
}

fn mebibytes(bytes: usize) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}
