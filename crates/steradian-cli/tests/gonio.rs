//! `steradian measure gonio`: cells against closed forms, and files that others read.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use roxmltree::{Document, Node};
use serde_json::Value;
use std::f64::consts::{FRAC_1_PI, PI};
use support::desk::Desk;

const SCENE: &str = r#"
WorldBegin
MakeNamedMaterial "paint" "string type" "diffuse" "spectrum reflectance" [ 300 0.6 900 0.6 ]
MakeNamedMaterial "veil" "string type" "diffusetransmission" "spectrum reflectance" [ 300 0.3 900 0.3 ]
  "spectrum transmittance" [ 300 0.5 900 0.5 ]
MakeNamedMaterial "glass" "string type" "thindielectric" "float eta" 1.5
MakeNamedMaterial "leather" "string type" "modifiedphong" "spectrum diffuse" [ 300 0.2 900 0.2 ]
  "spectrum specular" [ 300 0.6 900 0.6 ] "float exponent" 14
MakeNamedMaterial "metal" "string type" "conductor" "spectrum eta" [ 300 0.2 900 0.2 ]
  "spectrum k" [ 300 3.5 900 3.5 ] "float roughness" 0.4 "bool remaproughness" false
"#;

fn desk() -> Desk {
    Desk::new(SCENE)
}

/// The rows of a table whose light is of that kind.
fn rows<'v>(table: &'v Value, light: &str) -> Vec<&'v Value> {
    table["rows"].as_array().unwrap().iter().filter(|r| r["light"] == light).collect()
}

#[test]
fn a_lambertian_surface_reads_rho_over_pi_in_every_cell() {
    let desk = desk();
    let arguments = [
        "measure",
        "gonio",
        "scene.pbrt",
        "--material",
        "paint",
        "--incident",
        "40,0",
        "--wavelength",
        "500,600",
        "-o",
        "out.json",
        "-o",
        "out.csv",
        "--plot",
        "out.svg",
    ];
    desk.run(&arguments).succeeded();
    let table = desk.json("out.json");
    let cells = rows(&table, "scattered");
    assert_eq!(cells.len(), 2 * 216);
    for row in &cells {
        let [f, half_width] = ["value", "half_width"].map(|k| row["f"][k].as_f64().unwrap());
        assert!((f - 0.6 * FRAC_1_PI).abs() <= 3.0 * half_width + 1e-6, "{row}");
        assert!(half_width <= 0.0101 * f, "{row}");
    }
    let integral = |key: &str| cells.iter().map(|r| r[key]["value"].as_f64().unwrap()).sum::<f64>() / 2.0;
    assert!((integral("flux") - 0.6).abs() < 1e-3);
    for row in rows(&table, "all reflected") {
        assert!((row["flux"]["value"].as_f64().unwrap() - 0.6).abs() < 1e-3, "{row}");
    }
    assert!(rows(&table, "discrete").is_empty());
    let csv = desk.text("out.csv");
    let header = csv.lines().find(|l| !l.starts_with('#')).unwrap();
    for column in ["wavelength [nm]", "theta_o from [deg]", "f [1/sr]", "f ± [1/sr]", "s [1/sr]", "flux [1]"]
    {
        assert!(header.split(',').any(|c| c == column), "{header}");
    }
    assert!(csv.contains("# confidence: 95 %, statistical only") && csv.contains("# rays: "));
    assert!(desk.text("out.svg").contains("mean f of a cell [1/sr]"));
}

/// A pane: R = 2r/(1 + r) with r = 0.04, and the rest goes straight on.
#[test]
fn a_clear_pane_has_rows_for_its_two_discrete_directions() {
    let desk = desk();
    let arguments =
        ["measure", "gonio", "scene.pbrt", "--material", "glass", "--incident", "0,0", "-o", "out.json"];
    desk.run(&arguments).succeeded();
    let table = desk.json("out.json");
    let found: Vec<[f64; 3]> = rows(&table, "discrete")
        .iter()
        .map(|r| {
            [
                r["theta_o from"].as_f64().unwrap(),
                r["flux"]["value"].as_f64().unwrap(),
                r["flux"]["half_width"].as_f64().unwrap(),
            ]
        })
        .collect();
    let r = 2.0 * 0.04 / 1.04;
    for ([theta, flux, half_width], (from, truth)) in found.iter().zip([(0.0, r), (170.0, 1.0 - r)]) {
        assert!(*theta == from && (flux - truth).abs() <= 2.0 * half_width + 1e-6, "{found:?}");
    }
    assert_eq!(found.len(), 2);
}

