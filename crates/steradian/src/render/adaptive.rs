//! Adaptive sampling: every pixel is told by its neighbours when to stop.
//!
//! Whoever stops when his own samples look quiet keeps those that happen to be quiet, and misses what is rare and bright
//! (Kirk & Arvo 1991, "Unbiased sampling techniques for image synthesis"). So the picture is a checkerboard, and whether a
//! pixel goes on is decided from the pixels of the other colour around it, never from itself. What a pixel finds acts on
//! its own number of samples only through what it makes its neighbours know: whether they go on, and thus tell more, and
//! the picture's common λ, to which one pixel contributes as one among all. That bias is of second order: 0.2 % of the light
//! where half of it is found by one sample in 64, at a noise of 30 %, where deciding for oneself loses 17 % (64 renders).
//!
//! Rounds double the number of samples. The squared difference between a pixel's samples of the last round and those before
//! estimates the variance of its mean with the gain of low-discrepancy points, which the spread among samples does not show.

use super::noise::{self, Knowledge, Teller};
use super::report::Adaptive;
use super::rounds::{Passes, TILE_SIDE};
use super::setup::Estimator;
use super::worker::Worker;
use crate::film::{Film, FilmTile, PixelBounds};
use crate::integrator::Notes;
use crate::scene::{NoiseTarget, RenderJob};

/// Samples per pixel after which the first round ends; the second one ends with the first decision.
const FIRST_ROUND: u32 = 8;

/// The dark part of a picture, where errors count relative to this share of the median brightness instead of their own.
const DARK: f32 = 0.1;

/// Renders until the noise meets the target or every pixel has the job's number of samples; returns the tiles of the picture,
/// and what there is to say about them.
pub(super) fn render(
    teller: Teller,
    job: &RenderJob,
    target: NoiseTarget,
    film: &Film,
    estimator: &mut Estimator<'_>,
    passes: &mut Passes<'_>,
) -> (Vec<FilmTile>, Adaptive) {
    let mut tiles: Vec<Tile> =
        film.bounds().tiles(TILE_SIDE).into_iter().map(|b| Tile::new(film, b)).collect();
    let most = job.sampling.spp;
    let mut decisions = Decisions::new(film.bounds(), target, most, teller);
    let mut expected = u64::from(most) * film.bounds().area() as u64;
    let mut done = 0;
    let mut stopped = false;
    while let Some(round_end) = decisions.round_end().filter(|_| !stopped) {
        while done < round_end && !stopped {
            let lesson = estimator.next_lesson(done).filter(|&end| end > done && end <= round_end);
            for tile in &mut tiles {
                tile.notes = lesson.and_then(|_| estimator.notebook());
            }
            let worker = Worker::new(job, film, estimator);
            let end = passes.round(
                &mut tiles,
                done..lesson.unwrap_or(round_end),
                expected,
                || worker.state(),
                |state, tile, indices| {
                    let pixels = tile.open.iter().copied();
                    worker.add_samples(state, &mut tile.fresh, pixels, tile.notes.as_mut(), indices)
                },
            );
            (done, stopped) = (end.next, end.stopped);
            if lesson.is_some() && !stopped {
                estimator.learn(&job.scene, tiles.iter_mut().filter_map(|tile| tile.notes.take()).collect());
            }
        }
        decisions.close_round(film, &mut tiles, done);
        expected = decisions.decide(&mut tiles).unwrap_or(expected);
    }
    let report = decisions.report();
    (tiles.into_iter().map(|tile| tile.all).collect(), report)
}

/// What one thread works on at a time.
struct Tile {
    /// All samples but those of this round.
    all: FilmTile,
    /// The samples of this round.
    fresh: FilmTile,
    /// The pixels that take samples.
    open: Vec<[i32; 2]>,
    /// In rounds from which the integrator learns.
    notes: Option<Notes>,
}

impl Tile {
    fn new(film: &Film, bounds: PixelBounds) -> Self {
        let (all, fresh) = (film.tile(bounds), film.tile(bounds));
        Self { all, fresh, open: bounds.pixels().collect(), notes: None }
    }
}

/// What is known about the pixels, and which go on.
struct Decisions {
    bounds: PixelBounds,
    target: NoiseTarget,
    /// Samples that a pixel can have.
    most: u32,
    teller: Teller,
    /// Samples that all open pixels have.
    now: u32,
    /// Whether there has been a round whose samples could be compared with as many before.
    informed: bool,
    open: Vec<bool>,
    /// Samples that a pixel has.
    taken: Vec<u32>,
    /// Mean RGB of its samples.
    mean: Vec<[f32; 3]>,
    /// Mean square over RGB of the standard error of one sample, as the last round shows it [(cd/m² × imaging ratio)²].
    variance: Vec<f32>,
}

