//! Distributions of microfacet normals, and what single scattering by them loses.

mod beckmann;
mod distribution;
mod trowbridge_reitz;

pub use beckmann::Beckmann;
pub use distribution::Distribution;
pub use trowbridge_reitz::TrowbridgeReitz;

use crate::math::{LocalDir, Vec2};

/// The shape of a distribution, without its widths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FacetShape {
    /// Trowbridge & Reitz 1975, known as GGX: long tails.
    #[default]
    TrowbridgeReitz,
    /// Gaussian slopes.
    Beckmann,
}

/// A distribution of either shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Microfacets {
    /// Long tails.
    TrowbridgeReitz(TrowbridgeReitz),
    /// Gaussian slopes.
    Beckmann(Beckmann),
}

impl Microfacets {
    /// No microfacets: a smooth interface.
    pub const SMOOTH: Self = Self::TrowbridgeReitz(TrowbridgeReitz::SMOOTH);

    /// A distribution with slope widths `alpha_x`, `alpha_y` ≥ 0 along the axes of the shading frame.
    pub fn new(shape: FacetShape, alpha_x: f32, alpha_y: f32) -> Self {
        match shape {
            FacetShape::TrowbridgeReitz => Self::TrowbridgeReitz(TrowbridgeReitz::new(alpha_x, alpha_y)),
            FacetShape::Beckmann => Self::Beckmann(Beckmann::new(alpha_x, alpha_y)),
        }
    }
}

impl Distribution for Microfacets {
    fn alpha(&self) -> [f32; 2] {
        match self {
            Self::TrowbridgeReitz(d) => d.alpha(),
            Self::Beckmann(d) => d.alpha(),
        }
    }

    fn is_smooth(&self) -> bool {
        match self {
            Self::TrowbridgeReitz(d) => d.is_smooth(),
            Self::Beckmann(d) => d.is_smooth(),
        }
    }

    fn regularized(self) -> Self {
        match self {
            Self::TrowbridgeReitz(d) => Self::TrowbridgeReitz(d.regularized()),
            Self::Beckmann(d) => Self::Beckmann(d.regularized()),
        }
    }

    fn d(&self, wm: LocalDir) -> f32 {
        match self {
            Self::TrowbridgeReitz(d) => d.d(wm),
            Self::Beckmann(d) => d.d(wm),
        }
    }

    fn facing_area(&self, w: LocalDir) -> f32 {
        match self {
            Self::TrowbridgeReitz(d) => d.facing_area(w),
            Self::Beckmann(d) => d.facing_area(w),
        }
    }

    fn sample_visible(&self, w: LocalDir, u: Vec2) -> LocalDir {
        match self {
            Self::TrowbridgeReitz(d) => d.sample_visible(w, u),
            Self::Beckmann(d) => d.sample_visible(w, u),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Vec3, warp};
    use std::f32::consts::{PI, TAU};

    const WIDTHS: [(f32, f32); 4] = [(0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (0.2, 0.6)];

    fn all() -> impl Iterator<Item = (Microfacets, f32, f32)> {
        [FacetShape::TrowbridgeReitz, FacetShape::Beckmann].into_iter().flat_map(|shape| {
            WIDTHS.into_iter().map(move |(ax, ay)| (Microfacets::new(shape, ax, ay), ax, ay))
        })
    }

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
        for (d, _, _) in all() {
            let area = hemisphere_integral(|wm| d.d(wm) * wm.z);
            assert!((area - 1.0).abs() < 1e-3, "{d:?}: {area}");
        }
    }

    #[test]
    fn visible_facets_project_to_the_macroscopic_area_and_their_density_to_one() {
        for (d, _, _) in all() {
            for theta in [0.0, 40.0, 75.0] {
                let w = dir(theta, 30.0);
                let mass =
                    hemisphere_integral(|wm| if w.dot(*wm) > 0.0 { d.visible_pdf(w, wm) } else { 0.0 });
                assert!((mass - 1.0).abs() < 2e-3, "{d:?} {theta}: {mass}");
            }
        }
    }

    #[test]
    fn weak_white_furnace_holds() {
        // Heitz 2014, eq. 85: without shadowing of the outgoing ray a mirror facet surface loses nothing.
        for (d, _, _) in all() {
            let w = dir(55.0, 20.0);
            let n = 400;
            let mut sum = 0.0_f64;
            for i in 0..n * n {
                let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                let wm = d.sample_visible(w, u);
                // G1 D / (4 cos) over the density of the reflected direction is one for each visible facet.
                let f = 0.25 * d.g1_over_cos(w) * d.d(wm);
                sum += f64::from(f / (d.visible_pdf(w, wm) / (4.0 * w.dot(*wm).abs())));
            }
            assert!((sum / f64::from(n * n) - 1.0).abs() < 1e-4, "{d:?}");
        }
    }

    #[test]
    fn sampled_facets_follow_the_visible_density() {
        use statrs::distribution::{ChiSquared, ContinuousCDF};
        for (d, ax, ay) in all() {
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
                // 24 tests at a joint level of 1 %.
                let p = 1.0 - ChiSquared::new(f64::from(cells - 1)).unwrap().cdf(statistic);
                assert!(p > 0.01 / 24.0, "{d:?} {w:?}: χ² = {statistic:.1} over {cells} cells, p = {p:.2e}");
            }
        }
    }
}
