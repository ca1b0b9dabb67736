//! Laws of the importer: every directive does what pbrt-v4 says, every fault is reported at its place.

mod classes;
mod faults;
mod mutations;
mod real;
mod state;

use super::{Imported, Input, import};
use crate::scene::desc::SceneDesc;
use crate::scene::files::MemoryFiles;
use std::path::Path;

fn import_text(text: &str) -> Imported {
    import_with(text, &MemoryFiles::new())
}

fn import_with(text: &str, files: &MemoryFiles) -> Imported {
    import(&[Input::Text { name: "scene.pbrt", bytes: text.as_bytes(), base: Path::new("") }], files)
}

/// The scene of a text that must be right.
fn scene(text: &str) -> SceneDesc {
    let imported = import_text(text);
    assert!(imported.diagnostics.is_empty(), "{}", imported.diagnostics.display(&imported.sources));
    imported.scene.unwrap()
}

/// The scene of the contents of a world that must be right.
fn world(text: &str) -> SceneDesc {
    scene(&format!("WorldBegin\n{text}"))
}

/// What is said about a text, without source lines: `line:column: severity: message (help)`.
fn messages(imported: &Imported) -> Vec<String> {
    let place = |d: &crate::scene::Diagnostic| match d.span {
        Some(span) => {
            let l = imported.sources.location(span);
            let file = if l.file == "scene.pbrt" { "" } else { &format!("{}:", l.file) };
            format!("{file}{}:{}: ", l.line, l.column)
        }
        None => String::new(),
    };
    let help = |d: &crate::scene::Diagnostic| d.help.as_ref().map_or(String::new(), |h| format!(" ({h})"));
    imported
        .diagnostics
        .iter()
        .map(|d| format!("{}{}: {}{}", place(d), d.severity, d.message, help(d)))
        .collect()
}
