//! How much a light emits: the one place where scales, powers and illuminances become absolute units.
//!
//! As in pbrt-v4, a light's spectrum l is divided by its photometric integral, so that scale 1 stands for 1 cd/m²
//! (1 cd, 1 lx): L_λ = scale · l(λ) / (K_m ∫ l ȳ dλ), K_m = 683.002 lm/W.

use super::contract::LightError;
use crate::spectrum::{LAMBDA_MIN, Sampled, Spectrum, Wavelengths, cie};
use crate::units::{LUMENS_PER_WATT, Radiance};

/// Whether a spectrum states amounts by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Amount {
    /// Only its shape counts; amounts are photometric.
    #[default]
    Photometric,
    /// It is in W·m⁻²·sr⁻¹·nm⁻¹ (radiance), W·sr⁻¹·nm⁻¹ (intensity) or W·m⁻²·nm⁻¹ (irradiance).
    Absolute,
}

/// What the scene states about a light's amount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// Factor on everything.
    pub scale: f32,
    /// Whether the spectrum is a shape or an amount.
    pub amount: Amount,
    /// `power` [lm] or `illuminance` [lx]: the total that the light is scaled to.
    pub total: Option<f32>,
}

impl Default for Stated {
    fn default() -> Self {
        Self { scale: 1.0, amount: Amount::Photometric, total: None }
    }
}

impl Stated {
    /// The factor that makes a spectrum with photometric integral `integral` [nm·unit] absolute.
    ///
    /// `per_unit` is the total [lm, lx] that the light's geometry makes of a unit spectrum, one of 1 cd/m², 1 cd or 1 lx.
    /// A total replaces the amount that the spectrum's own normalisation gives; `scale` multiplies it.
    pub(super) fn multiplier(&self, integral: f32, per_unit: f32) -> Result<f32, LightError> {
        for v in [Some(self.scale), self.total].into_iter().flatten() {
            if !(v >= 0.0 && v.is_finite()) {
                return Err(LightError::Amount(v));
            }
        }
        let visible = || {
            if integral > 0.0 {
                Ok(self.scale / (LUMENS_PER_WATT * integral))
            } else {
                Err(LightError::Invisible)
            }
        };
        match (self.total, self.amount) {
            (Some(_), _) if per_unit <= 0.0 => Err(LightError::Black),
            (Some(total), _) => Ok(visible()? * total / per_unit),
            (None, Amount::Photometric) => visible(),
            (None, Amount::Absolute) => Ok(self.scale),
        }
    }
}

/// A spectrum in absolute units, with its integrals.
#[derive(Clone, Debug)]
pub struct Emission {
    spectrum: Spectrum,
    /// ∫ over 360–830 nm [W·…].
    watts: f32,
    /// K_m ∫ ȳ [lm·…].
    lumens: f32,
}

impl Emission {
    /// Applies what is stated; `per_unit` as in [`Stated::multiplier`].
    pub(super) fn new(spectrum: Spectrum, stated: &Stated, per_unit: f32) -> Result<Self, LightError> {
        if spectrum.max_value() <= 0.0 {
            // A black light has no amount to normalise, and needs none.
            stated.multiplier(1.0, 1.0)?;
            return Ok(Self { spectrum: Spectrum::Constant(0.0), watts: 0.0, lumens: 0.0 });
        }
        let factor = stated.multiplier(spectrum.photometric_integral(), per_unit)?;
        let spectrum = match spectrum.scaled(factor) {
            // One table lookup instead of two and a square root.
            rgb @ Spectrum::RgbIlluminant(_) => Spectrum::Dense(rgb.densely_sampled()),
            other => other,
        };
        let watts: f64 =
            (0..cie::SAMPLES).map(|i| f64::from(spectrum.at(LAMBDA_MIN + i as f32))).sum::<f64>();
        let lumens = LUMENS_PER_WATT * cie::luminous_integral(|l| spectrum.at(l));
        Ok(Self { spectrum, watts: watts as f32, lumens })
    }

    /// Values at a path's wavelengths; the owner knows whether they are radiance, intensity or irradiance.
    pub(super) fn at(&self, w: &Wavelengths) -> Sampled<Radiance> {
        self.spectrum.sample(w)
    }

    /// Integral over 360–830 nm [W per the spectrum's geometric unit].
    pub fn watts(&self) -> f32 {
        self.watts
    }

    /// Photometric integral [lm per the spectrum's geometric unit].
    pub fn lumens(&self) -> f32 {
        self.lumens
    }
}
