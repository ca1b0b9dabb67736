//! Which integrator renders what the scene asks for, and what is said about it.

use crate::light::Selection;
use crate::scene::desc::{IntegratorDesc, IntegratorKind, LightSamplerKind};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::job::PathSettings;
use crate::scene::source::Span;

/// What decides whether a path tracer misses light that another integrator would find.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CausticRisk {
    /// Some light has no extent.
    pub(super) delta_lights: bool,
    /// Some surface scatters into discrete directions only.
    pub(super) specular_surfaces: bool,
}

/// Settings of the path tracer for any integrator that it can stand in for. `scene` is the place of what nobody stated.
pub(super) fn choose(
    desc: &IntegratorDesc,
    scene: Span,
    risk: CausticRisk,
    diagnostics: &mut Diagnostics,
) -> PathSettings {
    let substitute = |name: &str, max_depth: u32, regularize: bool, diagnostics: &mut Diagnostics| {
        let mut message = format!("integrator \"{name}\" is rendered with \"path\"");
        if risk.delta_lights && risk.specular_surfaces {
            message.push_str(
                "; caustics of point, spot and distant lights through specular surfaces will be missing",
            );
        }
        diagnostics.notice(desc.span, message);
        PathSettings { max_depth, regularize }
    };
    match desc.kind {
        IntegratorKind::Path(p) => PathSettings { max_depth: p.max_depth, regularize: p.regularize },
        // The format's default, which nobody asked for by name, is nothing to remark on.
        IntegratorKind::VolPath(p) if desc.span == scene => {
            PathSettings { max_depth: p.max_depth, regularize: p.regularize }
        }
        // Without media it is the same estimator.
        IntegratorKind::VolPath(p) => substitute("volpath", p.max_depth, p.regularize, diagnostics),
        IntegratorKind::SimplePath { max_depth } => substitute("simplepath", max_depth, false, diagnostics),
        IntegratorKind::SimpleVolPath { max_depth } => {
            substitute("simplevolpath", max_depth, false, diagnostics)
        }
        IntegratorKind::LightPath { max_depth } => substitute("lightpath", max_depth, false, diagnostics),
        IntegratorKind::RandomWalk { max_depth } => substitute("randomwalk", max_depth, false, diagnostics),
        IntegratorKind::Bdpt { max_depth, regularize } => {
            substitute("bdpt", max_depth, regularize, diagnostics)
        }
        IntegratorKind::Mlt { max_depth, regularize } => {
            substitute("mlt", max_depth, regularize, diagnostics)
        }
        IntegratorKind::Sppm { max_depth } => substitute("sppm", max_depth, false, diagnostics),
        IntegratorKind::AmbientOcclusion => {
            diagnostics.push(
                Diagnostic::error(
                    desc.span,
                    "integrator \"ambientocclusion\" is not supported: it shows no radiance",
                )
                .with_help("\"path\" renders the scene's own lights"),
            );
            PathSettings { max_depth: 0, regularize: false }
        }
    }
}

/// How lights are chosen: by power, unless the scene asks for something else.
pub(super) fn selection(desc: &IntegratorDesc, diagnostics: &mut Diagnostics) -> Selection {
    let (IntegratorKind::Path(p) | IntegratorKind::VolPath(p)) = desc.kind else { return Selection::Power };
    match p.light_sampler {
        None | Some(LightSamplerKind::Power) => Selection::Power,
        Some(LightSamplerKind::Uniform) => Selection::Uniform,
        Some(LightSamplerKind::Bvh) => Selection::Position,
        Some(LightSamplerKind::Exhaustive) => {
            diagnostics.notice(desc.span, "light sampler \"exhaustive\" is rendered with \"bvh\"");
            Selection::Position
        }
    }
}
