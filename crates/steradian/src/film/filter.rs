//! Reconstruction filters, importance sampled.
//!
//! A sample lies at pixel centre + offset with an offset drawn from the filter, and counts for its own
//! pixel only (Ernst et al. 2006): pixels stay independent, and tiles need no border.

use crate::math::Vec2;
use crate::math::distribution::PiecewiseConstant1D;
use std::f32::consts::PI;

/// A reconstruction filter as plain data. All are separable; the profiles are not normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterKind {
    /// 1 everywhere.
    Box,
    /// r − |x|.
    Triangle,
    /// A Gaussian, lowered so that it reaches zero at the radius.
    Gaussian {
        /// Standard deviation [px].
        sigma: f32,
    },
    /// Piecewise cubic (Mitchell & Netravali 1988, eq. 8), stretched to the radius.
    Mitchell {
        /// Blur.
        b: f32,
        /// Ringing.
        c: f32,
    },
    /// sinc(x) windowed by sinc(x/τ) (Lanczos).
    Sinc {
        /// Cycles of the sinc after which the window reaches zero.
        tau: f32,
    },
}

impl FilterKind {
    /// The profile at `x` [px] of a filter with half width `radius` [px]; zero outside.
    pub fn profile(&self, x: f32, radius: f32) -> f32 {
        let x = x.abs();
        if x > radius {
            return 0.0;
        }
        match *self {
            Self::Box => 1.0,
            Self::Triangle => radius - x,
            Self::Gaussian { sigma } => {
                let g = |x: f32| (-x * x / (2.0 * sigma * sigma)).exp();
                (g(x) - g(radius)).max(0.0)
            }
            Self::Mitchell { b, c } => mitchell(2.0 * x / radius, b, c),
            Self::Sinc { tau } => sinc(x) * sinc(x / tau),
        }
    }

    /// The half widths that pbrt-v4 uses when the scene states none [px].
    pub fn default_radius(&self) -> f32 {
        match self {
            Self::Box => 0.5,
            Self::Gaussian { .. } => 1.5,
            Self::Triangle | Self::Mitchell { .. } => 2.0,
            Self::Sinc { .. } => 4.0,
        }
    }
}

impl Default for FilterKind {
    /// The Gaussian with σ = ½ px.
    fn default() -> Self {
        Self::Gaussian { sigma: 0.5 }
    }
}

fn mitchell(x: f32, b: f32, c: f32) -> f32 {
    let polynomial = |k3: f32, k2: f32, k1: f32, k0: f32| (((k3 * x + k2) * x + k1) * x + k0) / 6.0;
    if x <= 1.0 {
        polynomial(12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b)
    } else if x <= 2.0 {
        polynomial(-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c)
    } else {
        0.0
    }
}

fn sinc(x: f32) -> f32 {
    let x = PI * x;
    // Below this the next term x⁴/120 of the series vanishes in f32.
    if x.abs() < 1e-2 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

/// What makes a filter impossible.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// Half width [px].
    #[error("filter radius must be positive, not {0}")]
    Radius(f32),
    /// σ, B, C or τ.
    #[error("filter shape parameter {0} leaves nothing to sample")]
    Shape(f32),
}

/// Where a sample lies and what it counts.
#[derive(Clone, Copy, Debug)]
pub struct FilterSample {
    /// Offset from the pixel's centre [px].
    pub offset: Vec2,
    /// Filter over density, normalised to mean 1; negative in negative lobes.
    pub weight: f32,
}

/// A filter ready for sampling.
#[derive(Clone, Debug)]
pub struct Filter {
    kind: FilterKind,
    radius: Vec2,
    axes: [Axis; 2],
}

/// One factor of the separable filter.
#[derive(Clone, Debug)]
enum Axis {
    /// Sampled by inverting its integral: the weight is 1.
    Uniform,
    Tent,
    /// Sampled from cell averages of |f| over [−r, r].
    Table {
        density: PiecewiseConstant1D,
        norm: f32,
    },
}

/// Cells per pixel of a tabulated profile.
const CELLS_PER_PIXEL: f32 = 64.0;

impl Filter {
    /// A filter with half widths `radius` [px]. Fails when a radius is not positive or the profile is not
    /// a finite function with positive integral.
    pub fn new(kind: FilterKind, radius: Vec2) -> Result<Self, FilterError> {
        for r in [radius.x, radius.y] {
            if !(r > 0.0 && r.is_finite()) {
                return Err(FilterError::Radius(r));
            }
        }
        let axes = [Axis::new(&kind, radius.x)?, Axis::new(&kind, radius.y)?];
        Ok(Self { kind, radius, axes })
    }

    /// The filter's kind.
    pub fn kind(&self) -> FilterKind {
        self.kind
    }

    /// Half widths [px].
    pub fn radius(&self) -> Vec2 {
        self.radius
    }

    /// Draws an offset; E[weight · g(offset)] = ∫ f g / ∫ f for every g.
    pub fn sample(&self, u: Vec2) -> FilterSample {
        let (x, wx) = self.axes[0].sample(&self.kind, self.radius.x, u.x);
        let (y, wy) = self.axes[1].sample(&self.kind, self.radius.y, u.y);
        FilterSample { offset: Vec2::new(x, y), weight: wx * wy }
    }
}

