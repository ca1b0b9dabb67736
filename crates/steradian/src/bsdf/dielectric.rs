//! The interface between two transparent media, smooth or rough, and a thin pane of two such interfaces.

use super::albedo::Albedo;
use super::contract::{BsdfSample, Evaluated, Lobe, Lobes, Mode, Side, Sides};
use super::specimen::{Claims, Specimen};
use crate::math::{LocalDir, Vec2, Vec3};
use crate::optics::fresnel::{self, Crossing};
use crate::optics::{Distribution, TrowbridgeReitz, refraction};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian};

/// An interface between transparent media.
///
/// The index is one number: where it depends on the wavelength, the path carries its hero only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric<D = TrowbridgeReitz> {
    /// Index below the surface over the index above it.
    pub eta: f32,
    /// Distribution of the microfacets.
    pub roughness: D,
}

/// A pair of directions at a rough interface, apart from how much of the light takes that way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    pub(super) side: Side,
    /// Cosine of `wo` to the facet, negative from below.
    cos: f32,
    /// Cosine to the facet, negative from below, of that of both directions which lies in the less dense medium; on either
    /// side of the facet it decides about Fresnel's reflectance, and there it does so without amplifying its rounding.
    pub(super) thin_cos: f32,
    /// Index on the side of `wi` over that on the side of `wo`.
    pub(super) eta: f32,
    /// f [sr⁻¹] for importance, if all light took this way.
    pub(super) f: f32,
    /// Density of drawing `wi` for `wo` [sr⁻¹], were the side certain.
    pub(super) pdf: f32,
    /// Density of drawing `wo` for `wi` [sr⁻¹], were the side certain.
    reverse_pdf: f32,
}

/// Value and density of a pair of directions, alike at every wavelength.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluation {
    /// f [sr⁻¹].
    pub(crate) f: f32,
    /// Density of drawing `wi` for `wo` [sr⁻¹].
    pub(crate) pdf: f32,
    /// Density of drawing `wo` for `wi` [sr⁻¹], were the side certain.
    pub(crate) reverse_pdf: f32,
}

/// A drawn direction, alike at every wavelength.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Draw {
    pub(crate) wi: LocalDir,
    /// f·|cosθi|/p.
    pub(crate) weight: f32,
    /// The facet that was met; `None` for a discrete direction.
    pub(crate) facet: Option<LocalDir>,
    pub(crate) side: Side,
    /// Probability of having chosen the side.
    pub(crate) probability: f32,
    pub(crate) eta: f32,
}

