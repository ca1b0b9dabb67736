//! Reflectance of a smooth interface.
//!
//! `eta` is the relative index ηt/ηi, with the i side above the interface (positive cosine).

use crate::math::Vec3;
use crate::math::float::safe_sqrt;

/// Reflectances of power for the two linear polarisations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polarized {
    /// Electric field perpendicular to the plane of incidence (s, ⊥).
    pub s: f32,
    /// Electric field in the plane of incidence (p, ∥).
    pub p: f32,
}

impl Polarized {
    /// Reflectance of unpolarised light: the mean of both.
    pub fn unpolarized(self) -> f32 {
        0.5 * (self.s + self.p)
    }
}

/// Reflectances of a dielectric interface, from B (2.5) and the real case of B (2.8)–(2.11).
///
/// A negative cosine means incidence from below, where the relative index is 1/eta. Total internal
/// reflection gives one for both polarisations.
pub fn dielectric_polarized(cos_theta_i: f32, eta: f32) -> Polarized {
    let (ci, eta) = if cos_theta_i < 0.0 { (-cos_theta_i, 1.0 / eta) } else { (cos_theta_i, eta) };
    let ci = ci.min(1.0);
    let cos2_theta_t = 1.0 - (1.0 - ci * ci) / (eta * eta);
    if cos2_theta_t <= 0.0 {
        return Polarized { s: 1.0, p: 1.0 };
    }
    let ct = cos2_theta_t.sqrt();
    let rs = (ci - eta * ct) / (ci + eta * ct);
    let rp = (eta * ci - ct) / (eta * ci + ct);
    Polarized { s: rs * rs, p: rp * rp }
}

/// Reflectance of a dielectric interface for unpolarised light, B (2.12); domain as
/// [`dielectric_polarized`]. The transmittance of power is 1 − R.
pub fn dielectric(cos_theta_i: f32, eta: f32) -> f32 {
    Crossing::new(cos_theta_i, eta).reflectance
}

/// What happens to unpolarised light of one direction at a dielectric interface: Fresnel's and Snell's law,
/// which share their costly terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Share of the power that is reflected; one for total reflection.
    pub reflectance: f32,
    /// Index on the far side over the index on the side that the direction lies on.
    pub eta: f32,
    /// η |cosθt|; zero for total reflection.
    eta_cos_theta_t: f32,
}

impl Crossing {
    /// The crossing at the cosine to the normal; domain as [`dielectric_polarized`].
    #[inline]
    pub fn new(cos_theta_i: f32, eta: f32) -> Self {
        let eta = if cos_theta_i < 0.0 { 1.0 / eta } else { eta };
        let ci = cos_theta_i.abs().min(1.0);
        let eta2 = eta * eta;
        let eta2_cos2_theta_t = eta2 - (1.0 - ci * ci);
        if eta2_cos2_theta_t <= 0.0 {
            return Self { reflectance: 1.0, eta, eta_cos_theta_t: 0.0 };
        }
        // r_s = (ci − a)/(ci + a), r_p = (b − a)/(b + a), over their common denominator.
        let a = eta2_cos2_theta_t.sqrt();
        let b = eta2 * ci;
        let s = (ci - a) * (b + a);
        let p = (b - a) * (ci + a);
        let d = (ci + a) * (b + a);
        Self { reflectance: 0.5 * (s * s + p * p) / (d * d), eta, eta_cos_theta_t: a }
    }

    /// The refracted unit direction of `w`, whose cosine to the unit normal `n` the crossing was made for,
    /// B (2.5)–(2.7); `None` for total reflection. Both point away from the interface.
    #[inline]
    pub fn refract(&self, w: Vec3, n: Vec3) -> Option<Vec3> {
        if self.eta_cos_theta_t == 0.0 {
            return None;
        }
        let cos = w.dot(n);
        Some((n * (cos - self.eta_cos_theta_t.copysign(cos)) - w) * self.eta.recip())
    }
}

