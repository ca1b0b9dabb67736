//! The slabs at one point, ready to scatter: what each reflects and what it leaves to those below.

use super::directional::{self, Curve, Nodes, Place, average};
use super::fraction::{Fraction, Fractions};
use super::fuzz::Fuzz;
use super::interface;
use super::metal::Metal;
use super::slabs::{self, Slabs, Wall};
use crate::math::LocalDir;
use crate::math::float::safe_sqrt;
use crate::optics::TrowbridgeReitz;
use crate::optics::films::{self, Film};
use crate::spectrum::{LANES, Sampled};
use crate::units::Unitless;

/// Indices closer than this refract rough interfaces straight: the lobe would be narrower than a float can say.
const MATCHED: f32 = 5e-3;

/// OpenPBR Surface at one point, from [`Slabs`].
#[derive(Clone, Copy, Debug)]
pub struct OpenPbr {
    pub(super) lambda_nm: [f32; LANES],
    pub(super) base_color: Fractions,
    pub(super) specular_color: Fractions,
    pub(super) transmission_color: Fractions,
    /// Reflectance of the diffuse base.
    pub(super) diffuse: Fractions,
    /// Transmittance of the diffuse base: of thin walls only.
    pub(super) diffuse_transmission: Fractions,
    pub(super) coat_color: Fractions,
    pub(super) fuzz_color: Fractions,
    /// Shares of the surface below the coat; metal includes its specular weight, and translucent is a part of dielectric.
    pub(super) metal: f32,
    pub(super) dielectric: f32,
    pub(super) translucent: f32,
    pub(super) coat: f32,
    pub(super) fuzz: f32,
    pub(super) opacity: f32,
    /// Index of the base over air.
    pub(super) eta: f32,
    /// Index of the base over what is above it: air or coat.
    pub(super) eta_reflection: f32,
    pub(super) coat_eta: f32,
    /// Over what is above it.
    pub(super) film: Film,
    pub(super) widths: [f32; 2],
    pub(super) coat_widths: [f32; 2],
    /// 1/T̄ of the slabs above the diffuse base.
    pub(super) diffuse_norm: f32,
    /// What the coat returns of diffuse light from below.
    pub(super) returned: f32,
    pub(super) film_weight: Fraction,
    pub(super) coat_darkening: Fraction,
    pub(super) diffuse_roughness: Fraction,
    pub(super) fuzz_roughness: Fraction,
    pub(super) under_coat: Curve,
    pub(super) under_gloss: Curve,
    pub(super) wall: Wall,
}

/// What the slabs above pass for one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Above {
    pub(super) mu: f32,
    pub(super) fuzz: f32,
    pub(super) coat: f32,
    pub(super) gloss: f32,
}

/// What the base's interface does at a facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// Reflected, to pass the slabs above twice.
    pub(super) layered: Sampled<Unitless>,
    /// Reflected inside.
    pub(super) inside: Sampled<Unitless>,
    /// Refracted, or passed by a thin wall.
    pub(super) transmitted: Sampled<Unitless>,
}

impl Facet {
    /// Probability with which a sample is reflected.
    pub(super) fn reflection_probability(&self) -> f32 {
        let r = (self.layered + self.inside).mean();
        let t = self.transmitted.mean();
        if t > 0.0 { r / (r + t) } else { 1.0 }
    }
}

