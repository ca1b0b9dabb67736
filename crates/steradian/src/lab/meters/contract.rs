//! What all light meters share: where they stand, what can be wrong with that, and what a reading took.

use super::super::session::Ending;
use super::super::subject::Subject;
use crate::integrator::Metering;
use crate::math::{BoundedPoint, Dir, Normal, Point, Vec3};
use crate::render::setup;
use crate::scene::RenderJob;
use crate::units::kind::Unit;
use crate::units::{Estimate, Measured};
use glam::DVec3;

/// Most bounces of a path where no other number is asked for. Roulette ends most paths far earlier: this is for light that no surface
/// absorbs. Of a reflectance of 99 % it cuts off 4·10⁻⁵ of the light.
pub const DEFAULT_MAX_DEPTH: u32 = 1000;

/// A point on a surface is lifted off it by this share of its largest coordinate (2⁻²⁰, sixteen roundings).
const LIFT: f64 = 1.0 / 1_048_576.0;

/// Why a meter cannot read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeterError {
    /// The scene is for legacy shading.
    #[error(
        "the scene asks for integrator \"classic\", legacy shading that is no light transport: what it shows cannot be \
         measured"
    )]
    NotTransport,
    /// A coordinate that is not a number, or too large.
    #[error("position {} is not finite", .0 + 1)]
    NotFinite(usize),
    /// A direction or a normal without length.
    #[error("the direction at position {} has no length", .0 + 1)]
    NoDirection(usize),
    /// A wavelength [nm].
    #[error("{0} nm is no wavelength")]
    NoWavelength(f32),
    /// No wavelength at all.
    #[error("a spectral reading needs at least one wavelength")]
    NoWavelengths,
    /// A wavelength without data.
    #[error("wavelength {wavelength} nm: the data of material \"{material}\" reach from {lo} to {hi} nm")]
    NoData {
        /// The wavelength [nm].
        wavelength: f32,
        /// Whose data.
        material: String,
        /// Where they begin [nm].
        lo: f32,
        /// Where they end [nm].
        hi: f32,
    },
    /// An angle of acceptance [degrees].
    #[error("the acceptance angle must lie between 0 and 180 degrees, not {0}")]
    Acceptance(f64),
    /// A radius of an aperture [scene units].
    #[error("the radius of the aperture must be at least 0 and finite, not {0}")]
    Aperture(f64),
    /// A pixel that the film has not got.
    #[error("pixel {x}, {y}: the film has {width} by {height} pixels")]
    OffFilm {
        /// Column, from 0.
        x: u32,
        /// Row, from 0.
        y: u32,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// An f-number, or the diagonal of a film [m].
    #[error("f-number and diagonal of the film must be positive, not {0}")]
    ImagePlane(f64),
    /// A camera whose aperture has no area.
    #[error("the scene's camera is a pinhole, through which no light comes: state the f-number of its lens")]
    Pinhole,
    /// A camera whose film receives no irradiance that could be stated.
    #[error("a {0} camera has no image plane with an irradiance")]
    NoImagePlane(&'static str),
}

/// What a reading took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Rays traced.
    pub rays: u64,
    /// Samples taken: paths, of which each spectral reading takes one for four wavelengths.
    pub samples: u64,
    /// Samples that found light.
    pub lit: u64,
    /// Samples that were not finite and count as dark.
    pub dropped: u64,
    /// Why no more were taken.
    pub ending: Ending,
}

impl Effort {
    /// What one must know to trust the reading; `None` when it is as precise as was asked for.
    pub fn note(&self) -> Option<String> {
        let mut notes = Vec::new();
        if self.lit == 0 {
            notes.push(format!("dark: none of {} paths found light", self.samples));
        }
        if self.dropped > 0 {
            notes.push(format!("{} samples that were not finite count as dark", self.dropped));
        }
        if self.ending != Ending::Precise {
            notes.push(self.ending.name().to_owned());
        }
        (!notes.is_empty()).then(|| notes.join("; "))
    }
}

/// What a meter shows: one number, or one for each wavelength.
pub trait Shown {
    /// Name of the quantity.
    const NAME: &'static str;
    /// Its SI unit.
    const UNIT: &'static str;
    /// The numbers, in the SI unit.
    fn estimates(&self) -> Vec<Estimate>;
}

impl<K: Unit<D> + Copy, D: Copy> Shown for Measured<K, D> {
    const NAME: &'static str = K::NAME;
    const UNIT: &'static str = K::UNIT;
    fn estimates(&self) -> Vec<Estimate> {
        vec![self.estimate()]
    }
}

impl<K: Unit<D> + Copy, D: Copy> Shown for Vec<Measured<K, D>> {
    const NAME: &'static str = K::NAME;
    const UNIT: &'static str = K::UNIT;
    fn estimates(&self) -> Vec<Estimate> {
        self.iter().map(|m| m.estimate()).collect()
    }
}

/// The integrator that instruments use.
pub(super) fn metering(job: &RenderJob, max_depth: u32) -> Result<Box<dyn Metering + '_>, MeterError> {
    setup::metering(job, max_depth).ok_or(MeterError::NotTransport)
}

/// A point of the scene's world as rays meet it. The bound is so wide that a point which the user places on a surface is
/// outside of it, wherever rounding puts the one and the other.
pub(super) fn place(job: &RenderJob, index: usize, p: [f64; 3]) -> Result<BoundedPoint, MeterError> {
    let world = DVec3::from_array(p);
    let render = job.world_from_render.inverse_matrix().as_dmat4().transform_point3(world);
    let bound = world.abs().max_element().max(render.abs().max_element()) * LIFT;
    let placed = BoundedPoint { p: Point(render.as_vec3()), error: Vec3::splat(bound as f32) };
    if placed.p.is_finite() && placed.error.is_finite() {
        Ok(placed)
    } else {
        Err(MeterError::NotFinite(index))
    }
}

/// A normal of the scene's world as rays meet it.
pub(super) fn normal(job: &RenderJob, index: usize, n: [f64; 3]) -> Result<Normal, MeterError> {
    let unit = Normal::new(unit(n).ok_or(MeterError::NoDirection(index))?);
    let turned = unit.and_then(|n| job.world_from_render.inverse().normal(n));
    turned.ok_or(MeterError::NoDirection(index))
}

/// A direction of the scene's world as rays meet it.
pub(super) fn direction(job: &RenderJob, index: usize, d: [f64; 3]) -> Result<Dir, MeterError> {
    let unit = Dir::new(unit(d).ok_or(MeterError::NoDirection(index))?);
    let turned = unit.and_then(|d| job.world_from_render.inverse().direction(d));
    turned.ok_or(MeterError::NoDirection(index))
}

/// Directions may have any length that an `f64` can have.
fn unit(d: [f64; 3]) -> Option<Vec3> {
    DVec3::from_array(d).try_normalize().map(|d| d.as_vec3())
}

/// Refuses wavelengths [nm] for which a material of the scene has no data.
pub(super) fn check_wavelengths(job: &RenderJob, wavelengths: &[f32]) -> Result<(), MeterError> {
    if wavelengths.is_empty() {
        return Err(MeterError::NoWavelengths);
    }
    if let Some(&bad) = wavelengths.iter().find(|l| !(**l > 0.0 && l.is_finite())) {
        return Err(MeterError::NoWavelength(bad));
    }
    for subject in Subject::all(job) {
        let (lo, hi) = subject.range();
        if let Some(&wavelength) = wavelengths.iter().find(|l| !(lo..=hi).contains(*l)) {
            return Err(MeterError::NoData { wavelength, material: subject.name().to_owned(), lo, hi });
        }
    }
    Ok(())
}
