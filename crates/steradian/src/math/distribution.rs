//! Tabulated distributions: discrete (alias method), piecewise constant in one and two dimensions.

use super::vector::Vec2;

/// A discrete distribution sampled in constant time (Walker 1974, Vose 1991).
#[derive(Clone, Debug)]
pub struct AliasTable {
    bins: Vec<Bin>,
}

#[derive(Clone, Copy, Debug)]
struct Bin {
    /// Probability of the bin's own index.
    p: f32,
    /// Threshold within the bin below which its own index is chosen.
    q: f32,
    alias: u32,
}

/// An index drawn from a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discrete {
    /// The index.
    pub index: usize,
    /// Its probability.
    pub p: f32,
    /// The sample u, stretched back to [0, 1) for reuse.
    pub remapped: f32,
}

impl AliasTable {
    /// A table with probabilities proportional to `weights`; `None` when their sum is not positive and
    /// finite or one of them is negative.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let sum: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        if !(sum > 0.0 && sum.is_finite()) || weights.iter().any(|&w| w < 0.0) {
            return None;
        }
        let n = weights.len();
        let mut scaled: Vec<f64> = weights.iter().map(|&w| f64::from(w) / sum * n as f64).collect();
        let mut bins: Vec<Bin> = weights
            .iter()
            .enumerate()
            .map(|(i, &w)| Bin { p: (f64::from(w) / sum) as f32, q: 1.0, alias: i as u32 })
            .collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| scaled[i] < 1.0);
        while let (Some(&s), Some(&l)) = (small.last(), large.last()) {
            small.pop();
            bins[s].q = scaled[s] as f32;
            bins[s].alias = l as u32;
            scaled[l] -= 1.0 - scaled[s];
            if scaled[l] < 1.0 {
                large.pop();
                small.push(l);
            }
        }
        // What is left is 1 up to rounding, unless its weight is zero: such a bin must never be chosen.
        if let Some(heavy) = (0..n).max_by(|&a, &b| weights[a].total_cmp(&weights[b])) {
            for i in small {
                if weights[i] == 0.0 {
                    bins[i].q = 0.0;
                    bins[i].alias = heavy as u32;
                }
            }
        }
        Some(Self { bins })
    }

    /// Draws an index with `u` in [0, 1).
    #[inline]
    pub fn sample(&self, u: f32) -> Discrete {
        let n = self.bins.len();
        let scaled = u * n as f32;
        let offset = (scaled as usize).min(n - 1);
        let up = (scaled - offset as f32).min(super::float::ONE_MINUS_EPSILON);
        let bin = self.bins[offset];
        let (index, remapped) = if up < bin.q {
            (offset, up / bin.q)
        } else {
            (bin.alias as usize, (up - bin.q) / (1.0 - bin.q))
        };
        Discrete { index, p: self.bins[index].p, remapped: remapped.min(super::float::ONE_MINUS_EPSILON) }
    }

    /// Probability of `index`; zero outside the table.
    pub fn probability(&self, index: usize) -> f32 {
        self.bins.get(index).map_or(0.0, |b| b.p)
    }

    /// Number of indices.
    pub fn len(&self) -> usize {
        self.bins.len()
    }

    /// Whether the table holds nothing; a constructed table never does.
    pub fn is_empty(&self) -> bool {
        self.bins.is_empty()
    }
}

/// A function on [0, 1], constant on n equal cells.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1D {
    f: Vec<f32>,
    cdf: Vec<f32>,
    /// Cell that holds the start of each of n equal parts of [0, 1] of the cumulative density.
    guide: Vec<u32>,
    integral: f32,
}

/// A position drawn from a one-dimensional density.
#[derive(Clone, Copy, Debug)]
pub struct Sample1D {
    /// Position in [0, 1].
    pub x: f32,
    /// Density with respect to length on [0, 1].
    pub pdf: f32,
    /// Cell that holds the position.
    pub cell: usize,
}

