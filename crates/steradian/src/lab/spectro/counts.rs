//! What becomes of photons, counted one by one.

use crate::lab::precision::{Moments, Precision};
use crate::lab::session::Tally;
use crate::spectrum::LANES;
use crate::units::Estimate;
use statrs::function::beta::checked_beta_reg;

/// What can become of a photon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It leaves on the side that it came from.
    Reflected,
    /// It leaves on the other side.
    Transmitted,
    /// It ends.
    Absorbed,
}

/// The photons of one wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Count {
    fates: [u64; 3],
    /// Reflected photons that the viewing cone caught.
    viewed: u64,
    /// Photons that left beyond the one that came.
    overdrawn: u64,
    /// Photons that ended in no fate: weights that are no numbers.
    lost: u64,
}

impl Count {
    /// Books a photon whose energy left times `weight` ≥ 0 to one side: it is a photon with that probability, and ends here
    /// with the rest. A weight above one is that many photons, and shows in the sum of all fates.
    ///
    /// `u` ∈ [0, 1) decides.
    pub(super) fn book(&mut self, fate: Fate, weight: f32, is_viewed: bool, u: f32) {
        if !(weight >= 0.0 && weight.is_finite()) {
            self.lost += 1;
            return;
        }
        // Weights of lossless samples are one but for rounding.
        let weight = if (weight - 1.0).abs() < ROUNDING { 1.0 } else { weight };
        let whole = weight.floor();
        let photons = whole as u64 + u64::from(u < weight - whole);
        if photons == 0 {
            self.fates[Fate::Absorbed as usize] += 1;
            return;
        }
        self.fates[fate as usize] += photons;
        self.overdrawn += photons - 1;
        if is_viewed {
            self.viewed += photons;
        }
    }

    /// Books a photon that ends.
    pub(super) fn absorb(&mut self) {
        self.fates[Fate::Absorbed as usize] += 1;
    }

    fn add(&mut self, other: &Self) {
        for (mine, more) in self.fates.iter_mut().zip(other.fates) {
            *mine += more;
        }
        self.viewed += other.viewed;
        self.overdrawn += other.overdrawn;
        self.lost += other.lost;
    }

    fn of(&self, quantity: Quantity) -> u64 {
        match quantity {
            Quantity::Fate(fate) => self.fates[fate as usize],
            Quantity::Sum => self.fates.iter().sum(),
            Quantity::Viewed => self.viewed,
        }
    }
}

const ROUNDING: f32 = 1e-5;

/// What is asked of the counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// The share of one fate.
    Fate(Fate),
    /// The share of all fates together: one, unless light is made or lost.
    Sum,
    /// The share that the viewing cone caught.
    Viewed,
}

impl Quantity {
    const ALL: [Self; 5] = [
        Self::Fate(Fate::Reflected),
        Self::Fate(Fate::Transmitted),
        Self::Fate(Fate::Absorbed),
        Self::Sum,
        Self::Viewed,
    ];
}

/// The photons of the wavelengths of one scattering function.
#[derive(Clone, Debug, Default)]
pub(super) struct Ledger {
    photons: u64,
    counts: [Count; LANES],
    /// Means of blocks: what intervals are made from where some photon counted more than once.
    means: [[Moments; 5]; LANES],
}

impl Ledger {
    /// Adds a block of `photons` photons for each wavelength.
    pub(super) fn close(&mut self, photons: u64, counts: &[Count; LANES]) {
        self.photons += photons;
        for ((count, total), means) in counts.iter().zip(&mut self.counts).zip(&mut self.means) {
            total.add(count);
            for (mean, quantity) in means.iter_mut().zip(Quantity::ALL) {
                mean.add(count.of(quantity) as f64 / photons as f64);
            }
        }
    }

    /// A share of the photons of a wavelength with its interval: the exact one of binomial counts (Clopper & Pearson 1934),
    /// or Student's of block means where photons counted more than once.
    pub(super) fn estimate(&self, lane: usize, quantity: Quantity, precision: &Precision) -> Estimate {
        let count = &self.counts[lane];
        if count.overdrawn == 0 {
            return match quantity {
                Quantity::Sum if count.lost == 0 => Estimate::exact(1.0),
                _ => binomial(count.of(quantity), self.photons, precision.confidence),
            };
        }
        let i = Quantity::ALL.iter().position(|q| *q == quantity).unwrap_or(0);
        self.means[lane][i].estimate(precision)
    }

    /// Whether some photon of a wavelength counted more than once, or not at all.
    pub(super) fn is_unbalanced(&self, lane: usize) -> bool {
        self.counts[lane].overdrawn + self.counts[lane].lost > 0
    }
}

