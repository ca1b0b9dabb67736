//! Adaptive sampling without bias: two independent halves of the samples, each of which is told by the other when to stop.
//!
//! Whoever stops when the samples look quiet keeps those that happen to be quiet, and misses what is rare and bright
//! (Kirk & Arvo 1991). So every pixel takes pairs of samples from two independent sequences, and whether a half keeps on is
//! decided from the other half alone (two buffers as in Rousselle, Knaus & Zwicker 2012). Given one half, the number of samples that the
//! other keeps is fixed, so its mean is unbiased, and so is the plain mean of both means; to weight them by their counts
//! would bring the bias back. While only one of the halves goes on, the other is sampled to decide for it, and not kept:
//! decisions for one half thus never depend on what was decided for the other.
//!
//! Rounds double the number of pairs. The squared difference between a half's samples of the last round and those before
//! estimates its variance with the gain of low-discrepancy points, which the spread among samples does not show.

use super::TILE_SIDE;
use super::noise::{self, Knowledge};
use super::report::Adaptive;
use super::rounds::Passes;
use super::setup::Estimator;
use super::worker::{Sequences, State, Worker};
use crate::film::{Film, FilmTile, PixelBounds};
use crate::integrator::Notes;
use crate::scene::{NoiseTarget, RenderJob};
use std::ops::Range;

/// Pairs after which the first round ends; the second one ends with the first decision.
const FIRST_ROUND: u32 = 4;

/// The dark part of a picture, where errors count relative to this share of the median brightness instead of their own.
const DARK: f32 = 0.1;

/// Renders until the noise meets the target or every pixel has the job's number of samples; returns the tiles of the picture,
/// and what there is to say about them.
pub(super) fn render(
    job: &RenderJob,
    target: NoiseTarget,
    film: &Film,
    estimator: &mut Estimator<'_>,
    passes: &mut Passes<'_>,
) -> (Vec<FilmTile>, Adaptive) {
    render_told_by([1, 0], job, target, film, estimator, passes)
}

/// The same where each half is told by the given one.
pub(super) fn render_told_by(
    tellers: [usize; 2],
    job: &RenderJob,
    target: NoiseTarget,
    film: &Film,
    estimator: &mut Estimator<'_>,
    passes: &mut Passes<'_>,
) -> (Vec<FilmTile>, Adaptive) {
    let mut tiles: Vec<PairedTile> =
        film.bounds().tiles(TILE_SIDE).into_iter().map(|b| PairedTile::new(film, b)).collect();
    let most = job.sampling.spp / 2;
    let mut decisions = Decisions::new(film.bounds(), target, most, tellers);
    let mut expected = 2 * u64::from(most) * film.bounds().area() as u64;
    let mut done = 0;
    'rounds: while let Some(round_end) = decisions.round_end() {
        while done < round_end {
            // Lessons are counted in samples, of which a pair has two.
            let lesson = estimator
                .next_lesson(2 * done)
                .map(|end| end / 2)
                .filter(|&end| end > done && end <= round_end);
            for tile in &mut tiles {
                tile.notes = lesson.and_then(|_| estimator.notebook());
            }
            let worker = Worker::new(job, film, estimator);
            let end = passes.round(
                &mut tiles,
                done..lesson.unwrap_or(round_end),
                expected,
                || worker.state(Sequences::Two),
                |state, tile, indices| tile.add_samples(&worker, state, indices),
            );
            done = end.next;
            if end.stopped {
                decisions.close_round(film, &mut tiles, done);
                break 'rounds;
            }
            if lesson.is_some() {
                estimator.learn(&job.scene, tiles.iter_mut().filter_map(|tile| tile.notes.take()).collect());
            }
        }
        decisions.close_round(film, &mut tiles, done);
        expected = decisions.decide(&mut tiles);
    }
    decisions.finish(film, tiles)
}

/// A tile with both halves of its samples.
struct PairedTile {
    /// What the picture will be made of.
    kept: [FilmTile; 2],
    /// The samples of this round.
    fresh: [FilmTile; 2],
    /// The pixels that take samples.
    open: Vec<[i32; 2]>,
    notes: Option<Notes>,
}

impl PairedTile {
    fn new(film: &Film, bounds: PixelBounds) -> Self {
        let pair = || [film.tile(bounds), film.tile(bounds)];
        Self { kept: pair(), fresh: pair(), open: bounds.pixels().collect(), notes: None }
    }

    /// Takes the pairs `indices` of every open pixel; returns the number of samples.
    fn add_samples(&mut self, worker: &Worker<'_>, state: &mut State, indices: Range<u32>) -> u64 {
        let Self { fresh, open, notes, .. } = self;
        worker.add_pairs(state, fresh, open, notes.as_mut(), indices.clone());
        2 * open.len() as u64 * u64::from(indices.end - indices.start)
    }

