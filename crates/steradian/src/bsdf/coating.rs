//! A thin film on a surface, at a path's wavelengths.

use crate::optics::films::{self, Film};
use crate::spectrum::{LANES, Sampled};
use crate::units::Unitless;

/// A thin film on a surface: what it reflects depends on the wavelength, but no direction does.
#[derive(Clone, Copy, Debug)]
pub struct Coating {
    /// Index of the film over the index of the medium above it.
    pub eta: Sampled<Unitless>,
    /// Thickness [nm], at least 0.
    pub thickness_nm: f32,
    /// Wavelengths [nm].
    pub lambda: [f32; LANES],
}

impl Coating {
    /// Reflectance of unpolarised light on a metal with index eta + j k relative to the medium above.
    pub fn on_conductor(&self, cos: f32, eta: Sampled<Unitless>, k: Sampled<Unitless>) -> Sampled<Unitless> {
        Sampled::from_fn(|i| films::reflectance_conductor(cos, self.film(i), eta[i], k[i], self.lambda[i]))
    }

    /// Reflectance of unpolarised light on an interface with index `eta` below over above; a negative cosine means
    /// incidence from below.
    pub fn on_dielectric(&self, cos: f32, eta: f32) -> Sampled<Unitless> {
        Sampled::from_fn(|i| films::reflectance_dielectric(cos, self.film(i), eta, self.lambda[i]))
    }

    fn film(&self, lane: usize) -> Film {
        Film { eta: self.eta[lane], thickness_nm: self.thickness_nm }
    }
}
