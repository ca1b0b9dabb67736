//! `Material "hair"`.

use super::declared::Declared;
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Fibre, Hair};
use crate::color::{ColorSpace, ColorSpaceKind, Rgb};
use crate::spectrum::{Sampled, Spectrum};
use crate::texture::{FloatInput, SpectrumInput};
use crate::units::Unitless;

/// Absorption [1/radius] by one unit of the dark pigment, as an sRGB triple (d'Eon et al. 2011, section 6.1).
const EUMELANIN: [f32; 3] = [0.419, 0.697, 1.37];
/// Absorption [1/radius] by one unit of the reddish pigment.
const PHEOMELANIN: [f32; 3] = [0.187, 0.4, 1.05];
/// Brown hair: what a statement without a colour means.
const BROWN: f32 = 1.3;
/// Below it, refraction runs out of floats.
const MIN_INDEX: f32 = 1e-3;

/// A hair, for curves: where it is met on its width follows from their second texture coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct HairMaterial {
    /// What gives it its colour.
    pub pigment: Pigment,
    /// Index of refraction.
    pub eta: FloatInput,
    /// Roughness along the hair.
    pub beta_m: FloatInput,
    /// Roughness around the hair.
    pub beta_n: FloatInput,
    /// Tilt of the scales [°].
    pub alpha: FloatInput,
}

/// What gives hair its colour.
#[derive(Clone, Debug, PartialEq)]
pub enum Pigment {
    /// An absorption coefficient [1/radius].
    Absorption(SpectrumInput),
    /// The colour that a volume of such hair has.
    Reflectance(SpectrumInput),
    /// Concentrations that vary over the surface; the spectra belong to one unit.
    Melanin {
        /// The dark pigment and its spectrum.
        eumelanin: (FloatInput, Spectrum),
        /// The reddish pigment and its spectrum.
        pheomelanin: (FloatInput, Spectrum),
    },
}

impl Declared for HairMaterial {
    const CLASS: &'static str = "hair";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::quantity_opt("sigma_a"),
        Parameter::fraction_opt("reflectance"),
        Parameter::float_opt("eumelanin", 0.0, f32::INFINITY),
        Parameter::float_opt("pheomelanin", 0.0, f32::INFINITY),
        Parameter::float_in("eta", 1.55, 0.0, f32::INFINITY),
        Parameter::float_in("beta_m", 0.3, 0.0, f32::INFINITY),
        Parameter::float_in("beta_n", 0.3, 0.0, f32::INFINITY),
        Parameter::float("alpha", 2.0),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        Ok(Self {
            pigment: Pigment::from_arguments(arguments),
            eta: arguments.float("eta"),
            beta_m: arguments.float("beta_m"),
            beta_n: arguments.float("beta_n"),
            alpha: arguments.float("alpha"),
        })
    }

    fn is_textured(&self) -> bool {
        let pigment = match &self.pigment {
            Pigment::Absorption(s) | Pigment::Reflectance(s) => s.is_textured(),
            Pigment::Melanin { eumelanin, pheomelanin } => {
                eumelanin.0.is_textured() || pheomelanin.0.is_textured()
            }
        };
        pigment || [self.eta, self.beta_m, self.beta_n, self.alpha].iter().any(FloatInput::is_textured)
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let beta_n = lookup.float(&self.beta_n);
        Some(Bsdf::Hair(Hair::new(Fibre {
            h: 2.0 * lookup.point().uv.y - 1.0,
            eta: lookup.float(&self.eta).max(MIN_INDEX),
            sigma_a: self.pigment.sigma_a(lookup, beta_n),
            beta_m: lookup.float(&self.beta_m),
            beta_n,
            alpha: lookup.float(&self.alpha),
        })))
    }
}

impl Pigment {
    /// What is stated first of absorption, reflectance and melanin counts, and the others are ignored: pbrt-v4's order.
    fn from_arguments(arguments: &Arguments) -> Self {
        if let Some(sigma_a) = arguments.spectrum_opt("sigma_a") {
            return Self::Absorption(sigma_a);
        }
        if let Some(reflectance) = arguments.spectrum_opt("reflectance") {
            return Self::Reflectance(reflectance);
        }
        let given = ["eumelanin", "pheomelanin"].map(|name| arguments.float_opt(name));
        let default = if given == [None, None] { BROWN } else { 0.0 };
        let amounts = [
            given[0].unwrap_or(FloatInput::Constant(default)),
            given[1].unwrap_or(FloatInput::Constant(0.0)),
        ];
        let srgb = ColorSpace::new(ColorSpaceKind::Srgb);
        let of = |e: f32, p: f32| {
            let c = |i: usize| e * EUMELANIN[i] + p * PHEOMELANIN[i];
            srgb.unbounded(Rgb::new(c(0), c(1), c(2)))
        };
        match amounts {
            [FloatInput::Constant(e), FloatInput::Constant(p)] => {
                Self::Absorption(SpectrumInput::Constant(of(e, p)))
            }
            // The spectrum of a sum of triples is not quite the sum of their spectra: pbrt-v4 forms the former at each point.
            [eumelanin, pheomelanin] => Self::Melanin {
                eumelanin: (eumelanin, of(1.0, 0.0)),
                pheomelanin: (pheomelanin, of(0.0, 1.0)),
            },
        }
    }

    fn sigma_a(&self, lookup: &Lookup<'_>, beta_n: f32) -> Sampled<Unitless> {
        match self {
            Self::Absorption(s) => lookup.spectrum(s).map(|a| a.max(0.0)),
            Self::Reflectance(s) => Hair::sigma_a_of_reflectance(lookup.reflectance(s), beta_n),
            Self::Melanin { eumelanin, pheomelanin } => {
                let [e, p] = [eumelanin, pheomelanin].map(|(amount, _)| lookup.float(amount).max(0.0));
                let at = |s: &Spectrum| Sampled::<Unitless>::from_array(lookup.lambda().map(|l| s.at(l)));
                at(&eumelanin.1) * e + at(&pheomelanin.1) * p
            }
        }
    }
}