    /// The picture's part: the mean of both halves.
    fn finish(self) -> FilmTile {
        let [mut a, b] = self.kept;
        a.balance(&b);
        a
    }
}

/// Which pixels keep on, and why.
struct Decisions {
    bounds: PixelBounds,
    target: NoiseTarget,
    /// Pairs that a pixel can have.
    most: u32,
    halves: [Half; 2],
    /// For each half, the one that it is told by: the other.
    tellers: [usize; 2],
    /// Pairs that all open pixels have.
    now: u32,
}

/// What is decided about one half of the samples, and what the decisions for the other one are made from.
struct Half {
    /// Pixels whose new samples are kept.
    open: Vec<bool>,
    /// Samples kept.
    kept: Vec<u32>,
    /// Brightness as the teller shows it, up to the moment at which the pixel was closed.
    brightness: Vec<f32>,
    /// Relative variance of one pair as the teller shows it, up to the moment at which the pixel was closed.
    variance: Vec<f32>,
    /// Mean RGB of all samples before this round.
    before: Vec<[f32; 3]>,
    /// Least brightness that errors are relative to, from the first decision on.
    dark: Option<f32>,
}

impl Decisions {
    fn new(bounds: PixelBounds, target: NoiseTarget, most: u32, tellers: [usize; 2]) -> Self {
        let n = bounds.area();
        let half = || Half {
            open: vec![true; n],
            kept: vec![0; n],
            brightness: vec![0.0; n],
            variance: vec![0.0; n],
            before: vec![[0.0; 3]; n],
            dark: None,
        };
        Self { bounds, target, most, halves: [half(), half()], tellers, now: 0 }
    }

    /// Number of pairs at the end of the coming round; `None` when all pixels are closed.
    fn round_end(&self) -> Option<u32> {
        let any_open = self.halves.iter().any(|h| h.open.contains(&true));
        let end = if self.now == 0 { FIRST_ROUND } else { self.now.saturating_mul(2) };
        (any_open && self.now < self.most).then_some(end.min(self.most))
    }

    /// Takes over a round of which `pairs` were executed.
    fn close_round(&mut self, film: &Film, tiles: &mut [PairedTile], pairs: u32) {
        let (first, before) = (self.now == 0, self.now);
        self.now = pairs;
        // Only then are the means before and in this round of equally many samples.
        let doubled = pairs == 2 * before;
        let mut seen = [Vec::new(), Vec::new()];
        for tile in tiles.iter_mut() {
            let bounds = tile.fresh[0].bounds();
            for &pixel in &tile.open {
                let Some(at) = self.bounds.index(pixel) else { continue };
                for (s, half) in self.halves.iter_mut().enumerate() {
                    if half.open[at] {
                        tile.kept[s].absorb(&tile.fresh[s], pixel);
                        half.kept[at] = pairs;
                    }
                    let fresh = film.rgb(&tile.fresh[s], pixel).map_or([0.0; 3], |rgb| rgb.0.to_array());
                    let old = half.before[at];
                    half.before[at] =
                        if first { fresh } else { std::array::from_fn(|c| 0.5 * (old[c] + fresh[c])) };
                    seen[s].push(Seen { at, difference: std::array::from_fn(|c| fresh[c] - old[c]) });
                }
            }
            tile.fresh = [film.tile(bounds), film.tile(bounds)];
        }
        if doubled {
            for told in 0..2 {
                self.learn(told, &seen[self.tellers[told]]);
            }
        }
    }

    /// What the samples of one half show about the noise, for decisions about the half `told`.
    ///
    /// Of a pixel that is closed for `told` nothing more is learned, even where it is still sampled for the other half's sake:
    /// that depends on the samples of `told`.
    fn learn(&mut self, told: usize, seen: &[Seen]) {
        let teller = self.tellers[told];
        for &Seen { at, .. } in seen {
            if self.halves[told].open[at] {
                self.halves[told].brightness[at] = brightness(&self.halves[teller].before[at]);
            }
        }
        let half = &mut self.halves[told];
        let dark = *half.dark.get_or_insert_with(|| dark(&half.brightness));
        let scales = scales(&half.brightness, dark, self.bounds.width());
        for Seen { at, difference } in seen {
            if half.open[*at] {
                // Var[x̄ of a half] = E[(x̄₂ − x̄₁)²]/4, of which the mean with the other half has one half.
                half.variance[*at] = relative(difference, scales[*at]) / 8.0 * self.now as f32;
            }
        }
    }

