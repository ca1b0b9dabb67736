//! Goniometer tables: f on a grid of incident and scattered angles, as text.
//!
//! ```text
//! # lines that begin with # are comments
//! theta_i [deg], phi_i [deg], theta_o [deg], phi_o [deg], f_450nm [1/sr], f_550nm [1/sr], f_650nm [1/sr]
//! 0, 0, 0, 0, 0.41, 0.43, 0.44
//! …
//! ```
//!
//! The first line that is neither empty nor a comment names the columns, with their units. Four angles come first: of the
//! direction that light arrives from, and of the one it is seen from; both point away from the sample, θ counts from its
//! normal, and θo above 90° is transmission. Then f follows (without cosine) at two wavelengths or more that cover
//! 420–680 nm, or as a single column `f [1/sr]` for a sample without colour. Every further line is one measurement.
//!
//! Each combination of the incident angles (θi, φi) with the scattered ones (θo, φo) must be there once, in any order. If
//! all φi are equal, the sample is isotropic and φo counts from φi; if φo − φi then stays within [0°, 180°], the other half
//! is its mirror image. With several φi, both azimuths go around the whole circle.
//!
//! Values are interpolated linearly in all angles and in wavelength, reflection apart from transmission; beyond the last
//! polar angle or wavelength, its value holds. Light arrives from the incident side, whichever side a path starts from:
//! what was measured is not made reciprocal. Light from below sees the sample as light from above does.
//!
//! Directions are drawn in proportion to f cosθ, averaged over wavelengths and bilinear on a fine grid of (θo, φo), for
//! each node of the incident angles; between those, densities are interpolated. A tenth follows the cosine alone, so that
//! nothing is missed where a measurement is zero.

use super::axis::{Axis, Closure};
use super::csv::{Row, Text};
use super::error::MeasuredError;
use super::warp::{Blend, Grid, Knot, Warp};
use crate::bsdf::contract::{BsdfSample, Lobe, Lobes, Mode, Side};
use crate::math::{LocalDir, Vec2, Vec3, warp::spherical_direction};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PdfSolidAngle, PerSteradian};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Share of the samples that follow the cosine.
const COSINE_SHARE: f64 = 0.1;

/// The widest step between azimuths that is interpolated [rad].
const WIDEST_GAP: f32 = 0.51 * PI;

/// A measurement on a grid of angles.
#[derive(Clone, Debug)]
pub struct GoniometerTable {
    theta_i: Axis,
    phi_i: Axis,
    isotropic: bool,
    /// θo up to a right angle; may be absent.
    reflected: Option<Axis>,
    /// θo beyond it; may be absent.
    transmitted: Option<Axis>,
    phi_o: Axis,
    wavelengths: Vec<f32>,
    /// f [sr⁻¹] by θi, φi, θo, φo, wavelength; the last fastest.
    values: Vec<f32>,
    /// For each incident node, the density of drawn directions over θo (x) and φo (y).
    density: Warp,
}

/// Angles of a direction [rad].
#[derive(Clone, Copy)]
struct Angles {
    theta: f32,
    phi: f32,
}

impl Angles {
    /// Those of `w` seen from the side of `known`, by point reflection.
    fn of(w: LocalDir, known: LocalDir) -> Self {
        let w: Vec3 = *w * known.z.signum();
        Self { theta: w.truncate().length().atan2(w.z), phi: w.y.atan2(w.x) }
    }
}

