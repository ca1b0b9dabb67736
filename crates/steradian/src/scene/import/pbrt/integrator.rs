//! Integrator and accelerator classes.

use super::args::Args;
use crate::scene::desc::{
    AcceleratorDesc, AcceleratorKind, IntegratorDesc, IntegratorKind, LightSamplerKind, PathDesc,
};
use crate::scene::source::Span;
use crate::scene::text::Text;

const CLASSES: &[&str] = &[
    "path",
    "volpath",
    "simplepath",
    "simplevolpath",
    "lightpath",
    "randomwalk",
    "bdpt",
    "mlt",
    "sppm",
    "ambientocclusion",
    "function",
];
const V3_CLASSES: &[&str] = &["directlighting", "whitted", "ao"];
const DEPTHS: std::ops::RangeInclusive<u32> = 0..=i32::MAX as u32;
const COUNTS: std::ops::RangeInclusive<u32> = 1..=i32::MAX as u32;

/// The integrator of a scene that has no Integrator directive.
pub(super) fn default_integrator(span: Span) -> IntegratorDesc {
    let path = PathDesc { max_depth: 5, regularize: false, light_sampler: None };
    IntegratorDesc { kind: IntegratorKind::VolPath(path), span }
}

/// Reads the parameters of an integrator class; `None` when it is unknown or unsupported (and reported).
pub(super) fn integrator(class: &Text, directive: Span, args: &mut Args<'_>) -> Option<IntegratorDesc> {
    let depth = |args: &mut Args<'_>| args.count("maxdepth", 5, DEPTHS);
    let kind = match class.value.as_str() {
        "path" => IntegratorKind::Path(path(args)),
        "volpath" => IntegratorKind::VolPath(path(args)),
        "simplepath" => IntegratorKind::SimplePath {
            max_depth: depth(args),
            sample_lights: args.bool("samplelights", true),
            sample_bsdf: args.bool("samplebsdf", true),
        },
        "simplevolpath" => IntegratorKind::SimpleVolPath { max_depth: depth(args) },
        "lightpath" => IntegratorKind::LightPath { max_depth: depth(args) },
        "randomwalk" => IntegratorKind::RandomWalk { max_depth: depth(args) },
        "bdpt" => {
            for name in ["visualizestrategies", "visualizeweights"] {
                let span = args.span_of(name);
                if args.bool(name, false) {
                    args.ctx.diagnostics.notice(span, format!("\"{name}\" is ignored"));
                }
            }
            IntegratorKind::Bdpt { max_depth: depth(args), regularize: args.bool("regularize", false) }
        }
        "mlt" => IntegratorKind::Mlt {
            max_depth: depth(args),
            bootstrap_samples: args.count("bootstrapsamples", 100_000, COUNTS),
            chains: args.count("chains", 1000, COUNTS),
            mutations_per_pixel: args.count("mutationsperpixel", 100, COUNTS),
            sigma: args.positive("sigma", 0.01),
            large_step_probability: args.float_where(
                "largestepprobability",
                0.3,
                |v| (0.0..=1.0).contains(&v),
                "from 0 to 1",
            ),
            regularize: args.bool("regularize", false),
        },
        "sppm" => IntegratorKind::Sppm {
            max_depth: depth(args),
            // pbrt writes its default as −1.
            photons_per_iteration: args.int_opt("photonsperiteration").and_then(|n| u32::try_from(n).ok()),
            radius: args.positive("radius", 1.0),
            seed: args.int_opt("seed"),
        },
        "ambientocclusion" => IntegratorKind::AmbientOcclusion {
            cos_sample: args.bool("cossample", true),
            max_distance: args.positive("maxdistance", f32::INFINITY),
        },
        "function" => {
            args.unsupported_class("integrator", class);
            return None;
        }
        _ => {
            args.unknown_class("integrator", class, CLASSES, V3_CLASSES);
            return None;
        }
    };
    Some(IntegratorDesc { kind, span: directive })
}

fn path(args: &mut Args<'_>) -> PathDesc {
    let samplers = [
        ("bvh", Some(LightSamplerKind::Bvh)),
        ("uniform", Some(LightSamplerKind::Uniform)),
        ("power", Some(LightSamplerKind::Power)),
        ("exhaustive", Some(LightSamplerKind::Exhaustive)),
    ];
    PathDesc {
        max_depth: args.count("maxdepth", 5, DEPTHS),
        regularize: args.bool("regularize", false),
        light_sampler: args.choice("lightsampler", None, &samplers),
    }
}

/// The acceleration structure of a scene that has no Accelerator directive.
pub(super) fn default_accelerator(span: Span) -> AcceleratorDesc {
    AcceleratorDesc { kind: AcceleratorKind::Bvh, span }
}

/// Reads the parameters of an accelerator class; `None` when it is unknown (and reported).
pub(super) fn accelerator(class: &Text, directive: Span, args: &mut Args<'_>) -> Option<AcceleratorDesc> {
    let kind = match class.value.as_str() {
        "bvh" => {
            let methods = [("sah", ()), ("hlbvh", ()), ("middle", ()), ("equal", ())];
            args.choice("splitmethod", (), &methods);
            args.count("maxnodeprims", 4, COUNTS);
            AcceleratorKind::Bvh
        }
        "kdtree" => {
            args.int_opt("intersectcost");
            args.int_opt("traversalcost");
            args.float_where("emptybonus", 0.5, |v| (0.0..=1.0).contains(&v), "from 0 to 1");
            args.int_opt("maxprims");
            args.int_opt("maxdepth");
            AcceleratorKind::KdTree
        }
        _ => {
            args.unknown_class("accelerator", class, &["bvh", "kdtree"], &["grid"]);
            return None;
        }
    };
    Some(AcceleratorDesc { kind, span: directive })
}
