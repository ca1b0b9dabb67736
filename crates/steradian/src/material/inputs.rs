//! Groups of parameters that several materials share, and their values at a point.

use super::schema::{Arguments, Fault};
use crate::bsdf::{Coat, Conductor, Dielectric, ExitWeights};
use crate::math::{Footprint, SurfacePoint};
use crate::optics::TrowbridgeReitz;
use crate::spectrum::{LANES, Sampled, Spectrum, Wavelengths};
use crate::texture::{FloatInput, SpectrumInput, TextureContext, Textures};
use crate::units::Unitless;

/// What parameters are evaluated with: textures, a place, and a path's wavelengths.
#[derive(Debug)]
pub struct Lookup<'a> {
    textures: &'a Textures,
    at: TextureContext<'a>,
    wavelengths: &'a mut Wavelengths,
}

impl<'a> Lookup<'a> {
    #[inline]
    pub(super) fn new(
        textures: &'a Textures,
        point: &'a SurfacePoint,
        footprint: &'a Footprint,
        wavelengths: &'a mut Wavelengths,
    ) -> Self {
        Self { textures, at: TextureContext { point, footprint }, wavelengths }
    }

    /// A number.
    pub fn float(&self, input: &FloatInput) -> f32 {
        self.textures.float_input(input, &self.at)
    }

    /// A spectrum at the path's wavelengths.
    #[inline(always)]
    pub fn spectrum(&self, input: &SpectrumInput) -> Sampled<Unitless> {
        self.textures.spectrum_input(input, &self.at, self.wavelengths)
    }

    /// The path's wavelengths [nm].
    pub fn lambda(&self) -> &[f32; LANES] {
        self.wavelengths.lambda()
    }

    /// The place.
    pub fn point(&self) -> &SurfacePoint {
        self.at.point
    }

    /// Keeps the hero wavelength alone from here on: where directions depend on the wavelength.
    pub fn terminate_companions(&mut self) {
        self.wavelengths.terminate_companions();
    }

    /// A reflectance, limited to what a surface can reflect.
    #[inline(always)]
    pub fn reflectance(&self, input: &SpectrumInput) -> Sampled<Unitless> {
        self.spectrum(input).clamp(0.0, 1.0)
    }

    /// The index at the hero wavelength. Where it disperses, directions belong to the hero alone from here on.
    pub fn index(&mut self, eta: &Spectrum) -> f32 {
        if eta.constant_value().is_none() {
            self.wavelengths.terminate_companions();
        }
        index_at(eta, self.wavelengths.lambda()[0])
    }
}

/// The index at a wavelength [nm], positive.
pub(super) fn index_at(eta: &Spectrum, lambda: f32) -> f32 {
    clamped_index(eta.at(lambda))
}

fn clamped_index(value: f32) -> f32 {
    // Zero stands for "no value" in scene files: a medium without contrast.
    if value > 0.0 { value.clamp(MIN_INDEX, MAX_INDEX) } else { 1.0 }
}

/// Indices of refraction that no substance reaches, in whichever direction the interface is crossed; beyond them Snell's law
/// runs out of floats.
const MAX_INDEX: f32 = 1000.0;
const MIN_INDEX: f32 = 1.0 / MAX_INDEX;

/// What a number for the roughness means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RoughnessScale {
    /// Roughness in [0, 1]; α is its square root.
    #[default]
    Perceptual,
    /// The microfacet width α itself.
    Alpha,
}

/// Roughness along the two tangents.
#[derive(Clone, Debug, PartialEq)]
pub struct Roughness {
    /// Along ∂p/∂u.
    pub u: FloatInput,
    /// Along ∂p/∂v.
    pub v: FloatInput,
    /// What the numbers mean.
    pub scale: RoughnessScale,
}

impl Roughness {
    /// A smooth surface.
    pub const SMOOTH: Self = Self {
        u: FloatInput::Constant(0.0),
        v: FloatInput::Constant(0.0),
        scale: RoughnessScale::Perceptual,
    };

    /// Whether it varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.u.is_textured() || self.v.is_textured()
    }

    /// The value of the parameter named first for both tangents, unless the other two say more of either.
    pub(super) fn from_arguments(arguments: &Arguments, [both, u, v]: [&str; 3]) -> Self {
        let of = |name| arguments.float_opt(name).unwrap_or_else(|| arguments.float(both));
        let remap = arguments.flag("remaproughness");
        let scale = if remap { RoughnessScale::Perceptual } else { RoughnessScale::Alpha };
        Self { u: of(u), v: of(v), scale }
    }

    /// Whether the surface is smooth wherever it is looked at.
    pub(super) fn is_smooth(&self) -> bool {
        let zero = FloatInput::Constant(0.0);
        self.u == zero && self.v == zero
    }

    /// Its value at a point.
    pub fn at(&self, lookup: &Lookup) -> TrowbridgeReitz {
        let alpha = |input| self.alpha(lookup.float(input));
        TrowbridgeReitz::new(alpha(&self.u), alpha(&self.v))
    }

    /// The width that a number means.
    pub(super) fn alpha(&self, value: f32) -> f32 {
        match self.scale {
            RoughnessScale::Perceptual => TrowbridgeReitz::alpha_from_roughness(value),
            RoughnessScale::Alpha => value.max(0.0),
        }
    }
}

/// How a metal is given.
#[derive(Clone, Debug, PartialEq)]
pub enum Metal {
    /// Its complex index of refraction eta + j k.
    Index {
        /// Real part.
        eta: SpectrumInput,
        /// Imaginary part.
        k: SpectrumInput,
    },
    /// Its reflectance at normal incidence, from which an index 1 + j k follows (pbrt-v4 book, 10.5.2).
    Reflectance(SpectrumInput),
}

