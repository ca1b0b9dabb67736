//! Adaptive sampling: every pixel is told by its neighbours how many samples to take.
//!
//! Whoever stops when his own samples look quiet keeps those that happen to be quiet, and misses what is rare and bright
//! (Kirk & Arvo 1991, "Unbiased sampling techniques for image synthesis"). So the picture is a checkerboard, and whether a
//! pixel goes on is decided from the pixels of the other colour around it, never from itself. What a pixel finds acts on
//! its own number of samples only through what it makes its neighbours know: whether they go on, and thus tell more, and
//! the picture's common λ, to which one pixel contributes as one among all. That bias is of second order: 0.2 % of the light
//! where half of it is found by one sample in 64, at a noise of 30 %, where deciding for oneself loses 17 % (64 renders).
//!
//! A round doubles the samples of every pixel that wants more. The squared difference between a pixel's samples of its last
//! round and those before estimates the variance of its mean with the gain of low-discrepancy points, which the spread among
//! samples does not show. A pixel that had enough may want more later, when others have found what is rare.

use super::noise::{self, Knowledge, Teller};
use super::report::Adaptive;
use super::rounds::{Passes, TILE_SIDE};
use super::worker::Worker;
use crate::film::{Film, FilmTile, PixelBounds};
use crate::integrator::Integrator;
use crate::scene::{NoiseTarget, RenderJob};
use std::ops::Range;

/// Samples per pixel after which the first round ends; the first decision follows the second.
const FIRST_ROUND: u32 = 8;

/// The dark part of a picture, where errors count relative to this share of the median brightness instead of their own.
const DARK: f32 = 0.1;

/// What a sample costs besides its rays, in rays: camera, wavelengths and film, as on the Cornell box.
const SAMPLE_COST: f32 = 2.0;

/// Renders until the noise meets the target or every pixel has the job's number of samples; returns the tiles of the picture,
/// and what there is to say about them.
pub(super) fn render(
    teller: Teller,
    job: &RenderJob,
    target: NoiseTarget,
    film: &Film,
    integrator: &dyn Integrator,
    passes: &mut Passes<'_>,
) -> (Vec<FilmTile>, Adaptive) {
    let mut tiles: Vec<Tile> =
        film.bounds().tiles(TILE_SIDE).into_iter().map(|b| Tile::new(film, b)).collect();
    let most = job.sampling.spp;
    let worker = Worker::new(job, film, integrator);
    let mut decisions = Decisions::new(film.bounds(), target, most, teller);
    let mut expected = u64::from(most) * film.bounds().area() as u64;
    loop {
        expected = decisions.decide(&mut tiles).unwrap_or(expected);
        let steps = tiles.iter().flat_map(|tile| &tile.open).map(Open::len).max().unwrap_or(0);
        if steps == 0 {
            break;
        }
        let end = passes.round(
            &mut tiles,
            0..steps,
            expected,
            || worker.state(),
            |state, tile, part| {
                let rays_before = state.log.tally.rays();
                let taken = tile.open.iter().map(|open| {
                    let indices = open.at(part.start, steps)..open.at(part.end, steps);
                    worker.add_samples(state, &mut tile.fresh, open.pixel, indices)
                });
                let taken = taken.sum();
                tile.rays += state.log.tally.rays() - rays_before;
                tile.samples += taken;
                taken
            },
        );
        decisions.close_round(film, &mut tiles, end.next, steps);
        if end.stopped {
            break;
        }
    }
    let report = decisions.report();
    (tiles.into_iter().map(|tile| tile.all).collect(), report)
}

/// A pixel that takes samples.
struct Open {
    pixel: [i32; 2],
    /// Which ones in this round.
    indices: Range<u32>,
}

impl Open {
    fn len(&self) -> u32 {
        self.indices.end - self.indices.start
    }

    /// The index at which the pixel is after `done` of a round's `steps`, of which the longest range has one for each index.
    fn at(&self, done: u32, steps: u32) -> u32 {
        self.indices.start + (u64::from(self.len()) * u64::from(done) / u64::from(steps)) as u32
    }
}

