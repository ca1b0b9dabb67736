//! `LightSource "sky"` and `LightSource "sun"`, our extensions.

use super::args::Args;
use crate::light::{Atmosphere, GeneralSky, Moment, Place, SUN_ANGULAR_RADIUS, SkyModel};
use crate::math::Vec3;
use crate::scene::desc::{
    HorizonDesc, LightKind, SkyDesc, SkyKindDesc, SunDesc, SunPlaceDesc, SunPositionDesc,
};
use crate::scene::diagnostic::{Diagnostic, nearest};
use crate::scene::text::Text;

const MODELS: [&str; 20] = [
    "cie-1",
    "cie-2",
    "cie-3",
    "cie-4",
    "cie-5",
    "cie-6",
    "cie-7",
    "cie-8",
    "cie-9",
    "cie-10",
    "cie-11",
    "cie-12",
    "cie-13",
    "cie-14",
    "cie-15",
    "cie-16",
    "overcast",
    "clear",
    "uniform",
    BIRD_RIORDAN,
];
const BIRD_RIORDAN: &str = "bird-riordan";

/// Reads a sky; `None` when something needed is missing or unknown (and reported).
pub(super) fn sky(args: &mut Args<'_>) -> Option<LightKind> {
    let model = args.text("model");
    let horizon = horizon(args);
    let sun = sun_place(args);
    let ground = args.float("groundreflectance", 0.0);
    args.demand_range("groundreflectance", ground, 0.0, 1.0);
    let Some(model) = model else {
        args.missing("model");
        args.not_understood();
        return None;
    };
    let kind = match model.value.as_str() {
        BIRD_RIORDAN => cloudless(args, ground),
        _ => SkyKindDesc::Distribution {
            spectrum: args.light_spectrum("L"),
            model: known_model(&model, args)?,
        },
    };
    let needs_sun = match &kind {
        SkyKindDesc::Distribution { model, .. } => model.needs_sun(),
        SkyKindDesc::Cloudless { .. } => true,
    };
    if needs_sun && sun.is_none() {
        if !gives_sun(args) {
            let message =
                format!("sky \"{}\" is brighter near the sun, and nothing says where it stands", model.value);
            args.ctx.diagnostics.push(
                Diagnostic::error(model.span, message)
                    .with_help("give \"vector3 sundirection\", or \"latitude\", \"longitude\" and \"time\""),
            );
        }
        return None;
    }
    let ground = (ground > 0.0).then_some(ground);
    Some(LightKind::Sky(Box::new(SkyDesc { kind, horizon, sun, ground })))
}

/// Reads a sun; `None` when nothing says where it stands (which is reported).
pub(super) fn sun(args: &mut Args<'_>) -> Option<LightKind> {
    let horizon = horizon(args);
    let place = sun_place(args);
    let irradiance = args.light_spectrum("L");
    let angular_radius = angular_radius(args);
    if place.is_none() && !gives_sun(args) {
        let d = Diagnostic::error(args.span, "nothing says where the sun stands");
        args.ctx
            .diagnostics
            .push(d.with_help("give \"vector3 sundirection\", or \"latitude\", \"longitude\" and \"time\""));
    }
    let place = place?;
    Some(LightKind::Sun(Box::new(SunDesc { irradiance, angular_radius, horizon, place })))
}

fn known_model(name: &Text, args: &mut Args<'_>) -> Option<SkyModel> {
    let number = match name.value.as_str() {
        "uniform" => return Some(SkyModel::Uniform),
        "overcast" | "cie-16" => return Some(SkyModel::Overcast),
        "clear" => Some(12),
        other => other.strip_prefix("cie-").and_then(|n| n.parse().ok()),
    };
    let known = number.filter(|_| MODELS.contains(&name.value.as_str())).and_then(GeneralSky::of_type);
    if known.is_none() {
        args.not_understood();
        let d = Diagnostic::error(name.span, format!("unknown sky model \"{}\"", name.value));
        args.ctx.diagnostics.push(match nearest(&name.value, MODELS) {
            Some(n) => d.with_help(format!("did you mean \"{n}\"?")),
            None => d.with_help("known are cie-1 to cie-16, overcast, clear, uniform and bird-riordan"),
        });
    }
    known.map(SkyModel::General)
}

