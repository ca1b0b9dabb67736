//! MERL `.binary` files: isotropic reflection in red, green and blue (Matusik et al. 2003).
//!
//! ```text
//! i32 × 3: number of θh, of θd, of φd     f64 × 3 n: all red values, all green, all blue; φd fastest, then θd
//! ```
//!
//! Rusinkiewicz 1998: h is halfway between the two directions, d is one of them seen from h, with φd counted from the
//! plane of h and the normal. θh lies at (i + ½)² steps of π/2n², θd and φd ∈ [0, π) are uniform. f is the stored value
//! times 1/1500, 1.15/1500 and 1.66/1500. Exchanging the two directions adds π to φd, which the format does not tell
//! from φd: it is reciprocal by construction. A negative value says that nothing was measured.
//!
//! Values are interpolated linearly between the centres of cells. The triple is taken as linear sRGB.

use super::error::MeasuredError;
use super::upsampling::RgbUpsampling;
use super::warp::{Knot, ramp_inverse};
use crate::bsdf::contract::{BsdfSample, Lobe, Side};
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PdfSolidAngle, PerSteradian};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI, TAU};

/// What a stored value is multiplied by.
const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
const HEADER: usize = 12;
/// The largest extent; the published files have 90 × 90 × 180.
const MAX_EXTENT: i32 = 1024;

/// Numbers of θh, θd and φd.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extents {
    /// Half angles.
    pub theta_h: usize,
    /// Difference angles.
    pub theta_d: usize,
    /// Azimuths of the difference.
    pub phi_d: usize,
}

impl Extents {
    /// Those of the published files.
    pub const MERL: Self = Self { theta_h: 90, theta_d: 90, phi_d: 180 };

    fn len(self) -> usize {
        self.theta_h * self.theta_d * self.phi_d
    }

    /// The extents at the start of a file that account for all its bytes.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let head: &[u8; HEADER] = bytes.first_chunk()?;
        let (numbers, _) = head.as_chunks::<4>();
        let mut extents = [0_usize; 3];
        for (extent, b) in extents.iter_mut().zip(numbers) {
            let n = i32::from_le_bytes(*b);
            if !(2..=MAX_EXTENT).contains(&n) {
                return None;
            }
            *extent = n as usize;
        }
        let [theta_h, theta_d, phi_d] = extents;
        let extents = Self { theta_h, theta_d, phi_d };
        (bytes.len() as u64 == HEADER as u64 + 24 * extents.len() as u64).then_some(extents)
    }
}

/// A measurement in half and difference angles.
#[derive(Clone, Debug)]
pub struct MerlTable {
    extents: Extents,
    /// f [sr⁻¹] in red, green and blue; negative red where nothing was measured.
    values: Vec<[f32; 3]>,
    upsampling: Box<RgbUpsampling>,
    lobe: HalfwayLobe,
}

/// A pair of directions in Rusinkiewicz's coordinates.
struct Angles {
    theta_h: f32,
    theta_d: f32,
    phi_d: f32,
}

impl MerlTable {
    /// Reads a file.
    ///
    /// # Errors
    /// When the first bytes are not the extents of a table of the file's length, when a value is not finite, or when
    /// none is above zero.
    pub fn parse(bytes: &[u8]) -> Result<Self, MeasuredError> {
        let extents = Extents::of(bytes).ok_or(MeasuredError::MerlSize { bytes: bytes.len() })?;
        let n = extents.len();
        let (numbers, _) = bytes[HEADER..].as_chunks::<8>();
        let mut values = vec![[0.0; 3]; n];
        for (c, channel) in ["red", "green", "blue"].into_iter().enumerate() {
            for (index, (number, value)) in numbers[c * n..].iter().zip(&mut values).enumerate() {
                let f = (f64::from_le_bytes(*number) * SCALE[c]) as f32;
                if !(f.abs() <= LARGEST) {
                    return Err(MeasuredError::MerlValue { channel, index });
                }
                value[c] = f;
            }
        }
        for value in &mut values {
            // Nothing was measured where any channel is negative.
            if value.iter().any(|&c| c < 0.0) {
                *value = [-1.0; 3];
            }
        }
        let lobe = HalfwayLobe::of(extents, &values).ok_or(MeasuredError::Black)?;
        Ok(Self { extents, values, upsampling: Box::new(RgbUpsampling::new()), lobe })
    }

