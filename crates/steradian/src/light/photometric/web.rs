//! The photometric web: luminous intensity over a grid of angles, and between them.
//!
//! Between planes the intensity is linear in the angle. Along a plane it is a cubic that keeps monotone data monotone (Fritsch and
//! Butland 1984), or linear on request: linear interpolation of cosᵐ, m ≥ 2, at a spacing h makes the flux too
//! large by m h²/12, more than 10⁻⁴ at 1° from m = 4 on.
//!
//! All systems of planes are the same figure in different attitudes: half planes around a polar axis, and angles from one of its
//! ends within each half plane. A direction has plane angle α = atan2(d·ninety, d·zero) and angle β = acos(d·pole); solid angle
//! is dω = sin β dβ dα. Light space has the nadir of the luminaire at −z and its C0 plane at +x.

use crate::math::Vec3;
use thiserror::Error;

/// The systems of planes of IES LM-63, after its definitions of photometric zero (nadir), photometric horizontal and of the
/// sense in which horizontal angles count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planes {
    /// Vertical half planes; H = 0, V = 0 is horizontal, along +x, V counts upwards, H clockwise as seen from above.
    A,
    /// Planes around a horizontal axis, the y axis; H = V = 0 is the nadir, V counts towards +x, H from +y to −y.
    B,
    /// Vertical half planes C, from +x towards +y; γ counts from the nadir.
    C,
}

impl Planes {
    /// From which end of the polar axis β counts, and the directions of α = 0 and α = 90° at β = 90°.
    fn attitude(self) -> [Vec3; 3] {
        match self {
            Self::A => [-Vec3::Z, Vec3::X, -Vec3::Y],
            Self::B => [Vec3::Y, -Vec3::Z, Vec3::X],
            Self::C => [-Vec3::Z, Vec3::X, Vec3::Y],
        }
    }
}

/// Which half planes are copies of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// None.
    None,
    /// One half plane stands for all.
    Rotational,
    /// I(C) = I(360° − C): the C0–C180 plane is a mirror.
    AboutC0,
    /// I(C) = I(180° − C): the C90–C270 plane is a mirror.
    AboutC90,
    /// Both are.
    Quadrant,
}

/// What lies between the angles of a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Monotone cubics, smooth where the data are monotone, without overshoot anywhere.
    #[default]
    Smooth,
    /// Straight lines, as in most lighting programs.
    Linear,
}

/// A place in the data of a web.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WebItem {
    /// The plane of that index.
    Plane(usize),
    /// The angle of that index.
    Angle(usize),
    /// The intensity of that index, all angles of a plane after each other.
    Intensity(usize),
}

/// Why data are no web.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum WebError {
    /// A list is too short or too long.
    #[error("a web needs 1 to {MAX_ANGLES} planes with 2 to {MAX_ANGLES} angles, not {planes} with {angles}")]
    Extent {
        /// Number of planes.
        planes: usize,
        /// Number of angles.
        angles: usize,
    },
    /// Number of intensities.
    #[error("{planes} planes with {angles} angles have {} intensities, not {found}", planes * angles)]
    Count {
        /// Number of planes.
        planes: usize,
        /// Number of angles.
        angles: usize,
        /// Number of intensities.
        found: usize,
    },
    /// An angle is not above the one before it.
    #[error("angles must increase, found {found} after {before}")]
    Order {
        /// Where.
        at: WebItem,
        /// The angle [°].
        found: f64,
        /// Its predecessor [°].
        before: f64,
    },
    /// An angle is out of range.
    #[error("the angle must lie from {min} to {max} degrees, found {found}")]
    Range {
        /// Where.
        at: WebItem,
        /// The angle [°].
        found: f64,
        /// Least [°].
        min: f64,
        /// Greatest [°].
        max: f64,
    },
    /// The planes do not fit any symmetry.
    #[error(
        "planes from {first} to {last} degrees: they must reach from 0 to 90, 180 or 360, or from 90 to 270"
    )]
    Sector {
        /// Where.
        at: WebItem,
        /// First plane [°].
        first: f64,
        /// Last plane [°].
        last: f64,
    },
    /// An intensity is negative or not finite.
    #[error("an intensity must be finite and not negative, found {found}")]
    Intensity {
        /// Where.
        at: WebItem,
        /// The number.
        found: f64,
    },
}

