//! What the user typed, validated as far as a single argument allows.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;
use steradian::lab::probe::Angles;
use steradian::scene::NoiseTarget;
use steradian::scene::desc::MAX_SAMPLES;

/// Steradian: a spectral, physically based renderer for scenes in the pbrt-v4 format.
#[derive(Debug, Parser)]
#[command(name = "steradian", version, about, max_term_width = 100, arg_required_else_help = true)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXAMPLES: &str = "\
Examples:
  steradian render                                 the built-in Cornell box, in half a minute
  steradian render scene.pbrt -o a.exr -o a.png    a scene of your own, to measure and to look at
  steradian render scene.pbrt --spp 16 --quiet     the same, fast and rough
  steradian check scene.pbrt                       everything that is wrong with it
  steradian verify scene.pbrt --material paint     does it reflect more than arrives, is it reciprocal?
  steradian compare a.exr reference.exr            how far two pictures differ
  steradian plot scene.pbrt --material gold        how a material scatters, as a picture";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to an image; without a scene, the built-in Cornell box
    Render(Render),
    /// Describe a scene: counts, bounds, memory, lights with their power, what is unsupported
    #[command(after_help = "Example:\n  steradian info scene.pbrt")]
    Info(Inspect),
    /// Report every problem of a scene; the exit code says whether there was an error
    #[command(after_help = "Example:\n  steradian check scene.pbrt")]
    Check(Inspect),
    /// Test whether materials obey the laws of scattering: those of a scene, else all built-in specimens
    Verify(Verify),
    /// Compare two images: mean ratio, MSE, relMSE, FLIP, and a map of the error
    Compare(Compare),
    /// Print how a material of a scene scatters: f, pdf, scattering probability, reflectance, transmittance
    Bsdf(Bsdf),
    /// Draw how a material of a scene scatters: lobes, albedo, Fresnel curves, spectra; or a sphere of it
    Plot(Plot),
    /// Put a material or a scene under a virtual instrument
    #[command(subcommand)]
    Measure(crate::measure::Measure),
    /// Write a lighting report: illuminance on grids, uniformity, daylight factors, glare, luminance pictures
    Report(crate::report::Arguments),
}

#[derive(Args, Debug)]
pub(crate) struct Inspect {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
}

#[derive(Args, Debug)]
#[command(after_help = VERIFY_NOTES)]
pub(crate) struct Verify {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input [default: built-in specimens]
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Verify this material only; may be repeated
    #[arg(short, long, value_name = "NAME", requires = "scenes")]
    pub(crate) material: Vec<String>,
    /// Wavelengths to examine a scene's materials at, in nm [default: 440,520,600,680]
    #[arg(long, value_name = "NM,...", value_delimiter = ',', value_parser = parse_wavelength, requires = "scenes")]
    pub(crate) wavelengths: Vec<f32>,
    /// Accept materials that break a law as they declare; built-in specimens are judged so always
    #[arg(long)]
    pub(crate) declared: bool,
    /// How thoroughly to examine
    #[arg(long, value_enum, default_value_t = Effort::Normal)]
    pub(crate) effort: Effort,
    /// Seed of the random numbers; the same seed gives the same report
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(crate) threads: Option<u32>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub(crate) json: bool,
    /// Write a page with plots of reflectance and transmittance
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,
    /// Say nothing while at work
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const VERIFY_NOTES: &str = "\
Examples:
  steradian verify                                       all built-in specimens, in a few minutes
  steradian verify scene.pbrt --material paint --html paint.html";

/// How thoroughly materials are examined.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Few angles and samples: gross faults
    Quick,
    /// Angles from normal to grazing, a hundred thousand samples at each
    Normal,
    /// Eight times the samples
    Thorough,
}

#[derive(Args, Debug)]
#[command(after_help = RENDER_NOTES)]
pub(crate) struct Render {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Image to write: .exr, .png or .pfm; may be repeated [default: the scene's film filename]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// Samples per pixel, instead of the scene's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub(crate) spp: Option<u32>,
    /// Noise to aim at: each pixel gets as many samples as that takes, and at most --spp, instead of the same number
    #[arg(long, value_name = "PERCENT", value_parser = parse_noise)]
    pub(crate) noise: Option<NoiseTarget>,
    /// Image size in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", value_parser = parse_resolution)]
    pub(crate) resolution: Option<[u32; 2]>,
    /// Part of the image to render, as fractions of its width and height
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = parse_crop, allow_hyphen_values = true)]
    pub(crate) crop: Option<[f32; 4]>,
    /// Seed of the random numbers; the same seed gives the same image
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) seed: Option<i32>,
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(crate) threads: Option<u32>,
    /// Integrator, instead of the scene's
    #[arg(long, value_name = "NAME")]
    pub(crate) integrator: Option<String>,
    /// Longest path in bounces, instead of the scene's
    #[arg(long, value_name = "N")]
    pub(crate) max_depth: Option<u32>,
    /// Stop after the pass in which this time has passed, for example 90s, 5m or 1h
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    pub(crate) time: Option<Duration>,
    /// Say nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
    /// Print counts and timings at the end
    #[arg(long)]
    pub(crate) stats: bool,
}

