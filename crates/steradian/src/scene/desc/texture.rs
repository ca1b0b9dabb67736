//! Textures: numbers and spectra that vary over a surface.

use super::id::Id;
use super::value::{FileRef, SpectrumDesc};
use crate::image::ColorEncoding;
use crate::math::{Dir, Transform, Vec3};
use crate::scene::source::Span;

/// A number, or a texture of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatParam {
    /// The same number everywhere.
    Value(f32),
    /// The value of a texture.
    Texture(Id<FloatTextureDesc>),
}

/// A spectrum, or a texture of spectra.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumParam {
    /// The same spectrum everywhere.
    Value(SpectrumDesc),
    /// The value of a texture.
    Texture(Id<SpectrumTextureDesc>),
}

/// A named texture of numbers.
pub type FloatTextureDesc = TextureDesc<FloatTextureKind>;

/// A named texture of spectra.
///
/// Which kind of spectrum its RGB values stand for (albedo, unbounded, illuminant) depends on the parameter that
/// uses it, so one texture may be needed in several readings. RGB constants inside it are in [0,1].
pub type SpectrumTextureDesc = TextureDesc<SpectrumTextureKind>;

/// A named texture.
#[derive(Clone, Debug)]
pub struct TextureDesc<K> {
    /// Name in the scene.
    pub name: String,
    /// The transform in force at the definition.
    pub world_from_texture: Transform,
    /// What it computes.
    pub kind: K,
    /// The definition.
    pub span: Span,
}

/// A texture of either type, for lists in order of definition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureId {
    /// A texture of numbers.
    Float(Id<FloatTextureDesc>),
    /// A texture of spectra.
    Spectrum(Id<SpectrumTextureDesc>),
}

/// What a texture of numbers computes.
#[derive(Clone, Debug)]
pub enum FloatTextureKind {
    /// The same value everywhere (1).
    Constant {
        /// The value.
        value: FloatParam,
    },
    /// Product of two textures.
    Scale {
        /// First factor (1).
        tex: FloatParam,
        /// Second factor (1).
        scale: FloatParam,
    },
    /// Linear blend, tex1 (1 − amount) + tex2 amount.
    Mix {
        /// Value at amount 0 (0).
        tex1: FloatParam,
        /// Value at amount 1 (1).
        tex2: FloatParam,
        /// Weight of the second (0.5).
        amount: FloatParam,
    },
    /// Blend by the angle between the shading normal and a direction: |n · dir| of tex1, the rest of tex2.
    DirectionMix {
        /// Value where the normal is along `dir` (0).
        tex1: FloatParam,
        /// Value where the normal is across `dir` (1).
        tex2: FloatParam,
        /// Direction in world space (texture-space y).
        dir: Dir,
    },
    /// Bilinear interpolation of four constants over (u, v).
    Bilerp {
        /// Values v00, v01, v10, v11; the first digit counts u (0, 1, 0, 1).
        v: [f32; 4],
        /// Mapping.
        mapping: Mapping2d,
    },
    /// A picture.
    Image(ImageTextureDesc),
    /// Two textures in turn.
    Checkerboard {
        /// Value of the even cells (1).
        tex1: FloatParam,
        /// Value of the odd cells (0).
        tex2: FloatParam,
        /// Cells in (u, v) or in space.
        domain: CheckerboardDomain,
    },
    /// Random polka dots, one at most in each unit cell of (u, v).
    Dots {
        /// Value inside the dots (1).
        inside: FloatParam,
        /// Value outside (0).
        outside: FloatParam,
        /// Mapping.
        mapping: Mapping2d,
    },
    /// Fractional Brownian motion in texture space.
    Fbm(NoiseDesc),
    /// Turbulence in texture space.
    Wrinkled(NoiseDesc),
    /// Waves on water in texture space.
    Windy,
}

