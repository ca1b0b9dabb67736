//! Fuzz: a thin volume of fibres that stand on the surface.
//!
//! The layer is that of Zeltner, Burley and Chiang (2022), a homogeneous volume of unit thickness of SGGX microflakes
//! (Heitz et al. 2015) that are mirrors: S = diag(1, 1, α²), so that the flakes are the flanks of upright fibres where α is
//! small, and spherical dust at α = 1. They fit a table of linearly transformed cosines to its reflection, which is not
//! reciprocal. Here light that is scattered once is taken in closed form, and the rest in the product form of
//! Kulla and Conty (2017) with the albedo that random walks through the layer find:
//!
//! ```text
//! f₁ = D(h)/(4 μo μi) (1 − e^−(xo+xi))/(xo + xi)     x = σ(ω)/μ     σ(ω)² = ωᵀ S ω
//! f₊ = g(μo) g(μi) / (π ḡ)                           g = E − E₁,  ḡ its mean
//! ```

use super::directional::{Nodes, Place, mean};
use super::tables::{FUZZ_ONCE, FUZZ_ROWS, FUZZ_TOTAL, NODES};
use crate::math::{LocalDir, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Relative excess of the albedo over the table, which is linear between nodes: layers below get the rest.
const GUARD: f32 = 1.015;

/// A layer of unit thickness that absorbs nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fuzz {
    /// α in [0.1, 1]: thinner fibres are not tabulated.
    alpha: f32,
}

impl Fuzz {
    /// `roughness` in [0, 1] is α; below 0.1 it is taken as that.
    pub(super) fn new(roughness: f32) -> Self {
        Self { alpha: roughness.clamp(0.1, 1.0) }
    }

    /// f [sr⁻¹] on one side of the surface.
    pub(super) fn eval(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let Some(h) = LocalDir::new(*wo + *wi) else { return 0.0 };
        let (mu_o, mu_i) = (wo.abs_cos_theta(), wi.abs_cos_theta());
        let a2 = self.alpha * self.alpha;
        let q = h.x * h.x + h.y * h.y + h.z * h.z / a2;
        let d = 1.0 / (PI * self.alpha * q * q);
        let sigma = |w: Vec3| (w.x * w.x + w.y * w.y + a2 * w.z * w.z).sqrt();
        // (1 − e^−(xo + xi))/(μo μi (xo + xi)) without 1/μ.
        let sum = sigma(*wo) * mu_i + sigma(*wi) * mu_o;
        let once = 0.25 * d * -(-sum / (mu_o * mu_i)).exp_m1() / sum;
        let again = self.rows(|total, once| (total - once).max(0.0));
        let again = Place::new(mu_o).at(&again) * Place::new(mu_i).at(&again) / mean(&again);
        once + FRAC_1_PI * again
    }

    /// What a layer of full coverage keeps from those below at the nodes, at least.
    pub(super) fn reflected(&self) -> Nodes {
        self.rows(|total, _| (total * GUARD).min(1.0))
    }

    /// A function of the two tables between their rows.
    fn rows(&self, f: impl Fn(f32, f32) -> f32) -> Nodes {
        let x = (self.alpha - 0.1) / 0.1;
        let i = (x as usize).min(FUZZ_ROWS - 2);
        let t = x - i as f32;
        let mix = |table: &[[f32; NODES]; FUZZ_ROWS], j: usize| table[i][j] * (1.0 - t) + table[i + 1][j] * t;
        std::array::from_fn(|j| f(mix(&FUZZ_TOTAL, j), mix(&FUZZ_ONCE, j)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::directional::node;
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::{Frame, Vec2, warp};
    use crate::optics::refraction;

    fn direction(mu: f32, phi: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(mu.acos(), phi))
    }

    /// The share that a layer of mirror flakes reflects, by walks.
    fn walked(alpha: f32, mu: f32, n: u32) -> f32 {
        let mut rng = Pcg32::new(11, 4);
        let mut returned = 0;
        let stretch = |v: Vec3| Vec3::new(v.x, v.y, v.z / alpha).normalize();
        for _ in 0..n {
            let (mut w, mut depth) = (*-direction(mu, 0.4), 0.0_f32);
            loop {
                let sigma = (w.x * w.x + w.y * w.y + alpha * alpha * w.z * w.z).sqrt();
                depth -= w.z * warp::exponential(rng.next_f32(), sigma);
                if !(0.0..=1.0).contains(&depth) {
                    returned += u32::from(depth < 0.0);
                    break;
                }
                // A flake that is seen: cosine-distributed on the sphere that the ellipsoid stretches to.
                let u = Vec2::new(rng.next_f32(), rng.next_f32());
                let frame = Frame::from_z(stretch(-w));
                let up = warp::cosine_hemisphere(u);
                let on_sphere = frame.s * up.x + frame.t * up.y + frame.n * up.z;
                w = refraction::reflect(-w, stretch(on_sphere)).normalize();
            }
        }
        returned as f32 / n as f32
    }

    #[test]
    fn table_is_what_random_walks_find() {
        for (row, k) in [(0, 3), (0, 7), (2, 5), (4, 9), (6, 4), (9, 2), (9, 9)] {
            let n = 20_000;
            let (found, table) = (walked(0.1 + 0.1 * row as f32, node(k), n), FUZZ_TOTAL[row][k]);
            // Four standard errors of a share, and as much for the table's own walks.
            let error = 5.0 * (table * (1.0 - table) / n as f32).sqrt();
            assert!((found - table).abs() < error, "{row} {k}: {found} {table}");
        }
    }

    #[test]
    fn reflection_is_what_the_layers_below_are_told() {
        for roughness in [0.0_f32, 0.15, 0.3, 0.55, 1.0] {
            let fuzz = Fuzz::new(roughness);
            for mu in [0.05_f32, 0.15, 0.35, 0.6, 0.9, 1.0] {
                let wo = direction(mu, 0.0);
                let n = 300;
                let mut sum = 0.0_f64;
                for i in 0..n {
                    for j in 0..n {
                        // Dense towards the retroreflection and the horizon.
                        let (x, y) = ((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
                        let (z, phi) = (x * x, PI * y * y * y);
                        let f = fuzz.eval(wo, direction(z, phi));
                        sum += f64::from(f * z * 2.0 * x * 2.0 * 3.0 * PI * y * y) / f64::from(n * n);
                    }
                }
                let told = f64::from(Place::new(mu).at(&fuzz.reflected()));
                assert!(sum <= told && sum > 0.93 * told, "{roughness} {mu}: {sum} {told}");
            }
        }
    }
}
