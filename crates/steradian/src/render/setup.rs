//! From a job's settings to a film and an integrator, and from a film to a picture with its metadata.

use super::report::Report;
use crate::film::{
    Film, FilmError, FilmKind, Filter, FilterError, FilterKind, PixelBounds, Sensor, SensorError,
    SensorSettings, SpectralBins,
};
use crate::image::ImageError;
use crate::integrator::{ClassicShading, Integrator, Metering, PathTracer};
use crate::math::Vec2;
use crate::scene::{IntegratorSettings, RenderJob, desc};
use crate::units::Kelvin;

/// Why a job cannot be rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The film.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The pixel filter.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// The sensor.
    #[error(transparent)]
    Sensor(#[from] SensorError),
    /// The machine refuses to give the memory.
    #[error("the film needs {0} MiB of memory, more than this machine gives")]
    Memory(u64),
    /// The picture could not be put together.
    #[error(transparent)]
    Frame(#[from] ImageError),
}

/// The integrator that a job asks for.
pub(super) fn integrator(job: &RenderJob) -> Box<dyn Integrator + '_> {
    match &job.integrator {
        IntegratorSettings::Path(p) => {
            Box::new(PathTracer { max_depth: p.max_depth, regularize: p.regularize })
        }
        IntegratorSettings::Classic(c) => {
            Box::new(ClassicShading { ambient: c.ambient.as_deref(), shadows: c.shadows })
        }
    }
}

/// An integrator for instruments: that of the job without its biases, with paths of at most `max_depth` bounces.
///
/// `None` when the job asks for shading that is not light transport.
pub fn metering(job: &RenderJob, max_depth: u32) -> Option<Box<dyn Metering + '_>> {
    match &job.integrator {
        IntegratorSettings::Path(_) => Some(Box::new(PathTracer { max_depth, regularize: false })),
        IntegratorSettings::Classic(_) => None,
    }
}

/// The film that a job asks for.
pub(super) fn film(job: &RenderJob) -> Result<Film, RenderError> {
    let d = &job.film;
    let space = job.output_space.clone();
    let settings = SensorSettings {
        imaging_ratio: SensorSettings::exposure(job.scene.camera().shutter(), d.sensor.iso),
        white_balance: d.sensor.white_balance.map(Kelvin),
        max_component: d.max_component_value,
    };
    let sensor = Sensor::new(settings, &space)?;
    let kind = match job.filter.kind {
        desc::FilterKind::Box => FilterKind::Box,
        desc::FilterKind::Triangle => FilterKind::Triangle,
        desc::FilterKind::Gaussian { sigma } => FilterKind::Gaussian { sigma },
        desc::FilterKind::Mitchell { b, c } => FilterKind::Mitchell { b, c },
        desc::FilterKind::Sinc { tau } => FilterKind::Sinc { tau },
    };
    let filter = Filter::new(kind, Vec2::from_array(job.filter.radius))?;
    let kind = match d.kind {
        desc::FilmKind::Rgb => FilmKind::Rgb,
        desc::FilmKind::GBuffer { .. } => FilmKind::GBuffer,
        desc::FilmKind::Spectral { n_buckets, lambda_min, lambda_max } => {
            FilmKind::Spectral(SpectralBins { count: n_buckets, min: lambda_min, max: lambda_max })
        }
    };
    let film = Film::new(d.resolution, bounds(d), filter, sensor, kind, space)?;
    check_memory(job, &film)?;
    Ok(film)
}

/// Asks for the memory of all tiles at once and gives it back: where that is refused, a message is better than an abort.
fn check_memory(job: &RenderJob, film: &Film) -> Result<(), RenderError> {
    let b = film.bounds();
    let pixel = PixelBounds { min: b.min, max: [b.min[0] + 1, b.min[1] + 1] };
    let tiles = match job.sampling.noise {
        None => 1,
        // All samples, and those of a round.
        Some(_) => 2,
    };
    let bytes = film.tile(pixel).bytes().saturating_mul(tiles).saturating_mul(b.area());
    let mut probe: Vec<u8> = Vec::new();
    probe.try_reserve_exact(bytes).map_err(|_| RenderError::Memory((bytes >> 20) as u64))
}

fn bounds(film: &desc::FilmDesc) -> PixelBounds {
    let [x0, x1, y0, y1] = film.window().map(|v| i32::try_from(v).unwrap_or(i32::MAX));
    PixelBounds { min: [x0, y0], max: [x1, y1] }
}

/// Settings of a job that belong into the picture's metadata, as names and values.
pub(super) fn metadata(job: &RenderJob, report: &Report) -> Vec<(&'static str, String)> {
    let mut list = vec![
        ("software", format!("Steradian {}", env!("CARGO_PKG_VERSION"))),
        ("renderer.integrator", job.integrator.name().to_owned()),
        ("renderer.samplesPerPixel", report.spp.to_string()),
        ("renderer.sampler", format!("{:?}", job.sampling.kind)),
        ("renderer.filter", format!("{:?} radius {:?}", job.filter.kind, job.filter.radius)),
        ("renderer.seed", job.sampling.seed.to_string()),
        ("renderer.wavelengthsPerPath", crate::spectrum::LANES.to_string()),
        ("renderer.instructionSet", format!("{:?}", job.scene.accel().instructions())),
        ("scene.hash", format!("{:016x}", job.scene_hash)),
        ("scene.metersPerUnit", job.meters_per_unit.to_string()),
        ("units.RGB", "cd.m^-2 at exposure 1 s and ISO 100, linear".to_owned()),
    ];
    if let Some(adaptive) = &report.adaptive {
        list.push(("bias.adaptiveSampling", "second order".to_owned()));
        list.push(("renderer.noiseTarget", adaptive.target.get().to_string()));
        list.extend(adaptive.noise.map(|noise| ("renderer.noise", format!("{noise:.5}"))));
        list.push((
            "renderer.samplesPerPixelRange",
            format!("{} {}", adaptive.least_spp, adaptive.largest_spp),
        ));
        list.push(("renderer.stoppedByMaximum", adaptive.stopped_by_maximum().to_string()));
    }
    if job.scene.materials().has_inconsistent_coats() {
        list.push(("bias.layeredWeights", "pbrt-v4".to_owned()));
    }
    if let IntegratorSettings::Path(path) = &job.integrator {
        list.push(("renderer.maxDepth", path.max_depth.to_string()));
        if path.regularize {
            list.push(("bias.regularize", "true".to_owned()));
        }
    }
    list
}
