//! What a spectrum is worth to the eye: photopic, scotopic and α-opic integrals.
//!
//! Sums at 1 nm over the published tables, as the CIE prescribes (CIE 15, CIE S 026); a spectrum with lines narrower than that
//! must be averaged over nanometres before.

use super::cie;
use super::function::Spectrum;
use super::sampled::LAMBDA_MIN;
use crate::units::{
    Efficacy, Estimate, LCone, LUMENS_PER_WATT, Luminous, MCone, Measured, Melanopic, Nm, Rhodopic,
    SCOTOPIC_LUMENS_PER_WATT, SCone, Scotopic, Unit, Weighted,
};

/// First wavelength of the table of receptors [nm]; the last one is 780 nm.
const FIRST: f32 = 380.0;

/// V′, s_sc, s_mc, s_lc and s_mel at 1 nm.
static RECEPTORS: [[f32; 5]; 401] = include!("../../data/cie_receptors.rs");

/// A domain whose weighting function is known.
pub trait Response: Weighted {
    /// What a watt is worth at the maximum of the weighting function [lm·W⁻¹; 1 for α-opic domains].
    const PEAK: f64;

    /// The weighting function, at most 1, at whole nanometres [nm]: its first wavelength, then one value per nanometre.
    fn table() -> (f32, impl ExactSizeIterator<Item = f64>);
}

macro_rules! responses {
    ($($domain:ty: $peak:expr, $column:literal;)*) => {$(
        impl Response for $domain {
            const PEAK: f64 = $peak;
            fn table() -> (f32, impl ExactSizeIterator<Item = f64>) {
                (FIRST, RECEPTORS.iter().map(|row| f64::from(row[$column])))
            }
        }
    )*};
}

responses! {
    Scotopic: SCOTOPIC_LUMENS_PER_WATT as f64, 0;
    Rhodopic: 1.0, 0;
    SCone: 1.0, 1;
    MCone: 1.0, 2;
    LCone: 1.0, 3;
    Melanopic: 1.0, 4;
}

impl Response for Luminous {
    const PEAK: f64 = LUMENS_PER_WATT as f64;
    fn table() -> (f32, impl ExactSizeIterator<Item = f64>) {
        (LAMBDA_MIN, cie::table().iter().map(|bars| f64::from(bars[1])))
    }
}

/// The weighting function of a domain at a wavelength, in [0, 1]: V(λ), V′(λ) or an action spectrum, linear between whole nanometres and
/// zero outside of its table (V: 360–830 nm; V′ and action spectra: 380–780 nm, those of the cones from 390 nm).
pub fn response<D: Response>(lambda: Nm) -> f64 {
    let (first, values) = D::table();
    let last = values.len() - 1;
    let x = f64::from(lambda.0) - f64::from(first);
    if !(0.0..=last as f64).contains(&x) {
        return 0.0;
    }
    let below = (x as usize).min(last - 1);
    let mut pair = values.skip(below);
    let (a, b) = (pair.next().unwrap_or(0.0), pair.next().unwrap_or(0.0));
    a + (b - a) * (x - below as f64)
}

/// What monochromatic radiation is worth, K(λ) = K_m V(λ) and its like.
pub fn efficacy_at<D: Response>(lambda: Nm) -> Efficacy<D> {
    Efficacy::new(D::PEAK * response::<D>(lambda))
}

/// What a spectral quantity is worth as a whole, K_m ∫ X_λ V(λ) dλ and its like. The values of the spectrum are X_λ in the SI unit of
/// `K` per nanometre.
pub fn weigh<K: Unit<D>, D: Response>(spectrum: &Spectrum) -> Measured<K, D> {
    Measured::exact(integral::<D>(|lambda| f64::from(spectrum.at(lambda))))
}

/// As [`weigh`] for samples (wavelength [nm], X_λ with its interval) in ascending order, linear in between and zero outside.
///
/// Instruments use the same random numbers at all wavelengths, so that errors may go together: half-widths add with their weights,
/// which bounds the half-width of the sum.
pub fn weigh_samples<K: Unit<D>, D: Response>(samples: &[(f64, Estimate)]) -> Measured<K, D> {
    let mut sum = Estimate::exact(0.0);
    for (i, (lambda, sample)) in samples.iter().enumerate() {
        let beside = |other: Option<&(f64, Estimate)>, x: f64| {
            other.is_some_and(|(end, _)| {
                (x - lambda) * (end - lambda) >= 0.0 && (x - end) * (lambda - end) > 0.0
            })
        };
        let (before, after) = (i.checked_sub(1).and_then(|j| samples.get(j)), samples.get(i + 1));
        // The hat function of the sample: 1 here, 0 at its neighbours.
        let weight = integral::<D>(|x| {
            let x = f64::from(x);
            match (before, after) {
                _ if x == *lambda => 1.0,
                (Some((end, _)), _) if beside(before, x) => (x - end) / (lambda - end),
                (_, Some((end, _))) if beside(after, x) => (x - end) / (lambda - end),
                _ => 0.0,
            }
        });
        sum.value += weight * sample.value;
        sum.half_width += weight * sample.half_width;
    }
    Measured::new(sum)
}

