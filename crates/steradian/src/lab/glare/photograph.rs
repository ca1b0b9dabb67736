//! A fisheye picture of a scene, taken several times over so that one knows what noise does to what is read from it.

use super::eye::Eye;
use super::picture::{Fisheye, LuminancePicture};
use crate::color::{ColorSpace, Xyz};
use crate::film::sensor::{Sensor, SensorSettings};
use crate::integrator::{Integrator, Tally};
use crate::lab::Session;
use crate::math::{Ray, Vec2, hash};
use crate::render::TileOrder;
use crate::render::schedule::for_each;
use crate::sampler::{Randomization, Sampler, SamplerKind};
use crate::scene::RenderJob;
use crate::spectrum::Wavelengths;

/// How often the picture is taken: what is read from it is known by leaving out one of these exposures after the other.
pub const EXPOSURES: usize = 8;

/// What is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shots {
    /// Geometry.
    pub fisheye: Fisheye,
    /// Samples for each pixel, all exposures together; rounded up to a multiple of [`EXPOSURES`].
    pub samples: u32,
}

/// A picture with its exposures.
#[derive(Clone, Debug)]
pub struct Photograph {
    /// The eye.
    pub eye: Eye,
    /// Geometry.
    pub fisheye: Fisheye,
    /// Mean of all exposures: tristimulus values [cd/m²], row by row; black outside of the circle.
    pub color: Vec<Xyz>,
    /// Luminance of each exposure [cd/m²].
    pub exposures: Vec<LuminancePicture>,
    /// Samples for each pixel.
    pub samples: u32,
    /// Rays traced.
    pub rays: u64,
    /// Samples that were not finite and were left out.
    pub dropped: u64,
}

struct Row {
    y: u32,
    color: Vec<[f64; 3]>,
    luminance: Vec<[f32; EXPOSURES]>,
}

/// Takes a picture by an integrator; `None` when the eye has no place in the space of the rays, or the user stopped it before
/// every row was taken.
///
/// Samples are independent between pixels and exposures: padded Sobol' points, each exposure scrambled on its own.
pub fn take(
    job: &RenderJob,
    integrator: &dyn Integrator,
    eye: &Eye,
    shots: &Shots,
    session: &Session<'_>,
) -> Option<Photograph> {
    let fisheye = shots.fisheye;
    let side = fisheye.side();
    let per_exposure = shots.samples.max(1).div_ceil(EXPOSURES as u32);
    let samplers: [Sampler; EXPOSURES] = std::array::from_fn(|k| {
        let seed = hash::hash_words(&[session.seed, k as u64, u64::from(side)]);
        let kind = SamplerKind::PaddedSobol(Randomization::FastOwen);
        Sampler::new(kind, per_exposure, [side, side], seed)
    });
    let (point, _) = eye.in_render_space(job, [0.0, 0.0, 1.0])?;
    // With an exposure of one, whose values are cd/m². It cannot fail then.
    let sensor = Sensor::new(SensorSettings::default(), &ColorSpace::new(job.film.color_space)).ok()?;
    // As all instruments: at the moment when the shutter opens.
    let time = job.scene.camera().shutter()[0];
    let mut rows: Vec<Row> = (0..side)
        .map(|y| Row {
            y,
            color: vec![[0.0; 3]; side as usize],
            luminance: vec![[0.0; EXPOSURES]; side as usize],
        })
        .collect();
    let threads = session
        .threads
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
    let states = for_each(
        &mut rows,
        TileOrder::Scanline,
        threads,
        || (Tally::default(), 0_u64),
        |(tally, dropped), row| {
            if session.cancel.is_cancelled() {
                return;
            }
            for x in 0..side {
                // As the readings of the picture: pixels whose middle is outside of the circle do not count.
                if fisheye.direction([f64::from(x) + 0.5, f64::from(row.y) + 0.5]).is_none() {
                    continue;
                }
                let mut color = [0.0; 3];
                for (k, sampler) in samplers.iter().enumerate() {
                    let mut sampler = *sampler;
                    let mut sum = [0.0_f64; 3];
                    for index in 0..per_exposure {
                        sampler.start([x as i32, row.y as i32], index);
                        let place = sampler.next_pixel_2d();
                        let mut w = Wavelengths::sample_visible(sampler.next_1d());
                        let Some(local) = inside(fisheye, x, row.y, place) else { continue };
                        let Some((_, direction)) = eye.in_render_space(job, local) else { continue };
                        let ray = Ray { o: point, d: *direction, time };
                        let light = integrator.radiance(&job.scene, ray, &mut w, &mut sampler, tally, None);
                        if light.is_finite() {
                            let xyz = sensor.expose(light, &w).0.to_array();
                            sum.iter_mut().zip(xyz).for_each(|(s, v)| *s += f64::from(v));
                        } else {
                            *dropped += 1;
                        }
                    }
                    let share = 1.0 / f64::from(per_exposure);
                    row.luminance[x as usize][k] = (sum[1] * share) as f32;
                    color.iter_mut().zip(sum).for_each(|(c, s)| *c += s * share / EXPOSURES as f64);
                }
                row.color[x as usize] = color;
            }
        },
    );
    if session.cancel.is_cancelled() {
        return None;
    }
    let exposure = |k: usize| {
        let luminance = rows.iter().flat_map(|r| r.luminance.iter().map(|l| l[k])).collect();
        LuminancePicture { fisheye, luminance }
    };
    Some(Photograph {
        eye: *eye,
        fisheye,
        color: rows
            .iter()
            .flat_map(|r| r.color.iter().map(|c| Xyz::new(c[0] as f32, c[1] as f32, c[2] as f32)))
            .collect(),
        exposures: (0..EXPOSURES).map(exposure).collect(),
        samples: per_exposure * EXPOSURES as u32,
        rays: states.iter().map(|s| s.0.rays()).sum(),
        dropped: states.iter().map(|s| s.1).sum(),
    })
}

/// The direction through a place within a pixel; on the rim through its middle where the place is outside of the circle.
fn inside(fisheye: Fisheye, x: u32, y: u32, place: Vec2) -> Option<[f64; 3]> {
    let (x, y) = (f64::from(x), f64::from(y));
    fisheye
        .direction([x + f64::from(place.x), y + f64::from(place.y)])
        .or_else(|| fisheye.direction([x + 0.5, y + 0.5]))
}

impl Photograph {
    /// The mean of all exposures but perhaps one.
    pub fn without(&self, left_out: Option<usize>) -> LuminancePicture {
        let kept = || self.exposures.iter().enumerate().filter(|(k, _)| Some(*k) != left_out);
        let share = 1.0 / kept().count().max(1) as f64;
        let pixels = self.color.len();
        let mean = |i: usize| (kept().map(|(_, e)| f64::from(e.luminance[i])).sum::<f64>() * share) as f32;
        LuminancePicture { fisheye: self.fisheye, luminance: (0..pixels).map(mean).collect() }
    }
}
