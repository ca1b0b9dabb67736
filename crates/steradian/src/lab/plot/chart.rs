//! Curves over straight axes.

use super::curve::Curve;
use super::drawing::{Anchor, Drawing, Ink, Stroke, text_width};
use super::legend;
use super::ticks::{Ends, Ticks};

/// Nominal width of a chart with its legend [px].
pub const WIDTH: f64 = 640.0;
/// Nominal height of a chart [px].
pub const HEIGHT: f64 = 400.0;

const TITLE: f64 = 14.0;
const LABEL: f64 = 12.0;
const NUMBER: f64 = 11.0;

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten, that many of them below the largest value; smaller values lie on the lower end.
    Logarithmic {
        /// Their number, at least 1.
        decades: u32,
    },
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit, such as `wavelength [nm]`.
    pub label: String,
    /// Scale.
    pub scale: Scale,
    /// Values that the axis covers at least, besides those of the curves.
    pub include: Vec<f64>,
    /// Distance of marks on a linear axis, which then ends where the data do; `None` for a suitable one.
    pub step: Option<f64>,
}

impl Axis {
    /// A linear axis over what the curves cover.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, include: Vec::new(), step: None }
    }

    /// The same axis, which also covers these values.
    #[must_use]
    pub fn including(mut self, values: &[f64]) -> Self {
        self.include.extend(values);
        self
    }

    /// The same axis with marks at multiples of a step, above 0.
    #[must_use]
    pub fn stepped(self, step: f64) -> Self {
        Self { step: Some(step), ..self }
    }

    /// The same axis on another scale.
    #[must_use]
    pub fn scaled(self, scale: Scale) -> Self {
        Self { scale, ..self }
    }

    /// An axis of polar angles up to 90° with marks at every 15°.
    pub fn angle(label: impl Into<String>) -> Self {
        Self::new(label).including(&[0.0, 90.0]).stepped(15.0)
    }

    fn ticks(&self, curves: &[Curve], coordinate: usize, ends: Ends) -> Ticks {
        let extent = Curve::extent(curves, coordinate);
        let all = || self.include.iter().copied().chain(extent.into_iter().flatten());
        let (lo, hi) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        match (self.scale, self.step) {
            (Scale::Logarithmic { decades }, _) => Ticks::logarithmic(hi, decades.min(30) as i32),
            (Scale::Linear, Some(step)) => Ticks::stepped([lo, hi], step, Ends::Exact),
            (Scale::Linear, None) => Ticks::linear([lo, hi], 6, ends),
        }
    }
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What is seen.
    pub title: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// The curves, later ones over earlier ones.
    pub curves: Vec<Curve>,
}

