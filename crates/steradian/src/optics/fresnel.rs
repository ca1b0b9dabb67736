//! Reflectance of a smooth interface, in `f32` for rendering and in `f64` for instruments.
//!
//! `eta` is the relative index ηt/ηi, with the i side above the interface (positive cosine); `k` is μt/ηi. The side that
//! light comes from is transparent.

use super::complex::Complex;
use super::real::Real;
use crate::math::Vec3;

/// Reflectances of power for the two linear polarisations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polarized<T = f32> {
    /// Electric field perpendicular to the plane of incidence (s, ⊥).
    pub s: T,
    /// Electric field in the plane of incidence (p, ∥).
    pub p: T,
}

impl<T: Real> Polarized<T> {
    /// Reflectance of unpolarised light: the mean of both.
    #[inline]
    pub fn unpolarized(self) -> T {
        T::HALF * (self.s + self.p)
    }
}

/// Reflectances of a dielectric interface, from B (2.5) and the real case of B (2.8)–(2.11), to 1e-6 in `f32` and 1e-12
/// in `f64`.
///
/// A negative cosine means incidence from below, where the relative index is 1/eta. Total internal
/// reflection gives one for both polarisations, and so does grazing incidence.
#[inline]
pub fn dielectric_polarized<T: Real>(cos_theta_i: T, eta: T) -> Polarized<T> {
    let ci = cos_theta_i.abs().min(T::ONE);
    let (eta, refracted_square) = if cos_theta_i < T::ZERO {
        (T::ONE / eta, T::refracted_square_from_below(eta, ci))
    } else {
        (eta, T::refracted_square(eta, T::ZERO, ci))
    };
    if !(refracted_square > T::ZERO) {
        return Polarized { s: T::ONE, p: T::ONE };
    }
    let a = refracted_square.sqrt();
    let b = eta * eta * ci;
    let rs = (ci - a) / (ci + a);
    let rp = (b - a) / (b + a);
    Polarized { s: rs * rs, p: rp * rp }
}