impl PiecewiseConstant1D {
    /// From cell values, of which the absolute value counts; a zero function becomes the uniform density.
    pub fn new(f: &[f32]) -> Self {
        let n = f.len().max(1);
        let f: Vec<f32> = if f.is_empty() { vec![0.0] } else { f.iter().map(|v| v.abs()).collect() };
        let mut cdf = Vec::with_capacity(n + 1);
        let mut sum = 0.0_f64;
        cdf.push(0.0);
        for &v in &f {
            sum += f64::from(v) / n as f64;
            cdf.push(sum as f32);
        }
        let integral = sum as f32;
        for (i, c) in cdf.iter_mut().enumerate() {
            *c = if sum > 0.0 { (f64::from(*c) / sum) as f32 } else { i as f32 / n as f32 };
        }
        cdf[n] = 1.0;
        let mut cell = 0;
        let guide = (0..n).map(|g| {
            while cell + 1 < n && cdf[cell + 1] <= g as f32 / n as f32 {
                cell += 1;
            }
            cell as u32
        });
        Self { guide: guide.collect(), f, cdf, integral }
    }

    /// ∫ f over [0, 1].
    pub fn integral(&self) -> f32 {
        self.integral
    }

    /// Draws a position with density f/∫f.
    pub fn sample(&self, u: f32) -> Sample1D {
        let Quantile { cell, x } = quantile(&self.guide, &self.cdf, u);
        Sample1D { x, pdf: self.cell_pdf(cell), cell }
    }

    /// Density at x; zero outside [0, 1].
    pub fn pdf(&self, x: f32) -> f32 {
        if !(0.0..=1.0).contains(&x) {
            return 0.0;
        }
        self.cell_pdf(((x * self.f.len() as f32) as usize).min(self.f.len() - 1))
    }

    fn cell_pdf(&self, cell: usize) -> f32 {
        if self.integral > 0.0 { self.f[cell] / self.integral } else { 1.0 }
    }
}

/// Where a cumulative density reaches a value.
struct Quantile {
    cell: usize,
    /// Position in [0, 1].
    x: f32,
}

/// The place where `cdf`, of n cells, reaches `u`.
#[inline]
fn quantile(guide: &[u32], cdf: &[f32], u: f32) -> Quantile {
    let n = guide.len();
    let mut cell = guide[((u * n as f32) as usize).min(n - 1)] as usize;
    // Rounding can lead into the part after its own.
    while cell > 0 && cdf[cell] > u {
        cell -= 1;
    }
    while cell + 1 < n && cdf[cell + 1] <= u {
        cell += 1;
    }
    let width = cdf[cell + 1] - cdf[cell];
    let within = if width > 0.0 { ((u - cdf[cell]) / width).clamp(0.0, 1.0) } else { 0.5 };
    Quantile { cell, x: ((cell as f32 + within) / n as f32).min(super::float::ONE_MINUS_EPSILON) }
}

/// A function on [0, 1]², constant on nx × ny equal cells, sampled by rows.
///
/// The rows lie one after another: pictures of skies are larger than caches, and each array that is looked at costs a
/// trip to memory.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2D {
    nx: usize,
    f: Vec<f32>,
    /// Of each row, nx + 1 values.
    cdfs: Vec<f32>,
    guides: Vec<u32>,
    marginal: PiecewiseConstant1D,
}

impl PiecewiseConstant2D {
    /// From `nx × ny` cell values in rows, first row at y = 0.
    pub fn new(f: &[f32], nx: usize, ny: usize) -> Self {
        debug_assert_eq!(f.len(), nx * ny);
        let nx = nx.max(1);
        let (mut cdfs, mut guides) = (Vec::with_capacity((nx + 1) * ny), Vec::with_capacity(nx * ny));
        let mut sums = Vec::with_capacity(ny);
        for row in f.chunks_exact(nx) {
            let row = PiecewiseConstant1D::new(row);
            sums.push(row.integral);
            cdfs.extend(row.cdf);
            guides.extend(row.guide);
        }
        let f = f.iter().map(|v| v.abs()).collect();
        Self { nx, f, cdfs, guides, marginal: PiecewiseConstant1D::new(&sums) }
    }

