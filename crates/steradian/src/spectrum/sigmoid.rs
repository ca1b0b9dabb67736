//! Smooth reflectances with three coefficients: s(c₀t² + c₁t + c₂), Jakob & Hanika 2019.

use super::sampled::{LAMBDA_MAX, LAMBDA_MIN};

/// Middle of the range that the coefficients describe [nm].
const CENTER: f32 = 0.5 * (LAMBDA_MIN + LAMBDA_MAX);
/// Reciprocal of half the range [nm⁻¹].
const PER_HALF_RANGE: f32 = 2.0 / (LAMBDA_MAX - LAMBDA_MIN);

/// A reflectance in [0, 1]: s(x) = ½ + x / (2√(1 + x²)) of a parabola in t = (λ − 595 nm) / 235 nm.
///
/// Jakob & Hanika 2019, eq. 3–5; our deviation is t ∈ [−1, 1] in place of λ, which keeps the three
/// coefficients of like size. Defined over 360–830 nm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sigmoid {
    /// Coefficient of t².
    pub c0: f32,
    /// Coefficient of t.
    pub c1: f32,
    /// Constant coefficient; infinite for the constants 0 and 1.
    pub c2: f32,
}

impl Sigmoid {
    /// The reflectance that is `value` ∈ [0, 1] at every wavelength.
    pub fn constant(value: f32) -> Self {
        // s(x) = v solved for x; ∓∞ at v = 0 and 1.
        Self { c0: 0.0, c1: 0.0, c2: (value - 0.5) / (value * (1.0 - value)).sqrt() }
    }

    /// The reflectance at `lambda` [nm].
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        let t = (lambda - CENTER) * PER_HALF_RANGE;
        sigmoid((self.c0 * t + self.c1) * t + self.c2)
    }

    /// The largest reflectance over 360–830 nm.
    pub fn max_value(&self) -> f32 {
        let ends = self.at(LAMBDA_MIN).max(self.at(LAMBDA_MAX));
        let vertex = -self.c1 / (2.0 * self.c0);
        // Flat parabolas have their vertex at infinity or, divided 0/0, nowhere.
        if vertex.abs() <= 1.0 { ends.max(sigmoid(self.c2 + 0.5 * self.c1 * vertex)) } else { ends }
    }

    /// The value if it is the same at every wavelength.
    pub fn constant_value(&self) -> Option<f32> {
        (self.c0 == 0.0 && self.c1 == 0.0).then(|| sigmoid(self.c2))
    }
}

#[inline]
fn sigmoid(x: f32) -> f32 {
    // The square overflows beyond 10¹⁹; s has reached 0 or 1 long before.
    let x = x.clamp(-1e9, 1e9);
    0.5 + 0.5 * x / (1.0 + x * x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn constants_come_back() {
        for v in [0.0, 0.01, 0.18, 0.5, 0.9, 1.0] {
            let s = Sigmoid::constant(v);
            assert!((s.at(360.0) - v).abs() < 1e-6 && (s.at(700.0) - v).abs() < 1e-6, "{v}");
            assert!((s.constant_value().unwrap() - v).abs() < 1e-6);
            assert!((s.max_value() - v).abs() < 1e-6);
        }
    }

    proptest! {
        #[test]
        fn reflectance_stays_in_range_and_below_its_maximum(
            c0 in -300.0_f32..300.0, c1 in -300.0_f32..300.0, c2 in -300.0_f32..300.0,
        ) {
            let s = Sigmoid { c0, c1, c2 };
            let values: Vec<f32> = (0..=940).map(|i| s.at(360.0 + 0.5 * i as f32)).collect();
            prop_assert!(values.iter().all(|v| (0.0..=1.0).contains(v)));
            let seen = values.iter().fold(0.0_f32, |a, &b| a.max(b));
            prop_assert!(s.max_value() >= seen - 1e-5);
        }
    }
}
