//! A smooth clear coat over a Lambertian base, in closed form.
//!
//! A Lambertian base forgets where light came from, so that the orders of reflection under the coat form a geometric series:
//! this is the random walk of [`Layered`] with every integral done (Saunderson 1942, with directions and absorption).

use super::albedo::Albedo;
use super::contract::{BsdfSample, Evaluated, Lobe, Lobes, Side};
use super::diffuse::Diffuse;
use super::layered::{Coat, Layered};
use super::quadrature::GAUSS_LEGENDRE;
use super::specimen::{Claims, Specimen};
use super::varnish::sent_up;
use crate::math::float::safe_sqrt;
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::optics::fresnel::{self, Crossing};
use crate::optics::{TrowbridgeReitz, absorption};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// A smooth coat without scattering over a Lambertian base, alike on both sides of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VarnishedDiffuse {
    layers: Layered<Diffuse>,
    /// Light that the base gets back of what it gave off: absorbed twice and reflected by the coat from below.
    returned: f32,
}

impl VarnishedDiffuse {
    /// The closed form of `layers`; `None` where there is none, for a rough coat or a scattering medium.
    pub fn new(layers: Layered<Diffuse>) -> Option<Self> {
        let coat = &layers.coat;
        (coat.interface.is_specular() && coat.albedo.is_zero())
            .then(|| Self { layers, returned: returned_share(coat.interface.eta, coat.thickness) })
    }

    /// The same coat over a base of another reflectance: the coat's integral is not done again.
    #[must_use]
    #[inline]
    pub fn over(&self, reflectance: Sampled<Unitless>, seed: u64) -> Self {
        let layers = Layered { coat: self.layers.coat, base: Diffuse { reflectance }, seed };
        Self { layers, returned: self.returned }
    }

    /// The layers that this is the closed form of.
    pub fn layers(&self) -> &Layered<Diffuse> {
        &self.layers
    }

    /// f [sr⁻¹] = t(wo) t(wi) / (π η²) · Σ ρ (ρ K)^k without the mirror reflection: t is what passes the interface and the
    /// medium, K what returns to the base, and the sum has as many orders as the walk has events there.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        if !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        self.sent_up() * (self.passage(wo).passed() * self.passage(wi).passed())
    }

    /// (1 − R(wo)) cosθi / π.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if !wo.same_hemisphere(wi) {
            return PdfSolidAngle(0.0);
        }
        let entered = 1.0 - fresnel::dielectric(wo.abs_cos_theta(), self.layers.coat.interface.eta);
        PdfSolidAngle(entered * warp::cosine_hemisphere_pdf(wi.abs_cos_theta()))
    }

    /// Both at once.
    pub fn evaluate(&self, wo: LocalDir, wi: LocalDir) -> Evaluated {
        if !wo.same_hemisphere(wi) {
            return Evaluated::NOTHING;
        }
        let (there, back) = (self.passage(wo), self.passage(wi));
        let entered = 1.0 - there.reflectance;
        Evaluated {
            f: self.sent_up() * (there.passed() * back.passed()),
            pdf: PdfSolidAngle(entered * warp::cosine_hemisphere_pdf(wi.abs_cos_theta())),
        }
    }

    /// The mirror direction with the probability of its reflectance, else a cosine-distributed direction.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let there = self.passage(wo);
        if uc < there.reflectance {
            return Some(BsdfSample {
                wi: LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z)),
                weight: Sampled::ONE,
                density: Density::Delta,
                side: Side::Reflection,
                lobe: Lobe::Specular,
                eta: 1.0,
            });
        }
        let up = warp::cosine_hemisphere(u);
        let wi = if wo.z > 0.0 { up } else { -up };
        let entered = 1.0 - there.reflectance;
        let pdf = PdfSolidAngle(entered * warp::cosine_hemisphere_pdf(up.z));
        // What enters from `wo` and the cosine cancel.
        let carried = std::f32::consts::PI * there.transmittance * self.passage(wi).passed();
        (pdf.0 > 0.0).then(|| BsdfSample {
            wi,
            weight: self.sent_up().cast() * carried,
            density: Density::SolidAngle(pdf),
            side: Side::Reflection,
            lobe: Lobe::Glossy,
            eta: 1.0,
        })
    }

    /// ρ for light from `wi`: the mirror reflection, and ∫ f cosθ dω by Gauss' rule.
    pub fn albedo(&self, wi: LocalDir) -> Albedo {
        let mirror = fresnel::dielectric(wi.abs_cos_theta(), self.layers.coat.interface.eta);
        // Over cos²θ, in which the measure is uniform; f varies with the cosines alone.
        let mut below = Sampled::<PerSteradian>::ZERO;
        for [x, weight] in GAUSS_LEGENDRE {
            let cos = safe_sqrt(x as f32).copysign(wi.z);
            let wo = LocalDir::new_unchecked(Vec3::new(safe_sqrt(1.0 - cos * cos), 0.0, cos));
            below += self.eval(wo, wi) * (std::f32::consts::PI * weight as f32);
        }
        Albedo::reflecting(Sampled::splat(mirror) + below.cast())
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        self.layers.base.lobes()
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        Claims::CLOSED_FORM
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |eta, thickness, reflectance| {
            let coat = Coat { thickness, max_depth: 1000, ..Coat::clear(eta, TrowbridgeReitz::SMOOTH) };
            Self::new(Layered { coat, base: Diffuse { reflectance }, seed: 0 })
        };
        let coloured = Sampled::from_array([0.1, 0.8, 0.4, 1.0]);
        [
            ("varnished white", Claims::LOSSLESS, of(1.5, f32::MIN_POSITIVE, Sampled::ONE)),
            ("varnished coloured", Claims::CLOSED_FORM, of(1.5, 0.01, coloured)),
            ("varnished, dark varnish", Claims::CLOSED_FORM, of(1.33, 0.5, coloured)),
        ]
        .into_iter()
        .filter_map(|(name, claims, bsdf)| Some(Specimen::new(name, claims, bsdf?)))
    }

    /// Σ ρ (ρ K)^k / (π η²) [sr⁻¹]: what the base sends up, and what becomes of it as it leaves into air.
    #[inline]
    fn sent_up(&self) -> Sampled<PerSteradian> {
        let coat = &self.layers.coat;
        let eta = coat.interface.eta;
        let sum = sent_up(self.layers.base.reflectance, self.returned, coat.max_depth);
        (sum * (FRAC_1_PI / (eta * eta))).cast()
    }

    /// The way of light between `w` outside and the base.
    #[inline]
    fn passage(&self, w: LocalDir) -> Passage {
        let coat = &self.layers.coat;
        let crossing = Crossing::new(w.abs_cos_theta(), coat.interface.eta);
        let inside = crossing.cos_theta_t();
        let transmittance =
            if inside > 0.0 { absorption::bouguer(1.0 / inside, coat.thickness) } else { 0.0 };
        Passage { reflectance: crossing.reflectance, transmittance }
    }
}

