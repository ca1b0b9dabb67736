//! The language itself, and what is not supported.

use crate::errors::{expect, expect_of};
use std::path::Path;
use steradian::scene::MemoryFiles;
use steradian::scene::import::pbrt::Input;

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
