//! What a uniformly bright polygon does to a point: Lambert's formula and its generalisation to cosⁿ.

use super::solid_angle;
use crate::units::ProjectedSolidAngle;
use glam::DVec3;

/// The projected solid angle of a planar polygon above the horizon of a point, ∫ cosθ dω = ½ |Σ Θᵢ Γᵢ·n| (Lambert 1760,
/// Photometria; Moon 1936): Θᵢ is the angle under which edge i is seen from `p` and Γᵢ the unit normal of the plane
/// through `p` and the edge. `normal` is the unit normal at `p`; what lies below its horizon is cut off.
///
/// The orientation of the vertices does not matter: whether the side that is seen shines is for the caller to know.
/// Times L it is the irradiance, over π the configuration factor.
pub fn projected_solid_angle(p: DVec3, normal: DVec3, vertices: &[DVec3]) -> ProjectedSolidAngle {
    let seen: Vec<_> = vertices.iter().map(|v| *v - p).collect();
    let above = above_horizon(&seen, normal);
    let sum: f64 = edges(&above).map(|(a, b)| edge_vector(a, b).dot(normal)).sum();
    ProjectedSolidAngle(0.5 * sum.abs())
}

/// ∫ (w·u)ⁿ dω over the directions u in which a polygon is seen from `p`, for a unit vector w and n ≥ 0: the axial moment
/// (Arvo, SIGGRAPH 1995, eq. 17), by (n + 1) τₙ = (n − 1) τₙ₋₂ − Σ w·Γᵢ ∫ (w·u)ⁿ⁻¹ ds over the edges, from τ₀ = ω and τ₋₁ = 0.
/// For n = 1 it is Lambert's formula, for larger n the irradiance of a cosⁿ lobe. Nothing is clipped: where the
/// polygon reaches below the plane of w, odd moments count it as negative.
///
/// The polygon is convex, and `p` lies outside of its plane.
pub fn axial_moment(p: DVec3, w: DVec3, vertices: &[DVec3], n: u32) -> f64 {
    let fan = vertices.get(1..).unwrap_or_default().windows(2);
    let signed: f64 = fan.map(|pair| solid_angle::triangle(p, [vertices[0], pair[0], pair[1]])).sum();
    let seen: Vec<_> = vertices.iter().map(|v| *v - p).collect();
    let boundary = |k: u32| -> f64 { edges(&seen).map(|(a, b)| edge_moment(a, b, w, k)).sum() };
    let (mut moment, first) = if n.is_multiple_of(2) { (signed, 2) } else { (0.0, 1) };
    for k in (first..=n).step_by(2) {
        // Γ = a × b points inwards where the vertices run clockwise to the eye, where `signed` is negative.
        moment = (f64::from(k - 1) * moment - boundary(k - 1)) / f64::from(k + 1);
    }
    // The orientation is that of the caller; the moment of the region has the sign that a positive ω gives.
    if signed < 0.0 { -moment } else { moment }
}

/// The part of a polygon, given relative to the point, that lies above the horizon (Sutherland & Hodgman 1974).
pub(super) fn above_horizon(vertices: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut above = Vec::with_capacity(vertices.len() + 2);
    for (a, b) in edges(vertices) {
        let (za, zb) = (a.dot(normal), b.dot(normal));
        if za >= 0.0 {
            above.push(a);
        }
        if (za < 0.0) != (zb < 0.0) {
            above.push(a + (b - a) * (za / (za - zb)));
        }
    }
    above
}

