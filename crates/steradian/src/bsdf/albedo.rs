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
    /// Points of the average over samples.
    pub(super) const SAMPLES: u32 = 1 << 14;

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
    /// Hammersley's set. Its error is some 3·10⁻⁴ for smooth functions, 2·10⁻³ for random walks.
    pub(super) fn by_sampling(sample: impl Fn(f32, Vec2) -> Option<BsdfSample>) -> Self {
        let (mut reflected, mut transmitted) = ([0.0_f64; LANES], [0.0_f64; LANES]);
        for i in 0..Self::SAMPLES {
            let uc = (i as f32 + 0.5) / Self::SAMPLES as f32;
            // Base 2, by its bits.
            let ux = i.reverse_bits() as f32 * (1.0 / 4_294_967_296.0);
            let u = Vec2::new(ux, radical_inverse_base_3(i)).min(Vec2::splat(ONE_MINUS_EPSILON));
            let Some(s) = sample(uc, u) else { continue };
            let sum = if s.side == Side::Reflection { &mut reflected } else { &mut transmitted };
            for (sum, weight) in sum.iter_mut().zip(s.weight.to_array()) {
                *sum += f64::from(weight);
            }
        }
        let mean =
            |sum: [f64; LANES]| Sampled::from_array(sum.map(|x| (x / f64::from(Self::SAMPLES)) as f32));
        Self { reflectance: mean(reflected), transmittance: mean(transmitted) }
    }
}

/// The digits of `i` in base 3, mirrored at the point: in [0, 1).
fn radical_inverse_base_3(mut i: u32) -> f32 {
    let (mut digits, mut scale) = (0_u32, 1_u32);
    while i > 0 {
        digits = digits * 3 + i % 3;
        scale *= 3;
        i /= 3;
    }
    digits as f32 / scale as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_mirrored() {
        let inverse: Vec<f32> = (0..5).map(radical_inverse_base_3).collect();
        let expected = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0 / 9.0, 4.0 / 9.0];
        assert!(inverse.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7), "{inverse:?}");
    }
}
