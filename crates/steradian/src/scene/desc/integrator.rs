//! The integrator and the acceleration structure as the scene states them.

use crate::scene::source::Span;

/// The integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratorDesc {
    /// The algorithm.
    pub kind: IntegratorKind,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// The algorithms; `max_depth` counts scattering events (5), defaults in parentheses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntegratorKind {
    /// Path tracing of surfaces.
    Path(PathDesc),
    /// Path tracing with media.
    VolPath(PathDesc),
    /// Textbook path tracing.
    SimplePath {
        /// Largest number of scattering events.
        max_depth: u32,
        /// Whether lights are sampled (true).
        sample_lights: bool,
        /// Whether BSDFs are sampled (true).
        sample_bsdf: bool,
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
        /// Paths that seed the chains (100 000).
        bootstrap_samples: u32,
        /// Markov chains (1000).
        chains: u32,
        /// Mutations per pixel (100).
        mutations_per_pixel: u32,
        /// Standard deviation of small steps (0.01).
        sigma: f32,
        /// Probability of a large step (0.3).
        large_step_probability: f32,
        /// Whether BSDFs are roughened after the first bounce (false).
        regularize: bool,
    },
    /// Stochastic progressive photon mapping.
    Sppm {
        /// Largest number of scattering events.
        max_depth: u32,
        /// Photons per pass; `None` takes one per pixel.
        photons_per_iteration: Option<u32>,
        /// Initial search radius [scene units] (1).
        radius: f32,
        /// Seed of the photons; `None` takes the one of the options.
        seed: Option<i32>,
    },
    /// Ambient occlusion.
    AmbientOcclusion {
        /// Whether directions are cosine-distributed (true).
        cos_sample: bool,
        /// Distance beyond which nothing occludes [scene units] (∞).
        max_distance: f32,
    },
}

/// Parameters of the path tracers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathDesc {
    /// Largest number of scattering events (5).
    pub max_depth: u32,
    /// Whether BSDFs are roughened after the first bounce (false).
    pub regularize: bool,
    /// How lights are chosen; `None` where the scene does not say (by power; pbrt-v4: bvh).
    pub light_sampler: Option<LightSamplerKind>,
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

/// The acceleration structure; its parameters are checked and otherwise left to the renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AcceleratorDesc {
    /// What the scene asks for (bvh).
    pub kind: AcceleratorKind,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// The kinds of acceleration structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AcceleratorKind {
    /// Bounding volume hierarchy.
    Bvh,
    /// k-d tree.
    KdTree,
}
