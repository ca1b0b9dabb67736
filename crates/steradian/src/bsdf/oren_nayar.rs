//! Rough diffuse reflection that keeps its energy: EON of Portsmouth, Kutz and Hill (2024).
//!
//! A surface of Lambertian facets scatters back towards the light and darkens less at its edges than Lambert's law
//! has it. EON takes Fujii's form of the Oren–Nayar model for light scattered once,
//!
//! ```text
//! f₁ = ρ/π A (1 + r s/t)     A = 1/(1 + C₁ r)     s = wo·wi − μo μi     t = max(μo, μi) where s > 0, else 1
//! ```
//!
//! and returns what that loses as light scattered more often, with the directional albedo E of f₁ at ρ = 1 and its mean Ē:
//!
//! ```text
//! f₊ = ρ₊/π (1 − E(μo)) (1 − E(μi)) / (1 − Ē)     ρ₊ = ρ² Ē / (1 − ρ (1 − Ē))
//! ```
//!
//! The sum is reciprocal, and without loss at ρ = 1. E is the exact integral here, not the paper's polynomial.

use super::albedo::Albedo;
use super::contract::{BsdfSample, Lobe, Lobes};
use super::specimen::{Claims, Specimen};
use crate::math::float::safe_sqrt;
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// G(0)/π = 1/2 − 2/(3π): makes the albedo of light scattered once exactly one at grazing incidence.
const C1: f32 = 0.5 - 2.0 / (3.0 * PI);
/// The mean of G/π under 2μ dμ, 2/3 − 28/(15π).
const C2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// Energy-preserving Oren–Nayar reflection, alike on both sides of the surface; Lambert's law at roughness 0.
#[derive(Clone, Copy, Debug)]
pub struct OrenNayar {
    /// Reflectance ρ of the facets in [0, 1]; the reflectance of the surface where that is 0 or 1, and more saturated
    /// in between.
    pub reflectance: Sampled<Unitless>,
    /// Roughness r in [0, 1].
    pub roughness: f32,
}

impl OrenNayar {
    /// f [sr⁻¹]; zero across the surface.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        if !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        let (mu_o, mu_i) = (wo.abs_cos_theta(), wi.abs_cos_theta());
        // wo·wi − μo μi without the cancellation.
        let s = wo.x * wi.x + wo.y * wi.y;
        let s_over_t = if s > 0.0 { s / mu_o.max(mu_i) } else { s };
        let once = FRAC_1_PI * self.a() * (1.0 + self.roughness * s_over_t);
        // Both losses carry the factor A r, and so does 1 − Ē: one of them cancels, which leaves Lambert's law at r = 0.
        let again = FRAC_1_PI * self.a() * self.roughness * loss(mu_o) * loss(mu_i) / (C1 - C2);
        // Rounding may leave less than nothing where the two directions are opposite at the horizon.
        (self.reflectance * once.max(0.0) + self.multiple_reflectance() * again).cast()
    }

    /// Density of [`OrenNayar::sample`].
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if !wo.same_hemisphere(wi) {
            return PdfSolidAngle(0.0);
        }
        let lobe = ClippedLobe::new(wo, self.roughness);
        let p = self.uniform_probability(wo.abs_cos_theta());
        PdfSolidAngle(p * UNIFORM_HEMISPHERE_PDF + (1.0 - p) * lobe.pdf(wi))
    }

    /// A direction on the side of `wo`: from a linearly transformed cosine clipped at the horizon, or uniform.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 || self.reflectance.is_zero() {
            return None;
        }
        let wi = if uc < self.uniform_probability(wo.abs_cos_theta()) {
            let z = 1.0 - u.x;
            let (r, phi) = (safe_sqrt(1.0 - z * z), TAU * u.y);
            LocalDir::new_unchecked(Vec3::new(r * phi.cos(), r * phi.sin(), z.copysign(wo.z)))
        } else {
            ClippedLobe::new(wo, self.roughness).sample(u)?
        };
        BsdfSample::reflected(wi, self.eval(wo, wi), self.pdf(wo, wi), Lobe::Diffuse)
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        Lobes { reflection: !self.reflectance.is_zero(), transmission: false }
    }

    /// ρ E(μ) + ρ₊ (1 − E(μ)), a closed form.
    pub fn albedo(&self, wi: LocalDir) -> Albedo {
        let lost = self.a() * self.roughness * loss(wi.abs_cos_theta());
        Albedo::reflecting(self.reflectance * (1.0 - lost) + self.multiple_reflectance() * lost)
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        if self.reflectance.min() >= 1.0 { Claims::LOSSLESS } else { Claims::CLOSED_FORM }
    }

    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |reflectance, roughness| Self { reflectance, roughness };
        let colour = Sampled::from_array([0.1, 0.8, 0.4, 0.0]);
        [
            ("orennayar white 0.01", of(Sampled::ONE, 0.01)),
            ("orennayar white 0.5", of(Sampled::ONE, 0.5)),
            ("orennayar white 1", of(Sampled::ONE, 1.0)),
            ("orennayar coloured 0.3", of(colour, 0.3)),
            ("orennayar coloured 1", of(colour, 1.0)),
        ]
        .into_iter()
        .map(|(name, bsdf)| Specimen::new(name, bsdf.claims(), bsdf))
    }

    /// A of the model.
    fn a(&self) -> f32 {
        1.0 / (1.0 + C1 * self.roughness)
    }

    /// ρ₊: of the light that is scattered again, the part that leaves in the end.
    fn multiple_reflectance(&self) -> Sampled<Unitless> {
        let mean = self.a() * (1.0 + C2 * self.roughness);
        self.reflectance.map(|rho| rho * rho * mean / (1.0 - rho * (1.0 - mean)))
    }

    /// Probability of a uniform direction, which covers what the lobe misses at grazing angles; fit of the paper.
    fn uniform_probability(&self, mu: f32) -> f32 {
        self.roughness.powf(0.1) * (0.162_925 + mu * (-0.372_058 + (0.538_233 - 0.290_822 * mu) * mu))
    }
}

