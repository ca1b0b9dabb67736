//! Materials as the scene states them.

use super::id::Id;
use super::texture::{FloatParam, SpectrumParam};
use super::value::FileRef;
use crate::scene::source::Span;

/// A material. Named ones keep their name for messages and `info`.
#[derive(Clone, Debug)]
pub struct MaterialDesc {
    /// Name in the scene; `None` for materials stated in place.
    pub name: Option<String>,
    /// What it is.
    pub kind: MaterialKind,
    /// Bump map: height [scene units] along the normal.
    pub displacement: Option<FloatParam>,
    /// Normal map.
    pub normal_map: Option<FileRef>,
    /// The definition.
    pub span: Span,
}

/// The kinds of material with their parameters; defaults in parentheses.
#[derive(Clone, Debug)]
pub enum MaterialKind {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo (0.5).
        reflectance: SpectrumParam,
    },
    /// Lambertian reflection and transmission.
    DiffuseTransmission {
        /// Reflected fraction (0.25).
        reflectance: SpectrumParam,
        /// Transmitted fraction (0.25).
        transmittance: SpectrumParam,
        /// Factor on both (1).
        scale: f32,
    },
    /// Metal.
    Conductor {
        /// Optical constants (copper).
        optics: ConductorOptics,
        /// Roughness (0).
        roughness: RoughnessDesc,
    },
    /// Boundary of a transparent solid.
    Dielectric {
        /// Relative index of refraction (1.5); spectrally varying means dispersion. Never a texture.
        eta: SpectrumParam,
        /// Roughness (0).
        roughness: RoughnessDesc,
    },
    /// Thin transparent sheet.
    ThinDielectric {
        /// Index of refraction (1.5). Never a texture.
        eta: SpectrumParam,
    },
    /// Dielectric coating over a diffuse base.
    CoatedDiffuse {
        /// Albedo of the base (0.5).
        reflectance: SpectrumParam,
        /// Roughness of the coating (0).
        roughness: RoughnessDesc,
        /// Index of refraction of the coating (1.5). Never a texture.
        eta: SpectrumParam,
        /// The coating's inside.
        layer: LayerDesc,
    },
    /// Dielectric coating over metal.
    CoatedConductor {
        /// Roughness of the coating (0); its remapping holds for the metal too.
        interface_roughness: RoughnessDesc,
        /// Index of refraction of the coating (1.5). Never a texture.
        interface_eta: SpectrumParam,
        /// Optical constants of the metal (copper).
        optics: ConductorOptics,
        /// Roughness of the metal (0).
        conductor_roughness: RoughnessDesc,
        /// The coating's inside.
        layer: LayerDesc,
    },
    /// One of two materials, chosen by a fixed pseudo-random rule at each point.
    Mix {
        /// The materials; no mix contains itself.
        materials: [Id<MaterialDesc>; 2],
        /// Fraction of the second (0.5).
        amount: FloatParam,
    },
    /// No scattering: a mere boundary of media.
    Interface,
}

/// Optical constants of a metal.
#[derive(Clone, Debug)]
pub enum ConductorOptics {
    /// Complex index of refraction η − ik.
    Index {
        /// Real part.
        eta: SpectrumParam,
        /// Imaginary part.
        k: SpectrumParam,
    },
    /// Reflectance at normal incidence, from which an index is derived.
    Reflectance(SpectrumParam),
}

/// Microfacet roughness along both parameter directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughnessDesc {
    /// Along u.
    pub u: FloatParam,
    /// Along v.
    pub v: FloatParam,
    /// Whether the values are mapped to α = √roughness; they are α otherwise (true).
    pub remap: bool,
}

/// The inside of a coating and the length of random walks in it.
#[derive(Clone, Debug)]
pub struct LayerDesc {
    /// Thickness [scene units] (0.01).
    pub thickness: FloatParam,
    /// Henyey–Greenstein asymmetry of the filling (0).
    pub g: FloatParam,
    /// Single-scattering albedo of the filling (0: clear).
    pub albedo: SpectrumParam,
    /// Largest number of scattering events of a walk (10).
    pub max_depth: u32,
    /// Number of walks per evaluation (1), ≥ 1.
    pub n_samples: u32,
}
