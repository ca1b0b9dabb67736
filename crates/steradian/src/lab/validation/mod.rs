//! The luxmeter held to closed forms, in situations of the kinds by which CIE 171:2006 tests lighting programs (its sections
//! 5.2–5.14).
//!
//! The document's own dimensions are not used, nor is conformity to it claimed: each case states its own, and the closed form
//! that it is held to.

mod contract;
mod daylight;
mod lamps;
mod mean;
mod text;

pub use contract::{ARITHMETIC, Case, CaseResult, Part, Reading, ValidationError};

use super::meters::{Aim, LuxSettings, MeterError, luminance, lux};
use super::session::{Ending, Session};
use super::table::{Cell, Column, Table};
use crate::math::hash;
use crate::render::setup;
use crate::scene::import::pbrt::{Input, import};
use crate::scene::{Diagnostics, RenderJob, compile};
use crate::units::Estimate;
use statrs::distribution::{ContinuousCDF, Normal};
use std::path::Path;

/// All cases, in the order of their kinds.
pub fn cases() -> Vec<Case> {
    let mut cases = lamps::cases();
    cases.extend(daylight::cases());
    let section = |c: &Case| c.kind.split('.').filter_map(|n| n.parse::<u32>().ok()).collect::<Vec<_>>();
    cases.sort_by_key(section);
    cases
}

/// Measures the cases one after the other, each as precisely as the session asks; `found` hears of each.
///
/// The list of results is shorter than that of the cases when the session is cancelled.
///
/// # Errors
/// When a case's scene is wrong, which no case of [`cases`] is.
pub fn run(
    cases: &[Case],
    session: &Session<'_>,
    mut found: impl FnMut(&CaseResult),
) -> Result<Vec<CaseResult>, ValidationError> {
    let mut results = Vec::with_capacity(cases.len());
    for case in cases {
        if session.cancel.is_cancelled() {
            break;
        }
        // Cases that shared their random numbers would err together.
        let seed = case.name.bytes().fold(session.seed, |seed, byte| hash::combine(seed, u64::from(byte)));
        let result = measure(case, &Session { seed, ..*session })?;
        found(&result);
        results.push(result);
    }
    Ok(results)
}

fn measure(case: &Case, session: &Session<'_>) -> Result<CaseResult, ValidationError> {
    let job = compiled(case)?;
    let problem = |reason| ValidationError::Meter { case: case.name.clone(), reason };
    let (reading, rays, ending) = read(case, &job, session).map_err(problem)?;
    let measured = reading.scaled(case.scale);
    Ok(CaseResult { case: case.clone(), measured, z: score(measured, case.expected, session), rays, ending })
}

fn compiled(case: &Case) -> Result<RenderJob, ValidationError> {
    let input = Input::Text { name: "case.pbrt", bytes: case.scene.as_bytes(), base: Path::new("") };
    let imported = import(&[input], &case.files);
    let mut diagnostics: Diagnostics = imported.diagnostics;
    let job = imported.scene.and_then(|scene| compile(scene, &case.files, &mut diagnostics));
    let wrong = || ValidationError::Scene {
        case: case.name.clone(),
        problems: diagnostics.display(&imported.sources).to_string(),
    };
    job.filter(|_| !diagnostics.has_errors()).ok_or_else(wrong)
}

fn read(case: &Case, job: &RenderJob, session: &Session<'_>) -> Result<(Estimate, u64, Ending), MeterError> {
    match &case.reading {
        Reading::Illuminance { point, part } => {
            let aim = if *part == Part::Total { Aim::Total } else { Aim::Parts };
            let settings = LuxSettings { aim, ..LuxSettings::default() };
            let readings = lux::measure(job, &[*point], &settings, session)?;
            Ok(readings.first().map_or((NOTHING, 0, Ending::Cancelled), |r| {
                let part = if *part == Part::Total { r.total } else { r.indirect };
                (part.estimate(), r.effort.rays, r.effort.ending)
            }))
        }
        Reading::MeanIlluminance { faces, part } => {
            let depth = LuxSettings::default().max_depth;
            let integrator = setup::metering(job, depth).ok_or(MeterError::NotTransport)?;
            let mean = mean::illuminance(job, &*integrator, faces, *part, session);
            Ok((mean.lux, mean.rays, mean.ending))
        }
        Reading::Luminance(ray) => {
            let settings = luminance::LuminanceSettings { acceptance: 0.0, ..Default::default() };
            let readings = luminance::measure(job, &[*ray], &settings, session)?;
            Ok(readings.first().map_or((NOTHING, 0, Ending::Cancelled), |r| {
                (r.mean.estimate(), r.effort.rays, r.effort.ending)
            }))
        }
    }
}

/// A reading that was not taken.
const NOTHING: Estimate = Estimate { value: 0.0, half_width: f64::INFINITY };

fn score(measured: Estimate, expected: f64, session: &Session<'_>) -> f64 {
    let quantile = Normal::standard().inverse_cdf(0.5 + 0.5 * session.precision.confidence);
    let deviation = measured.value - expected;
    let beyond = (deviation.abs() - ARITHMETIC * expected.abs()).max(0.0);
    if beyond == 0.0 { 0.0 } else { beyond.copysign(deviation) * quantile / measured.half_width }
}

/// The results as a table.
pub fn table(results: &[CaseResult], session: &Session<'_>) -> Table {
    let columns = vec![
        Column::words("kind"),
        Column::words("case"),
        Column::words("closed form"),
        Column::words("unit"),
        Column::new("expected", "unit of the case"),
        Column::new("measured", "unit of the case"),
        Column::new("z", "1"),
        Column::new("rays", "1"),
    ];
    let mut table = Table::new("Validation against closed forms", columns);
    for CaseResult { case, measured, z, rays, .. } in results {
        table.rows.push(vec![
            case.kind.into(),
            case.name.as_str().into(),
            case.formula.into(),
            case.unit.into(),
            rounded(case.expected).into(),
            Cell::Estimate(*measured),
            ((z * 100.0).round() / 100.0).into(),
            (*rays as f64).into(),
        ]);
    }
    let percent = |x: f64| (x * 1e8).round() / 1e6;
    let precision = &session.precision;
    table.fact(
        "kinds",
        "situations of the kinds that CIE 171:2006 tests in its sections 5.2-5.14, with dimensions of our own; \
         no conformity is claimed",
    );
    table.fact("intervals", format!("{} % confidence, statistical only", percent(precision.confidence)));
    table.fact("z", "deviation over standard error, 2e-5 of the value being left to arithmetic");
    table.fact("precision asked", format!("{} %", percent(precision.relative)));
    let beyond = results.iter().filter(|r| !(r.z.abs() <= 1.96)).count();
    table.fact(
        "beyond 1.96",
        format!("{beyond} of {}, where {:.1} are to be expected", results.len(), 0.05 * results.len() as f64),
    );
    table.fact("rays", results.iter().map(|r| r.rays).sum::<u64>().to_string());
    let imprecise = results.iter().filter(|r| r.ending != Ending::Precise).count();
    table.fact(
        "ending",
        match imprecise {
            0 => Ending::Precise.name().to_owned(),
            n => format!("{n} of {} cases ended before the precision was met", results.len()),
        },
    );
    table.fact("seed", session.seed.to_string());
    table
}

/// Six significant digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
