//! Emittant cells: patches of the hemisphere between two circles of latitude and two meridians.

use crate::math::{LocalDir, Vec2, Vec3};
use std::f64::consts::TAU;

/// A patch of the hemisphere. On the other side of the sample it stands for its mirror image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Bounds of the angle to the normal [degrees], increasing, in [0, 90].
    pub theta: [f64; 2],
    /// Bounds of the azimuth [degrees], increasing, at most 360 apart; the first may be negative.
    pub phi: [f64; 2],
}

impl Cell {
    /// Solid angle [sr], ω = (φ₁ − φ₀)(cosθ₀ − cosθ₁), A (13).
    pub fn solid_angle(&self) -> f64 {
        let [c0, c1] = self.theta.map(|t| t.to_radians().cos());
        self.width() * (c0 - c1)
    }

    /// Projected solid angle ∫ cosθ dω = ½ (φ₁ − φ₀)(sin²θ₁ − sin²θ₀) [sr].
    pub fn projected_solid_angle(&self) -> f64 {
        let [s0, s1] = self.sin2();
        0.5 * self.width() * (s1 - s0)
    }

    /// Middle of both angles [degrees]; a whole cap has its middle at the pole.
    pub fn centre(&self) -> [f64; 2] {
        if self.theta[0] == 0.0 && self.phi[1] - self.phi[0] >= 360.0 {
            return [0.0, 0.0];
        }
        [0.5 * (self.theta[0] + self.theta[1]), 0.5 * (self.phi[0] + self.phi[1])]
    }

    /// The direction of a point of the unit square, of even density per projected solid angle.
    pub fn direction(&self, u: Vec2) -> LocalDir {
        let [s0, s1] = self.sin2();
        let sin2 = s0 + f64::from(u.x) * (s1 - s0);
        let phi = self.phi[0].to_radians() + f64::from(u.y) * self.width();
        let ((y, x), sin) = (phi.sin_cos(), sin2.sqrt());
        LocalDir::new_unchecked(Vec3::new(
            (sin * x) as f32,
            (sin * y) as f32,
            (1.0 - sin2).max(0.0).sqrt() as f32,
        ))
    }

    fn width(&self) -> f64 {
        (self.phi[1] - self.phi[0]).to_radians()
    }

    fn sin2(&self) -> [f64; 2] {
        self.theta.map(sin2)
    }
}

fn sin2(degrees: f64) -> f64 {
    degrees.to_radians().sin().powi(2)
}

/// A ring of equal cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Bounds of the angle to the normal [degrees].
    pub theta: [f64; 2],
    /// Number of cells, at least 1. The middle of the first lies at azimuth zero.
    pub cells: usize,
}

/// The hemisphere in rings of cells, without gap or overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct CellGrid {
    rings: Vec<Ring>,
    /// Number of the first cell of each ring.
    first: Vec<usize>,
    /// sin²θ of the outer bound of each ring.
    outer: Vec<f64>,
    /// ∫ cosθ dω of the cells of each ring [sr].
    projected: Vec<f64>,
}

impl CellGrid {
    /// `theta` rings of equal height with `phi` cells each; both at least 1.
    pub fn regular(theta: usize, phi: usize) -> Self {
        let n = theta.max(1);
        let bound = |i: usize| 90.0 * i as f64 / n as f64;
        Self::new((0..n).map(|i| Ring { theta: [bound(i), bound(i + 1)], cells: phi.max(1) }).collect())
    }

    /// The full basis of Klems (1994) as WINDOW and Radiance use it: 145 cells.
    pub fn klems() -> Self {
        let bounds = [0.0, 5.0, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 90.0];
        let counts = [1, 8, 16, 20, 24, 24, 24, 16, 12];
        let rings = bounds.windows(2).zip(counts);
        Self::new(rings.map(|(b, cells)| Ring { theta: [b[0], b[1]], cells }).collect())
    }

    fn new(rings: Vec<Ring>) -> Self {
        let mut next = 0;
        let mut first = Vec::with_capacity(rings.len());
        for ring in &rings {
            first.push(next);
            next += ring.cells;
        }
        let outer = rings.iter().map(|r| sin2(r.theta[1])).collect();
        let grid = Self { rings, first, outer, projected: Vec::new() };
        let projected = grid.first.iter().map(|&i| grid.cell(i).projected_solid_angle()).collect();
        Self { projected, ..grid }
    }

    /// Number of cells.
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(&self) -> usize {
        self.rings.iter().map(|r| r.cells).sum()
    }

    /// The rings from the pole outwards.
    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    /// Cells of each ring where all rings have the same number.
    pub fn even_azimuths(&self) -> Option<usize> {
        let count = self.rings[0].cells;
        self.rings.iter().all(|r| r.cells == count).then_some(count)
    }

