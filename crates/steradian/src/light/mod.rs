//! Light sources: what arrives at a point, from where, with which density; how much they emit; which to sample.

mod area;
mod bounds;
mod contract;
mod infinite;
mod normalise;
mod octahedral;
pub mod photometric;
mod picture;
mod point;
mod selection;
mod sky;
mod tree;

pub use area::{AreaRadiance, DiffuseAreaLight, Sides};
pub use contract::{Emitter, Escaped, LightError, LightId, LightPower, LightSample, LightTarget};
pub use infinite::{DistantLight, ImageInfiniteLight, UniformInfiniteLight};
pub use normalise::{Amount, Emission, Stated, Total};
pub use octahedral::latlong_to_octahedral;
pub use photometric::{EmittingOpening, PhotometricLight};
pub use picture::EmissionPicture;
pub use point::{GoniometricLight, PointLight, ProjectionLight, SpotLight};
pub use selection::{Chosen, LightSampler};
pub use sky::{
    Atmosphere, ClearSkyIrradiance, ClearSkySpectra, Compass, Daylight, GeneralSky, Ground, Handedness,
    Moment, MomentError, Place, SUN_ANGULAR_RADIUS, SkyIntegrals, SkyLight, SkyLuminance, SkyModel,
    SkyPlacement, SolarPosition, SunLight,
};

use bounds::EmitterBounds;
use selection::Candidate;

use crate::math::{Dir, Point, SurfacePoint, Vec2};
use crate::shape::{ReferencePoint, Shape};
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::{LUMENS_PER_WATT, PdfSolidAngle, Radiance};

/// A light source in render space.
#[derive(Clone, Debug)]
pub enum Light {
    /// A point that shines equally in all directions.
    Point(PointLight),
    /// A point that shines in a cone.
    Spot(SpotLight),
    /// Parallel light.
    Distant(DistantLight),
    /// A point with a measured distribution.
    Goniometric(Box<GoniometricLight>),
    /// A slide projector.
    Projection(Box<ProjectionLight>),
    /// A luminaire by its measured distribution.
    Photometric(Box<PhotometricLight>),
    /// A uniform sky all around.
    UniformInfinite(UniformInfiniteLight),
    /// An environment map.
    ImageInfinite(Box<ImageInfiniteLight>),
    /// A sky with its own distribution of luminance.
    Sky(Box<SkyLight>),
    /// The sun's disk.
    Sun(Box<SunLight>),
    /// An emitting shape.
    DiffuseArea(DiffuseAreaLight),
}

impl Light {
    /// Light that arrives at `from`, directly; `prim` is the primitive of an emitting shape, `u` ∈ [0, 1)².
    ///
    /// `None` when nothing arrives for this `u`. Occlusion is the caller's to test.
    #[inline(always)]
    pub fn sample(
        &self,
        from: &ReferencePoint,
        shapes: &[Shape],
        prim: u32,
        u: Vec2,
        w: &Wavelengths,
    ) -> Option<LightSample> {
        match self {
            Self::DiffuseArea(l) => l.sample(from, shapes, prim, u, w),
            _ => self.sample_rarer(from, shapes, prim, u, w),
        }
    }

    /// Out of line, so that emitting shapes have the caller's loop for themselves.
    #[inline(never)]
    fn sample_rarer(
        &self,
        from: &ReferencePoint,
        shapes: &[Shape],
        prim: u32,
        u: Vec2,
        w: &Wavelengths,
    ) -> Option<LightSample> {
        match self {
            Self::Point(l) => l.sample(from, w),
            Self::Spot(l) => l.sample(from, w),
            Self::Distant(l) => l.sample(w),
            Self::Goniometric(l) => l.sample(from, w),
            Self::Projection(l) => l.sample(from, w),
            Self::Photometric(l) => l.sample(from, u, w),
            Self::UniformInfinite(l) => l.sample(u, w),
            Self::ImageInfinite(l) => l.sample(u, w),
            Self::Sky(l) => l.sample(u, w),
            Self::Sun(l) => l.sample(u, w),
            Self::DiffuseArea(l) => l.sample(from, shapes, prim, u, w),
        }
    }

