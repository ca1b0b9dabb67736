//! Wrong scenes, whole: the full text of every message, from import to compilation.

#[path = "support/errors.rs"]
mod errors;

use errors::{expect, expect_of, expect_with};
use std::path::Path;
use steradian::scene::MemoryFiles;
use steradian::scene::import::pbrt::Input;

/// A picture of one brightness.
fn pfm(width: usize, height: usize) -> Vec<u8> {
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    bytes.extend([0.5_f32; 3].repeat(width * height).iter().flat_map(|v| v.to_le_bytes()));
    bytes
}

/// One triangle, six bytes short.
fn cut_binary_ply() -> Vec<u8> {
    let mut bytes =
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            .to_vec();
    for v in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(v.to_le_bytes());
    }
    bytes.push(3);
    for index in [0_i32, 1, 2] {
        bytes.extend(index.to_le_bytes());
    }
    bytes.truncate(bytes.len() - 6);
    bytes
}

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

#[test]
fn numbers_that_are_not_finite_are_refused() {
    expect(
        r#"WorldBegin
Translate nan 0 0
"#,
        r#"
scene.pbrt:2:11: error: expected a number, found `nan`
 2 | Translate nan 0 0
   |           ^^^
  help: numbers must be finite
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "float radius" inf
"#,
        r#"
scene.pbrt:2:31: error: expected a number, found `inf`
 2 | Shape "sphere" "float radius" inf
   |                               ^^^
  help: numbers must be finite
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "float radius" 1e999
"#,
        r#"
scene.pbrt:2:31: error: `1e999` does not fit 32 bits
 2 | Shape "sphere" "float radius" 1e999
   |                               ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "float radius" 1e40
"#,
        r#"
scene.pbrt:2:31: error: `1e40` does not fit 32 bits
 2 | Shape "sphere" "float radius" 1e40
   |                               ^^^^
"#,
    );
    expect(
        r#"Sampler "halton" "integer pixelsamples" 99999999999
WorldBegin
"#,
        r#"
scene.pbrt:1:41: error: `99999999999` does not fit 32 bits
 1 | Sampler "halton" "integer pixelsamples" 99999999999
   |                                         ^^^^^^^^^^^
"#,
    );
}

#[test]
fn negative_counts_and_lengths_are_refused() {
    expect(
        r#"Sampler "halton" "integer pixelsamples" -4
WorldBegin
"#,
        r#"
scene.pbrt:1:18: error: parameter "pixelsamples" must be from 1 to 16777216, found -4
 1 | Sampler "halton" "integer pixelsamples" -4
   |                  ^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Integrator "path" "integer maxdepth" -1
WorldBegin
"#,
        r#"
scene.pbrt:1:19: error: parameter "maxdepth" must be at least 0, found -1
 1 | Integrator "path" "integer maxdepth" -1
   |                   ^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "integer xresolution" -5
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: parameter "xresolution" must be from 1 to 65536, found -5
 1 | Film "rgb" "integer xresolution" -5
   |            ^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "float radius" -1
"#,
        r#"
scene.pbrt:2:16: error: parameter "radius" must be positive, found -1
 2 | Shape "sphere" "float radius" -1
   |                ^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "loopsubdiv" "integer levels" -1 "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
"#,
        r#"
scene.pbrt:2:20: error: parameter "levels" must be from 0 to 10, found -1
 2 | Shape "loopsubdiv" "integer levels" -1 "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
   |                    ^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Texture "t" "float" "fbm" "integer octaves" -3
"#,
        r#"
scene.pbrt:2:27: error: parameter "octaves" must be from 1 to 64, found -3
 2 | Texture "t" "float" "fbm" "integer octaves" -3
   |                           ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Camera "perspective" "float lensradius" -1
WorldBegin
"#,
        r#"
scene.pbrt:1:22: error: parameter "lensradius" must be at least 0, found -1
 1 | Camera "perspective" "float lensradius" -1
   |                      ^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn absurd_counts_are_refused() {
    expect(
        r#"Sampler "independent" "integer pixelsamples" 2000000000
WorldBegin
"#,
        r#"
scene.pbrt:1:23: error: parameter "pixelsamples" must be from 1 to 16777216, found 2000000000
 1 | Sampler "independent" "integer pixelsamples" 2000000000
   |                       ^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Sampler "stratified" "integer xsamples" 30000 "integer ysamples" 30000
WorldBegin
"#,
        r#"
scene.pbrt:1:22: error: 900000000 strata are more than the 16777216 samples that a pixel can have
 1 | Sampler "stratified" "integer xsamples" 30000 "integer ysamples" 30000
   |                      ^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "coateddiffuse" "integer nsamples" 1000000
"#,
        r#"
scene.pbrt:2:26: error: parameter "nsamples" must be from 1 to 1000, found 1000000
 2 | Material "coateddiffuse" "integer nsamples" 1000000
   |                          ^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Texture "t" "float" "fbm" "integer octaves" 1000
"#,
        r#"
scene.pbrt:2:27: error: parameter "octaves" must be from 1 to 64, found 1000
 2 | Texture "t" "float" "fbm" "integer octaves" 1000
   |                           ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "loopsubdiv" "integer levels" 30 "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
"#,
        r#"
scene.pbrt:2:20: error: parameter "levels" must be from 0 to 10, found 30
 2 | Shape "loopsubdiv" "integer levels" 30 "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
   |                    ^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "curve" "integer splitdepth" 30 "point3 P" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]
"#,
        r#"
scene.pbrt:2:15: error: parameter "splitdepth" must be from 0 to 10, found 30
 2 | Shape "curve" "integer splitdepth" 30 "point3 P" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]
   |               ^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "spectral" "integer nbuckets" 100000000
WorldBegin
"#,
        r#"
scene.pbrt:1:17: error: parameter "nbuckets" must be from 1 to 4096, found 100000000
 1 | Film "spectral" "integer nbuckets" 100000000
   |                 ^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn an_albedo_beyond_one_or_below_zero_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Material "diffuse" "rgb reflectance" [ 1.2 0.5 0.5 ]
"#,
        r#"
scene.pbrt:3:38: error: parameter "reflectance": rgb components must be from 0 to 1: they are fractions
 3 | Material "diffuse" "rgb reflectance" [ 1.2 0.5 0.5 ]
   |                                      ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Material "diffuse" "rgb reflectance" [ -0.1 0.5 0.5 ]
"#,
        r#"
scene.pbrt:3:38: error: parameter "reflectance": rgb components must not be negative
 3 | Material "diffuse" "rgb reflectance" [ -0.1 0.5 0.5 ]
   |                                      ^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Texture "t" "spectrum" "constant" "rgb value" [ 0 0 7 ]
"#,
        r#"
scene.pbrt:3:47: error: parameter "value": rgb components must be from 0 to 1: they are fractions
 3 | Texture "t" "spectrum" "constant" "rgb value" [ 0 0 7 ]
   |                                               ^^^^^^^^^
"#,
    );
}

