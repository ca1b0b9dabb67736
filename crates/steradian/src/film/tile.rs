//! What the film keeps per pixel while samples arrive.

use super::bounds::PixelBounds;

/// Accumulators of a rectangle of pixels, owned by one thread at a time.
///
/// A pixel belongs to one tile and receives its samples in the order of their indices, so the sums do
/// not depend on the number of threads or the order of tiles.
#[derive(Clone, Debug)]
pub struct FilmTile {
    pub(super) bounds: PixelBounds,
    pub(super) pixels: Vec<Pixel>,
    /// One per pixel when the film records surfaces, else empty.
    pub(super) surfaces: Vec<SurfaceSums>,
    /// One per pixel and wavelength bin, pixel by pixel, when the film is spectral, else empty.
    pub(super) bins: Vec<Bin>,
}

/// Sums of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pixel {
    /// Σ w · tristimulus values.
    pub(super) sum: [f64; 3],
    /// Σ w.
    pub(super) weight: f64,
    pub(super) luminance: Spread,
}

/// Running mean and spread of unweighted samples (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spread {
    pub(super) n: u32,
    pub(super) mean: f32,
    /// Σ (x − mean)².
    pub(super) m2: f32,
}

impl Spread {
    pub(super) fn add(&mut self, x: f32) {
        self.n += 1;
        let delta = x - self.mean;
        self.mean += delta / self.n as f32;
        self.m2 += delta * (x - self.mean);
    }

    /// The spread of both sets of samples (Chan, Golub & LeVeque 1979).
    fn merge(self, other: Self) -> Self {
        let n = self.n + other.n;
        if n == 0 {
            return self;
        }
        let (delta, share) = (other.mean - self.mean, other.n as f32 / n as f32);
        Self {
            n,
            mean: self.mean + delta * share,
            m2: self.m2 + other.m2 + delta * delta * self.n as f32 * share,
        }
    }

    /// Unbiased variance of one sample; zero for fewer than two.
    pub(super) fn variance(&self) -> f32 {
        if self.n < 2 { 0.0 } else { self.m2 / (self.n - 1) as f32 }
    }

    /// Variance over the mean, as pbrt-v4's film defines it; zero when the mean is.
    pub(super) fn relative_variance(&self) -> f32 {
        if self.mean == 0.0 { 0.0 } else { self.variance() / self.mean }
    }
}

/// Sums of the geometric layers of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SurfaceSums {
    /// Σ w over the samples that saw a surface.
    pub(super) weight: f64,
    pub(super) p: [f64; 3],
    pub(super) n: [f64; 3],
    pub(super) ns: [f64; 3],
    pub(super) uv: [f64; 2],
    pub(super) dz: [f64; 2],
    pub(super) albedo: [f64; 3],
    pub(super) rgb: [Spread; 3],
}

/// Sums of one wavelength bin of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bin {
    /// Σ w L / p.
    pub(super) sum: f64,
    /// Σ w / p.
    pub(super) weight: f64,
}

impl FilmTile {
    /// The pixels that the tile holds.
    pub fn bounds(&self) -> PixelBounds {
        self.bounds
    }

    /// Memory of the accumulators [B].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.pixels[..]) + size_of_val(&self.surfaces[..]) + size_of_val(&self.bins[..])
    }

    /// Number of samples that the pixel has received; zero outside the tile.
    pub fn samples(&self, pixel: [i32; 2]) -> u32 {
        self.bounds.index(pixel).map_or(0, |i| self.pixels[i].luminance.n)
    }

    /// Mean luminance of a pixel's samples [cd/m² × imaging ratio] and the variance of that mean, without
    /// the filter's weights; `None` outside the tile or for fewer than two samples.
    ///
    /// The variance is that of independent samples, an upper bound in practice for low-discrepancy ones.
    pub fn luminance(&self, pixel: [i32; 2]) -> Option<Estimate> {
        let spread = self.pixels[self.bounds.index(pixel)?].luminance;
        (spread.n >= 2)
            .then(|| Estimate { mean: spread.mean, variance_of_mean: spread.variance() / spread.n as f32 })
    }
}

impl FilmTile {
    /// Adds what another tile of the same film and bounds recorded.
    pub fn absorb(&mut self, other: &Self) {
        debug_assert_eq!(self.bounds, other.bounds);
        let add3 = |a: &mut [f64; 3], b: [f64; 3]| (0..3).for_each(|i| a[i] += b[i]);
        for (own, others) in self.pixels.iter_mut().zip(&other.pixels) {
            add3(&mut own.sum, others.sum);
            own.weight += others.weight;
            own.luminance = own.luminance.merge(others.luminance);
        }
        for (own, others) in self.surfaces.iter_mut().zip(&other.surfaces) {
            own.weight += others.weight;
            add3(&mut own.p, others.p);
            add3(&mut own.n, others.n);
            add3(&mut own.ns, others.ns);
            add3(&mut own.albedo, others.albedo);
            for axis in 0..2 {
                own.uv[axis] += others.uv[axis];
                own.dz[axis] += others.dz[axis];
            }
            (0..3).for_each(|c| own.rgb[c] = own.rgb[c].merge(others.rgb[c]));
        }
        for (own, others) in self.bins.iter_mut().zip(&other.bins) {
            own.sum += others.sum;
            own.weight += others.weight;
        }
    }
}

/// A mean and how far it may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f32,
    /// Variance of the mean.
    pub variance_of_mean: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_is_that_of_the_textbook() {
        let mut s = Spread::default();
        [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].iter().for_each(|&x| s.add(x));
        // Mean 5, Σ(x − 5)² = 32.
        assert!((s.mean - 5.0).abs() < 1e-6 && (s.variance() - 32.0 / 7.0).abs() < 1e-5);
        assert!((s.relative_variance() - 32.0 / 35.0).abs() < 1e-6);
    }

    #[test]
    fn the_spread_of_two_sets_is_that_of_their_union() {
        let of = |xs: &[f32]| {
            let mut s = Spread::default();
            xs.iter().for_each(|&x| s.add(x));
            s
        };
        let values = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0];
        let whole = of(&values);
        for cut in 0..=values.len() {
            let merged = of(&values[..cut]).merge(of(&values[cut..]));
            assert_eq!(merged.n, whole.n);
            assert!((merged.mean - whole.mean).abs() < 1e-5 && (merged.m2 - whole.m2).abs() < 1e-4);
        }
    }
}