impl WebError {
    /// The place in the data, where it is one.
    pub fn item(&self) -> Option<WebItem> {
        match self {
            Self::Extent { .. } | Self::Count { .. } => None,
            Self::Order { at, .. }
            | Self::Range { at, .. }
            | Self::Sector { at, .. }
            | Self::Intensity { at, .. } => Some(*at),
        }
    }
}

/// Most planes, and most angles in a plane, of a web.
pub const MAX_ANGLES: usize = 3601;

/// Largest intensity that a file may state [cd]: single precision holds its flux.
pub(super) const MAX_CANDELA: f64 = 1e30;

/// Luminous intensity [cd] by direction.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotometricWeb {
    system: Planes,
    /// α [°], increasing; of type C all around without 360.
    planes: Vec<f64>,
    /// β [°], increasing.
    angles: Vec<f64>,
    /// All angles of a plane after each other [cd].
    candela: Vec<f64>,
    /// Slopes there [cd·rad⁻¹]; empty for straight lines.
    slopes: Vec<f64>,
}

/// A piece of a plane: f + d x + c x² + e x³ at x [rad] after its first angle.
struct Piece {
    f: f64,
    d: f64,
    c: f64,
    e: f64,
}

impl Piece {
    fn at(&self, x: f64) -> f64 {
        self.f + x * (self.d + x * (self.c + x * self.e))
    }

    /// The antiderivative of the piece times sin β: −p cos β + p′ sin β + p″ cos β − p‴ sin β.
    fn weighted(&self, x: f64, beta: f64) -> f64 {
        let (sin, cos) = beta.sin_cos();
        let slope = self.d + x * (2.0 * self.c + x * 3.0 * self.e);
        let (second, third) = (2.0 * self.c + 6.0 * self.e * x, 6.0 * self.e);
        (second - self.at(x)) * cos + (slope - third) * sin
    }
}

/// A cell of a grid and the share of its upper end.
#[derive(Clone, Copy)]
struct Between {
    lower: usize,
    upper: usize,
    t: f64,
}

impl PhotometricWeb {
    /// A web of type C with half planes C [°], from 0 to 90 (a quadrant), to 180 or from 90 to 270 (half), up to 360 or any
    /// last plane above 180 (all around), or a single one, and angles γ [°] within [0, 180]; `candela` holds all angles of a
    /// plane after each other. Outside of the range of γ there is no light.
    pub fn type_c(planes: Vec<f64>, gamma: Vec<f64>, candela: Vec<f64>) -> Result<Self, WebError> {
        check(&planes, &gamma, &candela, [0.0, 360.0], [0.0, 180.0])?;
        let all_around = Self { system: Planes::C, planes, angles: gamma, candela, slopes: Vec::new() };
        let sector = [all_around.planes[0], all_around.planes[all_around.planes.len() - 1]];
        let mirrored = match sector {
            _ if all_around.planes.len() == 1 => return Ok(Self { planes: vec![0.0], ..all_around }.smooth()),
            [0.0, 90.0] => all_around.with_mirrored(|c| 180.0 - c).with_mirrored(|c| 360.0 - c),
            [0.0, 180.0] => all_around.with_mirrored(|c| 360.0 - c),
            [90.0, 270.0] => all_around.with_mirrored(|c| (540.0 - c).rem_euclid(360.0)),
            [0.0, last] if last > 180.0 => all_around,
            [first, last] => {
                let at = WebItem::Plane(if first == 0.0 { all_around.planes.len() - 1 } else { 0 });
                return Err(WebError::Sector { at, first, last });
            }
        };
        Ok(mirrored.without_seam().smooth())
    }

