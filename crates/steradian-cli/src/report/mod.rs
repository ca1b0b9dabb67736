//! `steradian report`: what lighting engineers hand over.

mod files;
mod places;

use crate::Failure;
use crate::interrupt;
use crate::load::{self, Verbosity};
use crate::measure::common::Sampling;
use crate::output::{note, print};
use clap::Args;
use files::Folder;
use places::{GlareThreshold, GridPlace, ViewPlace};
use std::path::PathBuf;
use steradian::lab::Session;
use steradian::lab::glare::{Fisheye, GlareRule, Handedness, Shots, read, take};
use steradian::lab::meters::DEFAULT_MAX_DEPTH;
use steradian::lab::meters::lux::LuxSettings;
use steradian::lab::report::{Report, ViewReport, measure_grid, summary_table, view_table};
use steradian::render::setup;
use steradian::scene::RenderJob;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Arguments {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input [default: the built-in Cornell box]
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Grid of points for illuminance: a corner, two sides, and the number of cells along each; may be repeated
    #[arg(long, value_name = "[NAME=]X,Y,Z,UX,UY,UZ,VX,VY,VZ,NU,NV", value_parser = places::grid, allow_hyphen_values = true)]
    grid: Vec<GridPlace>,
    /// Eye for luminances and glare: position, line of sight, upwards; or `camera`; may be repeated
    #[arg(long, value_name = "[NAME=]X,Y,Z,DX,DY,DZ,UX,UY,UZ", value_parser = places::view, allow_hyphen_values = true)]
    view: Vec<ViewPlace>,
    /// Folder for the report; made where it does not exist
    #[arg(short, long, value_name = "FOLDER", default_value = "report")]
    output: PathBuf,
    /// Pixels along the side of a fisheye picture
    #[arg(long, value_name = "PX", default_value_t = 512, value_parser = clap::value_parser!(u32).range(16..=4096))]
    view_size: u32,
    /// Samples for each pixel of a fisheye picture
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    view_spp: u32,
    /// What counts as a source of glare: pixels above this luminance, or above a multiple of the mean luminance (`5x`)
    #[arg(long, value_name = "CD/M2|FACTORx", default_value = "2000", value_parser = places::threshold)]
    glare_threshold: GlareThreshold,
    /// Most bounces of light
    #[arg(long, value_name = "N", default_value_t = DEFAULT_MAX_DEPTH)]
    max_depth: u32,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    sampling: Sampling,
}

const NOTES: &str = "\
A grid measures in the middle of its cells, facing side U x side V. The precision holds for each of its points; U0 is given with
bounds, because the smallest of noisy readings comes out low. In scenes that only skies light there are daylight factors.
A view writes its picture as Radiance .hdr, which evalglare reads. All coordinates are those of the scene's world.

The folder then holds index.html, report.json with all numbers, and for each grid and view CSV, SVG and PNG files.

Example (the built-in Cornell box, of 559 units with y upwards, above its blocks):
  steradian report --grid plane=0,400,0,0,0,559,556,0,0,6,6 --view camera --view-size 256 -o cornell";

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.grid.is_empty() && arguments.view.is_empty() {
        return Err(Failure::Message(
            "nothing to report: name a --grid for illuminance or a --view for glare, see steradian report --help".to_owned(),
        ));
    }
    places::check_names(&arguments.grid, &arguments.view)?;
    let verbosity = if arguments.quiet { Verbosity::ErrorsOnly } else { Verbosity::All };
    let folder = Folder::new(&arguments.output)?;
    let job = load::read(&arguments.scenes)?.compile(verbosity)?;
    let cancel =
        interrupt::token("stopping; what is measured by now is reported; press Ctrl-C again to stop at once");
    let session = arguments.sampling.session(&cancel);
    let report = measure(arguments, &job, &session)?;
    let handedness = Handedness::of(&job);
    let main = folder.write(&report, handedness)?;
    if !arguments.quiet {
        if !report.grids.is_empty() {
            print(summary_table(&report).to_text().trim_end())?;
        }
        for view in &report.views {
            print(view_table(&report, view).to_text().trim_end())?;
        }
        note(&format!("report: {}", main.display()));
    }
    if cancel.is_cancelled() { Err(Failure::Interrupted) } else { Ok(()) }
}

fn measure(arguments: &Arguments, job: &RenderJob, session: &Session<'_>) -> Result<Report, Failure> {
    let settings = LuxSettings { max_depth: arguments.max_depth, ..LuxSettings::default() };
    let title = match arguments.scenes.first() {
        Some(scene) => scene.display().to_string(),
        None => "the built-in Cornell box".to_owned(),
    };
    let mut report = Report {
        title,
        confidence: session.precision.confidence,
        seed: session.seed,
        max_depth: arguments.max_depth,
        meters_per_unit: f64::from(job.meters_per_unit),
        grids: Vec::new(),
        views: Vec::new(),
        remarks: remarks(arguments, job),
    };
    let say = |text: String| {
        if !arguments.quiet {
            note(&text);
        }
    };
    // Each of the places has its own random numbers.
    for (place, seed) in arguments.grid.iter().zip(0_u64..) {
        let grid = place.grid.clone();
        say(format!("grid {}: {} points", grid.name, grid.columns * grid.rows));
        let own = Session { seed: session.seed.wrapping_add(seed << 32), ..*session };
        match measure_grid(job, grid, &settings, &own).map_err(|e| e.to_string())? {
            Some(measured) => report.grids.push(measured),
            None => return Ok(report),
        }
    }
    let integrator = setup::metering(job, arguments.max_depth)
        .ok_or_else(|| "the scene asks for legacy shading, which is no light transport".to_owned())?;
    for (place, number) in arguments.view.iter().zip(0_u64..) {
        say(format!("view {}", place.name));
        let eye = place.eye(job)?;
        let own = Session { seed: session.seed.wrapping_add(number << 32), ..*session };
        let shots = Shots { fisheye: Fisheye::new(arguments.view_size), samples: arguments.view_spp };
        let Some(photograph) = take(job, integrator.as_ref(), &eye, &shots, &own) else { return Ok(report) };
        let rule = GlareRule { threshold: arguments.glare_threshold.0 };
        let reading = read(&photograph, &rule, &session.precision);
        report.views.push(ViewReport { name: place.name.clone(), photograph, rule, reading });
    }
    Ok(report)
}

fn remarks(arguments: &Arguments, job: &RenderJob) -> Vec<String> {
    let mut points: Vec<&str> =
        job.scene.lights().iter().filter(|l| l.is_delta()).map(|l| l.kind()).collect();
    points.sort_unstable();
    points.dedup();
    let mut remarks = Vec::new();
    if !points.is_empty() && !arguments.view.is_empty() {
        remarks.push(format!(
            "lights without extent ({}) cannot be seen: they are missing in pictures, in the illuminance at the eye and in \
             UGR and DGP; grids have their light",
            points.join(", ")
        ));
    }
    remarks
}
