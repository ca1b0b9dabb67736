//! A case, and what became of it.

use super::super::meters::{MeterPoint, luminance::MeterRay};
use super::super::session::Ending;
use crate::radiometry::opening::Rectangle;
use crate::scene::MemoryFiles;
use crate::units::Estimate;

/// A situation whose closed form is known, as a scene and what is read in it.
#[derive(Clone, Debug)]
pub struct Case {
    /// Section of CIE 171:2006 that tests this kind of light transport.
    pub kind: &'static str,
    /// The situation, with its dimensions.
    pub name: String,
    /// Where the expected number comes from.
    pub formula: &'static str,
    /// What is measured.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The number that is expected.
    pub expected: f64,
    /// The scene, as pbrt-v4 text.
    pub scene: String,
    /// Files that the scene names.
    pub files: MemoryFiles,
    /// What is read in it.
    pub reading: Reading,
    /// What the reading is multiplied by.
    pub scale: f64,
}

/// What is read.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading {
    /// Illuminance at a point.
    Illuminance {
        /// Where.
        point: MeterPoint,
        /// Which light counts.
        part: Part,
    },
    /// Mean illuminance of the faces together, each on the side of its normal.
    MeanIlluminance {
        /// Where.
        faces: Vec<Rectangle>,
        /// Which light counts.
        part: Part,
    },
    /// Luminance in a single direction.
    Luminance(MeterRay),
}

/// Which light counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All.
    Total,
    /// What was reflected at least once.
    Reflected,
}

/// What became of a case.
#[derive(Clone, Debug)]
pub struct CaseResult {
    /// The case.
    pub case: Case,
    /// The number that was measured, in the case's unit.
    pub measured: Estimate,
    /// The deviation over its standard error, the half-width over the normal quantile of the session's confidence; [`ARITHMETIC`] of
    /// the number is left out of the deviation.
    pub z: f64,
    /// Rays traced.
    pub rays: u64,
    /// Why no more were traced.
    pub ending: Ending,
}

/// Share of a number that `f32` arithmetic may cost.
pub const ARITHMETIC: f64 = 2e-5;

/// Why a case could not be run.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ValidationError {
    /// Its scene is wrong.
    #[error("the scene of case {case}: {problems}")]
    Scene {
        /// The case.
        case: String,
        /// What is wrong.
        problems: String,
    },
    /// The meter cannot read there.
    #[error("case {case}: {reason}")]
    Meter {
        /// The case.
        case: String,
        /// Why.
        reason: super::super::meters::MeterError,
    },
}
