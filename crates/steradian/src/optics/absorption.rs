//! Attenuation by absorption in a homogeneous medium. All coefficients are natural (base e), not decadic.

use crate::units::Nm;
use std::f32::consts::PI;

/// The share of power that passes a path of length `h` [length] in a medium with absorption coefficient
/// `a` [1/length]: e^(−a h), Bouguer–Lambert, B (2.21). One for a zero path, whatever `a`.
pub fn bouguer(a: f32, h: f32) -> f32 {
    if h == 0.0 { 1.0 } else { (-a * h).exp() }
}

/// The share of power that passes a path of length `h` [length] in a solution of concentration `c`
/// [amount/volume] whose specific absorption is `a` [area/amount]: e^(−a c h), Beer, B (2.22).
pub fn beer(a: f32, c: f32, h: f32) -> f32 {
    bouguer(a * c, h)
}

/// The imaginary part μ of the complex index of refraction of a medium with absorption coefficient
/// `a` [nm⁻¹] at the vacuum wavelength `lambda`: a λ / 4π, B (2.23). Dimensionless.
pub fn extinction_index(a: f32, lambda: Nm) -> f32 {
    a * lambda.0 / (4.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn successive_layers_multiply() {
        let (a, h0, h1) = (1.7, 0.4, 1.1);
        assert!((bouguer(a, h0) * bouguer(a, h1) - bouguer(a, h0 + h1)).abs() < 1e-6);
        assert_eq!(bouguer(f32::INFINITY, 0.0), 1.0);
    }

    #[test]
    fn half_of_the_power_is_left_after_ln_2_absorption_lengths() {
        assert!((beer(0.5, 2.0, std::f32::consts::LN_2) - 0.5).abs() < 1e-7);
    }

    #[test]
    fn a_wave_decays_by_e_over_one_absorption_length_of_its_own_index() {
        // Intensity along z is e^(−4π μ z / λ): with μ from a, that is e^(−a z).
        let (a, lambda) = (0.01, 550.0);
        let mu = extinction_index(a, Nm(lambda));
        let z = 1.0 / a;
        assert!(((-4.0 * PI * mu * z / lambda).exp() - (-1.0_f32).exp()).abs() < 1e-6);
    }
}
