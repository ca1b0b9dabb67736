//! Light transport: estimates of radiance along camera rays.

pub mod classic;
pub mod contract;
mod mis;
pub mod path;
mod vertex;

pub use classic::ClassicShading;
pub use contract::{FirstSurface, Integrator, Tally, VisibleSurface};
pub use path::PathTracer;
