//! Rendering small scenes from text, and the statistics that the laws are judged by.
#![allow(dead_code, reason = "each test binary uses its part of this module")]
#![allow(clippy::expect_used, clippy::panic, reason = "tests fail by panicking")]

use std::path::Path;
use steradian::image::Frame;
use steradian::render::{CancelToken, RenderOptions, Silent};
use steradian::scene::import::pbrt::{Imported, Input, import};
use steradian::scene::{Disk, FileSystem, RenderJob};

/// Everything before `WorldBegin` but camera and integrator: 8 × 8 pixels, box filter.
pub(crate) const SMALL_FILM: &str = r#"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8 "bool savefp16" false
PixelFilter "box"
"#;

/// Compiles a scene that must be free of errors.
pub(crate) fn job(text: &str) -> RenderJob {
    job_with(text, &Disk)
}

/// The same with other files than those on disk.
pub(crate) fn job_with(text: &str, files: &dyn FileSystem) -> RenderJob {
    let input = Input::Text { name: "test.pbrt", bytes: text.as_bytes(), base: Path::new(".") };
    let Imported { scene, sources, mut diagnostics } = import(&[input], files);
    let job = scene.and_then(|d| steradian::scene::compile(d, files, &mut diagnostics));
    assert!(!diagnostics.has_errors(), "{}", diagnostics.display(&sources));
    job.expect("a scene without errors compiles")
}

/// Renders with the given seed.
pub(crate) fn render_seeded(job: &mut RenderJob, seed: u64) -> Frame {
    job.sampling.seed = seed;
    render(job, &RenderOptions::default())
}

/// Renders with the given options.
pub(crate) fn render(job: &RenderJob, options: &RenderOptions) -> Frame {
    steradian::render::render(job, options, &Silent, &CancelToken::new()).expect("the film is valid").frame
}

/// Mean luminance of a linear sRGB frame [film units].
pub(crate) fn mean_luminance(frame: &Frame) -> f64 {
    let channel = |name: &str| {
        let values = frame.channel(name).unwrap_or_else(|| panic!("no channel {name}"));
        values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64
    };
    0.212_639 * channel("R") + 0.715_169 * channel("G") + 0.072_192 * channel("B")
}

/// Judges an unbiased estimate against its exact value by independent randomisations.
#[derive(Debug)]
pub(crate) struct Judgement {
    pub(crate) mean: f64,
    pub(crate) standard_error: f64,
}

/// Randomisations per law.
pub(crate) const RUNS: u64 = 16;
/// Student's t for a two-sided test at α = 0.001 with 15 degrees of freedom.
const T_15: f64 = 4.0728;

/// Renders the scene under [`RUNS`] seeds.
pub(crate) fn judge(text: &str) -> Judgement {
    let mut job = job(text);
    let values: Vec<f64> = (0..RUNS).map(|seed| mean_luminance(&render_seeded(&mut job, seed + 1))).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Judgement { mean, standard_error: (variance / n).sqrt() }
}

/// Asserts that the scene's mean luminance is `expected`.
///
/// A t test at α = 0.001 that can detect a bias of `detectable` (relative): when the noise is larger, the test fails as too
/// weak instead of passing. f32 arithmetic is granted 2·10⁻⁵.
pub(crate) fn assert_luminance(text: &str, expected: f64, detectable: f64) {
    let j = judge(text);
    let margin = T_15 * j.standard_error;
    assert!(
        margin <= detectable * expected.abs(),
        "too noisy to detect {detectable}: {j:?}, expected {expected}"
    );
    assert!(
        (j.mean - expected).abs() <= margin + 2e-5 * expected.abs(),
        "expected {expected}, got {} ± {margin}",
        j.mean
    );
}
