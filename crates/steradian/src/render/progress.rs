//! How a render reports on itself and how it is stopped.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// A snapshot of a running render.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// Pixel samples taken so far.
    pub samples_done: u64,
    /// Pixel samples that the whole render takes.
    pub samples_total: u64,
    /// Samples per pixel so far, on average, rounded down.
    pub spp_done: u32,
    /// Rays traced so far: camera, scattered and shadow rays.
    pub rays: u64,
    /// Time since rendering began.
    pub elapsed: Duration,
}

impl Progress {
    /// Fraction done, in [0, 1].
    pub fn fraction(&self) -> f64 {
        if self.samples_total == 0 { 1.0 } else { self.samples_done as f64 / self.samples_total as f64 }
    }

    /// Million rays per second of wall time.
    pub fn mrays_per_second(&self) -> f64 {
        let seconds = self.elapsed.as_secs_f64();
        if seconds > 0.0 { self.rays as f64 / seconds * 1e-6 } else { 0.0 }
    }

    /// Expected time until the render is complete, from the mean speed so far; `None` before the first sample.
    pub fn remaining(&self) -> Option<Duration> {
        if self.samples_done == 0 {
            return None;
        }
        let rate = self.elapsed.as_secs_f64() / self.samples_done as f64;
        let left = self.samples_total.saturating_sub(self.samples_done);
        Duration::try_from_secs_f64(rate * left as f64).ok()
    }
}

/// Receives snapshots while rendering, from whichever thread finished a tile.
pub trait ProgressSink: Sync {
    /// Called after every tile; must return quickly.
    fn update(&self, progress: &Progress);
}

/// A sink that listens to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl ProgressSink for Silent {
    fn update(&self, _: &Progress) {}
}

/// Asks a render to stop; clones share one flag.
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// A token that has not been cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks for a stop after the current pass. The image keeps every complete pass.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
