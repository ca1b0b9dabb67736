//! Colours that can be told apart on white paper.

use super::drawing::Ink;
use crate::color::transfer::srgb_encode;
use crate::color::{ColorSpace, ColorSpaceKind, Rgb, Xyz};
use crate::math::Vec3;
use crate::spectrum::cie;

/// Brightest luminance of a line relative to the paper: above it, yellow is not seen.
const MAX_LUMINANCE: f32 = 0.4;

/// The colour of monochromatic light of that wavelength [nm], as near as sRGB comes and dark enough for paper.
/// What is invisible has the colour of the nearer end of the spectrum.
pub fn wavelength_ink(lambda: f64) -> Ink {
    // Beyond these ends the hue does not change, but the eye's sensitivity falls to nothing.
    let [x, y, z] = cie::bars(lambda.clamp(405.0, 690.0) as f32);
    let space = ColorSpace::new(ColorSpaceKind::Srgb);
    let rgb = space.rgb_from_xyz(Xyz::new(x, y, z)).0.max(Vec3::ZERO);
    let rgb = rgb / rgb.max_element().max(f32::MIN_POSITIVE);
    let luminance = space.luminance(Rgb(rgb));
    let rgb = rgb * (MAX_LUMINANCE / luminance.max(f32::MIN_POSITIVE)).min(1.0);
    let encoded = |c: f32| (srgb_encode(c.clamp(0.0, 1.0)) * 255.0).round() as u8;
    Ink::new(encoded(rgb.x), encoded(rgb.y), encoded(rgb.z))
}

/// Colours for things that have none of their own, also for those who see fewer of them (Okabe and Ito 2008,
/// the light ones darkened); they repeat after seven.
pub fn series_ink(index: usize) -> Ink {
    const INKS: [Ink; 7] = [
        Ink::new(0, 114, 178),
        Ink::new(213, 94, 0),
        Ink::new(0, 134, 98),
        Ink::new(181, 84, 143),
        Ink::new(196, 137, 0),
        Ink::new(58, 153, 208),
        Ink::new(60, 60, 60),
    ];
    INKS[index % INKS.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_have_the_colours_that_they_are_called_by() {
        let [blue, green, yellow, red] = [450.0, 530.0, 578.0, 650.0].map(wavelength_ink);
        assert!(blue.b > 2 * blue.g && blue.b > blue.r, "{blue:?}");
        assert!(green.g > green.r && green.g > green.b, "{green:?}");
        assert!(yellow.r > yellow.b && yellow.g > yellow.b, "{yellow:?}");
        assert!(red.r > 2 * red.g && red.r > 2 * red.b, "{red:?}");
        assert_eq!(wavelength_ink(300.0), wavelength_ink(380.0));
    }
}
