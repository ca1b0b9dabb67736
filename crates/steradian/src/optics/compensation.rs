//! What single scattering by microfacets loses, tabulated so that a wide lobe can give it back.
//!
//! The share m(ω) of light from ω that meets a second facet returns in proportion to m on the way out, which is
//! reciprocal (Kelemen & Szirmay-Kalos 2001; Kulla & Conty 2017). For a mirror f = m(ωo) m(ωi) / (π M), where M is the
//! mean of m over the hemisphere; for an interface see [`Split`]. All tables are piecewise linear, and M is the mean
//! of the interpolated m: energy is lost or gained only as far as m is wrong.

use super::films::{self, Film};
use super::fresnel::{self, Crossing};
use super::microfacet::{Distribution, FacetShape, Microfacets};
use super::refraction;
use crate::math::{LocalDir, Vec2, Vec3};
use std::f32::consts::PI;
use std::f64::consts::FRAC_PI_2;

/// The side of an interface that light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// The side of the normal; the only one of a mirror.
    Above,
    /// The other side.
    Below,
}

impl Half {
    /// The half that a direction lies in.
    pub fn of(w: LocalDir) -> Self {
        if w.z < 0.0 { Self::Below } else { Self::Above }
    }

    /// The other half.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Above => Self::Below,
            Self::Below => Self::Above,
        }
    }
}

/// The distributions that a table must serve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coverage {
    /// One, at its own widths.
    One(Microfacets),
    /// Equal widths from [`Coverage::NARROWEST`] to 1.
    Isotropic(FacetShape),
    /// Any two widths from [`Coverage::NARROWEST`] to 1.
    Anisotropic(FacetShape),
}

impl Coverage {
    /// The narrowest tabulated width: what a narrower distribution loses, it loses within a seventh of a degree of the
    /// horizon.
    pub const NARROWEST: f32 = 2e-3;

    /// Widths per axis.
    fn n_widths(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Isotropic(_) => 24,
            Self::Anisotropic(_) => 15,
        }
    }

    fn resolution(&self) -> Resolution {
        match self {
            Self::One(d) => {
                let [x, y] = d.alpha();
                if x == y {
                    Resolution { n_cosines: 128, n_azimuths: 1, lattice: [987, 610] }
                } else {
                    let n_azimuths = 9 + (4.0 * (x / y).ln().abs()) as usize;
                    Resolution { n_cosines: 96, n_azimuths, lattice: [610, 377] }
                }
            }
            Self::Isotropic(_) => Resolution { n_cosines: 48, n_azimuths: 1, lattice: [377, 233] },
            Self::Anisotropic(_) => Resolution { n_cosines: 24, n_azimuths: 7, lattice: [233, 144] },
        }
    }

    /// The distributions at the nodes, the first axis of widths being the narrower one.
    fn nodes(&self) -> Vec<Microfacets> {
        let (shape, n) = match self {
            Self::One(d) => return vec![*d],
            Self::Isotropic(shape) | Self::Anisotropic(shape) => (*shape, self.n_widths()),
        };
        let width = |i: usize| invert(Self::NARROWEST, 1.0, i as f32 / (n - 1) as f32, Self::coordinate);
        (0..n)
            .flat_map(|high| {
                let low = if matches!(self, Self::Isotropic(_)) { high } else { 0 };
                (low..=high).map(move |low| Microfacets::new(shape, width(low), width(high)))
            })
            .collect()
    }

    /// Where a width lies among the nodes.
    fn position(&self, alpha: f32) -> f32 {
        let last = (self.n_widths() - 1) as f32;
        last * Self::coordinate(alpha.clamp(Self::NARROWEST, 1.0))
    }

    /// Narrow facets lose light by the ratio of cosine and width, wide ones by the square of the width: two thirds of the
    /// nodes are spread over its logarithm, one over itself.
    fn coordinate(alpha: f32) -> f32 {
        let logarithm = 1.0 - alpha.ln() / Self::NARROWEST.ln();
        (2.0 * logarithm + (alpha - Self::NARROWEST) / (1.0 - Self::NARROWEST)) / 3.0
    }
}

