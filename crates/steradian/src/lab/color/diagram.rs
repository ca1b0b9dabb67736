//! The CIE 1931 chromaticity diagram.

use crate::color::colorimetry::{Xy, planckian_uv};
use crate::lab::plot::{Anchor, Dash, Drawing, Ink, Stroke, series_ink, text_width, wavelength_ink};
use crate::spectrum::cie;

/// A colour in the diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// What it is.
    pub name: String,
    /// Where it is.
    pub at: Xy,
    /// Half-widths of the intervals of x and y; zero for none.
    pub half_widths: [f64; 2],
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 630.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 40.0;
/// Pixels for a step of 1, the same along both axes.
const UNIT: f64 = 610.0;
/// Ends of the axes.
const END: [f64; 2] = [0.8, 0.88];
const SMALL: f64 = 11.0;

/// The spectral locus, the Planckian locus with temperatures, and the colours.
pub fn diagram(title: &str, spots: &[Spot]) -> Drawing {
    let mut d = Drawing::new(WIDTH, HEIGHT);
    axes(&mut d);
    let outline = spectral_locus();
    for pair in outline.windows(2) {
        let middle = 0.5 * (pair[0].0 + pair[1].0);
        let stroke = Stroke::solid(wavelength_ink(middle), 2.6);
        d.line(vec![place(pair[0].1), place(pair[1].1)], stroke);
    }
    if let (Some(first), Some(last)) = (outline.first(), outline.last()) {
        let stroke = Stroke { ink: Ink::GREY, width: 1.2, dash: Dash::Dashed };
        d.line(vec![place(first.1), place(last.1)], stroke);
    }
    wavelengths(&mut d, &outline);
    planckian_locus(&mut d);
    for (i, spot) in spots.iter().enumerate() {
        mark(&mut d, spot, series_ink(i));
    }
    names(&mut d, spots);
    let middle = LEFT + 0.5 * END[0] * UNIT;
    d.text([0.5 * WIDTH, 24.0], title, 14.0, Anchor::Middle, Ink::BLACK);
    d.text([middle, HEIGHT - 10.0], "x [1]", 12.0, Anchor::Middle, Ink::BLACK);
    d.text_up([20.0, TOP + 0.5 * END[1] * UNIT], "y [1]", 12.0, Anchor::Middle, Ink::BLACK);
    d
}

fn place(p: Xy) -> [f64; 2] {
    [LEFT + p.x * UNIT, TOP + (END[1] - p.y) * UNIT]
}

fn axes(d: &mut Drawing) {
    let grid = Stroke::solid(Ink::PALE, 1.0);
    for i in 0..=8 {
        let v = 0.1 * f64::from(i);
        let label = format!("{v:.1}");
        let [x, bottom] = place(Xy { x: v, y: 0.0 });
        d.line(vec![[x, bottom], place(Xy { x: v, y: END[1] })], grid);
        d.text([x, bottom + 16.0], &label, SMALL, Anchor::Middle, Ink::BLACK);
        let [left, y] = place(Xy { x: 0.0, y: v });
        d.line(vec![[left, y], place(Xy { x: END[0], y: v })], grid);
        d.text([left - 6.0, y + 0.35 * SMALL], &label, SMALL, Anchor::End, Ink::BLACK);
    }
    let corners = [[0.0, 0.0], [END[0], 0.0], END, [0.0, END[1]], [0.0, 0.0]];
    let frame = corners.iter().map(|c| place(Xy { x: c[0], y: c[1] })).collect();
    d.line(frame, Stroke::solid(Ink::BLACK, 1.0));
}

/// Wavelengths [nm] and chromaticities of monochromatic light, from violet to red.
fn spectral_locus() -> Vec<(f64, Xy)> {
    // Beyond these the chromaticity hardly moves.
    (390..=700)
        .step_by(2)
        .map(|l| {
            let [x, y, z] = cie::bars(l as f32).map(f64::from);
            let sum = x + y + z;
            (f64::from(l), Xy { x: x / sum, y: y / sum })
        })
        .collect()
}

/// Labels of round wavelengths outside of the locus.
fn wavelengths(d: &mut Drawing, outline: &[(f64, Xy)]) {
    for lambda in [460.0, 470.0, 480.0, 490.0, 500.0, 510.0, 520.0, 540.0, 560.0, 580.0, 600.0, 620.0, 700.0]
    {
        let Some(i) = outline.iter().position(|o| o.0 == lambda) else { continue };
        let p = place(outline[i].1);
        let (a, b) =
            (place(outline[i.saturating_sub(1)].1), place(outline[(i + 1).min(outline.len() - 1)].1));
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy).max(1e-9);
        // To the left of the way from violet to red, but not onto the numbers of the axis.
        let side = if (485.0..515.0).contains(&lambda) { -1.0 } else { 1.0 };
        let (nx, ny) = (side * dy / length, side * -dx / length);
        d.line(vec![p, [p[0] + 5.0 * nx, p[1] + 5.0 * ny]], Stroke::solid(Ink::GREY, 1.0));
        let anchor = if nx < -0.4 {
            Anchor::End
        } else if nx > 0.4 {
            Anchor::Start
        } else {
            Anchor::Middle
        };
        let at = [p[0] + 9.0 * nx, p[1] + 9.0 * ny + 0.35 * SMALL];
        let label = if lambda == 520.0 { "520 nm".to_owned() } else { format!("{lambda}") };
        d.text(at, label, SMALL, anchor, Ink::GREY);
    }
}

