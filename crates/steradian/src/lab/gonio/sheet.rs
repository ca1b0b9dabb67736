//! Readings as a table and as a plot.

use super::super::plot::{Curve, Dash, Drawing, Heading, Polar, Ray, Scale, Zero, series_ink};
use super::super::probe::Angles;
use super::super::table::{Cell as Entry, Column, Table};
use super::beam::Incidence;
use super::reading::{Beam, Reading, Scattered};
use super::reciprocity::{Reciprocity, Residual};
use crate::bsdf::Side;
use crate::math::LocalDir;
use crate::units::Estimate;

/// Most curves of a plot.
const MOST_CURVES: usize = 12;

/// How much a table holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// A row for each cell.
    Cells,
    /// Rows of whole hemispheres only.
    Hemispheres,
}

/// The readings, one row for each incidence, wavelength and cell: f̄, s and flux of what was scattered into a continuum, and
/// a row of its own for the flux of discrete directions in a cell. Rows of whole hemispheres hold ρ and τ, and those of a
/// piece of geometry what was absorbed, lost, or left by its sides.
///
/// θ counts from the normal of the side that light comes to, and is above 90° for transmission. `sample` says what was
/// measured; `reciprocity` is what [`super::reciprocity()`] found.
pub fn table(sample: &str, reading: &Reading, reciprocity: Option<&[Reciprocity]>, detail: Detail) -> Table {
    let angle = |name: &str| Column::new(name, "deg");
    let columns = vec![
        Column::new("wavelength", "nm"),
        angle("theta_i"),
        angle("phi_i"),
        Column::words("light"),
        angle("theta_o from"),
        angle("theta_o to"),
        angle("phi_o from"),
        angle("phi_o to"),
        Column::new("f", "1/sr"),
        Column::new("s", "1/sr"),
        Column::new("flux", "1"),
    ];
    let mut table = Table::new(format!("goniophotometer: {sample}"), columns);
    facts(&mut table, reading, reciprocity);
    for beam in &reading.beams {
        let from = beam.incidence.angles(&reading.grid);
        for (lambda, scattered) in reading.wavelengths.iter().zip(&beam.spectra) {
            let start = |light: &str| -> Vec<Entry> {
                vec![f64::from(*lambda).into(), from.theta.into(), from.phi.into(), light.into()]
            };
            totals(&mut table, scattered, &start);
            if detail == Detail::Cells {
                cells(&mut table, reading, scattered, &start);
            }
        }
    }
    table
}

fn totals(table: &mut Table, scattered: &Scattered, start: &impl Fn(&str) -> Vec<Entry>) {
    let whole = |name: &str, [from, to]: [f64; 2], flux: Estimate| {
        let mut row = start(name);
        row.extend([from.into(), to.into(), Entry::Number(0.0), Entry::Number(360.0)]);
        row.extend([Entry::Missing, Entry::Missing, flux.into()]);
        row
    };
    table.rows.push(whole("all reflected", [0.0, 90.0], scattered.reflectance));
    table.rows.push(whole("all transmitted", [90.0, 180.0], scattered.transmittance));
    if let Some(rest) = &scattered.rest {
        let parts = [
            ("absorbed", rest.absorbed),
            ("lost", rest.lost),
            ("left by the sides", rest.edge),
            ("sum", rest.sum),
        ];
        for (name, flux) in parts {
            let mut row = start(name);
            row.extend(std::iter::repeat_n(Entry::Missing, 6));
            row.push(flux.into());
            table.rows.push(row);
        }
    }
}

fn cells(table: &mut Table, reading: &Reading, scattered: &Scattered, start: &impl Fn(&str) -> Vec<Entry>) {
    for side in [Side::Reflection, Side::Transmission] {
        for (index, flux) in scattered.cells(side).iter().enumerate() {
            let cell = reading.grid.cell(index);
            let theta = match side {
                Side::Reflection => cell.theta,
                Side::Transmission => [180.0 - cell.theta[1], 180.0 - cell.theta[0]],
            };
            let place = [theta[0], theta[1], cell.phi[0], cell.phi[1]].map(Entry::Number);
            let mut row = start("scattered");
            row.extend(place.clone());
            row.push(reading.mean_f(index, flux.continuous).into());
            let s = scattered.probability(flux, cell.solid_angle());
            row.push(s.map_or(Entry::Missing, Into::into));
            row.push(flux.continuous.into());
            table.rows.push(row);
            if flux.discrete.value > 0.0 {
                let mut row = start("discrete");
                row.extend(place);
                row.extend([Entry::Missing, Entry::Missing, flux.discrete.into()]);
                table.rows.push(row);
            }
        }
    }
}