impl Axis {
    fn new(kind: &FilterKind, r: f32) -> Result<Self, FilterError> {
        let shape = match *kind {
            FilterKind::Box => return Ok(Self::Uniform),
            FilterKind::Triangle => return Ok(Self::Tent),
            FilterKind::Gaussian { sigma } => sigma,
            FilterKind::Mitchell { b, c } => b + c,
            FilterKind::Sinc { tau } => tau,
        };
        let cells = (2.0 * r * CELLS_PER_PIXEL).ceil().clamp(64.0, 65_536.0) as usize;
        let width = 2.0 * r / cells as f32;
        let mut averages = Vec::with_capacity(cells);
        let mut integral = 0.0_f64;
        for i in 0..cells {
            // Gauss–Legendre with three nodes, exact to degree 5 in each cell.
            let mid = -r + (i as f32 + 0.5) * width;
            let mut absolute = 0.0_f32;
            for (node, weight) in [(-0.774_596_7, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_7, 5.0 / 18.0)] {
                let f = kind.profile(mid + node * 0.5 * width, r);
                absolute += weight * f.abs();
                integral += f64::from(weight * f * width);
            }
            averages.push(absolute);
        }
        if !(integral > 0.0 && averages.iter().all(|a| a.is_finite())) {
            return Err(FilterError::Shape(shape));
        }
        Ok(Self::Table { density: PiecewiseConstant1D::new(&averages), norm: integral as f32 })
    }

    /// Position [px] and weight.
    fn sample(&self, kind: &FilterKind, r: f32, u: f32) -> (f32, f32) {
        match self {
            Self::Uniform => (r * (2.0 * u - 1.0), 1.0),
            Self::Tent => {
                let x = if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
                (r * x, 1.0)
            }
            Self::Table { density, norm } => {
                let s = density.sample(u);
                let x = r * (2.0 * s.x - 1.0);
                // The density per pixel is that on [0, 1] over 2r.
                (x, kind.profile(x, r) * 2.0 * r / (s.pdf * norm))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [FilterKind; 5] = [
        FilterKind::Box,
        FilterKind::Triangle,
        FilterKind::Gaussian { sigma: 0.5 },
        FilterKind::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 },
        FilterKind::Sinc { tau: 3.0 },
    ];

    #[test]
    fn sampling_reproduces_the_filter_s_integrals() {
        for kind in KINDS {
            let r = kind.default_radius();
            let filter = Filter::new(kind, Vec2::new(r, 1.3 * r)).unwrap();
            // ∫ f g / ∫ f by midpoint quadrature, for g = 1, cos x, x, and x² by axis.
            let g = |x: f64| [1.0, x.cos(), x, x * x];
            for axis in 0..2 {
                let r = f64::from(filter.radius()[axis]);
                let n = 20_000;
                let (mut exact, mut mass) = ([0.0; 4], 0.0);
                for i in 0..n {
                    let x = r * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
                    let f = f64::from(kind.profile(x as f32, r as f32));
                    mass += f;
                    for (e, g) in exact.iter_mut().zip(g(x)) {
                        *e += f * g;
                    }
                }
                let mut sampled = [0.0; 4];
                for i in 0..n {
                    let mut u = Vec2::splat(0.37);
                    u[axis] = (i as f32 + 0.5) / n as f32;
                    let s = filter.sample(u);
                    let other = f64::from(filter.sample(Vec2::splat(0.37)).weight);
                    let fixed = Axis::new(&kind, filter.radius()[1 - axis]).unwrap();
                    let other_axis = f64::from(fixed.sample(&kind, filter.radius()[1 - axis], 0.37).1);
                    assert!(other.is_finite() && s.offset.abs().cmple(filter.radius()).all());
                    for (a, g) in sampled.iter_mut().zip(g(f64::from(s.offset[axis]))) {
                        *a += f64::from(s.weight) / other_axis * g / f64::from(n);
                    }
                }
                for k in 0..4 {
                    let expected = exact[k] / mass;
                    // f32 rounds the distribution function to 3e-5 of a cell's share; the moments of lobes cancel.
                    let tolerance = 1e-4 * (1.0 + r * r);
                    assert!(
                        (sampled[k] - expected).abs() < tolerance,
                        "{kind:?} {k}: {} {expected}",
                        sampled[k]
                    );
                }
            }
        }
    }

    #[test]
    fn weights_of_positive_filters_hardly_vary() {
        // Jitter of the weights costs variance; for box, triangle and Gaussian it must stay below a percent.
        for kind in &KINDS[..3] {
            let filter = Filter::new(*kind, Vec2::splat(kind.default_radius())).unwrap();
            let n = 4096;
            let variance: f64 = (0..n)
                .map(|i| filter.axes[0].sample(kind, kind.default_radius(), (i as f32 + 0.5) / n as f32).1)
                .map(|w| f64::from(w - 1.0).powi(2) / f64::from(n))
                .sum();
            assert!(variance < 1e-3, "{kind:?} {variance}");
        }
    }

    #[test]
    fn mitchell_is_continuous_and_interpolates_as_published() {
        // k(0) = (6 − 2B)/6 = 8/9, k(1) = B/6 = 1/18, k(2) = 0 for B = C = 1/3.
        let k = FilterKind::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 };
        for (x, value) in [(0.0, 8.0 / 9.0), (1.0, 1.0 / 18.0), (1.0 + 1e-6, 1.0 / 18.0), (2.0, 0.0)] {
            assert!((k.profile(x, 2.0) - value).abs() < 1e-5, "{x}");
        }
        // Partition of unity: the sum over integers is 1 at every phase.
        for phase in [0.0, 0.2, 0.5] {
            let sum: f32 = (-3..=3).map(|i| k.profile(i as f32 + phase, 2.0)).sum();
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }

    #[test]
    fn impossible_filters_are_refused() {
        assert_eq!(Filter::new(FilterKind::Box, Vec2::new(0.0, 1.0)).unwrap_err(), FilterError::Radius(0.0));
        assert!(Filter::new(FilterKind::Gaussian { sigma: f32::NAN }, Vec2::ONE).is_err());
        assert!(Filter::new(FilterKind::Gaussian { sigma: 0.0 }, Vec2::ONE).is_err());
    }
}
