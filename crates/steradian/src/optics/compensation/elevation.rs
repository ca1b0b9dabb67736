//! Where the nodes of a sheet lie over the angle to the normal.

/// Widths from here on need no finer nodes than this at the horizon, where refraction bends most.
const FINE: f32 = 0.1;

/// Half the nodes are spread over the cosine, half over its ratio to the width, or to what refraction at the horizon needs.
pub(super) fn coordinate(mu: f32, alpha: f32) -> f32 {
    let k = alpha.min(FINE);
    0.5 * mu * (1.0 + (1.0 + k) / (mu + k))
}

/// The inverse of [`coordinate`]: the root of μ² + μ (2k + 1 − 2s) − 2sk.
pub(super) fn cosine(s: f64, alpha: f64) -> f64 {
    let k = alpha.min(f64::from(FINE));
    let half = k + 0.5 - s;
    let root = (half * half + 2.0 * s * k).sqrt();
    // The form that does not cancel.
    if half > 0.0 { 2.0 * s * k / (half + root) } else { root - half }
}
