//! The report for scripts.

use serde_json::{Value, json};
use steradian::bsdf::conformance::{Evidence, Finding, Law, Power};
use steradian::bsdf::{Claims, Energy, Mode, Reciprocity, Values};
use steradian::lab::verify::{
    Acceptance, AlbedoAt, Inspection, Report, Standing, SubjectReport, Verdict, degrees,
};

pub(super) fn text(report: &Report, acceptance: Acceptance) -> String {
    let object = json!({
        "units": {
            "angle": "degree", "wavelength": "nm", "reflectance": "1", "transmittance": "1", "f": "1/sr",
            "direction": "[theta, phi] in degrees, theta from the surface normal",
        },
        "seed": report.seed,
        "level": report.level,
        "accepted": match acceptance { Acceptance::Lawful => "lawful", Acceptance::AsDeclared => "as declared" },
        "pass": report.passes(acceptance),
        "subjects": report.subjects.iter().map(|s| subject(s, acceptance)).collect::<Vec<_>>(),
    });
    format!("{object:#}")
}

fn subject(s: &SubjectReport, acceptance: Acceptance) -> Value {
    let verdict = match s.verdict() {
        Verdict::Lawful => "lawful",
        Verdict::BrokenAsDeclared => "broken as declared",
        Verdict::Contradicted => "contradicted",
        Verdict::NotExamined => "not examined",
    };
    let pair = s.worst_pair().map(|p| {
        json!({
            "directions": p.directions, "there": p.there, "back": p.back, "tolerance": p.tolerance,
            "relative": p.relative(), "wavelength": p.wavelength,
        })
    });
    let bright = s.brightest().map(
        |b| json!({ "value": b.value, "standard_error": b.error, "theta": b.theta, "wavelength": b.wavelength }),
    );
    json!({
        "name": s.name,
        "verdict": verdict,
        "pass": s.passes(acceptance),
        "note": s.note,
        "claims": s.claims.as_ref().map(claims),
        "laws": Law::ALL.into_iter().filter_map(|law| law_of(s, law)).collect::<Vec<_>>(),
        "worst_pair": pair,
        "largest_reflectance_plus_transmittance": bright,
        "powers": s.inspections.iter().flat_map(|i| i.examination.powers.iter().map(|p| power(i, p))).collect::<Vec<_>>(),
        "albedo_over_angle": s.over_angle.iter().map(albedo).collect::<Vec<_>>(),
        "albedo_over_wavelength": s.over_wavelength.iter().map(albedo).collect::<Vec<_>>(),
    })
}

fn claims(c: &Claims) -> Value {
    let (energy, tolerance) = match c.energy {
        Energy::Lossless { tolerance } => ("lossless", Some(tolerance)),
        Energy::Passive => ("passive", None),
        Energy::Unbounded => ("unbounded", None),
    };
    json!({
        "energy": energy,
        "tolerance": tolerance,
        "reciprocity": match c.reciprocity {
            Reciprocity::Exact => "exact",
            Reciprocity::Reported => "reported",
            Reciprocity::Broken => "broken",
        },
        "values": match c.values {
            Values::ClosedForm => "closed form",
            Values::Estimated => "estimated",
            Values::Biased => "biased",
            Values::BiasedClosedForm => "biased closed form",
        },
    })
}

fn law_of(s: &SubjectReport, law: Law) -> Option<Value> {
    let standing = match s.standing(law)? {
        Standing::Holds => "holds",
        Standing::BrokenAsDeclared => "broken as declared",
        Standing::Reported => "reported",
        Standing::Contradicted => "contradicted",
    };
    let (inspection, finding) = s.worst(law)?;
    Some(json!({
        "law": law.name(),
        "statement": law.statement(),
        "standing": standing,
        "wo": degrees(finding.wo),
        "wi": finding.wi.map(degrees),
        "wavelength": inspection.wavelength(finding.lane),
        "uv": inspection.uv,
        "transported": match finding.mode { Mode::Radiance => "radiance", Mode::Importance => "power" },
        "evidence": evidence(finding),
    }))
}

fn evidence(finding: &Finding) -> Value {
    match finding.evidence {
        Evidence::Probability { statistic, degrees_of_freedom, p, significance } => json!({
            "chi_square": statistic, "degrees_of_freedom": degrees_of_freedom, "p": p, "rejected_below": significance,
        }),
        Evidence::Equality { observed, expected, tolerance } => {
            json!({ "observed": observed, "expected": expected, "tolerance": tolerance })
        }
        Evidence::Bound { observed, limit } => json!({ "observed": observed, "limit": limit }),
    }
}

fn power(inspection: &Inspection, p: &Power) -> Value {
    let answer = |a: &steradian::bsdf::conformance::Answer| json!({ "reflectance": a.reflectance, "transmittance": a.transmittance });
    json!({
        "wi": degrees(p.wi),
        "uv": inspection.uv,
        "wavelengths": inspection.wavelengths,
        "by_sampling": answer(&p.sampled),
        "standard_error": answer(&p.error),
        "by_quadrature": answer(&p.integrated),
        "by_albedo": answer(&p.own),
    })
}

fn albedo(a: &AlbedoAt) -> Value {
    json!({
        "theta": a.theta,
        "wavelengths": a.wavelengths,
        "reflectance": a.albedo.reflectance.to_array(),
        "transmittance": a.albedo.transmittance.to_array(),
    })
}
