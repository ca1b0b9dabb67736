//! The parameters of OpenPBR Surface at one point: what its slabs are made of.

use crate::spectrum::{LANES, Sampled};
use crate::units::Unitless;

/// Whether a surface bounds a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wall {
    /// The surface of a body, whose inside is below it.
    #[default]
    Solid,
    /// A sheet without thickness, alike on both sides.
    Thin,
}

/// The values that the specification's parameters take at one point and at one path's wavelengths, by the
/// specification's names. Values out of their range are the caller's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slabs {
    /// Wavelengths of the lanes [nm], in air: films interfere at them.
    pub lambda_nm: [f32; LANES],
    /// base_weight × base_color in [0, 1]: reflectance of the diffuse base, or of the metal at normal incidence.
    pub base_color: Sampled<Unitless>,
    /// Roughness of the diffuse base in [0, 1].
    pub base_diffuse_roughness: f32,
    /// Share of metal in [0, 1].
    pub base_metalness: f32,
    /// Factor on the reflectance of the base's interface at normal incidence, at least 0.
    pub specular_weight: f32,
    /// Tint of the dielectric's reflection from above, or of the metal's at 82°, in [0, 1].
    pub specular_color: Sampled<Unitless>,
    /// Roughness of the base's interface in [0, 1]; its square is the microfacet width.
    pub specular_roughness: f32,
    /// How much longer the highlight is along the tangent, in [0, 1].
    pub specular_roughness_anisotropy: f32,
    /// Index of the base at the path's hero wavelength, above 0.
    pub specular_ior: f32,
    /// Share of the dielectric that is translucent, in [0, 1].
    pub transmission_weight: f32,
    /// Tint of transmitted light in [0, 1]; of a thin wall, its transmittance at normal incidence.
    pub transmission_color: Sampled<Unitless>,
    /// Share of the opaque dielectric that is a scattering sheet, in [0, 1]; of thin walls only.
    pub subsurface_weight: f32,
    /// What the sheet scatters, in [0, 1].
    pub subsurface_color: Sampled<Unitless>,
    /// Towards which side it scatters: −1 back, 1 through.
    pub subsurface_scatter_anisotropy: f32,
    /// Coverage of the coat in [0, 1].
    pub coat_weight: f32,
    /// Transmittance of the coat at normal incidence, down and up again, in [0, 1].
    pub coat_color: Sampled<Unitless>,
    /// Roughness of the coat in [0, 1].
    pub coat_roughness: f32,
    /// How much longer the coat's highlight is along the tangent, in [0, 1].
    pub coat_roughness_anisotropy: f32,
    /// Index of the coat, above 0.
    pub coat_ior: f32,
    /// How much of the darkening by reflections inside the coat takes place, in [0, 1].
    pub coat_darkening: f32,
    /// Coverage of the fuzz in [0, 1].
    pub fuzz_weight: f32,
    /// Colour of the fuzz in [0, 1].
    pub fuzz_color: Sampled<Unitless>,
    /// Width of the distribution of its flakes in [0, 1].
    pub fuzz_roughness: f32,
    /// Coverage of the film on the base, in [0, 1].
    pub thin_film_weight: f32,
    /// Thickness of the film [nm], at least 0; the specification's own unit is the micrometre.
    pub thin_film_thickness_nm: f32,
    /// Index of the film, above 0.
    pub thin_film_ior: f32,
    /// Share of the surface that is there, in [0, 1].
    pub geometry_opacity: f32,
    /// geometry_thin_walled.
    pub wall: Wall,
}

impl Default for Slabs {
    /// The defaults of the specification: glossy light grey plastic.
    fn default() -> Self {
        Self {
            lambda_nm: [450.0, 520.0, 590.0, 660.0],
            base_color: Sampled::splat(0.8),
            base_diffuse_roughness: 0.0,
            base_metalness: 0.0,
            specular_weight: 1.0,
            specular_color: Sampled::ONE,
            specular_roughness: 0.3,
            specular_roughness_anisotropy: 0.0,
            specular_ior: 1.5,
            transmission_weight: 0.0,
            transmission_color: Sampled::ONE,
            subsurface_weight: 0.0,
            subsurface_color: Sampled::splat(0.8),
            subsurface_scatter_anisotropy: 0.0,
            coat_weight: 0.0,
            coat_color: Sampled::ONE,
            coat_roughness: 0.0,
            coat_roughness_anisotropy: 0.0,
            coat_ior: 1.6,
            coat_darkening: 1.0,
            fuzz_weight: 0.0,
            fuzz_color: Sampled::ONE,
            fuzz_roughness: 0.5,
            thin_film_weight: 0.0,
            thin_film_thickness_nm: 500.0,
            thin_film_ior: 1.4,
            geometry_opacity: 1.0,
            wall: Wall::Solid,
        }
    }
}

/// Microfacet widths along the tangent and across it: α = r², stretched so that αt² + αb² = 2 α² (specification,
/// "Microfacet model").
pub(super) fn widths(roughness: f32, anisotropy: f32) -> [f32; 2] {
    let ratio = 1.0 - anisotropy;
    let along = roughness * roughness * (2.0 / (1.0 + ratio * ratio)).sqrt();
    [along, ratio * along]
}
