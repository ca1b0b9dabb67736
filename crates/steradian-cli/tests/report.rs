//! `steradian report`: closed forms on grids and in views, files that others read, faults that are named.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use serde_json::Value;
use std::f64::consts::PI;
use support::desk::Desk;

/// A sky of 40 cd/m² all around, and a ball of 5000 cd/m² ahead, above and to the right of an eye at the origin that looks along z.
const BALL: &str = r#"
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 40
AttributeBegin
  AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "float scale" 5000
  Translate 1 0.8 2
  Shape "sphere" "float radius" 0.25
AttributeEnd
"#;

/// The row of a table whose first column has the word.
fn row<'a>(json: &'a Value, table: usize, word: &str) -> &'a Value {
    let rows = json["tables"][table]["rows"].as_array().unwrap();
    rows.iter().find(|r| r.as_object().unwrap().values().any(|v| v == word)).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().or_else(|| value["value"].as_f64()).unwrap()
}

#[test]
fn a_ball_in_the_sky_has_the_glare_of_the_formulas() {
    let desk = Desk::new(BALL);
    let view = "--view=seat=0,0,0,0,0,1,0,1,0";
    let arguments =
        ["report", "scene.pbrt", view, "--view-size", "480", "--view-spp", "8", "-o", "out", "-q"];
    desk.run(&arguments).succeeded();
    let json = desk.json("out/report.json");
    let distance = (1.0_f64 + 0.64 + 4.0).sqrt();
    let sin = 0.25 / distance;
    let cos = 2.0 / distance;
    let omega = 2.0 * PI * (1.0 - (1.0 - sin * sin).sqrt());
    // A sphere's cosine-weighted solid angle is π sin²σ cosθ, which the sky lacks.
    let own = PI * sin * sin * cos;
    let vertical = 40.0 * (PI - own) + 5000.0 * own;
    let background = 40.0 * (1.0 - own / PI);
    let (alpha, beta) = ((1.0_f64).atan2(0.8).to_degrees(), cos.acos().to_degrees());
    let guth = ((35.2 - 0.31889 * alpha - 1.22 * (-2.0 * alpha / 9.0).exp()) * 1e-3 * beta
        + (21.0 + 0.26667 * alpha - 0.002963 * alpha * alpha) * 1e-5 * beta * beta)
        .exp();
    let weight = 5000.0_f64.powi(2) * omega / (guth * guth);
    let ugr = 8.0 * (0.25 / background * weight).log10();
    let dgp = 5.87e-5 * vertical + 0.0918 * (1.0 + weight / vertical.powf(1.87)).log10() + 0.16;
    let read = |name: &str| number(&row(&json, 0, name)["value"]);
    // Pixels on the rim of the ball are covered in part: those below the threshold count as background.
    for (name, expected, tolerance) in [
        ("vertical illuminance at the eye", vertical, 0.01 * vertical),
        ("background luminance", background, 0.035 * background),
        ("UGR", ugr, 0.4),
        ("DGP", dgp, 0.004),
        ("sources", 1.0, 0.0),
        ("threshold", 2000.0, 0.0),
    ] {
        assert!((read(name) - expected).abs() <= tolerance, "{name}: {} expected {expected}", read(name));
    }
    let source = &json["tables"][1]["rows"][0];
    for (name, expected, tolerance) in [
        ("mean luminance", 5000.0, 200.0),
        ("solid angle", omega, 0.03 * omega),
        ("to the right", (0.5_f64).atan().to_degrees(), 0.3),
        ("upwards", (0.8 / distance).asin().to_degrees(), 0.3),
        ("x", 1.0 / distance, 0.005),
        ("position index", guth, 0.03),
    ] {
        let found = number(&source[name]);
        assert!((found - expected).abs() <= tolerance, "{name}: {found} expected {expected}");
    }
    // The picture for Radiance: pbrt's world is left-handed, Radiance's is not.
    let picture = desk.read("out/view-seat.hdr");
    let end = picture.windows(2).position(|w| w == b"\n\n").unwrap();
    let header = std::str::from_utf8(&picture[..end]).unwrap();
    assert!(header.starts_with("#?RADIANCE\n"), "{header}");
    assert!(header.contains("\nVIEW= -vta -vp 0 0 0 -vd 0 0 1 -vu 0 1 0 -vh 180 -vv 180\n"), "{header}");
    assert!(picture[end..].starts_with(b"\n\n-Y 480 +X 480\n"));
    for name in ["view-seat.svg", "view-seat.png", "view-seat.csv", "view-seat-sources.csv", "index.html"] {
        assert!(!desk.read(&format!("out/{name}")).is_empty(), "{name}");
    }
    let svg = desk.text("out/view-seat.svg");
    let document = roxmltree::Document::parse(&svg).unwrap();
    assert!(document.descendants().any(|n| n.has_tag_name("image")));
}

