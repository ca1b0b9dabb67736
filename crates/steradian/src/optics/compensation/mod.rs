//! What single scattering by microfacets loses, tabulated so that a wide lobe can give it back.
//!
//! The share m(ω) of light from ω that meets a second facet returns in proportion to m on the way out, which is
//! reciprocal (Kelemen & Szirmay-Kalos 2001; Kulla & Conty 2017). For a mirror f = m(ωo) m(ωi) / (π M), where M is the
//! mean of m over the hemisphere; for an interface see [`Split`]. All tables are piecewise linear, and M is the mean
//! of the interpolated m: energy is lost or gained only as far as m is wrong.

mod coverage;
mod curve;
mod elevation;
mod half;
mod interpolation;
mod lobe;
mod sheet;
mod split;

pub use coverage::Coverage;
pub use half::Half;
pub use split::{Split, further_reflections};

use super::films::{self, Film};
use super::fresnel::{self, Crossing};
use super::microfacet::{Distribution, Microfacets};
use super::refraction;
use crate::math::{LocalDir, Vec2, Vec3};
use curve::Curve;
use interpolation::{Axis, Cell};
use sheet::Sheet;
use std::f32::consts::PI;

/// Where a distribution lies in a table.
#[derive(Clone, Copy, Debug)]
pub struct Position {
    /// Along either axis of widths.
    widths: [f32; 2],
    /// Along the axis of what else the loss depends on.
    other: f32,
}

/// The losses of a family of surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct LossTable {
    coverage: Coverage,
    axis: Axis,
    /// By the axis, then by side, then by the nodes of widths.
    sheets: Vec<Sheet>,
    /// Hemispherical transmittance of the smooth interface from above, over the axis; empty for a mirror.
    transmittance: Vec<f32>,
}

impl LossTable {
    /// That of facets that reflect everything.
    pub fn mirror(coverage: Coverage) -> Self {
        let axis = Axis::new(0.0, 0.0, 1);
        let mut table = Self { coverage, axis, sheets: Vec::new(), transmittance: Vec::new() };
        table.extend(None, &[Curve::new(|_| 1.0)]);
        table
    }

    /// That of dielectric interfaces, with indices below over above from `min` to `max`, the further coordinate.
    pub fn interface(coverage: Coverage, min: f32, max: f32) -> Self {
        let axis = Axis::new(min, max, 5);
        let mut table = Self { coverage, axis, sheets: Vec::new(), transmittance: Vec::new() };
        for eta in axis.nodes() {
            table.extend(Some(eta), &[Curve::new(|cos| fresnel::dielectric(cos, eta))]);
        }
        table
    }

    /// That of an interface under a film of constant thickness, over the wavenumbers [nm⁻¹] from `first` to `last`, the further
    /// coordinate. `eta` is the index below over above and `film` that of the film over above, by the wavelength [nm].
    pub fn filmed(
        coverage: Coverage,
        [first, last]: [f32; 2],
        thickness_nm: f32,
        eta: impl Fn(f32) -> f32,
        film: impl Fn(f32) -> f32,
    ) -> Self {
        // Half a radian of the phase between the film's two faces a node, over wavenumbers and over cosines.
        let films = |x: f32| Film { eta: film(1.0 / x), thickness_nm };
        let phase = |x: f32| 4.0 * PI * films(x).eta * thickness_nm * x;
        let pieces = |radians: f32, least: usize| least.max((2.0 * radians) as usize);
        let axis = Axis::new(first, last, 1 + pieces(phase(last) - phase(first), 24));
        let mut table = Self { coverage, axis, sheets: Vec::new(), transmittance: Vec::new() };
        let curve = |x: f32| {
            Curve::with_pieces(pieces(phase(x), Curve::PIECES), |cos| {
                films::reflectance_dielectric(cos, films(x), eta(1.0 / x), 1.0 / x).clamp(0.0, 1.0)
            })
        };
        let index = eta(1.0 / first);
        if axis.nodes().all(|x| eta(1.0 / x) == index) {
            let curves: Vec<Curve> = axis.nodes().map(curve).collect();
            table.extend(Some(index), &curves);
        } else {
            for x in axis.nodes() {
                table.extend(Some(eta(1.0 / x)), &[curve(x)]);
            }
        }
        table
    }

