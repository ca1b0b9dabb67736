//! Where textures are evaluated, and what stands in a parameter that may be textured.

use crate::math::{Footprint, SurfacePoint};
use crate::spectrum::Spectrum;

/// The place of one texture lookup.
#[derive(Clone, Copy, Debug)]
pub struct TextureContext<'a> {
    /// The surface point, in render space.
    pub point: &'a SurfacePoint,
    /// How the point moves per pixel; the texture is averaged over this extent.
    pub footprint: &'a Footprint,
}

/// A number-valued texture of a [`Textures`](super::Textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FloatTextureId(pub(super) u32);

/// A spectrum-valued texture of a [`Textures`](super::Textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpectrumTextureId(pub(super) u32);

/// A number that may vary over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatInput {
    /// The same everywhere.
    Constant(f32),
    /// Looked up.
    Texture(FloatTextureId),
}

/// A spectrum that may vary over the surface.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumInput {
    /// The same everywhere.
    Constant(Spectrum),
    /// Looked up.
    Texture(SpectrumTextureId),
}

impl From<f32> for FloatInput {
    fn from(value: f32) -> Self {
        Self::Constant(value)
    }
}

impl From<Spectrum> for SpectrumInput {
    fn from(value: Spectrum) -> Self {
        Self::Constant(value)
    }
}

impl FloatInput {
    /// The value where it is the same everywhere.
    pub fn constant(&self) -> Option<f32> {
        match self {
            Self::Constant(v) => Some(*v),
            Self::Texture(_) => None,
        }
    }

    /// Whether it varies over the surface.
    pub fn is_textured(&self) -> bool {
        matches!(self, Self::Texture(_))
    }
}

impl SpectrumInput {
    /// The spectrum where it is the same everywhere.
    pub fn constant(&self) -> Option<&Spectrum> {
        match self {
            Self::Constant(s) => Some(s),
            Self::Texture(_) => None,
        }
    }

    /// Whether it varies over the surface.
    pub fn is_textured(&self) -> bool {
        matches!(self, Self::Texture(_))
    }
}
