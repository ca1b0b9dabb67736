//! Path tracing: the Neumann series of the directional rendering equation, B (2.26), B (2.28),
//! with next-event estimation, multiple importance sampling and Russian roulette.

use super::contract::{Arriving, FirstSurface, Integrator, Metering, SensorPoint, Tally, VisibleSurface};
use super::mis::power_heuristic;
use super::vertex::{albedo, reference};
use crate::accel::Work;
use crate::bsdf::{Lobe, Mode, Side};
use crate::material::{Evaluation, SurfaceBsdf};
use crate::math::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use crate::math::{Dir, Frame, Ray};
use crate::sampler::Sampler;
use crate::scene::Scene;
use crate::shape::ReferencePoint;
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::kind::Irradiance;
use crate::units::{Density, PdfSolidAngle, Radiance, Unitless};
use std::f32::consts::PI;
use std::marker::PhantomData;

/// Bounces that no path is denied by roulette. Ending paths after the first one already costs more in noise than it saves in
/// time: at equal time the error of seven scenes was 1.04 to 1.8 times as large; five bounces are hardly better than three.
const WHOLE_BOUNCES: u32 = 3;

/// The path tracer.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer {
    /// Most bounces of a path; 0 shows only what emits.
    pub max_depth: u32,
    /// Widens narrow lobes after the first wide one. Biased, off by default.
    pub regularize: bool,
}

/// How the current ray was chosen, which decides the weight of light that it runs into.
enum Arrival {
    /// By the camera or by a discrete lobe: no light sample could have found it.
    Only,
    /// By a continuous lobe at a surface where lights were sampled as well.
    Scattered { from: ReferencePoint, density: PdfSolidAngle },
}

impl Arrival {
    /// Weight of emission found along `wi`, given the density with which light sampling finds it.
    fn weight(&self, light_density: impl FnOnce(&ReferencePoint) -> PdfSolidAngle) -> f32 {
        match self {
            Self::Only => 1.0,
            Self::Scattered { from, density } => power_heuristic(*density, light_density(from)),
        }
    }
}

/// Where a path puts the light that it finds.
trait Collect: Default {
    /// Light that was scattered `bounces` times before it came along the path's first ray.
    fn collect(&mut self, bounces: u32, light: Sampled<Radiance>);
}

/// Cameras do not care what happened to light.
impl Collect for Sampled<Radiance> {
    #[inline]
    fn collect(&mut self, _bounces: u32, light: Sampled<Radiance>) {
        *self += light;
    }
}

/// Radiance along a ray, by the history of the light.
#[derive(Clone, Copy, Debug, Default)]
struct ByHistory {
    /// From where it was emitted.
    direct: Sampled<Radiance>,
    /// Scattered at least once.
    indirect: Sampled<Radiance>,
}

impl Collect for ByHistory {
    #[inline]
    fn collect(&mut self, bounces: u32, light: Sampled<Radiance>) {
        match bounces {
            0 => self.direct += light,
            _ => self.indirect += light,
        }
    }
}

impl Integrator for PathTracer {
    fn radiance(
        &self,
        scene: &Scene,
        ray: Ray,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        first: Option<&mut FirstSurface>,
    ) -> Sampled<Radiance> {
        let (arrival, found) = (Arrival::Only, PhantomData);
        scene.accel().work(Walk { tracer: self, scene, ray, arrival, w, sampler, tally, first, found })
    }
}

/// A sensor measures what a white Lambertian surface in its place would send back: E = π L, A (24), A (30). Hence
/// its light is found as that of any surface: one sample of a light, and one path in a cosine-distributed direction.
impl Metering for PathTracer {
    fn irradiance(
        &self,
        scene: &Scene,
        sensor: &SensorPoint,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
    ) -> Arriving {
        let n = Some(sensor.n);
        let from = ReferencePoint { p: sensor.p, ng: n, ns: n, lit_side: n, time: sensor.time };
        let sampled = light_at_sensor(scene, &from, sensor, w, sampler, tally);
        let local = cosine_hemisphere(sampler.next_2d());
        let density = PdfSolidAngle(cosine_hemisphere_pdf(local.z));
        let wi = Frame::from_z(sensor.n).to_world(local);
        let ray = sensor.p.spawn(sensor.n, wi, sensor.time);
        let arrival = Arrival::Scattered { from, density };
        let (first, found) = (None, PhantomData::<ByHistory>);
        let found =
            scene.accel().work(Walk { tracer: self, scene, ray, arrival, w, sampler, tally, first, found });
        // cosθ over the density cosθ/π.
        Arriving { direct: sampled + (found.direct * PI).cast(), indirect: (found.indirect * PI).cast() }
    }
}

/// [`PathTracer::walk`] with its arguments.
struct Walk<'a, C> {
    tracer: &'a PathTracer,
    scene: &'a Scene,
    ray: Ray,
    arrival: Arrival,
    w: &'a mut Wavelengths,
    sampler: &'a mut Sampler,
    tally: &'a mut Tally,
    first: Option<&'a mut FirstSurface>,
    found: PhantomData<C>,
}

impl<C: Collect> Work for Walk<'_, C> {
    type Output = C;

    #[inline(always)]
    fn run(self) -> C {
        let Self { tracer, scene, ray, arrival, w, sampler, tally, first, found: _ } = self;
        tracer.walk(scene, ray, arrival, w, sampler, tally, first)
    }
}

