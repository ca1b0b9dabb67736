//! `steradian measure gonio`: where light is scattered to.

use super::common::{Comb, Desk, Outputs, Sampling, parse_comb, parse_share};
use crate::args::{self, Sample};
use crate::load::{self, Verbosity};
use crate::output::{OutputFile, note};
use crate::{Failure, pick};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use steradian::lab::gonio::{
    self, CellGrid, Detail, Face, Goniometer, Incidence, Patch, Port, Reading, check_table_wavelengths,
    klems_xml, material_table, reciprocity, table_incidence,
};
use steradian::lab::probe::{Angles, Probe};
use steradian::lab::{Session, Subject};
use steradian::render::CancelToken;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Gonio {
    #[command(flatten)]
    sample: Sample,
    /// Measure the scene's geometry instead of a material: light falls on it along -z (with --side back along +z)
    #[arg(long, conflicts_with = "material")]
    patch: bool,
    /// Window that light falls through onto the geometry, in scene units [default: leaves out an eighth on each side]
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = parse_port, requires = "patch", allow_hyphen_values = true)]
    port: Option<Port>,
    /// Direction that light comes from, in degrees; may be repeated [default: 0,0 and 30,0 and 60,0]
    #[arg(long, value_name = "THETA,PHI", value_parser = parse_incident, allow_hyphen_values = true)]
    incident: Vec<Angles>,
    /// Side that light comes to
    #[arg(long, value_enum, default_value = "front")]
    side: Side,
    /// Wavelengths in nm, separated by commas; 400:700:10 is a comb [default: 550; for --klems and --material-table 400:700:20]
    #[arg(short = 'l', long, value_name = "NM", value_delimiter = ',', value_parser = parse_comb)]
    wavelength: Vec<Comb>,
    /// Rings of cells on each hemisphere
    #[arg(long, value_name = "N", default_value = "9", value_parser = clap::value_parser!(u16).range(1..=180))]
    theta_cells: u16,
    /// Cells of each ring
    #[arg(long, value_name = "N", default_value = "24", value_parser = clap::value_parser!(u16).range(1..=720))]
    phi_cells: u16,
    /// How cells of a material are filled
    #[arg(long, value_enum, default_value = "combined")]
    method: Method,
    /// Cells that hold less than this share of the brightest one are as precise as if they held that much
    #[arg(long, value_name = "SHARE", default_value = "10%", value_parser = parse_share)]
    cell_floor: f64,
    /// File for a material that the renderer reads back: a CSV table for Material "measured"
    #[arg(long, value_name = "FILE", conflicts_with = "klems")]
    material_table: Option<PathBuf>,
    /// Azimuths of incidence of that table: 1 for an isotropic material, else at least 4
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u16).range(1..=360))]
    azimuths: u16,
    /// File for Klems matrices in the XML of WINDOW and Radiance: light from each of 145 cells, from both sides
    #[arg(long, value_name = "FILE", conflicts_with = "incident")]
    klems: Option<PathBuf>,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    sampling: Sampling,
}

const NOTES: &str = "\
Each reading is the mean of f over a cell, in 1/sr: the flux in the cell over the incident flux and the cell's
projected solid angle. Discrete directions have rows of their own, with their share of the flux. A cell is
precise when the half-width of its interval is --precision of its value, or of --cell-floor of the brightest
cell, or --floor.

Example: a gold finish lit at 45 degrees, and as a material in cells of 5 degrees
  steradian measure gonio scene.pbrt --material gold --incident 45,0 -l 450,550,650 -o gold.csv --plot gold.svg
  steradian measure gonio scene.pbrt --material gold --theta-cells 18 --phi-cells 72 --material-table gold-table.csv

Example: the geometry of a blind for WINDOW and Radiance
  steradian measure gonio blind.pbrt --patch --klems blind.xml --precision 5%";

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Side {
    /// The one that the normal points to: +z
    Front,
    /// The other one
    Back,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Method {
    /// Both of the following, each where it is better
    Combined,
    /// Directions are drawn from the scattering function and counted
    Counting,
    /// The scattering function is integrated over each cell
    Integration,
}

impl From<Side> for Face {
    fn from(side: Side) -> Self {
        match side {
            Side::Front => Self::Front,
            Side::Back => Self::Back,
        }
    }
}

impl From<Method> for gonio::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::Combined => Self::Combined,
            Method::Counting => Self::Counting,
            Method::Integration => Self::Integration,
        }
    }
}

