//! Pieces of work whose instructions are counted.

mod grid;
pub(crate) mod parsing;
mod scan;
mod scenes;
mod transport;

use crate::counting::{self, Kernel};
use std::path::Path;

/// The kernels that the gate guards.
pub(crate) fn gated() -> Vec<Kernel> {
    [transport::KERNELS, parsing::GATED].concat()
}

/// `kernels FOLDER NAME...`: executes kernels, with the files of a folder where they need any. What counts them runs it.
pub(crate) fn run(arguments: &[String]) -> Result<String, String> {
    let [folder, names @ ..] = arguments else { return Err("kernels FOLDER NAME...".to_owned()) };
    let known = [&gated()[..], parsing::OF_FILES, parsing::OF_COLLECTION].concat();
    let find = |name: &String| {
        known.iter().find(|k| k.name == name).copied().ok_or_else(|| format!("there is no kernel `{name}`"))
    };
    let kernels = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
    counting::execute(&kernels, Path::new(folder))
}
