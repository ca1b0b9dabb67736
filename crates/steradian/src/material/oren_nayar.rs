//! `Material "orennayar"`.

use super::declared::Declared;
use super::inputs::Lookup;
use super::passive::require_passive;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, OrenNayar};
use crate::texture::{FloatInput, SpectrumInput};

/// Rough diffuse reflection.
#[derive(Clone, Debug, PartialEq)]
pub struct OrenNayarMaterial {
    /// Reflectance of the facets, limited to [0, 1].
    pub reflectance: SpectrumInput,
    /// Roughness of the model, limited to [0, 1]: 0 is Lambert's law. It is no angle and no microfacet width.
    pub roughness: FloatInput,
}

impl Declared for OrenNayarMaterial {
    const CLASS: &'static str = "orennayar";
    const PARAMETERS: &'static [Parameter] =
        &[Parameter::fraction("reflectance", 0.5), Parameter::float_in("roughness", 0.5, 0.0, 1.0)];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let reflectance = arguments.spectrum("reflectance");
        require_passive("reflectance", &[("reflectance", &reflectance)])?;
        Ok(Self { reflectance, roughness: arguments.float("roughness") })
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_textured() || self.roughness.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::OrenNayar(OrenNayar {
            reflectance: lookup.reflectance(&self.reflectance),
            roughness: lookup.float(&self.roughness).clamp(0.0, 1.0),
        }))
    }
}
