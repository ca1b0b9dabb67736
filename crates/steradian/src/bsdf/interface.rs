//! The indices of refraction behind a scattering function.

use crate::optics::fresnel::{Polarized, conductor_polarized, dielectric_polarized};
use crate::spectrum::Sampled;
use crate::units::Unitless;

/// The bare interface that light meets first: relative complex index η + jk of the far side over the near one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Real part, above 0.
    pub eta: Sampled<Unitless>,
    /// Imaginary part, at least 0; zero at every wavelength for a dielectric.
    pub k: Sampled<Unitless>,
}

impl Interface {
    /// A clear interface of an index that is the same at all of one path's wavelengths.
    pub fn clear(eta: f32) -> Self {
        Self { eta: Sampled::splat(eta), k: Sampled::ZERO }
    }

    /// Fresnel's reflectances in the given lane at a cosine to the normal in [−1, 1]; below zero means from inside, for
    /// clear interfaces only.
    pub fn reflectance(&self, lane: usize, cos_theta: f32) -> Polarized {
        if self.k[lane] == 0.0 {
            dielectric_polarized(cos_theta, self.eta[lane])
        } else {
            conductor_polarized(cos_theta, self.eta[lane], self.k[lane])
        }
    }
}
