//! The names of curves beside a chart.

use super::curve::Curve;
use super::drawing::{Anchor, Drawing, Ink, text_width};

const SIZE: f64 = 11.0;
const ROW: f64 = 17.0;
const SAMPLE: f64 = 26.0;
const GAP: f64 = 7.0;

/// Room that the legend needs beside the chart [px]; none when no curve has a name.
pub(super) fn width(curves: &[Curve]) -> f64 {
    let longest = curves.iter().map(|c| text_width(&c.label, SIZE)).fold(0.0, f64::max);
    if longest > 0.0 { SAMPLE + GAP + longest + 2.0 * GAP } else { 0.0 }
}

/// Draws the legend with its upper left corner at `at`; names that do not fit into `height` are counted.
pub(super) fn draw(drawing: &mut Drawing, at: [f64; 2], height: f64, curves: &[Curve]) {
    let mut named: Vec<&Curve> = Vec::new();
    for curve in curves.iter().filter(|c| !c.label.is_empty()) {
        // Pieces of one curve, such as its two sides, are named once.
        if !named.iter().any(|n| (&n.label, n.ink, n.dash) == (&curve.label, curve.ink, curve.dash)) {
            named.push(curve);
        }
    }
    let rows = ((height / ROW) as usize).max(1);
    let shown = if named.len() > rows { rows - 1 } else { named.len() };
    for (i, curve) in named.iter().take(shown).enumerate() {
        let y = at[1] + (i as f64 + 0.5) * ROW;
        drawing.line(vec![[at[0], y], [at[0] + SAMPLE, y]], curve.stroke());
        let place = [at[0] + SAMPLE + GAP, y + 0.35 * SIZE];
        drawing.text(place, &curve.label, SIZE, Anchor::Start, Ink::BLACK);
    }
    if shown < named.len() {
        let y = at[1] + (shown as f64 + 0.5) * ROW + 0.35 * SIZE;
        drawing.text([at[0], y], format!("and {} more", named.len() - shown), SIZE, Anchor::Start, Ink::GREY);
    }
}
