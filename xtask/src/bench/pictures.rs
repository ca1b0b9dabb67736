//! Scenes with pictures of them that are taken for true, and what a program's render of one costs and how far off it is.

use super::scaling::children_seconds;
use super::scenes::{self, Kind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use steradian::image::{Frame, Outliers, compare, read_frame_exr};

/// Samples per pixel of references that are made here.
const REFERENCE_SPP: u32 = 4096;

/// A scene with a picture of it that is taken for true.
pub(super) struct Subject {
    pub(super) name: String,
    scene: PathBuf,
    reference: PathBuf,
    pub(super) size: [u32; 2],
}

/// When a render ends.
#[derive(Clone, Copy)]
pub(super) enum End {
    /// With this many samples in each pixel.
    Samples(u32),
    /// With the noise below this part of the picture, or with so many samples in each pixel.
    Noise { target: f64, most: u32 },
}

/// What a program makes of a scene.
pub(super) struct Run {
    /// By the clock [s].
    pub(super) elapsed: f64,
    /// Of all processors together [s], which other work on the machine disturbs less.
    pub(super) processor: f64,
    pub(super) rel_mse: f64,
}

/// Runs of two programs, or of one in two ways, on one scene.
pub(super) struct Comparison {
    /// What a second buys: the error of unbiased estimators falls as 1/time. One pair for each round.
    pub(super) pairs: Vec<[f64; 2]>,
    pub(super) rel_mse: [f64; 2],
    /// Standard error of that as found from the rounds [%].
    pub(super) spread: [f64; 2],
}

impl Comparison {
    /// Errors are averaged over all rounds before times are compared round by round: they differ more between rounds than
    /// between programs.
    pub(super) fn new(runs: &[[Run; 2]]) -> Self {
        let mean = |f: &dyn Fn(&[Run; 2]) -> f64| runs.iter().map(f).sum::<f64>() / runs.len() as f64;
        let rel_mse = [0, 1].map(|i| mean(&|r| r[i].rel_mse));
        let spread = [0, 1].map(|i| {
            let variance = mean(&|r| (r[i].rel_mse / rel_mse[i] - 1.0).powi(2));
            100.0 * (variance / (runs.len() as f64 - 1.0).max(1.0)).sqrt()
        });
        let pairs = runs.iter().map(|r| [0, 1].map(|i| 1.0 / (r[i].processor * rel_mse[i]))).collect();
        Self { pairs, rel_mse, spread }
    }
}

/// The scenes of the collection that have references, and our own.
pub(super) fn subjects(program: &Path, root: &Path, scenes: Option<&Path>) -> Result<Vec<Subject>, String> {
    let folder = folder(root)?;
    let mut subjects = collection(&scenes.map_or_else(|| root.join("../shared/scenes"), Path::to_path_buf));
    subjects.extend(own(program, &folder)?);
    Ok(subjects)
}

/// Where pictures go.
pub(super) fn folder(root: &Path) -> Result<PathBuf, String> {
    let folder = root.join("target/bench");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    Ok(folder)
}

impl Subject {
    pub(super) fn reference(&self) -> Result<Frame, String> {
        read(&self.reference)
    }
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
            start(program, &subject, End::Samples(REFERENCE_SPP), 1 << 20, &subject.reference)?;
        }
        subjects.push(subject);
    }
    Ok(subjects)
}

pub(super) fn render(
    program: &Path,
    subject: &Subject,
    reference: &Frame,
    end: End,
    seed: usize,
    picture: &Path,
) -> Result<Run, String> {
    let (begun, before) = (Instant::now(), children_seconds());
    start(program, subject, end, seed, picture)?;
    let elapsed = begun.elapsed().as_secs_f64();
    let processor = match (before, children_seconds()) {
        (Ok(before), Ok(after)) => after - before,
        _ => elapsed,
    };
    // Trimmed: a handful of fireflies would decide about the ratio otherwise.
    let compared = compare(&read(picture)?, reference, Outliers::Keep).map_err(|e| e.to_string())?;
    Ok(Run { elapsed, processor, rel_mse: compared.rel_mse_trimmed })
}

fn start(program: &Path, subject: &Subject, end: End, seed: usize, picture: &Path) -> Result<(), String> {
    let mut command = Command::new(program);
    match end {
        End::Samples(spp) => command.args(["render", "--spp", &spp.to_string()]),
        End::Noise { target, most } => {
            command.args(["render", "--spp", &most.to_string(), "--noise", &format!("{}%", 100.0 * target)])
        }
    };
    let status = command
        .args(["--quiet", "--seed", &seed.to_string()])
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
