//! The directions in which lost light is given back.

use super::elevation;
use crate::math::{LocalDir, Vec2, Vec3};
use std::f32::consts::PI;

/// A density of directions nearly in proportion to m cosθ, alike for every azimuth: piecewise constant over cos²θ.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lobe {
    /// The width whose coordinate delimits the pieces.
    alpha: f32,
    /// cos²θ between the pieces.
    edges: Vec<f32>,
    /// The probability below each edge.
    cumulative: Vec<f32>,
    /// Density over cos²θ within each piece.
    density: Vec<f32>,
}

impl Lobe {
    /// The share of directions that are cosine-distributed, whatever m is.
    const COSINE: f64 = 0.1;

    /// A lobe that is yet to be made.
    pub(super) fn none(alpha: f32) -> Self {
        Self { alpha, edges: Vec::new(), cumulative: Vec::new(), density: Vec::new() }
    }

    pub(super) fn new(alpha: f32, n_cosines: usize, m: impl Fn(f32) -> f32) -> Self {
        let last = (n_cosines - 1) as f64;
        let edge = |i: usize| elevation::cosine(i as f64 / last, f64::from(alpha)).clamp(0.0, 1.0).powi(2);
        let edges: Vec<f64> = (0..n_cosines).map(edge).collect();
        // m varies little within a piece.
        let middle = |a: f64, b: f64| f64::from(m((0.5 * (a + b)).sqrt() as f32));
        let masses: Vec<f64> = edges.windows(2).map(|e| (e[1] - e[0]) * middle(e[0], e[1])).collect();
        let total: f64 = masses.iter().sum();
        let mut lobe = Self {
            alpha,
            edges: Vec::new(),
            cumulative: vec![0.0],
            density: Vec::with_capacity(masses.len()),
        };
        let mut below = 0.0;
        for (e, mass) in edges.windows(2).zip(masses) {
            let size = e[1] - e[0];
            let share = if total > 0.0 { mass / total } else { size };
            let p = Self::COSINE * size + (1.0 - Self::COSINE) * share;
            below += p;
            lobe.cumulative.push(below as f32);
            lobe.density.push((p / size) as f32);
        }
        lobe.edges = edges.into_iter().map(|e| e as f32).collect();
        lobe
    }

    /// A direction in the upper half.
    pub(super) fn sample(&self, u: Vec2) -> LocalDir {
        let last = self.density.len() - 1;
        let i = self.cumulative.partition_point(|&c| c <= u.x).saturating_sub(1).min(last);
        let t = ((u.x - self.cumulative[i]) / (self.cumulative[i + 1] - self.cumulative[i])).clamp(0.0, 1.0);
        let cos2 = self.edges[i] + t * (self.edges[i + 1] - self.edges[i]);
        let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
        let r = (1.0 - cos2).sqrt();
        LocalDir::new_unchecked(Vec3::new(r * cos_phi, r * sin_phi, cos2.sqrt()))
    }

    /// [sr⁻¹], from the cosine.
    pub(super) fn pdf(&self, mu: f32) -> f32 {
        let last = self.density.len() - 1;
        let i = (elevation::coordinate(mu, self.alpha) * self.density.len() as f32) as usize;
        self.density[i.min(last)] * mu * (1.0 / PI)
    }
}
