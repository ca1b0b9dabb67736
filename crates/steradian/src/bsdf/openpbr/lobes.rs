//! The values of the lobes that are no discrete directions.

use super::directional::Place;
use super::fuzz::Fuzz;
use super::interface;
use super::slabs::Wall;
use super::surface::{Above, OpenPbr};
use crate::bsdf::contract::Mode;
use crate::bsdf::oren_nayar::OrenNayar;
use crate::math::{LocalDir, Vec3};
use crate::spectrum::Sampled;
use crate::units::{PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

impl OpenPbr {
    pub(super) fn reflected(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        let (o, i) = (self.above(wo), self.above(wi));
        let (full, inside) = (self.full(wo), self.is_inside(wo));
        let mut f = Sampled::<Unitless>::ZERO;
        if self.fuzz > 0.0 {
            let fuzz = Fuzz::new(self.fuzz_roughness.get()).eval(wo, wi);
            f += self.fuzz_color.get() * (self.fuzz * full * fuzz);
        }
        let halfway = halfway(wo, wi);
        let passed = self.passed_twice(&o, &i);
        if let Some(wm) = halfway {
            let cos = wo.dot(*wm).abs();
            let coat = self.coat_facets();
            if self.coat > 0.0 && !coat.is_smooth() {
                let r = interface::reflectance(cos, self.coat_eta) * self.coat * full * o.fuzz.min(i.fuzz);
                f += Sampled::splat(0.25 * coat.d(wm) * coat.g_over_cosines(wo, wi) * r);
            }
            let facets = self.facets();
            if !facets.is_smooth() {
                let facet = self.facet(cos, inside);
                let d = 0.25 * facets.d(wm) * facets.g_over_cosines(wo, wi);
                f += (facet.layered * passed + facet.inside) * d;
            }
        }
        if let Some((lost, again)) = self.metal_again() {
            let loss = Place::new(o.mu).at(&lost) * Place::new(i.mu).at(&lost);
            f += again * passed * (FRAC_1_PI * loss);
        }
        if self.has_diffuse() && !self.diffuse.is_zero() {
            f += self.diffuse_base(&o, &i, wo, wi, self.diffuse.get());
        }
        f.cast()
    }

    /// The diffuse base with `reflectance`, for directions on one side of the surface.
    pub(super) fn diffuse_base(
        &self,
        o: &Above,
        i: &Above,
        wo: LocalDir,
        wi: LocalDir,
        reflectance: Sampled<Unitless>,
    ) -> Sampled<Unitless> {
        let roughness = self.diffuse_roughness.get();
        let base = if roughness > 0.0 {
            OrenNayar { reflectance, roughness }.eval(wo, wi).cast()
        } else {
            reflectance * FRAC_1_PI
        };
        let passed =
            o.fuzz * o.coat * o.gloss * i.fuzz * i.coat * i.gloss * self.diffuse_norm * self.opaque();
        let mut f = base * passed;
        if self.coat > 0.0 {
            let whole = self.diffuse.get() + self.diffuse_transmission.get();
            f = f
                * self.darkened(whole, self.returned)
                * self.absorbed(self.coat_path(o.mu) + self.coat_path(i.mu));
        }
        f
    }

    pub(super) fn transmitted(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        let mut f = Sampled::<Unitless>::ZERO;
        let facets = self.facets();
        if self.wall == Wall::Thin {
            let across = mirrored(-wi);
            let (o, i) = (self.above(wo), self.above(wi));
            if self.translucent > 0.0
                && !facets.is_smooth()
                && let Some(wm) = halfway(wo, across)
            {
                let d = 0.25 * facets.d(wm) * facets.g_over_cosines(wo, across);
                f += self.facet(wo.dot(*wm).abs(), false).transmitted * self.passed_twice(&o, &i) * d;
            }
            if self.has_diffuse() && !self.diffuse_transmission.is_zero() {
                f += self.diffuse_base(&o, &i, wo, across, self.diffuse_transmission.get());
            }
            return f.cast();
        }
        if self.translucent == 0.0 || facets.is_smooth() || self.passes_straight() {
            return Sampled::ZERO;
        }
        let Some(crossing) = self.crossing(wo, wi) else { return Sampled::ZERO };
        let facet = self.facet(crossing.om.abs(), wo.z < 0.0);
        let above = self.above(if wo.z > 0.0 { wo } else { wi });
        let d = facets.d(crossing.wm)
            * facets.g_over_cosines(wo, wi)
            * crossing.jacobian()
            * crossing.om.abs()
            * radiance_scale(mode, crossing.eta);
        (facet.transmitted * self.passed_once(&above) * d).cast()
    }

    /// The facet that refracts `wo` to `wi`; `None` when there is none (Walter et al. 2007, eq. 16).
    pub(super) fn crossing(&self, wo: LocalDir, wi: LocalDir) -> Option<RoughCrossing> {
        let eta = if wo.z > 0.0 { self.eta } else { 1.0 / self.eta };
        let wm = LocalDir::new(*wi * eta + *wo)?;
        let wm = if wm.z < 0.0 { -wm } else { wm };
        let (om, im) = (wo.dot(*wm), wi.dot(*wm));
        (im * wi.z > 0.0 && om * wo.z > 0.0).then_some(RoughCrossing { wm, om, im, eta })
    }
}

/// A facet between two directions on different sides.
pub(super) struct RoughCrossing {
    pub(super) wm: LocalDir,
    pub(super) om: f32,
    pub(super) im: f32,
    /// Index on the side of `wi` over that of `wo`.
    pub(super) eta: f32,
}

impl RoughCrossing {
    /// dωm/dωi, Walter et al. 2007, eq. 17.
    pub(super) fn jacobian(&self) -> f32 {
        let root = self.im + self.om / self.eta;
        self.im.abs() / (root * root)
    }
}

/// (ηo/ηi)² for radiance (Veach 1997, 5.2).
pub(super) fn radiance_scale(mode: Mode, eta: f32) -> f32 {
    match mode {
        Mode::Radiance => 1.0 / (eta * eta),
        Mode::Importance => 1.0,
    }
}

/// The mirror direction about the surface's normal.
pub(super) fn mirrored(w: LocalDir) -> LocalDir {
    LocalDir::new_unchecked(Vec3::new(-w.x, -w.y, w.z))
}

/// The upper facet normal between two directions on one side; `None` when there is none.
pub(super) fn halfway(wo: LocalDir, wi: LocalDir) -> Option<LocalDir> {
    let wm = LocalDir::new(*wo + *wi)?;
    Some(if wm.z < 0.0 { -wm } else { wm })
}
