//! Files that drawings go to.

use crate::output::OutputFile;
use crate::raster;
use std::path::Path;
use steradian::lab::plot::{Drawing, svg};

/// A file that a drawing goes to.
#[derive(Debug)]
pub(crate) struct Sheet {
    file: OutputFile,
    format: SheetFormat,
}

#[derive(Clone, Copy, Debug)]
enum SheetFormat {
    Svg,
    Png,
}

impl Sheet {
    /// Checks the extension, and that a file can be made in the folder.
    pub(crate) fn new(path: &Path) -> Result<Self, String> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let format = match extension.as_str() {
            "svg" => SheetFormat::Svg,
            "png" => SheetFormat::Png,
            _ => return Err(format!("{}: plots are written as .svg or .png", path.display())),
        };
        Ok(Self { file: OutputFile::new(path)?, format })
    }

    pub(crate) fn path(&self) -> &Path {
        self.file.path()
    }

    pub(crate) fn write(&self, drawing: &Drawing) -> Result<(), String> {
        match self.format {
            SheetFormat::Svg => self.file.write(svg(drawing).as_bytes()),
            SheetFormat::Png => self.file.write(&raster::png(drawing)?),
        }
    }
}
