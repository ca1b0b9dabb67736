//! The validation table: the instruments against the closed forms of lighting.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use statrs::distribution::{ContinuousCDF, StudentsT};
use steradian::lab::validation::{cases, run, table};
use steradian::lab::{Precision, Session};
use steradian::render::CancelToken;

#[test]
fn every_case_agrees_with_its_closed_form_to_half_a_percent() {
    let cancel = CancelToken::new();
    let precision = Precision { relative: 0.005, ..Precision::default() };
    let session = Session { precision, seed: 1, threads: None, cancel: &cancel };
    let results = run(&cases(), &session, |_| ()).unwrap();
    // Šidák's level for all cases together 1 %, with no fewer than 31 degrees of freedom.
    let level = 1.0 - 0.99_f64.powf(1.0 / results.len() as f64);
    let bound = StudentsT::new(0.0, 1.0, 31.0).unwrap().inverse_cdf(1.0 - 0.5 * level);
    let wrong: Vec<_> = results
        .iter()
        .filter(|r| {
            let width = 0.005 * r.case.expected.max(r.measured.value);
            let far = (r.measured.value - r.case.expected).abs() > 0.01 * r.case.expected;
            far || !(r.z.abs() <= bound) || !(r.measured.half_width <= width)
        })
        .map(|r| format!("{} {}: {}, z {:.2}", r.case.kind, r.case.name, r.measured, r.z))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}\n{}", table(&results, &session).to_text());
    assert_eq!(results.len(), cases().len());
    assert!(results.len() >= 60);
}

#[test]
fn a_wrong_factor_is_noticed() {
    // One case with a number that is 2 % off.
    let mut wrong = cases().swap_remove(0);
    wrong.expected *= 1.02;
    let cancel = CancelToken::new();
    let precision = Precision { relative: 0.001, ..Precision::default() };
    let session = Session { precision, seed: 1, threads: None, cancel: &cancel };
    let results = run(&[wrong], &session, |_| ()).unwrap();
    assert!(results[0].z < -10.0, "{}", results[0].z);
    assert!(table(&results, &session).to_csv().contains("illuminance") || results[0].case.unit == "lx");
}
