//! What becomes of light that arrives from one direction.

use super::contract::{BsdfSample, Side};
use crate::math::Vec2;
use crate::math::float::ONE_MINUS_EPSILON;
use crate::spectrum::{LANES, Sampled};
use crate::units::Unitless;

/// Directional–hemispherical reflectance ρ and transmittance τ: ratios of scattered to incident power for light from
/// one direction, per wavelength, in [0, 1] for anything that obeys B (2.14), (2.15) and (2.19).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Albedo {
    /// ρ: power that stays on the side of the light, discrete directions included.
    pub reflectance: Sampled<Unitless>,
    /// τ: power that goes to the other side.
    pub transmittance: Sampled<Unitless>,
}

impl Albedo {
    /// Nothing is scattered.
    pub const BLACK: Self = Self { reflectance: Sampled::ZERO, transmittance: Sampled::ZERO };

    /// That of a surface that only reflects.
    pub const fn reflecting(reflectance: Sampled<Unitless>) -> Self {
        Self { reflectance, transmittance: Sampled::ZERO }
    }

    /// That of a clear interface: `reflectance` [0, 1] at every wavelength, and the rest passes.
    pub fn clear(reflectance: f32) -> Self {
        Self {
            reflectance: Sampled::splat(reflectance),
            transmittance: Sampled::splat((1.0 - reflectance).max(0.0)),
        }
    }

    /// ρ + τ, what is not absorbed.
    pub fn total(&self) -> Sampled<Unitless> {
        self.reflectance + self.transmittance
    }

    /// The mean weight of `sample`, which draws towards sensors with `uc` ∈ [0, 1) and `u` ∈ [0, 1)², over 16 384 points of
    /// an additive recurrence. Its error is about 10⁻⁴ for smooth functions, 2·10⁻³ for random walks.
    pub(super) fn by_sampling(sample: impl Fn(f32, Vec2) -> Option<BsdfSample>) -> Self {
        const N: u32 = 1 << 14;
        // Powers of 1/x for the root of x⁴ = x + 1 (Roberts 2018): the points stay apart in every projection.
        const STEP: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3];
        let (mut reflected, mut transmitted) = ([0.0_f64; LANES], [0.0_f64; LANES]);
        for i in 0..N {
            let [uc, ux, uy] = STEP.map(|step| {
                // Rounding to f32 may reach one.
                (((f64::from(i) + 0.5) * step).fract() as f32).min(ONE_MINUS_EPSILON)
            });
            let Some(s) = sample(uc, Vec2::new(ux, uy)) else { continue };
            let sum = if s.side == Side::Reflection { &mut reflected } else { &mut transmitted };
            for (sum, weight) in sum.iter_mut().zip(s.weight.to_array()) {
                *sum += f64::from(weight);
            }
        }
        let mean = |sum: [f64; LANES]| Sampled::from_array(sum.map(|x| (x / f64::from(N)) as f32));
        Self { reflectance: mean(reflected), transmittance: mean(transmitted) }
    }
}
