//! Angles at which a goniometer measured.

use std::f32::consts::{PI, TAU};

/// Increasing angles [rad], and what lies beyond them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    nodes: Vec<f32>,
    closure: Closure,
    /// One more than there are nodes: borders halfway between neighbours.
    borders: Vec<f32>,
}

/// What lies beyond the ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Closure {
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

/// A cell of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) start: f32,
    pub(super) end: f32,
}

impl Axis {
    /// Polar angles in [`min`, `max`], whose cells fill that range.
    pub(super) fn held(nodes: Vec<f32>, min: f32, max: f32) -> Self {
        let borders = borders(&nodes, min, max);
        Self { nodes, closure: Closure::Held, borders }
    }

    /// Azimuths that stand for the whole circle: mirrored where none lies beyond the half circle from zero to π.
    pub(super) fn azimuths(nodes: Vec<f32>, may_mirror: bool) -> Self {
        let inside = |&a: &f32| (-1e-6..=PI + 1e-5).contains(&a);
        if may_mirror && nodes.iter().all(inside) {
            let borders = borders(&nodes, 0.0, PI);
            return Self { nodes, closure: Closure::Mirrored, borders };
        }
        // The first and the last node may be one place, measured twice.
        let middle = 0.5 * (nodes[0] + nodes[nodes.len() - 1] - TAU);
        let borders = borders(&nodes, middle, middle + TAU);
        Self { nodes, closure: Closure::Circle, borders }
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The widest step between neighbours around the circle [rad].
    pub(super) fn widest_gap(&self) -> f32 {
        let steps = self.nodes.windows(2).map(|w| w[1] - w[0]);
        let closing = self.nodes[0] + TAU - self.nodes[self.nodes.len() - 1];
        steps.fold(closing, f32::max)
    }

    /// How many directions an angle of a cell stands for.
    pub(super) fn images(&self) -> f32 {
        if self.closure == Closure::Mirrored { 2.0 } else { 1.0 }
    }

    /// `angle` moved by symmetry to where the borders are.
    fn folded(&self, angle: f32) -> f32 {
        match self.closure {
            Closure::Held => angle,
            Closure::Circle => self.borders[0] + (angle - self.borders[0]).rem_euclid(TAU),
            Closure::Mirrored => {
                let a = angle.rem_euclid(TAU);
                if a > PI { TAU - a } else { a }
            }
        }
    }

    /// The nodes around `angle`.
    pub(super) fn locate(&self, angle: f32) -> Between {
        let n = self.nodes.len();
        let x = self.folded(angle);
        let above = self.nodes.partition_point(|&node| node <= x);
        let between = |a: usize, b: usize, start: f32, end: f32| {
            let share = if end > start { ((x - start) / (end - start)).clamp(0.0, 1.0) } else { 0.0 };
            Between { nodes: [a, b], share }
        };
        match (above, self.closure) {
            (0, Closure::Circle) => between(n - 1, 0, self.nodes[n - 1] - TAU, self.nodes[0]),
            (i, Closure::Circle) if i == n => between(n - 1, 0, self.nodes[n - 1], self.nodes[0] + TAU),
            (0, _) => Between { nodes: [0, 0], share: 0.0 },
            (i, _) if i == n => Between { nodes: [n - 1, n - 1], share: 0.0 },
            (i, _) => between(i - 1, i, self.nodes[i - 1], self.nodes[i]),
        }
    }

    /// The number of the cell that holds `angle`.
    pub(super) fn cell_at(&self, angle: f32) -> usize {
        let x = self.folded(angle);
        self.borders.partition_point(|&b| b <= x).clamp(1, self.nodes.len()) - 1
    }

    /// The cell around a node.
    pub(super) fn cell(&self, i: usize) -> Cell {
        Cell { start: self.borders[i], end: self.borders[i + 1] }
    }
}

/// Borders halfway between the nodes, and the ends given.
fn borders(nodes: &[f32], first: f32, last: f32) -> Vec<f32> {
    let inner = nodes.windows(2).map(|w| 0.5 * (w[0] + w[1]));
    std::iter::once(first).chain(inner).chain([last]).collect()
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
        assert_eq!(circle.cell_at(340.0_f32.to_radians()), 0);
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
        let cells: f32 = (0..axis.len()).map(|i| axis.cell(i).end - axis.cell(i).start).sum();
        assert!((cells - TAU).abs() < 1e-5);
        assert!((axis.widest_gap() - 120.0_f32.to_radians()).abs() < 1e-5);
        assert_eq!(axis.locate(350.0_f32.to_radians()).nodes, [2, 3]);
    }

    #[test]
    fn each_angle_lies_in_the_cell_of_its_nearest_node() {
        for axis in [
            Axis::azimuths(degrees(&[-170.0, -20.0, 30.0, 130.0]), true),
            Axis::azimuths(degrees(&[10.0, 60.0, 175.0]), true),
            Axis::held(degrees(&[5.0, 20.0, 80.0]), 0.0, 0.5 * PI),
        ] {
            for i in 0..720 {
                let angle = (i as f32 * 0.5 + 0.13).to_radians();
                let angle = if axis.closure == Closure::Held { 0.25 * angle } else { angle - PI };
                let b = axis.locate(angle);
                let nearest = b.nodes[usize::from(b.share > 0.5)];
                assert_eq!(axis.cell_at(angle), nearest, "{angle} {b:?}");
            }
        }
    }
}
