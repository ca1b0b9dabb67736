//! Colour triples and chromaticities.

use crate::math::Vec3;
use std::ops::{Add, Mul};

/// Linear RGB; the colour space is known from context.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rgb(pub Vec3);

/// CIE 1931 tristimulus values; Y is a luminance or a luminous reflectance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Xyz(pub Vec3);

impl Rgb {
    /// From red, green and blue.
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self(Vec3::new(r, g, b))
    }

    /// The largest component.
    pub fn max(self) -> f32 {
        self.0.max_element()
    }
}

impl Xyz {
    /// From X, Y and Z.
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self(Vec3::new(x, y, z))
    }

    /// x = X/(X+Y+Z), y = Y/(X+Y+Z); `None` for black, which has no chromaticity.
    pub fn chromaticity(self) -> Option<Chromaticity> {
        let sum = self.0.element_sum();
        (sum != 0.0).then(|| Chromaticity { x: self.0.x / sum, y: self.0.y / sum })
    }
}

impl Add for Rgb {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl Mul<f32> for Rgb {
    type Output = Self;
    fn mul(self, rhs: f32) -> Self {
        Self(self.0 * rhs)
    }
}

impl Add for Xyz {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl Mul<f32> for Xyz {
    type Output = Self;
    fn mul(self, rhs: f32) -> Self {
        Self(self.0 * rhs)
    }
}

/// A point of the CIE 1931 chromaticity diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticity {
    /// x.
    pub x: f32,
    /// y.
    pub y: f32,
}

impl Chromaticity {
    /// From x and y.
    pub const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }

    /// The tristimulus values of this chromaticity with luminance `luminance`; black if y = 0.
    pub fn with_luminance(self, luminance: f32) -> Xyz {
        if self.y == 0.0 {
            return Xyz::default();
        }
        let scale = luminance / self.y;
        Xyz::new(self.x * scale, luminance, (1.0 - self.x - self.y) * scale)
    }
}
