//! `steradian measure spectro` and `measure turbid`: numbers that are known beforehand, and faults that are named.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use support::desk::Desk;

const SCENE: &str = r#"
WorldBegin
MakeNamedMaterial "paint" "string type" "diffuse" "spectrum reflectance" [ 400 0.5 900 0.5 ]
MakeNamedMaterial "pane" "string type" "stack" "float thickness" 1e-3 "float eta" 1.5 "float absorption" 100
MakeNamedMaterial "foil" "string type" "leaf" "string coefficients" "table.txt" "float chlorophyll" 30
"#;

/// Invented.
const TABLE: &str =
    "lambda nrefrac SAC_CHL SAC_EWT SAC_LMA\n400 1.5 0.1 0 1\n700 1.45 0 0 1\n1000 1.4 0 40 5\n";

/// Rows of numbers below the comments and the header; words are NaN.
fn rows(csv: &str) -> Vec<Vec<f64>> {
    let lines = csv.lines().filter(|l| !l.starts_with('#')).skip(1);
    lines.map(|l| l.split(',').map(|c| c.parse().unwrap_or(f64::NAN)).collect()).collect()
}

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 1e-5
}

fn desk() -> Desk {
    let desk = Desk::new(SCENE);
    desk.put("table.txt", TABLE);
    desk
}

#[test]
fn a_pane_reads_its_closed_form_and_photons_agree() {
    let desk = desk();
    let pane = ["measure", "spectro", "scene.pbrt", "--material", "pane", "--wavelength", "500,600"];
    let run = |more: &[&str]| {
        let all: Vec<&str> = pane.iter().chain(more).copied().collect();
        desk.run(&all).succeeded();
    };
    run(&["--incidence", "0,60", "-o", "exact.csv", "--plot", "pane.svg", "-o", "exact.json"]);
    let text = desk.text("exact.csv");
    assert!(text.contains("wavelength [nm],incidence [°],reflectance [1],reflectance ± [1]"), "{text}");
    let exact = rows(&text);
    for (row, [r, t]) in exact.iter().zip([[0.070221, 0.834992], [0.070221, 0.834992], [0.137917, 0.748214]])
    {
        assert!(near(row[2], r) && row[3] == 0.0 && near(row[4], t) && near(row[6], 1.0 - r - t), "{row:?}");
    }
    assert_eq!(desk.json("exact.json")["columns"][2]["unit"], "1");
    assert!(desk.text("pane.svg").contains("share of the incident power"));
    // One interval in a million leaves the truth out; there are twelve.
    run(&[
        "--incidence",
        "60",
        "--method",
        "sampled",
        "--precision",
        "3%",
        "--confidence",
        "0.999999",
        "-o",
        "sampled.csv",
    ]);
    let text = desk.text("sampled.csv");
    for row in rows(&text) {
        for (column, truth) in [(2, 0.137917), (4, 0.748214), (6, 0.113869)] {
            assert!((row[column] - truth).abs() <= row[column + 1] && row[column + 1] <= 0.03 * row[column]);
        }
        assert_eq!(row[8], 1.0);
    }
    assert!(text.contains("# confidence: 99.9999 %, statistical only") && text.contains("# rays: "));
}

#[test]
fn paint_reads_too_low_in_a_single_beam() {
    let desk = desk();
    let run = |sphere: &str| {
        let arguments = [
            "measure",
            "spectro",
            "scene.pbrt",
            "--material",
            "paint",
            "-l",
            "550",
            "--sphere",
            sphere,
            "-o",
            "p.csv",
        ];
        desk.run(&arguments).succeeded();
        desk.text("p.csv")
    };
    // Columns of exact readings have a half-width, too.
    let single = &rows(&run("single-beam"))[0];
    assert!(single.iter().any(|x| near(*x, 0.5 * 0.0196 / 0.0296)), "{single:?}");
    let double = run("double-beam");
    assert!(double.contains("double beam") && double.contains("multiplier 24.74747"), "{double}");
    assert!(rows(&double)[0].iter().filter(|x| near(**x, 0.5)).count() >= 2);
}