#[test]
fn a_piece_of_geometry_is_measured_with_its_books() {
    let desk = desk();
    desk.put(
        "step.pbrt",
        "WorldBegin\nMaterial \"diffuse\" \"spectrum reflectance\" [ 300 0.6 900 0.6 ]\n\
         Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]",
    );
    let arguments = [
        "measure",
        "gonio",
        "step.pbrt",
        "--patch",
        "--incident",
        "30,0",
        "--theta-cells",
        "3",
        "--phi-cells",
        "4",
        "--precision",
        "5%",
        "-o",
        "out.json",
        "--port=-0.5,0.5,-0.5,0.5",
    ];
    desk.run(&arguments).succeeded();
    let table = desk.json("out.json");
    let flux = |light: &str| rows(&table, light)[0]["flux"]["value"].as_f64().unwrap();
    assert!((flux("sum") - 1.0).abs() < 1e-5 && (flux("absorbed") - 0.4).abs() < 1e-4);
    assert!((flux("all reflected") - 0.6).abs() < 1e-4 && flux("left by the sides") == 0.0);
    for row in rows(&table, "scattered").iter().filter(|r| r["theta_o to"].as_f64() <= Some(90.0)) {
        assert!((row["f"]["value"].as_f64().unwrap() / (0.6 / PI) - 1.0).abs() < 0.15, "{row}");
    }
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let desk = desk();
    let gonio = |more: &[&str]| desk.run(&[&["measure", "gonio", "scene.pbrt"], more].concat());
    gonio(&["--material", "paint", "--incident", "90,0"])
        .refused("theta must lie between 0 and 89.99 degrees");
    gonio(&["--patch", "--port", "1,0,0,1"]).refused("expected X0,X1,Y0,Y1 with X0 < X1");
    gonio(&["--patch", "--quiet"]).failed("error: the scene has no geometry");
    let table = ["--material", "paint", "--material-table", "t.csv", "-l", "500,600"];
    gonio(&table).failed(
        "error: a material table needs one wavelength, for a grey material, or several that cover 420–680 nm",
    );
    gonio(&["--material", "paint", "-l", "1500"])
        .failed("error: wavelength 1500 nm: the data of material \"paint\" reach from 300 to 900 nm");
}

fn child<'a, 'd>(node: Node<'a, 'd>, name: &str) -> Node<'a, 'd> {
    node.children().find(|n| n.has_tag_name(("http://windows.lbl.gov", name))).unwrap()
}

/// The visible matrix for one way that light goes, by rows.
fn matrix(document: &Document<'_>, direction: &str) -> Vec<Vec<f64>> {
    let all = document.descendants().filter(|n| n.tag_name().name() == "WavelengthData");
    let visible = all.filter(|n| child(*n, "Wavelength").text() == Some("Visible"));
    let blocks = visible.map(|n| child(n, "WavelengthDataBlock"));
    let mut wanted = blocks.filter(|b| child(*b, "WavelengthDataDirection").text() == Some(direction));
    let data = child(wanted.next().unwrap(), "ScatteringData").text().unwrap();
    let values: Vec<f64> = data.split([',', '\n']).filter_map(|v| v.trim().parse().ok()).collect();
    assert_eq!(values.len(), 145 * 145);
    values.chunks(145).map(<[f64]>::to_vec).collect()
}

/// Projected solid angles of the basis, from the angles that the file states.
fn lambda(document: &Document<'_>) -> Vec<f64> {
    let number = |n: Node<'_, '_>, name: &str| child(n, name).text().unwrap().parse::<f64>().unwrap();
    let rings = document.descendants().filter(|n| n.tag_name().name() == "AngleBasisBlock");
    rings
        .flat_map(|ring| {
            let bounds = child(ring, "ThetaBounds");
            let sin2 = |name| number(bounds, name).to_radians().sin().powi(2);
            let count = number(ring, "nPhis");
            vec![PI * (sin2("UpperTheta") - sin2("LowerTheta")) / count; count as usize]
        })
        .collect()
}

#[test]
fn klems_matrices_of_lambertian_surfaces_sum_to_rho_and_tau() {
    let desk = desk();
    let arguments = [
        "measure",
        "gonio",
        "scene.pbrt",
        "--material",
        "veil",
        "--klems",
        "veil.xml",
        "-l",
        "450,550,650",
        "--precision",
        "3%",
        "--method",
        "integration",
    ];
    let said = desk.run(&arguments).succeeded();
    assert!(said.out.contains("reciprocity of transmission at 550 nm: worst difference"), "{}", said.out);
    let text = desk.text("veil.xml");
    let document = Document::parse(&text).unwrap();
    let lambda = lambda(&document);
    assert!(lambda.len() == 145 && (lambda.iter().sum::<f64>() - PI).abs() < 1e-9);
    for (direction, total) in [
        ("Reflection Front", 0.3),
        ("Reflection Back", 0.3),
        ("Transmission Front", 0.5),
        ("Transmission Back", 0.5),
    ] {
        let matrix = matrix(&document, direction);
        for column in 0..145 {
            let sum: f64 = matrix.iter().zip(&lambda).map(|(row, l)| row[column] * l).sum();
            assert!((sum - total).abs() < 1e-5, "{direction} {column}: {sum}");
            assert!((matrix[column][77] - total * FRAC_1_PI).abs() < 1e-5);
        }
    }
    assert_eq!(document.descendants().filter(|n| n.tag_name().name() == "WavelengthData").count(), 8);
    let structure = document.descendants().find(|n| n.tag_name().name() == "IncidentDataStructure").unwrap();
    assert_eq!(structure.text(), Some("Columns"));
}

