//! `Material "conductor"`.

use super::declared::{Declared, Role};
use super::inputs::{Lookup, Metal, Roughness};
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::Bsdf;

/// A metal.
#[derive(Clone, Debug, PartialEq)]
pub struct ConductorMaterial {
    /// Its optical constants.
    pub metal: Metal,
    /// Its roughness.
    pub roughness: Roughness,
}

impl Declared for ConductorMaterial {
    const CLASS: &'static str = "conductor";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::fraction_opt("reflectance"),
        Parameter::quantity("eta", "metal-Cu-eta"),
        Parameter::quantity("k", "metal-Cu-k"),
        Parameter::float_in("roughness", 0.0, 0.0, f32::INFINITY),
        Parameter::float_opt("uroughness", 0.0, f32::INFINITY),
        Parameter::float_opt("vroughness", 0.0, f32::INFINITY),
        Parameter::flag("remaproughness", true),
    ];
    const ROLE: Role = Role::Specular;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        Ok(Self {
            metal: Metal::from_arguments(arguments, ["eta", "k"])?,
            roughness: Roughness::from_arguments(arguments, ["roughness", "uroughness", "vroughness"]),
        })
    }

    fn is_textured(&self) -> bool {
        self.metal.is_textured() || self.roughness.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::Conductor(self.metal.at(&self.roughness, lookup)))
    }
}
