//! OpenPBR Surface 1.1 (Academy Software Foundation, 2024-06-28): one general material as a mixture of lobes.
//!
//! ```text
//!              fuzz                      scattering volume of fibres          [`fuzz`]
//!              coat                      rough dielectric over an absorber
//!   - - - - - - film - - - - - - - -     interference in the interface of the base
//!   metal | translucent | opaque         F82-tint | refraction | gloss over a rough diffuse base
//! ```
//!
//! The specification leaves the reduction of the slabs to a scattering function open, and suggests albedo scaling, which
//! is not reciprocal. Here each slab passes the share T(ω) = 1 − w E(ω) of the light, with its coverage w and an upper bound
//! E of its directional albedo, and what lies below is multiplied by
//!
//! * T(ωo) T(ωi) / (1 − B (1 − max T)) for discrete and glossy lobes below: light that the slab sends back meets them again;
//!   B is the reflectance of what is below, or 1 as far as coat_darkening is turned down. Since T / max T ≤ 1 nothing is
//!   gained, and for mirrors under a mirror it is the exact sum of all reflections;
//! * T(ωo) T(ωi) / T̄ for the diffuse base, with the product T of all slabs above and its mean T̄ (Kelemen and
//!   Szirmay-Kalos 2001): exact for Lambert's law under a smooth interface, by the darkening factor of the specification.
//!
//! Both are symmetric and neither gains energy: every combination is reciprocal and passive. Metals keep what their
//! facets scatter more than once (Kulla and Conty 2017), and so does the gloss, whose E is that of single scattering: the
//! rest reaches the diffuse base. The refracting interface scatters once only and loses light where it is rough.
//!
//! Differences from the specification, besides the layering:
//!
//! * Colours are spectra, and a path refracts at the index of its hero wavelength.
//! * Media are not part of a surface: absorption and scattering over depth are left to the caller.
//! * Light is refracted by specular_ior over air, with or without a coat, since a coat with parallel faces does not bend
//!   it; the coat changes the reflectance of the interface only.
//! * A solid seen from inside shows its translucent share as the inside of the interface; the opaque share looks as it
//!   does from outside, as sheets without thickness do elsewhere in this library.
//! * A thin wall has its slabs on both sides, and transmitted light spreads like that mirrored by its facets.
//! * The film is seen in metals through an index fitted to the two colours; near-normal colours agree, edges roughly.
//! * Darkening of rough metals under a coat follows the specification's blend, that of gloss the smooth limit.
//! * Fuzz is in reciprocal form with the same albedo as the layer of Zeltner et al.; roughness below 0.1 counts as that.

mod directional;
mod fraction;
mod fuzz;
mod interface;
mod lobes;
mod metal;
mod slabs;
mod specimens;
mod surface;
mod tables;

pub use slabs::{Slabs, Wall};
pub use surface::OpenPbr;

use super::contract::{BsdfSample, Lobe, Lobes, Mode, Side};
use super::specimen::Claims;
use crate::math::float::safe_sqrt;
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::optics::fresnel::Crossing;
use crate::optics::{TrowbridgeReitz, refraction};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use directional::Place;
use lobes::{halfway, mirrored, radiance_scale};
use std::f32::consts::TAU;

const UNIFORM_HEMISPHERE_PDF: f32 = 1.0 / TAU;

/// Least share of samples for lobes whose reflectance at the macroscopic angle may vanish while some facet's does not.
const FLOOR: f32 = 0.02;

/// Lobes that samples are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Fuzz,
    Coat,
    Base,
    Diffuse,
    DiffuseTransmission,
    Hole,
}

const PARTS: [Part; 6] =
    [Part::Fuzz, Part::Coat, Part::Base, Part::Diffuse, Part::DiffuseTransmission, Part::Hole];

