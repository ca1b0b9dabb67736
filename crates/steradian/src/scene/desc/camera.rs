//! The camera as the scene states it.

use super::id::Id;
use super::medium::MediumDesc;
use crate::math::AnimatedTransform;
use crate::scene::source::Span;

/// The camera.
#[derive(Clone, Debug)]
pub struct CameraDesc {
    /// What it is.
    pub kind: CameraKind,
    /// Placement; camera space is left-handed with x right, y up, z forward.
    pub world_from_camera: AnimatedTransform,
    /// Opening of the shutter [s] (0).
    pub shutter_open: f32,
    /// Closing of the shutter [s] (1), ≥ opening.
    pub shutter_close: f32,
    /// The medium around the camera.
    pub medium: Option<Id<MediumDesc>>,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// The kinds of camera; defaults in parentheses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraKind {
    /// Thin lens or pinhole.
    Perspective {
        /// Angle of view along the shorter side of the picture [degrees] (90), in (0, 180).
        fov: f32,
        /// Lens and screen.
        projection: ProjectionDesc,
    },
    /// Parallel projection.
    Orthographic {
        /// Lens and screen.
        projection: ProjectionDesc,
    },
    /// All directions.
    Spherical {
        /// How directions fill the picture (equal-area).
        mapping: SphericalMapping,
    },
}

/// Lens and screen of a projective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectionDesc {
    /// Radius of the lens [scene units] (0: pinhole), ≥ 0.
    pub lens_radius: f32,
    /// Distance of the plane in focus [scene units] (10⁶), > 0.
    pub focal_distance: f32,
    /// Width over height of the screen; `None` takes the film's.
    pub frame_aspect_ratio: Option<f32>,
    /// Screen window x0, x1, y0, y1; `None` takes −1..1 along the shorter side.
    pub screen_window: Option<[f32; 4]>,
}

/// How the sphere of directions fills a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphericalMapping {
    /// Equal-area octahedral.
    EqualArea,
    /// Latitude and longitude.
    Equirectangular,
}
