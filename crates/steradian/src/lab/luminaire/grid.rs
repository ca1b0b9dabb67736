//! The directions of a table of intensities.

use super::contract::{LuminaireError, LuminaireSettings};
use crate::light::photometric::{Interpolation, PhotometricWeb};

/// Directions of a table.
pub(super) struct Grid {
    /// C [°].
    pub(super) planes: Vec<f64>,
    /// γ [°].
    pub(super) gamma: Vec<f64>,
}

impl Grid {
    pub(super) fn new(settings: &LuminaireSettings) -> Result<Self, LuminaireError> {
        let &LuminaireSettings { planes, gamma_steps, .. } = settings;
        if !(1..=720).contains(&planes) || !(1..=1800).contains(&gamma_steps) {
            return Err(LuminaireError::Grid { planes, gamma_steps });
        }
        Ok(Self {
            planes: (0..planes).map(|i| f64::from(i) * 360.0 / f64::from(planes)).collect(),
            gamma: (0..=gamma_steps).map(|i| f64::from(i) * 180.0 / f64::from(gamma_steps)).collect(),
        })
    }

    /// Cells that differ: both poles are one direction each.
    pub(super) fn cells(&self) -> usize {
        2 + self.planes.len() * (self.gamma.len() - 2)
    }

    /// C and γ [°] of a cell, the first two being the poles; `u` chooses C where one plane stands for all.
    pub(super) fn direction(&self, cell: usize, u: f32) -> [f64; 2] {
        let inner = self.gamma.len() - 2;
        match cell {
            0 => [0.0, 0.0],
            1 => [0.0, 180.0],
            _ if self.planes.len() == 1 => [360.0 * f64::from(u), self.gamma[1 + (cell - 2) % inner]],
            _ => [self.planes[(cell - 2) / inner], self.gamma[1 + (cell - 2) % inner]],
        }
    }

    /// The cell of each place of the table, all γ of a plane after each other.
    pub(super) fn indices(&self) -> impl Iterator<Item = usize> + '_ {
        let (n, inner) = (self.gamma.len(), self.gamma.len() - 2);
        (0..self.planes.len() * n).map(move |i| match i % n {
            0 => 0,
            g if g == n - 1 => 1,
            g => 2 + (i / n) * inner + g - 1,
        })
    }

    /// The integral of a table of cells.
    pub(super) fn flux(&self, values: &[f64], interpolation: Interpolation) -> f64 {
        let table = self.indices().map(|cell| values[cell]).collect();
        let web = PhotometricWeb::type_c(self.planes.clone(), self.gamma.clone(), table);
        web.map_or(0.0, |web| web.interpolated(interpolation).flux())
    }
}
