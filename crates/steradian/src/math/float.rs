//! Floating-point error bounds and numerically careful elementary functions.

/// Half an ulp of 1: the relative rounding error of one f32 operation.
pub const MACHINE_EPSILON: f32 = f32::EPSILON * 0.5;

/// The largest f32 below one: samples u lie in [0, 1).
pub const ONE_MINUS_EPSILON: f32 = 1.0 - MACHINE_EPSILON;

/// Bound on the relative error of `n` rounded operations in sequence (Higham 2002, lemma 3.1).
pub const fn gamma(n: u32) -> f32 {
    let ne = n as f32 * MACHINE_EPSILON;
    ne / (1.0 - ne)
}

/// √max(0, x): for radicands that are negative by rounding only.
pub fn safe_sqrt(x: f32) -> f32 {
    x.max(0.0).sqrt()
}

/// asin of x clamped to [−1, 1].
pub fn safe_asin(x: f32) -> f32 {
    x.clamp(-1.0, 1.0).asin()
}

/// acos of x clamped to [−1, 1].
pub fn safe_acos(x: f32) -> f32 {
    x.clamp(-1.0, 1.0).acos()
}

/// (1 − t) a + t b.
pub fn lerp(t: f32, a: f32, b: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// a·b − c·d with an error below 1.5 ulp (Kahan; Jeannerod et al. 2013).
pub fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    // f64 holds each product of two f32 exactly; only the subtraction and the final rounding err.
    (f64::from(a) * f64::from(b) - f64::from(c) * f64::from(d)) as f32
}

/// Real roots t0 ≤ t1 of a t² + b t + c = 0 in f64; `None` when there are none, or a = b = 0.
pub fn solve_quadratic(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    if a == 0.0 {
        if b == 0.0 {
            return None;
        }
        let t = -c / b;
        return Some((t, t));
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    // The root whose two terms have equal signs does not cancel; the other follows from Viète.
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let t0 = q / a;
    let t1 = if q == 0.0 { t0 } else { c / q };
    Some(if t0 <= t1 { (t0, t1) } else { (t1, t0) })
}

/// Smoothstep: 0 below `a`, 1 above `b`, cubic in between.
pub fn smoothstep(x: f32, a: f32, b: f32) -> f32 {
    if a == b {
        return if x < a { 0.0 } else { 1.0 };
    }
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_keeps_the_small_root() {
        let (t0, t1) = solve_quadratic(1.0, -1e8, 1.0).unwrap();
        assert!((t0 - 1e-8).abs() < 1e-20, "{t0}");
        assert!((t1 - 1e8).abs() < 1e-4);
        assert!(solve_quadratic(1.0, 0.0, 1.0).is_none());
        assert_eq!(solve_quadratic(0.0, 2.0, -4.0), Some((2.0, 2.0)));
    }

    #[test]
    fn difference_of_products_survives_cancellation() {
        let (a, b) = (1.0 + f32::EPSILON, 1.0 - f32::EPSILON);
        let exact = -(f64::from(f32::EPSILON) * f64::from(f32::EPSILON));
        assert_eq!(f64::from(difference_of_products(a, b, 1.0, 1.0)), exact);
    }
}
