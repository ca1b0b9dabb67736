//! Light on a hair: a dielectric cylinder with tilted scales and an absorbing inside.
//!
//! Chiang et al. 2016 with the longitudinal lobes of d'Eon et al. 2011, after Marschner et al. 2003; pbrt-v4 book, 9.9.
//! The local x axis runs along the hair, root to tip. Directions are (θ, φ): sinθ = x, and φ turns from y to z.
//!
//! The model describes a whole fibre. As a surface it is a function of where on the width it is met, f = S/|cosθi| with a
//! scattering function S that is no symmetric function of both directions: it returns what it does not absorb, but is not reciprocal.

use super::contract::{BsdfSample, Lobe, Lobes, Side};
use super::specimen::{Claims, Energy, Reciprocity, Specimen};
use crate::math::float::safe_sqrt;
use crate::math::{LocalDir, Vec2, Vec3};
use crate::optics::fresnel;
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::{PI, TAU};

/// Orders of internal reflection with a lobe of their own: R, TT, TRT. What is left leaves together.
const ORDERS: usize = 3;

/// Narrowest roughness: lobes stay resolved in f32.
const MIN_ROUGHNESS: f32 = 1e-2;

/// What a hair is like at one point.
#[derive(Clone, Copy, Debug)]
pub struct Fibre {
    /// Where it is met on its width, in [−1, 1].
    pub h: f32,
    /// Index of refraction of the inside.
    pub eta: f32,
    /// Absorption coefficient of the inside [1/radius].
    pub sigma_a: Sampled<Unitless>,
    /// Roughness along the hair, limited to [0.01, 1].
    pub beta_m: f32,
    /// Roughness around the hair, limited to [0.01, 1].
    pub beta_n: f32,
    /// Tilt of the scales [°].
    pub alpha: f32,
}

/// Scattering by a hair.
#[derive(Clone, Copy, Debug)]
pub struct Hair {
    h: f32,
    gamma_o: f32,
    eta: f32,
    sigma_a: Sampled<Unitless>,
    /// Variance of the R lobe along the hair; others follow.
    variance: f32,
    /// Scale of the logistic distribution around the hair.
    scale: f32,
    tilts: [Tilt; ORDERS],
}

/// A rotation of θ.
#[derive(Clone, Copy, Debug)]
struct Tilt {
    sin: f32,
    cos: f32,
}

/// A direction in the coordinates of the hair.
#[derive(Clone, Copy, Debug)]
struct Polar {
    sin_theta: f32,
    cos_theta: f32,
}

/// What the outgoing direction settles for all lobes.
struct Lobed {
    o: Polar,
    phi_o: f32,
    gamma_t: f32,
    /// Share of light that leaves with each order, the rest last.
    attenuation: [Sampled<Unitless>; ORDERS + 1],
    /// Probability of each order.
    probability: [f32; ORDERS + 1],
}

impl Hair {
    /// The scattering function of a fibre.
    pub fn new(fibre: Fibre) -> Self {
        let rough = |beta: f32| beta.clamp(MIN_ROUGHNESS, 1.0);
        let (m, n) = (rough(fibre.beta_m), rough(fibre.beta_n));
        // Fits that make both roughnesses look even in [0, 1]: Chiang et al. 2016, eq. 7 and 8.
        let variance = (0.726 * m + 0.812 * m * m + 3.7 * m.powi(20)).powi(2);
        let scale = (PI / 8.0).sqrt() * (0.265 * n + 1.194 * n * n + 5.372 * n.powi(22));
        // Each surface met tilts by 2α: by 2α for R, −α for TT, −4α for TRT (Marschner et al. 2003, table 1).
        let alpha = fibre.alpha.to_radians();
        let tilts = [-2.0, 1.0, 4.0].map(|factor: f32| {
            let (sin, cos) = (factor * alpha).sin_cos();
            Tilt { sin, cos }
        });
        let h = fibre.h.clamp(-1.0, 1.0);
        Self { h, gamma_o: h.asin(), eta: fibre.eta, sigma_a: fibre.sigma_a, variance, scale, tilts }
    }

