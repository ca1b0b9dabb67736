//! What every integrator promises: one unbiased estimate of the radiance along one camera ray; and what an integrator
//! promises that instruments can use: one of the irradiance at a sensor.

use crate::math::{BoundedPoint, Normal, Point, Ray, SurfacePoint};
use crate::sampler::Sampler;
use crate::scene::Scene;
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::kind::Irradiance;
use crate::units::{Radiance, Unitless};

/// Estimates incident radiance at the sensor, B (2.24).
pub trait Integrator: Sync {
    /// One estimate of the radiance that arrives along `ray`, at the wavelengths `w`; a dispersive path
    /// drops the companions of `w`.
    ///
    /// A pure function of the scene and of the sampler's pixel, index and seed. `first` receives the
    /// first visible surface when the film asks for it.
    fn radiance(
        &self,
        scene: &Scene,
        ray: Ray,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        first: Option<&mut FirstSurface>,
    ) -> Sampled<Radiance>;
}

/// An integrator whose answers are those of light transport, so that instruments can rely on it.
pub trait Metering: Integrator {
    /// One estimate of the irradiance, A (17), that a flat sensor with ideal cosine response receives from the hemisphere
    /// around its normal, at the wavelengths `w`; a dispersive path drops the companions of `w`.
    ///
    /// A pure function of the scene, the sensor, and the sampler's pixel, index and seed.
    fn irradiance(
        &self,
        scene: &Scene,
        sensor: &SensorPoint,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
    ) -> Arriving;
}

/// A point of a flat sensor, which is itself no obstacle for light.
#[derive(Clone, Copy, Debug)]
pub struct SensorPoint {
    /// Where, in render space; surfaces within the bound around it are taken to lie behind it.
    pub p: BoundedPoint,
    /// Which way it faces, in render space.
    pub n: Normal,
    /// When [s].
    pub time: f32,
}

/// Irradiance by the history of the light.
#[derive(Clone, Copy, Debug)]
pub struct Arriving {
    /// From the lights, past whatever lets it pass straight.
    pub direct: Sampled<Irradiance>,
    /// Scattered, reflected or refracted at least once.
    pub indirect: Sampled<Irradiance>,
}

/// What was done, counted per thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Rays traced to the closest hit.
    pub closest_rays: u64,
    /// Rays traced to any hit.
    pub shadow_rays: u64,
    /// Camera paths.
    pub paths: u64,
    /// Path vertices on surfaces.
    pub vertices: u64,
    /// Paths ended by Russian roulette.
    pub roulette_ends: u64,
}

impl Tally {
    /// All rays.
    pub fn rays(&self) -> u64 {
        self.closest_rays + self.shadow_rays
    }

    /// The sum of both.
    #[must_use]
    pub fn merge(self, other: Self) -> Self {
        Self {
            closest_rays: self.closest_rays + other.closest_rays,
            shadow_rays: self.shadow_rays + other.shadow_rays,
            paths: self.paths + other.paths,
            vertices: self.vertices + other.vertices,
            roulette_ends: self.roulette_ends + other.roulette_ends,
        }
    }
}

/// The first surface that a camera path meets, for auxiliary layers.
#[derive(Clone, Copy, Debug, Default)]
pub struct FirstSurface {
    /// The surface; `None` when the ray left the scene.
    pub surface: Option<VisibleSurface>,
}

/// A surface as the camera sees it.
#[derive(Clone, Copy, Debug)]
pub struct VisibleSurface {
    /// The point, in render space.
    pub point: SurfacePoint,
    /// Where the ray came from, in render space.
    pub seen_from: Point,
    /// Directional-hemispherical reflectance towards the camera, B (2.14), estimated.
    pub albedo: Sampled<Unitless>,
}
