//! The sampler as the scene states it.

use crate::scene::source::Span;

/// Most samples per pixel: the sequences are distinct up to here, and more are taken for a slip.
pub const MAX_SAMPLES: u32 = 1 << 24;

/// The sampler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerDesc {
    /// The sequence.
    pub kind: SamplerKind,
    /// Samples per pixel (16; independent 4; stratified x·y), from 1 to [`MAX_SAMPLES`].
    pub pixel_samples: u32,
    /// Seed; `None` takes the one of the options.
    pub seed: Option<i32>,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
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
