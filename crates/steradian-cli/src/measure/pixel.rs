//! `steradian measure pixel`: a pixel of the camera as an irradiance meter.

use super::common::{self, Desk, Outputs, Sampling};
use crate::Failure;
use clap::Args;
use std::path::PathBuf;
use steradian::lab::meters::pixel::{self, f_number};
use steradian::lab::meters::{
    Aperture, DEFAULT_MAX_DEPTH, MeterError, Pixel as FilmPixel, PixelSettings, plots,
};
use steradian::render::CancelToken;
use steradian::units::{Estimate, Illuminance};

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Pixel {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Column and row of a pixel, from 0 at the upper left; may be repeated
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel, required = true)]
    pixel: Vec<FilmPixel>,
    /// Working f-number of the lens: distance of the image over diameter of the aperture [default: from the scene's lens]
    #[arg(long, value_name = "N")]
    f_number: Option<f64>,
    /// Diagonal of the film behind the scene's lens, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 35.0, conflicts_with = "f_number")]
    film_diagonal: f64,
    /// Measure irradiance in W/m² over 360–830 nm instead of illuminance
    #[arg(long)]
    radiant: bool,
    /// Most bounces of light; roulette ends most paths earlier
    #[arg(long, value_name = "N", default_value_t = DEFAULT_MAX_DEPTH)]
    max_depth: u32,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    sampling: Sampling,
}

const NOTES: &str = "\
A point of the image plane receives H = π/(4N²) ⟨L cos⁴θ⟩: L is the radiance of the rays through the aperture, θ their
angle to the axis behind it, N the working f-number. The reading is the mean over the pixel's area and the time that
the shutter is open; the exposure is H times that time. A scene states the radius of its lens but not how far the film
is behind it: that follows from the field of view and the diagonal of the film. Through a pinhole comes no light, so
that it needs an f-number. Rendered pictures hold L itself, without cos⁴θ and whatever the aperture.

Example:
  steradian measure pixel --pixel 256,256 --pixel 480,300 --f-number 2.8
      the tall block and a wall in the picture of the built-in Cornell box";

fn parse_pixel(text: &str) -> Result<FilmPixel, String> {
    let number = |s: &str| s.trim().parse::<u32>().ok();
    let found = text.split_once(',').and_then(|(x, y)| Some(FilmPixel { x: number(x)?, y: number(y)? }));
    found.ok_or_else(|| "expected a column and a row, as in 256,128".to_owned())
}

pub(crate) fn run(args: &Pixel, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&args.outputs)?;
    let job = common::scene(&args.scenes, &args.outputs)?;
    let aperture = match args.f_number {
        Some(n) => Aperture::FNumber(n),
        None => Aperture::Film(args.film_diagonal * 1e-3),
    };
    let settings = PixelSettings { max_depth: args.max_depth, aperture };
    let session = args.sampling.session(cancel);
    let said = |e: MeterError| Failure::Message(e.to_string());
    let n = f_number(&job, aperture).map_err(said)?;
    if args.radiant {
        let readings = pixel::measure_radiant(&job, &args.pixel, &settings, &session).map_err(said)?;
        let table = pixel::table(&job, &args.pixel, &readings, n, &settings, &session);
        let all: Vec<Estimate> = readings.iter().map(|r| r.arriving.estimate()).collect();
        desk.hand_out(&table, || plots::along("irradiance [W·m⁻²]", "pixel", &all), cancel)
    } else {
        let readings = pixel::measure(&job, &args.pixel, &settings, &session).map_err(said)?;
        let table = pixel::table(&job, &args.pixel, &readings, n, &settings, &session);
        let all: Vec<Estimate> = readings.iter().map(|r| r.arriving.estimate()).collect();
        let quantity = format!("{} [{}]", Illuminance::NAME, Illuminance::UNIT);
        desk.hand_out(&table, || plots::along(&quantity, "pixel", &all), cancel)
    }
}
