//! Numbers that nothing can be made of.

use crate::errors::{expect, expect_with};

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