const RENDER_NOTES: &str = "\
Examples:
  steradian render scene.pbrt -o picture.exr -o picture.png --spp 256
  steradian render scene.pbrt --noise 2% --spp 4096
  steradian render scene.pbrt --crop 0.25,0.75,0.25,0.75 --time 60s --stats

Noise is the standard error of a pixel's R, G and B relative to their mean (relative to a tenth of the
picture's median where a pixel is darker), as the root mean square over the picture without its noisiest
hundredth. With --noise, --spp (or the scene's count) is the most that a pixel gets; allow a few thousand.";

#[derive(Args, Debug)]
#[command(after_help = "Example:\n  steradian compare a.exr reference.exr -o difference.png")]
pub(crate) struct Compare {
    /// Image under test (EXR)
    pub(crate) image: PathBuf,
    /// Reference image (EXR) of the same size
    pub(crate) reference: PathBuf,
    /// Write a map of the error, blue (none) to red: .png or .exr
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

/// A material of a scene, as a sample on the bench.
#[derive(Args, Clone, Debug)]
pub(crate) struct Sample {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Name of the material [default: the only one that the scene states]
    #[arg(short, long, value_name = "NAME")]
    pub(crate) material: Option<String>,
    /// Texture coordinates of the point that is looked at
    #[arg(long, value_name = "U,V", default_value = "0.5,0.5", value_parser = parse_uv, allow_hyphen_values = true)]
    pub(crate) uv: [f32; 2],
}

#[derive(Args, Debug)]
#[command(after_help = BSDF_NOTES)]
pub(crate) struct Bsdf {
    #[command(flatten)]
    pub(crate) sample: Sample,
    /// Direction towards the sensor, in degrees; theta above 90 is below the surface
    #[arg(
        long,
        value_name = "THETA,PHI",
        value_parser = parse_angles,
        allow_hyphen_values = true,
        required_unless_present = "directions"
    )]
    pub(crate) wo: Option<Angles>,
    /// Direction towards the light, in degrees
    #[arg(
        long,
        value_name = "THETA,PHI",
        value_parser = parse_angles,
        allow_hyphen_values = true,
        required_unless_present = "directions"
    )]
    pub(crate) wi: Option<Angles>,
    /// File of directions, four numbers a line: wo theta, wo phi, wi theta, wi phi, in degrees; `-` reads standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["wo", "wi"])]
    pub(crate) directions: Option<PathBuf>,
    /// Wavelengths in nm
    #[arg(
        short = 'l',
        long,
        value_name = "L",
        value_delimiter = ',',
        default_value = "450,550,650",
        value_parser = parse_wavelength
    )]
    pub(crate) wavelength: Vec<f32>,
    /// What f carries: radiance is scaled by the squared index through a refraction, importance (power) is not
    #[arg(long, value_enum, default_value = "radiance")]
    pub(crate) mode: Transport,
    /// Random walks behind each value of a material that is estimated
    #[arg(long, value_name = "N", default_value = "10000", value_parser = clap::value_parser!(u32).range(2..=100_000_000))]
    pub(crate) walks: u32,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

const BSDF_NOTES: &str = "\
f has no cosine. rho and tau are the shares of power that are reflected and transmitted of light
from wi; s = f |cos theta_o| / (rho + tau) is the density of that light's scattered power over wo.

Example:
  steradian bsdf scene.pbrt --material gold --wo 30,0 --wi 45,180 --wavelength 450,550,650";

