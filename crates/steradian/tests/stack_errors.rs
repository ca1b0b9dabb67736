//! What a user sees of a wrong stack, and that right ones and hair become scenes.

#[path = "support/errors.rs"]
mod errors;

use errors::expect;
use std::path::Path;
use steradian::scene::import::pbrt::{Imported, Input, import};
use steradian::scene::{MemoryFiles, compile};

#[track_caller]
fn accept(statement: &str) {
    let text = format!("WorldBegin\nLightSource \"infinite\"\n{statement}\nShape \"sphere\"\n");
    let files = MemoryFiles::new();
    let input = Input::Text { name: "scene.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    let Imported { scene, sources, mut diagnostics } = import(&[input], &files);
    let job = scene.and_then(|desc| compile(desc, &files, &mut diagnostics));
    let shown: Vec<_> = diagnostics.iter().map(|d| d.display(&sources).to_string()).collect();
    assert!(job.is_some() && shown.is_empty(), "{shown:?}");
}

#[test]
fn stacks_and_hair_become_scenes() {
    accept(r#"Material "stack" "float thickness" 1e-3"#);
    accept(
        r#"Material "stack" "float thickness" [1e-3 2e-3 1e-4] "float eta" [1.5 1.33 1.5]
"float absorption" [0 50 0] "float roughness" [0 0 .1 0] "float below" 1.33"#,
    );
    accept(
        r#"Material "stack" "float thickness" [1e-3 2e-3] "spectrum eta" ["glass-BK7" "glass-SF11"]
"string base" "diffuse" "rgb reflectance" [.2 .3 .9]"#,
    );
    accept(
        r#"Material "stack" "float thickness" [1e-3] "string base" "conductor"
"spectrum base.eta" "metal-Au-eta" "spectrum base.k" "metal-Au-k" "float roughness" [0 .2]"#,
    );
    accept(r#"Material "hair""#);
    accept(r#"Material "hair" "float eumelanin" .5 "float beta_m" .2"#);
    accept(r#"Material "hair" "rgb sigma_a" [.5 .7 1.2] "float alpha" 3"#);
    accept(
        r#"Texture "t" "float" "checkerboard"
Material "hair" "texture pheomelanin" "t" "rgb reflectance" [.5 .3 .1]"#,
    );
}

#[test]
fn lists_of_different_lengths_are_shown() {
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1e-3 1e-3 1e-3] "float eta" [1.5 1.4]
"#,
        r#"
scene.pbrt:2:53: error: 2 values of "eta" for 3 layers: give one for all, or one each
 2 | Material "stack" "float thickness" [1e-3 1e-3 1e-3] "float eta" [1.5 1.4]
   |                                                     ^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1e-3 1e-3] "float absorption" [1 2 3]
"#,
        r#"
scene.pbrt:2:48: error: 3 values of "absorption" for 2 layers: give one for all, or one each
 2 | Material "stack" "float thickness" [1e-3 1e-3] "float absorption" [1 2 3]
   |                                                ^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1e-3 1e-3] "float roughness" [0 .1]
"#,
        r#"
scene.pbrt:2:48: error: a stack of 2 layers takes one roughness, or 3 of them, not 2
 2 | Material "stack" "float thickness" [1e-3 1e-3] "float roughness" [0 .1]
   |                                                ^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn layers_that_cannot_be_are_shown() {
    expect(
        r#"WorldBegin
Material "stack"
"#,
        r#"
scene.pbrt:2:10: error: a stack needs the "thickness" [m] of each of its layers
 2 | Material "stack"
   |          ^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1e-3 -1e-3]
"#,
        r#"
scene.pbrt:2:18: error: layer 2 is -0.001 m thick: a thickness is finite and not negative
 2 | Material "stack" "float thickness" [1e-3 -1e-3]
   |                  ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1]
"#,
        r#"
scene.pbrt:2:18: error: a stack has at most 64 layers, not 65
 2 | Material "stack" "float thickness" [1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 …
   |                  ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1] "float absorption" -2
"#,
        r#"
scene.pbrt:2:40: error: "absorption" of layer 1 is -2, but must be not negative
 2 | Material "stack" "float thickness" [1] "float absorption" -2
   |                                        ^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1] "float eta" 0
"#,
        r#"
scene.pbrt:2:40: error: "eta" of layer 1 is 0, but must be positive
 2 | Material "stack" "float thickness" [1] "float eta" 0
   |                                        ^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" [1] "float roughness" -.5
"#,
        r#"
scene.pbrt:2:40: error: "roughness" must not be negative, found -0.5
 2 | Material "stack" "float thickness" [1] "float roughness" -.5
   |                                        ^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_base_and_its_parameters_belong_together() {
    expect(
        r#"WorldBegin
Material "stack" "float thickness" 1
"string base" "diffuse" "float below" 1.3
"#,
        r#"
scene.pbrt:3:25: error: "below" belongs to "string base" "none", but the base is "diffuse"
 3 | "string base" "diffuse" "float below" 1.3
   |                         ^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" 1
"rgb reflectance" [.5 .5 .5]
"#,
        r#"
scene.pbrt:3:1: error: "reflectance" belongs to "string base" "diffuse", but the base is "none"
 3 | "rgb reflectance" [.5 .5 .5]
   | ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "stack" "float thickness" 1
"string base" "conductor" "spectrum base.k" "metal-Au-k"
"#,
        r#"
scene.pbrt:3:27: error: a metal has both "base.eta" and "base.k"
 3 | "string base" "conductor" "spectrum base.k" "metal-Au-k"
   |                           ^^^^^^^^^^^^^^^^^
"#,
    );
}
