//! Steradian: spectral, physically based rendering and virtual light measurement.
//!
//! The modules are listed in the order in which data flows through them; a module imports only
//! from modules above it (checked by `cargo xtask layers`).

// 0: quantities and geometry
pub mod units;
pub mod math;
// 1: functions of wavelength, colour, pictures
pub mod spectrum;
pub mod color;
pub mod image;
// 2: physics of scattering
pub mod optics;
pub mod radiometry;
pub mod bsdf;
// 3: what a scene is made of
pub mod texture;
pub mod material;
pub mod shape;
pub mod accel;
pub mod light;
pub mod camera;
pub mod sampler;
// 4: text -> description -> compiled scene
pub mod scene;
// 5: light transport
pub mod film;
pub mod integrator;
// 6: execution
pub mod render;
pub mod lab;

/// The pages that show code: what they show compiles.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../../../README.md")]
    mod readme {}
    #[doc = include_str!("../../../docs/instruments.md")]
    mod instruments {}
}