impl PathTracer {
    /// The path that begins with `ray`, the way in which the ray was chosen being `arrival`.
    #[inline(always)]
    fn walk<C: Collect>(
        &self,
        scene: &Scene,
        mut ray: Ray,
        mut arrival: Arrival,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        mut first: Option<&mut FirstSurface>,
    ) -> C {
        let mut found = C::default();
        let mut throughput = Sampled::<Unitless>::ONE;
        // Product of (ηt/ηi)² over refractions: roulette compares power, not radiance.
        let mut eta_scale = 1.0_f32;
        let mut widened = false;
        let mut depth = 0;
        tally.paths += 1;
        let Some(mut direction) = Dir::new(ray.d) else { return found };
        loop {
            tally.closest_rays += 1;
            let met = scene.intersect(&ray, f32::INFINITY);
            // By reference: hits and scattering functions are too large to be moved once more.
            let Some(hit) = &met else {
                for light in scene.infinite_lights() {
                    let escaped = match arrival {
                        Arrival::Only => scene.escaped(light, direction, w),
                        Arrival::Scattered { density, .. } => {
                            let light = scene.escaped_with_density(light, direction, w);
                            light.radiance * power_heuristic(density, light.density)
                        }
                    };
                    found.collect(depth, throughput * escaped);
                }
                break;
            };
            let wo = -direction;
            tally.vertices += 1;
            if let Some(emitter) = hit.emitter {
                let emitted = scene.emitted(emitter, &hit.point, wo, w);
                if !emitted.is_zero() {
                    let weight =
                        arrival.weight(|from| scene.emitter_density(emitter, from, direction, &hit.point));
                    found.collect(depth, throughput * emitted * weight);
                }
            }
            let ends_here = depth >= self.max_depth && !scene.passes_straight(hit);
            if ends_here && first.is_none() {
                break;
            }
            let mut shaded = scene.shade(hit, wo, w, sampler.hash_seed());
            let Some(bsdf) = &mut shaded else {
                // No optical interface: the path goes straight on and does not count a bounce.
                ray = hit.point.p.spawn(hit.point.ng, direction, ray.time);
                continue;
            };
            if let Some(first) = first.take() {
                first.surface =
                    Some(VisibleSurface { point: hit.point, seen_from: ray.o, albedo: albedo(bsdf, wo) });
            }
            if self.regularize && widened {
                bsdf.regularize();
            }
            if ends_here {
                break;
            }
            depth += 1;
            let from = reference(&hit.point, bsdf, wo);
            if bsdf.lobes().is_continuous() {
                let direct = sample_direct(scene, &from, bsdf, wo, w, sampler, tally);
                found.collect(depth, throughput * direct);
            }
            let Some(scattered) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d(), Mode::Radiance)
            else {
                break;
            };
            throughput *= scattered.weight;
            widened |= scattered.lobe != Lobe::Specular;
            if scattered.side == Side::Transmission {
                eta_scale *= scattered.eta * scattered.eta;
            }
            arrival = match scattered.density {
                Density::Delta => Arrival::Only,
                Density::SolidAngle(density) => Arrival::Scattered { from, density },
            };
            direction = scattered.wi;
            ray = hit.point.p.spawn(hit.point.ng, direction, ray.time);
            // Survival in proportion to what the path still carries; exact in expectation (Arvo & Kirk 1990).
            let carried = (throughput * eta_scale).max();
            if !(carried > 0.0) {
                break;
            }
            if carried < 1.0 && depth > WHOLE_BOUNCES {
                if sampler.next_1d() >= carried {
                    tally.roulette_ends += 1;
                    break;
                }
                throughput = throughput / carried;
            }
        }
        found
    }
}

/// One light sample, A (30): irradiance that a sensor receives from a light.
fn light_at_sensor(
    scene: &Scene,
    from: &ReferencePoint,
    sensor: &SensorPoint,
    w: &Wavelengths,
    sampler: &mut Sampler,
    tally: &mut Tally,
) -> Sampled<Irradiance> {
    let (u_light, u) = (sampler.next_1d(), sampler.next_2d());
    let Some(light) = scene.sample_light(from, u_light, u, w) else { return Sampled::ZERO };
    let cos = sensor.n.dot(*light.wi);
    if cos <= 0.0 || light.radiance.is_zero() {
        return Sampled::ZERO;
    }
    tally.shadow_rays += 1;
    if scene.is_occluded(from, &light.target, light.wi) {
        return Sampled::ZERO;
    }
    let weight = match light.density {
        Density::Delta => cos,
        Density::SolidAngle(density) => {
            let other = PdfSolidAngle(cosine_hemisphere_pdf(cos));
            cos / density.0 * power_heuristic(density, other)
        }
    };
    (light.radiance * weight).cast()
}

/// One light sample, A (31): radiance that reaches the point from a light and is scattered towards `wo`.
#[inline(always)]
fn sample_direct(
    scene: &Scene,
    from: &ReferencePoint,
    bsdf: &SurfaceBsdf,
    wo: Dir,
    w: &Wavelengths,
    sampler: &mut Sampler,
    tally: &mut Tally,
) -> Sampled<Radiance> {
    let (u_light, u) = (sampler.next_1d(), sampler.next_2d());
    let Some(light) = scene.sample_light(from, u_light, u, w) else { return Sampled::ZERO };
    let Evaluation { f, pdf } = bsdf.evaluate(wo, light.wi, Mode::Radiance);
    if f.is_zero() || light.radiance.is_zero() {
        return Sampled::ZERO;
    }
    tally.shadow_rays += 1;
    if scene.is_occluded(from, &light.target, light.wi) {
        return Sampled::ZERO;
    }
    let cos = bsdf.n().dot(*light.wi).abs();
    match light.density {
        // The chance of having picked this light is already divided out of a delta light's sample.
        Density::Delta => f.reflect(light.radiance, cos, PdfSolidAngle(1.0)),
        Density::SolidAngle(density) => {
            f.reflect(light.radiance, cos * power_heuristic(density, pdf), density)
        }
    }
}
