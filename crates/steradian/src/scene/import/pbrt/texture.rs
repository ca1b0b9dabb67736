//! Texture classes.

use super::args::Args;
use super::spectrum::Role;
use crate::image::ColorEncoding;
use crate::math::{Dir, Transform, Vec3};
use crate::scene::desc::{
    CheckerboardDomain, FloatTextureKind, ImageFilter, ImageTextureDesc, Mapping2d, NoiseDesc, SpectrumParam,
    SpectrumTextureKind, SpectrumValue, WrapMode,
};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::text::Text;

const FLOAT_CLASSES: &[&str] = &[
    "constant",
    "scale",
    "mix",
    "directionmix",
    "bilerp",
    "imagemap",
    "checkerboard",
    "dots",
    "fbm",
    "wrinkled",
    "windy",
    "ptex",
];
const SPECTRUM_CLASSES: &[&str] = &[
    "constant",
    "scale",
    "mix",
    "directionmix",
    "bilerp",
    "imagemap",
    "checkerboard",
    "dots",
    "marble",
    "ptex",
];

/// Reads the parameters of a class of number textures; `None` when it is unknown or unsupported (and reported).
pub(super) fn float_texture(
    class: &Text,
    world_from_texture: &Transform,
    args: &mut Args<'_>,
) -> Option<FloatTextureKind> {
    Some(match class.value.as_str() {
        "constant" => FloatTextureKind::Constant { value: args.float_param("value", 1.0) },
        "scale" => FloatTextureKind::Scale {
            tex: args.float_param("tex", 1.0),
            scale: args.float_param("scale", 1.0),
        },
        "mix" => FloatTextureKind::Mix {
            tex1: args.float_param("tex1", 0.0),
            tex2: args.float_param("tex2", 1.0),
            amount: args.float_param("amount", 0.5),
        },
        "directionmix" => FloatTextureKind::DirectionMix {
            tex1: args.float_param("tex1", 0.0),
            tex2: args.float_param("tex2", 1.0),
            dir: direction(world_from_texture, args)?,
        },
        "bilerp" => FloatTextureKind::Bilerp {
            v: [
                args.float("v00", 0.0),
                args.float("v01", 1.0),
                args.float("v10", 0.0),
                args.float("v11", 1.0),
            ],
            mapping: mapping(args),
        },
        "imagemap" => FloatTextureKind::Image(image(args)?),
        "checkerboard" => FloatTextureKind::Checkerboard {
            tex1: args.float_param("tex1", 1.0),
            tex2: args.float_param("tex2", 0.0),
            domain: domain(args),
        },
        "dots" => FloatTextureKind::Dots {
            inside: args.float_param("inside", 1.0),
            outside: args.float_param("outside", 0.0),
            mapping: mapping(args),
        },
        "fbm" => FloatTextureKind::Fbm(noise(args)),
        "wrinkled" => FloatTextureKind::Wrinkled(noise(args)),
        "windy" => FloatTextureKind::Windy,
        "ptex" => {
            args.unsupported_class("texture", class);
            return None;
        }
        _ => {
            args.unknown_class("texture of numbers", class, FLOAT_CLASSES, &[]);
            return None;
        }
    })
}

/// Reads the parameters of a class of spectrum textures; `None` when it is unknown or unsupported (and reported).
pub(super) fn spectrum_texture(
    class: &Text,
    world_from_texture: &Transform,
    args: &mut Args<'_>,
) -> Option<SpectrumTextureKind> {
    Some(match class.value.as_str() {
        "constant" => SpectrumTextureKind::Constant { value: albedo(args, "value", 1.0) },
        "scale" => SpectrumTextureKind::Scale {
            tex: albedo(args, "tex", 1.0),
            scale: args.float_param("scale", 1.0),
        },
        "mix" => SpectrumTextureKind::Mix {
            tex1: albedo(args, "tex1", 0.0),
            tex2: albedo(args, "tex2", 1.0),
            amount: args.float_param("amount", 0.5),
        },
        "directionmix" => SpectrumTextureKind::DirectionMix {
            tex1: albedo(args, "tex1", 0.0),
            tex2: albedo(args, "tex2", 1.0),
            dir: direction(world_from_texture, args)?,
        },
        "bilerp" => SpectrumTextureKind::Bilerp {
            v: Box::new([
                bilerp_corner(args, "v00", 0.0),
                bilerp_corner(args, "v01", 1.0),
                bilerp_corner(args, "v10", 0.0),
                bilerp_corner(args, "v11", 1.0),
            ]),
            mapping: mapping(args),
        },
        "imagemap" => SpectrumTextureKind::Image(image(args)?),
        "checkerboard" => SpectrumTextureKind::Checkerboard {
            tex1: albedo(args, "tex1", 1.0),
            tex2: albedo(args, "tex2", 0.0),
            domain: domain(args),
        },
        "dots" => SpectrumTextureKind::Dots {
            inside: albedo(args, "inside", 1.0),
            outside: albedo(args, "outside", 0.0),
            mapping: mapping(args),
        },
        "marble" => SpectrumTextureKind::Marble {
            noise: noise(args),
            scale: args.float("scale", 1.0),
            variation: args.float("variation", 0.2),
        },
        "ptex" => {
            args.unsupported_class("texture", class);
            return None;
        }
        _ => {
            args.unknown_class("texture of spectra", class, SPECTRUM_CLASSES, &[]);
            return None;
        }
    })
}

