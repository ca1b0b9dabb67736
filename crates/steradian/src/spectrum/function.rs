//! The closed family of spectra.

use super::blackbody::Blackbody;
use super::cie;
use super::rgb::{RgbAlbedo, RgbIlluminant, RgbUnbounded};
use super::sampled::{LAMBDA_MAX, LAMBDA_MIN, Sampled, Wavelengths};
use super::tabulated::{Dense, Tabulated};

/// A function of wavelength. Its unit is its owner's business.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same at every wavelength.
    Constant(f32),
    /// Piecewise linear through samples, zero outside.
    Tabulated(Tabulated),
    /// Sampled at 1 nm, zero outside.
    Dense(Dense),
    /// Thermal radiation.
    Blackbody(Blackbody),
    /// An RGB reflectance.
    RgbAlbedo(RgbAlbedo),
    /// An RGB quantity without upper bound.
    RgbUnbounded(RgbUnbounded),
    /// RGB light.
    RgbIlluminant(RgbIlluminant),
}

impl Spectrum {
    /// The value at `lambda` [nm]; zero outside [`Spectrum::range`] for tabulated data.
    pub fn at(&self, lambda: f32) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Tabulated(t) => t.at(lambda),
            Self::Dense(d) => d.at(lambda),
            Self::Blackbody(b) => b.at(lambda),
            Self::RgbAlbedo(r) => r.sigmoid.at(lambda),
            Self::RgbUnbounded(r) => r.at(lambda),
            Self::RgbIlluminant(r) => r.at(lambda),
        }
    }

    /// The values at the wavelengths of a path, as the quantity that the caller knows them to be.
    pub fn sample<Q>(&self, w: &Wavelengths) -> Sampled<Q> {
        let l = w.lambda();
        match self {
            Self::Constant(v) => Sampled::splat(*v),
            Self::Tabulated(t) => Sampled::from_array(l.map(|l| t.at(l))),
            Self::Dense(d) => Sampled::from_array(l.map(|l| d.at(l))),
            Self::Blackbody(b) => Sampled::from_array(l.map(|l| b.at(l))),
            Self::RgbAlbedo(r) => Sampled::from_array(l.map(|l| r.sigmoid.at(l))),
            Self::RgbUnbounded(r) => Sampled::from_array(l.map(|l| r.at(l))),
            Self::RgbIlluminant(r) => Sampled::from_array(l.map(|l| r.at(l))),
        }
    }

    /// An upper bound of the values, reached or nearly so; over 360–830 nm for RGB spectra.
    pub fn max_value(&self) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Tabulated(t) => t.max_value(),
            Self::Dense(d) => d.max_value(),
            Self::Blackbody(b) => b.max_value(),
            Self::RgbAlbedo(r) => r.sigmoid.max_value(),
            Self::RgbUnbounded(r) => r.scale * r.sigmoid.max_value(),
            Self::RgbIlluminant(r) => r.scale * r.sigmoid.max_value() * r.illuminant.max_value(),
        }
    }

    /// ∫ l ȳ dλ [nm · unit]: what a light's spectrum is divided by, so that scale 1 means 1 cd/m².
    ///
    /// For RGB light it is the integral of the illuminant alone: the triple then keeps its own size (pbrt's rule).
    pub fn photometric_integral(&self) -> f32 {
        match self {
            Self::RgbIlluminant(r) => cie::luminous_integral(|l| r.illuminant.at(l)),
            _ => cie::luminous_integral(|l| self.at(l)),
        }
    }

    /// The value if it does not depend on wavelength by construction; `None` makes an index dispersive.
    pub fn constant_value(&self) -> Option<f32> {
        match self {
            Self::Constant(v) => Some(*v),
            Self::RgbAlbedo(r) => r.sigmoid.constant_value(),
            Self::RgbUnbounded(r) => r.sigmoid.constant_value().map(|v| v * r.scale),
            Self::Tabulated(_) | Self::Dense(_) | Self::Blackbody(_) | Self::RgbIlluminant(_) => None,
        }
    }

    /// The wavelengths for which there are data [nm]; `None` means all.
    pub fn range(&self) -> Option<(f32, f32)> {
        match self {
            Self::Constant(_) | Self::Blackbody(_) => None,
            Self::Tabulated(t) => Some(t.range()),
            Self::Dense(d) => Some(d.range()),
            Self::RgbAlbedo(_) | Self::RgbUnbounded(_) | Self::RgbIlluminant(_) => {
                Some((LAMBDA_MIN, LAMBDA_MAX))
            }
        }
    }

    /// The spectrum times `factor`. A scaled reflectance is no longer bounded by one.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Self::Constant(v) => Self::Constant(v * factor),
            Self::Tabulated(t) => Self::Tabulated(t.scaled(factor)),
            Self::Dense(d) => Self::Dense(d.scaled(factor)),
            Self::Blackbody(b) => Self::Blackbody(b.scaled(factor)),
            Self::RgbAlbedo(r) => Self::RgbUnbounded(RgbUnbounded { scale: factor, sigmoid: r.sigmoid }),
            Self::RgbUnbounded(r) => Self::RgbUnbounded(RgbUnbounded { scale: r.scale * factor, ..r }),
            Self::RgbIlluminant(r) => Self::RgbIlluminant(RgbIlluminant { scale: r.scale * factor, ..r }),
        }
    }

    /// The spectrum at 1 nm over 360–830 nm: one lookup costs the same whatever it was made from.
    pub fn densely_sampled(&self) -> Dense {
        Dense::sample_function(LAMBDA_MIN, cie::SAMPLES, |l| self.at(l))
    }
}
