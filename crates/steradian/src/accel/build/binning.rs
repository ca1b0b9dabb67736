//! Where to divide: the surface area heuristic over bins of centres, and over bins of sizes.

use super::reference::{Box4, Extent, Reference, packets};
use glam::{Mat4, Vec4};

/// Bins per axis, at most; a power of two, so that masked bits are a valid index.
const MAX_BINS: usize = 32;

/// References from which also a division into large and small is considered. Near the root of a scene of small things
/// in large surroundings (a table on a ground plane) no division by place is good.
const SIZED: usize = 4096;

/// Part of the whole's area below which nothing counts as large.
const LARGE: f32 = 1.0 / 64.0;

/// A number whose units are the last bits of its mantissa: adding it leaves the nearest integer in the low bits.
const ROUNDING: f32 = 8_388_608.0;

/// Spread of the centres along an axis, in parts of the largest, below which no division is looked for along it. Even two
/// parallel sheets are better divided across until they are less than three times as wide as they are apart.
const THIN: f32 = 0.25;

/// Whether a reference of this half area counts as large among the others.
#[inline(always)]
pub(super) fn is_large(half_area: f32, all: &Extent) -> bool {
    half_area >= LARGE * all.boxes.half_area()
}

/// By what the references are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    Center(usize),
    Size,
}

const KEYS: [Key; 4] = [Key::Center(0), Key::Center(1), Key::Center(2), Key::Size];

/// Index of the size among the keys.
const SIZE: usize = 3;

/// From a reference to its bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mapping {
    base: Vec4,
    /// Bins per unit; zero on an axis along which nothing can be told apart or need be.
    scale: Vec4,
    bins: usize,
    /// Bits of the half area of everything, if sizes are binned.
    largest: Option<u32>,
}

impl Mapping {
    #[inline(always)]
    pub(super) fn new(extent: &Extent, count: usize, largest: f32) -> Self {
        let bins = (8 + count / 8).min(MAX_BINS);
        let size = extent.centers.hi - extent.centers.lo;
        let scale = Vec4::splat((bins - 1) as f32) / size;
        let least = (THIN * size.x.max(size.y).max(size.z)).max(f32::MIN_POSITIVE);
        let usable = |axis: usize| {
            if size[axis] >= least && scale[axis].is_finite() { scale[axis] } else { 0.0 }
        };
        let largest =
            (count >= SIZED && is_large(largest, extent)).then(|| extent.boxes.half_area().to_bits());
        let scale = Vec4::new(usable(0), usable(1), usable(2), 0.0);
        Self { base: extent.centers.lo, scale, bins, largest }
    }

    /// The place of a centre along an axis, in bins, above the rounding.
    #[inline(always)]
    fn place(&self, axis: usize, r: &Reference) -> f32 {
        ((r.lo[axis] + r.hi[axis]) - self.base[axis]) * self.scale[axis] + ROUNDING
    }

    #[inline(always)]
    fn by_center(&self, axis: usize, r: &Reference) -> usize {
        self.place(axis, r).to_bits() as usize & (MAX_BINS - 1)
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
            (Key::Center(axis), _) => self.place(axis, r) >= s.threshold,
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
        let mut axes = (0..3).filter(|&axis| mapping.scale[axis] != 0.0);
        // Few axes are worth code of their own.
        match [axes.next(), axes.next(), axes.next()] {
            [Some(a), None, _] => self.add_along([a], references, step, mapping),
            [Some(a), Some(b), None] => self.add_along([a, b], references, step, mapping),
            _ => self.add_along([0, 1, 2], references, step, mapping),
        }
    }

    #[inline(always)]
    fn add_along<const N: usize>(
        &mut self,
        axes: [usize; N],
        references: &[Reference],
        step: usize,
        mapping: &Mapping,
    ) {
        for block in references.chunks(BLOCK * step) {
            // Neighbours tend to fall into the same bin, and one would have to wait for the other: they take turns with
            // others from far away.
            let (a, b) = block.split_at(block.len() / 2 / step * step);
            let (mut a, b) = (a.iter().step_by(step), b.iter().step_by(step));
            for r in b {
                self.count_center(axes, r, mapping);
                if let Some(r) = a.next() {
                    self.count_center(axes, r, mapping);
                }
            }
            if let Some(largest) = mapping.largest {
                for r in block.iter().step_by(step) {
                    self.count(SIZE, Mapping::by_size(largest, r), r, r.weight());
                }
            }
        }
    }

    #[inline(always)]
    fn count_center<const N: usize>(&mut self, axes: [usize; N], r: &Reference, mapping: &Mapping) {
        // Copied, so that it need not be read again after each writing to a bin.
        let (r, weight) = (*r, r.weight());
        for axis in axes {
            self.count(axis, mapping.by_center(axis, &r), &r, weight);
        }
    }

    #[inline(always)]
    fn count(&mut self, key: usize, bin: usize, r: &Reference, weight: u32) {
        self.boxes[bin][key] = self.boxes[bin][key].union(r.as_box());
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

    /// A bound on the half areas of the references in these bins; `None` where sizes were not binned.
    pub(super) fn largest(&self, mapping: &Mapping) -> Option<f32> {
        let bin = (0..mapping.bins).find(|&bin| self.weights[bin][SIZE] > 0)?;
        mapping.largest.map(|all| f32::from_bits(all.saturating_sub((bin as u32) << 22)))
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
        for (bin, &behind) in behind.iter().enumerate().take(mapping.bins).skip(1) {
            sweep.add(self, bin - 1);
            let costs = sweep.costs() + behind;
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
