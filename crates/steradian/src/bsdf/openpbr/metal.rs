//! The reflectance of metals by two colours: F82-tint (Kutz, Hašan and Edmondson 2021).

use crate::optics::films::{self, Film};
use crate::spectrum::{LANES, Sampled};
use crate::units::Unitless;

/// A metal by its colour face on and the tint that it takes on near its outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metal {
    /// Reflectance at normal incidence.
    pub(super) base: Sampled<Unitless>,
    /// Reflectance at [`EDGE`] over that of Schlick's curve.
    pub(super) tint: Sampled<Unitless>,
}

/// The cosine of about 82°, where the correction is largest.
const EDGE: f32 = 1.0 / 7.0;
/// (1 − [`EDGE`])⁵.
const EDGE_5: f32 = 7776.0 / 16807.0;

impl Metal {
    /// F(μ) = F₀ + (1 − F₀)(1 − μ)⁵ − b μ (1 − μ)⁶, with b such that F(1/7) is Schlick's value times the tint.
    pub(super) fn at(&self, cos: f32) -> Sampled<Unitless> {
        let m = 1.0 - cos.clamp(0.0, 1.0);
        let m5 = m * m * m * m * m;
        let dip = self.dip();
        Sampled::from_fn(|i| {
            let f0 = self.base[i];
            (f0 + (1.0 - f0) * m5 - dip[i] * cos * m5 * m).clamp(0.0, 1.0)
        })
    }

    /// 2 ∫ F μ dμ = F₀ + (1 − F₀)/21 − b/126.
    pub(super) fn average(&self) -> Sampled<Unitless> {
        let dip = self.dip();
        Sampled::from_fn(|i| {
            let f0 = self.base[i];
            (f0 + (1.0 - f0) / 21.0 - dip[i] / 126.0).clamp(0.0, 1.0)
        })
    }

    /// The reflectance under a film, of the complex index that Gulbrandsen (2014) maps the two colours to. His edge tint is
    /// not that of F82: without a film the curves differ somewhat.
    pub(super) fn under(&self, film: Film, cos: f32, lambda_nm: &[f32; LANES]) -> Sampled<Unitless> {
        Sampled::from_fn(|i| {
            let [eta, k] = index(self.base[i], self.tint[i]);
            films::reflectance_conductor(cos, film, eta, k, lambda_nm[i])
        })
    }

    /// b.
    fn dip(&self) -> Sampled<Unitless> {
        Sampled::from_fn(|i| {
            let schlick = self.base[i] + (1.0 - self.base[i]) * EDGE_5;
            schlick * (1.0 - self.tint[i]) / (EDGE * EDGE_5 * (1.0 - EDGE))
        })
    }
}

/// Gulbrandsen 2014, eq. 12 and 15: [n, k] with reflectance `r` at normal incidence, k from none (`g` = 0) to all it can be.
fn index(r: f32, g: f32) -> [f32; 2] {
    // At one the index is infinite.
    let r = r.clamp(0.0, 0.999);
    let root = r.sqrt();
    let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + root) / (1.0 - root);
    let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    [n, k2.max(0.0).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::fresnel;

    fn gold() -> Metal {
        Metal {
            base: Sampled::from_array([0.35, 0.72, 0.94, 1.0]),
            tint: Sampled::from_array([0.6, 0.9, 0.98, 1.0]),
        }
    }

    #[test]
    fn colours_are_met_face_on_and_at_the_edge() {
        let metal = gold();
        let (face, edge, grazing) = (metal.at(1.0), metal.at(1.0 / 7.0), metal.at(0.0));
        for i in 0..LANES {
            let schlick = metal.base[i] + (1.0 - metal.base[i]) * (6.0_f32 / 7.0).powi(5);
            assert!((face[i] - metal.base[i]).abs() < 1e-6);
            assert!((edge[i] - schlick * metal.tint[i]).abs() < 1e-6);
            assert!((grazing[i] - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn mean_reflectance_is_the_integral() {
        let metal = gold();
        let n = 2000;
        for lane in 0..LANES {
            let sum: f64 = (0..n)
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .map(|mu| 2.0 * mu * f64::from(metal.at(mu as f32)[lane]) / f64::from(n))
                .sum();
            assert!((sum - f64::from(metal.average()[lane])).abs() < 1e-5, "{lane}");
        }
    }

    #[test]
    fn index_has_the_reflectance_that_it_was_made_from() {
        for r in [0.1_f32, 0.5, 0.9] {
            for g in [0.0_f32, 0.4, 1.0] {
                let [n, k] = index(r, g);
                assert!((fresnel::conductor(1.0, n, k) - r).abs() < 1e-4, "{r} {g}");
            }
        }
    }
}
