//! Whether a scattering function obeys the laws that light transport relies on.
//!
//! The suite returns findings with their evidence; what to do about a law that does not hold is the caller's
//! matter. It runs over the specimens of every variant in the tests, and over any [`Bsdf`] for a user.

mod hemisphere;
mod statistics;

use super::specimen::{Claims, Energy, Specimen};
use super::{Bsdf, BsdfSample, Mode};
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PdfSolidAngle, PerSteradian};
use statistics::{ChiSquared, Moments};

/// A law of scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Sampled directions follow the density (Pearson's χ² over cells of equal solid angle).
    SamplesFollowDensity,
    /// weight = f·|cosθi|/p at each sample; where f is an estimate, in the mean over a lobe.
    WeightIsRatio,
    /// The density integrates to the probability that sampling yields a continuous direction.
    DensityMass,
    /// f(wo, wi) η² = f(wi, wo) with η² = 1 but across an interface, B (2.18); radiance and importance are adjoint.
    Reciprocity,
    /// ρ + τ ≤ 1 for light from one direction, B (2.19); equal to one where the specimen claims no loss.
    Energy,
    /// Reflectance by sampling and by quadrature of f are the same number.
    TwoWaysToReflectance,
    /// Values, densities and weights are finite and not negative, at grazing angles as well.
    Finite,
}

/// What a finding rests on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Evidence {
    /// A test statistic with the probability of one at least as large if the law holds.
    Probability {
        /// The statistic.
        statistic: f64,
        /// Degrees of freedom.
        degrees_of_freedom: u32,
        /// Probability; the law is rejected below `significance`.
        p: f64,
        /// Level of the test.
        significance: f64,
    },
    /// Two numbers that must agree.
    Equality {
        /// What was found.
        observed: f64,
        /// What the law demands.
        expected: f64,
        /// Largest accepted difference.
        tolerance: f64,
    },
    /// A number with an upper bound.
    Bound {
        /// What was found.
        observed: f64,
        /// The largest value that the law admits.
        limit: f64,
    },
}

/// One law examined at one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// The law.
    pub law: Law,
    /// The fixed direction.
    pub wo: LocalDir,
    /// What was transported.
    pub mode: Mode,
    /// What the verdict rests on.
    pub evidence: Evidence,
}

impl Finding {
    /// Whether the law holds as far as the evidence goes. NaN never holds.
    pub fn holds(&self) -> bool {
        match self.evidence {
            Evidence::Probability { p, significance, .. } => p >= significance,
            Evidence::Equality { observed, expected, tolerance } => (observed - expected).abs() <= tolerance,
            Evidence::Bound { observed, limit } => observed <= limit,
        }
    }
}

/// What can be examined: a [`Bsdf`], or anything that scatters like one.
pub trait Scatterer: Copy {
    /// f [sr⁻¹], without the cosine and without discrete directions.
    fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian>;
    /// Density of `wi` among the continuous directions drawn for `wo`.
    fn pdf(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> PdfSolidAngle;
    /// Draws `wi` for `wo`.
    fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample>;
    /// The same function with other random walks, where it is estimated by such.
    #[must_use]
    fn with_seed(self, seed: u64) -> Self;
}

impl Scatterer for Bsdf<'_> {
    fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        Self::eval(self, wo, wi, mode)
    }

    fn pdf(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> PdfSolidAngle {
        Self::pdf(self, wo, wi, mode)
    }

    fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        Self::sample(self, wo, uc, u, mode)
    }

    fn with_seed(self, seed: u64) -> Self {
        Self::with_seed(self, seed)
    }
}

/// How thoroughly to examine.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Samples per direction and mode.
    pub samples: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Level of each statistical test: the probability of rejecting a law that holds.
    pub significance: f64,
    /// Normal deviate of the same level, for numbers with a standard error.
    pub sigmas: f64,
}

impl Default for Effort {
    /// 100 000 samples; with a hundred findings the level of 10⁻⁵ leaves one false alarm in a thousand runs.
    fn default() -> Self {
        Self { samples: 100_000, seed: 1, significance: 1e-5, sigmas: 4.4 }
    }
}

/// Examines every law that the specimen claims, for directions above and below the surface.
pub fn examine<B: Scatterer>(specimen: &Specimen<B>, effort: &Effort) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (theta, phi) in [(0.0_f32, 0.0_f32), (65.0, 250.0), (140.0, 120.0)] {
        let wo = warp::spherical_direction(theta.to_radians(), phi.to_radians());
        let bench =
            Bench { bsdf: specimen.bsdf, claims: specimen.claims, effort, wo: LocalDir::new_unchecked(wo) };
        for mode in [Mode::Radiance, Mode::Importance] {
            bench.examine_sampling(mode, &mut findings);
        }
        bench.examine_reciprocity(&mut findings);
    }
    examine_grazing(specimen, effort, &mut findings);
    findings
}

/// Directional–hemispherical reflectance plus transmittance by sampling.
#[derive(Clone, Copy, Debug)]
pub struct Albedo {
    /// Mean over the lanes.
    pub value: f64,
    /// Standard error of the mean.
    pub error: f64,
}

