//! Mirror and refracted directions. All directions point away from the interface.

use super::fresnel::Crossing;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;
    use proptest::prelude::*;

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
                    if n.dot(r.w).abs() > 0.05 {
                        let back = refract(r.w, n, eta).unwrap();
                        prop_assert!((back.w - w).length() < 1e-4);
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
