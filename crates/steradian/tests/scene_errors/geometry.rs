//! Shapes and transforms.

use crate::errors::{expect, expect_with};

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
