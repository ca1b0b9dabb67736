use super::*;
use crate::integrator::{FirstSurface, Integrator, Learner, Tally};
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::import::pbrt::{Imported, Input, import};
use crate::scene::{Disk, Scene};
use crate::spectrum::{Sampled, Wavelengths};
use crate::units::Radiance;
use std::path::Path;
use std::sync::Mutex;

/// 40 × 24 pixels are six tiles, four of them cut.
fn job(spp: u32) -> RenderJob {
    job_with("zsobol", spp)
}

fn job_with(sampler: &str, spp: u32) -> RenderJob {
    let text = format!(
        r#"Film "rgb" "integer xresolution" 40 "integer yresolution" 24
        Sampler "{sampler}" "integer pixelsamples" {spp}
        Camera "perspective"
        WorldBegin
        LightSource "infinite" "rgb L" [ 1 1 1 ]"#
    );
    let input = Input::Text { name: "test.pbrt", bytes: text.as_bytes(), base: Path::new(".") };
    let Imported { scene, mut diagnostics, .. } = import(&[input], &Disk);
    crate::scene::compile(scene.unwrap(), &Disk, &mut diagnostics).unwrap()
}

/// Learns what it shows: the sum of what it noted, in the order in which it was handed over.
#[derive(Default)]
struct Pupil<'a> {
    learned: f32,
    lessons: Option<&'a Mutex<Vec<Vec<f32>>>>,
}

impl Integrator for Pupil<'_> {
    fn radiance(
        &self,
        _: &Scene,
        _: Ray,
        _: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        _: Option<&mut FirstSurface>,
    ) -> Sampled<Radiance> {
        tally.paths += 1;
        Sampled::splat(self.learned + sampler.next_1d())
    }
}

impl Learner for Pupil<'_> {
    /// Lessons after 2, 4 and 8 samples.
    fn next_lesson(&self, done: u32) -> Option<u32> {
        (done < 8).then(|| (2 * done).max(2))
    }

    fn notebook(&self) -> Notes {
        Box::new(Vec::<f32>::new())
    }

    fn radiance_with_notes(
        &self,
        scene: &Scene,
        ray: Ray,
        w: &mut Wavelengths,
        sampler: &mut Sampler,
        tally: &mut Tally,
        first: Option<&mut FirstSurface>,
        notes: &mut Notes,
    ) -> Sampled<Radiance> {
        let found = self.radiance(scene, ray, w, sampler, tally, first);
        notes.downcast_mut::<Vec<f32>>().unwrap().push(found[0]);
        found
    }

    fn learn(&mut self, _: &Scene, notes: Vec<Notes>) {
        let all: Vec<f32> = notes.into_iter().flat_map(|n| *n.downcast::<Vec<f32>>().unwrap()).collect();
        // Sums of floats depend on their order.
        self.learned = all.iter().sum::<f32>() / all.len() as f32;
        self.lessons.unwrap().lock().unwrap().push(all);
    }
}

/// Makes passes short, so that rounds are cut at other places.
struct Slow;

impl ProgressSink for Slow {
    fn update(&self, _: &Progress) {
        std::thread::sleep(Duration::from_millis(130));
    }
}

#[test]
fn what_is_learned_depends_on_neither_threads_nor_tiles_nor_passes() {
    let job = job(20);
    let run = |threads, tile_order, sink: &dyn ProgressSink| {
        let lessons = Mutex::new(Vec::new());
        let pupil = Pupil { learned: 0.0, lessons: Some(&lessons) };
        let options = RenderOptions { threads: Some(threads), tile_order, time_limit: None };
        let estimator = Estimator::Learning(Box::new(pupil));
        let rendering = execute(&job, estimator, &options, sink, &CancelToken::new()).unwrap();
        assert_eq!((rendering.report.spp, rendering.report.tally.paths), (20, 20 * 40 * 24));
        (lessons.into_inner().unwrap(), rendering.frame.channel("G").unwrap().to_vec())
    };
    let expected = run(1, TileOrder::Scanline, &Silent);
    // A note for each sample of a round, and none after the last lesson.
    assert_eq!(expected.0.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 4].map(|n| n * 40 * 24));
    assert!(run(3, TileOrder::Strided, &Silent) == expected);
    assert!(run(4, TileOrder::Reverse, &Slow) == expected);
}

/// The same light by the same rare and bright samples everywhere: one in 64 finds 5/6 of it.
struct RareLight;

impl RareLight {
    const CHANCE: f32 = 1.0 / 64.0;
    const CERTAIN: f32 = 0.2;
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
        // White of luminance 1 where nothing is found, so that the colours of few samples add no noise.
        let mut white = Sampled::ZERO;
        if let Some(d) = crate::math::Dir::new(ray.d) {
            scene.infinite_lights().for_each(|light| white += scene.escaped(light, d, w));
        }
        white * (Self::CERTAIN + found)
    }
}