impl Decisions {
    fn new(bounds: PixelBounds, target: NoiseTarget, most: u32, teller: Teller) -> Self {
        let n = bounds.area();
        Self {
            bounds,
            target,
            most,
            teller,
            now: 0,
            informed: false,
            open: vec![true; n],
            taken: vec![0; n],
            mean: vec![[0.0; 3]; n],
            variance: vec![0.0; n],
        }
    }

    /// Samples per open pixel at the end of the coming round; `None` when there is nothing left to do.
    fn round_end(&self) -> Option<u32> {
        let end = if self.now == 0 { FIRST_ROUND } else { self.now.saturating_mul(2) };
        (self.open.contains(&true) && self.now < self.most).then_some(end.min(self.most))
    }

    /// Takes over a round that ended at `now` samples.
    fn close_round(&mut self, film: &Film, tiles: &mut [Tile], now: u32) {
        let before = std::mem::replace(&mut self.now, now);
        // Only then are the means before and in this round of equally many samples.
        let doubled = now == 2 * before;
        self.informed |= doubled;
        for tile in tiles {
            tile.all.absorb(&tile.fresh);
            for &pixel in &tile.open {
                let Some(at) = self.bounds.index(pixel) else { continue };
                self.taken[at] = now;
                if doubled {
                    let fresh = film.rgb(&tile.fresh, pixel).map_or([0.0; 3], |rgb| rgb.0.to_array());
                    let squares: f32 = fresh.iter().zip(self.mean[at]).map(|(a, b)| (a - b) * (a - b)).sum();
                    // Var[x̄] = E[(x̄₂ − x̄₁)²]/4 for the mean of all, and n times that for one sample.
                    self.variance[at] = squares / 3.0 / 4.0 * now as f32;
                }
                self.mean[at] = film.rgb(&tile.all, pixel).map_or([0.0; 3], |rgb| rgb.0.to_array());
            }
            tile.fresh = film.tile(tile.fresh.bounds());
        }
    }

    /// Relative variance of one sample, as others tell each pixel.
    fn told(&self) -> Vec<f32> {
        let width = self.bounds.width();
        let brightness: Vec<f32> = self.mean.iter().map(brightness).collect();
        let mut lit: Vec<f32> = brightness.iter().copied().filter(|&b| b > 0.0).collect();
        let middle = lit.len() / 2;
        let dark =
            if lit.is_empty() { 0.0 } else { DARK * *lit.select_nth_unstable_by(middle, f32::total_cmp).1 };
        // A pixel brighter than its surroundings may be so by accident; its error must not look small for that.
        let around = noise::told(&brightness, width, Teller::All);
        let relative: Vec<f32> = (self.variance.iter().zip(&brightness).zip(around))
            .map(|((v, own), around)| {
                let scale = own.min(around).max(dark);
                if scale > 0.0 { v / (scale * scale) } else { 0.0 }
            })
            .collect();
        noise::told(&relative, width, self.teller)
    }

    /// Closes pixels that have enough; returns how many samples the render will take, once that can be foreseen.
    fn decide(&mut self, tiles: &mut [Tile]) -> Option<u64> {
        let (now, most) = (self.now, self.most);
        if !self.informed || now >= most {
            return None;
        }
        let variance = self.told();
        let known = Knowledge { variance: &variance, taken: &self.taken, open: &self.open };
        let plan = noise::plan(&known, self.target.get().into(), now, most);
        for (open, c) in self.open.iter_mut().zip(variance) {
            *open &= noise::doubled(c.into(), plan.lambda, now, most) > now;
        }
        for tile in tiles {
            tile.open.retain(|&pixel| self.bounds.index(pixel).is_some_and(|at| self.open[at]));
        }
        Some(plan.samples)
    }

    fn report(&self) -> Adaptive {
        let variance: Vec<f32> =
            self.told().iter().zip(&self.taken).map(|(c, &n)| c / n.max(1) as f32).collect();
        let share = |n: usize| n as f64 / self.taken.len().max(1) as f64;
        let target = f64::from(self.target.get());
        Adaptive {
            target: self.target,
            noise: self.informed.then(|| noise::noise(&variance)),
            mean_spp: self.taken.iter().map(|&n| f64::from(n)).sum::<f64>() / self.taken.len().max(1) as f64,
            least_spp: self.taken.iter().copied().min().unwrap_or(0),
            largest_spp: self.taken.iter().copied().max().unwrap_or(0),
            quiet_share: share(variance.iter().filter(|&&v| f64::from(v) <= target * target).count()),
            share_at_maximum: share(self.taken.iter().filter(|&&n| n >= self.most).count()),
        }
    }
}

/// Mean of the three channels of the picture, at least 0 [cd/m² × imaging ratio].
fn brightness(rgb: &[f32; 3]) -> f32 {
    (rgb.iter().sum::<f32>() / 3.0).max(0.0)
}
