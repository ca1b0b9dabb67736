//! The Halton sequence, laid over the picture so that each pixel receives an arithmetic progression of it.

use super::position::Position;
use super::scramble::{Randomization, permute};
use crate::math::Vec2;
use crate::math::float::ONE_MINUS_EPSILON;
use crate::math::hash::{combine, mix_bits, to_unit};

/// Side of the square of pixels that the first two dimensions tile.
const TILE: u32 = 128;

/// Halton (1960) points with randomised digits; the first two dimensions place the samples on the film (pbrt-v4 book, 8.6).
#[derive(Clone, Copy, Debug)]
pub struct Halton {
    pub(super) at: Position,
    pub(super) randomization: Randomization,
    /// 2^j and 3^k, the smallest powers that cover the picture or the tile.
    scale: [u32; 2],
    exponent: [u32; 2],
    pixel: [i32; 2],
    /// Index into the sequence of the current sample.
    sequence: u64,
}

impl Halton {
    pub(super) fn new(at: Position, randomization: Randomization, resolution: [u32; 2]) -> Self {
        let (mut scale, mut exponent) = ([1; 2], [0; 2]);
        for (axis, base) in [2, 3].into_iter().enumerate() {
            while scale[axis] < resolution[axis].min(TILE) {
                scale[axis] *= base;
                exponent[axis] += 1;
            }
        }
        Self { at, randomization, scale, exponent, pixel: [0; 2], sequence: 0 }
    }

    pub(super) fn start(&mut self, pixel: [i32; 2], index: u32) {
        self.at.start(pixel, index);
        self.at.dimension = 2;
        self.pixel = pixel;
        let stride = u64::from(self.scale[0]) * u64::from(self.scale[1]);
        self.sequence = self.offset(pixel) + u64::from(index) * stride;
    }

    /// The first index of the sequence that falls into the pixel: its residues modulo 2^j and 3^k are the
    /// reversed digits of the pixel coordinates, joined by the Chinese remainder theorem.
    fn offset(&self, pixel: [i32; 2]) -> u64 {
        let [sx, sy] = self.scale.map(u64::from);
        let x = reverse_digits(pixel[0].rem_euclid(TILE as i32) as u64, 2, self.exponent[0]);
        let y = reverse_digits(pixel[1].rem_euclid(TILE as i32) as u64, 3, self.exponent[1]);
        (x * sy * inverse_modulo(sy, sx) + y * sx * inverse_modulo(sx, sy)) % (sx * sy)
    }

    pub(super) fn next_1d(&mut self) -> f32 {
        let dimension = self.at.advance(1);
        self.dimension(dimension)
    }

    pub(super) fn next_2d(&mut self) -> Vec2 {
        let dimension = self.at.advance(2);
        Vec2::new(self.dimension(dimension), self.dimension(dimension + 1))
    }

    /// Position within the pixel: the digits of the first two dimensions that are not spent on choosing it.
    /// Only these are scrambled, nested below the pixel's column and row, so that samples stay in their pixel.
    pub(super) fn next_pixel_2d(&mut self) -> Vec2 {
        let inside = |axis: usize, base| {
            let seed = combine(combine(self.at.seed, axis as u64), self.pixel[axis] as u64);
            self.scrambled_inverse(base, self.sequence / u64::from(self.scale[axis]), seed)
        };
        Vec2::new(inside(0, 2), inside(1, 3))
    }

    fn dimension(&self, dimension: u32) -> f32 {
        let seed = combine(self.at.seed, u64::from(dimension));
        match PRIMES.get(dimension as usize) {
            Some(&base) => self.scrambled_inverse(base, self.sequence, seed),
            // Beyond the table, primes are so large that their dimensions are no better than random.
            None => to_unit(combine(combine(self.at.pixel_hash, u64::from(self.at.index)), seed)),
        }
    }

    fn scrambled_inverse(&self, base: u32, sequence: u64, seed: u64) -> f32 {
        if self.randomization == Randomization::None {
            return radical_inverse(base, sequence);
        }
        let nested = self.randomization != Randomization::PermuteDigits;
        let inverse_base = 1.0 / f64::from(base);
        let (mut rest, mut scale, mut value, mut place) = (sequence, 1.0_f64, 0.0_f64, 0u64);
        let mut above = 0u64;
        // Leading zeros of the index are digits as well: all that reach the precision of an f32 are permuted.
        while scale > f64::from(f32::EPSILON) * 0.25 {
            let digit = (rest % u64::from(base)) as u32;
            rest /= u64::from(base);
            let key = if nested { seed ^ above } else { seed };
            let permuted = permute(digit, base, (mix_bits(key ^ place << 56) >> 20) as u32);
            above = above * u64::from(base) + u64::from(digit) + 1;
            scale *= inverse_base;
            value += f64::from(permuted) * scale;
            place += 1;
        }
        (value as f32).min(ONE_MINUS_EPSILON)
    }
}