/// What one thread works on at a time.
struct Tile {
    /// All samples but those of this round.
    all: FilmTile,
    /// The samples of this round.
    fresh: FilmTile,
    open: Vec<Open>,
    /// Rays and samples so far.
    rays: u64,
    samples: u64,
}

impl Tile {
    fn new(film: &Film, bounds: PixelBounds) -> Self {
        Self { all: film.tile(bounds), fresh: film.tile(bounds), open: Vec::new(), rays: 0, samples: 0 }
    }

    /// Of a sample, in rays: told by so many pixels that none acts on its own number of samples in this way either.
    fn cost(&self) -> f32 {
        SAMPLE_COST + self.rays as f32 / self.samples.max(1) as f32
    }
}

/// What is known about the pixels, and which go on.
struct Decisions {
    bounds: PixelBounds,
    target: NoiseTarget,
    /// Samples that a pixel can have.
    most: u32,
    teller: Teller,
    /// Whether there has been a round whose samples could be compared with as many before.
    informed: bool,
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
            informed: false,
            taken: vec![0; n],
            mean: vec![[0.0; 3]; n],
            variance: vec![0.0; n],
        }
    }

    /// Takes over a round of which `done` of its `steps` were executed.
    fn close_round(&mut self, film: &Film, tiles: &mut [Tile], done: u32, steps: u32) {
        for tile in tiles {
            tile.all.absorb(&tile.fresh);
            for open in &tile.open {
                let (pixel, now) = (open.pixel, open.at(done, steps));
                let Some(at) = self.bounds.index(pixel) else { continue };
                // Only then are the means before and in this round of equally many samples.
                if now > 0 && now == 2 * self.taken[at] {
                    self.informed = true;
                    let fresh = film.rgb(&tile.fresh, pixel).map_or([0.0; 3], |rgb| rgb.0.to_array());
                    let squares: f32 = fresh.iter().zip(self.mean[at]).map(|(a, b)| (a - b) * (a - b)).sum();
                    // Var[x̄] = E[(x̄₂ − x̄₁)²]/4 for the mean of all, and n times that for one sample.
                    self.variance[at] = squares / 3.0 / 4.0 * now as f32;
                }
                self.taken[at] = now;
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
        let around = noise::told(&brightness, &vec![1.0; brightness.len()], width, Teller::All);
        let relative: Vec<f32> = (self.variance.iter().zip(&brightness).zip(around))
            .map(|((v, own), around)| {
                let scale = own.min(around).max(dark);
                if scale > 0.0 { v / (scale * scale) } else { 0.0 }
            })
            .collect();
        // Those who have more samples know more.
        let weights: Vec<f32> = self.taken.iter().map(|&n| n as f32).collect();
        noise::told(&relative, &weights, width, self.teller)
    }

    /// Opens the pixels that want more samples; returns how many the render will take, once that can be foreseen.
    fn decide(&self, tiles: &mut [Tile]) -> Option<u64> {
        let mut cost = vec![SAMPLE_COST; self.taken.len()];
        for tile in &*tiles {
            let of_tile = tile.cost();
            tile.all.bounds().pixels().filter_map(|p| self.bounds.index(p)).for_each(|at| cost[at] = of_tile);
        }
        let variance = if self.informed { self.told() } else { vec![0.0; cost.len()] };
        let known = Knowledge { variance: &variance, cost: &cost, taken: &self.taken };
        let plan = self.informed.then(|| noise::plan(&known, self.target.get().into(), self.most));
        for tile in tiles {
            let wants_more = |pixel: [i32; 2]| {
                let at = self.bounds.index(pixel)?;
                let taken = self.taken[at];
                let goal = plan.map_or(self.most, |plan| known.goal(at, plan.lambda, self.most));
                let end = if taken == 0 { FIRST_ROUND } else { taken.saturating_mul(2) };
                (goal > taken).then(|| Open { pixel, indices: taken..end.min(self.most) })
            };
            tile.open = tile.all.bounds().pixels().filter_map(wants_more).collect();
        }
        plan.map(|plan| plan.samples)
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
