//! `steradian measure lux`, `luminance` and `pixel` as users meet them.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use serde_json::Value;
use support::desk::Desk;

/// 90 cd at a height of 3, over a white table that reaches to x = 1.
const SCENE: &str = r#"LookAt 0 -5 1  0 0 0  0 0 1
Camera "perspective"
WorldBegin
LightSource "point" "point3 from" [ 0 0 3 ] "spectrum I" [ 300 1 900 1 ] "float scale" 90
Material "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ]
Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] "integer indices" [ 0 1 2  0 2 3 ]
"#;

fn value(row: &Value, column: &str) -> f64 {
    row[column]["value"].as_f64().unwrap_or_else(|| panic!("no {column} in {row}"))
}

#[test]
fn points_from_everywhere_are_measured_in_order() {
    let desk = Desk::new(SCENE);
    desk.put("list.txt", "# x y z  nx ny nz\n0 0 1.5  0 0 1\n\n0,0,2, 0,0,-1 # from below: the table\n");
    let arguments = [
        "measure",
        "lux",
        "scene.pbrt",
        "--points",
        "-",
        "--point=0,0,0,0,0,2",
        "--points",
        "list.txt",
        "--grid",
        "-1,-1,0,2,0,0,0,2,0,2,1",
        "-o",
        "lux.json",
        "-o",
        "lux.csv",
        "--plot",
        "lux.svg",
    ];
    let said = desk.run_with(&arguments, "0 4 0 0 -1 0\n").succeeded();
    assert!(said.out.is_empty() && said.err.contains("lux.json"), "{said:?}");
    let json = desk.json("lux.json");
    let rows = json["rows"].as_array().unwrap();
    // I cosθ/r²; the corner cells of the grid see 90·3/(1/4 + 9)^(3/2) at (±1/2, 0).
    let cell = 90.0 * 3.0 / 9.25_f64.powf(1.5);
    for (row, expected) in rows.iter().zip([10.0, 90.0 * 4.0 / 125.0, 40.0, 0.0, cell, cell]) {
        let (read, rays) = (value(row, "illuminance"), row["rays"].as_f64().unwrap());
        // What the table sends back reaches the third and the fourth meter as well.
        let direct_only = expected > 0.0;
        assert!(!direct_only || (read - expected).abs() < 0.02 * expected, "{row}, expected {expected}");
        assert!(rays > 0.0);
    }
    assert!(value(&rows[3], "illuminance") > 1.0, "light from the table: {}", rows[3]);
    assert_eq!((rows.len(), rows[4]["x"].as_f64(), rows[4]["nz"].as_f64()), (6, Some(-0.5), Some(1.0)));
    assert_eq!(json["columns"][7], serde_json::json!({ "name": "illuminance", "unit": "lx" }));
    assert_eq!(json["facts"]["intervals"], "95 % confidence, statistical only");
    assert_eq!(json["facts"]["ending"], "precision met");
    assert!(json["facts"]["light"].as_str().unwrap().contains("1000 bounces"));
    assert!(desk.text("lux.csv").contains("\npoint,x [scene units],"));
    assert!(desk.text("lux.svg").starts_with("<svg"));
}

#[test]
fn direct_and_indirect_light_spectra_and_watts_are_columns_with_units() {
    let desk = Desk::new(SCENE);
    let split = [
        "measure",
        "lux",
        "scene.pbrt",
        "--point",
        "0,0,1,0,0,-1",
        "--split",
        "--precision",
        "5%",
        "-o",
        "split.json",
    ];
    desk.run(&split).succeeded();
    let row = &desk.json("split.json")["rows"][0];
    assert_eq!(value(row, "direct illuminance"), 0.0);
    let (total, indirect) = (value(row, "illuminance"), value(row, "indirect illuminance"));
    assert!(total > 1.0 && (total - indirect).abs() < 1e-9 * total, "{row}");
    let spectral = [
        "measure",
        "lux",
        "scene.pbrt",
        "--point",
        "0,0,0,0,0,1",
        "--spectral",
        "400:700:100",
        "-o",
        "s.csv",
        "--plot",
        "s.svg",
    ];
    desk.run(&spectral).succeeded();
    let csv = desk.text("s.csv");
    assert!(csv.contains("wavelength [nm],spectral irradiance [W·m⁻²·nm⁻¹]"), "{csv}");
    assert_eq!(csv.lines().filter(|l| l.starts_with("1,0,0,0,0,0,1,")).count(), 4);
    // 90 cd of equal energy are 90/(683.002 · 106.857) W·sr⁻¹·nm⁻¹, at 3 m.
    let row = csv.lines().find(|l| l.contains(",500,")).unwrap();
    let read: f64 = row.split(',').nth(8).unwrap().parse().unwrap();
    assert!((read / (10.0 / (683.002 * 106.857)) - 1.0).abs() < 1e-4, "{row}");
    desk.run(&[
        "measure",
        "lux",
        "scene.pbrt",
        "--point",
        "0,0,0,0,0,1",
        "--radiant",
        "--quiet",
        "-o",
        "w.csv",
    ])
    .succeeded();
    assert!(desk.text("w.csv").contains("irradiance [W·m⁻²],irradiance ± [W·m⁻²]"), "{}", desk.text("w.csv"));
}

