//! What charts draw.

use super::drawing::{Dash, Ink, Stroke};

/// Width of a curve [px].
const WIDTH: f64 = 1.8;

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name in the legend; an empty one is not listed.
    pub label: String,
    /// Colour.
    pub ink: Ink,
    /// Interruptions.
    pub dash: Dash,
    /// x and y in the units of the axes (in a polar chart: angle [degrees] and radius); a value that is not
    /// finite interrupts the curve.
    pub points: Vec<[f64; 2]>,
}

impl Curve {
    /// A solid curve.
    pub fn new(label: impl Into<String>, ink: Ink, points: Vec<[f64; 2]>) -> Self {
        Self { label: label.into(), ink, dash: Dash::Solid, points }
    }

    /// The same curve, interrupted.
    #[must_use]
    pub fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }

    pub(super) fn stroke(&self) -> Stroke {
        Stroke { ink: self.ink, width: WIDTH, dash: self.dash }
    }

    /// Smallest and largest finite values of a coordinate; `None` when there is none.
    pub(super) fn extent(curves: &[Self], coordinate: usize) -> Option<[f64; 2]> {
        let values = curves.iter().flat_map(|c| &c.points).filter(|p| p.iter().all(|x| x.is_finite()));
        values.map(|p| p[coordinate]).fold(None, |range, x| {
            let [lo, hi] = range.unwrap_or([x, x]);
            Some([x.min(lo), x.max(hi)])
        })
    }

    /// The curve on paper, in pieces where values are missing.
    pub(super) fn pieces(&self, place: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
        let runs = self.points.split(|p| !p.iter().all(|x| x.is_finite()));
        runs.filter(|r| r.len() >= 2).map(|r| r.iter().map(|p| place(*p)).collect()).collect()
    }
}