    /// The absorption coefficient [1/radius] that gives hair with this roughness around it the multiple-scattering
    /// colour `reflectance` ∈ [0, 1]: Chiang et al. 2016, eq. 9.
    pub fn sigma_a_of_reflectance(reflectance: Sampled<Unitless>, beta_n: f32) -> Sampled<Unitless> {
        let b = beta_n.clamp(MIN_ROUGHNESS, 1.0);
        let fit = [5.969, -0.215, 2.532, -10.73, 5.574, 0.245];
        let divisor = fit.iter().rev().fold(0.0, |sum, c| sum * b + c);
        // Black would absorb without bound.
        reflectance.map(|c| (c.max(1e-10).ln() / divisor).powi(2))
    }

    /// f [sr⁻¹] = Σ Mp Ap Np / |cosθi|, Marschner et al. 2003, eq. 1, over the cosine to the surface.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Sampled::ZERO;
        }
        let lobed = self.lobed(wo);
        let shapes = self.shapes(&lobed, wi);
        let mut sum = Sampled::<Unitless>::ZERO;
        for (a, shape) in lobed.attenuation.into_iter().zip(shapes) {
            sum += a * shape;
        }
        // The floor keeps the quotient finite.
        (sum / wi.abs_cos_theta().max(1e-30)).cast()
    }

    /// Density of [`Hair::sample`].
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if wo.z == 0.0 || wi.z == 0.0 {
            return PdfSolidAngle(0.0);
        }
        let lobed = self.lobed(wo);
        let shapes = self.shapes(&lobed, wi);
        PdfSolidAngle(lobed.probability.into_iter().zip(shapes).map(|(p, shape)| p * shape).sum())
    }

    /// An order by its share of the light, θ by its longitudinal lobe (d'Eon 2013), φ by its azimuthal one.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let lobed = self.lobed(wo);
        let mut order = 0;
        let mut rest = uc;
        while order < ORDERS && rest >= lobed.probability[order] {
            rest -= lobed.probability[order];
            order += 1;
        }
        // The unused digits of the choice.
        let un = (rest / lobed.probability[order]).clamp(0.0, crate::math::float::ONE_MINUS_EPSILON);
        let o = self.tilted(&lobed.o, order);
        let v = self.variance_of(order);
        // 1 − cosine to the mirrored cone: −v ln(u + (1 − u) e^(−2/v)), at most 2.
        let u0 = 1.0 - u.x;
        let drop = (-v * (u0 + (1.0 - u0) * (-2.0 / v).exp()).ln()).clamp(0.0, 2.0);
        let (c, s) = (1.0 - drop, safe_sqrt(drop * (2.0 - drop)));
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        // On the cone around the mirrored tangent direction (−sinθo, cosθo): sideways by s, of which sinφ leaves its plane.
        let sin_theta = -c * o.sin_theta + s * cos_phi * o.cos_theta;
        let along = c * o.cos_theta + s * cos_phi * o.sin_theta;
        let cos_theta = along.hypot(s * sin_phi);
        let phi = if order < ORDERS {
            exit_azimuth(order, self.gamma_o, lobed.gamma_t) + sample_logistic(un, self.scale)
        } else {
            TAU * un
        };
        let (sin_phi, cos_phi) = (lobed.phi_o + phi).sin_cos();
        let wi = LocalDir::new(Vec3::new(sin_theta, cos_theta * cos_phi, cos_theta * sin_phi))?;
        if wi.z == 0.0 {
            return None;
        }
        let shapes = self.shapes(&lobed, wi);
        let mut power = Sampled::<Unitless>::ZERO;
        let mut pdf = 0.0;
        for (order, shape) in shapes.into_iter().enumerate() {
            power += lobed.attenuation[order] * shape;
            pdf += lobed.probability[order] * shape;
        }
        (pdf > 0.0).then(|| BsdfSample {
            wi,
            weight: power / pdf,
            density: Density::SolidAngle(PdfSolidAngle(pdf)),
            side: if wo.same_hemisphere(wi) { Side::Reflection } else { Side::Transmission },
            lobe: Lobe::Glossy,
            eta: 1.0,
        })
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: true }
    }

    /// What holds for it: the lobes are normalised, so that only absorption loses light.
    ///
    /// S at one point of the width is no symmetric function, and the width itself is seen under |cosθ|: the two ways along a pair
    /// of directions differ by any factor. Power is scattered as radiance is, so that white hair keeps it; the modes are
    /// then no more adjoint than the two ways are alike.
    pub fn claims(&self) -> Claims {
        let claims = Claims::CLOSED_FORM.with_reciprocity(Reciprocity::Reported);
        if self.sigma_a.is_zero() {
            claims.with_energy(Energy::Lossless { tolerance: 0.002 })
        } else {
            claims
        }
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let blond = Sampled::from_array([0.1, 0.2, 0.4, 0.8]);
        let dark = Sampled::from_array([1.2, 1.9, 3.5, 5.0]);
        let of = |h, sigma_a, beta_m, beta_n| {
            Self::new(Fibre { h, eta: 1.55, sigma_a, beta_m, beta_n, alpha: 2.0 })
        };
        [
            ("hair white", of(0.3, Sampled::ZERO, 0.3, 0.3)),
            ("hair white, at the rim", of(-0.99, Sampled::ZERO, 0.3, 0.3)),
            ("hair white, silky", of(-0.5, Sampled::ZERO, 0.1, 0.1)),
            ("hair white, rough", of(0.0, Sampled::ZERO, 1.0, 1.0)),
            ("hair blond", of(0.7, blond, 0.25, 0.5)),
            ("hair dark", of(-0.2, dark, 0.3, 0.3)),
            ("hair dark, rough along", of(0.9, dark, 0.9, 0.2)),
        ]
        .into_iter()
        .map(|(name, hair)| Specimen::new(name, hair.claims(), hair))
    }

    fn lobed(&self, wo: LocalDir) -> Lobed {
        let o = polar(wo);
        let sin_theta_t = o.sin_theta / self.eta;
        let cos_theta_t = safe_sqrt(1.0 - sin_theta_t * sin_theta_t);
        // Bravais: in the projection across the hair the index is √(η² − sin²θo)/cosθo.
        let sin_gamma_t = self.h * o.cos_theta
            / safe_sqrt(self.eta * self.eta - o.sin_theta * o.sin_theta).max(f32::MIN_POSITIVE);
        // Below an index of one the rim reflects totally.
        let sin_gamma_t = sin_gamma_t.clamp(-1.0, 1.0);
        let cos_gamma_t = safe_sqrt(1.0 - sin_gamma_t * sin_gamma_t);
        // One chord of the cylinder; along the hair itself it is endless.
        let chord = if cos_theta_t > 0.0 { 2.0 * cos_gamma_t / cos_theta_t } else { f32::MAX };
        let passed = self.sigma_a.map(|a| if a == 0.0 { 1.0 } else { (-a * chord).exp() });
        let attenuation = self.attenuation(&o, passed);
        let means = attenuation.map(Sampled::mean);
        let total: f32 = means.iter().sum();
        Lobed {
            o,
            phi_o: wo.z.atan2(wo.y),
            gamma_t: sin_gamma_t.asin(),
            attenuation,
            probability: means.map(|a| a / total),
        }
    }

    /// Ap: shares of the light that leave after p passages of the inside, `passed` being what one of them leaves.
    fn attenuation(&self, o: &Polar, passed: Sampled<Unitless>) -> [Sampled<Unitless>; ORDERS + 1] {
        let cos_gamma_o = safe_sqrt(1.0 - self.h * self.h);
        let r = fresnel::dielectric(o.cos_theta * cos_gamma_o, self.eta);
        let direct = Sampled::splat(r);
        let tt = passed * ((1.0 - r) * (1.0 - r));
        let trt = tt * passed * r;
        // Σ over all further orders: a geometric series.
        let rest = Sampled::from_fn(|lane| {
            let again = passed[lane] * r;
            if again < 1.0 { trt[lane] * again / (1.0 - again) } else { 0.0 }
        });
        [direct, tt, trt, rest]
    }

    /// Mp Np for each order, and for the rest.
    fn shapes(&self, lobed: &Lobed, wi: LocalDir) -> [f32; ORDERS + 1] {
        let i = polar(wi);
        let phi = wi.z.atan2(wi.y) - lobed.phi_o;
        std::array::from_fn(|order| {
            let along = longitudinal(&i, &self.tilted(&lobed.o, order), self.variance_of(order));
            let around = if order < ORDERS {
                let peak = exit_azimuth(order, self.gamma_o, lobed.gamma_t);
                logistic(wrapped(phi - peak), self.scale)
            } else {
                1.0 / TAU
            };
            along * around
        })
    }

    /// The outgoing direction as the tilted scales see it for one order.
    fn tilted(&self, o: &Polar, order: usize) -> Polar {
        let Some(tilt) = self.tilts.get(order) else { return *o };
        Polar {
            sin_theta: o.sin_theta * tilt.cos + o.cos_theta * tilt.sin,
            // Past the tip of the hair the lobe comes back on its other side.
            cos_theta: (o.cos_theta * tilt.cos - o.sin_theta * tilt.sin).abs(),
        }
    }

    /// TT is half, TRT and the rest twice as wide as R (Marschner et al. 2003, table 1).
    fn variance_of(&self, order: usize) -> f32 {
        match order {
            0 => self.variance,
            1 => 0.25 * self.variance,
            _ => 4.0 * self.variance,
        }
    }
}

