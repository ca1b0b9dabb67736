//! `Material "dielectric"` and `Material "thindielectric"`.

use super::declared::{Declared, Role};
use super::inputs::{Lookup, Roughness};
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Dielectric, ThinDielectric};
use crate::spectrum::Spectrum;

/// The interface to a transparent medium; a spectrum that varies makes it disperse.
#[derive(Clone, Debug, PartialEq)]
pub struct DielectricMaterial {
    /// Index of the inside over the outside.
    pub eta: Spectrum,
    /// Roughness of the interface.
    pub roughness: Roughness,
}

impl Declared for DielectricMaterial {
    const CLASS: &'static str = "dielectric";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::index("eta", 1.5),
        Parameter::float_in("roughness", 0.0, 0.0, f32::INFINITY),
        Parameter::float_opt("uroughness", 0.0, f32::INFINITY),
        Parameter::float_opt("vroughness", 0.0, f32::INFINITY),
        Parameter::flag("remaproughness", true),
    ];
    const ROLE: Role = Role::Specular;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let roughness = Roughness::from_arguments(arguments, ["roughness", "uroughness", "vroughness"]);
        Ok(Self { eta: arguments.index("eta"), roughness })
    }

    fn is_textured(&self) -> bool {
        self.roughness.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let eta = lookup.index(&self.eta);
        Some(Bsdf::Dielectric(Dielectric { eta, roughness: self.roughness.at(lookup) }))
    }
}

/// A pane without thickness.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinDielectricMaterial {
    /// Index of the pane.
    pub eta: Spectrum,
}

impl Declared for ThinDielectricMaterial {
    const CLASS: &'static str = "thindielectric";
    const PARAMETERS: &'static [Parameter] = &[Parameter::index("eta", 1.5)];
    const ROLE: Role = Role::Specular;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        Ok(Self { eta: arguments.index("eta") })
    }

    fn is_textured(&self) -> bool {
        false
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::ThinDielectric(ThinDielectric { eta: lookup.index(&self.eta) }))
    }
}
