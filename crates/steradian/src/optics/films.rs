//! Interference in one thin transparent film on an interface, in `f32` for rendering.
//!
//! The field in a film follows the characteristic matrix of Abelès (Born & Wolf, Principles of Optics, 7th ed., 1.6.2),
//! with elements C = cos β and S = sin β / κ1, β = 2π κ1 d / λ, where κ is an index times the cosine of refraction: all
//! of them real for a lossless film, beyond total reflection too. The result equals Airy's sum over all internal
//! reflections. The `multilayer` module holds both in `f64`, for any number of layers.

use super::complex::Complex;
use super::fresnel::normal_index;
use super::real::Real as _;
use std::f32::consts::TAU;

/// A film of uniform thickness, far thinner than the coherence length of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Index of the film over the index of the medium above it, above 0.
    pub eta: f32,
    /// Thickness [nm], at least 0.
    pub thickness_nm: f32,
}

/// The two elements of a film's characteristic matrix that depend on its thickness.
struct Phase {
    /// cos β.
    c: f32,
    /// sin β / κ1.
    s: f32,
    /// κ1², negative for an evanescent field.
    kappa2: f32,
}

impl Film {
    /// From the cosine in the medium above.
    #[inline]
    fn phase(&self, cos_theta: f32, lambda_nm: f32) -> Phase {
        let kappa2 = f32::refracted_square(self.eta, 0.0, cos_theta);
        let kappa = kappa2.abs().sqrt();
        let depth = TAU * self.thickness_nm / lambda_nm;
        let beta = depth * kappa;
        let (c, s) = if beta < 1e-3 {
            // sin β / β = 1 to the rounding of f32.
            (1.0, depth)
        } else if kappa2 > 0.0 {
            let (sin, cos) = beta.sin_cos();
            (cos, sin / kappa)
        } else {
            // cosh β and sinh β / |κ1| over cosh β, which would overflow: a common factor changes no ratio.
            (1.0, beta.tanh() / kappa)
        };
        Phase { c, s, kappa2 }
    }
}

/// The share of unpolarised light that a film on a dielectric reflects, in [0, 1]. The rest is transmitted.
///
/// `eta_below_over_above` is the relative index of the interface without the film. A negative cosine means incidence
/// from below, in the medium under the film; both ends of a refracted ray give the same. Total reflection gives one,
/// and so does grazing incidence. `lambda_nm` [nm] is the wavelength in the medium above: in vacuum, when that is air.
#[inline]
pub fn reflectance_dielectric(
    cos_theta_signed: f32,
    film: Film,
    eta_below_over_above: f32,
    lambda_nm: f32,
) -> f32 {
    let eta = eta_below_over_above;
    let cos = cos_theta_signed.abs().min(1.0);
    // κ0 above and κ2 below.
    let (above, below) = if cos_theta_signed < 0.0 {
        let above2 = eta * eta * f32::refracted_square_from_below(eta, cos);
        (if above2 > 0.0 { above2.sqrt() } else { 0.0 }, eta * cos)
    } else {
        let below2 = f32::refracted_square(eta, 0.0, cos);
        (cos, if below2 > 0.0 { below2.sqrt() } else { 0.0 })
    };
    if above <= 0.0 || below <= 0.0 {
        return 1.0;
    }
    let Phase { c, s, kappa2 } = film.phase(above, lambda_nm);
    let n1 = film.eta * film.eta;
    let n2 = eta * eta;
    let square = |x: f32| x * x;
    // r = ((κ0 − κ2) C + j (κ0κ2 − κ1²) S) / ((κ0 + κ2) C + j (κ0κ2 + κ1²) S), and with n²/κ for κ in the plane of incidence.
    let perpendicular = {
        let (c2, s2) = (square(c), square(s));
        let product = above * below;
        let reflected = square(above - below) * c2 + square(product - kappa2) * s2;
        reflected / (square(above + below) * c2 + square(product + kappa2) * s2)
    };
    let parallel = {
        let (c2, s2) = (square(c), square(s));
        let (direct, inverse) = (n2 * kappa2 / n1, n1 * above * below);
        let (first, second) = (n2 * above, below);
        let reflected = square(second - first) * c2 + square(direct - inverse) * s2;
        reflected / (square(second + first) * c2 + square(direct + inverse) * s2)
    };
    (0.5 * (perpendicular + parallel)).min(1.0)
}

