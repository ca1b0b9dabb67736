//! When an instrument has measured enough.

use crate::units::Estimate;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Degrees of freedom beyond which Student's distribution is the normal one and a small correction, to 1e-6.
const MANY: u64 = 1000;

/// The precision that is asked of an instrument.
///
/// A number is precise enough when the half-width of its interval is at most `relative` of its absolute value, or at most
/// `absolute`. Whatever was asked for, no more than `max_rays` are traced, but for the last block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// Share of the value, above 0; 0.01 for 1 %.
    pub relative: f64,
    /// In the unit of the number; 0 for no floor.
    pub absolute: f64,
    /// Level of the intervals, within (0, 1).
    pub confidence: f64,
    /// Most rays.
    pub max_rays: u64,
}

impl Default for Precision {
    /// 1 % at 95 %, with at most 10⁹ rays.
    fn default() -> Self {
        Self { relative: 0.01, absolute: 0.0, confidence: 0.95, max_rays: 1_000_000_000 }
    }
}

impl Precision {
    /// The widest half-width that is precise enough for a number of this value.
    pub fn target(&self, value: f64) -> f64 {
        (self.relative * value.abs()).max(self.absolute)
    }

    /// By which factor the number of samples must grow until the estimate is precise enough; at most 1 when it is.
    /// Widths shrink with the square root of the number of samples.
    pub fn demand(&self, estimate: Estimate) -> f64 {
        if estimate.half_width == 0.0 {
            return 0.0;
        }
        (estimate.half_width / self.target(estimate.value)).powi(2)
    }

    /// The demand of the worst of several estimates; 0 for none.
    pub fn worst_demand(&self, estimates: impl IntoIterator<Item = Estimate>) -> f64 {
        estimates.into_iter().map(|e| self.demand(e)).fold(0.0, worse)
    }

    /// What a quantity of which `samples` samples have shown nothing may still amount to, at the level of the intervals:
    /// light is then less frequent than −ln(1 − level)/samples (the rule of three), and none is taken to be brighter than
    /// `brightest`, a single sample's worth.
    pub fn unseen(&self, samples: u64, brightest: f64) -> f64 {
        -(1.0 - self.confidence).ln() / samples.max(1) as f64 * brightest
    }

    /// Half-width of the interval of a mean with the given standard error, by Student's t.
    pub fn half_width(&self, standard_error: f64, degrees_of_freedom: u64) -> f64 {
        // Beyond any float's reach for no degrees of freedom: nothing is known.
        if degrees_of_freedom == 0 {
            return f64::INFINITY;
        }
        let level = 0.5 + 0.5 * self.confidence;
        let quantile = if degrees_of_freedom > MANY {
            // The next term of the expansion about the normal distribution; the search for t's own does not end for millions.
            let z = Normal::standard().inverse_cdf(level);
            z + (z.powi(3) + z) / (4.0 * degrees_of_freedom as f64)
        } else {
            StudentsT::new(0.0, 1.0, degrees_of_freedom as f64)
                .map_or(f64::INFINITY, |t| t.inverse_cdf(level))
        };
        quantile * standard_error
    }
}

/// The larger demand, where one that is no number is the largest.
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// Mean and variance of independent observations, in one pass (Welford 1962; merged as in Chan et al. 1979).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    /// One more observation.
    pub fn add(&mut self, x: f64) {
        self.count += 1;
        let delta = x - self.mean;
        self.mean += delta / self.count as f64;
        self.squares += delta * (x - self.mean);
    }

    /// The observations of both.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let delta = other.mean - self.mean;
        self.count += other.count;
        self.mean += delta * b / (a + b);
        self.squares += other.squares + delta * delta * a * b / (a + b);
    }

    /// Number of observations.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Their variance, unbiased; infinite for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::INFINITY } else { self.squares / (self.count - 1) as f64 }
    }

    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count.max(1) as f64).sqrt()
    }

    /// The mean with its interval.
    pub fn estimate(&self, precision: &Precision) -> Estimate {
        // What never varied is exact up to the rounding of the sums.
        let half_width =
            match self.count > 1 && self.squares <= (1e-14 * self.mean).powi(2) * self.count as f64 {
                true => 0.0,
                false => precision.half_width(self.standard_error(), self.count.saturating_sub(1)),
            };
        Estimate { value: self.mean, half_width }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn students_quantiles_are_those_of_the_tables() {
        let p = Precision::default();
        for (dof, quantile) in [(1, 12.706), (10, 2.228), (30, 2.042), (1000, 1.962)] {
            assert!((p.half_width(1.0, dof) - quantile).abs() < 1e-3, "{dof}");
        }
        let wide = Precision { confidence: 0.99, ..p };
        assert!((wide.half_width(2.0, 10) - 2.0 * 3.169).abs() < 2e-3);
        assert_eq!(p.half_width(1.0, 0), f64::INFINITY);
        // Both forms meet, and the largest counts have the normal quantile.
        assert!((p.half_width(1.0, MANY) / p.half_width(1.0, MANY + 1) - 1.0).abs() < 1e-5);
        assert!((p.half_width(1.0, 1_000_000_000) - 1.959_964).abs() < 1e-6);
    }

    #[test]
    fn merging_equals_adding_all() {
        let data: Vec<f64> = (0..100).map(|i| f64::from(i * i % 37)).collect();
        let all = |xs: &[f64]| {
            let mut m = Moments::default();
            xs.iter().for_each(|&x| m.add(x));
            m
        };
        let (whole, mut left) = (all(&data), all(&data[..33]));
        left.merge(&all(&data[33..]));
        assert!((whole.mean() - left.mean()).abs() < 1e-12);
        assert!((whole.variance() / left.variance() - 1.0).abs() < 1e-12);
        let direct = data.iter().map(|x| (x - whole.mean()).powi(2)).sum::<f64>() / 99.0;
        assert!((whole.variance() / direct - 1.0).abs() < 1e-12);
        assert!(all(&[0.1; 50]).estimate(&Precision::default()).half_width == 0.0);
    }

    #[test]
    fn demand_is_the_square_of_the_excess_width() {
        let p = Precision { absolute: 0.5, ..Precision::default() };
        assert!((p.demand(Estimate { value: 100.0, half_width: 2.0 }) - 4.0).abs() < 1e-12);
        assert!(p.demand(Estimate { value: 0.0, half_width: 0.4 }) < 1.0, "the floor");
        assert_eq!(p.demand(Estimate::exact(0.0)), 0.0);
    }
}
