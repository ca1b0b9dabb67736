//! From the wavelengths of a table to every nanometre from 360 to 830.

use crate::spectrum::{LAMBDA_MIN, cie};

/// The linear map from the values of a table to values at every nanometre from 360 to 830.
///
/// Beyond the ends of the table its first and last values are held, CIE 15:2018, 7.2.3. A map and not a function of
/// numbers, because its transpose says how much each row of the table counts in a result.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampling {
    rows: usize,
    /// For each nanometre the rows that enter and their weights.
    terms: Vec<Vec<(usize, f64)>>,
}

/// Differences of wavelengths [nm] below which a table counts as equidistant.
const EVEN: f64 = 1e-3;

impl Resampling {
    /// Straight lines between the samples: the rule for illuminants and for tables of any spacing.
    ///
    /// `wavelengths` [nm] must increase; without any, the result is zero everywhere.
    pub fn linear(wavelengths: &[f64]) -> Self {
        Self::new(wavelengths, |i, t| vec![(i, 1.0 - t), (i + 1, t)])
    }

    /// Fifth-order polynomials through the samples (Sprague 1880), which the CIE recommends for smooth quantities such as
    /// reflectances (CIE 167:2005; CIE 15:2018, 7.2.2.1). `None` unless there are six samples or more at equal distances.
    pub fn sprague(wavelengths: &[f64]) -> Option<Self> {
        let n = wavelengths.len();
        let step = wavelengths.get(1)? - wavelengths[0];
        if n < 6 || wavelengths.windows(2).any(|w| (w[1] - w[0] - step).abs() > EVEN) {
            return None;
        }
        Some(Self::new(wavelengths, |i, t| {
            // Values r₋₂ … r₃ around the interval; those beyond the ends are combinations of the six at that end.
            let powers: [f64; 5] = std::array::from_fn(|p| t.powi(p as i32 + 1));
            let mut terms = Vec::with_capacity(12);
            for k in 0..6 {
                let mut weight = if k == 2 { 1.0 } else { 0.0 };
                weight += POLYNOMIAL.iter().zip(powers).map(|(row, p)| row[k] * p).sum::<f64>() / 24.0;
                match (i + k).checked_sub(2) {
                    Some(row) if row < n => terms.push((row, weight)),
                    Some(row) => {
                        let beyond = BEYOND[row - n + 2];
                        terms.extend(beyond.iter().enumerate().map(|(j, b)| (n - 6 + j, weight * b / 209.0)));
                    }
                    None => {
                        let beyond = BEYOND[i + k];
                        terms.extend(beyond.iter().enumerate().map(|(j, b)| (j, weight * b / 209.0)));
                    }
                }
            }
            terms
        }))
    }

    /// `between(i, t)` gives the weights for a place in the interval after sample i, at the fraction t of it.
    fn new(wavelengths: &[f64], between: impl Fn(usize, f64) -> Vec<(usize, f64)>) -> Self {
        let n = wavelengths.len();
        let at = |lambda: f64| {
            let after = wavelengths.partition_point(|&w| w <= lambda);
            match after {
                _ if n == 0 => Vec::new(),
                0 => vec![(0, 1.0)],
                // At the last sample as well as beyond it.
                _ if after == n => vec![(n - 1, 1.0)],
                _ => {
                    let i = after - 1;
                    between(i, (lambda - wavelengths[i]) / (wavelengths[i + 1] - wavelengths[i]))
                }
            }
        };
        let terms = (0..cie::SAMPLES).map(|i| at(f64::from(LAMBDA_MIN) + i as f64)).collect();
        Self { rows: n, terms }
    }

    /// The values at every nanometre, for one value for each row of the table.
    pub fn apply(&self, values: &[f64]) -> Vec<f64> {
        debug_assert_eq!(values.len(), self.rows);
        self.terms.iter().map(|terms| terms.iter().map(|(row, w)| w * values[*row]).sum()).collect()
    }

    /// How much each row of the table counts in Σ w(λ) s(λ), for a weight at every nanometre.
    pub fn weights(&self, w: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut rows = vec![0.0; self.rows];
        for (i, terms) in self.terms.iter().enumerate() {
            let weight = w(i);
            for (row, t) in terms {
                rows[*row] += weight * t;
            }
        }
        rows
    }
}

