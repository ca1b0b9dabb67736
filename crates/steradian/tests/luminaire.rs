//! The luminaire goniophotometer against closed forms.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use std::f64::consts::PI;
use steradian::lab::luminaire::{self, DIM, Distribution, LuminaireError, LuminaireSettings};
use steradian::lab::{Ending, Precision, Session};
use steradian::light::photometric::{Luminaire, PhotometricWeb, ies, read};
use steradian::render::CancelToken;
use steradian::scene::{MemoryFiles, RenderJob};
use support::{SMALL_FILM, job_with};

fn scene(world: &str, files: &MemoryFiles) -> RenderJob {
    // The camera's place must not matter.
    let view = "LookAt 3 -2 1  0 0 0  0 0 1\nCamera \"perspective\"";
    job_with(&format!("{SMALL_FILM}\n{view}\nWorldBegin\n{world}"), files)
}

fn job(world: &str) -> RenderJob {
    scene(world, &MemoryFiles::new())
}

fn session(cancel: &CancelToken) -> Session<'_> {
    let precision = Precision { relative: 0.02, confidence: 0.999, ..Precision::default() };
    Session { precision, seed: 3, threads: None, cancel }
}

const COARSE: LuminaireSettings = LuminaireSettings {
    planes: 4,
    gamma_steps: 12,
    nadir: [0.0, 0.0, -1.0],
    c0: [1.0, 0.0, 0.0],
    max_depth: 100,
};

fn measure(job: &RenderJob, settings: &LuminaireSettings) -> Distribution {
    let cancel = CancelToken::new();
    let found = luminaire::measure(job, settings, &session(&cancel)).unwrap();
    assert_eq!(found.endings, [Ending::Precise; 2]);
    found
}

/// Asserts the intensity [cd] of every cell by C and γ [°], and the flux [lm].
///
/// Of 50 cells at 99.9 % one in twenty runs would miss by chance: half a width more is one in 10⁴.
#[track_caller]
fn assert_shines(found: &Distribution, intensity: impl Fn(f64, f64) -> f64, flux: f64) {
    let (n, peak) = (found.gamma.len(), found.peak());
    for (i, cell) in found.cells.iter().enumerate() {
        let (c, g) = (found.planes[i / n], found.gamma[i % n]);
        let (e, expected) = (cell.estimate(), intensity(c, g));
        assert!(e.half_width <= 0.02 * e.value.max(DIM * peak) * 1.000_1, "C {c}, γ {g}: {e}");
        assert!(
            (e.value - expected).abs() <= 1.5 * e.half_width + 1e-4 * peak,
            "C {c}, γ {g}: {e}, expected {expected}"
        );
    }
    let e = found.flux.estimate();
    assert!((e.value - flux).abs() <= e.half_width + 1e-4 * flux, "{e}, expected {flux}");
}

#[test]
fn a_bare_point_has_its_intensity_all_around() {
    let found =
        measure(&job("LightSource \"point\" \"float intensity\" 100 \"point3 from\" [5 1 2]"), &COARSE);
    assert_shines(&found, |_, _| 100.0, 400.0 * PI);
    assert!((found.table_flux.value() / (400.0 * PI) - 1.0).abs() < 0.02);
}

#[test]
fn a_flat_lambertian_emitter_follows_the_cosine() {
    // One square metre of 50 cd/m² that faces down, in scenes of metres and of centimetres: I = 50 cosγ, Φ = 50π.
    for (unit, side) in [("1", 1.0), ("0.01", 100.0)] {
        let world = format!(
            "AttributeBegin AreaLightSource \"diffuse\" \"float luminance\" 50 Shape \"trianglemesh\" \"point3 P\" \
             [0 0 0 0 {side} 0 {side} {side} 0 {side} 0 0] \"integer indices\" [0 1 2 0 2 3] AttributeEnd"
        );
        let header = format!(
            "Option \"float metersperunit\" {unit}\n{SMALL_FILM}\nCamera \"perspective\"\nWorldBegin\n"
        );
        let job = job_with(&format!("{header}{world}"), &MemoryFiles::new());
        let found = measure(&job, &COARSE);
        assert_shines(&found, |_, g| if g < 90.0 { 50.0 * g.to_radians().cos() } else { 0.0 }, 50.0 * PI);
        assert!(
            (found.extent[0] - 1.0).abs() < 1e-4 && (found.extent[1] - 1.0).abs() < 1e-4,
            "{:?}",
            found.extent
        );
        // Turned about: the nadir along +y, C0 along −z.
        let turned = LuminaireSettings { nadir: [0.0, 2.0, 0.0], c0: [0.0, 0.3, -1.0], ..COARSE };
        let found = measure(&job, &turned);
        assert_shines(
            &found,
            |c, g| (50.0 * g.to_radians().sin() * c.to_radians().cos()).max(0.0),
            50.0 * PI,
        );
    }
}

