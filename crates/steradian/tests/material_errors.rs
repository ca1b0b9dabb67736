//! Wrong materials: the full text of every message.

#[path = "support/errors.rs"]
mod errors;

use errors::expect;

#[test]
fn a_metal_is_given_in_one_way() {
    expect(
        r#"WorldBegin
Material "conductor" "rgb reflectance" [ 1 1 1 ] "spectrum k" "metal-Ag-k"
"#,
        r#"
scene.pbrt:2:22: error: give "reflectance", or "eta" and "k", not both
 2 | Material "conductor" "rgb reflectance" [ 1 1 1 ] "spectrum k" "metal-Ag-k"
   |                      ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "coatedconductor" "spectrum conductor.k" "metal-Ag-k"
"#,
        r#"
scene.pbrt:2:28: error: "conductor.k" without "conductor.eta": a metal has both
 2 | Material "coatedconductor" "spectrum conductor.k" "metal-Ag-k"
   |                            ^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_negative_roughness_is_refused() {
    expect(
        r#"WorldBegin
Material "dielectric" "float roughness" -0.1
"#,
        r#"
scene.pbrt:2:23: error: parameter "roughness" must be at least 0, found -0.1
 2 | Material "dielectric" "float roughness" -0.1
   |                       ^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_phong_surface_reflects_no_more_than_arrives_at_any_wavelength() {
    expect(
        r#"WorldBegin
Material "modifiedphong" "spectrum diffuse" [ 400 0.2 599 0.2 600 0.7 700 0.2 ]
  "spectrum specular" [ 400 0.4 700 0.4 ]
"#,
        r#"
scene.pbrt:3:3: error: "diffuse" and "specular" add up to 1.1000 at 600 nm: more light would leave than arrives
 3 |   "spectrum specular" [ 400 0.4 700 0.4 ]
   |   ^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "modifiedphong" "rgb diffuse" [ 0.8 0.8 0.8 ]
"#,
        r#"
scene.pbrt:2:26: error: "diffuse" and "specular" add up to 1.0500 at 360 nm: more light would leave than arrives
 2 | Material "modifiedphong" "rgb diffuse" [ 0.8 0.8 0.8 ]
   |                          ^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "phong" "spectrum specular" [ 400 0.5 500 1.5 ]
"#,
        r#"
scene.pbrt:2:18: error: "specular" is 1.5000 at 500 nm: more light would leave than arrives
 2 | Material "phong" "spectrum specular" [ 400 0.5 500 1.5 ]
   |                  ^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "perfectmirror" "spectrum reflectance" [ 400 1 500 1.01 ]
"#,
        r#"
scene.pbrt:2:26: error: "reflectance" is 1.0100 at 500 nm: more light would leave than arrives
 2 | Material "perfectmirror" "spectrum reflectance" [ 400 1 500 1.01 ]
   |                          ^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn words_and_numbers_outside_their_range_are_refused() {
    expect(
        r#"WorldBegin
Material "modifiedphong" "string lobe" "half" "float exponent" -1
"#,
        r#"
scene.pbrt:2:47: error: parameter "exponent" must be from 0 to 10000, found -1
 2 | Material "modifiedphong" "string lobe" "half" "float exponent" -1
   |                                               ^^^^^^^^^^^^^^^^
scene.pbrt:2:40: error: unknown lobe "half"
 2 | Material "modifiedphong" "string lobe" "half" "float exponent" -1
   |                                        ^^^^^^
  help: known are mirror, halfway
"#,
    );
    expect(
        r#"WorldBegin
Material "orennayar" "float roughness" 1.5
"#,
        r#"
scene.pbrt:2:22: error: parameter "roughness" must be from 0 to 1, found 1.5
 2 | Material "orennayar" "float roughness" 1.5
   |                      ^^^^^^^^^^^^^^^^^
"#,
    );
}