impl<D: Distribution> Dielectric<D> {
    /// f [sr⁻¹]; Walter et al. 2007, eq. 20 and 21, the latter over η² for radiance.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        self.evaluate_at(wo, wi, mode, Sides::Both).map_or(Sampled::ZERO, |e| Sampled::splat(e.f))
    }

    /// Density of [`Dielectric::sample`]; zero where the interface is smooth.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        // The density does not depend on what is transported.
        PdfSolidAngle(self.evaluate_at(wo, wi, Mode::Importance, Sides::Both).map_or(0.0, |e| e.pdf))
    }

    /// Both at once.
    pub fn evaluate(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Evaluated {
        self.evaluate_at(wo, wi, mode, Sides::Both)
            .map_or(Evaluated::NOTHING, |e| Evaluated { f: Sampled::splat(e.f), pdf: PdfSolidAngle(e.pdf) })
    }

    /// A direction mirrored or refracted at a visible microfacet, chosen with `uc` by its reflectance.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let drawn = self.draw(wo, uc, u, mode, Sides::Both)?;
        let (density, lobe) = match self.density(wo, &drawn) {
            Some(pdf) => (Density::SolidAngle(PdfSolidAngle(pdf)), Lobe::Glossy),
            None => (Density::Delta, Lobe::Specular),
        };
        Some(BsdfSample {
            wi: drawn.wi,
            weight: Sampled::splat(drawn.weight),
            density,
            side: drawn.side,
            lobe,
            eta: drawn.eta,
        })
    }

    /// ρ and τ for light from `wi` where the interface is smooth.
    pub fn albedo(&self, wi: LocalDir) -> Option<Albedo> {
        self.is_specular().then(|| Albedo::clear(fresnel::dielectric(wi.z, self.eta)))
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        let rough = !self.is_specular();
        Lobes { reflection: rough, transmission: rough }
    }

    /// Widens a narrow lobe: a named bias against fireflies.
    pub fn regularize(&mut self) {
        self.roughness = self.roughness.regularized();
    }

    /// What holds for it: only light that meets a second facet is lost.
    pub fn claims(&self) -> Claims {
        if self.is_specular() { Claims::LOSSLESS } else { Claims::CLOSED_FORM }
    }

    /// Whether only discrete directions are scattered into: smooth, or no contrast to refract at.
    pub(crate) fn is_specular(&self) -> bool {
        self.eta == 1.0 || self.roughness.is_smooth()
    }

    /// Value and density for a rough interface; `None` where both are zero.
    #[inline]
    pub(crate) fn evaluate_at(
        &self,
        wo: LocalDir,
        wi: LocalDir,
        mode: Mode,
        sides: Sides,
    ) -> Option<Evaluation> {
        let met = self.meet(wo, wi)?;
        let r = fresnel::dielectric(met.cos, self.eta);
        let reflected = sides.reflection_probability(r);
        let (share, probability) = match met.side {
            Side::Reflection => (r, reflected),
            Side::Transmission => ((1.0 - r) * radiance_scale(mode, met.eta), 1.0 - reflected),
        };
        Some(Evaluation { f: met.f * share, pdf: met.pdf * probability, reverse_pdf: met.reverse_pdf })
    }

    /// The facet that takes `wo` to `wi`; `None` where there is none.
    #[inline]
    pub(super) fn meet(&self, wo: LocalDir, wi: LocalDir) -> Option<Meeting> {
        if self.is_specular() || wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        let side = if wo.z * wi.z > 0.0 { Side::Reflection } else { Side::Transmission };
        let eta = match side {
            Side::Reflection => 1.0,
            Side::Transmission if wo.z > 0.0 => self.eta,
            Side::Transmission => 1.0 / self.eta,
        };
        let half = *wi * eta + *wo;
        let length2 = half.length_squared();
        if length2 < f32::MIN_POSITIVE {
            return None;
        }
        let wm = half * length2.sqrt().recip().copysign(half.z);
        let (om, im) = (wo.dot(wm), wi.dot(wm));
        // Both directions must see the facet from the side on which they see the surface.
        if im * wi.z <= 0.0 || om * wo.z <= 0.0 {
            return None;
        }
        let d = self.roughness.d(LocalDir::new_unchecked(wm));
        let f = d * self.roughness.g_over_cosines(wo, wi);
        let visible = |w| d * self.roughness.g1_over_cos(w);
        Some(match side {
            Side::Reflection => Meeting {
                side,
                cos: om,
                thin_cos: om,
                eta,
                f: 0.25 * f,
                pdf: 0.25 * visible(wo),
                reverse_pdf: 0.25 * visible(wi),
            },
            Side::Transmission => {
                let jacobian = refraction_jacobian(om, im, eta) * om.abs();
                Meeting {
                    side,
                    cos: om,
                    thin_cos: if eta > 1.0 { om } else { im },
                    eta,
                    f: f * jacobian,
                    pdf: visible(wo) * jacobian,
                    // Seen from the other side, the index and so the Jacobian's root are inverted.
                    reverse_pdf: visible(wi) * jacobian / (eta * eta),
                }
            }
        })
    }

    /// Draws among the asked-for `sides`; `None` below the horizon or when nothing goes there.
    #[inline]
    pub(crate) fn draw(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode, sides: Sides) -> Option<Draw> {
        if wo.z == 0.0 {
            return None;
        }
        if self.is_specular() {
            return self.draw_at(wo, LocalDir::Z, uc, mode, sides);
        }
        let wm = self.roughness.sample_visible(wo, u);
        let mut drawn = self.draw_at(wo, wm, uc, mode, sides)?;
        if (wo.z * drawn.wi.z > 0.0) != (drawn.side == Side::Reflection) {
            return None;
        }
        // D and the cosines cancel: f cosθi / p = R G / (G1(wo) P), and likewise with 1 − R.
        drawn.weight *= self.roughness.g_over_g1(wo, drawn.wi);
        drawn.facet = Some(wm);
        Some(drawn)
    }

    /// The density of what [`Dielectric::draw`] drew for `wo`; `None` for a discrete direction.
    #[inline]
    pub(crate) fn density(&self, wo: LocalDir, drawn: &Draw) -> Option<f32> {
        let wm = drawn.facet?;
        let visible = self.roughness.d(wm) * self.roughness.g1_over_cos(wo) * drawn.probability;
        Some(match drawn.side {
            Side::Reflection => 0.25 * visible,
            Side::Transmission => {
                let om = wo.dot(*wm);
                visible * om.abs() * refraction_jacobian(om, drawn.wi.dot(*wm), drawn.eta)
            }
        })
    }

    /// A mirrored or refracted direction at the facet with normal `wm`, without shadowing.
    #[inline]
    fn draw_at(&self, wo: LocalDir, wm: LocalDir, uc: f32, mode: Mode, sides: Sides) -> Option<Draw> {
        let crossing = Crossing::new(wo.dot(*wm), self.eta);
        let r = crossing.reflectance;
        let p = sides.reflection_probability(r);
        if uc < p {
            return (r > 0.0).then(|| Draw {
                wi: LocalDir::new_unchecked(refraction::reflect(*wo, *wm)),
                weight: sides.weight(r),
                facet: None,
                side: Side::Reflection,
                probability: p,
                eta: 1.0,
            });
        }
        Some(Draw {
            wi: LocalDir::new_unchecked(crossing.refract(*wo, *wm)?),
            weight: sides.weight(1.0 - r) * radiance_scale(mode, crossing.eta),
            facet: None,
            side: Side::Transmission,
            probability: 1.0 - p,
            eta: crossing.eta,
        })
    }
}