    /// f [sr⁻¹]; zero across the surface, alike on both sides.
    pub(super) fn eval(&self, wo: LocalDir, wi: LocalDir, lambda: &[f32; LANES]) -> Sampled<PerSteradian> {
        let Some(angles) = angles(wo, wi) else { return Sampled::ZERO };
        self.upsampling.at(self.rgb(&angles), lambda)
    }

    /// Density of [`MerlTable::sample`].
    pub(super) fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if !wo.same_hemisphere(wi) {
            return PdfSolidAngle(0.0);
        }
        let sum = *wo + *wi;
        // wo·h is half of the sum's length; the product itself may be negative by rounding where both graze.
        let glossy = LocalDir::new(sum).map_or(0.0, |h| self.lobe.pdf(h) / (2.0 * sum.length()));
        let diffuse = warp::cosine_hemisphere_pdf(wi.abs_cos_theta());
        PdfSolidAngle(self.lobe.share * glossy + (1.0 - self.lobe.share) * diffuse)
    }

    /// A direction mirrored at a halfway vector, or with cosine distribution.
    pub(super) fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, lambda: &[f32; LANES]) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let flip = wo.z.signum();
        let (wi, lobe) = if uc < self.lobe.share {
            let h = self.lobe.sample(u) * flip;
            let cos = wo.dot(h);
            let wi = LocalDir::new(h * (2.0 * cos) - *wo)?;
            (wi, Lobe::Glossy)
        } else {
            (LocalDir::new(*warp::cosine_hemisphere(u) * flip)?, Lobe::Diffuse)
        };
        if !wo.same_hemisphere(wi) {
            return None;
        }
        let pdf = self.pdf(wo, wi);
        if !(pdf.0 > 0.0 && pdf.0.is_finite()) {
            return None;
        }
        Some(BsdfSample {
            wi,
            weight: self.eval(wo, wi, lambda).weight(wi.abs_cos_theta(), pdf),
            density: Density::SolidAngle(pdf),
            side: Side::Reflection,
            lobe,
            eta: 1.0,
        })
    }

    /// f [sr⁻¹] in red, green and blue: linear among those of the eight cells around where something was measured.
    fn rgb(&self, angles: &Angles) -> [f32; 3] {
        let Extents { theta_h: nh, theta_d: nd, phi_d: np } = self.extents;
        let h = among((angles.theta_h / FRAC_PI_2).sqrt(), nh);
        let d = among(angles.theta_d / FRAC_PI_2, nd);
        let p = angles.phi_d * FRAC_1_PI * np as f32 - 0.5;
        let floor = p.floor();
        let (first, share) = ((floor + np as f32) as usize % np, p - floor);
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for (i, wi) in [(h.index as usize, 1.0 - h.share), (h.index as usize + 1, h.share)] {
            for (j, wj) in [(d.index as usize, 1.0 - d.share), (d.index as usize + 1, d.share)] {
                for (k, wk) in [(first, 1.0 - share), ((first + 1) % np, share)] {
                    let value = self.values[(i * nd + j) * np + k];
                    let weight = wi * wj * wk;
                    if value[0] >= 0.0 {
                        total += weight;
                        sum = [0, 1, 2].map(|c| sum[c] + weight * value[c]);
                    }
                }
            }
        }
        if total > 0.0 { sum.map(|c| c / total) } else { [0.0; 3] }
    }
}

/// No f comes near; products of such values stay finite.
const LARGEST: f32 = 1e9;

