//! The same scene and seed give the same bits, whatever executes them.
#![allow(clippy::expect_used, reason = "tests fail by panicking")]

#[path = "support/specimens.rs"]
mod specimens;

use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;
use steradian::color::UpsamplingTables;
use steradian::image::Frame;
use steradian::render::{CancelToken, Progress, ProgressSink, RenderOptions, Silent, TileOrder};
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{RenderJob, compile_with_tables};

/// A little of everything that draws random numbers: lens, motion, filter, textures, layers, dispersion, roulette, and lights
/// of all kinds. 40 × 24 pixels are six tiles, four of them cut.
fn scene(sampler: &str) -> String {
    format!(
        r#"
LookAt 0 1 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 45 "float lensradius" .05 "float focaldistance" 5
Film "gbuffer" "integer xresolution" 40 "integer yresolution" 24
Sampler {sampler}
PixelFilter "mitchell"
Integrator "path" "integer maxdepth" 8
WorldBegin
LightSource "infinite" "string filename" "square.exr" "float scale" .3
LightSource "spot" "point3 from" [ 2 3 -2 ] "point3 to" [ 0 0 0 ] "float scale" 20
AttributeBegin
    Translate 0 3 0
    Rotate 90 1 0 0
    AreaLightSource "diffuse" "rgb L" [ 1 .9 .7 ] "float scale" 5
    Shape "disk" "float radius" .5
AttributeEnd
Texture "bumps" "float" "fbm" "float roughness" .4
Texture "photo" "spectrum" "imagemap" "string filename" "photo.jpg" "float uscale" 3
Texture "board" "spectrum" "checkerboard" "texture tex1" "photo" "rgb tex2" [ .2 .3 .7 ] "float uscale" 6 "float vscale" 6
AttributeBegin
    Translate 0 -1 0
    Rotate 90 1 0 0
    Material "diffuse" "texture reflectance" "board" "texture displacement" "bumps"
    Shape "disk" "float radius" 6
AttributeEnd
AttributeBegin
    Translate -1.3 0 0
    Material "coateddiffuse" "texture reflectance" "photo" "float roughness" .2 "float thickness" .1
        "rgb albedo" [ .5 .5 .5 ] "integer nsamples" 2
    Shape "sphere" "float radius" .9
AttributeEnd
AttributeBegin
    Material "dielectric" "spectrum eta" "glass-F11"
    ActiveTransform EndTime
    Translate .4 .2 0
    ActiveTransform All
    Shape "sphere" "float radius" .6
AttributeEnd
AttributeBegin
    Translate 1.5 0 .5
    Material "conductor" "float roughness" .1
    Shape "loopsubdiv" "integer levels" 2 "integer indices" [ 0 1 2  0 3 1  1 3 2  2 3 0 ]
        "point3 P" [ -1 -1 0  1 -1 0  0 1 0  0 0 1 ]
AttributeEnd
"#
    )
}

const ZSOBOL: &str = r#""zsobol" "integer pixelsamples" 4"#;
const INDEPENDENT: &str = r#""independent" "integer pixelsamples" 4"#;

