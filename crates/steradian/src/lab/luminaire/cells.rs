//! Sums over blocks, for each direction of a table.

use crate::integrator::Tally;
use crate::lab::precision::{Moments, Precision};
use crate::lab::session;
use crate::units::Estimate;

/// A cell is precise enough by the session's relative precision of this share of the largest intensity, if its own is less:
/// dim directions need not be known better than they matter.
pub const DIM: f64 = 0.1;

/// Sums over blocks.
pub(super) struct Cells {
    pub(super) cells: Vec<CellSum>,
    /// The integral of each block's table, interpolated by straight lines.
    pub(super) table_flux: Moments,
    /// The largest sample of all.
    pub(super) largest: f64,
    pub(super) tally: Tally,
    pub(super) dropped: u64,
    /// Means of the block in work.
    pub(super) block: Vec<f64>,
}

#[derive(Clone, Copy, Default)]
pub(super) struct CellSum {
    moments: Moments,
    samples: u64,
    /// Whether any of them found light.
    is_lit: bool,
}

impl session::Tally for Cells {
    fn merge(&mut self, later: &Self) {
        for (sum, more) in self.cells.iter_mut().zip(&later.cells) {
            sum.moments.merge(&more.moments);
            sum.samples += more.samples;
            sum.is_lit |= more.is_lit;
        }
        self.table_flux.merge(&later.table_flux);
        self.largest = self.largest.max(later.largest);
        self.tally = self.tally.merge(later.tally);
        self.dropped += later.dropped;
    }

    fn rays(&self) -> u64 {
        // Directions without geometry cost samples, but no rays.
        self.tally.rays().max(self.cells.iter().map(|c| c.samples).sum())
    }
}

impl Cells {
    pub(super) fn new(n: usize) -> Self {
        Self {
            cells: vec![CellSum::default(); n],
            table_flux: Moments::default(),
            largest: 0.0,
            tally: Tally::default(),
            dropped: 0,
            block: vec![0.0; n],
        }
    }

    pub(super) fn add(&mut self, cell: usize, sample: f64) {
        self.cells[cell].samples += 1;
        if !sample.is_finite() {
            self.dropped += 1;
            return;
        }
        self.block[cell] += sample;
        self.cells[cell].is_lit |= sample > 0.0;
        self.largest = self.largest.max(sample);
    }

    pub(super) fn close_block(&mut self, samples: u32) {
        for (cell, sum) in self.cells.iter_mut().zip(&mut self.block) {
            *sum /= f64::from(samples);
            cell.moments.add(*sum);
        }
    }

    /// What cells that found no light may have missed is bounded by the brightest sample of the whole measurement.
    pub(super) fn estimates(&self, precision: &Precision) -> Vec<Estimate> {
        let estimate = |c: &CellSum| match c.is_lit {
            true => c.moments.estimate(precision),
            false => Estimate { value: 0.0, half_width: precision.unseen(c.samples, self.largest) },
        };
        self.cells.iter().map(estimate).collect()
    }

    pub(super) fn demand(&self, precision: &Precision) -> f64 {
        let estimates = self.estimates(precision);
        let peak = estimates.iter().map(|e| e.value).fold(0.0, f64::max);
        let floor = precision.absolute.max(precision.relative * DIM * peak);
        let precision = Precision { absolute: floor, ..*precision };
        precision.worst_demand(estimates)
    }
}
