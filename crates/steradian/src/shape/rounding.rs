//! Points computed in f64 and stored in f32, with bounds on what the storing loses.

use crate::math::{BoundedPoint, Normal, Point, Vec3, float};
use glam::DVec3;

/// Rounds `p` to f32. `magnitude` bounds the absolute values that were added up per axis on the way to `p`:
/// where they cancel, the error of f64 outweighs that of the rounding.
#[inline]
pub(super) fn bounded(p: DVec3, magnitude: Vec3) -> BoundedPoint {
    // 64 f64 operations are more than any shape here spends on a coordinate.
    const F64_ERROR: f32 = 64.0 * f64::EPSILON as f32;
    let rounded = p.as_vec3();
    let error = rounded.abs() * float::gamma(2) + magnitude * F64_ERROR;
    BoundedPoint { p: Point(rounded), error }
}

/// Normalises; `None` for a vector without length.
#[inline]
pub(super) fn normalized(v: DVec3) -> Option<Normal> {
    let rounded = v.as_vec3();
    let squared = rounded.length_squared();
    // The root and the quotient in f32 take half the time; outside of its range f64 has room. False for NaN.
    if (1e-24..1e24).contains(&squared) {
        return Some(Normal::new_unchecked(rounded * (1.0 / squared.sqrt())));
    }
    normalized_far_out(v)
}

#[cold]
fn normalized_far_out(v: DVec3) -> Option<Normal> {
    Some(Normal::new_unchecked(v.try_normalize()?.as_vec3()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    #[test]
    fn what_storing_a_point_loses_is_within_its_error() {
        let mut rng = Pcg32::new(15, 9);
        for _ in 0..10_000 {
            let p = DVec3::from_array([0; 3].map(|_| f64::from(rng.next_f32() - 0.5) * (1.0 + 1e-9)));
            let p = p * 10.0_f64.powi(rng.next_u32() as i32 % 20 - 10);
            let b = bounded(p, p.abs().as_vec3());
            let lost = (b.p.as_dvec3() - p).abs();
            assert!(lost.cmple(b.error.as_dvec3()).all(), "{p}: {lost} {}", b.error);
        }
    }
}
