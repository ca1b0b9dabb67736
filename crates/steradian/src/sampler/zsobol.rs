//! Sobol' points along a hierarchically shuffled Morton curve: errors of neighbouring pixels cancel.

use super::position::Position;
use super::scramble::{Randomization, unit};
use super::sobol;
use crate::math::Vec2;
use crate::math::hash::mix_bits;

/// Screen-space blue-noise error by Z-order (Ahmed & Wonka 2020): all samples of the picture are one
/// sequence, visited in Morton order with the base-4 digits of the order permuted at random in each dimension.
#[derive(Clone, Copy, Debug)]
pub struct ZSobol {
    pub(super) at: Position,
    pub(super) randomization: Randomization,
    /// Samples per pixel, rounded up to a power of two, as an exponent.
    log2_spp: u32,
    /// Binary digits of an index into the whole picture.
    bits: u32,
    /// Place of the current sample in the whole picture, before shuffling: the highest digit in the lowest bits.
    reversed: u64,
    /// What else the permutations depend on.
    salt: u64,
}

/// The higher bits of base-4 digits in a reversed index.
const HIGHER: u64 = 0x5555_5555_5555_5555;

impl ZSobol {
    pub(super) fn new(at: Position, randomization: Randomization, spp: u32, resolution: [u32; 2]) -> Self {
        let log2_spp = spp.clamp(1, 1 << 24).next_power_of_two().trailing_zeros();
        let side = resolution[0].max(resolution[1]).clamp(1, 1 << 20).next_power_of_two();
        let bits = 2 * side.trailing_zeros() + log2_spp;
        Self { at, randomization, log2_spp, bits, reversed: 0, salt: 0 }
    }

    pub(super) fn start(&mut self, pixel: [i32; 2], index: u32) {
        self.at.start(pixel, index);
        let z = interleave(pixel[0] as u32) | interleave(pixel[1] as u32) << 1;
        let wrapped = u64::from(index) & ((1 << self.log2_spp) - 1);
        let morton = (z << self.log2_spp) | wrapped;
        self.reversed = morton.unbounded_shl(64 - self.bits).reverse_bits();
        // Indices beyond the announced count visit the same block in another order.
        let round = u64::from(index) >> self.log2_spp;
        self.salt = self.at.seed.rotate_left(17) ^ round << 40;
    }

    pub(super) fn next_1d(&mut self) -> f32 {
        let dimension = self.at.advance(1);
        let index = self.shuffled(dimension);
        let h = self.dimension_hash(dimension);
        unit(self.randomization.apply(sobol::dimension_0(index), h as u32))
    }

    pub(super) fn next_2d(&mut self) -> Vec2 {
        let dimension = self.at.advance(2);
        let index = self.shuffled(dimension);
        let h = self.dimension_hash(dimension);
        Vec2::new(
            unit(self.randomization.apply(sobol::dimension_0(index), h as u32)),
            unit(self.randomization.apply(sobol::dimension_1(index), (h >> 32) as u32)),
        )
    }

    fn dimension_hash(&self, dimension: u32) -> u64 {
        mix_bits(
            self.at.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ u64::from(dimension) ^ 0x5851_f42d_0000_0000,
        )
    }