impl Chart {
    /// The chart on a sheet of the nominal size.
    pub fn draw(&self) -> Drawing {
        let mut d = Drawing::new(WIDTH, HEIGHT);
        let x = self.x.ticks(&self.curves, 0, Ends::Exact);
        let y = self.y.ticks(&self.curves, 1, Ends::OnMarks);
        let numbers = y.at.iter().map(|v| text_width(&y.label(*v), NUMBER)).fold(0.0, f64::max);
        let left = 14.0 + LABEL + 8.0 + numbers + 6.0;
        let right = WIDTH - 20.0 - legend::width(&self.curves);
        let (top, bottom) = (40.0, HEIGHT - 52.0);
        let place = |p: [f64; 2]| {
            [left + x.fraction(p[0]) * (right - left), bottom - y.fraction(p[1]) * (bottom - top)]
        };

        let grid = Stroke::solid(Ink::PALE, 1.0);
        for &v in &x.at {
            let [px, _] = place([v, y.range[0]]);
            d.line(vec![[px, top], [px, bottom]], grid);
            d.text([px, bottom + 16.0], x.label(v), NUMBER, Anchor::Middle, Ink::BLACK);
        }
        for &v in &y.at {
            let [_, py] = place([x.range[0], v]);
            d.line(vec![[left, py], [right, py]], grid);
            d.text([left - 6.0, py + 0.35 * NUMBER], y.label(v), NUMBER, Anchor::End, Ink::BLACK);
        }
        for curve in &self.curves {
            for piece in curve.pieces(place) {
                d.line(piece, curve.stroke());
            }
        }
        let frame = vec![[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        d.line(frame, Stroke::solid(Ink::BLACK, 1.0));

        let middle = 0.5 * (left + right);
        d.text([0.5 * WIDTH, 24.0], fitted(&self.title, TITLE), TITLE, Anchor::Middle, Ink::BLACK);
        d.text([middle, HEIGHT - 14.0], &self.x.label, LABEL, Anchor::Middle, Ink::BLACK);
        d.text_up([8.0 + LABEL, 0.5 * (top + bottom)], &self.y.label, LABEL, Anchor::Middle, Ink::BLACK);
        legend::draw(&mut d, [right + 14.0, top], bottom - top, &self.curves);
        d
    }
}

/// A title that is cut where the sheet ends.
pub(super) fn fitted(title: &str, size: f64) -> String {
    let room = WIDTH - 24.0;
    if text_width(title, size) <= room {
        return title.to_owned();
    }
    let mut cut = String::new();
    for c in title.chars() {
        cut.push(c);
        if text_width(&cut, size) + size > room {
            break;
        }
    }
    cut.pop();
    cut.push('…');
    cut
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::plot::drawing::Mark;

    /// The curve's points on paper.
    fn drawn(chart: &Chart) -> Vec<Vec<[f64; 2]>> {
        let ink = chart.curves[0].ink;
        let lines = chart.draw().marks.into_iter().filter_map(|m| match m {
            Mark::Line { points, stroke } if stroke.ink == ink && stroke.width > 1.5 => Some(points),
            _ => None,
        });
        lines.collect()
    }

    fn chart(points: Vec<[f64; 2]>) -> Chart {
        let curves = vec![Curve::new("", Ink::new(1, 2, 3), points)];
        Chart { title: "t".to_owned(), x: Axis::new("x [1]"), y: Axis::new("y [1]"), curves }
    }

    #[test]
    fn a_straight_line_stays_straight_and_rises_upwards() {
        let lines = drawn(&chart(vec![[0.0, 0.0], [1.0, 10.0], [2.0, 20.0]]));
        let [[x0, y0], [x1, y1], [x2, y2]] = lines[0][..] else { panic!("{lines:?}") };
        assert!(x2 > x0 && y2 < y0);
        assert!((x1 - 0.5 * (x0 + x2)).abs() < 1e-9 && (y1 - 0.5 * (y0 + y2)).abs() < 1e-9);
    }

    #[test]
    fn missing_values_interrupt_a_curve_and_do_not_reach_the_paper() {
        let points =
            vec![[0.0, 1.0], [1.0, 2.0], [2.0, f64::NAN], [3.0, 3.0], [4.0, 1.0], [5.0, f64::INFINITY]];
        let lines = drawn(&chart(points)).iter().filter(|l| l.len() == 2).count();
        // Two pieces; without a name there is no line in a legend.
        assert_eq!(lines, 2);
    }

    #[test]
    fn every_mark_lies_on_the_sheet() {
        let curves = (0..40)
            .map(|i| {
                Curve::new(format!("curve number {i}"), Ink::BLACK, vec![[0.0, 0.0], [1.0, f64::from(i)]])
            })
            .collect();
        let title = "a title that is far too long for the sheet ".repeat(5);
        let chart = Chart { title, x: Axis::new("x"), y: Axis::new("y"), curves };
        for mark in chart.draw().marks {
            let (points, slack) = match mark {
                Mark::Line { points, .. } | Mark::Area { points, .. } => (points, [0.0; 2]),
                Mark::Text(t) => {
                    let w = text_width(&t.text, t.size);
                    let slack = match t.anchor {
                        Anchor::Start => [0.0, w],
                        Anchor::Middle => [0.5 * w, 0.5 * w],
                        Anchor::End => [w, 0.0],
                    };
                    (vec![t.at], slack)
                }
            };
            for [x, y] in points {
                assert!(
                    x - slack[0] >= 0.0 && x + slack[1] <= WIDTH && (0.0..=HEIGHT).contains(&y),
                    "{x} {y}"
                );
            }
        }
    }
}
