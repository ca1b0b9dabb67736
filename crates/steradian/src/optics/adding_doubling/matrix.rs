//! Square matrices, as far as adding layers needs them.

/// A square matrix.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Matrix {
    n: usize,
    /// Row by row.
    cells: Vec<f64>,
}

impl Matrix {
    pub(super) fn from_fn(n: usize, f: impl Fn(usize, usize) -> f64) -> Self {
        Self { n, cells: (0..n * n).map(|k| f(k / n, k % n)).collect() }
    }

    pub(super) fn identity(n: usize) -> Self {
        Self::from_fn(n, |i, j| if i == j { 1.0 } else { 0.0 })
    }

    pub(super) fn size(&self) -> usize {
        self.n
    }

    pub(super) fn at(&self, i: usize, j: usize) -> f64 {
        self.cells[i * self.n + j]
    }

    pub(super) fn plus(&self, other: &Self, factor: f64) -> Self {
        let cells = self.cells.iter().zip(&other.cells).map(|(a, b)| a + factor * b).collect();
        Self { n: self.n, cells }
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let n = self.n;
        let mut cells = vec![0.0; n * n];
        for (row, out) in self.cells.chunks_exact(n).zip(cells.chunks_exact_mut(n)) {
            for (a, line) in row.iter().zip(other.cells.chunks_exact(n)) {
                for (o, b) in out.iter_mut().zip(line) {
                    *o += a * b;
                }
            }
        }
        Self { n, cells }
    }

    pub(super) fn apply(&self, v: &[f64]) -> Vec<f64> {
        self.cells.chunks_exact(self.n).map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum()).collect()
    }

    /// Rows times the entries of a diagonal.
    pub(super) fn rows_scaled(&self, diagonal: &[f64]) -> Self {
        let mut all = self.clone();
        for (row, d) in all.cells.chunks_exact_mut(self.n).zip(diagonal) {
            row.iter_mut().for_each(|c| *c *= d);
        }
        all
    }

    /// Columns times the entries of a diagonal.
    pub(super) fn columns_scaled(&self, diagonal: &[f64]) -> Self {
        let mut all = self.clone();
        for row in all.cells.chunks_exact_mut(self.n) {
            row.iter_mut().zip(diagonal).for_each(|(c, d)| *c *= d);
        }
        all
    }

    /// The matrix X with self · X = right, by elimination with pivots; what passive layers ask for has a solution.
    pub(super) fn solve(mut self, mut right: Self) -> Self {
        let n = self.n;
        for k in 0..n {
            let size = |m: &Self, i: usize| m.at(i, k).abs();
            let pivot = (k..n).fold(k, |best, i| if size(&self, i) > size(&self, best) { i } else { best });
            if pivot != k {
                for j in 0..n {
                    self.cells.swap(k * n + j, pivot * n + j);
                    right.cells.swap(k * n + j, pivot * n + j);
                }
            }
            let inverse = 1.0 / self.at(k, k);
            for i in k + 1..n {
                let factor = self.at(i, k) * inverse;
                if factor != 0.0 {
                    self.subtract(i, k, factor, k);
                    right.subtract(i, k, factor, 0);
                }
            }
        }
        for k in (0..n).rev() {
            let inverse = 1.0 / self.at(k, k);
            right.cells[k * n..(k + 1) * n].iter_mut().for_each(|c| *c *= inverse);
            for i in 0..k {
                let factor = self.at(i, k);
                right.subtract(i, k, factor, 0);
            }
        }
        right
    }

    /// Row `i` minus `factor` times row `k`, from column `from` on.
    fn subtract(&mut self, i: usize, k: usize, factor: f64, from: usize) {
        let n = self.n;
        let (a, b) = self.cells.split_at_mut(i.max(k) * n);
        let (line, source) =
            if i < k { (&mut a[i * n..(i + 1) * n], &b[..n]) } else { (&mut b[..n], &a[k * n..(k + 1) * n]) };
        for (c, s) in line[from..].iter_mut().zip(&source[from..]) {
            *c -= factor * s;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_solve() {
        // A zero on the diagonal needs a pivot.
        let a = Matrix::from_fn(5, |i, j| if i == j { 0.0 } else { 1.0 / (1 + i + 2 * j) as f64 });
        let b = Matrix::from_fn(5, |i, j| (i as f64 - 1.3 * j as f64).cos());
        let difference = a.times(&a.clone().solve(b.clone())).plus(&b, -1.0);
        assert!(difference.cells.iter().all(|c| c.abs() < 1e-13), "{difference:?}");
        let x = [1.0, -2.0, 0.5, 3.0, 0.0];
        let as_matrix = Matrix::from_fn(5, |i, _| x[i]);
        assert_eq!(a.apply(&x)[3], a.times(&as_matrix).at(3, 0));
        let d = [1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(
            (b.rows_scaled(&d).at(3, 1), b.columns_scaled(&d).at(3, 1)),
            (4.0 * b.at(3, 1), 2.0 * b.at(3, 1))
        );
    }
}
