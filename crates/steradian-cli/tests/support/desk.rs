//! A folder to run the program in.
#![allow(dead_code, reason = "each test binary uses its part of this module")]
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

use serde_json::Value;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A folder to work in, with a scene as `scene.pbrt`.
pub(crate) struct Desk(TempDir);

impl Desk {
    pub(crate) fn new(scene: &str) -> Self {
        let desk = Self(TempDir::new().unwrap());
        desk.put("scene.pbrt", scene);
        desk
    }

    pub(crate) fn put(&self, name: &str, contents: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), contents).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).unwrap()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The files in the folder, by name.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// The program, called in the folder; it finds its standard input closed.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_steradian"));
        command.current_dir(self.0.path()).args(arguments).stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Said {
        Said::of(self.command(arguments).output().unwrap())
    }

    /// Runs with `input` on standard input.
    pub(crate) fn run_with(&self, arguments: &[&str], input: &str) -> Said {
        let mut command = self.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // A program that refuses its arguments does not read.
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        Said::of(child.wait_with_output().unwrap())
    }
}

/// What a run answered.
#[derive(Debug)]
pub(crate) struct Said {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Said {
    pub(crate) fn of(o: Output) -> Self {
        let text = |b: Vec<u8>| String::from_utf8(b).unwrap();
        let said = Self { code: o.status.code(), out: text(o.stdout), err: text(o.stderr) };
        assert!(!said.err.contains("panicked"), "{said:?}");
        said
    }

    #[track_caller]
    pub(crate) fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "{self:?}");
        self
    }

    /// Failed with exactly that on standard error.
    #[track_caller]
    pub(crate) fn failed(self, message: &str) {
        assert_eq!((self.code, self.err.trim_end(), self.out.as_str()), (Some(1), message, ""));
    }

    /// Refused the arguments, with that text in the message.
    #[track_caller]
    pub(crate) fn refused(self, text: &str) {
        assert_eq!(self.code, Some(2), "{self:?}");
        assert!(self.err.contains(text) && self.out.is_empty(), "{self:?}");
    }
}
