//! What can be examined.

use crate::bsdf::{Albedo, Bsdf, BsdfSample, Lobes, Mode};
use crate::math::hash::Pcg32;
use crate::math::{LocalDir, Vec2};
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian};

/// What can be examined: a [`Bsdf`], or anything that scatters like one.
pub trait Scatterer: Copy {
    /// f [sr⁻¹], without the cosine and without discrete directions.
    fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian>;
    /// Density of `wi` among the continuous directions drawn for `wo`.
    fn pdf(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> PdfSolidAngle;
    /// Draws `wi` for `wo`.
    fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample>;
    /// ρ and τ for light from `wi`.
    fn albedo(&self, wi: LocalDir) -> Albedo;
    /// Which continuous lobes are declared.
    fn lobes(&self) -> Lobes;
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

    fn albedo(&self, wi: LocalDir) -> Albedo {
        Self::albedo(self, wi)
    }

    fn lobes(&self) -> Lobes {
        Self::lobes(self)
    }

    fn with_seed(self, seed: u64) -> Self {
        Self::with_seed(self, seed)
    }
}

/// Draws with the next random numbers.
pub(super) fn draw<B: Scatterer>(bsdf: &B, wo: LocalDir, mode: Mode, rng: &mut Pcg32) -> Option<BsdfSample> {
    let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
    bsdf.sample(wo, uc, u, mode)
}
