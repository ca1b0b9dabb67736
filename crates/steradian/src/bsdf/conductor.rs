//! Reflection from metals, smooth or rough.

use super::albedo::Albedo;
use super::contract::{BsdfSample, Evaluated, Lobe, Lobes, Side};
use super::specimen::{Claims, Specimen};
use crate::math::{LocalDir, Vec2, Vec3};
use crate::optics::{Distribution, TrowbridgeReitz, fresnel, refraction};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};

/// A metal with complex index eta + j k relative to the outside, alike on both sides of the surface.
///
/// Light that meets a second microfacet is lost (single scattering): a rough lossless metal reflects less
/// than one.
#[derive(Clone, Copy, Debug)]
pub struct Conductor<D = TrowbridgeReitz> {
    /// Real part of the relative index.
    pub eta: Sampled<Unitless>,
    /// Imaginary part of the relative index.
    pub k: Sampled<Unitless>,
    /// Distribution of the microfacets.
    pub roughness: D,
}

impl<D: Distribution> Conductor<D> {
    /// f [sr⁻¹] = D F G / (4 cosθo cosθi), Walter et al. 2007, eq. 20; zero where the metal is smooth.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        let Some(wm) = self.halfway(wo, wi) else { return Sampled::ZERO };
        (self.fresnel(wo.dot(*wm)) * self.lossless_value(wo, wi, wm)).cast()
    }

    /// Density of [`Conductor::sample`]; zero where the metal is smooth.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        PdfSolidAngle(self.halfway(wo, wi).map_or(0.0, |wm| self.density(wo, wm)))
    }

    /// Both at once.
    pub fn evaluate(&self, wo: LocalDir, wi: LocalDir) -> Evaluated {
        let Some(wm) = self.halfway(wo, wi) else { return Evaluated::NOTHING };
        let d = 0.25 * self.roughness.d(wm);
        Evaluated {
            f: (self.fresnel(wo.dot(*wm)) * (d * self.roughness.g_over_cosines(wo, wi))).cast(),
            pdf: PdfSolidAngle(d * self.roughness.g1_over_cos(wo)),
        }
    }

    /// A direction mirrored at a visible microfacet; `None` when it falls below the horizon.
    pub fn sample(&self, wo: LocalDir, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.roughness.is_smooth() {
            return Some(BsdfSample {
                wi: LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z)),
                weight: self.fresnel(wo.z),
                density: Density::Delta,
                side: Side::Reflection,
                lobe: Lobe::Specular,
                eta: 1.0,
            });
        }
        let wm = self.roughness.sample_visible(wo, u);
        let wi = LocalDir::new_unchecked(refraction::reflect(*wo, *wm));
        if !wo.same_hemisphere(wi) {
            return None;
        }
        // D and the cosines cancel: f cosθi / p = F G / G1(wo).
        Some(BsdfSample {
            wi,
            weight: self.fresnel(wo.dot(*wm)) * self.roughness.g_over_g1(wo, wi),
            density: Density::SolidAngle(PdfSolidAngle(self.density(wo, wm))),
            side: Side::Reflection,
            lobe: Lobe::Glossy,
            eta: 1.0,
        })
    }

    /// ρ for light from `wi` where the metal is smooth.
    pub fn albedo(&self, wi: LocalDir) -> Option<Albedo> {
        self.roughness.is_smooth().then(|| Albedo::reflecting(self.fresnel(wi.z)))
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: !self.roughness.is_smooth(), transmission: false }
    }

    /// Widens a narrow lobe: a named bias against fireflies.
    pub fn regularize(&mut self) {
        self.roughness = self.roughness.regularized();
    }

    /// What holds for it: only a smooth mirror loses nothing.
    pub fn claims(&self) -> Claims {
        if self.roughness.is_smooth() && is_lossless(self.index_size(), |cos| self.fresnel(cos)) {
            Claims::LOSSLESS
        } else {
            Claims::CLOSED_FORM
        }
    }

    pub(super) fn fresnel(&self, cos: f32) -> Sampled<Unitless> {
        Sampled::from_fn(|i| fresnel::conductor(cos, self.eta[i], self.k[i]))
    }

    /// f for facets that reflect everything, at the facet normal that mirrors `wo` to `wi`.
    pub(super) fn lossless_value(&self, wo: LocalDir, wi: LocalDir, wm: LocalDir) -> f32 {
        0.25 * self.roughness.d(wm) * self.roughness.g_over_cosines(wo, wi)
    }

    /// |η + j k|, the smallest over the lanes.
    pub(super) fn index_size(&self) -> f32 {
        Sampled::<Unitless>::from_fn(|i| self.eta[i].hypot(self.k[i])).min()
    }

    /// Density of the reflected direction: that of the visible normals over the Jacobian 4 |wo·wm|, which cancels.
    pub(super) fn density(&self, wo: LocalDir, wm: LocalDir) -> f32 {
        0.25 * self.roughness.d(wm) * self.roughness.g1_over_cos(wo)
    }

    /// The upper facet normal that mirrors `wo` to `wi`; `None` when there is none.
    pub(super) fn halfway(&self, wo: LocalDir, wi: LocalDir) -> Option<LocalDir> {
        if self.roughness.is_smooth() || !wo.same_hemisphere(wi) {
            return None;
        }
        let wm = LocalDir::new(*wo + *wi)?;
        Some(if wm.z < 0.0 { -wm } else { wm })
    }
}

impl Conductor {
    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let gold = |ax, ay| Self {
            eta: Sampled::from_array([1.37, 1.46, 0.35, 0.13]),
            k: Sampled::from_array([1.77, 1.95, 2.71, 4.07]),
            roughness: TrowbridgeReitz::new(ax, ay),
        };
        // An index without real part: total reflection at every angle.
        let silver = Self { eta: Sampled::ZERO, k: Sampled::splat(3.0), roughness: TrowbridgeReitz::SMOOTH };
        [
            Specimen::new("conductor smooth", Claims::CLOSED_FORM, gold(0.0, 0.0)),
            Specimen::new("conductor smooth, without loss", Claims::LOSSLESS, silver),
            Specimen::new("conductor rough 0.01", Claims::CLOSED_FORM, gold(0.01, 0.01)),
            Specimen::new("conductor rough 0.1", Claims::CLOSED_FORM, gold(0.1, 0.1)),
            Specimen::new("conductor rough 0.5", Claims::CLOSED_FORM, gold(0.5, 0.5)),
            Specimen::new("conductor rough 1", Claims::CLOSED_FORM, gold(1.0, 1.0)),
            Specimen::new("conductor brushed", Claims::CLOSED_FORM, gold(0.15, 0.6)),
        ]
        .into_iter()
    }
}

/// Whether a metal whose index has the size `n` reflects everything at every wavelength and angle, to a tenth of what
/// a claim is judged by. Near the pseudo-Brewster angle, where cosθ = 1/n, it reflects least.
pub(super) fn is_lossless(n: f32, reflectance: impl Fn(f32) -> Sampled<Unitless>) -> bool {
    const ABSORBED: f32 = 2e-4;
    let brewster = (1.0 / n.max(1.0)).min(1.0);
    let near = [0.3, 0.6, 1.0, 1.6, 3.0].map(|x| (brewster * x).min(1.0));
    let even = (1..=64).map(|i| i as f32 / 64.0);
    near.into_iter().chain(even).all(|cos| reflectance(cos).min() >= 1.0 - ABSORBED)
}
