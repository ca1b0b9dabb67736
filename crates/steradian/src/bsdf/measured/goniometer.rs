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
//! Directions are drawn, for each known direction among the nodes, from a constant density in the cell around each
//! (θo, φo), in proportion to f cosθ there; a tenth follows the cosine alone, so that nothing is missed between nodes.

use super::axis::{Axis, Between};
use super::csv::{Row, Text};
use super::error::MeasuredError;
use super::warp::Knot;
use crate::bsdf::contract::{BsdfSample, Lobe, Lobes, Mode, Side};
use crate::math::distribution::AliasTable;
use crate::math::float::ONE_MINUS_EPSILON;
use crate::math::{LocalDir, Vec2, Vec3};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PdfSolidAngle, PerSteradian};
use std::f32::consts::{FRAC_PI_2, PI};

/// Share of the samples that follow the cosine.
const COSINE_SHARE: f64 = 0.1;

/// The widest step between azimuths that is interpolated [rad].
const WIDEST_GAP: f32 = 0.51 * PI;

/// A measurement on a grid of angles.
#[derive(Clone, Debug)]
pub struct GoniometerTable {
    incident: [Axis; 2],
    isotropic: bool,
    /// θo up to a right angle; may be absent.
    reflected: Option<Axis>,
    /// θo beyond it; may be absent.
    transmitted: Option<Axis>,
    phi: Axis,
    wavelengths: Vec<f32>,
    /// f [sr⁻¹] by θi, φi, θo, φo, wavelength; the last fastest.
    values: Vec<f32>,
    /// For each incident node, a distribution over the cells (θo, φo).
    cells: Vec<AliasTable>,
    /// Solid angle of each cell [sr].
    solid_angle: Vec<f32>,
}

/// Angles of a direction [rad].
#[derive(Clone, Copy)]
struct Angles {
    theta: f32,
    phi: f32,
}

impl Angles {
    fn of(w: Vec3) -> Self {
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
        let wavelengths = text.wavelengths;
        let radians = |nodes: &[f32]| nodes.iter().map(|a| a.to_radians()).collect::<Vec<_>>();
        let [theta_i, phi_i, theta_o, phi_o] = &nodes;
        let isotropic = phi_i.len() == 1;
        let (below, above): (Vec<f32>, Vec<f32>) = theta_o.iter().partition(|&&t| t <= 90.0);
        let polar =
            |nodes: Vec<f32>, min, max| (!nodes.is_empty()).then(|| Axis::held(radians(&nodes), min, max));
        let from_incident: Vec<f32> =
            if isotropic { phi_o.iter().map(|p| p - phi_i[0]).collect() } else { phi_o.clone() };
        let mut table = Self {
            incident: [Axis::held(radians(theta_i), 0.0, FRAC_PI_2), Axis::azimuths(radians(phi_i), false)],
            isotropic,
            reflected: polar(below, 0.0, FRAC_PI_2),
            transmitted: polar(above, FRAC_PI_2, PI),
            phi: Axis::azimuths(radians(&from_incident), isotropic),
            wavelengths,
            values,
            cells: Vec::new(),
            solid_angle: Vec::new(),
        };
        table.check_azimuths()?;
        table.distribute()?;
        Ok(table)
    }

    fn check_azimuths(&self) -> Result<(), MeasuredError> {
        let named =
            [("phi_i", &self.incident[1], !self.isotropic), ("phi_o", &self.phi, self.phi.images() < 2.0)];
        for (name, axis, is_circle) in named {
            let gap = axis.widest_gap();
            if is_circle && axis.len() > 1 && gap > WIDEST_GAP {
                let gap = gap.to_degrees().round();
                return Err(MeasuredError::Grid(format!("{name} leaves a gap of {gap}° in its circle")));
            }
        }
        Ok(())
    }

    /// Builds the distributions over cells.
    fn distribute(&mut self) -> Result<(), MeasuredError> {
        let theta = self.theta_cells();
        let channels = self.channels();
        let mut cosine = Vec::new();
        for t in &theta {
            let (z0, z1) = (f64::from(t[0]).cos(), f64::from(t[1]).cos());
            for p in 0..self.phi.len() {
                let cell = self.phi.cell(p);
                let width = f64::from((cell.end - cell.start) * self.phi.images());
                self.solid_angle.push((width * (z0 - z1)) as f32);
                cosine.push(width * 0.5 * (z0 * z0 - z1 * z1).abs());
            }
        }
        let total_cosine: f64 = cosine.iter().sum();
        for values in self.values.chunks_exact(cosine.len() * channels) {
            let mean =
                |i: usize| values[i * channels..][..channels].iter().map(|&v| f64::from(v)).sum::<f64>();
            let power: Vec<f64> = cosine.iter().enumerate().map(|(i, c)| mean(i) * c).collect();
            let total: f64 = power.iter().sum();
            let share = if total > 0.0 { COSINE_SHARE } else { 1.0 };
            let weight = |(p, c): (&f64, &f64)| {
                let p = if total > 0.0 { p / total } else { 0.0 };
                ((1.0 - share) * p + share * c / total_cosine) as f32
            };
            let weights: Vec<f32> = power.iter().zip(&cosine).map(weight).collect();
            // Each side has some cosine; a single angle of 180° alone, say, fills its side.
            let table = AliasTable::new(&weights);
            self.cells.push(table.ok_or_else(|| MeasuredError::Grid("the cells are empty".to_owned()))?);
        }
        if self.values.iter().all(|&v| v == 0.0) {
            return Err(MeasuredError::Black);
        }
        Ok(())
    }

