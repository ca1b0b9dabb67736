//! Wrong skies and suns: the full text of every message.

#[path = "support/errors.rs"]
mod errors;

use errors::expect;

#[test]
fn an_unknown_sky_is_shown_with_the_nearest_one() {
    expect(
        r#"WorldBegin
LightSource "sky" "string model" "cei-12" "vector3 sundirection" [ 0 0 1 ]
"#,
        r#"
scene.pbrt:2:34: error: unknown sky model "cei-12"
 2 | LightSource "sky" "string model" "cei-12" "vector3 sundirection" [ 0 0 1 ]
   |                                  ^^^^^^^^
  help: did you mean "cie-12"?
"#,
    );
    expect(
        r#"WorldBegin
LightSource "sky" "string model" "stormy" "float turbidity" 0.1
LightSource "sky" "float ozone" 0.3
"#,
        r#"
scene.pbrt:2:34: error: unknown sky model "stormy"
 2 | LightSource "sky" "string model" "stormy" "float turbidity" 0.1
   |                                  ^^^^^^^^
  help: known are cie-1 to cie-16, overcast, clear, uniform and bird-riordan
scene.pbrt:3:13: error: light "sky" needs a parameter "model"
 3 | LightSource "sky" "float ozone" 0.3
   |             ^^^^^
"#,
    );
}

