//! What arrives in the cells: sums over a block, and the spread of blocks.

use super::super::precision::{Moments, Precision};
use super::super::session::Tally;
use crate::bsdf::Side;
use crate::spectrum::{LANES, Sampled};
use crate::units::{Estimate, Unitless};
use statrs::distribution::{Beta, ContinuousCDF};

/// Fewer arrivals than this make a cell scarce: the spread of blocks then says too little.
const SCARCE: usize = 25;

/// Where light may end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In a cell, after it was scattered into a continuum of directions.
    Cell(Side, usize),
    /// In a cell, in a discrete direction.
    Discrete(Side, usize),
    /// In the sample.
    Absorbed,
    /// Nowhere: it was followed for too long.
    Lost,
    /// Counted in a cell as well: it left through the sides of the sample.
    Edge,
}

/// Sums of shares of the incident flux.
#[derive(Clone, Debug)]
pub(super) struct Census {
    cells: usize,
    /// Of the current block, by place.
    block: Vec<[f64; LANES]>,
    places: Vec<[Moments; LANES]>,
    arrivals: Vec<u64>,
    totals: [[Moments; LANES]; 3],
    /// Largest share that one draw brought.
    largest: [f64; LANES],
    draws: u64,
    rays: u64,
    /// Directions depend on the wavelength: lanes other than the first mean nothing.
    pub(super) is_dispersive: bool,
}

impl Census {
    pub(super) fn new(cells: usize) -> Self {
        let places = 4 * cells + 3;
        Self {
            cells,
            block: vec![[0.0; LANES]; places],
            places: vec![[Moments::default(); LANES]; places],
            arrivals: vec![0; places],
            totals: [[Moments::default(); LANES]; 3],
            largest: [0.0; LANES],
            draws: 0,
            rays: 0,
            is_dispersive: false,
        }
    }

    fn slot(&self, place: Place) -> usize {
        let side = |s: Side| if s == Side::Reflection { 0 } else { self.cells };
        match place {
            Place::Cell(s, cell) => side(s) + cell,
            Place::Discrete(s, cell) => 2 * self.cells + side(s) + cell,
            Place::Absorbed => 4 * self.cells,
            Place::Lost => 4 * self.cells + 1,
            Place::Edge => 4 * self.cells + 2,
        }
    }

    /// Adds the share `weight`·`factor` of the incident flux.
    pub(super) fn add(&mut self, place: Place, weight: Sampled<Unitless>, factor: f64) {
        let slot = self.slot(place);
        let mut arrived = false;
        for (sum, w) in self.block[slot].iter_mut().zip(weight.to_array()) {
            // What is no number must not spoil the rest; it counts as absorbed, and is told by the sum of all shares.
            if w.is_finite() {
                *sum += f64::from(w) * factor;
                arrived |= w != 0.0;
            }
        }
        self.arrivals[slot] += u64::from(arrived);
    }

    /// What one whole draw may bring, for the bounds of cells that nothing arrived in.
    pub(super) fn witness(&mut self, weight: Sampled<Unitless>) {
        for (largest, w) in self.largest.iter_mut().zip(weight.to_array()) {
            *largest = largest.max(f64::from(w));
        }
    }

    /// Ends a block of so many draws that could arrive anywhere, and of so many rays in all.
    pub(super) fn close(&mut self, draws: u64, rays: u64) {
        self.draws += draws;
        self.rays += rays;
        let n = self.cells;
        let mut sums = [[0.0; LANES]; 3];
        for (slot, (block, moments)) in self.block.iter_mut().zip(&mut self.places).enumerate() {
            let total = match slot / n.max(1) {
                0 | 2 => Some(0),
                1 | 3 => Some(1),
                _ => None,
            };
            for lane in 0..LANES {
                moments[lane].add(block[lane]);
                if let Some(total) = total {
                    sums[total][lane] += block[lane];
                }
                // Light that leaves by the sides is in a cell already.
                if slot <= 4 * n + 1 {
                    sums[2][lane] += block[lane];
                }
            }
            *block = [0.0; LANES];
        }
        for (moments, sums) in self.totals.iter_mut().zip(sums) {
            for (m, s) in moments.iter_mut().zip(sums) {
                m.add(s);
            }
        }
    }

