//! Light classes.

use super::args::Args;
use super::sky;
use crate::light::Total;
use crate::light::photometric::Interpolation;
use crate::math::Point;
use crate::scene::desc::{AreaLightDesc, AreaRadiance, FileRef, LightKind, Normalization, OpeningDesc};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::source::Span;
use crate::scene::text::Text;

const CLASSES: &[&str] =
    &["point", "spot", "goniometric", "projection", "photometric", "distant", "infinite", "sky", "sun"];
const V3_CLASSES: &[&str] = &["exinfinite"];

/// Reads the parameters of a light class; `None` when the class or something needed is missing (and reported).
pub(super) fn light(class: &Text, args: &mut Args<'_>) -> Option<LightKind> {
    match class.value.as_str() {
        "point" => Some(LightKind::Point {
            intensity: args.light_spectrum("I"),
            from: args.point("from", Point::ORIGIN),
        }),
        "spot" => {
            let Aim { from, to } = aim(args)?;
            Some(LightKind::Spot {
                intensity: args.light_spectrum("I"),
                from,
                to,
                cone_angle: args.float_where("coneangle", 30.0, |v| v > 0.0 && v <= 180.0, "in (0, 180]"),
                cone_delta_angle: args.non_negative("conedeltaangle", 5.0),
            })
        }
        "goniometric" => {
            let intensity = args.light_spectrum("I");
            let file = needed_file(args)?;
            Some(LightKind::Goniometric { intensity, file })
        }
        "projection" => {
            let fov = args.float_where("fov", 90.0, |v| v > 0.0 && v < 180.0, "between 0 and 180");
            let file = needed_file(args)?;
            Some(LightKind::Projection { file, fov })
        }
        "photometric" => photometric(args),
        "distant" => {
            let Aim { from, to } = aim(args)?;
            Some(LightKind::Distant { irradiance: args.light_spectrum("L"), from, to })
        }
        "infinite" => infinite(args),
        "sky" => sky::sky(args),
        "sun" => sky::sun(args),
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
        "distant" | "sun" => "irradiance",
        _ => "radiance",
    }
}

/// `"string unit"`, our extension: the spectrum is absolute.
pub(super) fn normalization(class: &Text, args: &mut Args<'_>) -> Normalization {
    let Some(unit) = args.text("unit") else { return Normalization::Photometric };
    if class.value == "photometric" {
        args.error(unit.span, "the file of a photometric light states candela; its spectrum is a shape");
        return Normalization::Photometric;
    }
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
        total: total(class, args),
        span: directive,
    })
}

/// A parameter that states an amount: its name, and what the number is.
type AmountParameter = (&'static str, fn(f32) -> Total);

/// The ways to state how much a light of a class emits [lm, W, cd; lx, W·m⁻², cd·m⁻²].
fn amounts_of(class: &str) -> &'static [AmountParameter] {
    match class {
        "distant" => &[("illuminance", Total::Luminous), ("irradiance", Total::Radiant)],
        "infinite" => &[
            ("illuminance", Total::Luminous),
            ("irradiance", Total::Radiant),
            ("luminance", Total::Directional),
        ],
        "sky" => &[
            ("illuminance", Total::Luminous),
            ("irradiance", Total::Radiant),
            ("zenithluminance", Total::Directional),
        ],
        "sun" => &[("illuminance", Total::Luminous), ("irradiance", Total::Radiant)],
        "diffuse" => {
            &[("power", Total::Luminous), ("watts", Total::Radiant), ("luminance", Total::Directional)]
        }
        "photometric" => &[
            ("flux", Total::Luminous),
            ("power", Total::Luminous),
            ("watts", Total::Radiant),
            ("intensity", Total::Directional),
        ],
        _ => &[("power", Total::Luminous), ("watts", Total::Radiant), ("intensity", Total::Directional)],
    }
}

/// The amount that a light is scaled to; more than one is an error.
pub(super) fn total(class: &Text, args: &mut Args<'_>) -> Option<Total> {
    let mut found: Option<(&str, Total)> = None;
    for &(name, kind) in amounts_of(&class.value) {
        let span = args.span_of(name);
        let Some(value) = args.float_opt(name) else { continue };
        if !(value > 0.0) {
            // pbrt takes anything not positive for absent; its parameters are these two.
            if matches!(name, "power" | "illuminance") {
                let message = format!("\"{name}\" is ignored because it is not positive");
                args.ctx.diagnostics.notice(span, message);
            } else {
                args.error(span, format!("parameter \"{name}\" must be positive, found {value}"));
            }
            continue;
        }
        match found {
            Some((earlier, _)) => {
                let first = args.span_of(earlier);
                let message = format!("the amount is stated twice: by \"{earlier}\" and by \"{name}\"");
                let d = Diagnostic::error(span, message);
                args.ctx.diagnostics.push(d.with_related(first, "the other statement"));
            }
            None => found = Some((name, kind(value))),
        }
    }
    found.map(|(_, total)| total)
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

fn photometric(args: &mut Args<'_>) -> Option<LightKind> {
    let spectrum = args.light_spectrum("spectrum");
    let from = args.point("from", Point::ORIGIN);
    let tilt = args.float_where("tilt", 0.0, |v| (0.0..=180.0).contains(&v), "from 0 to 180");
    let ways = [("smooth", Interpolation::Smooth), ("linear", Interpolation::Linear)];
    let interpolation = args.choice("interpolation", Interpolation::Smooth, &ways);
    let sized = ["width", "length"].into_iter().find(|name| args.has(name)).map(|name| args.span_of(name));
    let (width, length) = (args.positive("width", 1.0), args.positive("length", 1.0));
    let place = args.span_of("opening");
    let opening = args.text("opening");
    let opening = match (opening.as_ref().map(|t| t.value.as_str()), sized) {
        (None | Some("point"), None) => OpeningDesc::Point,
        (Some("file"), None) => OpeningDesc::File,
        (None, Some(span)) if !(args.has("width") && args.has("length")) => {
            args.error(span, "an opening needs both \"width\" and \"length\"");
            OpeningDesc::Point
        }
        (None, Some(_)) => OpeningDesc::Rectangle { along_c0: length, along_c90: width },
        (Some("file" | "point"), Some(span)) => {
            args.error(span, "give \"opening\" or its \"width\" and \"length\", not both");
            OpeningDesc::Point
        }
        (Some(other), _) => {
            let d = Diagnostic::error(place, format!("unknown opening \"{other}\""));
            args.ctx
                .diagnostics
                .push(d.with_help("known are point and file; or state \"width\" and \"length\""));
            OpeningDesc::Point
        }
    };
    let file = needed_file(args)?;
    Some(LightKind::Photometric { spectrum, file, from, opening, interpolation, tilt })
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
    Some(match file {
        Some(file) => LightKind::ImageInfinite { file },
        None => LightKind::UniformInfinite { radiance },
    })
}
