//! Scattering functions: the closed set, in local coordinates.

pub mod contract;

pub use contract::{BsdfSample, Lobe, Lobes, Mode, Side};