#[test]
fn an_index_of_refraction_that_nothing_has_is_refused() {
    expect(
        r#"WorldBegin
Material "dielectric" "float eta" -1.5
"#,
        r#"
scene.pbrt:2:35: error: parameter "eta" must be one number from 0.01 to 100 or a spectrum
 2 | Material "dielectric" "float eta" -1.5
   |                                   ^^^^
"#,
    );
    expect(
        r#"WorldBegin
Material "dielectric" "float eta" 1500
"#,
        r#"
scene.pbrt:2:35: error: parameter "eta" must be one number from 0.01 to 100 or a spectrum
 2 | Material "dielectric" "float eta" 1500
   |                                   ^^^^
"#,
    );
}

#[test]
fn an_index_out_of_range_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
    "integer indices" [ 0 1 4 ]
"#,
        r#"
scene.pbrt:4:23: error: "indices": value 3 is 4, but "P" has 4 points
 4 |     "integer indices" [ 0 1 4 ]
   |                       ^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
    "integer indices" [ 0 -1 2 ]
"#,
        r#"
scene.pbrt:4:23: error: "indices": value 2 is -1, but "P" has 4 points
 4 |     "integer indices" [ 0 -1 2 ]
   |                       ^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "bilinearmesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
    "integer indices" [ 0 1 2 9 ]
"#,
        r#"
scene.pbrt:4:23: error: "indices": value 4 is 9, but "P" has 4 points
 4 |     "integer indices" [ 0 1 2 9 ]
   |                       ^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "loopsubdiv" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
    "integer indices" [ 0 1 7 ]
"#,
        r#"
scene.pbrt:4:23: error: "indices": value 3 is 7, but "P" has 4 points
 4 |     "integer indices" [ 0 1 7 ]
   |                       ^^^^^^^^^
"#,
    );
    expect_with(r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#, [("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n".as_bytes())], r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: face 0: vertex index 3 is out of range: there are 3 vertices
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#);
}

#[test]
fn a_mesh_with_too_few_or_too_many_values_is_refused() {
    expect(
        r#"WorldBegin
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] "integer indices" [ 0 1 ]
"#,
        r#"
scene.pbrt:2:82: error: "indices" needs 3 values a face, found 2
 2 | …"point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] "integer indices" [ 0 1 ]
   |                                                              ^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "trianglemesh" "integer indices" [ 0 1 2 ]
"#,
        r#"
scene.pbrt:2:7: error: shape "trianglemesh" needs a parameter "P"
 2 | Shape "trianglemesh" "integer indices" [ 0 1 2 ]
   |       ^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] "integer indices" [ 0 1 2 ]
    "normal N" [ 0 0 1 ]
"#,
        r#"
scene.pbrt:3:16: error: "N" has 1 values, but "P" has 4 points
 3 |     "normal N" [ 0 0 1 ]
   |                ^^^^^^^^^
"#,
    );
}

