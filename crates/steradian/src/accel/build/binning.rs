//! Where to divide: the surface area heuristic over bins of centres, and over bins of sizes.

use super::reference::{Box4, Extent, Reference, packets};
use glam::{Mat4, Vec4};

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
        match (s.key, self.largest) {
            // Numbers from the rounding one on are ordered as the bins are.
            (Key::Center(axis), _) => {
                ((r.lo[axis] + r.hi[axis]) - self.base[axis]) * self.scale[axis] + ROUNDING >= s.threshold
            }
            (Key::Size, Some(largest)) => Self::by_size(largest, r) >= s.bin,
            (Key::Size, None) => false,
        }
    }
}

/// A way to divide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Division {
    key: Key,
    /// First bin of the second half.
    bin: usize,
    /// The same in the numbers of the mapping by centre.
    threshold: f32,
}

/// What each bin weighs, and how far it reaches. Smallest, largest and sum do not depend on the order of adding, so that
/// any division of the work gives the same bins. The keys lie side by side, so that all are searched at once.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    boxes: [[Box4; KEYS.len()]; MAX_BINS],
    weights: [[u32; KEYS.len()]; MAX_BINS],
}

/// References that stay in the nearest cache between binning by centre and by size.
const BLOCK: usize = 512;

/// The bins up to one, or from one on, for every key.
#[derive(Clone, Copy)]
struct Sweep {
    reaches: [Box4; KEYS.len()],
    weights: [u32; KEYS.len()],
}

impl Sweep {
    const EMPTY: Self = Self { reaches: [Box4::EMPTY; KEYS.len()], weights: [0; KEYS.len()] };

    #[inline(always)]
    fn add(&mut self, bins: &Bins, bin: usize) {
        for key in 0..KEYS.len() {
            self.reaches[key] = self.reaches[key].union(bins.boxes[bin][key]);
            self.weights[key] += bins.weights[bin][key];
        }
    }

    /// Half areas times packets; NaN where there is nothing.
    #[inline(always)]
    fn costs(&self) -> Vec4 {
        let size = self.reaches.map(|b| b.hi - b.lo);
        let Mat4 { x_axis: x, y_axis: y, z_axis: z, .. } =
            Mat4::from_cols(size[0], size[1], size[2], size[3]).transpose();
        // Fewer than 2³¹, so that the conversion is a single instruction.
        let packets = self.weights.map(|w| packets(w) as i32 as f32);
        (x * (y + z) + y * z) * Vec4::from_array(packets)
    }
}

impl Bins {
    pub(super) fn new() -> Self {
        Self { boxes: [[Box4::EMPTY; KEYS.len()]; MAX_BINS], weights: [[0; KEYS.len()]; MAX_BINS] }
    }

    /// Empties the bins that `mapping` uses.
    #[inline(always)]
    pub(super) fn clear(&mut self, mapping: &Mapping) {
        self.boxes[..mapping.bins].fill([Box4::EMPTY; KEYS.len()]);
        self.weights[..mapping.bins].fill([0; KEYS.len()]);
    }

    /// Adds every `step`-th reference.
    #[inline(always)]
    pub(super) fn add(&mut self, references: &[Reference], step: usize, mapping: &Mapping) {
        for block in references.chunks(BLOCK * step) {
            // Copied, so that they need not be read again after each writing to a bin.
            for r in block.iter().step_by(step).copied() {
                let (reach, weight) = (r.as_box(), r.weight());
                for (axis, bin) in mapping.by_center(&r).into_iter().enumerate() {
                    self.count(axis, bin, reach, weight);
                }
            }
            if let Some(largest) = mapping.largest {
                for r in block.iter().step_by(step) {
                    self.count(3, Mapping::by_size(largest, r), r.as_box(), r.weight());
                }
            }
        }
    }

    #[inline(always)]
    fn count(&mut self, key: usize, bin: usize, reach: Box4, weight: u32) {
        self.boxes[bin][key] = self.boxes[bin][key].union(reach);
        self.weights[bin][key] += weight;
    }

    pub(super) fn merge(&mut self, other: &Self) {
        for (a, b) in self.boxes.as_flattened_mut().iter_mut().zip(other.boxes.as_flattened()) {
            *a = a.union(*b);
        }
        for (a, b) in self.weights.as_flattened_mut().iter_mut().zip(other.weights.as_flattened()) {
            *a += b;
        }
    }

    /// The cheapest division; `None` where nothing can be told apart or no cost is finite.
    #[inline(always)]
    pub(super) fn cheapest(&self, mapping: &Mapping) -> Option<Division> {
        let mut behind = [Vec4::ZERO; MAX_BINS];
        let mut sweep = Sweep::EMPTY;
        for bin in (1..mapping.bins).rev() {
            sweep.add(self, bin);
            behind[bin] = sweep.costs();
        }
        let (mut least, mut at) = (Vec4::INFINITY, Vec4::ZERO);
        sweep = Sweep::EMPTY;
        for bin in 1..mapping.bins {
            sweep.add(self, bin - 1);
            let costs = sweep.costs() + behind[bin];
            // Nothing on one side costs NaN, which is not less than anything.
            let is_less = costs.cmplt(least);
            least = Vec4::select(is_less, costs, least);
            at = Vec4::select(is_less, Vec4::splat(bin as f32), at);
        }
        let mut best = None;
        let mut cost = f32::INFINITY;
        for (i, key) in KEYS.into_iter().enumerate() {
            if least[i] < cost {
                cost = least[i];
                best = Some(Division { key, bin: at[i] as usize, threshold: ROUNDING + at[i] });
            }
        }
        best
    }
}
