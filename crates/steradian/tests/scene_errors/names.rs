//! Names: directives, classes, parameters, spectra, and what was never defined.

use crate::errors::expect;

#[test]
fn an_unknown_directive_is_shown_with_the_nearest_one() {
    expect(
        r#"WorldBegin
Shpae "sphere"
"#,
        r#"
scene.pbrt:2:1: error: unknown directive `Shpae`
 2 | Shpae "sphere"
   | ^^^^^
  help: did you mean "Shape"?
"#,
    );
    expect(
        r#"WorldBegin
Frobnicate 1 2 3
"#,
        r#"
scene.pbrt:2:1: error: unknown directive `Frobnicate`
 2 | Frobnicate 1 2 3
   | ^^^^^^^^^^
"#,
    );
}

#[test]
fn an_unknown_class_is_shown_with_the_nearest_one() {
    expect(
        r#"WorldBegin
Shape "spheer"
"#,
        r#"
scene.pbrt:2:7: error: unknown shape "spheer"
 2 | Shape "spheer"
   |       ^^^^^^^^
  help: did you mean "sphere"?
"#,
    );
    expect(
        r#"WorldBegin
Material "difuse"
"#,
        r#"
scene.pbrt:2:10: error: unknown material "difuse"
 2 | Material "difuse"
   |          ^^^^^^^^
  help: did you mean "diffuse"?
"#,
    );
    expect(
        r#"WorldBegin
LightSource "pont"
"#,
        r#"
scene.pbrt:2:13: error: unknown light "pont"
 2 | LightSource "pont"
   |             ^^^^^^
  help: did you mean "point"?
"#,
    );
    expect(
        r#"WorldBegin
AreaLightSource "diffuze"
"#,
        r#"
scene.pbrt:2:17: error: unknown area light "diffuze"
 2 | AreaLightSource "diffuze"
   |                 ^^^^^^^^^
  help: did you mean "diffuse"?
"#,
    );
    expect(
        r#"WorldBegin
Texture "t" "spectrum" "imgemap"
"#,
        r#"
scene.pbrt:2:24: error: unknown texture of spectra "imgemap"
 2 | Texture "t" "spectrum" "imgemap"
   |                        ^^^^^^^^^
  help: did you mean "imagemap"?
"#,
    );
    expect(
        r#"WorldBegin
MakeNamedMaterial "m" "string type" "dielectrc"
"#,
        r#"
scene.pbrt:2:37: error: unknown material "dielectrc"
 2 | MakeNamedMaterial "m" "string type" "dielectrc"
   |                                     ^^^^^^^^^^^
  help: did you mean "dielectric"?
"#,
    );
    expect(
        r#"Camera "perspectiv"
WorldBegin
"#,
        r#"
scene.pbrt:1:8: error: unknown camera "perspectiv"
 1 | Camera "perspectiv"
   |        ^^^^^^^^^^^^
  help: did you mean "perspective"?
"#,
    );
    expect(
        r#"Film "rbg"
WorldBegin
"#,
        r#"
scene.pbrt:1:6: error: unknown film "rbg"
 1 | Film "rbg"
   |      ^^^^^
  help: did you mean "rgb"?
"#,
    );
    expect(
        r#"Sampler "haltn"
WorldBegin
"#,
        r#"
scene.pbrt:1:9: error: unknown sampler "haltn"
 1 | Sampler "haltn"
   |         ^^^^^^^
  help: did you mean "halton"?
"#,
    );
    expect(
        r#"PixelFilter "gausian"
WorldBegin
"#,
        r#"
scene.pbrt:1:13: error: unknown pixel filter "gausian"
 1 | PixelFilter "gausian"
   |             ^^^^^^^^^
  help: did you mean "gaussian"?
"#,
    );
    expect(
        r#"Integrator "pth"
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: unknown integrator "pth"
 1 | Integrator "pth"
   |            ^^^^^
  help: did you mean "path"?
"#,
    );
    expect(
        r#"Accelerator "bhv"
WorldBegin
"#,
        r#"
scene.pbrt:1:13: error: unknown accelerator "bhv"
 1 | Accelerator "bhv"
   |             ^^^^^
  help: did you mean "bvh"?
"#,
    );
}

#[test]
fn an_unknown_parameter_is_shown_with_the_nearest_one() {
    expect(
        r#"WorldBegin
Shape "sphere" "float raduis" 2
"#,
        r#"
scene.pbrt:2:16: error: shape "sphere" has no parameter "raduis"
 2 | Shape "sphere" "float raduis" 2
   |                ^^^^^^^^^^^^^^
  help: did you mean "radius"?
"#,
    );
    expect(
        r#"WorldBegin
Material "conductor"
    "float roughnes" 0.1
"#,
        r#"
scene.pbrt:3:5: error: material "conductor" has no parameter "roughnes"
 3 |     "float roughnes" 0.1
   |     ^^^^^^^^^^^^^^^^
  help: did you mean "roughness"?
"#,
    );
    expect(
        r#"Film "rgb" "integer xresolutoin" 4
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: film "rgb" has no parameter "xresolutoin"
 1 | Film "rgb" "integer xresolutoin" 4
   |            ^^^^^^^^^^^^^^^^^^^^^
  help: did you mean "xresolution"?
"#,
    );
}

