//! A pixel of the scene's camera as an irradiance meter on the image plane, A 12.4.
//!
//! Behind a lens whose aperture has the radius R, at the distance v, a point of the image plane receives
//!
//! ```text
//! H = ∫ L cos⁴θ dA / v² = π/(4N²) ⟨L cos⁴θ⟩,  N = v/(2R)
//! ```
//!
//! where A is the area of the aperture, θ the angle between the axis and the line from the point of the image plane to that
//! of the aperture, and the mean is over the aperture: A (17) and A (30) for the solid angle dω = dA cosθ r⁻² with r = v/cosθ. A lens
//! without losses keeps radiance, so that L is that of the ray which leaves it towards the scene. The meter reads the mean over
//! the area of a pixel and over the time that the shutter is open.
//!
//! N is the *working* f-number: for a lens that is focused at infinity the focal length over the diameter of the aperture. A scene
//! states R, but neither v nor the size of the film; one of them, or N, must be given. Through a pinhole comes no light at all: it
//! needs N. The pictures that are rendered hold L, without cos⁴θ and whatever the aperture (see `film::sensor`).

use super::super::session::Session;
use super::super::table::{Cell, Column, Table};
use super::bench::{self, Efficacies, Raw, Response};
use super::contract::{DEFAULT_MAX_DEPTH, Effort, MeterError, Shown, metering};
use super::facts::facts;
use super::luminance::RadiantRadiance;
use super::lux::RadiantIrradiance;
use crate::camera::{Camera, CameraRay, CameraSample, Projection};
use crate::math::{Ray, Vec2};
use crate::sampler::Sampler;
use crate::scene::RenderJob;
use crate::units::{Illuminance, Irradiance, Luminance, Luminous, Measured, Radiance, Unit};
use std::f64::consts::PI;

/// A pixel: column and row from 0 at the upper left of the uncropped film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
}

/// How much light the camera lets through to its image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aperture {
    /// By the working f-number N, above 0.
    FNumber(f64),
    /// By the scene's lens in front of a film of this diagonal [m], above 0, which the field of view spans.
    Film(f64),
}

/// How a pixel measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSettings {
    /// Most bounces of light on its way from a source; 0 for sources alone.
    pub max_depth: u32,
    /// What lets the light through.
    pub aperture: Aperture,
}

impl PixelSettings {
    /// A meter behind the given aperture.
    pub fn behind(aperture: Aperture) -> Self {
        Self { max_depth: DEFAULT_MAX_DEPTH, aperture }
    }
}

/// What a pixel shows.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelReading<L = Luminance, E = Illuminance> {
    /// Mean of what the pixel sees, each point of pixel and aperture counting alike.
    pub seen: L,
    /// What arrives on the image plane.
    pub arriving: E,
    /// What the reading took.
    pub effort: Effort,
}

/// Illuminance [lx] of each of the pixels on the image plane, one after the other, each as precise as the session asks.
///
/// The list of readings is shorter than that of the pixels when the session is cancelled.
///
/// # Errors
/// When the scene is for legacy shading, its camera has no image plane or the aperture cannot be known, or a pixel is not on the film.
pub fn measure(
    job: &RenderJob,
    pixels: &[Pixel],
    settings: &PixelSettings,
    session: &Session<'_>,
) -> Result<Vec<PixelReading>, MeterError> {
    let response = Efficacies::of::<Luminous>();
    read(job, pixels, settings, session, Response::Weighted(&response))
}

/// Irradiance [W·m⁻²] over 360–830 nm of each of the pixels on the image plane; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_radiant(
    job: &RenderJob,
    pixels: &[Pixel],
    settings: &PixelSettings,
    session: &Session<'_>,
) -> Result<Vec<PixelReading<RadiantRadiance, RadiantIrradiance>>, MeterError> {
    read(job, pixels, settings, session, Response::Radiant)
}

/// The working f-number that the settings come to for a job's camera.
///
/// # Errors
/// When the camera has no image plane, or the aperture cannot be known.
pub fn f_number(job: &RenderJob, aperture: Aperture) -> Result<f64, MeterError> {
    let camera = job.scene.camera();
    let lens = match camera.projection() {
        Projection::Perspective(p) => p.lens(),
        Projection::Orthographic(_) => return Err(MeterError::NoImagePlane("orthographic")),
        Projection::Spherical(_) => return Err(MeterError::NoImagePlane("spherical")),
    };
    let positive = |x: f64| if x > 0.0 && x.is_finite() { Ok(x) } else { Err(MeterError::ImagePlane(x)) };
    match aperture {
        Aperture::FNumber(n) => positive(n),
        Aperture::Film(_) if lens.radius == 0.0 => Err(MeterError::Pinhole),
        Aperture::Film(diagonal) => {
            let radius = f64::from(lens.radius) * f64::from(job.meters_per_unit);
            let [width, height] = camera.resolution().map(|n| n as f32);
            let slope = |film: Vec2| Line::through(camera, film, CENTRE, 0.0).map(|line| line.slope);
            let corners = slope(Vec2::ZERO).zip(slope(Vec2::new(width, height)));
            let across = corners.map_or(0.0, |(a, b)| f64::from((a - b).length()));
            positive(positive(diagonal)? / across / (2.0 * radius))
        }
    }
}

/// The middle of the aperture.
const CENTRE: Vec2 = Vec2::splat(0.5);

/// A ray through the lens, as the camera sees it.
struct Line {
    ray: Ray,
    /// Where it passes the aperture [scene units].
    on_lens: Vec2,
    /// x/z and y/z of its direction.
    slope: Vec2,
}

