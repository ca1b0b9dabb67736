//! What the samples of a picture spend their instructions on.

use super::scenes;
use crate::counting::{Kernel, Work};
use std::hint::black_box;
use steradian::accel::{Accel, Layout};
use steradian::bsdf::Mode;
use steradian::color::{ColorSpace, ColorSpaceKind};
use steradian::film::{Film, FilmKind, FilmSample, Filter, FilterKind, PixelBounds, Sensor, SensorSettings};
use steradian::math::hash::Pcg32;
use steradian::math::{Dir, Point, Ray, Vec2, Vec3};
use steradian::render::{CancelToken, RenderOptions, Silent};
use steradian::sampler::{Sampler, SamplerKind};
use steradian::scene::{RenderJob, SceneHit};
use steradian::shape::ReferencePoint;
use steradian::spectrum::{Sampled, Wavelengths};

pub(super) const KERNELS: &[Kernel] = &[
    Kernel { name: "closest hit, rays side by side", prepare: |_| rays(side_by_side, Query::Closest) },
    Kernel { name: "closest hit, rays at random", prepare: |_| rays(at_random, Query::Closest) },
    Kernel { name: "shadow ray at random", prepare: |_| rays(at_random, Query::Any) },
    Kernel { name: "hierarchy, a triangle", prepare: |_| hierarchy() },
    Kernel {
        name: "rough conductor, shade and sample",

        prepare: |_| scattering("Material \"conductor\" \"float roughness\" 0.2"),
    },
    Kernel {
        name: "rough dielectric, shade and sample",

        prepare: |_| scattering("Material \"dielectric\" \"float roughness\" 0.2"),
    },
    Kernel {
        name: "coated diffuse, shade and sample",

        prepare: |_| scattering("Material \"coateddiffuse\" \"float roughness\" 0.2"),
    },
    Kernel {
        name: "light sample, eight lamps",

        prepare: |_| Ok(light(scenes::square("Material \"diffuse\"")?)),
    },
    Kernel { name: "light sample, picture of a sky", prepare: |_| Ok(light(scenes::sky()?)) },
    Kernel { name: "sampler, a pair", prepare: |_| Ok(Box::new(pairs)) },
    Kernel { name: "film, a sample", prepare: |_| film() },
    Kernel { name: "path sample, Cornell box", prepare: |_| cornell_box() },
];

/// Units of work of a kernel.
const N: usize = 4096;

/// What is asked of the hierarchy.
#[derive(Clone, Copy)]
enum Query {
    Closest,
    Any,
}

fn side_by_side(i: usize, _: &mut Pcg32) -> Ray {
    let [x, y] = [i % 64, i / 64].map(|k| k as f32 / 32.5 - 0.97);
    Ray { o: Point::new(x * 0.1, y * 0.1, -3.0), d: Vec3::new(x * 0.3, y * 0.3, 1.0), time: 0.0 }
}

fn at_random(_: usize, rng: &mut Pcg32) -> Ray {
    let mut signed = || 2.0 * rng.next_f32() - 1.0;
    let [o, d] = [0, 1].map(|_| Vec3::new(signed(), signed(), 0.5 * signed()));
    Ray { o: Point(o), d, time: 0.0 }
}

fn rays(make: fn(usize, &mut Pcg32) -> Ray, query: Query) -> Result<Work, String> {
    let job = scenes::surface()?;
    let mut rng = Pcg32::new(1, 1);
    let rays: Vec<Ray> = (0..N).map(|i| make(i, &mut rng)).collect();
    // Instructions of a query depend on the transform to render space, which moves the camera's origin only.
    Ok(Box::new(move || {
        let accel = job.scene.accel();
        for ray in &rays {
            match query {
                Query::Closest => {
                    black_box(accel.intersect(ray, f32::INFINITY, &|_| true));
                }
                Query::Any => {
                    black_box(accel.occluded(ray, 1.0, &|_| true));
                }
            }
        }
        rays.len() as u64
    }))
}

fn hierarchy() -> Result<Work, String> {
    let job = scenes::surface()?;
    Ok(Box::new(move || {
        let shapes = job.scene.shapes();
        drop(black_box(Accel::build(shapes, &Layout::of_world(shapes.len()))));
        shapes.iter().map(|s| s.prim_count() as u64).sum()
    }))
}

