//! Physics of one interface or one medium: Fresnel, Snell, microfacets, phase functions, absorption.
//!
//! Nothing here knows a scene, a texture or a path; randomness is an argument.

pub mod absorption;
pub mod attenuation;
pub mod complex;
pub mod dispersion;
pub mod films;
pub mod fresnel;
pub mod microfacet;
pub mod phase;
pub mod real;
pub mod refraction;

pub use films::Film;
pub use microfacet::TrowbridgeReitz;
pub use phase::HenyeyGreenstein;
