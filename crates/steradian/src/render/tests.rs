use super::*;
use crate::integrator::{FirstSurface, Integrator, Tally};
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::import::pbrt::{Imported, Input, import};
use crate::scene::{Disk, Scene};
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::Radiance;
use std::path::Path;
use std::time::Duration;

/// 40 × 24 pixels are six tiles, four of them cut.
fn job(spp: u32) -> RenderJob {
    job_with("zsobol", spp)
}

fn job_with(sampler: &str, spp: u32) -> RenderJob {
    job_of("rgb", sampler, spp)
}

fn job_of(film: &str, sampler: &str, spp: u32) -> RenderJob {
    let text = format!(
        r#"Film "{film}" "integer xresolution" 40 "integer yresolution" 24
        Sampler "{sampler}" "integer pixelsamples" {spp}
        Camera "perspective"
        WorldBegin
        LightSource "infinite" "rgb L" [ 1 1 1 ]"#
    );
    let input = Input::Text { name: "test.pbrt", bytes: text.as_bytes(), base: Path::new(".") };
    let Imported { scene, mut diagnostics, .. } = import(&[input], &Disk);
    crate::scene::compile(scene.unwrap(), &Disk, &mut diagnostics).unwrap()
}

/// Makes passes short, so that rounds are cut at other places.
struct Slow;

impl ProgressSink for Slow {
    fn update(&self, _: &Progress) {
        std::thread::sleep(Duration::from_millis(130));
    }
}

/// The same light everywhere, half of it found by one sample in 64.
struct RareLight;

impl RareLight {
    const CHANCE: f32 = 1.0 / 64.0;

    /// Of the picture, where the background is 1.
    const EXACT: f64 = 2.0;
}

impl Integrator for RareLight {
    fn radiance(
        &self,
        scene: &Scene,
        ray: Ray,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        _: Option<&mut FirstSurface>,
    ) -> Sampled<Radiance> {
        tally.paths += 1;
        let found = if sampler.next_1d() < Self::CHANCE { 1.0 / Self::CHANCE } else { 0.0 };
        let mut background = Sampled::ZERO;
        if let Some(d) = crate::math::Dir::new(ray.d) {
            scene.infinite_lights().for_each(|light| background += scene.escaped(light, d, w));
        }
        background * (1.0 + found)
    }
}

fn render_rare_light(job: &RenderJob, teller: Teller) -> (Vec<FilmTile>, Film, Adaptive) {
    let film = setup::film(job).unwrap();
    let (options, cancel) = (RenderOptions::default(), CancelToken::new());
    let mut passes = Passes::new(&options, &Silent, &cancel, film.bounds().area() as u64);
    let target = job.sampling.noise.unwrap();
    let (tiles, report) = adaptive::render(teller, job, target, &film, &RareLight, &mut passes);
    (tiles, film, report)
}

/// A mean over 16 seeds and its standard error.
#[derive(Debug)]
struct Bias {
    /// Relative to the exact value.
    mean: f64,
    standard_error: f64,
    /// Mean samples per pixel.
    spp: f64,
}

