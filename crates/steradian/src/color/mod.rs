//! Colour: tristimulus values, RGB spaces, and the spectra that stand for RGB triples.

pub mod adaptation;
pub mod colorimetry;
mod fit;
pub mod space;
pub mod table;
pub mod transfer;
pub mod triple;

pub use crate::spectrum::cie;
pub use adaptation::{Adaptation, ConeModel};
pub use space::{ColorSpace, ColorSpaceKind, Factored, OutOfRange};
pub use table::{UpsamplingTable, UpsamplingTables};
pub use triple::{Chromaticity, Rgb, Xyz};
