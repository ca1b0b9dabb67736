//! Rectangles of pixels.

/// A half-open rectangle of pixels: min ≤ pixel < max on both axes; y points down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelBounds {
    /// First column and row.
    pub min: [i32; 2],
    /// One past the last column and row.
    pub max: [i32; 2],
}

impl PixelBounds {
    /// All pixels of a film.
    pub fn full([width, height]: [u32; 2]) -> Self {
        Self { min: [0, 0], max: [width as i32, height as i32] }
    }

    /// The common part; empty when there is none.
    #[must_use]
    pub fn intersect(&self, other: &Self) -> Self {
        let pick = |i: usize| (self.min[i].max(other.min[i]), self.max[i].min(other.max[i]));
        let ((x0, x1), (y0, y1)) = (pick(0), pick(1));
        Self { min: [x0, y0], max: [x1.max(x0), y1.max(y0)] }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.max[0].saturating_sub(self.min[0]).max(0) as usize
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.max[1].saturating_sub(self.min[1]).max(0) as usize
    }

    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.width() * self.height()
    }

    /// Whether `pixel` lies inside.
    pub fn contains(&self, pixel: [i32; 2]) -> bool {
        (0..2).all(|i| (self.min[i]..self.max[i]).contains(&pixel[i]))
    }

    /// Place of a pixel in row order; `None` outside.
    pub fn index(&self, pixel: [i32; 2]) -> Option<usize> {
        self.contains(pixel)
            .then(|| (pixel[1] - self.min[1]) as usize * self.width() + (pixel[0] - self.min[0]) as usize)
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = [i32; 2]> + Clone + use<> {
        let Self { min, max } = *self;
        (min[1]..max[1]).flat_map(move |y| (min[0]..max[0]).map(move |x| [x, y]))
    }

    /// Tiles of at most `side` × `side` pixels, row by row, aligned with pixel (0, 0).
    pub fn tiles(&self, side: u32) -> Vec<Self> {
        let side = side.max(1) as i32;
        let cut = |lo: i32, hi: i32| {
            let first = lo.div_euclid(side) * side;
            (first..hi).step_by(side as usize).map(move |a| (a.max(lo), (a + side).min(hi)))
        };
        cut(self.min[1], self.max[1])
            .flat_map(|(y0, y1)| {
                cut(self.min[0], self.max[0]).map(move |(x0, x1)| Self { min: [x0, y0], max: [x1, y1] })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let bounds = PixelBounds { min: [5, 3], max: [70, 33] };
        let mut seen = vec![0; bounds.area()];
        for tile in bounds.tiles(16) {
            assert!(tile.width() <= 16 && tile.height() <= 16);
            tile.pixels().for_each(|p| seen[bounds.index(p).unwrap()] += 1);
        }
        assert!(seen.iter().all(|&n| n == 1));
    }
}