    /// Closes pixels that have enough; returns how many samples the render will take, as far as is known now.
    fn decide(&mut self, tiles: &mut [PairedTile]) -> u64 {
        let (now, most) = (self.now, self.most);
        let mut expected = 0;
        if now > FIRST_ROUND && now < most {
            for half in &mut self.halves {
                let variance = noise::smoothed(&half.variance, self.bounds.width());
                let known = Knowledge { variance: &variance, kept: &half.kept, open: &half.open };
                let plan = noise::plan(&known, self.target.get().into(), now, most);
                for (open, c) in half.open.iter_mut().zip(variance) {
                    *open &= noise::doubled(c.into(), plan.lambda, now, most) > now;
                }
                expected += plan.samples;
            }
        } else {
            expected = 2 * u64::from(most) * self.bounds.area() as u64;
        }
        let [a, b] = &self.halves;
        for tile in tiles {
            tile.open.retain(|&pixel| self.bounds.index(pixel).is_some_and(|at| a.open[at] || b.open[at]));
        }
        expected
    }

    /// The tiles of the picture, and what there is to say about them.
    fn finish(self, film: &Film, tiles: Vec<PairedTile>) -> (Vec<FilmTile>, Adaptive) {
        let area = self.bounds.area();
        let counts = || (0..area).map(|i| self.halves[0].kept[i] + self.halves[1].kept[i]);
        let total: u64 = counts().map(u64::from).sum();
        let at_maximum = counts().filter(|&n| n >= 2 * self.most).count();
        let (mut means, mut differences) = (vec![0.0; area], vec![[0.0; 3]; area]);
        for tile in &tiles {
            for pixel in tile.kept[0].bounds().pixels() {
                let rgb = |s: usize| film.rgb(&tile.kept[s], pixel).map(|rgb| rgb.0.to_array());
                if let (Some(a), Some(b), Some(at)) = (rgb(0), rgb(1), self.bounds.index(pixel)) {
                    means[at] = brightness(&std::array::from_fn(|c| 0.5 * (a[c] + b[c])));
                    differences[at] = std::array::from_fn(|c| a[c] - b[c]);
                }
            }
        }
        let scales = scales(&means, dark(&means), self.bounds.width());
        // The halves are independent: Var[(x + y)/2] = E[(x − y)²]/4.
        let variance: Vec<f32> = differences.iter().zip(scales).map(|(d, s)| relative(d, s) / 4.0).collect();
        let variance = noise::smoothed(&variance, self.bounds.width());
        let share = |n: usize| n as f64 / area.max(1) as f64;
        let target = f64::from(self.target.get());
        let quiet = variance.iter().filter(|&&v| f64::from(v) <= target * target).count();
        let report = Adaptive {
            target: self.target,
            noise: noise::noise(&variance),
            mean_spp: total as f64 / area.max(1) as f64,
            least_spp: counts().min().unwrap_or(0),
            largest_spp: counts().max().unwrap_or(0),
            quiet_share: share(quiet),
            share_at_maximum: share(at_maximum),
        };
        (tiles.into_iter().map(PairedTile::finish).collect(), report)
    }
}

/// A pixel in one half after a round.
struct Seen {
    at: usize,
    /// Mean RGB of the round minus that of all samples before.
    difference: [f32; 3],
}

/// The brightness below which errors are judged as those of this brightness.
fn dark(brightness: &[f32]) -> f32 {
    let mut lit: Vec<f32> = brightness.iter().copied().filter(|&b| b > 0.0).collect();
    let middle = lit.len() / 2;
    if lit.is_empty() { 0.0 } else { DARK * *lit.select_nth_unstable_by(middle, f32::total_cmp).1 }
}

/// What errors are relative to in each pixel. A pixel that is brighter than its surroundings may be so by accident, and its
/// error must not look small for that.
fn scales(brightness: &[f32], dark: f32, width: usize) -> Vec<f32> {
    let around = noise::smoothed(brightness, width);
    brightness.iter().zip(around).map(|(own, around)| own.min(around).max(dark)).collect()
}

/// Mean square of a difference in the three channels, relative to a brightness squared; 0 where all is black.
fn relative(difference: &[f32; 3], scale: f32) -> f32 {
    let squares = difference.iter().map(|d| d * d).sum::<f32>() / 3.0;
    if scale > 0.0 { squares / (scale * scale) } else { 0.0 }
}

/// Mean of the three channels of the picture, at least 0 [cd/m² × imaging ratio].
fn brightness(rgb: &[f32; 3]) -> f32 {
    (rgb.iter().sum::<f32>() / 3.0).max(0.0)
}
