//! `steradian measure luminaire`: the far-field distribution of what shines in a scene.

use super::common::{self, Desk, Outputs, Sampling};
use crate::Failure;
use crate::output::{OutputFile, note};
use clap::Args;
use std::path::PathBuf;
use steradian::lab::Table;
use steradian::lab::luminaire::{self, LuminaireSettings};
use steradian::lab::plot::Drawing;
use steradian::light::photometric::{eulumdat, ies};
use steradian::render::CancelToken;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Luminaire {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<PathBuf>,
    /// Half planes C all around, at equal distance; 1 measures the mean around the axis
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=720))]
    planes: u32,
    /// Distance of the angles γ in degrees; a fraction of 180
    #[arg(long, value_name = "DEGREES", default_value = "5", value_parser = parse_step)]
    gamma_step: Step,
    /// Direction of γ = 0, in the scene's world
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,-1", value_parser = parse_direction, allow_hyphen_values = true)]
    nadir: Direction,
    /// A direction in the half plane C = 0; C counts from it counterclockwise as seen from above
    #[arg(long, value_name = "X,Y,Z", default_value = "1,0,0", value_parser = parse_direction, allow_hyphen_values = true)]
    c0: Direction,
    /// Measure watts within 360–830 nm instead of candela and lumen
    #[arg(long, conflicts_with_all = ["ies", "ldt"])]
    radiant: bool,
    /// Most bounces of light
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    max_depth: u32,
    /// File for the distribution in IES LM-63-2019
    #[arg(long, value_name = "FILE")]
    ies: Option<PathBuf>,
    /// File for the distribution in EULUMDAT
    #[arg(long, value_name = "FILE")]
    ldt: Option<PathBuf>,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    sampling: Sampling,
}

const NOTES: &str = "\
The intensity in a direction is the radiance that leaves the scene in it, over the area that the scene shows there.
Rays are traced backwards through everything: reflectors, diffusers, glass. Light of points without extent is seen
directly or after diffuse reflection; through glass and by mirrors only emitting surfaces are seen. Lights at
infinity belong to no luminaire and are refused.
Each cell is measured to the precision asked for, or to that share of a tenth of the largest one where it is dimmer.

Example: a square panel of 60 cm that emits 2000 lm, behind the plane z = 0

  cat > panel.pbrt <<'END'
  WorldBegin
  AreaLightSource \"diffuse\" \"float power\" 2000
  Shape \"bilinearmesh\" \"point3 P\" [ -.3 -.3 0  -.3 .3 0  .3 -.3 0  .3 .3 0 ]
  END
  steradian measure luminaire panel.pbrt --planes 1 -o panel.csv --plot panel.svg --ies panel.ies

What was measured shines again in another scene:

  LightSource \"photometric\" \"string filename\" \"panel.ies\" \"float flux\" 2500";

/// Intervals of γ between 0 and 180°.
#[derive(Clone, Copy, Debug)]
struct Step(u32);

#[derive(Clone, Copy, Debug)]
struct Direction([f64; 3]);

fn parse_step(text: &str) -> Result<Step, String> {
    let step = text.trim().trim_end_matches('°').parse::<f64>().ok().filter(|s| *s >= 0.1 && *s <= 180.0);
    let intervals = step.map(|s| 180.0 / s).filter(|n| (n - n.round()).abs() < 1e-6);
    intervals
        .map(|n| Step(n.round() as u32))
        .ok_or_else(|| "expected a fraction of 180 degrees from 0.1 on, such as 5 or 2.5".to_owned())
}

fn parse_direction(text: &str) -> Result<Direction, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|x| x.trim().parse().ok()).collect();
    let direction = numbers.and_then(|n| <[f64; 3]>::try_from(n).ok());
    direction
        .filter(|d| d.iter().all(|x| x.is_finite()) && d.iter().any(|x| *x != 0.0))
        .map(Direction)
        .ok_or_else(|| "expected a direction such as 0,0,-1".to_owned())
}

pub(crate) fn run(arguments: &Luminaire, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&arguments.outputs)?;
    let file =
        |path: &Option<PathBuf>, kind| path.as_deref().map(|p| OutputFile::of_kind(p, kind)).transpose();
    let (ies_file, ldt_file) = (file(&arguments.ies, "ies")?, file(&arguments.ldt, "ldt")?);
    let job = common::scene(&arguments.scenes, &arguments.outputs)?;
    let settings = LuminaireSettings {
        planes: arguments.planes,
        gamma_steps: arguments.gamma_step.0,
        nadir: arguments.nadir.0,
        c0: arguments.c0.0,
        max_depth: arguments.max_depth,
    };
    let session = arguments.sampling.session(cancel);
    let scene = arguments.scenes.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ");
    let hand_out = |mut table: Table, drawing: &dyn Fn() -> Drawing| {
        table.fact("scene", scene.as_str());
        desk.hand_out(&table, drawing, cancel)
    };
    if arguments.radiant {
        let found = luminaire::measure_radiant(&job, &settings, &session).map_err(|e| e.to_string())?;
        return hand_out(found.table(&settings, &session), &|| found.drawing());
    }
    let found = luminaire::measure(&job, &settings, &session).map_err(|e| e.to_string())?;
    let luminaire = found.luminaire(&scene);
    if cancel.is_cancelled() {
        // A photometric file does not show that its measurement was not finished.
        for file in [&ies_file, &ldt_file].into_iter().flatten() {
            note(&format!("{} is not written: the measurement was stopped", file.path().display()));
        }
        return hand_out(found.table(&settings, &session), &|| found.drawing());
    }
    if let Some(file) = ies_file {
        file.write(ies::write(&luminaire, ies::Edition::Of2019).as_bytes())?;
        report(&file, arguments.outputs.quiet);
    }
    if let Some(file) = ldt_file {
        let text = eulumdat::write(&luminaire).map_err(|e| format!("{}: {e}", file.path().display()))?;
        file.write(text.as_bytes())?;
        report(&file, arguments.outputs.quiet);
    }
    hand_out(found.table(&settings, &session), &|| found.drawing())
}

fn report(file: &OutputFile, quiet: bool) {
    if !quiet {
        note(&format!("photometric file: {}", file.path().display()));
    }
}
