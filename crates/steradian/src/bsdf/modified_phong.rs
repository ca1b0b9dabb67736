//! The modified Phong model of B (2.30)–(2.38): a BRDF that keeps its energy, if it is normalised for the lobe it has.

use super::contract::{BsdfSample, Lobe, Lobes};
use super::cosine_lobe::{self, mirrored};
use super::specimen::{Claims, Specimen};
use crate::math::{LocalDir, Vec2, warp};
use crate::optics::refraction;
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// What the angle α of the lobe is measured between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhongLobe {
    /// `wi` and the mirror direction of `wo`: what the text's integrals (2.33), (2.34) are about.
    Mirror,
    /// The normal and the vector halfway between `wo` and `wi`: what the text says under (2.30).
    Halfway,
}

/// By which constant cosⁿα is multiplied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhongNormalization {
    /// The one that makes the lobe's albedo 1 at normal incidence and less everywhere else: (n+2)/(2π) about the
    /// mirror direction, (n+2)(n+4) / (8π (2^(−n/2) + n)) about the halfway vector.
    Exact,
    /// (n+2)/(2π), B (2.35) to the letter. About the halfway vector it returns up to four times the light that arrives.
    Printed,
}

/// How directions are drawn for the lobe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhongSampling {
    /// In proportion to cosⁿα, B (2.36), (2.47); of the halfway vector, if that is what α belongs to.
    Lobe,
    /// By the density of Shirley and Wang about the mirror direction, B (2.38), for either lobe.
    ShirleyWang,
}

/// f = ρd/π + ρs C(n) cosⁿα, alike on both sides of the surface.
///
/// A lobe reaches under the horizon: a direction drawn there is none, neither drawn again nor clamped (B 2.5). C is for normal
/// incidence; away from it the albedo of either lobe falls, whatever n is.
#[derive(Clone, Copy, Debug)]
pub struct ModifiedPhong {
    /// Diffuse reflectance ρd; ρd + ρs ≤ 1 at every wavelength.
    pub diffuse: Sampled<Unitless>,
    /// Specular reflectance ρs.
    pub specular: Sampled<Unitless>,
    /// Specular exponent n, ≥ 0.
    pub exponent: f32,
    /// Where the lobe is.
    pub lobe: PhongLobe,
    /// How it is normalised.
    pub normalization: PhongNormalization,
    /// How it is sampled.
    pub sampling: PhongSampling,
}

