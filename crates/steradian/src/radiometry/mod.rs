//! Closed forms of radiometry, in `f64`: what instruments and renderings are held against.
//!
//! Each function cites where its equation comes from. Shapes are black to each other but for what is said; surfaces are
//! diffuse and of even radiance.

mod quadrature;
pub mod solid_angle;
pub mod polygon;
pub mod configuration;
pub mod view_factor;
pub mod enclosure;
pub mod luminaire;
pub mod daylight;
pub mod opening;
