//! `Material "dielectric"` and `Material "thindielectric"`.

use super::declared::{Declared, Role};
use super::finish::{Finish, THICKEST_FILM, interface_losses};
use super::inputs::{Lookup, Roughness};
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Dielectric, FinishedDielectric, ThinDielectric};
use crate::spectrum::Spectrum;

/// The interface to a transparent medium; a spectrum that varies makes it disperse.
#[derive(Clone, Debug, PartialEq)]
pub struct DielectricMaterial {
    /// Index of the inside over the outside.
    pub eta: Spectrum,
    /// Roughness of the interface.
    pub roughness: Roughness,
    /// Its finish.
    pub finish: Finish,
}

impl Declared for DielectricMaterial {
    const CLASS: &'static str = "dielectric";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::index("eta", 1.5),
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
        let eta = arguments.index("eta");
        let finish = Finish::from_arguments(arguments, &roughness, |coverage, film| {
            interface_losses(coverage, &eta, film)
        })?;
        Ok(Self { eta, roughness, finish })
    }

    fn is_textured(&self) -> bool {
        self.roughness.is_textured() || self.finish.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let eta = lookup.index(&self.eta);
        let roughness = self.roughness.at(lookup);
        if self.finish.is_plain() {
            return Some(Bsdf::Dielectric(Dielectric { eta, roughness }));
        }
        let interface = Dielectric { eta, roughness: self.finish.facets(roughness) };
        let coating = self.finish.coating(lookup);
        let losses = self.finish.losses.as_deref();
        Some(Bsdf::FinishedDielectric(FinishedDielectric::new(interface, coating, losses)))
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