fn polar(w: LocalDir) -> Polar {
    Polar { sin_theta: w.x, cos_theta: w.y.hypot(w.z) }
}

/// Φ(p, h): the azimuth by which a ray turns that passes the inside `order` times.
fn exit_azimuth(order: usize, gamma_o: f32, gamma_t: f32) -> f32 {
    let p = order as f32;
    2.0 * p * gamma_t - 2.0 * gamma_o + p * PI
}

/// Mp: a Gaussian on the sphere, averaged around the hair; ∫ Mp cosθi dθi = 1 (d'Eon et al. 2011, eq. 7).
///
/// Written with e^(−a) I0(a), and with 1 − cos(θi + θo) from differences, it neither overflows nor cancels for any variance.
fn longitudinal(i: &Polar, o: &Polar, v: f32) -> f32 {
    let a = i.cos_theta * o.cos_theta / v;
    let (dc, ds) = (i.cos_theta - o.cos_theta, i.sin_theta + o.sin_theta);
    (-(dc * dc + ds * ds) / (2.0 * v)).exp() * scaled_bessel_i0(a) / (v * (1.0 - (-2.0 / v).exp()))
}

/// e^(−x) I0(x) for x ≥ 0: Abramowitz & Stegun 1964, 9.8.1 and 9.8.2, within 2·10⁻⁷.
fn scaled_bessel_i0(x: f32) -> f32 {
    let horner = |t: f32, c: &[f32]| c.iter().rev().fold(0.0, |sum, c| sum * t + c);
    if x < 3.75 {
        let t = (x / 3.75) * (x / 3.75);
        let series =
            horner(t, &[1.0, 3.515_622_9, 3.089_942_4, 1.206_749_2, 0.265_973_2, 0.036_076_8, 0.004_581_3]);
        (-x).exp() * series
    } else {
        let t = 3.75 / x;
        #[rustfmt::skip]
        let series = horner(t, &[
            0.398_942_28, 0.013_285_92, 0.002_253_19, -0.001_575_65, 0.009_162_81, -0.020_577_06,
            0.026_355_37, -0.016_476_33, 0.003_923_77,
        ]);
        series / x.sqrt()
    }
}

