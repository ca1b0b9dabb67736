//! The luxmeter: irradiance at points, with ideal cosine response, A (17), (30).

use super::super::session::Session;
use super::super::table::{Cell, Column, Table};
use super::bench::{self, Efficacies, Raw, Response};
use super::contract::{
    DEFAULT_MAX_DEPTH, Effort, MeterError, Shown, check_wavelengths, metering, normal, place,
};
use super::facts::facts;
use crate::integrator::SensorPoint;
use crate::scene::RenderJob;
use crate::spectrum::photometry;
use crate::units::kind::{Irradiance, Radiant, Unit};
use crate::units::{Illuminance, Measured, SpectralIrradiance};

/// Where a meter lies and which way it faces, in the scene's world.
///
/// A meter has no extent and is no obstacle. One that lies on a surface, within a millionth of its largest coordinate, reads what
/// arrives on the side of its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeterPoint {
    /// Position [scene units].
    pub position: [f64; 3],
    /// Normal of the sensor, of any length but 0: only light from the hemisphere around it counts.
    pub normal: [f64; 3],
}

/// Which numbers must be as precise as the session asks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aim {
    /// The irradiance.
    #[default]
    Total,
    /// Its direct and its indirect part, each for itself.
    Parts,
}

/// How a luxmeter measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LuxSettings {
    /// Most bounces of light on its way from a source; 0 for direct light alone.
    pub max_depth: u32,
    /// When to stop.
    pub aim: Aim,
}

impl Default for LuxSettings {
    fn default() -> Self {
        Self { max_depth: DEFAULT_MAX_DEPTH, aim: Aim::Total }
    }
}

/// What a meter shows at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct LuxReading<Q = Illuminance> {
    /// All that arrives.
    pub total: Q,
    /// What arrives from lights past nothing that scatters it.
    pub direct: Q,
    /// What was reflected or refracted at least once on its way.
    pub indirect: Q,
    /// What the reading took.
    pub effort: Effort,
}

/// Irradiance over 360–830 nm [W·m⁻²].
pub type RadiantIrradiance = Measured<Irradiance, Radiant>;

/// Illuminance [lx] at each of the points, one after the other, each as precise as the session asks.
///
/// The list of readings is shorter than that of the points when the session is cancelled.
///
/// # Errors
/// When the scene is for legacy shading, or a point has no place or no normal.
pub fn measure(
    job: &RenderJob,
    points: &[MeterPoint],
    settings: &LuxSettings,
    session: &Session<'_>,
) -> Result<Vec<LuxReading>, MeterError> {
    measure_weighted(job, points, settings, session)
}

/// Irradiance as the eye by day or night, or one of its receptors, weighs it: the domain `D` says which; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_weighted<D: photometry::Response>(
    job: &RenderJob,
    points: &[MeterPoint],
    settings: &LuxSettings,
    session: &Session<'_>,
) -> Result<Vec<LuxReading<Measured<Irradiance, D>>>, MeterError>
where
    Irradiance: Unit<D>,
{
    let response = Efficacies::of::<D>();
    read(job, points, settings, session, Response::Weighted(&response), |raw, part| {
        Measured::new(raw.single(part))
    })
}

/// Irradiance [W·m⁻²] over 360–830 nm at each of the points; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_radiant(
    job: &RenderJob,
    points: &[MeterPoint],
    settings: &LuxSettings,
    session: &Session<'_>,
) -> Result<Vec<LuxReading<RadiantIrradiance>>, MeterError> {
    read(job, points, settings, session, Response::Radiant, |raw, part| {
        RadiantIrradiance::new(raw.single(part))
    })
}

/// Spectral irradiance [W·m⁻²·nm⁻¹] at each of the points and each of the wavelengths [nm], all of them as precise as the session asks;
/// as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`], and when there is no wavelength, or one for which a material of the scene has no data.
pub fn measure_spectral(
    job: &RenderJob,
    points: &[MeterPoint],
    wavelengths: &[f32],
    settings: &LuxSettings,
    session: &Session<'_>,
) -> Result<Vec<LuxReading<Vec<SpectralIrradiance>>>, MeterError> {
    check_wavelengths(job, wavelengths)?;
    read(job, points, settings, session, Response::Lines(wavelengths), |raw, part| {
        raw.all(part).map(SpectralIrradiance::new).collect()
    })
}