    /// Density with which [`Light::sample`] finds the direction `wi` at `from` that runs into `hit` on primitive `prim`
    /// of this light's shape; zero for lights without one.
    pub fn hit_density(
        &self,
        from: &ReferencePoint,
        shapes: &[Shape],
        prim: u32,
        wi: Dir,
        hit: &SurfacePoint,
    ) -> PdfSolidAngle {
        match self {
            Self::DiffuseArea(l) => l.density(from, shapes, prim, wi, hit),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projection(_)
            | Self::Photometric(_)
            | Self::UniformInfinite(_)
            | Self::ImageInfinite(_)
            | Self::Sky(_)
            | Self::Sun(_) => PdfSolidAngle(0.0),
        }
    }

    /// Density with which [`Light::sample`] finds a direction that leaves the scene; zero for lights of which a ray
    /// cannot run into the infinite.
    pub fn escape_density(&self, wi: Dir) -> PdfSolidAngle {
        match self {
            Self::UniformInfinite(l) => l.density(),
            Self::ImageInfinite(l) => l.density(wi),
            Self::Sky(l) => l.density(wi),
            Self::Sun(l) => l.density(wi),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projection(_)
            | Self::Photometric(_)
            | Self::DiffuseArea(_) => PdfSolidAngle(0.0),
        }
    }

    /// [`Light::escaped`] and [`Light::escape_density`] at once: a picture has to be looked up but once.
    pub fn escaped_with_density(&self, wi: Dir, w: &Wavelengths) -> Escaped {
        match self {
            Self::ImageInfinite(l) => l.escaped_with_density(wi, w),
            _ => Escaped { radiance: self.escaped(wi, w), density: self.escape_density(wi) },
        }
    }

    /// Radiance that leaves a point of this light's shape towards `wo`; zero for other lights.
    pub fn emitted(&self, point: &SurfacePoint, wo: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        match self {
            Self::DiffuseArea(l) => l.radiance(point.ng, point.uv, wo, w),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projection(_)
            | Self::Photometric(_)
            | Self::UniformInfinite(_)
            | Self::ImageInfinite(_)
            | Self::Sky(_)
            | Self::Sun(_) => Sampled::ZERO,
        }
    }

    /// Radiance that arrives along a ray which leaves the scene in direction `wi`; zero for lights that no ray can meet.
    pub fn escaped(&self, wi: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        match self {
            Self::UniformInfinite(l) => l.escaped(w),
            Self::ImageInfinite(l) => l.escaped(wi, w),
            Self::Sky(l) => l.escaped(wi, w),
            Self::Sun(l) => l.escaped(wi, w),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projection(_)
            | Self::Photometric(_)
            | Self::DiffuseArea(_) => Sampled::ZERO,
        }
    }

    /// Total output, of lights at infinity what enters a sphere of `scene_radius` [scene units] around the scene; in the
    /// units of [`LightPower`] where a scene unit is a metre, else to be multiplied by the square of its length.
    pub fn power(&self, scene_radius: f32) -> LightPower {
        match self {
            Self::Point(l) => l.power(),
            Self::Spot(l) => l.power(),
            Self::Distant(l) => l.power(scene_radius),
            Self::Goniometric(l) => l.power(),
            Self::Projection(l) => l.power(),
            Self::Photometric(l) => l.power(),
            Self::UniformInfinite(l) => l.power(scene_radius),
            Self::ImageInfinite(l) => l.power(scene_radius),
            Self::Sky(l) => l.power(scene_radius),
            Self::Sun(l) => l.power(scene_radius),
            Self::DiffuseArea(l) => l.power(),
        }
    }

