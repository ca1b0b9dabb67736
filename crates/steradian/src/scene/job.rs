//! Everything that one render needs: the compiled scene and the settings around it.

use super::compiled::Scene;
use super::desc::{FilmDesc, FilterDesc, NoiseTarget};
use crate::color::ColorSpace;
use crate::light::Light;
use crate::math::Transform;
use crate::sampler::SamplerKind;

/// A compiled scene with its settings.
#[derive(Debug)]
pub struct RenderJob {
    /// The scene.
    pub scene: Scene,
    /// What is recorded.
    pub film: FilmDesc,
    /// The colour space of the output.
    pub output_space: ColorSpace,
    /// The pixel filter.
    pub filter: FilterDesc,
    /// Sample points.
    pub sampling: Sampling,
    /// How radiance is found.
    pub integrator: IntegratorSettings,
    /// From the space in which rays are traced to the scene's world.
    pub world_from_render: Transform,
    /// Length of a scene unit [m].
    pub meters_per_unit: f32,
    /// Hash of the scene's text, for the image's metadata.
    pub scene_hash: u64,
}

/// Where samples are taken.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Family of points.
    pub kind: SamplerKind,
    /// Samples per pixel, ≥ 1; the most that a pixel gets where a noise is aimed at.
    pub spp: u32,
    /// The noise to aim at; `None` gives every pixel the same number of samples.
    pub noise: Option<NoiseTarget>,
    /// Seed.
    pub seed: u64,
    /// Whether samples are spread by the pixel filter or lie at pixel centres.
    pub pixel_jitter: Jitter,
    /// Whether wavelengths differ between samples.
    pub wavelength_jitter: Jitter,
}

/// Whether a sample dimension is random.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jitter {
    /// Random.
    On,
    /// Fixed at its middle.
    Off,
}

/// How radiance is found.
#[derive(Clone, Debug)]
pub enum IntegratorSettings {
    /// By tracing paths.
    Path(PathSettings),
    /// By legacy shading, A (34)–(40).
    Classic(ClassicSettings),
}

impl IntegratorSettings {
    /// What it is, for people and for the picture's metadata.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Path(_) => "path",
            Self::Classic(_) => "classic (legacy shading, not light transport)",
        }
    }
}

/// Settings of the legacy shading.
#[derive(Clone, Debug)]
pub struct ClassicSettings {
    /// Uniform surroundings, whose radiance is Ia of A (36).
    pub ambient: Option<Box<Light>>,
    /// Whether surfaces cast shadows.
    pub shadows: bool,
}

/// Settings of the path tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathSettings {
    /// Most bounces.
    pub max_depth: u32,
    /// Whether narrow lobes are widened after the first wide one (biased).
    pub regularize: bool,
}
