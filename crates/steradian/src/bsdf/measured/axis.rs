//! Angles at which a goniometer measured.

use std::f32::consts::{PI, TAU};

/// Increasing angles [rad], and what lies beyond them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    nodes: Vec<f32>,
    closure: Closure,
}

/// What lies beyond the ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Closure {
    /// The end's own value.
    Held,
    /// The circle closes.
    Circle,
    /// The half circle is mirrored: an angle stands for its opposite as well.
    Mirrored,
}

/// Two nodes around an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Between {
    pub(super) nodes: [usize; 2],
    /// Share of the second.
    pub(super) share: f32,
}

impl Between {
    /// The nodes with their shares.
    pub(super) fn parts(self) -> [(usize, f32); 2] {
        [(self.nodes[0], 1.0 - self.share), (self.nodes[1], self.share)]
    }
}

impl Axis {
    /// Polar angles, at least one.
    pub(super) fn held(nodes: Vec<f32>) -> Self {
        Self { nodes, closure: Closure::Held }
    }

    /// Azimuths, at least one, that stand for the whole circle: mirrored where that is allowed and none lies beyond
    /// the half circle from zero to π.
    pub(super) fn azimuths(nodes: Vec<f32>, may_mirror: bool) -> Self {
        let half = may_mirror && nodes.iter().all(|a| (-1e-6..=PI + 1e-5).contains(a));
        Self { nodes, closure: if half { Closure::Mirrored } else { Closure::Circle } }
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// What lies beyond the ends.
    pub(super) fn closure(&self) -> Closure {
        self.closure
    }

    /// The widest step between neighbours around the circle [rad].
    pub(super) fn widest_gap(&self) -> f32 {
        let steps = self.nodes.windows(2).map(|w| w[1] - w[0]);
        let closing = self.nodes[0] + TAU - self.nodes[self.nodes.len() - 1];
        steps.fold(closing, f32::max)
    }

    /// The nodes around `angle`.
    pub(super) fn locate(&self, angle: f32) -> Between {
        let n = self.nodes.len();
        let (first, last) = (self.nodes[0], self.nodes[n - 1]);
        let x = match self.closure {
            Closure::Held => angle,
            Closure::Circle => first + (angle - first).rem_euclid(TAU),
            Closure::Mirrored => {
                let a = angle.rem_euclid(TAU);
                if a > PI { TAU - a } else { a }
            }
        };
        let between = |a: usize, b: usize, start: f32, end: f32| {
            let share = if end > start { ((x - start) / (end - start)).clamp(0.0, 1.0) } else { 0.0 };
            Between { nodes: [a, b], share }
        };
        match (self.nodes.partition_point(|&node| node <= x), self.closure) {
            (0, _) => Between { nodes: [0, 0], share: 0.0 },
            (i, Closure::Circle) if i == n => between(n - 1, 0, last, first + TAU),
            (i, _) if i == n => Between { nodes: [n - 1, n - 1], share: 0.0 },
            (i, _) => between(i - 1, i, self.nodes[i - 1], self.nodes[i]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(nodes: &[f32]) -> Vec<f32> {
        nodes.iter().map(|d| d.to_radians()).collect()
    }

    #[test]
    fn a_circle_closes_and_a_half_circle_is_mirrored() {
        let circle = Axis::azimuths(degrees(&[0.0, 90.0, 180.0, 270.0]), true);
        let b = circle.locate(-45.0_f32.to_radians());
        assert_eq!(b.nodes, [3, 0]);
        assert!((b.share - 0.5).abs() < 1e-5);
        assert!((circle.widest_gap() - 90.0_f32.to_radians()).abs() < 1e-5);
        let half = Axis::azimuths(degrees(&[0.0, 90.0, 180.0]), true);
        for angle in [120.0_f32, 240.0, -120.0, 600.0] {
            let b = half.locate(angle.to_radians());
            assert_eq!(b.nodes, [1, 2], "{angle}");
            assert!((b.share - 1.0 / 3.0).abs() < 1e-5, "{angle}");
        }
    }

    #[test]
    fn a_place_measured_twice_leaves_no_gap() {
        let axis = Axis::azimuths(degrees(&[0.0, 120.0, 240.0, 360.0]), true);
        assert!((axis.widest_gap() - 120.0_f32.to_radians()).abs() < 1e-5);
        assert_eq!(axis.locate(350.0_f32.to_radians()).nodes, [2, 3]);
    }

    #[test]
    fn values_are_continuous_all_around() {
        for (axis, start) in [
            (Axis::azimuths(degrees(&[-170.0, -20.0, 30.0, 130.0]), true), -PI),
            (Axis::azimuths(degrees(&[10.0, 60.0, 175.0]), true), -PI),
            (Axis::held(degrees(&[5.0, 20.0, 80.0])), 0.0),
        ] {
            let values = [1.0, 4.0, 2.0, 3.0];
            let at = |angle| -> f32 { axis.locate(angle).parts().iter().map(|&(i, w)| w * values[i]).sum() };
            for i in 0..2000 {
                let angle = start + i as f32 * 2e-3;
                // No two neighbours differ by more than 3 over 15°.
                assert!((at(angle) - at(angle + 2e-3)).abs() < 0.03, "{angle}");
            }
        }
    }
}
