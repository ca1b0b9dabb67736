//! Writes any reflection into the adaptive parameterisation.

use super::tensor::TensorWriter;
use super::warp::{Blend, Grid, Knot, Warp};
use crate::math::{LocalDir, Vec2, Vec3, warp::spherical_direction};
use crate::optics::TrowbridgeReitz;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Where a `.bsdf` file has nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes {
    /// Number of known polar angles over [0, π/2], at least one.
    pub theta: usize,
    /// Known azimuths.
    pub azimuths: Azimuths,
    /// Side of the grids of facet normals, at least two.
    pub facets: usize,
    /// Side of the grids of spectra, at least two.
    pub directions: usize,
    /// Wavelengths [nm], increasing.
    pub wavelengths: Vec<f32>,
}

/// Known azimuths of a `.bsdf` file; each number of nodes is at least three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Azimuths {
    /// Only the difference of azimuths counts.
    Isotropic,
    /// All of the circle.
    Full(usize),
    /// Half of it: the surface is unchanged by half a turn.
    Half(usize),
    /// A quarter of it: the surface is unchanged by mirroring x and y.
    Quarter(usize),
}

impl Azimuths {
    fn values(self) -> Vec<f32> {
        let spread = |n: usize, span: f32| (0..n).map(|i| -PI + span * i as f32 / (n - 1) as f32).collect();
        match self {
            Self::Isotropic => vec![0.0],
            Self::Full(n) => spread(n, TAU),
            Self::Half(n) => spread(n, PI),
            Self::Quarter(n) => spread(n, FRAC_PI_2),
        }
    }
}

/// The bytes of a `.bsdf` file of the reflection f(wo, wi, λ [nm]) [sr⁻¹], without cosine, for directions above the
/// surface.
///
/// `facets` shapes the parameterisation, not the values: the nearer its lobe is to that of f, the finer f is resolved.
/// Widths under a tenth need more than 32 facets a side.
pub fn tabulate(
    facets: &TrowbridgeReitz,
    nodes: &Nodes,
    f: impl Fn(LocalDir, LocalDir, f32) -> f32,
) -> Vec<u8> {
    let phi = nodes.azimuths.values();
    let isotropic = nodes.azimuths == Azimuths::Isotropic;
    let theta: Vec<f32> =
        (0..nodes.theta).map(|i| FRAC_PI_2 * i as f32 / (nodes.theta - 1).max(1) as f32).collect();
    let known: Vec<LocalDir> =
        phi.iter().flat_map(|&phi| theta.iter().map(move |&theta| direction(theta, phi))).collect();
    let grid = Grid { nx: nodes.facets, ny: nodes.facets };
    let square = Grid { nx: nodes.directions, ny: nodes.directions };
    let ndf = over(grid, |u| facets.d(normal(u)));
    let sigma = over(grid, |u| area(facets, normal(u)));
    let visible = |wo: LocalDir| {
        over(grid, |u| {
            let m = normal(u);
            let sin_theta = m.truncate().length();
            facets.d(m) * wo.dot(*m).max(0.0) * 2.0 * PI * PI * u.x * sin_theta
        })
    };
    let vndf: Vec<f32> = known.iter().flat_map(|&wo| visible(wo)).collect();
    // A lobe below f32's range on every node would have no shape; facets are wide enough for any grid of use.
    let Ok(map) = Warp::new(grid, vndf.clone()) else { return Vec::new() };
    let (mut luminance, mut spectra) = (Vec::new(), Vec::new());
    for (i, &wo) in known.iter().enumerate() {
        let blend = Blend::new(Knot { index: i as u32, share: 0.0 }, Knot::default(), 1);
        let ratio = |s: Vec2, lambda| {
            let m = normal(map.sample(s, &blend).p);
            let wi = *m * (2.0 * wo.dot(*m)) - *wo;
            match LocalDir::new(wi) {
                Some(wi) if wi.z > 0.0 => f(wo, wi, lambda) * wi.z * 4.0 * area(facets, wo) / facets.d(m),
                _ => 0.0,
            }
        };
        let first = spectra.len();
        for &lambda in &nodes.wavelengths {
            spectra.extend(over(square, |s| ratio(s, lambda)));
        }
        let of_direction = &spectra[first..];
        let mean = |k| of_direction.iter().skip(k).step_by(square.len()).sum::<f32>();
        luminance.extend((0..square.len()).map(|k| mean(k) / nodes.wavelengths.len() as f32));
    }
    let mut file = TensorWriter::default();
    let slices = [phi.len(), theta.len()];
    file.bytes("description", if isotropic { b"isotropic, tabulated" } else { b"anisotropic, tabulated" });
    file.bytes("jacobian", &[1]);
    file.floats("theta_i", &[theta.len()], &theta);
    file.floats("phi_i", &[phi.len()], &phi);
    file.floats("wavelengths", &[nodes.wavelengths.len()], &nodes.wavelengths);
    file.floats("ndf", &[grid.ny, grid.nx], &ndf);
    file.floats("sigma", &[grid.ny, grid.nx], &sigma);
    file.floats("vndf", &[slices[0], slices[1], grid.ny, grid.nx], &vndf);
    file.floats("luminance", &[slices[0], slices[1], square.ny, square.nx], &luminance);
    let shape = [slices[0], slices[1], nodes.wavelengths.len(), square.ny, square.nx];
    file.floats("spectra", &shape, &spectra);
    file.finish()
}

/// Projected area of the facets that `w` sees, cosθ/G₁ (Heitz 2014, eq. 39).
fn area(facets: &TrowbridgeReitz, w: LocalDir) -> f32 {
    1.0 / facets.g1_over_cos(w)
}

fn direction(theta: f32, phi: f32) -> LocalDir {
    let w = spherical_direction(theta, phi);
    // cos(π/2) is not zero in floats, and may be negative.
    LocalDir::new_unchecked(Vec3::new(w.x, w.y, w.z.max(0.0)))
}

/// The direction with coordinates u on the square.
fn normal(u: Vec2) -> LocalDir {
    direction(u.x * u.x * FRAC_PI_2, (2.0 * u.y - 1.0) * PI)
}

/// Values at the nodes of a grid over the unit square.
fn over(grid: Grid, f: impl Fn(Vec2) -> f32) -> Vec<f32> {
    let at = |i: usize, n: usize| i as f32 / (n - 1) as f32;
    (0..grid.len()).map(|i| f(Vec2::new(at(i % grid.nx, grid.nx), at(i / grid.nx, grid.ny)))).collect()
}