#[test]
fn what_a_plate_takes_from_a_point_it_returns_by_its_reflectance() {
    // A point of 100 cd at height h over a disk of radius R and reflectance ½: the disk receives the share
    // ½(1 − h/√(h² + R²)) of 400π lm; it hides the point from below.
    let (h, r) = (1.0_f64, 2.0_f64);
    let world = "LightSource \"point\" \"float intensity\" 100 \"point3 from\" [0 0 1] \
                 Material \"diffuse\" \"spectrum reflectance\" [300 0.5 900 0.5] Shape \"disk\" \"float radius\" 2";
    let found = measure(&job(world), &COARSE);
    let share = 0.5 * (1.0 - h / h.hypot(r));
    // Diffuse light leaves upwards by Lambert's law: Φ/π cosθ.
    let reflected = 0.5 * share * 400.0 * PI;
    let hidden = (r / h).atan().to_degrees();
    let intensity = |_: f64, g: f64| {
        let point = if g < hidden { 0.0 } else { 100.0 };
        point + if g > 90.0 { reflected / PI * -g.to_radians().cos() } else { 0.0 }
    };
    assert_shines(&found, intensity, 400.0 * PI * (1.0 - share) + reflected);
}

#[test]
fn a_luminaire_measures_as_its_file_says_and_writes_that_file_again() {
    let gamma: Vec<f64> = (0..=12).map(|i| 15.0 * f64::from(i)).collect();
    // All planes agree at the poles.
    let intensity = |plane: u32, g: f64| 30.0 + g + 20.0 * f64::from(plane * plane) * g.to_radians().sin();
    let candela = (0..4).flat_map(|plane| gamma.iter().map(move |&g| intensity(plane, g))).collect();
    let web = PhotometricWeb::type_c(vec![0.0, 90.0, 180.0, 270.0], gamma.clone(), candela).unwrap();
    let lamp = ies::write(&Luminaire::of(web.clone()), ies::Edition::Of2002);
    let files = MemoryFiles::new().with("./lamp.ies", lamp);
    let world = "LightSource \"photometric\" \"string filename\" \"lamp.ies\" \"float width\" 0.2 \"float length\" 0.5";
    let found = measure(&scene(world, &files), &COARSE);
    assert_shines(&found, |c, g| web.at(c, g), web.flux());
    let written = ies::write(&found.luminaire("measured"), ies::Edition::Of2019);
    let back = read(written.as_bytes(), &mut |_| Err(String::new())).unwrap();
    assert!((back.web.flux() / found.table_flux.value() - 1.0).abs() < 1e-6);
    assert_eq!(back.label.name, "measured");
    // One plane is the mean over all.
    let mean = measure(&scene(world, &files), &LuminaireSettings { planes: 1, ..COARSE });
    let around = |g: f64| (0..4).map(|i| web.at(90.0 * f64::from(i), g)).sum::<f64>() / 4.0;
    let poles = |c: f64, g: f64| if g == 0.0 || g == 180.0 { web.at(c, g) } else { around(g) };
    assert_shines(&mean, poles, web.flux());
}

#[test]
fn radiant_readings_are_in_watts() {
    let job = job("LightSource \"point\" \"float watts\" 5 \"blackbody I\" 3000");
    let cancel = CancelToken::new();
    let found = luminaire::measure_radiant(&job, &COARSE, &session(&cancel)).unwrap();
    let e = found.flux.estimate();
    // The light's total is a sum over 471 wavelengths, the meter's an integral over 470 nm.
    assert!((e.value - 5.0).abs() < e.half_width + 0.02, "{e}");
    assert!(found.flux.to_string().ends_with(" W"), "{}", found.flux);
    let table = found.table(&COARSE, &session(&cancel)).to_csv();
    assert!(table.contains("W·sr⁻¹"), "{table}");
}

#[test]
fn scenes_that_are_no_luminaires_are_refused() {
    let cancel = CancelToken::new();
    let fault = |world: &str, settings: &LuminaireSettings| {
        luminaire::measure(&job(world), settings, &session(&cancel)).unwrap_err()
    };
    let point = "LightSource \"point\"";
    assert_eq!(fault("LightSource \"infinite\"", &COARSE), LuminaireError::AtInfinity("infinite"));
    assert_eq!(fault("Shape \"sphere\"", &COARSE), LuminaireError::NoLight);
    assert_eq!(fault(point, &LuminaireSettings { c0: [0.0, 0.0, 2.0], ..COARSE }), LuminaireError::Axes);
    assert_eq!(
        fault(point, &LuminaireSettings { planes: 0, ..COARSE }),
        LuminaireError::Grid { planes: 0, gamma_steps: 12 }
    );
}
