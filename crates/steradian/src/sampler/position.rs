//! Where in the sample space a sampler stands: the arguments of every sample.

use crate::math::hash::{combine, hash_words};

/// Pixel, sample index and dimension, with the hash that all dimensions of a pixel share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Position {
    pub(super) seed: u64,
    pub(super) index: u32,
    pub(super) dimension: u32,
    /// Hash of the pixel and the seed.
    pub(super) pixel_hash: u64,
}

impl Position {
    pub(super) fn new(seed: u64) -> Self {
        Self { seed, index: 0, dimension: 0, pixel_hash: hash_words(&[seed]) }
    }

    #[inline]
    pub(super) fn start(&mut self, pixel: [i32; 2], index: u32) {
        self.index = index;
        self.dimension = 0;
        self.pixel_hash = hash_words(&[self.seed, pack(pixel)]);
    }

    /// Consumes `n` dimensions and returns the first.
    pub(super) fn advance(&mut self, n: u32) -> u32 {
        let first = self.dimension;
        self.dimension += n;
        first
    }

    /// 64 random bits of the next dimension that all samples of the pixel share.
    pub(super) fn next_pixel_hash(&mut self, n: u32) -> u64 {
        let dimension = self.advance(n);
        combine(self.pixel_hash, u64::from(dimension))
    }

    /// 64 random bits of the next dimension, of this sample alone.
    #[inline]
    pub(super) fn next_sample_hash(&mut self, n: u32) -> u64 {
        let dimension = self.advance(n);
        combine(self.pixel_hash, u64::from(self.index) << 32 | u64::from(dimension))
    }
}

fn pack([x, y]: [i32; 2]) -> u64 {
    u64::from(x as u32) << 32 | u64::from(y as u32)
}
