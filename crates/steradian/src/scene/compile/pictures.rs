//! Picture files, each read and decoded once.

use crate::image::{ColorEncoding, Image, ImageError, decode};
use crate::scene::desc::FileRef;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::files::{FileSystem, reason};
use std::path::Path;

/// Reads a picture file, sRGB where neither its format nor the scene says otherwise; failure is reported at the place that names it.
pub(super) fn read(
    files: &dyn FileSystem,
    file: &FileRef,
    encoding: Option<ColorEncoding>,
    diagnostics: &mut Diagnostics,
) -> Option<Image> {
    let read = || -> Result<Image, String> {
        let bytes = files.read(&file.path).map_err(|e| reason(&e))?;
        decode(&bytes, &extension(&file.path), encoding.unwrap_or(ColorEncoding::Srgb))
            .map_err(|e: ImageError| e.to_string())
    };
    read()
        .map_err(|e| diagnostics.error(file.span, format!("cannot read image {}: {e}", file.path.display())))
        .ok()
}

fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default()
}