impl Dielectric {
    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |eta, ax, ay| Self { eta, roughness: TrowbridgeReitz::new(ax, ay) };
        [
            Specimen::new("dielectric smooth", Claims::LOSSLESS, of(1.5, 0.0, 0.0)),
            Specimen::new("dielectric smooth, less dense", Claims::LOSSLESS, of(0.75, 0.0, 0.0)),
            Specimen::new("dielectric without contrast", Claims::LOSSLESS, of(1.0, 0.3, 0.3)),
            Specimen::new("dielectric rough 0.01", Claims::CLOSED_FORM, of(1.5, 0.01, 0.01)),
            Specimen::new("dielectric rough 0.1", Claims::CLOSED_FORM, of(1.5, 0.1, 0.1)),
            Specimen::new("dielectric rough 0.5", Claims::CLOSED_FORM, of(1.5, 0.5, 0.5)),
            Specimen::new("dielectric rough 1", Claims::CLOSED_FORM, of(1.5, 1.0, 1.0)),
            Specimen::new("dielectric rough, less dense", Claims::CLOSED_FORM, of(1.0 / 1.33, 0.3, 0.3)),
            Specimen::new("dielectric brushed", Claims::CLOSED_FORM, of(1.5, 0.2, 0.6)),
        ]
        .into_iter()
    }
}

/// dωm/dωi of a refraction at the facet normal, from the cosines to it; Walter et al. 2007, eq. 17.
fn refraction_jacobian(om: f32, im: f32, eta: f32) -> f32 {
    let root = im + om / eta;
    im.abs() / (root * root)
}

/// (ηo/ηi)² for radiance: light that enters a denser medium is spread over a smaller solid angle there, so
/// that radiance seen from outside is the smaller (Veach 1997, 5.2).
pub(super) fn radiance_scale(mode: Mode, eta: f32) -> f32 {
    match mode {
        Mode::Radiance => 1.0 / (eta * eta),
        Mode::Importance => 1.0,
    }
}

/// A pane so thin that it neither shifts nor focuses light: two parallel smooth interfaces.
#[derive(Clone, Copy, Debug)]
pub struct ThinDielectric {
    /// Index of the pane over that of its surroundings.
    pub eta: f32,
}

impl ThinDielectric {
    /// A discrete direction: mirrored, or straight on.
    pub fn sample(&self, wo: LocalDir, uc: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let r = self.reflectance(wo);
        let (wi, side) = if uc < r {
            (LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z)), Side::Reflection)
        } else {
            (-wo, Side::Transmission)
        };
        // Chosen with the probability that is its power ratio.
        Some(BsdfSample {
            wi,
            weight: Sampled::ONE,
            density: Density::Delta,
            side,
            lobe: Lobe::Specular,
            eta: 1.0,
        })
    }

    /// ρ and τ for light from `wi`.
    pub fn albedo(&self, wi: LocalDir) -> Albedo {
        Albedo::clear(self.reflectance(wi))
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        Claims::LOSSLESS
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        [Specimen::new("thin dielectric", Claims::LOSSLESS, Self { eta: 1.5 })].into_iter()
    }

    /// All orders of internal reflection summed for each polarisation, R + T²R/(1 − R²) = 2R/(1 + R), and then their mean, as
    /// Stokes (1862) has it for unpolarised light. pbrt-v4 (book, 9.5.1) sums for the mean R instead: its panes transmit too
    /// little, 3 % at 70°.
    fn reflectance(&self, wo: LocalDir) -> f32 {
        let single = fresnel::dielectric_polarized(wo.abs_cos_theta(), self.eta);
        single.s / (1.0 + single.s) + single.p / (1.0 + single.p)
    }
}
