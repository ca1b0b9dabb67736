//! How stored numbers relate to linear light.

use crate::color::transfer::{gamma_decode, gamma_encode, srgb_decode, srgb_encode};

/// The curve between a stored value in [0, 1] and linear light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorEncoding {
    /// IEC 61966-2-1.
    Srgb,
    /// Stored values are linear.
    Linear,
    /// linear = stored^γ.
    Gamma(f32),
}

impl ColorEncoding {
    /// Reads `sRGB`, `linear` or `gamma <value>`, pbrt-v4's spelling; `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        match text {
            "sRGB" => Some(Self::Srgb),
            "linear" => Some(Self::Linear),
            _ => {
                let gamma: f32 = text.strip_prefix("gamma ")?.trim().parse().ok()?;
                (gamma.is_finite() && gamma > 0.0).then_some(Self::Gamma(gamma))
            }
        }
    }

    /// Linear value of a stored value in [0, 1].
    pub fn to_linear(self, stored: f32) -> f32 {
        match self {
            Self::Srgb => srgb_decode(stored),
            Self::Linear => stored,
            Self::Gamma(gamma) => gamma_decode(stored, gamma),
        }
    }

    /// Stored value of a linear value; inverse of [`ColorEncoding::to_linear`].
    pub fn from_linear(self, linear: f32) -> f32 {
        match self {
            Self::Srgb => srgb_encode(linear),
            Self::Linear => linear,
            Self::Gamma(gamma) => gamma_encode(linear, gamma),
        }
    }

    /// Nearest 8-bit code of a linear value; values outside [0, 1] saturate, NaN becomes 0.
    pub fn quantize(self, linear: f32) -> u8 {
        // The cast of a float to an integer saturates, and maps NaN to zero.
        (self.from_linear(linear) * 255.0 + 0.5) as u8
    }

    /// Linear values of all 8-bit codes.
    pub(crate) fn table(self) -> Box<[f32; 256]> {
        Box::new(std::array::from_fn(|code| self.to_linear(code as f32 / 255.0)))
    }
}

/// [`ColorEncoding::quantize`] for many values, by search instead of powers.
pub(super) struct Quantizer {
    /// Where each code ends and the next begins, in linear light.
    ends: [f32; 255],
    /// The code of the start of each of equal parts of [0, 1].
    guide: [u8; GUIDES],
}

/// Enough for a step or two in the dark, where codes are densest.
const GUIDES: usize = 4096;

impl Quantizer {
    pub(super) fn new(encoding: ColorEncoding) -> Self {
        let ends = std::array::from_fn(|code| encoding.to_linear((code as f32 + 0.5) / 255.0));
        let mut quantizer = Self { ends, guide: [0; GUIDES] };
        let mut code = 0;
        for i in 0..GUIDES {
            code = quantizer.advance(code, i as f32 / GUIDES as f32);
            quantizer.guide[i] = code;
        }
        quantizer
    }

    /// Nearest code of a linear value.
    #[inline]
    pub(super) fn code(&self, linear: f32) -> u8 {
        // The cast of a float to an integer saturates, and maps NaN to zero.
        let part = ((linear * GUIDES as f32) as usize).min(GUIDES - 1);
        self.advance(self.guide[part], linear)
    }

    /// The code of a linear value that is not below the start of `code`.
    #[inline]
    fn advance(&self, mut code: u8, linear: f32) -> u8 {
        while self.ends.get(usize::from(code)).is_some_and(|&end| linear >= end) {
            code += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_values_are_quantised_as_one_is() {
        for encoding in [ColorEncoding::Srgb, ColorEncoding::Linear, ColorEncoding::Gamma(2.2)] {
            let quantizer = Quantizer::new(encoding);
            for i in -100..70_000 {
                let v = (i as f32 / 60_000.0).powi(3);
                let exact = encoding.from_linear(v) * 255.0 + 0.5;
                // Rounding decides where two codes meet.
                if (exact - exact.round()).abs() > 1e-3 {
                    assert_eq!(quantizer.code(v), encoding.quantize(v), "{encoding:?} {v}");
                }
            }
            for v in [f32::NAN, f32::NEG_INFINITY, f32::INFINITY] {
                assert_eq!(quantizer.code(v), encoding.quantize(v), "{encoding:?} {v}");
            }
        }
    }

    #[test]
    fn every_code_survives_decoding_and_quantising() {
        for encoding in [ColorEncoding::Srgb, ColorEncoding::Linear, ColorEncoding::Gamma(2.2)] {
            for (code, &linear) in encoding.table().iter().enumerate() {
                assert_eq!(usize::from(encoding.quantize(linear)), code, "{encoding:?}");
            }
        }
    }

    #[test]
    fn quantising_saturates_and_turns_nan_black() {
        assert_eq!(ColorEncoding::Srgb.quantize(7.0), 255);
        assert_eq!(ColorEncoding::Srgb.quantize(-0.5), 0);
        assert_eq!(ColorEncoding::Srgb.quantize(f32::NAN), 0);
    }

    #[test]
    fn names_are_read_as_pbrt_spells_them() {
        assert_eq!(ColorEncoding::parse("sRGB"), Some(ColorEncoding::Srgb));
        assert_eq!(ColorEncoding::parse("gamma 2.2"), Some(ColorEncoding::Gamma(2.2)));
        assert_eq!(ColorEncoding::parse("gamma -1"), None);
        assert_eq!(ColorEncoding::parse("srgb"), None);
    }
}
