//! Values at and near the horizon, from both sides.

use super::evidence::{Evidence, Finding, Law};
use super::scatterer::{Scatterer, draw};
use super::survey::Bench;
use crate::bsdf::contract::Mode;
use crate::math::hash::Pcg32;
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::spectrum::LANES;
use crate::units::Density;

/// Cosines of the fixed direction.
const COSINES: [f32; 10] = [1.0, 1e-2, 1e-4, 1e-7, 1e-20, 0.0, -1e-20, -1e-7, -1e-3, -1.0];
/// Partners per fixed direction and mode.
const PARTNERS: u32 = 200;

impl<B: Scatterer> Bench<'_, B> {
    /// Values, densities and weights for directions at and near the horizon and in the mirror direction.
    pub(super) fn judge_grazing(&self, findings: &mut Vec<Finding>) {
        let mut rng = Pcg32::new(self.effort.seed, 23);
        for mode in [Mode::Radiance, Mode::Importance] {
            for z in COSINES {
                let r = (1.0 - z * z).sqrt();
                let (y, x) = (7.0 * z + 0.9).sin_cos();
                let wo = LocalDir::new_unchecked(Vec3::new(r * x, r * y, z));
                let mut unsound = 0;
                let mut partner = None;
                for i in 0..PARTNERS {
                    let mut w = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
                    w = match i % 8 {
                        0 => Vec3::new(-wo.x, -wo.y, wo.z),
                        1 => -*wo,
                        2 => *wo,
                        3 | 4 => Vec3::new(w.x, w.y, w.z * 1e-6),
                        _ => w,
                    };
                    let Some(wi) = LocalDir::new(w) else { continue };
                    if !self.is_sound(wo, wi, mode, &mut rng) {
                        unsound += 1;
                        partner = partner.or(Some(wi));
                    }
                }
                let evidence = Evidence::Bound { observed: f64::from(unsound), limit: 0.0 };
                findings.push(Finding { wi: partner, ..Finding::new(Law::Finite, wo, mode, evidence) });
            }
        }
    }

    fn is_sound(&self, wo: LocalDir, wi: LocalDir, mode: Mode, rng: &mut Pcg32) -> bool {
        let sound = |x: f32| x.is_finite() && x >= 0.0;
        let f = self.bsdf.eval(wo, wi, mode);
        let values = (0..LANES).all(|lane| sound(f[lane])) && sound(self.bsdf.pdf(wo, wi, mode).0);
        values
            && draw(&self.bsdf, wo, mode, rng).is_none_or(|s| {
                let density = match s.density {
                    Density::SolidAngle(p) => sound(p.0) && p.0 > 0.0,
                    Density::Delta => true,
                };
                density && (0..LANES).all(|lane| sound(s.weight[lane])) && (s.wi.length() - 1.0).abs() < 1e-3
            })
    }
}
