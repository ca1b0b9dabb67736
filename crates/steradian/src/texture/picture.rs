//! Textures from pictures.

use super::filter::{Color, ImageFilter, Scalar, lookup};
use super::input::TextureContext;
use super::mapping::Mapping2d;
use crate::color::Rgb;
use crate::image::{Pyramid, Wrap};
use crate::math::Vec3;

/// A picture in the arena; several textures may share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageId(pub(super) u32);

/// A picture that is mapped onto a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageTexture {
    /// The picture.
    pub image: ImageId,
    /// Where it lies.
    pub mapping: Mapping2d,
    /// How it is averaged over the footprint.
    pub filter: ImageFilter,
    /// What lies beyond its edges.
    pub wrap: Wrap,
    /// Factor on the values.
    pub scale: f32,
    /// Whether the value v becomes max(0, 1 − v), after scaling.
    pub invert: bool,
}

impl ImageTexture {
    /// A texture with pbrt-v4's defaults: (s, t) = (u, v), bilinear, repeated, as it is.
    pub fn new(image: ImageId) -> Self {
        Self {
            image,
            mapping: Mapping2d::UV,
            filter: ImageFilter::Bilinear,
            wrap: Wrap::REPEAT,
            scale: 1.0,
            invert: false,
        }
    }

    /// The number at a surface point.
    pub(super) fn scalar(&self, pyramid: &Pyramid, at: &TextureContext) -> f32 {
        let v = self.scale * lookup::<Scalar>(pyramid, self.filter, self.wrap, &self.mapping.map(at));
        if self.invert { (1.0 - v).max(0.0) } else { v }
    }

    /// Linear RGB at a surface point, not below zero.
    pub(super) fn rgb(&self, pyramid: &Pyramid, at: &TextureContext) -> Rgb {
        let Rgb(v) = lookup::<Color>(pyramid, self.filter, self.wrap, &self.mapping.map(at)) * self.scale;
        Rgb((if self.invert { Vec3::ONE - v } else { v }).max(Vec3::ZERO))
    }
}
