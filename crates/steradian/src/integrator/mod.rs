//! Light transport: estimates of radiance along camera rays.

pub mod contract;
mod mis;
pub mod path;

pub use contract::{FirstSurface, Integrator, Tally, VisibleSurface};
pub use path::PathTracer;
