//! Execution: threads, tiles, passes, progress, cancellation.
//!
//! A render runs in passes over all tiles; each pass adds the next samples of every pixel. Stopping between
//! passes leaves a complete picture with fewer samples. Which samples a pixel receives, and in which order, depends on
//! neither threads nor tiles nor passes.

pub mod progress;
pub mod report;
pub mod schedule;
pub mod setup;

pub use progress::{CancelToken, Progress, ProgressSink, Silent};
pub use report::{Dropped, DroppedSample, Report};
pub use schedule::TileOrder;
pub use setup::RenderError;

use crate::camera::CameraSample;
use crate::film::{Film, FilmSample, FilmTile, Recorded, SurfaceLayers};
use crate::image::{Frame, Window};
use crate::integrator::{FirstSurface, Integrator, Tally, VisibleSurface};
use crate::math::{Normal, Transform, Vec2};
use crate::sampler::Sampler;
use crate::scene::desc::{FilmKind, GBufferSpace};
use crate::scene::{Jitter, RenderJob};
use crate::spectrum::Sampled;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Pixels along the side of a tile: small enough to balance load at the end of a pass, large enough that
/// the queue's lock does not show.
const TILE_SIDE: u32 = 16;

/// Aimed length of a pass: how long a user waits for Ctrl-C or a time limit to take effect.
const PASS_TIME: Duration = Duration::from_millis(1500);

/// How to execute a render; none of it changes the picture, except that a time limit may end it early.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderOptions {
    /// Threads; `None` uses all that the machine offers.
    pub threads: Option<usize>,
    /// Order in which tiles are handed to threads.
    pub tile_order: TileOrder,
    /// Ends the render after the pass in which this time has passed.
    pub time_limit: Option<Duration>,
}

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
    let film = setup::film(job)?;
    let threads = options
        .threads
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get))
        .max(1);
    let mut tiles: Vec<FilmTile> = film.bounds().tiles(TILE_SIDE).into_iter().map(|b| film.tile(b)).collect();
    let integrator = setup::integrator(job);
    let worker = Worker { job, film: &film, integrator: &*integrator, layer_from_render: layer_space(job) };

    let pixels = film.bounds().area() as u64;
    let total = pixels * u64::from(job.sampling.spp);
    let (samples, rays) = (AtomicU64::new(0), AtomicU64::new(0));
    let start = Instant::now();
    let mut report = Report { spp_requested: job.sampling.spp, pixels, threads, ..Report::default() };
    let mut pass = 1;
    while report.spp < job.sampling.spp {
        let first = report.spp;
        let end = first.saturating_add(pass).min(job.sampling.spp);
        let pass_start = Instant::now();
        let states = schedule::for_each(
            &mut tiles,
            options.tile_order,
            threads,
            || worker.state(),
            |state: &mut State, tile| {
                let rays_before = state.tally.rays();
                worker.add_samples(state, tile, first..end);
                let done = tile.bounds().area() as u64 * u64::from(end - first);
                let traced = state.tally.rays() - rays_before;
                let samples_done = samples.fetch_add(done, Ordering::Relaxed) + done;
                sink.update(&Progress {
                    samples_done,
                    samples_total: total,
                    spp_done: (samples_done / pixels) as u32,
                    rays: rays.fetch_add(traced, Ordering::Relaxed) + traced,
                    elapsed: start.elapsed(),
                });
            },
        );
        for state in &states {
            report.tally = report.tally.merge(state.tally);
            report.dropped.merge(&state.dropped);
        }
        report.spp = end;
        let over_time = options.time_limit.is_some_and(|limit| start.elapsed() >= limit);
        if cancel.is_cancelled() || over_time {
            break;
        }
        // At most twice the last pass: the first passes are too short to predict from.
        let aimed =
            PASS_TIME.as_secs_f64() / pass_start.elapsed().as_secs_f64().max(1e-9) * f64::from(end - first);
        pass = (aimed as u32).clamp(1, (end - first).saturating_mul(2));
    }
    report.elapsed = start.elapsed();
    Ok(Rendering { frame: picture(job, &film, &tiles, report.spp)?, report })
}

/// What a thread owns.
struct State {
    sampler: Sampler,
    tally: Tally,
    dropped: Dropped,
}

/// What threads share.
struct Worker<'a> {
    job: &'a RenderJob,
    film: &'a Film,
    integrator: &'a dyn Integrator,
    layer_from_render: Transform,
}

