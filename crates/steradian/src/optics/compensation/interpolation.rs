//! Piecewise linear functions of equidistant nodes.

/// Equidistant values of what else the loss depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) first: f32,
    pub(super) step: f32,
    pub(super) n: usize,
}

impl Axis {
    pub(super) fn new(first: f32, last: f32, n: usize) -> Self {
        let n = if last > first { n.max(2) } else { 1 };
        Self { first, step: if n > 1 { (last - first) / (n - 1) as f32 } else { 1.0 }, n }
    }

    pub(super) fn nodes(&self) -> impl Iterator<Item = f32> + use<> {
        let Self { first, step, n } = *self;
        (0..n).map(move |i| first + step * i as f32)
    }

    pub(super) fn position(&self, x: f32) -> f32 {
        ((x - self.first) / self.step).clamp(0.0, (self.n - 1) as f32)
    }
}

/// A place between two nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    i: usize,
    t: f32,
}

impl Cell {
    /// From a position of at least 0.
    pub(super) fn new(position: f32) -> Self {
        let i = position as usize;
        Self { i, t: position - i as f32 }
    }

    pub(super) fn lerp(self, values: &[f32]) -> f32 {
        let a = values[self.i];
        if self.t > 0.0 { a + self.t * (values[self.i + 1] - a) } else { a }
    }

    /// The nodes with their shares, none of which is zero.
    pub(super) fn shares(self) -> impl Iterator<Item = (usize, f32)> {
        [(self.i, 1.0 - self.t), (self.i + 1, self.t)].into_iter().filter(|&(_, share)| share > 0.0)
    }
}
