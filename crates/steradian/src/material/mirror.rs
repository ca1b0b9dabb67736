//! `Material "perfectmirror"`.

use super::declared::{Declared, Role};
use super::inputs::Lookup;
use super::passive::require_passive;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Mirror};
use crate::texture::SpectrumInput;

/// A perfect mirror. (`"mirror"` is pbrt-v3's name, by which its scenes are recognised.)
#[derive(Clone, Debug, PartialEq)]
pub struct MirrorMaterial {
    /// Reflectance, limited to [0, 1].
    pub reflectance: SpectrumInput,
}

impl Declared for MirrorMaterial {
    const CLASS: &'static str = "perfectmirror";
    const PARAMETERS: &'static [Parameter] = &[Parameter::fraction("reflectance", 1.0)];
    const ROLE: Role = Role::Specular;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let reflectance = arguments.spectrum("reflectance");
        require_passive("reflectance", &[("reflectance", &reflectance)])?;
        Ok(Self { reflectance })
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::Mirror(Mirror { reflectance: lookup.reflectance(&self.reflectance) }))
    }
}
