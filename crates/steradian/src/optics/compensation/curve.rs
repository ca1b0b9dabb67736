//! What a smooth facet reflects.

use super::interpolation::Cell;

/// Reflectance over the cosine to the facet, on both sides of it.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    above: Vec<f32>,
    below: Vec<f32>,
}

impl Curve {
    /// Pieces that suffice without interference.
    pub(super) const PIECES: usize = 512;

    pub(super) fn new(reflectance: impl Fn(f32) -> f32) -> Self {
        Self::with_pieces(Self::PIECES, reflectance)
    }

    pub(super) fn with_pieces(n: usize, reflectance: impl Fn(f32) -> f32) -> Self {
        let cosine = |i: usize| (i as f32 / n as f32).max(1e-6);
        Self {
            above: (0..=n).map(|i| reflectance(cosine(i))).collect(),
            below: (0..=n).map(|i| reflectance(-cosine(i))).collect(),
        }
    }

    pub(super) fn at(&self, cos: f32) -> f32 {
        let cell = Cell::new(cos.abs().min(1.0) * (self.above.len() - 1) as f32);
        cell.lerp(if cos < 0.0 { &self.below } else { &self.above })
    }

    /// 1 − ∫ 2μ R(μ) dμ from above.
    pub(super) fn hemispherical_transmittance(&self) -> f32 {
        let n = 4 * self.above.len();
        let transmitted = |i| {
            let mu = (i as f32 + 0.5) / n as f32;
            f64::from(2.0 * mu * (1.0 - self.at(mu)))
        };
        ((0..n).map(transmitted).sum::<f64>() / n as f64) as f32
    }
}
