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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;
    use crate::optics::refraction;

    #[test]
    fn light_comes_from_the_mirror_direction_with_the_reflectance_as_its_weight() {
        let mirror = Mirror { reflectance: Sampled::from_array([0.1, 0.8, 0.4, 0.0]) };
        for degrees in [0.0_f32, 50.0, 89.0, 130.0] {
            let wo = LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.4));
            let s = mirror.sample(wo).unwrap();
            assert!((*s.wi - refraction::reflect(*wo, Vec3::Z)).length() < 1e-6, "{degrees}: {s:?}");
            assert_eq!((s.weight, s.density), (mirror.reflectance, Density::Delta));
        }
        let along = LocalDir::new_unchecked(Vec3::X);
        assert!(mirror.sample(along).is_none());
    }
}
