//! Spectra that stand for RGB triples, with pbrt's three meanings.

use super::sigmoid::Sigmoid;
use super::tabulated::Dense;

/// A reflectance or transmittance in [0, 1] (pbrt-v4 book, 4.6.6, `RGBAlbedoSpectrum`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbAlbedo {
    /// The reflectance.
    pub sigmoid: Sigmoid,
}

/// A smooth non-negative function of any size: an absorption coefficient, an index (pbrt's `RGBUnboundedSpectrum`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbUnbounded {
    /// Factor, twice the largest component: the shape then stays at or below one half.
    pub scale: f32,
    /// The shape.
    pub sigmoid: Sigmoid,
}

/// The light of an RGB display: the colour space's illuminant, filtered (pbrt's `RGBIlluminantSpectrum`).
#[derive(Clone, Debug, PartialEq)]
pub struct RgbIlluminant {
    /// Factor, twice the largest component.
    pub scale: f32,
    /// The filter.
    pub sigmoid: Sigmoid,
    /// The colour space's white, shared.
    pub illuminant: Dense,
}

impl RgbUnbounded {
    /// The value at `lambda` [nm].
    pub fn at(&self, lambda: f32) -> f32 {
        self.scale * self.sigmoid.at(lambda)
    }
}

impl RgbIlluminant {
    /// The value at `lambda` [nm], in the illuminant's unit.
    pub fn at(&self, lambda: f32) -> f32 {
        self.scale * self.sigmoid.at(lambda) * self.illuminant.at(lambda)
    }
}
