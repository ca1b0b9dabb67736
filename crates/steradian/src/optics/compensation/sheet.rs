//! The losses of one distribution over the directions.

use super::coverage::{Resolution, invert};
use super::elevation;
use super::interpolation::Cell;
use super::lobe::Lobe;
use crate::math::{LocalDir, Vec3};
use crate::optics::microfacet::{Distribution as _, Microfacets};
use std::f64::consts::FRAC_PI_2;

/// m of one distribution and reflectance, from one side.
///
/// Smith's Λ depends on the azimuth by α(φ) = √(αx² cos²φ + αy² sin²φ) alone, and on the elevation by cosθ / α(φ) near the
/// horizon: in mixtures of α(φ) and its logarithm, of cosine and ratio, few nodes suffice, for the narrowest distributions as well.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sheet {
    pub(super) low: f32,
    pub(super) high: f32,
    n_cosines: usize,
    n_azimuths: usize,
    /// The cosine varies fastest.
    m: Vec<f32>,
    /// (1/π) ∫ m cosθ dω.
    pub(super) mean: f32,
    pub(super) lobe: Lobe,
}

impl Sheet {
    /// Half the nodes are spread over α(φ), half over its logarithm.
    fn azimuth(alpha: f32, low: f32, high: f32) -> f32 {
        0.5 * ((alpha - low) / (high - low) + (alpha / low).ln() / (high / low).ln())
    }

    /// From the values at [`Sheet::nodes`].
    pub(super) fn new(d: &Microfacets, resolution: Resolution, m: Vec<f32>) -> Self {
        let [x, y] = d.alpha();
        let Resolution { n_cosines, n_azimuths, .. } = resolution;
        let (low, high) = (x.min(y), x.max(y));
        let alpha = (low * high).sqrt();
        let lobe = Lobe::none(alpha);
        let mut sheet = Self { low, high, n_cosines, n_azimuths, m, mean: 0.0, lobe };
        sheet.mean = sheet.integral();
        sheet.lobe = Lobe::new(alpha, n_cosines, |mu| sheet.at(mu, alpha));
        sheet
    }

    /// The directions, from above, at which a sheet wants values.
    pub(super) fn nodes(d: &Microfacets, resolution: Resolution) -> Vec<LocalDir> {
        let [x, y] = d.alpha();
        let (low, high) = (x.min(y), x.max(y));
        let Resolution { n_cosines, n_azimuths, .. } = resolution;
        let mut nodes = Vec::with_capacity(n_cosines * n_azimuths);
        for j in 0..n_azimuths {
            let v = j as f32 / (n_azimuths.max(2) - 1) as f32;
            let alpha = invert(low, high, v, |alpha| Self::azimuth(alpha, low, high));
            // The squared sine of the angle to the narrower axis.
            let sin2 = if high > low { (alpha * alpha - low * low) / (high * high - low * low) } else { 0.0 };
            let (sin, cos) = (sin2.clamp(0.0, 1.0).sqrt(), (1.0 - sin2).max(0.0).sqrt());
            let (along_x, along_y) = if x <= y { (cos, sin) } else { (sin, cos) };
            for i in 0..n_cosines {
                let s = i as f64 / (n_cosines - 1) as f64;
                // At the horizon itself the limit.
                let mu = (elevation::cosine(s, f64::from(alpha)) as f32).clamp(1e-3 * alpha.min(1.0), 1.0);
                let r = (1.0 - mu * mu).sqrt();
                nodes.push(LocalDir::new_unchecked(Vec3::new(r * along_x, r * along_y, mu)));
            }
        }
        nodes
    }

    /// Simpson's rule over the pieces of the cosine, midpoints over the azimuth.
    fn integral(&self) -> f32 {
        let n_phi = if self.n_azimuths > 1 { 64 } else { 1 };
        let mut sum = 0.0;
        for j in 0..n_phi {
            let (sin, cos) = (FRAC_PI_2 * (f64::from(j) + 0.5) / f64::from(n_phi)).sin_cos();
            let alpha = (f64::from(self.low) * cos).hypot(f64::from(self.high) * sin);
            let node = |i: f64| elevation::cosine(i / (self.n_cosines - 1) as f64, alpha);
            let integrand = |mu: f64| 2.0 * mu * f64::from(self.at(mu as f32, alpha as f32));
            for i in 0..self.n_cosines - 1 {
                let (a, b) = (node(i as f64), node((i + 1) as f64));
                let h = b - a;
                // Two halves: m is linear in the coordinate, which is nearly linear in the cosine within a piece.
                let at = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| integrand(a + t * h));
                sum += h / 12.0 * (at[0] + 4.0 * at[1] + 2.0 * at[2] + 4.0 * at[3] + at[4]);
            }
        }
        (sum / f64::from(n_phi)) as f32
    }

    pub(super) fn at(&self, mu: f32, alpha: f32) -> f32 {
        let last = (self.n_cosines - 1) as f32;
        let cosine = Cell::new((elevation::coordinate(mu, alpha) * last).clamp(0.0, last));
        if self.n_azimuths == 1 || self.low == self.high {
            return cosine.lerp(&self.m);
        }
        let last = (self.n_azimuths - 1) as f32;
        let azimuth = Cell::new((Self::azimuth(alpha, self.low, self.high) * last).clamp(0.0, last));
        azimuth.shares().map(|(j, share)| share * cosine.lerp(&self.m[j * self.n_cosines..])).sum()
    }
}
