//! `Material "stack"`: homogeneous absorbing layers, from the top.

use super::declared::{Declared, Role};
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::stack::{Below, LastBoundary, Layer, Layers, LayersError};
use crate::bsdf::{Bsdf, Stack};
use crate::optics::TrowbridgeReitz;
use crate::spectrum::{Sampled, Spectrum};
use crate::texture::SpectrumInput;

/// A stack of layers.
#[derive(Clone, Debug, PartialEq)]
pub struct StackMaterial {
    /// The layers, with the roughness of their boundaries.
    pub layers: Layers,
    /// What lies below them.
    pub base: StackBase,
}

/// What lies below the last layer of a stack.
#[derive(Clone, Debug, PartialEq)]
pub enum StackBase {
    /// A transparent medium with this index.
    Medium(Spectrum),
    /// A Lambertian surface with this reflectance, limited to [0, 1].
    Diffuse(SpectrumInput),
    /// A metal.
    Conductor {
        /// Real part of its index.
        eta: SpectrumInput,
        /// Imaginary part.
        k: SpectrumInput,
    },
}

impl Declared for StackMaterial {
    const CLASS: &'static str = "stack";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::numbers("thickness"),
        Parameter::spectra("eta"),
        Parameter::spectra("absorption"),
        Parameter::numbers("roughness"),
        Parameter::flag("remaproughness", true),
        Parameter::choice("base", &["none", "diffuse", "conductor"]),
        Parameter::index("below", 1.0),
        Parameter::fraction("reflectance", 0.5),
        Parameter::quantity("base.eta", "metal-Cu-eta"),
        Parameter::quantity("base.k", "metal-Cu-k"),
    ];
    const ROLE: Role = Role::Specular;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let base = StackBase::from_arguments(arguments)?;
        let thickness = arguments.numbers("thickness");
        if thickness.is_empty() {
            return Err(Fault::new("thickness", "a stack needs the \"thickness\" [m] of each of its layers"));
        }
        let eta = per_layer(arguments, "eta", thickness.len(), 1.5)?;
        let absorption = per_layer(arguments, "absorption", thickness.len(), 0.0)?;
        let layers = thickness
            .iter()
            .zip(eta)
            .zip(absorption)
            .map(|((&thickness, eta), absorption)| Layer { thickness, eta, absorption })
            .collect();
        let remap = arguments.flag("remaproughness");
        let microfacets = |&roughness: &f32| {
            if !(roughness >= 0.0 && roughness.is_finite()) {
                let message = format!("\"roughness\" must not be negative, found {roughness}");
                return Err(Fault::new("roughness", message));
            }
            let alpha = if remap { TrowbridgeReitz::alpha_from_roughness(roughness) } else { roughness };
            Ok(TrowbridgeReitz::new(alpha, alpha))
        };
        let roughness: Vec<_> =
            arguments.numbers("roughness").iter().map(microfacets).collect::<Result<_, _>>()?;
        let last = match base {
            StackBase::Diffuse(_) => LastBoundary::Lambertian,
            StackBase::Medium(_) | StackBase::Conductor { .. } => LastBoundary::Interface,
        };
        let layers = Layers::new(layers, &roughness, last).map_err(|e| {
            let parameter = match e {
                LayersError::Empty | LayersError::TooMany(_) | LayersError::Thickness { .. } => "thickness",
                LayersError::Roughness { .. } => "roughness",
            };
            Fault::new(parameter, e.to_string())
        })?;
        Ok(Self { layers: layers.prepared(), base })
    }

    fn is_textured(&self) -> bool {
        match &self.base {
            StackBase::Medium(_) => false,
            StackBase::Diffuse(reflectance) => reflectance.is_textured(),
            StackBase::Conductor { eta, k } => eta.is_textured() || k.is_textured(),
        }
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, seed: u64) -> Option<Bsdf<'a>> {
        if Stack::follows_hero(&self.layers)
            && self.layers.layers().iter().any(|layer| layer.eta.constant_value().is_none())
        {
            lookup.terminate_companions();
        }
        let below = match &self.base {
            StackBase::Medium(eta) => Below::Medium(Sampled::splat(lookup.index(eta))),
            StackBase::Diffuse(reflectance) => Below::Diffuse(lookup.reflectance(reflectance)),
            StackBase::Conductor { eta, k } => {
                Below::Conductor { eta: lookup.spectrum(eta), k: lookup.spectrum(k) }
            }
        };
        Some(Bsdf::Stack(Stack::new(&self.layers, below, *lookup.lambda(), seed)))
    }
}

impl StackBase {
    fn from_arguments(arguments: &Arguments) -> Result<Self, Fault> {
        let word = arguments.choice("base");
        for (name, owner) in [
            ("below", "none"),
            ("reflectance", "diffuse"),
            ("base.eta", "conductor"),
            ("base.k", "conductor"),
        ] {
            if arguments.given(name) && word != owner {
                let message =
                    format!("\"{name}\" belongs to \"string base\" \"{owner}\", but the base is \"{word}\"");
                return Err(Fault::new(name, message));
            }
        }
        Ok(match word {
            "diffuse" => Self::Diffuse(arguments.spectrum("reflectance")),
            "conductor" => {
                if arguments.given("base.k") != arguments.given("base.eta") {
                    let name = if arguments.given("base.k") { "base.k" } else { "base.eta" };
                    return Err(Fault::new(name, "a metal has both \"base.eta\" and \"base.k\""));
                }
                Self::Conductor { eta: arguments.spectrum("base.eta"), k: arguments.spectrum("base.k") }
            }
            _ => Self::Medium(arguments.index("below")),
        })
    }
}

/// One spectrum for each of `n` layers, from as many or from one for all.
fn per_layer(
    arguments: &Arguments,
    name: &'static str,
    n: usize,
    default: f32,
) -> Result<Vec<Spectrum>, Fault> {
    let given = arguments.spectra(name);
    let admitted: fn(f32) -> bool =
        if name == "eta" { |x| x > 0.0 && x.is_finite() } else { |x| x >= 0.0 && x.is_finite() };
    for (i, spectrum) in given.iter().enumerate() {
        let wrong = match spectrum {
            Spectrum::Tabulated(t) => t.samples().map(|(_, value)| value).find(|&v| !admitted(v)),
            other => other.constant_value().filter(|&v| !admitted(v)),
        };
        if let Some(value) = wrong {
            let rule = if name == "eta" { "positive" } else { "not negative" };
            return Err(Fault::new(
                name,
                format!("\"{name}\" of layer {} is {value}, but must be {rule}", i + 1),
            ));
        }
    }
    match given {
        [] => Ok(vec![Spectrum::Constant(default); n]),
        [one] => Ok(vec![one.clone(); n]),
        _ if given.len() == n => Ok(given.to_vec()),
        _ => {
            let message =
                format!("{} values of \"{name}\" for {n} layers: give one for all, or one each", given.len());
            Err(Fault::new(name, message))
        }
    }
}
