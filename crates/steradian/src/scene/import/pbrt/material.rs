//! Material classes.

use super::args::Args;
use super::spectrum::Role;
use crate::scene::desc::{
    ConductorOptics, FloatParam, LayerDesc, MaterialKind, RoughnessDesc, SpectrumParam, SpectrumValue,
};
use crate::scene::text::Text;

const CLASSES: &[&str] = &[
    "diffuse",
    "coateddiffuse",
    "diffusetransmission",
    "conductor",
    "coatedconductor",
    "dielectric",
    "thindielectric",
    "mix",
    "interface",
    "hair",
    "measured",
    "subsurface",
];
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

/// Reads the parameters of a material class; `None` when the class is unknown or unsupported (and reported).
pub(super) fn material(class: &Text, args: &mut Args<'_>) -> Option<MaterialKind> {
    Some(match class.value.as_str() {
        "diffuse" => {
            MaterialKind::Diffuse { reflectance: args.spectrum_param("reflectance", Role::Albedo, 0.5) }
        }
        "diffusetransmission" => MaterialKind::DiffuseTransmission {
            reflectance: args.spectrum_param("reflectance", Role::Albedo, 0.25),
            transmittance: args.spectrum_param("transmittance", Role::Albedo, 0.25),
            scale: args.non_negative("scale", 1.0),
        },
        "conductor" => MaterialKind::Conductor {
            optics: conductor(args, "eta", "k"),
            roughness: roughness(args, ["roughness", "uroughness", "vroughness"]),
        },
        "dielectric" => MaterialKind::Dielectric {
            eta: args.refractive_index("eta", 1.5),
            roughness: roughness(args, ["roughness", "uroughness", "vroughness"]),
        },
        "thindielectric" => MaterialKind::ThinDielectric { eta: args.refractive_index("eta", 1.5) },
        "coateddiffuse" => MaterialKind::CoatedDiffuse {
            reflectance: args.spectrum_param("reflectance", Role::Albedo, 0.5),
            roughness: roughness(args, ["roughness", "uroughness", "vroughness"]),
            eta: args.refractive_index("eta", 1.5),
            layer: layer(args),
        },
        "coatedconductor" => coated_conductor(args),
        "mix" => return mix(args),
        "interface" => MaterialKind::Interface,
        "" | "none" => {
            let name = &class.value;
            let message = format!("material \"{name}\" is an old name of \"interface\"");
            args.ctx.diagnostics.notice(class.span, message);
            MaterialKind::Interface
        }
        "hair" | "measured" | "subsurface" => {
            args.unsupported_class("material", class);
            return None;
        }
        _ => {
            args.unknown_class("material", class, CLASSES, V3_CLASSES);
            return None;
        }
    })
}

fn roughness(args: &mut Args<'_>, names: [&'static str; 3]) -> RoughnessDesc {
    let [both, u, v] = names;
    let both = args.float_param(both, 0.0);
    RoughnessDesc {
        u: args.float_param_opt(u).unwrap_or(both),
        v: args.float_param_opt(v).unwrap_or(both),
        remap: args.bool("remaproughness", true),
    }
}

/// Scattering events, and walks, within a layered material: each point that is hit pays for all of them.
const MAX_WALK: u32 = 1000;

fn layer(args: &mut Args<'_>) -> LayerDesc {
    LayerDesc {
        thickness: args.float_param("thickness", 0.01),
        g: args.float_param("g", 0.0),
        albedo: args.spectrum_param("albedo", Role::Albedo, 0.0),
        max_depth: args.count("maxdepth", 10, 0..=MAX_WALK),
        n_samples: args.count("nsamples", 1, 1..=MAX_WALK),
    }
}

fn conductor(args: &mut Args<'_>, eta_name: &'static str, k_name: &'static str) -> ConductorOptics {
    let span = args.span_of("reflectance");
    let reflectance = args.spectrum_param_opt("reflectance", Role::Albedo);
    let (eta, k) = (
        args.spectrum_param_opt(eta_name, Role::Unbounded),
        args.spectrum_param_opt(k_name, Role::Unbounded),
    );
    if let Some(reflectance) = reflectance {
        if eta.is_some() || k.is_some() {
            args.error(span, format!("give \"reflectance\", or \"{eta_name}\" and \"{k_name}\", not both"));
        }
        return ConductorOptics::Reflectance(reflectance);
    }
    let copper = |name: &str, args: &Args<'_>| {
        SpectrumParam::Value(args.default_spectrum(SpectrumValue::Named(name.to_owned())))
    };
    ConductorOptics::Index {
        eta: eta.unwrap_or_else(|| copper("metal-Cu-eta", args)),
        k: k.unwrap_or_else(|| copper("metal-Cu-k", args)),
    }
}

fn coated_conductor(args: &mut Args<'_>) -> MaterialKind {
    let interface_roughness =
        roughness(args, ["interface.roughness", "interface.uroughness", "interface.vroughness"]);
    let interface_eta = args.refractive_index("interface.eta", 1.5);
    let optics = conductor(args, "conductor.eta", "conductor.k");
    let both = args.float_param("conductor.roughness", 0.0);
    let conductor_roughness = RoughnessDesc {
        u: args.float_param_opt("conductor.uroughness").unwrap_or(both),
        v: args.float_param_opt("conductor.vroughness").unwrap_or(both),
        remap: interface_roughness.remap,
    };
    let layer = layer(args);
    MaterialKind::CoatedConductor { interface_roughness, interface_eta, optics, conductor_roughness, layer }
}

fn mix(args: &mut Args<'_>) -> Option<MaterialKind> {
    let amount: FloatParam = args.float_param("amount", 0.5);
    let Some(names) = args.texts("materials") else {
        args.missing("materials");
        return None;
    };
    let [a, b] = names.values.as_slice() else {
        let n = names.values.len();
        args.error(names.span, format!("\"materials\" takes the names of 2 materials, found {n}"));
        return None;
    };
    let materials = [args.ctx.materials.refer(a), args.ctx.materials.refer(b)];
    Some(MaterialKind::Mix { materials, amount })
}