    /// Borders of the cells along θo: reflection, then transmission.
    fn theta_cells(&self) -> Vec<[f32; 2]> {
        let of = |axis: &Axis| {
            let cells = (0..axis.len()).map(|i| axis.cell(i));
            cells.map(|c| [c.start, c.end]).collect::<Vec<_>>()
        };
        let sides = [&self.reflected, &self.transmitted];
        sides.into_iter().flatten().flat_map(of).collect()
    }

    fn channels(&self) -> usize {
        self.wavelengths.len().max(1)
    }

    fn n_theta(&self) -> usize {
        [&self.reflected, &self.transmitted].into_iter().flatten().map(Axis::len).sum()
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
        let flip = light.z.signum();
        let (light, seen) = (Angles::of(*light * flip), Angles::of(*seen * flip));
        let Some((theta, first)) = self.polar(seen.theta) else { return Sampled::ZERO };
        let incident = self.incident.each_ref();
        let [ti, pi] = [incident[0].locate(light.theta), incident[1].locate(light.phi)];
        let po = self.phi.locate(self.azimuth(light, seen));
        let (n_phi, channels) = (self.phi.len(), self.channels());
        let mut f = Sampled::ZERO;
        for (a, wa) in parts(ti) {
            for (b, wb) in parts(pi) {
                for (c, wc) in parts(theta) {
                    for (d, wd) in parts(po) {
                        let weight = wa * wb * wc * wd;
                        if weight == 0.0 {
                            continue;
                        }
                        let node = self.incident_node(a, b);
                        let row = (node * self.n_theta() + first + c) * n_phi + d;
                        let spectrum = &self.values[row * channels..][..channels];
                        f += Sampled::from_fn(|lane| {
                            let Knot { index, share } = knots[lane];
                            let i = index as usize;
                            let (v0, v1) = (spectrum[i], spectrum[(i + 1).min(channels - 1)]);
                            weight * (v0 + share * (v1 - v0))
                        });
                    }
                }
            }
        }
        f
    }

    /// Density of [`GoniometerTable::sample`].
    pub(super) fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if wo.z == 0.0 || wi.z == 0.0 {
            return PdfSolidAngle(0.0);
        }
        let flip = wo.z.signum();
        let (known, other) = (Angles::of(*wo * flip), Angles::of(*wi * flip));
        let axis = if other.theta <= FRAC_PI_2 { &self.reflected } else { &self.transmitted };
        let Some(axis) = axis else { return PdfSolidAngle(0.0) };
        let (_, first) = self.side(other.theta);
        let cell = (first + axis.cell_at(other.theta)) * self.phi.len()
            + self.phi.cell_at(self.azimuth(known, other));
        let probability: f32 =
            self.known_nodes(known).map(|(node, w)| w * self.cells[node].probability(cell)).sum();
        PdfSolidAngle(probability / self.solid_angle[cell])
    }

    /// A direction drawn from the cells of one of the nodes around the known direction.
    pub(super) fn sample(
        &self,
        wo: LocalDir,
        uc: f32,
        u: Vec2,
        mode: Mode,
        knots: &[Knot; LANES],
    ) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let flip = wo.z.signum();
        let known = Angles::of(*wo * flip);
        let mut left = uc;
        let mut chosen = None;
        for (node, weight) in self.known_nodes(known).filter(|n| n.1 > 0.0) {
            chosen = Some((node, (left / weight).min(ONE_MINUS_EPSILON)));
            if left < weight {
                break;
            }
            left -= weight;
        }
        let (node, uc) = chosen?;
        let drawn = self.cells[node].sample(u.x);
        let (i, j) = (drawn.index / self.phi.len(), drawn.index % self.phi.len());
        let (theta, phi) = (self.theta_cell(i)?, self.phi.cell(j));
        let z = theta[0].cos() + drawn.remapped * (theta[1].cos() - theta[0].cos());
        let mut phi = phi.start + u.y * (phi.end - phi.start);
        if self.phi.images() > 1.0 && uc < 0.5 {
            phi = -phi;
        }
        if self.isotropic {
            phi += known.phi;
        }
        let (sin, cos) = phi.sin_cos();
        let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let wi = LocalDir::new(Vec3::new(r * cos, r * sin, z) * flip)?;
        let pdf = self.pdf(wo, wi);
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
    fn side(&self, theta: f32) -> (Option<&Axis>, usize) {
        if theta <= FRAC_PI_2 {
            (self.reflected.as_ref(), 0)
        } else {
            (self.transmitted.as_ref(), self.reflected.as_ref().map_or(0, Axis::len))
        }
    }

    fn polar(&self, theta: f32) -> Option<(Between, usize)> {
        let (axis, first) = self.side(theta);
        Some((axis?.locate(theta), first))
    }

    fn theta_cell(&self, i: usize) -> Option<[f32; 2]> {
        let n = self.reflected.as_ref().map_or(0, Axis::len);
        let cell =
            if i < n { self.reflected.as_ref()?.cell(i) } else { self.transmitted.as_ref()?.cell(i - n) };
        Some([cell.start, cell.end])
    }

    fn incident_node(&self, theta: usize, phi: usize) -> usize {
        theta * self.incident[1].len() + phi
    }

    /// The incident nodes around a direction with their weights, which sum to one.
    fn known_nodes(&self, known: Angles) -> impl Iterator<Item = (usize, f32)> + '_ {
        let [theta, phi] = [self.incident[0].locate(known.theta), self.incident[1].locate(known.phi)];
        parts(theta)
            .into_iter()
            .flat_map(move |(a, wa)| parts(phi).map(move |(b, wb)| (self.incident_node(a, b), wa * wb)))
    }
}

fn parts(b: Between) -> [(usize, f32); 2] {
    [(b.nodes[0], 1.0 - b.share), (b.nodes[1], b.share)]
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
