//! A homogeneous layer without boundaries: from a thin slice to any thickness by doubling.

use super::matrix::Matrix;
use crate::optics::quadrature::Node;

/// Linear operators on the radiance along the directions of a quadrature over the cosine in [0, 1]: what a layer reflects and
/// what it transmits. Both sides are alike.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub(super) reflection: Matrix,
    pub(super) transmission: Matrix,
}

/// A medium by its single-scattering albedo and the moments of its phase function, for as many directions.
#[derive(Clone, Debug)]
pub(super) struct Medium {
    albedo: f64,
    /// How much of the optical thickness is left when the forward peak counts as unscattered.
    thinning: f64,
    /// ½ of the phase function, averaged over azimuth: from a direction down to one down, and to one up.
    forward: Matrix,
    backward: Matrix,
}

impl Medium {
    /// A medium that scatters after Henyey & Greenstein with the mean cosine `g`.
    ///
    /// `moments` of its Legendre series are kept; what they cannot hold is a peak into the forward direction, and counts as
    /// not scattered at all (δ-M, Wiscombe 1977).
    pub(super) fn new(albedo: f64, g: f64, directions: &[Node], moments: usize) -> Self {
        let peak = g.powi(moments as i32);
        let thinning = 1.0 - albedo * peak;
        let coefficient = |k: usize| (2 * k + 1) as f64 * (g.powi(k as i32) - peak) / (1.0 - peak);
        let polynomials: Vec<Vec<f64>> = directions.iter().map(|d| legendre(d.x, moments)).collect();
        let sum = |i: usize, j: usize, sign: f64| -> f64 {
            let terms = polynomials[i].iter().zip(&polynomials[j]).enumerate();
            0.5 * terms.map(|(k, (a, b))| sign.powi(k as i32) * coefficient(k) * a * b).sum::<f64>()
        };
        let n = directions.len();
        Self {
            albedo: albedo * (1.0 - peak) / thinning,
            thinning,
            forward: Matrix::from_fn(n, |i, j| sum(i, j, 1.0)),
            backward: Matrix::from_fn(n, |i, j| sum(i, j, -1.0)),
        }
    }

    /// The layer of optical thickness `depth`; for an infinite one, as thick as matters.
    pub(super) fn layer(&self, depth: f64, directions: &[Node]) -> Layer {
        let thinnest = directions.iter().map(|d| d.x).fold(f64::INFINITY, f64::min) * START;
        let depth = depth * self.thinning;
        if depth.is_infinite() {
            let mut layer = self.slice(thinnest, directions);
            for _ in 0..MOST_DOUBLINGS {
                if layer.passed(directions) < NOTHING {
                    break;
                }
                layer = layer.doubled();
            }
            return layer;
        }
        let doublings = (depth / thinnest).log2().ceil().clamp(0.0, MOST_DOUBLINGS as f64) as i32;
        let mut layer = self.slice(depth / 2.0_f64.powi(doublings), directions);
        for _ in 0..doublings {
            layer = layer.doubled();
        }
        layer
    }

    /// A layer that is thin even along the most oblique direction: the central difference of the transport equation over it
    /// ("diamond", Wiscombe 1976), whose relative error is a twelfth of the square of its oblique thickness.
    fn slice(&self, depth: f64, directions: &[Node]) -> Layer {
        let n = directions.len();
        let oblique: Vec<f64> = directions.iter().map(|d| 0.5 * depth / d.x).collect();
        let weights: Vec<f64> = directions.iter().map(|d| self.albedo * d.weight).collect();
        let identity = Matrix::identity(n);
        let a = identity.plus(&self.forward.columns_scaled(&weights), -1.0).rows_scaled(&oblique);
        let b = self.backward.columns_scaled(&weights).rows_scaled(&oblique);
        let one_and_a = identity.plus(&a, 1.0);
        // With light u₀ from above alone: (1 + A) v₀ = B (u₀ + u₁) and (1 + A)(u₀ + u₁) = 2 u₀ + B v₀.
        let c = one_and_a.clone().solve(b.clone());
        let g = one_and_a.plus(&b.times(&c), -1.0);
        let t = g.solve(identity.plus(&identity, 1.0));
        Layer { reflection: c.times(&t), transmission: t.plus(&identity, -1.0) }
    }
}

impl Layer {
    /// Two such layers.
    fn doubled(&self) -> Self {
        let Self { reflection: r, transmission: t } = self;
        let square = r.times(r);
        // (1 − R R)⁻¹ T: what goes down between them.
        let between = Matrix::identity(square.size()).plus(&square, -1.0).solve(t.clone());
        Self { reflection: r.plus(&t.times(&r.times(&between)), 1.0), transmission: t.times(&between) }
    }

    /// The share of diffuse light that passes.
    fn passed(&self, directions: &[Node]) -> f64 {
        let out = self.transmission.apply(&vec![1.0; directions.len()]);
        out.iter().zip(directions).map(|(l, d)| 2.0 * d.x * d.weight * l).sum()
    }
}

/// Thickness of the first slice along the most oblique direction.
const START: f64 = 0.01;
/// From a slice of 10⁻⁵ to 10¹⁰.
const MOST_DOUBLINGS: usize = 50;
/// A layer that passes less is as good as infinite.
const NOTHING: f64 = 1e-10;

/// The polynomials of Legendre of degrees below `count`.
fn legendre(x: f64, count: usize) -> Vec<f64> {
    let mut all = Vec::with_capacity(count);
    let (mut last, mut previous) = (1.0, 0.0);
    for k in 1..=count {
        all.push(last);
        let k = k as f64;
        (last, previous) = (((2.0 * k - 1.0) * x * last - (k - 1.0) * previous) / k, last);
    }
    all
}