const UNIFORM_HEMISPHERE_PDF: f32 = 1.0 / TAU;

/// (1 − E(μ))/(A r) = C₁ − G(μ)/π, where G is the integral of s/t over the hemisphere.
fn loss(mu: f32) -> f32 {
    let s = safe_sqrt(1.0 - mu * mu);
    // s/μ (1 − s³) by 1 − s = μ²/(1 + s): finite at the horizon.
    let g = s * (mu.min(1.0).acos() - s * mu) + (2.0 / 3.0) * (s * mu * (1.0 + s + s * s) / (1.0 + s) - s);
    (C1 - g * FRAC_1_PI).max(0.0)
}

/// A cosine lobe transformed linearly by M = [a 0 b; 0 c 0; d 0 1] (in the plane of `wo`) and clipped to the side of `wo`.
///
/// The cosine's unit disk is cut where M takes directions under the horizon, d x + z < 0: along an ellipse with semi-axis
/// v = 1/√(1 + d²), so that the rest has the area π (1 + v)/2. Samples are squeezed into it: none is lost.
struct ClippedLobe {
    a: f32,
    b: f32,
    c: f32,
    /// Not above zero.
    d: f32,
    v: f32,
    /// Unit vector towards `wo` in the surface.
    tangent: Vec2,
    /// Sign of the side.
    side: f32,
}

impl ClippedLobe {
    /// The fit of the paper (2024, listing 2).
    fn new(wo: LocalDir, r: f32) -> Self {
        let mu = wo.abs_cos_theta().min(1.0);
        let tangent = Vec2::new(wo.x, wo.y);
        let length = tangent.length();
        let a =
            1.0 + r * (0.303_392 + (-0.518_982 + 0.111_709 * mu) * mu + (-0.276_266 + 0.335_918 * mu) * r);
        let b =
            r * (-1.164_07 + 1.158_59 * mu + (0.150_815 - 0.150_105 * mu) * r) / (mu * mu * mu - 1.435_45);
        let c = 1.0 + r * (0.200_13 + (-0.506_373 + 0.261_777 * mu) * mu);
        let d = r * (0.540_852 + (-1.016_25 + 0.475_392 * mu) * mu) / (-1.0743 + (0.072_562_8 + mu) * mu);
        // The fit passes zero by a hair at normal incidence, and the disk is cut on one side only.
        let d = d.min(0.0);
        let tangent = if length > 0.0 { tangent / length } else { Vec2::X };
        Self { a, b, c, d, v: 1.0 / (1.0 + d * d).sqrt(), tangent, side: 1.0_f32.copysign(wo.z) }
    }

    fn sample(&self, u: Vec2) -> Option<LocalDir> {
        let disk = warp::polar_disk(u);
        let edge = safe_sqrt(1.0 - disk.y * disk.y);
        let s = self.area_fraction();
        let x = -((1.0 - s) * edge + s * disk.x);
        let h = Vec3::new(x, disk.y, safe_sqrt(1.0 - x * x - disk.y * disk.y));
        let w = Vec3::new(self.a * h.x + self.b * h.z, self.c * h.y, self.d * h.x + h.z);
        let (t, n) = (self.tangent, self.side);
        LocalDir::new(Vec3::new(t.x * w.x - t.y * w.y, t.y * w.x + t.x * w.y, n * w.z))
    }

