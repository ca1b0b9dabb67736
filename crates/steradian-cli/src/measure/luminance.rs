//! `steradian measure luminance`: the luminance meter.

use super::common::{self, Comb, Desk, Outputs, Sampling, parse_comb};
use super::places::{self, Six, parse_six};
use crate::Failure;
use clap::Args;
use std::path::PathBuf;
use steradian::lab::Session;
use steradian::lab::meters::{
    DEFAULT_MAX_DEPTH, LuminanceReading, LuminanceSettings, MeterError, MeterRay, Shown, luminance, plots,
};
use steradian::render::CancelToken;
use steradian::units::Estimate;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Luminance {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Where the meter stands and where it looks; may be repeated
    #[arg(long, value_name = "X,Y,Z,DX,DY,DZ", value_parser = parse_six, allow_hyphen_values = true)]
    ray: Vec<Six>,
    /// File with positions and directions, six numbers a line; `-` reads standard input; may be repeated
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    rays: Vec<PathBuf>,
    /// Full angle of the cone that is measured, in degrees; 0 for a single direction
    #[arg(long, value_name = "DEGREES", default_value_t = 1.0)]
    acceptance: f64,
    /// Radius of the entrance pupil, in scene units
    #[arg(long, value_name = "LENGTH", default_value_t = 0.0)]
    aperture: f64,
    /// Measure spectral radiance at these wavelengths, such as 400:700:10 or 450,550,650, in nm
    #[arg(long, value_name = "NM,...", value_delimiter = ',', value_parser = parse_comb, conflicts_with = "radiant")]
    spectral: Vec<Comb>,
    /// Measure radiance in W/(m² sr) over 360–830 nm instead of luminance
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
Positions are in the coordinates and units of the scene's world. The reading is the mean over all directions of the
cone and all points of the pupil, each counting alike. A list of rays is what `rtrace` reads: x y z dx dy dz.
Point, spot and distant lights have no surface that a meter could look at: only what they illuminate is read.

Examples:
  steradian measure luminance --ray 278,273,-800,0,0,1 --acceptance 2
      the tall block of the built-in Cornell box, from the camera
  steradian measure luminance room.pbrt --rays - -o luminance.csv < rays.txt
  steradian measure luminance room.pbrt --ray 2,1,1.2,1,0,0 --spectral 400:700:10 --plot spectrum.svg";

pub(crate) fn run(args: &Luminance, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&args.outputs)?;
    let mut sixes = args.ray.clone();
    for file in &args.rays {
        sixes.extend(places::read(file, &args.scenes)?);
    }
    if sixes.is_empty() {
        return Err("say where to look, by --ray or --rays".to_owned().into());
    }
    let rays: Vec<MeterRay> = sixes
        .iter()
        .map(|&[x, y, z, dx, dy, dz]| MeterRay { position: [x, y, z], direction: [dx, dy, dz] })
        .collect();
    let wavelengths: Vec<f32> = args.spectral.iter().flat_map(|c| c.0.iter().copied()).collect();
    let settings =
        LuminanceSettings { max_depth: args.max_depth, acceptance: args.acceptance, aperture: args.aperture };
    let job = common::scene(&args.scenes, &args.outputs)?;
    let session = args.sampling.session(cancel);
    let said = |e: MeterError| Failure::Message(e.to_string());
    let paper = Paper { rays: &rays, wavelengths: &wavelengths, settings: &settings };
    if !wavelengths.is_empty() {
        let readings = luminance::measure_spectral(&job, &rays, &wavelengths, &settings, &session);
        paper.hand_out(desk, &readings.map_err(said)?, &session)
    } else if args.radiant {
        let readings = luminance::measure_radiant(&job, &rays, &settings, &session);
        paper.hand_out(desk, &readings.map_err(said)?, &session)
    } else {
        let readings = luminance::measure(&job, &rays, &settings, &session);
        paper.hand_out(desk, &readings.map_err(said)?, &session)
    }
}

/// What was asked for.
struct Paper<'a> {
    rays: &'a [MeterRay],
    wavelengths: &'a [f32],
    settings: &'a LuminanceSettings,
}

impl Paper<'_> {
    fn hand_out<Q: Shown>(
        &self,
        desk: Desk,
        readings: &[LuminanceReading<Q>],
        session: &Session<'_>,
    ) -> Result<(), Failure> {
        let table = luminance::table(self.rays, readings, self.wavelengths, self.settings, session);
        let draw = || {
            let quantity = format!("{} [{}]", Q::NAME, Q::UNIT);
            let all: Vec<Vec<Estimate>> = readings.iter().map(|r| r.mean.estimates()).collect();
            match self.wavelengths {
                [] => plots::along(&quantity, "ray", &all.concat()),
                wavelengths => plots::spectra(&quantity, "ray", wavelengths, &all),
            }
        };
        desk.hand_out(&table, draw, session.cancel)
    }
}
