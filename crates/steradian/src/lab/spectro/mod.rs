//! A spectrophotometer with an integrating sphere: what becomes of light of one wavelength that falls on a material.
//!
//! Photons are drawn with the material's own scattering function, and each is counted once: reflected, transmitted, or
//! absorbed where it ends. Materials whose reflectance is a closed form may be read off without a photon.

mod counts;
mod measure;
mod readings;
mod setup;
mod sphere;

pub use counts::binomial;
pub use measure::measure;
pub use readings::{Reading, Spectrum, SphereReadings};
pub use setup::{Face, Incidence, Method, Setup, SpectroError, View};
pub use sphere::{Beams, Sphere, SphereReading};

#[cfg(test)]
mod tests;
