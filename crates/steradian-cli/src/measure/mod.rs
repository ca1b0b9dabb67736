//! `steradian measure`: virtual instruments.

mod color;
pub(crate) mod common;
mod gonio;
mod luminaire;
mod luminance;
mod lux;
mod pixel;
mod places;
mod series;
mod spectro;
mod turbid;
mod validation;

use crate::{Failure, interrupt};
use clap::Subcommand;
use steradian::render::CancelToken;

/// The instruments.
#[derive(Debug, Subcommand)]
pub(crate) enum Measure {
    /// Colour of light and of things: tristimulus values, colour temperature, colour rendering
    Color(color::Color),
    /// Where a material or a piece of geometry scatters light to: BRDF, BTDF and SPF of cells
    Gonio(Box<gonio::Gonio>),
    /// Far-field intensity distribution and total flux of a luminaire, also as IES or EULUMDAT file
    Luminaire(luminaire::Luminaire),
    /// Measure illuminance, irradiance or spectral irradiance at points of a scene
    Lux(lux::Lux),
    /// Measure luminance, radiance or spectral radiance from points of a scene in directions
    Luminance(luminance::Luminance),
    /// Measure what arrives at pixels of the image plane of the scene's camera
    Pixel(pixel::Pixel),
    /// Measure reflectance, transmittance and absorptance of a material in an integrating sphere
    Spectro(spectro::Spectro),
    /// Compare models of a turbid slab with the transport of light
    Turbid(turbid::Turbid),
    /// Carry out the measurements that a job file lists
    Series(series::Series),
    /// Hold the instruments to closed forms of lighting, and print the table
    Validation(validation::Validation),
}

pub(crate) fn run(measure: &Measure) -> Result<(), Failure> {
    execute(
        measure,
        &interrupt::token("stopping with the precision reached so far; press Ctrl-C again to stop at once"),
    )
}

fn execute(measure: &Measure, cancel: &CancelToken) -> Result<(), Failure> {
    match measure {
        Measure::Color(color) => color::run(color, cancel),
        Measure::Gonio(gonio) => gonio::run(gonio, cancel),
        Measure::Luminaire(luminaire) => luminaire::run(luminaire, cancel),
        Measure::Lux(lux) => lux::run(lux, cancel),
        Measure::Luminance(luminance) => luminance::run(luminance, cancel),
        Measure::Pixel(pixel) => pixel::run(pixel, cancel),
        Measure::Spectro(spectro) => spectro::run(spectro, cancel),
        Measure::Turbid(turbid) => turbid::run(turbid, cancel),
        Measure::Series(series) => series::run(series, cancel),
        Measure::Validation(validation) => validation::run(validation, cancel),
    }
}
