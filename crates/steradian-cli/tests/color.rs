//! `steradian measure color`: published numbers, intervals, files that are read back, faults that are named.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use serde_json::Value;
use support::desk::Desk;

/// The value of a quantity in the JSON file `name`, in the column `column`.
fn value(json: &Value, quantity: &str, column: &str) -> f64 {
    let rows = json["rows"].as_array().unwrap();
    let row = rows.iter().find(|r| r["quantity"] == quantity).unwrap();
    row[column]["value"].as_f64().unwrap()
}

/// colour-science 0.4.7 for chromaticity and Ra.
#[test]
fn illuminants_read_as_published() {
    let desk = Desk::new("");
    let arguments = ["measure", "color", "--spectrum", "stdillum-F11", "--spectrum", "stdillum-LED-B1", "-q"];
    desk.run(&[&arguments[..], &["-o", "lamps.json", "-o", "lamps.csv"]].concat()).succeeded();
    let json = desk.json("lamps.json");
    for (name, x, y, kelvin, ra) in [
        ("stdillum-F11", 0.38052, 0.37712, 4000.7, 82.86),
        ("stdillum-LED-B1", 0.45592, 0.40790, 2734.7, 81.79),
    ] {
        assert!((value(&json, "x", name) - x).abs() < 1e-5 && (value(&json, "y", name) - y).abs() < 1e-5);
        assert!((value(&json, "correlated colour temperature", name) - kelvin).abs() < 0.3);
        assert!((value(&json, "Ra", name) - ra).abs() < 0.01);
    }
    let csv = desk.text("lamps.csv");
    assert!(csv.contains("quantity,unit,stdillum-F11,stdillum-F11 ±,"), "{csv}");
    assert!(csv.contains("\ncorrelated colour temperature,K,4000."), "{csv}");
}

#[test]
fn the_example_of_the_help_works_and_draws() {
    let desk = Desk::new("");
    let input = "400 0.1\n500 0.3\n700 0.8\n";
    let said = desk.run_with(
        &["measure", "color", "--reflectance", "-", "--illuminant", "stdillum-D50", "--plot", "thing.svg"],
        input,
    );
    let out = said.succeeded().out;
    assert!(out.contains("colour under stdillum-D50") && out.contains("L*"), "{out}");
    let svg = desk.text("thing.svg");
    let document = roxmltree::Document::parse(&svg).unwrap();
    let texts: Vec<_> = document.descendants().filter_map(|n| n.text()).collect();
    assert!(texts.contains(&"x [1]") && texts.contains(&"stdillum-D50"), "{texts:?}");
}

#[test]
fn intervals_and_units_of_a_table_reach_the_result() {
    let desk = Desk::new("");
    let mut table = "# spectral irradiance\n# intervals: 95 % confidence, statistical only\n\
                     point,wavelength [nm],spectral irradiance [W·m⁻²·nm⁻¹],spectral irradiance ± [W·m⁻²·nm⁻¹]\n"
        .to_owned();
    for (point, level) in [(1, 0.001), (2, 0.002)] {
        for l in (380..=780).step_by(10) {
            table.push_str(&format!("{point},{l},{level},{}\n", 0.02 * level));
        }
    }
    desk.put("lux.csv", &table);
    let arguments = ["measure", "color", "--spectrum", "lux.csv", "--rows", "point=2"];
    desk.run(&[&arguments[..], &["-o", "color.json", "-q"]].concat()).succeeded();
    let json = desk.json("color.json");
    // Held to 360 and 830 nm: 0.002 · 683.002 · 106.857 lx.
    let illuminance = value(&json, "Y", "value");
    assert!((illuminance - 145.968).abs() < 0.01, "{illuminance}");
    let row = json["rows"].as_array().unwrap().iter().find(|r| r["quantity"] == "Y").unwrap();
    let half = row["value"]["half_width"].as_f64().unwrap();
    // 2 % of every row at once.
    assert!(row["unit"] == "lx" && (half / illuminance - 0.02).abs() < 1e-6, "{row}");
    let facts = json["facts"].to_string();
    assert!(facts.contains("95 % confidence, statistical only; carried on to first order"), "{facts}");
    // Both points at once are no spectrum.
    let said = desk.run(&["measure", "color", "--spectrum", "lux.csv"]);
    said.failed("error: lux.csv: line 45: wavelength 380 nm follows 780 nm: choose the rows of one spectrum");
}

/// Under a sky of 100 cd/m² all around, a plane has 100π lx of the sky's colour, here D65 by 41 wavelengths.
#[test]
fn light_in_a_scene_has_a_colour() {
    let desk = Desk::new(
        "WorldBegin\nLightSource \"infinite\" \"spectrum L\" \"stdillum-D65\" \"float scale\" 100\n",
    );
    let arguments = ["measure", "color", "scene.pbrt", "--point", "0,0,0,0,0,1", "-o", "sky.json", "-q"];
    desk.run(&arguments).succeeded();
    let json = desk.json("sky.json");
    let read = |quantity: &str| value(&json, quantity, "value");
    assert!((read("Y") - 314.16).abs() < 0.01 * 314.16, "{json}");
    assert!((read("x") - 0.3127).abs() < 2e-3 && (read("y") - 0.3290).abs() < 2e-3, "{json}");
    assert!((read("correlated colour temperature") - 6504.0).abs() < 60.0 && read("Ra") > 98.0, "{json}");
}

#[test]
fn faults_are_named() {
    let desk = Desk::new("");
    let said = desk.run(&["measure", "color", "--spectrum", "stdillum-D56"]);
    assert!(said.code == Some(1) && said.err.contains("did you mean stdillum-D"), "{said:?}");
    desk.put("bad.spd", "400 1\n410 one\n");
    let said = desk.run(&["measure", "color", "--spectrum", "bad.spd"]);
    said.failed("error: bad.spd: line 2: `one` is not a number");
    desk.run(&["measure", "color"])
        .failed("error: say what to measure, by --spectrum, --point or --reflectance");
    desk.run(&["measure", "color", "scene.pbrt"]).refused("--point");
    desk.run(&["measure", "color", "--spectrum", "x", "--rows", "point"]).refused("point=2");
}
