//! The Trowbridge–Reitz (GGX) distribution of microfacet normals.

use crate::math::{LocalDir, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Below this roughness both axes are treated as a perfectly smooth interface.
const SMOOTH_ALPHA: f32 = 1e-3;

/// Narrowest lobe along one axis of an anisotropic distribution: D stays finite in f32.
const MIN_ALPHA: f32 = 1e-4;

/// Steepest facets: a hundred times beyond the roughest surfaces, and far from where D underflows.
const MAX_ALPHA: f32 = 100.0;

/// Microfacets whose slopes follow Trowbridge & Reitz 1975, with Smith's height-correlated shadowing
/// (Walter et al. 2007; Heitz 2014; pbrt-v4 book, 9.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrowbridgeReitz {
    alpha_x: f32,
    alpha_y: f32,
}

impl TrowbridgeReitz {
    /// No microfacets: a smooth interface.
    pub const SMOOTH: Self = Self { alpha_x: 0.0, alpha_y: 0.0 };

    /// A distribution with slope widths `alpha_x`, `alpha_y` ≥ 0 along the axes of the shading frame.
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        debug_assert!(alpha_x >= 0.0 && alpha_y >= 0.0, "{alpha_x} {alpha_y}");
        let mut d = Self { alpha_x, alpha_y };
        if !d.is_smooth() {
            d.alpha_x = alpha_x.clamp(MIN_ALPHA, MAX_ALPHA);
            d.alpha_y = alpha_y.clamp(MIN_ALPHA, MAX_ALPHA);
        }
        d
    }

    /// Width α of the perceptual roughness in scene files: its square root.
    pub fn alpha_from_roughness(roughness: f32) -> f32 {
        roughness.max(0.0).sqrt()
    }

    /// The widths along x and y.
    pub fn alpha(&self) -> [f32; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// Whether both widths are too small to be told from a smooth interface: such a surface scatters
    /// into discrete directions, and D is not to be evaluated.
    pub fn is_smooth(&self) -> bool {
        self.alpha_x.max(self.alpha_y) < SMOOTH_ALPHA
    }

    /// Whether the distribution does not change under rotation about the normal.
    pub fn is_isotropic(&self) -> bool {
        self.alpha_x == self.alpha_y
    }

    /// Widens a narrow distribution: a named bias against fireflies (pbrt-v4 book, 14.2).
    #[must_use]
    pub fn regularized(self) -> Self {
        let widen = |a: f32| if a < 0.3 { (2.0 * a).clamp(0.1, 0.3) } else { a };
        Self { alpha_x: widen(self.alpha_x), alpha_y: widen(self.alpha_y) }
    }

    /// Differential area of facets with normal `wm` per area and solid angle [sr⁻¹]; ∫ D cosθm dωm = 1.
    pub fn d(&self, wm: LocalDir) -> f32 {
        let (x, y) = (wm.x / self.alpha_x, wm.y / self.alpha_y);
        let s = x * x + y * y + wm.z * wm.z;
        1.0 / (PI * self.alpha_x * self.alpha_y * s * s)
    }

    /// Smith's Λ: ratio of the hidden to the visible projected area, Heitz 2014, eq. 72. Infinite at grazing.
    pub fn lambda(&self, w: LocalDir) -> f32 {
        0.5 * (self.stretched_length(w) / w.abs_cos_theta() - 1.0)
    }

    /// Share of the facets that `w` sees, 1 / (1 + Λ), Heitz 2014, eq. 43. Zero at grazing.
    pub fn g1(&self, w: LocalDir) -> f32 {
        self.g1_over_cos(w) * w.abs_cos_theta()
    }

    /// Share of the facets visible from both directions, height-correlated, 1 / (1 + Λo + Λi), Heitz 2014,
    /// eq. 99. Zero when either grazes.
    pub fn g(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        self.g_over_cosines(wo, wi) * (wo.z * wi.z).abs()
    }

    /// G1 / |cosθ|, finite at grazing.
    pub fn g1_over_cos(&self, w: LocalDir) -> f32 {
        2.0 / (w.abs_cos_theta() + self.stretched_length(w))
    }

    /// G / |cosθo cosθi|, finite unless both directions graze.
    pub fn g_over_cosines(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        2.0 / (wi.abs_cos_theta() * self.stretched_length(wo)
            + wo.abs_cos_theta() * self.stretched_length(wi))
    }

    /// G / G1(wo): what is left of a direction drawn from the visible normals of `wo`. `wi` must not graze.
    pub fn g_over_g1(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let (o, i) = (wo.abs_cos_theta(), wi.abs_cos_theta());
        let length = self.stretched_length(wo);
        i * (o + length) / (i * length + o * self.stretched_length(wi))
    }

    /// Density [sr⁻¹] of the facet normals that `w` sees: G1(w) |w·wm| D(wm) / |cosθ|, Heitz 2014, eq. 16.
    pub fn visible_pdf(&self, w: LocalDir, wm: LocalDir) -> f32 {
        self.g1_over_cos(w) * self.d(wm) * w.dot(*wm).abs()
    }

    /// |cosθ| √(1 + α² tan²θ), in a form that does not divide.
    fn stretched_length(&self, w: LocalDir) -> f32 {
        let (x, y) = (w.x * self.alpha_x, w.y * self.alpha_y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// A facet normal, in the upper hemisphere, with density [`TrowbridgeReitz::visible_pdf`] in u ∈ [0, 1)²;
    /// `w` may lie on either side and is seen from above (Dupuy & Benyoub 2023, listing 1).
    pub fn sample_visible(&self, w: LocalDir, u: Vec2) -> LocalDir {
        let w = if w.z < 0.0 { -*w } else { *w };
        let stretched = Vec3::new(w.x * self.alpha_x, w.y * self.alpha_y, w.z);
        let stretched = stretched * stretched.length_recip();
        let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.x).sin_cos();
        let h = Vec3::new(r * cos_phi, r * sin_phi, z) + stretched;
        // z ≥ 0 but for rounding; the floor keeps a normal at the rim of the hemisphere usable.
        let wm = Vec3::new(h.x * self.alpha_x, h.y * self.alpha_y, h.z.max(1e-6));
        LocalDir::new_unchecked(wm * wm.length_recip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;

    const WIDTHS: [(f32, f32); 4] = [(0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (0.2, 0.6)];

    fn dir(theta: f32, phi: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(theta.to_radians(), phi.to_radians()))
    }

    /// ∫ over the upper hemisphere by the midpoint rule, dense towards the pole where D peaks.
    fn hemisphere_integral(f: impl Fn(LocalDir) -> f32) -> f64 {
        let (nt, np) = (600, 240);
        let mut sum = 0.0;
        for i in 0..nt {
            // θ = (π/2) x²: dθ = π x dx.
            let x = (i as f32 + 0.5) / nt as f32;
            let theta = std::f32::consts::FRAC_PI_2 * x * x;
            let dtheta = PI * x / nt as f32;
            for j in 0..np {
                let phi = TAU * (j as f32 + 0.5) / np as f32;
                let w = LocalDir::new_unchecked(warp::spherical_direction(theta, phi));
                sum += f64::from(f(w) * theta.sin() * dtheta * TAU / np as f32);
            }
        }
        sum
    }

    #[test]
    fn projected_facet_area_is_the_macroscopic_area() {
        for (ax, ay) in WIDTHS {
            let d = TrowbridgeReitz::new(ax, ay);
            let area = hemisphere_integral(|wm| d.d(wm) * wm.z);
            assert!((area - 1.0).abs() < 1e-3, "{ax} {ay}: {area}");
        }
    }

    #[test]
    fn visible_facets_project_to_the_macroscopic_area_and_their_density_to_one() {
        for (ax, ay) in WIDTHS {
            let d = TrowbridgeReitz::new(ax, ay);
            for theta in [0.0, 40.0, 75.0] {
                let w = dir(theta, 30.0);
                let mass =
                    hemisphere_integral(|wm| if w.dot(*wm) > 0.0 { d.visible_pdf(w, wm) } else { 0.0 });
                assert!((mass - 1.0).abs() < 2e-3, "{ax} {ay} {theta}: {mass}");
            }
        }
    }

    #[test]
    fn weak_white_furnace_holds() {
        // Heitz 2014, eq. 85: without shadowing of the outgoing ray a mirror facet surface loses nothing.
        for (ax, ay) in WIDTHS {
            let d = TrowbridgeReitz::new(ax, ay);
            let w = dir(55.0, 20.0);
            let n = 400;
            let mut sum = 0.0_f64;
            for i in 0..n * n {
                let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                let wm = d.sample_visible(w, u);
                // G1 D / (4 cos) over the density of the reflected direction is one for each visible facet.
                let f = d.g1(w) * d.d(wm) / (4.0 * w.abs_cos_theta());
                sum += f64::from(f / (d.visible_pdf(w, wm) / (4.0 * w.dot(*wm).abs())));
            }
            assert!((sum / f64::from(n * n) - 1.0).abs() < 1e-4, "{ax} {ay}");
        }
    }

    #[test]
    fn sampled_facets_follow_the_visible_density() {
        use statrs::distribution::{ChiSquared, ContinuousCDF};
        for (ax, ay) in WIDTHS {
            let d = TrowbridgeReitz::new(ax, ay);
            for w in [dir(0.0, 0.0), dir(60.0, 50.0), dir(140.0, 200.0)] {
                // Cells in u = (r², φ) of the tangent of the stretched facet: D is nearly uniform there.
                let (nr, np, n) = (10, 12, 40_000);
                let mut counts = vec![0.0_f64; nr * np];
                let cell = |wm: LocalDir| {
                    let (x, y) = (wm.x / ax / wm.z, wm.y / ay / wm.z);
                    let t2 = x * x + y * y;
                    let r = ((t2 / (1.0 + t2)) * nr as f32) as usize;
                    let phi = (y.atan2(x) / TAU).rem_euclid(1.0);
                    r.min(nr - 1) * np + ((phi * np as f32) as usize).min(np - 1)
                };
                let mut rng = crate::math::hash::Pcg32::new(7, 1);
                for _ in 0..n {
                    let u = Vec2::new(rng.next_f32(), rng.next_f32());
                    counts[cell(d.sample_visible(w, u))] += 1.0;
                }
                let up = if w.z < 0.0 { -w } else { w };
                let fine = 24;
                let mut expected = vec![0.0_f64; nr * np];
                for i in 0..nr * fine {
                    for j in 0..np * fine {
                        let s = (i as f64 + 0.5) / (nr * fine) as f64;
                        let phi = std::f64::consts::TAU * (j as f64 + 0.5) / (np * fine) as f64;
                        let t = (s / (1.0 - s)).sqrt();
                        let v = Vec3::new((t * phi.cos()) as f32 * ax, (t * phi.sin()) as f32 * ay, 1.0);
                        let wm = LocalDir::new(v).unwrap();
                        // dω = cos³θ dA on the plane z = 1; dA = αx αy t dt dφ; t dt = ds / (2 (1−s)²).
                        let cos = f64::from(wm.z);
                        let da = f64::from(ax * ay) * 0.5 / ((1.0 - s) * (1.0 - s));
                        let du = std::f64::consts::TAU / (nr * np * fine * fine) as f64;
                        if up.dot(*wm) > 0.0 {
                            expected[i / fine * np + j / fine] +=
                                f64::from(d.visible_pdf(up, wm)) * cos.powi(3) * da * du * f64::from(n);
                        }
                    }
                }
                let (mut statistic, mut cells) = (0.0, 0);
                let (mut rest_c, mut rest_e) = (0.0, 0.0);
                for (c, e) in counts.iter().zip(&expected) {
                    if *e < 5.0 {
                        rest_c += c;
                        rest_e += e;
                    } else {
                        statistic += (c - e) * (c - e) / e;
                        cells += 1;
                    }
                }
                if rest_e > 0.0 {
                    statistic += (rest_c - rest_e) * (rest_c - rest_e) / rest_e.max(1.0);
                    cells += 1;
                }
                // 12 tests at a joint level of 1 %.
                let p = 1.0 - ChiSquared::new(f64::from(cells - 1)).unwrap().cdf(statistic);
                assert!(
                    p > 0.01 / 12.0,
                    "{ax} {ay} {w:?}: χ² = {statistic:.1} over {cells} cells, p = {p:.2e}"
                );
            }
        }
    }
}