    /// Adds the sheets of each of the curves, which share what is costly.
    fn extend(&mut self, eta: Option<f32>, curves: &[Curve]) {
        let resolution = self.coverage.resolution();
        let halves: &[Half] = if eta.is_some() { &[Half::Above, Half::Below] } else { &[Half::Above] };
        let mut by_curve = vec![Vec::new(); curves.len()];
        for &half in halves {
            for d in self.coverage.nodes() {
                let nodes = Sheet::nodes(&d, resolution);
                let mut values = vec![Vec::with_capacity(nodes.len()); curves.len()];
                for w in nodes {
                    let w = if half == Half::Below { -w } else { w };
                    for (values, m) in values.iter_mut().zip(losses(&d, w, eta, curves, resolution.lattice)) {
                        values.push(m);
                    }
                }
                for (sheets, m) in by_curve.iter_mut().zip(values) {
                    sheets.push(Sheet::new(&d, resolution, m));
                }
            }
        }
        self.sheets.extend(by_curve.into_iter().flatten());
        if eta.is_some() {
            self.transmittance.extend(curves.iter().map(Curve::hemispherical_transmittance));
        }
    }

    /// Where to look for `d` and for `other`, the index or what else the table was made for.
    pub fn position(&self, d: &Microfacets, other: f32) -> Position {
        let widths = d.alpha().map(|alpha| self.coverage.position(alpha));
        Position { widths, other: self.axis.position(other) }
    }

    /// Whether the table holds for `d` and `other`, and not only for something near them.
    pub fn covers(&self, d: &Microfacets, other: f32) -> bool {
        let last = self.axis.first + self.axis.step * (self.axis.n - 1) as f32;
        let slack = 1e-4 * last.abs();
        let [x, y] = d.alpha();
        (self.axis.first - slack..=last + slack).contains(&other)
            && match self.coverage {
                Coverage::One(one) => one == *d,
                Coverage::Isotropic(_) => x == y && x <= 1.0,
                Coverage::Anisotropic(_) => x.max(y) <= 1.0,
            }
    }

    /// m(w): the share of light from `w` that single scattering loses, in [0, 1].
    pub fn loss(&self, at: &Position, w: LocalDir) -> f32 {
        let (x2, y2) = (w.x * w.x, w.y * w.y);
        let sin2 = x2 + y2;
        self.mean_over_nodes(at, Half::of(w), |sheet, [ax, ay]| {
            // Along the normal every azimuth is as good.
            let alpha = if sin2 > 0.0 { ((ax * ax * x2 + ay * ay * y2) / sin2).sqrt() } else { ax };
            sheet.at(w.abs_cos_theta(), alpha.clamp(sheet.low, sheet.high))
        })
    }

    /// M: the share of light from all of a half, equally bright in every direction, that single scattering loses.
    pub fn mean_loss(&self, at: &Position, half: Half) -> f32 {
        self.mean_over_nodes(at, half, |sheet, _| sheet.mean)
    }

    /// A direction in `half`, by and large in proportion to m cosθ, with density [`LossTable::lobe_pdf`] in u ∈ [0, 1)².
    pub fn sample_lobe(&self, at: &Position, half: Half, u: Vec2) -> LocalDir {
        let up = self.nearest(at, half).lobe.sample(u);
        if half == Half::Below { -up } else { up }
    }

    /// Density [sr⁻¹] of `w` among the directions that are drawn in its half.
    pub fn lobe_pdf(&self, at: &Position, w: LocalDir) -> f32 {
        self.nearest(at, Half::of(w)).lobe.pdf(w.abs_cos_theta())
    }

    /// What a smooth interface transmits of light from all of the upper half, equally bright in every direction; zero
    /// for a mirror.
    pub fn transmittance(&self, at: &Position) -> f32 {
        if self.transmittance.is_empty() { 0.0 } else { Cell::new(at.other).lerp(&self.transmittance) }
    }

    /// The sheets over the widths, at a node of the axis.
    fn sheets(&self, k: usize, half: Half) -> &[Sheet] {
        let n_halves = if self.transmittance.is_empty() { 1 } else { 2 };
        let half = if n_halves == 2 && half == Half::Below { 1 } else { 0 };
        let n_nodes = self.sheets.len() / (self.axis.n * n_halves);
        &self.sheets[(k * n_halves + half) * n_nodes..][..n_nodes]
    }

    /// The sheet whose node is nearest.
    fn nearest(&self, at: &Position, half: Half) -> &Sheet {
        let sheets = self.sheets(at.other.round() as usize, half);
        let [i, j] = at.widths.map(|x| x.round() as usize);
        match self.coverage {
            Coverage::One(_) => &sheets[0],
            Coverage::Isotropic(_) => &sheets[i],
            Coverage::Anisotropic(_) => &sheets[Self::pair(i, j)],
        }
    }