impl ModifiedPhong {
    /// f [sr⁻¹], B (2.35); zero across the surface.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        if !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        let power = match self.lobe {
            PhongLobe::Mirror => cosine_lobe::power(*mirrored(wo), *wi, self.exponent),
            PhongLobe::Halfway => halfway_power(wo, wi, self.exponent),
        };
        (self.diffuse * FRAC_1_PI + self.specular * (self.scale() * power)).cast()
    }

    /// Density of [`ModifiedPhong::sample`]; below one in total where the lobe reaches under the horizon.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if !wo.same_hemisphere(wi) {
            return PdfSolidAngle(0.0);
        }
        let n = self.exponent;
        let lobe = match (self.sampling, self.lobe) {
            (PhongSampling::Lobe, PhongLobe::Mirror) => {
                cosine_lobe::density_scale(n) * cosine_lobe::power(*mirrored(wo), *wi, n)
            }
            (PhongSampling::Lobe, PhongLobe::Halfway) => {
                // dωi = 4 (wo·h) dωh, and |wo + wi| = 2 (wo·h).
                let jacobian = (2.0 * (*wo + *wi).length()).max(f32::MIN_POSITIVE);
                cosine_lobe::density_scale(n) * halfway_power(wo, wi, n) / jacobian
            }
            (PhongSampling::ShirleyWang, _) => {
                let axis = mirrored(wo);
                cosine_lobe::half_angle_density_scale(n) * cosine_lobe::half_angle_power(*axis, *wi, n)
            }
        };
        let p = self.diffuse_probability();
        PdfSolidAngle(p * warp::cosine_hemisphere_pdf(wi.abs_cos_theta()) + (1.0 - p) * lobe)
    }

    /// A direction from the cosine, B (2.37), or from the lobe; `None` under the horizon.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 || self.is_black() {
            return None;
        }
        let n = self.exponent;
        let (wi, lobe) = if uc < self.diffuse_probability() {
            let up = warp::cosine_hemisphere(u);
            (if wo.z > 0.0 { up } else { -up }, Lobe::Diffuse)
        } else {
            let wi = match (self.sampling, self.lobe) {
                (PhongSampling::Lobe, PhongLobe::Mirror) => cosine_lobe::sample(mirrored(wo), n, u)?,
                (PhongSampling::Lobe, PhongLobe::Halfway) => {
                    let normal = if wo.z > 0.0 { LocalDir::Z } else { -LocalDir::Z };
                    let h = cosine_lobe::sample(normal, n, u)?;
                    LocalDir::new(refraction::reflect(*wo, *h))?
                }
                (PhongSampling::ShirleyWang, _) => cosine_lobe::sample_half_angle(mirrored(wo), n, u)?,
            };
            (wi, Lobe::Glossy)
        };
        BsdfSample::reflected(wi, self.eval(wo, wi), self.pdf(wo, wi), lobe)
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: !self.is_black(), transmission: false }
    }

    /// Widens a narrow lobe: a named bias against fireflies.
    pub fn regularize(&mut self) {
        self.exponent = cosine_lobe::widened(self.exponent);
    }

    /// What is claimed of it: B (2.31). The text derives the printed normalisation from it as well, about the halfway vector
    /// wrongly so.
    pub fn claims(&self) -> Claims {
        Claims::CLOSED_FORM
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        use {PhongLobe::*, PhongSampling::*};
        let lobe = |exponent, lobe, sampling| Self {
            diffuse: Sampled::ZERO,
            specular: Sampled::ONE,
            exponent,
            lobe,
            normalization: PhongNormalization::Exact,
            sampling,
        };
        let painted = |b| Self {
            diffuse: Sampled::from_array([0.1, 0.8, 0.4, 0.0]),
            specular: Sampled::from_array([0.5, 0.2, 0.6, 0.9]),
            ..b
        };
        [
            ("modifiedphong mirror 0", lobe(0.0, Mirror, Lobe)),
            ("modifiedphong mirror 1", lobe(1.0, Mirror, Lobe)),
            ("modifiedphong mirror 10", lobe(10.0, Mirror, Lobe)),
            ("modifiedphong mirror 1000", lobe(1000.0, Mirror, Lobe)),
            ("modifiedphong mirror 20 shirleywang", lobe(20.0, Mirror, ShirleyWang)),
            ("modifiedphong halfway 0", lobe(0.0, Halfway, Lobe)),
            ("modifiedphong halfway 1", lobe(1.0, Halfway, Lobe)),
            ("modifiedphong halfway 10", lobe(10.0, Halfway, Lobe)),
            ("modifiedphong halfway 1000", lobe(1000.0, Halfway, Lobe)),
            ("modifiedphong halfway 50 shirleywang", lobe(50.0, Halfway, ShirleyWang)),
            ("modifiedphong painted mirror 30", painted(lobe(30.0, Mirror, Lobe))),
            ("modifiedphong painted halfway 30", painted(lobe(30.0, Halfway, Lobe))),
            ("modifiedphong painted mirror shirleywang", painted(lobe(5.0, Mirror, ShirleyWang))),
        ]
        .into_iter()
        .map(|(name, bsdf)| Specimen::new(name, bsdf.claims(), bsdf))
    }

    /// C(n) [sr⁻¹].
    fn scale(&self) -> f32 {
        let n = self.exponent;
        match (self.normalization, self.lobe) {
            (PhongNormalization::Printed, _) | (_, PhongLobe::Mirror) => (n + 2.0) / TAU,
            (PhongNormalization::Exact, PhongLobe::Halfway) => {
                (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-0.5 * n).exp2() + n))
            }
        }
    }

    fn diffuse_probability(&self) -> f32 {
        let (d, s) = (self.diffuse.max(), self.specular.max());
        d / (d + s)
    }

    fn is_black(&self) -> bool {
        self.diffuse.is_zero() && self.specular.is_zero()
    }
}

