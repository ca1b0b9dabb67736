//! Functions of wavelength.

pub mod sampled;

pub use sampled::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled, Wavelengths};
