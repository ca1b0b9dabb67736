//! Scenes that nobody of the project made.

use crate::scene::files::Disk;
use crate::scene::import::pbrt::{Input, import};
use std::path::PathBuf;

/// The folder of real scenes; `None` when it is not there, as in a fresh clone.
fn scenes() -> Option<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let folder = root.ancestors().map(|a| a.join("shared/scenes")).find(|p| p.join("scenes.tsv").exists())?;
    Some(folder)
}

#[test]
fn real_surface_scenes_import_without_errors() {
    let Some(folder) = scenes() else { return };
    let table = std::fs::read_to_string(folder.join("scenes.tsv")).unwrap();
    for line in table.lines().filter(|l| !l.starts_with('#')) {
        let fields: Vec<&str> = line.split('\t').collect();
        let path = folder.join(fields[1]);
        let imported = import(&[Input::File(&path)], &Disk);
        let text = imported.diagnostics.display(&imported.sources).to_string();
        match fields[2] {
            "volume" => assert!(text.contains("unsupported: "), "{}: {text}", fields[0]),
            _ => assert!(!imported.diagnostics.has_errors(), "{text}"),
        }
        if let Some(scene) = imported.scene {
            assert!(!scene.shapes.is_empty() && scene.camera.span.len > 0, "{}", fields[0]);
        }
    }
}
