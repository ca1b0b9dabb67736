//! Sampling until a precision is met: the part that all instruments share.
//!
//! Samples come in blocks. A block is one randomisation of a low-discrepancy set (or a run of independent samples), so that
//! blocks are independent of each other and the spread of their means is an honest measure of error whatever happens inside.
//! The number of blocks grows in stages: after each, the precision that was reached predicts how many are needed.

use super::precision::Precision;
use crate::math::hash;
use crate::render::CancelToken;
use crate::render::schedule::{TileOrder, for_each};
use crate::sampler::{Randomization, Sampler, SamplerKind};
use std::ops::Range;

/// Blocks of the first stage: Student's t then has 31 degrees of freedom.
const FIRST_BLOCKS: u64 = 32;

/// Shares of a stage that threads take from the queue. Their number, and not that of the threads, decides in which order sums
/// are formed.
const SHARES: u64 = 64;

/// Shares that are in work at the same time: enough that threads seldom wait for each other.
const SHARES_PER_THREAD: u64 = 4;

/// How a measurement is carried out.
#[derive(Clone, Copy, Debug)]
pub struct Session<'a> {
    /// When to stop.
    pub precision: Precision,
    /// Seed of the random numbers; the same seed gives the same bits for any number of threads.
    pub seed: u64,
    /// Threads; `None` uses all that the machine offers.
    pub threads: Option<usize>,
    /// Ends the measurement early; what is known by then is reported with its wider interval.
    pub cancel: &'a CancelToken,
}

/// One block of samples.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Its number.
    pub index: u64,
    /// Seed for everything that is random in it.
    pub seed: u64,
}

impl Block {
    /// A part of the block with random numbers of its own.
    #[must_use]
    pub fn split(&self, part: u64) -> Self {
        Self { seed: hash::combine(self.seed, part), ..*self }
    }

    /// The low-discrepancy set of the block, of `samples` points: sample `i` begins with `start([0, 0], i)`.
    pub fn sampler(&self, samples: u32) -> Sampler {
        Sampler::new(SamplerKind::PaddedSobol(Randomization::FastOwen), samples, [1, 1], self.seed)
    }
}

/// What blocks add up to.
pub trait Tally: Send {
    /// Adds what later blocks found.
    fn merge(&mut self, later: &Self);
    /// Rays traced, or random walks taken.
    fn rays(&self) -> u64;
}

/// What a measurement came to.
#[derive(Clone, Debug)]
pub struct Outcome<T> {
    /// The sums.
    pub tally: T,
    /// Blocks taken.
    pub blocks: u64,
    /// Why no more were taken.
    pub ending: Ending,
}

/// Why a measurement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The precision is met.
    Precise,
    /// The ray limit is reached.
    RayLimit,
    /// The user wanted no more.
    Cancelled,
}

impl Ending {
    /// For people and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Precise => "precision met",
            Self::RayLimit => "ray limit reached before the precision was met",
            Self::Cancelled => "stopped before the precision was met",
        }
    }
}

impl Session<'_> {
    /// Takes blocks until `demand` of what they add up to is at most 1: the factor by which the number of blocks must
    /// still grow, as by [`Precision::demand`] of the worst of the numbers that are wanted.
    ///
    /// `stream` tells measurements of one session apart: each has its own random numbers.
    pub fn run<T: Tally>(
        &self,
        stream: u64,
        fresh: impl Fn() -> T + Sync,
        block: impl Fn(&mut T, Block) + Sync,
        demand: impl Fn(&T) -> f64,
    ) -> Outcome<T> {
        let threads = self
            .threads
            .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
        let seed = hash::hash_words(&[self.seed, stream]);
        let mut tally = fresh();
        // One block tells how many rays a block takes.
        let mut done = self.stage(0..1, threads, seed, &fresh, &block, &mut tally);
        let reach = self.precision.max_rays / tally.rays().max(1);
        let mut end = FIRST_BLOCKS.min(reach).max(2);
        loop {
            done += self.stage(done..end, threads, seed, &fresh, &block, &mut tally);
            let needed = demand(&tally);
            let ending = if needed <= 1.0 {
                Some(Ending::Precise)
            } else if self.cancel.is_cancelled() {
                Some(Ending::Cancelled)
            } else if tally.rays() >= self.precision.max_rays {
                Some(Ending::RayLimit)
            } else {
                None
            };
            if let Some(ending) = ending {
                return Outcome { tally, blocks: done, ending };
            }
            // A little more than predicted, so that the next look is most often the last: each look at the data is a chance to
            // stop by luck. At most eightfold, since early predictions are rough, and no further than the rays reach.
            let growth = if needed.is_nan() { 8.0 } else { (needed * 1.1).clamp(1.1, 8.0) };
            let per_block = (tally.rays() / done.max(1)).max(1);
            let reach = done.saturating_add((self.precision.max_rays - tally.rays()) / per_block + 1);
            end = ((done as f64 * growth).ceil() as u64).min(reach).max(done + 1);
        }
    }

    /// Takes the blocks, and adds them in the order of their shares. Returns how many were taken: fewer when the user wants no more.
    fn stage<T: Tally>(
        &self,
        blocks: Range<u64>,
        threads: usize,
        seed: u64,
        fresh: &(impl Fn() -> T + Sync),
        block: &(impl Fn(&mut T, Block) + Sync),
        tally: &mut T,
    ) -> u64 {
        let n = blocks.end - blocks.start;
        let shares = SHARES.min(n);
        let bound = |i: u64| blocks.start + n * i / shares;
        let mut taken = 0;
        // A few shares at a time: a tally may be large.
        let at_once = (SHARES_PER_THREAD * threads as u64).max(1);
        for first in (0..shares).step_by(at_once as usize) {
            let mut work: Vec<_> = (first..shares.min(first + at_once))
                .map(|i| Share { blocks: bound(i)..bound(i + 1), taken: 0, sum: fresh() })
                .collect();
            for_each(
                &mut work,
                TileOrder::Scanline,
                threads,
                || (),
                |(), share| {
                    for index in share.blocks.clone() {
                        if self.cancel.is_cancelled() {
                            break;
                        }
                        block(&mut share.sum, Block { index, seed: hash::combine(seed, index) });
                        share.taken += 1;
                    }
                },
            );
            for share in &work {
                tally.merge(&share.sum);
                taken += share.taken;
            }
        }
        taken
    }
}

