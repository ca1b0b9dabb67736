//! Light meters against closed forms.
//!
//! Lights of scale 1 have a luminance of 1 cd/m², an intensity of 1 cd or an illuminance of 1 lx, so that all expected numbers are
//! photometric.
#![allow(clippy::expect_used, reason = "tests fail by panicking")]

mod support;

use std::f64::consts::PI;
use steradian::lab::meters::lux::{self, measure_radiant, measure_spectral};
use steradian::lab::meters::{
    Aim, Aperture, LuminanceSettings, LuxReading, LuxSettings, MeterError, MeterPoint, MeterRay, Pixel,
    PixelSettings, Shown, luminance, pixel,
};
use steradian::lab::{Ending, Precision, Session};
use steradian::render::CancelToken;
use steradian::scene::RenderJob;
use steradian::units::Estimate;
use support::{SMALL_FILM, job};

/// A flat spectrum of the given value.
fn flat(value: f64) -> String {
    format!("[ 300 {value} 900 {value} ]")
}

fn scene(world: &str) -> RenderJob {
    job(&format!("{SMALL_FILM}\nLookAt 3 -2 1  0 0 0  0 0 1\nCamera \"perspective\"\nWorldBegin\n{world}"))
}

fn facing(position: [f64; 3], normal: [f64; 3]) -> MeterPoint {
    MeterPoint { position, normal }
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn precision(relative: f64) -> Precision {
    Precision { relative, confidence: 0.999, ..Precision::default() }
}

fn readings(
    job: &RenderJob,
    points: &[MeterPoint],
    settings: &LuxSettings,
    relative: f64,
) -> Vec<LuxReading> {
    let cancel = CancelToken::new();
    let session = Session { precision: precision(relative), seed: 7, threads: None, cancel: &cancel };
    lux::measure(job, points, settings, &session).expect("the points are valid")
}

/// Asserts that the reading is precise and holds `expected`, with 2·10⁻⁵ for f32 arithmetic.
#[track_caller]
fn assert_reads(reading: impl Shown, expected: f64, relative: f64) {
    let e = reading.estimates()[0];
    assert!(e.half_width <= relative * expected.abs() + 1e-9, "{e}, expected {expected}");
    assert!((e.value - expected).abs() <= e.half_width + 2e-5 * expected.abs(), "{e}, expected {expected}");
}

#[test]
fn a_point_light_follows_the_cosine_and_the_inverse_square() {
    let light = format!(
        "LightSource \"point\" \"point3 from\" [ 1 2 3 ] \"spectrum I\" {} \"float scale\" 50",
        flat(1.0)
    );
    let points = [
        facing([1.0, 2.0, 0.0], UP),
        facing([0.0, 0.0, 0.0], UP),
        facing([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        // Behind the sensor: the light does not count.
        facing([0.0, 0.0, 0.0], [0.0, 0.0, -2.0]),
    ];
    let r = readings(&scene(&light), &points, &LuxSettings::default(), 1e-3);
    let at_origin = |cos_r: f64| 50.0 * cos_r / 14.0_f64.powf(1.5);
    for (reading, expected) in r.iter().zip([50.0 / 9.0, at_origin(3.0), at_origin(1.0), 0.0]) {
        assert_reads(reading.total, expected, 1e-3);
        // None of the paths found any: bounded, not known to be none.
        let indirect = reading.indirect.estimate();
        assert!(indirect.value == 0.0 && indirect.half_width <= 2e-3 * expected, "{indirect}");
        assert!((indirect.half_width > 0.0) == (expected > 0.0), "{indirect}");
    }
    assert!(r[3].effort.note().is_some_and(|n| n.starts_with("dark")) && r[0].effort.note().is_none());
}

#[test]
fn a_disk_a_sky_and_a_sun_read_as_their_closed_forms() {
    // π L R²/(R² + h²), at h = 2 below a disk of radius 1.
    let disk = format!(
        "AreaLightSource \"diffuse\" \"spectrum L\" {} \"float scale\" 100
         ReverseOrientation Shape \"disk\" \"float height\" 2",
        flat(1.0)
    );
    let r = readings(&scene(&disk), &[facing([0.0; 3], UP)], &LuxSettings::default(), 2e-3);
    assert_reads(r[0].total, 100.0 * PI / 5.0, 2e-3);
    // π L, whichever way the meter faces; and E cosθ.
    let sky = format!("LightSource \"infinite\" \"spectrum L\" {} \"float scale\" 30", flat(1.0));
    let sun = format!(
        "LightSource \"distant\" \"point3 from\" [ 0 3 4 ] \"point3 to\" [ 0 0 0 ] \"spectrum L\" {} \"float scale\" 700",
        flat(1.0)
    );
    let points = [facing([5.0, 0.0, 1.0], UP), facing([0.0; 3], [1.0, -1.0, 0.3])];
    for reading in readings(&scene(&sky), &points, &LuxSettings::default(), 2e-3) {
        assert_reads(reading.direct, 30.0 * PI, 2e-3);
    }
    let r = readings(&scene(&sun), &points, &LuxSettings::default(), 2e-3);
    assert_reads(r[0].total, 700.0 * 0.8, 2e-3);
    assert_eq!(r[1].total.value(), 0.0);
    // A lamp and a sky share their samples: neither takes light from the other.
    let r = readings(&scene(&format!("{sky}\n{sun}\n{disk}")), &points[..1], &LuxSettings::default(), 2e-3);
    let seen = 100.0 * disk_beside(5.0, 1.0);
    // The disk hides as much of the sky as it fills, and its dark back is not seen from below.
    let hidden = disk_beside(5.0, 1.0);
    assert_reads(r[0].direct, 30.0 * (PI - hidden) + 560.0 + seen, 2e-3);
}

#[test]
fn a_scene_in_millimetres_reads_as_one_in_metres() {
    // 40 cd and 40 cd/m² are what they are; positions are in the scene's units.
    let job = job(&format!(
        "Option \"float metersperunit\" 0.001 {SMALL_FILM} WorldBegin
         LightSource \"point\" \"point3 from\" [ 0 0 2000 ] \"spectrum I\" {0} \"float scale\" 40
         AreaLightSource \"diffuse\" \"spectrum L\" {0} \"float scale\" 40
         Translate 0 0 4000 ReverseOrientation Shape \"disk\" \"float radius\" 2000",
        flat(1.0)
    ));
    let r = readings(&job, &[facing([0.0; 3], UP)], &LuxSettings::default(), 2e-3);
    assert_reads(r[0].direct, 10.0 + 40.0 * PI / 5.0, 2e-3);
}

/// ∫ cosθ dω of a disk of radius 1 whose plane is parallel to the meter's at distance `h`, its centre `d` off the meter's normal:
/// π F = ½ π (1 − (h² + d² − 1)/√((h² + d² + 1)² − 4 d²)).
fn disk_beside(d: f64, h: f64) -> f64 {
    let z = h * h + d * d;
    0.5 * PI * (1.0 - (z - 1.0) / ((z + 1.0).powi(2) - 4.0 * d * d).sqrt())
}

#[test]
fn a_rectangle_reads_as_lamberts_polygon_formula_and_from_its_front_only() {
    let rectangle = format!(
        "AreaLightSource \"diffuse\" \"spectrum L\" {} \"float scale\" 1000
         Shape \"trianglemesh\" \"point3 P\" [ 0 0 1  0 1 1  1 1 1  1 0 1 ] \"integer indices\" [ 0 1 2  0 2 3 ]",
        flat(1.0)
    );
    let points =
        [facing([0.0; 3], UP), facing([0.5, 0.5, 0.0], UP), facing([0.5, 0.5, 2.0], [0.0, 0.0, -1.0])];
    let r = readings(&scene(&rectangle), &points, &LuxSettings::default(), 2e-3);
    // Configuration factors of a unit square at unit distance, below its corner and below its centre.
    for (reading, factor) in r.iter().zip([0.138_531_605_99, 0.239_456_470_46, 0.0]) {
        assert_reads(reading.total, 1000.0 * PI * factor, 2e-3);
    }
}

#[test]
fn a_grey_furnace_tells_direct_and_indirect_light_apart() {
    for rho in [0.5, 0.8] {
        let furnace = format!(
            "ReverseOrientation
             AreaLightSource \"diffuse\" \"spectrum L\" {}
             Material \"diffuse\" \"spectrum reflectance\" {}
             Shape \"sphere\" \"float radius\" 4",
            flat(1.0),
            flat(rho)
        );
        let settings = LuxSettings { aim: Aim::Parts, ..LuxSettings::default() };
        let r = readings(&scene(&furnace), &[facing([0.0, 1.0, 2.0], [1.0, 2.0, 3.0])], &settings, 0.01);
        assert_reads(r[0].direct, PI, 0.01);
        assert_reads(r[0].indirect, PI * rho / (1.0 - rho), 0.01);
        assert_reads(r[0].total, PI / (1.0 - rho), 0.01);
        // One bounce: the first term of the series.
        let once = LuxSettings { max_depth: 1, ..settings };
        let r = readings(&scene(&furnace), &[facing([0.0; 3], UP)], &once, 0.01);
        assert_reads(r[0].indirect, PI * rho, 0.01);
    }
}

/// A cube of 4 m around the origin, of reflectance ρ, with an isotropic source of 10 000 lm in its middle.
fn cube(rho: f64) -> RenderJob {
    scene(&format!(
        "LightSource \"point\" \"spectrum I\" {} \"float power\" 10000
         Material \"diffuse\" \"spectrum reflectance\" {}
         Shape \"trianglemesh\"
           \"point3 P\" [ -2 -2 -2  2 -2 -2  -2 2 -2  2 2 -2  -2 -2 2  2 -2 2  -2 2 2  2 2 2 ]
           \"integer indices\" [ 0 1 3 0 3 2  4 7 5 4 6 7  0 5 1 0 4 5  2 3 7 2 7 6  0 2 6 0 6 4  1 7 3 1 5 7 ]",
        flat(1.0),
        flat(rho)
    ))
}

#[test]
fn interreflection_in_a_cube_has_the_pointwise_illuminance_of_the_radiosity_solution() {
    // Collocation with exact polygon factors; its own error is 10⁻³ of the mean. Meters lie on the floor itself.
    for (rho, centre, corner) in [(0.2, 28.877, 17.297), (0.5, 112.038, 77.032), (0.8, 430.959, 359.811)] {
        let points = [facing([0.0, 0.0, -2.0], UP), facing([1.9, 1.9, -2.0], UP)];
        let settings = LuxSettings { aim: Aim::Parts, ..LuxSettings::default() };
        let r = readings(&cube(rho), &points, &settings, 0.004);
        for (reading, expected) in r.iter().zip([centre, corner]) {
            let e = reading.indirect.estimate();
            assert!(e.half_width < 0.004 * expected, "{e}");
            assert!((e.value - expected).abs() < 0.005 * expected, "{e}, expected {expected}");
        }
        assert_reads(r[0].direct, 10_000.0 / (4.0 * PI) / 4.0, 0.004);
    }
}

#[test]
fn watts_and_spectra_are_those_of_the_source() {
    // E_λ = I_λ/r² with an absolute spectral intensity that rises from 0 at 300 nm to 6 at 900 nm.
    let light = "LightSource \"point\" \"point3 from\" [ 0 0 2 ] \"spectrum I\" [ 300 0 900 6 ] \"string unit\" \"intensity\"";
    let job = scene(light);
    let cancel = CancelToken::new();
    let session = Session { precision: precision(1e-3), seed: 1, threads: Some(1), cancel: &cancel };
    let at = [facing([0.0; 3], UP)];
    let r = measure_radiant(&job, &at, &LuxSettings::default(), &session).expect("valid");
    let watts = 0.005 * ((830.0_f64 - 300.0).powi(2) - 60.0_f64.powi(2)) / 4.0;
    assert!((r[0].total.value() / watts - 1.0).abs() < 1e-3, "{} {watts}", r[0].total);
    let wavelengths = [320.0, 400.0, 555.5, 700.0, 880.0];
    let r = measure_spectral(&job, &at, &wavelengths, &LuxSettings::default(), &session).expect("valid");
    assert_eq!(r[0].total.len(), 5);
    for (reading, lambda) in r[0].total.iter().zip(wavelengths) {
        let expected = 0.01 * (f64::from(lambda) - 300.0) / 4.0;
        assert!((reading.value() / expected - 1.0).abs() < 1e-5, "{lambda}: {reading}");
    }
}

#[test]
fn light_through_dispersing_glass_reaches_a_meter_at_each_wavelength() {
    // A lossless shell is invisible in a uniform sky, whatever it disperses: E_λ = π L_λ.
    let world = "LightSource \"infinite\" \"spectrum L\" [ 300 2 900 2 ] \"string unit\" \"radiance\"
        Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"
        Translate 0 0 3 Shape \"sphere\" \"float radius\" 2";
    let cancel = CancelToken::new();
    let session = Session { precision: precision(0.01), seed: 1, threads: None, cancel: &cancel };
    let at = [facing([0.0; 3], UP)];
    let wavelengths = [410.0, 480.0, 550.0, 620.0, 690.0];
    let r =
        measure_spectral(&scene(world), &at, &wavelengths, &LuxSettings::default(), &session).expect("valid");
    for reading in &r[0].total {
        assert!(reading.estimate().holds(2.0 * PI) && reading.estimate().relative() <= 0.01, "{reading}");
    }
    assert!(r[0].indirect[0].value() > 1.0, "much of it comes through the glass");
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let job = scene(
        "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" Shape \"sphere\"",
    );
    let cancel = CancelToken::new();
    let session = Session { precision: precision(0.01), seed: 1, threads: None, cancel: &cancel };
    let fails =
        |p: MeterPoint| lux::measure(&job, &[facing([0.0; 3], UP), p], &LuxSettings::default(), &session);
    assert_eq!(fails(facing([0.0; 3], [0.0; 3])), Err(MeterError::NoDirection(1)));
    assert_eq!(fails(facing([f64::NAN, 0.0, 0.0], UP)), Err(MeterError::NotFinite(1)));
    assert_eq!(fails(facing([1e300, 0.0, 0.0], UP)), Err(MeterError::NotFinite(1)));
    let spectral = |l: &[f32]| measure_spectral(&job, &[], l, &LuxSettings::default(), &session).map(|_| ());
    assert_eq!(spectral(&[]), Err(MeterError::NoWavelengths));
    assert_eq!(spectral(&[-5.0]), Err(MeterError::NoWavelength(-5.0)));
    assert!(matches!(spectral(&[5000.0]), Err(MeterError::NoData { .. })), "{:?}", spectral(&[5000.0]));
    let classic = support::job(&format!("{SMALL_FILM} Integrator \"classic\"\nWorldBegin\nShape \"sphere\""));
    let refused = lux::measure(&classic, &[], &LuxSettings::default(), &session);
    assert_eq!(refused, Err(MeterError::NotTransport));
}

#[test]
fn a_cancelled_session_reads_no_further_points_and_threads_change_nothing() {
    let job = cube(0.5);
    let points = [facing([0.0, 0.0, -2.0], UP), facing([1.0, 0.0, 1.0], UP)];
    let cancel = CancelToken::new();
    let with =
        |threads| Session { precision: precision(0.02), seed: 3, threads: Some(threads), cancel: &cancel };
    let one = lux::measure(&job, &points, &LuxSettings::default(), &with(1)).expect("valid");
    let three = lux::measure(&job, &points, &LuxSettings::default(), &with(3)).expect("valid");
    assert_eq!(one, three);
    assert!(one.iter().all(|r| r.effort.ending == Ending::Precise));
    let table = lux::table(&points, &one, &[], lux::Layout::Split, &LuxSettings::default(), &with(1));
    assert_eq!(table.rows.len(), 2);
    cancel.cancel();
    let none = lux::measure(&job, &points, &LuxSettings::default(), &with(1)).expect("valid");
    assert!(none.is_empty());
}

fn spot(position: [f64; 3], direction: [f64; 3]) -> MeterRay {
    MeterRay { position, direction }
}

#[test]
fn a_luminance_meter_reads_sources_walls_and_the_mean_over_its_cone() {
    // A source of 1000 cd/m² that fills the plane z = 1 up to x = 0, over a table of reflectance 0.3.
    let world = format!(
        "AttributeBegin
           AreaLightSource \"diffuse\" \"spectrum L\" {} \"float scale\" 1000
           Shape \"trianglemesh\" \"point3 P\" [ -900 -900 1  -900 900 1  0 900 1  0 -900 1 ]
             \"integer indices\" [ 0 1 2  0 2 3 ]
         AttributeEnd
         Material \"diffuse\" \"spectrum reflectance\" {}
         Shape \"disk\" \"float radius\" 0.001",
        flat(1.0),
        flat(0.3)
    );
    let job = scene(&world);
    let cancel = CancelToken::new();
    let session = Session { precision: precision(2e-3), seed: 2, threads: None, cancel: &cancel };
    let read = |ray: MeterRay, acceptance: f64, aperture: f64| {
        let settings = LuminanceSettings { acceptance, aperture, ..LuminanceSettings::default() };
        luminance::measure(&job, &[ray], &settings, &session).expect("valid")[0].clone()
    };
    let up = [0.0, 0.0, 3.0];
    assert_reads(read(spot([-1.0, 0.0, 0.5], up), 1.0, 0.0).mean, 1000.0, 2e-3);
    // At the edge half of the cone sees the source, and so does half of the pupil.
    assert_reads(read(spot([0.0, 0.0, 0.5], up), 20.0, 0.0).mean, 500.0, 2e-3);
    assert_reads(read(spot([0.0, 0.0, 0.5], up), 0.0, 0.1).mean, 500.0, 2e-3);
    // The edge appears 60° off the axis: just outside of the cone, the source on the one side and nothing on the other.
    assert_reads(read(spot([-0.5 * 3.0_f64.sqrt(), 0.0, 0.5], up), 119.0, 0.0).mean, 1000.0, 2e-3);
    assert_eq!(read(spot([0.5 * 3.0_f64.sqrt(), 0.0, 0.5], up), 119.0, 0.0).mean.value(), 0.0);
    // The table sees the half of its sky: L = ρ E/π with E = π L/2, the source's far edge apart.
    assert_reads(read(spot([0.0, 0.0, 0.5], [0.0, 0.0, -1.0]), 0.0, 0.0).mean, 150.0, 2e-3);
    let sideways = read(spot([1e-4, 0.0, 0.1], [0.0, 0.0, -1.0]), 0.01, 1e-4);
    assert!((sideways.mean.value() / 150.0 - 1.0).abs() < 4e-3, "{}", sideways.mean);
    for (acceptance, aperture) in
        [(-1.0, 0.0), (181.0, 0.0), (f64::NAN, 0.0), (1.0, -1.0), (1.0, f64::INFINITY)]
    {
        let settings = LuminanceSettings { acceptance, aperture, ..LuminanceSettings::default() };
        assert!(luminance::measure(&job, &[], &settings, &session).is_err(), "{settings:?}");
    }
}

#[test]
fn radiance_and_spectral_radiance_are_those_of_the_source() {
    let job = scene("LightSource \"infinite\" \"spectrum L\" [ 300 0 900 6 ] \"string unit\" \"radiance\"");
    let cancel = CancelToken::new();
    let session = Session { precision: precision(1e-3), seed: 1, threads: Some(1), cancel: &cancel };
    let rays = [spot([0.0; 3], UP)];
    let settings = LuminanceSettings::default();
    let r = luminance::measure_radiant(&job, &rays, &settings, &session).expect("valid");
    let watts = 0.005 * ((830.0_f64 - 300.0).powi(2) - 60.0_f64.powi(2));
    assert!((r[0].mean.value() / watts - 1.0).abs() < 1e-3, "{} {watts}", r[0].mean);
    let r = luminance::measure_spectral(&job, &rays, &[400.0, 700.0], &settings, &session).expect("valid");
    assert!((r[0].mean[0].value() - 1.0).abs() < 1e-5 && (r[0].mean[1].value() - 4.0).abs() < 1e-5);
}

/// Whether 95 % intervals hold `truth` in 92–98 % of 400 measurements that stop by themselves, each with its own seed.
#[track_caller]
fn assert_honest(truth: f64, relative: f64, measure: impl Fn(&Session<'_>) -> (Estimate, Ending)) {
    const RUNS: u64 = 400;
    let cancel = CancelToken::new();
    let held = (0..RUNS).filter(|&seed| {
        let precision = Precision { relative, ..Precision::default() };
        let (read, ending) = measure(&Session { precision, seed, threads: None, cancel: &cancel });
        assert!(ending == Ending::Precise && read.half_width > 0.0 && read.relative() <= relative, "{read}");
        read.holds(truth)
    });
    let share = held.count() as f64 / RUNS as f64;
    assert!((0.92..=0.98).contains(&share), "{share} of the intervals hold {truth}");
}

#[test]
fn intervals_of_the_luxmeter_are_honest_although_it_decides_when_to_stop() {
    // A sphere of radius 2 around a source of 1000 lm: direct light Φ/A and, anywhere, Φ ρ/(A (1 − ρ)) besides.
    let job = scene(&format!(
        "LightSource \"point\" \"spectrum I\" {} \"float power\" 1000
         Material \"diffuse\" \"spectrum reflectance\" {}
         Shape \"sphere\" \"float radius\" 2",
        flat(1.0),
        flat(0.6)
    ));
    let points = [facing([0.0, 1.6, 1.2], [0.0, -1.6, -1.2])];
    let indirect = 1000.0 / (16.0 * PI) * 0.6 / 0.4;
    let settings = LuxSettings { aim: Aim::Parts, ..LuxSettings::default() };
    assert_honest(indirect, 0.02, |session| {
        let r = &lux::measure(&job, &points, &settings, session).expect("valid")[0];
        (r.indirect.estimate(), r.effort.ending)
    });
}

#[test]
fn intervals_of_the_luminance_meter_are_honest_although_it_decides_when_to_stop() {
    // A furnace, L = Le/(1 − ρ).
    let job = scene(&format!(
        "ReverseOrientation
         AreaLightSource \"diffuse\" \"spectrum L\" {}
         Material \"diffuse\" \"spectrum reflectance\" {}
         Shape \"sphere\" \"float radius\" 3",
        flat(1.0),
        flat(0.6)
    ));
    let rays = [spot([0.0, 1.0, 0.5], [1.0, -1.0, 2.0])];
    assert_honest(2.5, 0.02, |session| {
        let r = &luminance::measure(&job, &rays, &LuminanceSettings::default(), session).expect("valid")[0];
        (r.mean.estimate(), r.effort.ending)
    });
}

/// Mean of cos⁴θ over the slopes of a square pixel, [x, x + side] × [y, y + side], and over a lens of radius `r` = R/v, by the midpoint
/// rule.
fn falloff(x: f64, y: f64, side: f64, r: f64) -> f64 {
    let middle = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let mut sum = 0.0;
    for (i, j) in (0..32).flat_map(|i| (0..32).map(move |j| (i, j))) {
        let (sx, sy) = (x + side * middle(i, 32), y + side * middle(j, 32));
        for (k, l) in (0..32).flat_map(|k| (0..16).map(move |l| (k, l))) {
            let (radius, phi) = (r * middle(k, 32).sqrt(), 2.0 * PI * middle(l, 16));
            let (dx, dy) = (sx + radius * phi.cos(), sy + radius * phi.sin());
            sum += (1.0 + dx * dx + dy * dy).powi(-2);
        }
    }
    sum / f64::from(1024 * 512)
}

#[test]
fn a_pixel_receives_light_by_f_number_and_the_fourth_power_of_the_cosine() {
    // 8 × 8 pixels over slopes from −1 to 1.
    let under_sky = |camera: &str| {
        job(&format!(
            "{SMALL_FILM} Camera {camera} WorldBegin
             LightSource \"infinite\" \"spectrum L\" {} \"float scale\" 200",
            flat(1.0)
        ))
    };
    let cancel = CancelToken::new();
    let session = Session { precision: precision(1e-3), seed: 4, threads: None, cancel: &cancel };
    let pixels = [Pixel { x: 0, y: 0 }, Pixel { x: 4, y: 4 }, Pixel { x: 7, y: 3 }];
    let slopes = [[-1.0, -1.0], [0.0, 0.0], [0.75, -0.25]];
    let job = under_sky("\"perspective\" \"float fov\" 90");
    let settings = PixelSettings::behind(Aperture::FNumber(2.8));
    let r = pixel::measure(&job, &pixels, &settings, &session).expect("valid");
    for (reading, [x, y]) in r.iter().zip(slopes) {
        assert_reads(reading.arriving, 200.0 * PI / (4.0 * 2.8 * 2.8) * falloff(x, y, 0.25, 0.0), 1.1e-3);
        assert!((reading.seen.value() / 200.0 - 1.0).abs() < 1e-3, "pictures have no falloff");
    }
    // A lens as wide as it is far from the film, which spans 2 by 2: N = 1/2. On its axis H = π L R²/(R² + v²).
    assert!((falloff(0.0, 0.0, 0.0, 1.0) - 0.5).abs() < 1e-3);
    let job = under_sky("\"perspective\" \"float fov\" 90 \"float lensradius\" 1 \"float focaldistance\" 5");
    let film = Aperture::Film(8.0_f64.sqrt());
    assert!((pixel::f_number(&job, film).expect("a lens") - 0.5).abs() < 1e-5);
    let r = pixel::measure(&job, &pixels, &PixelSettings::behind(film), &session).expect("valid");
    for (reading, [x, y]) in r.iter().zip(slopes) {
        assert_reads(reading.arriving, 200.0 * PI * falloff(x, y, 0.25, 1.0), 2e-3);
    }

    let refused = |camera: &str, aperture| {
        pixel::measure(&under_sky(camera), &pixels, &PixelSettings::behind(aperture), &session).map(|_| ())
    };
    assert_eq!(refused("\"perspective\"", Aperture::Film(0.035)), Err(MeterError::Pinhole));
    assert_eq!(refused("\"perspective\"", Aperture::FNumber(0.0)), Err(MeterError::ImagePlane(0.0)));
    let parallel = refused("\"orthographic\"", Aperture::FNumber(2.0));
    assert_eq!(parallel, Err(MeterError::NoImagePlane("orthographic")));
    let off = pixel::measure(&job, &[Pixel { x: 8, y: 0 }], &settings, &session);
    assert_eq!(off, Err(MeterError::OffFilm { x: 8, y: 0, width: 8, height: 8 }));
}
