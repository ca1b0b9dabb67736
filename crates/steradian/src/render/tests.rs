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
    let text = format!(
        r#"Film "rgb" "integer xresolution" 40 "integer yresolution" 24
        Sampler "zsobol" "integer pixelsamples" {spp}
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