/// ρ + τ for light that arrives from `wi`, by `samples` samples: the ratio of scattered to incident power, B (2.14), (2.15).
pub fn albedo<B: Scatterer>(bsdf: &B, wi: LocalDir, samples: u32, seed: u64) -> Albedo {
    let mut rng = Pcg32::new(seed, 17);
    let mut moments = Moments::default();
    for _ in 0..samples {
        moments.add(draw(bsdf, wi, Mode::Importance, &mut rng).map_or(0.0, |s| f64::from(s.weight.mean())));
    }
    Albedo { value: moments.mean(), error: moments.error() }
}

/// One specimen under one direction.
struct Bench<'a, B> {
    bsdf: B,
    claims: Claims,
    effort: &'a Effort,
    wo: LocalDir,
}

/// f cosθ integrated over the sphere, and the density, by quadrature.
struct Quadrature {
    density: Vec<f64>,
    power: Moments,
}

impl<B: Scatterer> Bench<'_, B> {
    fn examine_sampling(&self, mode: Mode, findings: &mut Vec<Finding>) {
        let mut find = |law, evidence| findings.push(Finding { law, wo: self.wo, mode, evidence });
        let n = f64::from(self.effort.samples);
        let mut rng = Pcg32::new(hash::combine(self.effort.seed, mode as u64), 5);
        let mut counts = vec![0.0; hemisphere::CELLS];
        let mut continuous = Moments::default();
        let mut all = Moments::default();
        let mut worst_ratio = 0.0_f64;
        for _ in 0..self.effort.samples {
            let sample = draw(&self.bsdf, self.wo, mode, &mut rng);
            all.add(sample.map_or(0.0, |s| f64::from(s.weight.mean())));
            let Some((s, pdf)) = sample.and_then(|s| match s.density {
                Density::SolidAngle(pdf) => Some((s, pdf)),
                Density::Delta => None,
            }) else {
                continuous.add(0.0);
                continue;
            };
            continuous.add(f64::from(s.weight.mean()));
            counts[hemisphere::cell(s.wi)] += 1.0;
            if self.claims.is_closed_form() {
                worst_ratio = worst_ratio.max(self.ratio_error(&s, pdf.0, mode));
            }
        }
        let quadrature = self.quadrature(mode);
        let sampled = counts.iter().sum::<f64>() / n;
        let mass: f64 = quadrature.density.iter().sum();
        if self.claims.is_closed_form() {
            // Density and weight share D: their rounding errors add up over a narrow lobe.
            find(Law::WeightIsRatio, Evidence::Bound { observed: worst_ratio, limit: 2e-2 });
            let spread = (sampled * (1.0 - sampled) / n).sqrt();
            let tolerance = self.effort.sigmas * spread + 2e-3;
            find(Law::DensityMass, Evidence::Equality { observed: mass, expected: sampled, tolerance });
            if sampled > 0.0 {
                // The quadrature's error of the whole is no matter of the shape.
                let expected: Vec<f64> = quadrature.density.iter().map(|d| d * n * sampled / mass).collect();
                let test = ChiSquared::test(&counts, &expected);
                let evidence = Evidence::Probability {
                    statistic: test.statistic,
                    degrees_of_freedom: test.degrees_of_freedom,
                    p: test.p,
                    significance: self.effort.significance,
                };
                find(Law::SamplesFollowDensity, evidence);
            }
        }
        let by_quadrature = quadrature.power.mean();
        let error = continuous
            .error()
            .hypot(quadrature.power.error() * f64::from(u8::from(!self.claims.is_closed_form())));
        find(
            Law::TwoWaysToReflectance,
            Evidence::Equality {
                observed: continuous.mean(),
                expected: by_quadrature,
                tolerance: self.effort.sigmas * error + 2e-3 * by_quadrature,
            },
        );
        if mode == Mode::Importance {
            // One-sided at 95 %.
            find(
                Law::Energy,
                Evidence::Bound { observed: all.mean() - 1.645 * all.error(), limit: 1.0 + 1e-5 },
            );
            if let Energy::Lossless { tolerance } = self.claims.energy {
                let tolerance = tolerance - 1.96 * all.error();
                find(Law::Energy, Evidence::Equality { observed: all.mean(), expected: 1.0, tolerance });
            }
        }
    }

    /// Relative difference between the weight and f·|cosθ|/p.
    fn ratio_error(&self, s: &BsdfSample, pdf: f32, mode: Mode) -> f64 {
        let f = self.bsdf.eval(self.wo, s.wi, mode);
        let density = self.bsdf.pdf(self.wo, s.wi, mode).0;
        let mut worst = f64::from((density - pdf).abs() / pdf);
        // Within a millirad of the horizon the direction's own rounding changes the cosine.
        if s.wi.abs_cos_theta() < 1e-3 {
            return 0.0;
        }
        for lane in 0..LANES {
            let ratio = f[lane] * s.wi.abs_cos_theta() / pdf;
            worst = worst.max(f64::from((ratio - s.weight[lane]).abs() / s.weight[lane].max(1e-3)));
        }
        worst
    }

    fn quadrature(&self, mode: Mode) -> Quadrature {
        let mut density = vec![0.0; hemisphere::CELLS];
        let mut power = Moments::default();
        for node in hemisphere::nodes() {
            if self.claims.is_closed_form() {
                density[node.cell] += f64::from(self.bsdf.pdf(self.wo, node.w, mode).0) * node.solid_angle;
            }
            let f = self.bsdf.eval(self.wo, node.w, mode).mean() * node.w.abs_cos_theta();
            // Times their number: the mean over the nodes is the integral.
            power.add(f64::from(f) * node.solid_angle * hemisphere::NODES as f64);
        }
        Quadrature { density, power }
    }

    fn examine_reciprocity(&self, findings: &mut Vec<Finding>) {
        let mode = Mode::Radiance;
        let mut rng = Pcg32::new(self.effort.seed, 9);
        let (pairs, repeats) = if self.claims.is_closed_form() { (200, 1) } else { (4, 4000) };
        let mut worst = Evidence::Equality { observed: 0.0, expected: 0.0, tolerance: 0.0 };
        let mut worst_excess = f64::NEG_INFINITY;
        for _ in 0..pairs {
            let Some(s) = draw(&self.bsdf, self.wo, mode, &mut rng) else { continue };
            if s.density.is_delta() || s.wi.abs_cos_theta() < 1e-2 {
                continue;
            }
            let (mut there, mut back, mut adjoint) =
                (Moments::default(), Moments::default(), Moments::default());
            for i in 0..repeats {
                let bsdf = self.bsdf.with_seed(hash::combine(self.effort.seed, i));
                let eta2 = s.eta * s.eta;
                there.add(f64::from(bsdf.eval(self.wo, s.wi, mode).mean() * eta2));
                back.add(f64::from(bsdf.eval(s.wi, self.wo, mode).mean()));
                adjoint.add(f64::from(bsdf.eval(s.wi, self.wo, mode.adjoint()).mean() * eta2));
            }
            for other in [back, adjoint] {
                let error =
                    if self.claims.is_closed_form() { 0.0 } else { there.error().hypot(other.error()) };
                let tolerance = self.effort.sigmas * error + 2e-3 * there.mean().abs();
                let excess = (there.mean() - other.mean()).abs() - tolerance;
                if excess > worst_excess {
                    worst_excess = excess;
                    worst = Evidence::Equality { observed: other.mean(), expected: there.mean(), tolerance };
                }
            }
        }
        findings.push(Finding { law: Law::Reciprocity, wo: self.wo, mode, evidence: worst });
    }
}