    /// Share of the incident flux that ends at a place.
    pub(super) fn share(&self, place: Place, lane: usize, bounds: &Bounds) -> Estimate {
        let slot = self.slot(place);
        let estimate = self.places[slot][lane].estimate(&bounds.precision);
        let arrivals = self.arrivals[slot] as usize;
        let Some(excess) = bounds.excess.get(arrivals) else { return estimate };
        // Where chance has let little arrive, the exact binomial interval of the number of arrivals, each of which brings
        // what those have brought, or the most that any has.
        let each = match arrivals {
            0 => self.largest[lane],
            n => estimate.value * self.draws as f64 / n as f64,
        };
        Estimate { half_width: estimate.half_width.max(excess * each), ..estimate }
    }

    /// Share of the incident flux that leaves on a side.
    pub(super) fn total(&self, side: Side, lane: usize, precision: &Precision) -> Estimate {
        self.totals[usize::from(side == Side::Transmission)][lane].estimate(precision)
    }

    /// The sum of all shares.
    pub(super) fn sum(&self, lane: usize, precision: &Precision) -> Estimate {
        self.totals[2][lane].estimate(precision)
    }

    /// The bounds that the number of draws so far allows.
    pub(super) fn bounds(&self, precision: &Precision) -> Bounds {
        let n = self.draws as f64;
        let level = 0.5 * (1.0 + precision.confidence);
        let excess = (0..SCARCE).map(|k| match k as f64 {
            k if k >= n => 1.0,
            // Clopper & Pearson 1934; for nothing in closed form.
            0.0 => 1.0 - (1.0 - level).powf(1.0 / n),
            k => Beta::new(k + 1.0, n - k).map_or(1.0, |b| b.inverse_cdf(level)) - k / n,
        });
        Bounds { excess: excess.collect(), precision: *precision }
    }
}

impl Tally for Census {
    fn merge(&mut self, later: &Self) {
        for (a, b) in
            self.places.iter_mut().chain(&mut self.totals).zip(later.places.iter().chain(&later.totals))
        {
            for (a, b) in a.iter_mut().zip(b) {
                a.merge(b);
            }
        }
        for (a, b) in self.arrivals.iter_mut().zip(&later.arrivals) {
            *a += b;
        }
        for (a, b) in self.largest.iter_mut().zip(later.largest) {
            *a = a.max(b);
        }
        self.draws += later.draws;
        self.rays += later.rays;
        self.is_dispersive |= later.is_dispersive;
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

/// How far the chance of arriving may exceed the share of draws that arrived, for few arrivals.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    excess: Vec<f64>,
    pub(super) precision: Precision,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Upper ends by Clopper & Pearson at 95 %, two-sided: 0 of 10 → 0.3085, 1 of 10 → 0.4450, 3 of 100 → 0.0852.
    #[test]
    fn scarce_cells_have_the_exact_binomial_bound() {
        let precision = Precision::default();
        for (draws, k, upper) in [(10, 0, 0.308_5), (10, 1, 0.445_0), (100, 3, 0.085_2)] {
            let census = Census { draws, ..Census::new(1) };
            let bound = census.bounds(&precision).excess[k] + k as f64 / draws as f64;
            assert!((bound - upper).abs() < 1e-4, "{k} of {draws}: {bound}");
        }
    }

    #[test]
    fn an_empty_cell_is_bounded_by_the_largest_draw() {
        let mut census = Census::new(2);
        for _ in 0..10 {
            let w = Sampled::from_fn(|lane| lane as f32 * 0.25);
            census.witness(w);
            census.add(Place::Cell(Side::Reflection, 1), w, 1.0);
            census.close(1, 1);
        }
        let bounds = census.bounds(&Precision::default());
        let empty = census.share(Place::Cell(Side::Reflection, 0), 2, &bounds);
        assert!(empty.value == 0.0 && (empty.half_width - 0.5 * 0.308_5).abs() < 1e-4, "{empty:?}");
        let full = census.share(Place::Cell(Side::Reflection, 1), 2, &bounds);
        assert!(full.value == 0.5 && full.half_width >= 0.0);
        assert_eq!(census.total(Side::Reflection, 2, &bounds.precision), Estimate::exact(0.5));
        assert_eq!(census.sum(2, &bounds.precision), Estimate::exact(0.5));
    }
}
