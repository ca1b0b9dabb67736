//! Time to equal error against an earlier state of this program, on scenes with reference pictures.

use super::options::Options;
use super::pictures::{self, Comparison, End, Run, Subject};
use super::row::{Row, Target, median};
use std::path::{Path, PathBuf};
use std::process::Command;

const SECTION: &str = "Error: time to equal error against the baseline";

/// "First light": the state that later speed work is measured against.
const BASELINE: &str = "41618a2bd350";

/// Samples per pixel of the compared pictures: small beside those of the references, whose own noise counts against both.
const SPP: u32 = 64;

/// Measures all scenes, and their geometric mean.
pub(super) fn measure(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let ours = super::program(root)?;
    let baseline = match &options.baseline {
        Some(path) => path.clone(),
        None => build_baseline(root)?,
    };
    let picture = pictures::folder(root)?.join("error.exr");
    let mut rows = Vec::new();
    for subject in &pictures::subjects(&ours, root, options.scenes.as_deref())? {
        let reference = subject.reference()?;
        let mut runs = Vec::new();
        for round in 0..options.repetitions.unwrap_or(3) {
            let run = |program: &Path| {
                pictures::render(program, subject, &reference, End::Samples(SPP), round, &picture)
            };
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

fn row(subject: &Subject, runs: &[[Run; 2]]) -> Row {
    let Comparison { pairs, rel_mse, spread } = Comparison::new(runs);
    let mut by_clock: Vec<f64> =
        runs.iter().map(|[a, b]| b.elapsed * rel_mse[1] / (a.elapsed * rel_mse[0])).collect();
    Row::compared(SECTION, subject.name.clone(), "1/(s relMSE)", &pairs, Target::RatioAtLeast(1.0)).noted(
        format!(
            "{SPP} spp, {}×{}; relMSE {:.4} ± {:.0} % against {:.4} ± {:.0} %; ratio by the clock {:.2}",
            subject.size[0],
            subject.size[1],
            rel_mse[0],
            spread[0],
            rel_mse[1],
            spread[1],
            median(&mut by_clock)
        ),
    )
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
