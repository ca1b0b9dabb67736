//! What a goniometer has read.

use super::super::precision::Precision;
use super::super::session::Ending;
use super::beam::{Face, Incidence};
use super::cells::CellGrid;
use super::material::Method;
use crate::bsdf::Side;
use crate::units::Estimate;

/// Readings of all cells, for each incidence and wavelength.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The cells.
    pub grid: CellGrid,
    /// The side that light came to.
    pub face: Face,
    /// How cells were filled; `None` for a piece of geometry, through which photons are followed.
    pub method: Option<Method>,
    /// The wavelengths [nm].
    pub wavelengths: Vec<f32>,
    /// One for each incidence that was asked for; fewer when the measurement was cancelled.
    pub beams: Vec<Beam>,
    /// What the intervals are, and what precision was asked for.
    pub precision: Precision,
    /// The worst of the endings.
    pub ending: Ending,
    /// Rays in all.
    pub rays: u64,
}

/// Light from one incidence.
#[derive(Clone, Debug)]
pub struct Beam {
    /// Where it came from.
    pub incidence: Incidence,
    /// One for each wavelength.
    pub spectra: Vec<Scattered>,
}

/// Where the light of one wavelength has gone, in shares of the incident flux.
#[derive(Clone, Debug)]
pub struct Scattered {
    /// What arrived in each cell on the side of the light.
    pub reflected: Vec<CellFlux>,
    /// What arrived in each cell on the other side; empty where nothing can.
    pub transmitted: Vec<CellFlux>,
    /// Directional-hemispherical reflectance ρ, B (2.14), discrete directions included.
    pub reflectance: Estimate,
    /// Directional-hemispherical transmittance τ, B (2.15), discrete directions included.
    pub transmittance: Estimate,
    /// What else became of it; `None` for a material, whose losses are 1 − ρ − τ.
    pub rest: Option<Rest>,
    /// Independent blocks of draws behind the intervals.
    pub blocks: u64,
}

/// Light that arrived in no cell, in shares of the incident flux, and light that may not have belonged there.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// Tallied where it was absorbed.
    pub absorbed: Estimate,
    /// Given up after very many reflections.
    pub lost: Estimate,
    /// Left across the sides of the sample, on its way to the cell where it was counted: what an unbounded sample may
    /// scatter otherwise.
    pub edge: Estimate,
    /// All cells, absorbed and lost light together: one, if the books are right.
    pub sum: Estimate,
}

/// Shares of the incident flux in one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellFlux {
    /// Scattered into a continuum of directions.
    pub continuous: Estimate,
    /// In discrete directions; of geometry, what passed it by.
    pub discrete: Estimate,
}

impl CellFlux {
    /// Both, which come from the same draws: their widths are added.
    pub fn total(&self) -> Estimate {
        let Self { continuous: c, discrete: d } = self;
        Estimate { value: c.value + d.value, half_width: c.half_width + d.half_width }
    }
}

impl Scattered {
    /// The cells on a side.
    pub fn cells(&self, side: Side) -> &[CellFlux] {
        match side {
            Side::Reflection => &self.reflected,
            Side::Transmission => &self.transmitted,
        }
    }

    /// Mean of the scattering probability function s over a cell [sr⁻¹], B (2.20), without discrete directions: the share of
    /// all scattered light that goes there, per solid angle. `None` where nothing is scattered.
    ///
    /// The interval is that of a ratio of independent numbers, which is wider than need be.
    pub fn probability(&self, flux: &CellFlux, solid_angle: f64) -> Option<Estimate> {
        let total = self.reflectance.plus_independent(self.transmittance);
        (total.value > 0.0).then(|| flux.continuous.over_independent(total).scaled(1.0 / solid_angle))
    }
}

impl Reading {
    /// f̄ [sr⁻¹], the mean of f over a cell weighted with the cosine: flux into the cell over the incident flux and the
    /// projected solid angle.
    pub fn mean_f(&self, cell: usize, flux: Estimate) -> Estimate {
        flux.scaled(1.0 / self.grid.projected_solid_angle(cell))
    }

    /// The standard error behind an interval of `scattered`.
    pub fn standard_error(&self, scattered: &Scattered, estimate: Estimate) -> f64 {
        estimate.half_width / self.precision.half_width(1.0, scattered.blocks.saturating_sub(1))
    }
}
