//! What a grid of readings says as a whole, with honest intervals for its smallest one.

use crate::lab::Precision;
use crate::units::Estimate;
use statrs::distribution::{ContinuousCDF, Normal};

/// An interval that need not be symmetric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Mean, extremes and uniformity of readings that were made independently of each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Uniformity {
    /// Mean Ē.
    pub mean: Estimate,
    /// The smallest reading.
    pub min: Estimate,
    /// The largest reading.
    pub max: Estimate,
    /// U0 = Emin/Ē (EN 12464-1) by the readings as they are.
    pub u0: f64,
    /// Where the true U0 lies, at the level of the readings or above.
    ///
    /// The smallest of noisy readings is likely to be one that came out low: U0 of the readings is too small on average. The
    /// intervals of all points are therefore widened until they hold together (Bonferroni); the true minimum is then between the
    /// smallest lower end and the smallest upper end, and that over the ends of the mean's interval bounds U0.
    pub u0_interval: Interval,
    /// Emin/Emax by the readings as they are: the uniformity that some call diversity, U_d.
    pub diversity: f64,
    /// Points that may be the true minimum: their widened intervals overlap that of the smallest upper end.
    pub candidates: usize,
    /// Largest relative half-width of the readings.
    pub worst_relative: f64,
}

/// `None` without readings.
pub fn uniformity(readings: &[Estimate], precision: &Precision) -> Option<Uniformity> {
    let n = readings.len() as f64;
    let by_value = |a: &&Estimate, b: &&Estimate| a.value.total_cmp(&b.value);
    let (min, max) = (*readings.iter().min_by(by_value)?, *readings.iter().max_by(by_value)?);
    let sum = readings.iter().copied().reduce(Estimate::plus_independent)?;
    let mean = sum.scaled(1.0 / n);
    // n points and the mean: each may fail with an equal share of the probability.
    let widening = widening(precision.confidence, n + 1.0);
    let low = |e: &Estimate| (e.value - widening * e.half_width).max(0.0);
    let high = |e: &Estimate| e.value + widening * e.half_width;
    let lowest = readings.iter().map(low).fold(f64::INFINITY, f64::min);
    let highest = readings.iter().map(high).fold(f64::INFINITY, f64::min);
    let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { f64::NAN };
    Some(Uniformity {
        mean,
        min,
        max,
        u0: ratio(min.value, mean.value),
        u0_interval: Interval {
            low: ratio(lowest, high(&mean)),
            high: if low(&mean) > 0.0 { highest / low(&mean) } else { f64::INFINITY }.min(1.0),
        },
        diversity: ratio(min.value, max.value),
        candidates: readings.iter().filter(|e| low(e) <= highest).count(),
        worst_relative: readings.iter().map(|e| e.relative()).fold(0.0, f64::max),
    })
}

/// By which factor the half-widths of `count` intervals of a level grow when all of them shall hold at once with it.
pub fn widening(confidence: f64, count: f64) -> f64 {
    let Ok(normal) = Normal::new(0.0, 1.0) else { return 1.0 };
    let outside = 1.0 - confidence;
    normal.inverse_cdf(1.0 - 0.5 * outside / count.max(1.0)) / normal.inverse_cdf(1.0 - 0.5 * outside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    #[test]
    fn exact_readings_have_an_exact_uniformity() {
        let readings = [300.0, 500.0, 400.0, 800.0].map(Estimate::exact);
        let u = uniformity(&readings, &Precision::default()).unwrap();
        assert_eq!((u.mean.value, u.min.value, u.max.value), (500.0, 300.0, 800.0));
        assert_eq!((u.u0, u.u0_interval), (0.6, Interval { low: 0.6, high: 0.6 }));
        assert_eq!((u.diversity, u.candidates, u.worst_relative), (0.375, 1, 0.0));
        assert!(uniformity(&[], &Precision::default()).is_none());
    }

    #[test]
    fn intervals_widen_as_bonferroni_says() {
        // z(1 − 0.05/2) = 1.959964, z(1 − 0.05/20) = 2.807034.
        assert!((widening(0.95, 10.0) - 2.807_034 / 1.959_964).abs() < 1e-6);
        assert!((widening(0.95, 1.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_interval_holds_the_true_uniformity_of_noisy_points_and_the_bare_ratio_is_biased() {
        // 60 points of 500 lx, one of 480 lx, 5 % noise: U0 = 480/(30480/61) = 0.96063. Over 2000 seeds the interval must
        // hold it in at least 95 % of the runs; z-test at α = 0.001 allows 93.5 %.
        let mut rng = Pcg32::new(17, 1);
        let mut normal = || (0..12).map(|_| f64::from(rng.next_f32())).sum::<f64>() - 6.0;
        let truth = 480.0 / (30_480.0 / 61.0);
        let (mut held, mut bare) = (0, 0.0);
        let runs = 2000;
        for _ in 0..runs {
            let readings: Vec<_> = (0..61)
                .map(|i| {
                    let value: f64 = if i == 7 { 480.0 } else { 500.0 };
                    let half_width = 1.96 * 0.05 * value;
                    Estimate { value: value + 0.05 * value * normal(), half_width }
                })
                .collect();
            let u = uniformity(&readings, &Precision::default()).unwrap();
            held += i32::from(u.u0_interval.low <= truth && truth <= u.u0_interval.high);
            bare += u.u0 / f64::from(runs);
        }
        assert!(f64::from(held) / f64::from(runs) > 0.935, "{held}");
        // The smallest of 61 lies about 2.3 standard deviations low.
        assert!(bare < truth - 0.05, "{bare} {truth}");
    }
}