pub(crate) fn run(arguments: &Gonio, cancel: &CancelToken) -> Result<(), Failure> {
    let wavelengths = arguments.wavelengths();
    if arguments.material_table.is_some() {
        check_table_wavelengths(&wavelengths).map_err(|e| e.to_string())?;
    }
    let desk = Desk::new(&arguments.outputs)?;
    let file = match (&arguments.material_table, &arguments.klems) {
        (Some(path), _) => Some(OutputFile::of_kind(path, "csv")?),
        (None, Some(path)) => Some(OutputFile::of_kind(path, "xml")?),
        (None, None) => None,
    };
    let job = match arguments.patch {
        // Warnings are about the scene as a picture, such as that it has no light.
        true => load::read(&arguments.sample.scenes)?.compile(Verbosity::ErrorsOnly)?,
        false => arguments.sample.job()?,
    };
    let session = arguments.sampling.session(cancel);
    let bench = Bench { arguments, wavelengths: &wavelengths, session: &session };
    let (name, readings) = if arguments.patch {
        for subject in Subject::all(&job) {
            pick::check_wavelengths(&subject, &wavelengths)?;
        }
        let patch = Patch::new(&job, arguments.port).map_err(|e| e.to_string())?;
        let Port { x, y } = patch.port();
        let name = format!("geometry, light through x {} to {}, y {} to {}", x[0], x[1], y[0], y[1]);
        (name, bench.measure(gonio::Sample::Geometry(&patch)))
    } else {
        let subject = arguments.sample.subject(&job)?;
        pick::check_wavelengths(&subject, &wavelengths)?;
        let probe = Probe::new(&subject, &wavelengths).map_err(|e| e.to_string())?;
        let mut name = format!("material \"{}\"", subject.name());
        if subject.is_textured() {
            let [u, v] = arguments.sample.uv;
            name += &format!(" at u = {u}, v = {v}");
        }
        (name, bench.measure(gonio::Sample::Material(&probe)))
    };
    let Readings { asked, other } = &readings;
    let residuals = reciprocity(asked, other.as_ref());
    // Whoever asked for another file has no use for thousands of lines on a screen.
    let detail = if file.is_some() && arguments.outputs.output.is_empty() {
        Detail::Hemispheres
    } else {
        Detail::Cells
    };
    let mut table = gonio::table(&name, asked, residuals.as_deref(), detail);
    table.fact("seed", arguments.sampling.seed.to_string());
    if let Some(file) = &file
        && cancel.is_cancelled()
    {
        note(&format!("{} is not written: the measurement was stopped", file.path().display()));
    } else if let Some(file) = &file {
        let text = match (&arguments.klems, other) {
            (Some(_), Some(other)) => {
                let (front, back) = if asked.face == Face::Front { (asked, other) } else { (other, asked) };
                klems_xml(&name, front, back).map_err(|e| e.to_string())?
            }
            _ => material_table(&name, asked).map_err(|e| e.to_string())?,
        };
        file.write(text.as_bytes())?;
        if !arguments.outputs.quiet {
            note(&format!("{name}: {}", file.path().display()));
        }
    }
    desk.hand_out(&table, || gonio::plot(&name, asked), cancel)
}

/// What was measured from the side that was asked for, and from the other one where that was needed.
struct Readings {
    asked: Reading,
    other: Option<Reading>,
}

struct Bench<'a> {
    arguments: &'a Gonio,
    wavelengths: &'a [f32],
    session: &'a Session<'a>,
}

impl Bench<'_> {
    fn measure(&self, sample: gonio::Sample<'_, '_>) -> Readings {
        let arguments = self.arguments;
        let (grid, incidence) = if arguments.klems.is_some() {
            let grid = CellGrid::klems();
            let all = (0..grid.len()).map(Incidence::Cell).collect();
            (grid, all)
        } else {
            let rings = usize::from(arguments.theta_cells);
            let grid = CellGrid::regular(rings, usize::from(arguments.phi_cells));
            (grid, arguments.incidence(rings))
        };
        let face = Face::from(arguments.side);
        let gonio =
            Goniometer { grid, face, incidence, method: arguments.method.into(), dim: arguments.cell_floor };
        let asked = gonio.measure(sample, self.wavelengths, self.session);
        let other = arguments.klems.is_some().then(|| {
            let face = if face == Face::Front { Face::Back } else { Face::Front };
            Goniometer { face, ..gonio }.measure(sample, self.wavelengths, self.session)
        });
        Readings { asked, other }
    }
}

impl Gonio {
    fn wavelengths(&self) -> Vec<f32> {
        if !self.wavelength.is_empty() {
            return self.wavelength.iter().flat_map(|comb| comb.0.iter().copied()).collect();
        }
        match self.klems.is_some() || self.material_table.is_some() {
            true => (0..16).map(|i| 400.0 + 20.0 * i as f32).collect(),
            false => vec![550.0],
        }
    }

    fn incidence(&self, rings: usize) -> Vec<Incidence> {
        if !self.incident.is_empty() {
            return self.incident.iter().copied().map(Incidence::Direction).collect();
        }
        if self.material_table.is_some() {
            return table_incidence(rings, usize::from(self.azimuths));
        }
        [0.0, 30.0, 60.0].map(|theta| Incidence::Direction(Angles { theta, phi: 0.0 })).to_vec()
    }
}

fn parse_incident(text: &str) -> Result<Angles, String> {
    let angles = args::parse_angles(text)?;
    // At the horizon no light falls onto the sample.
    if angles.theta > 89.99 {
        return Err(format!(
            "theta must lie between 0 and 89.99 degrees to the normal of the side, not {}",
            angles.theta
        ));
    }
    Ok(angles)
}

fn parse_port(text: &str) -> Result<Port, String> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|n| n.trim().parse().ok().filter(|x: &f32| x.is_finite())).collect();
    match numbers.as_deref() {
        Some(&[x0, x1, y0, y1]) if x0 < x1 && y0 < y1 => Ok(Port { x: [x0, x1], y: [y0, y1] }),
        _ => Err("expected X0,X1,Y0,Y1 with X0 < X1 and Y0 < Y1".to_owned()),
    }
}
