//! Quadrature and counting over cells of the sphere of directions.

use crate::bsdf::quadrature::GAUSS_LEGENDRE;
use crate::math::{LocalDir, Vec3};
use std::f64::consts::{PI, TAU};

const THETA_CELLS: usize = 24;
const PHI_CELLS: usize = 48;
/// Midpoints along φ in a cell; along θ a Gauss rule, since a lobe around the pole is no periodic function of θ.
const PHI_NODES: usize = 8;

/// Number of cells.
pub(super) const CELLS: usize = THETA_CELLS * PHI_CELLS;

/// The cell that a direction lies in: equal steps of θ and φ, which resolve lobes around the normal.
pub(super) fn cell(w: LocalDir) -> usize {
    let theta = f64::from(w.x).hypot(f64::from(w.y)).atan2(f64::from(w.z));
    let phi = (f64::from(w.y).atan2(f64::from(w.x)) / TAU).rem_euclid(1.0);
    let (i, j) = (theta / PI * THETA_CELLS as f64, phi * PHI_CELLS as f64);
    (i as usize).min(THETA_CELLS - 1) * PHI_CELLS + (j as usize).min(PHI_CELLS - 1)
}

/// A node of the quadrature over the whole sphere.
pub(super) struct Node {
    pub(super) cell: usize,
    pub(super) w: LocalDir,
    /// The solid angle that the node stands for [sr].
    pub(super) solid_angle: f64,
}

/// Number of nodes.
pub(super) const NODES: usize = CELLS * PHI_NODES * GAUSS_LEGENDRE.len();

/// All nodes.
pub(super) fn nodes() -> impl Iterator<Item = Node> {
    let n_phi = PHI_CELLS * PHI_NODES;
    let step = PI / THETA_CELLS as f64;
    (0..THETA_CELLS).flat_map(move |i| {
        GAUSS_LEGENDRE.iter().flat_map(move |&[x, weight]| {
            let theta = (i as f64 + x) * step;
            let (r, z) = theta.sin_cos();
            let solid_angle = weight * step * r * TAU / n_phi as f64;
            (0..n_phi).map(move |j| {
                let phi = TAU * (j as f64 + 0.5) / n_phi as f64;
                let w = Vec3::new((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32);
                Node { cell: i * PHI_CELLS + j / PHI_NODES, w: LocalDir::new_unchecked(w), solid_angle }
            })
        })
    })
}
