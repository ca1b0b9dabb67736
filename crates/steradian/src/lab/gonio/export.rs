//! Readings as a goniometer table that the renderer reads back as `Material "measured"`.
//!
//! The renderer interpolates linearly between nodes, the readings are means over cells. Written at the middles of the cells,
//! they would lose at peaks and gain at feet. So each cell is divided: values at several nodes within it follow the polynomial
//! of sixth degree that has the means of seven neighbouring cells, along θ and along φ (a conservative reconstruction, as in
//! finite volumes), and are then scaled until the means of what the renderer interpolates are the readings again. What a cell
//! scatters in all is kept; but for dark cells beside lobes narrower than two, to a few ten-thousandths of all light.

use super::super::probe::Angles;
use super::beam::Incidence;
use super::reading::{CellFlux, Reading};
use crate::bsdf::Side;
use std::fmt::Write as _;

/// How often values are scaled to the means of their cells: the error falls at least fivefold each time.
const ROUNDS: u32 = 12;
/// Cells that the values in one follow, along either angle.
const STENCIL: usize = 7;
/// Points of a quadrature between two neighbouring nodes.
const POINTS: usize = 8;

/// Why no table can be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// Cells must form a grid in θ and φ.
    #[error("a material table needs rings with equal numbers of cells, at least 4 of them")]
    Cells,
    /// Incidence must form a grid in θ and φ of directions.
    #[error(
        "a material table needs light from directions that form a grid in theta and phi, with one azimuth or with at least 4 \
         evenly around the circle"
    )]
    Incidence,
    /// The measurement was stopped.
    #[error("the measurement is not complete")]
    Incomplete,
    /// Nothing was measured that could be looked up between wavelengths.
    #[error("a material table needs one wavelength, for a grey material, or several that cover 420–680 nm")]
    Wavelengths,
}

/// Directions of incidence that a table of this grid interpolates well: at least twice as dense as its rings, at `azimuths`
/// even azimuths; 1 for an isotropic material.
pub fn table_incidence(rings: usize, azimuths: usize) -> Vec<Incidence> {
    let count = (2 * rings).max(36);
    let step = 90.0 / count as f64;
    let theta = (0..count).map(|i| i as f64 * step).chain([90.0 - 0.4 * step]);
    let n = azimuths.max(1);
    theta
        .flat_map(|theta| (0..n).map(move |k| Angles { theta, phi: 360.0 * k as f64 / n as f64 }))
        .map(Incidence::Direction)
        .collect()
}

/// Whether a table of these wavelengths [nm], in increasing order, can be read back.
///
/// # Errors
/// When they are several that do not cover the visible range.
pub fn check_table_wavelengths(wavelengths: &[f32]) -> Result<(), ExportError> {
    match wavelengths {
        [_] => Ok(()),
        [first, .., last] if *first <= 420.0 && *last >= 680.0 && wavelengths.is_sorted_by(|a, b| a < b) => {
            Ok(())
        }
        _ => Err(ExportError::Wavelengths),
    }
}

