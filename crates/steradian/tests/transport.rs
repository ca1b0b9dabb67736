//! Light transport against closed forms: furnaces, enclosures, simple sources, smooth interfaces.
//!
//! The film reads 1 for a luminance of 1 cd/m², and a light of scale 1 has luminance 1, so every expected
//! number below is a ratio of radiances.

mod support;

use std::f64::consts::{FRAC_PI_4, PI};
use support::{SMALL_FILM, assert_luminance, judge};

fn scene(header: &str, world: &str) -> String {
    format!("{SMALL_FILM}\n{header}\nWorldBegin\n{world}")
}

/// A camera at the origin of a closed scene.
const INSIDE: &str = r#"
LookAt 0 0 0  0.3 0.2 1  0 1 0
Camera "perspective" "float fov" 60
"#;

#[test]
fn grey_furnace_reaches_le_over_one_minus_rho() {
    for (rho, spp, detectable) in [(0.2, 64, 0.005), (0.5, 256, 0.005), (0.8, 1024, 0.01)] {
        let header = format!(
            "{INSIDE} Sampler \"independent\" \"integer pixelsamples\" {spp}
             Integrator \"path\" \"integer maxdepth\" 100000"
        );
        // The emitting sphere is seen from inside: its normals are turned inwards.
        let world = format!(
            "ReverseOrientation
             AreaLightSource \"diffuse\" \"spectrum L\" [ 300 1 900 1 ]
             Material \"diffuse\" \"spectrum reflectance\" [ 300 {rho} 900 {rho} ]
             Shape \"sphere\" \"float radius\" 2"
        );
        assert_luminance(&scene(&header, &world), 1.0 / (1.0 - rho), detectable);
    }
}

