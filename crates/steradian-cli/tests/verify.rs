//! `steradian verify` as users meet it.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

use std::process::{Command, Output};

const SCENE: &str = r#"WorldBegin
MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [ 0.5 0.2 0.1 ]
MakeNamedMaterial "printed" "string type" "modifiedphong" "spectrum diffuse" [ 400 0 700 0 ]
  "spectrum specular" [ 400 1 700 1 ] "float exponent" 10
  "string lobe" "halfway" "string normalization" "printed"
MakeNamedMaterial "legacy" "string type" "phong"
"#;

fn verify(folder: &tempfile::TempDir, arguments: &[&str]) -> Output {
    std::fs::write(folder.path().join("scene.pbrt"), SCENE).unwrap();
    Command::new(env!("CARGO_BIN_EXE_steradian"))
        .current_dir(folder.path())
        .args(["verify", "scene.pbrt", "--effort", "quick", "--quiet"])
        .args(arguments)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn a_material_that_reflects_more_than_arrives_fails_with_numbers_and_directions() {
    let folder = tempfile::TempDir::new().unwrap();
    let output = verify(&folder, &["--material", "printed"]);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("FAIL") && text.contains("energy BROKEN: ρ + τ ≤ 1"), "{text}");
    // B (2.35) to the letter for n = 10.
    assert!(text.contains("2.86"), "{text}");
}

#[test]
fn a_lawful_material_passes_and_a_declared_break_needs_consent() {
    let folder = tempfile::TempDir::new().unwrap();
    assert!(verify(&folder, &["--material", "paint"]).status.success());
    let refused = verify(&folder, &["--material", "legacy"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(said(&refused).contains("accepted with --declared"), "{}", said(&refused));
    assert!(verify(&folder, &["--material", "legacy", "--declared"]).status.success());
}

#[test]
fn scripts_get_numbers_with_units_and_people_a_page() {
    let folder = tempfile::TempDir::new().unwrap();
    let output = verify(
        &folder,
        &["--material", "paint", "--json", "--html", "page.html", "--wavelengths", "500,600nm"],
    );
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["units"]["wavelength"], "nm");
    assert_eq!(report["pass"], true);
    let paint = &report["subjects"][0];
    assert_eq!(paint["name"], "paint");
    assert_eq!(paint["verdict"], "lawful");
    let power = &paint["powers"][0];
    assert_eq!(power["wavelengths"][1], 600.0);
    let of = |key: &str| power[key]["reflectance"][0].as_f64().unwrap();
    assert!((of("by_quadrature") - of("by_albedo")).abs() < 1e-3, "{power}");
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.matches("<svg").count() == 2);
    assert!(!page.contains("<script") && !page.contains("http-equiv"));
}

#[test]
fn an_unknown_material_names_those_that_there_are() {
    let folder = tempfile::TempDir::new().unwrap();
    let output = verify(&folder, &["--material", "pain"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(text.contains("no material \"pain\"") && text.contains("paint, printed, legacy"), "{text}");
}
