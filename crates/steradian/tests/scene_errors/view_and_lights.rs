//! Film, camera, filters and lights.

use crate::errors::{expect, expect_with};
use crate::pfm;

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