/// cosⁿ of the angle between the normal and the halfway vector, from its tangent.
fn halfway_power(wo: LocalDir, wi: LocalDir, n: f32) -> f32 {
    let h = *wo + *wi;
    // Divided before they are squared: at the horizon the squares vanish.
    let (x, y) = (h.x / h.z, h.y / h.z);
    let tan2 = (x * x + y * y).min(f32::MAX);
    (-0.5 * n * tan2.ln_1p()).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Bsdf;
    use crate::bsdf::conformance::{self, Effort};
    use crate::bsdf::quadrature::GAUSS_LEGENDRE;
    use crate::math::Vec3;
    use crate::math::hash::Pcg32;

    fn at(degrees: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.3))
    }

    fn lobe(exponent: f32, lobe: PhongLobe, normalization: PhongNormalization) -> ModifiedPhong {
        ModifiedPhong {
            diffuse: Sampled::ZERO,
            specular: Sampled::ONE,
            exponent,
            lobe,
            normalization,
            sampling: PhongSampling::Lobe,
        }
    }

    /// ∫ f cosθ dω over the cosⁿ-warped square about the lobe's axis, by a Gauss rule in pieces of ξ₁ and midpoints in ξ₂: exact
    /// where nothing is cut off at the horizon.
    fn reflectance(b: &ModifiedPhong, wo: LocalDir) -> f64 {
        let (pieces, turns) = (32, 64);
        let mut sum = 0.0;
        for piece in 0..pieces {
            for [x, weight] in GAUSS_LEGENDRE {
                let u = ((f64::from(piece) + x) / f64::from(pieces)) as f32;
                for turn in 0..turns {
                    let u = Vec2::new(u, (turn as f32 + 0.5) / turns as f32);
                    let value = b.sample(wo, 0.5, u).map_or(0.0, |s| f64::from(s.weight[0]));
                    sum += weight * value / f64::from(pieces * turns);
                }
            }
        }
        sum
    }

    /// EQUATIONS.md section 5 and lightlab.md section 0.
    #[test]
    fn lobes_have_the_albedos_of_the_reference() {
        use {PhongLobe::*, PhongNormalization::*};
        for (n, printed) in [(1.0, 1.366), (10.0, 2.866), (100.0, 3.846), (1000.0, 3.984)] {
            for exact in [lobe(n, Mirror, Exact), lobe(n, Mirror, Printed), lobe(n, Halfway, Exact)] {
                let rho = reflectance(&exact, LocalDir::Z);
                assert!((rho - 1.0).abs() < 2e-4, "{exact:?}: {rho}");
            }
            let rho = reflectance(&lobe(n, Halfway, Printed), LocalDir::Z);
            assert!((rho - printed).abs() < 1e-3, "{n}: {rho}");
        }
        for (degrees, expected) in [(30.0, 0.8660), (60.0, 0.5047), (80.0, 0.2281)] {
            let rho = reflectance(&lobe(10.0, Mirror, Exact), at(degrees));
            assert!((rho - expected).abs() < 2e-4, "{degrees}: {rho}");
        }
        for (n, scale) in [(10.0, 0.666_37), (100.0, 4.220_79)] {
            assert!((lobe(n, Halfway, Exact).scale() - scale).abs() < 1e-5 * scale);
        }
    }

    #[test]
    fn exact_normalisation_keeps_energy_at_every_angle_and_exponent() {
        for n in [0.0, 0.1, 0.5, 1.0, 3.0, 10.0, 40.0, 300.0, 1e4] {
            for which in [PhongLobe::Mirror, PhongLobe::Halfway] {
                let mut last = f64::INFINITY;
                for degrees in (0..=88).step_by(8) {
                    let rho = reflectance(&lobe(n, which, PhongNormalization::Exact), at(degrees as f32));
                    // It falls from 1 at normal incidence; the quadrature's error is that of the cut at the horizon.
                    assert!(rho < last.min(1.0) + 1e-3, "{which:?} n = {n}, {degrees}°: {rho} after {last}");
                    last = rho;
                }
            }
        }
    }

    fn broken_laws(b: ModifiedPhong) -> Vec<String> {
        let specimen = Specimen::new("", b.claims(), Bsdf::ModifiedPhong(b));
        let examination = conformance::examine(&specimen, &Effort::QUICK);
        examination.contradictions().map(|f| format!("{b:?}: {f}\n")).collect()
    }

    /// B (2.35) to the letter breaks B (2.31), which it is derived from.
    #[test]
    fn the_suite_catches_the_printed_normalisation_about_the_halfway_vector() {
        for n in [1.0, 10.0, 1000.0] {
            let found = broken_laws(lobe(n, PhongLobe::Halfway, PhongNormalization::Printed));
            assert!(!found.is_empty() && found.iter().all(|f| f.contains("energy")), "{n}: {found:?}");
            assert!(broken_laws(lobe(n, PhongLobe::Mirror, PhongNormalization::Printed)).is_empty(), "{n}");
        }
    }

    #[test]
    fn the_narrowest_lobes_obey_every_law() {
        for which in [PhongLobe::Mirror, PhongLobe::Halfway] {
            for sampling in [PhongSampling::Lobe, PhongSampling::ShirleyWang] {
                let found =
                    broken_laws(ModifiedPhong { sampling, ..lobe(1e4, which, PhongNormalization::Exact) });
                assert!(found.is_empty(), "{found:?}");
            }
        }
    }

    /// 1 − 2^(−(n+2)/2) of B (2.38) lies in the hemisphere about its axis: 0.6464 at n = 1.
    #[test]
    fn shirley_wang_samples_under_the_horizon_are_none() {
        let b = ModifiedPhong {
            sampling: PhongSampling::ShirleyWang,
            ..lobe(1.0, PhongLobe::Mirror, PhongNormalization::Exact)
        };
        let mut rng = Pcg32::new(1, 1);
        let n = 40_000;
        let mut draw = || b.sample(LocalDir::Z, 0.5, Vec2::new(rng.next_f32(), rng.next_f32()));
        let share = (0..n).filter(|_| draw().is_some()).count() as f64 / f64::from(n);
        // Four standard errors: 4 √(p (1 − p)/n).
        assert!((share - 0.646_4).abs() < 0.0096, "{share}");
    }

    #[test]
    fn nothing_is_nan_where_directions_are_opposite_along_the_horizon() {
        for n in [0.0, 1.0, 1e4] {
            for which in [PhongLobe::Mirror, PhongLobe::Halfway] {
                let b = lobe(n, which, PhongNormalization::Exact);
                for z in [1e-38, 1e-30, 1e-20, 1e-7] {
                    let wo = LocalDir::new_unchecked(Vec3::new(1.0, 0.0, z));
                    let opposite = LocalDir::new_unchecked(Vec3::new(-1.0, 0.0, z));
                    for wi in [opposite, wo] {
                        assert!(b.eval(wo, wi).is_finite() && b.pdf(wo, wi).0.is_finite(), "{b:?} {z}");
                    }
                }
            }
        }
    }
}
