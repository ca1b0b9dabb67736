//! `.bsdf` files in the adaptive parameterisation (Dupuy & Jakob 2018), as of the RGL material database.
//!
//! Facet normals m have coordinates u = (√(2θ/π), φ/2π + ½) on the unit square; in isotropic files φ counts from the
//! azimuth of the known side. For each known direction, `vndf` maps the square to itself by the density of visible
//! normals in u; `luminance` is a density on the square before that map, and `spectra` live there too: the power
//! f cosθ itself or, where `jacobian` is set, f cosθ · 4σ/D with the facets' density D (`ndf`) and projected area σ
//! (`sigma`). Values between nodes are linear in angle, wavelength and on the square.
//!
//! As elsewhere, the known side (`theta_i`, `phi_i` of the file) is `wo`; Mitsuba and pbrt-v4 do the same. Data are
//! nearly reciprocal only: which side is taken as known shows where they are not.

use super::error::{MeasuredError, check_coverage};
use super::tensor::{Floats, TensorError, TensorFile};
use super::upsampling::RgbUpsampling;
use super::warp::{Bilinear, Blend, Grid, Knot, Warp};
use crate::bsdf::contract::{BsdfSample, Lobe, Side};
use crate::math::float::safe_asin;
use crate::math::{LocalDir, Vec2, Vec3, warp::spherical_direction};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// A measurement in the adaptive parameterisation.
#[derive(Clone, Debug)]
pub struct RglTable {
    theta: Vec<f32>,
    phi: Vec<f32>,
    symmetry: Symmetry,
    ndf: Bilinear,
    sigma: Bilinear,
    vndf: Warp,
    luminance: Warp,
    /// Grid of `spectra` on the square.
    grid: Grid,
    spectra: Vec<f32>,
    channels: Channels,
    /// Whether `spectra` are to be multiplied by D/(4σ).
    jacobian: bool,
}

/// What the third axis of `spectra` counts.
#[derive(Clone, Debug)]
enum Channels {
    /// Wavelengths [nm], increasing.
    Wavelengths(Vec<f32>),
    /// Red, green and blue.
    Rgb(Box<RgbUpsampling>),
}

/// How much of the circle of azimuths is in the file; the rest follows by symmetry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    /// Only the difference of azimuths counts.
    Isotropic,
    /// All of it.
    None,
    /// φ ∈ [−π, 0]: unchanged by half a turn.
    HalfTurn,
    /// φ ∈ [−π, −π/2]: unchanged by mirroring x and y.
    Quadrants,
}

/// A known direction, brought into the measured part of the circle.
struct Known {
    w: Vec3,
    theta: f32,
    phi: f32,
    blend: Blend,
    /// Signs by which x and y were multiplied.
    signs: Vec2,
}

/// Where the facet that mirrors one direction to another lies in the tables.
struct Facet {
    /// Coordinates u of the normal.
    u: Vec2,
    /// Point of the square before the map of visible normals.
    s: Vec2,
    /// Density of the mirrored direction [sr⁻¹].
    pdf: f32,
}

impl RglTable {
    /// Reads a file.
    ///
    /// # Errors
    /// When a field is missing or of another type or shape, when a value is not finite or is negative beyond noise (a
    /// hundredth of the largest; less is read as zero), or when wavelengths cover too little of the visible range.
    pub fn parse(bytes: &[u8]) -> Result<Self, MeasuredError> {
        let file = TensorFile::parse(bytes)?;
        let theta = increasing(&file, "theta_i", [-1e-3, FRAC_PI_2 + 1e-3])?;
        let phi = increasing(&file, "phi_i", [-PI - 1e-3, PI + 1e-3])?;
        let jacobian = file.byte("jacobian")? != 0;
        let ndf = table(&file, "ndf")?;
        let sigma = table(&file, "sigma")?;
        let slices = [Some(phi.len()), Some(theta.len())];
        let vndf = warp(&file, "vndf", slices)?;
        let luminance = positive(&file, "luminance", &[slices[0], slices[1], None, None])?;
        let grid = grid("luminance", &luminance.shape)?;
        let on_square = [Some(grid.ny), Some(grid.nx)];
        let luminance = normalised("luminance", grid, luminance.values)?;
        let (channels, name, count) = if file.contains("spectra") || !file.contains("rgb") {
            let lambda = increasing(&file, "wavelengths", [1.0, 1e5])?;
            check_coverage(&lambda)?;
            let count = lambda.len();
            (Channels::Wavelengths(lambda), "spectra", count)
        } else {
            (Channels::Rgb(Box::new(RgbUpsampling::new())), "rgb", 3)
        };
        let shape = [slices[0], slices[1], Some(count), on_square[0], on_square[1]];
        let spectra = positive(&file, name, &shape)?.values;
        let symmetry = symmetry(&phi)?;
        Ok(Self { theta, phi, symmetry, ndf, sigma, vndf, luminance, grid, spectra, channels, jacobian })
    }

