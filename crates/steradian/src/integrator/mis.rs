//! Multiple importance sampling (Veach 1997, chapter 9).

use crate::units::PdfSolidAngle;

/// Weight of a sample from the first of two techniques, one sample each, power heuristic with exponent 2
/// (Veach 1997, eq. 9.14). Zero when the first density is zero; the limit 1 when it is infinite.
#[inline]
pub(crate) fn power_heuristic(own: PdfSolidAngle, other: PdfSolidAngle) -> f32 {
    if own.0 <= 0.0 {
        return 0.0;
    }
    // The ratio cannot overflow where the squares could.
    let ratio = other.0 / own.0;
    let weight = 1.0 / (1.0 + ratio * ratio);
    if weight.is_nan() { 1.0 } else { weight }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_both_techniques_sum_to_one() {
        for (a, b) in [(1.0, 3.0), (1e-30, 1e30), (5.0, 0.0), (1e38, 1e38)] {
            let (a, b) = (PdfSolidAngle(a), PdfSolidAngle(b));
            let sum = power_heuristic(a, b) + if b.0 > 0.0 { power_heuristic(b, a) } else { 0.0 };
            assert!((sum - 1.0).abs() < 1e-6, "{a:?} {b:?} {sum}");
        }
        assert_eq!(power_heuristic(PdfSolidAngle(0.0), PdfSolidAngle(2.0)), 0.0);
    }
}
