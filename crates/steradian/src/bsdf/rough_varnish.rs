//! A rough clear coat over a Lambertian base, in closed form but for tables.
//!
//! This is the random walk of [`Layered`] with every integral done: its values are the walk's means.

use super::contract::{BsdfSample, Evaluated, Lobe, Lobes, Mode, Sides};
use super::diffuse::Diffuse;
use super::layered::{ExitWeights, Layered};
use super::specimen::{Claims, Specimen};
use super::varnish::Varnish;
use crate::math::{LocalDir, Vec2, warp};
use crate::optics::refraction;
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// A rough coat without scattering over a Lambertian base, alike on both sides of the surface.
#[derive(Clone, Copy, Debug)]
pub struct RoughVarnish<'a> {
    /// The coat.
    pub varnish: &'a Varnish,
    /// Reflectance of the base.
    pub reflectance: Sampled<Unitless>,
    /// Seed of the walks that take over where the coat is widened.
    pub seed: u64,
}

impl RoughVarnish<'_> {
    /// f [sr⁻¹]: what the coat's facets reflect, and t(wo) t(wi) / (π η²) · Σ ρ (ρ K)^k from below.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        if !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        self.value(self.reflected(wo, wi).f, self.varnish.passing(wo) * self.varnish.leaving(wi))
    }

    /// Density of [`RoughVarnish::sample`].
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if !wo.same_hemisphere(wi) {
            return PdfSolidAngle(0.0);
        }
        self.density(wo, wi, self.reflected(wo, wi).pdf)
    }

    /// Both at once.
    pub fn evaluate(&self, wo: LocalDir, wi: LocalDir) -> Evaluated {
        if !wo.same_hemisphere(wi) {
            return Evaluated::NOTHING;
        }
        let reflected = self.reflected(wo, wi);
        let passed = self.varnish.passing(wo) * self.varnish.leaving(wi);
        Evaluated { f: self.value(reflected.f, passed), pdf: self.density(wo, wi, reflected.pdf) }
    }

    /// A direction mirrored at a visible facet with the probability that light does not pass the coat, else a
    /// cosine-distributed one.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let wi = if uc < self.varnish.passing(wo) {
            let up = warp::cosine_hemisphere(u);
            if wo.z > 0.0 { up } else { -up }
        } else {
            let wm = self.varnish.coat().interface.roughness.sample_visible(wo, u);
            LocalDir::new_unchecked(refraction::reflect(*wo, *wm))
        };
        if !wo.same_hemisphere(wi) {
            return None;
        }
        let reflected = self.reflected(wo, wi);
        // Samples of the walk are unbiased, however it weighs its values.
        let f = self.value(reflected.f, self.varnish.passing(wo) * self.varnish.passing(wi));
        BsdfSample::reflected(wi, f, self.density(wo, wi, reflected.pdf), Lobe::Glossy)
    }

    /// The walk that this is the closed form of.
    pub fn layers(&self) -> Layered<Diffuse> {
        let base = Diffuse { reflectance: self.reflectance };
        Layered { coat: *self.varnish.coat(), base, seed: self.seed }
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false }
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        match self.varnish.coat().weights {
            ExitWeights::Consistent => Claims::CLOSED_FORM,
            ExitWeights::Pbrt4 => Claims::BIASED_CLOSED_FORM,
        }
    }

    #[inline]
    fn value(&self, surface: f32, passed: f32) -> Sampled<PerSteradian> {
        let eta = self.varnish.coat().interface.eta;
        let below = self.varnish.sent_up(self.reflectance) * (passed * FRAC_1_PI / (eta * eta));
        Sampled::splat(surface) + below.cast()
    }

    #[inline]
    fn density(&self, wo: LocalDir, wi: LocalDir, facets: f32) -> PdfSolidAngle {
        let below = self.varnish.passing(wo);
        PdfSolidAngle((1.0 - below) * facets + below * warp::cosine_hemisphere_pdf(wi.abs_cos_theta()))
    }

    /// What the facets reflect, and the density with which they are drawn.
    #[inline]
    fn reflected(&self, wo: LocalDir, wi: LocalDir) -> Facets {
        let interface = &self.varnish.coat().interface;
        // The coat lies above, from wherever it is seen.
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        interface
            .evaluate_at(wo, wi, Mode::Importance, Sides::Reflection)
            .map_or(Facets { f: 0.0, pdf: 0.0 }, |e| Facets { f: e.f, pdf: e.pdf })
    }
}

/// A pair of directions at the facets.
struct Facets {
    f: f32,
    pdf: f32,
}

