//! `Material "diffuse"` and `Material "diffusetransmission"`.

use super::declared::Declared;
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Diffuse, DiffuseTransmission};
use crate::texture::SpectrumInput;

/// Lambertian reflection.
#[derive(Clone, Debug, PartialEq)]
pub struct DiffuseMaterial {
    /// Reflectance, limited to [0, 1].
    pub reflectance: SpectrumInput,
}

impl Declared for DiffuseMaterial {
    const CLASS: &'static str = "diffuse";
    const PARAMETERS: &'static [Parameter] = &[Parameter::fraction("reflectance", 0.5)];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        Ok(Self { reflectance: arguments.spectrum("reflectance") })
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_textured()
    }

    #[inline(always)]
    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::Diffuse(Diffuse { reflectance: lookup.reflectance(&self.reflectance) }))
    }
}

/// Lambertian reflection and transmission.
#[derive(Clone, Debug, PartialEq)]
pub struct DiffuseTransmissionMaterial {
    /// Reflectance before scaling.
    pub reflectance: SpectrumInput,
    /// Transmittance before scaling.
    pub transmittance: SpectrumInput,
    /// Factor on both, which are then limited to [0, 1].
    pub scale: f32,
}

impl Declared for DiffuseTransmissionMaterial {
    const CLASS: &'static str = "diffusetransmission";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::fraction("reflectance", 0.25),
        Parameter::fraction("transmittance", 0.25),
        Parameter::number("scale", 1.0, 0.0, f32::INFINITY),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        Ok(Self {
            reflectance: arguments.spectrum("reflectance"),
            transmittance: arguments.spectrum("transmittance"),
            scale: arguments.number("scale"),
        })
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_textured() || self.transmittance.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let scaled = |input| (lookup.spectrum(input) * self.scale).clamp(0.0, 1.0);
        Some(Bsdf::DiffuseTransmission(DiffuseTransmission {
            reflectance: scaled(&self.reflectance),
            transmittance: scaled(&self.transmittance),
        }))
    }
}
