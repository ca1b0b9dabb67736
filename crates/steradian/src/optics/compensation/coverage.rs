//! Which distributions of facets a table must serve, and at which widths.

use crate::optics::microfacet::{Distribution as _, FacetShape, Microfacets};

/// The distributions that a table must serve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coverage {
    /// One, at its own widths.
    One(Microfacets),
    /// Equal widths from [`Coverage::NARROWEST`] to 1.
    Isotropic(FacetShape),
    /// Any two widths from [`Coverage::NARROWEST`] to 1.
    Anisotropic(FacetShape),
}

impl Coverage {
    /// The narrowest tabulated width: what a narrower distribution loses, it loses within a seventh of a degree of the
    /// horizon.
    pub const NARROWEST: f32 = 2e-3;

    /// Widths per axis.
    pub(super) fn n_widths(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Isotropic(_) => 24,
            Self::Anisotropic(_) => 15,
        }
    }

    pub(super) fn resolution(&self) -> Resolution {
        match self {
            Self::One(d) => {
                let [x, y] = d.alpha();
                if x == y {
                    Resolution { n_cosines: 128, n_azimuths: 1, lattice: [987, 610] }
                } else {
                    let n_azimuths = 9 + (4.0 * (x / y).ln().abs()) as usize;
                    Resolution { n_cosines: 96, n_azimuths, lattice: [610, 377] }
                }
            }
            Self::Isotropic(_) => Resolution { n_cosines: 48, n_azimuths: 1, lattice: [377, 233] },
            Self::Anisotropic(_) => Resolution { n_cosines: 24, n_azimuths: 7, lattice: [233, 144] },
        }
    }

    /// The distributions at the nodes, the first axis of widths being the narrower one.
    pub(super) fn nodes(&self) -> Vec<Microfacets> {
        let (shape, n) = match self {
            Self::One(d) => return vec![*d],
            Self::Isotropic(shape) | Self::Anisotropic(shape) => (*shape, self.n_widths()),
        };
        let width = |i: usize| invert(Self::NARROWEST, 1.0, i as f32 / (n - 1) as f32, Self::coordinate);
        (0..n)
            .flat_map(|high| {
                let low = if matches!(self, Self::Isotropic(_)) { high } else { 0 };
                (low..=high).map(move |low| Microfacets::new(shape, width(low), width(high)))
            })
            .collect()
    }

    /// Where a width lies among the nodes.
    pub(super) fn position(&self, alpha: f32) -> f32 {
        let last = (self.n_widths() - 1) as f32;
        last * Self::coordinate(alpha.clamp(Self::NARROWEST, 1.0))
    }

    /// Narrow facets lose light by the ratio of cosine and width, wide ones by the square of the width: two thirds of the
    /// nodes are spread over its logarithm, one over itself.
    fn coordinate(alpha: f32) -> f32 {
        let logarithm = 1.0 - alpha.ln() / Self::NARROWEST.ln();
        (2.0 * logarithm + (alpha - Self::NARROWEST) / (1.0 - Self::NARROWEST)) / 3.0
    }
}

/// Where between `low` and `high` an increasing function has the `value`, by bisection to the last digit.
pub(super) fn invert(low: f32, high: f32, value: f32, f: impl Fn(f32) -> f32) -> f32 {
    let (mut low, mut high) = (low, high);
    for _ in 0..32 {
        let middle = 0.5 * (low + high);
        if f(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// How finely a distribution is tabulated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resolution {
    pub(super) n_cosines: usize,
    pub(super) n_azimuths: usize,
    /// Number of points and generator of a Fibonacci lattice.
    pub(super) lattice: [u32; 2],
}