    /// The index of the sheet for two nodes of widths, in either order.
    fn pair(i: usize, j: usize) -> usize {
        let (low, high) = (i.min(j), i.max(j));
        high * (high + 1) / 2 + low
    }

    /// The interpolation of a quantity of the sheets, given with their widths along x and y.
    fn mean_over_nodes(&self, at: &Position, half: Half, f: impl Fn(&Sheet, [f32; 2]) -> f32) -> f32 {
        let [x, y] = at.widths;
        let mut sum = 0.0;
        for (k, share) in Cell::new(at.other).shares() {
            let sheets = self.sheets(k, half);
            match self.coverage {
                Coverage::One(d) => sum += share * f(&sheets[0], d.alpha()),
                Coverage::Isotropic(_) => {
                    for (i, share_i) in Cell::new(x).shares() {
                        sum += share * share_i * f(&sheets[i], [sheets[i].low; 2]);
                    }
                }
                Coverage::Anisotropic(_) => {
                    for (i, share_i) in Cell::new(x).shares() {
                        for (j, share_j) in Cell::new(y).shares() {
                            let sheet = &sheets[Self::pair(i, j)];
                            let widths =
                                if i <= j { [sheet.low, sheet.high] } else { [sheet.high, sheet.low] };
                            sum += share * share_i * share_j * f(sheet, widths);
                        }
                    }
                }
            }
        }
        sum
    }
}

