//! Which integrator renders what the scene asks for, and what is said about it.

use crate::light::Light;
use crate::light::Selection;
use crate::material::{Declared, LegacyPhongMaterial};
use crate::math::{AnimatedTransform, Transform};
use crate::scene::desc::{IntegratorDesc, IntegratorKind, LightDesc, LightKind, LightSamplerKind, SceneDesc};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::job::{ClassicSettings, IntegratorSettings, PathSettings};

/// What decides whether a path tracer misses light that another integrator would find.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CausticRisk {
    /// Some light has no extent.
    pub(super) delta_lights: bool,
    /// Some surface scatters into discrete directions only.
    pub(super) specular_surfaces: bool,
}

/// The uniform surroundings of legacy shading, as a light.
pub(super) fn surroundings(desc: &IntegratorDesc) -> Option<LightDesc> {
    let IntegratorKind::Classic(classic) = &desc.kind else { return None };
    let ambient = classic.ambient.as_ref()?;
    Some(LightDesc {
        kind: LightKind::UniformInfinite { radiance: ambient.radiance.clone() },
        scale: ambient.scale,
        normalization: ambient.normalization,
        total: None,
        world_from_light: AnimatedTransform::fixed(Transform::IDENTITY),
        medium: None,
        span: ambient.radiance.span,
    })
}

/// Settings of the integrator that renders the scene.
pub(super) fn choose(
    scene: &SceneDesc,
    risk: CausticRisk,
    ambient: Option<Light>,
    diagnostics: &mut Diagnostics,
) -> IntegratorSettings {
    if let IntegratorKind::Classic(classic) = &scene.integrator.kind {
        report_lights_left_out(scene, diagnostics);
        let ambient = ambient.map(Box::new);
        return IntegratorSettings::Classic(ClassicSettings { ambient, shadows: classic.shadows });
    }
    for material in scene.materials.iter().filter(|m| m.class.name == LegacyPhongMaterial::CLASS) {
        let message = "material \"phong\" is legacy shading, not a BRDF: paths through it may gain light, and depend on their direction";
        diagnostics.push(Diagnostic::notice(material.span, message).with_help(
            "integrator \"classic\" shades it as its text does; material \"modifiedphong\" is the BRDF",
        ));
    }
    IntegratorSettings::Path(path(scene, risk, diagnostics))
}

/// Legacy shading sums over lights that shine from one direction each, A (28).
fn report_lights_left_out(scene: &SceneDesc, diagnostics: &mut Diagnostics) {
    let extended = |kind: &LightKind| {
        matches!(
            kind,
            LightKind::UniformInfinite { .. }
                | LightKind::ImageInfinite { .. }
                | LightKind::Sky(_)
                | LightKind::Sun(_)
        )
    };
    let skies = scene.lights.iter().filter(|l| extended(&l.kind)).map(|l| l.span);
    for span in skies.chain(scene.area_lights.iter().map(|l| l.span)) {
        diagnostics.push(
            Diagnostic::notice(span, "integrator \"classic\" leaves out lights that have an extent")
                .with_help("it knows point, spot and distant lights, and its own \"spectrum ambient\""),
        );
    }
}

/// Settings of the path tracer for any integrator that it can stand in for.
fn path(scene: &SceneDesc, risk: CausticRisk, diagnostics: &mut Diagnostics) -> PathSettings {
    let desc = &scene.integrator;
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
        IntegratorKind::VolPath(p) if desc.span == scene.span => {
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
        // Traces no paths.
        IntegratorKind::Classic(_) => PathSettings { max_depth: 0, regularize: false },
    }
}

/// How lights are chosen: by what they may contribute at a point, unless the scene asks for something else.
pub(super) fn selection(desc: &IntegratorDesc, diagnostics: &mut Diagnostics) -> Selection {
    let (IntegratorKind::Path(p) | IntegratorKind::VolPath(p)) = desc.kind else {
        return Selection::Position;
    };
    match p.light_sampler {
        Some(LightSamplerKind::Power) => Selection::Power,
        Some(LightSamplerKind::Uniform) => Selection::Uniform,
        None | Some(LightSamplerKind::Bvh) => Selection::Position,
        Some(LightSamplerKind::Exhaustive) => {
            diagnostics.notice(desc.span, "light sampler \"exhaustive\" is rendered with \"bvh\"");
            Selection::Position
        }
    }
}