/// Reflectance of a dielectric interface for unpolarised light, B (2.12); domain as
/// [`dielectric_polarized`]. The transmittance of power is 1 − R.
#[inline]
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
        let ci = cos_theta_i.abs().min(1.0);
        let (eta, eta2_cos2_theta_t) = if cos_theta_i < 0.0 {
            (1.0 / eta, f32::refracted_square_from_below(eta, ci))
        } else {
            (eta, f32::refracted_square(eta, 0.0, ci))
        };
        let eta2 = eta * eta;
        if eta2_cos2_theta_t <= 0.0 {
            return Self { reflectance: 1.0, eta, eta_cos_theta_t: 0.0 };
        }
        // Divided before they are squared: at grazing incidence between like media the squares vanish.
        let a = eta2_cos2_theta_t.sqrt();
        let b = eta2 * ci;
        let (s, p) = ((ci - a) / (ci + a), (b - a) / (b + a));
        Self { reflectance: 0.5 * (s * s + p * p), eta, eta_cos_theta_t: a }
    }

    /// |cosθt|, the cosine of refraction; zero for total reflection.
    #[inline]
    pub fn cos_theta_t(&self) -> f32 {
        self.eta_cos_theta_t / self.eta
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

/// b₁ + j b₂ of B (2.11), both at least 0, for the relative complex index eta + j k: the index times the cosine of
/// refraction, that is the component of the refracted wave vector along the normal. The sign of the incident cosine does
/// not matter.
#[inline]
pub fn normal_index<T: Real>(cos_theta_i: T, eta: T, k: T) -> Complex<T> {
    let c = cos_theta_i.abs().min(T::ONE);
    let p = T::refracted_square(eta, k, c);
    let product = eta * k;
    let q = (p * p + (product + product) * (product + product)).sqrt();
    // b₁² b₂² = (η k)²: whichever of q ± p does not cancel gives the other one.
    let large = (T::HALF * (q + p.abs())).sqrt();
    let small = product.abs() / (large + T::TINY);
    if p < T::ZERO { Complex::new(small, large) } else { Complex::new(large, small) }
}

/// Reflectances of an absorbing medium with relative complex index eta + j k, B (2.8)–(2.11), seen from a
/// transparent side, to 1e-6 in `f32` and 1e-12 in `f64`; the sign of the cosine does not matter. A k of zero is
/// allowed, total reflection included.
///
/// The source's tanθ sinθ is multiplied out by cosθ, so that grazing incidence is regular, and b₁² + b₂² − 2 b₁ c + c²
/// is formed as (b₁ − c)² + b₂², which does not cancel.
#[inline]
pub fn conductor_polarized<T: Real>(cos_theta_i: T, eta: T, k: T) -> Polarized<T> {
    let c = cos_theta_i.abs().min(T::ONE);
    let sin2 = (T::ONE - c) * (T::ONE + c);
    let Complex { re: b1, im: b2 } = normal_index(c, eta, k);
    let square = |x: T| x * x;
    // An index of zero at normal incidence and an index of one at grazing incidence would be zero over zero; a branch
    // would keep the lanes from being vectorised.
    let share = |reflected: T, all: T| (reflected + T::TINY) / (all + T::TINY);
    let s = share(square(b1 - c) + square(b2), square(b1 + c) + square(b2));
    let b2c = square(b2 * c);
    let p = s * share(square(b1 * c - sin2) + b2c, square(b1 * c + sin2) + b2c);
    Polarized { s, p }
}

/// Reflectance of an absorbing medium for unpolarised light; domain as [`conductor_polarized`].
#[inline]
pub fn conductor(cos_theta_i: f32, eta: f32, k: f32) -> f32 {
    conductor_polarized(cos_theta_i, eta, k).unpolarized()
}

/// Amplitudes of the reflected over the incident electric field, for the relative complex index of the far side, by
/// Fresnel (1823); |r|² are [`conductor_polarized`]'s reflectances.
///
/// Signs as in Born & Wolf (7th ed., 1.5.2): at normal incidence r_p = −r_s. Time runs as e^(−j ω t): a field that is
/// ahead has the smaller argument.
pub fn amplitudes(cos_theta_i: f64, index: Complex) -> Polarized<Complex> {
    let c = cos_theta_i.abs().min(1.0);
    let normal = normal_index(c, index.re, index.im);
    let square = index.square();
    let incident = Complex::ONE * c;
    Polarized {
        s: (incident - normal) / (incident + normal),
        p: (square * c - normal) / (square * c + normal),
    }
}

/// The angle [rad] in [0, π) by which total reflection advances the field in the plane of incidence over the one
/// perpendicular to it, for the relative index `eta` below 1: 2 atan(cosθ √(sin²θ − η²) / sin²θ), Born & Wolf
/// (1.5, 60). `None` where the reflection is not total.
pub fn total_reflection_advance(cos_theta_i: f64, eta: f64) -> Option<f64> {
    let c = cos_theta_i.abs().min(1.0);
    let square = -f64::refracted_square(eta, 0.0, c);
    (square >= 0.0 && eta < 1.0).then(|| 2.0 * (c * square.sqrt() / ((1.0 - c) * (1.0 + c))).atan())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::float::safe_sqrt;

    /// |r|² from complex amplitudes in f64: an independent form of the same law.
    fn reference(cos_theta: f64, eta: f64, k: f64) -> Polarized<f64> {
        let n = Complex::new(eta, k);
        let ci = Complex::ONE * cos_theta;
        // cosθt by the principal root in polar form.
        let cos2 = Complex::ONE - Complex::ONE * (1.0 - cos_theta * cos_theta) / n.square();
        let cos_t = Complex::new(0.5 * cos2.argument(), 0.0).exp_j() * cos2.norm_squared().sqrt().sqrt();
        let s = (ci - n * cos_t) / (ci + n * cos_t);
        let p = (n * ci - cos_t) / (n * ci + cos_t);
        Polarized { s: s.norm_squared(), p: p.norm_squared() }
    }

    /// Cosines of 0° to 89.9°, denser where reflectance varies fast.
    fn cosines() -> impl Iterator<Item = f64> {
        let degrees = (0..90).map(f64::from).chain((1..=19).map(|i| 88.0 + 0.1 * f64::from(i)));
        degrees.map(|d| d.to_radians().cos())
    }

    const INDICES: [f32; 8] = [0.05, 0.43, 0.7, 1.0001, 1.33, 1.5, 2.4, 6.0];
    const EXTINCTIONS: [f32; 6] = [0.0, 1e-3, 0.1, 0.5, 2.455, 8.0];

    #[test]
    fn every_cosine_and_contrast_reflects_a_share() {
        for eta in [0.01_f32, 1.0 / 1.5, 1.0 - 1e-7, 1.0, 1.0 + 2e-7, 1.5, 100.0] {
            for exponent in 0..=45 {
                for sign in [1.0_f32, -1.0] {
                    let c = sign * 10.0_f32.powi(-exponent);
                    let both = dielectric_polarized(c, eta);
                    for r in [dielectric(c, eta), both.s, both.p, conductor(c.abs(), eta, 1e-3)] {
                        assert!((0.0..=1.0 + 1e-6).contains(&r), "{c} {eta}: {r}");
                    }
                }
            }
        }
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
    fn real_and_complex_forms_equal_the_amplitude_form_to_1e_6_in_f32() {
        for (eta, k) in INDICES.iter().flat_map(|eta| EXTINCTIONS.map(|k| (*eta, k))) {
            for c in cosines().map(|c| c as f32) {
                let expected = reference(f64::from(c), f64::from(eta), f64::from(k));
                let near = |r: Polarized| {
                    let difference =
                        (f64::from(r.s) - expected.s).abs().max((f64::from(r.p) - expected.p).abs());
                    assert!(difference < 1e-6, "{eta} {k} {c}: {r:?} {expected:?}");
                };
                near(conductor_polarized(c, eta, k));
                if k == 0.0 {
                    near(dielectric_polarized(c, eta));
                    assert!((f64::from(dielectric(c, eta)) - expected.unpolarized()).abs() < 1e-6);
                    // The same ray from the other side, where the index is 1/η: from its f32 cosine, as it is.
                    let below = reference(f64::from(c), 1.0 / f64::from(eta), 0.0);
                    let r = f64::from(dielectric(-c, eta));
                    assert!((r - below.unpolarized()).abs() < 1e-6, "{eta} {c}: {r} {below:?}");
                }
            }
        }
    }

    #[test]
    fn real_and_complex_forms_equal_the_amplitude_form_to_1e_12_in_f64() {
        for (eta, k) in INDICES.iter().flat_map(|eta| EXTINCTIONS.map(|k| (f64::from(*eta), f64::from(k)))) {
            for c in cosines() {
                let expected = reference(c, eta, k);
                let near = |r: Polarized<f64>| {
                    let difference = (r.s - expected.s).abs().max((r.p - expected.p).abs());
                    assert!(difference < 1e-12, "{eta} {k} {c}: {r:?} {expected:?}");
                };
                near(conductor_polarized(c, eta, k));
                if k == 0.0 {
                    near(dielectric_polarized(c, eta));
                    near(dielectric_polarized(-c, 1.0 / eta));
                }
            }
        }
    }

    #[test]
    fn everything_reflects_all_light_at_grazing_incidence() {
        for (eta, k) in INDICES.iter().flat_map(|eta| EXTINCTIONS.map(|k| (*eta, k))) {
            assert_eq!(conductor_polarized(0.0, eta, k), Polarized { s: 1.0, p: 1.0 });
            assert_eq!(dielectric_polarized(0.0, eta), Polarized { s: 1.0, p: 1.0 });
            assert_eq!([dielectric(0.0, eta), dielectric(-0.0, eta)], [1.0, 1.0]);
            // 1 − R falls to zero in proportion to the cosine: halved with it.
            let lost = |c: f64| 1.0 - conductor_polarized(c, f64::from(eta), f64::from(k)).unpolarized();
            if k > 0.0 {
                assert!((lost(1e-6) / lost(5e-7) - 2.0).abs() < 1e-2, "{eta} {k}");
            }
        }
        assert_eq!(conductor(0.0, 1.0, 0.0), 1.0);
        assert_eq!(conductor(1.0, 0.0, 0.0), 1.0);
    }

    #[test]
    fn total_reflection_advances_one_field_by_its_closed_form() {
        for eta in [0.4, 1.0 / 1.51, 0.9] {
            for c in cosines() {
                let r = amplitudes(c, Complex::new(eta, 0.0));
                match total_reflection_advance(c, eta) {
                    Some(advance) => {
                        assert!(
                            (r.s.norm_squared() - 1.0).abs() < 1e-14
                                && (r.p.norm_squared() - 1.0).abs() < 1e-14
                        );
                        assert!(((r.s / r.p).argument() - advance).abs() < 1e-12, "{eta} {c}");
                    }
                    None => assert!(r.s.im == 0.0 && r.s.norm_squared() < 1.0),
                }
            }
        }
        assert_eq!(total_reflection_advance(0.1, 1.5), None);
    }

    #[test]
    fn two_reflections_in_a_fresnel_rhomb_turn_light_at_45_degrees_into_circular_light() {
        let cos = 54.62_f64.to_radians().cos();
        let advance = total_reflection_advance(cos, 1.0 / 1.51).unwrap().to_degrees();
        assert!((advance - 45.0).abs() < 5e-3, "{advance}");
        let r = amplitudes(cos, Complex::new(1.0 / 1.51, 0.0));
        // Stokes parameters of equal fields s and p after both reflections: only the circular one is left.
        let (s, p) = (r.s.square(), r.p.square());
        let (linear, circular) = ((s.conjugate() * p).re, (s.conjugate() * p).im);
        assert!(linear.abs() < 2e-4 && (circular.abs() - 1.0).abs() < 1e-7, "{linear} {circular}");
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
}
