//! Time to equal error against an earlier state of this program, on scenes with reference pictures.

use super::options::Options;
use super::row::{Row, Target, median};
use super::scaling::children_seconds;
use super::scenes::{self, Kind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use steradian::image::{Frame, Outliers, compare, read_frame_exr};

const SECTION: &str = "Error: time to equal error against the baseline";

/// "First light": the state that later speed work is measured against.
const BASELINE: &str = "41618a2bd350";

/// Samples per pixel of the compared pictures: small beside those of the references, whose own noise counts against both.
const SPP: u32 = 64;

/// Samples per pixel of references that are made here.
const REFERENCE_SPP: u32 = 4096;

/// A scene with a picture of it that is taken for true.
struct Subject {
    name: String,
    scene: PathBuf,
    reference: PathBuf,
    size: [u32; 2],
}

/// What a program makes of a scene.
struct Run {
    /// By the clock.
    elapsed: f64,
    /// Of all processors together, which other work on the machine disturbs less.
    processor: f64,
    rel_mse: f64,
}

/// Measures all scenes, and their geometric mean.
pub(super) fn measure(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let ours = super::program(root)?;
    let baseline = match &options.baseline {
        Some(path) => path.clone(),
        None => build_baseline(root)?,
    };
    let folder = root.join("target/bench");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let mut subjects = collection(&options.scenes.clone().unwrap_or_else(|| root.join("../shared/scenes")));
    subjects.extend(own(&ours, &folder)?);
    let mut rows = Vec::new();
    for subject in &subjects {
        let reference = read(&subject.reference)?;
        let mut runs = Vec::new();
        for round in 0..options.repetitions.unwrap_or(3) {
            let run =
                |program: &Path| render(program, subject, &reference, SPP, round, &folder.join("error.exr"));
            runs.push([run(&ours)?, run(&baseline)?]);
        }
        rows.push(row(subject, &runs));
    }
    if rows.is_empty() {
        return Err("no scenes with references were found; --scenes names their folder".to_owned());
    }
    let mean = (rows.iter().map(|r| r.ratio.ln()).sum::<f64>() / rows.len() as f64).exp();
    let middle = median(&mut rows.iter().map(|r| r.ratio).collect::<Vec<_>>());
    rows.push(
        Row::alone(SECTION, "geometric mean of the ratios", "1", mean, Target::AtLeast(2.0))
            .noted(format!("{} scenes, median {middle:.2}; aim: 4", rows.len())),
    );
    Ok(rows)
}

/// The error of unbiased estimators falls as 1/time: their product is what a second buys. Errors are averaged over all
/// rounds before times are compared round by round: they differ more between rounds than between programs.
fn row(subject: &Subject, runs: &[[Run; 2]]) -> Row {
    let mean = |f: &dyn Fn(&[Run; 2]) -> f64| runs.iter().map(f).sum::<f64>() / runs.len() as f64;
    let error = [0, 1].map(|i| mean(&|r| r[i].rel_mse));
    let pairs: Vec<[f64; 2]> =
        runs.iter().map(|r| [0, 1].map(|i| 1.0 / (r[i].processor * error[i]))).collect();
    let spread = [0, 1].map(|i| {
        let variance = mean(&|r| (r[i].rel_mse / error[i] - 1.0).powi(2));
        100.0 * (variance / (runs.len() as f64 - 1.0).max(1.0)).sqrt()
    });
    let mut by_clock: Vec<f64> =
        runs.iter().map(|[a, b]| b.elapsed * error[1] / (a.elapsed * error[0])).collect();
    Row::compared(SECTION, subject.name.clone(), "1/(s relMSE)", &pairs, Target::RatioAtLeast(1.0)).noted(
        format!(
            "{SPP} spp, {}×{}; relMSE {:.4} ± {:.0} % against {:.4} ± {:.0} %; ratio by the clock {:.2}",
            subject.size[0],
            subject.size[1],
            error[0],
            spread[0],
            error[1],
            spread[1],
            median(&mut by_clock)
        ),
    )
}

/// The surface scenes of the collection.
fn collection(folder: &Path) -> Vec<Subject> {
    let table = std::fs::read_to_string(folder.join("scenes.tsv")).unwrap_or_default();
    let parse = |line: &str| {
        let fields: Vec<&str> = line.split('\t').collect();
        let [name, file, "surface", width, height, ..] = fields[..] else { return None };
        Some(Subject {
            name: name.to_owned(),
            scene: folder.join(file),
            reference: folder.join("references").join(format!("{name}.exr")),
            size: [width.parse().ok()?, height.parse().ok()?],
        })
    };
    table.lines().filter(|l| !l.starts_with('#')).filter_map(parse).collect()
}

/// Our own scenes of many lights and of an environment, with references made by the present program.
fn own(program: &Path, folder: &Path) -> Result<Vec<Subject>, String> {
    let mut subjects = Vec::new();
    for kind in [Kind::Street, Kind::Daylight, Kind::Plaza] {
        let written = scenes::write(kind, &folder.join("scenes"))?;
        let name = kind.name().to_owned();
        let reference = folder.join(format!("reference-{name}.exr"));
        let subject = Subject { name, scene: written.pbrt, reference, size: [160, 120] };
        if !subject.reference.exists() {
            start(program, &subject, REFERENCE_SPP, 1 << 20, &subject.reference)?;
        }
        subjects.push(subject);
    }
    Ok(subjects)
}

fn render(
    program: &Path,
    subject: &Subject,
    reference: &Frame,
    spp: u32,
    seed: usize,
    picture: &Path,
) -> Result<Run, String> {
    let (begun, before) = (Instant::now(), children_seconds());
    start(program, subject, spp, seed, picture)?;
    let elapsed = begun.elapsed().as_secs_f64();
    let processor = match (before, children_seconds()) {
        (Ok(before), Ok(after)) => after - before,
        _ => elapsed,
    };
    // Trimmed: a handful of fireflies would decide about the ratio otherwise.
    let compared = compare(&read(picture)?, reference, Outliers::Keep).map_err(|e| e.to_string())?;
    Ok(Run { elapsed, processor, rel_mse: compared.rel_mse_trimmed })
}

fn start(program: &Path, subject: &Subject, spp: u32, seed: usize, picture: &Path) -> Result<(), String> {
    let status = Command::new(program)
        .args(["render", "--quiet", "--spp", &spp.to_string(), "--seed", &seed.to_string()])
        .args(["--resolution", &format!("{}x{}", subject.size[0], subject.size[1])])
        .arg(&subject.scene)
        .arg("-o")
        .arg(picture)
        .stderr(std::process::Stdio::null())
        .status()
        .map_err(|e| format!("{}: {e}", program.display()))?;
    if status.success() { Ok(()) } else { Err(format!("{} failed on {}", program.display(), subject.name)) }
}

fn read(path: &Path) -> Result<Frame, String> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    read_frame_exr(&bytes).map_err(|e| format!("{}: {e}", path.display()))
}

/// Checks the baseline out below `target` and builds it there.
fn build_baseline(root: &Path) -> Result<PathBuf, String> {
    let folder = root.join("target/baseline");
    let program = folder.join(format!("target/release/steradian{}", std::env::consts::EXE_SUFFIX));
    if program.exists() {
        return Ok(program);
    }
    let run = |command: &mut Command| -> Result<(), String> {
        let status = command.status().map_err(|e| e.to_string())?;
        if status.success() {
            Ok(())
        } else {
            Err(format!("the baseline {BASELINE} cannot be built from this clone"))
        }
    };
    if !folder.exists() {
        run(Command::new("git").args(["clone", "--quiet", "--no-checkout"]).arg(root).arg(&folder))?;
    }
    run(Command::new("git").args(["checkout", "--quiet", BASELINE]).current_dir(&folder))?;
    run(Command::new("cargo")
        .args(["build", "--release", "--quiet", "--package", "steradian-cli"])
        .env_remove("CARGO_TARGET_DIR")
        .current_dir(&folder))?;
    Ok(program)
}
