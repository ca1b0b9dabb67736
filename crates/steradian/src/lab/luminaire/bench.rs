//! A luminaire before a detector that is far away: rays, and samples of intensity.

use super::cells::Cells;
use super::contract::{LuminaireError, LuminaireSettings};
use super::grid::Grid;
use crate::integrator::{Metering, Tally};
use crate::lab::session::Block;
use crate::light::photometric::Interpolation;
use crate::light::{Light, LightTarget};
use crate::math::warp::uniform_sphere;
use crate::math::{Dir, Frame, Ray, Vec2, Vec3};
use crate::render::setup;
use crate::sampler::Sampler;
use crate::scene::RenderJob;
use crate::shape::ReferencePoint;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled, Wavelengths, cie};
use crate::units::{LUMENS_PER_WATT, Radiance};
use glam::DVec3;

/// Samples of a direction in a block.
const BLOCK: u32 = 32;

/// Samples of the flux in a block.
const FLUX_BLOCK: u32 = 256;

/// How wavelengths count.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Response {
    Luminous,
    Radiant,
}

impl Response {
    fn wavelengths(self, u: f32) -> Wavelengths {
        match self {
            Self::Luminous => Wavelengths::sample_visible(u),
            Self::Radiant => Wavelengths::sample_uniform(u, LAMBDA_MIN, LAMBDA_MAX),
        }
    }

    /// One sample of the integral over wavelengths.
    fn integral<Q>(self, found: &Sampled<Q>, w: &Wavelengths) -> f64 {
        let weight = |lambda: f32| match self {
            Self::Luminous => LUMENS_PER_WATT * cie::y_bar(lambda),
            Self::Radiant => 1.0,
        };
        let lanes = (0..LANES).filter(|&i| w.pdf()[i] > 0.0);
        lanes.map(|i| f64::from(found[i] * weight(w.lambda()[i])) / f64::from(w.pdf()[i])).sum::<f64>()
            / LANES as f64
    }
}

/// A luminaire before a detector far away.
pub(super) struct Bench<'j> {
    job: &'j RenderJob,
    integrator: Box<dyn Metering + 'j>,
    response: Response,
    /// Directions of the nadir, of C0 and of C90 in the scene's world.
    axes: [DVec3; 3],
    /// Lights that rays cannot meet.
    points: Vec<&'j Light>,
    /// Square metres of a square scene unit.
    area: f64,
    time: f32,
}

impl<'j> Bench<'j> {
    pub(super) fn new(
        job: &'j RenderJob,
        settings: &LuminaireSettings,
        response: Response,
    ) -> Result<Self, LuminaireError> {
        let lights = job.scene.lights();
        if let Some(light) = lights.iter().find(|l| l.is_infinite()) {
            return Err(LuminaireError::AtInfinity(light.kind()));
        }
        if lights.is_empty() {
            return Err(LuminaireError::NoLight);
        }
        let integrator = setup::metering(job, settings.max_depth).ok_or(LuminaireError::NotTransport)?;
        let unit = |v: DVec3| v.try_normalize().ok_or(LuminaireError::Axes);
        let nadir = unit(DVec3::from_array(settings.nadir))?;
        let towards = unit(DVec3::from_array(settings.c0))?;
        let across = towards - nadir * towards.dot(nadir);
        if across.length() < 1e-6 {
            return Err(LuminaireError::Axes);
        }
        let c0 = unit(across)?;
        Ok(Self {
            job,
            integrator,
            response,
            axes: [nadir, c0, (-nadir).cross(c0)],
            points: lights.iter().filter(|l| l.place(Vec2::ZERO).is_some()).collect(),
            area: f64::from(job.meters_per_unit) * f64::from(job.meters_per_unit),
            time: job.scene.camera().shutter()[0],
        })
    }

    /// Extent of the geometry along C0, C90 and the nadir [m].
    pub(super) fn extent(&self) -> [f64; 3] {
        let bounds = self.job.scene.accel().bounds();
        if bounds.is_empty() {
            return [0.0; 3];
        }
        let [nadir, c0, c90] = self.axes;
        let corners = bounds.corners().map(|p| self.job.world_from_render.point(p).as_dvec3());
        [c0, c90, nadir].map(|axis| {
            let along = corners.map(|p| p.dot(axis));
            let (lo, hi) =
                (along.into_iter().fold(f64::MAX, f64::min), along.into_iter().fold(f64::MIN, f64::max));
            (hi - lo) * f64::from(self.job.meters_per_unit)
        })
    }