    /// A web of type A: vertical planes at H [°] with angles V [°], both within [−90, 90]. Planes that begin at H = 0 stand for
    /// those on the other side, too. `candela` holds all angles V of a plane after each other.
    pub fn type_a(horizontal: Vec<f64>, vertical: Vec<f64>, candela: Vec<f64>) -> Result<Self, WebError> {
        check(&horizontal, &vertical, &candela, [-90.0, 90.0], [-90.0, 90.0])?;
        at_least_two(&horizontal, &vertical)?;
        let angles = vertical.iter().map(|v| v + 90.0).collect();
        let web = Self { system: Planes::A, planes: horizontal, angles, candela, slopes: Vec::new() };
        Ok(if web.planes[0] == 0.0 { web.with_mirrored(|h| -h) } else { web }.smooth())
    }

    /// A web of type B with angles H and V [°], both within [−90, 90]. Angles that begin at H = 0 stand for those on the other
    /// side, too. `candela` holds, as in a file, all angles V for the same H after each other.
    pub fn type_b(horizontal: Vec<f64>, vertical: Vec<f64>, candela: Vec<f64>) -> Result<Self, WebError> {
        check(&horizontal, &vertical, &candela, [-90.0, 90.0], [-90.0, 90.0])?;
        at_least_two(&horizontal, &vertical)?;
        // The planes of the figure are those of V; a mirror would reverse β, which is done while H still counts the rows.
        let rows =
            Self { system: Planes::B, planes: horizontal, angles: vertical, candela, slopes: Vec::new() };
        let rows = if rows.planes[0] == 0.0 { rows.with_mirrored(|h| -h) } else { rows };
        let (n, m) = (rows.planes.len(), rows.angles.len());
        let candela = (0..n * m).map(|i| rows.candela[(i % n) * m + i / n]).collect();
        let angles = rows.planes.iter().map(|h| h + 90.0).collect();
        Ok(Self { system: Planes::B, planes: rows.angles, angles, candela, slopes: Vec::new() }.smooth())
    }

    /// No light at all.
    pub fn dark() -> Self {
        Self {
            system: Planes::C,
            planes: vec![0.0],
            angles: vec![0.0, 180.0],
            candela: vec![0.0; 2],
            slopes: vec![0.0; 2],
        }
    }

    /// The planes, and those at the mirrored angle, in increasing order.
    fn with_mirrored(self, mirror: impl Fn(f64) -> f64) -> Self {
        let m = self.angles.len();
        let mut all: Vec<(f64, usize)> = self.planes.iter().copied().zip(0..).collect();
        all.extend(self.planes.iter().map(|&p| mirror(p)).zip(0..));
        // Stable: of a plane and its image at the same angle the plane comes first.
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.dedup_by(|a, b| a.0 == b.0);
        let candela = all.iter().flat_map(|&(_, i)| &self.candela[i * m..(i + 1) * m]).copied().collect();
        Self { planes: all.into_iter().map(|(p, _)| p).collect(), candela, ..self }
    }

    /// Without the plane at 360°, which is the one at 0.
    fn without_seam(mut self) -> Self {
        if self.planes.last().is_some_and(|p| *p >= 360.0) && self.planes.len() > 1 {
            self.planes.pop();
            self.candela.truncate(self.planes.len() * self.angles.len());
        }
        self
    }