impl OpenPbr {
    /// The surface made of `s`.
    pub fn new(s: &Slabs) -> Self {
        let [fuzz, coat] = [s.fuzz_weight, s.coat_weight].map(|w| w.clamp(0.0, 1.0));
        let thin = s.wall == Wall::Thin;
        // Base lobes widen under a rough coat (specification, "Roughening").
        let [rough, coat_rough] = [s.specular_roughness, s.coat_roughness].map(|r| r.clamp(0.0, 1.0));
        let under_coat = (rough.powi(4) + 2.0 * coat_rough.powi(4)).min(1.0).sqrt().sqrt();
        let rough = rough + (under_coat - rough) * coat;
        // The index of the surroundings, where some of the base is covered by the coat.
        let ratio = s.specular_ior * (1.0 + coat * (1.0 / s.coat_ior - 1.0));
        let around = s.specular_ior / ratio;
        // Light in the coat came from air: there is no total reflection under a denser coat.
        let ratio = if ratio < 1.0 && s.specular_ior >= 1.0 { 1.0 / ratio } else { ratio };
        let dielectric = 1.0 - s.base_metalness.clamp(0.0, 1.0);
        let sheet = if thin { s.subsurface_weight.clamp(0.0, 1.0) } else { 0.0 };
        let scattered = s.subsurface_color * (0.5 * sheet);
        let g = s.subsurface_scatter_anisotropy.clamp(-1.0, 1.0);
        let mut open = Self {
            lambda_nm: s.lambda_nm,
            base_color: Fractions::new(s.base_color),
            specular_color: Fractions::new(s.specular_color),
            transmission_color: Fractions::new(s.transmission_color),
            diffuse: Fractions::new(s.base_color * (1.0 - sheet) + scattered * (1.0 - g)),
            diffuse_transmission: Fractions::new(scattered * (1.0 + g)),
            coat_color: Fractions::new(s.coat_color),
            fuzz_color: Fractions::new(s.fuzz_color),
            metal: (1.0 - dielectric) * s.specular_weight.clamp(0.0, 1.0),
            dielectric,
            translucent: dielectric * s.transmission_weight.clamp(0.0, 1.0),
            coat,
            fuzz,
            opacity: s.geometry_opacity.clamp(0.0, 1.0),
            eta: interface::modulated(s.specular_ior, s.specular_weight),
            eta_reflection: interface::modulated(ratio, s.specular_weight),
            coat_eta: s.coat_ior,
            film: Film {
                eta: s.thin_film_ior / around,
                // The wavelength in the coat is shorter.
                thickness_nm: s.thin_film_thickness_nm.max(0.0) * around,
            },
            widths: slabs::widths(rough, s.specular_roughness_anisotropy.clamp(0.0, 1.0)),
            coat_widths: slabs::widths(coat_rough, s.coat_roughness_anisotropy.clamp(0.0, 1.0)),
            diffuse_norm: 1.0,
            returned: 0.0,
            film_weight: Fraction::new(s.thin_film_weight),
            coat_darkening: Fraction::new(s.coat_darkening),
            diffuse_roughness: Fraction::new(s.base_diffuse_roughness),
            fuzz_roughness: Fraction::new(s.fuzz_roughness),
            under_coat: Curve::CLEAR,
            under_gloss: Curve::CLEAR,
            wall: s.wall,
        };
        if coat > 0.0 && s.coat_darkening > 0.0 {
            open.returned = interface::returned_share(s.coat_ior);
        }
        open.balance();
        open
    }

    /// Sets what each slab leaves to those below, once the slabs are known.
    pub(super) fn balance(&mut self) {
        if self.coat > 0.0 {
            let fresnel = directional::at_nodes(self.coat_eta, |c| interface::reflectance(c, self.coat_eta));
            let nodes = directional::reflected(self.coat_widths, &fresnel);
            self.under_coat = Curve::left_by(&nodes, self.coat);
        }
        if !self.has_diffuse() {
            return;
        }
        let (eta, film) = (self.eta_reflection, self.film_weight.get());
        let fresnel = directional::at_nodes(eta, |c| {
            let bare = interface::reflectance(c, eta);
            if film > 0.0 {
                bare + film * (interface::film_bound(c, self.film.eta, eta) - bare)
            } else {
                bare
            }
        });
        self.under_gloss = Curve::left_by(&directional::reflected(self.widths, &fresnel), 1.0);
        let fuzz = self.fuzz_nodes();
        let passed = |mu: f32| {
            let fuzz = fuzz.map_or(1.0, |nodes| 1.0 - self.fuzz * Place::new(mu).at(&nodes));
            fuzz * self.under_coat.at(mu) * self.under_gloss.at(mu)
        };
        let mean = average(passed);
        // A rough diffuse base prefers directions that the slabs above may pass more of than they do in the mean.
        let most = self.under_coat.max() * self.under_gloss.max();
        let excess = ROUGH_EXCESS * self.diffuse_roughness.get() * (most / mean - 1.0).max(0.0);
        // Rounding must not make light.
        self.diffuse_norm = 0.9995 / (mean.max(1e-6) * (1.0 + excess));
    }

