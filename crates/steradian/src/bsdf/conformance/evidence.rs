//! What the suite finds, and what it rests on.

use crate::bsdf::contract::Mode;
use crate::math::{LocalDir, warp};
use std::fmt;

/// A law of scattering, or of the bookkeeping that transport relies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Law {
    /// Sampled directions follow the density (Pearson's χ² over cells that follow the lobes).
    SamplesFollowDensity,
    /// The density integrates to the probability that sampling yields a continuous direction.
    DensityMass,
    /// The density that comes with a sample is the one that is reported for its direction.
    DensityOfSample,
    /// weight = f·|cosθi|/p at each sample and wavelength; where f is an estimate, in the mean over each cell.
    WeightIsRatio,
    /// Samples say rightly which side they leave to and which index they cross, and come from declared lobes only.
    Bookkeeping,
    /// f(wo, wi) η² = f(wi, wo) with η² = 1 but across an interface, B (2.18), and likewise the power of discrete
    /// directions.
    Reciprocity,
    /// f for radiance from `wi` to `wo` is f for power from `wo` to `wi`: (ηo/ηi)² scales the one and not the other.
    Adjoint,
    /// ρ + τ ≤ 1 for light from one direction, B (2.19).
    Energy,
    /// ρ + τ = 1 where no loss is claimed.
    Lossless,
    /// ρ and τ by sampling, by quadrature and by the function's own albedo are the same numbers.
    AnswersAgree,
    /// The scattering probability function s = f cosθ/ρ, B (2.20), integrates to one with the function's own ρ.
    ScatteringProbability,
    /// Values, densities and weights are finite and not negative, at grazing angles as well.
    Finite,
}

impl Law {
    /// All laws, in the order of reports.
    pub const ALL: [Self; 12] = [
        Self::SamplesFollowDensity,
        Self::DensityMass,
        Self::DensityOfSample,
        Self::WeightIsRatio,
        Self::Bookkeeping,
        Self::Reciprocity,
        Self::Adjoint,
        Self::Energy,
        Self::Lossless,
        Self::AnswersAgree,
        Self::ScatteringProbability,
        Self::Finite,
    ];

    /// A short name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::SamplesFollowDensity => "chi-square",
            Self::DensityMass => "pdf mass",
            Self::DensityOfSample => "sample's pdf",
            Self::WeightIsRatio => "weight",
            Self::Bookkeeping => "bookkeeping",
            Self::Reciprocity => "reciprocity",
            Self::Adjoint => "adjoint",
            Self::Energy => "energy",
            Self::Lossless => "lossless",
            Self::AnswersAgree => "three answers",
            Self::ScatteringProbability => "spf",
            Self::Finite => "finite",
        }
    }

    /// What the law says, for an explanation.
    pub fn statement(self) -> &'static str {
        match self {
            Self::SamplesFollowDensity => "sampled directions follow the density",
            Self::DensityMass => "the density integrates to the share of continuous samples",
            Self::DensityOfSample => "a sample's density is the one reported for its direction",
            Self::WeightIsRatio => "a sample's weight is f·cosθ/p",
            Self::Bookkeeping => "samples name their side, index and lobe rightly",
            Self::Reciprocity => "f(wo, wi)·η² = f(wi, wo)",
            Self::Adjoint => "f for radiance one way is f for power the other way",
            Self::Energy => "ρ + τ ≤ 1",
            Self::Lossless => "ρ + τ = 1",
            Self::AnswersAgree => "ρ and τ by sampling, by quadrature and by albedo() agree",
            Self::ScatteringProbability => "∫ f·cosθ/ρ dω = 1 with the function's own ρ",
            Self::Finite => "values are finite and not negative",
        }
    }
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

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Probability { statistic, degrees_of_freedom, p, significance } => {
                write!(f, "χ² = {statistic:.1} at {degrees_of_freedom} degrees of freedom, p = {p:.2e}")?;
                write!(f, " (rejected below {significance:.1e})")
            }
            Self::Equality { observed, expected, tolerance } => {
                write!(f, "{observed:.6} instead of {expected:.6} ± {tolerance:.6}")
            }
            Self::Bound { observed, limit } => write!(f, "{observed:.6}, at most {limit:.6}"),
        }
    }
}

impl Evidence {
    /// Whether the law holds as far as the evidence goes. NaN never holds.
    pub fn holds(&self) -> bool {
        match *self {
            Self::Probability { p, significance, .. } => p >= significance,
            Self::Equality { observed, expected, tolerance } => (observed - expected).abs() <= tolerance,
            Self::Bound { observed, limit } => observed <= limit,
        }
    }

    /// How far the evidence goes, one where it just holds: for choosing the worst of several.
    pub fn strain(&self) -> f64 {
        let strain = match *self {
            Self::Probability { p, significance, .. } => p.max(f64::MIN_POSITIVE).ln() / significance.ln(),
            Self::Equality { observed, expected, tolerance } => (observed - expected).abs() / tolerance,
            Self::Bound { observed, limit } if limit > 0.0 => observed / limit,
            Self::Bound { observed, .. } => 1.0 + observed,
        };
        if strain.is_nan() { f64::INFINITY } else { strain }
    }
}

/// What the claims let expect of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// That the law holds.
    Holds,
    /// That it does not: the suite must be able to show that.
    Broken,
    /// Nothing: the finding is shown and not judged.
    Reported,
}

/// One law examined at one direction, or at the worst pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// The law.
    pub law: Law,
    /// The fixed direction.
    pub wo: LocalDir,
    /// The other direction, for laws about pairs.
    pub wi: Option<LocalDir>,
    /// Index of the wavelength that it was worst at, for laws that hold per wavelength.
    pub lane: Option<usize>,
    /// What was transported.
    pub mode: Mode,
    /// What the verdict rests on.
    pub evidence: Evidence,
    /// What was expected.
    pub expectation: Expectation,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let angles = |w: LocalDir| {
            let (theta, phi) = warp::spherical_angles(*w);
            format!("({:.2}°, {:.2}°)", theta.to_degrees(), phi.to_degrees())
        };
        write!(f, "{} ({}) at wo = {}", self.law.name(), self.law.statement(), angles(self.wo))?;
        if let Some(wi) = self.wi {
            write!(f, ", wi = {}", angles(wi))?;
        }
        if let Some(lane) = self.lane {
            write!(f, ", wavelength {}", lane + 1)?;
        }
        write!(f, ", {:?}: {}", self.mode, self.evidence)
    }
}

impl Finding {
    /// A finding about one direction, for a law that is expected to hold.
    pub(super) fn new(law: Law, wo: LocalDir, mode: Mode, evidence: Evidence) -> Self {
        Self { law, wo, wi: None, lane: None, mode, evidence, expectation: Expectation::Holds }
    }

    /// At the wavelength with this index.
    pub(super) fn at_lane(self, lane: usize) -> Self {
        Self { lane: Some(lane), ..self }
    }

    /// Under another expectation.
    pub(super) fn expecting(self, expectation: Expectation) -> Self {
        Self { expectation, ..self }
    }

    /// Whether the law holds as far as the evidence goes.
    pub fn holds(&self) -> bool {
        self.evidence.holds()
    }

    /// Whether the finding is as the claims let expect.
    pub fn is_as_claimed(&self) -> bool {
        match self.expectation {
            Expectation::Holds => self.holds(),
            Expectation::Broken => !self.holds(),
            Expectation::Reported => true,
        }
    }
}
