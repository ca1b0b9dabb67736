//! Light sources as the scene states them.

use super::id::Id;
use super::medium::MediumDesc;
use super::sky::{SkyDesc, SunDesc};
use super::value::{FileRef, SpectrumDesc};
use crate::light::Total;
use crate::light::photometric::Interpolation;
use crate::math::{AnimatedTransform, Point};
use crate::scene::source::Span;

/// A light that is not a surface.
#[derive(Clone, Debug)]
pub struct LightDesc {
    /// What it is.
    pub kind: LightKind,
    /// Factor on its emission (1).
    pub scale: f32,
    /// How amounts are meant.
    pub normalization: Normalization,
    /// What it is scaled to instead of the amount of its spectrum, > 0; that of a map at infinity is of a plane facing +z.
    pub total: Option<Total>,
    /// The transform in force.
    pub world_from_light: AnimatedTransform,
    /// The medium around the light.
    pub medium: Option<Id<MediumDesc>>,
    /// The directive.
    pub span: Span,
}

/// Whether a light's spectrum states amounts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normalization {
    /// As pbrt-v4 does: the spectrum is divided by its photometric integral, `scale` is luminous [cd/m², cd, lx].
    #[default]
    Photometric,
    /// The spectrum is absolute, in W·m⁻²·sr⁻¹·nm⁻¹ (radiance), W·sr⁻¹·nm⁻¹ (intensity) or W·m⁻²·nm⁻¹ (irradiance),
    /// whichever is the quantity of the kind of light.
    Absolute,
}

/// The kinds of light; points are in light space, defaults in parentheses.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// A point that shines equally in all directions.
    Point {
        /// Intensity (the colour space's white).
        intensity: SpectrumDesc,
        /// Position (origin).
        from: Point,
    },
    /// A point that shines in a cone.
    Spot {
        /// Intensity on the axis (the colour space's white).
        intensity: SpectrumDesc,
        /// Position (origin).
        from: Point,
        /// A point on the axis (0, 0, 1); differs from `from`.
        to: Point,
        /// Half angle of the cone [degrees] (30).
        cone_angle: f32,
        /// Width of the falloff inside the cone [degrees] (5).
        cone_delta_angle: f32,
    },
    /// A point whose intensity is a picture of directions.
    Goniometric {
        /// Intensity that scales the picture (the colour space's white).
        intensity: SpectrumDesc,
        /// Equal-area octahedral picture.
        file: FileRef,
    },
    /// A slide projector.
    Projection {
        /// The slide.
        file: FileRef,
        /// Full angle of view along the slide's shorter side [degrees] (90), in (0, 180).
        fov: f32,
    },
    /// A luminaire by its measured distribution, nadir at −z, C0 plane at +x.
    Photometric {
        /// Spectrum, of which only the shape counts (the colour space's white).
        spectrum: SpectrumDesc,
        /// IES LM-63 or EULUMDAT.
        file: FileRef,
        /// Position (origin).
        from: Point,
        /// What it shines from.
        opening: OpeningDesc,
        /// What lies between the angles of the file (smooth).
        interpolation: Interpolation,
        /// Tilt of the luminaire [degrees] (0), by which an IES file's tilt factors are chosen.
        tilt: f32,
    },
    /// Parallel light from infinity.
    Distant {
        /// Perpendicular irradiance (the colour space's white).
        irradiance: SpectrumDesc,
        /// Light travels from here (origin) …
        from: Point,
        /// … to here (0, 0, 1); differs from `from`.
        to: Point,
    },
    /// The same radiance from every direction.
    UniformInfinite {
        /// Radiance (the colour space's white).
        radiance: SpectrumDesc,
    },
    /// Radiance from all directions by a picture.
    ImageInfinite {
        /// Equal-area octahedral picture, square.
        file: FileRef,
    },
    /// A sky by model.
    Sky(Box<SkyDesc>),
    /// The sun's disk.
    Sun(Box<SunDesc>),
}

/// The luminous opening of a photometric light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OpeningDesc {
    /// None: all light comes from one point.
    Point,
    /// As the file states it.
    File,
    /// A rectangle [scene units], both > 0.
    Rectangle {
        /// Extent along C0–C180, light space x.
        along_c0: f32,
        /// Extent along C90–C270, light space y.
        along_c90: f32,
    },
}

impl LightKind {
    /// Whether the light has no place in the scene, so that its amount is per area and not over a squared distance.
    pub fn is_at_infinity(&self) -> bool {
        matches!(
            self,
            Self::Distant { .. }
                | Self::UniformInfinite { .. }
                | Self::ImageInfinite { .. }
                | Self::Sky(_)
                | Self::Sun(_)
        )
    }
}

/// The emission that shapes after an `AreaLightSource` directive have.
#[derive(Clone, Debug)]
pub struct AreaLightDesc {
    /// Radiance (the colour space's white), or a picture of it over (u, v).
    pub radiance: AreaRadiance,
    /// Factor on the emission (1).
    pub scale: f32,
    /// How amounts are meant.
    pub normalization: Normalization,
    /// Whether both sides emit (false).
    pub two_sided: bool,
    /// What each shape is scaled to instead of the amount of its radiance, > 0.
    pub total: Option<Total>,
    /// The directive.
    pub span: Span,
}

/// What a surface emits.
#[derive(Clone, Debug)]
pub enum AreaRadiance {
    /// The same spectrum everywhere.
    Uniform(SpectrumDesc),
    /// A picture over (u, v).
    Image(FileRef),
}