/// Where a ray along the view meets the square.
fn hit(job: &RenderJob) -> Result<SceneHit, String> {
    let ray = Ray { o: Point::new(0.2, 0.1, -3.0), d: Vec3::Z, time: 0.0 };
    job.scene.intersect(&ray, f32::INFINITY).ok_or_else(|| "the ray meets nothing".to_owned())
}

fn scattering(material: &str) -> Result<Work, String> {
    let job = scenes::square(material)?;
    let hit = hit(&job)?;
    Ok(Box::new(move || {
        let mut rng = Pcg32::new(1, 1);
        for seed in 0..N as u64 {
            let mut w = Wavelengths::sample_visible(rng.next_f32());
            let tilt = Vec3::new(rng.next_f32() - 0.5, rng.next_f32() - 0.5, -0.7);
            let Some(wo) = Dir::new(tilt) else { continue };
            let Some(surface) = job.scene.shade(&hit, wo, &mut w, seed) else { continue };
            let u = Vec2::new(rng.next_f32(), rng.next_f32());
            let Some(s) = surface.sample(wo, rng.next_f32(), u, Mode::Radiance) else { continue };
            black_box((
                s.weight,
                surface.eval(wo, s.wi, Mode::Radiance),
                surface.pdf(wo, s.wi, Mode::Radiance),
            ));
        }
        N as u64
    }))
}

fn light(job: RenderJob) -> Work {
    Box::new(move || {
        let mut rng = Pcg32::new(1, 1);
        let w = Wavelengths::sample_visible(0.5);
        for _ in 0..N {
            let p = Point::new(rng.next_f32(), rng.next_f32(), 0.0);
            let u = Vec2::new(rng.next_f32(), rng.next_f32());
            black_box(job.scene.sample_light(&ReferencePoint::free(p, 0.0), rng.next_f32(), u, &w));
        }
        N as u64
    })
}

fn pairs() -> u64 {
    const DIMENSIONS: u32 = 8;
    let kind = SamplerKind::ZSobol(steradian::sampler::Randomization::FastOwen);
    let mut sampler = Sampler::new(kind, 4, [32, 32], 0);
    for i in 0..N as i32 / 4 {
        for index in 0..4 {
            sampler.start([i % 32, i / 32], index);
            for _ in 0..DIMENSIONS {
                black_box(sampler.next_2d());
            }
        }
    }
    N as u64 * u64::from(DIMENSIONS)
}

fn film() -> Result<Work, String> {
    let failed = |e: &dyn std::fmt::Display| e.to_string();
    let space = ColorSpace::new(ColorSpaceKind::Srgb);
    let sensor = Sensor::new(SensorSettings::default(), &space).map_err(|e| failed(&e))?;
    let kind = FilterKind::Gaussian { sigma: 0.5 };
    let filter = Filter::new(kind, Vec2::splat(kind.default_radius())).map_err(|e| failed(&e))?;
    let bounds = PixelBounds::full([32, 32]);
    let film = Film::new([32, 32], bounds, filter, sensor, FilmKind::Rgb, space).map_err(|e| failed(&e))?;
    Ok(Box::new(move || {
        let mut tile = film.tile(bounds);
        for i in 0..N {
            let w = film.sample_wavelengths(i as f32 / N as f32);
            let sample =
                FilmSample { radiance: Sampled::splat(1.0), wavelengths: &w, weight: 1.0, surface: None };
            let _ = film.add_sample(&mut tile, [(i % 32) as i32, (i / 128) as i32], &sample);
        }
        black_box(tile);
        N as u64
    }))
}

fn cornell_box() -> Result<Work, String> {
    let mut job = scenes::cornell_box()?;
    job.film.resolution = [32, 32];
    Ok(Box::new(move || {
        let options = RenderOptions { threads: Some(1), ..RenderOptions::default() };
        let rendered = steradian::render::render(&job, &options, &Silent, &CancelToken::new());
        // A picture that failed counts as no samples, which no bound allows.
        rendered.map_or(0, |_| 32 * 32 * u64::from(job.sampling.spp))
    }))
}
