//! What is measured for a report.

use super::daylight::{DaylightFactors, daylight_factors, faces_zenith, is_lit_by_skies, outdoors};
use super::grid::Grid;
use super::uniformity::{Uniformity, uniformity};
use super::view::ViewReport;
use crate::lab::meters::lux::{self, LuxReading, LuxSettings};
use crate::lab::meters::{MeterError, MeterPoint};
use crate::lab::{Ending, Session};
use crate::scene::RenderJob;
use crate::units::{Estimate, Illuminance};

/// Readings on a grid.
#[derive(Clone, Debug)]
pub struct GridReport {
    /// The grid.
    pub grid: Grid,
    /// Where the meters stood.
    pub points: Vec<MeterPoint>,
    /// What they read, one after the other.
    pub readings: Vec<LuxReading>,
    /// What that says as a whole.
    pub uniformity: Uniformity,
    /// Illuminance of a plane of the same direction with nothing around it, in scenes that only skies light.
    pub outdoors: Option<Illuminance>,
    /// Daylight factors, in scenes that only skies light.
    pub daylight: Option<DaylightFactors>,
}

/// A report.
#[derive(Clone, Debug)]
pub struct Report {
    /// What was measured, such as the scene's file name.
    pub title: String,
    /// Level of all intervals, within (0, 1).
    pub confidence: f64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Most bounces of light.
    pub max_depth: u32,
    /// Length of a scene unit [m].
    pub meters_per_unit: f64,
    /// Grids.
    pub grids: Vec<GridReport>,
    /// Views.
    pub views: Vec<ViewReport>,
    /// What one must know to read the numbers.
    pub remarks: Vec<String>,
}

impl GridReport {
    /// The illuminances [lx].
    pub fn illuminances(&self) -> Vec<Estimate> {
        self.readings.iter().map(|r| r.total.estimate()).collect()
    }

    /// Rays traced.
    pub fn rays(&self) -> u64 {
        self.readings.iter().map(|r| r.effort.rays).sum()
    }

    /// Points whose reading is not as precise as was asked for.
    pub fn imprecise(&self) -> usize {
        self.readings.iter().filter(|r| r.effort.ending != Ending::Precise).count()
    }
}

/// Measures the points of a grid; `None` when the user stopped it before the last point.
///
/// # Errors
/// When the scene is for legacy shading, or the grid has no place in it.
pub fn measure_grid(
    job: &RenderJob,
    grid: Grid,
    settings: &LuxSettings,
    session: &Session<'_>,
) -> Result<Option<GridReport>, MeterError> {
    let points = grid.points();
    let readings = lux::measure(job, &points, settings, session)?;
    if readings.len() < points.len() {
        return Ok(None);
    }
    let values: Vec<Estimate> = readings.iter().map(|r| r.total.estimate()).collect();
    let outdoors = match grid.normal() {
        Some(up) if is_lit_by_skies(job) && faces_zenith(job, up) => outdoors(job, up, session),
        _ => None,
    };
    let daylight = outdoors.and_then(|e| daylight_factors(&values, e));
    let Some(uniformity) = uniformity(&values, &session.precision) else { return Ok(None) };
    Ok(Some(GridReport { grid, points, readings, uniformity, outdoors, daylight }))
}
