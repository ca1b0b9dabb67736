use super::*;
use crate::lab::probe::Angles;
use crate::lab::{Ending, Precision, Session, Subject};
use crate::optics::hemispherical::diffuse_reflectance;
use crate::render::CancelToken;
use crate::scene::import::pbrt::{Input, import};
use crate::scene::{Diagnostics, MemoryFiles, RenderJob, compile};
use std::path::Path;

fn job() -> RenderJob {
    let text = "WorldBegin
        MakeNamedMaterial \"paper\" \"string type\" \"diffusetransmission\"
            \"spectrum reflectance\" [ 300 0.2 900 0.8 ] \"spectrum transmittance\" [ 300 0.1 900 0.1 ]
        MakeNamedMaterial \"pane\" \"string type\" \"stack\" \"float thickness\" 1e-3 \"float eta\" 1.5
        MakeNamedMaterial \"tinted\" \"string type\" \"stack\" \"float thickness\" 1e-3 \"float eta\" 1.5
            \"float absorption\" 100
        MakeNamedMaterial \"glass\" \"string type\" \"dielectric\" \"float eta\" 1.5
        MakeNamedMaterial \"mirror\" \"string type\" \"perfectmirror\" \"spectrum reflectance\" [ 300 0.6 900 0.6 ]
        MakeNamedMaterial \"metal\" \"string type\" \"conductor\" \"float roughness\" 0.5
        MakeNamedMaterial \"coat\" \"string type\" \"coateddiffuse\" \"float roughness\" 0.3 \"integer maxdepth\" 100
        MakeNamedMaterial \"printed\" \"string type\" \"modifiedphong\" \"string lobe\" \"halfway\"
            \"string normalization\" \"printed\" \"spectrum diffuse\" [ 300 0 900 0 ] \"spectrum specular\" [ 300 1 900 1 ]";
    let input = Input::Text { name: "test", bytes: text.as_bytes(), base: Path::new("") };
    let scene = import(&[input], &MemoryFiles::default()).scene.unwrap();
    compile(scene, &MemoryFiles::default(), &mut Diagnostics::default()).unwrap()
}

fn beam(theta: f64) -> Incidence {
    Incidence::Beam(Angles { theta, phi: 0.0 })
}

fn setup(incidences: &[Incidence], method: Method) -> Setup {
    let wavelengths = vec![450.0, 600.0];
    Setup { wavelengths, incidences: incidences.to_vec(), method, view: None, sphere: None }
}

#[track_caller]
fn read(job: &RenderJob, name: &str, setup: &Setup, precision: Precision) -> Spectrum {
    let cancel = CancelToken::new();
    let session = Session { precision, seed: 11, threads: None, cancel: &cancel };
    measure(&Subject::find(job, name).unwrap(), setup, &session).unwrap()
}

/// Intervals that chance leaves once in a million numbers.
fn sure(relative: f64) -> Precision {
    Precision { relative, confidence: 1.0 - 1e-6, ..Precision::default() }
}

#[test]
fn plates_have_the_checked_shares() {
    let job = job();
    for (name, theta, r, t) in [
        ("pane", 0.0, 0.076_923_1, 0.923_076_9),
        ("pane", 45.0, 0.092_656, 0.907_344),
        ("pane", 60.0, 0.151_872, 0.848_128),
        ("pane", 75.0, 0.381_851, 0.618_149),
        ("tinted", 0.0, 0.070_221, 0.834_992),
        ("tinted", 60.0, 0.137_917, 0.748_214),
    ] {
        let spectrum = read(&job, name, &setup(&[beam(theta)], Method::Auto), Precision::default());
        assert!(!spectrum.by_sampling && spectrum.rays == 0);
        for reading in &spectrum.readings {
            let [found_r, found_t] = [reading.reflectance.value, reading.transmittance.value];
            assert!((found_r - r).abs() < 1e-6 && (found_t - t).abs() < 1e-6, "{name} {theta}: {reading:?}");
            assert!((reading.absorptance.value - (1.0 - r - t)).abs() < 2e-6);
        }
    }
}