#[test]
fn a_mesh_file_that_is_missing_cut_or_damaged_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#,
        r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: no such file
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#,
    );
    expect_with(r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#, [("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0".as_bytes())], r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: the header promises 1 of element "face", more than the file has room for
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#);
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#,
        [("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nprope".as_bytes())],
        r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: the header does not end
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#,
    );
    expect_with(r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#, [("m.ply", "ply\nformat ascii 1.0\nelement vertex 3000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".as_bytes())], r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: the header promises 3000000000 of element "vertex", more than the file has room for
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#);
    expect_with(r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#, [("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n".as_bytes())], r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: vertex 1: position [1, NaN, 0] is not finite
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#);
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#,
        [("m.ply", "solid cube\n".as_bytes())],
        r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: this is not a PLY file
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#,
        [("m.ply", "".as_bytes())],
        r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: the header does not end
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#,
    );
    expect_with(r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#, [("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n5 0 1 2 0 1\n".as_bytes())], r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: face 0: 5 corners; only 3 and 4 are supported
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#);
}

#[test]
fn a_binary_mesh_file_that_is_cut_is_refused() {
    let scene = r#"WorldBegin
LightSource "infinite"
Shape "plymesh" "string filename" "m.ply"
"#;
    expect_with(
        scene,
        [("m.ply", &cut_binary_ply()[..])],
        r#"
scene.pbrt:3:35: error: cannot read mesh m.ply: face 0: a list of 3 entries, more than the file has room for
 3 | Shape "plymesh" "string filename" "m.ply"
   |                                   ^^^^^^^
"#,
    );
}

#[test]
fn a_singular_transform_is_refused() {
    expect(
        r#"WorldBegin
Scale 0 0 0
"#,
        r#"
scene.pbrt:2:1: error: `Scale` by zero along an axis cannot be inverted
 2 | Scale 0 0 0
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Rotate 45 0 0 0
"#,
        r#"
scene.pbrt:2:1: error: `Rotate` needs an axis that is not zero
 2 | Rotate 45 0 0 0
   | ^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Transform [ 1 0 0 0  2 0 0 0  0 0 1 0  0 0 0 1 ]
"#,
        r#"
scene.pbrt:2:1: error: the matrix of `Transform` cannot be inverted
 2 | Transform [ 1 0 0 0  2 0 0 0  0 0 1 0  0 0 0 1 ]
   | ^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
ConcatTransform [ 0 0 0 0  0 0 0 0  0 0 0 0  0 0 0 0 ]
"#,
        r#"
scene.pbrt:2:1: error: the matrix of `ConcatTransform` cannot be inverted
 2 | ConcatTransform [ 0 0 0 0  0 0 0 0  0 0 0 0  0 0 0 0 ]
   | ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"LookAt 0 0 0  0 0 0  0 1 0
WorldBegin
"#,
        r#"
scene.pbrt:1:1: error: `LookAt` needs a target away from the eye and an up vector across the view
 1 | LookAt 0 0 0  0 0 0  0 1 0
   | ^^^^^^
"#,
    );
    expect(
        r#"LookAt 0 0 0  0 5 0  0 1 0
WorldBegin
"#,
        r#"
scene.pbrt:1:1: error: `LookAt` needs a target away from the eye and an up vector across the view
 1 | LookAt 0 0 0  0 5 0  0 1 0
   | ^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Scale 1e-30 1 1
Scale 1e-30 1 1
"#,
        r#"
scene.pbrt:3:1: error: the current transform becomes too large or too small for 32-bit floats
 3 | Scale 1e-30 1 1
   | ^^^^^
"#,
    );
}

#[test]
fn geometry_beyond_the_range_of_floats_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Scale 1e25 1e25 1e25
Shape "sphere" "float radius" 1e30
"#,
        r#"
scene.pbrt:4:1: error: the shape reaches beyond the range of floats in render space
 4 | Shape "sphere" "float radius" 1e30
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Scale 1e20 1e20 1e20
Shape "trianglemesh" "point3 P" [ 0 0 0  1e30 0 0  0 1e30 0 ]
"#,
        r#"
scene.pbrt:4:1: error: vertex 1 is not finite in render space
 4 | Shape "trianglemesh" "point3 P" [ 0 0 0  1e30 0 0  0 1e30 0 ]
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
ObjectBegin "o"
Shape "sphere" "float radius" 1e20
ObjectEnd
Scale 1e20 1e20 1e20
ObjectInstance "o"
"#,
        r#"
scene.pbrt:7:1: error: the instance reaches beyond the range of floats in render space
 7 | ObjectInstance "o"
   | ^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_surface_that_cannot_be_subdivided_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "loopsubdiv" "integer indices" [ 0 1 2  0 1 3  0 1 4 ]
    "point3 P" [ 0 0 0  1 0 0  0 1 0  0 0 1  1 1 1 ]
"#,
        r#"
scene.pbrt:3:1: error: edge (0, 1) belongs to more than two faces or is traversed twice in the same sense
 3 | Shape "loopsubdiv" "integer indices" [ 0 1 2  0 1 3  0 1 4 ]
   | ^^^^^
"#,
    );
}

#[test]
fn empty_quadrics_are_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "sphere" "float zmin" 2 "float zmax" 3
"#,
        r#"
scene.pbrt:3:16: error: nothing of the sphere lies between "zmin" and "zmax"
 3 | Shape "sphere" "float zmin" 2 "float zmax" 3
   |                ^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "disk" "float innerradius" 2
"#,
        r#"
scene.pbrt:3:1: error: innerradius = 2 must be at least 0 and less than the radius
 3 | Shape "disk" "float innerradius" 2
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "cylinder" "float zmin" 1 "float zmax" 1
"#,
        r#"
scene.pbrt:3:1: error: zmax = 1 must be different from zmin
 3 | Shape "cylinder" "float zmin" 1 "float zmax" 1
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Shape "sphere" "float phimax" 0
"#,
        r#"
scene.pbrt:3:16: error: parameter "phimax" must be positive, found 0
 3 | Shape "sphere" "float phimax" 0
   |                ^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_scene_that_includes_itself_is_refused() {
    let files = MemoryFiles::new().with("self.pbrt", "WorldBegin\nInclude \"self.pbrt\"\n");
    expect_of(
        Input::File(Path::new("self.pbrt")),
        &files,
        r#"
self.pbrt:2:9: error: "self.pbrt" includes itself
 2 | Include "self.pbrt"
   |         ^^^^^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
Include "a.pbrt"
"#,
        [
            ("a.pbrt", "Include \"b.pbrt\"\n".as_bytes()),
            ("b.pbrt", "Scale 1 1 1\nInclude \"a.pbrt\"\n".as_bytes()),
        ],
        r#"
b.pbrt:2:9: error: "a.pbrt" includes itself
 2 | Include "a.pbrt"
   |         ^^^^^^^^
  included from a.pbrt:1:1
  included from scene.pbrt:2:1
"#,
    );
    expect_with(
        r#"WorldBegin
Import "a.pbrt"
"#,
        [("a.pbrt", "Import \"a.pbrt\"\n".as_bytes())],
        r#"
a.pbrt:1:8: error: "a.pbrt" includes itself
 1 | Import "a.pbrt"
   |        ^^^^^^^^
  included from scene.pbrt:2:1
"#,
    );
}

