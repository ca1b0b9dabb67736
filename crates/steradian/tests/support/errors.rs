//! What a user sees of a wrong scene.

use std::path::Path;
use steradian::scene::import::pbrt::{Imported, Input, import};
use steradian::scene::{MemoryFiles, Severity, compile};

/// Imports and compiles; asserts that the errors, as a user sees them, are `expected`, and that no scene comes out of them.
#[track_caller]
pub(crate) fn expect_of(input: Input<'_>, files: &MemoryFiles, expected: &str) {
    let Imported { scene, sources, mut diagnostics } = import(&[input], files);
    let job = scene.and_then(|desc| compile(desc, files, &mut diagnostics));
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
    let shown: Vec<String> = errors.map(|d| d.display(&sources).to_string()).collect();
    assert_eq!(shown.join("\n"), expected.trim_matches('\n'));
    assert!(job.is_none() && diagnostics.has_errors(), "a scene in spite of the errors");
}

/// The same for a text named `scene.pbrt` and the files that it reads.
#[track_caller]
pub(crate) fn expect_with<'a>(
    text: &str,
    files: impl IntoIterator<Item = (&'a str, &'a [u8])>,
    expected: &str,
) {
    let files = files.into_iter().fold(MemoryFiles::new(), |all, (name, bytes)| all.with(name, bytes));
    let input = Input::Text { name: "scene.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    expect_of(input, &files, expected);
}

/// The same for a text alone.
#[track_caller]
pub(crate) fn expect(text: &str, expected: &str) {
    expect_with(text, [], expected);
}