/// The text of the table: θ and φ of light and of the scattered direction [°], f [1/sr] at each wavelength. Discrete
/// directions have no f: their flux is spread over the cell that they lie in.
///
/// # Errors
/// When cells or directions of incidence form no grid.
pub fn material_table(name: &str, reading: &Reading) -> Result<String, ExportError> {
    check_table_wavelengths(&reading.wavelengths)?;
    let n_phi = reading.grid.even_azimuths().filter(|n| *n >= 4).ok_or(ExportError::Cells)?;
    let incidence = incidence(reading)?;
    let bounds: Vec<f64> =
        std::iter::once(0.0).chain(reading.grid.rings().iter().map(|r| r.theta[1])).collect();
    let height = 90.0 / (bounds.len() - 1) as f64;
    // Fine enough for straight lines between nodes, and not much longer.
    let parts = if height > 7.0 {
        3
    } else if height > 3.5 {
        2
    } else {
        1
    };
    let pole = if n_phi % 2 == 0 { Pole::Open } else { Pole::Barred };
    let polar = Polar::new(&bounds, parts, pole);
    let around = Around::new(n_phi, parts);
    let passes = reading.beams.iter().flat_map(|b| &b.spectra).any(|s| !s.transmitted.is_empty());
    let sides = if passes { &[Side::Reflection, Side::Transmission][..] } else { &[Side::Reflection] };

    let mut text = format!("# {}: measured by a virtual goniophotometer\n", name.replace(['\n', '\r'], " "));
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "# light from the {}; means over {} x {n_phi} cells a hemisphere are kept by {parts} x {parts} nodes in each; discrete \
         directions are spread over their cells",
        reading.face.name(),
        bounds.len() - 1
    );
    if let [only] = reading.wavelengths.as_slice() {
        let _ = writeln!(text, "# read at {only} nm and held for all wavelengths");
    }
    text.push_str("theta_i [deg], phi_i [deg], theta_o [deg], phi_o [deg]");
    match reading.wavelengths.as_slice() {
        [_] => text.push_str(", f [1/sr]"),
        several => several.iter().for_each(|l| {
            let _ = write!(text, ", f_{l}nm [1/sr]");
        }),
    }
    text.push('\n');
    for (angles, beam) in incidence.iter().zip(&reading.beams) {
        for &side in sides {
            let spectra: Vec<Vec<f64>> = beam
                .spectra
                .iter()
                .map(|scattered| {
                    let flux = |cell: usize| {
                        scattered.cells(side).get(cell).map_or(0.0, |c: &CellFlux| c.total().value)
                    };
                    let means = (0..reading.grid.len())
                        .map(|c| flux(c).max(0.0) / reading.grid.projected_solid_angle(c))
                        .collect::<Vec<_>>();
                    nodes(&means, &polar, &around)
                })
                .collect();
            for (i, theta) in polar.nodes.iter().enumerate() {
                let theta = if side == Side::Reflection { *theta } else { 180.0 - theta };
                for (k, phi) in around.nodes.iter().enumerate() {
                    let _ = write!(
                        text,
                        "{},{},{},{}",
                        shown(angles.theta),
                        shown(angles.phi),
                        shown(theta),
                        shown(*phi)
                    );
                    for spectrum in &spectra {
                        let _ = write!(text, ",{}", value(spectrum[i * around.nodes.len() + k]));
                    }
                    text.push('\n');
                }
            }
        }
    }
    Ok(text)
}

