//! The interface of the dielectric base: its index after the specification's adjustments, films, and panes.

use crate::bsdf::quadrature::GAUSS_LEGENDRE;
use crate::optics::fresnel;
use crate::spectrum::Sampled;
use crate::units::Unitless;

/// The reflectance of an interface. Cosines below 10⁻⁸ count as that: there the formula divides zero by zero where there
/// is no contrast.
pub(super) fn reflectance(cos: f32, eta: f32) -> f32 {
    fresnel::dielectric(cos.max(1e-8), eta)
}

/// The relative index whose reflectance at normal incidence is `weight` times that of `eta` (specification, "Dielectric
/// base").
pub(super) fn modulated(eta: f32, weight: f32) -> f32 {
    if weight == 1.0 {
        return eta;
    }
    let r = ((1.0 - eta) / (1.0 + eta)).abs();
    // A reflectance of one has no index.
    let epsilon = (r * weight.max(0.0).sqrt()).min(0.999).copysign(eta - 1.0);
    (1.0 + epsilon) / (1.0 - epsilon)
}

/// The most that a film of index `film_eta` on an interface reflects at any thickness and wavelength, both indices over that
/// of the medium above: all waves in phase, per polarisation.
pub(super) fn film_bound(cos: f32, film_eta: f32, eta: f32) -> f32 {
    let inside = 1.0 - (1.0 - cos * cos) / (film_eta * film_eta);
    if inside <= 0.0 {
        return 1.0;
    }
    let upper = fresnel::dielectric_polarized(cos, film_eta);
    let lower = fresnel::dielectric_polarized(inside.sqrt(), eta / film_eta);
    let bound = |a: f32, b: f32| {
        let (a, b) = (a.sqrt(), b.sqrt());
        let r = (a + b) / (1.0 + a * b);
        r * r
    };
    0.5 * (bound(upper.s, lower.s) + bound(upper.p, lower.p))
}

/// The share of a Lambertian emission under an interface of relative index `eta` that it returns, 1 − (1 − F̄)/η², where F̄
/// is the mean reflectance from above.
pub(super) fn returned_share(eta: f32) -> f32 {
    let (eta, inverse) = if eta < 1.0 { (1.0 / eta, true) } else { (eta, false) };
    let outside: f64 = GAUSS_LEGENDRE
        .iter()
        .map(|&[c, w]| 2.0 * c * w * f64::from(fresnel::dielectric(c as f32, eta)))
        .sum();
    // Under a less dense layer the medium below is the denser one.
    let share = if inverse { outside as f32 } else { 1.0 - (1.0 - outside as f32) / (eta * eta) };
    share.clamp(0.0, 1.0)
}

/// What becomes of light at a sheet of two parallel interfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pane {
    /// Reflected inside at least once.
    pub(super) reflected_inside: Sampled<Unitless>,
    /// Transmitted.
    pub(super) transmitted: Sampled<Unitless>,
}

/// All orders of reflection in a sheet whose interfaces reflect `r` and whose inside transmits `a` once: A R (1 − R)² A/(1 − R² A²)
/// back and (1 − R)² A/(1 − R² A²) through.
pub(super) fn pane(r: Sampled<Unitless>, a: Sampled<Unitless>) -> Pane {
    let transmitted = Sampled::from_fn(|i| {
        let t = 1.0 - r[i];
        // Where everything is reflected nothing gets inside.
        if t > 0.0 { t * t * a[i] / (1.0 - r[i] * r[i] * a[i] * a[i]) } else { 0.0 }
    });
    Pane { reflected_inside: transmitted * (r * a), transmitted }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::films::{self, Film};

    #[test]
    fn weight_scales_the_reflectance_face_on() {
        for eta in [0.7_f32, 1.2, 1.5, 2.4] {
            for weight in [0.0_f32, 0.3, 1.0, 2.0] {
                let (whole, part) =
                    (fresnel::dielectric(1.0, eta), fresnel::dielectric(1.0, modulated(eta, weight)));
                assert!((part - weight * whole).abs() < 1e-6, "{eta} {weight}");
                assert!((eta - 1.0) * (modulated(eta, weight) - 1.0) >= 0.0);
            }
        }
        assert!(fresnel::dielectric(1.0, modulated(2.0, 1e9)) <= 1.0);
    }

    #[test]
    fn no_film_reflects_more_than_its_bound() {
        let mut nearest = 1.0_f32;
        for film_eta in [0.8_f32, 1.33, 1.8, 2.5] {
            for eta in [0.7_f32, 1.0, 1.5, 2.2] {
                for i in 0..=20 {
                    let cos = i as f32 / 20.0;
                    let bound = film_bound(cos, film_eta, eta);
                    for thickness_nm in (0..1000).step_by(20) {
                        let film = Film { eta: film_eta, thickness_nm: thickness_nm as f32 };
                        let r = films::reflectance_dielectric(cos, film, eta, 550.0);
                        assert!(r <= bound + 1e-4, "{film_eta} {eta} {cos} {thickness_nm}: {r} {bound}");
                        if bound < 0.99 {
                            nearest = nearest.min((bound - r).abs());
                        }
                    }
                }
            }
        }
        assert!(nearest < 1e-3, "{nearest}");
    }

    #[test]
    fn returned_share_has_its_known_values() {
        // r_int of the hemispherical reflectances.
        for (eta, share) in [(1.333, 0.474_590_57), (1.5, 0.596_345_76), (1.6, 0.650_877_17)] {
            assert!((returned_share(eta) - share).abs() < 2e-5, "{eta}");
        }
        // From the dense side of an interface to the rare one, and the other way round.
        assert!((returned_share(1.0 / 1.5) - 0.091_777_96).abs() < 2e-5);
    }

    #[test]
    fn clear_pane_loses_nothing() {
        let r = Sampled::from_array([0.0, 0.04, 0.5, 1.0]);
        let pane = pane(r, Sampled::ONE);
        let all = r + pane.reflected_inside + pane.transmitted;
        assert!((all - Sampled::ONE).to_array().iter().all(|x| x.abs() < 1e-6), "{all:?}");
    }
}