/// Means of the picture over its exact value, and mean samples per pixel, of adaptive renders with 16 seeds.
fn rare_light_told_by(tellers: [usize; 2]) -> (Vec<f64>, f64) {
    let mut job = job_with("independent", 512);
    let target = crate::scene::NoiseTarget::new(0.2).unwrap();
    let (options, mut spp) = (RenderOptions::default(), 0.0);
    let means = (0..16).map(|seed| {
        job.sampling.seed = seed;
        let film = setup::film(&job).unwrap();
        let cancel = CancelToken::new();
        let mut passes = Passes::new(&options, &Silent, &cancel, film.bounds().area() as u64);
        let mut estimator = Estimator::Fixed(Box::new(RareLight));
        let (tiles, report) =
            adaptive::render_told_by(tellers, &job, target, &film, &mut estimator, &mut passes);
        assert!(report.least_spp >= 16 && report.largest_spp <= 512, "{report}");
        spp += report.mean_spp / 16.0;
        let developed = film.develop(&tiles);
        let green = developed.layer("G").unwrap();
        green.iter().map(|&v| f64::from(v)).sum::<f64>()
            / green.len() as f64
            / f64::from(1.0 + RareLight::CERTAIN)
    });
    (means.collect(), spp)
}

#[test]
fn deciding_on_the_other_half_is_unbiased_and_deciding_on_its_own_is_not() {
    // Student's t with 15 degrees of freedom: 4.07 is the 99.9 % quantile, two-sided.
    let t = |means: &[f64]| {
        let n = means.len() as f64;
        let mean = means.iter().sum::<f64>() / n;
        let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean - 1.0) / (variance / n).sqrt()
    };
    let (means, spp) = rare_light_told_by([1, 0]);
    assert!(t(&means).abs() < 4.07, "{means:?}");
    // Some pixels stop and some go on, without which nothing would be decided.
    assert!((50.0..500.0).contains(&spp), "{spp}");
    // A standard error of one percent finds the naive rule's bias, of ten and more, every time.
    let (naive, _) = rare_light_told_by([0, 1]);
    assert!(t(&naive) < -6.0, "{naive:?}");
}

#[test]
fn adaptive_pictures_depend_on_neither_threads_nor_tiles_nor_passes() {
    let mut job = job(64);
    job.sampling.noise = crate::scene::NoiseTarget::new(0.08);
    let run = |threads, tile_order, sink: &dyn ProgressSink| {
        let options = RenderOptions { threads: Some(threads), tile_order, time_limit: None };
        let estimator = Estimator::Fixed(Box::new(RareLight));
        let rendering = execute(&job, estimator, &options, sink, &CancelToken::new()).unwrap();
        let adaptive = rendering.report.adaptive.unwrap();
        (adaptive, rendering.frame.channel("G").unwrap().to_vec())
    };
    let expected = run(1, TileOrder::Scanline, &Silent);
    assert!(run(3, TileOrder::Strided, &Silent) == expected);
    assert!(run(4, TileOrder::Reverse, &Slow) == expected);
}

#[test]
fn the_noise_that_is_reported_is_the_difference_to_the_exact_picture() {
    let mut job = job_with("independent", 1 << 14);
    for target in [0.3, 0.1] {
        job.sampling.noise = crate::scene::NoiseTarget::new(target);
        let estimator = Estimator::Fixed(Box::new(RareLight));
        let rendering =
            execute(&job, estimator, &RenderOptions::default(), &Silent, &CancelToken::new()).unwrap();
        let adaptive = rendering.report.adaptive.unwrap();
        let exact = f64::from(1.0 + RareLight::CERTAIN);
        let (mut squares, mut n) = (0.0, 0.0);
        for c in ["R", "G", "B"] {
            for v in rendering.frame.channel(c).unwrap() {
                squares += (f64::from(*v) / exact - 1.0).powi(2);
                n += 1.0;
            }
        }
        let true_noise = (squares / n).sqrt();
        // 960 pixels of about a normal error each: 2.3 % for the true noise, as much for its estimate, and 2 % for the outliers.
        assert!((adaptive.noise / true_noise - 1.0).abs() < 0.15, "{adaptive} but {true_noise}");
        // The doubling that just suffices leaves the noise of equal pixels within √2 of the target.
        assert!(
            true_noise < 1.15 * f64::from(target) && true_noise > 0.6 * f64::from(target),
            "{true_noise}"
        );
        assert!(!adaptive.stopped_by_maximum());
        let attribute = |name| rendering.frame.attribute(name).unwrap().parse::<f64>().unwrap();
        assert!((attribute("renderer.noise") - adaptive.noise).abs() < 1e-5);
        assert!((attribute("renderer.samplesPerPixel") - adaptive.mean_spp).abs() <= 0.5);
    }
}
