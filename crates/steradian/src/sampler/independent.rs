//! Uniform, independent numbers.

use super::position::Position;
use crate::math::Vec2;
use crate::math::hash::{combine, mix_bits, to_unit};

/// One stream of SplitMix64 (Steele, Lea & Flood 2014) per sample, begun at a hash of pixel, index and seed.
#[derive(Clone, Copy, Debug)]
pub struct Independent {
    at: Position,
    state: u64,
}

/// What the stream's counter advances by: 2⁶⁴ over the golden ratio, odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

impl Independent {
    pub(super) fn new(at: Position) -> Self {
        Self { at, state: at.pixel_hash }
    }

    #[inline]
    pub(super) fn start(&mut self, pixel: [i32; 2], index: u32) {
        self.at.start(pixel, index);
        self.state = combine(self.at.pixel_hash, u64::from(index));
    }

    /// The next 64 random bits.
    #[inline]
    pub(super) fn next_word(&mut self) -> u64 {
        self.state = self.state.wrapping_add(STEP);
        mix_bits(self.state)
    }

    #[inline]
    pub(super) fn next_1d(&mut self) -> f32 {
        to_unit(self.next_word())
    }

    #[inline]
    pub(super) fn next_2d(&mut self) -> Vec2 {
        let word = self.next_word();
        Vec2::new(to_unit(word), to_unit(word << 32))
    }
}
