//! Powers of a cosine about an axis: the lobe of every Phong model and of its sampling.

use crate::math::float::{ONE_MINUS_EPSILON, safe_sqrt};
use crate::math::{Frame, LocalDir, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// m = 2(n·w)n − w, A 12.5.3.
pub(super) fn mirrored(w: LocalDir) -> LocalDir {
    LocalDir::new_unchecked(Vec3::new(-w.x, -w.y, w.z))
}

/// cosⁿα where α ∈ [0, 90°) is the angle between two unit vectors, else zero.
///
/// From the vectors' difference, |a − b|² = 2(1 − cosα): the product a·b of f32 knows no angle below 10⁻³ rad.
pub(super) fn power(a: Vec3, b: Vec3, n: f32) -> f32 {
    let versine = 0.5 * (a - b).length_squared();
    if versine < 1.0 { (n * (-versine).ln_1p()).exp() } else { 0.0 }
}

/// cosⁿ(α/2) over the whole sphere α ∈ [0, 180°].
pub(super) fn half_angle_power(a: Vec3, b: Vec3, n: f32) -> f32 {
    // cos²(α/2) = 1 − |a − b|²/4.
    let s = (0.25 * (a - b).length_squared()).min(ONE_MINUS_EPSILON);
    (0.5 * n * (-s).ln_1p()).exp()
}

/// (n + 1)/(2π), which makes cosⁿα a density over the hemisphere about its axis, B (2.36).
pub(super) fn density_scale(n: f32) -> f32 {
    (n + 1.0) / TAU
}

/// (n + 2)/(8π), which makes cosⁿ(α/2) a density over the sphere, B (2.38).
pub(super) fn half_angle_density_scale(n: f32) -> f32 {
    (n + 2.0) / (8.0 * PI)
}

/// A direction about `axis` with the density of B (2.36): cosα = (1 − ξ₁)^(1/(n+1)), β = 2πξ₂, B (2.47).
pub(super) fn sample(axis: LocalDir, n: f32, u: Vec2) -> Option<LocalDir> {
    // 1 − cosα, without rounding near the axis.
    around(axis, -((-u.x).ln_1p() / (n + 1.0)).exp_m1(), u.y)
}

/// A direction about `axis` with the density of B (2.38): cos(α/2) = (1 − ξ₁)^(1/(n+2)), β = 2πξ₂.
pub(super) fn sample_half_angle(axis: LocalDir, n: f32, u: Vec2) -> Option<LocalDir> {
    // 1 − cosα = 2 (1 − cos²(α/2)).
    around(axis, -2.0 * (2.0 * (-u.x).ln_1p() / (n + 2.0)).exp_m1(), u.y)
}

/// The exponent of a lobe that is widened against fireflies, as a microfacet width √(2/(n + 2)) of the same breadth would be.
pub(super) fn widened(n: f32) -> f32 {
    let alpha = (2.0 / (n + 2.0)).sqrt();
    if alpha >= 0.3 {
        return n;
    }
    let wider = (2.0 * alpha).clamp(0.1, 0.3);
    2.0 / (wider * wider) - 2.0
}

/// `None` where rounding leaves no direction.
fn around(axis: LocalDir, versine: f32, u: f32) -> Option<LocalDir> {
    let sin = safe_sqrt(versine * (2.0 - versine));
    let phi = TAU * u;
    let frame = Frame::from_z(axis);
    LocalDir::new(frame.s * (sin * phi.cos()) + frame.t * (sin * phi.sin()) + frame.n * (1.0 - versine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;

    /// E[cosα] = (n + 1)/(n + 2) under B (2.36), E[cos²(α/2)] = (n + 2)/(n + 4) under B (2.38).
    #[test]
    fn warps_have_the_moments_of_their_densities() {
        let axis = LocalDir::new_unchecked(warp::spherical_direction(0.7, 2.0));
        let side = 300;
        for n in [0.0_f32, 1.0, 30.0, 1e4] {
            let (mut cos, mut half) = (0.0_f64, 0.0_f64);
            for i in 0..side * side {
                let u = Vec2::new((i % side) as f32 + 0.5, (i / side) as f32 + 0.5) / side as f32;
                let versine = |w: LocalDir| 0.5 * f64::from((*w - *axis).length_squared());
                cos += 1.0 - versine(sample(axis, n, u).unwrap());
                half += 1.0 - 0.5 * versine(sample_half_angle(axis, n, u).unwrap());
            }
            let (count, n) = (f64::from(side * side), f64::from(n));
            // The midpoint rule errs most for (1 − ξ)^½ at n = 0: 10⁻⁴.
            assert!((cos / count - (n + 1.0) / (n + 2.0)).abs() < 2e-4, "{n}: {}", cos / count);
            assert!((half / count - (n + 2.0) / (n + 4.0)).abs() < 2e-4, "{n}: {}", half / count);
        }
    }

    #[test]
    fn narrow_lobes_are_resolved_in_single_precision() {
        let axis = LocalDir::new_unchecked(warp::spherical_direction(1.0, 2.0));
        let near = LocalDir::new_unchecked(warp::spherical_direction(1.001, 2.0));
        // cos^n of a milliradian at n = 10⁶ is e^(−1/2).
        let value = power(*axis, *near, 1e6);
        assert!((value - (-0.5_f32).exp()).abs() < 2e-4, "{value}");
        let half = half_angle_power(*axis, *near, 1e6);
        assert!((half - (-0.125_f32).exp()).abs() < 2e-4, "{half}");
    }
}