impl Worker<'_> {
    fn state(&self) -> State {
        let s = &self.job.sampling;
        let sampler = Sampler::new(s.kind, s.spp, self.film.resolution(), s.seed);
        State { sampler, tally: Tally::default(), dropped: Dropped::default() }
    }

    fn add_samples(&self, state: &mut State, tile: &mut FilmTile, indices: std::ops::Range<u32>) {
        for pixel in tile.bounds().pixels() {
            for index in indices.clone() {
                if self.add_sample(state, tile, pixel, index) == Recorded::NotFinite {
                    state.dropped.add(DroppedSample { pixel, sample: index });
                }
            }
        }
    }

    fn add_sample(&self, state: &mut State, tile: &mut FilmTile, pixel: [i32; 2], index: u32) -> Recorded {
        let sampler = &mut state.sampler;
        sampler.start(pixel, index);
        let u_filter = sampler.next_pixel_2d();
        let u_lambda = sampler.next_1d();
        let (u_time, u_lens) = (sampler.next_1d(), sampler.next_2d());
        let center = Vec2::new(pixel[0] as f32, pixel[1] as f32) + 0.5;
        let (film, weight, lens, time) = match self.job.sampling.pixel_jitter {
            Jitter::On => {
                let f = self.film.filter().sample(u_filter);
                (center + f.offset, f.weight, u_lens, u_time)
            }
            Jitter::Off => (center, 1.0, Vec2::splat(0.5), 0.5),
        };
        let u_lambda = match self.job.sampling.wavelength_jitter {
            Jitter::On => u_lambda,
            Jitter::Off => 0.5,
        };
        let mut w = self.film.sample_wavelengths(u_lambda);
        let mut first = self.film.wants_surfaces().then(FirstSurface::default);
        let (radiance, weight) = match self.job.scene.camera().ray(&CameraSample { film, lens, time }) {
            Some(camera) => {
                let radiance = self.integrator.radiance(
                    &self.job.scene,
                    camera.ray,
                    &mut w,
                    sampler,
                    &mut state.tally,
                    first.as_mut(),
                );
                (radiance, weight * camera.weight)
            }
            None => (Sampled::ZERO, weight),
        };
        let surface = first.and_then(|f| f.surface).map(|s| self.layers(&s));
        let sample = FilmSample { radiance, wavelengths: &w, weight, surface: surface.as_ref() };
        self.film.add_sample(tile, pixel, &sample)
    }

    /// The surface in the coordinates of the output layers.
    fn layers(&self, s: &VisibleSurface) -> SurfaceLayers {
        let t = &self.layer_from_render;
        let towards_viewer = s.seen_from - s.point.p.p;
        let normal = |n: Normal| t.normal(n.facing(towards_viewer)).unwrap_or(n);
        let footprint = self.job.scene.footprint(&s.point);
        SurfaceLayers {
            p: t.point(s.point.p.p),
            n: normal(s.point.ng),
            ns: normal(s.point.shading.n),
            uv: s.point.uv,
            dz: Vec2::new(t.vector(footprint.dpdx).z, t.vector(footprint.dpdy).z),
            albedo: s.albedo,
        }
    }
}

/// From render space to the space of the geometric layers; the camera's is that of the shutter's opening.
fn layer_space(job: &RenderJob) -> Transform {
    match job.film.kind {
        FilmKind::GBuffer { space: GBufferSpace::Camera } => job.scene.camera().placement().start().inverse(),
        FilmKind::GBuffer { space: GBufferSpace::World } | FilmKind::Rgb | FilmKind::Spectral { .. } => {
            job.world_from_render
        }
    }
}

fn picture(job: &RenderJob, film: &Film, tiles: &[FilmTile], spp: u32) -> Result<Frame, RenderError> {
    let developed = film.develop(tiles);
    let b = developed.bounds;
    let window = Window { x: b.min[0], y: b.min[1], width: b.width() as u32, height: b.height() as u32 };
    let mut frame = Frame::new(developed.resolution, window, Some(job.output_space.kind()))?;
    for layer in developed.layers {
        frame.push_channel(layer.name, layer.values)?;
    }
    for (name, value) in developed.attributes.into_iter().chain(setup::metadata(job, spp)) {
        frame.set_attribute(name, value);
    }
    Ok(frame)
}
