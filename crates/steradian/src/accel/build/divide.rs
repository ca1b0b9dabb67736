//! From references to a binary tree, from the top down: whole at first, by all threads, then branch by branch.
//!
//! All partitions are stable and all sums independent of their order, so that the tree is the same for any number of
//! threads.

use super::binning::{Bins, Division, Mapping};
use super::branch::{Branch, Grower};
use super::reference::{Extent, Reference, Tally};
use crate::accel::tree::{LANES, MAX_DEPTH};
use rayon::prelude::*;

/// References that are divided by several threads together; below, each part is the work of one.
pub(super) const SHARED: usize = 1 << 17;

/// References that one thread handles at a time in a shared division.
const SLICE: usize = 1 << 14;

/// A part of the references, about to be divided.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// They lie here for the moment.
    pub(super) references: &'a mut [Reference],
    /// As much room for another order of them.
    spare: &'a mut [Reference],
    /// Whether `spare` and not `references` is their place in the end.
    displaced: bool,
    /// Position of the first in the whole.
    pub(super) first: u32,
    pub(super) extent: Extent,
    pub(super) tally: Tally,
    /// Ancestors in the binary tree.
    depth: u32,
}

/// The binary tree: forks down to the branches.
#[derive(Debug)]
pub(super) enum Limb {
    Fork(Box<(Extent, Limb, Limb)>),
    Branch(Branch),
}

/// Divides `references`, which end up in the order of the leaves; `spare` is room for as many. Branches have at most
/// `grain` references.
pub(super) fn divide(references: &mut [Reference], spare: &mut [Reference], grain: usize) -> Limb {
    let extent = references.par_chunks(SLICE).map(Extent::of).reduce(|| Extent::EMPTY, Extent::union);
    let tally = references.par_chunks(SLICE).map(Tally::of).reduce(
        || Tally::ZERO,
        |mut a, b| {
            a.add(b);
            a
        },
    );
    let part = Part { references, spare, displaced: false, first: 0, extent, tally, depth: 0 };
    limb(part, grain, &mut Bins::new())
}

fn limb(mut part: Part<'_>, grain: usize, bins: &mut Bins) -> Limb {
    let count = part.references.len();
    if count <= grain || part.is_leaf() {
        part.settle();
        return Limb::Branch(Grower::grow(part, bins));
    }
    let extent = part.extent;
    let (a, b) = if count > SHARED { part.split_by_all() } else { part.split(bins) };
    // A number of tasks that grows with the work alone; rayon spreads them.
    let (a, b) = rayon::join(|| limb(a, grain, &mut Bins::new()), || limb(b, grain, &mut Bins::new()));
    Limb::Fork(Box::new((extent, a, b)))
}

impl<'a> Part<'a> {
    /// Whether one packet, or the only item of a leaf, holds all.
    #[inline(always)]
    pub(super) fn is_leaf(&self) -> bool {
        self.tally.weight() <= LANES as u32
    }

    /// Moves the references to their place.
    fn settle(&mut self) {
        if std::mem::take(&mut self.displaced) {
            self.spare.copy_from_slice(self.references);
            std::mem::swap(&mut self.references, &mut self.spare);
        }
    }

    /// Whether a lopsided division leaves enough depth to halve the larger part down to single references.
    #[inline(always)]
    fn may_be_lopsided(&self) -> bool {
        let levels = usize::BITS - (self.references.len() - 1).leading_zeros();
        self.depth + 1 + levels <= MAX_DEPTH
    }

    /// Two parts, found by one thread.
    #[inline(always)]
    pub(super) fn split(self, bins: &mut Bins) -> (Self, Self) {
        let mapping = Mapping::new(&self.extent, self.references.len());
        bins.clear(&mapping);
        bins.add(self.references, &mapping);
        match bins.cheapest(&mapping).filter(|_| self.may_be_lopsided()) {
            Some(s) => self.split_at_division(&mapping, &s),
            None => self.halve(),
        }
    }