/// The share of light from `w` that facets with each of the reflectances `curves` lose: one minus the mean of G/G1 over
/// the visible normals, at the points of a lattice. Without `eta`, what is not reflected is absorbed.
fn losses(
    d: &Microfacets,
    w: LocalDir,
    eta: Option<f32>,
    curves: &[Curve],
    [n, generator]: [u32; 2],
) -> Vec<f32> {
    let mut lost = vec![0.0_f64; curves.len()];
    for i in 0..n {
        let along = f64::from(i * generator % n) / f64::from(n);
        let u = Vec2::new(along as f32, (f64::from(i) + 0.5) as f32 / n as f32);
        let wm = d.sample_visible(w, u);
        let cos = w.dot(*wm);
        let passed = |wi: Vec3, same_half: bool| {
            let wi = LocalDir::new_unchecked(wi);
            let leaves = if same_half { w.z * wi.z > 0.0 } else { w.z * wi.z < 0.0 };
            if leaves { d.g_over_g1(w, wi) } else { 0.0 }
        };
        let reflected = passed(refraction::reflect(*w, *wm), true);
        let transmitted =
            eta.and_then(|eta| Crossing::new(cos, eta).refract(*w, *wm)).map_or(0.0, |wi| passed(wi, false));
        for (lost, curve) in lost.iter_mut().zip(curves) {
            let r = curve.at(cos);
            *lost += f64::from(r * (1.0 - reflected) + (1.0 - r) * (1.0 - transmitted));
        }
    }
    lost.into_iter().map(|sum| (sum / f64::from(n)).clamp(0.0, 1.0) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;
    use crate::optics::microfacet::FacetShape;

    fn at(degrees: f32, phi: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), phi.to_radians()))
    }

    const SHAPES: [FacetShape; 2] = [FacetShape::TrowbridgeReitz, FacetShape::Beckmann];

    /// The largest error of a table against dense lattices over directions, half a degree from the horizon and more.
    fn worst_error(table: &LossTable, d: &Microfacets, eta: Option<f32>) -> f32 {
        let curve = match eta {
            None => Curve::new(|_| 1.0),
            Some(eta) => Curve::new(|cos| fresnel::dielectric(cos, eta)),
        };
        let position = table.position(d, eta.unwrap_or(0.0));
        let mut worst = 0.0_f32;
        for degrees in [0.0, 37.0, 44.0, 65.0, 77.0, 86.0, 88.0, 89.0, 89.5] {
            for phi in [0.0, 3.0, 10.0, 35.0, 75.0] {
                for w in [at(degrees, phi), -at(degrees, phi)] {
                    if w.z < 0.0 && eta.is_none() {
                        continue;
                    }
                    let exact = losses(d, w, eta, std::slice::from_ref(&curve), [1597, 987])[0];
                    worst = worst.max((table.loss(&position, w) - exact).abs());
                }
            }
        }
        worst
    }

    #[test]
    fn tables_for_one_distribution_are_exact_to_a_few_thousandths() {
        let shapes =
            [(0, 0.01, 0.01), (1, 0.3, 0.3), (0, 1.0, 1.0), (1, 1.0, 1.0), (0, 0.6, 0.1), (1, 0.1, 0.6)];
        for (shape, ax, ay) in shapes {
            let d = Microfacets::new(SHAPES[shape], ax, ay);
            for eta in [None, Some(1.5), Some(1.02)] {
                let table = match eta {
                    None => LossTable::mirror(Coverage::One(d)),
                    Some(eta) => LossTable::interface(Coverage::One(d), eta, eta),
                };
                let worst = worst_error(&table, &d, eta);
                assert!(worst < 4e-3, "{d:?} {eta:?}: {worst}");
            }
        }
    }

    #[test]
    fn tables_for_textured_widths_are_exact_to_less_than_a_hundredth() {
        for (shape, widths) in SHAPES.into_iter().zip([[0.013, 0.23, 1.0], [0.01, 0.07, 0.6]]) {
            let mirror = LossTable::mirror(Coverage::Isotropic(shape));
            let glass = LossTable::interface(Coverage::Isotropic(shape), 1.45, 1.55);
            for alpha in widths {
                let d = Microfacets::new(shape, alpha, alpha);
                let errors = [worst_error(&mirror, &d, None), worst_error(&glass, &d, Some(1.52))];
                assert!(errors.iter().all(|&e| e < 6e-3), "{d:?}: {errors:?}");
            }
        }
        let mirror = LossTable::mirror(Coverage::Anisotropic(SHAPES[0]));
        for (ax, ay) in [(0.01, 0.01), (0.013, 0.5), (0.3, 0.07), (0.5, 1.0)] {
            let d = Microfacets::new(SHAPES[0], ax, ay);
            let worst = worst_error(&mirror, &d, None);
            assert!(worst < 1e-2, "{d:?}: {worst}");
        }
    }

    #[test]
    fn mean_loss_is_the_mean_of_the_interpolated_losses() {
        let d = Microfacets::new(FacetShape::TrowbridgeReitz, 0.04, 0.5);
        for (table, eta) in [
            (LossTable::mirror(Coverage::One(d)), 0.0),
            (LossTable::interface(Coverage::One(d), 1.5, 1.5), 1.5),
            (LossTable::mirror(Coverage::Anisotropic(FacetShape::TrowbridgeReitz)), 0.0),
        ] {
            let position = table.position(&d, eta);
            for half in [Half::Above, Half::Below] {
                let n = 300;
                let mut sum = 0.0_f64;
                for i in 0..n * n {
                    let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                    let w = warp::cosine_hemisphere(u);
                    sum += f64::from(table.loss(&position, if half == Half::Below { -w } else { w }));
                }
                let (found, expected) = (f64::from(table.mean_loss(&position, half)), sum / f64::from(n * n));
                assert!((found / expected - 1.0).abs() < 2e-3, "{half:?} {found} {expected}");
            }
        }
    }

    #[test]
    fn split_keeps_transmission_reciprocal() {
        for (eta, above, below) in [(1.5_f32, 0.2, 0.05), (0.7, 0.01, 0.3), (1.001, 0.4, 0.4)] {
            let transmittance = Curve::new(|cos| fresnel::dielectric(cos, eta)).hemispherical_transmittance();
            let split = Split::new(eta, transmittance, above, below);
            let (t, b) = (split.transmitted(Half::Above), split.transmitted(Half::Below));
            assert!((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&b), "{split:?}");
            assert!((t * above - b * eta * eta * below).abs() < 1e-6, "{split:?}");
        }
    }

    #[test]
    fn curves_know_the_hemispherical_transmittance() {
        // 1 − r_ext(1.5), lightlab 2.3's closed form.
        let t = Curve::new(|cos| fresnel::dielectric(cos, 1.5)).hemispherical_transmittance();
        assert!((t - (1.0 - 0.091_777_96)).abs() < 2e-5, "{t}");
    }

    #[test]
    fn further_reflections_of_a_perfect_mirror_return_everything() {
        for loss in [0.0, 0.3, 0.69, 1.0 - 1e-6] {
            assert!((further_reflections(1.0, loss) - 1.0).abs() < 1e-3);
            // A grey metal: the geometric series term by term.
            let series: f32 = (0..200).map(|i| 0.5 * (0.5 * loss).powi(i) * 0.5 * (1.0 - loss)).sum();
            assert!((further_reflections(0.5, loss) - series).abs() < 1e-5);
        }
    }
}
