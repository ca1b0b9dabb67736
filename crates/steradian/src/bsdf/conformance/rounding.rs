//! How far rounding of directions moves a value: near a narrow lobe or the horizon, more than any fixed tolerance allows.

use crate::math::{LocalDir, Vec3};

/// Steps of a few units in the last place of a direction's components.
const STEP: f32 = 3e-7;

const STEPS: [Vec3; 4] = [
    Vec3::new(STEP, STEP, -STEP),
    Vec3::new(-STEP, STEP, STEP),
    Vec3::new(STEP, -STEP, STEP),
    Vec3::new(-STEP, -STEP, -STEP),
];

/// Directions that rounding may make of `w`, on the same side of the surface.
pub(super) fn neighbours(w: LocalDir) -> impl Iterator<Item = LocalDir> {
    STEPS.into_iter().filter_map(move |step| LocalDir::new(*w + step)).filter(move |n| n.z * w.z > 0.0)
}

/// The largest change of `value` = `f(w)` among the neighbours of `w`, doubled.
pub(super) fn spread(w: LocalDir, value: f32, f: impl Fn(LocalDir) -> f32) -> f64 {
    2.0 * neighbours(w).map(|n| f64::from((f(n) - value).abs())).fold(0.0, f64::max)
}