    pub(super) fn facets(&self) -> TrowbridgeReitz {
        TrowbridgeReitz::new(self.widths[0], self.widths[1])
    }

    pub(super) fn coat_facets(&self) -> TrowbridgeReitz {
        TrowbridgeReitz::new(self.coat_widths[0], self.coat_widths[1])
    }

    /// The share of the base that is opaque and no metal.
    pub(super) fn opaque(&self) -> f32 {
        self.dielectric - self.translucent
    }

    pub(super) fn has_diffuse(&self) -> bool {
        self.opaque() > 0.0 && !(self.diffuse.is_zero() && self.diffuse_transmission.is_zero())
    }

    /// Whether a rough interface has no contrast to refract at.
    pub(super) fn passes_straight(&self) -> bool {
        self.wall == Wall::Solid && (self.eta - 1.0).abs() < MATCHED
    }

    /// Whether `w` lies inside of a translucent body.
    pub(super) fn is_inside(&self, w: LocalDir) -> bool {
        w.z < 0.0 && self.wall == Wall::Solid && self.translucent > 0.0
    }

    /// The share of the surface that has its slabs on the side of `w`.
    pub(super) fn full(&self, w: LocalDir) -> f32 {
        if self.is_inside(w) { 1.0 - self.translucent } else { 1.0 }
    }

    pub(super) fn fuzz_nodes(&self) -> Option<Nodes> {
        (self.fuzz > 0.0).then(|| Fuzz::new(self.fuzz_roughness.get()).reflected())
    }

    pub(super) fn metal_colors(&self) -> Metal {
        Metal { base: self.base_color.get(), tint: self.specular_color.get() }
    }

    pub(super) fn above(&self, w: LocalDir) -> Above {
        let mu = w.abs_cos_theta();
        Above {
            mu,
            fuzz: self.fuzz_nodes().map_or(1.0, |nodes| 1.0 - self.fuzz * Place::new(mu).at(&nodes)),
            coat: if self.coat > 0.0 { self.under_coat.at(mu) } else { 1.0 },
            gloss: self.under_gloss.at(mu),
        }
    }

    /// The path in the coat over its thickness, B (2.5).
    pub(super) fn coat_path(&self, mu: f32) -> f32 {
        let inside = 1.0 - (1.0 - mu * mu) / (self.coat_eta * self.coat_eta);
        inside.max(1e-4).sqrt().recip()
    }

    /// What the coat's medium leaves over a `path` in its thickness; coat_color is that of two.
    pub(super) fn absorbed(&self, path: f32) -> Sampled<Unitless> {
        if self.coat == 0.0 || self.coat_color.is_one() {
            return Sampled::ONE;
        }
        self.coat_color.get().map(|c| 1.0 + self.coat * (c.powf(0.5 * path) - 1.0))
    }

    /// What fuzz and coat leave of light that passes them down and up between glossy lobes.
    pub(super) fn passed_twice(&self, o: &Above, i: &Above) -> Sampled<Unitless> {
        let fuzz = o.fuzz.min(i.fuzz);
        if self.coat == 0.0 {
            return Sampled::splat(fuzz);
        }
        let (product, most) = (fuzz * o.coat * i.coat, o.coat.max(i.coat));
        if most == 0.0 {
            return Sampled::ZERO;
        }
        let (base, darkening) = (self.base_color.get(), self.coat_darkening.get());
        let solid = 1.0 - self.translucent;
        let absorbed = self.absorbed(self.coat_path(o.mu) + self.coat_path(i.mu));
        Sampled::from_fn(|lane| {
            let again = 1.0 - darkening * (1.0 - solid * base[lane]);
            // 1 − again (1 − most) without its rounding at the horizon.
            absorbed[lane] * product / (1.0 - again + again * most)
        })
    }

    /// What a single pass leaves.
    pub(super) fn passed_once(&self, above: &Above) -> Sampled<Unitless> {
        self.absorbed(self.coat_path(above.mu)) * (above.fuzz * above.coat)
    }

    /// (1 − K)/(1 − ρK) for a base of reflectance `rho` under a coat that returns K, as far as darkening is wanted
    /// (specification, "Darkening").
    pub(super) fn darkened(&self, rho: Sampled<Unitless>, k: f32) -> Sampled<Unitless> {
        let amount = self.coat * self.coat_darkening.get();
        if amount == 0.0 || k == 0.0 {
            return Sampled::ONE;
        }
        rho.map(|rho| 1.0 + amount * ((1.0 - k) / (1.0 - rho * k) - 1.0))
    }