/// The directions of incidence, which form a grid that the reader takes.
fn incidence(reading: &Reading) -> Result<Vec<Angles>, ExportError> {
    let mut all = Vec::with_capacity(reading.beams.len());
    for beam in &reading.beams {
        let Incidence::Direction(angles) = beam.incidence else { return Err(ExportError::Incidence) };
        if beam.spectra.len() != reading.wavelengths.len() {
            return Err(ExportError::Incomplete);
        }
        all.push(angles);
    }
    let distinct = |of: fn(&Angles) -> f64| {
        let mut values: Vec<f64> = all.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let (theta, phi) = (distinct(|a| a.theta), distinct(|a| a.phi));
    let gap = phi.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    let closing = phi.first().zip(phi.last()).map_or(0.0, |(first, last)| first + 360.0 - last);
    let around = phi.len() == 1 || phi.len() >= 4 && gap.max(closing) <= 91.0;
    match theta.len() * phi.len() == all.len() && !all.is_empty() && around {
        true => Ok(all),
        false => Err(ExportError::Incidence),
    }
}

fn shown(angle: f64) -> String {
    let rounded = (angle * 1e4).round() / 1e4;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

fn value(f: f64) -> String {
    if f < 1e-12 { "0".to_owned() } else { format!("{f:.5e}") }
}

/// Values at the nodes, polar angle by polar angle, whose interpolation has the given means over cells.
fn nodes(means: &[f64], polar: &Polar, around: &Around) -> Vec<f64> {
    let (sectors, width) = (around.cells, around.nodes.len());
    // Around each ring first, then from the pole outwards.
    let rows: Vec<f64> = means
        .chunks(sectors)
        .flat_map(|ring| {
            (0..width).map(|k| {
                let (sector, stencil) = (k / around.parts, &around.stencils[k % around.parts]);
                let at = |j: usize| ring[(sector + sectors + j - stencil.len() / 2) % sectors];
                stencil.iter().enumerate().map(|(j, c)| c * at(j)).sum::<f64>()
            })
        })
        .collect();
    let mut values = Vec::with_capacity(polar.nodes.len() * width);
    for (start, stencil) in &polar.stencils {
        for k in 0..width {
            // Beyond the pole lie the rings themselves, from the other side.
            let at = |ring: i64| match usize::try_from(ring) {
                Ok(ring) => rows[ring * width + k],
                Err(_) => rows[(-1 - ring) as usize * width + (k + width / 2) % width],
            };
            let value: f64 = stencil.iter().zip(*start..).map(|(c, ring)| c * at(ring)).sum();
            values.push(value.max(0.0));
        }
    }
    for _ in 0..ROUNDS {
        for (cell, interpolated) in cell_means(&values, polar, around).into_iter().enumerate() {
            let (ring, sector) = (cell / sectors, cell % sectors);
            let factor = if interpolated > 0.0 { means[cell] / interpolated } else { 1.0 };
            for a in 0..polar.parts {
                for b in 0..around.parts {
                    values[(ring * polar.parts + a) * width + sector * around.parts + b] *= factor;
                }
            }
        }
    }
    values
}

/// Coefficients by which `count` means, weighted over the intervals [start, start + 1] and so on, make the value at `at` of the
/// polynomial that has these means.
fn stencil(start: i64, count: usize, at: f64, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    /// Points of the midpoint rule.
    const MIDPOINTS: usize = 64;
    // One equation for each power of x − at: its mean over each interval, and its value at `at`.
    let mut rows: Vec<Vec<f64>> =
        (0..count).map(|power| vec![if power == 0 { 1.0 } else { 0.0 }; count + 1]).collect();
    for j in 0..count {
        let mut sum = 0.0;
        let mut moments = vec![0.0; count];
        for i in 0..MIDPOINTS {
            let x = start as f64 + j as f64 + (i as f64 + 0.5) / MIDPOINTS as f64;
            let mut term = weight(x);
            sum += term;
            for moment in &mut moments {
                *moment += term;
                term *= x - at;
            }
        }
        for (row, moment) in rows.iter_mut().zip(&moments) {
            row[j] = moment / sum;
        }
    }
    // Gauß–Jordan with the largest pivot.
    for column in 0..count {
        let largest = |a: &usize, b: &usize| rows[*a][column].abs().total_cmp(&rows[*b][column].abs());
        let pivot = (column..count).max_by(largest).unwrap_or(column);
        rows.swap(column, pivot);
        let scale = rows[column][column];
        rows[column].iter_mut().for_each(|x| *x /= scale);
        let own = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(other, _)| *other != column) {
            let factor = row[column];
            row.iter_mut().zip(&own).for_each(|(x, own)| *x -= factor * own);
        }
    }
    rows.iter().map(|row| row[count]).collect()
}

/// Means over cells of what the renderer interpolates.
fn cell_means(values: &[f64], polar: &Polar, around: &Around) -> Vec<f64> {
    let width = around.nodes.len();
    // Around each circle of nodes first.
    let rows: Vec<Vec<f64>> = values
        .chunks(width)
        .map(|row| {
            let mean = |weights: &Vec<(usize, f64)>| weights.iter().map(|(k, w)| w * row[*k]).sum();
            around.weights.iter().map(mean).collect()
        })
        .collect();
    let of = |ring: usize, sector: usize| polar.weights[ring].iter().map(|(i, w)| w * rows[*i][sector]).sum();
    (0..polar.cells)
        .flat_map(|ring| (0..around.cells).map(move |sector| (ring, sector)))
        .map(|(r, s)| of(r, s))
        .collect()
}

/// Nodes of the polar angle, and their shares in the means over rings.
struct Polar {
    cells: usize,
    parts: usize,
    nodes: Vec<f64>,
    weights: Vec<Vec<(usize, f64)>>,
    /// First ring, negative beyond the pole, and coefficients of each node.
    stencils: Vec<(i64, Vec<f64>)>,
}

impl Polar {
    /// Of equal rings. Whether stencils may reach across the pole: opposite nodes then exist.
    fn new(bounds: &[f64], parts: usize, pole: Pole) -> Self {
        let cells = bounds.len() - 1;
        let height = 90.0 / cells as f64;
        let count = STENCIL.min(cells);
        let stencils = (0..cells * parts).map(|i| {
            let first = (i / parts) as i64 - count as i64 / 2;
            let first = if pole == Pole::Barred { first.max(0) } else { first };
            let first = first.min((cells - count) as i64);
            let at = (i as f64 + 0.5) / parts as f64;
            (first, stencil(first, count, at, |x| (2.0 * height * x).to_radians().sin().abs()))
        });
        let stencils = stencils.collect();
        let node = |i: usize| {
            let (lo, hi) = (bounds[i / parts], bounds[i / parts + 1]);
            lo + (hi - lo) * ((i % parts) as f64 + 0.5) / parts as f64
        };
        let nodes: Vec<f64> = (0..cells * parts).map(node).collect();
        let last = nodes.len() - 1;
        let weights = (0..cells).map(|cell| {
            let mut weights = vec![0.0; nodes.len()];
            let mut sum = 0.0;
            let n = POINTS * (parts + 1);
            for j in 0..n {
                let theta = bounds[cell] + (bounds[cell + 1] - bounds[cell]) * (j as f64 + 0.5) / n as f64;
                let (sin, cos) = theta.to_radians().sin_cos();
                // The ends are held.
                let next = nodes.partition_point(|x| *x <= theta);
                let (a, b) = (next.saturating_sub(1), next.min(last));
                let share = if b > a { (theta - nodes[a]) / (nodes[b] - nodes[a]) } else { 0.0 };
                weights[a] += sin * cos * (1.0 - share);
                weights[b] += sin * cos * share;
                sum += sin * cos;
            }
            sparse(&weights, sum)
        });
        let weights = weights.collect();
        Self { cells, parts, nodes, weights, stencils }
    }
}

/// Whether what lies beyond the pole is known.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pole {
    Open,
    Barred,
}

