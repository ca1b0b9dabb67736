//! From the RGB of a texel to the spectrum that it stands for.

use crate::color::{ColorSpace, Factored, Rgb, UpsamplingTable};
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::Unitless;
use std::sync::Arc;

/// A colour space in the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ColorTableId(pub(super) u32);

/// What an RGB texel stands for, by the parameter that it feeds (pbrt-v4 book, 4.6.6).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumUse {
    /// A reflectance; components are clamped to [0, 1].
    Albedo,
    /// A smooth quantity without upper bound.
    Unbounded,
    /// Light: the colour space's white, filtered.
    Illuminant,
}

/// The spectra of a colour space's RGB triples.
#[derive(Clone, Debug)]
pub(super) struct ColorTable {
    table: Arc<UpsamplingTable>,
    illuminant: Spectrum,
}

impl ColorTable {
    /// `table` must have been built from `space`.
    pub(super) fn new(space: &ColorSpace, table: Arc<UpsamplingTable>) -> Self {
        Self { table, illuminant: space.illuminant().clone() }
    }

    /// The spectrum of a triple whose components are not negative.
    pub(super) fn sample(&self, rgb: Rgb, reading: SpectrumUse, w: &Wavelengths) -> Sampled<Unitless> {
        let shape = |rgb, scale: f32| {
            let sigmoid = self.table.sigmoid(rgb);
            Sampled::from_fn(|lane| scale * sigmoid.at(w.lambda()[lane]))
        };
        match reading {
            SpectrumUse::Albedo => shape(rgb, 1.0),
            SpectrumUse::Unbounded => {
                let Factored { scale, shape: factored } = Factored::new(rgb);
                shape(factored, scale)
            }
            SpectrumUse::Illuminant => {
                let Factored { scale, shape: factored } = Factored::new(rgb);
                shape(factored, scale) * self.illuminant.sample::<Unitless>(w)
            }
        }
    }
}
