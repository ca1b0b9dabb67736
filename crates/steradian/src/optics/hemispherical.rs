//! Fresnel reflectance of diffuse light.

/// The share of diffuse (Lambertian) unpolarised light that a smooth dielectric interface reflects:
/// ∫ R(θ) 2 cosθ d(cosθ), in [0, 1], for light that comes from the side over which `eta` is relative.
///
/// Above one, light comes from the thinner side: the closed form of Walsh (1926) as Duntley (1942) has it. Below one it
/// comes from the denser side, where (1 − r) η′² = 1 − r′ with η′ = 1/η relates it to the other side's (reciprocity).
/// The terms cancel near one, where the result tends to zero: the absolute error is about 1e-15/|η − 1|.
pub fn diffuse_reflectance(eta: f64) -> f64 {
    if eta < 1.0 {
        return 1.0 - (1.0 - diffuse_reflectance(eta.recip())) * eta * eta;
    }
    // Here the value itself is below 1e-6, and the closed form would soon be all rounding.
    if eta - 1.0 < 1e-7 {
        return 0.0;
    }
    let n = eta;
    let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
    let below = n - 1.0;
    let a = n2 + 1.0;
    let b = below * (n + 1.0) * a;
    let r = 0.5
        + below * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (below * (n + 1.0)).powi(2) / a.powi(3) * (below / (n + 1.0)).ln()
        - 2.0 * n3 * (n2 + 2.0 * n - 1.0) / (a * b)
        + 8.0 * n4 * (n4 + 1.0) / (a * b * b) * below.ln_1p();
    r.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::fresnel::dielectric_polarized;
    use super::*;

    #[test]
    fn external_and_internal_reflectance_have_the_checked_values() {
        for (n, external, internal) in [
            (1.333, 0.066_405_76, 0.474_590_57),
            (1.4, 0.076_811_55, 0.528_985_48),
            (1.5, 0.091_777_96, 0.596_345_76),
            (1.6, 0.106_245_57, 0.650_877_17),
        ] {
            let (r, r_inside) = (diffuse_reflectance(n), diffuse_reflectance(1.0 / n));
            assert!((r - external).abs() < 5e-9 && (r_inside - internal).abs() < 5e-9, "{n}: {r} {r_inside}");
        }
    }

    #[test]
    fn the_closed_form_is_the_mean_of_fresnels_formula_from_either_side() {
        // cosθ = u² smooths the grazing end; the critical angle splits the inner integral.
        let mean = |eta: f64| {
            let critical = (1.0 - eta * eta).max(0.0).sqrt();
            let n = 20_000;
            let refracted: f64 = (0..n)
                .map(|i| {
                    let u = (f64::from(i) + 0.5) / f64::from(n);
                    let c = critical + (1.0 - critical) * u * u;
                    let weight = 2.0 * c * 2.0 * u * (1.0 - critical) / f64::from(n);
                    weight * dielectric_polarized(c, eta).unpolarized()
                })
                .sum();
            refracted + critical * critical
        };
        for eta in [1.01, 1.3, 2.4, 5.0, 0.99, 0.75, 0.4] {
            assert!(
                (diffuse_reflectance(eta) - mean(eta)).abs() < 1e-7,
                "{eta}: {}",
                diffuse_reflectance(eta)
            );
        }
    }

    #[test]
    fn no_interface_reflects_nothing() {
        assert_eq!(diffuse_reflectance(1.0), 0.0);
        for exponent in 3..=12 {
            let delta = 10.0_f64.powi(-exponent);
            for eta in [1.0 + delta, 1.0 - delta] {
                let r = diffuse_reflectance(eta);
                assert!((0.0..=12.0 * delta + 1e-7).contains(&r), "{eta}: {r}");
            }
        }
    }
}
