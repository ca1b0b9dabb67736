//! Job files: the words of the command line, and faults that point at the text.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use support::desk::Desk;

/// A plane under a point light of 1 cd, 1 m above the origin.
const SCENE: &str = r#"
WorldBegin
LightSource "point" "point3 from" [ 0 0 1 ] "float power" 12.566370614
Material "diffuse" "spectrum reflectance" [ 300 0 900 0 ]
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  0 9 0 ] "integer indices" [ 0 1 2 ]
"#;

#[test]
fn a_job_file_reads_what_the_command_line_reads() {
    let desk = Desk::new(SCENE);
    desk.put(
        "job.toml",
        r#"
scene = "scene.pbrt"
precision = "2%"
seed = 7

[[measure]]
instrument = "lux"
point = ["0,0,0,0,0,1", "1,0,0,0,0,1"]
output = ["a.csv", "a.json"]
quiet = true

[[measure]]
instrument = "luminance"
ray = "0,0,1,0,0,-1"
acceptance = 0
output = "b.csv"
quiet = true
"#,
    );
    let said = desk.run(&["measure", "series", "job.toml"]).succeeded();
    assert!(said.err.contains("[1/2] lux") && said.err.contains("[2/2] luminance"), "{}", said.err);
    let arguments = ["measure", "lux", "scene.pbrt", "--precision", "2%", "--seed", "7", "--quiet"];
    let points = ["--point", "0,0,0,0,0,1", "--point", "1,0,0,0,0,1", "-o", "direct.csv"];
    desk.run(&[&arguments[..], &points].concat()).succeeded();
    assert_eq!(desk.text("a.csv"), desk.text("direct.csv"));
    // E = I cosθ / r²: 1 lx below the light, (1/√2)/2 lx a metre aside.
    let rows = &desk.json("a.json")["rows"];
    for (row, expected) in [(0, 1.0), (1, 0.5 * 0.5_f64.sqrt())] {
        let lux = rows[row]["illuminance"]["value"].as_f64().unwrap();
        // What is left is the noise of sampling wavelengths.
        assert!((lux / expected - 1.0).abs() < 5e-3, "{lux}");
    }
    assert!(desk.text("b.csv").contains("luminance [cd·m⁻²]"));
}

#[test]
fn a_dry_run_prints_the_commands_and_measures_nothing() {
    let desk = Desk::new(SCENE);
    desk.put(
        "job.toml",
        "[[measure]]\ninstrument = \"lux\"\nscene = \"none.pbrt\"\npoint = \"0,0,0,0,0,1\"\nsplit = true\n",
    );
    let said = desk.run(&["measure", "series", "job.toml", "--dry-run"]).succeeded();
    assert_eq!(said.err.trim(), "[1/1] lux --point=0,0,0,0,0,1 --split none.pbrt");
}

#[test]
fn faults_point_at_the_text_before_anything_is_measured() {
    let desk = Desk::new(SCENE);
    let lux = "[[measure]]\ninstrument = \"lux\"\nscene = \"scene.pbrt\"\npoint = \"0,0,0,0,0,1\"\noutput = \"a.csv\"\n";
    for (more, place, message) in [
        ("[[measure]]\ninstrument = \"lax\"\n", "job.toml:7:14", "expected an instrument, one of "),
        ("[[measure]]\npoint = \"0,0,0,0,0,1\"\n", "job.toml:6:1", "this measurement names no `instrument`"),
        (
            "[[measure]]\ninstrument = \"lux\"\npiont = \"1\"\n",
            "job.toml:8:1",
            "instrument \"lux\" has no option `piont`",
        ),
        (
            "[[measure]]\ninstrument = \"lux\"\nscene = \"scene.pbrt\"\nprecision = \"much\"\n",
            "job.toml:9:1",
            "invalid value 'much' for '--precision <SHARE>': expected a share such as 1% or 0.01",
        ),
        ("[[measure]\n", "job.toml:6:", "not TOML: "),
        ("[[measure]]\ninstrument = \"lux\"\npoint = { x = 1 }\n", "job.toml:8:9", "an option is a text, "),
    ] {
        desk.put("job.toml", format!("{lux}{more}"));
        let said = desk.run(&["measure", "series", "job.toml"]);
        assert_eq!(said.code, Some(1), "{said:?}");
        assert!(said.err.contains(message) && said.err.contains(&format!("--> {place}")), "{}", said.err);
        assert!(!desk.files().contains(&"a.csv".to_owned()));
    }
    desk.put("job.toml", format!("incidence = 8\n{lux}"));
    let expected = "error: `incidence` is an option of none of the instruments of this file\n \
                    --> job.toml:1:1\n  |\n1 | incidence = 8\n  | ^";
    desk.run(&["measure", "series", "job.toml"]).failed(expected);
    desk.put("job.toml", "scene = \"scene.pbrt\"\n");
    let said = desk.run(&["measure", "series", "job.toml"]);
    assert!(said.code == Some(1) && said.err.contains("needs at least one [[measure]] table"), "{said:?}");
    desk.run(&["measure", "series", "none.toml"]).failed("error: cannot read none.toml: no such file");
}
