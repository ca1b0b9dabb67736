//! Measurements in red, green and blue at a path's wavelengths.

use crate::color::{ColorSpace, ColorSpaceKind, Factored, Rgb, UpsamplingTable};
use crate::spectrum::{LANES, Sampled};
use crate::units::PerSteradian;

/// The smooth spectra of linear sRGB triples of any size.
#[derive(Clone, Debug)]
pub(super) struct RgbUpsampling(UpsamplingTable);

impl RgbUpsampling {
    /// Fits the table: about half a second.
    pub(super) fn new() -> Self {
        Self(UpsamplingTable::build(&ColorSpace::new(ColorSpaceKind::Srgb)))
    }

    /// The spectrum that shows `rgb`, whose negative components count as zero, at `lambda` [nm].
    pub(super) fn at(&self, rgb: [f32; 3], lambda: &[f32; LANES]) -> Sampled<PerSteradian> {
        let [r, g, b] = rgb.map(|c| c.max(0.0));
        let Factored { scale, shape } = Factored::new(Rgb::new(r, g, b));
        let sigmoid = self.0.sigmoid(shape);
        Sampled::from_fn(|lane| scale * sigmoid.at(lambda[lane]))
    }
}