/// Where between `low` and `high` an increasing function has the `value`, by bisection to the last digit.
fn invert(low: f32, high: f32, value: f32, f: impl Fn(f32) -> f32) -> f32 {
    let (mut low, mut high) = (low, high);
    for _ in 0..32 {
        let middle = 0.5 * (low + high);
        if f(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[derive(Clone, Copy, Debug)]
struct Resolution {
    n_cosines: usize,
    n_azimuths: usize,
    /// Number of points and generator of a Fibonacci lattice.
    lattice: [u32; 2],
}

/// Equidistant values of what else the loss depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    first: f32,
    step: f32,
    n: usize,
}

impl Axis {
    fn new(first: f32, last: f32, n: usize) -> Self {
        let n = if last > first { n.max(2) } else { 1 };
        Self { first, step: if n > 1 { (last - first) / (n - 1) as f32 } else { 1.0 }, n }
    }

    fn nodes(&self) -> impl Iterator<Item = f32> + use<> {
        let Self { first, step, n } = *self;
        (0..n).map(move |i| first + step * i as f32)
    }

    fn position(&self, x: f32) -> f32 {
        ((x - self.first) / self.step).clamp(0.0, (self.n - 1) as f32)
    }
}

/// Reflectance over the cosine to the facet, on both sides of it.
#[derive(Clone, Debug)]
struct Curve {
    above: Vec<f32>,
    below: Vec<f32>,
}

impl Curve {
    /// Pieces that suffice without interference.
    const PIECES: usize = 512;

    fn new(reflectance: impl Fn(f32) -> f32) -> Self {
        Self::with_pieces(Self::PIECES, reflectance)
    }

    fn with_pieces(n: usize, reflectance: impl Fn(f32) -> f32) -> Self {
        let cosine = |i: usize| (i as f32 / n as f32).max(1e-6);
        Self {
            above: (0..=n).map(|i| reflectance(cosine(i))).collect(),
            below: (0..=n).map(|i| reflectance(-cosine(i))).collect(),
        }
    }

    fn at(&self, cos: f32) -> f32 {
        let cell = Cell::new(cos.abs().min(1.0) * (self.above.len() - 1) as f32);
        cell.lerp(if cos < 0.0 { &self.below } else { &self.above })
    }

    /// 1 − ∫ 2μ R(μ) dμ from above.
    fn hemispherical_transmittance(&self) -> f32 {
        let n = 4 * self.above.len();
        let transmitted = |i| {
            let mu = (i as f32 + 0.5) / n as f32;
            f64::from(2.0 * mu * (1.0 - self.at(mu)))
        };
        ((0..n).map(transmitted).sum::<f64>() / n as f64) as f32
    }
}

/// A place between two nodes.
#[derive(Clone, Copy, Debug)]
struct Cell {
    i: usize,
    t: f32,
}

impl Cell {
    /// From a position of at least 0.
    fn new(position: f32) -> Self {
        let i = position as usize;
        Self { i, t: position - i as f32 }
    }

    fn lerp(self, values: &[f32]) -> f32 {
        let a = values[self.i];
        if self.t > 0.0 { a + self.t * (values[self.i + 1] - a) } else { a }
    }

    /// The nodes with their shares, none of which is zero.
    fn shares(self) -> impl Iterator<Item = (usize, f32)> {
        [(self.i, 1.0 - self.t), (self.i + 1, self.t)].into_iter().filter(|&(_, share)| share > 0.0)
    }
}

/// m of one distribution and reflectance, from one side.
///
/// Smith's Λ depends on the azimuth by α(φ) = √(αx² cos²φ + αy² sin²φ) alone, and on the elevation by cosθ / α(φ) near the
/// horizon: in mixtures of α(φ) and its logarithm, of cosine and ratio, few nodes suffice, for the narrowest distributions as well.
#[derive(Clone, Debug, PartialEq)]
struct Sheet {
    low: f32,
    high: f32,
    n_cosines: usize,
    n_azimuths: usize,
    /// The cosine varies fastest.
    m: Vec<f32>,
    /// (1/π) ∫ m cosθ dω.
    mean: f32,
    lobe: Lobe,
}

/// A density of directions nearly in proportion to m cosθ, alike for every azimuth: piecewise constant over cos²θ.
#[derive(Clone, Debug, PartialEq)]
struct Lobe {
    /// The width whose coordinate delimits the pieces.
    alpha: f32,
    /// cos²θ between the pieces.
    edges: Vec<f32>,
    /// The probability below each edge.
    cumulative: Vec<f32>,
    /// Density over cos²θ within each piece.
    density: Vec<f32>,
}

impl Lobe {
    /// The share of directions that are cosine-distributed, whatever m is.
    const COSINE: f64 = 0.1;

    fn new(alpha: f32, n_cosines: usize, m: impl Fn(f32) -> f32) -> Self {
        let last = (n_cosines - 1) as f64;
        let edge = |i: usize| Sheet::cosine(i as f64 / last, f64::from(alpha)).clamp(0.0, 1.0).powi(2);
        let edges: Vec<f64> = (0..n_cosines).map(edge).collect();
        // m varies little within a piece.
        let middle = |a: f64, b: f64| f64::from(m((0.5 * (a + b)).sqrt() as f32));
        let masses: Vec<f64> = edges.windows(2).map(|e| (e[1] - e[0]) * middle(e[0], e[1])).collect();
        let total: f64 = masses.iter().sum();
        let mut lobe = Self {
            alpha,
            edges: Vec::new(),
            cumulative: vec![0.0],
            density: Vec::with_capacity(masses.len()),
        };
        let mut below = 0.0;
        for (e, mass) in edges.windows(2).zip(masses) {
            let size = e[1] - e[0];
            let share = if total > 0.0 { mass / total } else { size };
            let p = Self::COSINE * size + (1.0 - Self::COSINE) * share;
            below += p;
            lobe.cumulative.push(below as f32);
            lobe.density.push((p / size) as f32);
        }
        lobe.edges = edges.into_iter().map(|e| e as f32).collect();
        lobe
    }

    /// A direction in the upper half.
    fn sample(&self, u: Vec2) -> LocalDir {
        let last = self.density.len() - 1;
        let i = self.cumulative.partition_point(|&c| c <= u.x).saturating_sub(1).min(last);
        let t = ((u.x - self.cumulative[i]) / (self.cumulative[i + 1] - self.cumulative[i])).clamp(0.0, 1.0);
        let cos2 = self.edges[i] + t * (self.edges[i + 1] - self.edges[i]);
        let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
        let r = (1.0 - cos2).sqrt();
        LocalDir::new_unchecked(Vec3::new(r * cos_phi, r * sin_phi, cos2.sqrt()))
    }

    /// [sr⁻¹], from the cosine.
    fn pdf(&self, mu: f32) -> f32 {
        let last = self.density.len() - 1;
        let i = (Sheet::coordinate(mu, self.alpha) * self.density.len() as f32) as usize;
        self.density[i.min(last)] * mu * (1.0 / PI)
    }
}

impl Sheet {
    /// Half the nodes are spread over the cosine, half over its ratio to the width, or to what refraction at the horizon needs.
    fn coordinate(mu: f32, alpha: f32) -> f32 {
        let k = alpha.min(Self::FINE);
        0.5 * mu * (1.0 + (1.0 + k) / (mu + k))
    }

    /// The inverse of [`Sheet::coordinate`]: the root of μ² + μ (2k + 1 − 2s) − 2sk.
    fn cosine(s: f64, alpha: f64) -> f64 {
        let k = alpha.min(f64::from(Self::FINE));
        let half = k + 0.5 - s;
        let root = (half * half + 2.0 * s * k).sqrt();
        // The form that does not cancel.
        if half > 0.0 { 2.0 * s * k / (half + root) } else { root - half }
    }

    const FINE: f32 = 0.1;

    /// Half the nodes are spread over α(φ), half over its logarithm.
    fn azimuth(alpha: f32, low: f32, high: f32) -> f32 {
        0.5 * ((alpha - low) / (high - low) + (alpha / low).ln() / (high / low).ln())
    }

    /// From the values at [`Sheet::nodes`].
    fn new(d: &Microfacets, resolution: Resolution, m: Vec<f32>) -> Self {
        let [x, y] = d.alpha();
        let Resolution { n_cosines, n_azimuths, .. } = resolution;
        let (low, high) = (x.min(y), x.max(y));
        let alpha = (low * high).sqrt();
        let lobe = Lobe { alpha, edges: Vec::new(), cumulative: Vec::new(), density: Vec::new() };
        let mut sheet = Self { low, high, n_cosines, n_azimuths, m, mean: 0.0, lobe };
        sheet.mean = sheet.integral();
        sheet.lobe = Lobe::new(alpha, n_cosines, |mu| sheet.at(mu, alpha));
        sheet
    }

    /// The directions, from above, at which a sheet wants values.
    fn nodes(d: &Microfacets, resolution: Resolution) -> Vec<LocalDir> {
        let [x, y] = d.alpha();
        let (low, high) = (x.min(y), x.max(y));
        let Resolution { n_cosines, n_azimuths, .. } = resolution;
        let mut nodes = Vec::with_capacity(n_cosines * n_azimuths);
        for j in 0..n_azimuths {
            let v = j as f32 / (n_azimuths.max(2) - 1) as f32;
            let alpha = invert(low, high, v, |alpha| Self::azimuth(alpha, low, high));
            // The squared sine of the angle to the narrower axis.
            let sin2 = if high > low { (alpha * alpha - low * low) / (high * high - low * low) } else { 0.0 };
            let (sin, cos) = (sin2.clamp(0.0, 1.0).sqrt(), (1.0 - sin2).max(0.0).sqrt());
            let (along_x, along_y) = if x <= y { (cos, sin) } else { (sin, cos) };
            for i in 0..n_cosines {
                let s = i as f64 / (n_cosines - 1) as f64;
                // At the horizon itself the limit.
                let mu = (Self::cosine(s, f64::from(alpha)) as f32).clamp(1e-3 * alpha.min(1.0), 1.0);
                let r = (1.0 - mu * mu).sqrt();
                nodes.push(LocalDir::new_unchecked(Vec3::new(r * along_x, r * along_y, mu)));
            }
        }
        nodes
    }

    /// Simpson's rule over the pieces of the cosine, midpoints over the azimuth.
    fn integral(&self) -> f32 {
        let n_phi = if self.n_azimuths > 1 { 64 } else { 1 };
        let mut sum = 0.0;
        for j in 0..n_phi {
            let (sin, cos) = (FRAC_PI_2 * (f64::from(j) + 0.5) / f64::from(n_phi)).sin_cos();
            let alpha = (f64::from(self.low) * cos).hypot(f64::from(self.high) * sin);
            let node = |i: f64| Self::cosine(i / (self.n_cosines - 1) as f64, alpha);
            let integrand = |mu: f64| 2.0 * mu * f64::from(self.at(mu as f32, alpha as f32));
            for i in 0..self.n_cosines - 1 {
                let (a, b) = (node(i as f64), node((i + 1) as f64));
                let h = b - a;
                // Two halves: m is linear in the coordinate, which is nearly linear in the cosine within a piece.
                let at = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| integrand(a + t * h));
                sum += h / 12.0 * (at[0] + 4.0 * at[1] + 2.0 * at[2] + 4.0 * at[3] + at[4]);
            }
        }
        (sum / f64::from(n_phi)) as f32
    }

    fn at(&self, mu: f32, alpha: f32) -> f32 {
        let last = (self.n_cosines - 1) as f32;
        let cosine = Cell::new((Self::coordinate(mu, alpha) * last).clamp(0.0, last));
        if self.n_azimuths == 1 || self.low == self.high {
            return cosine.lerp(&self.m);
        }
        let last = (self.n_azimuths - 1) as f32;
        let azimuth = Cell::new((Self::azimuth(alpha, self.low, self.high) * last).clamp(0.0, last));
        azimuth.shares().map(|(j, share)| share * cosine.lerp(&self.m[j * self.n_cosines..])).sum()
    }
}

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

/// Which share of the loss of an interface is given back to the other side.
///
/// With f(i → o) = (1 − t) m m / (πM) on the side of the light and t m m / (πM) beyond, each with the M of the side that it
/// leaves to, nothing is lost whatever t is, and reflection is reciprocal. Transmission is so, f(i → o) / ηo² =
/// f(o → i) / ηi², exactly if t₁ η₁² M₁ = t₂ η₂² M₂: one degree of freedom remains. The hemispherical transmittances T of
/// the smooth interface obey T₁ η₁² = T₂ η₂², so that t₁ = T₁ M₂ / max(M₁, M₂) and its counterpart solve it, between
/// zero and one; where both sides lose alike, the loss is split as diffuse light is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    above: f32,
    below: f32,
}