    /// The file's wavelengths [nm]; none where it has red, green and blue.
    pub(super) fn wavelengths(&self) -> &[f32] {
        match &self.channels {
            Channels::Wavelengths(nodes) => nodes,
            Channels::Rgb(_) => &[],
        }
    }

    /// Places of `lambda` [nm] among the file's wavelengths, whose ends are held.
    pub(super) fn knots(&self, lambda: &[f32; LANES]) -> [Knot; LANES] {
        match &self.channels {
            Channels::Wavelengths(nodes) => lambda.map(|l| Knot::locate(nodes, l)),
            Channels::Rgb(_) => [Knot::default(); LANES],
        }
    }

    /// f [sr⁻¹]; zero across the surface.
    pub(super) fn eval(
        &self,
        wo: LocalDir,
        wi: LocalDir,
        lambda: &[f32; LANES],
        knots: &[Knot; LANES],
    ) -> Sampled<PerSteradian> {
        let Some((wo, wi)) = upwards(wo, wi) else { return Sampled::ZERO };
        let known = self.known(wo);
        let Some(facet) = self.facet(&known, wi) else { return Sampled::ZERO };
        // The file knows f cosθ only, which it does not bring to zero at the horizon exactly.
        self.power(&known, &facet, lambda, knots) / wi.z.max(1e-6)
    }

