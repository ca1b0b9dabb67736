//! Mirror and refracted directions. All directions point away from the interface.

use super::fresnel::Crossing;
use super::real::Real;
use crate::math::Vec3;

/// The mirror direction of `w` about the unit normal `n`: 2 (n·w) n − w, B (2.4).
pub fn reflect(w: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * n.dot(w)) - w
}

/// A direction beyond an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refracted {
    /// The refracted unit direction.
    pub w: Vec3,
    /// Relative index of the side it lies in over the side it came from.
    pub eta: f32,
}

/// The direction in which light refracts to from the unit direction `w`, by Snell's law, B (2.5)–(2.7);
/// `None` for total internal reflection.
///
/// `eta` is the index on the side opposite to the unit normal `n` over the index on its own side; `w` may
/// lie on either side.
pub fn refract(w: Vec3, n: Vec3, eta: f32) -> Option<Refracted> {
    let crossing = Crossing::new(n.dot(w), eta);
    Some(Refracted { w: crossing.refract(w, n)?, eta: crossing.eta })
}

/// The cosine of refraction behind an interface of relative index `eta` (far side over near side, above 0), from the
/// cosine of incidence in [0, 1]: Snell's law, B (2.5). `None` for total reflection.
pub fn refracted_cosine<T: Real>(cos_theta: T, eta: T) -> Option<T> {
    let square = T::refracted_square(eta, T::ZERO, cos_theta);
    (square > T::ZERO).then(|| square.sqrt() / eta)
}

/// The angle of incidence [rad] above which everything is reflected, asin η; `None` for an index of 1 or more.
pub fn critical_angle(eta: f64) -> Option<f64> {
    (eta < 1.0).then(|| eta.asin())
}

/// The angle of incidence [rad] at which no light polarised in the plane of incidence is reflected, atan η
/// (Brewster 1815).
pub fn brewster_angle(eta: f64) -> f64 {
    eta.atan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;
    use proptest::prelude::*;

    #[test]
    fn glass_has_its_brewster_and_critical_angles() {
        assert!((brewster_angle(1.5).to_degrees() - 56.309_93).abs() < 5e-6);
        assert!((critical_angle(1.0 / 1.5).unwrap().to_degrees() - 41.810_31).abs() < 5e-6);
        assert_eq!(critical_angle(1.0), None);
        let cos = |degrees: f64| degrees.to_radians().cos();
        assert!(refracted_cosine(cos(41.8103), 1.0 / 1.5).is_some());
        assert_eq!(refracted_cosine(cos(41.8104), 1.0 / 1.5), None);
        assert!((refracted_cosine(cos(30.0), 1.5).unwrap() - (1.0 - 1.0 / 9.0_f64).sqrt()).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn refraction_obeys_snell_and_is_its_own_inverse(theta in 0.0f32..3.1, phi in 0.0f32..6.2, eta in 0.4f32..2.5) {
            let n = warp::spherical_direction(0.7, 1.1);
            let w = warp::spherical_direction(theta, phi);
            prop_assume!(n.dot(w).abs() > 1e-3);
            match refract(w, n, eta) {
                Some(r) => {
                    let (si, st) = (n.cross(w).length(), n.cross(r.w).length());
                    prop_assert!((si - r.eta * st).abs() < 1e-5);
                    prop_assert!(n.dot(w) * n.dot(r.w) < 0.0);
                    prop_assert!((r.w.length() - 1.0).abs() < 1e-5);
                    // In one plane with the normal, and on the far side of it.
                    prop_assert!(n.cross(w).dot(r.w).abs() < 1e-5 && n.cross(w).dot(n.cross(r.w)) <= 1e-6);
                    // A cosine follows from the square of its sine: near 90° its error is the rounding over the cosine.
                    let least_cosine = n.dot(w).abs().min(n.dot(r.w).abs());
                    if least_cosine > 0.05 {
                        let back = refract(r.w, n, eta).unwrap();
                        prop_assert!((back.w - w).length() < 5e-6 / least_cosine);
                    }
                }
                None => {
                    let eta = if n.dot(w) < 0.0 { 1.0 / eta } else { eta };
                    prop_assert!(n.cross(w).length() > eta - 1e-5);
                }
            }
        }

        #[test]
        fn reflection_keeps_the_angle_and_the_plane(theta in 0.0f32..3.1, phi in 0.0f32..6.2) {
            let n = warp::spherical_direction(0.7, 1.1);
            let w = warp::spherical_direction(theta, phi);
            let r = reflect(w, n);
            prop_assert!((n.dot(w) - n.dot(r)).abs() < 1e-5 && (n.cross(w) + n.cross(r)).length() < 1e-5);
        }
    }
}