impl<'a> RoughVarnish<'a> {
    /// Examples for the conformance suite.
    pub fn specimens(varnishes: &'a [Varnish]) -> impl Iterator<Item = Specimen<Self>> + use<'a> {
        const NAMES: [&str; 3] =
            ["varnished matt", "varnished satin, dark varnish", "varnished as pbrt-v4 does"];
        let reflectance = Sampled::from_array([0.1, 0.8, 0.4, 1.0]);
        NAMES.into_iter().zip(varnishes).map(move |(name, varnish)| {
            let bsdf = Self { varnish, reflectance, seed: 0 };
            Specimen::new(name, bsdf.claims(), bsdf)
        })
    }
}

/// The coats that specimens refer to.
pub(super) fn varnishes() -> Vec<Varnish> {
    use super::layered::Coat;
    use crate::optics::TrowbridgeReitz;
    let of = |alpha| Coat::clear(1.5, TrowbridgeReitz::new(alpha, alpha));
    [
        Coat { max_depth: 1000, ..of(0.4) },
        Coat { thickness: 0.3, ..of(0.1) },
        Coat { weights: ExitWeights::Pbrt4, ..of(0.2) },
    ]
    .iter()
    .filter_map(Varnish::new)
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::layered::Coat;
    use crate::math::Vec3;
    use crate::math::hash::Pcg32;
    use crate::optics::TrowbridgeReitz;

    fn coat(alpha: f32, thickness: f32, max_depth: u16, weights: ExitWeights) -> Coat {
        Coat { thickness, max_depth, weights, ..Coat::clear(1.5, TrowbridgeReitz::new(alpha, alpha)) }
    }

    const CASES: [(f32, f32, u16, ExitWeights); 6] = [
        (0.1, 0.01, 10, ExitWeights::Consistent),
        (0.4, 0.3, 10, ExitWeights::Consistent),
        (0.9, 0.01, 3, ExitWeights::Consistent),
        (0.02, 0.01, 10, ExitWeights::Pbrt4),
        (0.3, 0.01, 10, ExitWeights::Pbrt4),
        (0.7, 0.1, 100, ExitWeights::Pbrt4),
    ];

    #[test]
    fn values_are_the_means_of_the_random_walks() {
        let wo = LocalDir::new(Vec3::new(0.5, 0.2, 0.7)).unwrap();
        let wi = LocalDir::new(Vec3::new(-0.8, 0.4, 0.3)).unwrap();
        let reflectance = Sampled::from_array([0.2, 0.5, 0.9, 1.0]);
        for (alpha, thickness, depth, weights) in CASES {
            let varnish = Varnish::new(&coat(alpha, thickness, depth, weights)).unwrap();
            let closed = RoughVarnish { varnish: &varnish, reflectance, seed: 0 };
            let expected = closed.eval(wo, wi);
            let n = 20_000;
            let (mut mean, mut square) = ([0.0_f64; 4], [0.0_f64; 4]);
            for seed in 0..n {
                let f = Layered { seed, ..closed.layers() }.eval(wo, wi, Mode::Radiance);
                for lane in 0..4 {
                    mean[lane] += f64::from(f[lane]) / n as f64;
                    square[lane] += f64::from(f[lane]).powi(2) / n as f64;
                }
            }
            for lane in 0..4 {
                let error = ((square[lane] - mean[lane].powi(2)).max(0.0) / n as f64).sqrt();
                let difference = (mean[lane] - f64::from(expected[lane])).abs();
                // 24 comparisons at 4.5 standard errors: a joint level of 2e-4; and the tables' own error.
                assert!(
                    difference < 4.5 * error + 1e-3 * mean[lane],
                    "{alpha} {thickness} {depth} {weights:?} {lane}: {} {expected:?} ± {error}",
                    mean[lane]
                );
            }
        }
    }

    #[test]
    fn sampled_energy_is_that_of_the_walk() {
        let reflectance = Sampled::splat(0.8);
        for (alpha, thickness, depth, weights) in CASES {
            // A walk whose last event is at the base never leaves: its samples lack the last order that its values have.
            let depth = depth & !1;
            let varnish = Varnish::new(&coat(alpha, thickness, depth, weights)).unwrap();
            let closed = RoughVarnish { varnish: &varnish, reflectance, seed: 5 };
            let wo = LocalDir::new(Vec3::new(0.5, 0.2, -0.5)).unwrap();
            for max_depth in [depth, depth + 1] {
                let mut layers = closed.layers();
                layers.coat.max_depth = max_depth;
                let mut rng = Pcg32::new(3, 3);
                let n = 60_000;
                let (mut walk, mut form) = (0.0_f64, 0.0_f64);
                for _ in 0..n {
                    let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
                    let weight =
                        |s: Option<BsdfSample>| s.map_or(0.0, |s| f64::from(s.weight[0])) / f64::from(n);
                    walk += weight(layers.sample(wo, uc, u, Mode::Radiance));
                    form += weight(closed.sample(wo, uc, u));
                }
                // The walk's weights are zero or near one: standard error below 0.5/√n = 2.1e-3.
                assert!((walk - form).abs() < 9e-3, "{alpha} {weights:?} {max_depth}: {walk} {form}");
            }
        }
    }
}