/// Np: the logistic distribution with scale `s`, cut to [−π, π] and normalised there.
fn logistic(x: f32, s: f32) -> f32 {
    let e = (-x.abs() / s).exp();
    e / (s * (1.0 + e) * (1.0 + e) * (0.5 * PI / s).tanh())
}

/// A draw from [`logistic`], by its inverse distribution.
fn sample_logistic(u: f32, s: f32) -> f32 {
    // Both ends of the distribution: its values at −π and π.
    let low = 1.0 / (1.0 + (PI / s).exp());
    let share = low + u * (0.5 * PI / s).tanh();
    (-s * (1.0 / share - 1.0).ln()).clamp(-PI, PI)
}

/// The same azimuth in [−π, π].
fn wrapped(phi: f32) -> f32 {
    phi - TAU * (phi / TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::quadrature::GAUSS_LEGENDRE;
    use crate::math::warp;

    fn dir(theta: f32, phi: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(theta, phi))
    }

    fn fibre(h: f32, sigma_a: f32, beta: f32) -> Fibre {
        Fibre { h, eta: 1.55, sigma_a: Sampled::splat(sigma_a), beta_m: beta, beta_n: beta, alpha: 2.0 }
    }

    #[test]
    fn longitudinal_lobes_are_normalised_at_every_width() {
        for v in [1e-4_f32, 1e-3, 0.01, 0.09, 0.11, 1.0, 20.0] {
            for theta in [0.0_f32, 0.5, -1.2, 1.5] {
                let (sin_theta, cos_theta) = theta.sin_cos();
                let o = Polar { sin_theta, cos_theta };
                // θi around −θo, in steps much finer than √v.
                let (n, reach) = (4000, (12.0 * v.sqrt()).min(PI));
                let mut sum = 0.0_f64;
                for k in 0..n {
                    let t = -theta + reach * ((k as f32 + 0.5) / n as f32 * 2.0 - 1.0);
                    if t.abs() < 0.5 * PI {
                        let i = Polar { sin_theta: t.sin(), cos_theta: t.cos() };
                        sum += f64::from(longitudinal(&i, &o, v) * t.cos() * 2.0 * reach / n as f32);
                    }
                }
                assert!((sum - 1.0).abs() < 1e-3, "{v} {theta}: {sum}");
            }
        }
    }

    #[test]
    fn scaled_bessel_function_is_its_integral() {
        // Mean of e^(x (cos t − 1)) over t ∈ [0, π], by quadrature in f64.
        for (x, expected) in
            [(0.0, 1.0), (1.0, 0.465_759_6), (3.7, 0.216_049_4), (5.0, 0.183_540_8), (10.0, 0.127_833_3)]
        {
            let y = scaled_bessel_i0(x);
            assert!((y - expected).abs() < 1e-6, "{x}: {y} {expected}");
        }
    }

    #[test]
    fn azimuthal_lobe_is_normalised_and_its_draws_are_its_quantiles() {
        for s in [0.002_f32, 0.03, 0.5, 4.3] {
            let n = 20_000;
            let reach = (30.0 * s).min(PI);
            let mass: f64 = (0..n)
                .map(|k| {
                    let x = reach * ((k as f32 + 0.5) / n as f32 * 2.0 - 1.0);
                    f64::from(logistic(x, s) * 2.0 * reach / n as f32)
                })
                .sum();
            assert!((mass - 1.0).abs() < 1e-4, "{s}: {mass}");
            for u in [0.1_f32, 0.5, 0.83] {
                let end = sample_logistic(u, s);
                let below: f64 = (0..n)
                    .map(|k| {
                        let x = -reach + (end + reach) * (k as f32 + 0.5) / n as f32;
                        f64::from(logistic(x, s) * (end + reach) / n as f32)
                    })
                    .sum();
                assert!((below - f64::from(u)).abs() < 2e-4, "{s} {u}: {below}");
            }
        }
    }

    #[test]
    fn white_hair_returns_all_light_wherever_it_is_met() {
        for beta in [0.2, 0.6, 1.0] {
            for h in [-0.95, 0.0, 0.6] {
                let hair = Hair::new(fibre(h, 0.0, beta));
                for wo in [dir(0.2, 0.3), dir(1.2, 2.5), dir(2.9, 4.0)] {
                    // θi and φ: cosθ dθ dφ about the hair's axis.
                    let (nt, np) = (60, 400);
                    let mut sum = 0.0_f64;
                    for a in 0..nt {
                        for &[x, weight] in &GAUSS_LEGENDRE {
                            let theta = PI * ((a as f32 + x as f32) / nt as f32 - 0.5);
                            for b in 0..np {
                                let phi = TAU * (b as f32 + 0.5) / np as f32;
                                let (s, c) = theta.sin_cos();
                                let wi = LocalDir::new_unchecked(Vec3::new(s, c * phi.cos(), c * phi.sin()));
                                let cell =
                                    f64::from(PI) * weight / f64::from(nt) * f64::from(TAU) / f64::from(np);
                                sum += f64::from(hair.eval(wo, wi)[0] * wi.abs_cos_theta() * c) * cell;
                            }
                        }
                    }
                    assert!((sum - 1.0).abs() < 1e-3, "{beta} {h}: {sum}");
                }
            }
        }
    }

    #[test]
    fn thin_light_path_is_absorbed_as_its_chord_says() {
        // Met in the middle and across: R, then TT over a diameter, 2 radii.
        let (sigma, eta) = (0.4_f32, 1.55_f32);
        let hair = Hair::new(Fibre { eta, ..fibre(0.0, sigma, 0.3) });
        let a = hair.lobed(dir(0.0, 0.0)).attenuation.map(|a| f64::from(a[0]));
        let r = f64::from(((eta - 1.0) / (eta + 1.0)).powi(2));
        let t = (-2.0 * f64::from(sigma)).exp();
        let tt = (1.0 - r).powi(2) * t;
        for (found, expected) in a.into_iter().zip([r, tt, tt * t * r, tt * (t * r).powi(2) / (1.0 - t * r)])
        {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn scales_tilt_the_highlight_by_twice_their_angle() {
        // R of light across the hair leaves at θ = 2α: where M is largest.
        let hair = Hair::new(Fibre { alpha: 3.0, beta_m: 0.05, ..fibre(0.0, 1e6, 0.3) });
        let wo = dir(0.0, 0.0);
        let best = (-200..200)
            .map(|k| (k as f32 * 0.1_f32).to_radians())
            .max_by(|&a, &b| {
                let f = |t: f32| {
                    hair.eval(wo, LocalDir::new_unchecked(Vec3::new(t.sin(), 0.0, t.cos())))[0] * t.cos()
                };
                f(a).total_cmp(&f(b))
            })
            .unwrap();
        assert!((best.to_degrees() - 6.0).abs() < 0.11, "{}", best.to_degrees());
    }

    #[test]
    fn colour_comes_back_from_its_absorption() {
        // Chiang et al. 2016, eq. 9 at β = 0.3: ln c = −√σ (5.969 − …).
        let sigma = Hair::sigma_a_of_reflectance(Sampled::splat(0.5), 0.3);
        let b = 0.3_f64;
        let divisor =
            5.969 - 0.215 * b + 2.532 * b.powi(2) - 10.73 * b.powi(3) + 5.574 * b.powi(4) + 0.245 * b.powi(5);
        assert!((f64::from(sigma[0]) - (0.5_f64.ln() / divisor).powi(2)).abs() < 1e-7, "{sigma:?}");
        assert!(Hair::sigma_a_of_reflectance(Sampled::ONE, 0.3).is_zero());
        assert!(Hair::sigma_a_of_reflectance(Sampled::ZERO, 0.3).is_finite());
    }
}
