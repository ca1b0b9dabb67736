//! Material classes: their parameters are read by the schema of the class.

use super::args::Args;
use super::spectrum::Role as Meaning;
use crate::material::schema::{Quantity, SpectrumDefault};
use crate::material::{self, CLASSES, Class, Parameter, ParameterKind};
use crate::scene::desc::{
    ArgumentDesc, ArgumentValue, FloatParam, SpectrumDesc, SpectrumParam, SpectrumValue,
};
use crate::scene::source::Span;
use crate::scene::text::Text;

/// Classes of the format that cannot be rendered yet.
const UNSUPPORTED: &[&str] = &["subsurface"];
const V3_CLASSES: &[&str] = &[
    "matte",
    "plastic",
    "uber",
    "glass",
    "metal",
    "mirror",
    "substrate",
    "translucent",
    "fourier",
    "disney",
    "kdsubsurface",
];

/// The class of that name; `None` when it is unknown or unsupported (and reported).
pub(super) fn class(name: &Text, args: &mut Args<'_>) -> Option<&'static Class> {
    let word = name.value.as_str();
    if let Some(class) = material::class(word) {
        return Some(class);
    }
    match word {
        "" | "none" => {
            let message = format!("material \"{word}\" is an old name of \"interface\"");
            args.ctx.diagnostics.notice(name.span, message);
            return material::class("interface");
        }
        _ if UNSUPPORTED.contains(&word) => args.unsupported_class("material", name),
        _ => {
            let known: Vec<&str> =
                CLASSES.iter().map(|c| c.name).chain(UNSUPPORTED.iter().copied()).collect();
            args.unknown_class("material", name, &known, V3_CLASSES);
        }
    }
    None
}

/// Reads the parameters of a class.
pub(super) fn arguments(class: &Class, args: &mut Args<'_>) -> Vec<ArgumentDesc> {
    class.parameters.iter().map(|p| argument(p, args)).collect()
}

/// The values of a class of which nothing is stated, located at `span`.
pub(super) fn defaults(class: &Class, span: Span) -> Vec<ArgumentDesc> {
    let of = |p: &Parameter| {
        let value = match p.kind {
            ParameterKind::Spectrum { default, .. } => {
                ArgumentValue::Spectrum(default_spectrum(default, span))
            }
            ParameterKind::Index { default } => ArgumentValue::Index(default.map(|v| constant(v, span))),
            ParameterKind::Float { default, .. } => ArgumentValue::Float(default.map(FloatParam::Value)),
            ParameterKind::Number { default, .. } => ArgumentValue::Number(default),
            ParameterKind::Numbers => ArgumentValue::Numbers(Vec::new()),
            ParameterKind::Spectra => ArgumentValue::Spectra(Vec::new()),
            ParameterKind::Flag { default } => ArgumentValue::Flag(default),
            ParameterKind::Count { default, .. } => ArgumentValue::Count(default),
            ParameterKind::Choice { options } => {
                ArgumentValue::Choice(options.first().copied().unwrap_or(""))
            }
            ParameterKind::File { .. } => ArgumentValue::File(None),
            ParameterKind::Materials { .. } => ArgumentValue::Materials(Vec::new()),
        };
        ArgumentDesc { name: p.name, value, given: false, span }
    };
    class.parameters.iter().map(of).collect()
}

fn constant(value: f32, span: Span) -> SpectrumDesc {
    SpectrumDesc { value: SpectrumValue::Constant(value), span }
}

fn default_spectrum(default: SpectrumDefault, span: Span) -> Option<SpectrumParam> {
    let value = match default {
        SpectrumDefault::Constant(v) => SpectrumValue::Constant(v),
        SpectrumDefault::Named(name) => SpectrumValue::Named(name.to_owned()),
        SpectrumDefault::Absent => return None,
    };
    Some(SpectrumParam::Value(SpectrumDesc { value, span }))
}

fn argument(p: &Parameter, args: &mut Args<'_>) -> ArgumentDesc {
    let (name, given, span) = (p.name, args.has(p.name), args.span_of(p.name));
    let value = match p.kind {
        ParameterKind::Spectrum { quantity, default } => {
            let meaning = match quantity {
                Quantity::Fraction => Meaning::Albedo,
                Quantity::Unbounded => Meaning::Unbounded,
            };
            let read = args.spectrum_param_opt(name, meaning);
            ArgumentValue::Spectrum(read.or_else(|| default_spectrum(default, args.span)))
        }
        ParameterKind::Index { default } => {
            let read = args.refractive_index_opt(name);
            ArgumentValue::Index(read.or_else(|| default.map(|v| constant(v, args.span))))
        }
        ParameterKind::Float { default, min, max } => {
            let read = args.float_param_opt(name);
            if let Some(FloatParam::Value(v)) = read {
                args.demand_range(name, v, min, max);
            }
            ArgumentValue::Float(read.or(default.map(FloatParam::Value)))
        }
        ParameterKind::Number { default, min, max } => {
            let read = args.float_opt(name);
            if let Some(v) = read {
                args.demand_range(name, v, min, max);
            }
            ArgumentValue::Number(read.or(default))
        }
        ParameterKind::Numbers => ArgumentValue::Numbers(args.floats(name).map_or(Vec::new(), |m| m.values)),
        ParameterKind::Spectra => ArgumentValue::Spectra(args.spectra(name)),
        ParameterKind::Flag { default } => ArgumentValue::Flag(args.bool(name, default)),
        ParameterKind::Count { default, min, max } => {
            ArgumentValue::Count(args.count(name, default, min..=max))
        }
        ParameterKind::Choice { options } => {
            let choices: Vec<(&str, &'static str)> = options.iter().map(|&o| (o, o)).collect();
            ArgumentValue::Choice(args.choice(name, options.first().copied().unwrap_or(""), &choices))
        }
        ParameterKind::File { required } => {
            let file = args.file(name);
            if required && file.is_none() {
                args.missing(name);
            }
            ArgumentValue::File(file)
        }
        ParameterKind::Materials { count } => ArgumentValue::Materials(materials(name, count, args)),
    };
    ArgumentDesc { name, value, given, span }
}

fn materials(
    name: &'static str,
    count: usize,
    args: &mut Args<'_>,
) -> Vec<crate::scene::desc::Id<crate::scene::desc::MaterialDesc>> {
    let Some(names) = args.texts(name) else {
        args.missing(name);
        return Vec::new();
    };
    if names.values.len() != count {
        let n = names.values.len();
        args.error(names.span, format!("\"{name}\" takes the names of {count} materials, found {n}"));
        return Vec::new();
    }
    names.values.iter().map(|n| args.ctx.materials.refer(n)).collect()
}
