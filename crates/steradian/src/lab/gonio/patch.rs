//! A piece of geometry as the sample: light is followed through the scene until it leaves.

use super::super::session::Block;
use super::census::{Census, Place};
use super::material::Setting;
use crate::bsdf::{Mode, Side};
use crate::math::{Bounds3, Dir, LocalDir, Normal, Point, Ray, Transform, Vec2, Vec3};
use crate::sampler::Sampler;
use crate::scene::{RenderJob, Scene};
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::Unitless;

/// Photons of a block.
const PHOTONS: u32 = 1024;
/// Share of the incident flux of a photon.
const EACH: f64 = 1.0 / PHOTONS as f64;
/// Surfaces that a photon may meet before it counts as lost.
const MOST_EVENTS: u32 = 4096;
/// What a photon carries when roulette begins.
const FAINT: f32 = 0.25;
/// Share of the sample's width that the port leaves out on each side, unless one is given.
const MARGIN: f32 = 0.125;

/// The window in the plane above the sample, or below it, that light enters through, as bounds of x and y [scene units].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port {
    /// Bounds of x, increasing.
    pub x: [f32; 2],
    /// Bounds of y, increasing.
    pub y: [f32; 2],
}

/// The geometry of a scene as a sample. The z axis of the scene's world is the sample's normal.
#[derive(Clone, Copy, Debug)]
pub struct Patch<'j> {
    scene: &'j Scene,
    world_from_render: Transform,
    render_from_world: Transform,
    bounds: Bounds3,
    port: Port,
}

/// Why a scene is no sample.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// Nothing to shine light on.
    #[error("the scene has no geometry")]
    Empty,
    /// The window has no area.
    #[error("the sample has no width in x or y to shine light on: state a port")]
    NoWidth,
    /// Light would miss the sample.
    #[error(
        "the port x {}–{}, y {}–{} does not lie within the sample, x {}–{}, y {}–{}",
        .port.x[0], .port.x[1], .port.y[0], .port.y[1], .sample.x[0], .sample.x[1], .sample.y[0], .sample.y[1]
    )]
    Outside {
        /// The window.
        port: Port,
        /// Extent of the sample.
        sample: Port,
    },
}

impl<'j> Patch<'j> {
    /// All of the scene's geometry, with light through a given port, or through one that leaves an eighth of the sample's width
    /// out on each side.
    ///
    /// # Errors
    /// When there is no geometry, or the port is not a window above it.
    pub fn new(job: &'j RenderJob, port: Option<Port>) -> Result<Self, PatchError> {
        let in_render = job.scene.accel().bounds();
        if in_render.is_empty() {
            return Err(PatchError::Empty);
        }
        let bounds = job.world_from_render.bounds(&in_render);
        let sample = Port { x: [bounds.min.x, bounds.max.x], y: [bounds.min.y, bounds.max.y] };
        let inner = |[lo, hi]: [f32; 2]| [lo + MARGIN * (hi - lo), hi - MARGIN * (hi - lo)];
        let port = port.unwrap_or(Port { x: inner(sample.x), y: inner(sample.y) });
        if !(port.x[1] > port.x[0] && port.y[1] > port.y[0]) {
            return Err(PatchError::NoWidth);
        }
        // The bounds have been moved to another space and back: they are known to rounding.
        let slack = 1e-5 * bounds.diagonal().length();
        let within = |p: [f32; 2], s: [f32; 2]| p[0] >= s[0] - slack && p[1] <= s[1] + slack;
        if !within(port.x, sample.x) || !within(port.y, sample.y) {
            return Err(PatchError::Outside { port, sample });
        }
        let world_from_render = job.world_from_render;
        let render_from_world = world_from_render.inverse();
        Ok(Self { scene: &job.scene, world_from_render, render_from_world, bounds, port })
    }

    /// The window.
    pub fn port(&self) -> Port {
        self.port
    }

    /// Extent of the sample [scene units], in the scene's world.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// One block of photons.
    pub(super) fn block(&self, census: &mut Census, block: Block, w: Wavelengths, setting: &Setting<'_>) {
        let mut sampler = block.sampler(PHOTONS);
        for i in 0..PHOTONS {
            sampler.start([0, 0], i);
            self.photon(census, &mut sampler, w, setting);
        }
        census.close(u64::from(PHOTONS), u64::from(PHOTONS));
    }

