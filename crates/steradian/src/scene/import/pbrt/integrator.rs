//! Integrator and accelerator classes.

use super::args::Args;
use super::light::normalization;
use super::spectrum::Role;
use crate::scene::desc::{
    AmbientDesc, ClassicDesc, IntegratorDesc, IntegratorKind, LightSamplerKind, PathDesc,
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
    "classic",
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
        "simplepath" => {
            let [lights, bsdf] = ["samplelights", "samplebsdf"].map(|name| args.bool(name, true));
            if !(lights && bsdf) {
                let place = args.span_of(if lights { "samplebsdf" } else { "samplelights" });
                args.ctx.diagnostics.notice(place, "lights and BSDFs are both sampled all the same");
            }
            IntegratorKind::SimplePath { max_depth: depth(args) }
        }
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
        "mlt" => {
            for (name, default) in
                [("bootstrapsamples", 100_000), ("chains", 1000), ("mutationsperpixel", 100)]
            {
                args.count(name, default, COUNTS);
            }
            args.positive("sigma", 0.01);
            args.float_where("largestepprobability", 0.3, |v| (0.0..=1.0).contains(&v), "from 0 to 1");
            IntegratorKind::Mlt { max_depth: depth(args), regularize: args.bool("regularize", false) }
        }
        "sppm" => {
            args.int_opt("photonsperiteration");
            args.positive("radius", 1.0);
            args.int_opt("seed");
            IntegratorKind::Sppm { max_depth: depth(args) }
        }
        "ambientocclusion" => {
            args.bool("cossample", true);
            args.positive("maxdistance", f32::INFINITY);
            IntegratorKind::AmbientOcclusion
        }
        "classic" => IntegratorKind::Classic(classic(class, args)),
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

fn classic(class: &Text, args: &mut Args<'_>) -> ClassicDesc {
    let (scale, normalization) = (args.non_negative("scale", 1.0), normalization(class, args));
    let ambient = args.spectrum_opt("ambient", Role::Illuminant).map(|radiance| AmbientDesc {
        radiance,
        scale,
        normalization,
    });
    ClassicDesc { ambient, shadows: args.bool("shadows", false) }
}

/// Checks the parameters of an accelerator class, whose choice is the renderer's; `None` when it is unknown (and
/// reported).
pub(super) fn accelerator(class: &Text, args: &mut Args<'_>) -> Option<()> {
    match class.value.as_str() {
        "bvh" => {
            let methods = [("sah", ()), ("hlbvh", ()), ("middle", ()), ("equal", ())];
            args.choice("splitmethod", (), &methods);
            args.count("maxnodeprims", 4, COUNTS);
            Some(())
        }
        "kdtree" => {
            args.int_opt("intersectcost");
            args.int_opt("traversalcost");
            args.float_where("emptybonus", 0.5, |v| (0.0..=1.0).contains(&v), "from 0 to 1");
            args.int_opt("maxprims");
            args.int_opt("maxdepth");
            Some(())
        }
        _ => {
            args.unknown_class("accelerator", class, &["bvh", "kdtree"], &["grid"]);
            None
        }
    }
}
