//! Laws about sampling and power at one direction.

use super::evidence::{Evidence, Expectation, Finding, Law};
use super::scatterer::{Scatterer, draw};
use super::statistics::{ChiSquared, Moments};
use super::survey::{Bench, Integral, Survey};
use crate::bsdf::Albedo;
use crate::bsdf::contract::{Mode, Side};
use crate::bsdf::specimen::{Energy, Values};
use crate::math::LocalDir;
use crate::math::hash::{self, Pcg32};
use crate::spectrum::LANES;

/// ρ and τ for light from one direction, three ways; one number per wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// Where light arrives from.
    pub wi: LocalDir,
    /// By sampling: mean weights.
    pub sampled: Answer,
    /// Standard errors of the sampled answer.
    pub error: Answer,
    /// Standard errors of the sampled ρ + τ.
    pub total_error: [f64; LANES],
    /// By quadrature of f cosθ and the power of discrete directions.
    pub integrated: Answer,
    /// Standard errors of the integrated ρ + τ, from that of discrete directions.
    pub integrated_error: [f64; LANES],
    /// By the function's own albedo.
    pub own: Answer,
}

/// ρ and τ per wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// ρ.
    pub reflectance: [f64; LANES],
    /// τ.
    pub transmittance: [f64; LANES],
}

impl Answer {
    fn from_fn(f: impl Fn(Side, usize) -> f64) -> Self {
        Self {
            reflectance: std::array::from_fn(|lane| f(Side::Reflection, lane)),
            transmittance: std::array::from_fn(|lane| f(Side::Transmission, lane)),
        }
    }

    /// ρ + τ at a wavelength.
    pub fn total(&self, lane: usize) -> f64 {
        self.reflectance[lane] + self.transmittance[lane]
    }

    fn of(&self, side: Side, lane: usize) -> f64 {
        match side {
            Side::Reflection => self.reflectance[lane],
            Side::Transmission => self.transmittance[lane],
        }
    }
}

impl From<Albedo> for Answer {
    fn from(a: Albedo) -> Self {
        Self {
            reflectance: a.reflectance.to_array().map(f64::from),
            transmittance: a.transmittance.to_array().map(f64::from),
        }
    }
}

/// How far off a function's own albedo may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OwnError {
    /// It is a closed form.
    None,
    /// It is an average over points that are spread evenly.
    Spaced,
    /// It is an average over random walks.
    Random,
}

impl OwnError {
    /// Over the standard error of as many random samples.
    fn share(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Spaced => 0.3,
            Self::Random => 1.0,
        }
    }
}

/// One-sided deviate of the 95 % bound on energy.
const ONE_SIDED_95: f64 = 1.645;
/// Two-sided deviate of the 95 % interval of an equivalence test.
const TWO_SIDED_95: f64 = 1.96;
/// How many times the samples may be quadrupled until a verdict about energy is clear.
const REPETITIONS: u32 = 3;
/// What rounding adds to a sum of weights that are one.
const ROUNDING: f64 = 2e-5;