    fn pdf(&self, w: LocalDir) -> f32 {
        let t = self.tangent;
        let (x, y, z) = (t.x * w.x + t.y * w.y, t.x * w.y - t.y * w.x, self.side * w.z);
        // The adjugate of M, applied: M⁻¹ w times det M.
        let m = self.a - self.b * self.d;
        let h = Vec3::new(self.c * (x - self.b * z), m * y, self.c * (self.a * z - self.d * x));
        let det = self.c * m;
        let squared = h.length_squared();
        h.z.max(0.0) * det * det / (PI * self.area_fraction() * squared * squared)
    }

    fn area_fraction(&self) -> f32 {
        0.5 * (1.0 + self.v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Diffuse;
    use crate::math::hash::Pcg32;

    fn at(mu: f32, phi: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(mu.acos(), phi))
    }

    /// ∫ f cosθ dω by midpoints in cos²θ and φ.
    fn by_quadrature(b: &OrenNayar, wo: LocalDir) -> f64 {
        let (n, m) = (400, 200);
        let mut sum = 0.0;
        for i in 0..n {
            let mu = ((i as f32 + 0.5) / n as f32).sqrt();
            for j in 0..m {
                sum += f64::from(b.eval(wo, at(mu, TAU * (j as f32 + 0.5) / m as f32))[0]);
            }
        }
        sum * std::f64::consts::PI / f64::from(n * m)
    }

    #[test]
    fn albedo_is_the_closed_form_at_every_angle_and_one_for_white() {
        for roughness in [0.0, 0.01, 0.3, 1.0] {
            for rho in [0.2, 0.7, 1.0] {
                let b = OrenNayar { reflectance: Sampled::splat(rho), roughness };
                for mu in [1.0, 0.8, 0.3, 0.05] {
                    let integral = by_quadrature(&b, at(mu, 0.4));
                    let closed = f64::from(b.albedo(at(mu, 0.0)).reflectance[0]);
                    // The kink of s/t leaves the midpoint rule 1e-4.
                    assert!((integral - closed).abs() < 4e-4, "{roughness} {rho} {mu}: {integral} {closed}");
                    assert!(rho < 1.0 || (closed - 1.0).abs() < 1e-6, "{roughness} {mu}: {closed}");
                }
            }
        }
    }

    #[test]
    fn a_surface_without_roughness_is_lambertian() {
        let reflectance = Sampled::from_array([0.1, 0.8, 0.4, 1.0]);
        let (b, lambert) = (OrenNayar { reflectance, roughness: 0.0 }, Diffuse { reflectance });
        for (wo, wi) in [(at(0.9, 0.0), at(0.2, 3.0)), (at(0.01, 0.0), at(0.02, 0.0))] {
            assert_eq!(b.eval(wo, wi), lambert.eval(wo, wi));
            assert!((b.pdf(wo, wi).0 - lambert.pdf(wo, wi).0).abs() < 1e-6);
        }
    }

    /// A = 1/(1 + 1/2 − 2/(3π)) = 0.77652: f₁ at normal incidence is A/π there, and E = A.
    #[test]
    fn light_scattered_once_returns_to_where_it_came_from() {
        let b = OrenNayar { reflectance: Sampled::splat(1e-4), roughness: 1.0 };
        // ρ² drops out at 1e-4.
        let normal = b.eval(LocalDir::Z, LocalDir::Z)[0] / 1e-4;
        assert!((normal - 0.776_52 * FRAC_1_PI).abs() < 1e-4, "{normal}");
        let (wo, back, forth) = (at(0.5, 0.0), at(0.5, 0.0), at(0.5, PI));
        // s = ±3/4; t = 1/2 or 1.
        let ratio = b.eval(wo, back)[0] / b.eval(wo, forth)[0];
        assert!((ratio - (1.0 + 1.5) / (1.0 - 0.75)).abs() < 1e-2, "{ratio}");
    }

    /// Cosine sampling leaves variances of 0.036, 0.50 and 0.118 here.
    #[test]
    fn weights_of_a_white_surface_vary_less_than_by_cosine_sampling() {
        let mut rng = Pcg32::new(3, 1);
        for (roughness, mu, most) in [(1.0, 0.9, 0.015), (1.0, 0.2, 0.05), (0.3, 0.05, 0.03)] {
            let b = OrenNayar { reflectance: Sampled::ONE, roughness };
            let (mut sum, mut squares, n) = (0.0, 0.0, 40_000);
            for _ in 0..n {
                let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
                let weight = b.sample(at(mu, 1.0), uc, u).map_or(0.0, |s| f64::from(s.weight[0]));
                sum += weight;
                squares += weight * weight;
            }
            let mean = sum / f64::from(n);
            let variance = squares / f64::from(n) - mean * mean;
            // Four standard errors: 4 √(0.05/40 000).
            assert!((mean - 1.0).abs() < 5e-3 && variance < most, "{roughness} {mu}: {mean} {variance}");
        }
    }
}
