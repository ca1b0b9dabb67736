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
    /// How radiance becomes RGB.
    pub sensor: SensorDesc,
    /// Largest component of a sample that is recorded; `None` for no limit.
    pub max_component_value: Option<f32>,
    /// The colour space of the output, in force at the directive.
    pub color_space: ColorSpaceKind,
    /// The directive, or the start of the file when there is none.
    pub span: Span,
}

impl FilmDesc {
    /// The pixels that are rendered, x0, x1, y0, y1 with exclusive ends. Each edge of a crop window is rounded up, so that
    /// adjacent windows tile the film; a narrow one may contain no pixel.
    pub fn window(&self) -> [u32; 4] {
        let [width, height] = self.resolution;
        let edge = |fraction: f32, side: u32| (fraction.clamp(0.0, 1.0) * side as f32).ceil() as u32;
        let [x0, x1, y0, y1] = self.crop_window.unwrap_or([0.0, 1.0, 0.0, 1.0]);
        let crop = [edge(x0, width), edge(x1, width), edge(y0, height), edge(y1, height)];
        let b = self.pixel_bounds.unwrap_or([0, width, 0, height]);
        [crop[0].max(b[0]), crop[1].min(b[1]), crop[2].max(b[2]), crop[3].min(b[3])]
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::files::FileBytes;
    use crate::scene::source::SourceMap;
    use std::sync::Arc;

    #[test]
    fn adjacent_crops_meet_without_gap_or_overlap() {
        let file = SourceMap::new().add("film", Arc::new(FileBytes::Owned(Vec::new())), None);
        let sensor = SensorDesc { response: SensorResponse::Cie1931, iso: 100.0, white_balance: None };
        for width in [7, 100, 1281] {
            let mut film = FilmDesc {
                kind: FilmKind::Rgb,
                resolution: [width, 1],
                crop_window: None,
                pixel_bounds: None,
                filename: String::new(),
                sensor: sensor.clone(),
                max_component_value: None,
                color_space: ColorSpaceKind::Srgb,
                span: Span { file, start: 0, len: 0 },
            };
            assert_eq!(film.window(), [0, width, 0, 1]);
            let cuts = [0.0, 0.1, 0.37, 0.5, 0.99, 1.0];
            let mut next = 0;
            for pair in cuts.windows(2) {
                film.crop_window = Some([pair[0], pair[1], 0.0, 1.0]);
                let [x0, x1, ..] = film.window();
                assert_eq!(x0, next);
                next = x1;
            }
            assert_eq!(next, width);
            film.pixel_bounds = Some([1, 5, 0, 1]);
            film.crop_window = Some([0.5, 1.0, 0.0, 1.0]);
            assert_eq!(film.window(), [width.div_ceil(2), 5, 0, 1]);
        }
    }
}
