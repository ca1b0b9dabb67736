//! `steradian compare`.

use crate::Failure;
use crate::args;
use crate::output::{Target, print, reason};
use serde_json::json;
use std::path::Path;
use steradian::image::{
    Comparison, DEFAULT_PIXELS_PER_DEGREE, Frame, Outliers, compare, flip, heat_map, read_frame_exr,
};

pub(crate) fn run(arguments: &args::Compare) -> Result<(), Failure> {
    let target = arguments.output.as_deref().map(Target::new).transpose()?;
    let (image, reference) = (read(&arguments.image)?, read(&arguments.reference)?);
    let text = |e: steradian::image::ImageError| Failure::Message(e.to_string());
    let c = compare(&image, &reference, Outliers::Keep).map_err(text)?;
    let perceived = flip(&image, &reference, DEFAULT_PIXELS_PER_DEGREE).map_err(text)?;
    let report = if arguments.json { as_json(&c, perceived.mean()) } else { as_text(&c, perceived.mean()) };
    print(&report)?;
    if let Some(target) = target {
        let size = [reference.window().width, reference.window().height];
        target.write(&heat_map(size, &perceived.values).map_err(text)?)?;
    }
    Ok(())
}

fn read(path: &Path) -> Result<Frame, String> {
    let bytes = std::fs::read(path).map_err(|e| format!("cannot read {}: {}", path.display(), reason(&e)))?;
    read_frame_exr(&bytes).map_err(|e| format!("cannot read {}: {e}", path.display()))
}

fn as_text(c: &Comparison, flip: f64) -> String {
    let [r, g, b] = c.mean_ratio;
    format!(
        "mean ratio        {r:.5} {g:.5} {b:.5}  (R G B, image / reference)\n\
         MSE               {:.6e}\n\
         MAE               {:.6e}\n\
         relMSE            {:.6e}\n\
         FLIP              {flip:.5}  (mean, {DEFAULT_PIXELS_PER_DEGREE} pixels per degree)\n\
         blocks            {:.5} (95th percentile), {:.5} (worst)  relative difference of 16 × 16 block means\n\
         non-finite pixels {} of {}",
        c.mse, c.mae, c.rel_mse, c.block_95, c.block_worst, c.non_finite, c.pixels
    )
}

fn as_json(c: &Comparison, flip: f64) -> String {
    json!({
        "mean_ratio": c.mean_ratio,
        "mse": c.mse,
        "mae": c.mae,
        "rel_mse": c.rel_mse,
        "flip": flip,
        "block_95": c.block_95,
        "block_worst": c.block_worst,
        "non_finite": c.non_finite,
        "pixels": c.pixels,
    })
    .to_string()
}