    /// Density of [`RglTable::sample`].
    pub(super) fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        let Some((wo, wi)) = upwards(wo, wi) else { return PdfSolidAngle(0.0) };
        PdfSolidAngle(self.facet(&self.known(wo), wi).map_or(0.0, |facet| facet.pdf))
    }

    /// A direction mirrored at a facet that is drawn by `luminance` and `vndf`.
    pub(super) fn sample(
        &self,
        wo: LocalDir,
        u: Vec2,
        lambda: &[f32; LANES],
        knots: &[Knot; LANES],
    ) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let flip = wo.z.signum();
        let known = self.known(*wo * flip);
        let bright = self.luminance.sample(u, &known.blend);
        let normal = self.vndf.sample(bright.p, &known.blend);
        let theta = normal.p.x * normal.p.x * FRAC_PI_2;
        let mut phi = (2.0 * normal.p.y - 1.0) * PI;
        if self.symmetry == Symmetry::Isotropic {
            phi += known.phi;
        }
        let m = spherical_direction(theta, phi);
        let cos = known.w.dot(m);
        let mirrored = m * (2.0 * cos) - known.w;
        let pdf = bright.density * normal.density / solid_angle_ratio(normal.p.x, theta.sin(), cos);
        if !(mirrored.z > 0.0 && cos > 0.0 && pdf > 0.0) {
            return None;
        }
        let facet = Facet { u: normal.p, s: bright.p, pdf };
        let weight = self.power(&known, &facet, lambda, knots) / pdf;
        let wi = LocalDir::new(Vec3::from((mirrored.truncate() * known.signs, mirrored.z)) * flip)?;
        Some(BsdfSample {
            wi,
            weight: weight.cast::<Unitless>(),
            density: Density::SolidAngle(PdfSolidAngle(pdf)),
            side: Side::Reflection,
            lobe: Lobe::Glossy,
            eta: 1.0,
        })
    }

    /// Folds an upper direction by the file's symmetry and finds it among the nodes.
    fn known(&self, w: Vec3) -> Known {
        // Towards −: the file holds azimuths from −π on.
        let toward = |c: f32| if c >= 0.0 { -1.0 } else { 1.0 };
        let signs = match self.symmetry {
            Symmetry::Isotropic | Symmetry::None => Vec2::ONE,
            Symmetry::HalfTurn => Vec2::splat(toward(w.y)),
            Symmetry::Quadrants => Vec2::new(toward(w.x), toward(w.y)),
        };
        let w = Vec3::from((w.truncate() * signs, w.z));
        let (theta, phi) = (elevation(w), w.y.atan2(w.x));
        let blend =
            Blend::new(Knot::locate(&self.phi, phi), Knot::locate(&self.theta, theta), self.theta.len());
        Known { w, theta, phi, blend, signs }
    }

    /// The facet that mirrors the known direction to the upper direction `wi`.
    fn facet(&self, known: &Known, wi: Vec3) -> Option<Facet> {
        let wi = Vec3::from((wi.truncate() * known.signs, wi.z));
        let sum = known.w + wi;
        let m = LocalDir::new(sum)?;
        let mut phi = m.y.atan2(m.x);
        if self.symmetry == Symmetry::Isotropic {
            phi -= known.phi;
        }
        let v = phi / TAU + 0.5;
        let u = Vec2::new((elevation(*m) / FRAC_PI_2).sqrt(), v - v.floor());
        let seen = self.vndf.invert(u, &known.blend);
        let bright = self.luminance.density(seen.p, &known.blend);
        // wo·m is half of the sum's length; the product itself may be negative by rounding where both graze.
        let ratio = solid_angle_ratio(u.x, m.truncate().length(), 0.5 * sum.length());
        Some(Facet { u, s: seen.p, pdf: bright * seen.density / ratio })
    }

    /// f cosθi [sr⁻¹].
    fn power(
        &self,
        known: &Known,
        facet: &Facet,
        lambda: &[f32; LANES],
        knots: &[Knot; LANES],
    ) -> Sampled<PerSteradian> {
        let patch = self.grid.locate(facet.s);
        let n = self.grid.len();
        let at = |slice: usize| self.grid.interpolate(&self.spectra[slice * n..][..n], &patch);
        let spectrum = match &self.channels {
            Channels::Wavelengths(nodes) => Sampled::from_fn(|lane| {
                let Knot { index, share } = knots[lane];
                let value = |(slice, weight): (usize, f32)| {
                    let first = slice * nodes.len() + index as usize;
                    weight * (at(first) * (1.0 - share) + at(first + 1) * share)
                };
                known.blend.parts().map(value).sum()
            }),
            Channels::Rgb(upsampling) => {
                let channel = |c| known.blend.parts().map(|(slice, w)| w * at(slice * 3 + c)).sum();
                upsampling.at([channel(0), channel(1), channel(2)], lambda)
            }
        };
        if !self.jacobian {
            return spectrum;
        }
        let direction = Vec2::new((known.theta / FRAC_PI_2).sqrt(), known.phi / TAU + 0.5);
        spectrum * (self.ndf.at(facet.u) / (4.0 * self.sigma.at(direction).max(1e-9)))
    }
}

/// Both directions on the upper side, point-reflected where they lie below (as pbrt-v4 does); `None` where they lie on
/// different sides.
fn upwards(wo: LocalDir, wi: LocalDir) -> Option<(Vec3, Vec3)> {
    let flip = wo.z.signum();
    wo.same_hemisphere(wi).then_some((*wo * flip, *wi * flip))
}

/// Angle to +z [rad], accurate near it.
fn elevation(w: Vec3) -> f32 {
    2.0 * safe_asin(0.5 * (w - Vec3::Z).length())
}