#[test]
fn receptors_weigh_light_each_in_its_own_way() {
    // 10 lx of daylight are 10 lx to every receptor, by definition of the equivalent.
    let daylight = SCENE.replace("[ 300 1 900 1 ] \"float scale\" 90", "\"stdillum-D65\" \"float scale\" 90");
    let desk = Desk::new(&daylight);
    for receptor in ["s-cone", "m-cone", "l-cone", "rhodopic", "melanopic"] {
        let point = ["measure", "lux", "scene.pbrt", "--point", "0,0,0,0,0,1", "-o", "r.json"];
        desk.run(&[&point[..], &["--receptor", receptor]].concat()).succeeded();
        let json = desk.json("r.json");
        let name = json["columns"][7]["name"].as_str().unwrap();
        assert!(name.contains("equivalent daylight (D65) illuminance"), "{name}");
        let read = value(&json["rows"][0], name);
        assert!((read / 10.0 - 1.0).abs() < 0.01, "{receptor}: {read}");
    }
    let scotopic = ["measure", "lux", "scene.pbrt", "--point", "0,0,0,0,0,1", "--receptor", "scotopic"];
    // Daylight has a ratio of scotopic to photopic light of 2.47.
    let said = desk.run(&[&scotopic[..], &["-o", "n.json"]].concat()).succeeded();
    assert!(said.out.is_empty());
    let read = value(&desk.json("n.json")["rows"][0], "scotopic illuminance");
    assert!((read / 24.7 - 1.0).abs() < 0.015, "{read}");
}

#[test]
fn a_grid_alone_is_drawn_as_a_map_and_darkness_is_explained() {
    let desk = Desk::new(SCENE);
    let said = desk
        .run(&[
            "measure",
            "lux",
            "scene.pbrt",
            "--grid",
            "-1,-1,0,2,0,0,0,2,0,3,2",
            "--precision",
            "5%",
            "--plot",
            "map.svg",
        ])
        .succeeded();
    assert!(said.out.starts_with("illuminance\n") && said.out.contains("[lx]"), "{said:?}");
    assert!(desk.text("map.svg").contains("3 by 2 cells"));
    // Above the lamp, facing up: nothing arrives.
    let said = desk.run(&["measure", "lux", "scene.pbrt", "--point", "0,0,4,0,0,1"]).succeeded();
    assert!(said.out.contains("dark: none of 72192 paths found light"), "{said:?}");
}

#[test]
fn luminance_is_what_the_surface_sends_back() {
    let desk = Desk::new(SCENE);
    // L = ρ E/π with E = 10 lx below the lamp.
    let arguments = [
        "measure",
        "luminance",
        "scene.pbrt",
        "--ray",
        "1,0,1,-1,0,-1",
        "--rays",
        "-",
        "--acceptance",
        "0",
        "--precision",
        "2%",
        "-o",
        "l.json",
    ];
    desk.run_with(&arguments, "0 0 2 0 0 -1\n0 0 2 0 0 1\n").succeeded();
    let json = desk.json("l.json");
    for row in 0..2 {
        let read = value(&json["rows"][row], "luminance");
        assert!((read / (0.5 * 10.0 / std::f64::consts::PI) - 1.0).abs() < 0.02, "{read}");
    }
    // A point light has no surface.
    assert!(json["rows"][2]["note"].as_str().unwrap().starts_with("dark: none of"), "{json}");
    assert_eq!(json["facts"]["instrument"], "a single direction, entrance pupil without extent");
}

