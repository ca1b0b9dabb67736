//! Physics of one interface or one medium: Fresnel, Snell, microfacets, phase functions, absorption.
//!
//! Nothing here knows a scene, a texture or a path; randomness is an argument.

pub mod absorption;
pub mod adding_doubling;
pub mod attenuation;
pub mod compensation;
pub mod complex;
pub mod deviation;
pub mod diffusion;
pub mod dispersion;
pub mod films;
pub mod fresnel;
pub mod hemispherical;
pub mod indices;
pub mod microfacet;
pub mod multilayer;
pub mod phase;
pub mod plate;
pub mod quadrature;
pub mod real;
pub mod refraction;
pub mod shares;
pub mod slab;
pub mod two_flux;

pub use films::Film;
pub use microfacet::{Distribution, FacetShape, Microfacets, TrowbridgeReitz};
pub use phase::HenyeyGreenstein;
pub use shares::Shares;