/// How far the means of pictures are off.
fn bias_of_rare_light(sampler: &str, teller: Teller) -> Bias {
    let mut job = job_with(sampler, 1024);
    job.sampling.noise = crate::scene::NoiseTarget::new(0.4);
    let mut spp = 0.0;
    let errors: Vec<f64> = (0..16)
        .map(|seed| {
            job.sampling.seed = seed;
            let (tiles, film, report) = render_rare_light(&job, teller);
            assert!(report.least_spp >= 16 && report.largest_spp <= 1024, "{report}");
            spp += report.mean_spp / 16.0;
            let developed = film.develop(&tiles);
            let green = developed.layer("G").unwrap();
            green.iter().map(|&v| f64::from(v)).sum::<f64>() / green.len() as f64 / RareLight::EXACT - 1.0
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / 16.0;
    let variance = errors.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / 15.0;
    Bias { mean, standard_error: (variance / 16.0).sqrt(), spp }
}

#[test]
fn being_told_by_others_has_no_bias_that_shows_and_deciding_for_oneself_has() {
    for sampler in ["independent", "zsobol"] {
        let told = bias_of_rare_light(sampler, Teller::Others);
        // The 99.9 % quantile of Student's t with 15 degrees of freedom, two-sided, is 4.07; one percent is found.
        assert!(
            told.mean.abs() < 4.07 * told.standard_error + 1e-5 && told.standard_error < 4e-3,
            "{told:?}"
        );
        // Some pixels stop and some go on, without which nothing would be decided.
        assert!((20.0..800.0).contains(&told.spp), "{sampler}: {told:?}");
        // A sixth of the light is lost where pixels that have not found it stop.
        let naive = bias_of_rare_light(sampler, Teller::Itself);
        assert!(naive.mean < -0.1 && naive.mean < -8.0 * naive.standard_error, "{sampler}: {naive:?}");
    }
}

#[test]
fn adaptive_pictures_depend_on_neither_threads_nor_tiles_nor_passes() {
    let mut job = job_of("gbuffer", "independent", 64);
    job.sampling.noise = crate::scene::NoiseTarget::new(0.8);
    let run = |threads, tile_order, sink: &dyn ProgressSink| {
        let options = RenderOptions { threads: Some(threads), tile_order, time_limit: None };
        let rendering = execute(&job, &RareLight, &options, sink, &CancelToken::new()).unwrap();
        let adaptive = rendering.report.adaptive.unwrap();
        assert!(adaptive.least_spp < adaptive.largest_spp, "{adaptive}");
        let counts = rendering.frame.channel("SampleCount").unwrap().to_vec();
        (adaptive, rendering.frame.channel("G").unwrap().to_vec(), counts)
    };
    let expected = run(1, TileOrder::Scanline, &Silent);
    let mean = expected.2.iter().map(|&n| f64::from(n)).sum::<f64>() / expected.2.len() as f64;
    assert!((mean - expected.0.mean_spp).abs() < 1e-9);
    assert!(run(3, TileOrder::Strided, &Silent) == expected);
    assert!(run(4, TileOrder::Reverse, &Slow) == expected);
}

#[test]
fn the_noise_that_is_reported_is_the_difference_to_the_exact_picture() {
    let mut job = job_with("independent", 1 << 12);
    for target in [0.4, 0.2] {
        job.sampling.noise = crate::scene::NoiseTarget::new(target);
        let (tiles, film, adaptive) = render_rare_light(&job, Teller::Others);
        let developed = film.develop(&tiles);
        let (mut squares, mut n) = (0.0, 0.0);
        for c in ["R", "G", "B"] {
            for v in developed.layer(c).unwrap() {
                squares += (f64::from(*v) / RareLight::EXACT - 1.0).powi(2);
                n += 1.0;
            }
        }
        let (truth, noise) = (f64::sqrt(squares / n), adaptive.noise.unwrap());
        // 960 pixels with errors of about a normal distribution, 2.3 % for the truth and 4 % for its estimate, and the
        // brighter pixels' errors are judged by their surroundings.
        assert!((noise / truth - 1.0).abs() < 0.2, "{adaptive} but {truth}");
        assert!(truth < 1.2 * f64::from(target) && truth > 0.6 * f64::from(target), "{adaptive}: {truth}");
        assert!(!adaptive.stopped_by_maximum(), "{adaptive}");
    }
}

#[test]
fn a_maximum_that_is_too_small_is_noticed_and_written_into_the_picture() {
    let mut job = job(40);
    job.sampling.noise = crate::scene::NoiseTarget::new(0.01);
    let rendering =
        execute(&job, &RareLight, &RenderOptions::default(), &Silent, &CancelToken::new()).unwrap();
    let adaptive = rendering.report.adaptive.unwrap();
    assert!(adaptive.stopped_by_maximum() && adaptive.noise.unwrap() > 0.1, "{adaptive}");
    assert_eq!((adaptive.mean_spp, adaptive.share_at_maximum, adaptive.quiet_share), (40.0, 1.0, 0.0));
    let attribute = |name| rendering.frame.attribute(name).unwrap();
    assert_eq!(attribute("renderer.stoppedByMaximum"), "true");
    assert_eq!(attribute("renderer.noiseTarget"), "0.01");
    assert_eq!(attribute("renderer.samplesPerPixelRange"), "40 40");
}
