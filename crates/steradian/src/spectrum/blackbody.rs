//! Thermal radiation: Planck's law.

use crate::units::Kelvin;

/// First radiation constant for spectral radiance, 2hc² in W·m⁻²·sr⁻¹·nm⁴ (SI 2019, exact to the digits).
const C1: f64 = 1.191_042_972_397_188e20;
/// Second radiation constant hc/k in nm·K (SI 2019).
const C2: f64 = 1.438_776_877_503_933e7;
/// Wien's displacement constant λ_max·T in nm·K (SI 2019).
pub const WIEN: f64 = 2.897_771_955_185_172e6;

/// Spectral radiance of a black body [W·m⁻²·sr⁻¹·nm⁻¹] at a wavelength in nm; zero at or below 0 K.
///
/// Planck's law, L = 2hc² / (λ⁵ (e^{hc/λkT} − 1)), pbrt-v4 book (4.17).
pub fn planck(lambda: f64, temperature: f64) -> f64 {
    if temperature <= 0.0 || lambda <= 0.0 {
        return 0.0;
    }
    C1 / (lambda.powi(5) * (C2 / (lambda * temperature)).exp_m1())
}

/// The spectrum of a black body times a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blackbody {
    temperature: f32,
    /// Factor times 2hc², reduced by 10⁻¹⁵ like λ⁵ so that f32 holds both.
    c1: f32,
    /// hc/kT [nm].
    c2_over_t: f32,
}

impl Blackbody {
    /// Spectral radiance in W·m⁻²·sr⁻¹·nm⁻¹; zero everywhere at or below 0 K.
    pub fn absolute(temperature: Kelvin) -> Self {
        Self::with_factor(temperature, 1.0)
    }

    /// The same shape with its maximum, at Wien's wavelength, equal to one: pbrt's `blackbody`.
    pub fn normalized(temperature: Kelvin) -> Self {
        let t = f64::from(temperature.0);
        let peak = planck(WIEN / t, t);
        Self::with_factor(temperature, if peak > 0.0 { 1.0 / peak } else { 0.0 })
    }

    fn with_factor(temperature: Kelvin, factor: f64) -> Self {
        let t = f64::from(temperature.0);
        if t <= 0.0 {
            return Self { temperature: temperature.0, c1: 0.0, c2_over_t: 1.0 };
        }
        Self { temperature: temperature.0, c1: (factor * C1 * 1e-15) as f32, c2_over_t: (C2 / t) as f32 }
    }

    /// The temperature.
    pub fn temperature(&self) -> Kelvin {
        Kelvin(self.temperature)
    }

    /// The value at `lambda` [nm].
    pub fn at(&self, lambda: f32) -> f32 {
        let um = lambda * 1e-3;
        let um2 = um * um;
        self.c1 / (um2 * um2 * um * (self.c2_over_t / lambda).exp_m1())
    }

    /// The largest value, reached at Wien's wavelength.
    pub fn max_value(&self) -> f32 {
        if self.c1 == 0.0 { 0.0 } else { self.at((WIEN / f64::from(self.temperature)) as f32) }
    }

    /// The same spectrum times `factor`.
    #[must_use]
    pub fn scaled(mut self, factor: f32) -> Self {
        self.c1 *= factor;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planck_integrates_to_stefan_boltzmann() {
        // ∫ L dλ = σT⁴/π, σ = 5.670374419·10⁻⁸; Simpson in ln λ from 100 nm to 1 cm.
        let t = 5778.0;
        let (a, b, n) = (100.0_f64.ln(), 1e7_f64.ln(), 4000);
        let h = (b - a) / f64::from(n);
        let sum: f64 = (0..=n)
            .map(|i| {
                let l = (a + h * f64::from(i)).exp();
                let w = if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
                w * planck(l, t) * l
            })
            .sum::<f64>()
            * h
            / 3.0;
        let exact = 5.670_374_419e-8 * t.powi(4) / std::f64::consts::PI;
        assert!((sum / exact - 1.0).abs() < 1e-6, "{sum} {exact}");
    }

    #[test]
    fn the_maximum_obeys_wien() {
        for t in [1000.0_f32, 2856.0, 6504.0, 20_000.0] {
            let b = Blackbody::normalized(Kelvin(t));
            let peak = (WIEN / f64::from(t)) as f32;
            assert!((b.at(peak) - 1.0).abs() < 1e-5, "{}", b.at(peak));
            assert!(b.at(peak * 0.99) < 1.0 && b.at(peak * 1.01) < 1.0);
            assert!((b.max_value() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn single_precision_follows_planck() {
        for t in [300.0_f32, 2856.0, 6504.0] {
            let b = Blackbody::absolute(Kelvin(t));
            for lambda in [250.0_f32, 360.0, 555.0, 830.0, 2500.0] {
                let exact = planck(f64::from(lambda), f64::from(t));
                // The relative error of e^{x} is x times that of x: 190·10⁻⁷ at 300 K and 250 nm. Below
                // f32's normal range the value may vanish.
                assert!((f64::from(b.at(lambda)) - exact).abs() <= 4e-5 * exact + 1e-37, "{lambda} {t}");
            }
        }
    }

    #[test]
    fn nothing_radiates_at_absolute_zero() {
        for b in [Blackbody::absolute(Kelvin(0.0)), Blackbody::normalized(Kelvin(0.0))] {
            assert_eq!([b.at(360.0), b.at(830.0), b.max_value()], [0.0; 3]);
        }
    }
}