fn facts(table: &mut Table, reading: &Reading, reciprocity: Option<&[Reciprocity]>) {
    let Reading { grid, precision, .. } = reading;
    let shape = match grid.even_azimuths() {
        Some(n) => format!("{} rings of {n} cells", grid.rings().len()),
        None => format!("{} cells in {} rings", grid.len(), grid.rings().len()),
    };
    table.fact("cells", format!("{shape} a hemisphere, the first of each ring centred on azimuth 0"));
    table.fact("light on", format!("the {} of the sample", reading.face.name()));
    table.fact(
        "f",
        "mean over the cell weighted with the cosine: flux in the cell / (incident flux · projected solid angle)",
    );
    table.fact("s", "share of the scattered flux per solid angle; integrates to 1 with discrete directions");
    table.fact("flux", "shares of the incident flux");
    let method =
        reading.method.map_or("photons followed through the geometry", super::material::Method::name);
    table.fact("method", method);
    table.fact("confidence", format!("{} %, statistical only", 100.0 * precision.confidence));
    table.fact("rays", reading.rays.to_string());
    table.fact("ending", reading.ending.name());
    for (lambda, found) in reading.wavelengths.iter().zip(reciprocity.into_iter().flatten()) {
        let said = |r: &Residual| {
            format!(
                "worst difference {:.2} and root mean square {:.2} standard errors over {} pairs of cells; root mean square {:.3} % \
                 of f",
                r.worst,
                r.rms,
                r.pairs,
                100.0 * r.relative
            )
        };
        table.fact(format!("reciprocity of reflection at {lambda} nm"), said(&found.reflection));
        if let Some(transmission) = &found.transmission {
            table.fact(format!("reciprocity of transmission at {lambda} nm"), said(transmission));
        }
    }
}

/// f̄ over the angle to the normal in the plane of incidence, light coming from the left, for at most twelve curves; arrows
/// are discrete directions, as long as their share of the flux.
pub fn plot(sample: &str, reading: &Reading) -> Drawing {
    let count = reading.beams.len() * reading.wavelengths.len();
    let stride = count.div_ceil(MOST_CURVES).max(1);
    let all = reading
        .beams
        .iter()
        .flat_map(|beam| beam.spectra.iter().zip(&reading.wavelengths).map(move |(s, l)| (beam, s, *l)));
    let (mut curves, mut rays) = (Vec::new(), Vec::new());
    for (number, (beam, scattered, lambda)) in all.step_by(stride).enumerate() {
        let from = beam.incidence.angles(&reading.grid);
        let ink = series_ink(number);
        let spread = if beam.incidence.is_spread() { "around " } else { "" };
        let label = format!("{lambda} nm, from {spread}{:.1}°, {:.1}°", from.theta, from.phi);
        for (piece, points) in profile(reading, beam, scattered).into_iter().enumerate() {
            let label = if piece == 0 { label.clone() } else { String::new() };
            let dash = Dash::ALL[number / 6 % Dash::ALL.len()];
            curves.push(Curve::new(label, ink, points).dashed(dash));
        }
        rays.push(Ray { angle: -from.theta, length: 0.95, heading: Heading::In, ink });
        for side in [Side::Reflection, Side::Transmission] {
            for (index, flux) in
                scattered.cells(side).iter().enumerate().filter(|(_, c)| c.discrete.value > 0.0)
            {
                let [theta, phi] = reading.grid.cell(index).centre();
                let forward = (phi - from.phi).to_radians().cos() <= 0.0;
                let angle = if side == Side::Reflection { theta } else { 180.0 - theta };
                let angle = if forward { angle } else { -angle };
                rays.push(Ray { angle, length: flux.discrete.value.min(1.0), heading: Heading::Out, ink });
            }
        }
    }
    let radius = "mean f of a cell [1/sr]".to_owned();
    Polar {
        title: format!("goniophotometer: {sample}"),
        radius,
        scale: Scale::Linear,
        zero: Zero::Top,
        curves,
        rays,
    }
    .draw()
}

/// Readings along the plane of incidence, of each side.
fn profile(reading: &Reading, beam: &Beam, scattered: &Scattered) -> Vec<Vec<[f64; 2]>> {
    let from = match beam.incidence {
        Incidence::Direction(angles) => angles.phi,
        Incidence::Cell(_) => beam.incidence.angles(&reading.grid).phi,
    };
    let sides =
        [Side::Reflection, Side::Transmission].into_iter().filter(|s| !scattered.cells(*s).is_empty());
    sides
        .map(|side| {
            let rings = reading.grid.rings().iter().map(|r| 0.5 * (r.theta[0] + r.theta[1]));
            let at = |theta: f64, forward: bool| {
                let phi = if forward { from + 180.0 } else { from };
                let towards: LocalDir = Angles { theta, phi }.direction();
                let cell = reading.grid.index(towards);
                let f =
                    scattered.cells(side).get(cell).map_or(0.0, |c| reading.mean_f(cell, c.continuous).value);
                let angle = if side == Side::Reflection { theta } else { 180.0 - theta };
                [if forward { angle } else { -angle }, f]
            };
            let mut points: Vec<[f64; 2]> = rings.clone().map(|t| at(t, false)).collect();
            points.reverse();
            points.extend(rings.map(|t| at(t, true)));
            points
        })
        .collect()
}