impl<B: Scatterer> Bench<'_, B> {
    /// Laws about samples, densities and weights.
    pub(super) fn judge_sampling(&self, survey: &Survey, findings: &mut Vec<Finding>) {
        let find = |law, evidence| Finding::new(law, survey.wo, survey.mode, evidence);
        let misfits = Evidence::Bound { observed: f64::from(survey.misfits), limit: 0.0 };
        findings.push(find(Law::Bookkeeping, misfits));
        for (law, worst) in
            [(Law::WeightIsRatio, survey.weight), (Law::DensityOfSample, survey.sample_density)]
        {
            let Some(d) = worst else { continue };
            let (observed, expected, tolerance) = (d.observed, d.expected, d.tolerance);
            let mut finding = find(law, Evidence::Equality { observed, expected, tolerance });
            (finding.wi, finding.lane) = (Some(d.wi), d.lane);
            findings.push(finding.expecting(self.of_values()));
        }
        if !self.claims.is_closed_form() {
            return;
        }
        let n = f64::from(survey.n);
        let share = survey.counts.iter().sum::<f64>() / n;
        let mass: f64 = survey.density.iter().sum();
        let tolerance = self.effort.sigmas() * (share * (1.0 - share) / n).sqrt() + 2e-3;
        findings
            .push(find(Law::DensityMass, Evidence::Equality { observed: mass, expected: share, tolerance }));
        if share == 0.0 {
            return;
        }
        // The quadrature's error of the whole is no matter of the shape.
        let expected: Vec<f64> = survey.density.iter().map(|d| d * n * share / mass).collect();
        // Fine cells find a wrong width, coarse ones a gentle slope.
        let coarse = [survey.partition.grouped(&survey.counts), survey.partition.grouped(&expected)];
        for (counts, expected) in [(&survey.counts, &expected), (&coarse[0], &coarse[1])] {
            let test = ChiSquared::test(counts, expected);
            let evidence = Evidence::Probability {
                statistic: test.statistic,
                degrees_of_freedom: test.degrees_of_freedom,
                p: test.p,
                significance: self.effort.significance(),
            };
            findings.push(find(Law::SamplesFollowDensity, evidence));
        }
    }

    /// Laws about power, for a survey towards sensors.
    pub(super) fn judge_power(&self, survey: &Survey, index: u64, findings: &mut Vec<Finding>) -> Power {
        let wi = survey.wo;
        let albedo = self.bsdf.albedo(wi);
        let own = Answer::from(albedo);
        // An average over the function's own samples has their error, a closed form has none.
        let averaged = Albedo::by_sampling(|uc, u| self.bsdf.sample(wi, uc, u, Mode::Importance));
        let own_error = match self.claims.values {
            _ if averaged != albedo => OwnError::None,
            Values::ClosedForm | Values::BiasedClosedForm => OwnError::Spaced,
            Values::Estimated | Values::Biased => OwnError::Random,
        };
        let power = Power {
            wi,
            sampled: Answer::from_fn(|side, lane| survey.by_sampling(side, lane).value),
            error: Answer::from_fn(|side, lane| survey.by_sampling(side, lane).error),
            total_error: survey.total.map(|m| m.error()),
            integrated: Answer::from_fn(|side, lane| survey.by_quadrature(side, lane).value),
            integrated_error: std::array::from_fn(|lane| {
                let error = |side| survey.by_quadrature(side, lane).error;
                error(Side::Reflection).hypot(error(Side::Transmission))
            }),
            own,
        };
        self.judge_agreement(survey, &own, own_error, findings);
        self.judge_energy(survey, index, findings);
        power
    }

    fn judge_agreement(
        &self,
        survey: &Survey,
        own: &Answer,
        own_error: OwnError,
        findings: &mut Vec<Finding>,
    ) {
        let sigmas = self.effort.sigmas();
        let own_error = |sampled: &Integral| {
            own_error.share() * sampled.error * (f64::from(survey.n) / f64::from(Albedo::SAMPLES)).sqrt()
        };
        let (mut agreement, mut unity): (Option<Finding>, Option<Finding>) = (None, None);
        let keep = |worst: &mut Option<Finding>, f: Finding| {
            if worst.is_none_or(|w| f.evidence.strain() > w.evidence.strain()) {
                *worst = Some(f);
            }
        };
        for side in [Side::Reflection, Side::Transmission] {
            for lane in 0..LANES {
                let sampled = survey.by_sampling(side, lane);
                let integrated = survey.by_quadrature(side, lane);
                let own_value = own.of(side, lane);
                let find = |law, observed: f64, expected: f64, tolerance: f64| {
                    let evidence = Evidence::Equality { observed, expected, tolerance };
                    let f = Finding::new(law, survey.wo, survey.mode, evidence).at_lane(lane);
                    f.expecting(self.of_values())
                };
                // The discrete part is common to both: its error cancels.
                let error = sampled.error.hypot(survey.integrated.of(side)[lane].error);
                let tolerance = sigmas * error + 2e-3 * sampled.value + 5e-4;
                keep(&mut agreement, find(Law::AnswersAgree, integrated.value, sampled.value, tolerance));
                let error = sampled.error.hypot(own_error(&sampled));
                let tolerance = sigmas * error + 2e-3 * sampled.value + 1e-3;
                keep(&mut agreement, find(Law::AnswersAgree, own_value, sampled.value, tolerance));
                if own_value > 0.02 || integrated.value > 0.02 {
                    let tolerance =
                        (sigmas * integrated.error.hypot(own_error(&sampled)) + 1e-3) / own_value + 4e-3;
                    let unit = integrated.value / own_value;
                    keep(&mut unity, find(Law::ScatteringProbability, unit, 1.0, tolerance));
                }
            }
        }
        findings.extend(agreement.into_iter().chain(unity));
    }

    /// ρ + τ against one: by the lower bound where at most one is claimed, by equivalence where exactly one is.
    fn judge_energy(&self, survey: &Survey, index: u64, findings: &mut Vec<Finding>) {
        let find = |law, lane, evidence| Finding::new(law, survey.wo, survey.mode, evidence).at_lane(lane);
        let (excess_limit, tolerance) = match self.claims.energy {
            Energy::Lossless { tolerance } => (1.0 + tolerance, Some(tolerance)),
            Energy::Passive | Energy::Unbounded => (1.0 + ROUNDING, None),
        };
        let mut totals = survey.total;
        let mut n = survey.n;
        let mut deviate = ONE_SIDED_95;
        for round in 0..=REPETITIONS {
            let unsettled = |m: &Moments| {
                let exceeds = |sigmas: f64| !(m.mean() - sigmas * m.error() <= excess_limit);
                // What 95 % hint at, the level of the run confirms: a bound on something that is one errs once in twenty times.
                let hinted = exceeds(ONE_SIDED_95) && !(round > 0 && exceeds(self.effort.sigmas()));
                let off = (m.mean() - 1.0).abs();
                let open = tolerance.is_some_and(|t| {
                    off + TWO_SIDED_95 * m.error() > t && off - self.effort.sigmas() * m.error() <= t
                });
                hinted || open
            };
            if round == REPETITIONS || !totals.iter().any(unsettled) {
                break;
            }
            // Fresh samples, four times as many: the first look does not bias the second.
            n = n.saturating_mul(4).min(1 << 22);
            let seed = hash::combine(self.effort.seed, hash::combine(index, u64::from(round)));
            totals = totals_by_sampling(&self.bsdf, survey.wo, n, seed);
            deviate = self.effort.sigmas();
        }
        let worst = |key: &dyn Fn(&Moments) -> f64| {
            (0..LANES).fold(0, |a, b| if key(&totals[b]) > key(&totals[a]) { b } else { a })
        };
        let bound = |m: &Moments| m.mean() - deviate * m.error();
        let lane = worst(&bound);
        // Where no bound is claimed, all directions are judged together.
        let expectation = match self.claims.energy {
            Energy::Unbounded => Expectation::Reported,
            Energy::Lossless { .. } | Energy::Passive => Expectation::Holds,
        };
        let evidence = Evidence::Bound { observed: bound(&totals[lane]), limit: excess_limit };
        findings.push(find(Law::Energy, lane, evidence).expecting(expectation));
        if let Some(tolerance) = tolerance {
            let interval = |m: &Moments| (m.mean() - 1.0).abs() + TWO_SIDED_95 * m.error();
            let lane = worst(&interval);
            let tolerance = tolerance - TWO_SIDED_95 * totals[lane].error();
            let evidence = Evidence::Equality { observed: totals[lane].mean(), expected: 1.0, tolerance };
            findings.push(find(Law::Lossless, lane, evidence));
        }
    }

    /// What to expect of laws about values: a named bias breaks them.
    pub(super) fn of_values(&self) -> Expectation {
        match self.claims.values {
            Values::ClosedForm | Values::Estimated => Expectation::Holds,
            Values::Biased | Values::BiasedClosedForm => Expectation::Reported,
        }
    }
}