#[test]
fn leaves_are_measured_as_far_as_their_table_reaches() {
    let desk = desk();
    let leaf = |wavelengths: &str| {
        desk.run(&["measure", "spectro", "scene.pbrt", "-m", "foil", "-l", wavelengths, "-o", "leaf.csv"])
    };
    leaf("400:1000:100").succeeded();
    let all = rows(&desk.text("leaf.csv"));
    assert_eq!(all.len(), 7);
    // Green above blue, and all of the light is somewhere.
    assert!(all[3][2] > all[0][2] && all.iter().all(|r| near(r[2] + r[4] + r[6], 1.0)));
    leaf("390,500")
        .failed("error: wavelength 390 nm: the data of material \"foil\" reach from 400 to 1000 nm");
}

#[test]
fn the_worked_example_works() {
    let desk = Desk::new("");
    let help = desk.run(&["measure", "spectro", "--help"]).succeeded().out;
    let scene: String = help.split("glass.pbrt):\n").nth(1).unwrap().split("\n\n").next().unwrap().to_owned();
    desk.put("glass.pbrt", scene);
    let commands: Vec<&str> = help.lines().filter_map(|l| l.trim().strip_prefix("steradian ")).collect();
    assert_eq!(commands.len(), 2, "{help}");
    for command in commands {
        desk.run(&command.split(' ').collect::<Vec<_>>()).succeeded();
    }
    assert!(desk.text("pane.csv").contains("R as read / true"));
}

#[test]
fn spectro_names_what_is_wrong() {
    let desk = desk();
    let run = |more: &[&str]| {
        let all: Vec<&str> =
            ["measure", "spectro", "scene.pbrt", "-m", "paint"].iter().chain(more).copied().collect();
        desk.run(&all)
    };
    run(&["--incidence", "90"]).refused("other than 90");
    run(&["--incidence", "sideways"]).refused("diffuse-below");
    run(&["--view", "95,0"]).refused("THETA,PHI");
    run(&["--view", "88,0", "-l", "500"])
        .failed("error: a viewing cone of 5° about 88° is not above the horizon");
    run(&["--sphere", "single-beam", "--wall", "1", "-l", "500"])
        .failed("error: a sphere has a wall of reflectance from 0 to below 1, a port between 0 and 1, and a standard above 0 and up to 1");
}

#[test]
fn turbid_slabs_stand_beside_their_models() {
    let desk = Desk::new("");
    desk.run(&[
        "measure",
        "turbid",
        "--albedo",
        "0.9",
        "--thickness",
        "1,inf",
        "-o",
        "t.csv",
        "--plot",
        "t.svg",
    ])
    .succeeded();
    let found = rows(&desk.text("t.csv"));
    for (column, expected) in [(1, 0.26741), (2, 0.59163), (3, 0.35271), (4, 0.47475)] {
        assert!((found[0][column] - expected).abs() < 2e-5, "{found:?}");
    }
    // The dipole's half-space, and how far it is off.
    assert!((found[1][9] - 0.3856).abs() < 1e-4 && (found[1][10] - (0.3856 - 0.41495)).abs() < 1e-4);
    assert!(desk.text("t.csv").contains("optical thickness [1],R beam [1]"));
    assert!(desk.text("t.svg").contains("Kubelka–Munk"));
    let text = desk.run(&["measure", "turbid", "--thickness", "2", "--substrate", "0.5", "--eta", "1.5"]);
    assert!(text.succeeded().out.contains("Lambertian surface of reflectance 0.5"));
    desk.run(&["measure", "turbid", "--albedo", "1.2"])
        .failed("error: a single-scattering albedo of 1.2 is not from 0 to 1");
    desk.run(&["measure", "turbid", "--thickness", "thin"]).refused("optical thickness");
    let help = desk.run(&["measure", "turbid", "--help"]).succeeded().out;
    let example = help.lines().find_map(|l| l.trim().strip_prefix("steradian ")).unwrap();
    desk.run(&example.split(' ').collect::<Vec<_>>()).succeeded();
}
