//! What `docs/materials.md` says exists, and all that exists is said there; what `docs/lights.md` says exists.

#![allow(clippy::panic, clippy::expect_used, reason = "tests fail by panicking")]

use std::path::Path;
use steradian::material::CLASSES;
use steradian::scene::MemoryFiles;
use steradian::scene::import::pbrt::{Input, import};

#[test]
fn every_material_and_parameter_is_described() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/materials.md");
    let text = std::fs::read_to_string(path).expect("docs/materials.md");
    let sections: Vec<(&str, &str)> = text
        .split("\n### `")
        .skip(1)
        .map(|section| section.split_once('`').expect("a closed heading"))
        .collect();
    for class in CLASSES {
        let found = sections.iter().find(|(name, _)| *name == class.name);
        let (_, section) = found.unwrap_or_else(|| panic!("no section on {}", class.name));
        for parameter in class.parameters {
            // Parameters that materials share are described where they occur first.
            let described = section.contains(&format!("`{}`", parameter.name));
            assert!(described, "{} has a parameter \"{}\"", class.name, parameter.name);
        }
    }
    for (name, _) in sections {
        assert!(CLASSES.iter().any(|c| c.name == name), "there is no material {name}");
    }
}

/// Classes of `LightSource`, the one of `AreaLightSource`, and a sky with parameters of its own.
const LIGHTS: [&str; 11] = [
    "point",
    "spot",
    "goniometric",
    "projection",
    "photometric",
    "diffuse",
    "distant",
    "infinite",
    "sky",
    "sun",
    "bird-riordan",
];

/// The parameters that the table rows of a section name, as pbrt writes them: `float scale`.
fn described(section: &str) -> Vec<String> {
    let rows = section.lines().filter(|l| l.starts_with("| `"));
    let cells = |row: &str| row.split('|').map(|c| c.trim().to_owned()).collect::<Vec<_>>();
    rows.map(cells)
        .flat_map(|cells| {
            let names: Vec<String> = cells[1].split('`').skip(1).step_by(2).map(str::to_owned).collect();
            let with_type = move |n: String| if n.contains(' ') { n } else { format!("{} {n}", cells[2]) };
            names.into_iter().map(with_type)
        })
        .collect()
}

#[test]
fn lights_have_the_parameters_that_are_described() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/lights.md");
    let text = std::fs::read_to_string(path).expect("docs/lights.md");
    let mut sections = text.split("\n### `");
    let amounts = described(sections.next().expect("an introduction"));
    assert_eq!(amounts.len(), 6, "{amounts:?}");
    let sections: Vec<(&str, &str)> = sections.filter_map(|s| s.split_once('`')).collect();
    let refused = |class: &str, parameter: &str| {
        let value = match parameter.split(' ').next() {
            Some("string") => "\"a\"",
            Some("bool") => "true",
            Some("point3" | "vector3") => "[0 0 2]",
            Some("spectrum") => "[400 1 700 1]",
            _ => "1",
        };
        let directive = if class == "diffuse" { "AreaLightSource" } else { "LightSource" };
        let class = match class {
            "sky" => "sky\" \"string model\" \"uniform",
            "bird-riordan" => "sky\" \"string model\" \"bird-riordan",
            _ => class,
        };
        let scene = format!("WorldBegin {directive} \"{class}\" \"{parameter}\" {value}");
        let input = Input::Text { name: "doc", bytes: scene.as_bytes(), base: Path::new("") };
        let imported = import(&[input], &MemoryFiles::new());
        imported.diagnostics.iter().any(|d| {
            ["has no parameter", "has type", "amount of its own"].iter().any(|m| d.message.contains(m))
        })
    };
    for class in LIGHTS {
        let found = sections.iter().find(|(name, _)| *name == class);
        let (_, section) = found.unwrap_or_else(|| panic!("no section on {class}"));
        for parameter in described(section) {
            assert!(!refused(class, &parameter), "{class} has no parameter \"{parameter}\"");
        }
    }
    // Each amount belongs to the lights that the table says.
    for class in LIGHTS {
        let taken: Vec<&str> = amounts.iter().map(String::as_str).filter(|a| !refused(class, a)).collect();
        let expected: &[&str] = match class {
            "distant" | "sky" | "sun" => &["float illuminance", "float irradiance"],
            "infinite" => &["float luminance", "float illuminance", "float irradiance"],
            "diffuse" => &["float power", "float watts", "float luminance"],
            "bird-riordan" => &[],
            _ => &["float power", "float watts", "float intensity"],
        };
        assert_eq!(taken, expected, "{class}");
    }
}