/// A smooth pane reflects and transmits along the diagonal of both matrices.
#[test]
fn klems_matrices_of_a_clear_pane_are_diagonal() {
    let desk = desk();
    let arguments = [
        "measure",
        "gonio",
        "scene.pbrt",
        "--material",
        "glass",
        "--klems",
        "glass.xml",
        "-l",
        "550",
        "--precision",
        "5%",
    ];
    desk.run(&arguments).succeeded();
    let text = desk.text("glass.xml");
    let document = Document::parse(&text).unwrap();
    let lambda = lambda(&document);
    let (r, t) = (matrix(&document, "Reflection Back"), matrix(&document, "Transmission Back"));
    for i in 0..145 {
        let column: f64 = (0..145).map(|row| (r[row][i] + t[row][i]) * lambda[row]).sum();
        let diagonal = (r[i][i] + t[i][i]) * lambda[i];
        assert!((diagonal - 1.0).abs() < 1e-4 && (column - 1.0).abs() < 1e-4, "{i}: {diagonal} {column}");
    }
    // Within 5° of the normal as at it.
    assert!((t[0][0] * lambda[0] - 0.923_08).abs() < 0.01, "{}", t[0][0] * lambda[0]);
}

/// A sphere on a floor under a lamp, 64 × 64.
fn still_life(material: &str) -> String {
    format!(
        r#"
LookAt 0 -4 4  0 0 0.4  0 0 1
Camera "perspective" "float fov" 32
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
Sampler "zsobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 1
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "spectrum L" [ 300 8 900 8 ]
  Translate -1.5 0.5 4.5
  Shape "sphere" "float radius" 0.9
AttributeEnd
{material}
Shape "trianglemesh" "point3 P" [ -6 -6 0  6 -6 0  6 6 0  -6 6 0 ] "integer indices" [ 0 1 2 0 2 3 ]
Translate 0 0 0.8
Shape "sphere" "float radius" 0.8
"#
    )
}

/// Pixels of a .pfm file, three numbers each.
fn pixels(bytes: &[u8]) -> Vec<f64> {
    let header = bytes.iter().enumerate().filter(|(_, b)| **b == b'\n').nth(2).unwrap().0;
    bytes[header + 1..]
        .chunks_exact(4)
        .map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap())))
        .collect()
}

/// Cells are 10° high and up to 15° wide. Half of the maximum of cos¹⁴ is 36° wide, little more than two of them; the
/// metal's lobe is wider at first, and gets as narrow across the plane of flat incidence. Both are grey: how far apart wavelengths
/// may be is another question.
#[test]
fn an_exported_table_renders_the_picture_of_its_material() {
    for name in ["leather", "metal"] {
        let desk = desk();
        let measure = ["measure", "gonio", "scene.pbrt", "--material", name, "--material-table", "table.csv"];
        desk.run(&[&measure[..], &["-l", "550"]].concat()).succeeded();
        let named = SCENE.replace("WorldBegin", "");
        desk.put("a.pbrt", still_life(&format!("{named}\nNamedMaterial \"{name}\"")));
        desk.put("b.pbrt", still_life("Material \"measured\" \"string filename\" \"table.csv\""));
        let [a, b] = ["a", "b"].map(|scene| {
            let (text, picture) = (format!("{scene}.pbrt"), format!("{scene}.pfm"));
            desk.run(&["render", &text, "-o", &picture]).succeeded();
            pixels(&desk.read(&picture))
        });
        let luminance = |p: &[f64], x: usize, y: usize| p[3 * (64 * y + x) + 1];
        let mean = |p: &[f64]| (0..4096).map(|i| luminance(p, i % 64, i / 64)).sum::<f64>() / 4096.0;
        let ratio = mean(&b) / mean(&a);
        assert!((ratio - 1.0).abs() < 0.01, "{name}: {ratio}");
        let mut worst = 0.0_f64;
        for block in 0..64 {
            let sum = |p: &[f64]| -> f64 {
                (0..64).map(|i| luminance(p, block % 8 * 8 + i % 8, block / 8 * 8 + i / 8)).sum()
            };
            // In the shadow there is nothing to compare.
            let bright = sum(&a).max(0.1 * 64.0 * mean(&a));
            worst = worst.max((sum(&b) - sum(&a)).abs() / bright);
        }
        assert!(worst < 0.01, "{name}: {worst}");
    }
}
