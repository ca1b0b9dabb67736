//! Warps from the unit square to the domains that light transport integrates over, with their densities.
//!
//! Every `x(u)` has an `x_pdf`; `u` lies in [0, 1)².

use super::float::safe_sqrt;
use super::vector::{LocalDir, Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Uniform on the unit disk, concentric map (Shirley & Chiu 1997). Density 1/π per unit area.
#[inline(always)]
pub fn concentric_disk(u: Vec2) -> Vec2 {
    let o = 2.0 * u - Vec2::ONE;
    if o == Vec2::ZERO {
        return Vec2::ZERO;
    }
    // Chosen without a branch, which a processor would guess wrongly every other time.
    let flat = o.x.abs() > o.y.abs();
    let (long, short) = if flat { (o.x, o.y) } else { (o.y, o.x) };
    let (sin, cos) = sin_cos_of_eighth(FRAC_PI_4 * (short / long));
    let (along, across) = (long * cos, long * sin);
    // About the other axis the angle is π/2 less this one.
    if flat { Vec2::new(along, across) } else { Vec2::new(across, along) }
}

/// Sine and cosine for |x| ≤ π/4 by their power series, to 3·10⁻⁸, without a call.
#[inline(always)]
fn sin_cos_of_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin = 1.0 / 6.0 - x2 * (1.0 / 120.0 - x2 * (1.0 / 5040.0 - x2 * (1.0 / 362_880.0)));
    let cos = 0.5 - x2 * (1.0 / 24.0 - x2 * (1.0 / 720.0 - x2 * (1.0 / 40_320.0)));
    (x - x * x2 * sin, 1.0 - x2 * cos)
}

/// Uniform on the unit disk, polar map: keeps u.y proportional to the angle.
pub fn polar_disk(u: Vec2) -> Vec2 {
    let (r, theta) = (u.x.sqrt(), TAU * u.y);
    r * Vec2::new(theta.cos(), theta.sin())
}

/// Cosine-weighted on the upper hemisphere: a concentric disk lifted (Malley); B (2.37), (2.48), (2.49).
#[inline(always)]
pub fn cosine_hemisphere(u: Vec2) -> LocalDir {
    let d = concentric_disk(u);
    LocalDir::new_unchecked(Vec3::new(d.x, d.y, safe_sqrt(1.0 - d.length_squared())))
}

/// cosθ/π [sr⁻¹] on the upper hemisphere, B (2.37).
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Uniform on the unit sphere.
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = safe_sqrt(1.0 - z * z);
    let phi = TAU * u.y;
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// 1/4π [sr⁻¹].
pub const UNIFORM_SPHERE_PDF: f32 = FRAC_1_PI * 0.25;

/// Uniform within a cone around +z, given 1 − cos of its half angle (accurate for tiny cones).
pub fn uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    let one_minus_cos = u.x * one_minus_cos_max;
    let sin = safe_sqrt(one_minus_cos * (2.0 - one_minus_cos));
    let phi = TAU * u.y;
    Vec3::new(sin * phi.cos(), sin * phi.sin(), 1.0 - one_minus_cos)
}

/// 1/(2π(1 − cosθmax)) [sr⁻¹] inside the cone, A (13).
pub fn uniform_cone_pdf(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}

/// Barycentric coordinates uniform over a triangle, low distortion (Heitz 2019).
#[inline]
pub fn uniform_triangle(u: Vec2) -> [f32; 3] {
    let (b0, b1) = if u.x < u.y {
        let b0 = u.x * 0.5;
        (b0, u.y - b0)
    } else {
        let b1 = u.y * 0.5;
        (u.x - b1, b1)
    };
    [b0, b1, (1.0 - b0 - b1).max(0.0)]
}

/// Distance to an exponential event with rate `a` [1/length].
pub fn exponential(u: f32, a: f32) -> f32 {
    -(-u).ln_1p() / a
}

/// Position on [0, 1] with density proportional to the linear ramp from `a` to `b` (both ≥ 0).
pub fn linear(u: f32, a: f32, b: f32) -> f32 {
    if u == 0.0 && a == 0.0 {
        return 0.0;
    }
    let x = u * (a + b) / (a + (a * a * (1.0 - u) + b * b * u).sqrt());
    x.min(super::float::ONE_MINUS_EPSILON)
}

/// Density of [`linear`] at x.
pub fn linear_pdf(x: f32, a: f32, b: f32) -> f32 {
    if (0.0..=1.0).contains(&x) { 2.0 * super::float::lerp(x, a, b) / (a + b) } else { 0.0 }
}

/// Point of the unit square with density proportional to the bilinear patch with corner weights
/// w = [(0,0), (1,0), (0,1), (1,1)].
pub fn bilinear(u: Vec2, w: [f32; 4]) -> Vec2 {
    let y = linear(u.y, w[0] + w[1], w[2] + w[3]);
    let x = linear(u.x, super::float::lerp(y, w[0], w[2]), super::float::lerp(y, w[1], w[3]));
    Vec2::new(x, y)
}

/// Density of [`bilinear`] at p.
pub fn bilinear_pdf(p: Vec2, w: [f32; 4]) -> f32 {
    if !(0.0..=1.0).contains(&p.x) || !(0.0..=1.0).contains(&p.y) {
        return 0.0;
    }
    let sum: f32 = w.iter().sum();
    if sum == 0.0 {
        return 1.0;
    }
    let (x, y) = (p.x, p.y);
    let patch = (1.0 - x) * (1.0 - y) * w[0] + x * (1.0 - y) * w[1] + (1.0 - x) * y * w[2] + x * y * w[3];
    4.0 * patch / sum
}

