//! Radiometric and photometric quantities with their units.
//!
//! Newtypes stand at the doors (scene files, constructors, instruments); inside one function plain
//! `f32` with the unit in its doc line is used. The tags mark what a spectral sample measures.

pub mod density;
pub mod estimate;
pub mod kind;
pub mod measured;
pub mod quantity;

pub use density::{Density, PdfArea, PdfSolidAngle};
pub use estimate::Estimate;
pub use measured::{
    Illuminance, Luminance, LuminousFlux, LuminousIntensity, Measured, RadiantEnergy, RadiantExitance,
    SpectralIrradiance,
};
pub use quantity::{Kelvin, Nm, PerSteradian, Quantity, Radiance, Unitless};

/// Luminous efficacy constant K_m, 683.002 lm/W: maximum of photopic efficacy of radiation in air
/// (683 lm/W at 540 THz, divided by V at that frequency; CIE S 010 / ISO 23539).
pub const LUMENS_PER_WATT: f32 = 683.002;