/// Coefficients of t to t⁵ (rows) for r₋₂ to r₃, times 24 (CIE 167:2005; Westland et al. 2012, table 4.5).
const POLYNOMIAL: [[f64; 6]; 5] = [
    [2.0, -16.0, 0.0, 16.0, -2.0, 0.0],
    [-1.0, 16.0, -30.0, 16.0, -1.0, 0.0],
    [-9.0, 39.0, -70.0, 66.0, -33.0, 7.0],
    [13.0, -64.0, 126.0, -124.0, 61.0, -12.0],
    [-5.0, 25.0, -50.0, 50.0, -25.0, 5.0],
];

/// The two values before the first six samples and the two after the last six, times 209 (CIE 167:2005).
const BEYOND: [[f64; 6]; 4] = [
    [884.0, -1960.0, 3033.0, -2648.0, 1080.0, -180.0],
    [508.0, -540.0, 488.0, -367.0, 144.0, -24.0],
    [-24.0, 144.0, -367.0, 488.0, -540.0, 508.0],
    [-180.0, 1080.0, -2648.0, 3033.0, -1960.0, 884.0],
];

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(step: usize) -> Vec<f64> {
        (380..=780).step_by(step).map(|l| l as f64).collect()
    }

    #[test]
    fn both_rules_pass_through_the_samples_and_hold_the_ends() {
        let wavelengths = grid(10);
        let values: Vec<f64> = wavelengths.iter().map(|l| (l * 0.05).sin()).collect();
        for map in [Resampling::linear(&wavelengths), Resampling::sprague(&wavelengths).unwrap()] {
            let fine = map.apply(&values);
            for (l, v) in wavelengths.iter().zip(&values) {
                assert!((fine[*l as usize - 360] - v).abs() < 1e-12, "{l}");
            }
            assert_eq!((fine[0], fine[470]), (values[0], values[40]));
        }
    }

    #[test]
    fn sprague_reproduces_parabolas_and_near_the_ends_lines() {
        // The two values beyond each end are right for lines only (CIE 167), so that curves bend there a little.
        let wavelengths = grid(20);
        for (bend, range) in [(3e-5, 420..=740), (0.0, 380..=780)] {
            let f = |l: f64| 2.0 - 0.01 * l + bend * l * l;
            let values: Vec<f64> = wavelengths.iter().map(|&l| f(l)).collect();
            let fine = Resampling::sprague(&wavelengths).unwrap().apply(&values);
            for l in range {
                assert!((fine[l - 360] - f(l as f64)).abs() < 1e-10, "{bend} {l}");
            }
        }
    }

    #[test]
    fn sprague_has_the_published_values() {
        // colour-science 0.4.7, SpragueInterpolator over 7 values: 7.2185025 at 0.5, 6.7295161 at 0.25.
        let y = [5.92, 9.37, 10.8135, 4.51, 69.59, 27.8007, 86.05];
        let wavelengths: Vec<f64> = (0..7).map(|i| 400.0 + 4.0 * f64::from(i)).collect();
        let fine = Resampling::sprague(&wavelengths).unwrap().apply(&y);
        assert!((fine[42] - 7.218_502_5).abs() < 1e-6 && (fine[41] - 6.729_516_1).abs() < 1e-6);
    }

    #[test]
    fn weights_are_the_transpose() {
        let wavelengths = grid(5);
        let map = Resampling::sprague(&wavelengths).unwrap();
        let values: Vec<f64> = wavelengths.iter().map(|l| (l * 0.031).cos().powi(2)).collect();
        let w = |i: usize| (i as f64 * 0.01).sin();
        let direct: f64 = map.apply(&values).iter().enumerate().map(|(i, v)| w(i) * v).sum();
        let by_rows: f64 = map.weights(w).iter().zip(&values).map(|(w, v)| w * v).sum();
        assert!((direct - by_rows).abs() < 1e-10 * direct.abs());
    }

    #[test]
    fn uneven_tables_have_no_sprague() {
        assert_eq!(Resampling::sprague(&[400.0, 410.0, 420.0, 430.0, 441.0, 450.0, 460.0]), None);
        assert_eq!(Resampling::sprague(&[400.0, 410.0]), None);
        assert!(Resampling::linear(&[]).apply(&[]).iter().all(|v| *v == 0.0));
    }
}