impl Tally for Ledger {
    fn merge(&mut self, later: &Self) {
        self.photons += later.photons;
        for (mine, more) in self.counts.iter_mut().zip(&later.counts) {
            mine.add(more);
        }
        for (mine, more) in self.means.iter_mut().flatten().zip(later.means.iter().flatten()) {
            mine.merge(more);
        }
    }

    fn rays(&self) -> u64 {
        self.photons
    }
}

/// Counts beyond which the interval has its asymptotic form, to a thousandth of its width.
const MANY: u64 = 1000;

/// The share `count` of `total` with the half-width that covers the exact interval on both sides (Clopper & Pearson 1934).
pub fn binomial(count: u64, total: u64, confidence: f64) -> Estimate {
    if total == 0 {
        return Estimate { value: 0.0, half_width: f64::INFINITY };
    }
    let (k, n) = (count as f64, total as f64);
    let share = k / n;
    let tail = 0.5 * (1.0 - confidence);
    let rare = count.min(total.saturating_sub(count));
    if rare == 0 {
        // (1 − p)ⁿ = α/2.
        return Estimate { value: share, half_width: -(tail.ln() / n).exp_m1() };
    }
    let half_width = if rare > MANY {
        let normal = Precision { confidence, ..Precision::default() };
        let z = normal.half_width(1.0, total);
        let skew = (1.0 - 2.0 * share).abs();
        // The next term of the expansion in 1/√n, as the Poisson distribution's limit has it.
        z * (share * (1.0 - share) / n).sqrt() + (0.5 + skew * (2.0 * z * z + 1.0) / 6.0) / n
    } else {
        // The ends p solve P(X ≥ k) = α/2 and P(X ≤ k) = α/2, which are incomplete beta functions of p.
        let at_least = |k: f64, p: f64| checked_beta_reg(k, n - k + 1.0, p).unwrap_or(0.5);
        let lower = bisected([0.0, share], |p| at_least(k, p) < tail);
        let upper = bisected([share, 1.0], |p| 1.0 - at_least(k + 1.0, p) > tail);
        (share - lower).max(upper - share)
    };
    Estimate { value: share, half_width }
}

/// Where `is_below` ends to hold between two places, at the first of which it does.
fn bisected([mut from, mut to]: [f64; 2], is_below: impl Fn(f64) -> bool) -> f64 {
    // Half the way in logarithms while the ends differ by factors: rare events have their place near zero.
    for _ in 0..60 {
        let middle = if from > 0.0 && to > 2.0 * from { (from * to).sqrt() } else { 0.5 * (from + to) };
        if is_below(middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_of_counts_are_the_exact_ones() {
        // No event among n: the upper end solves (1 − p)^n = α/2.
        for n in [10_u64, 1000, 1_000_000] {
            let upper = 1.0 - 0.025_f64.powf(1.0 / n as f64);
            assert!((binomial(0, n, 0.95).half_width / upper - 1.0).abs() < 1e-6, "{n}");
            assert!((binomial(n, n, 0.95).half_width / upper - 1.0).abs() < 1e-6, "{n}");
        }
        // The ends solve P(X ≥ k) = α/2 and P(X ≤ k) = α/2: 1 of 10, as tables have it.
        let one = binomial(1, 10, 0.95);
        assert!((one.value + one.half_width - 0.445_016).abs() < 1e-5, "{one:?}");
        assert_eq!(binomial(0, 0, 0.95).half_width, f64::INFINITY);
    }

    #[test]
    fn both_forms_of_the_interval_meet() {
        for share in [1e-5, 0.01, 0.3, 0.499] {
            let n = (MANY as f64 / share) as u64;
            for confidence in [0.95, 0.999] {
                // The width itself grows with the root of the count.
                let [exact, asymptotic] = [MANY, MANY + 1].map(|k| binomial(k, n, confidence).half_width);
                assert!((asymptotic / exact - 1.0).abs() < 3e-3, "{share}: {exact} {asymptotic}");
            }
        }
    }

    #[test]
    fn every_photon_ends_once_unless_energy_is_made() {
        let mut count = Count::default();
        for (weight, u) in [(0.3, 0.2), (0.3, 0.4), (1.0, 0.9), (1.000_001, 0.0)] {
            count.book(Fate::Reflected, weight, true, u);
        }
        count.absorb();
        assert_eq!((count.fates, count.viewed, count.overdrawn), ([3, 0, 2], 3, 0));
        count.book(Fate::Transmitted, 2.3, false, 0.2);
        assert_eq!((count.fates, count.overdrawn), ([3, 3, 2], 2));
        count.book(Fate::Transmitted, f32::NAN, false, 0.2);
        assert_eq!((count.of(Quantity::Sum), count.lost), (8, 1));
    }
}
