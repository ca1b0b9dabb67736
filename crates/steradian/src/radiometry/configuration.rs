//! Configuration factors: the share of what leaves a diffuse element of area that arrives at a shape; times πL of the shape,
//! the irradiance of the element by it. Numbered as in Howell, Menguc, Daun & Siegel, "A Catalog of Radiation Heat Transfer
//! Configuration Factors".

use std::f64::consts::PI;

/// An element below the corner of an a × b rectangle in a parallel plane at distance `h` > 0 (B-3):
/// C = 1/2π [A/√(1+A²) atan(B/√(1+A²)) + B/√(1+B²) atan(A/√(1+B²))] with A = a/h, B = b/h. Odd in a and in b: differences
/// and sums give rectangles that lie anywhere.
pub fn parallel_rectangle_at_corner(a: f64, b: f64, h: f64) -> f64 {
    let (a, b) = (a / h, b / h);
    let (p, q) = (1.0_f64.hypot(a), 1.0_f64.hypot(b));
    (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * PI)
}

/// An element whose plane is perpendicular to that of a w × h rectangle at distance `d` > 0: the rectangle stands on the plane of the
/// element, with one lower corner opposite it, w wide along the plane and h high along the element's normal (B-4):
/// C = 1/2π [atan(w/d) − d/√(d² + h²) atan(w/√(d² + h²))]. Odd in w, even in h.
pub fn perpendicular_rectangle_at_corner(w: f64, h: f64, d: f64) -> f64 {
    let far = d.hypot(h);
    ((w / d).atan() - d / far * (w / far).atan()) / (2.0 * PI)
}

/// An element on the axis of a disk of radius `r` in a parallel plane at distance `h`, not both 0 (B-12):
/// C = r²/(r² + h²).
pub fn disk_on_axis(r: f64, h: f64) -> f64 {
    r * r / (r * r + h * h)
}

/// An element in a plane parallel to a disk of radius `r` > 0 at distance `h` > 0, at distance `a` from its axis (B-13):
/// C = ½ [1 − (h² + a² − r²)/√((h² + a² + r²)² − 4a²r²)].
pub fn disk_off_axis(r: f64, h: f64, a: f64) -> f64 {
    let (far, near) = (h * h + (a + r) * (a + r), h * h + (a - r) * (a - r));
    0.5 * (1.0 - (h * h + a * a - r * r) / (far * near).sqrt())
}

/// A sphere of radius `r` whose centre lies at distance `d` > r in a direction at angle `theta` [rad] to the element's normal,
/// in [0, π], as much of it as is above the horizon.
///
/// Wholly above: (r/d)² cosθ. Cut by the horizon, with h = d/r, x = √(h² − 1), y = −x cotθ (B-43):
/// C = 1/π {[cosθ acos y − x sinθ √(1 − y²)]/h² + atan(sinθ √(1 − y²)/x)}.
pub fn sphere(r: f64, d: f64, theta: f64) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let angular_radius = (r / d).asin();
    if theta + angular_radius <= 0.5 * PI {
        return (r / d).powi(2) * cos;
    }
    if theta - angular_radius >= 0.5 * PI {
        return 0.0;
    }
    let h = d / r;
    let x = (h * h - 1.0).sqrt();
    let y = (-x * cos / sin).clamp(-1.0, 1.0);
    let root = (1.0 - y * y).sqrt();
    ((cos * y.acos() - x * sin * root) / (h * h) + (sin * root / x).atan()) / PI
}

#[cfg(test)]
mod tests {
    use super::super::polygon;
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 6e-9, "{a} {b}");
    }

    #[test]
    fn rectangles_have_the_checked_factors() {
        assert!((parallel_rectangle_at_corner(1.0, 1.0, 1.0) - 0.138_531_605_99).abs() < 1e-11);
        assert!((4.0 * parallel_rectangle_at_corner(0.5, 0.5, 1.0) - 0.239_456_470_46).abs() < 1e-11);
        // An endless wall on one side hides a quarter of the projected hemisphere, times two halves.
        assert!((2.0 * perpendicular_rectangle_at_corner(1e9, 1e9, 1.0) - 0.5).abs() < 1e-8);
    }

    #[test]
    fn disks_and_spheres_have_the_checked_factors() {
        close(PI * disk_on_axis(1.0, 2.0), 0.628_318_53);
        close(PI * sphere(1.0, 2.0, 0.0), 0.785_398_16);
        for (degrees, e) in [(80.0_f64, 0.171_831_98), (90.0, 0.090_586_07), (95.0, 0.059_649_27)] {
            close(PI * sphere(0.5, 1.0, degrees.to_radians()), e);
        }
    }

    #[test]
    fn a_setting_sphere_fades_continuously() {
        for theta in [60.0_f64, 120.0] {
            let at = |t: f64| sphere(0.5, 1.0, t.to_radians());
            assert!((at(theta - 1e-6) - at(theta + 1e-6)).abs() < 1e-7, "{theta}");
        }
        assert_eq!(sphere(0.5, 1.0, PI), 0.0);
    }

    proptest! {
        #[test]
        fn rectangles_agree_with_lamberts_formula(a in 0.01..20.0_f64, b in 0.01..20.0_f64, h in 0.01..20.0_f64) {
            let flat = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]].map(|[x, y]| DVec3::new(x, y, h));
            let upright = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]].map(|[y, z]| DVec3::new(h, y, z));
            let lambert =
                |v: &[DVec3]| polygon::projected_solid_angle(DVec3::ZERO, DVec3::Z, v).configuration_factor();
            prop_assert!((parallel_rectangle_at_corner(a, b, h) - lambert(&flat)).abs() < 1e-12);
            prop_assert!((perpendicular_rectangle_at_corner(a, b, h) - lambert(&upright)).abs() < 1e-12);
        }

        #[test]
        fn a_disk_agrees_with_a_polygon_of_many_sides(r in 0.1..3.0_f64, h in 0.2..3.0_f64, a in 0.0..4.0_f64) {
            let ring: Vec<_> = (0..2000)
                .map(|i| (f64::from(i) * PI / 1000.0).sin_cos())
                .map(|(s, c)| DVec3::new(a + r * c, r * s, h))
                .collect();
            let lambert = polygon::projected_solid_angle(DVec3::ZERO, DVec3::Z, &ring).configuration_factor();
            prop_assert!((disk_off_axis(r, h, a) / lambert - 1.0).abs() < 1e-4);
        }
    }
}
