//! Marble: bands of colour along y, displaced by noise.

use super::input::TextureContext;
use super::mapping::{Mapping3d, TexCoord3d};
use super::noise::Octaves;
use super::upsampling::ColorTableId;
use crate::color::Rgb;

/// A marble of the published palette (pbrt-v4 book, exercise of chapter 10; the texture of pbrt since its first edition).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marble {
    /// Surface to texture space.
    pub mapping: Mapping3d,
    /// The noise.
    pub octaves: Octaves,
    /// Factor on texture space.
    pub scale: f32,
    /// How far the noise displaces the bands, in units of scaled texture space.
    pub variation: f32,
    /// The sRGB colour space.
    pub colors: ColorTableId,
}

/// Control points of the colour along a band, in linear sRGB, before [`GAIN`].
const PALETTE: [[f32; 3]; 9] = [
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.5, 0.5, 0.5],
    [0.6, 0.59, 0.58],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.2, 0.2, 0.33],
    [0.58, 0.58, 0.6],
];

/// Brightens the palette.
const GAIN: f32 = 1.5;

impl Marble {
    /// Linear sRGB reflectance at a surface point.
    pub(super) fn rgb(&self, at: &TextureContext) -> Rgb {
        let c = self.mapping.map(at);
        let c = TexCoord3d { p: c.p * self.scale, dpdx: c.dpdx * self.scale, dpdy: c.dpdy * self.scale };
        let phase = c.p.y + self.variation * self.octaves.fbm(&c);
        palette(0.5 + 0.5 * phase.sin())
    }
}

/// The palette at t in [0, 1]: overlapping cubic Bézier segments, each starting one control point later.
fn palette(t: f32) -> Rgb {
    const SEGMENTS: usize = PALETTE.len() - 3;
    let x = t * SEGMENTS as f32;
    let first = (x as usize).min(SEGMENTS - 1);
    let t = x - first as f32;
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    PALETTE[first..]
        .iter()
        .zip(weights)
        .fold(Rgb::default(), |sum, (&[r, g, b], w)| sum + Rgb::new(r, g, b) * (w * GAIN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_palette_is_a_reflectance() {
        for i in 0..=1000 {
            let v = palette(i as f32 / 1000.0).0;
            // A Bézier curve stays within its control points: 0.2 · 1.5 … 0.6 · 1.5.
            assert!(v.min_element() >= 0.3 - 1e-6 && v.max_element() <= 0.9 + 1e-6, "{v}");
        }
        assert!((palette(0.0).0.z - 0.9).abs() < 1e-6);
    }
}