#[derive(Args, Debug)]
#[command(after_help = PLOT_NOTES)]
pub(crate) struct Plot {
    #[command(flatten)]
    pub(crate) sample: Sample,
    /// File to write: .svg or .png, for a sphere .png, .exr or .pfm; may be repeated [default: the material's name]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// What to draw
    #[arg(long, value_enum, default_value = "all", conflicts_with = "sphere")]
    pub(crate) kind: PlotKind,
    /// Wavelengths in nm
    #[arg(
        short = 'l',
        long,
        value_name = "L",
        value_delimiter = ',',
        default_value = "450,550,650",
        value_parser = parse_wavelength
    )]
    pub(crate) wavelength: Vec<f32>,
    /// Angles of the arriving light in degrees; above 90 it comes from below
    #[arg(
        short,
        long,
        value_name = "THETA",
        value_delimiter = ',',
        default_value = "0,45",
        value_parser = parse_theta
    )]
    pub(crate) theta: Vec<f64>,
    /// Radius of the lobes
    #[arg(long, value_enum, default_value = "intensity")]
    pub(crate) radius: LobeRadius,
    /// Scale of the lobes' radius: `log` shows four decades
    #[arg(long, value_enum, default_value = "linear")]
    pub(crate) scale: LobeScale,
    /// Random walks behind each value of a material that is estimated
    #[arg(long, value_name = "N", default_value = "4000", value_parser = clap::value_parser!(u32).range(2..=100_000_000))]
    pub(crate) walks: u32,
    /// Render a sphere of the material on a checkered floor instead
    #[arg(long)]
    pub(crate) sphere: bool,
    /// Samples per pixel of the sphere
    #[arg(long, value_name = "N", default_value = "64", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub(crate) spp: u32,
    /// Size of the sphere's picture in pixels
    #[arg(long, value_name = "WxH", default_value = "480x480", value_parser = parse_resolution)]
    pub(crate) resolution: [u32; 2],
    /// Say nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const PLOT_NOTES: &str = "\
Examples:
  steradian plot scene.pbrt --material gold -o gold.svg -o gold.png
  steradian plot scene.pbrt --material gold --kind lobes --theta 30,60 --scale log -o lobes.svg
  steradian plot scene.pbrt --material gold --sphere -o ball.png";

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlotKind {
    /// Polar lobes in the plane of incidence
    Lobes,
    /// Reflectance and transmittance over angle and over wavelength
    Albedo,
    /// Fresnel reflectance of both polarisations, where the material has an index
    Fresnel,
    /// Index and extinction over wavelength, or the albedo where the material has none
    Spectrum,
    /// All of them that the material has
    All,
}

/// What the radius of a lobe means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LobeRadius {
    /// f |cos theta_o|: scattered intensity for unit power
    Intensity,
    /// f: the scattering function itself
    F,
}

/// How the radius of a lobe grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LobeScale {
    /// Evenly
    Linear,
    /// By powers of ten
    Log,
}

/// What is transported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Transport {
    /// From lights to the sensor
    Radiance,
    /// From the sensor to lights
    Importance,
}

pub(crate) fn parse_angles(text: &str) -> Result<Angles, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[theta, phi]) => angles(theta, phi),
        _ => Err("expected THETA,PHI in degrees, such as 30,180".to_owned()),
    }
}

/// Angles in degrees within the range that makes sense.
pub(crate) fn angles(theta: f64, phi: f64) -> Result<Angles, String> {
    if !(0.0..=180.0).contains(&theta) {
        return Err(format!("theta must lie between 0 and 180 degrees, not {theta}"));
    }
    if !phi.is_finite() {
        return Err("phi must be a number of degrees".to_owned());
    }
    Ok(Angles { theta, phi })
}

fn parse_theta(text: &str) -> Result<f64, String> {
    let theta = text.trim().parse().map_err(|_| "expected an angle in degrees, such as 45".to_owned())?;
    angles(theta, 0.0).map(|a| a.theta)
}

pub(crate) fn parse_uv(text: &str) -> Result<[f32; 2], String> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|n| n.trim().parse().ok().filter(|x: &f32| x.is_finite())).collect();
    match numbers.as_deref() {
        Some(&[u, v]) => Ok([u, v]),
        _ => Err("expected U,V, such as 0.5,0.5".to_owned()),
    }
}

fn parse_resolution(text: &str) -> Result<[u32; 2], String> {
    let parsed =
        text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    match parsed {
        Some([w, h]) if (1..=65_536).contains(&w) && (1..=65_536).contains(&h) => Ok([w, h]),
        Some(_) => Err("width and height must lie between 1 and 65536".to_owned()),
        None => Err("expected a width and a height, such as 1280x720".to_owned()),
    }
}

pub(crate) fn parse_wavelength(text: &str) -> Result<f32, String> {
    match text.trim().trim_end_matches("nm").trim().parse() {
        Ok(nm) if (200.0..=2500.0).contains(&nm) => Ok(nm),
        Ok(_) => Err("wavelengths must lie between 200 and 2500 nm".to_owned()),
        Err(_) => Err("expected a wavelength in nm, such as 550".to_owned()),
    }
}

