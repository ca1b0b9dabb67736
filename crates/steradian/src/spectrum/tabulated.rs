//! Spectra given by samples: sparse and piecewise linear, or dense at 1 nm.

use super::sampled::{LAMBDA_MAX, LAMBDA_MIN, LANES, Wavelengths};
use std::sync::Arc;
use thiserror::Error;

/// Entries of a table at 1 nm over the default range.
const NANOMETRES: usize = (LAMBDA_MAX - LAMBDA_MIN) as usize + 1;

/// Why pairs of wavelength and value do not define a spectrum.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TableError {
    /// There is no pair at all.
    #[error("no samples: a spectrum needs at least one wavelength and value")]
    Empty,
    /// The last wavelength has no value.
    #[error("{count} numbers: wavelengths and values must come in pairs")]
    OddCount {
        /// How many numbers there are.
        count: usize,
    },
    /// A wavelength is not larger than the one before it.
    #[error("wavelength {lambda} nm follows {previous} nm: wavelengths must increase")]
    NotIncreasing {
        /// Index of the offending pair.
        index: usize,
        /// The wavelength before it [nm].
        previous: f32,
        /// The offending wavelength [nm].
        lambda: f32,
    },
    /// A wavelength or value is infinite or not a number.
    #[error("sample {index} is not finite")]
    NotFinite {
        /// Index of the offending pair.
        index: usize,
    },
    /// A wavelength is zero or negative.
    #[error("wavelength {lambda} nm is not positive")]
    NotPositive {
        /// Index of the offending pair.
        index: usize,
        /// The offending wavelength [nm].
        lambda: f32,
    },
}

impl TableError {
    /// Index of the pair that is wrong, where one pair is to blame.
    pub fn pair(&self) -> Option<usize> {
        match *self {
            Self::Empty => None,
            Self::OddCount { count } => Some(count / 2),
            Self::NotIncreasing { index, .. }
            | Self::NotFinite { index }
            | Self::NotPositive { index, .. } => Some(index),
        }
    }
}

/// A sample, and the slope from it to the next one [nm⁻¹]; zero at the last.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    lambda: f32,
    value: f32,
    slope: f32,
}

/// A piecewise linear spectrum through samples of any spacing; zero outside their range. Clones share the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    knots: Arc<[Knot]>,
    /// Knot at or before the start of each of equally wide buckets of the range: finding a wavelength's segment is one
    /// multiplication and, for data no denser than the buckets, at most one step.
    first: Arc<[u32]>,
    buckets_per_nm: f32,
}

/// Bounds the bucket table of a spectrum that spans a huge range.
const MAX_BUCKETS: usize = 8192;

impl Tabulated {
    /// From wavelengths [nm], finite, positive and increasing, each with its finite value.
    pub fn new(pairs: &[(f32, f32)]) -> Result<Self, TableError> {
        if pairs.is_empty() {
            return Err(TableError::Empty);
        }
        for (index, &(lambda, value)) in pairs.iter().enumerate() {
            if !(lambda.is_finite() && value.is_finite()) {
                return Err(TableError::NotFinite { index });
            }
            if lambda <= 0.0 {
                return Err(TableError::NotPositive { index, lambda });
            }
            if index > 0 && lambda <= pairs[index - 1].0 {
                return Err(TableError::NotIncreasing { index, previous: pairs[index - 1].0, lambda });
            }
        }
        Ok(Self::from_sorted(pairs))
    }

    /// From numbers in turn wavelength [nm] and value, as scene files write them.
    pub fn from_interleaved(numbers: &[f32]) -> Result<Self, TableError> {
        if !numbers.len().is_multiple_of(2) {
            return Err(TableError::OddCount { count: numbers.len() });
        }
        let pairs: Vec<_> = numbers.chunks_exact(2).map(|p| (p[0], p[1])).collect();
        Self::new(&pairs)
    }

