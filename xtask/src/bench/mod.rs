//! The benchmark: every figure that the project claims about its speed, measured against its peers in one run.

mod build;
mod embree;
mod error;
pub(crate) mod job;
mod noise;
mod options;
mod parse;
mod pictures;
mod rays;
mod report;
pub(crate) mod row;
mod samples;
mod scaling;
mod scenes;

use options::Options;
use row::Row;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A part of the benchmark: its name on the command line and how it is run. `Err` says why nothing was measured; the other
/// parts go on.
type Section = (&'static str, fn(&Path, &Options) -> Result<Vec<Row>, String>);

const SECTIONS: &[Section] = &[
    ("rays", rays::measure),
    ("build", build::measure),
    ("parse", parse::measure),
    ("samples", samples::measure),
    ("error", error::measure),
    ("noise", noise::measure),
    ("scaling", scaling::measure),
];

/// `bench [SECTION...] [--embree LIB] [--python EXE] [--baseline EXE] [--scenes DIR] [--reps N] [--triangles N]
/// [--output FILE]`.
pub(crate) fn run(root: &Path, arguments: &[String]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    if let Some(unknown) = options.sections.iter().find(|s| !SECTIONS.iter().any(|(name, _)| name == *s)) {
        let known: Vec<&str> = SECTIONS.iter().map(|(name, _)| *name).collect();
        return Err(format!("there is no section `{unknown}`; there are {}", known.join(", ")));
    }
    // Debug assertions mean that this program was not built as users build theirs: hand over to one that was.
    if cfg!(debug_assertions) {
        let status = Command::new("cargo")
            .args(["run", "--quiet", "--release", "--package", "xtask", "--", "bench"])
            .args(arguments)
            .current_dir(root)
            .status()
            .map_err(|e| format!("cargo: {e}"))?;
        return if status.success() { Ok(String::new()) } else { Err("the benchmark failed".to_owned()) };
    }
    let (mut rows, mut remarks) = (Vec::new(), Vec::new());
    for (name, measure) in SECTIONS {
        if !options.sections.is_empty() && !options.sections.iter().any(|s| s == name) {
            continue;
        }
        match measure(root, &options) {
            Ok(found) => rows.extend(found),
            Err(reason) => remarks.push(format!("{name}: {reason}")),
        }
    }
    let command = format!("cargo xtask bench {}", arguments.join(" "));
    let page = report::markdown(root, command.trim(), &rows, &remarks);
    if let Some(path) = &options.output {
        std::fs::write(path, &page).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(page)
}

/// Our program as users build it.
fn program(root: &Path) -> Result<PathBuf, String> {
    let status = Command::new("cargo")
        .args(["build", "--release", "--quiet", "--package", "steradian-cli"])
        .current_dir(root)
        .status()
        .map_err(|e| format!("cargo: {e}"))?;
    let name = format!("target/release/steradian{}", std::env::consts::EXE_SUFFIX);
    if status.success() { Ok(root.join(name)) } else { Err("the build failed".to_owned()) }
}
