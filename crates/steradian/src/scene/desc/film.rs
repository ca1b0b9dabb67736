//! The film and the pixel filter as the scene states them.

use crate::color::ColorSpaceKind;
use crate::scene::source::Span;

/// The film.
#[derive(Clone, Debug)]
pub struct FilmDesc {
    /// What it records.
    pub kind: FilmKind,
    /// Width and height [pixels] (1280 × 720), each ≥ 1.
    pub resolution: [u32; 2],
    /// The part that is rendered, as fractions x0, x1, y0, y1 in [0,1] (all).
    pub crop_window: Option<[f32; 4]>,
    /// The part that is rendered, in pixels x0, x1, y0, y1 with exclusive ends, inside the resolution.
    pub pixel_bounds: Option<[u32; 4]>,
    /// Name of the picture file (`pbrt.exr`), relative to the working folder.
    pub filename: String,
    /// Length of the film's diagonal [mm] (35), > 0.
    pub diagonal_mm: f32,
    /// How radiance becomes RGB.
    pub sensor: SensorDesc,
    /// Largest component of a sample that is recorded; `None` for no limit.
    pub max_component_value: Option<f32>,
    /// Whether the file holds half floats (true).
    pub save_fp16: bool,
    /// The colour space of the output, in force at the directive.
    pub color_space: ColorSpaceKind,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// What the film records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilmKind {
    /// RGB.
    Rgb,
    /// RGB and geometric quantities.
    GBuffer {
        /// Space of positions and normals (camera).
        space: GBufferSpace,
    },
    /// RGB and wavelength bins.
    Spectral {
        /// Number of bins (16), ≥ 1.
        n_buckets: u32,
        /// Shortest wavelength [nm] (360).
        lambda_min: f32,
        /// Longest wavelength [nm] (830), > shortest.
        lambda_max: f32,
    },
}

/// The space of geometric quantities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GBufferSpace {
    /// Camera space.
    Camera,
    /// World space.
    World,
}

/// How radiance becomes RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorDesc {
    /// Spectral response (CIE 1931 observer).
    pub response: SensorResponse,
    /// Exposure index (100).
    pub iso: f32,
    /// Colour temperature that is rendered white [K]; `None` leaves colours as they are (none).
    pub white_balance: Option<f32>,
}

/// Spectral response of a sensor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SensorResponse {
    /// The CIE 1931 observer.
    Cie1931,
    /// A camera body known by name.
    Camera(String),
}

/// The pixel filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterDesc {
    /// Its shape.
    pub kind: FilterKind,
    /// Half width along x and y [pixels], > 0.
    pub radius: [f32; 2],
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

/// The kinds of filter; defaults in parentheses, first of them the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterKind {
    /// Constant (0.5).
    Box,
    /// Tent (2).
    Triangle,
    /// Gaussian, shifted to reach zero at the radius (1.5).
    Gaussian {
        /// Standard deviation [pixels] (0.5), > 0.
        sigma: f32,
    },
    /// Mitchell–Netravali (2).
    Mitchell {
        /// Blur (1/3).
        b: f32,
        /// Ringing (1/3).
        c: f32,
    },
    /// Sinc windowed by the main lobe of a wider sinc (4).
    Sinc {
        /// Number of lobes (3), > 0.
        tau: f32,
    },
}
