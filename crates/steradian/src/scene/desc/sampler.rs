//! The sampler as the scene states it.

use crate::scene::source::Span;
use std::fmt;

/// Most samples per pixel: the sequences are distinct up to here, and more are taken for a slip.
pub const MAX_SAMPLES: u32 = 1 << 24;

/// The sampler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerDesc {
    /// The sequence.
    pub kind: SamplerKind,
    /// Samples per pixel (16; independent 4; stratified x·y), from 1 to [`MAX_SAMPLES`].
    pub pixel_samples: u32,
    /// Noise to aim at with at most that many samples; `None` gives every pixel the same number.
    pub noise: Option<NoiseTarget>,
    /// Seed; `None` takes the one of the options.
    pub seed: Option<i32>,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// How much noise a picture may have.
///
/// The noise of a pixel is the standard error of its R, G and B (root mean square of the three), divided by their mean;
/// by that of the 11 × 11 pixels around where that is less, and by a tenth of the median over the lit pixels of the
/// picture where that is more. The noise of a picture is the root mean square of its pixels' noise, where each variance is
/// averaged over the window and the noisiest hundredth is left out. A picture of noise 1 % thus differs from the converged
/// one by about 1 % of its brightness: by more where that is costly to change, by less where it is cheap.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct NoiseTarget(f32);

impl NoiseTarget {
    /// A target as a fraction, in (0, 1]; `None` outside.
    pub fn new(fraction: f32) -> Option<Self> {
        (fraction > 0.0 && fraction <= 1.0).then_some(Self(fraction))
    }

    /// The fraction, in (0, 1].
    pub fn get(self) -> f32 {
        self.0
    }
}

impl fmt::Display for NoiseTarget {
    /// As a percentage, without what the fraction's rounding would add to what was asked for.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} %", (f64::from(self.0) * 1e6).round() / 1e4)
    }
}

/// The kinds of sequence; default randomisation in parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerKind {
    /// Independent uniform numbers.
    Independent,
    /// Jittered strata.
    Stratified {
        /// Strata along x (4), ≥ 1.
        x: u32,
        /// Strata along y (4), ≥ 1.
        y: u32,
        /// Whether samples are jittered inside their strata (true).
        jitter: bool,
    },
    /// Halton (permuted digits).
    Halton(Randomization),
    /// Sobol′ over the whole picture (fast Owen).
    Sobol(Randomization),
    /// Two-dimensional Sobol′ points, padded (fast Owen).
    PaddedSobol(Randomization),
    /// Sobol′ points distributed along a Morton curve (fast Owen).
    ZSobol(Randomization),
    /// Progressive multi-jittered points with blue noise.
    Pmj02bn,
}

/// How a deterministic sequence is randomised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Randomization {
    /// Not at all.
    None,
    /// Random permutation of digits.
    PermuteDigits,
    /// Approximate Owen scrambling by hashing.
    FastOwen,
    /// Owen scrambling.
    Owen,
}