    fn from_sorted(pairs: &[(f32, f32)]) -> Self {
        let mut knots: Vec<Knot> =
            pairs.iter().map(|&(lambda, value)| Knot { lambda, value, slope: 0.0 }).collect();
        for i in 1..knots.len() {
            let (here, next) = (knots[i - 1], knots[i]);
            knots[i - 1].slope = (next.value - here.value) / (next.lambda - here.lambda);
        }
        let start = knots[0].lambda;
        let range = knots[knots.len() - 1].lambda - start;
        let buckets = (range.ceil() as usize).clamp(1, MAX_BUCKETS);
        let mut knot = 0;
        let first = (0..buckets)
            .map(|b| {
                let bucket_start = start + range * (b as f32 / buckets as f32);
                while knot + 1 < knots.len() && knots[knot + 1].lambda <= bucket_start {
                    knot += 1;
                }
                knot as u32
            })
            .collect();
        let buckets_per_nm = if range > 0.0 { buckets as f32 / range } else { 0.0 };
        Self { knots: knots.into(), first, buckets_per_nm }
    }

    /// The value at `lambda` [nm]; zero outside [`Tabulated::range`].
    pub fn at(&self, lambda: f32) -> f32 {
        let (start, end) = self.range();
        if !(start..=end).contains(&lambda) {
            return 0.0;
        }
        let bucket = ((lambda - start) * self.buckets_per_nm) as usize;
        let mut i = self.first[bucket.min(self.first.len() - 1)] as usize;
        // Rounding can put a wavelength into the bucket after its own.
        while i > 0 && lambda < self.knots[i].lambda {
            i -= 1;
        }
        while i + 1 < self.knots.len() && lambda >= self.knots[i + 1].lambda {
            i += 1;
        }
        let Knot { lambda: left, value, slope } = self.knots[i];
        value + slope * (lambda - left)
    }

    /// First and last wavelength [nm].
    pub fn range(&self) -> (f32, f32) {
        (self.knots[0].lambda, self.knots[self.knots.len() - 1].lambda)
    }

    /// The samples: wavelength [nm] and value.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = (f32, f32)> + '_ {
        self.knots.iter().map(|k| (k.lambda, k.value))
    }

    /// Largest value.
    pub fn max_value(&self) -> f32 {
        self.knots.iter().fold(f32::NEG_INFINITY, |a, k| a.max(k.value))
    }

    /// The same spectrum with every value multiplied by `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        let scaled = |k: &Knot| Knot { value: k.value * factor, slope: k.slope * factor, ..*k };
        Self { knots: self.knots.iter().map(scaled).collect(), ..self }
    }

    /// The spectrum with its first and last value held as far as `min` and `max` [nm].
    ///
    /// pbrt's rule for its built-in spectra, several of which end inside 360–830 nm.
    #[must_use]
    pub fn held_to(self, min: f32, max: f32) -> Self {
        let (start, end) = self.range();
        let mut pairs: Vec<_> = self.samples().collect();
        if min < start {
            pairs.insert(0, (min, self.knots[0].value));
        }
        if max > end {
            pairs.push((max, self.knots[self.knots.len() - 1].value));
        }
        Self::from_sorted(&pairs)
    }
}

/// A spectrum sampled at every nanometre, linear in between and zero outside. Clones share the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    start: f32,
    value: Arc<[f32]>,
}

impl Dense {
    /// Samples `f` at `start`, `start` + 1, … nm; `count` samples (at least one).
    pub fn sample_function(start: f32, count: usize, f: impl Fn(f32) -> f32) -> Self {
        Self { start, value: (0..count.max(1)).map(|i| f(start + i as f32)).collect() }
    }

