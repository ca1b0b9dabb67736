//! What `docs/materials.md` says exists, and all that exists is said there.

#![allow(clippy::panic, clippy::expect_used, reason = "tests fail by panicking")]

use std::path::Path;
use steradian::material::CLASSES;

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
