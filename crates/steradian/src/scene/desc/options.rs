//! Settings of the `Option` directive.

/// Settings that belong to no entity; defaults in parentheses.
#[derive(Clone, Debug, PartialEq)]
pub struct OptionsDesc {
    /// Whether samples lie at pixel centres (false).
    pub disable_pixel_jitter: bool,
    /// Whether all pixels use the same wavelengths (false).
    pub disable_wavelength_jitter: bool,
    /// Whether textures are looked up at their finest level (false).
    pub disable_texture_filtering: bool,
    /// Whether every material is replaced by a diffuse one (false).
    pub force_diffuse: bool,
    /// Seed of the samplers (0).
    pub seed: i32,
    /// The space in which rays are traced (camera at the origin, world axes).
    pub rendering_space: RenderingSpace,
    /// Factor on the edge length of displaced meshes (1).
    pub displacement_edge_scale: f32,
    /// Length of a scene unit [m] (1), > 0; an extension of pbrt's vocabulary.
    pub meters_per_unit: f32,
}

impl Default for OptionsDesc {
    fn default() -> Self {
        Self {
            disable_pixel_jitter: false,
            disable_wavelength_jitter: false,
            disable_texture_filtering: false,
            force_diffuse: false,
            seed: 0,
            rendering_space: RenderingSpace::CameraWorld,
            displacement_edge_scale: 1.0,
            meters_per_unit: 1.0,
        }
    }
}

/// The space in which rays are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderingSpace {
    /// Camera space.
    Camera,
    /// World axes with the camera at the origin.
    CameraWorld,
    /// World space.
    World,
}
