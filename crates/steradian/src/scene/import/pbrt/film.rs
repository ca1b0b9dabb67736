//! Film and filter classes.

use super::args::Args;
use crate::color::ColorSpaceKind;
use crate::scene::desc::{
    FilmDesc, FilmKind, FilterDesc, FilterKind, GBufferSpace, SensorDesc, SensorResponse,
};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::source::Span;
use crate::scene::text::Text;

const FILMS: &[&str] = &["rgb", "gbuffer", "spectral"];
const V3_FILMS: &[&str] = &["image"];
const FILTERS: &[&str] = &["box", "gaussian", "mitchell", "sinc", "triangle"];

/// Camera bodies whose responses pbrt-v4 knows.
const CAMERAS: &[&str] = &[
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d",
    "canon_eos_200d_mkii",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
];

/// Colour temperatures that a sensor can be balanced for [K]: thermal light that is not merely red, up to the end of the
/// definition of daylight.
const WHITES: std::ops::RangeInclusive<f32> = 1000.0..=24_900.0;

/// Larger pictures than this along one side are taken for slips.
const MAX_SIDE: u32 = 1 << 16;

/// The film of a scene that has no Film directive.
pub(super) fn default_film(color_space: ColorSpaceKind, span: Span) -> FilmDesc {
    FilmDesc {
        kind: FilmKind::Rgb,
        resolution: [1280, 720],
        crop_window: None,
        pixel_bounds: None,
        filename: "pbrt.exr".to_owned(),
        sensor: SensorDesc { response: SensorResponse::Cie1931, iso: 100.0, white_balance: None },
        max_component_value: None,
        color_space,
        span,
    }
}

/// Reads the parameters of a film class; `None` when it is unknown (and reported).
pub(super) fn film(class: &Text, directive: Span, args: &mut Args<'_>) -> Option<FilmDesc> {
    let kind = match class.value.as_str() {
        "rgb" => FilmKind::Rgb,
        "gbuffer" => {
            let spaces = [("camera", GBufferSpace::Camera), ("world", GBufferSpace::World)];
            FilmKind::GBuffer { space: args.choice("coordinatesystem", GBufferSpace::Camera, &spaces) }
        }
        "spectral" => {
            let n_buckets = args.count("nbuckets", 16, 1..=4096);
            let span = args.span_of("lambdamax");
            let wavelength = |args: &mut Args<'_>, name, default| {
                args.float_where(name, default, |v| (1.0..=1e6).contains(&v), "from 1 to 1e6")
            };
            let (lambda_min, lambda_max) =
                (wavelength(args, "lambdamin", 360.0), wavelength(args, "lambdamax", 830.0));
            if lambda_min >= lambda_max {
                args.error(span, "\"lambdamax\" must be greater than \"lambdamin\"");
            }
            FilmKind::Spectral { n_buckets, lambda_min, lambda_max }
        }
        _ => {
            args.unknown_class("film", class, FILMS, V3_FILMS);
            return None;
        }
    };
    let resolution =
        [args.count("xresolution", 1280, 1..=MAX_SIDE), args.count("yresolution", 720, 1..=MAX_SIDE)];
    let defaults = default_film(args.color_space(), directive);
    let both = args.has("cropwindow") && args.has("pixelbounds");
    if both {
        let span = args.span_of("pixelbounds");
        args.error(span, "give \"cropwindow\" or \"pixelbounds\", not both");
    }
    let max = args.float_opt("maxcomponentvalue");
    // Only lens systems need the size of the film.
    args.positive("diagonal", 35.0);
    let half = args.span_of("savefp16");
    if args.bool("savefp16", false) {
        args.ctx.diagnostics.notice(half, "\"savefp16\" is ignored: EXR is written in 32-bit float");
    }
    Some(FilmDesc {
        kind,
        resolution,
        crop_window: crop_window(args),
        pixel_bounds: pixel_bounds(args, resolution),
        filename: args.text("filename").map_or(defaults.filename, |t| t.value),
        sensor: sensor(args),
        max_component_value: max.filter(|m| *m > 0.0),
        color_space: defaults.color_space,
        span: directive,
    })
}

