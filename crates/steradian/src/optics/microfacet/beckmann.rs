//! The Beckmann distribution of microfacet normals: Gaussian slopes.

use super::distribution::{Distribution, Widths};
use crate::math::{LocalDir, Vec2, Vec3};
use std::f32::consts::PI;

/// 1/√π.
const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

/// erf is told from ±1 by f32 up to here.
const LARGEST_ERF: f32 = 1.0 - f32::EPSILON;

/// Microfacets whose slopes are Gaussian (Beckmann & Spizzichino 1963; Walter et al. 2007, eq. 25), with Smith's exact Λ
/// and height-correlated shadowing (Heitz 2014, 5.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beckmann {
    widths: Widths,
}

impl Beckmann {
    /// No microfacets: a smooth interface.
    pub const SMOOTH: Self = Self { widths: Widths::SMOOTH };

    /// A distribution whose slopes have the standard deviations `alpha_x`/√2, `alpha_y`/√2 ≥ 0 along the axes of the
    /// shading frame.
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        Self { widths: Widths::new(alpha_x, alpha_y) }
    }
}

impl Distribution for Beckmann {
    fn alpha(&self) -> [f32; 2] {
        [self.widths.x, self.widths.y]
    }

    fn is_smooth(&self) -> bool {
        self.widths.is_smooth()
    }

    fn regularized(self) -> Self {
        Self { widths: self.widths.regularized() }
    }

    fn d(&self, wm: LocalDir) -> f32 {
        let (x, y) = (wm.x / self.widths.x, wm.y / self.widths.y);
        let cos2 = wm.z * wm.z;
        let exponent = (x * x + y * y) / cos2;
        // There e^−x has long won against cos⁻⁴θ, which overflows at the horizon.
        if exponent > 80.0 {
            return 0.0;
        }
        (-exponent).exp() / (PI * self.widths.x * self.widths.y * cos2 * cos2)
    }

    /// With a = 1/(α tanθ): 1 + Λ = ½ (1 + erf a + e^(−a²) / (a √π)), Heitz 2014, eq. 68, times |cosθ|.
    fn facing_area(&self, w: LocalDir) -> f32 {
        let (x, y) = (w.x * self.widths.x, w.y * self.widths.y);
        facing_area(w.abs_cos_theta(), (x * x + y * y).sqrt())
    }

    /// Slopes of unit width are drawn for the stretched direction and then squeezed (Heitz & d'Eon 2014).
    fn sample_visible(&self, w: LocalDir, u: Vec2) -> LocalDir {
        let w = if w.z < 0.0 { -*w } else { *w };
        let stretched = Vec3::new(w.x * self.widths.x, w.y * self.widths.y, w.z);
        let stretched = stretched * stretched.length_recip();
        let sin2 = stretched.x * stretched.x + stretched.y * stretched.y;
        let sin = sin2.sqrt();
        // Along the normal every azimuth is as good.
        let (cos_phi, sin_phi) = if sin > 0.0 { (stretched.x / sin, stretched.y / sin) } else { (1.0, 0.0) };
        let along = visible_slope(stretched.z, sin, u.x);
        let across = inverse_erf((2.0 * u.y - 1.0).clamp(-LARGEST_ERF, LARGEST_ERF));
        let x = cos_phi * along - sin_phi * across;
        let y = sin_phi * along + cos_phi * across;
        let wm = Vec3::new(-x * self.widths.x, -y * self.widths.y, 1.0);
        LocalDir::new_unchecked(wm * wm.length_recip())
    }
}

/// [`Distribution::facing_area`] for unit width, with the cosine and sine of a direction of any length.
fn facing_area(cos: f32, sin: f32) -> f32 {
    if sin == 0.0 {
        return cos;
    }
    let (erf, gauss) = erf_and_gauss(cos / sin);
    0.5 * (cos * (1.0 + erf) + sin * FRAC_1_SQRT_PI * gauss)
}

