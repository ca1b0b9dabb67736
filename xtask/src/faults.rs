//! Plants faults into scattering functions and shows which laws of the conformance suite catch which.

use std::path::Path;
use std::process::{Command, Stdio};

/// The module that holds the faults; it is compiled for tests only.
const MODULE: &str = "bsdf::conformance::faults";

/// Runs the tests of the faults; the text is the kill matrix, and an error where a fault goes unnoticed.
pub(crate) fn run(root: &Path) -> Result<String, String> {
    let output = Command::new("cargo")
        .args(["test", "--quiet", "--package", "steradian", "--lib", MODULE, "--", "--nocapture"])
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("cargo: {e}"))?;
    let said = String::from_utf8_lossy(&output.stdout);
    let matrix = said.find("kill matrix").and_then(|from| said[from..].split("\n\n").next());
    match matrix {
        Some(matrix) if output.status.success() => {
            Ok(format!("{matrix}\n\nevery fault is caught by the law named for it"))
        }
        Some(matrix) => {
            Err(format!("{matrix}\n\na fault is missed, or a sound function is accused: see above"))
        }
        None => Err(format!("the tests of {MODULE} did not run\n{said}")),
    }
}