/// Half of the sky of 100 cd/m² is hidden by a black wall without an end: E = 50π, daylight factor 50 %.
#[test]
fn half_a_sky_gives_half_the_daylight() {
    let scene = r#"
        WorldBegin
        LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 100
        Material "diffuse" "spectrum reflectance" [ 360 0 830 0 ]
        Shape "bilinearmesh" "point3 P" [ 0 -1e5 -1e5  0 1e5 -1e5  0 -1e5 1e5  0 1e5 1e5 ]
    "#;
    let desk = Desk::new(scene);
    let grid = "--grid=yard=1,0,0,2,0,0,0,2,0,3,2";
    desk.run(&["report", "scene.pbrt", grid, "--precision", "2%", "-o", "out", "-q"]).succeeded();
    let json = desk.json("out/report.json");
    let yard = row(&json, 0, "yard");
    assert!((number(&yard["mean illuminance"]) / (50.0 * PI) - 1.0).abs() < 0.03, "{yard}");
    assert!((number(&yard["illuminance outdoors"]) / (100.0 * PI) - 1.0).abs() < 0.01, "{yard}");
    assert!((number(&yard["daylight factor, mean"]) - 50.0).abs() < 1.0, "{yard}");
    // All points are alike, and the report must know that it cannot tell them apart.
    let (low, high) = (number(&yard["U0 at least"]), number(&yard["U0 at most"]));
    assert!(low < number(&yard["U0 of the readings"]) && high > 0.99 && low > 0.9, "{yard}");
    assert_eq!(number(&yard["points that may be the minimum"]), 6.0);
    let facts = json["tables"][0]["facts"].to_string();
    assert!(
        facts.contains("EN 17037, yard: minimum (300 lx on half, 100 lx on 95 % of the points)"),
        "{facts}"
    );
    // 300 lx are 50 % of 600 lx.
    assert!(facts.contains("at least 60") || facts.contains("at least 59"), "{facts}");
    let csv = desk.text("out/grid-yard.csv");
    assert_eq!(csv.lines().filter(|l| !l.starts_with('#')).count(), 7);
    assert!(
        csv.contains("illuminance [lx],illuminance ± [lx]") && csv.contains("daylight factor [%]"),
        "{csv}"
    );
    assert!(desk.text("out/index.html").contains("Grid yard"));
}

/// The floor's middle of a black room of 4 m × 4 m × 3 m with an opening of 1 m × 1 m in the middle of its roof, under the CIE's
/// overcast sky: E/E_h = 9/(7π) · ⅓ (C + 2J) with C = ∫cosθ dω and J = ∫cos²θ dω over the opening, 4.35898 %.
#[test]
fn a_roof_light_under_the_overcast_sky_has_the_daylight_factor_of_its_closed_form() {
    let mut scene =
        "WorldBegin\nLightSource \"sky\" \"string model\" \"overcast\" \"float illuminance\" 10000\n\
                     Material \"diffuse\" \"spectrum reflectance\" [ 360 0 830 0 ]\n"
            .to_owned();
    for [x0, y0, x1, y1] in
        [[-2.0, -2.0, -0.5, 2.0], [0.5, -2.0, 2.0, 2.0], [-0.5, -2.0, 0.5, -0.5], [-0.5, 0.5, 0.5, 2.0]]
    {
        scene += &format!(
            "Shape \"bilinearmesh\" \"point3 P\" [ {x0} {y0} 3  {x1} {y0} 3  {x0} {y1} 3  {x1} {y1} 3 ]\n"
        );
    }
    // Walls: the sky must not come in from the sides.
    for [x0, y0, x1, y1] in [[-2, -2, 2, -2], [2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2]] {
        scene += &format!(
            "Shape \"bilinearmesh\" \"point3 P\" [ {x0} {y0} -1  {x1} {y1} -1  {x0} {y0} 3  {x1} {y1} 3 ]\n"
        );
    }
    let desk = Desk::new(&scene);
    let grid = "--grid=middle=-0.005,-0.005,0,0.01,0,0,0,0.01,0,1,1";
    desk.run(&["report", "scene.pbrt", grid, "--precision", "2%", "-o", "out", "-q"]).succeeded();
    let json = desk.json("out/report.json");
    let middle = row(&json, 0, "middle");
    let factor = &middle["daylight factor, mean"];
    let half = factor["half_width"].as_f64().unwrap();
    // At one point the interval misses in one of twenty seeds; twice its width in less than one of ten thousand.
    assert!((number(factor) - 4.358_98).abs() < 2.0 * half && half < 0.1, "{middle}");
    assert!((number(&middle["illuminance outdoors"]) / 1e4 - 1.0).abs() < 0.004, "{middle}");
}

#[test]
fn the_example_of_the_help_works() {
    let desk = Desk::new("");
    let arguments =
        ["report", "--grid", "plane=0,400,0,0,0,559,556,0,0,6,6", "--view", "camera", "-o", "cornell"];
    // As in the help, but rough.
    let rough = ["--view-size", "64", "--view-spp", "8", "--precision", "20%"];
    let said = desk.run(&[&arguments[..], &rough].concat()).succeeded();
    assert!(said.out.contains("illuminance on grids") && said.out.contains("UGR"), "{}", said.out);
    assert!(said.err.contains("report: cornell/index.html"), "{}", said.err);
    let html = desk.text("cornell/index.html");
    assert!(html.contains("the built-in Cornell box") && html.contains("<svg"));
    let json = desk.json("cornell/report.json");
    let plane = row(&json, 0, "plane");
    let (low, high) = (number(&plane["U0 at least"]), number(&plane["U0 at most"]));
    assert!(0.0 < low && low < high && high <= 1.0, "{plane}");
}

#[test]
fn faults_are_named() {
    let desk = Desk::new(BALL);
    let said = desk.run(&["report", "scene.pbrt"]);
    assert!(said.code == Some(1) && said.err.contains("name a --grid"), "{said:?}");
    desk.run(&["report", "scene.pbrt", "--grid", "1,2,3"]).refused("expected 11 numbers");
    desk.run(&["report", "scene.pbrt", "--view", "0,0,0,0,0,1"]).refused("9 numbers");
    desk.run(&["report", "scene.pbrt", "--view=camera", "--glare-threshold", "0"]).refused("2000");
    desk.run(&["report", "scene.pbrt", "--view", "0,0,0,0,0,1,0,0,2", "-q"])
        .failed("error: view view: the upward direction must not lie along the line of sight");
}