    /// The index with each base-4 digit permuted at random, depending on the digits above it.
    ///
    /// Four digits have as many permutations as pairs of bits have invertible affine maps, so that all digits are permuted
    /// at once by operations on words: a shear, another one, an exchange and a translation, each where a random word says.
    fn shuffled(&self, dimension: u32) -> u64 {
        let x = self.reversed;
        let key = mix_bits(self.salt ^ (u64::from(dimension) + 1).wrapping_mul(0xd1b5_4a32_d192_ed03));
        let other = mix_bits(key);
        let h = depending_on_digits_above(x.wrapping_add(key), 0x9e6c_63d0_876a_46d2, other | 1);
        // Each bit of x appears in the same bit of the hash as it is; what is left depends on lower bits alone.
        let random = |salt: u32, shear: u64, factor: u64| {
            depending_on_digits_above(h.wrapping_add(other.rotate_left(salt)), shear, factor) ^ x
        };
        // With an odd exponent the last digit is a binary one, and may only be translated.
        let whole = HIGHER & u64::MAX.unbounded_shr(64 - (self.bits & !1));
        let (mut higher, mut lower) = (x & HIGHER, x >> 1 & HIGHER);
        lower ^= higher & whole & random(7, 0xb543_fc1c_d4a1_7e6a, 0xa0b4_28db_9c5e_1d53);
        higher ^= lower & random(19, 0x8cb9_2ba7_2f3d_8dd6, 0xe703_7ed1_a0b4_28db);
        let exchanged = (higher ^ lower) & whole & random(31, 0xd6e8_feb8_6659_fd92, 0x8ebc_6af0_9c88_c6e3);
        higher ^= exchanged ^ (random(43, 0xc2b2_ae3d_27d4_eb4e, 0x5899_65cc_7537_4cc3) & HIGHER);
        lower ^= exchanged ^ (random(53, 0x1656_67b1_9e37_79fa, 0x1d8e_4e27_c47d_124f) & whole);
        (higher | lower << 1).reverse_bits().unbounded_shr(64 - self.bits)
    }
}

/// A word of which each bit depends on the bits of `x` up to it, and on the highest of them as it is: carries run upwards
/// only (Laine & Karras 2011). `even` is even, `odd` is odd.
#[inline(always)]
const fn depending_on_digits_above(x: u64, even: u64, odd: u64) -> u64 {
    (x ^ x.wrapping_mul(even)).wrapping_mul(odd)
}

/// Spreads the bits of `v` to the even places.
const fn interleave(v: u32) -> u64 {
    let mut x = v as u64;
    x = (x | x << 16) & 0x0000_ffff_0000_ffff;
    x = (x | x << 8) & 0x00ff_00ff_00ff_00ff;
    x = (x | x << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    x = (x | x << 2) & 0x3333_3333_3333_3333;
    (x | x << 1) & 0x5555_5555_5555_5555
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 8 products of 3 involutions are 4 of the 6 linear maps once and 2 of them twice; with the 4 translations, each
    /// permutation has a share of 1/32 or 1/16 at each level, whatever the digits above.
    #[test]
    fn every_permutation_is_met_at_every_level() {
        let digits = 5_u32;
        for level in 0..digits {
            for above in [0_u64, 0b11_01_10_00] {
                let mut met = std::collections::BTreeMap::<[u64; 4], u32>::new();
                let dimensions = 9600;
                for dimension in 0..dimensions {
                    let images = [0_u64, 1, 2, 3].map(|digit| {
                        let mut z = ZSobol::new(Position::new(5), Randomization::None, 1, [32, 32]);
                        let prefix = above & ((1 << (2 * level)) - 1);
                        let morton = (prefix << 2 | digit) << (2 * (digits - 1 - level));
                        z.reversed = (morton << (64 - z.bits)).reverse_bits();
                        z.shuffled(dimension) >> (2 * (digits - 1 - level)) & 3
                    });
                    *met.entry(images).or_default() += 1;
                }
                assert_eq!(met.len(), 24, "level {level}");
                // Shares of 1/32 and 1/16 with five standard deviations around.
                for (images, count) in met {
                    let (share, n) = (f64::from(count) / f64::from(dimensions), f64::from(dimensions));
                    let near = |p: f64| (share - p).abs() < 5.0 * (p / n).sqrt();
                    assert!(near(1.0 / 32.0) || near(1.0 / 16.0), "level {level}, {images:?}: {share}");
                }
            }
        }
    }

    #[test]
    fn shuffling_is_a_bijection_of_the_picture() {
        for (side, spp) in [(8, 1), (8, 2), (8, 4), (8, 8), (1, 1), (1, 2), (2, 1)] {
            let mut z = ZSobol::new(Position::new(3), Randomization::FastOwen, spp, [side; 2]);
            for dimension in [0, 1, 5] {
                let mut seen = vec![false; (side * side * spp) as usize];
                for i in 0..side * side * spp {
                    let (pixel, index) = (i / spp, i % spp);
                    z.start([(pixel % side) as i32, (pixel / side) as i32], index);
                    seen[z.shuffled(dimension) as usize] = true;
                }
                assert!(seen.iter().all(|&s| s), "{side} {spp} {dimension}");
            }
        }
    }
}
