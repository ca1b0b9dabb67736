//! Parsers of numbers, beside the plain scans that they are held against.

use super::grid::{Faces, Grid};
use super::scan;
use crate::counting::{Kernel, Work};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use steradian::scene::Disk;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::import::ply;

/// Parsers and scans of files that [`write_inputs`] makes.
pub(crate) const OF_FILES: &[Kernel] = &[
    Kernel { name: "pbrt", prepare: |f| Ok(scene(f.join(TEXT))) },
    Kernel { name: "pbrt std", prepare: |f| plain(&[f.join(TEXT)], scan::words_by_std) },
    Kernel { name: "pbrt hand", prepare: |f| plain(&[f.join(TEXT)], scan::digits_by_hand) },
    Kernel { name: "ascii", prepare: |f| meshes(&[f.join(ASCII)]) },
    Kernel { name: "ascii std", prepare: |f| plain(&[f.join(ASCII)], scan::words_by_std) },
    Kernel { name: "ascii hand", prepare: |f| plain(&[f.join(ASCII)], scan::digits_by_hand) },
    Kernel { name: "triangles", prepare: |f| meshes(&[f.join(TRIANGLES)]) },
    Kernel { name: "triangles scan", prepare: |f| plain(&[f.join(TRIANGLES)], scan::words_of_four) },
    Kernel { name: "quads", prepare: |f| meshes(&[f.join(QUADS)]) },
    Kernel { name: "quads scan", prepare: |f| plain(&[f.join(QUADS)], scan::words_of_four) },
];

/// The same for the binary meshes that lie in folders of a folder.
pub(crate) const OF_COLLECTION: &[Kernel] = &[
    Kernel { name: "collection", prepare: |f| meshes(&binary_meshes(f)?) },
    Kernel { name: "collection scan", prepare: |f| plain(&binary_meshes(f)?, scan::words_of_four) },
];

/// Parsers of small inputs, which need no files.
pub(super) const GATED: &[Kernel] = &[
    Kernel {
        name: "pbrt text, a byte",

        prepare: |_| {
            let text = scene_text(60).into_bytes();
            Ok(Box::new(move || {
                let input = Input::Text { name: "", bytes: &text, base: Path::new("") };
                black_box(import(&[input], &Disk));
                text.len() as u64
            }))
        },
    },
    Kernel { name: "ASCII PLY, a byte", prepare: |_| Ok(mesh(vec![Grid::new(60).ascii_ply()])) },
    Kernel {
        name: "binary PLY, a byte",

        prepare: |_| Ok(mesh(vec![Grid::new(150).binary_ply(Faces::Triangles)])),
    },
];

const TEXT: &str = "mesh.pbrt";
const ASCII: &str = "ascii.ply";
const TRIANGLES: &str = "triangles.ply";
const QUADS: &str = "quads.ply";

/// Writes the files that the kernels read: text of about 20 MB, meshes of a million triangles.
pub(crate) fn write_inputs(folder: &Path) -> Result<(), String> {
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))
    };
    write(TEXT, scene_text(390).as_bytes())?;
    let million = Grid::new(708);
    write(ASCII, &million.ascii_ply())?;
    write(TRIANGLES, &million.binary_ply(Faces::Triangles))?;
    write(QUADS, &million.binary_ply(Faces::Quads))
}

fn scene_text(side: usize) -> String {
    format!("WorldBegin\n{}", Grid::new(side).pbrt())
}

/// Reads a scene as far as its description.
fn scene(path: PathBuf) -> Work {
    Box::new(move || {
        let imported = import(&[Input::File(&path)], &Disk);
        // A scene with faults would have been read in part.
        let read = imported.scene.is_some() && !imported.diagnostics.has_errors();
        if read { std::fs::metadata(&path).map_or(0, |m| m.len()) } else { 0 }
    })
}

fn mesh(files: Vec<Vec<u8>>) -> Work {
    Box::new(move || {
        let read = files.iter().filter(|bytes| black_box(ply::parse(bytes)).is_ok());
        read.map(|bytes| bytes.len() as u64).sum()
    })
}

fn meshes(paths: &[PathBuf]) -> Result<Work, String> {
    Ok(mesh(read(paths)?))
}

fn plain(paths: &[PathBuf], scan: fn(&[u8]) -> f32) -> Result<Work, String> {
    let files = read(paths)?;
    Ok(Box::new(move || {
        for bytes in &files {
            black_box(scan(bytes));
        }
        files.iter().map(|bytes| bytes.len() as u64).sum()
    }))
}

fn read(paths: &[PathBuf]) -> Result<Vec<Vec<u8>>, String> {
    paths.iter().map(|p| std::fs::read(p).map_err(|e| format!("{}: {e}", p.display()))).collect()
}

/// The little-endian meshes in `scenes/*/models`.
fn binary_meshes(scenes: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect()
    };
    let mut found = Vec::new();
    for path in entries(scenes).iter().flat_map(|scene| entries(&scene.join("models"))) {
        let binary = path.extension().is_some_and(|e| e == "ply")
            && std::fs::read(&path).is_ok_and(|b| b.windows(13).take(64).any(|w| w == b"little_endian"));
        found.extend(binary.then_some(path));
    }
    found.sort();
    if found.is_empty() { Err(format!("{} holds no meshes", scenes.display())) } else { Ok(found) }
}
