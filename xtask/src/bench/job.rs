//! Scenes ready to be rendered within this process.

use std::path::Path;
use steradian::render::{CancelToken, RenderOptions, Report, Silent};
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{Disk, RenderJob};

/// Reads and compiles one scene.
pub(crate) fn compile(input: Input<'_>, name: &str) -> Result<RenderJob, String> {
    let mut imported = import(&[input], &Disk);
    let job = imported
        .scene
        .take()
        .and_then(|desc| steradian::scene::compile(desc, &Disk, &mut imported.diagnostics));
    job.ok_or_else(|| format!("{name} does not compile"))
}

/// Reads and compiles a file.
pub(crate) fn compile_file(path: &Path) -> Result<RenderJob, String> {
    compile(Input::File(path), &path.display().to_string())
}

/// Renders with `threads`, all that there are for `None`.
pub(crate) fn render(job: &RenderJob, threads: Option<usize>) -> Result<Report, String> {
    let options = RenderOptions { threads, ..RenderOptions::default() };
    let rendering = steradian::render::render(job, &options, &Silent, &CancelToken::new());
    Ok(rendering.map_err(|e| e.to_string())?.report)
}
