//! Points computed in f64 and stored in f32, with bounds on what the storing loses.

use crate::math::{BoundedPoint, Point, float};
use glam::DVec3;

/// Rounds `p` to f32. `magnitude` bounds the absolute values that were added up per axis on the way to `p`:
/// where they cancel, the error of f64 outweighs that of the rounding.
pub(super) fn bounded(p: DVec3, magnitude: DVec3) -> BoundedPoint {
    // 64 f64 operations are more than any shape here spends on a coordinate.
    const F64_ERROR: f64 = 64.0 * f64::EPSILON;
    let rounded = p.as_vec3();
    let error = rounded.abs() * float::gamma(2) + (magnitude * F64_ERROR).as_vec3();
    BoundedPoint { p: Point(rounded), error }
}

/// Normalises in f64; `None` for a vector without length.
pub(super) fn normalized(v: DVec3) -> Option<crate::math::Normal> {
    Some(crate::math::Normal::new_unchecked(v.try_normalize()?.as_vec3()))
}