    /// The cell of a number below [`CellGrid::len`].
    pub fn cell(&self, index: usize) -> Cell {
        let ring = self.ring_of(index);
        let Ring { theta, cells } = self.rings[ring];
        let step = 360.0 / cells as f64;
        let middle = (index - self.first[ring]) as f64 * step;
        Cell { theta, phi: [middle - 0.5 * step, middle + 0.5 * step] }
    }

    /// All cells in the order of their numbers: rings from the pole outwards, azimuths counter-clockwise.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + '_ {
        (0..self.len()).map(|i| self.cell(i))
    }

    /// The number of the cell that a direction, or its mirror image below, lies in.
    pub fn index(&self, w: LocalDir) -> usize {
        let [x, y, z] = [w.x, w.y, w.z].map(f64::from);
        let across = x * x + y * y;
        let sin2 = across / (across + z * z);
        let ring = self.outer.partition_point(|&outer| outer <= sin2).min(self.rings.len() - 1);
        let cells = self.rings[ring].cells;
        let place = (y.atan2(x) / TAU * cells as f64).round() as i64;
        self.first[ring] + place.rem_euclid(cells as i64) as usize
    }

    /// ∫ cosθ dω over a cell [sr], as [`Cell::projected_solid_angle`].
    pub fn projected_solid_angle(&self, index: usize) -> f64 {
        self.projected[self.ring_of(index)]
    }

    /// The cell at the opposite azimuth, `None` where a ring has an odd number of cells, but for a whole cap.
    pub fn opposite(&self, index: usize) -> Option<usize> {
        let ring = self.ring_of(index);
        let (first, cells) = (self.first[ring], self.rings[ring].cells);
        match cells {
            1 => Some(index),
            n if n % 2 == 0 => Some(first + (index - first + n / 2) % n),
            _ => None,
        }
    }

    fn ring_of(&self, index: usize) -> usize {
        self.first.partition_point(|&first| first <= index) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use std::f64::consts::PI;

    #[test]
    fn cells_tile_the_hemisphere() {
        for grid in
            [CellGrid::klems(), CellGrid::regular(9, 24), CellGrid::regular(1, 1), CellGrid::regular(5, 7)]
        {
            let (solid, projected) = grid
                .cells()
                .fold((0.0, 0.0), |(a, b), c| (a + c.solid_angle(), b + c.projected_solid_angle()));
            assert!((solid / TAU - 1.0).abs() < 1e-12 && (projected / PI - 1.0).abs() < 1e-12);
        }
        assert_eq!(CellGrid::klems().len(), 145);
        // Klems' Λ of the cells of the first two rings and the last: π sin²5°, π (sin²15° − sin²5°)/8, π cos²75°/12.
        let lambda = |i| CellGrid::klems().projected_solid_angle(i);
        for (i, expected) in [(0, 0.023_863), (3, 0.023_323), (144, 0.017_537)] {
            assert!((lambda(i) - expected).abs() < 1e-6, "{i}: {}", lambda(i));
        }
    }

    #[test]
    fn directions_of_a_cell_lie_in_it_and_follow_the_cosine() {
        let mut rng = Pcg32::new(1, 1);
        for grid in [CellGrid::klems(), CellGrid::regular(9, 24)] {
            for index in 0..grid.len() {
                let cell = grid.cell(index);
                for _ in 0..20 {
                    let mut u = || 0.001 + 0.998 * rng.next_f32();
                    let w = cell.direction(Vec2::new(u(), u()));
                    assert_eq!(grid.index(w), index);
                    assert_eq!(grid.index(LocalDir::new_unchecked(Vec3::new(w.x, w.y, -w.z))), index);
                }
                let opposite = grid.opposite(index).unwrap();
                let w = cell.direction(Vec2::splat(0.4));
                assert_eq!(grid.index(LocalDir::new_unchecked(Vec3::new(-w.x, -w.y, w.z))), opposite);
            }
        }
        // Half of the projected solid angle of the hemisphere lies within 45°.
        let whole = CellGrid::regular(1, 1).cell(0);
        assert!((whole.direction(Vec2::new(0.5, 0.0)).z - 0.5_f32.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn the_horizon_and_the_pole_have_a_cell() {
        let grid = CellGrid::klems();
        assert_eq!(grid.index(LocalDir::new_unchecked(Vec3::Z)), 0);
        assert_eq!(grid.index(LocalDir::new_unchecked(Vec3::X)), 133);
        assert_eq!(grid.index(LocalDir::new_unchecked(Vec3::NEG_X)), 139);
    }
}