fn albedo(args: &mut Args<'_>, name: &'static str, default: f32) -> SpectrumParam {
    args.spectrum_param(name, Role::Albedo, default)
}

fn bilerp_corner(args: &mut Args<'_>, name: &'static str, default: f32) -> SpectrumParam {
    let fallback = args.default_spectrum(SpectrumValue::Constant(default));
    SpectrumParam::Value(args.spectrum_opt(name, Role::Albedo).unwrap_or(fallback))
}

fn direction(world_from_texture: &Transform, args: &mut Args<'_>) -> Option<Dir> {
    let span = args.span_of("dir");
    let dir = Dir::new(world_from_texture.vector(args.vector("dir", Vec3::Y)));
    if dir.is_none() {
        args.error(span, "parameter \"dir\" must not be zero");
    }
    dir
}

fn noise(args: &mut Args<'_>) -> NoiseDesc {
    NoiseDesc { octaves: args.count("octaves", 8, 1..=64), roughness: args.float("roughness", 0.5) }
}

fn domain(args: &mut Args<'_>) -> CheckerboardDomain {
    match args.count("dimension", 2, 2..=3) {
        3 => CheckerboardDomain::Space,
        _ => CheckerboardDomain::Plane(mapping(args)),
    }
}

#[derive(Clone, Copy)]
enum MappingClass {
    Uv,
    Spherical,
    Cylindrical,
    Planar,
}

fn mapping(args: &mut Args<'_>) -> Mapping2d {
    let classes = [
        ("uv", MappingClass::Uv),
        ("spherical", MappingClass::Spherical),
        ("cylindrical", MappingClass::Cylindrical),
        ("planar", MappingClass::Planar),
    ];
    match args.choice("mapping", MappingClass::Uv, &classes) {
        MappingClass::Uv => Mapping2d::Uv {
            scale: [args.float("uscale", 1.0), args.float("vscale", 1.0)],
            delta: [args.float("udelta", 0.0), args.float("vdelta", 0.0)],
        },
        MappingClass::Spherical => Mapping2d::Spherical,
        MappingClass::Cylindrical => Mapping2d::Cylindrical,
        MappingClass::Planar => Mapping2d::Planar {
            v1: args.vector("v1", Vec3::X),
            v2: args.vector("v2", Vec3::Y),
            delta: [args.float("udelta", 0.0), args.float("vdelta", 0.0)],
        },
    }
}

fn image(args: &mut Args<'_>) -> Option<ImageTextureDesc> {
    let filters = [
        ("point", ImageFilter::Point),
        ("bilinear", ImageFilter::Bilinear),
        ("trilinear", ImageFilter::Trilinear),
        ("ewa", ImageFilter::Ewa),
        ("EWA", ImageFilter::Ewa),
    ];
    let wraps = [
        ("repeat", WrapMode::Repeat),
        ("black", WrapMode::Black),
        ("clamp", WrapMode::Clamp),
        ("octahedralsphere", WrapMode::OctahedralSphere),
    ];
    let filter = args.choice("filter", ImageFilter::Bilinear, &filters);
    let wrap = args.choice("wrap", WrapMode::Repeat, &wraps);
    let scale = args.float("scale", 1.0);
    let invert = args.bool("invert", false);
    let max_anisotropy = args.float_where("maxanisotropy", 8.0, |v| v >= 1.0, "at least 1");
    let encoding = encoding(args);
    let mapping = mapping(args);
    let file = args.file("filename");
    if file.is_none() {
        args.missing("filename");
    }
    Some(ImageTextureDesc { file: file?, encoding, filter, wrap, scale, invert, max_anisotropy, mapping })
}

fn encoding(args: &mut Args<'_>) -> Option<ColorEncoding> {
    let text = args.text("encoding")?;
    let encoding = ColorEncoding::parse(&text.value);
    if encoding.is_none() {
        let d = Diagnostic::error(text.span, format!("unknown encoding \"{}\"", text.value));
        args.ctx
            .diagnostics
            .push(d.with_help("known are sRGB, linear, and gamma followed by a positive number"));
    }
    encoding
}
