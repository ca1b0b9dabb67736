//! Picture files of lights and normal maps, each read and decoded once.

use crate::image::{ColorEncoding, Image, ImageError, decode};
use crate::scene::desc::FileRef;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::files::{FileSystem, reason};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The pictures that were read so far; `None` for one whose fault has been reported.
pub(super) struct Pictures<'a> {
    files: &'a dyn FileSystem,
    known: BTreeMap<(PathBuf, Reading), Option<Arc<Image>>>,
}

/// How the numbers of a file are understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Reading {
    /// Colours: sRGB where the format does not say otherwise.
    Color,
    /// Components of vectors, to which no transfer function applies.
    Vector,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(files: &'a dyn FileSystem) -> Self {
        Self { files, known: BTreeMap::new() }
    }

    /// The picture, which all who ask for it share.
    pub(super) fn get(
        &mut self,
        file: &FileRef,
        reading: Reading,
        diagnostics: &mut Diagnostics,
    ) -> Option<Arc<Image>> {
        let key = (file.path.clone(), reading);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let encoding = match reading {
            Reading::Color => None,
            Reading::Vector => Some(ColorEncoding::Linear),
        };
        let picture = read(self.files, file, encoding, diagnostics).map(Arc::new);
        self.known.insert(key, picture.clone());
        picture
    }
}

/// Reads a picture file, sRGB where neither its format nor the scene says otherwise; failure is reported at the place that names it.
///
/// A texel that is infinite or not a number is a failure: it would spread to every filtered neighbour, and make the
/// whole distribution of a sky undefined.
pub(super) fn read(
    files: &dyn FileSystem,
    file: &FileRef,
    encoding: Option<ColorEncoding>,
    diagnostics: &mut Diagnostics,
) -> Option<Image> {
    let read = || -> Result<Image, String> {
        let bytes = files.read(&file.path).map_err(|e| reason(&e))?;
        let image = decode(&bytes, &extension(&file.path), encoding.unwrap_or(ColorEncoding::Srgb))
            .map_err(|e: ImageError| e.to_string())?;
        match image.first_not_finite() {
            Some((x, y, value)) => {
                Err(format!("the texel in column {x}, row {y} is {value}, not a finite number"))
            }
            None => Ok(image),
        }
    };
    read()
        .map_err(|e| diagnostics.error(file.span, format!("cannot read image {}: {e}", file.path.display())))
        .ok()
}

fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default()
}