fn parse_crop(text: &str) -> Result<[f32; 4], String> {
    let numbers: Vec<f32> = text.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    match <[f32; 4]>::try_from(numbers) {
        Ok([x0, x1, y0, y1]) if 0.0 <= x0 && x0 < x1 && x1 <= 1.0 && 0.0 <= y0 && y0 < y1 && y1 <= 1.0 => {
            Ok([x0, x1, y0, y1])
        }
        _ => Err("expected X0,X1,Y0,Y1 with 0 <= X0 < X1 <= 1 and 0 <= Y0 < Y1 <= 1".to_owned()),
    }
}

fn parse_noise(text: &str) -> Result<NoiseTarget, String> {
    let text = text.trim();
    let (number, factor) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let fraction = number.trim().parse::<f32>().ok().map(|n| n * factor);
    match fraction.and_then(NoiseTarget::new) {
        Some(target) => Ok(target),
        None => Err("expected a percentage such as 1%, or a fraction such as 0.01, up to 100%".to_owned()),
    }
}

fn parse_duration(text: &str) -> Result<Duration, String> {
    let text = text.trim();
    let (number, factor) = match text.strip_suffix(['s', 'm', 'h']) {
        Some(number) if text.ends_with('m') => (number, 60.0),
        Some(number) if text.ends_with('h') => (number, 3600.0),
        Some(number) => (number, 1.0),
        None => (text, 1.0),
    };
    number
        .trim()
        .parse::<f64>()
        .ok()
        .filter(|n| *n > 0.0)
        .and_then(|n| Duration::try_from_secs_f64(n * factor).ok())
        .ok_or_else(|| "expected a time such as 60s, 5m or 1h".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        use clap::CommandFactory as _;
        Cli::command().debug_assert();
    }

    /// Every command shows an example in its help, and every example is one that the program accepts.
    #[test]
    fn every_help_has_an_example_that_parses() {
        use clap::CommandFactory as _;
        fn visit(command: &clap::Command, path: &str) {
            let path = format!("{path} {}", command.get_name());
            if command.has_subcommands() {
                command.get_subcommands().filter(|c| c.get_name() != "help").for_each(|c| visit(c, &path));
                return;
            }
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let examples: Vec<&str> =
                help.lines().map(str::trim).filter(|l| l.starts_with("steradian ")).collect();
            assert!(
                examples.iter().any(|e| format!(" {e} ").starts_with(&format!("{path} "))),
                "{path} has no example of its own"
            );
            for example in examples {
                // What follows several spaces explains; what follows a bar or an arrow is the shell's.
                let words = example.split("   ").next().unwrap_or("").split(['|', '<']).next().unwrap_or("");
                if let Err(e) = Cli::try_parse_from(words.split_whitespace()) {
                    panic!("{path}: {example}\n{e}");
                }
            }
        }
        Cli::command().get_subcommands().for_each(|c| visit(c, " steradian"));
    }

    #[test]
    fn resolutions_crops_and_times_are_checked() {
        assert_eq!(parse_resolution("640x480"), Ok([640, 480]));
        assert!(parse_resolution("0x480").is_err() && parse_resolution("640").is_err());
        assert!(parse_resolution("-1x4").is_err() && parse_resolution("99999999999x4").is_err());
        assert_eq!(parse_crop("0,0.5,0.25,1"), Ok([0.0, 0.5, 0.25, 1.0]));
        assert!(parse_crop("0.5,0.5,0,1").is_err() && parse_crop("0,1,0").is_err());
        assert!(parse_crop("nan,1,0,1").is_err());
        assert_eq!(parse_angles("30, -20"), Ok(Angles { theta: 30.0, phi: -20.0 }));
        assert!(
            parse_angles("30").is_err() && parse_angles("181,0").is_err() && parse_angles("nan,0").is_err()
        );
        assert!(parse_wavelength("0").is_err() && parse_wavelength("inf").is_err());
        assert!(parse_uv("1").is_err() && parse_uv("nan,0").is_err());
        assert_eq!(parse_noise("2%").map(NoiseTarget::get), Ok(0.02));
        assert_eq!(parse_noise(" 0.5 % "), parse_noise("0.005"));
        for said in ["20 %", "0.1 %", "33.3 %", "0.0001 %"] {
            assert_eq!(parse_noise(said).map(|noise| noise.to_string()).as_deref(), Ok(said));
        }
        for wrong in ["0", "2", "-1%", "101%", "nan", "%", "little"] {
            assert!(parse_noise(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse_duration("90s"), Ok(Duration::from_secs(90)));
        assert_eq!(parse_duration("1.5m"), Ok(Duration::from_secs(90)));
        assert!(
            parse_duration("0").is_err()
                && parse_duration("soon").is_err()
                && parse_duration("1e300h").is_err()
        );
    }
}