    /// The same data, interpolated in the given way.
    #[must_use]
    pub fn interpolated(mut self, interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Smooth => self.smooth(),
            Interpolation::Linear => {
                self.slopes.clear();
                self
            }
        }
    }

    fn smooth(mut self) -> Self {
        let m = self.angles.len();
        self.slopes = self.candela.chunks_exact(m).flat_map(|row| slopes(&self.angles, row)).collect();
        self
    }

    /// The system of planes.
    pub fn system(&self) -> Planes {
        self.system
    }

    /// α of the planes [°], of type C all around without 360.
    pub fn planes(&self) -> &[f64] {
        &self.planes
    }

    /// β [°], which for type C is γ.
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// Intensities of a plane [cd]; empty beyond the last.
    pub fn plane(&self, index: usize) -> &[f64] {
        let m = self.angles.len();
        self.candela.get(index * m..(index + 1) * m).unwrap_or(&[])
    }

    /// The largest intensity [cd].
    pub fn peak(&self) -> f64 {
        self.candela.iter().copied().fold(0.0, f64::max)
    }

    /// The same web times `factor`, which is finite and not negative.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.candela.iter_mut().chain(&mut self.slopes).for_each(|c| *c *= factor);
        self
    }

    /// Intensity [cd] in direction `d` of light space, which need not be normalised; zero outside of the table.
    pub fn intensity(&self, d: Vec3) -> f64 {
        let [pole, zero, ninety] = self.system.attitude().map(|axis| f64::from(axis.dot(d)));
        let (alpha, beta) = (ninety.atan2(zero), zero.hypot(ninety).atan2(pole));
        self.at(alpha.to_degrees(), beta.to_degrees())
    }

    /// Intensity [cd] at plane α and angle β [°], interpolated in both; zero outside of the table.
    pub fn at(&self, alpha: f64, beta: f64) -> f64 {
        let (Some(p), Some(a)) = (self.between_planes(alpha), between(&self.angles, beta)) else {
            return 0.0;
        };
        let x = (beta - self.angles[a.lower]).to_radians();
        let row = |plane: usize| self.piece(plane, a.lower).at(x);
        let lower = row(p.lower);
        if p.t == 0.0 { lower } else { lower + p.t * (row(p.upper) - lower) }
    }

    /// The piece of a plane that begins at its angle `i`, which is not the last one.
    fn piece(&self, plane: usize, i: usize) -> Piece {
        let at = plane * self.angles.len() + i;
        let h = (self.angles[i + 1] - self.angles[i]).to_radians();
        let (f, rise) = (self.candela[at], (self.candela[at + 1] - self.candela[at]) / h);
        match self.slopes.get(at..at + 2) {
            Some(&[d, next]) => {
                Piece { f, d, c: (3.0 * rise - 2.0 * d - next) / h, e: (d + next - 2.0 * rise) / (h * h) }
            }
            _ => Piece { f, d: rise, c: 0.0, e: 0.0 },
        }
    }

    fn between_planes(&self, alpha: f64) -> Option<Between> {
        if self.system != Planes::C {
            return between(&self.planes, alpha);
        }
        let alpha = alpha.rem_euclid(360.0);
        let (first, last) = (self.planes[0], self.planes[self.planes.len() - 1]);
        // Between the last plane and the first one.
        if self.planes.len() == 1 || alpha < first || alpha >= last {
            let width = first + 360.0 - last;
            let t = (alpha - last).rem_euclid(360.0) / width;
            return Some(Between { lower: self.planes.len() - 1, upper: 0, t });
        }
        between(&self.planes, alpha)
    }

    /// ∫ I dω [lm] of the interpolated table, in closed form.
    pub fn flux(&self) -> f64 {
        self.flux_within([0.0, 180.0])
    }

    /// ∫ I dω [lm] of the interpolated table over `range` of β [°], in closed form: linear in α, a cell's integral over α is the
    /// mean of its ends; in β it is that of a cubic times sin β.
    pub fn flux_within(&self, range: [f64; 2]) -> f64 {
        let columns: Vec<f64> = (0..self.planes.len()).map(|p| self.column(p, range)).collect();
        let mut sum: f64 = self
            .planes
            .windows(2)
            .zip(columns.windows(2))
            .map(|(p, c)| (p[1] - p[0]).to_radians() * 0.5 * (c[0] + c[1]))
            .sum();
        if self.system == Planes::C {
            let last = self.planes.len() - 1;
            let seam = (self.planes[0] + 360.0 - self.planes[last]).to_radians();
            sum += seam * 0.5 * (columns[last] + columns[0]);
        }
        sum
    }

    /// ∫ I sin β dβ along a plane [cd].
    fn column(&self, plane: usize, [from, to]: [f64; 2]) -> f64 {
        let mut sum = 0.0;
        for (i, ends) in self.angles.windows(2).enumerate() {
            let (lo, hi) = (ends[0].max(from), ends[1].min(to));
            if hi > lo {
                let piece = self.piece(plane, i);
                let weighted = |beta: f64| piece.weighted((beta - ends[0]).to_radians(), beta.to_radians());
                sum += weighted(hi) - weighted(lo);
            }
        }
        sum
    }

    /// The largest angle from the nadir at which there is light [°].
    pub fn reach(&self) -> f64 {
        match self.system {
            // Around the nadir, up to the angle after the last one that is lit.
            Planes::C => {
                let m = self.angles.len();
                let lit = self
                    .candela
                    .iter()
                    .zip(0..)
                    .filter(|(c, _)| **c > 0.0)
                    .map(|(_, i): (_, usize)| i % m)
                    .max();
                lit.map_or(0.0, |i| self.angles[(i + 1).min(m - 1)])
            }
            Planes::B => 90.0,
            Planes::A => 180.0,
        }
    }

    /// Which planes are copies of others, to the last bit.
    pub fn symmetry(&self) -> Symmetry {
        if self.system != Planes::C {
            return Symmetry::None;
        }
        if self.planes.len() == 1 {
            return Symmetry::Rotational;
        }
        let has = |mirror: &dyn Fn(f64) -> f64| {
            (0..self.planes.len()).all(|i| {
                let image = mirror(self.planes[i]).rem_euclid(360.0);
                let found = self.planes.iter().position(|p| (p - image).abs() < 1e-9);
                found.is_some_and(|j| self.plane(i) == self.plane(j))
            })
        };
        // A file of such a sector begins and ends at the planes of the mirror.
        let planes = |wanted: [f64; 2]| wanted.iter().all(|w| self.planes.contains(w));
        let c0 = planes([0.0, 180.0]) && has(&|c| 360.0 - c);
        let c90 = planes([90.0, 270.0]) && has(&|c| 180.0 - c);
        match (c0, c90) {
            (true, true) => Symmetry::Quadrant,
            (true, false) => Symmetry::AboutC0,
            (false, true) => Symmetry::AboutC90,
            (false, false) => Symmetry::None,
        }
    }
}

