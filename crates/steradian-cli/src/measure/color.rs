//! `steradian measure color`: the colour of light and of things.

use super::common::{Comb, Desk, Outputs, Sampling, parse_comb, scene};
use super::places::{Six, parse_six};
use crate::Failure;
use crate::output::reason;
use clap::{Args, ValueEnum};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use steradian::color::colorimetry::Xy;
use steradian::lab::Ending;
use steradian::lab::color::{
    Choice, Noise, SpectralData, Spot, diagram, light, light_table, object, object_table,
};
use steradian::lab::meters::{LuxReading, LuxSettings, MeterPoint, lux};
use steradian::lab::table::Fact;
use steradian::render::CancelToken;
use steradian::scene::nearest;
use steradian::spectrum::named::{self, named};
use steradian::units::{Estimate, SpectralIrradiance};

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Color {
    /// Scene files in the pbrt-v4 format, read as one, for --point; `-` reads standard input
    #[arg(value_name = "SCENE", requires = "point")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Spectrum of a light: a built-in name, or a file (- for standard input); may be repeated
    #[arg(long, value_name = "NAME|FILE")]
    spectrum: Vec<String>,
    /// Light that arrives at a point of the scene, on a plane with that normal; may be repeated
    #[arg(long, value_name = "X,Y,Z,NX,NY,NZ", value_parser = parse_six, allow_hyphen_values = true)]
    point: Vec<Six>,
    /// Wavelengths at which that light is measured, in nm
    #[arg(long, value_name = "NM,...", value_delimiter = ',', value_parser = parse_comb, default_value = "380:780:10")]
    spectral: Vec<Comb>,
    /// Reflectance (or transmittance) of a thing: a file (- for standard input); may be repeated
    #[arg(long, value_name = "FILE", conflicts_with_all = ["spectrum", "point"])]
    reflectance: Vec<String>,
    /// What the thing is seen under
    #[arg(long, value_name = "NAME|FILE", default_value = "stdillum-D65")]
    illuminant: String,
    /// Column of a table of several quantities that is meant [default: the first after the wavelength]
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
    /// Rows of a table of several spectra that are meant, such as `point=2`
    #[arg(long, value_name = "COLUMN=WORD", value_parser = parse_rows)]
    rows: Option<Rows>,
    /// How the errors of a file's rows go together
    #[arg(long, value_enum, default_value_t = Together::Unknown)]
    noise: Together,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    sampling: Sampling,
}

/// How errors go together.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Together {
    /// In any way, as in a simulation, whose readings share their paths: the widest intervals
    Unknown,
    /// Each row by itself
    Independent,
}

const NOTES: &str = "\
Light: X, Y, Z, chromaticity, correlated colour temperature with Duv, colour rendering indices Ra and R1-R14
(CIE 13.3). Things: X, Y, Z, chromaticity and CIE L*a*b* under the illuminant.

With --point the spectral irradiance there is measured first, each wavelength to the precision asked for.

Files hold a wavelength [nm] and a value in each row, and perhaps the half-width of its interval; or they are CSV with
headings such as `wavelength [nm],spectral irradiance [W·m⁻²·nm⁻¹]`, as `steradian measure` writes them. With such a
unit, Y is in lx (cd·m⁻², cd, lm), else 100. Intervals are carried on to every result.

Examples:
  steradian measure color --spectrum stdillum-F11
  steradian measure color --spectrum stdillum-A --spectrum stdillum-LED-B1 -o lamps.csv --plot lamps.svg
  steradian measure color --point 450,0,150,0,1,0 --precision 5%
      the light on the floor of the built-in Cornell box
  printf '400 0.1\\n500 0.3\\n700 0.8\\n' | steradian measure color --reflectance - --illuminant stdillum-D50";

/// A column and what rows have in it.
#[derive(Clone, Debug)]
struct Rows {
    column: String,
    word: String,
}

fn parse_rows(text: &str) -> Result<Rows, String> {
    let (column, word) = text.split_once('=').ok_or("expected a column and a word, such as point=2")?;
    Ok(Rows { column: column.trim().to_owned(), word: word.trim().to_owned() })
}