fn job(sampler: &str, tables: &UpsamplingTables) -> RenderJob {
    let files = specimens::file_system(&specimens::files());
    let text = scene(sampler);
    let input = Input::Text { name: "scene.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    let mut imported = import(&[input], &files);
    let desc = imported.scene.take();
    let job = desc.and_then(|d| compile_with_tables(d, &files, tables, &mut imported.diagnostics));
    assert!(imported.diagnostics.is_empty(), "{}", imported.diagnostics.display(&imported.sources));
    job.expect("a scene without errors compiles")
}

fn render(job: &RenderJob, options: &RenderOptions, sink: &dyn ProgressSink, cancel: &CancelToken) -> Frame {
    steradian::render::render(job, options, sink, cancel).expect("the film is valid").frame
}

fn rendered(job: &RenderJob) -> Frame {
    render(job, &RenderOptions::default(), &Silent, &CancelToken::new())
}

/// The bits of all channels.
fn bits(frame: &Frame) -> Vec<u32> {
    frame.channels().iter().flat_map(|c| c.values.iter().map(|v| v.to_bits())).collect()
}

#[test]
fn threads_and_the_order_of_tiles_leave_the_picture_as_it_is() {
    let tables = UpsamplingTables::new();
    for sampler in [ZSOBOL, INDEPENDENT, r#""halton" "integer pixelsamples" 4"#, r#""stratified""#] {
        let job = job(sampler, &tables);
        let expected = bits(&rendered(&job));
        for threads in [1, 2, 5] {
            for tile_order in [TileOrder::Scanline, TileOrder::Reverse, TileOrder::Strided] {
                let options =
                    RenderOptions { threads: Some(threads), tile_order, ..RenderOptions::default() };
                let found = bits(&render(&job, &options, &Silent, &CancelToken::new()));
                assert!(found == expected, "{sampler}, {threads} threads, {tile_order:?}");
            }
        }
    }
}

#[test]
fn the_instructions_of_the_processor_leave_the_picture_as_it_is() {
    let tables = UpsamplingTables::new();
    for sampler in [ZSOBOL, INDEPENDENT] {
        let mut job = job(sampler, &tables);
        let expected = bits(&rendered(&job));
        job.scene = job.scene.portable();
        assert!(bits(&rendered(&job)) == expected, "{sampler}");
    }
}

#[test]
fn compiling_again_gives_the_same_scene() {
    let (one, other) = (UpsamplingTables::new(), UpsamplingTables::new());
    assert!(bits(&rendered(&job(ZSOBOL, &one))) == bits(&rendered(&job(ZSOBOL, &other))));
}

#[test]
fn another_seed_gives_another_picture() {
    let mut job = job(ZSOBOL, &UpsamplingTables::new());
    let pictures = [0, 1, 2].map(|seed| {
        job.sampling.seed = seed;
        bits(&rendered(&job))
    });
    assert!(pictures[0] != pictures[1] && pictures[0] != pictures[2] && pictures[1] != pictures[2]);
}

/// Sleeps through the first pass, so that the second one is short, and notes how many samples each pixel had when it ended.
struct Sleepy {
    until: u64,
    seen: Mutex<Vec<u64>>,
}

impl ProgressSink for Sleepy {
    fn update(&self, p: &Progress) {
        if p.samples_done <= self.until {
            std::thread::sleep(Duration::from_millis(300));
        }
        self.seen.lock().expect("no thread panics").push(p.samples_done);
    }
}

#[test]
fn the_length_of_passes_leaves_the_picture_as_it_is() {
    let job = job(ZSOBOL, &UpsamplingTables::new());
    let options = RenderOptions { threads: Some(1), ..RenderOptions::default() };
    let record = |until: u64| {
        let sink = Sleepy { until, seen: Mutex::new(Vec::new()) };
        let picture = bits(&render(&job, &options, &sink, &CancelToken::new()));
        (picture, sink.seen.into_inner().expect("no thread panics"))
    };
    // Six tiles a pass: the last updates tell how long the passes were.
    let (slow, slow_passes) = record(40 * 24);
    let (fast, fast_passes) = record(0);
    assert_ne!(slow_passes, fast_passes);
    assert!(slow == fast);
}

/// Stops the render as soon as something has been rendered.
struct Impatient<'a>(&'a CancelToken);

impl ProgressSink for Impatient<'_> {
    fn update(&self, _: &Progress) {
        self.0.cancel();
    }
}

#[test]
fn a_stopped_render_is_the_render_of_fewer_samples() {
    let mut job = job(INDEPENDENT, &UpsamplingTables::new());
    let cancel = CancelToken::new();
    let stopped = render(&job, &RenderOptions::default(), &Impatient(&cancel), &cancel);
    assert_eq!(stopped.attribute("renderer.samplesPerPixel"), Some("1"));
    job.sampling.spp = 1;
    assert!(bits(&stopped) == bits(&rendered(&job)));
}
