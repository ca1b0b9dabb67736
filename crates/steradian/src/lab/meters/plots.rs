//! Readings of meters as drawings.

use super::super::plot::chart::{Axis, Chart};
use super::super::plot::curve::Curve;
use super::super::plot::drawing::{Anchor, Drawing, Ink, Stroke};
use super::super::plot::palette::series_ink;
use crate::color::transfer::srgb_encode;
use crate::image::heat::heat_color;
use crate::units::Estimate;

/// Most curves of a chart: more cannot be told apart.
const MOST_CURVES: usize = 7;

/// Spectra over wavelength [nm], one for each place in the order of the places; of many, the first few are drawn. `place` is what the
/// places are called, `quantity` what is measured, with its unit.
pub fn spectra(quantity: &str, place: &str, wavelengths: &[f32], readings: &[Vec<Estimate>]) -> Drawing {
    let mut curves = Vec::new();
    for (i, spectrum) in readings.iter().take(MOST_CURVES).enumerate() {
        let ink = series_ink(i);
        let points: Vec<[f64; 2]> =
            wavelengths.iter().zip(spectrum).map(|(&l, e)| [f64::from(l), e.value]).collect();
        curves.push(Curve::new(format!("{place} {}", i + 1), ink, points));
        curves.extend(wavelengths.iter().zip(spectrum).map(|(&l, &e)| interval(f64::from(l), e, ink)));
    }
    chart(quantity, "wavelength [nm]", curves)
}

/// Readings over the number of their place, with their intervals.
pub fn along(quantity: &str, place: &str, readings: &[Estimate]) -> Drawing {
    let ink = series_ink(0);
    let number = |i: usize| (i + 1) as f64;
    let points = readings.iter().enumerate().map(|(i, e)| [number(i), e.value]).collect();
    let mut curves = vec![Curve::new("", ink, points)];
    curves.extend(readings.iter().enumerate().map(|(i, &e)| interval(number(i), e, ink)));
    chart(quantity, &format!("{place} [1]"), curves)
}

fn interval(x: f64, e: Estimate, ink: Ink) -> Curve {
    Curve::new("", ink, vec![[x, e.value - e.half_width], [x, e.value + e.half_width]])
}

fn chart(quantity: &str, x: &str, curves: Vec<Curve>) -> Drawing {
    let y = Axis::new(quantity).including(&[0.0]);
    Chart { title: quantity.to_owned(), x: Axis::new(x), y, curves }.draw()
}

/// Readings on the cells of a rectangle of the given sides [scene units] in false colours, the first cell at the lower left, rows
/// upwards; those that are missing stay white.
pub fn map(quantity: &str, cells: [usize; 2], sides: [f64; 2], readings: &[Estimate]) -> Drawing {
    const LONGEST: f64 = 480.0;
    const STEPS: usize = 64;
    let scale = LONGEST / sides[0].max(sides[1]);
    let [width, height] = sides.map(|s| (s * scale).max(24.0));
    let [nu, nv] = cells;
    let (left, top, bar) = (20.0, 40.0, 200.0_f64);
    let bottom = top + height.max(bar);
    let mut d = Drawing::new(left + width + 140.0, bottom + 44.0);
    let values = || readings.iter().map(|e| e.value).filter(|v| v.is_finite());
    let (lo, hi) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    let share = |v: f64| if hi > 0.0 { v / hi } else { 0.0 };
    let corners = |x: [f64; 2], y: [f64; 2]| vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
    for (i, e) in readings.iter().enumerate().take(nu * nv) {
        let (column, row) = ((i % nu) as f64, (i / nu) as f64);
        let x = [column, column + 1.0].map(|c| left + width * c / nu as f64);
        let y = [row, row + 1.0].map(|r| bottom - height * r / nv as f64);
        d.area(corners(x, y), ink(share(e.value)), 1.0);
    }
    let frame = corners([left, left + width], [bottom, bottom - height]);
    d.line(frame.iter().copied().chain(frame.first().copied()).collect(), Stroke::solid(Ink::BLACK, 1.0));
    // From zero, so that colours are in proportion.
    let x = [left + width + 20.0, left + width + 38.0];
    for i in 0..STEPS {
        let y = [i, i + 1].map(|i| bottom - bar * i as f64 / STEPS as f64);
        d.area(corners(x, y), ink((i as f64 + 0.5) / STEPS as f64), 1.0);
    }
    for i in 0..=4 {
        let v = hi * f64::from(i) / 4.0;
        let at = [x[1] + 6.0, bottom - bar * f64::from(i) / 4.0 + 4.0];
        d.text(at, shown(v), 11.0, Anchor::Start, Ink::BLACK);
    }
    d.text([left, 24.0], quantity, 14.0, Anchor::Start, Ink::BLACK);
    let extent = format!(
        "{} by {} scene units, {nu} by {nv} cells; least {}, greatest {}",
        sides[0],
        sides[1],
        shown(if lo.is_finite() { lo } else { 0.0 }),
        shown(hi)
    );
    d.text([left, bottom + 24.0], extent, 11.0, Anchor::Start, Ink::BLACK);
    d
}

fn ink(share: f64) -> Ink {
    let [r, g, b] = heat_color(share as f32).map(|c| (srgb_encode(c) * 255.0).round() as u8);
    Ink::new(r, g, b)
}

/// Three significant digits.
fn shown(v: f64) -> String {
    let rounded: f64 = format!("{v:.2e}").parse().unwrap_or(v);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}
