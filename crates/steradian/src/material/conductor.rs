//! `Material "conductor"`.

use super::declared::{Declared, Role};
use super::finish::{Finish, THICKEST_FILM};
use super::inputs::{Lookup, Metal, Roughness};
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Conductor, FinishedConductor};
use crate::optics::compensation::LossTable;

/// A metal.
#[derive(Clone, Debug, PartialEq)]
pub struct ConductorMaterial {
    /// Its optical constants.
    pub metal: Metal,
    /// Its roughness.
    pub roughness: Roughness,
    /// Its finish.
    pub finish: Finish,
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
        Parameter::choice("distribution", &["ggx", "beckmann"]),
        Parameter::flag("multiscatter", false),
        Parameter::float_opt("film.thickness", 0.0, THICKEST_FILM),
        Parameter::index_opt("film.eta"),
    ];
    const ROLE: Role = Role::Specular;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let roughness = Roughness::from_arguments(arguments, ["roughness", "uroughness", "vroughness"]);
        // A metal's film changes what facets reflect, and not what a perfect mirror of such facets would lose.
        let losses = |coverage, _: Option<&_>| Ok(LossTable::mirror(coverage));
        Ok(Self {
            metal: Metal::from_arguments(arguments, ["eta", "k"])?,
            finish: Finish::from_arguments(arguments, &roughness, losses)?,
            roughness,
        })
    }

    fn is_textured(&self) -> bool {
        self.metal.is_textured() || self.roughness.is_textured() || self.finish.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let metal = self.metal.at(&self.roughness, lookup);
        if self.finish.is_plain() {
            return Some(Bsdf::Conductor(metal));
        }
        let Conductor { eta, k, roughness } = metal;
        let metal = Conductor { eta, k, roughness: self.finish.facets(roughness) };
        let coating = self.finish.coating(lookup);
        Some(Bsdf::FinishedConductor(FinishedConductor::new(metal, coating, self.finish.losses.as_deref())))
    }
}