#[test]
fn grey_furnace_of_triangles_reaches_the_same_radiance() {
    let header = format!(
        "{INSIDE} Sampler \"zsobol\" \"integer pixelsamples\" 256
         Integrator \"path\" \"integer maxdepth\" 100000"
    );
    let world = r#"
        AreaLightSource "diffuse" "spectrum L" [ 300 1 900 1 ]
        Material "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ]
        Shape "trianglemesh"
            "point3 P" [ -1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
            "integer indices" [ 0 1 3 0 3 2  4 7 5 4 6 7  0 5 1 0 4 5  2 3 7 2 7 6  0 2 6 0 6 4  1 7 3 1 5 7 ]
    "#;
    assert_luminance(&scene(&header, world), 2.0, 0.005);
}

#[test]
fn white_furnace_leaves_lossless_objects_invisible() {
    // A dispersive path keeps one wavelength of four: its colour noise needs more samples,
    // as do diffuse lobes, which light samples and scattered rays share.
    let lossless = [
        (r#"Material "diffuse" "spectrum reflectance" [ 300 1 900 1 ]"#, 256),
        (r#"Material "conductor" "spectrum reflectance" [ 300 1 900 1 ]"#, 64),
        (r#"Material "dielectric" "float eta" 1.5"#, 64),
        (r#"Material "dielectric" "spectrum eta" "glass-BK7""#, 1024),
        (r#"Material "thindielectric" "float eta" 1.5"#, 64),
        (
            r#"Material "diffusetransmission" "spectrum reflectance" [ 300 0.3 900 0.3 ]
                "spectrum transmittance" [ 300 0.7 900 0.7 ]"#,
            1024,
        ),
        (r#"Material "perfectmirror""#, 64),
        (r#"Material "orennayar" "spectrum reflectance" [ 300 1 900 1 ] "float roughness" 0.8"#, 256),
        (r#"Material "dielectric" "float film.thickness" 400 "float film.eta" 1.38"#, 1024),
    ];
    for (material, spp) in lossless {
        let header = format!(
            "LookAt 0 0 -3  0 0 0  0 1 0
             Camera \"perspective\" \"float fov\" 30
             Sampler \"independent\" \"integer pixelsamples\" {spp}
             Integrator \"path\" \"integer maxdepth\" 100000"
        );
        let world =
            format!("LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]\n{material}\nShape \"sphere\"");
        assert_luminance(&scene(&header, &world), 1.0, 0.005);
    }
}

#[test]
fn white_furnace_hides_rough_metal_and_glass_whose_losses_are_given_back() {
    let finish = r#""float roughness" 1 "bool remaproughness" false "bool multiscatter" true"#;
    for material in [
        format!(r#"Material "conductor" "spectrum reflectance" [ 300 1 900 1 ] {finish}"#),
        format!(r#"Material "dielectric" "float eta" 1.5 {finish}"#),
    ] {
        let header = "LookAt 0 0 -3  0 0 0  0 1 0
             Camera \"perspective\" \"float fov\" 30
             Sampler \"independent\" \"integer pixelsamples\" 1024
             Integrator \"path\" \"integer maxdepth\" 100000";
        let world =
            format!("LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]\n{material}\nShape \"sphere\"");
        let j = judge(&scene(header, &world));
        // What is given back is tabulated: 1 % is claimed.
        assert!(4.1 * j.standard_error < 0.007, "too noisy: {j:?}");
        assert!((j.mean - 1.0).abs() < 0.01, "{material}: {j:?}");
    }
}

#[test]
fn point_light_in_a_sphere_gives_the_integrating_sphere_equation() {
    // L = Φ ρ / (4 π² R² (1 − ρ)) with Φ = 4 π I.
    for (rho, radius, spp) in [(0.5, 1.0, 256), (0.75, 2.0, 512)] {
        let intensity = PI;
        let expected = 4.0 * PI * intensity * rho / (4.0 * PI * PI * radius * radius * (1.0 - rho));
        let header = format!(
            "{INSIDE} Sampler \"zsobol\" \"integer pixelsamples\" {spp}
             Integrator \"path\" \"integer maxdepth\" 100000"
        );
        let world = format!(
            "LightSource \"point\" \"spectrum I\" [ 300 1 900 1 ] \"float scale\" {intensity}
             Material \"diffuse\" \"spectrum reflectance\" [ 300 {rho} 900 {rho} ]
             Shape \"sphere\" \"float radius\" {radius}"
        );
        assert_luminance(&scene(&header, &world), expected, 0.005);
    }
}

/// A camera that looks down on a white Lambertian patch at the origin: it reads E/π.
fn illuminated(lights: &str, spp: u32) -> String {
    let header = format!(
        "LookAt 0 0.3 0.01  0 0 0  0 0 1
         Camera \"perspective\" \"float fov\" 0.01
         Sampler \"zsobol\" \"integer pixelsamples\" {spp}
         Integrator \"path\" \"integer maxdepth\" 1"
    );
    let world = format!(
        "{lights}
         Material \"diffuse\" \"spectrum reflectance\" [ 300 1 900 1 ]
         Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ]
            \"point3 P\" [ -0.1 0 -0.1  -0.1 0 0.1  0.1 0 0.1  0.1 0 -0.1 ]"
    );
    scene(&header, &world)
}

const BLACK: &str = r#"Material "diffuse" "spectrum reflectance" [ 300 0 900 0 ]"#;
const UNIT: &str = r#""spectrum L" [ 300 1 900 1 ]"#;

#[test]
fn irradiance_of_a_point_light_falls_with_distance_and_cosine() {
    // A (20): E = I cosθ / r², here at (1, 2, 0): r² = 5, cosθ = 2/√5.
    let light = r#"LightSource "point" "spectrum I" [ 300 1 900 1 ] "point3 from" [ 1 2 0 ]"#;
    assert_luminance(&illuminated(light, 16), 2.0 / 5.0_f64.powf(1.5) / PI, 1e-3);
}

#[test]
fn irradiance_of_a_disk_on_its_axis() {
    // E = π L R²/(R² + h²), R = 1, h = 2: 0.62831853.
    let light = format!(
        "AttributeBegin {BLACK} AreaLightSource \"diffuse\" {UNIT}
         Translate 0 2 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1 AttributeEnd"
    );
    assert_luminance(&illuminated(&light, 1024), 0.628_318_53 / PI, 3e-3);
}

#[test]
fn irradiance_of_a_sphere() {
    // E = π L (R/d)² cosθ, R = 1, d = 2: 0.78539816 straight above; cosθ = 0.8 at (1.2, 1.6, 0).
    for (center, expected) in [("0 2 0", FRAC_PI_4), ("1.2 1.6 0", FRAC_PI_4 * 0.8)] {
        let light = format!(
            "AttributeBegin {BLACK} AreaLightSource \"diffuse\" {UNIT}
             Translate {center} Shape \"sphere\" AttributeEnd"
        );
        assert_luminance(&illuminated(&light, 1024), expected / PI, 3e-3);
    }
}

#[test]
fn irradiance_of_a_square() {
    // Form factor of a centred unit square at distance 1: 0.23945647046, E = π L F.
    let triangles = r#"Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ]
        "point3 P" [ -0.5 1 -0.5  0.5 1 -0.5  0.5 1 0.5  -0.5 1 0.5 ]"#;
    let patch = r#"Shape "bilinearmesh" "point3 P" [ -0.5 1 -0.5  0.5 1 -0.5  -0.5 1 0.5  0.5 1 0.5 ]"#;
    for shape in [triangles, patch] {
        let light = format!("AttributeBegin {BLACK} AreaLightSource \"diffuse\" {UNIT} {shape} AttributeEnd");
        assert_luminance(&illuminated(&light, 1024), 0.239_456_470_46, 3e-3);
    }
}

#[test]
fn irradiance_of_the_sky() {
    // A (24): a uniform hemisphere gives E = π L; the picture shows E/π = L.
    let light = format!("LightSource \"infinite\" {UNIT}");
    assert_luminance(&illuminated(&light, 256), 1.0, 5e-3);
}

#[test]
fn irradiance_of_a_distant_light() {
    // A (35): L = ρ/π E cosθ; the light comes from 60° off the normal.
    let light = r#"LightSource "distant" "spectrum L" [ 300 1 900 1 ] "point3 from" [ 1.7320508 1 0 ] "point3 to" [ 0 0 0 ]"#;
    assert_luminance(&illuminated(light, 16), 0.5 / PI, 1e-3);
}

/// An orthographic camera that sees a horizontal plane under `degrees` from its normal, black below, uniform sky above.
fn interface(material: &str, degrees: f64) -> String {
    let (s, c) = degrees.to_radians().sin_cos();
    let header = format!(
        "LookAt {} {} 0  0 0 0  0 0 1
         Camera \"orthographic\" \"float screenwindow\" [ -0.001 0.001 -0.001 0.001 ]
         Sampler \"independent\" \"integer pixelsamples\" 256
         Integrator \"path\" \"integer maxdepth\" 3",
        5.0 * s,
        5.0 * c
    );
    let quad = |y: f64, size: f64| {
        format!(
            "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ]
             \"point3 P\" [ -{size} {y} -{size}  -{size} {y} {size}  {size} {y} {size}  {size} {y} -{size} ]"
        )
    };
    let world = format!(
        "LightSource \"infinite\" {UNIT}
         {BLACK} {}
         {material} {}",
        quad(-1.0, 1e5),
        quad(0.0, 10.0)
    );
    scene(&header, &world)
}

#[test]
fn smooth_glass_reflects_by_fresnel() {
    // B (2.12), n = 1.5; the golden numbers are computed from rs and rp in f64.
    for degrees in [0.0, 30.0, 56.309_93, 75.0, 85.0_f64] {
        let (s, c) = degrees.to_radians().sin_cos();
        let ct = (1.0 - (s / 1.5) * (s / 1.5)).sqrt();
        let rs = (c - 1.5 * ct) / (c + 1.5 * ct);
        let rp = (1.5 * c - ct) / (1.5 * c + ct);
        let expected = 0.5 * (rs * rs + rp * rp);
        let text = interface(r#"Material "dielectric" "float eta" 1.5"#, degrees);
        // Reflection or transmission is a coin toss per sample: 16 · 64 · 256 tosses.
        assert_luminance(&text, expected, 0.06);
    }
}

#[test]
fn a_mirror_reflects_by_complex_fresnel() {
    // Gold-like N = 0.43 + 2.455 i: 0.78691576 at 0°, (0.892820 + 0.683443)/2 at 60°.
    let material =
        r#"Material "conductor" "spectrum eta" [ 300 0.43 900 0.43 ] "spectrum k" [ 300 2.455 900 2.455 ]"#;
    for (degrees, expected) in [(0.0, 0.786_915_76), (60.0, 0.788_131_5)] {
        assert_luminance(&interface(material, degrees), expected, 1e-3);
    }
}

#[test]
fn a_thin_sheet_transmits_the_series_of_internal_reflections() {
    // n = 1.5 without absorption, summed for each polarisation: 2r/(1 + r) and then the mean (Stokes 1862).
    for (degrees, expected) in [(0.0_f64, 0.076_923_1), (60.0, 0.151_872), (75.0, 0.381_851)] {
        assert_luminance(&interface(r#"Material "thindielectric" "float eta" 1.5"#, degrees), expected, 0.06);
    }
}

#[test]
fn absolute_radiance_gives_absolute_luminance() {
    // 0.01 W·m⁻²·sr⁻¹·nm⁻¹ at every wavelength: Y = 683.002 · 0.01 · ∫ȳ = 6.83002 · 106.856895 cd/m².
    let world = r#"LightSource "infinite" "spectrum L" [ 300 0.01 900 0.01 ] "string unit" "radiance""#;
    let header = format!("{INSIDE} Sampler \"independent\" \"integer pixelsamples\" 16 Integrator \"path\"");
    assert_luminance(&scene(&header, world), 6.830_02 * 106.856_895, 2e-2);
}
