//! `Material "coateddiffuse"` and `Material "coatedconductor"`.

use super::declared::Declared;
use super::inputs::{CoatInput, Lookup, Metal, Roughness};
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Diffuse, Layered, RoughVarnish, Varnish, VarnishedDiffuse};
use crate::spectrum::Sampled;
use crate::texture::SpectrumInput;
use std::sync::Arc;

/// A dielectric coat over a Lambertian base.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDiffuseMaterial {
    /// Reflectance of the base, limited to [0, 1].
    pub reflectance: SpectrumInput,
    /// The coat.
    pub coat: CoatInput,
    /// What is the same wherever the coat is met.
    prepared: Prepared,
}

/// The coat's integrals, where it is the same everywhere.
#[derive(Clone, Debug, PartialEq)]
enum Prepared {
    /// They depend on the place, or there is no closed form.
    Nothing,
    /// A smooth clear coat, over any base.
    Smooth(VarnishedDiffuse),
    /// A rough clear coat.
    Rough(Arc<Varnish>),
}

impl Prepared {
    fn new(coat: &CoatInput) -> Self {
        let Some(coat) = coat.constant() else { return Self::Nothing };
        let layers = Layered { coat, base: Diffuse { reflectance: Sampled::ZERO }, seed: 0 };
        match VarnishedDiffuse::new(layers) {
            Some(varnished) => Self::Smooth(varnished),
            None => Varnish::new(&coat).map_or(Self::Nothing, |v| Self::Rough(Arc::new(v))),
        }
    }
}

impl CoatedDiffuseMaterial {
    /// A coat over a base with the given reflectance, which is limited to [0, 1].
    pub fn new(reflectance: SpectrumInput, coat: CoatInput) -> Self {
        let prepared = Prepared::new(&coat);
        Self { reflectance, coat, prepared }
    }
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
        let coat = CoatInput::from_arguments(arguments, "eta", roughness);
        Ok(Self::new(arguments.spectrum("reflectance"), coat))
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_textured() || self.coat.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, seed: u64) -> Option<Bsdf<'a>> {
        let reflectance = lookup.reflectance(&self.reflectance);
        Some(match &self.prepared {
            Prepared::Smooth(varnished) => Bsdf::VarnishedDiffuse(varnished.over(reflectance, seed)),
            Prepared::Rough(varnish) => Bsdf::RoughVarnish(RoughVarnish { varnish, reflectance, seed }),
            Prepared::Nothing => {
                let layers = Layered { coat: self.coat.at(lookup), base: Diffuse { reflectance }, seed };
                VarnishedDiffuse::new(layers).map_or(Bsdf::CoatedDiffuse(layers), Bsdf::VarnishedDiffuse)
            }
        })
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
