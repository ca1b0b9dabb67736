//! Leaves in scenes: what they reflect and transmit, that they obey the laws, and what a user sees of wrong ones.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

#[path = "support/errors.rs"]
#[allow(dead_code, reason = "each test binary uses its part of this module")]
mod errors;

use errors::expect_with;
use std::path::Path;
use steradian::bsdf::conformance::Effort;
use steradian::lab::probe::Probe;
use steradian::lab::{Subject, verify};
use steradian::math::LocalDir;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{MemoryFiles, RenderJob, compile};

/// Invented: a green pigment, water, and the two parts of dry matter.
const TABLE: &str = "lambda nrefrac SAC_CHL SAC_EWT SAC_PROT SAC_CBC\n400 1.5 0.1 0 2 1\n500 1.48 0.05 0 1 1\n\
     550 1.47 0.01 0 1 1\n650 1.46 0.06 0 1 1\n700 1.45 0 0 1 1\n1000 1.4 0 40 5 9\n";

fn job(parameters: &str, table: &str) -> RenderJob {
    let text = format!(
        "WorldBegin\nMakeNamedMaterial \"l\" \"string type\" \"leaf\" \"string coefficients\" \"table.txt\" {parameters}\n"
    );
    let files = MemoryFiles::new().with("table.txt", table);
    let input = Input::Text { name: "scene.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    let mut imported = import(&[input], &files);
    compile(imported.scene.unwrap(), &files, &mut imported.diagnostics).unwrap()
}

fn shares(job: &RenderJob, lambda: f32) -> [f64; 2] {
    let probe = Probe::new(&Subject::find(job, "l").unwrap(), &[lambda]).unwrap();
    let albedo = probe.albedo(LocalDir::Z)[0];
    [albedo.reflectance, albedo.transmittance]
}

#[test]
fn the_published_leaf_has_its_published_colours_in_a_scene() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/prospect-pro-coefficients.txt");
    let Ok(table) = std::fs::read_to_string(&path) else {
        println!("skipped: there is no {}", path.display());
        return;
    };
    // The healthy one is the default.
    let job = job("", &table);
    for (lambda, r, t) in [
        (450.0, 0.041251, 0.001399),
        (550.0, 0.151166, 0.150252),
        (680.0, 0.036002, 0.005272),
        (800.0, 0.442341, 0.474429),
        (1450.0, 0.121504, 0.155602),
        (2200.0, 0.126856, 0.212914),
    ] {
        let [reflected, transmitted] = shares(&job, lambda);
        assert!((reflected - r).abs() < 2e-6 && (transmitted - t).abs() < 2e-6, "{lambda}");
    }
}

#[test]
fn more_chlorophyll_darkens_where_it_absorbs_and_nowhere_else() {
    let [pale, green] = ["5", "60"].map(|amount| job(&format!("\"float chlorophyll\" {amount}"), TABLE));
    for lambda in [400.0, 450.0, 550.0, 650.0] {
        let ([r0, t0], [r1, t1]) = (shares(&pale, lambda), shares(&green, lambda));
        assert!(r1 < r0 && t1 < t0, "{lambda}");
    }
    assert_eq!(shares(&pale, 900.0), shares(&green, 900.0));
}

#[test]
fn instruments_see_the_range_of_the_table_and_pictures_its_ends_held() {
    let job = job("", TABLE);
    assert_eq!(Subject::find(&job, "l").unwrap().range(), (400.0, 1000.0));
    assert_eq!(shares(&job, 360.0), shares(&job, 400.0));
}

#[test]
fn the_conformance_suite_passes_for_leaves() {
    let job = job("\"float structure\" 2.2 \"float proteins\" 0.001 \"float carbonbased\" 0.003", TABLE);
    let options = verify::Options { effort: Effort::QUICK, ..verify::Options::default() };
    let report = verify::subjects(&[Subject::find(&job, "l").unwrap()], &options, &|_, _| {});
    assert!(report.passes(verify::Acceptance::Lawful));
}

/// A scene with this leaf, and the fault expected at its 2nd line from `column` on under `marked` characters.
#[track_caller]
fn refused(parameters: &str, table: &str, column: usize, marked: usize, message: &str) {
    let line = format!("Material \"leaf\" \"string coefficients\" \"table.txt\" {parameters}");
    let line = line.trim_end();
    expect_with(
        &format!("WorldBegin\n{line}\nShape \"sphere\"\n"),
        [("table.txt", table.as_bytes())],
        &format!(
            "scene.pbrt:2:{column}: error: {message}\n 2 | {line}\n   |{}{}",
            " ".repeat(column),
            "^".repeat(marked)
        ),
    );
}

#[test]
fn wrong_leaves_are_refused_where_they_are_wrong() {
    refused(
        "",
        &TABLE.replace("0.05", "green"),
        17,
        21,
        "cannot read coefficients table.txt: line 3, column 10: `green` is not a number",
    );
    refused(
        "",
        "lambda nrefrac SAC_CHL\n500 1.5 0\n900 1.4 0\n",
        17,
        21,
        "cannot read coefficients table.txt: the wavelengths 500–900 nm do not cover 420–680 nm, and nothing is extrapolated",
    );
    refused(
        "\"float brown\" 0.5",
        TABLE,
        51,
        13,
        "the table of coefficients has no column `SAC_BROWN` for \"brown\"",
    );
    refused(
        "\"float structure\" 0.5",
        TABLE,
        51,
        17,
        "parameter \"structure\" must be from 1 to 10, found 0.5",
    );
    refused(
        "\"float drymatter\" 1 \"float proteins\" 1",
        TABLE,
        51,
        17,
        "\"drymatter\" is all of it: give it, or \"proteins\" and \"carbonbased\", not both",
    );
}

#[test]
fn a_film_cannot_record_wavelengths_that_the_table_lacks() {
    expect_with(
        "Film \"spectral\" \"float lambdamin\" 380 \"float lambdamax\" 1200\nWorldBegin\n\
         Material \"leaf\" \"string coefficients\" \"table.txt\"\nShape \"sphere\"\n",
        [("table.txt", TABLE.as_bytes())],
        "scene.pbrt:3:17: error: the film records 380–1200 nm, but there are data for 400–1000 nm only\n \
         3 | Material \"leaf\" \"string coefficients\" \"table.txt\"\n   |                 ^^^^^^^^^^^^^^^^^^^^^",
    );
}
