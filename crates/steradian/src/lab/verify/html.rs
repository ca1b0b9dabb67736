//! The report as a page for people, in one file.

use super::report::{AlbedoAt, Inspection, Report, Standing, SubjectReport, Verdict, degrees};
use crate::bsdf::Side;
use crate::bsdf::conformance::Law;
use crate::lab::plot::{Axis, Chart, Curve, series_ink, svg, wavelength_ink};
use crate::lab::plot::{Dash, Ink};
use crate::spectrum::LANES;
use std::fmt::Write as _;

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em;color:#222;background:#fff}\
h1{font-size:1.5em}h2{font-size:1.1em;margin:2em 0 .3em;border-top:1px solid #ddd;padding-top:1em}\
table{border-collapse:collapse;margin:.5em 0}td,th{padding:.15em .8em .15em 0;text-align:left;vertical-align:top}\
th{border-bottom:1px solid #999}.n{text-align:right;font-variant-numeric:tabular-nums}\
.pass{color:#060}.fail{color:#b00;font-weight:bold}.declared{color:#850}.none{color:#777}\
svg{max-width:100%;height:auto}.plots{display:flex;flex-wrap:wrap;gap:1em}.plots>*{flex:1 1 26em}";

/// The report as one HTML page with its plots inside: no script, no other file.
pub fn html(report: &Report, title: &str) -> String {
    let mut page = String::new();
    let title = escaped(title);
    // Writing to a String does not fail.
    let _ = write!(
        page,
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title><style>{STYLE}</style></head><body>\n\
         <h1>{title}</h1>\n<p>ρ and τ are ratios of scattered to incident power for light from one direction. \
         A law that holds is rejected anywhere in this report with probability {}. Seed {}.</p>\n\
         <table><tr><th>subject</th><th>laws that hold</th><th>worst reciprocity</th><th>largest ρ + τ</th><th>verdict</th></tr>\n",
        report.level, report.seed
    );
    for (i, subject) in report.subjects.iter().enumerate() {
        let [held, examined] = subject.counts();
        let pair = subject.worst_pair().map_or(String::new(), |p| format!("{:.1e}", p.relative()));
        let bright =
            subject.brightest().map_or(String::new(), |b| format!("{:.4} at {:.0}°", b.value, b.theta));
        let _ = writeln!(
            page,
            "<tr><td><a href=\"#s{i}\">{}</a></td><td class=n>{held}/{examined}</td><td class=n>{pair}</td>\
             <td class=n>{bright}</td><td>{}</td></tr>",
            escaped(&subject.name),
            verdict(subject)
        );
    }
    page.push_str("</table>\n");
    for (i, subject) in report.subjects.iter().enumerate() {
        section(&mut page, i, subject);
    }
    page.push_str("</body></html>\n");
    page
}

fn verdict(subject: &SubjectReport) -> String {
    let (class, words) = match subject.verdict() {
        Verdict::Lawful => ("pass", "passes"),
        Verdict::BrokenAsDeclared => ("declared", "breaks laws as declared"),
        Verdict::Contradicted => ("fail", "FAILS"),
        Verdict::NotExamined => ("none", "not examined"),
    };
    format!("<span class={class}>{words}</span>")
}

fn section(page: &mut String, i: usize, subject: &SubjectReport) {
    let _ = writeln!(page, "<h2 id=\"s{i}\">{} — {}</h2>", escaped(&subject.name), verdict(subject));
    if let Some(note) = &subject.note {
        let _ = writeln!(page, "<p>{}</p>", escaped(note));
    }
    if subject.inspections.is_empty() {
        return;
    }
    page.push_str("<table><tr><th>law</th><th></th><th>worst evidence</th><th>directions (θ, φ)</th></tr>\n");
    for law in Law::ALL {
        let (Some(standing), Some((inspection, finding))) = (subject.standing(law), subject.worst(law))
        else {
            continue;
        };
        let (class, words) = match standing {
            Standing::Holds => ("pass", "holds"),
            Standing::BrokenAsDeclared => ("declared", "broken as declared"),
            Standing::Reported => ("declared", "reported"),
            Standing::Contradicted => ("fail", "CONTRADICTED"),
        };
        let angles = |w| {
            let [theta, phi] = degrees(w);
            format!("({theta:.1}°, {phi:.1}°)")
        };
        let mut at = angles(finding.wo);
        if let Some(wi) = finding.wi {
            let _ = write!(at, " ↔ {}", angles(wi));
        }
        if let Some(nm) = inspection.wavelength(finding.lane) {
            let _ = write!(at, " at {nm} nm");
        }
        let _ = writeln!(
            page,
            "<tr><td>{}<br><small>{}</small></td><td class={class}>{words}</td><td>{}</td><td>{at}</td></tr>",
            law.name(),
            escaped(law.statement()),
            escaped(&finding.evidence.to_string())
        );
    }
    page.push_str("</table>\n<div class=plots>\n");
    page.push_str(&angle_chart(subject));
    if !subject.over_wavelength.is_empty() {
        page.push_str(&wavelength_chart(subject));
    }
    page.push_str("</div>\n");
}

/// A curve over the angle from above, with the answers by quadrature as crosses of their own.
fn angle_chart(subject: &SubjectReport) -> String {
    let wavelengths = subject.over_angle.first().and_then(|a| a.wavelengths);
    let shown = |lane: usize| match wavelengths {
        Some(w) => !w[..lane].contains(&w[lane]),
        None => !is_grey(&subject.over_angle) || lane == 0,
    };
    let label = |lane: usize| match wavelengths {
        Some(w) => format!("{} nm", w[lane]),
        None if is_grey(&subject.over_angle) => String::new(),
        None => format!("wavelength {}", lane + 1),
    };
    let ink =
        |lane: usize| wavelengths.map_or_else(|| series_ink(lane), |w| wavelength_ink(f64::from(w[lane])));
    let mut curves = Vec::new();
    for lane in (0..LANES).filter(|&lane| shown(lane)) {
        for side in [Side::Reflection, Side::Transmission] {
            let own = |a: &AlbedoAt| f64::from(of(a, side)[lane]);
            let above: Vec<[f64; 2]> =
                subject.over_angle.iter().filter(|a| a.theta < 90.0).map(|a| [a.theta, own(a)]).collect();
            if side == Side::Transmission && above.iter().all(|p| p[1] == 0.0) {
                continue;
            }
            let name = format!("{} {}", symbol(side), label(lane));
            curves.push(dashed(Curve::new(name.trim_end(), ink(lane), above), side));
            if let Some(inspection) = subject.inspections.first() {
                curves.extend(crosses(inspection, side, lane, ink(lane)));
            }
        }
    }
    let chart = Chart {
        title: "power over the angle of incidence; crosses by quadrature".to_owned(),
        x: Axis::angle("angle of incidence [°]"),
        y: Axis::new("ρ, τ [1]").including(&[0.0, 1.0]),
        curves,
    };
    svg(&chart.draw())
}

fn wavelength_chart(subject: &SubjectReport) -> String {
    let mut curves = Vec::new();
    let mut angles: Vec<f64> = subject.over_wavelength.iter().map(|a| a.theta).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    for (i, &theta) in angles.iter().enumerate() {
        for side in [Side::Reflection, Side::Transmission] {
            let mut points: Vec<[f64; 2]> = Vec::new();
            for a in subject.over_wavelength.iter().filter(|a| a.theta == theta) {
                let Some(lambda) = a.wavelengths else { continue };
                for (lambda, value) in lambda.into_iter().zip(of(a, side)) {
                    // The last lanes repeat a wavelength.
                    if points.last().is_none_or(|p| p[0] < f64::from(lambda)) {
                        points.push([f64::from(lambda), f64::from(value)]);
                    }
                }
            }
            if side == Side::Transmission && points.iter().all(|p| p[1] == 0.0) {
                continue;
            }
            let curve = Curve::new(format!("{} from {theta:.0}°", symbol(side)), series_ink(i), points);
            curves.push(dashed(curve, side));
        }
    }
    let chart = Chart {
        title: "power over wavelength".to_owned(),
        x: Axis::new("wavelength [nm]"),
        y: Axis::new("ρ, τ [1]").including(&[0.0, 1.0]),
        curves,
    };
    svg(&chart.draw())
}

/// Two strokes at each answer by quadrature.
fn crosses(inspection: &Inspection, side: Side, lane: usize, ink: Ink) -> Vec<Curve> {
    let powers = inspection.examination.powers.iter();
    let answers = powers.map(|p| {
        let value = match side {
            Side::Reflection => p.integrated.reflectance[lane],
            Side::Transmission => p.integrated.transmittance[lane],
        };
        (degrees(p.wi)[0], value)
    });
    let (dx, dy) = (0.7, 0.012);
    answers
        .filter(|(theta, _)| *theta <= 90.0)
        .flat_map(|(x, y)| {
            [[[x - dx, y - dy], [x + dx, y + dy]], [[x - dx, y + dy], [x + dx, y - dy]]]
                .map(|ends| Curve::new("", ink, ends.to_vec()))
        })
        .collect()
}

fn of(a: &AlbedoAt, side: Side) -> [f32; LANES] {
    match side {
        Side::Reflection => a.albedo.reflectance.to_array(),
        Side::Transmission => a.albedo.transmittance.to_array(),
    }
}

fn symbol(side: Side) -> &'static str {
    match side {
        Side::Reflection => "ρ",
        Side::Transmission => "τ",
    }
}

fn dashed(curve: Curve, side: Side) -> Curve {
    match side {
        Side::Reflection => curve,
        Side::Transmission => curve.dashed(Dash::Dashed),
    }
}

fn is_grey(curve: &[AlbedoAt]) -> bool {
    let equal = |v: [f32; LANES]| v.iter().all(|x| (x - v[0]).abs() < 1e-6);
    curve.iter().all(|a| equal(of(a, Side::Reflection)) && equal(of(a, Side::Transmission)))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
