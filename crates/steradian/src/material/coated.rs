//! `Material "coateddiffuse"` and `Material "coatedconductor"`.

use super::declared::Declared;
use super::inputs::{CoatInput, Lookup, Metal, Roughness};
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Diffuse, Layered, VarnishedDiffuse};
use crate::texture::SpectrumInput;

/// A dielectric coat over a Lambertian base.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDiffuseMaterial {
    /// Reflectance of the base, limited to [0, 1].
    pub reflectance: SpectrumInput,
    /// The coat.
    pub coat: CoatInput,
}

impl Declared for CoatedDiffuseMaterial {
    const CLASS: &'static str = "coateddiffuse";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::fraction("reflectance", 0.5),
        Parameter::float_in("roughness", 0.0, 0.0, f32::INFINITY),
        Parameter::float_opt("uroughness", 0.0, f32::INFINITY),
        Parameter::float_opt("vroughness", 0.0, f32::INFINITY),
        Parameter::flag("remaproughness", true),
        Parameter::index("eta", 1.5),
        Parameter::float("thickness", 0.01),
        Parameter::float("g", 0.0),
        Parameter::fraction("albedo", 0.0),
        Parameter::count("maxdepth", 10, 0, MAX_WALK),
        Parameter::count("nsamples", 1, 1, MAX_WALK),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let roughness = Roughness::from_arguments(arguments, ["roughness", "uroughness", "vroughness"]);
        Ok(Self {
            reflectance: arguments.spectrum("reflectance"),
            coat: CoatInput::from_arguments(arguments, "eta", roughness),
        })
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_textured() || self.coat.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, seed: u64) -> Option<Bsdf<'a>> {
        let base = Diffuse { reflectance: lookup.reflectance(&self.reflectance) };
        let layers = Layered { coat: self.coat.at(lookup), base, seed };
        Some(VarnishedDiffuse::new(layers).map_or(Bsdf::CoatedDiffuse(layers), Bsdf::VarnishedDiffuse))
    }
}

/// Scattering events, and walks, within a layered material: each point that is hit pays for all of them.
const MAX_WALK: u32 = 1000;

/// A dielectric coat over a metal.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedConductorMaterial {
    /// The metal's optical constants, in air.
    pub metal: Metal,
    /// The metal's roughness.
    pub roughness: Roughness,
    /// The coat.
    pub coat: CoatInput,
}

impl Declared for CoatedConductorMaterial {
    const CLASS: &'static str = "coatedconductor";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::float_in("interface.roughness", 0.0, 0.0, f32::INFINITY),
        Parameter::float_opt("interface.uroughness", 0.0, f32::INFINITY),
        Parameter::float_opt("interface.vroughness", 0.0, f32::INFINITY),
        Parameter::flag("remaproughness", true),
        Parameter::index("interface.eta", 1.5),
        Parameter::fraction_opt("reflectance"),
        Parameter::quantity("conductor.eta", "metal-Cu-eta"),
        Parameter::quantity("conductor.k", "metal-Cu-k"),
        Parameter::float_in("conductor.roughness", 0.0, 0.0, f32::INFINITY),
        Parameter::float_opt("conductor.uroughness", 0.0, f32::INFINITY),
        Parameter::float_opt("conductor.vroughness", 0.0, f32::INFINITY),
        Parameter::float("thickness", 0.01),
        Parameter::float("g", 0.0),
        Parameter::fraction("albedo", 0.0),
        Parameter::count("maxdepth", 10, 0, MAX_WALK),
        Parameter::count("nsamples", 1, 1, MAX_WALK),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let interface = ["interface.roughness", "interface.uroughness", "interface.vroughness"];
        let conductor = ["conductor.roughness", "conductor.uroughness", "conductor.vroughness"];
        let interface = Roughness::from_arguments(arguments, interface);
        Ok(Self {
            metal: Metal::from_arguments(arguments, ["conductor.eta", "conductor.k"])?,
            roughness: Roughness::from_arguments(arguments, conductor),
            coat: CoatInput::from_arguments(arguments, "interface.eta", interface),
        })
    }

    fn is_textured(&self) -> bool {
        self.metal.is_textured() || self.roughness.is_textured() || self.coat.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, seed: u64) -> Option<Bsdf<'a>> {
        let coat = self.coat.at(lookup);
        let mut base = self.metal.at(&self.roughness, lookup);
        // The metal meets the coat, not air.
        base.eta = base.eta / coat.interface.eta;
        base.k = base.k / coat.interface.eta;
        Some(Bsdf::CoatedConductor(Layered { coat, base, seed }))
    }
}
