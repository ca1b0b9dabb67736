//! From arguments to a scene, with everything that is wrong with it said.

use crate::Failure;
use crate::output::note;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use steradian::scene::import::pbrt::{Imported, Input, import};
use steradian::scene::{Diagnostic, Disk, RenderJob, Severity};

/// Which messages are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verbosity {
    ErrorsOnly,
    All,
}

/// A scene on its way from text to compiled form.
pub(crate) struct Loading {
    pub(crate) imported: Imported,
}

/// Reads the files as one scene; none means the built-in Cornell box.
pub(crate) fn read(paths: &[PathBuf]) -> Result<Loading, String> {
    let mut stdin = Vec::new();
    if paths.iter().any(|p| is_stdin(p)) {
        std::io::stdin().read_to_end(&mut stdin).map_err(|e| format!("cannot read standard input: {e}"))?;
    }
    let here = Path::new("");
    let mut inputs: Vec<Input> = paths
        .iter()
        .map(|p| match is_stdin(p) {
            true => Input::Text { name: "(standard input)", bytes: &stdin, base: here },
            false => Input::File(p),
        })
        .collect();
    if inputs.is_empty() {
        let bytes = steradian::scene::CORNELL_BOX.as_bytes();
        inputs.push(Input::Text { name: "(built-in)/cornell-box.pbrt", bytes, base: here });
    }
    Ok(Loading { imported: import(&inputs, &Disk) })
}

fn is_stdin(path: &Path) -> bool {
    path == Path::new("-")
}

impl Loading {
    /// Leaves out everything but materials and their textures, which may be the smallest part of a scene.
    pub(crate) fn materials_only(mut self) -> Self {
        if let Some(scene) = &mut self.imported.scene {
            scene.shapes.clear();
            scene.objects.clear();
            scene.instances.clear();
            scene.lights.clear();
            scene.area_lights.clear();
        }
        self
    }

    /// Compiles what was read and shows all messages.
    pub(crate) fn compile(mut self, verbosity: Verbosity) -> Result<RenderJob, Failure> {
        let job = self
            .imported
            .scene
            .take()
            .and_then(|d| steradian::scene::compile(d, &Disk, &mut self.imported.diagnostics));
        self.report(verbosity);
        match job {
            Some(job) if !self.imported.diagnostics.has_errors() => Ok(job),
            _ => Err(Failure::Reported),
        }
    }

    /// Shows the messages.
    pub(crate) fn report(&self, verbosity: Verbosity) {
        let Imported { sources, diagnostics, .. } = &self.imported;
        let shown = |d: &Diagnostic| verbosity == Verbosity::All || d.severity == Severity::Error;
        let text = diagnostics.display_where(sources, shown).to_string();
        if !text.is_empty() {
            note(text.trim_end());
        }
    }
}