impl Metal {
    /// A metal by its parameter "reflectance", or by the two named ones.
    pub(super) fn from_arguments(arguments: &Arguments, [eta, k]: [&'static str; 2]) -> Result<Self, Fault> {
        let has_index = arguments.given(eta) || arguments.given(k);
        match arguments.spectrum_opt("reflectance") {
            Some(_) if has_index => {
                let message = format!("give \"reflectance\", or \"{eta}\" and \"{k}\", not both");
                Err(Fault::new("reflectance", message))
            }
            Some(reflectance) => Ok(Self::Reflectance(reflectance)),
            None if arguments.given(k) && !arguments.given(eta) => {
                let message = format!("\"{k}\" without \"{eta}\": a metal has both");
                Err(Fault::new(k, message))
            }
            None => Ok(Self::Index { eta: arguments.spectrum(eta), k: arguments.spectrum(k) }),
        }
    }

    /// Whether it varies over the surface.
    pub fn is_textured(&self) -> bool {
        match self {
            Self::Index { eta, k } => eta.is_textured() || k.is_textured(),
            Self::Reflectance(r) => r.is_textured(),
        }
    }

    /// Its value at a point.
    pub fn at(&self, roughness: &Roughness, lookup: &Lookup) -> Conductor {
        let (eta, k) = match self {
            Self::Index { eta, k } => (lookup.spectrum(eta), lookup.spectrum(k)),
            Self::Reflectance(r) => {
                // At one, k would be infinite.
                let r = lookup.spectrum(r).clamp(0.0, 0.9999);
                (Sampled::ONE, r.map(|r| 2.0 * r.sqrt() / (1.0 - r).sqrt()))
            }
        };
        Conductor { eta, k, roughness: roughness.at(lookup) }
    }
}

/// A dielectric coat with a medium under it.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatInput {
    /// Index of the coat.
    pub eta: Spectrum,
    /// Roughness of the upper interface.
    pub roughness: Roughness,
    /// Optical thickness of the medium.
    pub thickness: FloatInput,
    /// Single-scattering albedo of the medium.
    pub albedo: SpectrumInput,
    /// Mean cosine of scattering in the medium.
    pub g: FloatInput,
    /// Most events of one random walk.
    pub max_depth: u16,
    /// Random walks per value.
    pub samples: u16,
    /// How a walk's ways through the coat are weighed.
    pub weights: ExitWeights,
}

impl Default for CoatInput {
    /// The scene format's defaults: thickness 0.01, index 1.5, smooth, ten events, one walk, no scattering
    /// between the layers; weighed as the program that defines the format does.
    fn default() -> Self {
        Self {
            eta: Spectrum::Constant(1.5),
            roughness: Roughness::SMOOTH,
            thickness: FloatInput::Constant(0.01),
            albedo: SpectrumInput::Constant(Spectrum::Constant(0.0)),
            g: FloatInput::Constant(0.0),
            max_depth: 10,
            samples: 1,
            weights: ExitWeights::Pbrt4,
        }
    }
}

impl CoatInput {
    /// Whether its values are biased as pbrt-v4's are: a rough coat, weighed in the inconsistent way.
    pub fn is_inconsistent(&self) -> bool {
        self.weights == ExitWeights::Pbrt4 && !self.roughness.is_smooth()
    }

    pub(super) fn from_arguments(arguments: &Arguments, eta: &str, roughness: Roughness) -> Self {
        let limit = |name| u16::try_from(arguments.count(name)).unwrap_or(u16::MAX);
        Self {
            eta: arguments.index(eta),
            roughness,
            thickness: arguments.float("thickness"),
            albedo: arguments.spectrum("albedo"),
            g: arguments.float("g"),
            max_depth: limit("maxdepth"),
            samples: limit("nsamples"),
            weights: ExitWeights::Pbrt4,
        }
    }

    /// Whether it varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.roughness.is_textured()
            || self.thickness.is_textured()
            || self.albedo.is_textured()
            || self.g.is_textured()
    }

    /// Its value, where it is the same everywhere and at all wavelengths, and nothing scatters between the layers.
    pub(super) fn constant(&self) -> Option<Coat> {
        let eta = self.eta.constant_value()?;
        let [u, v] =
            [self.roughness.u.constant()?, self.roughness.v.constant()?].map(|r| self.roughness.alpha(r));
        if self.albedo.constant()?.constant_value()? != 0.0 {
            return None;
        }
        Some(Coat {
            interface: Dielectric { eta: clamped_index(eta), roughness: TrowbridgeReitz::new(u, v) },
            thickness: self.thickness.constant()?.max(f32::MIN_POSITIVE),
            albedo: Sampled::ZERO,
            g: self.g.constant()?.clamp(-1.0, 1.0),
            max_depth: self.max_depth,
            samples: self.samples.max(1),
            weights: self.weights,
        })
    }

    /// Its value at a point.
    pub fn at(&self, lookup: &mut Lookup) -> Coat {
        Coat {
            interface: Dielectric { eta: lookup.index(&self.eta), roughness: self.roughness.at(lookup) },
            // Walks move between two different depths.
            thickness: lookup.float(&self.thickness).max(f32::MIN_POSITIVE),
            albedo: lookup.reflectance(&self.albedo),
            g: lookup.float(&self.g).clamp(-1.0, 1.0),
            max_depth: self.max_depth,
            samples: self.samples.max(1),
            weights: self.weights,
        }
    }
}