/// Where x ∈ [0, 1] lies among the centres of n cells.
fn among(x: f32, n: usize) -> Knot {
    let at = (x * n as f32 - 0.5).clamp(0.0, (n - 1) as f32);
    let index = (at as usize).min(n - 2);
    Knot { index: index as u32, share: at - index as f32 }
}

/// The coordinates of two directions on the same side; `None` where they are not.
fn angles(wo: LocalDir, wi: LocalDir) -> Option<Angles> {
    if !wo.same_hemisphere(wi) {
        return None;
    }
    let flip = wo.z.signum();
    let (sum, difference) = ((*wo + *wi) * flip, (*wi - *wo) * flip);
    let h = LocalDir::new(sum)?;
    let radius = h.truncate().length();
    // The axes across h: one in the plane of h and the normal, one across it. At the pole, any.
    let (c, s) = if radius > 0.0 { (h.x / radius, h.y / radius) } else { (1.0, 0.0) };
    let along = difference.dot(Vec3::new(c * h.z, s * h.z, -radius));
    let across = difference.y * c - difference.x * s;
    let phi = across.atan2(along);
    Some(Angles {
        theta_h: radius.atan2(h.z),
        // Half of the angle between the directions, accurate for small and large ones.
        theta_d: difference.length().atan2(sum.length()),
        phi_d: if phi < 0.0 { phi + PI } else { phi },
    })
}

/// Halfway vectors distributed as brightly as they scatter on average, around the normal.
#[derive(Clone, Debug)]
struct HalfwayLobe {
    /// Nodes in 1 − cosθh, from 0 to 1.
    nodes: Vec<f32>,
    /// Density over 1 − cosθh at the nodes; linear between them, with integral one.
    density: Vec<f32>,
    /// Its integral up to each node.
    cumulative: Vec<f32>,
    /// Probability of drawing from it; else the cosine distribution is drawn from.
    share: f32,
}

impl HalfwayLobe {
    /// `None` where all is black.
    fn of(extents: Extents, values: &[[f32; 3]]) -> Option<Self> {
        let Extents { theta_h: nh, theta_d: nd, phi_d: np } = extents;
        let theta = |i: f32| FRAC_PI_2 * (i / nh as f32).powi(2);
        // Mean f by half angle, over the directions around h in proportion to their projected solid angle.
        let mut mean = vec![0.0_f64; nh];
        for (i, mean) in mean.iter_mut().enumerate() {
            let mut total = 0.0;
            for j in 0..nd {
                let theta_d = FRAC_PI_2 * (j as f32 + 0.5) / nd as f32;
                let weight = f64::from((2.0 * theta_d).sin());
                for value in &values[(i * nd + j) * np..][..np] {
                    if value[0] >= 0.0 {
                        *mean += weight * f64::from(value.iter().sum::<f32>() / 3.0);
                        total += weight;
                    }
                }
            }
            *mean /= f64::max(total, f64::MIN_POSITIVE);
        }
        // What is scattered everywhere is left to the cosine distribution.
        let steep = |i: usize| theta(i as f32 + 0.5) < 1.0;
        let floor =
            mean.iter().enumerate().filter(|m| steep(m.0)).map(|m| *m.1).fold(f64::INFINITY, f64::min);
        let mut nodes = vec![0.0];
        nodes.extend((0..nh).map(|i| versine(theta(i as f32 + 0.5))));
        nodes.push(1.0);
        let excess = |i: usize| ((mean[i] - floor).max(0.0) as f32) * (1.0 - nodes[i + 1]);
        let mut density = vec![excess(0)];
        density.extend((0..nh).map(excess));
        density.push(0.0);
        let area = |density: &[f32]| -> f64 {
            let pairs = nodes.windows(2).zip(density.windows(2));
            pairs.map(|(x, y)| 0.5 * f64::from((x[1] - x[0]) * (y[0] + y[1]))).sum()
        };
        // Directions around h fill four times its solid angle.
        let glossy = 4.0 * f64::from(TAU) * area(&density);
        let diffuse = floor * f64::from(PI);
        if !(glossy + diffuse > 0.0) {
            return mean.iter().any(|&m| m > 0.0).then(Self::diffuse);
        }
        if !(glossy > 0.0) {
            return Some(Self::diffuse());
        }
        let total = area(&density);
        density.iter_mut().for_each(|d| *d = (f64::from(*d) / total) as f32);
        let mut sum = 0.0;
        let mut cumulative = vec![0.0];
        for (x, y) in nodes.windows(2).zip(density.windows(2)) {
            sum += 0.5 * f64::from((x[1] - x[0]) * (y[0] + y[1]));
            cumulative.push(sum as f32);
        }
        let share = (glossy / (glossy + diffuse)).clamp(0.0, 0.9) as f32;
        Some(Self { nodes, density, cumulative, share })
    }

