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

/// A total that a light is scaled to; it replaces the amount of the light's spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Total {
    /// Luminous flux [lm]; of lights at infinity the illuminance [lx] of a plane.
    Luminous(f32),
    /// Radiant flux within 360–830 nm [W]; of lights at infinity the irradiance of a plane [W·m⁻²].
    Radiant(f32),
    /// Largest luminous intensity [cd]; of surfaces and of lights at infinity the mean luminance [cd·m⁻²].
    Directional(f32),
}

impl Total {
    /// The number, in the unit of its variant.
    pub fn value(self) -> f32 {
        match self {
            Self::Luminous(v) | Self::Radiant(v) | Self::Directional(v) => v,
        }
    }

    /// The same kind of total, times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Self::Luminous(v) => Self::Luminous(v * factor),
            Self::Radiant(v) => Self::Radiant(v * factor),
            Self::Directional(v) => Self::Directional(v * factor),
        }
    }
}

/// What the scene states about a light's amount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// Factor on everything.
    pub scale: f32,
    /// Whether the spectrum is a shape or an amount.
    pub amount: Amount,
    /// The total that the light is scaled to.
    pub total: Option<Total>,
}

impl Default for Stated {
    fn default() -> Self {
        Self { scale: 1.0, amount: Amount::Photometric, total: None }
    }
}

/// What a light gives while its spectrum, or the white of its picture, is taken as it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Yield {
    /// K_m ∫ ȳ of that spectrum: what stands for 1 cd/m², 1 cd or 1 lx [lm per unit].
    pub(super) unit: f32,
    /// In the sense of [`Total::Luminous`].
    pub(super) luminous: f32,
    /// In the sense of [`Total::Radiant`].
    pub(super) radiant: f32,
    /// In the sense of [`Total::Directional`].
    pub(super) directional: f32,
}

impl Stated {
    /// The factor that makes the light's spectrum or picture absolute.
    ///
    /// A total replaces the amount that the spectrum's own normalisation gives; `scale` multiplies it.
    pub(super) fn multiplier(&self, light: &Yield) -> Result<f32, LightError> {
        for v in [Some(self.scale), self.total.map(Total::value)].into_iter().flatten() {
            if !(v >= 0.0 && v.is_finite()) {
                return Err(LightError::Amount(v));
            }
        }
        let over = |wanted: f32, given: f32, why: LightError| match given > 0.0 {
            true => Ok(self.scale * wanted / given),
            false => Err(why),
        };
        let dark = if light.unit > 0.0 { LightError::Black } else { LightError::Invisible };
        match (self.total, self.amount) {
            (Some(Total::Luminous(lm)), _) => over(lm, light.luminous, dark),
            (Some(Total::Directional(cd)), _) => over(cd, light.directional, dark),
            (Some(Total::Radiant(w)), _) => over(w, light.radiant, LightError::NoRadiantPower),
            (None, Amount::Photometric) => over(1.0, light.unit, LightError::Invisible),
            (None, Amount::Absolute) => Ok(self.scale),
        }
    }

    /// A spectrum that gives exactly what is stated: an RGB triple would keep its own size.
    pub(super) fn measurable(&self, spectrum: Spectrum) -> Spectrum {
        match spectrum {
            Spectrum::RgbIlluminant(_) if self.total.is_some() => Spectrum::Dense(spectrum.densely_sampled()),
            other => other,
        }
    }
}

/// ∫ over 360–830 nm [nm · unit], by the sum over 1 nm.
fn radiant_integral(spectrum: &Spectrum) -> f32 {
    (0..cie::SAMPLES).map(|i| f64::from(spectrum.at(LAMBDA_MIN + i as f32))).sum::<f64>() as f32
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
    /// Applies what is stated; `per_unit` is the total [lm, lx] that the light's geometry makes of a spectrum of 1 cd/m²,
    /// 1 cd or 1 lx.
    pub(super) fn new(spectrum: Spectrum, stated: &Stated, per_unit: f32) -> Result<Self, LightError> {
        Self::with_peak(spectrum, stated, per_unit, 1.0)
    }

    /// [`Emission::new`] for lights that make at most `peak` times as much intensity of their spectrum.
    pub(super) fn with_peak(
        spectrum: Spectrum,
        stated: &Stated,
        per_unit: f32,
        peak: f32,
    ) -> Result<Self, LightError> {
        if spectrum.max_value() <= 0.0 {
            // A black light has no amount to normalise, and needs none.
            stated.multiplier(&Yield { unit: 1.0, luminous: 1.0, radiant: 1.0, directional: 1.0 })?;
            return Ok(Self { spectrum: Spectrum::Constant(0.0), watts: 0.0, lumens: 0.0 });
        }
        let unit = LUMENS_PER_WATT * spectrum.photometric_integral();
        let factor = stated.multiplier(&Yield {
            unit,
            // Of an RGB triple only the white counts here, as in pbrt-v4: the triple keeps its size.
            luminous: unit * per_unit,
            radiant: radiant_integral(&spectrum) * per_unit,
            directional: LUMENS_PER_WATT * cie::luminous_integral(|l| spectrum.at(l)) * peak,
        })?;
        let spectrum = match spectrum.scaled(factor) {
            // One table lookup instead of two and a square root.
            rgb @ Spectrum::RgbIlluminant(_) => Spectrum::Dense(rgb.densely_sampled()),
            other => other,
        };
        let watts = radiant_integral(&spectrum);
        let lumens = LUMENS_PER_WATT * cie::luminous_integral(|l| spectrum.at(l));
        Ok(Self { spectrum, watts, lumens })
    }

    /// Times a factor, finite and not negative.
    pub(super) fn times(&self, factor: f32) -> Self {
        let spectrum = self.spectrum.clone().scaled(factor);
        Self { spectrum, watts: factor * self.watts, lumens: factor * self.lumens }
    }

    /// Values at a path's wavelengths; the owner knows whether they are radiance, intensity or irradiance.
    #[inline(always)]
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