impl OpenPbr {
    /// f [sr⁻¹] of all lobes that are no discrete directions.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Sampled::ZERO;
        }
        let f = if wo.same_hemisphere(wi) { self.reflected(wo, wi) } else { self.transmitted(wo, wi, mode) };
        f * self.opacity
    }

    /// Density of [`OpenPbr::sample`].
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if wo.z == 0.0 || wi.z == 0.0 {
            return PdfSolidAngle(0.0);
        }
        let Some(choice) = Choice::new(self, wo) else { return PdfSolidAngle(0.0) };
        PdfSolidAngle(self.density(&choice, wo, wi))
    }

    /// A direction from one of the lobes, chosen in proportion to about what each scatters.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let choice = Choice::new(self, wo)?;
        let (part, uc) = choice.draw(uc);
        let side = wo.z.signum();
        let above = |w: LocalDir| LocalDir::new_unchecked(Vec3::new(w.x, w.y, side * w.z));
        let wi = match part {
            Part::Fuzz => {
                let z = 1.0 - u.x;
                let (r, phi) = (safe_sqrt(1.0 - z * z), TAU * u.y);
                above(LocalDir::new_unchecked(Vec3::new(r * phi.cos(), r * phi.sin(), z)))
            }
            Part::Diffuse => above(warp::cosine_hemisphere(u)),
            Part::DiffuseTransmission => -above(warp::cosine_hemisphere(u)),
            Part::Coat => {
                let facets = self.coat_facets();
                if facets.is_smooth() {
                    let f = interface::reflectance(wo.abs_cos_theta(), self.coat_eta) * self.coat;
                    let weight = f * self.full(wo) * self.above(wo).fuzz * self.opacity;
                    return Some(discrete(
                        mirrored(wo),
                        Side::Reflection,
                        1.0,
                        Sampled::splat(weight / choice.of(Part::Coat)),
                    ));
                }
                LocalDir::new_unchecked(refraction::reflect(*wo, *facets.sample_visible(wo, u)))
            }
            Part::Base => return self.sample_base(&choice, wo, uc, u, mode),
            Part::Hole => {
                let weight = (1.0 - self.opacity) / choice.of(Part::Hole);
                return Some(discrete(-wo, Side::Transmission, 1.0, Sampled::splat(weight)));
            }
        };
        let (side, lobe) = match part {
            Part::DiffuseTransmission => (Side::Transmission, Lobe::Diffuse),
            Part::Diffuse => (Side::Reflection, Lobe::Diffuse),
            _ => (Side::Reflection, Lobe::Glossy),
        };
        self.continuous(&choice, wo, wi, mode, side, lobe, 1.0)
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        let rough = !self.facets().is_smooth();
        let base = self.metal > 0.0 || self.dielectric > 0.0;
        let there = self.opacity > 0.0;
        let coat = self.coat > 0.0 && !self.coat_facets().is_smooth();
        Lobes {
            reflection: there
                && (rough && base
                    || coat
                    || self.fuzz > 0.0 && !self.fuzz_color.is_zero()
                    || self.has_diffuse() && !self.diffuse.is_zero()),
            transmission: there
                && (rough && self.translucent > 0.0 && !self.passes_straight()
                    || self.has_diffuse() && !self.diffuse_transmission.is_zero()),
        }
    }

    /// Widens narrow lobes: a named bias against fireflies.
    pub fn regularize(&mut self) {
        self.widths = self.facets().regularized().alpha();
        self.coat_widths = self.coat_facets().regularized().alpha();
        self.balance();
    }

    /// What holds for it: every combination of slabs is reciprocal and gains nothing.
    pub fn claims(&self) -> Claims {
        let bare = self.coat == 0.0 && self.fuzz == 0.0 && self.facets().is_smooth();
        let clear = self.translucent == 1.0 && self.transmission_color.is_one();
        if bare && clear && self.specular_color.is_one() { Claims::LOSSLESS } else { Claims::CLOSED_FORM }
    }

    fn density(&self, choice: &Choice, wo: LocalDir, wi: LocalDir) -> f32 {
        let facets = self.facets();
        let visible = |d: TrowbridgeReitz, wm: LocalDir| d.d(wm) * d.g1_over_cos(wo);
        let mu = wi.abs_cos_theta();
        let inside = self.is_inside(wo);
        // Where nothing bends, the choice is made before a facet is.
        let selector = |cos: f32| if self.passes_straight() { wo.abs_cos_theta() } else { cos };
        if wo.same_hemisphere(wi) {
            let mut p = choice.of(Part::Fuzz) * UNIFORM_HEMISPHERE_PDF
                + choice.of(Part::Diffuse) * warp::cosine_hemisphere_pdf(mu);
            if let Some(wm) = halfway(wo, wi) {
                let coat = self.coat_facets();
                if !coat.is_smooth() {
                    p += choice.of(Part::Coat) * 0.25 * visible(coat, wm);
                }
                if !facets.is_smooth() && choice.of(Part::Base) > 0.0 {
                    let facet = self.facet(selector(wo.dot(*wm).abs()), inside);
                    p += choice.of(Part::Base) * facet.reflection_probability() * 0.25 * visible(facets, wm);
                }
            }
            return p;
        }
        let mut p = choice.of(Part::DiffuseTransmission) * warp::cosine_hemisphere_pdf(mu);
        if facets.is_smooth() || self.translucent == 0.0 || self.passes_straight() {
            return p;
        }
        let (facet, along) = match self.wall {
            Wall::Thin => {
                let Some(wm) = halfway(wo, mirrored(-wi)) else { return p };
                (self.facet(wo.dot(*wm).abs(), false), 0.25 * visible(facets, wm))
            }
            Wall::Solid => {
                let Some(c) = self.crossing(wo, wi) else { return p };
                (self.facet(c.om.abs(), inside), visible(facets, c.wm) * c.om.abs() * c.jacobian())
            }
        };
        p += choice.of(Part::Base) * (1.0 - facet.reflection_probability()) * along;
        p
    }

    /// A direction that the interface of the base reflects or passes.
    fn sample_base(&self, choice: &Choice, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let inside = self.is_inside(wo);
        let facets = self.facets();
        let smooth = facets.is_smooth();
        let p_base = choice.of(Part::Base) / self.opacity;
        let wm = if smooth { LocalDir::Z } else { facets.sample_visible(wo, u) };
        let straight = smooth || self.passes_straight();
        let cos = if straight { wo.abs_cos_theta() } else { wo.dot(*wm).abs() };
        let facet = self.facet(cos, inside);
        let p_reflection = facet.reflection_probability();
        if uc < p_reflection {
            if smooth {
                let above = self.above(wo);
                let r = facet.layered * self.passed_twice(&above, &above) + facet.inside;
                return Some(discrete(mirrored(wo), Side::Reflection, 1.0, r / (p_base * p_reflection)));
            }
            let wi = LocalDir::new_unchecked(refraction::reflect(*wo, *wm));
            return self.continuous(choice, wo, wi, mode, Side::Reflection, Lobe::Glossy, 1.0);
        }
        let p = p_base * (1.0 - p_reflection);
        if self.wall == Wall::Thin {
            if smooth {
                let above = self.above(wo);
                let t = facet.transmitted * self.passed_twice(&above, &above);
                return Some(discrete(-wo, Side::Transmission, 1.0, t / p));
            }
            let wi = LocalDir::new_unchecked(refraction::reflect(*wo, *wm));
            if !wo.same_hemisphere(wi) {
                return None;
            }
            return self.continuous(choice, wo, mirrored(-wi), mode, Side::Transmission, Lobe::Glossy, 1.0);
        }
        let wm = if straight { LocalDir::Z } else { wm };
        let crossing = Crossing::new(wo.dot(*wm), self.eta);
        let wi = LocalDir::new_unchecked(crossing.refract(*wo, *wm)?);
        if straight {
            let above = self.above(if wo.z > 0.0 { wo } else { wi });
            let t = facet.transmitted * self.passed_once(&above) * radiance_scale(mode, crossing.eta);
            return Some(discrete(wi, Side::Transmission, crossing.eta, t / p));
        }
        self.continuous(choice, wo, wi, mode, Side::Transmission, Lobe::Glossy, crossing.eta)
    }

    /// A sample of a direction that several lobes may scatter to; `None` on the wrong side.
    #[expect(clippy::too_many_arguments, reason = "the fields of the sample that is made")]
    fn continuous(
        &self,
        choice: &Choice,
        wo: LocalDir,
        wi: LocalDir,
        mode: Mode,
        side: Side,
        lobe: Lobe,
        eta: f32,
    ) -> Option<BsdfSample> {
        if wi.z == 0.0 || wo.same_hemisphere(wi) != (side == Side::Reflection) {
            return None;
        }
        let pdf = PdfSolidAngle(self.density(choice, wo, wi));
        (pdf.0 > 0.0 && pdf.0.is_finite()).then(|| BsdfSample {
            wi,
            weight: self.eval(wo, wi, mode).weight(wi.abs_cos_theta(), pdf),
            density: Density::SolidAngle(pdf),
            side,
            lobe,
            eta,
        })
    }
}