/// Nodes of the azimuth, and their shares in the means over sectors.
struct Around {
    cells: usize,
    parts: usize,
    nodes: Vec<f64>,
    weights: Vec<Vec<(usize, f64)>>,
    /// Coefficients of the nodes of a cell, for as many cells around it.
    stencils: Vec<Vec<f64>>,
}

impl Around {
    fn new(cells: usize, parts: usize) -> Self {
        let count = cells * parts;
        let step = 360.0 / count as f64;
        // The middle of the first cell lies at zero.
        let first = 0.5 * step * (1.0 - parts as f64);
        let nodes = (0..count).map(|k| first + k as f64 * step).collect();
        let weights = (0..cells).map(|cell| {
            let mut weights = vec![0.0; count];
            let n = 2 * POINTS * parts;
            for j in 0..n {
                // In steps from the first node; a cell reaches half a step beyond its outer nodes.
                let x = (cell * parts) as f64 - 0.5 + parts as f64 * (j as f64 + 0.5) / n as f64;
                let (floor, share) = (x.floor(), x - x.floor());
                let at = |i: i64| i.rem_euclid(count as i64) as usize;
                weights[at(floor as i64)] += 1.0 - share;
                weights[at(floor as i64 + 1)] += share;
            }
            sparse(&weights, n as f64)
        });
        let weights = weights.collect();
        // As many on either side.
        let count = STENCIL.min((cells - 1) / 2 * 2 + 1);
        let start = -(count as i64) / 2;
        let stencils =
            (0..parts).map(|b| stencil(start, count, (b as f64 + 0.5) / parts as f64, |_| 1.0)).collect();
        Self { cells, parts, nodes, weights, stencils }
    }
}

