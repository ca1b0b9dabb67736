//! The report on the terminal: one line for each subject, then what is wrong.

use std::fmt::Write as _;
use steradian::bsdf::conformance::Law;
use steradian::lab::verify::{Acceptance, Report, Standing, SubjectReport, Verdict, degrees};

pub(super) fn text(report: &Report, acceptance: Acceptance) -> String {
    let width = report.subjects.iter().map(|s| s.name.chars().count()).max().unwrap_or(0).clamp(8, 44);
    let mut out = format!(
        "{:width$}  {:>6}  {:>13}  {:>17}  verdict\n",
        "subject", "laws", "reciprocity", "largest ρ + τ"
    );
    for subject in &report.subjects {
        line(&mut out, subject, width);
    }
    for subject in report.subjects.iter().filter(|s| !s.passes(acceptance)) {
        explain(&mut out, subject);
    }
    summary(&mut out, report, acceptance);
    out
}

fn line(out: &mut String, subject: &SubjectReport, width: usize) {
    let name = &subject.name;
    if subject.verdict() == Verdict::NotExamined {
        let note = subject.note.as_deref().unwrap_or_default();
        // Writing to a String does not fail.
        let _ = writeln!(out, "{name:width$}  {:>6}  {:>13}  {:>17}  {note}", "-", "-", "-");
        return;
    }
    let [held, examined] = subject.counts();
    let laws = format!("{held}/{examined}");
    let pair = subject.worst_pair().map_or("-".to_owned(), |p| {
        // Where the difference is known from samples, the number alone would accuse chance.
        match p.relative_tolerance() {
            t if t > 0.01 => format!("{:.0e} ± {t:.0e}", p.relative()),
            _ => format!("{:.1e}", p.relative()),
        }
    });
    let bright =
        subject.brightest().map_or("-".to_owned(), |b| format!("{:.4} at {:>3.0}°", b.value, b.theta));
    let verdict = match subject.verdict() {
        Verdict::Lawful if subject.reports_reciprocity() => "pass, reciprocity not claimed",
        Verdict::Lawful => "pass",
        Verdict::BrokenAsDeclared if subject.claims.is_some_and(|c| c.has_named_bias()) => "biased as named",
        Verdict::BrokenAsDeclared => "breaks laws as declared",
        Verdict::Contradicted => "FAIL",
        Verdict::NotExamined => "-",
    };
    let _ = writeln!(out, "{name:width$}  {laws:>6}  {pair:>13}  {bright:>17}  {verdict}");
}

fn explain(out: &mut String, subject: &SubjectReport) {
    let _ = writeln!(out, "\n{}:", subject.name);
    if let Some(note) = &subject.note {
        let _ = writeln!(out, "  {note}");
    }
    for law in Law::ALL {
        let Some(standing) = subject.standing(law) else { continue };
        let words = match standing {
            Standing::Holds | Standing::Reported => continue,
            Standing::BrokenAsDeclared => "broken as declared",
            Standing::Contradicted => "BROKEN",
        };
        let Some((inspection, finding)) = subject.worst(law) else { continue };
        let words = if standing == Standing::Contradicted && finding.holds() {
            "HOLDS, declared broken"
        } else {
            words
        };
        let _ = writeln!(out, "  {} {words}: {}", law.name(), law.statement());
        let _ = write!(out, "    {}", finding.evidence);
        let angles = |w| {
            let [theta, phi] = degrees(w);
            format!("(θ {theta:.2}°, φ {phi:.2}°)")
        };
        match finding.wi {
            Some(wi) => {
                let _ = write!(out, "\n    wo = {}, wi = {}", angles(finding.wo), angles(wi));
            }
            None => {
                let _ = write!(out, "\n    at {}", angles(finding.wo));
            }
        }
        if let Some(nm) = inspection.wavelength(finding.lane) {
            let _ = write!(out, ", {nm} nm");
        } else if let Some(lane) = finding.lane {
            let _ = write!(out, ", wavelength {} of the specimen", lane + 1);
        }
        let [u, v] = inspection.uv;
        if [u, v] != [0.5, 0.5] {
            let _ = write!(out, ", uv ({u}, {v})");
        }
        out.push('\n');
    }
}

fn summary(out: &mut String, report: &Report, acceptance: Acceptance) {
    let count = |v: Verdict| report.subjects.iter().filter(|s| s.verdict() == v).count();
    let (lawful, declared, failed) =
        (count(Verdict::Lawful), count(Verdict::BrokenAsDeclared), count(Verdict::Contradicted));
    let _ = write!(out, "\n{} subjects: {lawful} lawful", report.subjects.len());
    if declared > 0 {
        let verb = match acceptance {
            Acceptance::AsDeclared => "",
            Acceptance::Lawful => " (accepted with --declared)",
        };
        let _ = write!(out, ", {declared} break a law as they declare{verb}");
    }
    let _ = write!(out, ", {failed} fail");
}