pub(crate) fn run(color: &Color, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&color.outputs)?;
    let noise = match color.noise {
        Together::Unknown => Noise::Unknown,
        Together::Independent => Noise::Independent,
    };
    if color.reflectance.is_empty() {
        let mut spectra = color.spectrum.iter().map(|s| color.spectrum(s)).collect::<Result<Vec<_>, _>>()?;
        let mut facts = Vec::new();
        for (data, fact) in color.arriving(cancel)? {
            spectra.push(data);
            facts.push(fact);
        }
        if spectra.is_empty() && cancel.is_cancelled() {
            return Err(Failure::Interrupted);
        }
        if spectra.is_empty() {
            return Err("say what to measure, by --spectrum, --point or --reflectance".to_owned().into());
        }
        let lights: Vec<_> = spectra.iter().map(|s| (s, light(s, noise))).collect();
        let spots =
            lights.iter().filter_map(|(data, l)| spot(&data.name, l.chromaticity)).collect::<Vec<_>>();
        let title = "chromaticity, CIE 1931";
        let mut table = light_table(&lights, noise);
        facts.into_iter().for_each(|f| table.facts.push(f));
        return desk.hand_out(&table, || diagram(title, &spots), cancel);
    }
    let illuminant = color.spectrum(&color.illuminant)?;
    let things = color.reflectance.iter().map(|s| color.file(s)).collect::<Result<Vec<_>, _>>()?;
    let objects: Vec<_> = things.iter().map(|s| (s, object(s, &illuminant, noise))).collect();
    let mut spots: Vec<_> = objects.iter().filter_map(|(data, o)| spot(&data.name, o.chromaticity)).collect();
    spots.extend(spot(&illuminant.name, light(&illuminant, noise).chromaticity));
    let title = format!("chromaticity under {}, CIE 1931", illuminant.name);
    desk.hand_out(&object_table(&objects, &illuminant.name, noise), || diagram(&title, &spots), cancel)
}

fn spot(name: &str, chromaticity: Option<[Estimate; 4]>) -> Option<Spot> {
    let [x, y, _, _] = chromaticity?;
    let at = Xy { x: x.value, y: y.value };
    Some(Spot { name: name.to_owned(), at, half_widths: [x.half_width, y.half_width] })
}

impl Color {
    /// The light at the points of the scene, and how it was measured.
    fn arriving(&self, cancel: &CancelToken) -> Result<Vec<(SpectralData, Fact)>, Failure> {
        if self.point.is_empty() {
            return Ok(Vec::new());
        }
        let points: Vec<MeterPoint> = self
            .point
            .iter()
            .map(|&[x, y, z, nx, ny, nz]| MeterPoint { position: [x, y, z], normal: [nx, ny, nz] })
            .collect();
        let mut wavelengths: Vec<f32> = self.spectral.iter().flat_map(|c| c.0.iter().copied()).collect();
        wavelengths.sort_by(f32::total_cmp);
        wavelengths.dedup();
        let job = scene(&self.scenes, &self.outputs)?;
        let session = self.sampling.session(cancel);
        let readings = lux::measure_spectral(&job, &points, &wavelengths, &LuxSettings::default(), &session)
            .map_err(|e| e.to_string())?;
        let level = format!("{:.6}", 100.0 * session.precision.confidence);
        let level = level.trim_end_matches('0').trim_end_matches('.');
        let data = |(i, reading): (usize, &LuxReading<Vec<SpectralIrradiance>>)| {
            let name = format!("point {}", i + 1);
            let data = SpectralData {
                name: name.clone(),
                unit: Some(SpectralIrradiance::UNIT.to_owned()),
                wavelengths: wavelengths.iter().map(|l| f64::from(*l)).collect(),
                values: reading.total.iter().map(|e| e.estimate()).collect(),
                confidence: Some(format!("{level} % confidence, statistical only")),
            };
            let MeterPoint { position: [x, y, z], normal: [nx, ny, nz] } = points[i];
            let value = format!(
                "spectral irradiance at {x} {y} {z} on a plane that faces {nx} {ny} {nz} [scene units], {} rays, {}, seed {}",
                reading.effort.rays,
                reading.effort.note().unwrap_or_else(|| Ending::Precise.name().to_owned()),
                session.seed
            );
            (data, Fact { name, value })
        };
        Ok(readings.iter().enumerate().map(data).collect())
    }

    /// A built-in spectrum, or one from a file.
    fn spectrum(&self, name: &str) -> Result<SpectralData, String> {
        match named(name) {
            Some(spectrum) => Ok(SpectralData::of(name, &spectrum)),
            None => self.file(name),
        }
    }

    fn file(&self, name: &str) -> Result<SpectralData, String> {
        let text = if name == "-" {
            let mut text = String::new();
            std::io::stdin()
                .read_to_string(&mut text)
                .map_err(|e| format!("cannot read standard input: {}", reason(&e)))?;
            text
        } else {
            let path = Path::new(name);
            std::fs::read_to_string(path).map_err(|e| match e.kind() {
                std::io::ErrorKind::NotFound => unknown(name),
                std::io::ErrorKind::InvalidData => format!("{name} is not a text file"),
                _ => format!("cannot read {name}: {}", reason(&e)),
            })?
        };
        let rows = self.rows.as_ref().map(|r| [r.column.as_str(), r.word.as_str()]);
        let choice = Choice { column: self.column.as_deref(), rows };
        let shown = if name == "-" { "(standard input)" } else { name };
        SpectralData::parse(shown, &text, choice).map_err(|e| format!("{shown}: {e}"))
    }
}

fn unknown(name: &str) -> String {
    let hint = nearest(name, named::names());
    let hint = hint.map_or_else(String::new, |n| format!("; did you mean {n}?"));
    format!("there is neither a built-in spectrum nor a file called {name}{hint}")
}
