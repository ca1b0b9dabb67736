//! One sample: from a pixel and an index to a record on the film.

use super::report::{Dropped, DroppedSample};
use crate::camera::CameraSample;
use crate::film::{Film, FilmSample, FilmTile, Recorded, SurfaceLayers};
use crate::integrator::{FirstSurface, Integrator, Tally, VisibleSurface};
use crate::math::{Normal, Transform, Vec2};
use crate::sampler::Sampler;
use crate::scene::desc::{FilmKind, GBufferSpace};
use crate::scene::{Jitter, RenderJob};
use crate::spectrum::Sampled;
use std::ops::Range;

/// What a thread owns.
pub(super) struct State {
    pub(super) sampler: Sampler,
    pub(super) log: Log,
}

/// What a thread has to say about its samples.
#[derive(Default)]
pub(super) struct Log {
    pub(super) tally: Tally,
    pub(super) dropped: Dropped,
}

/// What threads share.
pub(super) struct Worker<'a> {
    job: &'a RenderJob,
    film: &'a Film,
    integrator: &'a dyn Integrator,
    layer_from_render: Transform,
}

impl<'a> Worker<'a> {
    pub(super) fn new(job: &'a RenderJob, film: &'a Film, integrator: &'a dyn Integrator) -> Self {
        Self { job, film, integrator, layer_from_render: layer_space(job) }
    }

    pub(super) fn state(&self) -> State {
        let s = &self.job.sampling;
        let sampler = Sampler::new(s.kind, s.spp, self.film.resolution(), s.seed);
        State { sampler, log: Log::default() }
    }

    /// Adds the samples `indices` of a pixel to its tile; returns how many that were.
    pub(super) fn add_samples(
        &self,
        state: &mut State,
        tile: &mut FilmTile,
        pixel: [i32; 2],
        indices: Range<u32>,
    ) -> u64 {
        let count = u64::from(indices.end - indices.start);
        for index in indices {
            self.add_sample(&mut state.sampler, &mut state.log, tile, pixel, index);
        }
        count
    }

    fn add_sample(
        &self,
        sampler: &mut Sampler,
        log: &mut Log,
        tile: &mut FilmTile,
        pixel: [i32; 2],
        index: u32,
    ) {
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
                let (scene, ray, tally) = (&self.job.scene, camera.ray, &mut log.tally);
                let radiance = self.integrator.radiance(scene, ray, &mut w, sampler, tally, first.as_mut());
                (radiance, weight * camera.weight)
            }
            None => (Sampled::ZERO, weight),
        };
        let surface = first.and_then(|f| f.surface).map(|s| self.layers(&s));
        let sample = FilmSample { radiance, wavelengths: &w, weight, surface: surface.as_ref() };
        if self.film.add_sample(tile, pixel, &sample) == Recorded::NotFinite {
            log.dropped.add(DroppedSample { pixel, sample: index });
        }
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