/// Reflectances of an absorbing medium with relative complex index eta + j k, B (2.8)–(2.11), seen from a
/// transparent side; the sign of the cosine does not matter.
///
/// tanθ sinθ of the source is multiplied out by cosθ, so that grazing incidence is regular.
pub fn conductor_polarized(cos_theta_i: f32, eta: f32, k: f32) -> Polarized {
    let c = cos_theta_i.abs().min(1.0);
    let c2 = c * c;
    let s2 = 1.0 - c2;
    let p = eta * eta - k * k - s2;
    let product = eta * k;
    let q = (p * p + 4.0 * product * product).sqrt();
    // b1² b2² = (η k)²: whichever of q ± p does not cancel gives the other one.
    let large = 0.5 * (q + p.abs());
    let small = if large > 0.0 { product * product / large } else { 0.0 };
    let b1_squared = if p >= 0.0 { large } else { small };
    let b1 = safe_sqrt(b1_squared);
    let b = large + small;
    let s = (b - 2.0 * b1 * c + c2) / (b + 2.0 * b1 * c + c2);
    let s4 = s2 * s2;
    let p = s * (b * c2 - 2.0 * b1 * c * s2 + s4) / (b * c2 + 2.0 * b1 * c * s2 + s4);
    Polarized { s, p }
}

