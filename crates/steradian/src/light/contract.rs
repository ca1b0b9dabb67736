//! What every light promises.
//!
//! Radiance carriers are absolute, in W·m⁻²·sr⁻¹·nm⁻¹. `wi` points from the receiver to the light.

use crate::math::{BoundedPoint, Dir, Normal};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, Radiance};

/// Index of a light in the scene's list of lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LightId(pub u32);

/// One thing that can be sampled: a light, or one primitive of an emitting shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Emitter {
    /// The light.
    pub light: LightId,
    /// Primitive of its shape; zero for lights without a shape.
    pub prim: u32,
}

/// Light that arrives at a point from one direction, if nothing is in between.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Towards the light.
    pub wi: Dir,
    /// Radiance that arrives. With [`Density::Delta`]: perpendicular irradiance [W·m⁻²·nm⁻¹], that is I/r².
    pub radiance: Sampled<Radiance>,
    /// Density of `wi`, given that this emitter was chosen.
    pub density: Density,
    /// Where the light comes from.
    pub target: LightTarget,
}

/// What a ray that leaves the scene finds in an infinite light.
#[derive(Clone, Copy, Debug)]
pub struct Escaped {
    /// Radiance that arrives along the ray.
    pub radiance: Sampled<Radiance>,
    /// Density with which sampling the light finds the ray's direction.
    pub density: PdfSolidAngle,
}

/// The far end of a shadow ray.
#[derive(Clone, Copy, Debug)]
pub enum LightTarget {
    /// A point at a finite distance.
    Point {
        /// Where.
        p: BoundedPoint,
        /// Geometric normal of the surface; `None` for a point light.
        n: Option<Normal>,
    },
    /// Beyond everything.
    Infinite,
}

/// Total output.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightPower {
    /// Radiant power within 360–830 nm [W].
    pub watts: f32,
    /// Luminous flux [lm].
    pub lumens: f32,
}

/// Why a light cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightError {
    /// A photometric amount of a spectrum that the eye does not see.
    #[error("the spectrum has no visible part, so its amount cannot be given in lumen, lux or candela")]
    Invisible,
    /// Scale, power or illuminance.
    #[error("amount must be finite and not negative, not {0}")]
    Amount(f32),
    /// Direction of a spot or distant light.
    #[error("`from` and `to` must differ")]
    NoDirection,
    /// The transform flattens the light.
    #[error("the transform in force is singular")]
    Singular,
    /// Angles of a spot [°].
    #[error("cone of {cone} degrees with a falloff of {delta} degrees is impossible")]
    Cone {
        /// Half angle.
        cone: f32,
        /// Falloff.
        delta: f32,
    },
    /// Field of view of a projector [°].
    #[error("field of view must lie between 0 and 180 degrees, not {0}")]
    FieldOfView(f32),
    /// Width and height of an environment map [px].
    #[error("an environment map must be square (equal-area octahedral), not {0} by {1} pixels")]
    NotSquare(u32, u32),
    /// A sky whose luminance depends on the sun.
    #[error("this sky is brighter near the sun, and nothing says where the sun stands")]
    NoSun,
    /// Elevation of the sun [°].
    #[error("the sun stands below the horizon, at an elevation of {0:.2} degrees")]
    SunBelowHorizon(f32),
    /// Angular radius of the sun [°].
    #[error("the sun's angular radius must lie between 0.01 and 10 degrees, not {0}")]
    AngularRadius(f32),
    /// An amount in lumen or lux of a black picture.
    #[error("the picture is black, so it cannot be scaled to an amount")]
    Black,
    /// An amount in watts of a spectrum without power in the range that watts are counted in.
    #[error("the spectrum has no power within 360–830 nm, so its amount cannot be given in watts")]
    NoRadiantPower,
}
