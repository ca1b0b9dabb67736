//! Sampling to a noise target against equal samples in all pixels: what a second buys of either.

use super::options::Options;
use super::pictures::{self, Comparison, End, Run, Subject};
use super::row::{Row, Target};
use std::path::Path;

const SECTION: &str = "Noise targets: time to equal error against equal samples";

/// Samples in each pixel of what is compared with; their error becomes the noise that is asked for.
const SPP: u32 = 64;

/// Samples that a pixel can have: room for those that need much more than the others.
const MOST: u32 = 16 * SPP;

/// Measures all scenes, and their geometric mean.
pub(super) fn measure(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let program = super::program(root)?;
    let picture = pictures::folder(root)?.join("noise.exr");
    let mut rows = Vec::new();
    for subject in &pictures::subjects(&program, root, options.scenes.as_deref())? {
        let reference = subject.reference()?;
        let run = |end, seed| pictures::render(&program, subject, &reference, end, seed, &picture);
        let target = run(End::Samples(SPP), 1000)?.rel_mse.sqrt();
        let mut runs = Vec::new();
        for round in 0..options.repetitions.unwrap_or(5) {
            runs.push([run(End::Noise { target, most: MOST }, round)?, run(End::Samples(SPP), round)?]);
        }
        rows.push(row(subject, target, &runs));
    }
    let mean = (rows.iter().map(|r| r.ratio.ln()).sum::<f64>() / rows.len().max(1) as f64).exp();
    rows.push(
        Row::alone(SECTION, "geometric mean of the ratios", "1", mean, Target::AtLeast(1.0))
            .noted(format!("{} scenes", rows.len())),
    );
    Ok(rows)
}

fn row(subject: &Subject, target: f64, runs: &[[Run; 2]]) -> Row {
    let Comparison { pairs, rel_mse, spread } = Comparison::new(runs);
    let total = |i: usize| runs.iter().map(|r| r[i].elapsed).sum::<f64>();
    let time = total(0) / total(1);
    Row::compared(SECTION, subject.name.clone(), "1/(s relMSE)", &pairs, Target::RatioAtLeast(1.0)).noted(
        format!(
            "asked for {:.1} %, found {:.1} % ± {:.0} % in {time:.2} times the time of {SPP} spp, which have {:.1} % ± {:.0} %",
            100.0 * target,
            100.0 * rel_mse[0].sqrt(),
            spread[0],
            100.0 * rel_mse[1].sqrt(),
            spread[1]
        ),
    )
}