/// What a texture of spectra computes; the variants correspond to those of [`FloatTextureKind`].
#[derive(Clone, Debug)]
pub enum SpectrumTextureKind {
    /// The same value everywhere (1).
    Constant {
        /// The value.
        value: SpectrumParam,
    },
    /// Product with a texture of numbers.
    Scale {
        /// First factor (1).
        tex: SpectrumParam,
        /// Second factor (1).
        scale: FloatParam,
    },
    /// Linear blend.
    Mix {
        /// Value at amount 0 (0).
        tex1: SpectrumParam,
        /// Value at amount 1 (1).
        tex2: SpectrumParam,
        /// Weight of the second (0.5).
        amount: FloatParam,
    },
    /// Blend by the angle between the shading normal and a direction.
    DirectionMix {
        /// Value where the normal is along `dir` (0).
        tex1: SpectrumParam,
        /// Value where the normal is across `dir` (1).
        tex2: SpectrumParam,
        /// Direction in world space (texture-space y).
        dir: Dir,
    },
    /// Bilinear interpolation of four constants over (u, v).
    Bilerp {
        /// Values v00, v01, v10, v11 (0, 1, 0, 1); never textures.
        v: Box<[SpectrumParam; 4]>,
        /// Mapping.
        mapping: Mapping2d,
    },
    /// A picture.
    Image(ImageTextureDesc),
    /// Two textures in turn.
    Checkerboard {
        /// Value of the even cells (1).
        tex1: SpectrumParam,
        /// Value of the odd cells (0).
        tex2: SpectrumParam,
        /// Cells in (u, v) or in space.
        domain: CheckerboardDomain,
    },
    /// Random polka dots.
    Dots {
        /// Value inside the dots (1).
        inside: SpectrumParam,
        /// Value outside (0).
        outside: SpectrumParam,
        /// Mapping.
        mapping: Mapping2d,
    },
    /// Marble: a colour spline along a plane perturbed by noise, in texture space.
    Marble {
        /// The noise.
        noise: NoiseDesc,
        /// Factor on texture-space coordinates (1).
        scale: f32,
        /// Size of the perturbation (0.2).
        variation: f32,
    },
}

/// How a surface point becomes a point (s, t) of a two-dimensional texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping2d {
    /// (s, t) = (uscale u + udelta, vscale v + vdelta).
    Uv {
        /// Factors on (u, v) (1, 1).
        scale: [f32; 2],
        /// Offsets (0, 0).
        delta: [f32; 2],
    },
    /// Spherical angles of the texture-space point.
    Spherical,
    /// Angle and height of the texture-space point.
    Cylindrical,
    /// Projection of the texture-space point on two axes.
    Planar {
        /// Axis of s (x).
        v1: Vec3,
        /// Axis of t (y).
        v2: Vec3,
        /// Offsets (0, 0).
        delta: [f32; 2],
    },
}

/// Where the cells of a checkerboard live.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CheckerboardDomain {
    /// Unit squares of (s, t).
    Plane(Mapping2d),
    /// Unit cubes of texture space.
    Space,
}

/// Octaves of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseDesc {
    /// Number of octaves (8), 1 to 64.
    pub octaves: u32,
    /// Ratio of the amplitudes of successive octaves (0.5).
    pub roughness: f32,
}

/// A texture from a picture file.
#[derive(Clone, Debug)]
pub struct ImageTextureDesc {
    /// The picture.
    pub file: FileRef,
    /// How 8-bit samples are encoded; `None` leaves it to the file's format.
    pub encoding: Option<ColorEncoding>,
    /// Filter (bilinear).
    pub filter: ImageFilter,
    /// Continuation beyond the borders (repeat).
    pub wrap: WrapMode,
    /// Factor on the values (1).
    pub scale: f32,
    /// Whether the values are replaced by one minus them, after scaling, and not below zero (false).
    pub invert: bool,
    /// Largest ratio of the axes of an EWA filter ellipse (8).
    pub max_anisotropy: f32,
    /// Mapping.
    pub mapping: Mapping2d,
}

/// Filtering of picture lookups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFilter {
    /// Nearest texel of the level that suits the footprint.
    Point,
    /// Four texels of the level that suits the footprint.
    Bilinear,
    /// Eight texels of the two levels that suit the footprint best.
    Trilinear,
    /// Elliptically weighted average.
    Ewa,
}

/// Continuation of a picture beyond its borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrapMode {
    /// Periodic.
    Repeat,
    /// Zero.
    Black,
    /// The border texel.
    Clamp,
    /// The neighbour on the sphere that the square unfolds.
    OctahedralSphere,
}
