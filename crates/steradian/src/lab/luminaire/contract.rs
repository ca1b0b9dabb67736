//! How a luminaire is measured, and what may be wrong with a scene as one.

/// How a luminaire is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuminaireSettings {
    /// Half planes all around, at equal distance from C = 0 on; 1 for the mean around the axis.
    pub planes: u32,
    /// Intervals of γ from 0 to 180°, at least 1.
    pub gamma_steps: u32,
    /// Direction of γ = 0 in the scene's world, of any length but 0.
    pub nadir: [f64; 3],
    /// A direction in the half plane C = 0, not parallel to the nadir. C counts from it counterclockwise as seen from above,
    /// that is against the nadir.
    pub c0: [f64; 3],
    /// Most bounces of light on its way from a source.
    pub max_depth: u32,
}

impl Default for LuminaireSettings {
    /// 24 planes and 36 intervals of 5°, nadir at −z and C0 at +x.
    fn default() -> Self {
        Self { planes: 24, gamma_steps: 36, nadir: [0.0, 0.0, -1.0], c0: [1.0, 0.0, 0.0], max_depth: 1000 }
    }
}

/// Why a scene is no luminaire that can be measured.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LuminaireError {
    /// The scene is for legacy shading.
    #[error(
        "the scene asks for integrator \"classic\", legacy shading that is no light transport: it cannot be measured"
    )]
    NotTransport,
    /// A light without a place.
    #[error(
        "the scene has a light \"{0}\", which is infinitely far away: a luminaire has all its lights in itself"
    )]
    AtInfinity(&'static str),
    /// The scene is dark.
    #[error("the scene has no light")]
    NoLight,
    /// Nadir or C0.
    #[error("the nadir and C0 must be two directions that are not parallel")]
    Axes,
    /// Number of planes or of intervals.
    #[error("a grid has 1 to 720 planes and 1 to 1800 intervals of γ, not {planes} and {gamma_steps}")]
    Grid {
        /// Planes.
        planes: u32,
        /// Intervals of γ.
        gamma_steps: u32,
    },
}