#[test]
fn mistakes_are_explained_where_they_are_made() {
    let desk = Desk::new(SCENE);
    let lux = |more: &[&str]| desk.run(&[&["measure", "lux", "scene.pbrt"], more].concat());
    lux(&[]).failed("error: say where to measure, by --point, --points or --grid");
    lux(&["--point", "0,0,0,0,0,0"]).refused("the direction has no length");
    lux(&["--point", "0,0,0"]).refused("expected six numbers");
    lux(&["--grid", "0,0,0,1,0,0,2,0,0,2,2"]).refused("span no area");
    lux(&["--point", "0,0,0,0,0,1", "--radiant", "--spectral", "500"]).refused("cannot be used with");
    lux(&["--points", "none.txt"]).failed("error: cannot read none.txt: no such file");
    desk.put("bad.txt", "0 0 0  0 0 1\n0 0 zero  0 0 1\n");
    lux(&["--points", "bad.txt"]).failed(
        "error: expected a number, found \"zero\"\n --> bad.txt:2:5\n  |\n2 | 0 0 zero  0 0 1\n  |     ^",
    );
    desk.run_with(&["measure", "lux", "-", "--points", "-"], SCENE)
        .failed("error: standard input holds either the scene or the list of positions, not both");
    desk.put("classic.pbrt", SCENE.replace("WorldBegin", "Integrator \"classic\"\nWorldBegin"));
    let said = desk.run(&["measure", "lux", "classic.pbrt", "--point", "0,0,0,0,0,1"]);
    assert!(said.code == Some(1) && said.err.contains("is no light transport"), "{said:?}");
}

#[test]
fn a_pixel_receives_what_its_lens_lets_through() {
    let desk = Desk::new(&SCENE.replace(
        "LightSource \"point\"",
        "LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ] \"float scale\" 80\nLightSource \"point\"",
    ));
    let pixel = |more: &[&str]| {
        desk.run(&[&["measure", "pixel", "scene.pbrt", "--max-depth", "0", "-o", "p.json"], more].concat())
    };
    pixel(&["--pixel", "640,5", "--f-number", "4"]).succeeded();
    let json = desk.json("p.json");
    let row = &json["rows"][0];
    assert!((value(row, "luminance") / 80.0 - 1.0).abs() < 0.01, "{row}");
    // The upper edge of 1280 by 720 pixels at 90° across the shorter side: 354.5 pixels of 360 off the axis.
    let cos2 = 1.0 / (1.0 + (354.5_f64 / 360.0).powi(2));
    let expected = 80.0 * std::f64::consts::PI / 64.0 * cos2 * cos2;
    assert!((value(row, "illuminance") / expected - 1.0).abs() < 0.01, "{row}, expected {expected}");
    assert_eq!(json["columns"][4], serde_json::json!({ "name": "exposure", "unit": "lx·s" }));
    assert_eq!(json["facts"]["working f-number"], "4");
    pixel(&["--pixel", "640,5"])
        .failed("error: the scene's camera is a pinhole, through which no light comes: state the f-number of its lens");
    pixel(&["--pixel", "1280,5", "--f-number", "2"])
        .failed("error: pixel 1280, 5: the film has 1280 by 720 pixels");
    pixel(&["--pixel", "5", "--f-number", "2"]).refused("expected a column and a row");
    pixel(&["--f-number", "2"]).refused("--pixel");
}

#[test]
fn the_same_seed_gives_the_same_readings_for_any_number_of_threads() {
    let desk = Desk::new(SCENE);
    let read = |more: &[&str]| {
        let common = ["measure", "lux", "scene.pbrt", "--point", "0.3,0,1,0,0,-1", "--precision", "5%"];
        desk.run(&[&common, more].concat()).succeeded().out
    };
    let one = read(&["--threads", "1"]);
    assert_eq!(one, read(&["--threads", "3"]));
    assert_ne!(one, read(&["--threads", "1", "--seed", "2"]));
}

#[test]
fn the_worked_examples_of_the_help_work() {
    let desk = Desk::new(SCENE);
    for instrument in ["lux", "luminance", "pixel"] {
        let help = desk.run(&["measure", instrument, "--help"]).succeeded().out;
        let example = help
            .lines()
            .find(|l| l.trim_start().starts_with(&format!("steradian measure {instrument} --")))
            .unwrap();
        let words: Vec<&str> = example.split_whitespace().skip(1).collect();
        let said = desk.run(&[&words[..], &["--precision", "5%"]].concat()).succeeded();
        assert!(said.out.contains("precision met") && !said.out.contains("dark"), "{said:?}");
    }
}
