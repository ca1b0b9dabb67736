//! Glare indices.

use super::detection::GlareSource;

/// Unified Glare Rating, CIE 117-1995: 8 log₁₀(0.25/L_b Σ L² ω / p²), with the background luminance L_b [cd/m²], that is the
/// vertical illuminance at the eye without the sources, over π.
///
/// `None` without sources or without background. Ratings run from 10 (none) to 28 (uncomfortable); lower values mean no
/// glare either.
pub fn ugr(sources: &[GlareSource], background: f64) -> Option<f64> {
    let sum: f64 = sources.iter().map(weight).sum();
    (sum > 0.0 && background > 0.0).then(|| 8.0 * (0.25 / background * sum).log10())
}

/// Daylight Glare Probability, Wienold & Christoffersen 2006, (4): 5.87·10⁻⁵ E_v + 9.18·10⁻² log₁₀(1 + Σ L² ω /
/// (E_v^1.87 p²)) + 0.16, with the vertical illuminance E_v at the eye [lx].
///
/// Made from tests with daylight: valid for 0.2 ≤ DGP ≤ 0.8 and E_v of 380 lx and more. `None` in the dark.
pub fn dgp(sources: &[GlareSource], vertical_illuminance: f64) -> Option<f64> {
    if !(vertical_illuminance > 0.0) {
        return None;
    }
    let sum: f64 = sources.iter().map(weight).sum();
    let contrast = sum / vertical_illuminance.powf(1.87);
    Some(5.87e-5 * vertical_illuminance + 9.18e-2 * contrast.ln_1p() / std::f64::consts::LN_10 + 0.16)
}

/// What evalglare makes of a DGP at less than 1000 lx (Wienold 2009): times e^x/(1 + e^x), x = 0.024 E_v − 4.
pub fn dgp_in_low_light(dgp: f64, vertical_illuminance: f64) -> f64 {
    if vertical_illuminance >= 1000.0 {
        return dgp.min(1.0);
    }
    (dgp / (1.0 + (4.0 - 0.024 * vertical_illuminance).exp())).min(1.0)
}

/// L² ω / p².
fn weight(s: &GlareSource) -> f64 {
    (s.luminance / s.position_index).powi(2) * s.solid_angle
}

/// What a DGP means (Wienold 2009).
pub fn dgp_class(dgp: f64) -> &'static str {
    match dgp {
        d if d < 0.35 => "imperceptible",
        d if d < 0.40 => "perceptible",
        d if d < 0.45 => "disturbing",
        _ => "intolerable",
    }
}

/// What a UGR means (CIE 117, scale of Hopkinson's criteria).
pub fn ugr_class(ugr: f64) -> &'static str {
    match ugr {
        u if u < 13.0 => "imperceptible",
        u if u < 16.0 => "just perceptible",
        u if u < 19.0 => "perceptible",
        u if u < 22.0 => "just acceptable",
        u if u < 25.0 => "unacceptable",
        u if u < 28.0 => "just uncomfortable",
        _ => "uncomfortable",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(luminance: f64, solid_angle: f64, position_index: f64) -> GlareSource {
        GlareSource { luminance, solid_angle, position_index, ..GlareSource::default() }
    }

    #[test]
    fn one_source_has_the_rating_of_the_formula() {
        // 8 log₁₀(0.25/40 · 1000² · 0.01/2²) = 8 log₁₀ 15.625.
        let rating = ugr(&[source(1000.0, 0.01, 2.0)], 40.0).unwrap();
        assert!((rating - 9.550_56).abs() < 1e-5, "{rating}");
        // Eight more units for ten times the sources.
        let ten = ugr(&[source(1000.0, 0.01, 2.0); 10], 40.0).unwrap();
        assert!((ten - rating - 8.0).abs() < 1e-12);
        assert!(ugr(&[], 40.0).is_none() && ugr(&[source(1.0, 1.0, 1.0)], 0.0).is_none());
    }

    #[test]
    fn probability_is_that_of_the_illuminance_and_the_contrast() {
        // Without sources 0.16 + 5.87e-5 E_v; one source with Σ = 9 E_v^1.87 adds a tenth of its coefficient's decade.
        let e: f64 = 2000.0;
        assert!((dgp(&[], e).unwrap() - 0.2774).abs() < 1e-12);
        let l = (9.0 * e.powf(1.87) / 0.01).sqrt();
        let one = dgp(&[source(l, 0.01, 1.0)], e).unwrap();
        assert!((one - 0.2774 - 0.0918).abs() < 1e-12, "{one}");
        assert_eq!(dgp(&[], 0.0), None);
        assert!((dgp_in_low_light(0.3, 4.0 / 0.024) - 0.15).abs() < 1e-12);
        assert_eq!(dgp_in_low_light(1.3, 2000.0), 1.0);
    }
}
