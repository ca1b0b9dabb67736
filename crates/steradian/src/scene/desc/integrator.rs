//! The integrator as the scene states it.

use super::light::Normalization;
use super::value::SpectrumDesc;
use crate::scene::source::Span;

/// The integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegratorDesc {
    /// The algorithm.
    pub kind: IntegratorKind,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// The algorithms; `max_depth` counts scattering events (5), defaults in parentheses.
#[derive(Clone, Debug, PartialEq)]
pub enum IntegratorKind {
    /// Path tracing of surfaces.
    Path(PathDesc),
    /// Path tracing with media.
    VolPath(PathDesc),
    /// Textbook path tracing.
    SimplePath {
        /// Largest number of scattering events.
        max_depth: u32,
    },
    /// Textbook path tracing with media.
    SimpleVolPath {
        /// Largest number of scattering events.
        max_depth: u32,
    },
    /// Paths from the lights.
    LightPath {
        /// Largest number of scattering events.
        max_depth: u32,
    },
    /// Path tracing without light sampling.
    RandomWalk {
        /// Largest number of scattering events.
        max_depth: u32,
    },
    /// Bidirectional path tracing.
    Bdpt {
        /// Largest number of scattering events.
        max_depth: u32,
        /// Whether BSDFs are roughened after the first bounce (false).
        regularize: bool,
    },
    /// Metropolis light transport.
    Mlt {
        /// Largest number of scattering events.
        max_depth: u32,
        /// Whether BSDFs are roughened after the first bounce (false).
        regularize: bool,
    },
    /// Stochastic progressive photon mapping.
    Sppm {
        /// Largest number of scattering events.
        max_depth: u32,
    },
    /// Ambient occlusion.
    AmbientOcclusion,
    /// Legacy shading, A (34)–(40).
    Classic(ClassicDesc),
}

/// Parameters of the path tracers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathDesc {
    /// Largest number of scattering events (5).
    pub max_depth: u32,
    /// Whether BSDFs are roughened after the first bounce (false).
    pub regularize: bool,
    /// How lights are chosen; `None` where the scene does not say (bvh).
    pub light_sampler: Option<LightSamplerKind>,
}

/// Parameters of the legacy shading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClassicDesc {
    /// Radiance Ia of the uniform surroundings; `None` where there are none.
    pub ambient: Option<AmbientDesc>,
    /// Whether what stands between a surface and a light matters (false: the text knows no shadows).
    pub shadows: bool,
}

/// Uniform surroundings, A (36).
#[derive(Clone, Debug, PartialEq)]
pub struct AmbientDesc {
    /// Their radiance.
    pub radiance: SpectrumDesc,
    /// Factor on it (1).
    pub scale: f32,
    /// How amounts are meant.
    pub normalization: Normalization,
}

/// How lights are chosen for sampling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSamplerKind {
    /// By a hierarchy of estimated contributions.
    Bvh,
    /// Uniformly.
    Uniform,
    /// In proportion to power.
    Power,
    /// By estimating the contribution of every light.
    Exhaustive,
}
