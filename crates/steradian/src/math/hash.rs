//! Stateless hashing and a small counter-free generator: randomness as a function of its arguments.

/// Mixes all bits of a 64-bit word (the finaliser of MurmurHash3; Stafford's variant 13).
#[inline]
pub const fn mix_bits(mut v: u64) -> u64 {
    v ^= v >> 30;
    v = v.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    v ^= v >> 27;
    v = v.wrapping_mul(0x94d0_49bb_1331_11eb);
    v ^ (v >> 31)
}

/// Folds one more word into a running hash.
#[inline]
pub const fn combine(h: u64, v: u64) -> u64 {
    mix_bits(h.rotate_left(26) ^ v.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

/// Hash of a sequence of words.
pub fn hash_words(words: &[u64]) -> u64 {
    words.iter().fold(0x243f_6a88_85a3_08d3, |h, &w| combine(h, w))
}

/// Hash of a sequence of floats by their bits.
pub fn hash_floats(floats: &[f32]) -> u64 {
    floats.iter().fold(0x1319_8a2e_0370_7344, |h, f| combine(h, u64::from(f.to_bits())))
}

/// The top 24 bits of a word as a uniform f32 in [0, 1).
#[inline]
pub const fn to_unit(v: u64) -> f32 {
    (v >> 40) as f32 * (1.0 / 16_777_216.0)
}

/// PCG32 (O'Neill 2014, XSH-RR 64/32): for random walks that need an unbounded stream from one seed.
#[derive(Clone, Copy, Debug)]
pub struct Pcg32 {
    state: u64,
    increment: u64,
}

impl Pcg32 {
    /// A generator whose stream is a function of `seed` and `stream` alone.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut rng = Self { state: 0, increment: (stream << 1) | 1 };
        rng.next_u32();
        rng.state = rng.state.wrapping_add(seed);
        rng.next_u32();
        rng
    }

    /// The next 32 uniform bits.
    pub fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(self.increment);
        let xorshifted = (((old >> 18) ^ old) >> 27) as u32;
        xorshifted.rotate_right((old >> 59) as u32)
    }

    /// The next uniform f32 in [0, 1).
    pub fn next_f32(&mut self) -> f32 {
        (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pcg32_matches_the_published_demo_stream() {
        // O'Neill's pcg32-demo, seed 42, stream 54.
        let mut rng = Pcg32::new(42, 54);
        let first: Vec<u32> = (0..6).map(|_| rng.next_u32()).collect();
        assert_eq!(first, [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e]);
    }

    #[test]
    fn unit_floats_stay_below_one() {
        assert!(to_unit(u64::MAX) < 1.0);
        assert_eq!(to_unit(0), 0.0);
    }
}
