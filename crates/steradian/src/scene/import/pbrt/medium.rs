//! Medium classes.

use super::args::Args;
use super::spectrum::Role;
use crate::color::ColorSpaceKind;
use crate::scene::desc::{MediumCoefficients, MediumEmission, MediumKind, SpectrumDesc, SpectrumValue};
use crate::scene::text::Text;

const CLASSES: &[&str] = &["cloud", "homogeneous", "nanovdb", "rgbgrid", "uniformgrid"];
const V3_CLASSES: &[&str] = &["heterogeneous"];

/// Reads the parameters of a medium class; `None` when it is unknown (and reported).
pub(super) fn medium(class: &Text, args: &mut Args<'_>) -> Option<MediumKind> {
    match class.value.as_str() {
        "homogeneous" => Some(homogeneous(args)),
        name if CLASSES.contains(&name) => {
            args.unsupported_class("medium", class);
            Some(MediumKind::Unsupported { kind: name.to_owned() })
        }
        _ => {
            args.unknown_class("medium", class, CLASSES, V3_CLASSES);
            None
        }
    }
}

fn homogeneous(args: &mut Args<'_>) -> MediumKind {
    let preset = args.text("preset").filter(|t| !t.value.is_empty());
    let both = preset.is_some() && (args.has("sigma_a") || args.has("sigma_s"));
    let rgb = |args: &Args<'_>, rgb| {
        let value = SpectrumValue::Rgb { rgb, color_space: ColorSpaceKind::Srgb };
        SpectrumDesc { value, span: args.span }
    };
    let sigma_a = args.spectrum_opt("sigma_a", Role::Unbounded);
    let sigma_s = args.spectrum_opt("sigma_s", Role::Unbounded);
    if both && let Some(preset) = &preset {
        args.error(preset.span, "give \"preset\", or \"sigma_a\" and \"sigma_s\", not both");
    }
    let coefficients = match preset {
        Some(p) => MediumCoefficients::Preset(p.value),
        None => MediumCoefficients::Values {
            sigma_a: sigma_a.unwrap_or_else(|| rgb(args, [0.0011, 0.0024, 0.014])),
            sigma_s: sigma_s.unwrap_or_else(|| rgb(args, [2.55, 3.21, 3.77])),
        },
    };
    let le_scale = args.float("Lescale", 1.0);
    let spectrum = args.spectrum_opt("Le", Role::Illuminant);
    MediumKind::Homogeneous {
        coefficients,
        scale: args.non_negative("scale", 1.0),
        g: args.float_where("g", 0.0, |v| v.abs() < 1.0, "between −1 and 1"),
        emission: spectrum.map(|spectrum| MediumEmission { spectrum, scale: le_scale }),
    }
}