#[test]
fn an_unknown_spectrum_is_shown_with_the_nearest_one() {
    expect(
        r#"WorldBegin
Material "conductor" "spectrum eta" "metal-Ag-etaa"
"#,
        r#"
scene.pbrt:2:37: error: unknown spectrum "metal-Ag-etaa"
 2 | Material "conductor" "spectrum eta" "metal-Ag-etaa"
   |                                     ^^^^^^^^^^^^^^^
  help: did you mean "metal-Ag-eta"?
"#,
    );
    expect(
        r#"WorldBegin
LightSource "point" "spectrum I" "stdillum-D66"
"#,
        r#"
scene.pbrt:2:34: error: unknown spectrum "stdillum-D66"
 2 | LightSource "point" "spectrum I" "stdillum-D66"
   |                                  ^^^^^^^^^^^^^^
  help: did you mean "stdillum-D65"?
"#,
    );
}

#[test]
fn an_undefined_name_is_shown_with_the_nearest_one() {
    expect(
        r#"WorldBegin
MakeNamedMaterial "walnut" "string type" "diffuse"
NamedMaterial "wallnut"
"#,
        r#"
scene.pbrt:3:15: error: material "wallnut" is not defined
 3 | NamedMaterial "wallnut"
   |               ^^^^^^^^^
  help: did you mean "walnut"?
"#,
    );
    expect(
        r#"WorldBegin
Texture "bricks" "spectrum" "constant"
Material "diffuse" "texture reflectance" "brikcs"
"#,
        r#"
scene.pbrt:3:42: error: spectrum texture "brikcs" is not defined
 3 | Material "diffuse" "texture reflectance" "brikcs"
   |                                          ^^^^^^^^
  help: did you mean "bricks"?
"#,
    );
    expect(
        r#"WorldBegin
ObjectBegin "tree"
ObjectEnd
ObjectInstance "tre"
"#,
        r#"
scene.pbrt:4:16: error: object "tre" is not defined
 4 | ObjectInstance "tre"
   |                ^^^^^
  help: did you mean "tree"?
"#,
    );
}

#[test]
fn a_texture_of_the_other_type_is_undefined() {
    expect(
        r#"WorldBegin
Texture "t" "float" "constant"
Material "diffuse" "texture reflectance" "t"
"#,
        r#"
scene.pbrt:3:42: error: spectrum texture "t" is not defined
 3 | Material "diffuse" "texture reflectance" "t"
   |                                          ^^^
  help: there is a float texture of this name, but spectra are needed here
"#,
    );
}

#[test]
fn a_parameter_of_the_wrong_type_says_which_it_takes() {
    expect(
        r#"WorldBegin
Shape "sphere" "string radius" "big"
"#,
        r#"
scene.pbrt:2:16: error: parameter "radius" has type string, expected float
 2 | Shape "sphere" "string radius" "big"
   |                ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "integer radius" 2
"#,
        r#"
scene.pbrt:2:16: error: parameter "radius" has type integer, expected float
 2 | Shape "sphere" "integer radius" 2
   |                ^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "float xresolution" 4
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: parameter "xresolution" has type float, expected integer
 1 | Film "rgb" "float xresolution" 4
   |            ^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "diffuse" "float reflectance" 0.5
"#,
        r#"
scene.pbrt:2:20: error: parameter "reflectance" has type float, expected texture, spectrum, rgb or blackbody
 2 | Material "diffuse" "float reflectance" 0.5
   |                    ^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "flaot radius" 2
"#,
        r#"
scene.pbrt:2:16: error: unknown parameter type "flaot"
 2 | Shape "sphere" "flaot radius" 2
   |                ^^^^^^^^^^^^^^
  help: did you mean "float"?
"#,
    );
    expect(
        r#"WorldBegin
Shape "disk" "float radius" [ 1 2 ]
"#,
        r#"
scene.pbrt:2:29: error: parameter "radius" takes one value, found 2
 2 | Shape "disk" "float radius" [ 1 2 ]
   |                             ^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "disk" "bool radius" "true"
"#,
        r#"
scene.pbrt:2:28: error: expected true or false, found "true"
 2 | Shape "disk" "bool radius" "true"
   |                            ^^^^^^
  help: write true without quotes, which only pbrt-v3 had
"#,
    );
    expect(
        r#"WorldBegin
Shape "trianglemesh" "point3 P" [ 0 0 0 1 ]
"#,
        r#"
scene.pbrt:2:33: error: "P" is of type point3: it needs 3 numbers a value, found 4
 2 | Shape "trianglemesh" "point3 P" [ 0 0 0 1 ]
   |                                 ^^^^^^^^^^^
"#,
    );
}
