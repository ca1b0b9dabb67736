//! Light transport: estimates of radiance along camera rays, and of irradiance at sensors.

pub mod classic;
pub mod contract;
mod mis;
pub mod path;
mod vertex;

pub use classic::ClassicShading;
pub use contract::{Arriving, FirstSurface, Integrator, Metering, SensorPoint, Tally, VisibleSurface};
pub use path::PathTracer;