/// What one watt of radiation within `range` [nm] of a spectrum is worth, K = ∫ X_λ K(λ) dλ / ∫ X_λ dλ; `None` for a spectrum without power
/// there.
pub fn efficacy<D: Response>(spectrum: &Spectrum, range: [f32; 2]) -> Option<Efficacy<D>> {
    let [lo, hi] = range;
    // Trapezoids of at most 1 nm.
    let steps = f64::from(hi - lo).ceil().max(1.0);
    let width = f64::from(hi - lo) / steps;
    let value = |i: f64| {
        let lambda = f64::from(lo) + i * width;
        let weight = if i == 0.0 || i == steps { 0.5 } else { 1.0 };
        let x = weight * width * f64::from(spectrum.at(lambda as f32));
        [x, x * D::PEAK * response::<D>(Nm(lambda as f32))]
    };
    let sums =
        (0..=steps as u32).map(|i| value(f64::from(i))).fold([0.0; 2], |s, v| [s[0] + v[0], s[1] + v[1]]);
    (sums[0] > 0.0).then(|| Efficacy::new(sums[1] / sums[0]))
}

fn integral<D: Response>(f: impl Fn(f32) -> f64) -> f64 {
    let (first, values) = D::table();
    D::PEAK * values.enumerate().map(|(i, s)| s * f(first + i as f32)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::super::named;
    use super::*;
    use crate::units::{AlphaOpic, Irradiance};

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
    }

    #[test]
    fn both_eyes_agree_on_the_candela() {
        // At 540 THz, 555.016 nm in air, a watt is 683 lm by definition (SI, 2019), by day and by night.
        close(efficacy_at::<Luminous>(Nm(555.016)).value(), 683.0, 1e-5);
        close(efficacy_at::<Scotopic>(Nm(555.016)).value(), 683.0, 1e-4);
        assert_eq!(response::<Scotopic>(Nm(507.0)), 1.0);
        assert_eq!(
            [
                response::<Scotopic>(Nm(379.9)),
                response::<Melanopic>(Nm(781.0)),
                response::<SCone>(Nm(f32::NAN))
            ],
            [0.0; 3]
        );
        // Linear in between: V′(555) = 0.402, V′(556) = 0.3864.
        close(response::<Rhodopic>(Nm(555.5)), 0.3942, 1e-6);
    }

    fn daylight<A: Response + AlphaOpic>() -> f64
    where
        Irradiance: Unit<A>,
    {
        let d65 = named("stdillum-D65").unwrap();
        weigh::<Irradiance, A>(&d65).value() / weigh::<Irradiance, Luminous>(&d65).value()
    }

    #[test]
    fn daylight_has_the_efficacies_of_cie_s_026() {
        // Published to 10⁻⁷ W/lm; the table's last digit is what may differ.
        for (ours, published) in [
            (daylight::<SCone>(), SCone::DAYLIGHT_EFFICACY),
            (daylight::<MCone>(), MCone::DAYLIGHT_EFFICACY),
            (daylight::<LCone>(), LCone::DAYLIGHT_EFFICACY),
            (daylight::<Rhodopic>(), Rhodopic::DAYLIGHT_EFFICACY),
            (daylight::<Melanopic>(), Melanopic::DAYLIGHT_EFFICACY),
        ] {
            assert!((ours - published).abs() < 6e-8, "{ours} {published}");
        }
    }

    #[test]
    fn incandescent_light_is_poor_in_melanopic_daylight() {
        // Illuminant A: melanopic DER 0.496 and scotopic over photopic 1.41 (CIE S 026; CIE 191:2010).
        let a = named("stdillum-A").unwrap();
        let lux = weigh::<Irradiance, Luminous>(&a).value();
        close(weigh::<Irradiance, Melanopic>(&a).equivalent_daylight().value() / lux, 0.496, 2e-3);
        close(weigh::<Irradiance, Scotopic>(&a).value() / lux, 1.41, 5e-3);
    }

    #[test]
    fn a_table_weighs_what_its_spectrum_weighs() {
        let d65 = named("stdillum-D65").unwrap();
        let samples: Vec<_> = (0..=106).map(|i| 300.0 + 5.0 * f64::from(i)).collect();
        let samples: Vec<_> = samples
            .iter()
            .map(|&l| {
                (
                    l,
                    Estimate {
                        value: f64::from(d65.at(l as f32)),
                        half_width: 0.01 * f64::from(d65.at(l as f32)),
                    },
                )
            })
            .collect();
        let table = weigh_samples::<Irradiance, Luminous>(&samples);
        close(table.value(), weigh::<Irradiance, Luminous>(&d65).value(), 1e-5);
        close(table.estimate().half_width, 0.01 * table.value(), 1e-9);
        assert_eq!(weigh_samples::<Irradiance, Luminous>(&[]).value(), 0.0);
    }

    #[test]
    fn the_efficacy_of_a_flat_band_is_the_mean_of_its_wavelengths() {
        let flat = Spectrum::Constant(2.0);
        let all = efficacy::<Luminous>(&flat, [360.0, 830.0]).unwrap();
        close(all.value(), f64::from(LUMENS_PER_WATT * cie::Y_INTEGRAL) / 470.0, 1e-5);
        let narrow = efficacy::<Melanopic>(&flat, [489.9, 490.1]).unwrap();
        close(narrow.value(), 1.0, 1e-4);
        assert!(efficacy::<Luminous>(&Spectrum::Constant(0.0), [400.0, 500.0]).is_none());
    }
}
