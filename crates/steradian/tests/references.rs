//! Real scenes against reference pictures, at few samples: a guard between full runs of `cargo xtask references`.
//!
//! The collection is not part of the project; without it beside the checkout there is nothing to compare.
#![allow(clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use std::path::{Path, PathBuf};
use steradian::image::{Outliers, compare, read_frame_exr};
use steradian::render::RenderOptions;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{Disk, Overrides, compile};

fn collection() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    folder.join("scenes.tsv").is_file().then_some(folder)
}

/// The mean of each channel must agree within 2 %: at 16 samples the mean's own noise is below 0.5 % in these scenes.
fn agrees(name: &str, file: &str) {
    let Some(folder) = collection() else { return };
    let bytes = std::fs::read(folder.join(format!("references/{name}.exr"))).unwrap();
    let reference = read_frame_exr(&bytes).unwrap();
    let mut imported = import(&[Input::File(&folder.join(file))], &Disk);
    let mut desc = imported.scene.take().unwrap();
    let overrides =
        Overrides { spp: Some(16), resolution: Some(reference.resolution()), ..Overrides::default() };
    overrides.apply(&mut desc).unwrap();
    let job = compile(desc, &Disk, &mut imported.diagnostics);
    let job = job.unwrap_or_else(|| panic!("{}", imported.diagnostics.display(&imported.sources)));
    let frame = support::render(&job, &RenderOptions::default());
    let c = compare(&frame, &reference, Outliers::LimitAtQuantile(0.999)).unwrap();
    assert!(c.mean_ratio.iter().all(|r| (r - 1.0).abs() < 0.02), "{name}: {c:?}");
    assert_eq!(c.non_finite, 0);
}

#[test]
fn cornell_box_agrees_with_its_reference() {
    agrees("cornell-box", "cornell-box/scene-v4.pbrt");
}

#[test]
fn metal_plates_under_spherical_lights_agree_with_their_reference() {
    agrees("veach-mis", "veach-mis/scene-v4.pbrt");
}

#[test]
fn coated_ball_under_an_environment_agrees_with_its_reference() {
    agrees("material-testball", "material-testball/scene-v4.pbrt");
}
