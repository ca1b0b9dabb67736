//! From film positions in pixels to the screen plane on which projections are defined.

use super::contract::CameraError;
use crate::math::Vec2;

/// The rectangle of the screen plane that the film shows, y upwards.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    top_left: Vec2,
    /// Screen units per pixel; y is negative, because rows run downwards.
    per_pixel: Vec2,
    resolution: [u32; 2],
}

impl Screen {
    /// The screen of a film of `resolution` pixels.
    ///
    /// Without `window` = [x min, x max, y min, y max] the shorter side spans [−1, 1] and the longer one follows from
    /// `aspect` (width over height, by default that of the resolution). Fails on an empty film or window.
    pub fn new(
        resolution: [u32; 2],
        aspect: Option<f32>,
        window: Option<[f32; 4]>,
    ) -> Result<Self, CameraError> {
        let [width, height] = resolution;
        if width == 0 || height == 0 {
            return Err(CameraError::EmptyFilm);
        }
        let aspect = aspect.unwrap_or(width as f32 / height as f32);
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(CameraError::Aspect(aspect));
        }
        let half = if aspect > 1.0 { Vec2::new(aspect, 1.0) } else { Vec2::new(1.0, 1.0 / aspect) };
        let [x0, x1, y0, y1] = window.unwrap_or([-half.x, half.x, -half.y, half.y]);
        if x0 == x1 || y0 == y1 || ![x0, x1, y0, y1].iter().all(|v| v.is_finite()) {
            return Err(CameraError::Window([x0, x1, y0, y1]));
        }
        let per_pixel = Vec2::new((x1 - x0) / width as f32, (y0 - y1) / height as f32);
        Ok(Self { top_left: Vec2::new(x0, y1), per_pixel, resolution })
    }

    /// Position on the screen plane of a film position [px].
    pub fn at(&self, film: Vec2) -> Vec2 {
        self.top_left + film * self.per_pixel
    }

    /// Film size [px].
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }
}
