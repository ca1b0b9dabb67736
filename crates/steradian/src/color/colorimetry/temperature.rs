//! Correlated colour temperature.

use super::tristimulus::{Tristimulus, Uv1960};
use crate::spectrum::{LAMBDA_MIN, blackbody};

/// The temperature of the black body whose chromaticity is nearest, and how far away that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorTemperature {
    /// Correlated colour temperature [K].
    pub kelvin: f64,
    /// Distance from the Planckian locus in the 1960 diagram [1], positive above it (towards green).
    pub duv: f64,
}

/// Farther from the locus a colour temperature means nothing (CIE 15:2018, 9.5).
const FARTHEST: f64 = 0.05;

/// Reciprocal temperatures between which the nearest is looked for [K⁻¹]: 10⁶ K, nearly at the locus' end, to 1000 K.
const RECIPROCALS: [f64; 2] = [1e-6, 1e-3];

/// Steps of the first search.
const STEPS: usize = 48;

/// Chromaticity of a black body in the 1960 diagram; `None` at or below 0 K.
///
/// Planck's law with the constants of the SI 2019 (c₂ = 1.438777·10⁻² m·K, the CIE's 1.4388·10⁻² to its digits),
/// summed at 1 nm over 360–830 nm.
pub fn planckian_uv(kelvin: f64) -> Option<Uv1960> {
    if !(kelvin > 0.0) {
        return None;
    }
    // Relative to one wavelength: at low temperatures the absolute numbers leave the range of floats.
    let peak = blackbody::planck(830.0, kelvin).max(f64::MIN_POSITIVE);
    Tristimulus::of(|i| blackbody::planck(f64::from(LAMBDA_MIN) + i as f64, kelvin) / peak).uv1960()
}

impl ColorTemperature {
    /// The point of the Planckian locus that is nearest to `uv` in the 1960 diagram, CIE 15:2018, 9.5, found by searching the
    /// locus itself. `None` where the distance exceeds 0.05, or where the locus is nearest at one of its ends
    /// (1000 K, 10⁶ K).
    pub fn of(uv: Uv1960) -> Option<Self> {
        let squared = |r: f64| {
            planckian_uv(1.0 / r).map_or(f64::INFINITY, |p| (p.u - uv.u).powi(2) + (p.v - uv.v).powi(2))
        };
        // The locus is nearly straight in steps of reciprocal temperature, so that the distance has one minimum; the
        // first search makes sure of it for points far away.
        let at = |i: usize| {
            let t = i as f64 / STEPS as f64;
            RECIPROCALS[0] + (RECIPROCALS[1] - RECIPROCALS[0]) * t
        };
        let nearest = (0..=STEPS).min_by(|&a, &b| squared(at(a)).total_cmp(&squared(at(b))))?;
        let (mut lo, mut hi) = (at(nearest.saturating_sub(1)), at((nearest + 1).min(STEPS)));
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut a, mut b) = (hi - golden * (hi - lo), lo + golden * (hi - lo));
        let (mut da, mut db) = (squared(a), squared(b));
        // To the last digits that the squared distance can tell apart.
        while hi - lo > 1e-12 {
            if da < db {
                (hi, b, db) = (b, a, da);
                a = hi - golden * (hi - lo);
                da = squared(a);
            } else {
                (lo, a, da) = (a, b, db);
                b = lo + golden * (hi - lo);
                db = squared(b);
            }
        }
        let reciprocal = 0.5 * (lo + hi);
        let kelvin = 1.0 / reciprocal;
        let foot = planckian_uv(kelvin)?;
        let distance = (uv.u - foot.u).hypot(uv.v - foot.v);
        let inside = reciprocal > RECIPROCALS[0] + 1e-11 && reciprocal < RECIPROCALS[1] - 1e-11;
        (inside && distance <= FARTHEST)
            .then(|| Self { kelvin, duv: if uv.v >= foot.v { distance } else { -distance } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn xy(x: f64, y: f64) -> Uv1960 {
        Tristimulus::new(x, y, 1.0 - x - y).uv1960().unwrap()
    }

    #[test]
    fn black_bodies_have_their_own_temperature() {
        for kelvin in [1200.0, 1850.0, 2856.0, 5000.0, 6504.0, 12_000.0, 40_000.0] {
            let found = ColorTemperature::of(planckian_uv(kelvin).unwrap()).unwrap();
            assert!((found.kelvin / kelvin - 1.0).abs() < 1e-5, "{kelvin}: {found:?}");
            assert!(found.duv.abs() < 1e-8, "{kelvin}: {found:?}");
        }
    }

    #[test]
    fn a_step_across_the_locus_keeps_the_temperature() {
        for kelvin in [2000.0, 4000.0, 8000.0] {
            let p = planckian_uv(kelvin).unwrap();
            let (a, b) = (planckian_uv(kelvin * 0.999).unwrap(), planckian_uv(kelvin * 1.001).unwrap());
            // Perpendicular to the locus, upwards.
            let (du, dv) = (b.u - a.u, b.v - a.v);
            let length = du.hypot(dv);
            let (nu, nv) = if du < 0.0 { (dv / length, -du / length) } else { (-dv / length, du / length) };
            for duv in [-0.02, -0.005, 0.005, 0.02] {
                let found = ColorTemperature::of(Uv1960 { u: p.u + duv * nu, v: p.v + duv * nv }).unwrap();
                assert!((found.kelvin / kelvin - 1.0).abs() < 2e-4, "{kelvin} {duv}: {found:?}");
                assert!((found.duv - duv).abs() < 1e-7, "{kelvin} {duv}: {found:?}");
            }
        }
    }

    #[test]
    fn published_chromaticities_have_their_published_temperatures() {
        // CIE 15:2018, table 12: LED-B1 2733 K, LED-B3 4103 K, LED-B5 6598 K, LED-V2 4070 K; to the CIE's digits of x and y.
        for (x, y, kelvin) in [
            (0.4560, 0.4078, 2733.0),
            (0.3756, 0.3723, 4103.0),
            (0.3118, 0.3236, 6598.0),
            (0.3781, 0.3775, 4070.0),
        ] {
            let found = ColorTemperature::of(xy(x, y)).unwrap();
            assert!((found.kelvin - kelvin).abs() < 8.0, "{x} {y}: {found:?}");
        }
    }

    #[test]
    fn saturated_colours_have_none() {
        for (x, y) in [(0.7, 0.3), (0.2, 0.7), (0.15, 0.05), (0.1, 0.2)] {
            assert_eq!(ColorTemperature::of(xy(x, y)), None, "{x} {y}");
        }
    }
}