    /// The lobe that is never drawn from.
    fn diffuse() -> Self {
        Self { nodes: vec![0.0, 1.0], density: vec![1.0, 1.0], cumulative: vec![0.0, 1.0], share: 0.0 }
    }

    /// A halfway vector on the upper side.
    fn sample(&self, u: Vec2) -> Vec3 {
        let last = self.nodes.len() - 2;
        let i = self.cumulative.partition_point(|&c| c <= u.x).saturating_sub(1).min(last);
        let width = self.nodes[i + 1] - self.nodes[i];
        let ends = [self.density[i], self.density[i + 1]];
        let versine = self.nodes[i] + width * ramp_inverse((u.x - self.cumulative[i]) / width, ends);
        let r = (versine * (2.0 - versine)).max(0.0).sqrt();
        let (sin, cos) = (TAU * u.y).sin_cos();
        Vec3::new(r * cos, r * sin, 1.0 - versine)
    }

    /// Density [sr⁻¹] of the halfway vector ±h.
    fn pdf(&self, h: LocalDir) -> f32 {
        // 1 − cosθ without cancellation.
        let versine = h.truncate().length_squared() / (1.0 + h.abs_cos_theta());
        let Knot { index, share } = Knot::locate(&self.nodes, versine);
        let i = index as usize;
        (self.density[i] * (1.0 - share) + self.density[i + 1] * share) / TAU
    }
}

/// 1 − cosθ, accurate for small angles.
fn versine(theta: f32) -> f32 {
    let s = (0.5 * theta).sin();
    2.0 * s * s
}

