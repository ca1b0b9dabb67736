//! Scattering that forgets the incident direction: Lambert's law, on one side or both.

use super::albedo::Albedo;
use super::contract::{BsdfSample, Lobe, Lobes, Side};
use super::specimen::{Claims, Specimen};
use crate::math::{LocalDir, Vec2, warp};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// Lambertian reflection f = ρ/π, A (33), alike on both sides of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// Reflectance ρ in [0, 1].
    pub reflectance: Sampled<Unitless>,
}

impl Diffuse {
    /// f [sr⁻¹] for two directions on the same side.
    #[inline]
    pub fn value(&self) -> Sampled<PerSteradian> {
        (self.reflectance * FRAC_1_PI).cast()
    }

    /// f [sr⁻¹]; zero across the surface.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        if wo.same_hemisphere(wi) { self.value() } else { Sampled::ZERO }
    }

    /// cosθ/π on the side of `wo`.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        PdfSolidAngle(if wo.same_hemisphere(wi) {
            warp::cosine_hemisphere_pdf(wi.abs_cos_theta())
        } else {
            0.0
        })
    }

    /// A cosine-distributed direction on the side of `wo`.
    #[inline(always)]
    pub fn sample(&self, wo: LocalDir, u: Vec2) -> Option<BsdfSample> {
        cosine_sample(wo, Side::Reflection, 1.0, self.reflectance, u)
    }

    /// ρ, for any direction.
    pub fn albedo(&self) -> Albedo {
        Albedo::reflecting(self.reflectance)
    }

    /// Which lobes are present.
    #[inline]
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: !self.reflectance.is_zero(), transmission: false }
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        if self.reflectance.min() >= 1.0 { Claims::LOSSLESS } else { Claims::CLOSED_FORM }
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |reflectance| Self { reflectance };
        [
            Specimen::new("diffuse white", Claims::LOSSLESS, of(Sampled::ONE)),
            Specimen::new(
                "diffuse coloured",
                Claims::CLOSED_FORM,
                of(Sampled::from_array([0.1, 0.8, 0.4, 0.0])),
            ),
        ]
        .into_iter()
    }
}

/// Lambertian reflection and transmission, f = ρ/π on the side of `wo` and τ/π on the other: paper, leaves.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission {
    /// Reflectance ρ.
    pub reflectance: Sampled<Unitless>,
    /// Transmittance τ; ρ + τ ≤ 1.
    pub transmittance: Sampled<Unitless>,
}

impl DiffuseTransmission {
    /// f [sr⁻¹].
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        let rho = if wo.same_hemisphere(wi) { self.reflectance } else { self.transmittance };
        (rho * FRAC_1_PI).cast()
    }

    /// cosθ/π on either side, in proportion to the larger reflectance and transmittance.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        let p = self.reflection_probability();
        let p = if wo.same_hemisphere(wi) { p } else { 1.0 - p };
        PdfSolidAngle(p * warp::cosine_hemisphere_pdf(wi.abs_cos_theta()))
    }

    /// A cosine-distributed direction on a side chosen with `uc`.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        let p = self.reflection_probability();
        if uc < p {
            cosine_sample(wo, Side::Reflection, p, self.reflectance, u)
        } else {
            cosine_sample(wo, Side::Transmission, 1.0 - p, self.transmittance, u)
        }
    }

    /// ρ and τ, for any direction.
    pub fn albedo(&self) -> Albedo {
        Albedo { reflectance: self.reflectance, transmittance: self.transmittance }
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: !self.reflectance.is_zero(), transmission: !self.transmittance.is_zero() }
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        let lossless = (self.reflectance + self.transmittance).min() >= 1.0;
        if lossless { Claims::LOSSLESS } else { Claims::CLOSED_FORM }
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |r, t| Self { reflectance: Sampled::splat(r), transmittance: Sampled::splat(t) };
        [
            Specimen::new("diffuse transmission lossless", Claims::LOSSLESS, of(0.3, 0.7)),
            Specimen::new("diffuse transmission only", Claims::CLOSED_FORM, of(0.0, 0.5)),
        ]
        .into_iter()
    }

    fn reflection_probability(&self) -> f32 {
        let (r, t) = (self.reflectance.max(), self.transmittance.max());
        // A black surface samples reflection; its weight is zero either way.
        if r + t > 0.0 { r / (r + t) } else { 1.0 }
    }
}

#[inline(always)]
fn cosine_sample(
    wo: LocalDir,
    side: Side,
    probability: f32,
    rho: Sampled<Unitless>,
    u: Vec2,
) -> Option<BsdfSample> {
    let up = warp::cosine_hemisphere(u);
    // A direction in the surface carries no power and has density zero.
    if rho.is_zero() || up.z == 0.0 || wo.z == 0.0 {
        return None;
    }
    let wi = if (wo.z > 0.0) == (side == Side::Reflection) { up } else { -up };
    let pdf = PdfSolidAngle(probability * warp::cosine_hemisphere_pdf(up.z));
    Some(BsdfSample {
        wi,
        weight: rho / probability,
        density: Density::SolidAngle(pdf),
        side,
        lobe: Lobe::Diffuse,
        eta: 1.0,
    })
}
