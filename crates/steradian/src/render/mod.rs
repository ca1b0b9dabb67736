//! Execution: threads, tiles, rounds, passes, progress, cancellation.
//!
//! A render runs in rounds, between which it may be decided which pixels go on; a round runs in passes over all tiles, each
//! of which adds the next samples of every pixel. Stopping between passes leaves a complete picture with fewer samples. Which
//! samples a pixel receives, and in which order, depends on neither threads nor tiles nor passes.

mod adaptive;
mod noise;
pub mod options;
pub mod progress;
pub mod report;
mod rounds;
pub mod schedule;
pub mod setup;
mod worker;

pub use options::RenderOptions;
pub use progress::{CancelToken, Progress, ProgressSink, Silent};
pub use report::{Adaptive, Dropped, DroppedSample, Report};
pub use schedule::TileOrder;
pub use setup::RenderError;

use crate::film::{Film, FilmKind, FilmTile};
use crate::image::{Frame, Window};
use crate::integrator::Integrator;
use crate::scene::RenderJob;
use noise::Teller;
use rounds::{Passes, TILE_SIDE};
use worker::Worker;

/// A finished (or stopped) render.
#[derive(Debug)]
pub struct Rendering {
    /// The picture.
    pub frame: Frame,
    /// What was done.
    pub report: Report,
}

/// Renders a job.
///
/// # Errors
/// When the job's film settings contradict each other; no sample has been taken then.
pub fn render(
    job: &RenderJob,
    options: &RenderOptions,
    sink: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Rendering, RenderError> {
    execute(job, &*setup::integrator(job), options, sink, cancel)
}

fn execute(
    job: &RenderJob,
    integrator: &dyn Integrator,
    options: &RenderOptions,
    sink: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Rendering, RenderError> {
    let film = setup::film(job)?;
    let mut passes = Passes::new(options, sink, cancel, film.bounds().area() as u64);
    let spp_requested = job.sampling.spp;
    let (tiles, spp, adaptive) = match job.sampling.noise {
        None => {
            let (tiles, spp) = uniform(job, &film, integrator, &mut passes);
            (tiles, spp, None)
        }
        Some(target) => {
            let (tiles, adaptive) =
                adaptive::render(Teller::Others, job, target, &film, integrator, &mut passes);
            (tiles, adaptive.mean_spp.round() as u32, Some(adaptive))
        }
    };
    let report = Report { spp, spp_requested, adaptive, ..passes.report() };
    Ok(Rendering { frame: picture(job, &film, &tiles, &report)?, report })
}

/// The same number of samples for every pixel; returns the tiles and that number.
fn uniform(
    job: &RenderJob,
    film: &Film,
    integrator: &dyn Integrator,
    passes: &mut Passes<'_>,
) -> (Vec<FilmTile>, u32) {
    let mut tiles: Vec<FilmTile> = film.bounds().tiles(TILE_SIDE).into_iter().map(|b| film.tile(b)).collect();
    let spp = job.sampling.spp;
    let expected = film.bounds().area() as u64 * u64::from(spp);
    let worker = Worker::new(job, film, integrator);
    let end = passes.round(
        &mut tiles,
        0..spp,
        expected,
        || worker.state(),
        |state, tile, indices| {
            let pixels = tile.bounds().pixels();
            pixels.map(|pixel| worker.add_samples(state, tile, pixel, indices.clone())).sum()
        },
    );
    (tiles, end.next)
}

fn picture(job: &RenderJob, film: &Film, tiles: &[FilmTile], report: &Report) -> Result<Frame, RenderError> {
    let developed = film.develop(tiles);
    let b = developed.bounds;
    let window = Window { x: b.min[0], y: b.min[1], width: b.width() as u32, height: b.height() as u32 };
    let mut frame = Frame::new(developed.resolution, window, Some(job.output_space.kind()))?;
    for layer in developed.layers {
        frame.push_channel(layer.name, layer.values)?;
    }
    if report.adaptive.is_some() && film.kind() == FilmKind::GBuffer {
        let mut counts = vec![0.0; b.area()];
        for tile in tiles {
            for pixel in tile.bounds().pixels() {
                if let Some(at) = b.index(pixel) {
                    counts[at] = tile.samples(pixel) as f32;
                }
            }
        }
        frame.push_channel("SampleCount", counts)?;
    }
    for (name, value) in developed.attributes.into_iter().chain(setup::metadata(job, report)) {
        frame.set_attribute(name, value);
    }
    Ok(frame)
}

#[cfg(test)]
mod tests;
