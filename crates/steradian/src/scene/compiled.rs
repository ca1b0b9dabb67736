//! The scene as light transport sees it: immutable, resolved, shared by all threads.

use crate::accel::{Accel, Candidate};
use crate::camera::Camera;
use crate::light::{Emitter, Escaped, Light, LightId, LightSampler, LightTarget};
use crate::material::{MaterialId, Materials, SurfaceBsdf};
use crate::math::{Dir, Footprint, Ray, SurfacePoint, Vec2, hash};
use crate::shape::{ReferencePoint, Shape, ShapeId};
use crate::spectrum::{Sampled, Wavelengths};
use crate::texture::{FloatInput, TextureContext, Textures};
use crate::units::{Density, PdfSolidAngle, Radiance};

/// What a shape carries besides its geometry.
#[derive(Clone, Debug)]
pub struct ShapeAttributes {
    /// How it scatters.
    pub material: MaterialId,
    /// What it emits.
    pub light: Option<LightId>,
    /// Chance that a ray meets it at all, in [0, 1]; a cut-out where it is textured with 0 and 1.
    pub alpha: FloatInput,
}

/// A compiled scene. Lengths are scene units in render space.
#[derive(Debug)]
pub struct Scene {
    pub(super) shapes: Vec<Shape>,
    pub(super) attributes: Vec<ShapeAttributes>,
    pub(super) accel: Accel,
    pub(super) textures: Textures,
    pub(super) materials: Materials,
    pub(super) lights: Vec<Light>,
    pub(super) light_sampler: LightSampler,
    pub(super) camera: Camera,
    pub(super) footprint_samples: Option<u32>,
}

/// A surface that a ray met.
#[derive(Clone, Copy, Debug)]
pub struct SceneHit {
    /// The point.
    pub point: SurfacePoint,
    /// How it scatters.
    pub material: MaterialId,
    /// What it emits, where it does.
    pub emitter: Option<Emitter>,
}

/// Light that reaches a point from a light that was chosen at random.
#[derive(Clone, Copy, Debug)]
pub struct SceneLightSample {
    /// Direction to the light.
    pub wi: Dir,
    /// Radiance along `wi`; for a delta light its irradiance on a perpendicular plane, divided by the chance of choosing it.
    pub radiance: Sampled<Radiance>,
    /// Density of `wi`, the choice of the light included.
    pub density: Density,
    /// Where the light is, for the shadow ray.
    pub target: LightTarget,
}

