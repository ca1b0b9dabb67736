//! Phase functions: the directional distribution of one scattering event in a medium.

use crate::math::float::safe_sqrt;
use crate::math::{Frame, Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, TAU};

/// The one-parameter phase function of Henyey & Greenstein 1941.
///
/// Both directions point away from the event: forward scattering is wi = −wo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    g: f32,
}

/// A scattered direction with its density, which equals the value of the phase function.
#[derive(Clone, Copy, Debug)]
pub struct PhaseSample {
    /// The scattered unit direction, away from the event, in the space of `wo`.
    pub wi: Vec3,
    /// Value and density [sr⁻¹].
    pub p: f32,
}

impl HenyeyGreenstein {
    /// A phase function with mean cosine `g` of the deflection, limited to ±0.99 where f32 still resolves the peak.
    pub fn new(g: f32) -> Self {
        Self { g: g.clamp(-0.99, 0.99) }
    }

    /// The mean cosine of the angle of deflection.
    pub fn g(&self) -> f32 {
        self.g
    }

    /// Value [sr⁻¹] at the cosine between `wo` and `wi`; integrates to one over the sphere.
    pub fn p(&self, cos_theta: f32) -> f32 {
        let g = self.g;
        // Not below (1 − |g|)² but for rounding.
        let d = (1.0 + g * g + 2.0 * g * cos_theta).max((1.0 - g.abs()) * (1.0 - g.abs()));
        0.25 * FRAC_1_PI * (1.0 - g * g) / (d * d.sqrt())
    }

    /// Draws a direction with density [`HenyeyGreenstein::p`] for u ∈ [0, 1)²; `wo` is a unit vector of any space.
    pub fn sample(&self, wo: Vec3, u: Vec2) -> PhaseSample {
        let g = self.g;
        let cos_theta = if g.abs() < 1e-3 {
            1.0 - 2.0 * u.x
        } else {
            let s = (1.0 - g * g) / (1.0 + g - 2.0 * g * u.x);
            (-(1.0 + g * g - s * s) / (2.0 * g)).clamp(-1.0, 1.0)
        };
        let sin_theta = safe_sqrt(1.0 - cos_theta * cos_theta);
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        let frame = Frame::from_z(wo);
        let wi = frame.s * (sin_theta * cos_phi) + frame.t * (sin_theta * sin_phi) + frame.n * cos_theta;
        PhaseSample { wi, p: self.p(cos_theta) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_function_is_normalised_with_mean_deflection_g() {
        for g in [-0.7_f32, 0.0, 0.3, 0.9] {
            let hg = HenyeyGreenstein::new(g);
            let n = 200_000;
            let (mut mass, mut mean) = (0.0_f64, 0.0_f64);
            for i in 0..n {
                let c = -1.0 + 2.0 * (i as f32 + 0.5) / n as f32;
                let p = f64::from(hg.p(c)) * std::f64::consts::TAU * 2.0 / f64::from(n);
                mass += p;
                // The deflection is measured from the direction of travel, −wo.
                mean -= p * f64::from(c);
            }
            assert!((mass - 1.0).abs() < 1e-4 && (mean - f64::from(g)).abs() < 1e-4, "{g}: {mass} {mean}");
        }
    }

    #[test]
    fn samples_have_the_moments_of_the_density() {
        for g in [-0.7_f32, 0.0, 0.3, 0.9] {
            let hg = HenyeyGreenstein::new(g);
            let wo = *crate::math::Dir::new(Vec3::new(0.3, -0.5, 0.2)).unwrap();
            let n = 400;
            let mut mean = Vec3::ZERO;
            for i in 0..n * n {
                let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                let s = hg.sample(wo, u);
                assert!((s.p / hg.p(wo.dot(s.wi)) - 1.0).abs() < 0.02);
                mean += s.wi / (n * n) as f32;
            }
            assert!((mean + wo * g).length() < 1e-3, "{g}: {mean:?}");
        }
    }
}
