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
    /// Base-4 digits of an index into the whole picture.
    digits: u32,
    /// Place of the current sample in the whole picture, before shuffling.
    morton: u64,
    /// Per base-4 digit, a hash of the digits above it: shared by all dimensions of a sample.
    above: [u32; MAX_DIGITS],
}

/// Base-4 digits of the largest index: 2^20 pixels a side and 2^24 samples per pixel.
const MAX_DIGITS: usize = 32;

impl ZSobol {
    pub(super) fn new(at: Position, randomization: Randomization, spp: u32, resolution: [u32; 2]) -> Self {
        let log2_spp = spp.clamp(1, 1 << 24).next_power_of_two().trailing_zeros();
        let side = resolution[0].max(resolution[1]).clamp(1, 1 << 20).next_power_of_two();
        let digits = side.trailing_zeros() + log2_spp.div_ceil(2);
        Self { at, randomization, log2_spp, digits, morton: 0, above: [0; MAX_DIGITS] }
    }

    pub(super) fn start(&mut self, pixel: [i32; 2], index: u32) {
        self.at.start(pixel, index);
        let z = interleave(pixel[0] as u32) | interleave(pixel[1] as u32) << 1;
        let wrapped = u64::from(index) & ((1 << self.log2_spp) - 1);
        self.morton = (z << self.log2_spp) | wrapped;
        // Indices beyond the announced count visit the same block in another order.
        let round = u64::from(index) >> self.log2_spp;
        let salt = self.at.seed.rotate_left(17) ^ round << 40;
        let odd = self.log2_spp & 1;
        for (k, above) in (0u32..).zip(&mut self.above[..self.digits as usize]) {
            *above = (mix_bits((self.morton >> (2 * k + 2 - odd)) ^ salt ^ u64::from(k) << 58) >> 32) as u32;
        }
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
    fn shuffled(&self, dimension: u32) -> u64 {
        // With an odd exponent the last digit is a binary one, below the base-4 digits.
        let odd = self.log2_spp & 1;
        // Multiply-shift hashing (Dietzfelbinger 1996), the cheapest that is pairwise independent: one random line
        // per dimension over the hashed digits above.
        let slope = mix_bits((u64::from(dimension) + 1).wrapping_mul(0xd1b5_4a32_d192_ed03));
        let offset = mix_bits(slope);
        let mut index = 0;
        for (k, &above) in (0u32..).zip(&self.above[..self.digits as usize]) {
            let h = (slope.wrapping_mul(u64::from(above)).wrapping_add(offset) >> 32) as u32;
            if k == 0 && odd == 1 {
                index = (self.morton & 1) ^ u64::from(h >> 31);
                continue;
            }
            let shift = 2 * k - odd;
            let digit = self.morton >> shift & 3;
            // Lemire's multiply-shift instead of a remainder.
            let p = (u64::from(h) * 24) >> 32;
            index |= u64::from(PERMUTATIONS[p as usize] >> (2 * digit) & 3) << shift;
        }
        index
    }
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

/// The 24 permutations of four digits, two bits per image.
static PERMUTATIONS: [u8; 24] = permutations();

const fn permutations() -> [u8; 24] {
    let mut table = [0; 24];
    let mut rank = 0;
    while rank < 24 {
        // Lehmer code: which of the digits still left comes next.
        let code = [rank / 6, rank / 2 % 3, rank % 2, 0];
        let mut left = [0u8, 1, 2, 3];
        let mut i = 0;
        while i < 4 {
            let pick = code[i];
            table[rank] |= left[pick] << (2 * i);
            let mut j = pick;
            while j + 1 < 4 {
                left[j] = left[j + 1];
                j += 1;
            }
            i += 1;
        }
        rank += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_holds_every_permutation_once() {
        let mut seen: Vec<u8> = PERMUTATIONS.to_vec();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 24);
        for p in PERMUTATIONS {
            assert_eq!((0..4).fold(0u8, |m, i| m | 1 << (p >> (2 * i) & 3)), 0b1111);
        }
    }

    #[test]
    fn shuffling_is_a_bijection_of_the_picture() {
        for spp in [1, 2, 4, 8] {
            let mut z = ZSobol::new(Position::new(3), Randomization::FastOwen, spp, [8, 8]);
            for dimension in [0, 1, 5] {
                let mut seen = vec![false; 64 * spp as usize];
                for i in 0..64 * spp {
                    let (pixel, index) = (i / spp, i % spp);
                    z.start([(pixel % 8) as i32, (pixel / 8) as i32], index);
                    seen[z.shuffled(dimension) as usize] = true;
                }
                assert!(seen.iter().all(|&s| s), "{spp} {dimension}");
            }
        }
    }
}