/// One passage through the coat.
struct Passage {
    /// What the interface reflects.
    reflectance: f32,
    /// What the medium lets pass.
    transmittance: f32,
}

impl Passage {
    /// The share of light from outside that arrives at the base.
    #[inline]
    fn passed(&self) -> f32 {
        (1.0 - self.reflectance) * self.transmittance
    }
}

/// ∫ 2μ R(μ) e^(−2t/μ) dμ: the share of a Lambertian emission under a smooth interface that returns through
/// a medium of optical thickness `t`. For t → 0 the hemispherical reflectance from inside.
fn returned_share(eta: f32, t: f32) -> f32 {
    let (eta, t) = (f64::from(eta), f64::from(t));
    let reflectance = |cos: f64| f64::from(fresnel::dielectric(cos as f32, eta as f32));
    let integrate = |f: &dyn Fn(f64) -> f64| GAUSS_LEGENDRE.iter().map(|&[x, w]| w * f(x)).sum::<f64>();
    let absorbed = |mu: f64| (-2.0 * t / mu).exp();
    if eta <= 1.0 {
        return integrate(&|mu| 2.0 * mu * reflectance(-mu) * absorbed(mu)) as f32;
    }
    // Total reflection up to the critical angle, beyond it over the cosine outside, in which R is smooth: μ dμ = c dc / η².
    let critical = (1.0 - 1.0 / (eta * eta)).sqrt();
    let total = integrate(&|x| 2.0 * critical * critical * x * absorbed(critical * x));
    let partial = integrate(&|c| {
        let mu = (1.0 - (1.0 - c * c) / (eta * eta)).sqrt();
        2.0 * c / (eta * eta) * reflectance(c) * absorbed(mu)
    });
    (total + partial) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Mode;
    use crate::math::hash::Pcg32;

    #[test]
    fn clear_coat_returns_the_hemispherical_reflectance_from_inside() {
        // Closed form of r_int = 1 − (1 − r_ext)/n².
        for (eta, r_int) in
            [(1.333, 0.474_590_57), (1.4, 0.528_985_48), (1.5, 0.596_345_76), (1.6, 0.650_877_17)]
        {
            let k = returned_share(eta, 1e-30);
            assert!((k - r_int).abs() < 2e-5, "{eta}: {k} {r_int}");
        }
    }

    #[test]
    fn absorbing_coat_returns_what_dense_quadrature_says() {
        for eta in [0.8_f32, 1.2, 1.5, 2.0] {
            for t in [0.003_f32, 0.01, 0.1, 0.5, 2.0] {
                let n = 200_000;
                let dense: f64 = (0..n)
                    .map(|i| {
                        let mu = (f64::from(i) + 0.5) / f64::from(n);
                        let r = f64::from(fresnel::dielectric(-mu as f32, eta));
                        2.0 * mu * r * (-2.0 * f64::from(t) / mu).exp() / f64::from(n)
                    })
                    .sum();
                let k = f64::from(returned_share(eta, t));
                assert!((k - dense).abs() < 4e-4, "{eta} {t}: {k} {dense}");
            }
        }
    }

    #[test]
    fn varnish_of_saunderson_has_its_reflectance() {
        // Diffuse incidence: r_ext + (1 − r_ext)(1 − r_int) ρ / (1 − r_int ρ); here ∫ 2μ of the directional one.
        let (r_ext, r_int) = (0.091_777_96_f64, 0.596_345_76_f64);
        for rho in [0.2_f32, 0.7, 1.0] {
            let coat = Coat {
                thickness: f32::MIN_POSITIVE,
                max_depth: 1000,
                ..Coat::clear(1.5, TrowbridgeReitz::SMOOTH)
            };
            let base = Diffuse { reflectance: Sampled::splat(rho) };
            let b = VarnishedDiffuse::new(Layered { coat, base, seed: 0 }).unwrap();
            let dir = |c: f64| LocalDir::new_unchecked(Vec3::new((1.0 - c * c).sqrt() as f32, 0.0, c as f32));
            let quadrature =
                |f: &dyn Fn(f64) -> f64| GAUSS_LEGENDRE.iter().map(|&[x, w]| w * f(x)).sum::<f64>();
            let total = quadrature(&|o| {
                let mirror = f64::from(fresnel::dielectric(o as f32, 1.5));
                let base =
                    quadrature(&|i| 2.0 * i * std::f64::consts::PI * f64::from(b.eval(dir(o), dir(i))[0]));
                2.0 * o * (mirror + base)
            });
            let rho = f64::from(rho);
            let expected = r_ext + (1.0 - r_ext) * (1.0 - r_int) * rho / (1.0 - r_int * rho);
            assert!((total - expected).abs() < 5e-5, "{rho}: {total} {expected}");
        }
    }

    #[test]
    fn closed_form_is_the_mean_of_the_random_walks() {
        let wo = LocalDir::new(Vec3::new(0.5, 0.2, 0.7)).unwrap();
        let wi = LocalDir::new(Vec3::new(-0.8, 0.4, 0.5)).unwrap();
        for (thickness, depth) in [(0.01, 10), (0.4, 10), (0.05, 4), (0.05, 1)] {
            let coat = Coat { thickness, max_depth: depth, ..Coat::clear(1.5, TrowbridgeReitz::SMOOTH) };
            let base = Diffuse { reflectance: Sampled::from_array([0.2, 0.5, 0.9, 1.0]) };
            let layers = Layered { coat, base, seed: 0 };
            let closed = VarnishedDiffuse::new(layers).unwrap().eval(wo, wi);
            let n = 40_000;
            let (mut mean, mut square) = ([0.0_f64; 4], [0.0_f64; 4]);
            for seed in 0..n {
                let f = Layered { seed, ..layers }.eval(wo, wi, Mode::Radiance);
                for lane in 0..4 {
                    mean[lane] += f64::from(f[lane]) / n as f64;
                    square[lane] += f64::from(f[lane]).powi(2) / n as f64;
                }
            }
            for lane in 0..4 {
                let error = ((square[lane] - mean[lane].powi(2)).max(0.0) / n as f64).sqrt();
                let difference = (mean[lane] - f64::from(closed[lane])).abs();
                // 16 comparisons at 4.4 standard errors: a joint level of 2e-4.
                assert!(
                    difference < 4.4 * error + 1e-6,
                    "{thickness} {depth} {lane}: {} {closed:?} ± {error}",
                    mean[lane]
                );
            }
        }
    }

    #[test]
    fn sampled_energy_is_that_of_the_walk() {
        let coat = Coat::clear(1.5, TrowbridgeReitz::SMOOTH);
        let layers = Layered { coat, base: Diffuse { reflectance: Sampled::splat(0.8) }, seed: 5 };
        let closed = VarnishedDiffuse::new(layers).unwrap();
        let wo = LocalDir::new(Vec3::new(0.5, 0.2, -0.7)).unwrap();
        let mut rng = Pcg32::new(3, 3);
        let n = 200_000;
        let (mut walk, mut form) = (0.0_f64, 0.0_f64);
        for _ in 0..n {
            let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
            let weight = |s: Option<BsdfSample>| s.map_or(0.0, |s| f64::from(s.weight[0])) / f64::from(n);
            walk += weight(layers.sample(wo, uc, u, Mode::Radiance));
            form += weight(closed.sample(wo, uc, u));
        }
        // The walk's weights are zero or near one: standard error below 0.5/√n = 1.1e-3.
        assert!((walk - form).abs() < 5e-3, "{walk} {form}");
    }
}
