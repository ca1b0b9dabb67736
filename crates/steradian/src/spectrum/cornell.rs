//! The Cornell box: measured reflectances of its paints and the emission of its lamp.
//!
//! Measured by the Cornell University Program of Computer Graphics, published for public use.

use super::function::Spectrum;
use super::sampled::{LAMBDA_MAX, LAMBDA_MIN};
use super::spd;
use super::tabulated::Tabulated;

/// The light's own reflectance.
pub const LIGHT_REFLECTANCE: f32 = 0.78;

fn table(text: &str) -> Option<Tabulated> {
    spd::parse(text).ok()
}

/// A table of the source tree, held at both ends; the tests prove that each of them parses.
fn held(text: &str) -> Spectrum {
    table(text).map_or(Spectrum::Constant(0.0), |t| Spectrum::Tabulated(t.held_to(LAMBDA_MIN, LAMBDA_MAX)))
}

/// Reflectance of the white walls; measured over 400–700 nm, held at its ends.
pub fn white() -> Spectrum {
    held(include_str!("../../data/spectra/cornell-white.spd"))
}

/// Reflectance of the green wall; measured over 400–700 nm, held at its ends.
pub fn green() -> Spectrum {
    held(include_str!("../../data/spectra/cornell-green.spd"))
}

/// Reflectance of the red wall; measured over 400–700 nm, held at its ends.
pub fn red() -> Spectrum {
    held(include_str!("../../data/spectra/cornell-red.spd"))
}

/// Relative emission of the lamp: zero at 400 nm and below, held above 700 nm.
pub fn light() -> Spectrum {
    held(include_str!("../../data/spectra/cornell-light.spd"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_figures_are_kept() {
        assert_eq!([white().at(400.0), green().at(500.0), red().at(700.0)], [0.343, 0.285, 0.642]);
        assert_eq!([red().at(830.0), white().at(360.0)], [0.642, 0.343]);
        assert!((light().at(450.0) - 4.0).abs() < 1e-5);
        assert_eq!([light().at(360.0), light().at(400.0), light().at(800.0)], [0.0, 0.0, 18.4]);
    }
}