    /// Name of the kind in scene files.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Point(_) => "point",
            Self::Spot(_) => "spot",
            Self::Distant(_) => "distant",
            Self::Goniometric(_) => "goniometric",
            Self::Projection(_) => "projection",
            Self::Photometric(_) => "photometric",
            Self::UniformInfinite(_) | Self::ImageInfinite(_) => "infinite",
            Self::Sky(_) => "sky",
            Self::Sun(_) => "sun",
            Self::DiffuseArea(_) => "diffuse area",
        }
    }

    /// Whether the light comes from single directions, so that no scattered ray can run into it.
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projection(_)
            | Self::Photometric(_) => true,
            Self::UniformInfinite(_)
            | Self::ImageInfinite(_)
            | Self::Sky(_)
            | Self::Sun(_)
            | Self::DiffuseArea(_) => false,
        }
    }

    /// Where each emitter of the light is and shines, the light's power being `power`; none for lights without a place.
    fn bounds(&self, shapes: &[Shape], power: f32) -> Vec<EmitterBounds> {
        match self {
            Self::DiffuseArea(l) => match shapes.get(l.shape().0 as usize) {
                Some(shape) => (0..shape.prim_count()).map(|prim| l.bounds(shape, prim, power)).collect(),
                None => Vec::new(),
            },
            Self::Point(l) => vec![l.bounds(power)],
            Self::Spot(l) => vec![l.bounds(power)],
            Self::Goniometric(l) => vec![l.bounds(power)],
            Self::Projection(l) => vec![l.bounds(power)],
            Self::Photometric(l) => vec![l.bounds(power)],
            Self::Distant(_)
            | Self::UniformInfinite(_)
            | Self::ImageInfinite(_)
            | Self::Sky(_)
            | Self::Sun(_) => Vec::new(),
        }
    }

    /// Where the light that shines from a point, or from one of those that `u` ∈ [0, 1)² chooses, is, in render space; `None`
    /// for lights that rays can meet or that are infinitely far away.
    pub fn place(&self, u: Vec2) -> Option<Point> {
        match self {
            Self::Point(l) => Some(l.position()),
            Self::Spot(l) => Some(l.position()),
            Self::Goniometric(l) => Some(l.position()),
            Self::Projection(l) => Some(l.position()),
            Self::Photometric(l) => Some(l.place(u)),
            Self::Distant(_)
            | Self::UniformInfinite(_)
            | Self::ImageInfinite(_)
            | Self::Sky(_)
            | Self::Sun(_)
            | Self::DiffuseArea(_) => None,
        }
    }

    /// Where the zenith of a sky is, in render space; `None` for lights without one.
    pub fn zenith(&self) -> Option<Dir> {
        match self {
            Self::Sky(sky) => Some(sky.up()),
            _ => None,
        }
    }

    /// Whether the light has no place in the scene.
    pub fn is_infinite(&self) -> bool {
        matches!(
            self,
            Self::Distant(_)
                | Self::UniformInfinite(_)
                | Self::ImageInfinite(_)
                | Self::Sky(_)
                | Self::Sun(_)
        )
    }
}

/// What [`LightSampler::sample_at`] takes into account.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Selection {
    /// Every emitter alike.
    Uniform,
    /// Power alone.
    Power,
    /// Power, distance and orientation.
    Position,
}

impl LightSampler {
    /// A selection among all lights of a scene. `shapes` are those that area lights refer to.
    pub fn for_scene(lights: &[Light], shapes: &[Shape], scene_radius: f32, selection: Selection) -> Self {
        Self::new(lights.iter().zip(0..).map(|(light, id)| {
            let power = light.power(scene_radius);
            // Luminance noise is what shows, but infrared light must be found as well: a twentieth for any watt.
            let power = power.lumens / LUMENS_PER_WATT + 0.05 * power.watts;
            let mut candidate = Candidate {
                light: LightId(id),
                infinite: light.is_infinite(),
                weights: vec![power],
                bounds: if selection == Selection::Position {
                    light.bounds(shapes, power)
                } else {
                    Vec::new()
                },
            };
            if let Light::DiffuseArea(l) = light
                && let Some(shape) = shapes.get(l.shape().0 as usize)
            {
                candidate.weights =
                    (0..shape.prim_count()).map(|p| power * shape.area(p) / l.area()).collect();
            }
            if selection == Selection::Uniform {
                candidate.weights.iter_mut().for_each(|w| *w = if *w > 0.0 { 1.0 } else { 0.0 });
            }
            candidate
        }))
    }

    /// [`LightSampler::for_scene`] by power alone.
    pub fn by_power(lights: &[Light], shapes: &[Shape], scene_radius: f32) -> Self {
        Self::for_scene(lights, shapes, scene_radius, Selection::Power)
    }
}

#[cfg(test)]
mod laws;
