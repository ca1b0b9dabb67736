//! Padded Sobol' points: every pair of dimensions is an independently shuffled and scrambled (0, 2)-sequence.

use super::position::Position;
use super::scramble::{Randomization, shuffle_index, unit};
use super::sobol;
use crate::math::Vec2;
use crate::math::hash::mix_bits;

/// Padding after Burley (2020): the order of the points is shuffled by nested uniform scrambling of the
/// index, not by an arbitrary permutation, so any prefix of 2^k samples of a pixel is a (0, k, 2)-net in each pair
/// of dimensions, and the sample count need not be known.
#[derive(Clone, Copy, Debug)]
pub struct PaddedSobol {
    pub(super) at: Position,
    pub(super) randomization: Randomization,
}

impl PaddedSobol {
    pub(super) fn next_1d(&mut self) -> f32 {
        let h = self.at.next_pixel_hash(1);
        let index = self.shuffled(h);
        unit(self.randomization.apply(sobol::dimension_0(index), (h >> 32) as u32))
    }

    pub(super) fn next_2d(&mut self) -> Vec2 {
        let h = self.at.next_pixel_hash(2);
        let index = self.shuffled(h);
        let h2 = mix_bits(h);
        Vec2::new(
            unit(self.randomization.apply(sobol::dimension_0(index), h2 as u32)),
            unit(self.randomization.apply(sobol::dimension_1(index), (h2 >> 32) as u32)),
        )
    }

    fn shuffled(&self, h: u64) -> u64 {
        u64::from(shuffle_index(self.at.index, h as u32))
    }
}
