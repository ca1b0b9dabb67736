//! Light meters in a scene: what arrives at a point, or from a direction.
//!
//! Positions and directions are those of the scene's world, as after `WorldBegin` without transforms. A scene that moves is
//! measured at the moment when the camera's shutter opens.

mod bench;
mod contract;
mod facts;
pub mod luminance;
pub mod lux;
pub mod pixel;
pub mod plots;

pub use contract::{DEFAULT_MAX_DEPTH, Effort, MeterError, Shown};
pub use luminance::{LuminanceReading, LuminanceSettings, MeterRay, RadiantRadiance, SpectralRadiance};
pub use lux::{Aim, LuxReading, LuxSettings, MeterPoint, RadiantIrradiance};
pub use pixel::{Aperture, Pixel, PixelReading, PixelSettings};
