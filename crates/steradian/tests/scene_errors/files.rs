//! Files that are missing, damaged or include themselves.

use crate::errors::{expect, expect_of, expect_with};
use std::path::Path;
use steradian::scene::MemoryFiles;
use steradian::scene::import::pbrt::Input;

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
