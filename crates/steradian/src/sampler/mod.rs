//! Sample points: pure functions of pixel, sample index, dimension and seed.
//!
//! A sampler is `Copy`, holds no table and allocates nothing; two threads that ask for the same sample
//! get the same bits, in any order. Numbers lie in [0, 1).

mod halton;
mod independent;
mod padded;
mod position;
mod scramble;
mod sobol;
mod stratified;
mod zsobol;

use crate::math::Vec2;
use position::Position;

pub use halton::Halton;
pub use independent::Independent;
pub use padded::PaddedSobol;
pub use scramble::Randomization;
pub use stratified::Stratified;
pub use zsobol::ZSobol;

/// Which family of points is asked for, as plain data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerKind {
    /// Uniform and independent.
    Independent,
    /// Jittered strata: `x` × `y` cells, and that many samples.
    Stratified {
        /// Cells along the first dimension of a pair.
        x: u32,
        /// Cells along the second dimension.
        y: u32,
        /// Whether samples are placed at random in their cell, or in its centre.
        jitter: bool,
    },
    /// Halton points over the picture.
    Halton(Randomization),
    /// Independently shuffled Sobol' pairs.
    PaddedSobol(Randomization),
    /// Sobol' points in shuffled Morton order of the pixels.
    ZSobol(Randomization),
}

/// A stream of sample points, positioned by [`Sampler::start`].
#[derive(Clone, Copy, Debug)]
pub enum Sampler {
    /// See [`SamplerKind::Independent`].
    Independent(Independent),
    /// See [`SamplerKind::Stratified`].
    Stratified(Stratified),
    /// See [`SamplerKind::Halton`].
    Halton(Halton),
    /// See [`SamplerKind::PaddedSobol`].
    PaddedSobol(PaddedSobol),
    /// See [`SamplerKind::ZSobol`].
    ZSobol(ZSobol),
}

impl Sampler {
    /// A sampler for pictures of `resolution` pixels with about `spp` samples per pixel.
    ///
    /// Counts that are not powers of two are allowed for every kind; Sobol' points are evenest at powers of two (of four in Z-order).
    pub fn new(kind: SamplerKind, spp: u32, resolution: [u32; 2], seed: u64) -> Self {
        let at = Position::new(seed);
        match kind {
            SamplerKind::Independent => Self::Independent(Independent::new(at)),
            SamplerKind::Stratified { x, y, jitter } => {
                Self::Stratified(Stratified { at, x: x.max(1), y: y.max(1), jitter })
            }
            SamplerKind::Halton(r) => Self::Halton(Halton::new(at, r, resolution)),
            SamplerKind::PaddedSobol(randomization) => Self::PaddedSobol(PaddedSobol { at, randomization }),
            SamplerKind::ZSobol(r) => Self::ZSobol(ZSobol::new(at, r, spp, resolution)),
        }
    }

    /// Moves to the first dimension of sample `index` of `pixel`.
    #[inline]
    pub fn start(&mut self, pixel: [i32; 2], index: u32) {
        match self {
            Self::Independent(s) => s.start(pixel, index),
            Self::Stratified(s) => s.at.start(pixel, index),
            Self::Halton(s) => s.start(pixel, index),
            Self::PaddedSobol(s) => s.at.start(pixel, index),
            Self::ZSobol(s) => s.start(pixel, index),
        }
    }

    /// The next number; consumes one dimension.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        match self {
            Self::Independent(s) => s.next_1d(),
            _ => self.next_1d_of_sequence(),
        }
    }

    /// Out of line: a sequence's arithmetic is long, and there are many callers.
    #[inline(never)]
    fn next_1d_of_sequence(&mut self) -> f32 {
        match self {
            Self::Independent(s) => s.next_1d(),
            Self::Stratified(s) => s.next_1d(),
            Self::Halton(s) => s.next_1d(),
            Self::PaddedSobol(s) => s.next_1d(),
            Self::ZSobol(s) => s.next_1d(),
        }
    }

    /// The next pair, stratified jointly; consumes two dimensions.
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        match self {
            Self::Independent(s) => s.next_2d(),
            _ => self.next_2d_of_sequence(),
        }
    }

    /// Out of line: a sequence's arithmetic is long, and there are many callers.
    #[inline(never)]
    fn next_2d_of_sequence(&mut self) -> Vec2 {
        match self {
            Self::Independent(s) => s.next_2d(),
            Self::Stratified(s) => s.next_2d(),
            Self::Halton(s) => s.next_2d(),
            Self::PaddedSobol(s) => s.next_2d(),
            Self::ZSobol(s) => s.next_2d(),
        }
    }

    /// The pair that places the sample on the film, to be asked for once per sample.
    pub fn next_pixel_2d(&mut self) -> Vec2 {
        match self {
            Self::Halton(s) => s.next_pixel_2d(),
            Self::Independent(_) | Self::Stratified(_) | Self::PaddedSobol(_) | Self::ZSobol(_) => {
                self.next_2d()
            }
        }
    }

    /// 64 random bits of this pixel, sample and dimension: the seed of a random walk; consumes one dimension.
    #[inline]
    pub fn hash_seed(&mut self) -> u64 {
        match self {
            Self::Independent(s) => s.next_word(),
            Self::Stratified(s) => s.at.next_sample_hash(1),
            Self::Halton(s) => s.at.next_sample_hash(1),
            Self::PaddedSobol(s) => s.at.next_sample_hash(1),
            Self::ZSobol(s) => s.at.next_sample_hash(1),
        }
    }
}

