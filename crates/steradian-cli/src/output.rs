//! What the program says, and the files that it writes.

use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use steradian::image::{Frame, FrameFormat, write_frame};

/// One line (or several) on standard error. A closed stream is nobody's loss.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Text on standard output, for results; the error is that of a closed pipe, which ends the program quietly.
pub(crate) fn print(text: &str) -> Result<(), String> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(format!("cannot write: {e}")),
        _ => Ok(()),
    }
}

/// What went wrong with a file, in words of people.
pub(crate) fn reason(e: &std::io::Error) -> String {
    match e.kind() {
        ErrorKind::NotFound => "no such file".to_owned(),
        ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => e.to_string(),
    }
}

/// A file to be written, known to be writable before the long work begins.
#[derive(Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
}

impl OutputFile {
    /// Checks that a file can be made in the folder.
    pub(crate) fn new(path: &Path) -> Result<Self, String> {
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            return Err(format!("{}: the folder {} does not exist", path.display(), folder.display()));
        }
        if path.is_dir() {
            return Err(format!("{} is a folder", path.display()));
        }
        let file = Self { path: path.to_owned() };
        let partial = file.partial();
        File::create(&partial)
            .and_then(|_| std::fs::remove_file(&partial))
            .map_err(|e| format!("cannot write into the folder of {}: {}", path.display(), reason(&e)))?;
        Ok(file)
    }

    /// As [`OutputFile::new`] for a file of one kind: another extension is most likely an input, named by mistake.
    pub(crate) fn of_kind(path: &Path, extension: &str) -> Result<Self, String> {
        match path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension)) {
            true => Self::new(path),
            false => Err(format!("{}: the name of this file ends in .{extension}", path.display())),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    fn partial(&self) -> PathBuf {
        let mut name = self.path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        self.path.with_file_name(name)
    }

    /// Writes bytes as [`OutputFile::write_with`] does.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), String> {
        self.write_with(|file| file.write_all(bytes).map_err(|e| e.to_string()))
    }

    /// Writes beside the target and renames, so that an older file is never lost to a failed write.
    fn write_with(
        &self,
        write: impl FnOnce(&mut BufWriter<File>) -> Result<(), String>,
    ) -> Result<(), String> {
        let partial = self.partial();
        let failed = |e: &dyn std::fmt::Display| format!("cannot write {}: {e}", self.path.display());
        let written = (|| {
            let mut file = BufWriter::new(File::create(&partial).map_err(|e| failed(&e))?);
            write(&mut file).map_err(|e| failed(&e))?;
            file.flush().map_err(|e| failed(&e))?;
            std::fs::rename(&partial, &self.path).map_err(|e| failed(&e))
        })();
        if written.is_err() {
            // The partial file is of no use; if it cannot be removed either, the first error says why.
            let _ = std::fs::remove_file(&partial);
        }
        written
    }
}

/// A picture to be written.
#[derive(Debug)]
pub(crate) struct Target {
    file: OutputFile,
    format: FrameFormat,
}

impl Target {
    /// Checks the extension, and that a file can be made in the folder.
    pub(crate) fn new(path: &Path) -> Result<Self, String> {
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
        let format =
            FrameFormat::from_extension(&extension).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Self { file: OutputFile::new(path)?, format })
    }

    pub(crate) fn path(&self) -> &Path {
        self.file.path()
    }

    /// Writes the picture; an older one is never lost to a failed write.
    pub(crate) fn write(&self, frame: &Frame) -> Result<(), String> {
        self.file.write_with(|file| write_frame(frame, file, self.format).map_err(|e| e.to_string()))
    }
}