#[test]
fn photons_agree_with_closed_forms_and_end_once() {
    let job = job();
    let incidences = [
        beam(8.0),
        beam(60.0),
        beam(120.0),
        Incidence::Diffuse(Face::Above),
        Incidence::Diffuse(Face::Below),
    ];
    for name in ["paper", "tinted", "glass", "mirror"] {
        let exact = read(&job, name, &setup(&incidences, Method::Exact), Precision::default());
        // 40 intervals of each material: one in 25 000 runs leaves the truth out.
        let sampled = read(&job, name, &setup(&incidences, Method::Sampled), sure(0.05));
        assert_eq!(sampled.ending, Ending::Precise);
        for (e, s) in exact.readings.iter().zip(&sampled.readings) {
            for (exact, sampled) in [
                (e.reflectance, s.reflectance),
                (e.transmittance, s.transmittance),
                (e.absorptance, s.absorptance),
            ] {
                assert!(sampled.holds(exact.value), "{name} {:?}: {exact:?} {sampled:?}", e.incidence);
                assert!(sampled.half_width <= 0.05 * sampled.value.max(0.01));
            }
            assert_eq!(s.sum.map(|s| s.value), Some(1.0));
        }
    }
}

#[test]
fn diffuse_light_is_reflected_by_the_mean_of_fresnels_formula() {
    let job = job();
    let both = [Incidence::Diffuse(Face::Above), Incidence::Diffuse(Face::Below)];
    let spectrum = read(&job, "glass", &setup(&both, Method::Exact), Precision::default());
    let [above, below] = [0, 2].map(|i| spectrum.readings[i].reflectance.value);
    assert!((above - diffuse_reflectance(1.5)).abs() < 1e-6, "{above}");
    // With the kink at the critical angle.
    assert!((below - diffuse_reflectance(1.0 / 1.5)).abs() < 2e-5, "{below}");
}

#[test]
fn walks_and_lobes_keep_their_energy_and_a_printed_misnormalisation_does_not() {
    let job = job();
    for name in ["coat", "metal"] {
        let spectrum = read(&job, name, &setup(&[beam(45.0)], Method::Auto), sure(0.02));
        let reading = &spectrum.readings[0];
        assert!(spectrum.by_sampling && reading.sum.unwrap().value == 1.0, "{name}: {reading:?}");
        assert!(reading.absorptance.value > 0.05, "{name}");
    }
    // B (2.35) to the letter returns more than arrives.
    let printed = read(&job, "printed", &setup(&[beam(0.0)], Method::Sampled), sure(0.05));
    let sum = printed.readings[0].sum.unwrap();
    assert!(printed.unbalanced && sum.value - sum.half_width > 1.5, "{sum:?}");
    assert!(printed.table().to_csv().contains("# balance"));
}

#[test]
fn the_reflectance_factor_compares_with_a_perfect_diffuser() {
    let job = job();
    let view = |theta: f64, phi: f64| Some(View { direction: Angles { theta, phi }, half_angle: 10.0 });
    let factor = |name: &str, view: Option<View>, incidence: Incidence| {
        let setup = Setup { view, wavelengths: vec![600.0], ..setup(&[incidence], Method::Auto) };
        read(&job, name, &setup, sure(0.05)).readings[0].factor.unwrap()
    };
    // ρ = 0.5 at 600 nm, wherever the light comes from and the detector stands.
    for (theta, from) in [(0.0, beam(45.0)), (50.0, beam(8.0)), (30.0, beam(150.0))] {
        let found = factor("paper", view(theta, 70.0), from);
        assert!(found.holds(0.5), "{found:?}");
    }
    // A mirror sends all of 0.6 into the cone that a perfect diffuser gives sin²κ cosθ.
    let found = factor("mirror", view(30.0, 180.0), beam(30.0));
    let expected = 0.6 / (10.0_f64.to_radians().sin().powi(2) * 30.0_f64.to_radians().cos());
    assert!(found.holds(expected), "{found:?} {expected}");
    assert_eq!(factor("mirror", view(30.0, 90.0), beam(30.0)).value, 0.0);
}

