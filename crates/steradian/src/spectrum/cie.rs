//! CIE 1931 2° colour matching functions, 360–830 nm at 1 nm, linear in between, zero outside.

use super::sampled::{LAMBDA_MAX, LAMBDA_MIN, Wavelengths};
use glam::Vec4;

/// ∫ ȳ dλ [nm]: the constant by which tristimulus values are normalised to Y = 1 for l ≡ 1.
///
/// The figure in use since pbrt-v2; the sum of the table differs from it by 2·10⁻⁷.
pub const Y_INTEGRAL: f32 = 106.856_895;

/// Number of entries of the tables: one per nanometre, both ends included.
pub const SAMPLES: usize = 471;

const MATCHING: [[f32; 3]; SAMPLES] = include!("../../data/cie_1931_2deg.rs");

/// x̄, ȳ, z̄ at `LAMBDA_MIN` + i nanometres, for i = 0 … 470.
pub fn table() -> &'static [[f32; 3]; SAMPLES] {
    static TABLE: [[f32; 3]; SAMPLES] = MATCHING;
    &TABLE
}

/// The tables with a fourth column of zeros: a row is one load.
static ROWS: [[f32; 4]; SAMPLES] = {
    let mut rows = [[0.0; 4]; SAMPLES];
    let mut i = 0;
    while i < SAMPLES {
        rows[i] = [MATCHING[i][0], MATCHING[i][1], MATCHING[i][2], 0.0];
        i += 1;
    }
    rows
};

/// x̄, ȳ, z̄ and 0 at the wavelength `lane`.
#[inline]
pub(crate) fn bars_at(w: &Wavelengths, lane: usize) -> Vec4 {
    match w.row(lane).and_then(|(i, t)| Some((ROWS.get(i..i + 2)?, t))) {
        Some((&[a, b], t)) => {
            let (a, b) = (Vec4::from_array(a), Vec4::from_array(b));
            a + (b - a) * t
        }
        _ => Vec4::ZERO,
    }
}

/// x̄, ȳ and z̄ at `lambda` [nm].
pub fn bars(lambda: f32) -> [f32; 3] {
    if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
        return [0.0; 3];
    }
    let x = lambda - LAMBDA_MIN;
    let i = (x as i32 as usize).min(SAMPLES - 2);
    let t = x - i as f32;
    let (a, b) = (ROWS[i], ROWS[i + 1]);
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * t)
}

/// Colour matching function x̄ at `lambda` [nm].
pub fn x_bar(lambda: f32) -> f32 {
    bars(lambda)[0]
}

/// Colour matching function ȳ at `lambda` [nm], equal to the luminous efficiency V.
pub fn y_bar(lambda: f32) -> f32 {
    bars(lambda)[1]
}

/// Colour matching function z̄ at `lambda` [nm].
pub fn z_bar(lambda: f32) -> f32 {
    bars(lambda)[2]
}

/// ∫ f ȳ dλ for a function of wavelength [nm]; the sum over the table at 1 nm, as the CIE prescribes.
pub fn luminous_integral(mut f: impl FnMut(f32) -> f32) -> f32 {
    let mut sum = 0.0_f64;
    for (i, row) in table().iter().enumerate() {
        sum += f64::from(f(LAMBDA_MIN + i as f32)) * f64::from(row[1]);
    }
    sum as f32
}

/// ∫ f x̄, f ȳ, f z̄ dλ [nm·unit of f], by the sum over the table at 1 nm.
pub fn tristimulus_integral(mut f: impl FnMut(f32) -> f32) -> [f64; 3] {
    let mut sum = [0.0_f64; 3];
    for (i, row) in table().iter().enumerate() {
        let v = f64::from(f(LAMBDA_MIN + i as f32));
        for (s, &bar) in sum.iter_mut().zip(row) {
            *s += v * f64::from(bar);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matching_functions_integrate_to_the_normalisation_constant() {
        let [x, y, z] = tristimulus_integral(|_| 1.0);
        assert!((y / f64::from(Y_INTEGRAL) - 1.0).abs() < 1e-6, "{y}");
        // The equal-energy stimulus is white: all three integrals agree within the table's rounding.
        assert!((x / y - 1.0).abs() < 1e-4 && (z / y - 1.0).abs() < 4e-4, "{x} {y} {z}");
        assert_eq!(luminous_integral(|_| 1.0), y as f32);
    }

    #[test]
    fn luminous_efficiency_peaks_at_555_nm_with_one() {
        assert_eq!(y_bar(555.0), 1.0);
        assert!((0..=470).all(|i| y_bar(360.0 + i as f32) <= 1.0));
    }

    #[test]
    fn lookup_is_linear_between_entries_and_zero_outside() {
        assert_eq!(x_bar(600.5), 0.5 * (x_bar(600.0) + x_bar(601.0)));
        assert_eq!(z_bar(830.0), table()[470][2]);
        assert_eq!([y_bar(359.9), y_bar(830.1), y_bar(f32::NAN)], [0.0; 3]);
    }
}
