//! Where scene files come from: the disk, or memory in tests and embedders.
//!
//! The only file of the scene layer with unsafe code: large files are memory-mapped.
#![expect(unsafe_code, reason = "memory mapping; the one block carries its SAFETY note")]

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// Files from this size on are mapped rather than read [bytes]: below it, a copy is as fast.
const MAP_FROM: u64 = 1 << 20;

/// The contents of a file, owned or mapped.
#[derive(Debug)]
pub enum FileBytes {
    /// Bytes in memory.
    Owned(Vec<u8>),
    /// A private, read-only mapping of a file.
    Mapped(memmap2::Mmap),
}

impl Deref for FileBytes {
    type Target = [u8];
    fn deref(&self) -> &[u8] {
        match self {
            Self::Owned(v) => v,
            Self::Mapped(m) => m,
        }
    }
}

impl From<Vec<u8>> for FileBytes {
    fn from(v: Vec<u8>) -> Self {
        Self::Owned(v)
    }
}

/// Read access to the files that a scene refers to.
pub trait FileSystem: Sync {
    /// The whole contents of the file at `path`, decompressed when its name ends in `.gz`.
    ///
    /// # Errors
    /// Any failure to open, read or decompress the file.
    fn read(&self, path: &Path) -> io::Result<FileBytes>;
}

/// The files of the machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl FileSystem for Disk {
    fn read(&self, path: &Path) -> io::Result<FileBytes> {
        let mut file = File::open(path)?;
        let meta = file.metadata()?;
        if meta.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "is a directory"));
        }
        let bytes = if meta.is_file() && meta.len() >= MAP_FROM {
            // SAFETY: the mapping is private and read-only, and lives no longer than `FileBytes`. A file that another
            // process truncates or rewrites meanwhile is outside what any reader of mapped files can guard against.
            FileBytes::Mapped(unsafe { memmap2::Mmap::map(&file)? })
        } else {
            let mut v = Vec::with_capacity(usize::try_from(meta.len()).unwrap_or(0));
            file.read_to_end(&mut v)?;
            FileBytes::Owned(v)
        };
        decompress_if_gz(path, bytes)
    }
}

/// Files held in memory, by path; for tests, fuzzing and scenes that are generated.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl MemoryFiles {
    /// No files.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same files and one more; a file of the same path is replaced.
    #[must_use]
    pub fn with(mut self, path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.insert(path.into(), bytes.into());
        self
    }
}

impl FileSystem for MemoryFiles {
    fn read(&self, path: &Path) -> io::Result<FileBytes> {
        let bytes = self.files.get(path).ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))?;
        decompress_if_gz(path, FileBytes::Owned(bytes.clone()))
    }
}

/// What went wrong with a file, without the operating system's numbers.
pub(super) fn reason(e: &io::Error) -> String {
    match e.kind() {
        io::ErrorKind::NotFound => "no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => e.to_string(),
    }
}

fn decompress_if_gz(path: &Path, bytes: FileBytes) -> io::Result<FileBytes> {
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("gz")) {
        return Ok(bytes);
    }
    let mut out = Vec::new();
    flate2::read::MultiGzDecoder::new(&*bytes).read_to_end(&mut out)?;
    Ok(FileBytes::Owned(out))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gz(data: &[u8]) -> Vec<u8> {
        let mut e = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        e.write_all(data).unwrap();
        e.finish().unwrap()
    }

    #[test]
    fn small_large_and_compressed_files_read_back_equal() {
        let dir = tempfile::tempdir().unwrap();
        let large: Vec<u8> = (0..(MAP_FROM + 7)).map(|i| (i * 31 % 251) as u8).collect();
        for (name, on_disk, expected) in [
            ("small.pbrt", b"WorldBegin".to_vec(), b"WorldBegin".to_vec()),
            ("large.pbrt", large.clone(), large.clone()),
            ("empty.pbrt", Vec::new(), Vec::new()),
            ("scene.pbrt.gz", gz(&large), large.clone()),
        ] {
            let path = dir.path().join(name);
            std::fs::write(&path, on_disk).unwrap();
            let read = Disk.read(&path).unwrap();
            assert_eq!(&*read, &expected[..], "{name}");
            assert_eq!(matches!(read, FileBytes::Mapped(_)), name == "large.pbrt");
        }
        assert_eq!(Disk.read(dir.path()).unwrap_err().kind(), io::ErrorKind::IsADirectory);
        assert_eq!(Disk.read(&dir.path().join("none")).unwrap_err().kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn damaged_gzip_is_an_error() {
        let mut data = gz(b"some text that is long enough to be cut");
        data.truncate(data.len() - 12);
        let files = MemoryFiles::new().with("a.gz", data).with("b.gz", b"not gzip".to_vec());
        assert!(files.read(Path::new("a.gz")).is_err());
        assert!(files.read(Path::new("b.gz")).is_err());
    }
}