/// Mean weights towards sensors for light from `wi`, both sides together.
fn totals_by_sampling<B: Scatterer>(bsdf: &B, wi: LocalDir, n: u32, seed: u64) -> [Moments; LANES] {
    let mut rng = Pcg32::new(seed, 17);
    let mut totals = [Moments::default(); LANES];
    for _ in 0..n {
        let weight = draw(bsdf, wi, Mode::Importance, &mut rng).map_or([0.0; LANES], |s| s.weight.to_array());
        for (m, w) in totals.iter_mut().zip(weight) {
            m.add(f64::from(w));
        }
    }
    totals
}

/// ρ + τ by sampling, over all wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// Mean over the lanes.
    pub value: f64,
    /// Standard error of the mean.
    pub error: f64,
}

/// ρ + τ for light that arrives from `wi`, by `samples` samples: the ratio of scattered to incident power, B (2.14), (2.15).
pub fn albedo<B: Scatterer>(bsdf: &B, wi: LocalDir, samples: u32, seed: u64) -> Estimate {
    let mut rng = Pcg32::new(seed, 17);
    let mut moments = Moments::default();
    for _ in 0..samples {
        moments.add(draw(bsdf, wi, Mode::Importance, &mut rng).map_or(0.0, |s| f64::from(s.weight.mean())));
    }
    Estimate { value: moments.mean(), error: moments.error() }
}