/// Slopes [per rad] of the monotone cubics through values at angles [°]: the weighted harmonic mean of the slopes on either side,
/// or zero where these differ in sign (Fritsch & Butland 1984); a parabola's at the ends, limited likewise.
fn slopes(angles: &[f64], values: &[f64]) -> Vec<f64> {
    let widths: Vec<f64> = angles.windows(2).map(|a| (a[1] - a[0]).to_radians()).collect();
    let rises: Vec<f64> = values.windows(2).zip(&widths).map(|(v, h)| (v[1] - v[0]) / h).collect();
    let end = |near: usize, next: Option<usize>| {
        let Some(next) = next.filter(|&i| i < rises.len()) else { return rises[near] };
        let (h, k) = (widths[near], widths[next]);
        let slope = ((2.0 * h + k) * rises[near] - h * rises[next]) / (h + k);
        if slope * rises[near] <= 0.0 {
            0.0
        } else if rises[near] * rises[next] < 0.0 && slope.abs() > 3.0 * rises[near].abs() {
            3.0 * rises[near]
        } else {
            slope
        }
    };
    let last = rises.len() - 1;
    let inner = |i: usize| {
        let (a, b) = (rises[i - 1], rises[i]);
        if a * b <= 0.0 {
            return 0.0;
        }
        let (v, w) = (2.0 * widths[i] + widths[i - 1], widths[i] + 2.0 * widths[i - 1]);
        (v + w) / (v / a + w / b)
    };
    (0..values.len())
        .map(|i| match i {
            0 => end(0, Some(1)),
            i if i > last => end(last, last.checked_sub(1)),
            i => inner(i),
        })
        .collect()
}

fn at_least_two(planes: &[f64], angles: &[f64]) -> Result<(), WebError> {
    let (planes, angles) = (planes.len(), angles.len());
    if planes < 2 { Err(WebError::Extent { planes, angles }) } else { Ok(()) }
}