impl GoniometerTable {
    /// Reads a table from its text.
    ///
    /// # Errors
    /// With line and column where the text is wrong; with the angles where a measurement is missing or there twice.
    pub fn parse(bytes: &[u8]) -> Result<Self, MeasuredError> {
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let line = bytes[..e.valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
            MeasuredError::Text { line, column: 1, message: "the text is not UTF-8".to_owned() }
        })?;
        let text = Text::parse(text)?;
        let nodes: [Vec<f32>; 4] = std::array::from_fn(|i| distinct(&text.rows, i));
        let values = grid(&text, &nodes)?;
        if values.iter().all(|&v| v == 0.0) {
            return Err(MeasuredError::Black);
        }
        let radians = |nodes: &[f32]| nodes.iter().map(|a| a.to_radians()).collect::<Vec<_>>();
        let [theta_i, phi_i, theta_o, phi_o] = &nodes;
        let isotropic = phi_i.len() == 1;
        let (below, above): (Vec<f32>, Vec<f32>) = theta_o.iter().partition(|&&t| t <= 90.0);
        let polar = |nodes: Vec<f32>| (!nodes.is_empty()).then(|| Axis::held(radians(&nodes)));
        let turned = if isotropic { phi_i[0] } else { 0.0 };
        let phi_o: Vec<f32> = phi_o.iter().map(|p| p - turned).collect();
        let mut table = Self {
            theta_i: Axis::held(radians(theta_i)),
            phi_i: Axis::azimuths(radians(phi_i), false),
            isotropic,
            reflected: polar(below),
            transmitted: polar(above),
            phi_o: Axis::azimuths(radians(&phi_o), isotropic),
            wavelengths: text.wavelengths,
            values,
            density: Warp::default(),
        };
        table.check_azimuths()?;
        table.density = table.distribution()?;
        Ok(table)
    }

    fn check_azimuths(&self) -> Result<(), MeasuredError> {
        for (name, axis) in [("phi_i", &self.phi_i), ("phi_o", &self.phi_o)] {
            let gap = axis.widest_gap();
            if axis.closure() == Closure::Circle && axis.len() > 1 && gap > WIDEST_GAP {
                let gap = gap.to_degrees().round();
                return Err(MeasuredError::Grid(format!("{name} leaves a gap of {gap}° in its circle")));
            }
        }
        Ok(())
    }

    /// The densities that directions are drawn with.
    fn distribution(&self) -> Result<Warp, MeasuredError> {
        // About two patches a node, so that lobes keep their width; one border is the horizon where both sides are there.
        let side = |axis: &Option<Axis>| axis.as_ref().map_or(0, Axis::len);
        let sides = [&self.reflected, &self.transmitted].into_iter().flatten().count();
        let patches = (2 * side(&self.reflected).max(side(&self.transmitted))).clamp(8, 90) * sides;
        let images = if self.phi_o.closure() == Closure::Mirrored { 4 } else { 2 };
        let grid = Grid { nx: patches + 1, ny: (images * self.phi_o.len()).clamp(8, 72) + 1 };
        let slices = self.theta_i.len() * self.phi_i.len();
        let mut values = Vec::with_capacity(slices * grid.len());
        let (mut power, mut cosine) = (Vec::new(), Vec::new());
        for node in 0..slices {
            power.clear();
            cosine.clear();
            for i in 0..grid.len() {
                let at = Vec2::new(
                    (i % grid.nx) as f32 / (grid.nx - 1) as f32,
                    (i / grid.nx) as f32 / (grid.ny - 1) as f32,
                );
                let Angles { theta, phi } = self.angles_at(at);
                // sin π is not zero in floats, and may be negative.
                let area = f64::from(theta.cos().abs() * theta.sin().max(0.0));
                let spectrum = |row: usize| self.spectrum(row).iter().map(|&v| f64::from(v)).sum::<f64>();
                let f: f64 = self.rows(node, theta, phi).map(|(row, w)| f64::from(w) * spectrum(row)).sum();
                power.push(f * area);
                cosine.push(area);
            }
            let (total_power, total_cosine) = (power.iter().sum::<f64>(), cosine.iter().sum::<f64>());
            let share = if total_power > 0.0 { COSINE_SHARE } else { 1.0 };
            let scale = (1.0 - share) / total_power.max(f64::MIN_POSITIVE);
            let pairs = power.iter().zip(&cosine);
            values.extend(pairs.map(|(p, c)| (p * scale + share * c / total_cosine) as f32));
        }
        Warp::new(grid, values).map_err(|_| MeasuredError::Black)
    }

    /// First and last θo of the sides that were measured.
    fn span(&self) -> [f32; 2] {
        let first = if self.reflected.is_some() { 0.0 } else { FRAC_PI_2 };
        let last = if self.transmitted.is_some() { PI } else { FRAC_PI_2 };
        [first, last]
    }

    /// The angles of a point of the square of densities, as the table counts them.
    fn angles_at(&self, p: Vec2) -> Angles {
        let [first, last] = self.span();
        Angles { theta: first + p.x * (last - first), phi: p.y * TAU }
    }

    /// The inverse of [`GoniometerTable::angles_at`].
    fn point_at(&self, angles: Angles) -> Vec2 {
        let [first, last] = self.span();
        Vec2::new((angles.theta - first) / (last - first), (angles.phi / TAU).rem_euclid(1.0))
    }

    /// Density per solid angle of a density on the square at θo: dω = sinθ dθ dφ.
    fn per_solid_angle(&self, density: f32, theta: f32) -> PdfSolidAngle {
        let [first, last] = self.span();
        // At the poles, the density vanishes with the sine.
        PdfSolidAngle(density / (theta.sin().max(1e-6) * (last - first) * TAU))
    }

    /// The table's wavelengths [nm]; none where it has no colour.
    pub(super) fn wavelengths(&self) -> &[f32] {
        &self.wavelengths
    }

    /// Places of `lambda` [nm] among the table's wavelengths, whose ends are held.
    pub(super) fn knots(&self, lambda: &[f32; LANES]) -> [Knot; LANES] {
        lambda.map(|l| Knot::locate(&self.wavelengths, l))
    }

    /// Which sides were measured.
    pub(super) fn lobes(&self) -> Lobes {
        Lobes { reflection: self.reflected.is_some(), transmission: self.transmitted.is_some() }
    }

    /// f [sr⁻¹]: light arrives from `wi` where radiance is transported, from `wo` where power is.
    pub(super) fn eval(
        &self,
        wo: LocalDir,
        wi: LocalDir,
        mode: Mode,
        knots: &[Knot; LANES],
    ) -> Sampled<PerSteradian> {
        let (light, seen) = match mode {
            Mode::Radiance => (wi, wo),
            Mode::Importance => (wo, wi),
        };
        if light.z == 0.0 || seen.z == 0.0 {
            return Sampled::ZERO;
        }
        let (light, seen) = (Angles::of(light, light), Angles::of(seen, light));
        let phi = self.azimuth(light, seen);
        let mut f = Sampled::ZERO;
        for (node, outer) in self.incident(light) {
            for (row, inner) in self.rows(node, seen.theta, phi) {
                let spectrum = self.spectrum(row);
                let last = spectrum.len() - 1;
                f += Sampled::from_fn(|lane| {
                    let Knot { index, share } = knots[lane];
                    let i = index as usize;
                    let (v0, v1) = (spectrum[i], spectrum[(i + 1).min(last)]);
                    outer * inner * (v0 + share * (v1 - v0))
                });
            }
        }
        f
    }

    /// Density of [`GoniometerTable::sample`].
    pub(super) fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if wo.z == 0.0 || wi.z == 0.0 {
            return PdfSolidAngle(0.0);
        }
        let (known, other) = (Angles::of(wo, wo), Angles::of(wi, wo));
        if self.side(other.theta).is_none() {
            return PdfSolidAngle(0.0);
        }
        let p = self.point_at(Angles { phi: self.azimuth(known, other), ..other });
        self.per_solid_angle(self.density.density(p, &Blend::of(self.incident(known))), other.theta)
    }

    /// A direction drawn as if `wo` were the incident side, on either side of the surface.
    pub(super) fn sample(
        &self,
        wo: LocalDir,
        u: Vec2,
        mode: Mode,
        knots: &[Knot; LANES],
    ) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let known = Angles::of(wo, wo);
        let drawn = self.density.sample(u, &Blend::of(self.incident(known)));
        let Angles { theta, phi } = self.angles_at(drawn.p);
        let phi = if self.isotropic { phi + known.phi } else { phi };
        let wi = LocalDir::new(spherical_direction(theta, phi) * wo.z.signum())?;
        let pdf = self.per_solid_angle(drawn.density, theta);
        if wi.z == 0.0 || !(pdf.0 > 0.0) {
            return None;
        }
        let side = if wo.same_hemisphere(wi) { Side::Reflection } else { Side::Transmission };
        Some(BsdfSample {
            wi,
            weight: self.eval(wo, wi, mode, knots).weight(wi.abs_cos_theta(), pdf),
            density: Density::SolidAngle(pdf),
            side,
            lobe: Lobe::Glossy,
            eta: 1.0,
        })
    }

    /// Azimuth of a direction as the table counts it.
    fn azimuth(&self, from: Angles, to: Angles) -> f32 {
        if self.isotropic { to.phi - from.phi } else { to.phi }
    }

    /// The axis of θo on the side of `theta`, and the number of its first node.
    fn side(&self, theta: f32) -> Option<(&Axis, usize)> {
        if theta <= FRAC_PI_2 {
            Some((self.reflected.as_ref()?, 0))
        } else {
            Some((self.transmitted.as_ref()?, self.reflected.as_ref().map_or(0, Axis::len)))
        }
    }

    /// The incident nodes around a direction with their weights, which sum to one.
    fn incident(&self, w: Angles) -> impl Iterator<Item = (usize, f32)> + use<> {
        let (theta, phi) = (self.theta_i.locate(w.theta), self.phi_i.locate(w.phi));
        let count = self.phi_i.len();
        theta
            .parts()
            .into_iter()
            .flat_map(move |(a, wa)| phi.parts().map(move |(b, wb)| (a * count + b, wa * wb)))
            .filter(|n| n.1 > 0.0)
    }

    /// The measurements around a scattered direction at an incident node, with their weights; none on a side that was not
    /// measured.
    fn rows(&self, node: usize, theta: f32, phi: f32) -> impl Iterator<Item = (usize, f32)> + use<> {
        let nodes = [&self.reflected, &self.transmitted].into_iter().flatten().map(Axis::len);
        let (n_theta, n_phi) = (nodes.sum::<usize>(), self.phi_o.len());
        let phi = self.phi_o.locate(phi);
        let theta = self.side(theta).map(|(axis, first)| (axis.locate(theta), first));
        theta
            .into_iter()
            .flat_map(|(theta, first)| theta.parts().map(|(c, w)| (first + c, w)))
            .flat_map(move |(c, wc)| {
                phi.parts().map(move |(d, wd)| ((node * n_theta + c) * n_phi + d, wc * wd))
            })
            .filter(|r| r.1 > 0.0)
    }

    /// The values of one measurement.
    fn spectrum(&self, row: usize) -> &[f32] {
        let channels = self.wavelengths.len().max(1);
        &self.values[row * channels..][..channels]
    }
}

