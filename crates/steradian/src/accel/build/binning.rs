//! Where to divide: the surface area heuristic over bins of centres, and over bins of sizes.

use super::reference::{Box4, Extent, Reference, Tally};
use glam::Vec4;

/// Bins per axis, at most; a power of two, so that masked bits are a valid index.
const MAX_BINS: usize = 32;

/// References from which also a division into large and small is considered. Near the root of a scene of small things
/// in large surroundings (a table on a ground plane) no division by place is good.
const SIZED: usize = 4096;

/// A number whose units are the last bits of its mantissa: adding it leaves the nearest integer in the low bits.
const ROUNDING: f32 = 8_388_608.0;

/// By what the references are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    Center(usize),
    Size,
}

const KEYS: [Key; 4] = [Key::Center(0), Key::Center(1), Key::Center(2), Key::Size];

/// From a reference to its bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mapping {
    base: Vec4,
    /// Bins per unit; zero on an axis along which nothing can be told apart.
    scale: Vec4,
    bins: usize,
    /// Bits of the half area of everything, if sizes are binned.
    largest: Option<u32>,
}

impl Mapping {
    #[inline(always)]
    pub(super) fn new(extent: &Extent, count: usize) -> Self {
        let bins = (8 + count / 8).min(MAX_BINS);
        let size = extent.centers.hi - extent.centers.lo;
        let scale = Vec4::splat((bins - 1) as f32) / size;
        let usable = |axis: usize| {
            if size[axis] > 0.0 && scale[axis].is_finite() { scale[axis] } else { 0.0 }
        };
        let largest = (count >= SIZED).then(|| extent.boxes.half_area().to_bits());
        Self {
            base: extent.centers.lo,
            scale: Vec4::new(usable(0), usable(1), usable(2), 0.0),
            bins,
            largest,
        }
    }

    #[inline(always)]
    fn by_center(&self, r: &Reference) -> [usize; 3] {
        let at = ((r.center() - self.base) * self.scale + Vec4::splat(ROUNDING)).to_array();
        [0, 1, 2].map(|axis| at[axis].to_bits() as usize & (MAX_BINS - 1))
    }

    /// Half octaves of area below the whole's: differences of the bits of floats are differences of their logarithms.
    #[inline(always)]
    fn by_size(largest: u32, r: &Reference) -> usize {
        let smaller = largest.saturating_sub(r.as_box().half_area().to_bits());
        (smaller >> 22).min(MAX_BINS as u32 - 1) as usize
    }

    /// Whether a reference lies behind a division: exactly as the bins have counted it.
    #[inline(always)]
    pub(super) fn is_behind(&self, r: &Reference, s: &Division) -> bool {
        let bin = match (s.key, self.largest) {
            (Key::Center(axis), _) => {
                let at = ((r.lo[axis] + r.hi[axis]) - self.base[axis]) * self.scale[axis] + ROUNDING;
                at.to_bits() as usize & (MAX_BINS - 1)
            }
            (Key::Size, Some(largest)) => Self::by_size(largest, r),
            (Key::Size, None) => 0,
        };
        bin >= s.bin
    }
}

/// A way to divide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Division {
    key: Key,
    /// First bin of the second half.
    bin: usize,
}

/// How many references there are in each bin, and how far they reach. Smallest, largest and sum do not depend on the
/// order of adding, so that any division of the work gives the same bins.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    boxes: [[Box4; MAX_BINS]; KEYS.len()],
    tallies: [[Tally; MAX_BINS]; KEYS.len()],
}

/// References that stay in the nearest cache between binning by centre and by size.
const BLOCK: usize = 512;

#[inline(always)]
fn cost(reach: Box4, tally: Tally) -> f32 {
    reach.half_area() * tally.packets() as f32
}

impl Bins {
    pub(super) fn new() -> Self {
        Self { boxes: [[Box4::EMPTY; MAX_BINS]; KEYS.len()], tallies: [[Tally::ZERO; MAX_BINS]; KEYS.len()] }
    }

    /// Empties the bins that `mapping` uses.
    #[inline(always)]
    pub(super) fn clear(&mut self, mapping: &Mapping) {
        for axis in 0..3 {
            self.boxes[axis][..mapping.bins].fill(Box4::EMPTY);
            self.tallies[axis][..mapping.bins].fill(Tally::ZERO);
        }
        if mapping.largest.is_some() {
            self.boxes[3].fill(Box4::EMPTY);
            self.tallies[3].fill(Tally::ZERO);
        }
    }

    /// Adds every `step`-th reference.
    #[inline(always)]
    pub(super) fn add(&mut self, references: &[Reference], step: usize, mapping: &Mapping) {
        for block in references.chunks(BLOCK * step) {
            for r in block.iter().step_by(step) {
                for (axis, bin) in mapping.by_center(r).into_iter().enumerate() {
                    self.count(axis, bin, r);
                }
            }
            if let Some(largest) = mapping.largest {
                block.iter().step_by(step).for_each(|r| self.count(3, Mapping::by_size(largest, r), r));
            }
        }
    }

    #[inline(always)]
    fn count(&mut self, key: usize, bin: usize, r: &Reference) {
        self.boxes[key][bin] = self.boxes[key][bin].union(r.as_box());
        self.tallies[key][bin].add(r.tally());
    }

    pub(super) fn merge(&mut self, other: &Self) {
        for (a, b) in self.boxes.as_flattened_mut().iter_mut().zip(other.boxes.as_flattened()) {
            *a = a.union(*b);
        }
        for (a, b) in self.tallies.as_flattened_mut().iter_mut().zip(other.tallies.as_flattened()) {
            a.add(*b);
        }
    }

    /// The cheapest division; `None` where nothing can be told apart or no cost is finite.
    #[inline(always)]
    pub(super) fn cheapest(&self, mapping: &Mapping) -> Option<Division> {
        let mut best = None;
        let mut least = f32::INFINITY;
        for (i, key) in KEYS.into_iter().enumerate() {
            let count = match key {
                Key::Center(axis) if mapping.scale[axis] != 0.0 => mapping.bins,
                Key::Size if mapping.largest.is_some() => MAX_BINS,
                _ => continue,
            };
            let (boxes, tallies) = (&self.boxes[i][..count], &self.tallies[i][..count]);
            let mut behind = [f32::INFINITY; MAX_BINS];
            let (mut reach, mut tally) = (Box4::EMPTY, Tally::ZERO);
            for bin in (1..count).rev() {
                reach = reach.union(boxes[bin]);
                tally.add(tallies[bin]);
                if tally != Tally::ZERO {
                    behind[bin] = cost(reach, tally);
                }
            }
            let (mut reach, mut tally) = (Box4::EMPTY, Tally::ZERO);
            for bin in 1..count {
                reach = reach.union(boxes[bin - 1]);
                tally.add(tallies[bin - 1]);
                let cost = cost(reach, tally) + behind[bin];
                if cost < least && tally != Tally::ZERO {
                    least = cost;
                    best = Some(Division { key, bin });
                }
            }
        }
        best
    }
}
