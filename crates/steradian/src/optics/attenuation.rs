//! Means of the transmitted share over the directions of diffuse light, for absorbing bodies without reflection.

use super::absorption::NaturalAbsorbance;

/// The share of diffuse (Lambertian) light that passes a slab whose absorbance along the normal is `depth`:
/// 2 E₃(τ) = ∫₀¹ 2 μ e^(−τ/μ) dμ, in [0, 1], with a relative error below 1e-13.
///
/// Up to a depth of 1.5 from (1 − τ) e^(−τ) + τ² E₁(τ) with the series of E₁, beyond from the continued fraction
/// (Abramowitz & Stegun, 5.1.14, 5.1.11, 5.1.22).
pub fn diffuse_transmittance(depth: NaturalAbsorbance) -> f64 {
    let tau = depth.value();
    if tau <= 0.0 {
        return 1.0;
    }
    if tau <= 1.5 {
        let mut e1 = -EULER_MASCHERONI - tau.ln();
        let mut power = -1.0;
        for k in 1..=24 {
            power *= -tau / f64::from(k);
            e1 += power / f64::from(k);
        }
        return (1.0 - tau) * (-tau).exp() + tau * tau * e1;
    }
    // 1/(τ + 3 − 1·3/(τ + 5 − 2·4/(τ + 7 − …))), from its tail.
    let mut fraction = 0.0;
    for k in (1..=60).rev() {
        let k = f64::from(k);
        fraction = k * (k + 2.0) / (tau + 3.0 + 2.0 * k - fraction);
    }
    2.0 * (-tau).exp() / (tau + 3.0 - fraction)
}

const EULER_MASCHERONI: f64 = 0.577_215_664_901_532_9;

/// The mean share of light that passes a sphere without refraction (its index is that of its surroundings) whose
/// diameter has the absorbance `diameter`: 2 [1 − (1 + y) e^(−y)] / y², in [0, 1].
///
/// The mean is over parallel rays that cover the sphere, or over Lambertian directions at a point of its surface: the
/// chord lengths have the same distribution.
pub fn sphere_transmittance(diameter: NaturalAbsorbance) -> f64 {
    let y = diameter.value();
    if y >= 1.0 {
        return 2.0 * (1.0 - (1.0 + y) * (-y).exp()) / (y * y);
    }
    // Σ 2 (k + 1) (−y)^k / (k + 2)!: the closed form cancels.
    let mut sum = 0.0;
    let mut term = 1.0;
    for k in 0..20 {
        let k = f64::from(k);
        sum += (k + 1.0) * term;
        term *= -y / (k + 3.0);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slab(tau: f64) -> f64 {
        diffuse_transmittance(NaturalAbsorbance::new(tau))
    }

    fn sphere(y: f64) -> f64 {
        sphere_transmittance(NaturalAbsorbance::new(y))
    }

    #[test]
    fn diffuse_light_through_a_slab_has_the_checked_values() {
        for (tau, expected) in
            [(0.1, 0.832_582_92), (0.5, 0.443_208_73), (1.0, 0.219_383_93), (2.0, 0.060_266_76)]
        {
            assert!((slab(tau) - expected).abs() < 5e-9, "{tau}: {}", slab(tau));
        }
    }

    #[test]
    fn diffuse_transmittance_is_the_mean_of_bouguers_law() {
        for tau in [1e-3_f64, 0.3, 1.5, 1.501, 5.0, 30.0] {
            let n = 400_000;
            let sum: f64 = (0..n)
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .map(|mu| 2.0 * mu * (-tau / mu).exp())
                .sum();
            assert!((slab(tau) / (sum / f64::from(n)) - 1.0).abs() < 1e-8, "{tau}");
        }
        // The branches meet: the jump is no larger than the slope times the step.
        assert!((slab(1.5) / slab(1.5 + 1e-14) - 1.0).abs() < 1e-13);
        assert_eq!([slab(0.0), slab(1e4)], [1.0, 0.0]);
    }

    #[test]
    fn an_absorbing_sphere_has_the_checked_value_and_limits() {
        assert!((sphere(2.0) - 0.296_997_08).abs() < 5e-9);
        assert_eq!(sphere(0.0), 1.0);
        // The mean chord is two thirds of the diameter.
        assert!(((1.0 - sphere(1e-6)) / 1e-6 - 2.0 / 3.0).abs() < 1e-6);
        assert!((sphere(1.0 - 1e-14) / sphere(1.0) - 1.0).abs() < 1e-13);
        assert!((sphere(1e8) * 5e15 - 1.0).abs() < 1e-12);
    }
}
