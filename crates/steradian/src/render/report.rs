//! What a render has to say about itself afterwards.

use crate::integrator::Tally;
use crate::scene::NoiseTarget;
use std::fmt;
use std::time::Duration;

/// Counts, times and mishaps of one render.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Samples per pixel in the image; the rounded mean where pixels differ.
    pub spp: u32,
    /// Samples per pixel that were asked for, or allowed.
    pub spp_requested: u32,
    /// Pixels rendered.
    pub pixels: u64,
    /// Threads used.
    pub threads: usize,
    /// Wall time of rendering.
    pub elapsed: Duration,
    /// What the paths did.
    pub tally: Tally,
    /// Samples that were not finite.
    pub dropped: Dropped,
    /// How the samples were spread over the picture; `None` when every pixel got the same number.
    pub adaptive: Option<Adaptive>,
}

/// What adaptive sampling did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// The noise that was asked for.
    pub target: NoiseTarget,
    /// The noise of the picture, as defined by [`NoiseTarget`]; `None` when there are too few samples to tell.
    pub noise: Option<f64>,
    /// Samples per pixel in the image, on average.
    pub mean_spp: f64,
    /// Fewest samples of a pixel.
    pub least_spp: u32,
    /// Most samples of a pixel.
    pub largest_spp: u32,
    /// Share of pixels, in [0, 1], around which the noise is below the target.
    pub quiet_share: f64,
    /// Share of pixels, in [0, 1], that took as many samples as they may.
    pub share_at_maximum: f64,
}

impl Adaptive {
    /// Whether the noise is above the target, by more than it is uncertain, and pixels could take no more samples.
    pub fn stopped_by_maximum(&self) -> bool {
        self.share_at_maximum > 0.0
            && self.noise.is_none_or(|noise| noise > 1.05 * f64::from(self.target.get()))
    }
}

impl fmt::Display for Adaptive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.noise {
            Some(noise) => write!(f, "noise {:.3} %", 100.0 * noise)?,
            None => write!(f, "unknown noise")?,
        }
        write!(
            f,
            " (target {}), {:.1} spp on average ({} to {}), {:.1} % of the pixels below the target",
            self.target,
            self.mean_spp,
            self.least_spp,
            self.largest_spp,
            100.0 * self.quiet_share,
        )
    }
}

/// Samples that were NaN or infinite; they were left out of the image.
#[derive(Clone, Debug, Default)]
pub struct Dropped {
    /// How many.
    pub count: u64,
    /// The first of them in order of pixel and sample, at most [`Dropped::KEPT`].
    pub first: Vec<DroppedSample>,
}

/// Where a sample was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct DroppedSample {
    /// Column and row.
    pub pixel: [i32; 2],
    /// Index within the pixel.
    pub sample: u32,
}

impl Dropped {
    /// Number of places that are kept.
    pub const KEPT: usize = 8;

    pub(crate) fn add(&mut self, sample: DroppedSample) {
        self.count += 1;
        self.keep(sample);
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        other.first.iter().for_each(|s| self.keep(*s));
    }

    /// Keeps the smallest, so that the report does not depend on which thread came first.
    fn keep(&mut self, sample: DroppedSample) {
        let order = |s: &DroppedSample| (s.pixel[1], s.pixel[0], s.sample);
        let at = self.first.partition_point(|s| order(s) < order(&sample));
        self.first.insert(at, sample);
        self.first.truncate(Self::KEPT);
    }
}

impl Report {
    /// Million rays per second of wall time.
    pub fn mrays_per_second(&self) -> f64 {
        per_second(self.tally.rays() as f64, self.elapsed) * 1e-6
    }

    /// Million pixel samples per second of wall time.
    pub fn msamples_per_second(&self) -> f64 {
        per_second(self.tally.paths as f64, self.elapsed) * 1e-6
    }
}

fn per_second(count: f64, time: Duration) -> f64 {
    let seconds = time.as_secs_f64();
    if seconds > 0.0 { count / seconds } else { 0.0 }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let t = &self.tally;
        let per_path = |n: u64| n as f64 / t.paths.max(1) as f64;
        writeln!(f, "samples per pixel    {} of {}", self.spp, self.spp_requested)?;
        if let Some(adaptive) = &self.adaptive {
            writeln!(f, "adaptive             {adaptive}")?;
        }
        writeln!(f, "pixels               {}", self.pixels)?;
        writeln!(f, "paths                {}", t.paths)?;
        writeln!(f, "rays, closest hit    {} ({:.3} per path)", t.closest_rays, per_path(t.closest_rays))?;
        writeln!(f, "rays, shadow         {} ({:.3} per path)", t.shadow_rays, per_path(t.shadow_rays))?;
        writeln!(f, "surface vertices     {} ({:.3} per path)", t.vertices, per_path(t.vertices))?;
        writeln!(f, "ended by roulette    {} ({:.3} per path)", t.roulette_ends, per_path(t.roulette_ends))?;
        writeln!(f, "dropped samples      {}", self.dropped.count)?;
        writeln!(f, "threads              {}", self.threads)?;
        writeln!(f, "render time          {:.3} s", self.elapsed.as_secs_f64())?;
        writeln!(f, "rays per second      {:.3} M", self.mrays_per_second())?;
        write!(f, "samples per second   {:.3} M", self.msamples_per_second())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_dropped_samples_do_not_depend_on_the_order_of_arrival() {
        let all: Vec<_> = (0..20).map(|i| DroppedSample { pixel: [i % 5, i / 5], sample: 3 }).collect();
        let (mut forward, mut backward) = (Dropped::default(), Dropped::default());
        all.iter().for_each(|s| forward.add(*s));
        let mut half = Dropped::default();
        all[..10].iter().rev().for_each(|s| half.add(*s));
        all[10..].iter().rev().for_each(|s| backward.add(*s));
        backward.merge(&half);
        assert_eq!(forward.first, backward.first);
        assert_eq!((forward.count, backward.count), (20, 20));
        assert_eq!(forward.first, all[..Dropped::KEPT]);
    }
}
