//! Participating media as the scene states them.

use super::id::Id;
use super::value::SpectrumDesc;
use crate::scene::source::Span;

/// A named medium.
#[derive(Clone, Debug)]
pub struct MediumDesc {
    /// Name in the scene.
    pub name: String,
    /// What it is.
    pub kind: MediumKind,
    /// The definition.
    pub span: Span,
}

/// The kinds of medium.
#[derive(Clone, Debug)]
pub enum MediumKind {
    /// The same everywhere.
    Homogeneous {
        /// Absorption and scattering.
        coefficients: MediumCoefficients,
        /// Factor on both coefficients (1).
        scale: f32,
        /// Henyey–Greenstein asymmetry (0).
        g: f32,
        /// Emission, and the factor on it.
        emission: Option<MediumEmission>,
    },
    /// A kind that is known but not interpreted; the import has reported it.
    Unsupported {
        /// The kind's name.
        kind: String,
    },
}

/// Absorption and scattering of a medium.
#[derive(Clone, Debug)]
pub enum MediumCoefficients {
    /// Measured values of a substance known by name.
    Preset(String),
    /// Values in 1/scene unit.
    Values {
        /// Absorption (1.1, 24, 14 as RGB in 1/mm·1000).
        sigma_a: SpectrumDesc,
        /// Scattering.
        sigma_s: SpectrumDesc,
    },
}

/// Emission of a medium.
#[derive(Clone, Debug)]
pub struct MediumEmission {
    /// Emitted spectrum.
    pub spectrum: SpectrumDesc,
    /// Factor (1).
    pub scale: f32,
}

/// The media on both sides of a surface; `None` is vacuum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MediumInterface {
    /// On the side away from the normal.
    pub inside: Option<Id<MediumDesc>>,
    /// On the side of the normal.
    pub outside: Option<Id<MediumDesc>>,
}