impl Line {
    fn through(camera: &Camera, film: Vec2, lens: Vec2, time: f32) -> Option<Self> {
        let CameraRay { ray, .. } = camera.ray(&CameraSample { film, lens, time })?;
        let to_camera = camera.placement().at(ray.time).inverse();
        let (o, d) = (to_camera.point(ray.o), to_camera.vector(ray.d));
        Some(Self { ray, on_lens: o.truncate(), slope: d.truncate() / d.z })
    }
}

/// One pixel of a camera.
struct Meter<'a> {
    camera: &'a Camera,
    pixel: Pixel,
    /// 1/v [scene units⁻¹]; of no effect for a pinhole.
    inverse_distance: f32,
}

impl Meter<'_> {
    /// A ray through pixel and aperture, and cos⁴θ.
    fn sample(&self, sampler: &mut Sampler) -> Option<(Ray, f32)> {
        let film = Vec2::new(self.pixel.x as f32, self.pixel.y as f32) + sampler.next_2d();
        let (lens, time) = (sampler.next_2d(), sampler.next_1d());
        let line = Line::through(self.camera, film, lens, time)?;
        // Behind the lens the point of the image plane lies against the ray through the lens' centre, at the distance v.
        let chief = Line::through(self.camera, film, CENTRE, time)?.slope;
        let slope = chief + line.on_lens * self.inverse_distance;
        Some((line.ray, (1.0 + slope.length_squared()).recip().powi(2)))
    }
}

type Readings<D> = Vec<PixelReading<Measured<Radiance, D>, Measured<Irradiance, D>>>;

fn read<D>(
    job: &RenderJob,
    pixels: &[Pixel],
    settings: &PixelSettings,
    session: &Session<'_>,
    response: Response<'_>,
) -> Result<Readings<D>, MeterError>
where
    Radiance: Unit<D>,
    Irradiance: Unit<D>,
{
    let integrator = metering(job, settings.max_depth)?;
    let n = f_number(job, settings.aperture)?;
    let camera = job.scene.camera();
    let [width, height] = camera.resolution();
    if let Some(&Pixel { x, y }) = pixels.iter().find(|p| p.x >= width || p.y >= height) {
        return Err(MeterError::OffFilm { x, y, width, height });
    }
    let radius = match camera.projection() {
        Projection::Perspective(p) => f64::from(p.lens().radius),
        Projection::Orthographic(_) | Projection::Spherical(_) => 0.0,
    };
    let inverse_distance = if radius > 0.0 { (0.5 / (n * radius)) as f32 } else { 0.0 };
    let mut readings = Vec::with_capacity(pixels.len());
    for (&pixel, stream) in pixels.iter().zip(0..) {
        if session.cancel.is_cancelled() {
            break;
        }
        let meter = Meter { camera, pixel, inverse_distance };
        let raw: Raw<2> = bench::measure(session, stream, response, &[1], |w, sampler, tally| {
            let Some((ray, falloff)) = meter.sample(sampler) else { return Default::default() };
            let seen = integrator.radiance(&job.scene, ray, w, sampler, tally, None);
            [seen, seen * falloff]
        });
        readings.push(PixelReading {
            seen: Measured::new(raw.single(0)),
            arriving: Measured::new(raw.single(1).scaled(PI / (4.0 * n * n))),
            effort: raw.effort,
        });
    }
    Ok(readings)
}

/// The readings of the first pixels as a table. `n` is that of [`f_number`].
pub fn table<L: Shown, E: Shown>(
    job: &RenderJob,
    pixels: &[Pixel],
    readings: &[PixelReading<L, E>],
    n: f64,
    settings: &PixelSettings,
    session: &Session<'_>,
) -> Table {
    let mut columns = ["x", "y"].map(|name| Column::new(name, "px")).to_vec();
    columns.push(Column::new(L::NAME, L::UNIT));
    columns.push(Column::new(E::NAME, E::UNIT));
    columns.push(Column::new("exposure", format!("{}·s", E::UNIT)));
    columns.push(Column::words("rays"));
    let notes = readings.iter().any(|r| r.effort.note().is_some());
    if notes {
        columns.push(Column::words("note"));
    }
    let [opens, closes] = job.scene.camera().shutter().map(f64::from);
    let mut table = Table::new(format!("{} of pixels", E::NAME), columns);
    for (pixel, reading) in pixels.iter().zip(readings) {
        let mut row = vec![Cell::Number(f64::from(pixel.x)), Cell::Number(f64::from(pixel.y))];
        let arriving = reading.arriving.estimates();
        let exposure = arriving.iter().map(|e| e.scaled(closes - opens));
        let all = reading.seen.estimates().into_iter().chain(arriving.iter().copied()).chain(exposure);
        row.extend(all.map(Cell::Estimate));
        row.push(Cell::Number(reading.effort.rays as f64));
        if notes {
            row.push(reading.effort.note().map_or(Cell::Missing, Cell::Text));
        }
        table.rows.push(row);
    }
    table.fact("instrument", "pixel of the scene's camera on its image plane: H = π/(4N²) ⟨L cos⁴θ⟩, mean over pixel, aperture and shutter");
    table.fact("working f-number", format!("{n}"));
    table.fact("exposure time", format!("{} s", closes - opens));
    facts(&mut table, readings.iter().map(|r| &r.effort), pixels.len(), settings.max_depth, session);
    table
}
