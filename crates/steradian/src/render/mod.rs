//! Execution: threads, tiles, rounds, passes, progress, cancellation.
//!
//! A render runs in rounds, between which an integrator may learn; a round runs in passes over all tiles, each of which
//! adds the next samples of every pixel. Stopping between passes leaves a complete picture with fewer samples. Which
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
use crate::integrator::Notes;
use crate::scene::RenderJob;
use noise::Teller;
use rounds::{Passes, TILE_SIDE};
use setup::Estimator;
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
    execute(job, setup::estimator(job), options, sink, cancel)
}

fn execute(
    job: &RenderJob,
    mut estimator: Estimator<'_>,
    options: &RenderOptions,
    sink: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Rendering, RenderError> {
    let film = setup::film(job)?;
    let mut passes = Passes::new(options, sink, cancel, film.bounds().area() as u64);
    let spp_requested = job.sampling.spp;
    let (tiles, spp, adaptive) = match job.sampling.noise {
        None => {
            let (tiles, spp) = uniform(job, &film, &mut estimator, &mut passes);
            (tiles, spp, None)
        }
        Some(target) => {
            let (tiles, adaptive) =
                adaptive::render(Teller::Others, job, target, &film, &mut estimator, &mut passes);
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
    estimator: &mut Estimator<'_>,
    passes: &mut Passes<'_>,
) -> (Vec<FilmTile>, u32) {
    let mut items: Vec<Item> = film
        .bounds()
        .tiles(TILE_SIDE)
        .into_iter()
        .map(|b| Item { tile: film.tile(b), notes: None })
        .collect();
    let spp = job.sampling.spp;
    let expected = film.bounds().area() as u64 * u64::from(spp);
    let mut done = 0;
    while done < spp {
        let lesson = estimator.next_lesson(done).filter(|&end| end > done && end <= spp);
        for item in &mut items {
            item.notes = lesson.and_then(|_| estimator.notebook());
        }
        let worker = Worker::new(job, film, estimator);
        let end = passes.round(
            &mut items,
            done..lesson.unwrap_or(spp),
            expected,
            || worker.state(),
            |state, item, indices| {
                let pixels = item.tile.bounds().pixels();
                worker.add_samples(state, &mut item.tile, pixels, item.notes.as_mut(), indices)
            },
        );
        done = end.next;
        if end.stopped {
            break;
        }
        if lesson.is_some() {
            estimator.learn(&job.scene, items.iter_mut().filter_map(|item| item.notes.take()).collect());
        }
    }
    (items.into_iter().map(|item| item.tile).collect(), done)
}

/// What one thread works on at a time.
struct Item {
    tile: FilmTile,
    /// In rounds from which the integrator learns.
    notes: Option<Notes>,
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