/// Direction of an equal-area octahedral square (Clarberg 2008), z up; `p` in [0, 1]².
pub fn equal_area_square_to_sphere(p: Vec2) -> Vec3 {
    let (u, v) = (2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
    let (up, vp) = (u.abs(), v.abs());
    let signed_distance = 1.0 - (up + vp);
    let d = signed_distance.abs();
    let r = 1.0 - d;
    let phi = if r == 0.0 { 1.0 } else { (vp - up) / r + 1.0 } * FRAC_PI_4;
    let z = (1.0 - r * r).copysign(signed_distance);
    let s = r * safe_sqrt(2.0 - r * r);
    Vec3::new((phi.cos() * s).copysign(u), (phi.sin() * s).copysign(v), z)
}

/// Inverse of [`equal_area_square_to_sphere`]; `d` is a unit vector.
pub fn equal_area_sphere_to_square(d: Vec3) -> Vec2 {
    let (x, y, z) = (d.x.abs(), d.y.abs(), d.z.abs());
    let r = safe_sqrt(1.0 - z);
    let phi = if x == 0.0 && y == 0.0 { 0.0 } else { y.atan2(x) / FRAC_PI_2 };
    let v = phi * r;
    let u = r - v;
    let (u, v) = if d.z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
    Vec2::new((u.copysign(d.x) + 1.0) * 0.5, (v.copysign(d.y) + 1.0) * 0.5)
}

/// Unit vector from spherical angles [rad], θ from +z, φ from +x towards +y; A (9).
pub fn spherical_direction(theta: f32, phi: f32) -> Vec3 {
    let (st, ct) = theta.sin_cos();
    let (sp, cp) = phi.sin_cos();
    Vec3::new(st * cp, st * sp, ct)
}

/// (θ, φ) of a unit vector, θ in [0, π], φ in [0, 2π).
pub fn spherical_angles(d: Vec3) -> (f32, f32) {
    let phi = d.y.atan2(d.x);
    let theta = d.x.hypot(d.y).atan2(d.z);
    (theta.clamp(0.0, PI), if phi < 0.0 { (phi + TAU).min(TAU.next_down()) } else { phi })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: u32) -> impl Iterator<Item = Vec2> {
        (0..n * n).map(move |i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32)
    }

    #[test]
    fn the_series_agree_with_the_library() {
        for i in -1000..=1000 {
            let x = FRAC_PI_4 * i as f32 / 1000.0;
            let ((sin, cos), exact) = (sin_cos_of_eighth(x), f64::from(x).sin_cos());
            assert!(
                (f64::from(sin) - exact.0).abs() < 1e-7 && (f64::from(cos) - exact.1).abs() < 1e-7,
                "{x}"
            );
        }
    }

    #[test]
    fn cosine_hemisphere_has_the_moments_of_its_density() {
        let n = 256;
        let (mut z, mut z2) = (0.0_f64, 0.0_f64);
        for u in grid(n) {
            let d = cosine_hemisphere(u);
            z += f64::from(d.z);
            z2 += f64::from(d.z * d.z);
        }
        let count = f64::from(n * n);
        // E[cos] = 2/3, E[cos²] = 1/2 under cos/π; cos has a square-root edge at the rim of the disk,
        // so the midpoint grid errs by O(n^(-3/2)) = 2.4e-4.
        assert!((z / count - 2.0 / 3.0).abs() < 5e-4 && (z2 / count - 0.5).abs() < 1e-4, "{z} {z2}");
    }

    #[test]
    fn equal_area_map_inverts_and_preserves_area() {
        let n = 128;
        let mut mean = Vec3::ZERO;
        for u in grid(n) {
            let d = equal_area_square_to_sphere(u);
            assert!((d.length() - 1.0).abs() < 1e-5);
            assert!((equal_area_sphere_to_square(d) - u).length() < 1e-4, "{u:?}");
            mean += Vec3::new(d.z * d.z, d.x * d.x, d.z.max(0.0)) / (n * n) as f32;
        }
        assert!((mean - Vec3::new(1.0 / 3.0, 1.0 / 3.0, 0.25)).abs().max_element() < 1e-3, "{mean:?}");
    }

    #[test]
    fn ramps_and_patches_integrate_to_one_and_follow_their_density() {
        let w = [0.2, 1.0, 3.0, 0.0];
        let n = 200;
        let mass: f32 = grid(n).map(|p| bilinear_pdf(p, w)).sum::<f32>() / (n * n) as f32;
        assert!((mass - 1.0).abs() < 1e-4);
        // E[x y] of the samples against the same moment of the density.
        let sampled: f32 = grid(n).map(|u| bilinear(u, w)).map(|p| p.x * p.y).sum::<f32>() / (n * n) as f32;
        let exact: f32 = grid(n).map(|p| p.x * p.y * bilinear_pdf(p, w)).sum::<f32>() / (n * n) as f32;
        assert!((sampled - exact).abs() < 1e-4, "{sampled} {exact}");
    }

    #[test]
    fn spherical_angles_invert() {
        for u in grid(40) {
            let d = uniform_sphere(u);
            let (theta, phi) = spherical_angles(d);
            assert!((spherical_direction(theta, phi) - d).length() < 1e-5);
        }
    }
}