fn read<Q>(
    job: &RenderJob,
    points: &[MeterPoint],
    settings: &LuxSettings,
    session: &Session<'_>,
    response: Response<'_>,
    show: impl Fn(&Raw<3>, usize) -> Q,
) -> Result<Vec<LuxReading<Q>>, MeterError> {
    let integrator = metering(job, settings.max_depth)?;
    let time = job.scene.camera().shutter()[0];
    let sensor = |(i, point): (usize, &MeterPoint)| {
        Ok(SensorPoint { p: place(job, i, point.position)?, n: normal(job, i, point.normal)?, time })
    };
    let sensors: Vec<SensorPoint> = points.iter().enumerate().map(sensor).collect::<Result<_, _>>()?;
    // Total, direct, indirect.
    let wanted: &[usize] = match settings.aim {
        Aim::Total => &[0],
        Aim::Parts => &[1, 2],
    };
    let mut readings = Vec::with_capacity(sensors.len());
    for (sensor, stream) in sensors.iter().zip(0..) {
        if session.cancel.is_cancelled() {
            break;
        }
        let raw = bench::measure(session, stream, response, wanted, |w, sampler, tally| {
            let arriving = integrator.irradiance(&job.scene, sensor, w, sampler, tally);
            [arriving.direct + arriving.indirect, arriving.direct, arriving.indirect]
        });
        let part = |part| show(&raw, part);
        readings.push(LuxReading { total: part(0), direct: part(1), indirect: part(2), effort: raw.effort });
    }
    Ok(readings)
}

/// Which numbers a table has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// The irradiance.
    Total,
    /// Its direct and its indirect part besides.
    Split,
}

/// The readings of the first points as a table: a row for each point, or for each point and wavelength [nm].
pub fn table<Q: Shown>(
    points: &[MeterPoint],
    readings: &[LuxReading<Q>],
    wavelengths: &[f32],
    layout: Layout,
    settings: &LuxSettings,
    session: &Session<'_>,
) -> Table {
    let mut columns = vec![Column::words("point")];
    columns.extend(["x", "y", "z"].map(|name| Column::new(name, "scene units")));
    columns.extend(["nx", "ny", "nz"].map(|name| Column::new(name, "1")));
    if !wavelengths.is_empty() {
        columns.push(Column::new("wavelength", "nm"));
    }
    columns.push(Column::new(Q::NAME, Q::UNIT));
    if layout == Layout::Split {
        columns.push(Column::new(format!("direct {}", Q::NAME), Q::UNIT));
        columns.push(Column::new(format!("indirect {}", Q::NAME), Q::UNIT));
    }
    columns.push(Column::words("rays"));
    let notes = readings.iter().any(|r| r.effort.note().is_some());
    if notes {
        columns.push(Column::words("note"));
    }
    let mut table = Table::new(Q::NAME, columns);
    for (i, (point, reading)) in points.iter().zip(readings).enumerate() {
        let parts = [&reading.total, &reading.direct, &reading.indirect].map(Shown::estimates);
        for line in 0..parts[0].len() {
            let mut row = vec![Cell::Number((i + 1) as f64)];
            row.extend(point.position.into_iter().chain(point.normal).map(Cell::Number));
            row.extend(wavelengths.get(line).map(|&l| Cell::Number(f64::from(l))));
            let shown = if layout == Layout::Split { &parts[..] } else { &parts[..1] };
            row.extend(shown.iter().map(|part| Cell::Estimate(part[line])));
            row.push(Cell::Number(reading.effort.rays as f64));
            if notes {
                row.push(reading.effort.note().map_or(Cell::Missing, Cell::Text));
            }
            table.rows.push(row);
        }
    }
    table.fact(
        "instrument",
        "flat sensor without extent, ideal cosine response over the hemisphere around its normal",
    );
    facts(&mut table, readings.iter().map(|r| &r.effort), points.len(), settings.max_depth, session);
    table
}