#[test]
fn a_sky_that_is_brighter_near_the_sun_is_told_where_it_stands() {
    expect(
        r#"WorldBegin
LightSource "sky" "string model" "clear"
LightSource "sun"
"#,
        r#"
scene.pbrt:2:34: error: sky "clear" is brighter near the sun, and nothing says where it stands
 2 | LightSource "sky" "string model" "clear"
   |                                  ^^^^^^^
  help: give "vector3 sundirection", or "latitude", "longitude" and "time"
scene.pbrt:3:13: error: nothing says where the sun stands
 3 | LightSource "sun"
   |             ^^^^^
  help: give "vector3 sundirection", or "latitude", "longitude" and "time"
"#,
    );
    expect(
        r#"WorldBegin
LightSource "sun" "float latitude" 48.1 "string time" "2026-06-21T12:00+02:00"
LightSource "sun" "float longitude" 11.6
LightSource "sun" "float latitude" 48.1 "vector3 sundirection" [ 0 0 1 ]
"#,
        r#"
scene.pbrt:2:19: error: the sun's place takes "latitude", "longitude" and "time"; "longitude" is missing
 2 | LightSource "sun" "float latitude" 48.1 "string time" "2026-06-21T12:00+02:00"
   |                   ^^^^^^^^^^^^^^^^
scene.pbrt:3:19: error: the sun's place takes "latitude", "longitude" and "time"; "latitude" and "time" are missing
 3 | LightSource "sun" "float longitude" 11.6
   |                   ^^^^^^^^^^^^^^^^^
scene.pbrt:4:19: error: give "sundirection", or place and time, not both
 4 | LightSource "sun" "float latitude" 48.1 "vector3 sundirection" [ 0 0 1 ]
   |                   ^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn times_and_places_that_do_not_exist_are_refused() {
    expect(
        r#"WorldBegin
LightSource "sun" "float latitude" 48.1 "float longitude" 11.6 "string time" "2026-06-21T12:00"
LightSource "sun" "float latitude" 98.1 "float longitude" 200 "string time" "2026-06-31T12:00Z"
"#,
        r#"
scene.pbrt:2:78: error: `2026-06-21T12:00` does not say which time it is: end it with the offset from universal time, like +02:00, or Z
 2 | … "float latitude" 48.1 "float longitude" 11.6 "string time" "2026-06-21T12:00"
   |                                                              ^^^^^^^^^^^^^^^^^^
scene.pbrt:3:19: error: parameter "latitude" must be from -90 to 90, found 98.1
 3 | LightSource "sun" "float latitude" 98.1 "float longitude" 200 "string time" "2026-06-31T12:00Z"
   |                   ^^^^^^^^^^^^^^^^
scene.pbrt:3:41: error: parameter "longitude" must be from -180 to 180, found 200
 3 | LightSource "sun" "float latitude" 98.1 "float longitude" 200 "string time" "2026-06-31T12:00Z"
   |                                         ^^^^^^^^^^^^^^^^^
scene.pbrt:3:77: error: day 31 does not exist
 3 | …" "float latitude" 98.1 "float longitude" 200 "string time" "2026-06-31T12:00Z"
   |                                                              ^^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_sun_below_the_horizon_lights_nothing() {
    expect(
        r#"WorldBegin
LightSource "sky" "string model" "clear" "vector3 sundirection" [ 1 0 -1 ]
LightSource "sun" "float latitude" 0 "float longitude" 0 "string time" "2026-03-20T00:00Z"
LightSource "sky" "string model" "overcast" "vector3 sundirection" [ 1 0 -1 ]
LightSource "sky" "string model" "bird-riordan" "vector3 sundirection" [ 0 1 -0.01 ]
"#,
        r#"
scene.pbrt:2:42: error: the sun stands below the horizon, at an elevation of -45.00 degrees
 2 | LightSource "sky" "string model" "clear" "vector3 sundirection" [ 1 0 -1 ]
   |                                          ^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:3:58: error: the sun stands below the horizon, at an elevation of -88.08 degrees
 3 | LightSource "sun" "float latitude" 0 "float longitude" 0 "string time" "2026-03-20T00:00Z"
   |                                                          ^^^^^^^^^^^^^
scene.pbrt:5:49: error: the sun stands below the horizon, at an elevation of -0.57 degrees
 5 | LightSource "sky" "string model" "bird-riordan" "vector3 sundirection" [ 0 1 -0.01 ]
   |                                                 ^^^^^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn an_amount_is_given_once_and_directions_have_a_length() {
    expect(
        r#"WorldBegin
LightSource "sky" "string model" "overcast" "float zenithluminance" 9000 "float illuminance" 20000
LightSource "sky" "string model" "overcast" "vector3 up" [ 0 0 0 ]
LightSource "sky" "string model" "overcast" "float groundreflectance" 1.2
LightSource "sun" "vector3 sundirection" [ 0 0 0 ] "float angularradius" 45
"#,
        r#"
scene.pbrt:2:45: error: the amount is stated twice: by "illuminance" and by "zenithluminance"
 2 | LightSource "sky" "string model" "overcast" "float zenithluminance" 9000 "float illuminance" 20000
   |                                             ^^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:2:74: note: the other statement
 2 | …sky" "string model" "overcast" "float zenithluminance" 9000 "float illuminance" 20000
   |                                                              ^^^^^^^^^^^^^^^^^^^
scene.pbrt:3:45: error: parameter "up" is no direction: it has no length
 3 | LightSource "sky" "string model" "overcast" "vector3 up" [ 0 0 0 ]
   |                                             ^^^^^^^^^^^^
scene.pbrt:4:45: error: parameter "groundreflectance" must be from 0 to 1, found 1.2
 4 | LightSource "sky" "string model" "overcast" "float groundreflectance" 1.2
   |                                             ^^^^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:5:19: error: parameter "sundirection" is no direction: it has no length
 5 | LightSource "sun" "vector3 sundirection" [ 0 0 0 ] "float angularradius" 45
   |                   ^^^^^^^^^^^^^^^^^^^^^^
scene.pbrt:5:52: error: parameter "angularradius" must be from 0.01 to 10, found 45
 5 | LightSource "sun" "vector3 sundirection" [ 0 0 0 ] "float angularradius" 45
   |                                                    ^^^^^^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn a_model_of_the_atmosphere_has_its_own_spectrum_and_amount() {
    expect(
        r#"WorldBegin
LightSource "sky" "string model" "bird-riordan" "vector3 sundirection" [ 0 0 1 ] "float illuminance" 5
LightSource "sky" "string model" "bird-riordan" "vector3 sundirection" [ 0 0 1 ] "float turbidity" 3
LightSource "sky" "string model" "bird-riordan"
LightSource "sky" "string model" "uniform" "float ozone" 0.3
"#,
        r#"
scene.pbrt:2:82: error: sky "bird-riordan" has a spectrum and an amount of its own
 2 | …ring model" "bird-riordan" "vector3 sundirection" [ 0 0 1 ] "float illuminance" 5
   |                                                              ^^^^^^^^^^^^^^^^^^^
  help: "float scale" is a factor on it
scene.pbrt:3:82: error: parameter "turbidity" must be from 0 to 1, found 3
 3 | …ring model" "bird-riordan" "vector3 sundirection" [ 0 0 1 ] "float turbidity" 3
   |                                                              ^^^^^^^^^^^^^^^^^
scene.pbrt:4:34: error: sky "bird-riordan" is brighter near the sun, and nothing says where it stands
 4 | LightSource "sky" "string model" "bird-riordan"
   |                                  ^^^^^^^^^^^^^^
  help: give "vector3 sundirection", or "latitude", "longitude" and "time"
scene.pbrt:5:44: error: light "sky" has no parameter "ozone"
 5 | LightSource "sky" "string model" "uniform" "float ozone" 0.3
   |                                            ^^^^^^^^^^^^^
"#,
    );
}