/// x and y of a black body.
fn black_body(kelvin: f64) -> Option<Xy> {
    let p = planckian_uv(kelvin)?;
    let sum = 2.0 * p.u - 8.0 * p.v + 4.0;
    Some(Xy { x: 3.0 * p.u / sum, y: 2.0 * p.v / sum })
}

fn planckian_locus(d: &mut Drawing) {
    let points: Vec<_> = (1..=100).filter_map(|i| black_body(1e5 / f64::from(i))).map(place).collect();
    d.line(points, Stroke::solid(Ink::BLACK, 1.4));
    for kelvin in [1000.0, 2000.0, 3000.0, 4000.0, 6500.0, 10_000.0, 100_000.0] {
        let (Some(p), Some(next)) = (black_body(kelvin), black_body(kelvin * 1.01)) else { continue };
        let (p, next) = (place(p), place(next));
        let (dx, dy) = (next[0] - p[0], next[1] - p[1]);
        let length = dx.hypot(dy).max(1e-9);
        // Across the locus; labels below it, where there is room.
        let (nx, ny) = (-dy / length, dx / length);
        let (nx, ny) = if ny > 0.0 { (nx, ny) } else { (-nx, -ny) };
        d.line(
            vec![[p[0] - 3.5 * nx, p[1] - 3.5 * ny], [p[0] + 3.5 * nx, p[1] + 3.5 * ny]],
            Stroke::solid(Ink::BLACK, 1.4),
        );
        // Low temperatures, where the locus falls to the right, have theirs on the left.
        let (side, anchor) = if kelvin < 2500.0 { (-6.0, Anchor::End) } else { (2.0, Anchor::Start) };
        let at = [p[0] + 4.0 * nx + side, p[1] + 4.0 * ny + 10.0];
        let label = if kelvin == 100_000.0 { "10⁵ K".to_owned() } else { format!("{kelvin} K") };
        d.text(at, label, 10.0, anchor, Ink::GREY);
    }
}

/// A dot in a ring, with bars where the intervals can be seen.
fn mark(d: &mut Drawing, spot: &Spot, ink: Ink) {
    let c = place(spot.at);
    let ring = |r: f64| -> Vec<[f64; 2]> {
        (0..=24)
            .map(|i| {
                let (sin, cos) = (f64::from(i) / 24.0 * std::f64::consts::TAU).sin_cos();
                [c[0] + r * cos, c[1] + r * sin]
            })
            .collect()
    };
    for (axis, half) in spot.half_widths.iter().enumerate() {
        let half = half * UNIT;
        if half.is_finite() && half > 5.0 {
            let (mut a, mut b) = (c, c);
            a[axis] -= half;
            b[axis] += half;
            d.line(vec![a, b], Stroke::solid(ink, 1.4));
        }
    }
    d.area(ring(5.5), Ink::WHITE, 1.0);
    d.line(ring(5.5), Stroke::solid(ink, 1.8));
    d.area(ring(2.2), ink, 1.0);
}

/// The names of the colours, in the empty corner beyond the line of reds.
fn names(d: &mut Drawing, spots: &[Spot]) {
    const ROW: f64 = 17.0;
    const MOST: usize = 12;
    let right = LEFT + END[0] * UNIT - 12.0;
    let longest = spots.iter().take(MOST).map(|s| text_width(&s.name, SMALL)).fold(0.0, f64::max);
    for (i, spot) in spots.iter().take(MOST).enumerate() {
        let y = TOP + 18.0 + i as f64 * ROW;
        let left = right - longest - 14.0;
        let corners = vec![[left, y - 8.0], [left + 9.0, y - 8.0], [left + 9.0, y + 1.0], [left, y + 1.0]];
        d.area(corners, series_ink(i), 1.0);
        d.text([left + 14.0, y], &spot.name, SMALL, Anchor::Start, Ink::BLACK);
    }
    if spots.len() > MOST {
        let y = TOP + 18.0 + MOST as f64 * ROW;
        d.text([right, y], format!("and {} more", spots.len() - MOST), SMALL, Anchor::End, Ink::GREY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::plot::Mark;

    #[test]
    fn spots_stand_at_their_coordinates() {
        let at = Xy { x: 1.0 / 3.0, y: 1.0 / 3.0 };
        let spot = Spot { name: "white".to_owned(), at, half_widths: [0.02, 0.0] };
        let d = diagram("t", &[spot]);
        let expected = place(at);
        let found = d.marks.iter().any(|m| match m {
            // The horizontal bar of the interval, 2 · 0.02 long.
            Mark::Line { points, .. } => {
                points.len() == 2
                    && (points[1][0] - points[0][0] - 0.04 * UNIT).abs() < 1e-9
                    && (points[0][1] - expected[1]).abs() < 1e-9
            }
            _ => false,
        });
        assert!(found);
    }

    #[test]
    fn the_planckian_locus_ends_where_it_is_known_to() {
        // 2856 K and the limit of infinite temperature.
        let a = black_body(2855.5).unwrap();
        assert!((a.x - 0.4476).abs() < 2e-4 && (a.y - 0.4074).abs() < 2e-4, "{a:?}");
        let end = black_body(1e9).unwrap();
        assert!((end.x - 0.2399).abs() < 2e-4 && (end.y - 0.2341).abs() < 2e-4, "{end:?}");
    }
}
