//! `steradian verify` as users meet it.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use support::desk::{Desk, Said};

const SCENE: &str = r#"WorldBegin
MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [ 0.5 0.2 0.1 ]
MakeNamedMaterial "printed" "string type" "modifiedphong" "spectrum diffuse" [ 400 0 700 0 ]
  "spectrum specular" [ 400 1 700 1 ] "float exponent" 10
  "string lobe" "halfway" "string normalization" "printed"
MakeNamedMaterial "legacy" "string type" "phong"
"#;

fn verify(desk: &Desk, arguments: &[&str]) -> Said {
    desk.run(&[&["verify", "scene.pbrt", "--effort", "quick", "--quiet"], arguments].concat())
}

#[test]
fn a_material_that_reflects_more_than_arrives_fails_with_numbers_and_directions() {
    let desk = Desk::new(SCENE);
    let output = verify(&desk, &["--material", "printed"]);
    let text = &output.out;
    assert_eq!(output.code, Some(1), "{text}");
    assert!(text.contains("FAIL") && text.contains("energy BROKEN: ρ + τ ≤ 1"), "{text}");
    // B (2.35) to the letter for n = 10.
    assert!(text.contains("2.86"), "{text}");
}

#[test]
fn a_lawful_material_passes_and_a_declared_break_needs_consent() {
    let desk = Desk::new(SCENE);
    verify(&desk, &["--material", "paint"]).succeeded();
    let refused = verify(&desk, &["--material", "legacy"]);
    assert_eq!(refused.code, Some(1));
    assert!(refused.out.contains("accepted with --declared"), "{refused:?}");
    verify(&desk, &["--material", "legacy", "--declared"]).succeeded();
}

#[test]
fn scripts_get_numbers_with_units_and_people_a_page() {
    let desk = Desk::new(SCENE);
    let output = verify(
        &desk,
        &["--material", "paint", "--json", "--html", "page.html", "--wavelengths", "500,600nm"],
    );
    let report: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    assert_eq!(report["units"]["wavelength"], "nm");
    assert_eq!(report["pass"], true);
    let paint = &report["subjects"][0];
    assert_eq!(paint["name"], "paint");
    assert_eq!(paint["verdict"], "lawful");
    let power = &paint["powers"][0];
    assert_eq!(power["wavelengths"][1], 600.0);
    let of = |key: &str| power[key]["reflectance"][0].as_f64().unwrap();
    assert!((of("by_quadrature") - of("by_albedo")).abs() < 1e-3, "{power}");
    let page = desk.text("page.html");
    assert!(page.starts_with("<!DOCTYPE html>") && page.matches("<svg").count() == 2);
    assert!(!page.contains("<script") && !page.contains("http-equiv"));
}

#[test]
fn an_unknown_material_names_those_that_there_are() {
    let desk = Desk::new(SCENE);
    let output = verify(&desk, &["--material", "pain"]);
    let text = &output.err;
    assert_eq!(output.code, Some(1));
    assert!(text.contains("no material \"pain\"") && text.contains("paint, printed, legacy"), "{text}");
}