#[cfg(test)]
mod blue_noise;

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [SamplerKind; 9] = [
        SamplerKind::Independent,
        SamplerKind::Stratified { x: 8, y: 8, jitter: true },
        SamplerKind::Halton(Randomization::PermuteDigits),
        SamplerKind::Halton(Randomization::Owen),
        SamplerKind::PaddedSobol(Randomization::PermuteDigits),
        SamplerKind::PaddedSobol(Randomization::FastOwen),
        SamplerKind::PaddedSobol(Randomization::Owen),
        SamplerKind::ZSobol(Randomization::FastOwen),
        SamplerKind::ZSobol(Randomization::Owen),
    ];

    #[test]
    fn a_sample_is_a_function_of_its_arguments() {
        for kind in ALL {
            let fresh = Sampler::new(kind, 64, [200, 100], 5);
            let draw = |s: &mut Sampler, pixel, index| {
                s.start(pixel, index);
                let film = s.next_pixel_2d();
                (film, s.next_1d(), s.next_2d(), s.hash_seed(), s.next_1d())
            };
            let mut used = fresh;
            for i in 0..40 {
                draw(&mut used, [i, 3 * i % 100], i as u32);
            }
            assert_eq!(draw(&mut used, [70, 33], 41), draw(&mut fresh.clone(), [70, 33], 41), "{kind:?}");
            let other = Sampler::new(kind, 64, [200, 100], 6);
            assert_ne!(draw(&mut used, [70, 33], 41).2, draw(&mut other.clone(), [70, 33], 41).2, "{kind:?}");
        }
    }

    /// Whether the first 2^k points of a pair of dimensions hold one point in every elementary interval of area 2^-k.
    fn is_net(points: &[Vec2]) -> bool {
        let k = points.len().trailing_zeros();
        (0..=k).all(|split| {
            let (nx, ny) = (1usize << split, 1usize << (k - split));
            let mut seen = vec![false; points.len()];
            for p in points {
                seen[(p.y * ny as f32) as usize * nx + (p.x * nx as f32) as usize] = true;
            }
            seen.iter().all(|&s| s)
        })
    }

    #[test]
    fn sobol_pairs_are_nets_at_every_power_of_four_in_every_dimension() {
        for kind in ALL {
            let net = matches!(kind, SamplerKind::PaddedSobol(_) | SamplerKind::ZSobol(_));
            for spp in [4u32, 16, 64, 256] {
                let mut s = Sampler::new(kind, spp, [64, 64], 1);
                for skip in 0..6 {
                    let points: Vec<Vec2> = (0..spp)
                        .map(|i| {
                            s.start([13, 50], i);
                            (0..skip).for_each(|_| {
                                s.next_1d();
                            });
                            s.next_2d()
                        })
                        .collect();
                    assert!(!net || is_net(&points), "{kind:?} {spp} {skip}");
                    // The test can fail: points of the other kinds are no nets.
                    assert!(net || spp < 256 || !is_net(&points), "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn padded_prefixes_are_nets_and_single_dimensions_are_stratified() {
        let mut s = Sampler::new(SamplerKind::PaddedSobol(Randomization::FastOwen), 1000, [64, 64], 1);
        let points: Vec<Vec2> = (0..1024)
            .map(|i| {
                s.start([5, 6], i);
                s.next_1d();
                s.next_2d()
            })
            .collect();
        for k in 1..=10 {
            assert!(is_net(&points[..1 << k]), "2^{k}");
        }
        for kind in
            [SamplerKind::PaddedSobol(Randomization::Owen), SamplerKind::ZSobol(Randomization::FastOwen)]
        {
            let mut s = Sampler::new(kind, 32, [64, 64], 1);
            let mut seen = [false; 32];
            for i in 0..32 {
                s.start([5, 6], i);
                s.next_2d();
                seen[(s.next_1d() * 32.0) as usize] = true;
            }
            assert!(seen.iter().all(|&s| s), "{kind:?}");
        }
    }

    #[test]
    fn neighbouring_pixels_share_one_net_in_z_order() {
        let mut s = Sampler::new(SamplerKind::ZSobol(Randomization::FastOwen), 4, [64, 64], 1);
        let points: Vec<Vec2> = (0..64)
            .map(|i| {
                s.start([8 + i / 4 % 4, 12 + i / 16], i as u32 % 4);
                s.next_1d();
                s.next_2d()
            })
            .collect();
        assert!(is_net(&points));
    }

    #[test]
    fn moments_are_uniform_and_dimensions_are_uncorrelated() {
        // Over pixels the samples of one index are independent or negatively correlated, so each mean of n numbers
        // deviates by at most 4.5/√(12 n) (two-sided α = 7e-6 each, 9·(8 + 28) comparisons).
        let (side, dimensions) = (64, 8);
        for kind in ALL {
            let mut s = Sampler::new(kind, 1, [side, side], 42);
            let n = f64::from(side * side);
            let mut sum = vec![0.0_f64; dimensions];
            let mut product = vec![0.0_f64; dimensions * dimensions];
            for i in 0..side * side {
                s.start([(i % side) as i32, (i / side) as i32], 0);
                let film = s.next_pixel_2d();
                let pair = s.next_2d();
                let mut x = vec![film.x, film.y, pair.x, pair.y];
                x.extend((4..dimensions).map(|_| s.next_1d()));
                for (a, &xa) in x.iter().enumerate() {
                    assert!((0.0..1.0).contains(&xa));
                    sum[a] += f64::from(xa);
                    for (b, &xb) in x.iter().enumerate() {
                        product[a * dimensions + b] += (f64::from(xa) - 0.5) * (f64::from(xb) - 0.5);
                    }
                }
            }
            for a in 0..dimensions {
                assert!(
                    (sum[a] / n - 0.5).abs() < 4.5 / (12.0 * n).sqrt(),
                    "{kind:?} mean {a}: {}",
                    sum[a] / n
                );
                for b in 0..a {
                    let correlation = product[a * dimensions + b] / n * 12.0;
                    assert!(correlation.abs() < 4.5 / n.sqrt(), "{kind:?} {a} {b}: {correlation}");
                }
            }
        }
    }

    /// Mean squared error over pixels of an `spp`-sample estimate of the mean of f = Π (1 + (x_i − ½)) over 6 dimensions, which is 1.
    fn error_of(kind: SamplerKind, spp: u32) -> f64 {
        let side = 32;
        let mut s = Sampler::new(kind, spp, [side, side], 3);
        let mut total = 0.0;
        for p in 0..side * side {
            let mut mean = 0.0_f64;
            for i in 0..spp {
                s.start([(p % side) as i32, (p / side) as i32], i);
                let film = s.next_pixel_2d();
                let (a, b) = (s.next_2d(), s.next_2d());
                mean += [film.x, film.y, a.x, a.y, b.x, b.y]
                    .iter()
                    .fold(1.0, |f, &x| f * (1.0 + 1.5 * (f64::from(x) - 0.5)))
                    / f64::from(spp);
            }
            total += (mean - 1.0).powi(2) / f64::from(side * side);
        }
        total
    }

    #[test]
    #[ignore = "measurement: error and speed of each kind"]
    fn measure() {
        for kind in ALL {
            let errors: Vec<f64> = [1, 4, 16, 64, 256].map(|n| error_of(kind, n) * f64::from(n)).to_vec();
            let mut s = Sampler::new(kind, 64, [1024, 1024], 0);
            let begin = std::time::Instant::now();
            let mut sum = 0.0;
            for i in 0..100_000 {
                s.start([i % 1000, i / 100], i as u32 % 64);
                (0..20).for_each(|_| sum += s.next_1d() + s.next_2d().y);
            }
            let ns = begin.elapsed().as_secs_f64() * 1e9 / 4e6;
            println!("{kind:?}: n·MSE {errors:.4?}, {ns:.1} ns per draw {}", sum > 0.0);
        }
    }

    #[test]
    fn low_discrepancy_points_beat_independent_ones_on_a_smooth_integrand() {
        // Variance of f over independent points: (1 + 1.5²/12)^6 − 1 = 1.8107.
        let independent = error_of(SamplerKind::Independent, 64);
        let exact = ((1.0_f64 + 2.25 / 12.0).powi(6) - 1.0) / 64.0;
        assert!((independent / exact - 1.0).abs() < 0.25, "{independent} {exact}");
        for kind in &ALL[1..] {
            let e = error_of(*kind, 64);
            // The interactions of padded pairs converge like independent points; main effects vanish, which leaves
            // less than half of the variance of this integrand.
            assert!(e < 0.55 * exact, "{kind:?}: {e} against {exact}");
        }
    }
}