/// The parameters of the model of Bird and Riordan.
fn cloudless(args: &mut Args<'_>, ground: f32) -> SkyKindDesc {
    for name in ["L", "unit", "illuminance", "irradiance", "zenithluminance"] {
        if args.has(name) {
            let span = args.span_of(name);
            let message = format!("sky \"{BIRD_RIORDAN}\" has a spectrum and an amount of its own");
            let d = Diagnostic::error(span, message);
            args.ctx.diagnostics.push(d.with_help("\"float scale\" is a factor on it"));
        }
    }
    // Asked for, so that it is not called unknown as well.
    args.light_spectrum("L");
    let default = Atmosphere::default();
    let mut within = |name: &'static str, default: f64, min: f32, max: f32| {
        let v = args.float(name, default as f32);
        args.demand_range(name, v, min, max);
        f64::from(v)
    };
    let atmosphere = Atmosphere {
        turbidity: within("turbidity", default.turbidity, 0.0, 1.0),
        angstrom_exponent: within("angstrom", default.angstrom_exponent, 0.0, 3.0),
        water: within("watervapor", default.water, 0.0, 10.0),
        ozone: within("ozone", default.ozone, 0.0, 1.0),
        pressure: within("pressure", default.pressure, 30_000.0, 110_000.0),
        ground_reflectance: if ground > 0.0 { f64::from(ground) } else { default.ground_reflectance },
    };
    let radius = angular_radius(args);
    SkyKindDesc::Cloudless { atmosphere, sun: args.bool("sun", true).then_some(radius) }
}

fn angular_radius(args: &mut Args<'_>) -> f32 {
    let radius = args.float("angularradius", SUN_ANGULAR_RADIUS);
    args.demand_range("angularradius", radius, 0.01, 10.0);
    radius
}

fn horizon(args: &mut Args<'_>) -> HorizonDesc {
    HorizonDesc { up: direction(args, "up", Vec3::Z), north: args.float("north", 0.0) }
}

/// A vector that is not zero.
fn direction(args: &mut Args<'_>, name: &'static str, default: Vec3) -> Vec3 {
    let span = args.span_of(name);
    let v = args.vector(name, default);
    if v.length_squared() > 0.0 {
        return v;
    }
    args.error(span, format!("parameter \"{name}\" is no direction: it has no length"));
    default
}

const PLACE_AND_TIME: [&str; 3] = ["latitude", "longitude", "time"];

/// Whether the scene tries to say where the sun stands.
fn gives_sun(args: &Args<'_>) -> bool {
    args.has("sundirection") || PLACE_AND_TIME.iter().any(|name| args.has(name))
}

fn sun_place(args: &mut Args<'_>) -> Option<SunPlaceDesc> {
    let given: Vec<&str> = PLACE_AND_TIME.into_iter().filter(|name| args.has(name)).collect();
    let (towards, span, time_span) =
        (args.has("sundirection"), args.span_of("sundirection"), args.span_of("time"));
    let direction = direction(args, "sundirection", Vec3::Z);
    let latitude = coordinate(args, "latitude", 90.0);
    let longitude = coordinate(args, "longitude", 180.0);
    let moment = moment(args);
    if towards {
        if let Some(first) = given.first() {
            let span = args.span_of(first);
            args.error(span, "give \"sundirection\", or place and time, not both");
        }
        return Some(SunPlaceDesc { position: SunPositionDesc::Towards(direction), span });
    }
    if let Some(first) = given.first()
        && given.len() < PLACE_AND_TIME.len()
    {
        let span = args.span_of(first);
        let missing: Vec<String> =
            PLACE_AND_TIME.iter().filter(|n| !given.contains(n)).map(|n| format!("\"{n}\"")).collect();
        let verb = if missing.len() == 1 { "is" } else { "are" };
        let message = format!(
            "the sun's place takes \"latitude\", \"longitude\" and \"time\"; {} {verb} missing",
            missing.join(" and ")
        );
        args.error(span, message);
        return None;
    }
    let place = Place { latitude: latitude?, longitude: longitude? };
    let position = SunPositionDesc::SeenFrom { place, moment: moment? };
    Some(SunPlaceDesc { position, span: time_span })
}

fn coordinate(args: &mut Args<'_>, name: &'static str, limit: f32) -> Option<f64> {
    let v = args.float_opt(name)?;
    args.demand_range(name, v, -limit, limit);
    Some(f64::from(v))
}

fn moment(args: &mut Args<'_>) -> Option<Moment> {
    let text = args.text("time")?;
    Moment::parse(&text.value).map_err(|e| args.error(text.span, e.to_string())).ok()
}
