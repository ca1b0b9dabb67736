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