fn check(
    planes: &[f64],
    angles: &[f64],
    candela: &[f64],
    plane_range: [f64; 2],
    angle_range: [f64; 2],
) -> Result<(), WebError> {
    let (p, a) = (planes.len(), angles.len());
    if !(1..=MAX_ANGLES).contains(&p) || !(2..=MAX_ANGLES).contains(&a) {
        return Err(WebError::Extent { planes: p, angles: a });
    }
    check_angles(planes, plane_range, WebItem::Plane)?;
    check_angles(angles, angle_range, WebItem::Angle)?;
    if candela.len() != p * a {
        return Err(WebError::Count { planes: p, angles: a, found: candela.len() });
    }
    match candela.iter().position(|c| !(c.is_finite() && *c >= 0.0)) {
        Some(i) => Err(WebError::Intensity { at: WebItem::Intensity(i), found: candela[i] }),
        None => Ok(()),
    }
}

fn check_angles(list: &[f64], [min, max]: [f64; 2], item: impl Fn(usize) -> WebItem) -> Result<(), WebError> {
    if let Some(i) = list.iter().position(|a| !(min..=max).contains(a)) {
        return Err(WebError::Range { at: item(i), found: list[i], min, max });
    }
    match list.windows(2).position(|w| w[0] >= w[1]) {
        Some(i) => Err(WebError::Order { at: item(i + 1), found: list[i + 1], before: list[i] }),
        None => Ok(()),
    }
}

