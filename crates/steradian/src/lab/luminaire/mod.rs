//! The goniophotometer for luminaires: the far-field distribution of everything that shines in a scene.
//!
//! Seen from infinity in direction d, a scene is a figure in the plane perpendicular to d. Its intensity is
//! I(d) = ∫ L(x, d) dA over that plane, A (19), (21); rays are traced backwards through a rectangle around the figure by the
//! integrator that renders the scene. What points emit directly no ray can meet: it is I(d) where nothing stands in between.

mod bench;
mod cells;
mod contract;
mod distribution;
mod grid;

pub use cells::DIM;
pub use contract::{LuminaireError, LuminaireSettings};
pub use distribution::Distribution;

use super::session::Session;
use crate::light::photometric::Interpolation;
use crate::scene::RenderJob;
use crate::units::kind::{Flux, Intensity, Radiant, Unit};
use crate::units::{Estimate, Measured};
use bench::{Bench, Response};
use cells::Cells;
use grid::Grid;

/// Luminous intensity [cd] in all directions of the grid, and the luminous flux [lm], each as precise as the session asks.
///
/// # Errors
/// When the scene is for legacy shading, has no light or one at infinity, or the settings make no grid.
pub fn measure(
    job: &RenderJob,
    settings: &LuminaireSettings,
    session: &Session<'_>,
) -> Result<Distribution, LuminaireError> {
    measure_as(job, settings, session, Response::Luminous)
}

/// Radiant intensity [W·sr⁻¹] and flux [W] over 360–830 nm; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_radiant(
    job: &RenderJob,
    settings: &LuminaireSettings,
    session: &Session<'_>,
) -> Result<Distribution<Radiant>, LuminaireError> {
    measure_as(job, settings, session, Response::Radiant)
}

fn measure_as<D>(
    job: &RenderJob,
    settings: &LuminaireSettings,
    session: &Session<'_>,
    response: Response,
) -> Result<Distribution<D>, LuminaireError>
where
    Intensity: Unit<D>,
    Flux: Unit<D>,
{
    let bench = Bench::new(job, settings, response)?;
    let grid = Grid::new(settings)?;
    let precision = &session.precision;
    let outcome = session.run(
        0,
        || Cells::new(grid.cells()),
        |cells, block| bench.take_table(&grid, cells, block),
        |cells| cells.demand(precision),
    );
    let flux = session.run(
        1,
        || Cells::new(1),
        |sum, block| bench.take_flux(sum, block),
        |sum| precision.demand(sum.estimates(precision)[0]),
    );
    let estimates = outcome.tally.estimates(precision);
    let cells = grid.indices().map(|cell| Measured::new(estimates[cell])).collect();
    Ok(Distribution {
        cells,
        table_flux: Measured::new(Estimate {
            value: grid.flux(&estimates.iter().map(|e| e.value).collect::<Vec<_>>(), Interpolation::Smooth),
            ..outcome.tally.table_flux.estimate(precision)
        }),
        flux: Measured::new(flux.tally.estimates(precision)[0]),
        extent: bench.extent(),
        rays: outcome.tally.tally.rays() + flux.tally.tally.rays(),
        dropped: outcome.tally.dropped + flux.tally.dropped,
        endings: [outcome.ending, flux.ending],
        planes: grid.planes,
        gamma: grid.gamma,
    })
}
