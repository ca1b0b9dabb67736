//! How an index of refraction depends on wavelength: closed forms.
//!
//! Wavelengths are vacuum wavelengths in nanometres.

/// The helium d line [nm], the wavelength of n_d.
pub const LINE_D: f32 = 587.5618;
/// The hydrogen F line [nm], the blue one of an Abbe number.
pub const LINE_F: f32 = 486.1327;
/// The hydrogen C line [nm], the red one of an Abbe number.
pub const LINE_C: f32 = 656.2725;

/// Cauchy's series n(λ) = A + B/λ² + C/λ⁴ + D/λ⁶ (Cauchy 1836), for transparent media far from their absorption bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cauchy {
    /// The index at infinite wavelength.
    pub a: f32,
    /// Coefficient of λ⁻² [nm²]; above 0 in normal dispersion.
    pub b: f32,
    /// Coefficient of λ⁻⁴ [nm⁴].
    pub c: f32,
    /// Coefficient of λ⁻⁶ [nm⁶].
    pub d: f32,
}

impl Cauchy {
    /// The index at `lambda_nm` [nm], above 0.
    #[inline]
    pub fn at(&self, lambda_nm: f32) -> f32 {
        let inverse = (lambda_nm * lambda_nm).recip();
        self.a + (self.b + (self.c + self.d * inverse) * inverse) * inverse
    }
}

/// One resonance of a medium: a band of absorption that bends the index around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    /// B, dimensionless.
    pub strength: f32,
    /// The vacuum wavelength λ₀ of the resonance [nm].
    pub wavelength: f32,
}

/// Sellmeier's formula n² = 1 + A + Σ B λ²/(λ² − λ₀²) (Sellmeier 1871), for transparent media between their resonances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sellmeier {
    /// A, the share of resonances too far off to be seen; zero in the original form.
    pub constant: f32,
    /// The resonances.
    pub terms: &'static [Resonance],
}

impl Sellmeier {
    /// The index at `lambda_nm` [nm], above 0 and not at a resonance.
    pub fn at(&self, lambda_nm: f32) -> f32 {
        // (λ₀/λ)² instead of λ²: no overflow, and no cancellation but near the resonance itself.
        let sum: f32 = self
            .terms
            .iter()
            .map(|t| {
                let ratio = t.wavelength / lambda_nm;
                t.strength / ((1.0 - ratio) * (1.0 + ratio))
            })
            .sum();
        (1.0 + self.constant + sum).sqrt()
    }
}

/// A closed form of the index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Formula {
    /// Sum of resonances.
    Sellmeier(Sellmeier),
    /// Power series.
    Cauchy(Cauchy),
}

/// A formula that was fitted to measurements, with the range that it was fitted in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dispersion {
    /// Name of the medium, as scene files call its table.
    pub name: &'static str,
    /// The formula.
    pub formula: Formula,
    /// First and last vacuum wavelength [nm] of the fit.
    pub range: (f32, f32),
    /// The medium and the publication of the fit.
    pub reference: &'static str,
}

impl Dispersion {
    /// The index at `lambda_nm` [nm]; `None` outside the range of the fit.
    pub fn at(&self, lambda_nm: f32) -> Option<f32> {
        let (first, last) = self.range;
        (first..=last).contains(&lambda_nm).then(|| match self.formula {
            Formula::Sellmeier(formula) => formula.at(lambda_nm),
            Formula::Cauchy(formula) => formula.at(lambda_nm),
        })
    }

    /// The Abbe number V_d = (n_d − 1)/(n_F − n_C); `None` if a line is outside the range.
    pub fn abbe_number(&self) -> Option<f32> {
        Some((self.at(LINE_D)? - 1.0) / (self.at(LINE_F)? - self.at(LINE_C)?))
    }
}

/// The two-term Cauchy dispersion of a medium of index `n_d` at the d line and Abbe number
/// V_d = (n_d − 1)/(n_F − n_C), both of which it meets.
///
/// `v_d` is 20–90 for real glasses; an infinite one means no dispersion, and so does one that is not above 0,
/// which no medium has.
pub fn from_abbe(n_d: f32, v_d: f32) -> Cauchy {
    let inverse_square = |lambda: f32| 1.0 / (f64::from(lambda) * f64::from(lambda));
    let spread = if v_d > 0.0 { (f64::from(n_d) - 1.0) / f64::from(v_d) } else { 0.0 };
    let b = spread / (inverse_square(LINE_F) - inverse_square(LINE_C));
    Cauchy { a: (f64::from(n_d) - b * inverse_square(LINE_D)) as f32, b: b as f32, c: 0.0, d: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_index_and_abbe_number_asked_for_come_back() {
        for (n_d, v_d) in [(1.516_80, 64.17), (1.784_72, 25.68), (1.33, 55.8), (2.417, 55.3)] {
            let n = from_abbe(n_d, v_d);
            assert!((n.at(LINE_D) - n_d).abs() < 3e-7, "{n:?}");
            let v = (n.at(LINE_D) - 1.0) / (n.at(LINE_F) - n.at(LINE_C));
            assert!((v / v_d - 1.0).abs() < 1e-4, "{v} {v_d}");
            assert!((360..830).all(|l| n.at(l as f32) > n.at((l + 1) as f32)));
        }
    }

    #[test]
    fn crown_glass_is_met_to_1e_3_over_the_visible_from_two_catalogue_numbers() {
        // Schott N-BK7 data sheet: n_h (404.6561 nm) 1.53024, n_e (546.074 nm) 1.51872, n_r (706.5188 nm) 1.51289.
        let n = from_abbe(1.516_80, 64.17);
        for (lambda, index) in [(404.6561, 1.530_24), (546.074, 1.518_72), (706.5188, 1.512_89)] {
            assert!((n.at(lambda) - index).abs() < 1e-3, "{lambda}: {}", n.at(lambda));
        }
    }

    #[test]
    fn no_abbe_number_means_no_dispersion() {
        for v_d in [f32::INFINITY, 0.0, -3.0, f32::NAN] {
            assert_eq!(from_abbe(1.5, v_d), Cauchy { a: 1.5, b: 0.0, c: 0.0, d: 0.0 });
        }
    }
}