/// The cell of an increasing list that holds `x`.
fn between(list: &[f64], x: f64) -> Option<Between> {
    let last = list.len() - 1;
    if !(list[0] <= x && x <= list[last]) {
        return None;
    }
    let upper = list.partition_point(|a| *a <= x).clamp(1, last.max(1)).min(last);
    let lower = upper.saturating_sub(1);
    let width = list[upper] - list[lower];
    let t = if width > 0.0 { (x - list[lower]) / width } else { 0.0 };
    Some(Between { lower, upper, t })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec2;
    use crate::math::warp::uniform_sphere;
    use std::f64::consts::{PI, TAU};

    fn degrees(n: u32) -> Vec<f64> {
        (0..=n).map(f64::from).collect()
    }

    fn random_web(seed: u64, planes: &[f64], gamma: &[f64]) -> PhotometricWeb {
        let mut rng = crate::math::hash::Pcg32::new(seed, 1);
        let candela = (0..planes.len() * gamma.len()).map(|_| f64::from(rng.next_f32())).collect();
        PhotometricWeb::type_c(planes.to_vec(), gamma.to_vec(), candela).unwrap()
    }

    /// ∫ I dω by the midpoint rule over (α, cos β).
    fn quadrature(web: &PhotometricWeb, n: u32) -> f64 {
        let cells = f64::from(n) * f64::from(n);
        let points = (0..n * n).map(|i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32);
        points.map(|u| web.intensity(uniform_sphere(u))).sum::<f64>() * 4.0 * PI / cells
    }

    #[test]
    fn flux_of_known_distributions_at_one_degree() {
        // 4πI₀, πI₀ and 2πI₀/(m + 1).
        let gamma = degrees(180);
        let isotropic = PhotometricWeb::type_c(vec![0.0], gamma.clone(), vec![7.0; 181]).unwrap();
        assert!((isotropic.flux() / (28.0 * PI) - 1.0).abs() < 1e-13);
        for m in 1..=5 {
            let lobe = gamma.iter().map(|g| 7.0 * g.to_radians().cos().max(0.0).powi(m)).collect();
            let web = PhotometricWeb::type_c(vec![0.0], gamma.clone(), lobe).unwrap();
            let expected = 7.0 * TAU / f64::from(m + 1);
            assert!((web.flux() / expected - 1.0).abs() < 1e-4, "{m}: {} {expected}", web.flux());
            // Straight lines: too much by m h²/12, but for m = 1, whose slope at 90° counts twice as much the other way.
            let excess = web.interpolated(Interpolation::Linear).flux() / expected - 1.0;
            let (h, sign) = (1_f64.to_radians(), if m == 1 { -1.0 } else { 1.0 });
            assert!((excess / (sign * f64::from(m) * h * h / 12.0) - 1.0).abs() < 0.01, "{m}: {excess}");
        }
    }

    #[test]
    fn cubics_meet_the_data_and_stay_between_them() {
        let web = random_web(11, &[0.0, 90.0], &[0.0, 10.0, 25.0, 50.0, 55.0, 80.0, 90.0]);
        for (i, g) in web.angles().iter().enumerate() {
            assert!((web.at(0.0, *g) - web.plane(0)[i]).abs() < 1e-12);
        }
        for (i, ends) in web.angles().windows(2).enumerate() {
            let (a, b) = (web.plane(0)[i], web.plane(0)[i + 1]);
            let inner = (0..=40).map(|k| web.at(0.0, ends[0] + (ends[1] - ends[0]) * f64::from(k) / 40.0));
            let values: Vec<f64> = inner.collect();
            assert!(values.iter().all(|v| (a.min(b) - 1e-12..=a.max(b) + 1e-12).contains(v)), "{values:?}");
            assert!(values.windows(2).all(|v| (v[1] - v[0]) * (b - a) >= -1e-12), "{values:?}");
        }
        let linear = web.clone().interpolated(Interpolation::Linear);
        assert!((linear.at(0.0, 17.5) - 0.5 * (web.plane(0)[1] + web.plane(0)[2])).abs() < 1e-12);
        assert_eq!(linear.interpolated(Interpolation::Smooth), web);
    }

    #[test]
    fn the_closed_form_is_the_integral_of_the_interpolated_table() {
        let webs = [
            random_web(1, &[0.0, 20.0, 90.0], &[0.0, 30.0, 45.0, 90.0]),
            random_web(2, &[0.0, 50.0, 180.0], &[90.0, 130.0, 180.0]),
            random_web(3, &[90.0, 100.0, 200.0, 270.0], &[0.0, 40.0, 180.0]),
            random_web(4, &[0.0, 45.0, 200.0, 310.0], &[10.0, 60.0, 170.0]),
            random_web(5, &[0.0], &[0.0, 60.0, 100.0]),
            PhotometricWeb::type_a(
                vec![0.0, 40.0, 90.0],
                vec![-60.0, 10.0, 80.0],
                (1..10).map(f64::from).collect(),
            )
            .unwrap(),
            PhotometricWeb::type_b(
                vec![0.0, 40.0, 70.0],
                vec![-60.0, 10.0, 80.0],
                (1..10).map(f64::from).collect(),
            )
            .unwrap(),
        ];
        let linear: Vec<_> = webs.iter().map(|w| w.clone().interpolated(Interpolation::Linear)).collect();
        for web in webs.iter().chain(&linear) {
            let (exact, sum) = (web.flux(), quadrature(web, 700));
            // Steps at the ends of the table: about one part in 700 of a cell's weight.
            assert!((sum / exact - 1.0).abs() < 2e-3, "{web:?}: {exact} {sum}");
            let parts = web.flux_within([0.0, 47.0]) + web.flux_within([47.0, 180.0]);
            assert!((parts / exact - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn sectors_are_completed_by_their_symmetry() {
        let gamma = [0.0, 90.0];
        let quadrant = random_web(6, &[0.0, 30.0, 90.0], &gamma);
        let half = random_web(7, &[0.0, 30.0, 90.0, 180.0], &gamma);
        let other = random_web(8, &[90.0, 120.0, 180.0, 270.0], &gamma);
        let all = random_web(9, &[0.0, 100.0, 200.0, 360.0], &gamma);
        let one = random_web(10, &[0.0], &gamma);
        let symmetries = [
            (&quadrant, Symmetry::Quadrant),
            (&half, Symmetry::AboutC0),
            (&other, Symmetry::AboutC90),
            (&all, Symmetry::None),
            (&one, Symmetry::Rotational),
        ];
        for (web, expected) in symmetries {
            assert_eq!(web.symmetry(), expected, "{web:?}");
        }
        for c in (0..72).map(|i| 5.0 * f64::from(i) + 1.0) {
            for web in [&quadrant, &half] {
                assert!((web.at(c, 70.0) - web.at(360.0 - c, 70.0)).abs() < 1e-12, "{c}");
            }
            for web in [&quadrant, &other] {
                assert!((web.at(c, 70.0) - web.at(180.0 - c, 70.0)).abs() < 1e-12, "{c}");
            }
            assert_eq!(one.at(c, 70.0), one.at(0.0, 70.0));
        }
        assert_eq!(quadrant.planes(), [0.0, 30.0, 90.0, 150.0, 180.0, 210.0, 270.0, 330.0]);
    }

    #[test]
    fn each_system_of_planes_lies_as_the_standard_says() {
        let corner = |planes: &[f64], angles: &[f64], p: usize, a: usize| -> Vec<f64> {
            let m = angles.len();
            (0..planes.len() * m).map(|i| if i == p * m + a { 1.0 } else { 0.0 }).collect()
        };
        let h = [-90.0, -45.0, 0.0, 45.0, 90.0];
        let brightest = |web: &PhotometricWeb| {
            let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
            axes.into_iter().max_by(|a, b| web.intensity(*a).total_cmp(&web.intensity(*b))).unwrap()
        };
        let a = |p, v| PhotometricWeb::type_a(h.to_vec(), h.to_vec(), corner(&h, &h, p, v)).unwrap();
        let b = |p, v| PhotometricWeb::type_b(h.to_vec(), h.to_vec(), corner(&h, &h, p, v)).unwrap();
        // H = V = 0, then H = 90 at V = 0, then V = −90 or 90 at H = 0.
        assert_eq!(brightest(&a(2, 2)), Vec3::X);
        assert_eq!(brightest(&a(4, 2)), -Vec3::Y);
        assert_eq!(brightest(&a(2, 0)), -Vec3::Z);
        assert_eq!(brightest(&b(2, 2)), -Vec3::Z);
        assert_eq!(brightest(&b(2, 4)), Vec3::X);
        let side =
            PhotometricWeb::type_b(h.to_vec(), h.to_vec(), (0..25).map(|i| f64::from(i / 5)).collect())
                .unwrap();
        assert_eq!(brightest(&side), -Vec3::Y, "H = 90 is the pole that all planes share");
        let c = |p, g| {
            let planes = [0.0, 90.0, 180.0, 270.0];
            let gamma = [0.0, 90.0, 180.0];
            PhotometricWeb::type_c(planes.to_vec(), gamma.to_vec(), corner(&planes, &gamma, p, g)).unwrap()
        };
        assert_eq!(brightest(&c(1, 1)), Vec3::Y);
        assert_eq!(brightest(&c(2, 1)), -Vec3::X);
        assert!(c(0, 2).intensity(Vec3::new(1e-4, 0.0, 1.0)) > 0.9);
    }

    #[test]
    fn what_is_no_table_is_refused_with_its_place() {
        let c = |p: &[f64], g: &[f64], n: usize| {
            PhotometricWeb::type_c(p.to_vec(), g.to_vec(), vec![1.0; n]).unwrap_err()
        };
        assert_eq!(c(&[0.0], &[0.0], 1), WebError::Extent { planes: 1, angles: 1 });
        assert_eq!(c(&[0.0], &[0.0, 90.0], 3), WebError::Count { planes: 1, angles: 2, found: 3 });
        assert_eq!(c(&[0.0], &[0.0, 90.0, 80.0], 3).item(), Some(WebItem::Angle(2)));
        assert_eq!(c(&[0.0], &[-1.0, 90.0], 2).item(), Some(WebItem::Angle(0)));
        assert_eq!(c(&[0.0, 45.0], &[0.0, 90.0], 4).item(), Some(WebItem::Plane(1)));
        let negative = PhotometricWeb::type_c(vec![0.0], vec![0.0, 90.0], vec![1.0, -1.0]);
        assert_eq!(negative.unwrap_err().item(), Some(WebItem::Intensity(1)));
    }
}
