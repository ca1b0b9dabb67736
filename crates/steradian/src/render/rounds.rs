//! Rounds and passes: how the samples of a render follow one another.
//!
//! A *round* is a range of sample indices whose ends depend on the job alone: what is decided or learned from samples is
//! decided between rounds. Within a round, *passes* over all tiles are cut by time, so that a stop leaves a complete
//! picture with fewer samples; nothing may depend on where they end.

use super::options::RenderOptions;
use super::progress::{CancelToken, Progress, ProgressSink};
use super::report::Report;
use super::schedule;
use super::worker::{Log, State};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Pixels along the side of a tile: small enough to balance load at the end of a pass, large enough that
/// the queue's lock does not show.
pub(super) const TILE_SIDE: u32 = 16;

/// Aimed length of a pass: how long a user waits for Ctrl-C or a time limit to take effect.
const PASS_TIME: Duration = Duration::from_millis(1500);

/// Executes rounds, and keeps count.
pub(super) struct Passes<'a> {
    options: &'a RenderOptions,
    sink: &'a dyn ProgressSink,
    cancel: &'a CancelToken,
    start: Instant,
    /// Indices of the next pass, as time allows.
    length: u32,
    threads: usize,
    pixels: u64,
    samples: AtomicU64,
    rays: AtomicU64,
    log: Log,
}

/// How a round ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RoundEnd {
    /// The first index that was not executed.
    pub(super) next: u32,
    /// Whether the user or the clock asks for no more.
    pub(super) stopped: bool,
}

impl<'a> Passes<'a> {
    pub(super) fn new(
        options: &'a RenderOptions,
        sink: &'a dyn ProgressSink,
        cancel: &'a CancelToken,
        pixels: u64,
    ) -> Self {
        let all = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        Self {
            options,
            sink,
            cancel,
            start: Instant::now(),
            length: 1,
            threads: options.threads.unwrap_or_else(all).max(1),
            pixels,
            samples: AtomicU64::new(0),
            rays: AtomicU64::new(0),
            log: Log::default(),
        }
    }

    /// Executes the samples `indices` on all items. `work` does a part of them on one item and returns how many samples
    /// it took; `expected` is the number that the whole render will take, as far as is known.
    pub(super) fn round<T: Send>(
        &mut self,
        items: &mut [T],
        indices: Range<u32>,
        expected: u64,
        state: impl Fn() -> State + Sync,
        work: impl Fn(&mut State, &mut T, Range<u32>) -> u64 + Sync,
    ) -> RoundEnd {
        let mut next = indices.start;
        while next < indices.end {
            let pass = next..next.saturating_add(self.length).min(indices.end);
            let pass_start = Instant::now();
            let (samples, rays) = (&self.samples, &self.rays);
            let states =
                schedule::for_each(items, self.options.tile_order, self.threads, &state, |state, item| {
                    let rays_before = state.log.tally.rays();
                    let taken = work(state, item, pass.clone());
                    let traced = state.log.tally.rays() - rays_before;
                    let samples_done = samples.fetch_add(taken, Ordering::Relaxed) + taken;
                    self.sink.update(&Progress {
                        samples_done,
                        samples_total: expected.max(samples_done),
                        spp_done: (samples_done / self.pixels) as u32,
                        rays: rays.fetch_add(traced, Ordering::Relaxed) + traced,
                        elapsed: self.start.elapsed(),
                    });
                });
            for state in &states {
                self.log.tally = self.log.tally.merge(state.log.tally);
                self.log.dropped.merge(&state.log.dropped);
            }
            let done = pass.end - next;
            next = pass.end;
            let over_time = self.options.time_limit.is_some_and(|limit| self.start.elapsed() >= limit);
            if self.cancel.is_cancelled() || over_time {
                return RoundEnd { next, stopped: true };
            }
            // At most twice the last pass: the first passes are too short to predict from.
            let seconds = pass_start.elapsed().as_secs_f64().max(1e-9);
            let aimed = PASS_TIME.as_secs_f64() / seconds * f64::from(done);
            self.length = (aimed as u32).clamp(1, done.saturating_mul(2));
        }
        RoundEnd { next, stopped: false }
    }

    /// What was done.
    pub(super) fn report(self) -> Report {
        Report {
            pixels: self.pixels,
            threads: self.threads,
            elapsed: self.start.elapsed(),
            tally: self.log.tally,
            dropped: self.log.dropped,
            ..Report::default()
        }
    }
}
