//! Skies and the sun.

mod atmosphere;
mod compass;
mod dome;
mod luminance;
mod moment;
mod solar;
mod sun;

pub use atmosphere::{Atmosphere, ClearSkyIrradiance, ClearSkySpectra, Daylight};
pub use compass::{Compass, Handedness};
pub use dome::{Ground, SkyLight, SkyPlacement};
pub use luminance::{GeneralSky, SkyIntegrals, SkyLuminance, SkyModel};
pub use moment::{Moment, MomentError};
pub use solar::{Place, SolarPosition};
pub use sun::{SUN_ANGULAR_RADIUS, SunLight};

#[cfg(test)]
mod laws;
