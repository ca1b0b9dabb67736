//! Skies and the sun in scenes: what a plain and a camera see of them.

mod support;

use std::f64::consts::PI;
use steradian::light::{Atmosphere, Daylight};
use steradian::spectrum::Spectrum;
use steradian::units::LUMENS_PER_WATT;
use support::{SMALL_FILM, assert_luminance};

/// A white plain seen from above; under a sky of horizontal illuminance E it shows ρE/π.
fn plain(light: &str) -> String {
    format!(
        "{SMALL_FILM}
        LookAt 0 0 5  0 0 0  0 1 0
        Camera \"perspective\" \"float fov\" 20
        Sampler \"independent\" \"integer pixelsamples\" 256
        WorldBegin
        {light}
        Material \"diffuse\" \"spectrum reflectance\" [ 300 0.5 900 0.5 ]
        Shape \"disk\" \"float radius\" 100"
    )
}

#[test]
fn a_plain_under_a_sky_shows_its_illuminance() {
    let shown = |lux: f64| 0.5 * lux / PI;
    for (light, lux) in [
        (r#"LightSource "sky" "string model" "uniform" "float zenithluminance" 3"#, 3.0 * PI),
        (r#"LightSource "sky" "string model" "overcast" "float zenithluminance" 9"#, 7.0 * PI),
        (r#"LightSource "sky" "string model" "overcast" "float illuminance" 10 "float scale" 0.5"#, 5.0),
        (
            r#"LightSource "sky" "string model" "cie-13" "float illuminance" 10
               "vector3 sundirection" [ 1 0.3 0.5 ] "blackbody L" 9000"#,
            10.0,
        ),
        // The ground is below the plain.
        (
            r#"LightSource "sky" "string model" "cie-1" "float illuminance" 4 "float groundreflectance" 0.6"#,
            4.0,
        ),
    ] {
        assert_luminance(&plain(light), shown(lux), 0.01);
    }
}

#[test]
fn a_plain_in_the_sun_shows_its_illuminance_times_the_cosine() {
    let sun = r#"LightSource "sun" "float illuminance" 8 "vector3 sundirection" [ 3 0 4 ]"#;
    assert_luminance(&plain(sun), 0.5 * 8.0 * 0.8 / PI, 0.01);
    // A mirror on the ground shows the disk itself: E/(π sin²α).
    let mirror = format!(
        "{SMALL_FILM}
        LookAt 0 0 5  0 0 0  0 1 0
        Camera \"perspective\" \"float fov\" 0.1
        Sampler \"independent\" \"integer pixelsamples\" 64
        WorldBegin
        LightSource \"sun\" \"float illuminance\" 0.001 \"vector3 sundirection\" [ 0 0 1 ]
        Material \"perfectmirror\"
        Shape \"disk\" \"float radius\" 100"
    );
    assert_luminance(&mirror, 0.001 / (PI * 0.2666_f64.to_radians().sin().powi(2)), 0.01);
}

#[test]
fn a_cloudless_day_gives_a_plain_what_its_atmosphere_lets_through() {
    let atmosphere = Atmosphere { turbidity: 0.2, ground_reflectance: 0.1, ..Atmosphere::default() };
    let elevation = 0.8_f64.asin().to_degrees();
    let spectra = atmosphere.spectra(&Daylight { elevation, distance: 1.0 });
    let shown = |e: &Spectrum| 0.5 * f64::from(LUMENS_PER_WATT * e.photometric_integral()) / PI;
    let day = r#"LightSource "sky" "string model" "bird-riordan" "vector3 sundirection" [ 0 -3 4 ]
        "float turbidity" 0.2 "float groundreflectance" 0.1"#;
    assert_luminance(&plain(day), shown(&spectra.global_horizontal), 0.01);
    assert_luminance(&plain(&format!("{day} \"bool sun\" false")), shown(&spectra.diffuse_horizontal), 0.01);
    // Below the horizon, what the ground returns of both.
    let below =
        format!("{} \"float scale\" 0.01", day.replace("[ 0 -3 4 ]", "[ 0 4 -3 ] \"vector3 up\" [ 0 1 0 ]"));
    assert_luminance(&looking(&below, false, "0 -1 0"), 0.01 * 0.2 * shown(&spectra.global_horizontal), 0.01);
}

/// A camera that looks at a spot of the sky through nothing, up being the scene's y.
fn looking(light: &str, mirrored: bool, towards: &str) -> String {
    let mirror = if mirrored { "Scale -1 1 1" } else { "" };
    format!(
        "{SMALL_FILM}
        {mirror}
        LookAt 0 0 0  {towards}  0 1 0.01
        Camera \"perspective\" \"float fov\" 0.1
        Sampler \"independent\" \"integer pixelsamples\" 64
        WorldBegin
        {light}"
    )
}

#[test]
fn the_sun_stands_where_place_and_time_put_it() {
    // On the equator at the March equinox, 09:07 UT on the meridian of Greenwich: halfway up in the east. With +z the north
    // of a scene, east is +x in pbrt's pictures and -x in mirrored ones.
    let sun = r#"LightSource "sun" "vector3 up" [ 0 1 0 ] "float illuminance" 0.001 "float angularradius" 1
        "float latitude" 0 "float longitude" 0 "string time" "2026-03-20T09:07:25Z""#;
    let disk = 0.001 / (PI * 1_f64.to_radians().sin().powi(2));
    assert_luminance(&looking(sun, false, "1 1 0"), disk, 0.01);
    assert_luminance(&looking(sun, true, "-1 1 0"), disk, 0.01);
    // A scene whose +z looks east has the morning sun ahead.
    let turned = format!("{sun} \"float north\" 90");
    assert_luminance(&looking(&turned, false, "0 1 1"), disk, 0.01);
    assert_luminance(&looking(&turned, true, "0 1 1"), disk, 0.01);
}

#[test]
fn the_zenith_has_the_luminance_that_is_stated_whatever_up_is() {
    let sky = r#"Rotate 90 1 0 0
        LightSource "sky" "string model" "clear" "float zenithluminance" 3 "vector3 up" [ 0 0 -1 ]
            "vector3 sundirection" [ 1 0 -1 ]"#;
    // Turned by the transform in force, -z is +y.
    assert_luminance(&looking(sky, false, "0 1 0"), 3.0, 0.01);
}