/// The share of unpolarised light that a film on an absorbing medium of relative complex index eta + j k reflects, in
/// [0, 1]. The rest is absorbed.
///
/// Indices are relative to the medium above, which light comes from; the sign of the cosine does not matter. A k of zero
/// is allowed. `lambda_nm` [nm] is the wavelength in the medium above.
#[inline]
pub fn reflectance_conductor(cos_theta: f32, film: Film, eta: f32, k: f32, lambda_nm: f32) -> f32 {
    let cos = cos_theta.abs().min(1.0);
    let Phase { c, s, kappa2 } = film.phase(cos, lambda_nm);
    let kappa = normal_index(cos, eta, k);
    let n2 = Complex::new(eta, k).square();
    let n1 = film.eta * film.eta;
    // Matrix times (1, κ2), and times (κ2, n2²) in the plane of incidence: no division by κ2, which can be zero.
    let perpendicular = reflected_share(
        (Complex::ONE * c - (kappa * s).times_j()) * cos,
        kappa * c - Complex::new(0.0, kappa2 * s),
    );
    let parallel = reflected_share(
        (n2 * c - (kappa * (n1 * s)).times_j()) * cos,
        kappa * c - (n2 * (kappa2 * s / n1)).times_j(),
    );
    (0.5 * (perpendicular + parallel)).min(1.0)
}