fn sparse(weights: &[f64], sum: f64) -> Vec<(usize, f64)> {
    weights.iter().enumerate().filter(|(_, w)| **w > 0.0).map(|(i, w)| (i, w / sum)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_between_nodes_keeps_the_means_of_cells() {
        let bounds: Vec<f64> = (0..=9).map(|i| 10.0 * f64::from(i)).collect();
        let (polar, around) = (Polar::new(&bounds, 3, Pole::Open), Around::new(24, 3));
        // A lobe of about two cells beside darkness.
        let means: Vec<f64> = (0..9 * 24)
            .map(|c| {
                let (ring, sector) = ((c / 24) as f64 - 4.0, (c % 24) as f64 - 12.0);
                (-(ring * ring + 0.5 * sector * sector)).exp()
            })
            .collect();
        let values = nodes(&means, &polar, &around);
        assert!(values.iter().all(|v| *v >= 0.0));
        let total: f64 = means.iter().sum();
        for (cell, (a, b)) in cell_means(&values, &polar, &around).iter().zip(&means).enumerate() {
            // Darkness beside a lobe as narrow as this one keeps what is interpolated across its edge.
            assert!((a - b).abs() < 3e-4 * total, "{cell}: {a} {b}");
        }
        // A constant stays one.
        let flat = nodes(&vec![0.7; 9 * 24], &polar, &around);
        assert!(flat.iter().all(|v| (v - 0.7).abs() < 1e-9));
    }

    #[test]
    fn a_stencil_finds_the_polynomial_that_the_means_are_of() {
        // The mean of x³ over [a, a + 1], weighted with x: (b⁵ − a⁵)/5 over (b² − a²)/2.
        let mean = |a: f64| (((a + 1.0).powi(5) - a.powi(5)) / 5.0) / (((a + 1.0).powi(2) - a * a) / 2.0);
        for at in [2.1, 3.5, 4.9] {
            let value: f64 =
                stencil(1, 5, at, |x| x).iter().zip(1..).map(|(c, a)| c * mean(f64::from(a))).sum();
            assert!((value / at.powi(3) - 1.0).abs() < 1e-3, "{at}: {value}");
        }
    }

    #[test]
    fn a_lobe_of_two_cells_is_found_between_its_means() {
        // cos²⁰ of the angle to 45°, 180°: half of the maximum is 30° wide, two cells along the azimuth.
        let f = |theta: f64, phi: f64| {
            let (t, p) = (theta.to_radians(), (phi - 180.0).to_radians());
            let cos = 0.5_f64.sqrt() * (t.cos() + t.sin() * p.cos());
            cos.max(0.0).powi(20)
        };
        let bounds: Vec<f64> = (0..=9).map(|i| 10.0 * f64::from(i)).collect();
        let (polar, around) = (Polar::new(&bounds, 3, Pole::Open), Around::new(24, 3));
        let mean = |cell: usize| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for i in 0..1600 {
                let theta = 10.0 * ((cell / 24) as f64 + ((i / 40) as f64 + 0.5) / 40.0);
                let phi = 15.0 * ((cell % 24) as f64 + ((i % 40) as f64 + 0.5) / 40.0 - 0.5);
                let weight = (2.0 * theta).to_radians().sin();
                sum += weight * f(theta, phi);
                weights += weight;
            }
            sum / weights
        };
        let means: Vec<f64> = (0..216).map(mean).collect();
        let values = nodes(&means, &polar, &around);
        for (i, theta) in polar.nodes.iter().enumerate() {
            for (k, phi) in around.nodes.iter().enumerate() {
                let value = values[i * around.nodes.len() + k];
                // A mean in the middle of the lobe's cell would be 8 % low.
                assert!(
                    (value - f(*theta, *phi)).abs() < 0.015,
                    "{theta} {phi}: {value} {}",
                    f(*theta, *phi)
                );
            }
        }
    }
}
