//! `steradian measure turbid`: how far teaching models are from the transport of light.

use super::common::{Desk, Outputs};
use crate::Failure;
use clap::Args;
use steradian::lab::turbid;
use steradian::optics::adding_doubling::{Below, Slab};
use steradian::render::CancelToken;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Turbid {
    /// Single-scattering albedo of the medium, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.9)]
    pub(crate) albedo: f64,
    /// Optical thicknesses; `inf` is a half-space
    #[arg(long, value_name = "T,...", value_delimiter = ',', default_value = "0.1,0.3,1,3,10,inf", value_parser = parse_thickness)]
    pub(crate) thickness: Vec<f64>,
    /// Mean cosine of scattering, -0.99 to 0.99 (Henyey-Greenstein)
    #[arg(long, value_name = "G", default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) anisotropy: f64,
    /// Index of the medium over that of its surroundings, 1 to 10
    #[arg(long, value_name = "ETA", default_value_t = 1.0)]
    pub(crate) eta: f64,
    /// Reflectance of a Lambertian surface below, in optical contact [default: nothing, light passes]
    #[arg(long, value_name = "SHARE")]
    pub(crate) substrate: Option<f64>,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
}

const NOTES: &str = "\
R and T are shares of the incident power, by radiative transport in a plane slab (adding-doubling). Beside them
stand the two-flux model of Kubelka and Munk with Saunderson's boundaries, and the dipole of diffusion theory for
half-spaces, each with its error. Both are teaching models.

Example:
  steradian measure turbid --albedo 0.9 --thickness 0.5,1,2,inf --eta 1.5 -o slab.csv --plot slab.svg";

pub(crate) fn run(arguments: &Turbid, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&arguments.outputs)?;
    let below = arguments.substrate.map_or(Below::Surroundings, Below::Lambertian);
    let Turbid { albedo, anisotropy, eta, .. } = *arguments;
    let turbid = turbid::Turbid {
        slab: Slab { albedo, depth: 0.0, anisotropy, eta, below },
        depths: arguments.thickness.clone(),
    };
    let comparisons = turbid.compare().map_err(|e| e.to_string())?;
    desk.hand_out(&turbid.table(&comparisons), || turbid.drawing(), cancel)
}

fn parse_thickness(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|x| *x >= 0.0);
    number.ok_or_else(|| "expected an optical thickness from 0 up, such as 1.5, or inf".to_owned())
}
