//! `steradian measure validation`: the instruments held to closed forms.

use super::common::{Desk, Outputs, Sampling};
use crate::Failure;
use clap::Args;
use steradian::lab::plot::{Axis, Chart, Curve, Dash, Ink, series_ink};
use steradian::lab::validation::{CaseResult, cases, run as measure, table};
use steradian::render::CancelToken;

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Validation {
    /// Only cases of this kind, such as 5.8; may be repeated [default: all]
    #[arg(long, value_name = "SECTION", value_parser = parse_kind)]
    kind: Vec<String>,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    sampling: Sampling,
}

const NOTES: &str = "\
Measures rooms, openings and lamps of the kinds that CIE 171:2006 tests in its sections 5.2-5.14, with dimensions
of our own, and compares with closed forms. z is the deviation over its standard error: of many honest cases one
in twenty is beyond 1.96. No conformity to the document is claimed.

Example: the reflected light in a cube to half a percent
  steradian measure validation --kind 5.8 --precision 0.5%";

fn parse_kind(text: &str) -> Result<String, String> {
    let mut known: Vec<_> = cases().iter().map(|c| c.kind).collect();
    known.dedup();
    match known.contains(&text) {
        true => Ok(text.to_owned()),
        false => Err(format!("expected one of {}", known.join(", "))),
    }
}

pub(crate) fn run(validation: &Validation, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&validation.outputs)?;
    let session = validation.sampling.session(cancel);
    let mut chosen = cases();
    chosen.retain(|case| validation.kind.is_empty() || validation.kind.iter().any(|kind| kind == case.kind));
    let results = measure(&chosen, &session, |_| ()).map_err(|e| e.to_string())?;
    desk.hand_out(&table(&results, &session), || chart(&results).draw(), cancel)
}

/// z over the number of the case.
fn chart(results: &[CaseResult]) -> Chart {
    let last = results.len() as f64;
    let points = results.iter().zip(1..).map(|(r, i)| [f64::from(i), r.z]).collect();
    let bound =
        |z: f64| Curve::new(format!("{z}"), Ink::GREY, vec![[1.0, z], [last, z]]).dashed(Dash::Dashed);
    Chart {
        title: "Validation against closed forms".to_owned(),
        x: Axis::new("case"),
        y: Axis::new("deviation over standard error [1]"),
        curves: vec![Curve::new("z", series_ink(0), points), bound(1.96), bound(-1.96)],
    }
}
