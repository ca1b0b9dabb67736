//! What is to be known about the readings of any meter.

use super::super::precision::Precision;
use super::super::session::{Ending, Session};
use super::super::table::Table;
use super::contract::Effort;

/// How the light was found, how precisely, and what it took; `efforts` are those of the first of `places`.
pub(super) fn facts<'e>(
    table: &mut Table,
    efforts: impl Iterator<Item = &'e Effort> + Clone,
    places: usize,
    max_depth: u32,
    session: &Session<'_>,
) {
    let Precision { relative, absolute, confidence, .. } = session.precision;
    let percent = |x: f64| (x * 1e8).round() / 1e6;
    table.fact("light", format!("paths of at most {max_depth} bounces with Russian roulette"));
    table.fact("intervals", format!("{} % confidence, statistical only", percent(confidence)));
    let floor = if absolute > 0.0 { format!(" or {absolute}") } else { String::new() };
    table.fact("precision asked", format!("{} %{floor}", percent(relative)));
    table.fact("rays", efforts.clone().map(|e| e.rays).sum::<u64>().to_string());
    let count = efforts.clone().count();
    let imprecise: Vec<Ending> = efforts.map(|e| e.ending).filter(|e| *e != Ending::Precise).collect();
    let ending = match imprecise.first() {
        _ if count < places => format!("{}: {count} of {places} measured", Ending::Cancelled.name()),
        None => Ending::Precise.name().to_owned(),
        Some(ending) => format!("{}, {} of {count} times", ending.name(), imprecise.len()),
    };
    table.fact("ending", ending);
    table.fact("seed", session.seed.to_string());
}