/// The distinct angles of a column, increasing [°].
fn distinct(rows: &[Row], column: usize) -> Vec<f32> {
    let mut values: Vec<f32> = rows.iter().map(|r| r.angles[column]).collect();
    values.sort_by(f32::total_cmp);
    values.dedup();
    values
}

/// The values in the order of the grid.
fn grid(text: &Text, nodes: &[Vec<f32>; 4]) -> Result<Vec<f32>, MeasuredError> {
    let mut order: Vec<usize> = (0..text.rows.len()).collect();
    let compare = |a: &[f32; 4], b: &[f32; 4]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    };
    order.sort_by(|&a, &b| compare(&text.rows[a].angles, &text.rows[b].angles));
    for pair in order.windows(2) {
        let [first, second] = [&text.rows[pair[0]], &text.rows[pair[1]]];
        if first.angles == second.angles {
            let message = format!("the angles are those of line {}", first.line);
            return Err(MeasuredError::Text { line: second.line, column: 1, message });
        }
    }
    let channels = text.channels();
    let mut values = Vec::with_capacity(text.values.len());
    let mut rows = order.iter();
    // Rows and combinations are both in order: the first that differ are a combination without row.
    for &theta_i in &nodes[0] {
        for &phi_i in &nodes[1] {
            for &theta_o in &nodes[2] {
                for &phi_o in &nodes[3] {
                    match rows.next() {
                        Some(&row) if text.rows[row].angles == [theta_i, phi_i, theta_o, phi_o] => {
                            values.extend(&text.values[row * channels..][..channels]);
                        }
                        _ => {
                            return Err(MeasuredError::Grid(format!(
                                "there is no row for theta_i {theta_i}°, phi_i {phi_i}°, theta_o {theta_o}°, \
                                 phi_o {phi_o}°"
                            )));
                        }
                    }
                }
            }
        }
    }
    Ok(values)
}
