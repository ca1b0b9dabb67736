//! The luminance meter: mean radiance over a cone of directions and an entrance pupil, A (21).
//!
//! A meter sees what a camera in its place would see, and no more: point, spot and distant lights have no surface that it
//! could look at, and only what they illuminate counts.

use super::super::session::Session;
use super::super::table::{Cell, Column, Table};
use super::bench::{self, Efficacies, Raw, Response};
use super::contract::{
    DEFAULT_MAX_DEPTH, Effort, MeterError, Shown, check_wavelengths, direction, metering, place,
};
use super::facts::facts;
use crate::math::warp::{concentric_disk, uniform_cone};
use crate::math::{Dir, Frame, LocalDir, Point, Ray, Vec2};
use crate::sampler::Sampler;
use crate::scene::RenderJob;
use crate::spectrum::photometry;
use crate::units::kind::{Radiant, Spectral, Unit};
use crate::units::{Luminance, Measured, Radiance};

/// Where a meter stands and where it looks, in the scene's world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeterRay {
    /// Centre of the entrance pupil [scene units].
    pub position: [f64; 3],
    /// Axis of the field of view, of any length but 0.
    pub direction: [f64; 3],
}

/// How a luminance meter measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuminanceSettings {
    /// Most bounces of light on its way from a source; 0 for sources alone.
    pub max_depth: u32,
    /// Full angle of the cone that the meter accepts [degrees], in [0, 180]; 0 for a single direction.
    ///
    /// All directions of the cone count alike.
    pub acceptance: f64,
    /// Radius of the entrance pupil [scene units], a disk across the axis; 0 for a point. All points of it count alike.
    pub aperture: f64,
}

impl Default for LuminanceSettings {
    /// A spot meter of 1° without extent.
    fn default() -> Self {
        Self { max_depth: DEFAULT_MAX_DEPTH, acceptance: 1.0, aperture: 0.0 }
    }
}

/// What a meter shows in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct LuminanceReading<Q = Luminance> {
    /// The mean over cone and pupil.
    pub mean: Q,
    /// What the reading took.
    pub effort: Effort,
}

/// Radiance over 360–830 nm [W·m⁻²·sr⁻¹].
pub type RadiantRadiance = Measured<Radiance, Radiant>;
/// L_λ [W·m⁻²·sr⁻¹·nm⁻¹].
pub type SpectralRadiance = Measured<Radiance, Spectral>;

/// Luminance [cd·m⁻²] along each of the rays, one after the other, each as precise as the session asks.
///
/// The list of readings is shorter than that of the rays when the session is cancelled.
///
/// # Errors
/// When the scene is for legacy shading, a ray has no place or no direction, or the meter is impossible.
pub fn measure(
    job: &RenderJob,
    rays: &[MeterRay],
    settings: &LuminanceSettings,
    session: &Session<'_>,
) -> Result<Vec<LuminanceReading>, MeterError> {
    measure_weighted(job, rays, settings, session)
}

/// Radiance as the eye by day or night, or one of its receptors, weighs it: the domain `D` says which; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_weighted<D: photometry::Response>(
    job: &RenderJob,
    rays: &[MeterRay],
    settings: &LuminanceSettings,
    session: &Session<'_>,
) -> Result<Vec<LuminanceReading<Measured<Radiance, D>>>, MeterError>
where
    Radiance: Unit<D>,
{
    let response = Efficacies::of::<D>();
    read(job, rays, settings, session, Response::Weighted(&response), |raw| Measured::new(raw.single(0)))
}

/// Radiance [W·m⁻²·sr⁻¹] over 360–830 nm along each of the rays; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_radiant(
    job: &RenderJob,
    rays: &[MeterRay],
    settings: &LuminanceSettings,
    session: &Session<'_>,
) -> Result<Vec<LuminanceReading<RadiantRadiance>>, MeterError> {
    read(job, rays, settings, session, Response::Radiant, |raw| RadiantRadiance::new(raw.single(0)))
}

/// Spectral radiance [W·m⁻²·sr⁻¹·nm⁻¹] along each of the rays and at each of the wavelengths [nm], all of them as precise as the session
/// asks; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`], and when there is no wavelength, or one for which a material of the scene has no data.
pub fn measure_spectral(
    job: &RenderJob,
    rays: &[MeterRay],
    wavelengths: &[f32],
    settings: &LuminanceSettings,
    session: &Session<'_>,
) -> Result<Vec<LuminanceReading<Vec<SpectralRadiance>>>, MeterError> {
    check_wavelengths(job, wavelengths)?;
    read(job, rays, settings, session, Response::Lines(wavelengths), |raw| {
        raw.all(0).map(SpectralRadiance::new).collect()
    })
}

