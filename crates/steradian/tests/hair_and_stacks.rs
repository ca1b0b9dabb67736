//! Hair and stacks of layers in whole scenes.

mod support;

use support::{SMALL_FILM, assert_luminance};

/// A scene in a uniform environment of radiance 1, seen by a narrow camera.
fn furnace(objects: &str, spp: u32) -> String {
    format!(
        "{SMALL_FILM}
         LookAt 0 0 -3  0 0 0  0 1 0
         Camera \"perspective\" \"float fov\" 30
         Sampler \"independent\" \"integer pixelsamples\" {spp}
         Integrator \"path\" \"integer maxdepth\" 100000
         WorldBegin
         LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]
         {objects}"
    )
}

#[test]
fn white_hair_vanishes_in_a_uniform_environment() {
    // The hair fills the view; light that passes it meets it again or leaves.
    for profile in ["flat", "cylinder"] {
        let hair = format!(
            "Material \"hair\" \"rgb sigma_a\" [ 0 0 0 ] \"float beta_m\" 0.4 \"float beta_n\" 0.4
             Shape \"curve\" \"string type\" \"{profile}\" \"float width\" 1.5
                \"point3 P\" [ -3 0 0  -1 0.1 0  1 -0.1 0  3 0 0 ]"
        );
        assert_luminance(&furnace(&hair, 256), 1.0, 0.01);
    }
}

#[test]
fn lossless_stacks_vanish_in_a_uniform_environment() {
    for material in [
        r#"Material "stack" "float thickness" [ 1e-3 2e-3 1e-3 ] "float eta" [ 1.5 1.2 1.8 ]"#,
        r#"Material "stack" "float thickness" [ 1e-3 2e-3 ] "float eta" [ 1.5 1.7 ] "float below" 1.33"#,
        r#"Material "stack" "float thickness" [ 1e-3 2e-3 ] "spectrum eta" [ "glass-BK7" "glass-SF11" ]"#,
        r#"Material "stack" "float thickness" 1e-3 "string base" "diffuse"
            "spectrum reflectance" [ 300 1 900 1 ]"#,
    ] {
        let sphere = format!("{material}\nShape \"sphere\"");
        assert_luminance(&furnace(&sphere, 256), 1.0, 0.005);
    }
}

#[test]
fn absorbing_pane_before_a_light_shows_its_transmittance() {
    // n = 1.5, absorption times thickness 0.1, seen straight on: T = 0.834992, and 0.070221 of what lies behind the camera.
    let pane = r#"
        Material "stack" "float thickness" 2e-3 "float absorption" 50
        Shape "bilinearmesh" "point3 P" [ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]"#;
    let narrow = furnace(pane, 256).replace("\"float fov\" 30", "\"float fov\" 1");
    assert_luminance(&narrow, 0.834_992 + 0.070_221, 0.001);
}
