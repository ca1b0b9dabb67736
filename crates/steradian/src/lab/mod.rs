//! The light laboratory: the scene's own materials under virtual instruments.

pub mod plot;
pub mod portrait;
pub mod preview;
pub mod probe;
pub mod subject;
pub mod verify;

pub use subject::{Subject, UnknownMaterial};