    /// A direction of the grid [°] in render space.
    fn direction(&self, [c, gamma]: [f64; 2]) -> Option<Dir> {
        let [nadir, c0, c90] = self.axes;
        let ((sin_c, cos_c), (sin_g, cos_g)) = (c.to_radians().sin_cos(), gamma.to_radians().sin_cos());
        let d = nadir * cos_g + (c0 * cos_c + c90 * sin_c) * sin_g;
        Dir::new(self.job.world_from_render.inverse().vector(d.as_vec3()))
    }

    pub(super) fn take_table(&self, grid: &Grid, cells: &mut Cells, block: Block) {
        for cell in 0..grid.cells() {
            let mut sampler = block.split(cell as u64).sampler(BLOCK);
            for index in 0..BLOCK {
                sampler.start([0, 0], index);
                let around = sampler.next_1d();
                let sample = match self.direction(grid.direction(cell, around)) {
                    Some(d) => self.intensity(d, &mut sampler, &mut cells.tally),
                    None => 0.0,
                };
                cells.add(cell, sample);
            }
        }
        cells.close_block(BLOCK);
        // Cubics through noise would not be right in the mean; their spread is that of straight lines.
        cells.table_flux.add(grid.flux(&cells.block, Interpolation::Linear));
        cells.block.fill(0.0);
    }

    /// Φ = ∫ I dω over the sphere.
    pub(super) fn take_flux(&self, sum: &mut Cells, block: Block) {
        let mut sampler = block.sampler(FLUX_BLOCK);
        for index in 0..FLUX_BLOCK {
            sampler.start([0, 0], index);
            let d = Dir::new_unchecked(uniform_sphere(sampler.next_2d()));
            let sample = self.intensity(d, &mut sampler, &mut sum.tally) * 4.0 * std::f64::consts::PI;
            sum.add(0, sample);
        }
        sum.close_block(FLUX_BLOCK);
        sum.block.fill(0.0);
    }

    /// One sample of the intensity in a direction of render space.
    fn intensity(&self, d: Dir, sampler: &mut Sampler, tally: &mut Tally) -> f64 {
        let mut w = self.response.wavelengths(sampler.next_1d());
        let mut sum = 0.0;
        for light in &self.points {
            sum += self.response.integral(&self.point_intensity(light, d, sampler.next_2d(), &w, tally), &w);
        }
        let u = sampler.next_2d();
        if let Some(Window { ray, area }) = self.window(d, u) {
            let radiance = self.integrator.radiance(&self.job.scene, ray, &mut w, sampler, tally, None);
            sum += self.response.integral(&radiance, &w) * area;
        }
        sum * self.area
    }

    /// Intensity of a light without extent, or of a point of its opening; zero where something stands in the way.
    fn point_intensity(
        &self,
        light: &Light,
        d: Dir,
        u: Vec2,
        w: &Wavelengths,
        tally: &mut Tally,
    ) -> Sampled<Radiance> {
        let scene = &self.job.scene;
        let Some(place) = light.place(u) else { return Sampled::ZERO };
        // Any distance would do but for rounding: E r².
        let r = place.abs().max_element().max(1.0);
        let from = ReferencePoint::free(place + *d * r, self.time);
        let Some(sample) = light.sample(&from, scene.shapes(), 0, u, w) else { return Sampled::ZERO };
        tally.shadow_rays += 1;
        let leaving = ReferencePoint::free(place, self.time);
        match scene.is_occluded(&leaving, &LightTarget::Infinite, d) {
            true => Sampled::ZERO,
            false => sample.radiance * (r * r),
        }
    }

    /// A ray against `d` through the rectangle that holds the scene as seen from there; `None` where it shows no area.
    fn window(&self, d: Dir, u: Vec2) -> Option<Window> {
        let bounds = self.job.scene.accel().bounds();
        if bounds.is_empty() {
            return None;
        }
        let frame = Frame::from_z(d);
        let (centre, radius) = bounds.bounding_sphere();
        let corners = bounds.corners().map(|p| p - centre);
        let half = |axis: Vec3| corners.iter().map(|c| c.dot(axis).abs()).fold(0.0, f32::max);
        let (half_s, half_t) = (half(frame.s), half(frame.t));
        let area = 4.0 * f64::from(half_s) * f64::from(half_t);
        let at = 2.0 * u - Vec2::ONE;
        let o = centre + frame.s * (at.x * half_s) + frame.t * (at.y * half_t) + *d * (1.01 * radius);
        (area > 0.0).then_some(Window { ray: Ray { o, d: -*d, time: self.time }, area })
    }
}

/// A ray through a figure, and the area that its start was chosen from [square scene units].
struct Window {
    ray: Ray,
    area: f64,
}