    /// The factor of the metal that the glossy coupling does not contain: rough metals return light to where the coat
    /// reflects all of it.
    pub(super) fn metal_darkening(&self) -> Sampled<Unitless> {
        let [x, y] = self.widths;
        let roughness = (0.5 * (x * x + y * y)).sqrt().sqrt().min(1.0);
        self.darkened(self.base_color.get(), roughness * self.returned)
    }

    /// Reflectance of the base's metal.
    pub(super) fn metal_reflectance(&self, cos: f32) -> Sampled<Unitless> {
        let metal = self.metal_colors();
        let bare = metal.at(cos);
        let w = self.film_weight.get();
        if w > 0.0 { bare * (1.0 - w) + metal.under(self.film, cos, &self.lambda_nm) * w } else { bare }
    }

    /// Reflectance of the base's dielectric for a cosine above it, without tint.
    pub(super) fn dielectric_reflectance(&self, cos: f32) -> Sampled<Unitless> {
        let eta = self.eta_reflection;
        let bare = Sampled::splat(interface::reflectance(cos, eta));
        let w = self.film_weight.get();
        if w == 0.0 {
            return bare;
        }
        let filmed =
            Sampled::from_fn(|i| films::reflectance_dielectric(cos, self.film, eta, self.lambda_nm[i]));
        bare * (1.0 - w) + filmed * w
    }

    /// What the base does at a facet seen under the cosine `cos`, from outside or inside.
    pub(super) fn facet(&self, cos: f32, inside: bool) -> Facet {
        let mut facet = Facet { layered: Sampled::ZERO, inside: Sampled::ZERO, transmitted: Sampled::ZERO };
        if self.metal > 0.0 {
            facet.layered = self.metal_reflectance(cos) * self.metal_darkening() * self.metal;
        }
        if self.dielectric == 0.0 {
            return facet;
        }
        let tint = self.specular_color.get();
        let r = self.dielectric_reflectance(cos);
        facet.layered += tint * r * self.opaque();
        if self.translucent == 0.0 {
            return facet;
        }
        let color = self.transmission_color.get();
        match self.wall {
            Wall::Thin => {
                let inside = safe_sqrt(1.0 - (1.0 - cos * cos) / (self.eta * self.eta)).max(1e-3);
                let pane = interface::pane(r, color.map(|c| c.powf(1.0 / inside)));
                facet.layered += (tint * r + pane.reflected_inside) * self.translucent;
                facet.transmitted = pane.transmitted * self.translucent;
            }
            Wall::Solid if inside => {
                // Both ends of a refracted path reflect alike.
                let cos2 = 1.0 - self.eta * self.eta * (1.0 - cos * cos);
                let r = if cos2 > 0.0 { self.dielectric_reflectance(cos2.sqrt()) } else { Sampled::ONE };
                facet.inside = r * self.translucent;
                facet.transmitted = color * (Sampled::ONE - r) * self.translucent;
            }
            Wall::Solid => {
                facet.layered += tint * r * self.translucent;
                facet.transmitted = color * (Sampled::ONE - r) * self.translucent;
            }
        }
        facet
    }

    /// The part of light scattered more than once between the facets of the metal, and what it reflects.
    pub(super) fn metal_again(&self) -> Option<(Nodes, Sampled<Unitless>)> {
        if self.metal == 0.0 || self.facets().is_smooth() {
            return None;
        }
        let white = directional::reflected_by_mirrors(self.widths);
        let mean = directional::mean(&white);
        let f = self.metal_colors().average();
        let again = f.map(|f| f * f * mean / (1.0 - f * (1.0 - mean)));
        let lost = white.map(|e| 1.0 - e);
        // The product form's normalisation, π times the mean loss.
        let norm = self.metal / (1.0 - mean).max(1e-6);
        Some((lost, again * self.metal_darkening() * norm))
    }
}

/// How much of the spread of the slabs' transmission a rough diffuse base can use; the largest found was a third.
const ROUGH_EXCESS: f32 = 0.4;