/// Reflectance of an absorbing medium for unpolarised light; domain as [`conductor_polarized`].
pub fn conductor(cos_theta_i: f32, eta: f32, k: f32) -> f32 {
    conductor_polarized(cos_theta_i, eta, k).unpolarized()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |r|² from complex amplitudes in f64: an independent form of the same law.
    fn amplitudes(cos_theta: f64, eta: f64, k: f64) -> (f64, f64) {
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let div = |a: C, b: C| {
            let d = b.0 * b.0 + b.1 * b.1;
            ((a.0 * b.0 + a.1 * b.1) / d, (a.1 * b.0 - a.0 * b.1) / d)
        };
        let sub = |a: C, b: C| (a.0 - b.0, a.1 - b.1);
        let add = |a: C, b: C| (a.0 + b.0, a.1 + b.1);
        let norm = |a: C| a.0 * a.0 + a.1 * a.1;
        let n = (eta, k);
        let sin2 = 1.0 - cos_theta * cos_theta;
        let (x, y) = sub((1.0, 0.0), div((sin2, 0.0), mul(n, n)));
        let r = (x * x + y * y).sqrt();
        let cos_t = (((r + x) / 2.0).sqrt(), ((r - x) / 2.0).max(0.0).sqrt().copysign(y));
        let ci = (cos_theta, 0.0);
        let rs = div(sub(ci, mul(n, cos_t)), add(ci, mul(n, cos_t)));
        let rp = div(sub(mul(n, ci), cos_t), add(mul(n, ci), cos_t));
        (norm(rs), norm(rp))
    }

    #[test]
    fn glass_at_normal_incidence_brewster_and_critical_angle() {
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-7);
        let brewster = dielectric_polarized(56.30993_f32.to_radians().cos(), 1.5);
        assert!((brewster.s - 0.147_928_99).abs() < 1e-6 && brewster.p < 1e-9, "{brewster:?}");
        let critical = 41.810_31_f32;
        assert_eq!(dielectric(-(critical + 0.001).to_radians().cos(), 1.5), 1.0);
        assert!(dielectric(-(critical - 0.01).to_radians().cos(), 1.5) < 1.0);
    }

    #[test]
    fn gold_like_index_reproduces_the_checked_values() {
        assert!((conductor(1.0, 0.43, 2.455) - 0.786_915_76).abs() < 1e-6);
        let at_60 = conductor_polarized(60.0_f32.to_radians().cos(), 0.43, 2.455);
        assert!((at_60.s - 0.892_820).abs() < 2e-6 && (at_60.p - 0.683_443).abs() < 2e-6, "{at_60:?}");
    }

    #[test]
    fn real_and_complex_forms_equal_the_amplitude_form() {
        for eta in [0.05_f32, 0.43, 1.0001, 1.33, 2.4] {
            for k in [0.0_f32, 1e-3, 0.5, 2.455, 8.0] {
                for i in 1..=100 {
                    let c = i as f32 / 100.0;
                    // Total reflection has no refracted amplitude of that form.
                    if k == 0.0 && f64::from(eta).powi(2) <= 1.0 - f64::from(c).powi(2) {
                        continue;
                    }
                    let (s, p) = amplitudes(f64::from(c), f64::from(eta), f64::from(k));
                    let r = conductor_polarized(c, eta, k);
                    assert!(
                        (f64::from(r.s) - s).abs() < 1e-5 && (f64::from(r.p) - p).abs() < 1e-5,
                        "{eta} {k} {c}: {r:?} {s} {p}"
                    );
                    if k == 0.0 {
                        let d = dielectric_polarized(c, eta);
                        assert!(
                            (f64::from(d.s) - s).abs() < 1e-5 && (f64::from(d.p) - p).abs() < 1e-5,
                            "{eta} {c}: {d:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn unpolarised_form_of_the_source_agrees() {
        // B (2.12), with ηi = 1.
        for eta in [0.7_f64, 1.33, 1.5, 2.4] {
            for i in 1..=50 {
                let ci2 = (f64::from(i) / 50.0).powi(2);
                let ct2 = 1.0 - (1.0 - ci2) / (eta * eta);
                if ct2 <= 1e-6 {
                    continue;
                }
                let cc = (ci2 * ct2).sqrt();
                let numerator = (1.0 - eta * eta).powi(2) * ci2 * ct2 + (ci2 - ct2).powi(2) * eta * eta;
                let denominator = (eta * (ci2 + ct2) + cc * (1.0 + eta * eta)).powi(2);
                let r = dielectric(ci2.sqrt() as f32, eta as f32);
                assert!((f64::from(r) - numerator / denominator).abs() < 2e-6, "{eta} {ci2}");
            }
        }
    }

    #[test]
    fn both_ends_of_a_refracted_ray_reflect_alike() {
        for i in 1..=90 {
            let ci = (i as f32).to_radians().sin();
            let ct = safe_sqrt(1.0 - (1.0 - ci * ci) / 2.25);
            // Near the critical angle the rounding of ct is amplified by η² ct / ci and a slope of about −5.
            let tolerance = 1e-6 / ci;
            assert!((dielectric(ci, 1.5) - dielectric(-ct, 1.5)).abs() < tolerance, "{i}");
        }
    }

    #[test]
    fn slab_transmittance_reproduces_the_checked_values() {
        // T = (1 − r)² / (1 − r²) per polarisation, averaged last; no absorption.
        for (degrees, expected) in
            [(0.0_f32, 0.923_076_9), (45.0, 0.907_344), (60.0, 0.848_128), (75.0, 0.618_149)]
        {
            let r = dielectric_polarized(degrees.to_radians().cos(), 1.5);
            let t = |r: f32| (1.0 - r) * (1.0 - r) / (1.0 - r * r);
            assert!((0.5 * (t(r.s) + t(r.p)) - expected).abs() < 2e-6, "{degrees}");
        }
    }

    #[test]
    fn hemispherical_reflectance_has_its_closed_form() {
        // r_ext(1.5) and r_int(1.5) = 1 − (1 − r_ext)/n²: ∫ 2 cosθ R dcosθ from either side.
        let n = 200_000;
        let (mut outside, mut inside) = (0.0_f64, 0.0_f64);
        for i in 0..n {
            let c = (i as f32 + 0.5) / n as f32;
            outside += f64::from(2.0 * c * dielectric(c, 1.5)) / f64::from(n);
            inside += f64::from(2.0 * c * dielectric(-c, 1.5)) / f64::from(n);
        }
        assert!(
            (outside - 0.091_777_96).abs() < 1e-6 && (inside - 0.596_345_76).abs() < 1e-6,
            "{outside} {inside}"
        );
    }
}