/// The slope x, towards a unit direction at (sinθ, 0, cosθ), of a facet that it sees: below cotθ, with density in
/// proportion to (cosθ − x sinθ) e^(−x²), which u ∈ [0, 1) inverts.
///
/// Up to a factor ½ the integral is cosθ (1 + erf x) + sinθ e^(−x²)/√π; as a function of erf x it has the slope
/// cosθ − x sinθ, so that Newton's steps need no more transcendentals (Jakob 2014). A bracket keeps them from leaving.
fn visible_slope(cos: f32, sin: f32, u: f32) -> f32 {
    let gauss_factor = sin * FRAC_1_SQRT_PI;
    let (erf_max, gauss_max) = if sin > 0.0 { erf_and_gauss(cos / sin) } else { (1.0, 0.0) };
    let total = cos * (1.0 + erf_max) + gauss_factor * gauss_max;
    let target = u * total;
    let (mut low, mut high) = (-LARGEST_ERF, erf_max.min(LARGEST_ERF));
    // Exact for perpendicular incidence, where erf x is uniform, and close at grazing, where e^(−x²) is.
    let mut b = low + (high - low) * (1.0 - (1.0 - u).powf(0.4 + 0.6 * cos));
    let mut x = inverse_erf(b);
    // Four steps as a rule; bisection alone exhausts the digits of f32 in 24.
    for _ in 0..24 {
        let excess = cos * (1.0 + b) + gauss_factor * (-x * x).exp() - target;
        if excess.abs() <= 5e-7 * total {
            break;
        }
        if excess > 0.0 {
            high = b;
        } else {
            low = b;
        }
        b -= excess / (cos - x * sin);
        if !(low < b && b < high) {
            b = 0.5 * (low + high);
        }
        x = inverse_erf(b);
    }
    x
}

/// The error function and e^(−x²) for x ≥ 0 (Abramowitz & Stegun 7.1.26: absolute error below 1.5e-7).
fn erf_and_gauss(x: f32) -> (f32, f32) {
    const P: f32 = 0.327_591_1;
    const A: [f32; 5] = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let t = 1.0 / (1.0 + P * x);
    let polynomial = A.iter().rev().fold(0.0, |sum, &a| (sum + a) * t);
    let gauss = (-x * x).exp();
    (1.0 - polynomial * gauss, gauss)
}

