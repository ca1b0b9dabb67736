//! Files of measurements in scenes: what right ones reflect, and what a user sees of wrong ones, at the place in the scene
//! that names the file.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

#[path = "support/errors.rs"]
mod errors;

use errors::{expect, expect_with};
use std::f32::consts::FRAC_1_PI;
use std::path::Path;
use steradian::bsdf::measured::merl::{self, Extents};
use steradian::bsdf::measured::tabulate::{Azimuths, Nodes, tabulate};
use steradian::lab::Subject;
use steradian::math::{LocalDir, Vec3};
use steradian::optics::TrowbridgeReitz;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{MemoryFiles, compile};
use steradian::spectrum::Wavelengths;

/// A small `.bsdf` file of a grey surface.
fn bsdf() -> Vec<u8> {
    let wavelengths = vec![400.0, 550.0, 700.0];
    let nodes = Nodes { theta: 3, azimuths: Azimuths::Isotropic, facets: 8, directions: 8, wavelengths };
    tabulate(&TrowbridgeReitz::new(0.5, 0.5), &nodes, |_, _, _| 0.5 * FRAC_1_PI)
}

/// Expects `message` at the file's name in a scene that uses `bytes` under that name.
#[track_caller]
fn refused(name: &str, bytes: &[u8], message: &str) {
    let line = format!(r#"Material "measured" "string filename" "{name}""#);
    let marks = "^".repeat("\"string filename\"".len());
    expect_with(
        &format!("WorldBegin\n{line}\nShape \"sphere\"\n"),
        [(name, bytes)],
        &format!(
            "scene.pbrt:2:21: error: cannot read measurement {name}: {message}\n 2 | {line}\n   |{}{marks}",
            " ".repeat(21)
        ),
    );
}

/// Reflectance at 550 nm for light from 40°, of a scene's material from a file.
fn reflectance(name: &str, bytes: &[u8]) -> f32 {
    let text = format!(
        "WorldBegin\nMakeNamedMaterial \"m\" \"string type\" \"measured\" \"string filename\" \"{name}\"\n\
         NamedMaterial \"m\"\nShape \"sphere\"\n"
    );
    let files = MemoryFiles::new().with(name, bytes);
    let input = Input::Text { name: "scene.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    let mut imported = import(&[input], &files);
    let job = compile(imported.scene.unwrap(), &files, &mut imported.diagnostics).unwrap();
    let subject = Subject::find(&job, "m").unwrap();
    let mut w = Wavelengths::exactly([550.0; 4]);
    let bsdf = subject.scatterer(&mut w, 1).unwrap();
    let (sin, cos) = 40.0_f32.to_radians().sin_cos();
    bsdf.albedo(LocalDir::new(Vec3::new(0.6 * sin, 0.8 * sin, cos)).unwrap()).reflectance[0]
}

#[test]
fn a_constant_f_of_a_half_over_pi_reflects_a_half_in_each_format() {
    let grey = 0.5 * FRAC_1_PI;
    let wavelengths = vec![400.0, 700.0];
    let nodes = Nodes { theta: 5, azimuths: Azimuths::Isotropic, facets: 64, directions: 64, wavelengths };
    let bsdf = tabulate(&TrowbridgeReitz::new(1.0, 1.0), &nodes, |_, _, _| grey);
    let extents = Extents { theta_h: 20, theta_d: 20, phi_d: 20 };
    let binary = merl::write(extents, |_, _| [grey; 3]);
    let mut csv = "theta_i [deg], phi_i [deg], theta_o [deg], phi_o [deg], f [1/sr]\n".to_owned();
    for theta_o in [0, 45, 90] {
        csv += &format!("0, 0, {theta_o}, 0, {grey}\n80, 0, {theta_o}, 0, {grey}\n");
    }
    // Directions near the horizon lie between a node above it and one below in the first two.
    for (name, bytes, tolerance) in
        [("a.bsdf", bsdf, 0.02), ("a.binary", binary, 0.02), ("a.csv", csv.into_bytes(), 0.002)]
    {
        let rho = reflectance(name, &bytes);
        assert!((rho - 0.5).abs() < tolerance, "{name}: {rho}");
    }
}

#[test]
fn a_file_that_was_cut_off_is_named() {
    let file = bsdf();
    refused("a.bsdf", &file[..file.len() - 100], "the file ends before the data of field `spectra`");
    refused("a.bsdf", &file[..30], "the file ends within the list of its fields");
    refused("a.bsdf", b"", "this is no tensor file: it does not begin with `tensor_file`");
}

#[test]
fn another_file_under_the_name_of_a_measurement_is_told_apart() {
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    refused("a.bsdf", png, "this is no tensor file: it does not begin with `tensor_file`");
    refused(
        "a.png",
        png,
        "this is neither an RGL .bsdf file, nor a MERL .binary file, nor a goniometer table in CSV",
    );
}

#[test]
fn a_missing_field_and_a_wrong_value_are_named() {
    let mut file = bsdf();
    let at = file.windows(5).position(|w| w == b"sigma").unwrap();
    file[at] = b'S';
    refused("a.bsdf", &file, "there is no field `sigma`");
    let mut file = bsdf();
    let end = file.len();
    file[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
    refused("a.bsdf", &file, "field `spectra` has a value of NaN");
}

#[test]
fn a_measurement_of_half_of_the_visible_range_is_not_extrapolated() {
    let nodes = Nodes {
        theta: 3,
        azimuths: Azimuths::Isotropic,
        facets: 8,
        directions: 8,
        wavelengths: vec![500.0, 700.0],
    };
    let file = tabulate(&TrowbridgeReitz::new(0.5, 0.5), &nodes, |_, _, _| 0.1);
    refused(
        "a.bsdf",
        &file,
        "the wavelengths 500–700 nm do not cover 420–680 nm, and nothing is extrapolated",
    );
}

#[test]
fn mistakes_in_a_goniometer_table_have_their_line_and_column() {
    let header = "theta_i [deg], phi_i [deg], theta_o [deg], phi_o [deg], f [1/sr]";
    let table = |rows: &str| format!("# a sheet\n{header}\n{rows}").into_bytes();
    refused("a.csv", &table("0, 0, 0, 0, 0.1\n0, 0, 30, O, 0.1\n"), "line 4, column 11: `O` is not a number");
    refused(
        "a.csv",
        &table("0, 0, 0, 0, 0.1\n0, 0, 30, 0, -0.1\n"),
        "line 4, column 14: f = -0.1 is not a number from zero up",
    );
    refused(
        "a.csv",
        &table("0, 0, 0, 0, 0.1\n60, 0, 30, 0, 0.1\n"),
        "there is no row for theta_i 0°, phi_i 0°, theta_o 30°, phi_o 0°",
    );
    refused(
        "a.csv",
        b"wavelength,value\n",
        "line 1, column 1: column `wavelength`, expected `theta_i [deg]`",
    );
}

#[test]
fn a_merl_file_that_was_cut_off_is_named() {
    let mut file = Vec::new();
    file.extend([2_i32; 3].iter().flat_map(|n| n.to_le_bytes()));
    file.extend([0.5_f64; 23].iter().flat_map(|v| v.to_le_bytes()));
    refused(
        "a.binary",
        &file,
        "this is no MERL file: its first 12 bytes are not the extents of a table of 196 bytes",
    );
}

#[test]
fn a_measurement_without_a_file_is_no_material() {
    expect(
        "WorldBegin\nMaterial \"measured\"\n",
        r#"
scene.pbrt:2:10: error: material "measured" needs a parameter "filename"
 2 | Material "measured"
   |          ^^^^^^^^^^
"#,
    );
    expect(
        "WorldBegin\nMaterial \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\"\n",
        r#"
scene.pbrt:2:39: error: cannot read a.bsdf: no such file
 2 | Material "measured" "string filename" "a.bsdf"
   |                                       ^^^^^^^^
"#,
    );
}