/// |x − y|² / |x + y|²; one where both vanish.
#[inline]
fn reflected_share(x: Complex<f32>, y: Complex<f32>) -> f32 {
    let all = (x + y).norm_squared();
    if all > 0.0 { (x - y).norm_squared() / all } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::super::fresnel;
    use super::*;
    use proptest::prelude::*;

    fn film(eta: f32, thickness_nm: f32) -> Film {
        Film { eta, thickness_nm }
    }

    #[test]
    fn a_quarter_wave_coat_reflects_as_its_closed_form() {
        // ((n0 n2 − n1²)/(n0 n2 + n1²))² for 1 | 1.38 | 1.52; a metal without k is the same glass.
        let coat = film(1.38, 550.0 / (4.0 * 1.38));
        assert!((reflectance_dielectric(1.0, coat, 1.52, 550.0) - 0.012_600_79).abs() < 1e-7);
        assert!((reflectance_conductor(1.0, coat, 1.52, 0.0, 550.0) - 0.012_600_79).abs() < 1e-7);
    }

    #[test]
    fn a_soap_film_at_45_degrees_reflects_as_calculated() {
        // Airy in f64: Rs 0.09177912, Rp 0.00475070 at 550 nm.
        let r = reflectance_dielectric(45.0_f32.to_radians().cos(), film(1.33, 300.0), 1.0, 550.0);
        assert!((r - 0.5 * (0.091_779_12 + 0.004_750_70)).abs() < 1e-6, "{r}");
    }

    #[test]
    fn an_air_gap_beyond_the_critical_angle_lets_light_through_as_the_tunnel_formula_says() {
        // Glass | air | glass, n = 1.5 at 45°: T = 1/(1 + α sinh²(y)), α⊥ = (n² − 1)²/(4 n² cos²θ (n² sin²θ − 1)),
        // α∥ = α⊥ ((n² + 1) sin²θ − 1)², y = 2π d √(n² sin²θ − 1)/λ (Zhu et al., Am. J. Phys. 54, 601 (1986)).
        let (n2, s2) = (2.25_f64, 0.5_f64);
        let outside = n2 * s2 - 1.0;
        let a_s = (n2 - 1.0).powi(2) / (4.0 * n2 * (1.0 - s2) * outside);
        let a_p = a_s * ((n2 + 1.0) * s2 - 1.0).powi(2);
        for d in [0.0, 50.0, 200.0, 600.0, 3000.0, 1e5] {
            let sinh2 = (std::f64::consts::TAU * d * outside.sqrt() / 550.0).sinh().powi(2);
            let expected = 1.0 - 0.5 * (1.0 / (1.0 + a_s * sinh2) + 1.0 / (1.0 + a_p * sinh2));
            // Relative to the glass above, in which the wavelength is shorter.
            let gap = film(1.0 / 1.5, d as f32);
            let r = reflectance_dielectric(0.5_f32.sqrt(), gap, 1.0, 550.0 / 1.5);
            assert!((f64::from(r) - expected).abs() < 2e-6, "{d}: {r} {expected}");
        }
    }

    proptest! {
        #[test]
        fn a_film_of_no_thickness_or_of_its_neighbours_index_is_absent(
            cos in -1.0f32..1.0, eta in 0.4f32..3.0, k in 0.0f32..5.0, other in 0.5f32..3.0, d in 0.0f32..2000.0,
        ) {
            let bare = fresnel::dielectric(cos, eta);
            let metal = fresnel::conductor(cos, eta, k);
            for absent in [film(other, 0.0), film(1.0, d), film(eta, d)] {
                let r = reflectance_dielectric(cos, absent, eta, 550.0);
                prop_assert!((r - bare).abs() < 1e-4, "{absent:?} {r} {bare}");
            }
            for absent in [film(other, 0.0), film(1.0, d)] {
                let r = reflectance_conductor(cos, absent, eta, k, 550.0);
                prop_assert!((r - metal).abs() < 1e-4, "{absent:?} {r} {metal}");
            }
        }

        #[test]
        fn both_ends_of_a_refracted_ray_reflect_alike(
            sin in 0.0f64..0.98, eta in 0.4f64..3.0, n in 0.5f32..3.0, d in 0.0f32..1000.0, lambda in 360.0f32..830.0,
        ) {
            // The refracted cosine in f64: its rounding is all that may differ.
            prop_assume!(sin < 0.98 * eta);
            let (above, below) = ((1.0 - sin * sin).sqrt(), (1.0 - sin * sin / (eta * eta)).sqrt());
            let down = reflectance_dielectric(above as f32, film(n, d), eta as f32, lambda);
            let up = reflectance_dielectric(-below as f32, film(n, d), eta as f32, lambda);
            prop_assert!((down - up).abs() < 1e-4, "{down} {up}");
        }

        #[test]
        fn metal_without_absorption_is_a_dielectric_beyond_total_reflection_too(
            cos in 0.0f32..1.0, eta in 0.4f32..3.0, n in 0.5f32..3.0, d in 0.0f32..1000.0, lambda in 360.0f32..830.0,
        ) {
            let glass = reflectance_dielectric(cos, film(n, d), eta, lambda);
            let metal = reflectance_conductor(cos, film(n, d), eta, 0.0, lambda);
            prop_assert!((glass - metal).abs() < 1e-4, "{glass} {metal}");
        }

        #[test]
        fn every_input_gives_a_share(
            cos in prop_oneof![-1.0f32..1.0, Just(0.0), Just(-0.0), Just(1.0), Just(-1.0), -1e-6f32..1e-6],
            eta in prop_oneof![0.01f32..20.0, Just(1.0), Just(0.5)],
            k in prop_oneof![0.0f32..20.0, Just(0.0), Just(1e-20)],
            n in prop_oneof![0.05f32..10.0, Just(1.0), Just(0.5)],
            d in prop_oneof![0.0f32..1e6, Just(0.0), Just(1e-30)],
            lambda in 100.0f32..3000.0,
        ) {
            let share = 0.0..=1.0;
            prop_assert!(share.contains(&reflectance_dielectric(cos, film(n, d), eta, lambda)));
            prop_assert!(share.contains(&reflectance_conductor(cos, film(n, d), eta, k, lambda)));
            prop_assert!((0.0..=1.000_001).contains(&fresnel::conductor(cos, eta, k)));
            prop_assert!((0.0..=1.000_001).contains(&fresnel::dielectric(cos, eta)));
        }
    }
}
