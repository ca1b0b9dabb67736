//! A scene as pbrt-v4 text.

use super::description::{Color, METAL_NM, Material, Scene};
use std::fmt::Write as _;

pub(super) fn text(scene: &Scene) -> String {
    let view = &scene.view;
    let mut out = String::new();
    // Writing into a string cannot fail.
    let _ = describe(scene, view.max_depth - 1, &mut out);
    out
}

fn describe(scene: &Scene, bounces: u32, out: &mut String) -> std::fmt::Result {
    let view = &scene.view;
    // The format's cameras mirror a right-handed world.
    writeln!(out, "Scale -1 1 1\nLookAt {}  {}  0 1 0", list(&view.eye), list(&view.target))?;
    writeln!(out, "Camera \"perspective\" \"float fov\" {}", view.fov)?;
    writeln!(
        out,
        "Film \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {} \"string filename\" \"scene.exr\"",
        view.width, view.height
    )?;
    writeln!(out, "PixelFilter \"box\"\nSampler \"independent\" \"integer pixelsamples\" 64")?;
    writeln!(out, "Integrator \"path\" \"integer maxdepth\" {bounces}\nWorldBegin")?;
    if let Some(environment) = &scene.environment {
        writeln!(out, "LightSource \"infinite\" \"string filename\" \"{}\"", environment.square)?;
    }
    for (name, _) in scene.pictures.iter().filter(|(name, _)| name.ends_with(".png")) {
        writeln!(out, "Texture \"{name}\" \"spectrum\" \"imagemap\" \"string filename\" \"{name}\"")?;
    }
    for lamp in &scene.lamps {
        writeln!(
            out,
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] AreaLightSource \"diffuse\" \"rgb L\" [ {} ]\n\
             Translate {} Shape \"sphere\" \"float radius\" {} AttributeEnd",
            list(&lamp.radiance),
            list(&lamp.center),
            lamp.radius
        )?;
    }
    for object in &scene.objects {
        writeln!(out, "AttributeBegin\n{}", material(&object.material))?;
        if let Some(radiance) = &object.emission {
            writeln!(out, "AreaLightSource \"diffuse\" \"rgb L\" [ {} ]", list(radiance))?;
        }
        writeln!(out, "Shape \"plymesh\" \"string filename\" \"{}.ply\"\nAttributeEnd", object.name)?;
    }
    Ok(())
}

fn material(material: &Material) -> String {
    let color = |color: &Color| match color {
        Color::Rgb(rgb) => format!("\"rgb reflectance\" [ {} ]", list(rgb)),
        Color::Picture(name) => format!("\"texture reflectance\" \"{name}\""),
    };
    let rough = |alpha| format!("\"float roughness\" {alpha} \"bool remaproughness\" false");
    match material {
        Material::Diffuse(c) | Material::Sheet(c) => format!("Material \"diffuse\" {}", color(c)),
        // Nothing is absorbed between coat and base, and no order of reflection is left out.
        Material::Coated { base, alpha } => format!(
            "Material \"coateddiffuse\" {} {} \"float thickness\" 1e-6 \"integer maxdepth\" 100",
            color(base),
            rough(alpha)
        ),
        Material::Dielectric { eta, alpha } => {
            format!("Material \"dielectric\" \"float eta\" {eta} {}", rough(alpha))
        }
        Material::Conductor { eta, k, alpha } => {
            let spectrum = |values: &[f32; 5]| {
                let pairs: Vec<String> =
                    METAL_NM.iter().zip(values).map(|(nm, value)| format!("{nm} {value}")).collect();
                pairs.join(" ")
            };
            format!(
                "Material \"conductor\" \"spectrum eta\" [ {} ] \"spectrum k\" [ {} ] {}",
                spectrum(eta),
                spectrum(k),
                rough(alpha)
            )
        }
    }
}

fn list(values: &[f32]) -> String {
    values.iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}