    /// The value at `lambda` [nm]; zero outside [`Dense::range`].
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        let x = lambda - self.start;
        let last = self.value.len() - 1;
        if !(0.0..=last as f32).contains(&x) {
            return 0.0;
        }
        // Through i32, to which there is a machine instruction.
        let i = x as i32;
        let t = x - i as f32;
        let i = i as usize;
        let a = self.value[i];
        a + t * (self.value[(i + 1).min(last)] - a)
    }

    /// [`Dense::at`] for the wavelengths of a path.
    #[inline(always)]
    pub(super) fn sample(&self, w: &Wavelengths) -> [f32; LANES] {
        if self.start == LAMBDA_MIN && self.value.len() == NANOMETRES {
            return w.look_up(&self.value);
        }
        w.lambda().map(|l| self.at(l))
    }

    /// First and last wavelength [nm].
    pub fn range(&self) -> (f32, f32) {
        (self.start, self.start + (self.value.len() - 1) as f32)
    }

    /// Largest value.
    pub fn max_value(&self) -> f32 {
        self.value.iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b))
    }

    /// The same spectrum with every value multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        Self { start: self.start, value: self.value.iter().map(|v| v * factor).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn reference(pairs: &[(f32, f32)], lambda: f32) -> f32 {
        pairs
            .windows(2)
            .find(|w| (w[0].0..=w[1].0).contains(&lambda))
            .map_or(0.0, |w| w[0].1 + (w[1].1 - w[0].1) * (lambda - w[0].0) / (w[1].0 - w[0].0))
    }

    proptest! {
        #[test]
        fn lookup_agrees_with_a_linear_search(
            steps in prop::collection::vec((0.01_f32..40.0, -2.0_f32..5.0), 2..80),
            at in prop::collection::vec(0.0_f32..1.0, 20),
        ) {
            let mut lambda = 200.0;
            let pairs: Vec<_> = steps.iter().map(|&(d, v)| { lambda += d; (lambda, v) }).collect();
            let table = Tabulated::new(&pairs).unwrap();
            let (lo, hi) = table.range();
            for u in at {
                let l = lo - 5.0 + u * (hi - lo + 10.0);
                prop_assert!((table.at(l) - reference(&pairs, l)).abs() < 2e-4, "{} at {l}", table.at(l));
            }
            for &(l, v) in &pairs {
                prop_assert!((table.at(l) - v).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn one_sample_is_a_spectrum_of_no_width() {
        let t = Tabulated::new(&[(500.0, 3.0)]).unwrap();
        assert_eq!([t.at(499.9), t.at(500.0), t.at(500.1)], [0.0, 3.0, 0.0]);
    }

    #[test]
    fn a_table_over_the_whole_electromagnetic_spectrum_stays_exact() {
        let t = Tabulated::new(&[(1.0, 0.0), (2.0, 1.0), (3.0, 0.0), (1e9, 1.0)]).unwrap();
        assert_eq!(t.at(1.5), 0.5);
        assert_eq!(t.at(2.25), 0.75);
        assert!((t.at(5e8) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn wrong_pairs_are_named() {
        assert_eq!(Tabulated::new(&[]), Err(TableError::Empty));
        assert_eq!(Tabulated::from_interleaved(&[400.0, 1.0, 500.0]), Err(TableError::OddCount { count: 3 }));
        assert_eq!(
            Tabulated::from_interleaved(&[400.0, 1.0, 400.0, 2.0]),
            Err(TableError::NotIncreasing { index: 1, previous: 400.0, lambda: 400.0 })
        );
        assert_eq!(Tabulated::new(&[(400.0, f32::NAN)]), Err(TableError::NotFinite { index: 0 }));
        assert_eq!(Tabulated::new(&[(f32::INFINITY, 1.0)]), Err(TableError::NotFinite { index: 0 }));
        assert_eq!(Tabulated::new(&[(-1.0, 1.0)]), Err(TableError::NotPositive { index: 0, lambda: -1.0 }));
    }

    #[test]
    fn held_ends_continue_the_first_and_last_value() {
        let t = Tabulated::new(&[(400.0, 1.0), (700.0, 4.0)]).unwrap().held_to(360.0, 830.0);
        assert_eq!([t.at(360.0), t.at(399.0), t.at(550.0), t.at(830.0)], [1.0, 1.0, 2.5, 4.0]);
        assert_eq!(t.at(359.0), 0.0);
        assert_eq!(t.clone().held_to(500.0, 600.0), t);
    }

    #[test]
    fn dense_samples_interpolate_and_end() {
        let d = Dense::sample_function(360.0, 471, |l| l);
        assert_eq!(
            [d.at(360.0), d.at(415.25), d.at(830.0), d.at(830.01), d.at(359.9)],
            [360.0, 415.25, 830.0, 0.0, 0.0]
        );
        assert_eq!(d.at(f32::NAN), 0.0);
        assert_eq!(d.scaled(2.0).max_value(), 1660.0);
    }
}