/// Each vertex with the next one, the last with the first.
pub(super) fn edges(vertices: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    vertices.iter().zip(vertices.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

/// ΘΓ of an edge seen from the origin; zero for an edge that is seen end on.
fn edge_vector(a: DVec3, b: DVec3) -> DVec3 {
    let cross = a.cross(b);
    let sin = cross.length();
    if sin == 0.0 { DVec3::ZERO } else { cross * (sin.atan2(a.dot(b)) / sin) }
}

/// w·Γ ∫ (w·u)ᵏ ds over the arc of directions from a to b.
fn edge_moment(a: DVec3, b: DVec3, w: DVec3, k: u32) -> f64 {
    let cross = a.cross(b);
    let sin = cross.length();
    if sin == 0.0 {
        return 0.0;
    }
    let (gamma, start) = (cross / sin, a.normalize());
    let onward = gamma.cross(start);
    // On the arc w·u = c cos(s − s₀).
    let (x, y) = (w.dot(start), w.dot(onward));
    let (c, s0, angle) = (x.hypot(y), y.atan2(x), sin.atan2(a.dot(b)));
    w.dot(gamma) * c.powi(k as i32) * (cosine_power_integral(angle - s0, k) - cosine_power_integral(-s0, k))
}

/// ∫₀ˣ cosᵏ t dt, by the reduction formula.
fn cosine_power_integral(x: f64, k: u32) -> f64 {
    let (sin, cos) = x.sin_cos();
    let (mut integral, first) = if k.is_multiple_of(2) { (x, 2) } else { (sin, 3) };
    for j in (first..=k).step_by(2) {
        let j = f64::from(j);
        integral = (cos.powf(j - 1.0) * sin + (j - 1.0) * integral) / j;
    }
    integral
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{Illuminance, Luminance};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn rectangle(x: [f64; 2], y: [f64; 2], z: f64) -> [DVec3; 4] {
        [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| DVec3::new(x, y, z))
    }

    #[test]
    fn a_unit_square_at_unit_height_has_the_checked_factor() {
        let square = rectangle([-0.5, 0.5], [-0.5, 0.5], 1.0);
        let factor = projected_solid_angle(DVec3::ZERO, DVec3::Z, &square).configuration_factor();
        assert!((factor - 0.239_456_470_46).abs() < 1e-11, "{factor}");
        let quarter = rectangle([0.0, 1.0], [0.0, 1.0], 1.0);
        let factor = projected_solid_angle(DVec3::ZERO, DVec3::Z, &quarter).configuration_factor();
        assert!((factor - 0.138_531_605_99).abs() < 1e-11, "{factor}");
    }

    #[test]
    fn a_ceiling_without_end_fills_the_hemisphere() {
        let e = projected_solid_angle(DVec3::ZERO, DVec3::Z, &rectangle([-1e9, 1e9], [-1e9, 1e9], 1.0));
        assert!((e.0 - ProjectedSolidAngle::HEMISPHERE.0).abs() < 1e-8);
        let lit = Luminance::exact(2.0).from_directions(e);
        assert!((lit.value() - Illuminance::exact(2.0 * PI).value()).abs() < 1e-7);
    }

    #[test]
    fn what_lies_below_the_horizon_does_not_count() {
        // A wall that stands through the horizon, and its upper half alone.
        let wall =
            |z0: f64| [[-1.0, z0], [1.0, z0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(1.0, y, z));
        let e = |wall: [DVec3; 4]| projected_solid_angle(DVec3::ZERO, DVec3::Z, &wall).0;
        assert!((e(wall(-3.0)) - e(wall(0.0))).abs() < 1e-15 && e(wall(0.0)) > 0.1);
        let below = wall(-3.0).map(|v| v - 2.0 * DVec3::Z);
        assert_eq!(e(below), 0.0);
    }

    #[test]
    fn moments_of_a_pole_are_those_of_a_cone_in_the_limit() {
        // A regular 720-gon about w: ∫ cosⁿ dω = 2π (1 − cosⁿ⁺¹σ)/(n + 1), to the area that the sagittae cut off.
        let sigma = 0.7_f64;
        let ring: Vec<_> = (0..720)
            .map(|i| (f64::from(i) * PI / 360.0).sin_cos())
            .map(|(s, c)| DVec3::new(c * sigma.tan(), s * sigma.tan(), 1.0))
            .collect();
        for n in [0, 1, 2, 3, 10, 25] {
            let moment = axial_moment(DVec3::ZERO, DVec3::Z, &ring, n);
            let cone = 2.0 * PI * (1.0 - sigma.cos().powi(n as i32 + 1)) / f64::from(n + 1);
            assert!((moment / cone - 1.0).abs() < 5e-5, "{n}: {moment} {cone}");
        }
    }

    proptest! {
        #[test]
        fn the_first_moment_is_lamberts_formula_in_either_orientation(
            x in -2.0..2.0_f64, y in -2.0..2.0_f64, h in 0.2..3.0_f64, tilt in -0.2..0.2_f64
        ) {
            let mut square = rectangle([x, x + 1.0], [y, y + 0.7], h);
            let w = DVec3::new(tilt, 0.0, 1.0).normalize();
            prop_assume!(square.iter().all(|v| v.dot(w) > 0.0));
            let e = projected_solid_angle(DVec3::ZERO, w, &square).0;
            prop_assert!((axial_moment(DVec3::ZERO, w, &square, 1) - e).abs() < 1e-12);
            let third = axial_moment(DVec3::ZERO, w, &square, 3);
            square.reverse();
            prop_assert!((axial_moment(DVec3::ZERO, w, &square, 1) - e).abs() < 1e-12);
            prop_assert!((axial_moment(DVec3::ZERO, w, &square, 3) - third).abs() < 1e-12);
            prop_assert!(third < e && third > 0.0);
        }

        #[test]
        fn moments_agree_with_a_sum_over_small_squares(
            x in -2.0..2.0_f64, y in -2.0..2.0_f64, h in 0.5..3.0_f64, n in 0..8_u32
        ) {
            let square = rectangle([x, x + 1.0], [y, y + 1.0], h);
            // The midpoint rule with 64² cells errs by some 10⁻⁵ here.
            let mut sum = 0.0;
            for i in 0..4096 {
                let (u, v) = (f64::from(i % 64), f64::from(i / 64));
                let q = DVec3::new(x + (u + 0.5) / 64.0, y + (v + 0.5) / 64.0, h);
                let cos = h / q.length();
                sum += cos.powi(n as i32) * cos / q.length_squared() / 4096.0;
            }
            let moment = axial_moment(DVec3::ZERO, DVec3::Z, &square, n);
            prop_assert!((moment / sum - 1.0).abs() < 2e-3, "{moment} {sum}");
        }
    }
}
