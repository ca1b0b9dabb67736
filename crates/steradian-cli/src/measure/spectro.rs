//! `steradian measure spectro`: a spectrophotometer with an integrating sphere.

use super::common::{Comb, Desk, Outputs, Sampling, parse_comb};
use crate::args::Sample;
use crate::{Failure, pick};
use clap::{Args, ValueEnum};
use steradian::lab::probe::Angles;
use steradian::lab::spectro::{self, Beams, Face, Incidence, Setup, View};
use steradian::render::CancelToken;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Spectro {
    #[command(flatten)]
    pub(crate) sample: Sample,
    /// Wavelengths in nm: 550, or 400:700:10 for a comb
    #[arg(short = 'l', long, value_name = "NM,...", value_delimiter = ',', default_value = "400:700:10", value_parser = parse_comb)]
    pub(crate) wavelength: Vec<Comb>,
    /// Angles of the beam to the normal in degrees, above 90 from below; `diffuse` and `diffuse-below` for light from everywhere
    #[arg(long, value_name = "ANGLE,...", value_delimiter = ',', default_value = "8", value_parser = parse_incidence)]
    pub(crate) incidence: Vec<Incidence>,
    /// Azimuth of the beams in degrees
    #[arg(long, value_name = "PHI", default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) azimuth: f64,
    /// How numbers come about
    #[arg(long, value_enum, default_value_t = Method::Auto)]
    pub(crate) method: Method,
    /// Also the reflectance factor, in a cone about this direction in degrees
    #[arg(long, value_name = "THETA,PHI", value_parser = parse_view, allow_hyphen_values = true)]
    pub(crate) view: Option<Angles>,
    /// Half-angle of that cone in degrees
    #[arg(long, value_name = "ANGLE", default_value_t = 5.0, requires = "view")]
    pub(crate) cone: f64,
    /// The sphere: what it would read is shown beside the truth
    #[arg(long, value_enum, default_value_t = Sphere::Ideal)]
    pub(crate) sphere: Sphere,
    /// Reflectance of the sphere's wall
    #[arg(long, value_name = "SHARE", default_value_t = 0.98)]
    pub(crate) wall: f64,
    /// Share of the sphere's area that the port takes
    #[arg(long, value_name = "SHARE", default_value_t = 0.02)]
    pub(crate) port: f64,
    /// Reflectance of the standard
    #[arg(long, value_name = "SHARE", default_value_t = 1.0)]
    pub(crate) standard: f64,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) sampling: Sampling,
}

/// How numbers come about.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// In closed form where the material has one, else by sampling
    Auto,
    /// In closed form
    Exact,
    /// Photon by photon
    Sampled,
}

/// What surrounds the sample.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sphere {
    /// Reads the truth
    Ideal,
    /// Sample and standard in turn: has the error of substitution
    SingleBeam,
    /// A second beam corrects it
    DoubleBeam,
}

const NOTES: &str = "\
Reflectance, transmittance and absorptance are shares of the power that falls on the material: directional-hemispherical
for a beam, bihemispherical for diffuse light. By sampling, photons are counted where they end: reflected,
transmitted, or absorbed, which is what becomes of all that is not scattered on. R + T + A exceeds one where a
material makes light. Without a --floor, shares below 1 % are measured as
precisely as 1 % would be.

Example (a pane of green glass, 1 mm thick; glass.pbrt):
  WorldBegin
  MakeNamedMaterial \"pane\" \"string type\" \"stack\" \"float thickness\" 1e-3 \"float eta\" 1.5
    \"float absorption\" 100

  steradian measure spectro glass.pbrt --material pane --incidence 8,60,diffuse --wavelength 400:700:50
  steradian measure spectro glass.pbrt --sphere single-beam --method sampled --precision 2% -o pane.csv --plot pane.svg";

pub(crate) fn run(arguments: &Spectro, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&arguments.outputs)?;
    let job = arguments.sample.job()?;
    let subject = arguments.sample.subject(&job)?;
    let wavelengths: Vec<f32> = arguments.wavelength.iter().flat_map(|c| c.0.iter().copied()).collect();
    pick::check_wavelengths(&subject, &wavelengths)?;
    let turned = |incidence: &Incidence| match *incidence {
        Incidence::Beam(angles) => Incidence::Beam(Angles { phi: arguments.azimuth, ..angles }),
        diffuse @ Incidence::Diffuse(_) => diffuse,
    };
    let sphere = |beams| spectro::Sphere {
        wall: arguments.wall,
        port: arguments.port,
        standard: arguments.standard,
        beams,
    };
    let setup = Setup {
        wavelengths,
        incidences: arguments.incidence.iter().map(turned).collect(),
        method: match arguments.method {
            Method::Auto => spectro::Method::Auto,
            Method::Exact => spectro::Method::Exact,
            Method::Sampled => spectro::Method::Sampled,
        },
        view: arguments.view.map(|direction| View { direction, half_angle: arguments.cone }),
        sphere: match arguments.sphere {
            Sphere::Ideal => None,
            Sphere::SingleBeam => Some(sphere(Beams::Single)),
            Sphere::DoubleBeam => Some(sphere(Beams::Double)),
        },
    };
    let session = arguments.sampling.session(cancel);
    let spectrum = spectro::measure(&subject, &setup, &session).map_err(|e| e.to_string())?;
    desk.hand_out(&spectrum.table(), || spectrum.drawing(), cancel)
}

fn parse_incidence(text: &str) -> Result<Incidence, String> {
    match text.trim() {
        "diffuse" => Ok(Incidence::Diffuse(Face::Above)),
        "diffuse-below" => Ok(Incidence::Diffuse(Face::Below)),
        angle => {
            let theta = angle.trim_end_matches('°').parse::<f64>().ok().filter(|t| (0.0..=180.0).contains(t));
            let theta = theta.filter(|t| (t - 90.0).abs() > 1e-6);
            let theta =
                theta.ok_or("expected an angle from 0 to 180 other than 90, diffuse, or diffuse-below")?;
            Ok(Incidence::Beam(Angles { theta, phi: 0.0 }))
        }
    }
}

fn parse_view(text: &str) -> Result<Angles, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    match numbers.as_slice() {
        [theta, phi] if (0.0..90.0).contains(theta) && phi.is_finite() => {
            Ok(Angles { theta: *theta, phi: *phi })
        }
        _ => Err("expected THETA,PHI in degrees with 0 <= THETA < 90".to_owned()),
    }
}
