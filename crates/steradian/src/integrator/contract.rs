//! What every integrator promises: one unbiased estimate of the radiance along one camera ray.

use crate::math::{Point, Ray, SurfacePoint};
use crate::sampler::Sampler;
use crate::scene::Scene;
use crate::spectrum::{Sampled, Wavelengths};
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