    /// ∫∫ f over the unit square.
    pub fn integral(&self) -> f32 {
        self.marginal.integral()
    }

    /// Draws a point and its density per unit area of the square.
    pub fn sample(&self, u: Vec2) -> (Vec2, f32) {
        let Quantile { cell: row, x: y } = quantile(&self.marginal.guide, &self.marginal.cdf, u.y);
        let (guide, cdf) = (row * self.nx, row * (self.nx + 1));
        let Quantile { cell: column, x } =
            quantile(&self.guides[guide..guide + self.nx], &self.cdfs[cdf..cdf + self.nx + 1], u.x);
        (Vec2::new(x, y), self.cell_pdf(row, column))
    }

    /// Density at `p`, zero outside the square.
    pub fn pdf(&self, p: Vec2) -> f32 {
        if !(p.cmpge(Vec2::ZERO) & p.cmple(Vec2::ONE)).all() {
            return 0.0;
        }
        let cell = |x: f32, n: usize| ((x * n as f32) as usize).min(n - 1);
        self.cell_pdf(cell(p.y, self.marginal.f.len()), cell(p.x, self.nx))
    }

    /// That of the row times that within the row, in which the row's own integral cancels.
    #[inline]
    fn cell_pdf(&self, row: usize, column: usize) -> f32 {
        let integral = self.integral();
        if integral > 0.0 { self.f[row * self.nx + column] / integral } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alias_table_reproduces_its_weights() {
        let weights = [1.0, 0.0, 5.0, 2.5, 0.125, 0.0];
        let table = AliasTable::new(&weights).unwrap();
        let n = 1 << 16;
        let mut counts = [0u32; 6];
        for i in 0..n {
            let d = table.sample((i as f32 + 0.5) / n as f32);
            assert!((0.0..1.0).contains(&d.remapped));
            counts[d.index] += 1;
        }
        let sum: f32 = weights.iter().sum();
        for (i, w) in weights.iter().enumerate() {
            // A regular grid of u resolves each bin to one count per bin boundary.
            assert!((counts[i] as f32 / n as f32 - w / sum).abs() < 12.0 / n as f32, "{i}: {}", counts[i]);
            assert!((table.probability(i) - w / sum).abs() < 1e-6);
        }
        assert_eq!(counts[1] + counts[5], 0);
        assert!(AliasTable::new(&[0.0, 0.0]).is_none() && AliasTable::new(&[]).is_none());
        assert!(AliasTable::new(&[1.0, f32::NAN]).is_none() && AliasTable::new(&[1.0, -1.0]).is_none());
    }

    #[test]
    fn two_dimensional_samples_follow_the_density() {
        let (nx, ny) = (4, 3);
        let f: Vec<f32> = (0..12).map(|i| (i * 7 % 5) as f32).collect();
        let d = PiecewiseConstant2D::new(&f, nx, ny);
        let mean = f.iter().sum::<f32>() / 12.0;
        assert!((d.integral() - mean).abs() < 1e-6);
        let n = 300;
        let mut counts = [0u32; 12];
        for i in 0..n * n {
            let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            let (p, pdf) = d.sample(u);
            let cell = (p.x * nx as f32) as usize + nx * (p.y * ny as f32) as usize;
            assert!((pdf - f[cell] / mean).abs() < 1e-5 && (d.pdf(p) - pdf).abs() < 1e-5);
            counts[cell] += 1;
        }
        for (c, f) in counts.iter().zip(&f) {
            assert!((*c as f32 / (n * n) as f32 - f / mean / 12.0).abs() < 0.005);
        }
    }
}