/// Values at and near the horizon, from both sides.
fn examine_grazing<B: Scatterer>(specimen: &Specimen<B>, effort: &Effort, findings: &mut Vec<Finding>) {
    let mut rng = Pcg32::new(effort.seed, 23);
    let bsdf = &specimen.bsdf;
    for mode in [Mode::Radiance, Mode::Importance] {
        for z in [1.0_f32, 1e-2, 1e-4, 1e-7, 1e-20, 0.0, -1e-20, -1e-7, -1e-3, -1.0] {
            let r = (1.0 - z * z).sqrt();
            let wo = LocalDir::new_unchecked(Vec3::new(r * 0.6, r * 0.8, z));
            let sound = |x: f32| x.is_finite() && x >= 0.0;
            let mut unsound = 0;
            for i in 0..200 {
                let mut w = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
                if i % 2 == 0 {
                    // Grazing, or the mirror direction itself.
                    w = if i % 4 == 0 {
                        Vec3::new(-wo.x, -wo.y, wo.z)
                    } else {
                        Vec3::new(w.x, w.y, w.z * 1e-6)
                    };
                }
                let Some(wi) = LocalDir::new(w) else { continue };
                let f = bsdf.eval(wo, wi, mode);
                let sample = draw(bsdf, wo, mode, &mut rng);
                let fine = (0..LANES).all(|l| sound(f[l]))
                    && sound(bsdf.pdf(wo, wi, mode).0)
                    && sample.is_none_or(|s| {
                        let pdf = match s.density {
                            Density::SolidAngle(p) => sound(p.0) && p.0 > 0.0,
                            Density::Delta => true,
                        };
                        pdf && (0..LANES).all(|l| sound(s.weight[l])) && (s.wi.length() - 1.0).abs() < 1e-3
                    });
                unsound += u32::from(!fine);
            }
            let evidence = Evidence::Bound { observed: f64::from(unsound), limit: 0.0 };
            findings.push(Finding { law: Law::Finite, wo, mode, evidence });
        }
    }
}

fn draw<B: Scatterer>(bsdf: &B, wo: LocalDir, mode: Mode, rng: &mut Pcg32) -> Option<BsdfSample> {
    let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
    bsdf.sample(wo, uc, u, mode)
}

#[cfg(test)]
mod tests;
