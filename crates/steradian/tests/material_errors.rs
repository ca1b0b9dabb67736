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

#[test]
fn what_openpbr_cannot_show_is_refused_where_it_is_asked_for() {
    expect(
        r#"WorldBegin
Material "openpbr" "float specular_roughness" 1.2 "float specular_color" 1
"#,
        r#"
scene.pbrt:2:51: error: parameter "specular_color" has type float, expected texture, spectrum, rgb or blackbody
 2 | Material "openpbr" "float specular_roughness" 1.2 "float specular_color" 1
   |                                                   ^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:2:20: error: parameter "specular_roughness" must be from 0 to 1, found 1.2
 2 | Material "openpbr" "float specular_roughness" 1.2 "float specular_color" 1
   |                    ^^^^^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "openpbr" "float subsurface_weight" 0.5
Material "openpbr" "float emission_luminance" 100
Material "openpbr" "float transmission_weight" 1 "float transmission_depth" 2
  "rgb transmission_color" [ 0.2 0.5 0.9 ]
Material "openpbr" "float transmission_weight" 1 "float transmission_depth" 2
  "rgb transmission_scatter" [ 0.2 0.5 0.9 ]
"#,
        r#"
scene.pbrt:2:20: error: scattering under the surface is not supported, except with "geometry_thin_walled"; use "base_color" for dense materials
 2 | Material "openpbr" "float subsurface_weight" 0.5
   |                    ^^^^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:3:20: error: surfaces emit by an AreaLightSource, not by their material
 3 | Material "openpbr" "float emission_luminance" 100
   |                    ^^^^^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:4:50: error: absorption over a depth is not supported; leave it at 0, which tints light at the surface
 4 | Material "openpbr" "float transmission_weight" 1 "float transmission_depth" 2
   |                                                  ^^^^^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:7:3: error: scattering inside of the body is not supported; leave it at 0
 7 |   "rgb transmission_scatter" [ 0.2 0.5 0.9 ]
   |   ^^^^^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "openpbr" "float transmission_dispersion_scale" 1 "spectrum specular_ior" "glass-F11"
Material "openpbr" "float transmission_dispersion_scale" 1
  "float transmission_dispersion_abbe_number" 0
"#,
        r#"
scene.pbrt:2:20: error: the spectrum "specular_ior" disperses by itself; give the index at 587.6 nm as a number
 2 | Material "openpbr" "float transmission_dispersion_scale" 1 "spectrum specular_ior" "glass-F11"
   |                    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:4:3: error: dispersion needs an Abbe number above 0
 4 |   "float transmission_dispersion_abbe_number" 0
   |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
}
