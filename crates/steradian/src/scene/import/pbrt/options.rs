//! The `Option` directive.

use crate::scene::desc::{OptionsDesc, RenderingSpace};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::text::{Param, Values};

const NAMES: &[&str] = &[
    "disablepixeljitter",
    "disabletexturefiltering",
    "disablewavelengthjitter",
    "displacementedgescale",
    "forcediffuse",
    "metersperunit",
    "msereferenceimage",
    "msereferenceout",
    "pixelstats",
    "rendercoordsys",
    "seed",
    "wavefront",
];

/// Applies one `Option` directive; what is wrong with it goes to `diagnostics`.
pub(super) fn set_option(options: &mut OptionsDesc, param: &Param, diagnostics: &mut Diagnostics) {
    let name: String =
        param.name.chars().filter(|c| !matches!(c, '_' | '-')).collect::<String>().to_lowercase();
    let expected = match name.as_str() {
        "disablepixeljitter" => set_bool(&mut options.disable_pixel_jitter, param),
        "disabletexturefiltering" => set_bool(&mut options.disable_texture_filtering, param),
        "disablewavelengthjitter" => set_bool(&mut options.disable_wavelength_jitter, param),
        "forcediffuse" => set_bool(&mut options.force_diffuse, param),
        "displacementedgescale" => set_positive(&mut options.displacement_edge_scale, param),
        "metersperunit" => set_positive(&mut options.meters_per_unit, param),
        "seed" => match &param.values {
            Values::Integers(v) if v.len() == 1 => {
                options.seed = v[0];
                None
            }
            _ => Some("one integer"),
        },
        "rendercoordsys" => set_space(&mut options.rendering_space, param),
        "msereferenceimage" | "msereferenceout" | "pixelstats" | "wavefront" => {
            diagnostics.notice(param.span, format!("option \"{name}\" is ignored"));
            None
        }
        _ => {
            let d = Diagnostic::error(param.span, format!("unknown option \"{}\"", param.name));
            diagnostics.push(d.with_nearest(&name, NAMES.iter().copied()));
            None
        }
    };
    if let Some(expected) = expected {
        diagnostics.error(param.value_span, format!("option \"{}\" takes {expected}", param.name));
    }
}

fn set_bool(target: &mut bool, param: &Param) -> Option<&'static str> {
    match &param.values {
        Values::Bools(v) if v.len() == 1 => {
            *target = v[0];
            None
        }
        _ => Some("true or false"),
    }
}

fn set_positive(target: &mut f32, param: &Param) -> Option<&'static str> {
    let v = match &param.values {
        Values::Numbers(v) if v.len() == 1 => v[0],
        Values::Integers(v) if v.len() == 1 => v[0] as f32,
        _ => 0.0,
    };
    if v > 0.0 {
        *target = v;
        return None;
    }
    Some("one positive number")
}

fn set_space(target: &mut RenderingSpace, param: &Param) -> Option<&'static str> {
    let word = match &param.values {
        Values::Texts(v) if v.len() == 1 => v[0].value.as_str(),
        _ => "",
    };
    *target = match word {
        "camera" => RenderingSpace::Camera,
        "cameraworld" => RenderingSpace::CameraWorld,
        "world" => RenderingSpace::World,
        _ => return Some("\"camera\", \"cameraworld\" or \"world\""),
    };
    None
}