fn sensor(args: &mut Args<'_>) -> SensorDesc {
    let iso = args.float_where("iso", 100.0, |v| (1e-6..=1e9).contains(&v), "from 1e-6 to 1e9");
    let white_balance = args.float_where(
        "whitebalance",
        0.0,
        |t| t == 0.0 || WHITES.contains(&t),
        "0 or a colour temperature from 1000 to 24900",
    );
    let white_balance = Some(white_balance).filter(|t| *t > 0.0);
    let response = match args.text("sensor") {
        Some(name) if CAMERAS.contains(&name.value.as_str()) => {
            args.ctx.unsupported(name.span, &format!("sensor \"{}\"; known is cie1931", name.value));
            SensorResponse::Camera(name.value)
        }
        Some(name) if name.value != "cie1931" => {
            let d = Diagnostic::error(name.span, format!("unknown sensor \"{}\"", name.value));
            let known = CAMERAS.iter().copied().chain(["cie1931"]);
            args.ctx.diagnostics.push(d.with_nearest(&name.value, known));
            SensorResponse::Cie1931
        }
        Some(_) | None => SensorResponse::Cie1931,
    };
    SensorDesc { response, iso, white_balance }
}

fn crop_window(args: &mut Args<'_>) -> Option<[f32; 4]> {
    let (w, span) = args.four_floats("cropwindow")?;
    let clamp = |a: f32| a.clamp(0.0, 1.0);
    let ordered = |a: f32, b: f32| [clamp(a.min(b)), clamp(a.max(b))];
    let ([x0, x1], [y0, y1]) = (ordered(w[0], w[1]), ordered(w[2], w[3]));
    if x0 >= x1 || y0 >= y1 {
        args.error(span, "the crop window is empty");
        return None;
    }
    Some([x0, x1, y0, y1])
}

fn pixel_bounds(args: &mut Args<'_>, resolution: [u32; 2]) -> Option<[u32; 4]> {
    let many = args.ints("pixelbounds")?;
    let Ok(b) = <[i32; 4]>::try_from(many.values.as_slice()) else {
        args.error(
            many.span,
            format!("parameter \"pixelbounds\" takes 4 values, found {}", many.values.len()),
        );
        return None;
    };
    let inside = |v: i32, side: u32| u32::try_from(v).unwrap_or(0).min(side);
    let [x0, x1] = [inside(b[0], resolution[0]), inside(b[1], resolution[0])];
    let [y0, y1] = [inside(b[2], resolution[1]), inside(b[3], resolution[1])];
    if x0 >= x1 || y0 >= y1 {
        args.error(many.span, "the pixel bounds contain no pixel");
        return None;
    }
    Some([x0, x1, y0, y1])
}

/// The filter of a scene that has no PixelFilter directive.
pub(super) fn default_filter(span: Span) -> FilterDesc {
    FilterDesc { kind: FilterKind::Gaussian { sigma: 0.5 }, radius: [1.5, 1.5], span }
}

/// Reads the parameters of a filter class; `None` when it is unknown (and reported).
pub(super) fn filter(class: &Text, directive: Span, args: &mut Args<'_>) -> Option<FilterDesc> {
    let (kind, radius) = match class.value.as_str() {
        "box" => (FilterKind::Box, 0.5),
        "triangle" => (FilterKind::Triangle, 2.0),
        "gaussian" => {
            let wide = |v| (0.01..=100.0).contains(&v);
            (FilterKind::Gaussian { sigma: args.float_where("sigma", 0.5, wide, "from 0.01 to 100") }, 1.5)
        }
        "mitchell" => {
            let coefficient = |args: &mut Args<'_>, name| {
                args.float_where(name, 1.0 / 3.0, |v| v.abs() <= 10.0, "from -10 to 10")
            };
            (FilterKind::Mitchell { b: coefficient(args, "B"), c: coefficient(args, "C") }, 2.0)
        }
        "sinc" => {
            let wide = |v| (0.1..=1000.0).contains(&v);
            (FilterKind::Sinc { tau: args.float_where("tau", 3.0, wide, "from 0.1 to 1000") }, 4.0)
        }
        _ => {
            args.unknown_class("pixel filter", class, FILTERS, &[]);
            return None;
        }
    };
    let limit = |v: f32| (0.01..=64.0).contains(&v);
    let demand = "from 0.01 to 64";
    let radius = [
        args.float_where("xradius", radius, limit, demand),
        args.float_where("yradius", radius, limit, demand),
    ];
    if let FilterKind::Gaussian { sigma } = kind
        && sigma > 100.0 * radius[0].min(radius[1])
    {
        let span = args.span_of("sigma");
        args.error(span, format!("\"sigma\" {sigma} leaves nothing of the filter within its radius"));
    }
    Some(FilterDesc { kind, radius, span: directive })
}
