//! The finish of metals and of interfaces, beyond what pbrt-v4 knows: the shape of the facets, a thin film, and the light
//! that single scattering loses.

use super::inputs::{Lookup, Roughness, index_at};
use super::schema::{Arguments, Fault};
use crate::bsdf::Coating;
use crate::optics::compensation::{Coverage, LossTable};
use crate::optics::{FacetShape, Microfacets, TrowbridgeReitz};
use crate::spectrum::{Sampled, Spectrum};
use crate::texture::FloatInput;
use std::sync::Arc;

/// Thickest film [nm]: beyond it the fringes of daylight wash out, and it is a plate.
pub(super) const THICKEST_FILM: f32 = 10_000.0;

/// Wavelengths [nm] between which materials have optical data.
const SHORTEST: f32 = 200.0;
const LONGEST: f32 = 2500.0;

/// A thin film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmInput {
    /// Its index over that of the medium above.
    pub eta: Spectrum,
    /// Its thickness [nm].
    pub thickness: FloatInput,
}

/// The finish of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finish {
    /// Shape of the facets.
    pub shape: FacetShape,
    /// A film.
    pub film: Option<FilmInput>,
    /// What single scattering loses, where it is given back.
    pub losses: Option<Arc<LossTable>>,
}

impl Finish {
    /// From the parameters "distribution", "film.thickness" and "film.eta"; `losses` makes the table if "multiscatter" asks for it.
    pub(super) fn from_arguments(
        arguments: &Arguments,
        roughness: &Roughness,
        losses: impl FnOnce(Coverage, Option<&FilmInput>) -> Result<LossTable, Fault>,
    ) -> Result<Self, Fault> {
        let shape = match arguments.choice("distribution") {
            "beckmann" => FacetShape::Beckmann,
            _ => FacetShape::TrowbridgeReitz,
        };
        let film = match (arguments.float_opt("film.thickness"), arguments.index_opt("film.eta")) {
            (None, Some(_)) => {
                return Err(Fault::new(
                    "film.eta",
                    "\"film.eta\" without \"film.thickness\": a film has both",
                ));
            }
            // Nothing, however it is called.
            (None | Some(FloatInput::Constant(0.0)), _) => None,
            (Some(thickness), eta) => {
                Some(FilmInput { eta: eta.unwrap_or(Spectrum::Constant(1.33)), thickness })
            }
        };
        let losses = match coverage(roughness, shape) {
            Some(coverage) if arguments.flag("multiscatter") => {
                Some(Arc::new(losses(coverage, film.as_ref())?))
            }
            _ => None,
        };
        Ok(Self { shape, film, losses })
    }

    /// Whether it is nothing but GGX facets.
    pub(super) fn is_plain(&self) -> bool {
        self.shape == FacetShape::TrowbridgeReitz && self.film.is_none() && self.losses.is_none()
    }

    pub(super) fn is_textured(&self) -> bool {
        self.film.as_ref().is_some_and(|film| film.thickness.is_textured())
    }

    /// Facets of this shape, as wide as `d`.
    pub(super) fn facets(&self, d: TrowbridgeReitz) -> Microfacets {
        let [x, y] = d.alpha();
        Microfacets::new(self.shape, x, y)
    }

    /// The film at a point.
    pub(super) fn coating(&self, lookup: &Lookup) -> Option<Coating> {
        let film = self.film.as_ref()?;
        let lambda = *lookup.lambda();
        Some(Coating {
            eta: Sampled::from_fn(|i| index_at(&film.eta, lambda[i])),
            thickness_nm: lookup.float(&film.thickness).clamp(0.0, THICKEST_FILM),
            lambda,
        })
    }
}

/// The losses of an interface with the index `eta` below over above.
///
/// # Errors
/// When the thickness of the film is textured: the losses depend on it.
pub(super) fn interface_losses(
    coverage: Coverage,
    eta: &Spectrum,
    film: Option<&FilmInput>,
) -> Result<LossTable, Fault> {
    match film {
        None => {
            let (from, to) = eta.range().unwrap_or((SHORTEST, LONGEST));
            let (from, to) = (from.max(SHORTEST), to.min(LONGEST));
            let n = if eta.constant_value().is_some() { 0 } else { 1000 };
            let at = |i: u16| index_at(eta, from + (to - from) * f32::from(i) / 1000.0);
            let indices = (0..=n).map(at);
            let (min, max) = indices.fold((f32::MAX, f32::MIN), |(a, b), x| (a.min(x), b.max(x)));
            Ok(LossTable::interface(coverage, min, max))
        }
        Some(FilmInput { thickness: FloatInput::Texture(_), .. }) => Err(Fault::new(
            "multiscatter",
            "\"multiscatter\" needs a film of the same \"film.thickness\" everywhere",
        )),
        Some(FilmInput { eta: film, thickness: FloatInput::Constant(thickness) }) => Ok(LossTable::filmed(
            coverage,
            [1.0 / LONGEST, 1.0 / SHORTEST],
            *thickness,
            |lambda| index_at(eta, lambda),
            |lambda| index_at(film, lambda),
        )),
    }
}

/// The distributions that a roughness may turn out to be; `None` where it is smooth.
fn coverage(roughness: &Roughness, shape: FacetShape) -> Option<Coverage> {
    match (roughness.u, roughness.v) {
        (FloatInput::Constant(u), FloatInput::Constant(v)) => {
            let widths = TrowbridgeReitz::new(roughness.alpha(u), roughness.alpha(v));
            let [x, y] = widths.alpha();
            (!widths.is_smooth()).then(|| Coverage::One(Microfacets::new(shape, x, y)))
        }
        (u, v) if u == v => Some(Coverage::Isotropic(shape)),
        _ => Some(Coverage::Anisotropic(shape)),
    }
}