/// A meter in render space.
#[derive(Clone, Copy, Debug)]
struct Spot {
    pupil: Point,
    frame: Frame,
    radius: f32,
    /// 1 − cos of half the acceptance angle.
    one_minus_cos: f32,
    time: f32,
}

impl Spot {
    fn ray(&self, sampler: &mut Sampler) -> Ray {
        let (u_pupil, u_cone): (Vec2, Vec2) = (sampler.next_2d(), sampler.next_2d());
        let on_pupil = self.radius * concentric_disk(u_pupil);
        let o = self.pupil + (self.frame.s * on_pupil.x + self.frame.t * on_pupil.y);
        let local = LocalDir::new_unchecked(uniform_cone(u_cone, self.one_minus_cos));
        Ray { o, d: *self.frame.to_world(local), time: self.time }
    }
}

fn read<Q>(
    job: &RenderJob,
    rays: &[MeterRay],
    settings: &LuminanceSettings,
    session: &Session<'_>,
    response: Response<'_>,
    show: impl Fn(&Raw<1>) -> Q,
) -> Result<Vec<LuminanceReading<Q>>, MeterError> {
    let integrator = metering(job, settings.max_depth)?;
    if !(0.0..=180.0).contains(&settings.acceptance) {
        return Err(MeterError::Acceptance(settings.acceptance));
    }
    if !(settings.aperture >= 0.0 && settings.aperture.is_finite()) {
        return Err(MeterError::Aperture(settings.aperture));
    }
    // 1 − cos(a/2) = 2 sin²(a/4) keeps its digits for the smallest angles.
    let one_minus_cos = 2.0 * (0.25 * settings.acceptance.to_radians()).sin().powi(2);
    let spot = |(i, ray): (usize, &MeterRay)| {
        let axis: Dir = direction(job, i, ray.direction)?;
        Ok(Spot {
            pupil: place(job, i, ray.position)?.p,
            frame: Frame::from_z(*axis),
            radius: settings.aperture as f32,
            one_minus_cos: one_minus_cos as f32,
            time: job.scene.camera().shutter()[0],
        })
    };
    let spots: Vec<Spot> = rays.iter().enumerate().map(spot).collect::<Result<_, _>>()?;
    let mut readings = Vec::with_capacity(spots.len());
    for (spot, stream) in spots.iter().zip(0..) {
        if session.cancel.is_cancelled() {
            break;
        }
        let raw = bench::measure(session, stream, response, &[0], |w, sampler, tally| {
            let ray = spot.ray(sampler);
            [integrator.radiance(&job.scene, ray, w, sampler, tally, None)]
        });
        readings.push(LuminanceReading { mean: show(&raw), effort: raw.effort });
    }
    Ok(readings)
}

/// The readings of the first rays as a table: a row for each ray, or for each ray and wavelength [nm].
pub fn table<Q: Shown>(
    rays: &[MeterRay],
    readings: &[LuminanceReading<Q>],
    wavelengths: &[f32],
    settings: &LuminanceSettings,
    session: &Session<'_>,
) -> Table {
    let mut columns = vec![Column::words("ray")];
    columns.extend(["x", "y", "z"].map(|name| Column::new(name, "scene units")));
    columns.extend(["dx", "dy", "dz"].map(|name| Column::new(name, "1")));
    if !wavelengths.is_empty() {
        columns.push(Column::new("wavelength", "nm"));
    }
    columns.extend([Column::new(Q::NAME, Q::UNIT), Column::words("rays")]);
    let notes = readings.iter().any(|r| r.effort.note().is_some());
    if notes {
        columns.push(Column::words("note"));
    }
    let mut table = Table::new(Q::NAME, columns);
    for (i, (ray, reading)) in rays.iter().zip(readings).enumerate() {
        for (line, estimate) in reading.mean.estimates().into_iter().enumerate() {
            let mut row = vec![Cell::Number((i + 1) as f64)];
            row.extend(ray.position.into_iter().chain(ray.direction).map(Cell::Number));
            row.extend(wavelengths.get(line).map(|&l| Cell::Number(f64::from(l))));
            row.extend([Cell::Estimate(estimate), Cell::Number(reading.effort.rays as f64)]);
            if notes {
                row.push(reading.effort.note().map_or(Cell::Missing, Cell::Text));
            }
            table.rows.push(row);
        }
    }
    let LuminanceSettings { max_depth, acceptance, aperture } = *settings;
    let field = match acceptance > 0.0 {
        true => format!("mean over a cone of {acceptance}° full angle"),
        false => "a single direction".to_owned(),
    };
    let pupil = match aperture > 0.0 {
        true => format!("entrance pupil of radius {aperture} scene units"),
        false => "entrance pupil without extent".to_owned(),
    };
    table.fact("instrument", format!("{field}, {pupil}"));
    facts(&mut table, readings.iter().map(|r| &r.effort), rays.len(), max_depth, session);
    table
}