    fn photon(&self, census: &mut Census, sampler: &mut Sampler, mut w: Wavelengths, setting: &Setting<'_>) {
        let u = sampler.next_2d();
        let spread = if setting.incidence.is_spread() { sampler.next_2d() } else { Vec2::ZERO };
        let from = setting.incidence.direction(setting.grid, setting.face, spread);
        let mut photon = Photon { from, carried: Sampled::ONE, is_scattered: false };
        let Some(mut ray) = self.first_ray(u, from) else {
            return census.add(Place::Lost, photon.carried, EACH);
        };
        census.witness(photon.carried);
        for event in 0..MOST_EVENTS {
            let Some(direction) = Dir::new(ray.d) else { break };
            let Some(hit) = self.scene.intersect(&ray, f32::INFINITY) else {
                return self.leave(census, &ray, &photon, setting);
            };
            let wo = -direction;
            let shaded = self.scene.shade(&hit, wo, &mut w, sampler.hash_seed());
            census.is_dispersive |= w.companions_terminated();
            let Some(bsdf) = shaded else {
                ray = hit.point.p.spawn(hit.point.ng, direction, ray.time);
                continue;
            };
            photon.is_scattered = true;
            let Some(s) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d(), Mode::Importance) else {
                return census.add(Place::Absorbed, photon.carried, EACH);
            };
            let left = s.weight * adjoint(hit.point.ng, bsdf.n(), wo, s.wi) * photon.carried;
            census.add(Place::Absorbed, photon.carried - left, EACH);
            photon.carried = left;
            let most = left.max();
            if !(most > 0.0) {
                return;
            }
            ray = hit.point.p.spawn(hit.point.ng, s.wi, ray.time);
            if most < FAINT && event > 2 {
                let survival = most / FAINT;
                if sampler.next_1d() >= survival {
                    return;
                }
                photon.carried = left / survival;
            }
        }
        census.add(Place::Lost, photon.carried, EACH);
    }

    /// Parallel light that crosses the plane of the port at a point of it.
    fn first_ray(&self, u: Vec2, from: LocalDir) -> Option<Ray> {
        let Port { x, y } = self.port;
        let z = if from.z > 0.0 { self.bounds.max.z } else { self.bounds.min.z };
        let at = Vec3::new(x[0] + u.x * (x[1] - x[0]), y[0] + u.y * (y[1] - y[0]), z);
        // From somewhat above the plane, so that what lies in it is met.
        let start = at + *from * (0.1 * self.bounds.diagonal().length());
        let towards = self.render_from_world.direction(Dir::new(-*from)?)?;
        Some(Ray { o: self.render_from_world.point(Point(start)), d: *towards, time: 0.0 })
    }

    fn leave(&self, census: &mut Census, ray: &Ray, photon: &Photon, setting: &Setting<'_>) {
        let out = Dir::new(ray.d).and_then(|d| self.world_from_render.direction(d));
        let Some(out) = out.and_then(|d| LocalDir::new(*d)).filter(|d| d.z != 0.0) else {
            return census.add(Place::Lost, photon.carried, EACH);
        };
        let side = if out.same_hemisphere(photon.from) { Side::Reflection } else { Side::Transmission };
        let cell = setting.grid.index(out);
        let place = if photon.is_scattered { Place::Cell(side, cell) } else { Place::Discrete(side, cell) };
        census.add(place, photon.carried, EACH);
        let start = self.world_from_render.point(ray.o);
        let plane = if out.z > 0.0 { self.bounds.max.z } else { self.bounds.min.z };
        let crossing = *start + *out * ((plane - start.z) / out.z);
        let within = |x: f32, lo: f32, hi: f32| lo <= x && x <= hi;
        let Bounds3 { min, max } = self.bounds;
        if !(within(crossing.x, min.x, max.x) && within(crossing.y, min.y, max.y)) {
            census.add(Place::Edge, photon.carried, EACH);
        }
    }
}

/// Light on its way.
struct Photon {
    /// Where it came from.
    from: LocalDir,
    carried: Sampled<Unitless>,
    is_scattered: bool,
}

/// Factor by which power that is scattered under a shading normal differs from radiance (Veach 1997, 5.3.2): one where the
/// shading normal is that of the surface.
fn adjoint(ng: Normal, ns: Normal, from: Dir, to: Dir) -> f32 {
    if *ng == *ns {
        return 1.0;
    }
    let cos = |n: Normal, w: Dir| n.dot(*w).abs();
    let below = cos(ng, from) * cos(ns, to);
    // Light along the surface, or along its shading normal's plane, carries nothing on.
    if below > 0.0 { cos(ns, from) * cos(ng, to) / below } else { 0.0 }
}