/// The inverse of the error function for |x| < 1 (Giles 2010, table 5: relative error below 4e-7 but for rounding of x).
fn inverse_erf(x: f32) -> f32 {
    const CENTRAL: [f32; 9] = [
        1.501_409_41,
        0.246_640_727,
        -0.004_177_681_64,
        -0.001_253_725_03,
        0.000_218_580_87,
        -4.391_506_54e-6,
        -3.523_387_7e-6,
        3.432_739_39e-7,
        2.810_226_36e-8,
    ];
    const TAIL: [f32; 9] = [
        2.832_976_82,
        1.001_674_06,
        0.009_438_870_47,
        -0.007_622_461_3,
        0.005_739_507_73,
        -0.003_673_428_44,
        0.001_349_343_22,
        0.000_100_950_558,
        -0.000_200_214_257,
    ];
    let horner = |c: &[f32; 9], w: f32| c.iter().rev().fold(0.0, |sum, &c| sum * w + c);
    let w = -((1.0 - x) * (1.0 + x)).ln();
    x * if w < 5.0 { horner(&CENTRAL, w - 2.5) } else { horner(&TAIL, w.sqrt() - 3.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf::erf;

    #[test]
    fn error_function_agrees_with_f64() {
        for i in 0..=500 {
            let x = i as f32 * 0.01;
            assert!((f64::from(erf_and_gauss(x).0) - erf(f64::from(x))).abs() < 4e-7, "{x}");
        }
    }

    #[test]
    fn inverse_error_function_inverts_the_error_function() {
        for i in -999..=999 {
            let y = i as f32 * 0.001;
            assert!((erf(f64::from(inverse_erf(y))) - f64::from(y)).abs() < 4e-7, "{y}");
        }
        for y in [1.0 - 1e-5_f32, 1.0 - 1e-6, LARGEST_ERF] {
            let (found, expected) = (1.0 - erf(f64::from(inverse_erf(y))), 1.0 - f64::from(y));
            assert!((found / expected - 1.0).abs() < 1e-4, "{y}: {found} {expected}");
        }
    }

    #[test]
    fn visible_slopes_invert_their_distribution_up_to_grazing() {
        for degrees in [0.0_f64, 1e-4, 0.1, 10.0, 45.0, 80.0, 89.0, 89.9, 89.9999, 90.0] {
            let (s, c) = degrees.to_radians().sin_cos();
            let c = c.max(0.0);
            let integral = |x: f64| c * (1.0 + erf(x)) + s * (-x * x).exp() / std::f64::consts::PI.sqrt();
            let total = if s > 0.0 { integral(c / s) } else { 2.0 };
            for i in 0..1000 {
                let u = (i as f32 + 0.5) / 1000.0;
                let x = f64::from(visible_slope(c as f32, s as f32, u));
                assert!(x * s <= c + 1e-3, "{degrees} {u}: {x}");
                assert!((integral(x) / total - f64::from(u)).abs() < 3e-6, "{degrees} {u}: {x}");
            }
        }
    }

    #[test]
    fn slopes_seen_along_the_normal_are_gaussian_out_to_their_tails() {
        use crate::math::hash::Pcg32;
        use statrs::distribution::{ChiSquared, ContinuousCDF};
        // tan²θ/α² of two Gaussian slopes is exponential with mean 1 (D cosθ dω over tanθ): cells of equal probability,
        // and four of the tail, each a tenth of the one before.
        let n = 1_000_000_u32;
        let mut edges: Vec<f64> = (1..50).map(|i| f64::from(i) / 50.0).collect();
        edges.extend([0.99, 0.999, 0.9999, 0.99999]);
        for alpha in [0.01_f32, 0.1, 1.0] {
            let d = Beckmann::new(alpha, alpha);
            let mut rng = Pcg32::new(11, 3);
            let mut counts = vec![0_u32; edges.len() + 1];
            for _ in 0..n {
                let u = Vec2::new(rng.next_f32(), rng.next_f32());
                let wm = d.sample_visible(LocalDir::Z, u);
                let slope = f64::from(wm.x).hypot(f64::from(wm.y)) / f64::from(wm.z) / f64::from(alpha);
                let cdf = -(-slope * slope).exp_m1();
                counts[edges.partition_point(|&e| e <= cdf)] += 1;
            }
            let mut low = 0.0;
            let mut statistic = 0.0;
            for (count, high) in counts.iter().zip(edges.iter().copied().chain([1.0])) {
                let expected = (high - low) * f64::from(n);
                statistic += (f64::from(*count) - expected).powi(2) / expected;
                low = high;
            }
            // Three tests at a joint level of 1 %.
            let p = 1.0 - ChiSquared::new(edges.len() as f64).unwrap().cdf(statistic);
            assert!(p > 0.01 / 3.0, "{alpha}: χ² = {statistic:.1}, p = {p:.2e}");
        }
    }

    #[test]
    fn lambda_is_the_exact_one() {
        // Λ(a) = ½ (erf a − 1 + e^(−a²)/(a√π)) in f64, at 1/tanθ = a.
        for a in [0.01_f64, 0.1, 0.5, 1.0, 1.6, 3.0] {
            let lambda = 0.5 * (erf(a) - 1.0 + (-a * a).exp() / (a * std::f64::consts::PI.sqrt()));
            let norm = (1.0 + a * a).sqrt();
            let area = facing_area((a / norm) as f32, (1.0 / norm) as f32);
            let expected = a / norm * (1.0 + lambda);
            assert!((f64::from(area) / expected - 1.0).abs() < 1e-6, "{a}");
        }
    }
}
