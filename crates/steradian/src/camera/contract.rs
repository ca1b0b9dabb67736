//! What every camera promises: one ray per film, lens and time sample, or none.

use crate::math::{Ray, Vec2, Vec3};

/// What makes a camera impossible.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The film has no pixels.
    #[error("the film has no pixels")]
    EmptyFilm,
    /// Frame aspect ratio [1].
    #[error("frame aspect ratio must be positive, not {0}")]
    Aspect(f32),
    /// Screen window as [x min, x max, y min, y max].
    #[error("screen window {0:?} is empty")]
    Window([f32; 4]),
    /// Field of view [°].
    #[error("field of view must lie between 0 and 180 degrees, not {0}")]
    FieldOfView(f32),
    /// Lens radius [scene units].
    #[error("lens radius must not be negative, but is {0}")]
    LensRadius(f32),
    /// Focal distance [scene units].
    #[error("focal distance must be positive, not {0}")]
    FocalDistance(f32),
    /// Shutter times [s].
    #[error("shutter must open before it closes, not at {0:?}")]
    Shutter([f32; 2]),
}

/// Which ray is asked for.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// Position on the film [px].
    pub film: Vec2,
    /// Position on the aperture, in [0, 1)².
    pub lens: Vec2,
    /// Moment between shutter opening and closing, in [0, 1).
    pub time: f32,
}

/// A ray towards the scene and what it counts.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The ray in render space, its direction normalised, its time in seconds.
    pub ray: Ray,
    /// Sensor response over sampling density; 1 for the idealised cameras here.
    pub weight: f32,
}

/// How far a surface point moves when the film position moves by one pixel (before projection to uv).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    /// ∂p/∂x per pixel [scene units].
    pub dpdx: Vec3,
    /// ∂p/∂y per pixel [scene units].
    pub dpdy: Vec3,
}
