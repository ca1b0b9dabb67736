//! Randomisation of digit sequences: permutations of small ranges and Owen scrambling.

use crate::math::hash::mix_bits;

/// How a low-discrepancy sequence is randomised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Randomization {
    /// Not at all: every pixel and every pair of dimensions repeats the same points.
    None,
    /// One random permutation per digit (a random digital shift in base 2).
    PermuteDigits,
    /// Owen's nested uniform scrambling, approximated by hashing whole words (Laine & Karras 2011).
    #[default]
    FastOwen,
    /// Owen's nested uniform scrambling, digit by digit (Owen 1995).
    Owen,
}

impl Randomization {
    /// Randomises the 32 binary digits `v`, most significant digit first.
    pub(super) fn apply(self, v: u32, seed: u32) -> u32 {
        match self {
            Self::None => v,
            Self::PermuteDigits => v ^ seed,
            Self::FastOwen => nested_uniform(v.reverse_bits(), seed).reverse_bits(),
            Self::Owen => owen(v, seed),
        }
    }
}

/// Nested uniform scrambling of a bit-reversed word: bit k is flipped depending on the bits below it
/// (Laine & Karras 2011, with the constants of Vegdahl 2021).
pub(super) const fn nested_uniform(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Shuffles an index such that every aligned block of 2^k indices stays a block (Burley 2020, section 5):
/// each prefix of 2^k samples of the shuffled sequence is as well stratified as a prefix of the original.
pub(super) const fn shuffle_index(index: u32, seed: u32) -> u32 {
    nested_uniform(index.reverse_bits(), seed).reverse_bits()
}

fn owen(v: u32, seed: u32) -> u32 {
    let mut flips = 0;
    for bit in 0..32 {
        // The digits above this one choose its flip.
        let above = if bit == 0 { 0 } else { v >> (32 - bit) };
        let h = mix_bits(u64::from(seed) << 32 ^ u64::from(above) ^ (bit as u64) << 56);
        flips |= ((h >> 32) as u32 & 1) << (31 - bit);
    }
    v ^ flips
}

/// The image of `i` under a random permutation of 0..n; `i < n`. Cycle walking over a bijection of the
/// next power of two (Black & Rogaway 2002).
pub(super) fn permute(i: u32, n: u32, seed: u32) -> u32 {
    debug_assert!(i < n);
    if n <= 1 {
        return 0;
    }
    let mask = u32::MAX >> (n - 1).leading_zeros();
    let shift = (32 - mask.leading_zeros()).div_ceil(2);
    let mut x = i;
    loop {
        x = x.wrapping_add(seed) & mask;
        x ^= x >> shift;
        x = x.wrapping_mul(0x9e37_79b1 ^ (seed >> 7 & !1)) & mask;
        x ^= x >> shift;
        x ^= seed >> 15 & mask;
        x = x.wrapping_mul(0x85eb_ca6b ^ (seed.rotate_left(11) & !1)) & mask;
        x ^= x >> shift;
        x = x.wrapping_add(seed.rotate_left(19)) & mask;
        x = x.wrapping_mul(0xc2b2_ae35 ^ (seed.rotate_left(23) & !1)) & mask;
        x ^= x >> shift;
        if x < n {
            return x;
        }
    }
}

/// 32 binary digits as a number in [0, 1); truncation keeps each number in its elementary interval.
pub(super) const fn unit(v: u32) -> f32 {
    (v >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permute_is_a_bijection_and_nearly_uniform() {
        for n in [2, 3, 5, 7, 16, 24, 100, 257] {
            for s in 0..50u64 {
                let seed = mix_bits(s + 1) as u32;
                let mut seen = vec![false; n as usize];
                (0..n).for_each(|i| seen[permute(i, n, seed) as usize] = true);
                assert!(seen.iter().all(|&s| s), "{n} {seed}");
            }
        }
        // χ² of the image of each index over random seeds, 4 degrees of freedom: 99.99 % quantile 23.5,
        // split over five indices.
        for i in 0..5 {
            let mut counts = [0u32; 5];
            (0..10_000u64).for_each(|s| counts[permute(i, 5, mix_bits(s + 77) as u32) as usize] += 1);
            let chi2: f64 = counts.iter().map(|&c| (f64::from(c) - 2000.0).powi(2) / 2000.0).sum();
            assert!(chi2 < 26.0, "{i}: {counts:?}");
        }
    }

    #[test]
    fn owen_scrambling_is_nested_and_a_bijection_of_prefixes() {
        for r in [Randomization::FastOwen, Randomization::Owen, Randomization::PermuteDigits] {
            for seed in [1, 0xdead_beef, 0x1234_5678] {
                for bits in 1..10u32 {
                    let mut seen = vec![false; 1 << bits];
                    for prefix in 0..1u32 << bits {
                        let low = prefix << (32 - bits);
                        let image = r.apply(low, seed) >> (32 - bits);
                        // The digits below the prefix must not matter.
                        assert_eq!(
                            image,
                            r.apply(low | (u32::MAX >> bits), seed) >> (32 - bits),
                            "{r:?} {bits}"
                        );
                        seen[image as usize] = true;
                    }
                    assert!(seen.iter().all(|&s| s), "{r:?} {bits}");
                }
            }
        }
    }
}
