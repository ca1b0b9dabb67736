//! Jittered strata: one sample in each cell of a grid, in random order per dimension.

use super::position::Position;
use super::scramble::permute;
use crate::math::Vec2;
use crate::math::float::ONE_MINUS_EPSILON;
use crate::math::hash::{combine, mix_bits, to_unit};

/// A grid of `x` × `y` strata per pair of dimensions, and x·y strata in each single one.
#[derive(Clone, Copy, Debug)]
pub struct Stratified {
    pub(super) at: Position,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) jitter: bool,
}

impl Stratified {
    pub(super) fn next_1d(&mut self) -> f32 {
        let h = self.at.next_pixel_hash(1);
        let stratum = self.stratum(h);
        let n = self.x * self.y;
        let inside = if self.jitter { to_unit(self.jitter_bits(h)) } else { 0.5 };
        ((stratum as f32 + inside) / n as f32).min(ONE_MINUS_EPSILON)
    }

    pub(super) fn next_2d(&mut self) -> Vec2 {
        let h = self.at.next_pixel_hash(2);
        let stratum = self.stratum(h);
        let inside = if self.jitter {
            let bits = self.jitter_bits(h);
            Vec2::new(to_unit(bits), to_unit(bits << 32))
        } else {
            Vec2::splat(0.5)
        };
        let cell = Vec2::new((stratum % self.x) as f32, (stratum / self.x) as f32);
        ((cell + inside) / Vec2::new(self.x as f32, self.y as f32)).min(Vec2::splat(ONE_MINUS_EPSILON))
    }

    /// Cell of the current sample; indices beyond the grid start another round in a new order.
    fn stratum(&self, h: u64) -> u32 {
        let n = self.x * self.y;
        let round = self.at.index / n;
        permute(self.at.index % n, n, mix_bits(h ^ u64::from(round) << 32) as u32)
    }

    fn jitter_bits(&self, h: u64) -> u64 {
        combine(h, u64::from(self.at.index))
    }
}
