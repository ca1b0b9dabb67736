//! A part of the references, and its division into two.
//!
//! All partitions are stable and all sums independent of their order, so that the parts are the same for any number of
//! threads.

use super::binning::{Bins, Division, Mapping, is_large};
use super::reference::{Box4, Extent, Reference};
use crate::accel::bunch::STRANDS;
use crate::accel::tree::{LANES, MAX_DEPTH};
use rayon::prelude::*;

/// References that one thread handles at a time in a division by all.
const SLICE: usize = 1 << 14;

/// References that are enough to find a good division where all are small. A quarter of it is too few near the root.
const SAMPLE: usize = 1 << 14;

/// The same where a few large ones should not be missed.
const LARGE_SAMPLE: usize = 1 << 17;

/// Part of the area of a leaf below which its halves are leaves of their own.
const GAIN: f32 = 0.8;

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
    /// Ancestors in the binary tree.
    pub(super) depth: u32,
    /// No reference has a larger half area.
    largest: f32,
}

impl<'a> Part<'a> {
    /// All of `references`; `spare` is room for as many.
    pub(super) fn whole(references: &'a mut [Reference], spare: &'a mut [Reference]) -> Self {
        let extent = references.par_chunks(SLICE).map(Extent::of).reduce(|| Extent::EMPTY, Extent::union);
        let area = |slice: &[Reference]| slice.iter().map(|r| r.as_box().half_area()).fold(0.0, f32::max);
        let largest = references.par_chunks(SLICE).map(area).reduce(|| 0.0, f32::max);
        Self { references, spare, displaced: false, first: 0, extent, depth: 0, largest }
    }

    /// Whether one packet, one bunch of curves, or the only item of a leaf holds all.
    #[inline(always)]
    pub(super) fn is_leaf(&self) -> bool {
        self.extent.weight <= LANES as u32
            || (self.references.len() <= STRANDS && self.references.iter().all(Reference::is_strand))
    }

    /// Whether rays would meet clearly less of its halves than of a leaf that holds all: packets are tested as a whole,
    /// and two walls in one are tested by every ray in the room.
    pub(super) fn gains_by_division(&self, bins: &mut Bins) -> bool {
        let mapping = Mapping::new(&self.extent, self.references.len(), self.largest);
        bins.clear(&mapping);
        bins.add(self.references, 1, &mapping);
        let Some(s) = bins.cheapest(&mapping) else { return false };
        let area = |behind: bool| {
            let half = self.references.iter().filter(|r| mapping.is_behind(r, &s) == behind);
            half.fold(Box4::EMPTY, |reach, r| reach.union(r.as_box())).half_area()
        };
        area(false) + area(true) < GAIN * self.extent.boxes.half_area()
    }

    /// Moves the references to their place.
    pub(super) fn settle(&mut self) {
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

    /// Of how many references one is enough to find a division.
    #[inline(always)]
    fn step(&self) -> usize {
        let sample = if is_large(self.largest, &self.extent) { LARGE_SAMPLE } else { SAMPLE };
        (self.references.len() / sample).max(1)
    }

    /// Two parts, found by one thread.
    #[inline(always)]
    pub(super) fn split(mut self, bins: &mut Bins) -> (Self, Self) {
        let mapping = Mapping::new(&self.extent, self.references.len(), self.largest);
        bins.clear(&mapping);
        let step = self.step();
        bins.add(self.references, step, &mapping);
        if step == 1
            && let Some(largest) = bins.largest(&mapping)
        {
            self.largest = largest;
        }
        match bins.cheapest(&mapping).filter(|_| self.may_be_lopsided()) {
            Some(s) => self.split_at_division(&mapping, &s),
            None => self.halve(),
        }
    }

    #[inline(always)]
    fn split_at_division(mut self, mapping: &Mapping, s: &Division) -> (Self, Self) {
        self.settle();
        let n = self.references.len();
        let (source, target) = (&mut *self.references, &mut self.spare[..n]);
        // Both places are written and one cursor moves: the outcome of the test is as good as random, and a branch
        // on it would cost more.
        let (mut before, mut behind) = (0, 0);
        for i in 0..n {
            let r = source[i];
            let is_behind = usize::from(mapping.is_behind(&r, s));
            source[before] = r;
            target[behind] = r;
            before += 1 - is_behind;
            behind += is_behind;
        }
        source[before..].copy_from_slice(&target[..behind]);
        let extents = [Extent::of(&source[..before]), Extent::of(&source[before..])];
        self.cut(before, extents)
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
        let extents = [Extent::of(&self.references[..middle]), Extent::of(&self.references[middle..])];
        self.cut(middle, extents)
    }

    /// Two parts, found by all threads.
    pub(super) fn split_by_all(self) -> (Self, Self) {
        let mapping = Mapping::new(&self.extent, self.references.len(), self.largest);
        let step = self.step();
        let sampled = |slice: &[Reference]| {
            let mut bins = Bins::new();
            bins.add(slice, step, &mapping);
            bins
        };
        let merged = |mut a: Bins, b: Bins| {
            a.merge(&b);
            a
        };
        let bins = self.references.par_chunks(SLICE * step).map(sampled).reduce(Bins::new, merged);
        let Some(s) = bins.cheapest(&mapping).filter(|_| self.may_be_lopsided()) else { return self.halve() };
        let is_before = |r: &&Reference| !mapping.is_behind(r, &s);
        let counts: Vec<usize> =
            self.references.par_chunks(SLICE).map(|slice| slice.iter().filter(is_before).count()).collect();
        let middle = counts.iter().sum();
        let (mut before, mut behind) = self.spare.split_at_mut(middle);
        let mut jobs = Vec::with_capacity(counts.len());
        for (slice, &count) in self.references.chunks(SLICE).zip(&counts) {
            let (a, b);
            (a, before) = before.split_at_mut(count);
            (b, behind) = behind.split_at_mut(slice.len() - count);
            jobs.push((slice, a, b));
        }
        let sort = |(slice, a, b): (&[Reference], &mut [Reference], &mut [Reference])| {
            let mut places = [a.iter_mut(), b.iter_mut()];
            for r in slice {
                // As many were counted, so that there always is a place.
                if let Some(place) = places[usize::from(mapping.is_behind(r, &s))].next() {
                    *place = *r;
                }
            }
            [Extent::of(a), Extent::of(b)]
        };
        let none = || [Extent::EMPTY; 2];
        let extents = jobs.into_par_iter().map(sort).reduce(none, |[a, b], [c, d]| [a.union(c), b.union(d)]);
        self.moved().cut(middle, extents)
    }

    /// The same after the references were written to the spare room.
    fn moved(self) -> Self {
        let Self { references, spare, displaced, .. } = self;
        Self { references: spare, spare: references, displaced: !displaced, ..self }
    }

    #[inline(always)]
    fn cut(self, middle: usize, [extent_a, extent_b]: [Extent; 2]) -> (Self, Self) {
        let (a, b) = self.references.split_at_mut(middle);
        let (spare_a, spare_b) = self.spare.split_at_mut(middle);
        let (displaced, depth, largest) = (self.displaced, self.depth + 1, self.largest);
        let first = self.first + middle as u32;
        (
            Part {
                references: a,
                spare: spare_a,
                displaced,
                first: self.first,
                extent: extent_a,
                depth,
                largest,
            },
            Part { references: b, spare: spare_b, displaced, first, extent: extent_b, depth, largest },
        )
    }
}