/// Solid angle of mirrored directions over area on the square: dωi = 4 (wo·m) dωm with dωm = sinθ dθ dφ, θ = ½π x²,
/// φ = 2π y.
fn solid_angle_ratio(x: f32, sin_theta: f32, cos: f32) -> f32 {
    // The floor keeps the pole finite: there the density of normals vanishes as fast.
    (2.0 * PI * PI * x * sin_theta).max(1e-6) * 4.0 * cos
}

fn symmetry(phi: &[f32]) -> Result<Symmetry, MeasuredError> {
    // Two azimuths are what isotropic files with a redundant one have.
    let ([first, .., last], true) = (phi, phi.len() > 2) else { return Ok(Symmetry::Isotropic) };
    let refuse = |what: String| Err(MeasuredError::Field { field: "phi_i", what });
    if (first + PI).abs() > 0.02 {
        return refuse(format!("a first azimuth of {first} rad, expected −π"));
    }
    match (TAU / (last - first)).round() as u32 {
        1 => Ok(Symmetry::None),
        2 => Ok(Symmetry::HalfTurn),
        4 => Ok(Symmetry::Quadrants),
        _ => refuse(format!("azimuths up to {last} rad, which are no whole, half or quarter circle from −π")),
    }
}

/// A list of nodes.
fn increasing(file: &TensorFile<'_>, name: &'static str, range: [f32; 2]) -> Result<Vec<f32>, MeasuredError> {
    let values = file.floats(name, &[None])?.values;
    let refuse = |what| Err(MeasuredError::Field { field: name, what });
    if values.is_empty() {
        return refuse("no values".to_owned());
    }
    if let Some(v) = values.iter().find(|v| !(range[0]..=range[1]).contains(*v)) {
        return refuse(format!("a value of {v}, which is not in [{}, {}]", range[0], range[1]));
    }
    if values.windows(2).any(|w| w[0] >= w[1]) {
        return refuse("values that do not increase".to_owned());
    }
    Ok(values)
}

/// No density or spectrum comes near; products of such values stay finite.
const LARGEST: f32 = 1e9;

/// An array of finite values that are not negative, but for noise: what falls short of zero by up to a hundredth of the
/// largest value becomes zero.
fn positive(
    file: &TensorFile<'_>,
    name: &'static str,
    shape: &[Option<usize>],
) -> Result<Floats, MeasuredError> {
    let mut floats = file.floats(name, shape)?;
    let largest = floats.values.iter().fold(0.0_f32, |a, &b| a.max(b));
    if let Some(v) = floats.values.iter().find(|v| !(-0.01 * largest..=LARGEST).contains(*v)) {
        return Err(MeasuredError::Field { field: name, what: format!("a value of {v}") });
    }
    floats.values.iter_mut().for_each(|v| *v = v.max(0.0));
    Ok(floats)
}

fn grid(name: &'static str, shape: &[usize]) -> Result<Grid, MeasuredError> {
    match *shape {
        [.., ny, nx] if nx >= 2 && ny >= 2 => Ok(Grid { nx, ny }),
        _ => {
            let found = shape.iter().map(usize::to_string).collect::<Vec<_>>().join(" × ");
            Err(TensorError::Shape { name, found, expected: "at least 2 × 2 at its end".to_owned() }.into())
        }
    }
}

fn table(file: &TensorFile<'_>, name: &'static str) -> Result<Bilinear, MeasuredError> {
    let Floats { shape, values } = positive(file, name, &[None, None])?;
    Ok(Bilinear { grid: grid(name, &shape)?, values })
}

fn warp(
    file: &TensorFile<'_>,
    name: &'static str,
    slices: [Option<usize>; 2],
) -> Result<Warp, MeasuredError> {
    let Floats { shape, values } = positive(file, name, &[slices[0], slices[1], None, None])?;
    normalised(name, grid(name, &shape)?, values)
}

fn normalised(name: &'static str, grid: Grid, values: Vec<f32>) -> Result<Warp, MeasuredError> {
    Warp::new(grid, values).map_err(|slice| MeasuredError::Field {
        field: name,
        what: format!("a slice that is zero everywhere, number {slice}"),
    })
}
