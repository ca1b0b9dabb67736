//! Small measurements of surfaces that are known in closed form.

use super::tabulate::{Azimuths, Nodes, tabulate};
use super::{MeasuredTable, RglTable};
use crate::math::LocalDir;
use crate::optics::{TrowbridgeReitz, fresnel};

/// Wavelengths [nm] at which specimens are examined: on a node, between nodes, and beyond both ends.
pub(super) const WAVELENGTHS: [f32; 4] = [550.0, 365.0, 607.0, 820.0];

/// A table with a name for reports.
#[derive(Clone, Debug)]
pub struct Synthetic {
    /// The name.
    pub name: &'static str,
    /// The table.
    pub table: MeasuredTable,
}

/// A rough metal with single scattering: f = D F G / (4 cosθo cosθi), as tarnished copper.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metal(pub(super) TrowbridgeReitz);

impl Metal {
    /// Its optical constants at `lambda` [nm]: smooth, and near those of copper.
    fn index(lambda: f32) -> [f32; 2] {
        let red = 1.0 / (1.0 + (-(lambda - 575.0) / 15.0).exp());
        [1.2 - 0.9 * red, 2.5 + 0.004 * (lambda - 500.0)]
    }

    /// f [sr⁻¹] between directions above the surface.
    pub(super) fn f(&self, wo: LocalDir, wi: LocalDir, lambda: f32) -> f32 {
        let Some(m) = LocalDir::new(*wo + *wi) else { return 0.0 };
        let [eta, k] = Self::index(lambda);
        0.25 * self.0.d(m) * self.0.g_over_cosines(wo, wi) * fresnel::conductor(wo.dot(*m), eta, k)
    }
}

/// A `.bsdf` file of [`Metal`].
pub(super) fn metal_file(facets: TrowbridgeReitz, nodes: &Nodes) -> Vec<u8> {
    tabulate(&facets, nodes, |wo, wi, lambda| Metal(facets).f(wo, wi, lambda))
}

pub(super) fn nodes(azimuths: Azimuths, facets: usize) -> Nodes {
    Nodes {
        theta: 8,
        azimuths,
        facets,
        directions: 32,
        wavelengths: vec![380.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 780.0],
    }
}

/// The specimens of the conformance suite.
pub fn tables() -> Vec<Synthetic> {
    let mut all = Vec::new();
    for (name, ax, ay, azimuths, facets) in [
        ("measured rgl rough 0.03", 0.03, 0.03, Azimuths::Isotropic, 64),
        ("measured rgl rough 0.3", 0.3, 0.3, Azimuths::Isotropic, 32),
        ("measured rgl rough 1", 1.0, 1.0, Azimuths::Isotropic, 32),
        ("measured rgl brushed", 0.15, 0.6, Azimuths::Quarter(5), 32),
    ] {
        let file = metal_file(TrowbridgeReitz::new(ax, ay), &nodes(azimuths, facets));
        // What the project writes, it reads (tested); a specimen that it did not read would be missing in reports.
        if let Ok(table) = RglTable::parse(&file) {
            all.push(Synthetic { name, table: MeasuredTable::Rgl(table) });
        }
    }
    all
}