#[test]
fn a_file_that_is_missing_or_damaged_is_refused() {
    expect(
        r#"WorldBegin
Include "gone.pbrt"
"#,
        r#"
scene.pbrt:2:9: error: cannot read "gone.pbrt": no such file
 2 | Include "gone.pbrt"
   |         ^^^^^^^^^^^
"#,
    );
    let files = MemoryFiles::new();
    expect_of(
        Input::File(Path::new("gone.pbrt")),
        &files,
        r#"
error: cannot read gone.pbrt: no such file
"#,
    );
    expect_with(
        r#"WorldBegin
Include "a.pbrt.gz"
"#,
        [("a.pbrt.gz", "not gzip".as_bytes())],
        r#"
scene.pbrt:2:9: error: cannot read "a.pbrt.gz": unexpected end of file
 2 | Include "a.pbrt.gz"
   |         ^^^^^^^^^^^
"#,
    );
}

#[test]
fn an_error_in_an_included_file_names_the_chain() {
    expect_with(
        r#"WorldBegin
Include "parts/a.pbrt"
"#,
        [
            ("parts/a.pbrt", "# a part\nInclude \"parts/b.pbrt\"\n".as_bytes()),
            ("parts/b.pbrt", "Shape \"cube\"\nShape \"disc\"\n".as_bytes()),
        ],
        r#"
parts/b.pbrt:1:7: error: unknown shape "cube"
 1 | Shape "cube"
   |       ^^^^^^
  included from parts/a.pbrt:2:1
  included from scene.pbrt:2:1
parts/b.pbrt:2:7: error: unknown shape "disc"
 2 | Shape "disc"
   |       ^^^^^^
  help: did you mean "disk"?
  included from parts/a.pbrt:2:1
  included from scene.pbrt:2:1
"#,
    );
}

#[test]
fn a_picture_that_is_missing_or_cannot_be_decoded_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Texture "t" "spectrum" "imagemap" "string filename" "gone.png"
"#,
        r#"
scene.pbrt:3:53: error: cannot read image gone.png: no such file
 3 | Texture "t" "spectrum" "imagemap" "string filename" "gone.png"
   |                                                     ^^^^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Texture "t" "spectrum" "imagemap" "string filename" "t.png"
"#,
        [("t.png", "this is no picture".as_bytes())],
        r#"
scene.pbrt:3:53: error: cannot read image t.png: malformed PNG image: the signature of the format is missing
 3 | Texture "t" "spectrum" "imagemap" "string filename" "t.png"
   |                                                     ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Texture "t" "spectrum" "imagemap" "string filename" "t.xyz"
"#,
        [("t.xyz", "this is no picture".as_bytes())],
        r#"
scene.pbrt:3:53: error: cannot read image t.xyz: unknown image format "xyz" (read: exr, pfm, hdr, png, tga, jpg, bmp)
 3 | Texture "t" "spectrum" "imagemap" "string filename" "t.xyz"
   |                                                     ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Texture "t" "spectrum" "imagemap" "string filename" "t.pfm"
"#,
        [("t.pfm", "PF\n4 4\n-1.0\n1234".as_bytes())],
        r#"
scene.pbrt:3:53: error: cannot read image t.pfm: malformed PFM image: the data end early
 3 | Texture "t" "spectrum" "imagemap" "string filename" "t.pfm"
   |                                                     ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Texture "t" "spectrum" "imagemap" "string filename" "t.pfm"
"#,
        [("t.pfm", "PF\n60000 60000\n-1.0\n1234".as_bytes())],
        r#"
scene.pbrt:3:53: error: cannot read image t.pfm: image of 60000 x 60000 pixels is too large for a file of 24 bytes
 3 | Texture "t" "spectrum" "imagemap" "string filename" "t.pfm"
   |                                                     ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Material "diffuse" "string normalmap" "n.pfm"
"#,
        [("n.pfm", "Pf\n1 1\n-1.0\n1234".as_bytes())],
        r#"
scene.pbrt:3:39: error: n.pfm: normal map has 1 channels, but needs red, green and blue
 3 | Material "diffuse" "string normalmap" "n.pfm"
   |                                       ^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Texture "t" "spectrum" "imagemap"
"#,
        r#"
scene.pbrt:2:24: error: texture "imagemap" needs a parameter "filename"
 2 | Texture "t" "spectrum" "imagemap"
   |                        ^^^^^^^^^^
"#,
    );
}

#[test]
fn a_spectrum_file_that_is_missing_or_damaged_is_refused() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
"#,
        r#"
scene.pbrt:3:37: error: cannot read spectrum file a.spd: no such file
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                     ^^^^^^^
scene.pbrt:3:58: error: cannot read spectrum file a.spd: no such file
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                                          ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
"#,
        [("a.spd", "400 1\n500 x\n".as_bytes())],
        r#"
scene.pbrt:3:37: error: cannot read spectrum file a.spd: line 2: `x` is not a number
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                     ^^^^^^^
scene.pbrt:3:58: error: cannot read spectrum file a.spd: line 2: `x` is not a number
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                                          ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
"#,
        [("a.spd", "400 1\n300 2\n".as_bytes())],
        r#"
scene.pbrt:3:37: error: cannot read spectrum file a.spd: line 2: wavelength 300 nm follows 400 nm: wavelengths must increase
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                     ^^^^^^^
scene.pbrt:3:58: error: cannot read spectrum file a.spd: line 2: wavelength 300 nm follows 400 nm: wavelengths must increase
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                                          ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
"#,
        [("a.spd", "# empty\n".as_bytes())],
        r#"
scene.pbrt:3:37: error: cannot read spectrum file a.spd: no samples: a spectrum needs at least one wavelength and value
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                     ^^^^^^^
scene.pbrt:3:58: error: cannot read spectrum file a.spd: no samples: a spectrum needs at least one wavelength and value
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                                          ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
"#,
        [("a.spd", "400 1 500\n".as_bytes())],
        r#"
