//! Sampler classes.

use super::args::Args;
use crate::scene::desc::{MAX_SAMPLES, NoiseTarget, Randomization, SamplerDesc, SamplerKind};
use crate::scene::source::Span;
use crate::scene::text::Text;

const CLASSES: &[&str] =
    &["halton", "independent", "paddedsobol", "pmj02bn", "sobol", "stratified", "zsobol"];
const V3_CLASSES: &[&str] =
    &["02sequence", "lowdiscrepancy", "maxmindist", "random", "zerotwosequence", "adaptive", "bestcandidate"];

const RANDOMIZATIONS: [(&str, Randomization); 4] = [
    ("none", Randomization::None),
    ("permutedigits", Randomization::PermuteDigits),
    ("fastowen", Randomization::FastOwen),
    ("owen", Randomization::Owen),
];

/// The sampler of a scene that has no Sampler directive.
pub(super) fn default_sampler(span: Span) -> SamplerDesc {
    let kind = SamplerKind::ZSobol(Randomization::FastOwen);
    SamplerDesc { kind, pixel_samples: 16, noise: None, seed: None, span }
}

/// Reads the parameters of a sampler class; `None` when it is unknown (and reported).
pub(super) fn sampler(class: &Text, directive: Span, args: &mut Args<'_>) -> Option<SamplerDesc> {
    let owen = |args: &mut Args<'_>| args.choice("randomization", Randomization::FastOwen, &RANDOMIZATIONS);
    let kind = match class.value.as_str() {
        "independent" => SamplerKind::Independent,
        "stratified" => SamplerKind::Stratified {
            x: args.count("xsamples", 4, 1..=1 << 15),
            y: args.count("ysamples", 4, 1..=1 << 15),
            jitter: args.bool("jitter", true),
        },
        "halton" => {
            // Binary scrambling does not apply to the bases of Halton's sequence in pbrt's "fastowen" form.
            let known = [RANDOMIZATIONS[0], RANDOMIZATIONS[1], RANDOMIZATIONS[3]];
            SamplerKind::Halton(args.choice("randomization", Randomization::PermuteDigits, &known))
        }
        "sobol" => SamplerKind::Sobol(owen(args)),
        "paddedsobol" => SamplerKind::PaddedSobol(owen(args)),
        "zsobol" => SamplerKind::ZSobol(owen(args)),
        "pmj02bn" => SamplerKind::Pmj02bn,
        _ => {
            args.unknown_class("sampler", class, CLASSES, V3_CLASSES);
            return None;
        }
    };
    let pixel_samples = match kind {
        SamplerKind::Stratified { x, y, .. } => x * y,
        SamplerKind::Independent => args.count("pixelsamples", 4, 1..=MAX_SAMPLES),
        _ => args.count("pixelsamples", 16, 1..=MAX_SAMPLES),
    };
    if pixel_samples > MAX_SAMPLES {
        let span = args.span_of("xsamples");
        args.error(
            span,
            format!("{pixel_samples} strata are more than the {MAX_SAMPLES} samples that a pixel can have"),
        );
    }
    // Our own; pbrt-v4 knows no such parameter.
    let noise_span = args.span_of("noise");
    let noise = args.float_opt("noise").and_then(|fraction| {
        let target = NoiseTarget::new(fraction);
        if target.is_none() {
            let demand = "must be above 0 and at most 1, such as 0.01";
            args.error(noise_span, format!("parameter \"noise\" {demand}, found {fraction}"));
        }
        target
    });
    Some(SamplerDesc { kind, pixel_samples, noise, seed: args.int_opt("seed"), span: directive })
}
