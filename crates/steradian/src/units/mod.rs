//! Radiometric and photometric quantities with their units.
//!
//! Newtypes stand at the doors (scene files, constructors, instruments); inside one function plain
//! `f32` with the unit in its doc line is used. The tags mark what a spectral sample measures.

pub mod conversion;
pub mod density;
pub mod estimate;
pub mod extent;
pub mod kind;
pub mod measured;
pub mod quantity;

pub use conversion::Efficacy;
pub use density::{Density, PdfArea, PdfSolidAngle};
pub use estimate::Estimate;
pub use extent::{
    Bandwidth, Cosine, ForeshortenedArea, Metres, ProjectedSolidAngle, Reflectance, Seconds, SolidAngle,
    SquareMetres,
};
pub use kind::{
    AlphaOpic, Energy, EquivalentDaylight, Exitance, Flux, Intensity, Irradiance, LCone, Luminous, MCone,
    Melanopic, Radiant, Rhodopic, SCone, Scotopic, Spectral, Unit, Weighted,
};
pub use measured::{
    Illuminance, Luminance, LuminousExitance, LuminousFlux, LuminousIntensity, Measured,
    MelanopicIlluminance, RadiantEnergy, RadiantExitance, RadiantFlux, SpectralIrradiance,
};
pub use quantity::{Kelvin, Nm, PerSteradian, Quantity, Radiance, Unitless};

/// Luminous efficacy constant K_m, 683.002 lm/W: maximum of photopic efficacy of radiation in air
/// (683 lm/W at 540 THz, divided by V at that frequency; CIE S 010 / ISO 23539).
pub const LUMENS_PER_WATT: f32 = 683.002;

/// Scotopic luminous efficacy constant K′_m, 1700.05 lm/W: maximum of scotopic efficacy of radiation in air
/// (683 lm/W at 540 THz, divided by V′ at that frequency; CIE S 010 / ISO 23539).
pub const SCOTOPIC_LUMENS_PER_WATT: f32 = 1700.05;