    #[inline(always)]
    fn split_at_division(self, mapping: &Mapping, s: &Division) -> (Self, Self) {
        let n = self.references.len();
        let middle = s.before.count();
        let (source, target) = (&mut *self.references, &mut self.spare[..n]);
        if self.displaced {
            let mut next = [0, middle];
            for r in source.iter() {
                let to = &mut next[usize::from(mapping.is_behind(r, s))];
                target[*to] = *r;
                *to += 1;
            }
        } else {
            // Both places are written and one cursor moves: the outcome of the test is as good as random, and a
            // branch on it would cost more.
            let (mut before, mut behind) = (0, 0);
            for i in 0..n {
                let r = source[i];
                let is_behind = usize::from(mapping.is_behind(&r, s));
                source[before] = r;
                target[behind] = r;
                before += 1 - is_behind;
                behind += is_behind;
            }
            source[middle..].copy_from_slice(&target[..n - middle]);
        }
        let displaced = self.displaced;
        let this = if displaced { self.moved() } else { self };
        this.cut(middle, s.before)
    }

    /// Two halves of equal number along the axis on which the centres spread most: whatever the references, this ends
    /// after ⌈log₂ n⌉ levels.
    #[cold]
    fn halve(self) -> (Self, Self) {
        let middle = self.references.len() / 2;
        // Halved before adding, so that the centre of a box of any size is finite.
        let center = |r: &Reference| r.lo * 0.5 + r.hi * 0.5;
        let mut centers = Extent::EMPTY.centers;
        for r in self.references.iter() {
            (centers.lo, centers.hi) = (centers.lo.min(center(r)), centers.hi.max(center(r)));
        }
        let spread = centers.hi * 0.5 - centers.lo * 0.5;
        let axis = (0..3).max_by(|&a, &b| spread[a].total_cmp(&spread[b])).unwrap_or(0);
        if spread[axis] > 0.0 {
            let number = |r: &Reference| (r.lo.w.to_bits(), r.hi.w.to_bits());
            self.references.select_nth_unstable_by(middle, |a, b| {
                center(a)[axis].total_cmp(&center(b)[axis]).then(number(a).cmp(&number(b)))
            });
        }
        let before = Tally::of(&self.references[..middle]);
        self.cut(middle, before)
    }

    /// Two parts, found by all threads.
    fn split_by_all(self) -> (Self, Self) {
        let mapping = Mapping::new(&self.extent, self.references.len());
        let slices: Vec<Bins> = self
            .references
            .par_chunks(SLICE)
            .map(|slice| {
                let mut bins = Bins::new();
                bins.add(slice, &mapping);
                bins
            })
            .collect();
        let mut all = Bins::new();
        slices.iter().for_each(|b| all.merge(b));
        let Some(s) = all.cheapest(&mapping).filter(|_| self.may_be_lopsided()) else { return self.halve() };
        let middle = s.before.count();
        let (mut before, mut behind) = self.spare.split_at_mut(middle);
        let mut jobs = Vec::with_capacity(slices.len());
        for (slice, bins) in self.references.chunks(SLICE).zip(&slices) {
            let count = bins.before(&s).count();
            let (a, b);
            (a, before) = before.split_at_mut(count);
            (b, behind) = behind.split_at_mut(slice.len() - count);
            jobs.push((slice, a, b));
        }
        jobs.into_par_iter().for_each(|(slice, a, b)| {
            let mut places = [a.iter_mut(), b.iter_mut()];
            for r in slice {
                // The bins have counted as many, so there always is a place.
                if let Some(place) = places[usize::from(mapping.is_behind(r, &s))].next() {
                    *place = *r;
                }
            }
        });
        self.moved().cut(middle, s.before)
    }

    /// The same after the references were written to the spare room.
    fn moved(self) -> Self {
        let Self { references, spare, displaced, .. } = self;
        Self { references: spare, spare: references, displaced: !displaced, ..self }
    }

    #[inline(always)]
    fn cut(self, middle: usize, before: Tally) -> (Self, Self) {
        let (a, b) = self.references.split_at_mut(middle);
        let (spare_a, spare_b) = self.spare.split_at_mut(middle);
        let (extent_a, extent_b) = if a.len() + b.len() > SHARED {
            let of =
                |s: &[Reference]| s.par_chunks(SLICE).map(Extent::of).reduce(|| Extent::EMPTY, Extent::union);
            (of(a), of(b))
        } else {
            (Extent::of(a), Extent::of(b))
        };
        let (displaced, depth) = (self.displaced, self.depth + 1);
        let part = |references: &'a mut [Reference], spare, first, extent, tally| Part {
            references,
            spare,
            displaced,
            first,
            extent,
            tally,
            depth,
        };
        (
            part(a, spare_a, self.first, extent_a, before),
            part(b, spare_b, self.first + middle as u32, extent_b, self.tally.minus(before)),
        )
    }
}
