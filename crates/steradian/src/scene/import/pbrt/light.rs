//! Light classes.

use super::args::Args;
use crate::math::Point;
use crate::scene::desc::{AreaLightDesc, AreaRadiance, FileRef, LightKind, Normalization};
use crate::scene::source::Span;
use crate::scene::text::Text;

const CLASSES: &[&str] = &["point", "spot", "goniometric", "projection", "distant", "infinite"];
const V3_CLASSES: &[&str] = &["exinfinite"];

/// Reads the parameters of a light class; `None` when the class or something needed is missing (and reported).
pub(super) fn light(class: &Text, args: &mut Args<'_>) -> Option<LightKind> {
    match class.value.as_str() {
        "point" => Some(LightKind::Point {
            intensity: args.light_spectrum("I"),
            from: args.point("from", Point::ORIGIN),
            power: amount(args, "power"),
        }),
        "spot" => {
            let Aim { from, to } = aim(args)?;
            Some(LightKind::Spot {
                intensity: args.light_spectrum("I"),
                from,
                to,
                cone_angle: args.float_where("coneangle", 30.0, |v| v > 0.0 && v <= 180.0, "in (0, 180]"),
                cone_delta_angle: args.non_negative("conedeltaangle", 5.0),
                power: amount(args, "power"),
            })
        }
        "goniometric" => {
            let intensity = args.light_spectrum("I");
            let power = amount(args, "power");
            let file = needed_file(args)?;
            Some(LightKind::Goniometric { intensity, file, power })
        }
        "projection" => {
            let fov = args.float_where("fov", 90.0, |v| v > 0.0 && v < 180.0, "between 0 and 180");
            let power = amount(args, "power");
            let file = needed_file(args)?;
            Some(LightKind::Projection { file, fov, power })
        }
        "distant" => {
            let Aim { from, to } = aim(args)?;
            Some(LightKind::Distant {
                irradiance: args.light_spectrum("L"),
                from,
                to,
                illuminance: amount(args, "illuminance"),
            })
        }
        "infinite" => infinite(args),
        _ => {
            args.unknown_class("light", class, CLASSES, V3_CLASSES);
            None
        }
    }
}

/// The unit that a class's spectrum may be stated in, when it is absolute.
fn unit_of(class: &str) -> &'static str {
    match class {
        "point" | "spot" | "goniometric" | "projection" => "intensity",
        "distant" => "irradiance",
        _ => "radiance",
    }
}

/// `"string unit"`, our extension: the spectrum is absolute.
pub(super) fn normalization(class: &Text, args: &mut Args<'_>) -> Normalization {
    let Some(unit) = args.text("unit") else { return Normalization::Photometric };
    let expected = unit_of(&class.value);
    if unit.value != expected {
        let message = format!("the unit of this light can only be \"{expected}\", found \"{}\"", unit.value);
        args.error(unit.span, message);
    }
    Normalization::Absolute
}

/// Reads an `AreaLightSource`; `None` when the class is unknown (and reported).
pub(super) fn area_light(class: &Text, directive: Span, args: &mut Args<'_>) -> Option<AreaLightDesc> {
    if class.value != "diffuse" {
        args.unknown_class("area light", class, &["diffuse"], &["area"]);
        return None;
    }
    let both = args.has("L") && args.has("filename");
    let span = args.span_of("filename");
    let spectrum = args.light_spectrum("L");
    let file = args.file("filename");
    if both {
        args.error(span, "give \"L\" or \"filename\", not both");
    }
    Some(AreaLightDesc {
        radiance: file.map_or(AreaRadiance::Uniform(spectrum), AreaRadiance::Image),
        scale: args.float("scale", 1.0),
        normalization: normalization(class, args),
        two_sided: args.bool("twosided", false),
        power: amount(args, "power"),
        span: directive,
    })
}

/// A photometric amount that overrides the spectrum's; pbrt takes anything not positive for absent.
fn amount(args: &mut Args<'_>, name: &'static str) -> Option<f32> {
    let span = args.span_of(name);
    let v = args.float_opt(name)?;
    if v > 0.0 {
        return Some(v);
    }
    args.ctx.diagnostics.notice(span, format!("\"{name}\" is ignored because it is not positive"));
    None
}

struct Aim {
    from: Point,
    to: Point,
}

fn aim(args: &mut Args<'_>) -> Option<Aim> {
    let from = args.point("from", Point::ORIGIN);
    let to = args.point("to", Point::new(0.0, 0.0, 1.0));
    if from == to {
        let span = args.span_of("to");
        args.error(span, "\"from\" and \"to\" must differ");
        return None;
    }
    Some(Aim { from, to })
}

fn needed_file(args: &mut Args<'_>) -> Option<FileRef> {
    let file = args.file("filename");
    if file.is_none() {
        args.missing("filename");
    }
    file
}

fn infinite(args: &mut Args<'_>) -> Option<LightKind> {
    let portal = args.has("portal").then(|| args.span_of("portal"));
    args.points("portal");
    if let Some(span) = portal {
        args.ctx.unsupported(span, "portals of infinite lights");
    }
    let both = args.has("L") && args.has("filename");
    let span = args.span_of("filename");
    let radiance = args.light_spectrum("L");
    let file = args.file("filename");
    if both {
        args.error(span, "give \"L\" or \"filename\", not both");
    }
    let illuminance = amount(args, "illuminance");
    Some(match file {
        Some(file) => LightKind::ImageInfinite { file, illuminance },
        None => LightKind::UniformInfinite { radiance, illuminance },
    })
}