/// Φ_b(i): the digits of `i` in base `base`, mirrored at the radix point.
fn radical_inverse(base: u32, mut i: u64) -> f32 {
    let (b, inverse_base) = (u64::from(base), 1.0 / f64::from(base));
    let (mut reversed, mut scale) = (0u64, 1.0_f64);
    while i > 0 && reversed < u64::MAX / b - b {
        reversed = reversed * b + i % b;
        i /= b;
        scale *= inverse_base;
    }
    ((reversed as f64 * scale) as f32).min(ONE_MINUS_EPSILON)
}

fn reverse_digits(mut v: u64, base: u64, digits: u32) -> u64 {
    let mut reversed = 0;
    for _ in 0..digits {
        reversed = reversed * base + v % base;
        v /= base;
    }
    reversed
}

/// x with a·x ≡ 1 (mod n), for coprime a and n, by Euclid's algorithm.
fn inverse_modulo(a: u64, n: u64) -> u64 {
    let (mut r, mut next_r) = (n as i64, (a % n) as i64);
    let (mut t, mut next_t) = (0i64, 1i64);
    while next_r != 0 {
        let q = r / next_r;
        (r, next_r) = (next_r, r - q * next_r);
        (t, next_t) = (next_t, t - q * next_t);
    }
    t.rem_euclid(n as i64) as u64
}

/// Primes below 1000, the bases of the dimensions.
static PRIMES: [u32; 168] = primes();

const fn primes() -> [u32; 168] {
    let mut table = [2; 168];
    let (mut n, mut candidate) = (1, 3);
    while n < 168 {
        let (mut i, mut prime) = (0, true);
        while i < n && table[i] * table[i] <= candidate {
            if candidate % table[i] == 0 {
                prime = false;
            }
            i += 1;
        }
        if prime {
            table[n] = candidate;
            n += 1;
        }
        candidate += 2;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_of_a_pixel_lies_in_that_pixel() {
        let h = Halton::new(Position::new(0), Randomization::None, [100, 60]);
        let mut s = h;
        for pixel in [[0, 0], [17, 5], [99, 59], [3, 41]] {
            for index in 0..20 {
                s.start(pixel, index);
                // The unsplit sequence scaled to the covering grid is a film position in the pixel.
                let x = f64::from(radical_inverse(2, s.sequence)) * f64::from(h.scale[0]);
                let y = f64::from(radical_inverse(3, s.sequence)) * f64::from(h.scale[1]);
                let inside = s.next_pixel_2d();
                assert!(
                    (x - f64::from(pixel[0]) - f64::from(inside.x)).abs() < 1e-4,
                    "{pixel:?} {index}: {x}"
                );
                assert!(
                    (y - f64::from(pixel[1]) - f64::from(inside.y)).abs() < 1e-4,
                    "{pixel:?} {index}: {y}"
                );
            }
        }
    }

    #[test]
    fn the_table_ends_with_the_largest_prime_below_1000() {
        assert_eq!((PRIMES[0], PRIMES[1], PRIMES[24], PRIMES[167]), (2, 3, 97, 997));
    }

    #[test]
    fn scrambled_digits_keep_one_sample_per_stratum_of_the_base() {
        // Any b consecutive points of a dimension with base b fall into b different b-adic intervals.
        for r in [Randomization::PermuteDigits, Randomization::Owen, Randomization::None] {
            let mut s = Halton::new(Position::new(9), r, [1, 1]);
            for dimension in [2, 3, 10] {
                let base = PRIMES[dimension as usize];
                let mut seen = vec![false; base as usize];
                for index in 0..base {
                    s.start([0, 0], index);
                    seen[(s.dimension(dimension) * base as f32) as usize] = true;
                }
                assert!(seen.iter().filter(|&&s| !s).count() == 0, "{r:?} {base}");
            }
        }
    }
}