/// Probabilities of the lobes for one direction.
struct Choice([f32; PARTS.len()]);

impl Choice {
    /// `None` when nothing is scattered.
    fn new(b: &OpenPbr, wo: LocalDir) -> Option<Self> {
        let above = b.above(wo);
        let full = b.full(wo);
        let reach = above.fuzz * above.coat;
        let facet = b.facet(above.mu, b.is_inside(wo));
        let coat = if b.coat == 0.0 {
            0.0
        } else if b.coat_facets().is_smooth() {
            b.coat * interface::reflectance(above.mu, b.coat_eta)
        } else {
            1.0 - above.coat
        };
        let again = b.metal_again().map_or(0.0, |(lost, f)| Place::new(above.mu).at(&lost) * f.mean());
        let (mut diffuse, mut diffuse_transmission) = (0.0, 0.0);
        if b.has_diffuse() {
            let reach = reach * above.gloss * b.opaque();
            diffuse = reach * b.diffuse.get().mean();
            diffuse_transmission = reach * b.diffuse_transmission.get().mean();
        }
        let mut weights = PARTS.map(|part| {
            b.opacity
                * match part {
                    Part::Fuzz => full * b.fuzz_color.get().mean() * (1.0 - above.fuzz),
                    Part::Coat => full * above.fuzz * coat,
                    Part::Base => {
                        let floor = FLOOR * (b.metal + b.dielectric);
                        reach * (facet.layered.mean() + floor)
                            + facet.inside.mean()
                            + reach * facet.transmitted.mean()
                    }
                    Part::Diffuse => diffuse + reach * again,
                    Part::DiffuseTransmission => diffuse_transmission,
                    Part::Hole => 0.0,
                }
        });
        let total: f32 = weights.iter().sum();
        if total > 0.0 {
            for w in &mut weights {
                *w *= b.opacity / total;
            }
            weights[PARTS.len() - 1] = 1.0 - b.opacity;
            return Some(Self(weights));
        }
        if b.opacity < 1.0 {
            weights = [0.0; PARTS.len()];
            weights[PARTS.len() - 1] = 1.0 - b.opacity;
            return Some(Self(weights));
        }
        None
    }

    fn of(&self, part: Part) -> f32 {
        self.0[part as usize]
    }

    /// The chosen lobe, and what is left of the random number.
    fn draw(&self, uc: f32) -> (Part, f32) {
        let mut rest = uc;
        let mut last = (Part::Hole, 0.0);
        for (&part, &p) in PARTS.iter().zip(&self.0) {
            if p > 0.0 {
                if rest < p {
                    return (part, (rest / p).min(1.0 - f32::EPSILON));
                }
                rest -= p;
                last = (part, 1.0 - f32::EPSILON);
            }
        }
        // Rounding of the sum.
        last
    }
}

fn discrete(wi: LocalDir, side: Side, eta: f32, weight: Sampled<Unitless>) -> BsdfSample {
    BsdfSample { wi, weight, density: Density::Delta, side, lobe: Lobe::Specular, eta }
}

#[cfg(test)]
mod tests;
