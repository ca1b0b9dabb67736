//! What passes a smooth dielectric interface from a cone of diffuse light.

/// Below this half-angle [rad] light counts as normal: the mean differs from normal incidence by its fourth power, and the
/// closed form loses its digits to the square.
const NORMAL: f64 = 3e-3;

/// The share of unpolarised light that enters a dielectric of relative index `n`, at least 1, when radiance is the same over a
/// cone of half-angle `alpha` [rad] in [0, π/2] about the normal: ∫₀^α T(θ) sin2θ dθ / sin²α, in [0, 1].
///
/// The closed form of Stern (1964) as Allen (1973) gives it. Its terms cancel near an index of one and in narrow cones: the
/// absolute error is about 1e-16/((n − 1)² sin²α).
pub fn cone_transmittance(alpha: f64, n: f64) -> f64 {
    if n - 1.0 < 1e-7 {
        return 1.0;
    }
    if alpha < NORMAL {
        return 4.0 * n / ((n + 1.0) * (n + 1.0));
    }
    let n2 = n * n;
    let (sum, difference) = (n2 + 1.0, n2 - 1.0);
    let sin2 = alpha.sin().powi(2);
    // With x = n² − sin²θ under the root of Snell's law, b(θ) = (cosθ + √x)² up to factors runs from a at the normal to b at
    // the rim of the cone, and both polarisations are rational functions of it.
    let a = 0.5 * (n + 1.0).powi(2);
    let k = -0.25 * difference * difference;
    let below = sin2 - 0.5 * sum;
    // Zero at 90°, where rounding may make it negative.
    let b = (below * below + k).max(0.0).sqrt() - below;
    let perpendicular = |x: f64| k * k / (6.0 * x.powi(3)) + k / x - 0.5 * x;
    let s = perpendicular(b) - perpendicular(a);
    let shifted = |x: f64| 2.0 * sum * x - difference * difference;
    let (d2, s2, s3) = (difference * difference, sum * sum, sum.powi(3));
    let p = -2.0 * n2 * (b - a) / s2 - 2.0 * n2 * sum * (b / a).ln() / d2
        + 0.5 * n2 * (1.0 / b - 1.0 / a)
        + 16.0 * n2 * n2 * (n2 * n2 + 1.0) * (shifted(b) / shifted(a)).ln() / (s3 * d2)
        + 16.0 * n2.powi(3) * (1.0 / shifted(b) - 1.0 / shifted(a)) / s3;
    (0.5 * (s + p) / sin2).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::super::fresnel::dielectric_polarized;
    use super::super::super::hemispherical::diffuse_reflectance;
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_closed_form_is_the_mean_of_fresnels_formula_over_the_cone() {
        // cosθ = c₀ + (1 − c₀) u² smooths the grazing end.
        let mean = |alpha: f64, n: f64| {
            let (rim, count) = (alpha.cos(), 20_000);
            let sum: f64 = (0..count)
                .map(|i| {
                    let u = (f64::from(i) + 0.5) / f64::from(count);
                    let c = rim + (1.0 - rim) * u * u;
                    (1.0 - dielectric_polarized(c, n).unpolarized()) * 4.0 * c * u * (1.0 - rim)
                })
                .sum();
            sum / f64::from(count) / alpha.sin().powi(2)
        };
        for degrees in [0.1_f64, 0.3, 5.0, 40.0, 59.0, 80.0, 90.0] {
            for n in [1.01, 1.27, 1.4, 1.5, 2.4] {
                let alpha = degrees.to_radians();
                let (closed, mean) = (cone_transmittance(alpha, n), mean(alpha, n));
                let rounding = 1e-16 / ((n - 1.0) * alpha.sin()).powi(2);
                assert!((closed - mean).abs() < 1e-8 + rounding, "{degrees}°, {n}: {closed} {mean}");
            }
        }
    }

    #[test]
    fn the_mean_transmission_of_leaves_has_the_checked_values() {
        for (degrees, n, expected) in [
            (40.0_f64, 1.4, 0.970_895_20),
            (90.0, 1.4, 0.923_188_45),
            (40.0, 1.5, 0.958_424_04),
            (90.0, 1.5, 0.908_222_04),
        ] {
            let t = cone_transmittance(degrees.to_radians(), n);
            assert!((t - expected).abs() < 5e-9, "{degrees}°, {n}: {t}");
        }
    }

    #[test]
    fn a_whole_hemisphere_is_what_is_not_diffusely_reflected() {
        for n in [1.1, 1.333, 1.5, 2.0] {
            assert!((cone_transmittance(FRAC_PI_2, n) + diffuse_reflectance(n) - 1.0).abs() < 1e-12, "{n}");
        }
        assert_eq!(cone_transmittance(FRAC_PI_2, 1.0), 1.0);
        assert_eq!(cone_transmittance(0.0, 1.5), 0.96);
    }
}
