//! Settings given outside the scene, which win over the scene's own.

use super::desc::{ClassicDesc, IntegratorKind, MAX_SAMPLES, NoiseTarget, PathDesc, SamplerKind, SceneDesc};
use super::diagnostic::nearest;

/// What a user may change without touching the scene; `None` leaves the scene's value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Samples per pixel, from 1 to [`MAX_SAMPLES`].
    pub spp: Option<u32>,
    /// The noise to aim at.
    pub noise: Option<NoiseTarget>,
    /// Width and height [pixels], ≥ 1.
    pub resolution: Option<[u32; 2]>,
    /// Part of the picture x0, x1, y0, y1 as fractions, ascending in [0, 1].
    pub crop: Option<[f32; 4]>,
    /// Seed of all random numbers.
    pub seed: Option<i32>,
    /// Name of the integrator.
    pub integrator: Option<String>,
    /// Most bounces of a path.
    pub max_depth: Option<u32>,
}

/// An override that cannot be followed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OverrideError {
    /// The integrator is not known.
    #[error("unknown integrator \"{name}\"{}", hint(.suggestion.as_deref()))]
    UnknownIntegrator {
        /// As given.
        name: String,
        /// The nearest known name.
        suggestion: Option<String>,
    },
    /// A count of zero, or a crop window without area.
    #[error("{0} must be positive")]
    NotPositive(&'static str),
    /// More samples per pixel than a sequence has.
    #[error("{0} samples per pixel are more than the {MAX_SAMPLES} that a pixel can have")]
    TooManySamples(u32),
}

fn hint(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(
        || format!("; known are \"{}\"", INTEGRATORS.join("\" and \"")),
        |s| format!("; did you mean \"{s}\"?"),
    )
}

/// Integrators that can be asked for by name.
const INTEGRATORS: [&str; 2] = ["path", "classic"];

/// Bounces where neither the scene nor the user says (pbrt's default).
const DEFAULT_DEPTH: u32 = 5;

impl Overrides {
    /// Writes the overrides into a description.
    ///
    /// # Errors
    /// An unknown integrator, a zero count, an empty crop window.
    pub fn apply(&self, desc: &mut SceneDesc) -> Result<(), OverrideError> {
        if let Some(spp) = self.spp {
            if spp == 0 {
                return Err(OverrideError::NotPositive("samples per pixel"));
            }
            if spp > MAX_SAMPLES {
                return Err(OverrideError::TooManySamples(spp));
            }
            desc.sampler.pixel_samples = spp;
            // Strata are a count of samples, too: keep them as square as the new count allows.
            if let SamplerKind::Stratified { x, y, .. } = &mut desc.sampler.kind {
                *x = (1..=spp.isqrt()).rev().find(|n| spp.is_multiple_of(*n)).unwrap_or(1);
                *y = spp / *x;
            }
        }
        if self.noise.is_some() {
            desc.sampler.noise = self.noise;
        }
        if let Some(seed) = self.seed {
            desc.sampler.seed = Some(seed);
        }
        if let Some(resolution) = self.resolution {
            if resolution.contains(&0) {
                return Err(OverrideError::NotPositive("resolution"));
            }
            desc.film.resolution = resolution;
            // Pixel bounds of another resolution have no meaning.
            desc.film.pixel_bounds = None;
        }
        if let Some(crop) = self.crop {
            let [x0, x1, y0, y1] = crop;
            if !(0.0 <= x0 && x0 < x1 && x1 <= 1.0 && 0.0 <= y0 && y0 < y1 && y1 <= 1.0) {
                return Err(OverrideError::NotPositive("area of the crop window"));
            }
            desc.film.crop_window = Some(crop);
            desc.film.pixel_bounds = None;
        }
        if let Some(name) = &self.integrator {
            match name.as_str() {
                "path" => {
                    desc.integrator.kind = IntegratorKind::Path(PathDesc {
                        max_depth: max_depth(&mut desc.integrator.kind).map_or(DEFAULT_DEPTH, |d| *d),
                        regularize: false,
                        light_sampler: None,
                    });
                }
                "classic" => {
                    // The scene's own surroundings stay.
                    if !matches!(desc.integrator.kind, IntegratorKind::Classic(_)) {
                        desc.integrator.kind = IntegratorKind::Classic(ClassicDesc::default());
                    }
                }
                _ => {
                    let suggestion = nearest(name, INTEGRATORS).map(str::to_owned);
                    return Err(OverrideError::UnknownIntegrator { name: name.clone(), suggestion });
                }
            }
        }
        if let (Some(depth), Some(field)) = (self.max_depth, max_depth(&mut desc.integrator.kind)) {
            *field = depth;
        }
        Ok(())
    }
}

/// The field that limits path length; what traces no paths has none.
fn max_depth(kind: &mut IntegratorKind) -> Option<&mut u32> {
    match kind {
        IntegratorKind::Path(p) | IntegratorKind::VolPath(p) => Some(&mut p.max_depth),
        IntegratorKind::SimplePath { max_depth }
        | IntegratorKind::SimpleVolPath { max_depth }
        | IntegratorKind::LightPath { max_depth }
        | IntegratorKind::RandomWalk { max_depth }
        | IntegratorKind::Bdpt { max_depth, .. }
        | IntegratorKind::Mlt { max_depth, .. }
        | IntegratorKind::Sppm { max_depth } => Some(max_depth),
        IntegratorKind::AmbientOcclusion | IntegratorKind::Classic(_) => None,
    }
}
