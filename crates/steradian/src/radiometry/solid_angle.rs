//! Solid angles of simple shapes, exact at any distance. A (8): the area of the projection on a sphere over its radius squared.

use crate::units::SolidAngle;
use glam::DVec3;
use std::f64::consts::PI;

/// A patch between two polar angles and two azimuths, A (13): ω = (φ₁ − φ₀)(cosθ₀ − cosθ₁).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Polar angles from the axis [rad], the smaller one first, in [0, π].
    pub theta: [f64; 2],
    /// Azimuths [rad], the smaller one first, at most 2π apart.
    pub phi: [f64; 2],
}

impl Patch {
    /// Its solid angle.
    pub fn solid_angle(&self) -> SolidAngle {
        let [theta0, theta1] = self.theta;
        // cosθ₀ − cosθ₁ without cancellation for narrow patches.
        let height = 2.0 * (0.5 * (theta1 + theta0)).sin() * (0.5 * (theta1 - theta0)).sin();
        SolidAngle((self.phi[1] - self.phi[0]) * height)
    }
}

/// A circular cone of half-angle `sigma` [rad], in [0, π]: ω = 2π(1 − cosσ), from A (13).
pub fn cap(sigma: f64) -> SolidAngle {
    // 1 − cosσ = 2 sin²(σ/2) keeps its digits for the sun.
    SolidAngle(4.0 * PI * (0.5 * sigma).sin().powi(2))
}

/// A disk of radius `r` seen from its axis at distance `h`, both at least 0 and not both 0: ω = 2π(1 − h/√(h² + r²)).
pub fn disk_on_axis(r: f64, h: f64) -> SolidAngle {
    let far = h.hypot(r);
    SolidAngle(2.0 * PI * r * r / (far * (far + h)))
}

/// A sphere of radius `r` whose centre is at distance `d` > r: ω = 2π(1 − √(1 − (r/d)²)).
pub fn sphere(r: f64, d: f64) -> SolidAngle {
    let s = r / d;
    SolidAngle(2.0 * PI * s * s / (1.0 + (1.0 - s * s).sqrt()))
}

/// An a × b rectangle seen from height `h` > 0 above one of its corners: ω = atan(ab / (h √(a² + b² + h²)))
/// (Khadjavi, JOSA 58, 1417 (1968)). Odd in a and in b, so that differences give rectangles that lie anywhere.
pub fn rectangle_at_corner(a: f64, b: f64, h: f64) -> SolidAngle {
    SolidAngle((a * b / (h * (a * a + b * b + h * h).sqrt())).atan())
}

/// A triangle, with its sign: positive where the vertices run counterclockwise as seen from `p` outside of its plane
/// (van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30, 125 (1983)):
/// tan(ω/2) = r₁·(r₂ × r₃) / (r₁r₂r₃ + (r₁·r₂)r₃ + (r₁·r₃)r₂ + (r₂·r₃)r₁), with r_i from p to the vertices.
pub fn triangle(p: DVec3, vertices: [DVec3; 3]) -> f64 {
    let [a, b, c] = vertices.map(|v| v - p);
    let [la, lb, lc] = [a.length(), b.length(), c.length()];
    let volume = a.dot(b.cross(c));
    let sum = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    // Vertices counterclockwise to the eye have a negative triple product: their normal points to the eye.
    2.0 * (-volume).atan2(sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn patches_add_up_to_the_sphere() {
        let mut sum = 0.0;
        for i in 0..9 {
            for j in 0..18 {
                let step = PI / 9.0;
                let (t, p) = (f64::from(i) * step, f64::from(j) * step);
                sum += Patch { theta: [t, t + step], phi: [p, p + step] }.solid_angle().0;
            }
        }
        assert!((sum - SolidAngle::SPHERE.0).abs() < 1e-12);
        // A (13) for the first octant: ½π.
        let octant = Patch { theta: [0.0, 0.5 * PI], phi: [0.0, 0.5 * PI] };
        assert!((octant.solid_angle().0 - 0.5 * PI).abs() < 1e-15);
    }

    #[test]
    fn the_sun_has_68_microsteradians() {
        let sun = cap(0.266_f64.to_radians());
        assert!((sun.0 - 6.77e-5).abs() < 5e-8, "{sun:?}");
        assert!((cap(PI).0 - SolidAngle::SPHERE.0).abs() < 1e-12);
        assert!((cap(0.5 * PI).0 - SolidAngle::HEMISPHERE.0).abs() < 1e-12);
    }

    #[test]
    fn one_face_of_a_cube_fills_a_sixth_of_the_sphere() {
        assert!((4.0 * rectangle_at_corner(1.0, 1.0, 1.0).0 - SolidAngle::SPHERE.0 / 6.0).abs() < 1e-14);
    }

    #[test]
    fn a_far_square_is_foreshortened_as_a_small_area() {
        // A (14) at 1 km and 60°, to the relative size squared.
        let (h, x) = (500.0, 750.0_f64.sqrt() * 1000.0_f64.sqrt());
        let w = |a: f64, b: f64| rectangle_at_corner(a, b, h).0;
        let square = w(x + 0.5, 0.5) - w(x - 0.5, 0.5) - w(x + 0.5, -0.5) + w(x - 0.5, -0.5);
        assert!((square / (0.5 / 1e6) - 1.0).abs() < 1e-6, "{square}");
    }

    proptest! {
        #[test]
        fn a_cone_a_disk_and_a_sphere_of_like_outline_agree(sigma in 0.001..1.5_f64) {
            let disk = disk_on_axis(sigma.tan(), 1.0).0;
            prop_assert!((disk / cap(sigma).0 - 1.0).abs() < 1e-12);
            prop_assert!((sphere(sigma.sin(), 1.0).0 / cap(sigma).0 - 1.0).abs() < 1e-9);
        }

        #[test]
        fn triangles_add_up_to_rectangles(a in 0.1..5.0_f64, b in 0.1..5.0_f64, h in 0.1..5.0_f64) {
            let eye = DVec3::new(0.0, 0.0, h);
            let [p, q, r, s] = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]].map(|[x, y]| DVec3::new(x, y, 0.0));
            let both = triangle(eye, [p, q, r]) + triangle(eye, [p, r, s]);
            prop_assert!((both - rectangle_at_corner(a, b, h).0).abs() < 1e-12);
            prop_assert!((triangle(eye, [r, q, p]) + triangle(eye, [p, q, r])).abs() < 1e-15);
        }
    }
}