#[test]
fn a_single_beam_reads_too_low_by_the_darkened_sphere_and_a_double_beam_does_not() {
    let job = job();
    let sphere = Sphere { wall: 0.98, port: 0.02, standard: 1.0, beams: Beams::Single };
    let at = |beams| Setup {
        sphere: Some(Sphere { beams, ..sphere }),
        wavelengths: vec![600.0],
        ..setup(&[beam(8.0)], Method::Exact)
    };
    let single = read(&job, "paper", &at(Beams::Single), Precision::default());
    let found = single.readings[0].sphere.unwrap();
    // 1 − 0.9604 − 0.02 ρ, with ρ = 1 and then 0.5.
    assert!((found.reflectance.ratio.value - 0.0196 / 0.0296).abs() < 1e-5);
    assert!((found.reflectance.reading.value - 0.5 * 0.0196 / 0.0296).abs() < 1e-5);
    assert!((found.transmittance.ratio.value - 0.0396 / 0.0296).abs() < 1e-5);
    let double = read(&job, "paper", &at(Beams::Double), Precision::default());
    let found = double.readings[0].sphere.unwrap();
    assert_eq!(found.reflectance.reading, double.readings[0].reflectance);
    assert!(single.table().to_csv().contains("multiplier 24.74747"));
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let job = job();
    let paper = Subject::find(&job, "paper").unwrap();
    let setup = Setup { wavelengths: vec![450.0], ..setup(&[beam(8.0)], Method::Sampled) };
    let cancel = CancelToken::new();
    let precision = Precision { relative: 0.04, ..Precision::default() };
    let runs = 400;
    let mut held = [0_u32; 3];
    for seed in 0..runs {
        let session = Session { precision, seed, threads: Some(1), cancel: &cancel };
        let reading = measure(&paper, &setup, &session).unwrap().readings[0];
        let found = [reading.reflectance, reading.transmittance, reading.absorptance];
        for (count, (estimate, truth)) in held.iter_mut().zip(found.iter().zip([0.35, 0.1, 0.55])) {
            *count += u32::from(estimate.holds(truth));
        }
    }
    // 92 to 98 % of the runs.
    assert!(held.iter().all(|h| (368..=392).contains(h)), "{held:?}");
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let job = job();
    let coat = Subject::find(&job, "coat").unwrap();
    let cancel = CancelToken::new();
    let precision = Precision { relative: 0.05, ..Precision::default() };
    let with = |threads| {
        let session = Session { precision, seed: 5, threads: Some(threads), cancel: &cancel };
        measure(&coat, &setup(&[beam(8.0)], Method::Sampled), &session).unwrap()
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn what_cannot_be_measured_is_said() {
    let job = job();
    let cancel = CancelToken::new();
    let session = Session { precision: Precision::default(), seed: 0, threads: None, cancel: &cancel };
    let said = |name: &str, setup: &Setup| {
        measure(&Subject::find(&job, name).unwrap(), setup, &session).unwrap_err().to_string()
    };
    let plain = setup(&[beam(8.0)], Method::Exact);
    assert!(said("coat", &plain).contains("no closed form"));
    assert!(said("paper", &setup(&[beam(90.0)], Method::Auto)).contains("along the surface"));
    let view = View { direction: Angles { theta: 80.0, phi: 0.0 }, half_angle: 20.0 };
    assert!(said("paper", &Setup { view: Some(view), ..plain.clone() }).contains("above the horizon"));
    let view = View { half_angle: 5.0, ..view };
    assert!(said("paper", &Setup { view: Some(view), ..plain.clone() }).contains("by sampling only"));
    let sphere = Sphere { wall: 1.0, port: 0.1, standard: 1.0, beams: Beams::Double };
    assert!(said("paper", &Setup { sphere: Some(sphere), ..plain }).contains("below 1"));
}
