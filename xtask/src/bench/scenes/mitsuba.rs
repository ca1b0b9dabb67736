//! A scene as Mitsuba 3 XML.

use super::description::{Color, METAL_NM, Material, Scene};
use std::fmt::Write as _;

pub(super) fn text(scene: &Scene) -> String {
    let mut out = String::new();
    // Writing into a string cannot fail.
    let _ = describe(scene, &mut out);
    out
}

fn describe(scene: &Scene, out: &mut String) -> std::fmt::Result {
    let view = &scene.view;
    writeln!(out, "<scene version=\"3.0.0\">\n<default name=\"spp\" value=\"64\"/>")?;
    writeln!(
        out,
        "<integrator type=\"path\"><integer name=\"max_depth\" value=\"{}\"/></integrator>",
        view.max_depth
    )?;
    writeln!(
        out,
        "<sensor type=\"perspective\"><string name=\"fov_axis\" value=\"smaller\"/><float name=\"fov\" value=\"{}\"/>\n\
         <transform name=\"to_world\"><lookat origin=\"{}\" target=\"{}\" up=\"0, 1, 0\"/></transform>\n\
         <sampler type=\"independent\"><integer name=\"sample_count\" value=\"$spp\"/></sampler>\n\
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"{}\"/><integer name=\"height\" value=\"{}\"/>\n\
         <rfilter type=\"box\"/></film></sensor>",
        view.fov,
        list(&view.eye),
        list(&view.target),
        view.width,
        view.height
    )?;
    if let Some(environment) = &scene.environment {
        writeln!(
            out,
            "<emitter type=\"envmap\"><string name=\"filename\" value=\"{}\"/></emitter>",
            environment.latlong
        )?;
    }
    for lamp in &scene.lamps {
        writeln!(
            out,
            "<shape type=\"sphere\"><point name=\"center\" value=\"{}\"/><float name=\"radius\" value=\"{}\"/>\n\
             <emitter type=\"area\"><rgb name=\"radiance\" value=\"{}\"/></emitter></shape>",
            list(&lamp.center),
            lamp.radius,
            list(&lamp.radiance)
        )?;
    }
    for object in &scene.objects {
        writeln!(out, "<shape type=\"ply\"><string name=\"filename\" value=\"{}.ply\"/>", object.name)?;
        // Rows are counted from the top there.
        writeln!(out, "<boolean name=\"flip_tex_coords\" value=\"true\"/>")?;
        if !object.mesh.is_smooth() {
            writeln!(out, "<boolean name=\"face_normals\" value=\"true\"/>")?;
        }
        if let Some(radiance) = &object.emission {
            writeln!(
                out,
                "<emitter type=\"area\"><rgb name=\"radiance\" value=\"{}\"/></emitter>",
                list(radiance)
            )?;
        }
        writeln!(out, "{}\n</shape>", material(&object.material))?;
    }
    writeln!(out, "</scene>")
}

fn material(material: &Material) -> String {
    let color = |name: &str, color: &Color| match color {
        Color::Rgb(rgb) => format!("<rgb name=\"{name}\" value=\"{}\"/>", list(rgb)),
        Color::Picture(file) => format!(
            "<texture type=\"bitmap\" name=\"{name}\"><string name=\"filename\" value=\"{file}\"/></texture>"
        ),
    };
    let rough = |smooth: &str, alpha: f32| match alpha {
        0.0 => format!("<bsdf type=\"{smooth}\">"),
        _ => format!(
            "<bsdf type=\"rough{smooth}\"><string name=\"distribution\" value=\"ggx\"/>\
             <float name=\"alpha\" value=\"{alpha}\"/>"
        ),
    };
    match material {
        Material::Diffuse(c) => format!("<bsdf type=\"diffuse\">{}</bsdf>", color("reflectance", c)),
        Material::Sheet(c) => format!(
            "<bsdf type=\"twosided\"><bsdf type=\"diffuse\">{}</bsdf></bsdf>",
            color("reflectance", c)
        ),
        Material::Coated { base, alpha } => format!(
            "{}<float name=\"int_ior\" value=\"1.5\"/><float name=\"ext_ior\" value=\"1\"/>\
             <boolean name=\"nonlinear\" value=\"true\"/>{}</bsdf>",
            rough("plastic", *alpha),
            color("diffuse_reflectance", base)
        ),
        Material::Dielectric { eta, alpha } => format!(
            "{}<float name=\"int_ior\" value=\"{eta}\"/><float name=\"ext_ior\" value=\"1\"/></bsdf>",
            rough("dielectric", *alpha)
        ),
        Material::Conductor { eta, k, alpha } => {
            let spectrum = |name: &str, values: &[f32; 5]| {
                let pairs: Vec<String> =
                    METAL_NM.iter().zip(values).map(|(nm, value)| format!("{nm}:{value}")).collect();
                format!("<spectrum name=\"{name}\" value=\"{}\"/>", pairs.join(", "))
            };
            format!("{}{}{}</bsdf>", rough("conductor", *alpha), spectrum("eta", eta), spectrum("k", k))
        }
    }
}

fn list(values: &[f32]) -> String {
    values.iter().map(f32::to_string).collect::<Vec<_>>().join(", ")
}
