//! The closed family of spectra.

use super::blackbody::Blackbody;
use super::cie;
use super::rgb::{RgbAlbedo, RgbIlluminant, RgbUnbounded};
use super::sampled::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled, Wavelengths};
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
    #[inline(always)]
    pub fn sample<Q>(&self, w: &Wavelengths) -> Sampled<Q> {
        let l = w.lambda();
        match self {
            Self::Constant(v) => Sampled::splat(*v),
            Self::Dense(d) => Sampled::from_array(d.sample(w)),
            Self::RgbAlbedo(r) => Sampled::from_array(at_each(l, |l| r.sigmoid.at(l))),
            _ => Sampled::from_array(self.sample_rarer(w)),
        }
    }

    /// [`Spectrum::sample`] for the kinds that are not worth their room in every caller.
    #[inline(never)]
    fn sample_rarer(&self, w: &Wavelengths) -> [f32; LANES] {
        let l = w.lambda();
        match self {
            Self::Constant(_) | Self::Dense(_) | Self::RgbAlbedo(_) => at_each(l, |l| self.at(l)),
            Self::Tabulated(t) => at_each(l, |l| t.at(l)),
            Self::Blackbody(b) => at_each(l, |l| b.at(l)),
            Self::RgbUnbounded(r) => at_each(l, |l| r.at(l)),
            Self::RgbIlluminant(r) => {
                // Apart, because the table's gathers would keep the filter's arithmetic from being vectorised.
                let filter = at_each(l, |l| r.scale * r.sigmoid.at(l));
                let mut out = r.illuminant.sample(w);
                out.iter_mut().zip(filter).for_each(|(white, filter)| *white *= filter);
                out
            }
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

/// A loop, because `array::map` is not always inlined, and then not vectorised.
#[inline(always)]
fn at_each(lambda: &[f32; LANES], f: impl Fn(f32) -> f32) -> [f32; LANES] {
    let mut out = [0.0; LANES];
    for (out, &lambda) in out.iter_mut().zip(lambda) {
        *out = f(lambda);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::sigmoid::Sigmoid;
    use super::*;
    use crate::units::{Kelvin, Unitless};

    fn specimens() -> Vec<Spectrum> {
        let sigmoid = Sigmoid { c0: 3.0, c1: -2.0, c2: -0.5 };
        let dense = Dense::sample_function(LAMBDA_MIN, cie::SAMPLES, |l| 0.01 * l);
        vec![
            Spectrum::Constant(0.7),
            Spectrum::Tabulated(Tabulated::new(&[(400.0, 1.0), (500.0, 3.0), (650.0, 0.5)]).unwrap()),
            Spectrum::Dense(dense.clone()),
            Spectrum::Blackbody(Blackbody::normalized(Kelvin(5000.0))),
            Spectrum::RgbAlbedo(RgbAlbedo { sigmoid }),
            Spectrum::RgbUnbounded(RgbUnbounded { scale: 4.0, sigmoid }),
            Spectrum::RgbIlluminant(RgbIlluminant { scale: 2.0, sigmoid, illuminant: dense }),
        ]
    }

    #[test]
    fn sampling_a_path_agrees_with_evaluating_each_wavelength() {
        for s in specimens() {
            for i in 0..50 {
                let w = Wavelengths::sample_visible((i as f32 + 0.5) / 50.0);
                let sampled: Sampled<Unitless> = s.sample(&w);
                assert_eq!(sampled.to_array(), w.lambda().map(|l| s.at(l)), "{s:?}");
            }
        }
    }

    #[test]
    fn the_maximum_bounds_every_value() {
        for s in specimens() {
            let max = s.max_value();
            assert!((3600..=8300).all(|l| s.at(l as f32 * 0.1) <= max * (1.0 + 1e-5)), "{s:?}");
        }
    }

    #[test]
    fn scaling_scales_values_and_integrals() {
        for s in specimens() {
            let t = s.clone().scaled(2.5);
            for l in [410.0, 555.0, 640.0] {
                assert!((t.at(l) - 2.5 * s.at(l)).abs() <= 1e-5 * t.at(l).abs(), "{s:?}");
            }
            let factor = if matches!(s, Spectrum::RgbIlluminant(_)) { 1.0 } else { 2.5 };
            assert!((t.photometric_integral() / s.photometric_integral() - factor).abs() < 1e-5, "{s:?}");
        }
    }

    #[test]
    fn photometric_integrals_of_known_spectra() {
        assert!(
            (Spectrum::Constant(2.0).photometric_integral() / (2.0 * cie::Y_INTEGRAL) - 1.0).abs() < 1e-6
        );
        // A line of 2 nm base and unit peak at 555 nm, where ȳ = 1: the table sees one sample of 1.
        let line = Tabulated::new(&[(554.0, 0.0), (555.0, 1.0), (556.0, 0.0)]).unwrap();
        assert_eq!(Spectrum::Tabulated(line).photometric_integral(), 1.0);
        // A black body at the freezing point of platinum, 2042 K, defined the candela until 1979: 60 cd/cm².
        let platinum = Spectrum::Blackbody(Blackbody::absolute(Kelvin(2042.0)));
        let luminance = crate::units::LUMENS_PER_WATT * platinum.photometric_integral();
        assert!((luminance / 6.0e5 - 1.0).abs() < 0.02, "{luminance}");
    }

    #[test]
    fn dense_sampling_keeps_values_at_whole_nanometres() {
        for s in specimens() {
            let d = s.densely_sampled();
            for l in [360.0, 401.0, 555.0, 830.0] {
                assert_eq!(d.at(l), s.at(l));
            }
        }
    }

    #[test]
    fn only_wavelength_independent_spectra_are_constant() {
        let constant: Vec<_> = specimens().iter().map(Spectrum::constant_value).collect();
        assert_eq!(constant, [Some(0.7), None, None, None, None, None, None]);
        let grey = Spectrum::RgbUnbounded(RgbUnbounded { scale: 3.0, sigmoid: Sigmoid::constant(0.5) });
        assert!((grey.constant_value().unwrap() - 1.5).abs() < 1e-6);
    }
}
