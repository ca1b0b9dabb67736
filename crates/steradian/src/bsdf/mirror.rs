//! The perfect mirror.

use super::albedo::Albedo;
use super::contract::{BsdfSample, Lobe, Lobes, Side};
use super::cosine_lobe;
use super::modified_phong::{ModifiedPhong, PhongLobe, PhongNormalization, PhongSampling};
use super::specimen::{Claims, Specimen};
use crate::math::{LocalDir, Vec3};
use crate::spectrum::Sampled;
use crate::units::{Density, Unitless};

/// A mirror f = ρ δ(d − m)/(n·d), A (37), alike on both sides of the surface: L(d) = ρ L(p, −m), A (38), where the text
/// has ρ = 1.
#[derive(Clone, Copy, Debug)]
pub struct Mirror {
    /// Reflectance ρ in [0, 1], the same at every angle.
    pub reflectance: Sampled<Unitless>,
}

impl Mirror {
    /// The direction m = 2(n·d)n − d, which is the only one; `None` along the surface.
    pub fn sample(&self, wo: LocalDir) -> Option<BsdfSample> {
        (wo.z != 0.0 && !self.reflectance.is_zero()).then(|| BsdfSample {
            wi: LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z)),
            weight: self.reflectance,
            density: Density::Delta,
            side: Side::Reflection,
            lobe: Lobe::Specular,
            eta: 1.0,
        })
    }

    /// ρ, for any direction.
    pub fn albedo(&self) -> Albedo {
        Albedo::reflecting(self.reflectance)
    }

    /// Which continuous lobes are present: none.
    pub fn lobes(&self) -> Lobes {
        Lobes::default()
    }

    /// A narrow lobe in its place: a named bias against fireflies.
    pub fn regularized(&self) -> ModifiedPhong {
        ModifiedPhong {
            diffuse: Sampled::ZERO,
            specular: self.reflectance,
            exponent: cosine_lobe::widened(f32::INFINITY),
            lobe: PhongLobe::Mirror,
            normalization: PhongNormalization::Exact,
            sampling: PhongSampling::Lobe,
        }
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        if self.reflectance.min() >= 1.0 { Claims::LOSSLESS } else { Claims::CLOSED_FORM }
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |reflectance| Self { reflectance };
        [
            ("mirror lossless", of(Sampled::ONE)),
            ("mirror coloured", of(Sampled::from_array([0.1, 0.8, 0.4, 0.0]))),
        ]
        .into_iter()
        .map(|(name, bsdf)| Specimen::new(name, bsdf.claims(), bsdf))
    }
}