/// The bytes of a file of f(wo, wi) [sr⁻¹] in red, green and blue, for directions above the surface.
pub fn write(extents: Extents, f: impl Fn(LocalDir, LocalDir) -> [f32; 3]) -> Vec<u8> {
    let mut values = Vec::with_capacity(extents.len());
    for i in 0..extents.theta_h {
        let theta_h = FRAC_PI_2 * ((i as f32 + 0.5) / extents.theta_h as f32).powi(2);
        let (sh, ch) = theta_h.sin_cos();
        for j in 0..extents.theta_d {
            let (sd, cd) = (FRAC_PI_2 * (j as f32 + 0.5) / extents.theta_d as f32).sin_cos();
            for k in 0..extents.phi_d {
                let (sp, cp) = (PI * (k as f32 + 0.5) / extents.phi_d as f32).sin_cos();
                // d around h = (sh, 0, ch), turned from the pole to h.
                let turned = |sign: f32| {
                    Vec3::new(ch * sd * cp * sign + sh * cd, sd * sp * sign, ch * cd - sh * sd * cp * sign)
                };
                let pair = LocalDir::new(turned(-1.0)).zip(LocalDir::new(turned(1.0)));
                values.push(match pair {
                    Some((wo, wi)) if wo.z > 0.0 && wi.z > 0.0 => f(wo, wi),
                    _ => [-1.0; 3],
                });
            }
        }
    }
    let extents = [extents.theta_h, extents.theta_d, extents.phi_d];
    let mut out: Vec<u8> = extents.iter().flat_map(|&n| (n as i32).to_le_bytes()).collect();
    for (c, scale) in SCALE.into_iter().enumerate() {
        out.extend(values.iter().flat_map(|v| (f64::from(v[c]) / scale).to_le_bytes()));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::warp::uniform_sphere;

    #[test]
    fn the_writer_places_values_where_the_reader_looks() {
        // f tells where it was asked: a smooth function of the coordinates, symmetric in the directions.
        let f = |wo: LocalDir, wi: LocalDir| {
            let a = angles(wo, wi).unwrap();
            [0.2 + a.theta_h, 0.2 + a.theta_d, 0.5 + 0.3 * (2.0 * a.phi_d).cos()]
        };
        let extents = Extents { theta_h: 60, theta_d: 60, phi_d: 90 };
        let table = MerlTable::parse(&write(extents, f)).unwrap();
        let mut rng = Pcg32::new(1, 1);
        for _ in 0..500 {
            let mut draw = || uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32())).abs();
            let (wo, wi) = (LocalDir::new(draw()).unwrap(), LocalDir::new(draw()).unwrap());
            if wo.z < 0.2 || wi.z < 0.2 {
                continue;
            }
            let (exact, found) = (f(wo, wi), table.rgb(&angles(wo, wi).unwrap()));
            assert!((0..3).all(|c| (exact[c] - found[c]).abs() < 0.02), "{exact:?} {found:?}");
        }
    }

    #[test]
    fn the_lobe_integrates_to_one_over_the_hemisphere() {
        let extents = Extents { theta_h: 20, theta_d: 10, phi_d: 8 };
        let lobe =
            MerlTable::parse(&write(extents, |wo, wi| [(*wo + *wi).normalize().z.powi(40); 3])).unwrap().lobe;
        let mut mass = 0.0;
        let n = 20_000;
        for i in 0..n {
            let z = 1.0 - (i as f32 + 0.5) / n as f32;
            let h = LocalDir::new_unchecked(Vec3::new((1.0 - z * z).sqrt(), 0.0, z));
            mass += f64::from(lobe.pdf(h) * TAU / n as f32);
        }
        assert!((mass - 1.0).abs() < 1e-3, "{mass}");
        assert!(lobe.share > 0.5, "{}", lobe.share);
        // The integral below a drawn vector is the number it was drawn with.
        for u in [0.01, 0.3, 0.77, 0.999] {
            let v = 1.0 - lobe.sample(Vec2::new(u, 0.2)).z;
            let below: f64 = (0..n)
                .map(|i| v * (i as f32 + 0.5) / n as f32)
                .map(|x| {
                    let h = Vec3::new((x * (2.0 - x)).sqrt(), 0.0, 1.0 - x);
                    f64::from(lobe.pdf(LocalDir::new_unchecked(h)) * TAU * v / n as f32)
                })
                .sum();
            assert!((below - f64::from(u)).abs() < 2e-3, "{u} {below}");
        }
    }

    #[test]
    fn files_of_another_length_and_values_without_meaning_are_refused() {
        let extents = Extents { theta_h: 2, theta_d: 2, phi_d: 2 };
        let file = write(extents, |_, _| [0.1; 3]);
        let refused = |bytes: &[u8]| MerlTable::parse(bytes).unwrap_err().to_string();
        let n = file.len();
        assert_eq!(
            refused(&file[..n - 1]),
            format!(
                "this is no MERL file: its first 12 bytes are not the extents of a table of {} bytes",
                n - 1
            )
        );
        let mut nan = file.clone();
        nan[HEADER + 8 * 9..][..8].copy_from_slice(&f64::NAN.to_le_bytes());
        assert_eq!(refused(&nan), "value 1 of green is not finite");
        assert_eq!(refused(&write(extents, |_, _| [0.0; 3])), "no value is above zero");
    }
}
