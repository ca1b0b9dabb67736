//! Legacy shading as A (34)–(40) has it: the sum over lights that shine from one direction each, an ambient term, and
//! nothing else. Not light transport: no bounces, no emission, and no shadows unless they are asked for.
//!
//! A point light of intensity I makes the irradiance E = I/r² on a plane that faces it, A (20), and a distant light is given by
//! its E. A surface with a BRDF f shows
//!
//! ```text
//! L = Σj f(d, dj) Ej max(0, n·dj) + ρ Ia        A (26)–(28), (36)
//! ```
//!
//! which for Lambert's f = ρ/π is A (34) with ρ₀ = ρ/π, and A (35) with I = E/π. Ia is the radiance of uniform surroundings, of which
//! a surface returns its albedo: for Phong's model, A (40), its own coefficient ra.

use super::contract::{FirstSurface, Integrator, Tally, VisibleSurface};
use super::vertex::{albedo, reference};
use crate::bsdf::Mode;
use crate::light::Light;
use crate::material::SurfaceBsdf;
use crate::math::{Dir, Ray, Vec2};
use crate::sampler::Sampler;
use crate::scene::Scene;
use crate::shape::ReferencePoint;
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::{PdfSolidAngle, Radiance};

/// Legacy shading.
#[derive(Clone, Copy, Debug)]
pub struct ClassicShading<'a> {
    /// Uniform surroundings with the radiance Ia.
    pub ambient: Option<&'a Light>,
    /// Whether what stands between a surface and a light matters; the text knows no shadows.
    pub shadows: bool,
}

impl Integrator for ClassicShading<'_> {
    fn radiance(
        &self,
        scene: &Scene,
        mut ray: Ray,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        first: Option<&mut FirstSurface>,
    ) -> Sampled<Radiance> {
        tally.paths += 1;
        loop {
            tally.closest_rays += 1;
            let Some(direction) = Dir::new(ray.d) else { return Sampled::ZERO };
            let Some(hit) = scene.intersect(&ray, f32::INFINITY) else { return Sampled::ZERO };
            let wo = -direction;
            tally.vertices += 1;
            let Some(bsdf) = scene.shade(&hit, wo, w, sampler.hash_seed()) else {
                ray = hit.point.p.spawn(hit.point.ng, direction, ray.time);
                continue;
            };
            if let Some(first) = first {
                first.surface =
                    Some(VisibleSurface { point: hit.point, seen_from: ray.o, albedo: albedo(&bsdf, wo) });
            }
            let from = reference(&hit.point, &bsdf, wo);
            return self.direct(scene, &from, &bsdf, wo, w, tally) + self.ambient(&bsdf, wo, w, sampler);
        }
    }
}

impl ClassicShading<'_> {
    /// A (28): every light that shines from one direction.
    fn direct(
        &self,
        scene: &Scene,
        from: &ReferencePoint,
        bsdf: &SurfaceBsdf,
        wo: Dir,
        w: &Wavelengths,
        tally: &mut Tally,
    ) -> Sampled<Radiance> {
        let mut radiance = Sampled::ZERO;
        for light in scene.lights().iter().filter(|l| l.is_delta()) {
            let Some(s) = light.sample(from, scene.shapes(), 0, Vec2::ZERO, w) else { continue };
            let f = bsdf.eval(wo, s.wi, Mode::Radiance);
            if f.is_zero() {
                continue;
            }
            if self.shadows {
                tally.shadow_rays += 1;
                if scene.is_occluded(from, &s.target, s.wi) {
                    continue;
                }
            }
            // A (27), (32): of a point light, the sample holds E instead of a radiance over a density.
            radiance += f.reflect(s.radiance, bsdf.abs_cos(s.wi), PdfSolidAngle(1.0));
        }
        radiance
    }

    /// A (36). The albedo of a surface without a coefficient of its own is estimated by one sample.
    fn ambient(
        &self,
        bsdf: &SurfaceBsdf,
        wo: Dir,
        w: &Wavelengths,
        sampler: &mut Sampler,
    ) -> Sampled<Radiance> {
        let Some(ambient) = self.ambient else { return Sampled::ZERO };
        let reflected = bsdf.bsdf().legacy_ambient().unwrap_or_else(|| {
            // Towards sensors, weights are ratios of power: surroundings inside glass are as bright as outside.
            bsdf.sample(wo, sampler.next_1d(), sampler.next_2d(), Mode::Importance)
                .map_or(Sampled::ZERO, |s| s.weight)
        });
        reflected * ambient.escaped(wo, w)
    }
}