impl Scene {
    /// The first surface along the ray within `t_max` of its lengths.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<SceneHit> {
        let hit = self.accel.intersect(ray, t_max, &|c: &Candidate| self.admits(ray, c))?;
        let point = self.accel.surface(ray, &hit, &self.shapes);
        let attributes = &self.attributes[hit.shape.0 as usize];
        let emitter = attributes.light.map(|light| Emitter { light, prim: hit.prim });
        Some(SceneHit { point, material: attributes.material, emitter })
    }

    /// Whether something stands between a point and a light.
    #[inline(always)]
    pub fn is_occluded(&self, from: &ReferencePoint, target: &LightTarget, wi: Dir) -> bool {
        let (ray, t_max) = match target {
            LightTarget::Infinite => (from.spawn(wi), f32::INFINITY),
            LightTarget::Point { p, n } => (from.spawn_to(p, *n), 1.0 - SHADOW_MARGIN),
        };
        if ray.d.length_squared() == 0.0 {
            return false;
        }
        self.accel.occluded(&ray, t_max, &|c: &Candidate| {
            !self.materials.is_interface(self.attributes[c.shape.0 as usize].material) && self.admits(&ray, c)
        })
    }

    /// Whether there is no optical interface at a hit.
    #[inline]
    pub fn passes_straight(&self, hit: &SceneHit) -> bool {
        self.materials.is_interface(hit.material)
    }

    /// The scattering function at a hit; `None` where there is no optical interface.
    ///
    /// `seed` decides the random walks of layered materials.
    #[inline(always)]
    pub fn shade(&self, hit: &SceneHit, wo: Dir, w: &mut Wavelengths, seed: u64) -> Option<SurfaceBsdf<'_>> {
        let used = self.materials.needs_footprint(hit.material);
        let footprint = if used { self.footprint(&hit.point) } else { Footprint::ZERO };
        self.materials.shade(hit.material, &hit.point, &footprint, wo, &self.textures, w, seed)
    }

    /// Radiance that an emitter sends from a point of its surface towards `wo`.
    pub fn emitted(&self, e: Emitter, point: &SurfacePoint, wo: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        self.lights[e.light.0 as usize].emitted(point, wo, w)
    }

    /// Density per solid angle with which [`Scene::sample_light`] finds a point of an emitter along `wi`.
    #[inline(always)]
    pub fn emitter_density(
        &self,
        e: Emitter,
        from: &ReferencePoint,
        wi: Dir,
        hit: &SurfacePoint,
    ) -> PdfSolidAngle {
        let p = self.light_sampler.probability_at(from, e);
        PdfSolidAngle(p * self.lights[e.light.0 as usize].hit_density(from, &self.shapes, e.prim, wi, hit).0)
    }

    /// The lights that surround the scene.
    pub fn infinite_lights(&self) -> impl Iterator<Item = LightId> + '_ {
        self.light_sampler.infinite().iter().copied()
    }

    /// Radiance that arrives from an infinite light along a ray that left the scene in `direction`.
    pub fn escaped(&self, light: LightId, direction: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        self.lights[light.0 as usize].escaped(direction, w)
    }

    /// [`Scene::escaped`] with the density per solid angle with which [`Scene::sample_light`] finds `direction` by that light.
    pub fn escaped_with_density(&self, light: LightId, direction: Dir, w: &Wavelengths) -> Escaped {
        let Escaped { radiance, density } = self.lights[light.0 as usize].escaped_with_density(direction, w);
        let p = self.light_sampler.probability(Emitter { light, prim: 0 });
        Escaped { radiance, density: PdfSolidAngle(p * density.0) }
    }

    /// One light, chosen at random, and a direction to it.
    #[inline(always)]
    pub fn sample_light(
        &self,
        from: &ReferencePoint,
        u_light: f32,
        u: Vec2,
        w: &Wavelengths,
    ) -> Option<SceneLightSample> {
        let chosen = self.light_sampler.sample_at(from, u_light)?;
        let light = &self.lights[chosen.emitter.light.0 as usize];
        let s = light.sample(from, &self.shapes, chosen.emitter.prim, u, w)?;
        let (radiance, density) = match s.density {
            Density::Delta => (s.radiance / chosen.probability, Density::Delta),
            Density::SolidAngle(d) => {
                (s.radiance, Density::SolidAngle(PdfSolidAngle(d.0 * chosen.probability)))
            }
        };
        Some(SceneLightSample { wi: s.wi, radiance, density, target: s.target })
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The lights.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The shapes.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The materials.
    pub fn materials(&self) -> &Materials {
        &self.materials
    }

    /// The textures.
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    /// The same scene, whose rays and paths use the target's baseline instructions only.
    #[must_use]
    pub fn portable(mut self) -> Self {
        self.accel = self.accel.portable();
        self
    }

    /// The acceleration structure.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }

    /// What the shape of that id carries.
    pub fn attributes(&self, id: ShapeId) -> Option<&ShapeAttributes> {
        self.attributes.get(id.0 as usize)
    }

    /// How a surface point moves per pixel, as if seen directly.
    pub fn footprint(&self, point: &SurfacePoint) -> Footprint {
        let Some(samples) = self.footprint_samples else { return Footprint::ZERO };
        let motion = self.camera.approximate_footprint(point.p.p, point.ng, point.time, samples);
        Footprint::project(motion.dpdx, motion.dpdy, point.dpdu, point.dpdv)
    }

    /// Whether a ray that geometrically hits a candidate is stopped by it: always at alpha 1, never at 0,
    /// and in between by a fixed pseudo-random rule.
    fn admits(&self, ray: &Ray, candidate: &Candidate) -> bool {
        let alpha = match self.attributes[candidate.shape.0 as usize].alpha {
            FloatInput::Constant(alpha) => alpha,
            FloatInput::Texture(texture) => {
                let point = self.accel.surface(ray, candidate, &self.shapes);
                let context = TextureContext { point: &point, footprint: &Footprint::ZERO };
                self.textures.float(texture, &context)
            }
        };
        if alpha >= 1.0 {
            return true;
        }
        let place = [ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z, candidate.t];
        alpha > 0.0 && hash::to_unit(hash::hash_floats(&place)) < alpha
    }
}

/// Shadow rays to a point of a surface stop short by this fraction (pbrt-v4's ShadowEpsilon): the end of the ray is moved off the
/// surface by its error bound, and this margin covers the rounding of the ray parameter itself.
const SHADOW_MARGIN: f32 = 1e-4;