scene.pbrt:3:37: error: cannot read spectrum file a.spd: line 1: 3 numbers: wavelengths and values must come in pairs
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                     ^^^^^^^
scene.pbrt:3:58: error: cannot read spectrum file a.spd: line 1: 3 numbers: wavelengths and values must come in pairs
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                                          ^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "infinite"
Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
"#,
        [("a.spd", "400 nan\n".as_bytes())],
        r#"
scene.pbrt:3:37: error: cannot read spectrum file a.spd: line 1: sample 0 is not finite
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                     ^^^^^^^
scene.pbrt:3:58: error: cannot read spectrum file a.spd: line 1: sample 0 is not finite
 3 | Material "conductor" "spectrum eta" "a.spd" "spectrum k" "a.spd"
   |                                                          ^^^^^^^
"#,
    );
}

#[test]
fn a_table_of_a_spectrum_must_ascend() {
    expect(
        r#"WorldBegin
LightSource "infinite"
Material "diffuse" "spectrum reflectance" [ 500 0.1 400 0.2 ]
"#,
        r#"
scene.pbrt:3:43: error: parameter "reflectance": wavelengths must increase, found 400 after 500
 3 | Material "diffuse" "spectrum reflectance" [ 500 0.1 400 0.2 ]
   |                                           ^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
Material "diffuse" "spectrum reflectance" [ 500 0.1 600 ]
"#,
        r#"
scene.pbrt:3:43: error: "reflectance" needs pairs of wavelength and value, found 3 numbers
 3 | Material "diffuse" "spectrum reflectance" [ 500 0.1 600 ]
   |                                           ^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_film_without_pixels_is_refused() {
    expect(
        r#"Film "rgb" "integer xresolution" 0
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: parameter "xresolution" must be from 1 to 65536, found 0
 1 | Film "rgb" "integer xresolution" 0
   |            ^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "float cropwindow" [ 0.5 0.5 0 1 ]
WorldBegin
"#,
        r#"
scene.pbrt:1:31: error: the crop window is empty
 1 | Film "rgb" "float cropwindow" [ 0.5 0.5 0 1 ]
   |                               ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "integer pixelbounds" [ 5 5 0 9 ]
WorldBegin
"#,
        r#"
scene.pbrt:1:34: error: the pixel bounds contain no pixel
 1 | Film "rgb" "integer pixelbounds" [ 5 5 0 9 ]
   |                                  ^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "integer xresolution" 4 "integer yresolution" 4 "float cropwindow" [ 0.3 0.4 0 1 ]
WorldBegin
LightSource "infinite"
"#,
        r#"
scene.pbrt:1:1: error: the part to be rendered contains none of the 4 x 4 pixels
 1 | Film "rgb" "integer xresolution" 4 "integer yresolution" 4 "float cropwindow" [ 0.3 0.4 0 1 ]
   | ^^^^
"#,
    );
}

#[test]
fn a_film_beyond_all_memory_is_refused() {
    expect(
        r#"Film "rgb" "integer xresolution" 1000000000 "integer yresolution" 1000000000
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: parameter "xresolution" must be from 1 to 65536, found 1000000000
 1 | Film "rgb" "integer xresolution" 1000000000 "integer yresolution" 1000000000
   |            ^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:1:45: error: parameter "yresolution" must be from 1 to 65536, found 1000000000
 1 | Film "rgb" "integer xresolution" 1000000000 "integer yresolution" 1000000000
   |                                             ^^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "integer xresolution" 65536 "integer yresolution" 65536
WorldBegin
LightSource "infinite"
"#,
        r#"
scene.pbrt:1:1: error: 65536 x 65536 pixels of this film need about 256 GiB of memory, more than 64
 1 | Film "rgb" "integer xresolution" 65536 "integer yresolution" 65536
   | ^^^^
  help: render it in parts by "cropwindow"
"#,
    );
    expect(
        r#"Film "spectral" "integer nbuckets" 4000
    "integer xresolution" 4000 "integer yresolution" 4000
WorldBegin
LightSource "infinite"
"#,
        r#"
scene.pbrt:1:1: error: 4000 x 4000 pixels of this film need about 1431 GiB of memory, more than 64
 1 | Film "spectral" "integer nbuckets" 4000
   | ^^^^
  help: render it in parts by "cropwindow"
"#,
    );
}

#[test]
fn a_sensor_that_sees_nothing_is_refused() {
    expect(
        r#"Film "rgb" "float iso" 0
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: parameter "iso" must be from 1e-6 to 1e9, found 0
 1 | Film "rgb" "float iso" 0
   |            ^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "float whitebalance" 100
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: parameter "whitebalance" must be 0 or a colour temperature from 1000 to 24900, found 100
 1 | Film "rgb" "float whitebalance" 100
   |            ^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Camera "perspective" "float shutteropen" 1 "float shutterclose" 1
WorldBegin
"#,
        r#"
scene.pbrt:1:44: error: the shutter is open for no time: the picture would be black
 1 | Camera "perspective" "float shutteropen" 1 "float shutterclose" 1
   |                                            ^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Camera "perspective" "float shutterclose" 1e-38
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite"
"#,
        r#"
scene.pbrt:2:1: error: shutter time and ISO make an exposure of 1e-38, which no picture can show
 2 | Film "rgb" "integer xresolution" 16 "integer yresolution" 16
   | ^^^^
scene.pbrt:1:1: note: the shutter times are the camera's
 1 | Camera "perspective" "float shutterclose" 1e-38
   | ^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "string sensor" "cie1932"
WorldBegin
"#,
        r#"
scene.pbrt:1:28: error: unknown sensor "cie1932"
 1 | Film "rgb" "string sensor" "cie1932"
   |                            ^^^^^^^^^
  help: did you mean "cie1931"?
"#,
    );
}

#[test]
fn a_filter_without_content_is_refused() {
    expect(
        r#"PixelFilter "gaussian" "float sigma" 0
WorldBegin
"#,
        r#"
scene.pbrt:1:24: error: parameter "sigma" must be from 0.01 to 100, found 0
 1 | PixelFilter "gaussian" "float sigma" 0
   |                        ^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"PixelFilter "gaussian" "float xradius" 0.01 "float sigma" 50
WorldBegin
"#,
        r#"
scene.pbrt:1:45: error: "sigma" 50 leaves nothing of the filter within its radius
 1 | PixelFilter "gaussian" "float xradius" 0.01 "float sigma" 50
   |                                             ^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"PixelFilter "box" "float xradius" 0
WorldBegin
"#,
        r#"
scene.pbrt:1:19: error: parameter "xradius" must be from 0.01 to 64, found 0
 1 | PixelFilter "box" "float xradius" 0
   |                   ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"PixelFilter "mitchell" "float B" 1e30
WorldBegin
"#,
        r#"
scene.pbrt:1:24: error: parameter "B" must be from -10 to 10, found 1e30
 1 | PixelFilter "mitchell" "float B" 1e30
   |                        ^^^^^^^^^
"#,
    );
    expect(
        r#"PixelFilter "sinc" "float tau" 0
WorldBegin
"#,
        r#"
scene.pbrt:1:20: error: parameter "tau" must be from 0.1 to 1000, found 0
 1 | PixelFilter "sinc" "float tau" 0
   |                    ^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_camera_without_a_view_is_refused() {
    expect(
        r#"Camera "perspective" "float fov" 180
WorldBegin
"#,
        r#"
scene.pbrt:1:22: error: parameter "fov" must be between 0 and 180, found 180
 1 | Camera "perspective" "float fov" 180
   |                      ^^^^^^^^^^^
"#,
    );
    expect(
        r#"Camera "perspective" "float screenwindow" [ 1 1 -1 1 ]
WorldBegin
"#,
        r#"
scene.pbrt:1:43: error: the screen window is empty
 1 | Camera "perspective" "float screenwindow" [ 1 1 -1 1 ]
   |                                           ^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Camera "perspective" "float focaldistance" 0
WorldBegin
"#,
        r#"
scene.pbrt:1:22: error: parameter "focaldistance" must be positive, found 0
 1 | Camera "perspective" "float focaldistance" 0
   |                      ^^^^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_light_that_nobody_sees_is_refused() {
    expect(
        r#"WorldBegin
LightSource "point" "spectrum I" [ 900 1 1000 1 ]
"#,
        r#"
scene.pbrt:2:1: error: the spectrum has no visible part, so its amount cannot be given in lumen, lux or candela
 2 | LightSource "point" "spectrum I" [ 900 1 1000 1 ]
   | ^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
AreaLightSource "diffuse" "spectrum L" [ 200 1 300 1 ]
Shape "sphere"
"#,
        r#"
scene.pbrt:2:1: error: the spectrum has no visible part, so its amount cannot be given in lumen, lux or candela
 2 | AreaLightSource "diffuse" "spectrum L" [ 200 1 300 1 ]
   | ^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn an_environment_map_that_is_not_square_is_refused() {
    expect_with(
        r#"WorldBegin
LightSource "infinite" "string filename" "sky.pfm"
"#,
        [("sky.pfm", &pfm(3, 2)[..])],
        r#"
scene.pbrt:2:42: error: an environment map must be square (equal-area octahedral), not 3 by 2 pixels
 2 | LightSource "infinite" "string filename" "sky.pfm"
   |                                          ^^^^^^^^^
"#,
    );
    expect_with(
        r#"WorldBegin
LightSource "goniometric" "string filename" "sky.pfm"
"#,
        [("sky.pfm", &pfm(3, 1)[..])],
        r#"
scene.pbrt:2:45: error: an environment map must be square (equal-area octahedral), not 3 by 1 pixels
 2 | LightSource "goniometric" "string filename" "sky.pfm"
   |                                             ^^^^^^^^^
"#,
    );
}

#[test]
fn a_light_without_its_direction_or_picture_is_refused() {
    expect(
        r#"WorldBegin
LightSource "spot" "point3 from" [ 1 1 1 ] "point3 to" [ 1 1 1 ]
"#,
        r#"
scene.pbrt:2:44: error: "from" and "to" must differ
 2 | LightSource "spot" "point3 from" [ 1 1 1 ] "point3 to" [ 1 1 1 ]
   |                                            ^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "projection"
"#,
        r#"
scene.pbrt:2:13: error: light "projection" needs a parameter "filename"
 2 | LightSource "projection"
   |             ^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ] "string filename" "sky.exr"
"#,
        r#"
scene.pbrt:2:42: error: give "L" or "filename", not both
 2 | LightSource "infinite" "rgb L" [ 1 1 1 ] "string filename" "sky.exr"
   |                                          ^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite" "string filename" "gone.exr"
"#,
        r#"
scene.pbrt:2:42: error: cannot read image gone.exr: no such file
 2 | LightSource "infinite" "string filename" "gone.exr"
   |                                          ^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "point" "string unit" "radiance"
"#,
        r#"
scene.pbrt:2:35: error: the unit of this light can only be "intensity", found "radiance"
 2 | LightSource "point" "string unit" "radiance"
   |                                   ^^^^^^^^^^
"#,
    );
}

#[test]
fn what_is_not_supported_is_said_at_its_place() {
    expect(
        r#"WorldBegin
Material "subsurface" "string name" "Skin1"
"#,
        r#"
scene.pbrt:2:10: error: unsupported: material "subsurface"
 2 | Material "subsurface" "string name" "Skin1"
   |          ^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "plymesh" "string filename" "a.ply"
    "float displacement" 1
"#,
        r#"
scene.pbrt:3:5: error: unsupported: displacement of plymesh shapes
 3 |     "float displacement" 1
   |     ^^^^^^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous"
"#,
        r#"
scene.pbrt:2:1: error: unsupported: participating media
 2 | MakeNamedMedium "fog" "string type" "homogeneous"
   | ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
MakeNamedMedium "fog" "string type" "nanovdb" "string filename" "a.nvdb"
"#,
        r#"
scene.pbrt:2:37: error: unsupported: medium "nanovdb"
 2 | MakeNamedMedium "fog" "string type" "nanovdb" "string filename" "a.nvdb"
   |                                     ^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite" "point3 portal" [ 0 0 0  1 0 0  1 1 0  0 1 0 ]
"#,
        r#"
scene.pbrt:2:24: error: unsupported: portals of infinite lights
 2 | LightSource "infinite" "point3 portal" [ 0 0 0  1 0 0  1 1 0  0 1 0 ]
   |                        ^^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Camera "realistic" "string lensfile" "a.dat"
WorldBegin
"#,
        r#"
scene.pbrt:1:8: error: unsupported: camera "realistic"
 1 | Camera "realistic" "string lensfile" "a.dat"
   |        ^^^^^^^^^^^
"#,
    );
    expect(
        r#"Film "rgb" "string sensor" "nikon_d810"
WorldBegin
"#,
        r#"
scene.pbrt:1:28: error: unsupported: sensor "nikon_d810"; known is cie1931
 1 | Film "rgb" "string sensor" "nikon_d810"
   |                            ^^^^^^^^^^^^
"#,
    );
    expect(
        r#"Integrator "function"
WorldBegin
"#,
        r#"
scene.pbrt:1:12: error: unsupported: integrator "function"
 1 | Integrator "function"
   |            ^^^^^^^^^^
"#,
    );
    expect(
        r#"Integrator "ambientocclusion"
WorldBegin
LightSource "infinite"
"#,
        r#"
scene.pbrt:1:1: error: integrator "ambientocclusion" is not supported: it shows no radiance
 1 | Integrator "ambientocclusion"
   | ^^^^^^^^^^
  help: "path" renders the scene's own lights
"#,
    );
    expect(
        r#"WorldBegin
Texture "t" "float" "ptex" "string filename" "a.ptx"
"#,
        r#"
scene.pbrt:2:21: error: unsupported: texture "ptex"
 2 | Texture "t" "float" "ptex" "string filename" "a.ptx"
   |                     ^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
AreaLightSource "diffuse"
ActiveTransform EndTime
Translate 1 0 0
Shape "sphere"
"#,
        r#"
scene.pbrt:5:1: error: an area light on a moving shape is not supported
 5 | Shape "sphere"
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
AreaLightSource "diffuse"
Shape "sphere" "float alpha" 0.5
"#,
        r#"
scene.pbrt:3:1: error: an area light with alpha is not supported: light would be sampled from its holes
 3 | Shape "sphere" "float alpha" 0.5
   | ^^^^^
"#,
    );
    expect(
        r#"WorldBegin
LightSource "infinite"
ObjectBegin "o"
ActiveTransform EndTime
Translate 1 0 0
Shape "sphere"
ObjectEnd
"#,
        r#"
scene.pbrt:6:1: error: a moving shape inside an object is not supported; move the instance instead
 6 | Shape "sphere"
   | ^^^^^
"#,
    );
}

#[test]
fn a_scene_of_the_older_language_is_recognised() {
    expect(
        r#"Film "image" "integer xresolution" [16]
WorldBegin
Material "matte"
WorldEnd
"#,
        r#"
scene.pbrt:1:6: error: this looks like a pbrt-v3 file; the language here is pbrt-v4, which has no film "image"
 1 | Film "image" "integer xresolution" [16]
   |      ^^^^^^^
  help: convert it with pbrt-v4: `pbrt --upgrade old.pbrt > new.pbrt`
"#,
    );
    expect(
        r#"WorldBegin
Material "matte" "color Kd" [ 1 1 1 ]
"#,
        r#"
scene.pbrt:2:18: error: unknown parameter type "color"
 2 | Material "matte" "color Kd" [ 1 1 1 ]
   |                  ^^^^^^^^^^
  help: pbrt-v4 writes "rgb" where pbrt-v3 wrote "color"
scene.pbrt:2:10: error: this looks like a pbrt-v3 file; the language here is pbrt-v4, which has no material "matte"
 2 | Material "matte" "color Kd" [ 1 1 1 ]
   |          ^^^^^^^
  help: convert it with pbrt-v4: `pbrt --upgrade old.pbrt > new.pbrt`
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere"
WorldEnd
"#,
        r#"
scene.pbrt:3:1: error: this looks like a pbrt-v3 file; the language here is pbrt-v4, which has no `WorldEnd`
 3 | WorldEnd
   | ^^^^^^^^
  help: convert it with pbrt-v4: `pbrt --upgrade old.pbrt > new.pbrt`
"#,
    );
}

#[test]
fn things_made_of_themselves_are_refused() {
    expect(
        r#"WorldBegin
Texture "a" "float" "scale" "texture tex" "b"
Texture "b" "float" "scale" "texture tex" "a"
"#,
        r#"
scene.pbrt:3:1: error: texture "b" is made of itself
 3 | Texture "b" "float" "scale" "texture tex" "a"
   | ^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
MakeNamedMaterial "m" "string type" "mix" "string materials" [ "m" "m" ]
"#,
        r#"
scene.pbrt:2:1: error: material "m" is a mix of itself
 2 | MakeNamedMaterial "m" "string type" "mix" "string materials" [ "m" "m" ]
   | ^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn blocks_and_brackets_that_are_not_closed_are_refused() {
    expect(
        r#"WorldBegin
AttributeBegin
"#,
        r#"
scene.pbrt:2:1: error: this `AttributeBegin` is never closed
 2 | AttributeBegin
   | ^^^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
AttributeEnd
"#,
        r#"
scene.pbrt:2:1: error: `AttributeEnd` without `AttributeBegin`
 2 | AttributeEnd
   | ^^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
ObjectBegin "o"
"#,
        r#"
scene.pbrt:2:1: error: this `ObjectBegin` is never closed
 2 | ObjectBegin "o"
   | ^^^^^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere
"#,
        r#"
scene.pbrt:2:7: error: this string is not closed on its line
 2 | Shape "sphere
   |       ^^^^^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "trianglemesh" "point3 P" [ 0 0 0
Shape "sphere"
"#,
        r#"
scene.pbrt:2:33: error: this `[` is never closed
 2 | Shape "trianglemesh" "point3 P" [ 0 0 0
   |                                 ^
"#,
    );
}

#[test]
fn directives_in_the_wrong_half_are_refused() {
    expect(
        r#"WorldBegin
Film "rgb"
"#,
        r#"
scene.pbrt:2:1: error: `Film` must come before `WorldBegin`
 2 | Film "rgb"
   | ^^^^
"#,
    );
    expect(
        r#"Shape "sphere"
WorldBegin
"#,
        r#"
scene.pbrt:1:1: error: `Shape` must come after `WorldBegin`
 1 | Shape "sphere"
   | ^^^^^
"#,
    );
    expect(
        r#"Film "rgb"
"#,
        r#"
scene.pbrt:2:1: error: the scene ends without `WorldBegin`
"#,
    );
    expect(
        r#""#,
        r#"
scene.pbrt:1:1: error: the scene ends without `WorldBegin`
"#,
    );
}

#[test]
fn a_definition_given_twice_is_shown_with_the_first() {
    expect(
        r#"WorldBegin
MakeNamedMaterial "m" "string type" "diffuse"
MakeNamedMaterial "m" "string type" "diffuse"
"#,
        r#"
scene.pbrt:3:19: error: material "m" is defined twice
 3 | MakeNamedMaterial "m" "string type" "diffuse"
   |                   ^^^
scene.pbrt:2:19: note: the first definition is here
 2 | MakeNamedMaterial "m" "string type" "diffuse"
   |                   ^^^
"#,
    );
    expect(
        r#"WorldBegin
Shape "sphere" "float radius" 1 "float radius" 2
"#,
        r#"
scene.pbrt:2:33: error: parameter "radius" is given twice
 2 | Shape "sphere" "float radius" 1 "float radius" 2
   |                                 ^^^^^^^^^^^^^^
scene.pbrt:2:16: note: it was given here first
 2 | Shape "sphere" "float radius" 1 "float radius" 2
   |                ^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn bytes_that_are_no_scene_are_refused() {
    let bytes =
        [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52];
    let input = Input::Text { name: "scene.pbrt", bytes: &bytes, base: Path::new("") };
    expect_of(
        input,
        &MemoryFiles::new(),
        r#"
scene.pbrt:1:1: error: unknown directive `�PNG`
 1 | �PNG
   | ^^^^
scene.pbrt:3:9: error: the scene ends without `WorldBegin`
 3 |     IHDR
   |         ^
"#,
    );
    expect(
        r#"{ "asset": { "version": "2.0" } }
"#,
        r#"
scene.pbrt:1:1: error: unknown directive `{`
 1 | { "asset": { "version": "2.0" } }
   | ^
scene.pbrt:2:1: error: the scene ends without `WorldBegin`
"#,
    );
}

#[test]
fn all_errors_of_a_file_are_reported_at_once() {
    expect(
        r#"Camera "perspective" "float fov" 200
WorldBegin
Shape "spheer"
Scale 0 1 1
Material "diffuse" "rgb reflectance" [ 1 2 ]
Shape "disk" "float hight" 1
NamedMaterial "gone"
"#,
        r#"
scene.pbrt:1:22: error: parameter "fov" must be between 0 and 180, found 200
 1 | Camera "perspective" "float fov" 200
   |                      ^^^^^^^^^^^
scene.pbrt:3:7: error: unknown shape "spheer"
 3 | Shape "spheer"
   |       ^^^^^^^^
  help: did you mean "sphere"?
scene.pbrt:4:1: error: `Scale` by zero along an axis cannot be inverted
 4 | Scale 0 1 1
   | ^^^^^
scene.pbrt:5:38: error: "reflectance" is of type rgb: it needs 3 numbers a value, found 2
 5 | Material "diffuse" "rgb reflectance" [ 1 2 ]
   |                                      ^^^^^^^
scene.pbrt:6:14: error: shape "disk" has no parameter "hight"
 6 | Shape "disk" "float hight" 1
   |              ^^^^^^^^^^^^^
  help: did you mean "height"?
scene.pbrt:7:15: error: material "gone" is not defined
 7 | NamedMaterial "gone"
   |               ^^^^^^
"#,
    );
}

#[test]
fn all_errors_of_compiling_are_reported_at_once() {
    expect(
        r#"Film "rgb" "integer xresolution" 65536 "integer yresolution" 65536
WorldBegin
LightSource "point" "spectrum I" [ 900 1 1000 1 ]
LightSource "infinite" "string filename" "gone.exr"
Texture "t" "spectrum" "imagemap" "string filename" "gone.png"
Material "diffuse" "spectrum reflectance" "gone.spd"
Shape "plymesh" "string filename" "gone.ply"
Shape "sphere" "float zmin" 2 "float zmax" 3
"#,
        r#"
scene.pbrt:8:16: error: nothing of the sphere lies between "zmin" and "zmax"
 8 | Shape "sphere" "float zmin" 2 "float zmax" 3
   |                ^^^^^^^^^^^^
"#,
    );
}
