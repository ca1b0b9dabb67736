//! Small scenes in which kernels find what they need.

use super::grid::Grid;
use std::fmt::Write as _;
use std::path::Path;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{CORNELL_BOX, FileSystem, MemoryFiles, RenderJob};

fn compile(text: &str, files: &dyn FileSystem) -> Result<RenderJob, String> {
    let input = Input::Text { name: "kernel", bytes: text.as_bytes(), base: Path::new("") };
    let mut imported = import(&[input], files);
    let job = imported
        .scene
        .take()
        .and_then(|desc| steradian::scene::compile(desc, files, &mut imported.diagnostics));
    job.ok_or_else(|| "the scene of the kernel does not compile".to_owned())
}

/// The built-in scene, small.
pub(super) fn cornell_box() -> Result<RenderJob, String> {
    let mut job = compile(CORNELL_BOX, &MemoryFiles::new())?;
    job.sampling.spp = 4;
    Ok(job)
}

/// A square of some material across the view at z = 0, below eight lamps.
pub(super) fn square(material: &str) -> Result<RenderJob, String> {
    let mut text = format!("WorldBegin\n{material}\n{}", Grid::new(2).pbrt());
    for i in 0..8 {
        let _ = write!(
            text,
            "AttributeBegin\nTranslate {i} 0 2\nAreaLightSource \"diffuse\" \"blackbody L\" 5000\n\
             Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  0 0.{i}5 0  0.5 0 0 ]\nAttributeEnd\n"
        );
    }
    compile(&text, &MemoryFiles::new())
}

/// A surface of about sixteen thousand triangles.
pub(super) fn surface() -> Result<RenderJob, String> {
    let text = format!("WorldBegin\nLightSource \"infinite\"\n{}", Grid::new(91).pbrt());
    compile(&text, &MemoryFiles::new())
}

/// A square below a picture of a sky.
pub(super) fn sky() -> Result<RenderJob, String> {
    const SIDE: usize = 64;
    let mut picture = format!("PF\n{SIDE} {SIDE}\n-1\n").into_bytes();
    for k in 0..SIDE * SIDE {
        let (x, y) = ((k % SIDE) as f32 / SIDE as f32, (k / SIDE) as f32 / SIDE as f32);
        let bright = if (x - 0.4).hypot(y - 0.3) < 0.03 { 500.0 } else { 0.2 + y };
        [bright, bright * 0.9, bright * 0.8 + x].iter().for_each(|v| picture.extend(v.to_le_bytes()));
    }
    let files = MemoryFiles::new().with("sky.pfm", picture);
    let light = "LightSource \"infinite\" \"string filename\" \"sky.pfm\"";
    compile(&format!("WorldBegin\n{light}\n{}", Grid::new(2).pbrt()), &files)
}
