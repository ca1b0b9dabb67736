//! The pbrt-v4 importer: a graphics state machine over the directives of a scene.
//!
//! Here, and only here, the names of classes and parameters are known. Everything that a description refers to by
//! name in the files is an [`Id`](crate::scene::desc::Id) when the import is done.

mod args;
mod camera;
mod context;
mod entities;
mod film;
mod finish;
mod input;
mod integrator;
mod light;
mod machine;
mod material;
mod medium;
mod names;
mod options;
mod sampler;
mod shape;
mod sky;
mod spectrum;
mod state;
#[cfg(test)]
mod tests;
mod texture;

pub use input::{Imported, Input};

use crate::scene::files::FileSystem;

/// Reads a scene. Several inputs are read one after another as if they were one file, each with its own folder.
///
/// Never fails as a whole: whatever is wrong is in [`Imported::diagnostics`], all of it as far as
/// it can be told apart from consequences.
pub fn import(inputs: &[Input<'_>], files: &dyn FileSystem) -> Imported {
    let mut importer = machine::Importer::new(files);
    for input in inputs {
        importer.read(input);
    }
    finish::finish(importer)
}
