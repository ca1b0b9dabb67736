//! Grids of points on which illuminance is judged.

use crate::lab::meters::MeterPoint;
use glam::DVec3;

/// A parallelogram divided into cells, with a meter in the middle of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// What it is called.
    pub name: String,
    /// A corner [scene units].
    pub corner: [f64; 3],
    /// The side from there along which points are counted first.
    pub u: [f64; 3],
    /// The other side from there.
    pub v: [f64; 3],
    /// Cells along `u`, at least 1.
    pub columns: usize,
    /// Cells along `v`, at least 1.
    pub rows: usize,
}

/// Why there is no such grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// The sides lie along one line, or a number is not finite.
    #[error("the sides of the grid span no area")]
    Flat,
    /// No cells, or more than a million.
    #[error("the grid needs between 1 and 1000000 cells")]
    Cells,
}

impl Grid {
    /// Checks what must hold.
    ///
    /// # Errors
    /// When the sides span no area, or there are no cells or too many.
    pub fn checked(self) -> Result<Self, GridError> {
        if !(1..=1_000_000).contains(&self.columns.saturating_mul(self.rows)) {
            return Err(GridError::Cells);
        }
        if !(self.normal().is_some() && DVec3::from(self.corner).is_finite()) {
            return Err(GridError::Flat);
        }
        Ok(self)
    }

    /// Where the meters face: u × v, a unit vector; `None` for a grid without area.
    pub fn normal(&self) -> Option<[f64; 3]> {
        let (u, v) = (DVec3::from(self.u), DVec3::from(self.v));
        let n = u.cross(v);
        (n.length() > 1e-9 * u.length() * v.length()).then(|| n.normalize().into())
    }

    /// Lengths of the sides [scene units].
    pub fn size(&self) -> [f64; 2] {
        [DVec3::from(self.u).length(), DVec3::from(self.v).length()]
    }

    /// The meters, row by row.
    pub fn points(&self) -> Vec<MeterPoint> {
        let normal = self.normal().unwrap_or([0.0, 0.0, 1.0]);
        let (corner, u, v) = (DVec3::from(self.corner), DVec3::from(self.u), DVec3::from(self.v));
        let mut points = Vec::with_capacity(self.columns * self.rows);
        for row in 0..self.rows {
            for column in 0..self.columns {
                let s = (column as f64 + 0.5) / self.columns as f64;
                let t = (row as f64 + 0.5) / self.rows as f64;
                points.push(MeterPoint { position: (corner + u * s + v * t).into(), normal });
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meters_stand_in_the_middle_of_cells_and_face_u_cross_v() {
        let grid = Grid {
            name: "desk".to_owned(),
            corner: [1.0, 2.0, 0.8],
            u: [4.0, 0.0, 0.0],
            v: [0.0, 3.0, 0.0],
            columns: 4,
            rows: 2,
        };
        let points = grid.clone().checked().unwrap().points();
        assert_eq!(points.len(), 8);
        assert_eq!(points[0].position, [1.5, 2.75, 0.8]);
        assert_eq!(points[5].position, [2.5, 4.25, 0.8]);
        assert!(points.iter().all(|p| p.normal == [0.0, 0.0, 1.0]));
        assert_eq!(grid.size(), [4.0, 3.0]);
        let flat = Grid { v: [8.0, 0.0, 0.0], ..grid.clone() };
        assert_eq!(flat.checked(), Err(GridError::Flat));
        assert_eq!(Grid { rows: 0, ..grid }.checked(), Err(GridError::Cells));
    }
}
