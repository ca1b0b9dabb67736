//! Phong's reflectance model of A (39), (40), as it was meant: legacy shading, not a BRDF.
//!
//! The text gives the radiance that a shaded point shows, not a ratio of radiance to irradiance,
//!
//! ```text
//! L = rd Id max(0, s·n) + ra Ia + rs Is max(0, m·d)^α
//! ```
//!
//! and leaves open what I measures. Here I = E/π, where E is the irradiance that the light makes on a plane facing it:
//! the radiance of a perfect white diffuser there. With it (35) is (34) for a surface of reflectance rd, and
//! Ia is the radiance of uniform surroundings. Dividing by E cosθi leaves
//!
//! ```text
//! f = rd/π + rs max(0, m·d)^α / (π cosθi)
//! ```
//!
//! which depends on the direction of the *light* in a way that it does not on that of the view: reciprocity fails,
//! B (2.18), and towards grazing light more power leaves than arrives, without bound, B (2.19).

use super::contract::{BsdfSample, Lobe, Lobes, Mode};
use super::cosine_lobe::{self, mirrored};
use super::specimen::{Claims, Energy, Reciprocity, Specimen};
use crate::math::{LocalDir, Vec2, warp};
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// Phong's model, A (40): not a BRDF. Alike on both sides of the surface, dark to light from the other one (the text shows
/// highlights of lights that are behind the surface).
#[derive(Clone, Copy, Debug)]
pub struct LegacyPhong {
    /// Diffuse reflection coefficient rd.
    pub diffuse: Sampled<Unitless>,
    /// Ambient reflection coefficient ra, A (36); light transport has no use for it.
    pub ambient: Sampled<Unitless>,
    /// Specular reflection coefficient rs.
    pub specular: Sampled<Unitless>,
    /// Exponent α, ≥ 0.
    pub exponent: f32,
}

impl LegacyPhong {
    /// L/(E cosθ) [sr⁻¹], with the cosine of the direction that light comes from: `wi` for radiance, `wo` for importance.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        if !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        let from = match mode {
            Mode::Radiance => wi,
            Mode::Importance => wo,
        };
        // Finite for light along the surface as well.
        let cos = from.abs_cos_theta().max(f32::MIN_POSITIVE);
        let highlight = cosine_lobe::power(*mirrored(wo), *wi, self.exponent) / cos;
        ((self.diffuse + self.specular * highlight) * FRAC_1_PI).cast()
    }

    /// Density of [`LegacyPhong::sample`].
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if !wo.same_hemisphere(wi) {
            return PdfSolidAngle(0.0);
        }
        let power = cosine_lobe::power(*mirrored(wo), *wi, self.exponent);
        let lobe = cosine_lobe::density_scale(self.exponent) * power;
        let p = self.diffuse_probability();
        PdfSolidAngle(p * warp::cosine_hemisphere_pdf(wi.abs_cos_theta()) + (1.0 - p) * lobe)
    }

    /// A direction from the cosine or from the lobe; `None` under the horizon.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 || self.is_black() {
            return None;
        }
        let (wi, lobe) = if uc < self.diffuse_probability() {
            let up = warp::cosine_hemisphere(u);
            (if wo.z > 0.0 { up } else { -up }, Lobe::Diffuse)
        } else {
            (cosine_lobe::sample(mirrored(wo), self.exponent, u)?, Lobe::Glossy)
        };
        BsdfSample::reflected(wi, self.eval(wo, wi, mode), self.pdf(wo, wi), lobe)
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: !self.is_black(), transmission: false }
    }

    /// Widens a narrow lobe: a named bias against fireflies.
    pub fn regularize(&mut self) {
        self.exponent = cosine_lobe::widened(self.exponent);
    }

    /// What holds for it: nothing but that its values are closed forms, unless it is Lambertian.
    pub fn claims(&self) -> Claims {
        if self.specular.is_zero() {
            return Claims::CLOSED_FORM;
        }
        Claims::CLOSED_FORM.with_energy(Energy::Unbounded).with_reciprocity(Reciprocity::Broken)
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |diffuse, specular, exponent| Self {
            diffuse: Sampled::splat(diffuse),
            ambient: Sampled::splat(diffuse),
            specular: Sampled::splat(specular),
            exponent,
        };
        [
            ("phong (not a BRDF) wide", of(0.5, 0.5, 2.0)),
            ("phong (not a BRDF) shiny", of(0.3, 0.7, 40.0)),
            ("phong diffuse", of(0.8, 0.0, 10.0)),
        ]
        .into_iter()
        .map(|(name, bsdf)| Specimen::new(name, bsdf.claims(), bsdf))
    }

    fn diffuse_probability(&self) -> f32 {
        let (d, s) = (self.diffuse.max(), self.specular.max());
        d / (d + s)
    }

    fn is_black(&self) -> bool {
        self.diffuse.is_zero() && self.specular.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f32, phi: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), phi))
    }

    /// A (39), (40) with I = E/π: rd cos 60° + rs cos^α 20° for light from 60° and a view 20° off the mirror direction.
    #[test]
    fn radiance_under_a_light_is_that_of_the_text() {
        let b = LegacyPhong {
            diffuse: Sampled::splat(0.4),
            ambient: Sampled::ZERO,
            specular: Sampled::splat(0.5),
            exponent: 8.0,
        };
        let (light, view) = (at(60.0, 0.0), at(40.0, std::f32::consts::PI));
        let radiance = std::f64::consts::PI
            * f64::from(b.eval(view, light, Mode::Radiance)[0])
            * f64::from(light.abs_cos_theta());
        let expected = 0.4 * 0.5 + 0.5 * 20.0_f64.to_radians().cos().powi(8);
        assert!((radiance - expected).abs() < 1e-6, "{radiance} {expected}");
        // Importance walks the same path from its other end.
        assert_eq!(b.eval(light, view, Mode::Importance), b.eval(view, light, Mode::Radiance));
    }

    #[test]
    fn neither_reciprocal_nor_passive() {
        let b = LegacyPhong {
            diffuse: Sampled::ZERO,
            ambient: Sampled::ZERO,
            specular: Sampled::ONE,
            exponent: 10.0,
        };
        let (a, c) = (at(80.0, 0.0), at(60.0, std::f32::consts::PI));
        let (there, back) = (b.eval(a, c, Mode::Radiance)[0], b.eval(c, a, Mode::Radiance)[0]);
        // The ratio of the cosines, 0.5/0.17365.
        assert!((back / there - 2.8794).abs() < 1e-3, "{there} {back}");
    }
}