/// What one thread does at a time.
struct Share<T> {
    blocks: Range<u64>,
    taken: u64,
    sum: T,
}

#[cfg(test)]
mod tests {
    use super::super::precision::Moments;
    use super::*;
    use crate::math::hash::Pcg32;

    #[derive(Clone, Default, PartialEq, Debug)]
    struct Means {
        moments: Moments,
        rays: u64,
    }

    impl Tally for Means {
        fn merge(&mut self, later: &Self) {
            self.moments.merge(&later.moments);
            self.rays += later.rays;
        }
        fn rays(&self) -> u64 {
            self.rays
        }
    }

    /// The mean of exponential variables, whose blocks of 16 are still skewed.
    fn exponential(precision: Precision, seed: u64, threads: usize) -> Outcome<Means> {
        let cancel = CancelToken::new();
        let session = Session { precision, seed, threads: Some(threads), cancel: &cancel };
        let block = |means: &mut Means, block: Block| {
            let mut rng = Pcg32::new(block.seed, 0);
            let sum: f64 = (0..16).map(|_| -f64::from(1.0 - rng.next_f32()).ln()).sum();
            means.moments.add(sum / 16.0);
            means.rays += 16;
        };
        session.run(0, Means::default, block, |m| precision.demand(m.moments.estimate(&precision)))
    }

    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say_although_the_data_decide_when_to_stop() {
        for (confidence, relative) in [(0.95, 0.05), (0.95, 0.01), (0.8, 0.03)] {
            let precision = Precision { relative, confidence, ..Precision::default() };
            let runs = 1000;
            let held = (0..runs).filter(|&seed| {
                let outcome = exponential(precision, seed, 1);
                assert_eq!(outcome.ending, Ending::Precise);
                outcome.tally.moments.estimate(&precision).holds(1.0)
            });
            let share = held.count() as f64 / runs as f64;
            // Three standard deviations of a binomial share.
            let band = 3.0 * (confidence * (1.0 - confidence) / runs as f64).sqrt();
            assert!((share - confidence).abs() < band, "{share} of {confidence} at {relative}");
        }
    }

    #[test]
    fn the_bits_do_not_depend_on_the_number_of_threads() {
        let p = Precision::default();
        let one = exponential(p, 3, 1);
        let three = exponential(p, 3, 3);
        assert_eq!((one.tally, one.blocks), (three.tally, three.blocks));
    }

    #[test]
    fn the_ray_limit_ends_what_cannot_become_precise() {
        let p = Precision { relative: 1e-9, max_rays: 10_000, ..Precision::default() };
        let outcome = exponential(p, 1, 2);
        assert_eq!(outcome.ending, Ending::RayLimit);
        assert!((10_000..10_032).contains(&outcome.tally.rays), "{}", outcome.tally.rays);
        // A limit below the first stage counts as well; an interval needs two blocks.
        for (max_rays, expected) in [(1, 32), (100, 112)] {
            let outcome = exponential(Precision { max_rays, ..p }, 1, 2);
            assert_eq!((outcome.ending, outcome.tally.rays), (Ending::RayLimit, expected));
        }
    }

    #[test]
    fn who_wants_no_more_waits_for_one_block_only() {
        let cancel = CancelToken::new();
        let session = Session { precision: Precision::default(), seed: 1, threads: Some(2), cancel: &cancel };
        let block = |means: &mut Means, block: Block| {
            means.moments.add(block.index as f64);
            means.rays += 1;
            if block.index == 40 {
                cancel.cancel();
            }
        };
        let outcome = session.run(0, Means::default, block, |_| 1e9);
        assert_eq!(outcome.ending, Ending::Cancelled);
        assert!(
            (41..=50).contains(&outcome.blocks) && outcome.blocks == outcome.tally.rays,
            "{}",
            outcome.blocks
        );
    }

    #[test]
    fn what_is_no_number_is_not_precise() {
        let cancel = CancelToken::new();
        let precision = Precision { max_rays: 5000, ..Precision::default() };
        let session = Session { precision, seed: 1, threads: Some(1), cancel: &cancel };
        let block = |means: &mut Means, _: Block| means.rays += 1;
        assert_eq!(session.run(0, Means::default, block, |_| f64::NAN).ending, Ending::RayLimit);
    }
}