impl Split {
    /// From the index below over above, the smooth interface's hemispherical transmittance from above, and the mean losses.
    pub fn new(eta: f32, transmittance: f32, mean_above: f32, mean_below: f32) -> Self {
        let largest = mean_above.max(mean_below).max(f32::MIN_POSITIVE);
        let eta2 = eta * eta;
        // From below it is transmittance / η², neither of which exceeds one but for interpolation.
        let transmittance = transmittance.clamp(0.0, eta2.min(1.0));
        Self {
            above: transmittance * (mean_below / largest),
            below: transmittance / eta2 * (mean_above / largest),
        }
    }

    /// t for light from a half.
    pub fn transmitted(&self, from: Half) -> f32 {
        match from {
            Half::Above => self.above,
            Half::Below => self.below,
        }
    }
}

/// What of the loss of a perfect mirror a metal gives back: F̄² Ē / (1 − F̄ (1 − Ē)) for all further reflections, each
/// with the hemispherical reflectance F̄, when a share Ē leaves after each (Hill 2018; Kulla & Conty 2017). One for F̄ = 1.
pub fn further_reflections(f_mean: f32, mean_loss: f32) -> f32 {
    let e = 1.0 - mean_loss;
    // Zero over zero for a mirror that nothing leaves.
    f_mean * f_mean * e / (1.0 - f_mean * mean_loss).max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp;

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
