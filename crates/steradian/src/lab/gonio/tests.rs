use super::*;
use crate::bsdf::{Bsdf, Mode, Side};
use crate::lab::probe::{Angles, Probe};
use crate::lab::{Ending, Precision, Session, Subject};
use crate::math::{LocalDir, Vec3};
use crate::render::CancelToken;
use crate::scene::import::pbrt::{Input, import};
use crate::scene::{Diagnostics, MemoryFiles, RenderJob, compile};
use crate::spectrum::LANES;
use crate::units::Estimate;
use std::f64::consts::PI;
use std::path::Path;

const MATERIALS: &str = "WorldBegin
    MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0.2 900 0.8]
    MakeNamedMaterial \"veil\" \"string type\" \"diffusetransmission\" \"spectrum reflectance\" [300 0.3 900 0.3]
      \"spectrum transmittance\" [300 0.5 900 0.5]
    MakeNamedMaterial \"plastic\" \"string type\" \"modifiedphong\" \"spectrum diffuse\" [300 0.3 900 0.3]
      \"spectrum specular\" [300 0.5 900 0.5] \"float exponent\" 30
    MakeNamedMaterial \"gold\" \"string type\" \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"
      \"float roughness\" 0.2 \"bool remaproughness\" false
    MakeNamedMaterial \"glass\" \"string type\" \"dielectric\" \"float eta\" 1.5
    MakeNamedMaterial \"frosted\" \"string type\" \"dielectric\" \"float eta\" 1.5 \"float roughness\" 0.3
      \"bool remaproughness\" false
    MakeNamedMaterial \"prism\" \"string type\" \"dielectric\" \"spectrum eta\" \"glass-SF11\"
    MakeNamedMaterial \"coat\" \"string type\" \"coateddiffuse\" \"float roughness\" 0.3
    MakeNamedMaterial \"legacy\" \"string type\" \"phong\"\n";

const WAVELENGTHS: [f32; 3] = [450.0, 550.0, 650.0];

fn job(text: &str) -> RenderJob {
    let input = Input::Text { name: "test", bytes: text.as_bytes(), base: Path::new("") };
    let imported = import(&[input], &MemoryFiles::default());
    let mut diagnostics: Diagnostics = imported.diagnostics;
    let job = compile(imported.scene.unwrap(), &MemoryFiles::default(), &mut diagnostics);
    job.unwrap_or_else(|| panic!("{}", diagnostics.display(&imported.sources)))
}

fn from(theta: f64, phi: f64) -> Incidence {
    Incidence::Direction(Angles { theta, phi })
}

fn goniometer(incidence: Vec<Incidence>) -> Goniometer {
    Goniometer {
        grid: CellGrid::regular(9, 24),
        face: Face::Front,
        incidence,
        method: Method::Combined,
        dim: 0.1,
    }
}

fn read(gonio: &Goniometer, sample: Sample<'_, '_>, wavelengths: &[f32], relative: f64) -> Reading {
    let cancel = CancelToken::new();
    let precision = Precision { relative, max_rays: 40_000_000, ..Precision::default() };
    let session = Session { precision, seed: 7, threads: None, cancel: &cancel };
    gonio.measure(sample, wavelengths, &session)
}

/// ∫ f cosθ dω over a cell, by Gauss' three-point rule on 8 × 8 parts of it.
fn quadrature(bsdf: &Bsdf<'_>, light: LocalDir, cell: Cell, side: Side) -> [f64; LANES] {
    const GAUSS: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0), (0.0, 8.0), (0.774_596_669_241_483_4, 5.0)];
    const PARTS: usize = 8;
    let nodes = |[lo, hi]: [f64; 2]| -> Vec<(f64, f64)> {
        let step = (hi - lo).to_radians() / PARTS as f64;
        let part = |i: usize| {
            GAUSS.map(|(x, w)| (lo.to_radians() + step * (i as f64 + 0.5 + 0.5 * x), w / 18.0 * step))
        };
        (0..PARTS).flat_map(part).collect()
    };
    let mut sum = [0.0; LANES];
    for (theta, wt) in nodes(cell.theta) {
        for (phi, wp) in nodes(cell.phi) {
            let (sin, cos) = theta.sin_cos();
            let up = if (side == Side::Reflection) == (light.z > 0.0) { 1.0 } else { -1.0 };
            let at = Vec3::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, (up * cos) as f32);
            let f = bsdf.eval(light, LocalDir::new_unchecked(at), Mode::Importance);
            for (sum, f) in sum.iter_mut().zip(f.to_array()) {
                *sum += wt * wp * sin * cos * f64::from(f);
            }
        }
    }
    sum
}

/// Student's t of an estimate against what it should be; single-precision scattering functions round.
fn deviation(reading: &Reading, scattered: &Scattered, estimate: Estimate, truth: f64) -> f64 {
    let error = reading.standard_error(scattered, estimate);
    (estimate.value - truth).abs() / error.hypot(1e-5 * truth).max(1e-12)
}

/// The bound that holds for all of `count` deviations with a probability of 99 % (Šidák), with 31 degrees of freedom at least.
fn bound(count: usize) -> f64 {
    let confidence = 0.99_f64.powf(1.0 / count as f64);
    Precision { confidence, ..Precision::default() }.half_width(1.0, 31)
}

#[test]
fn cells_read_the_mean_of_f_over_them_whatever_the_method() {
    let job = job(MATERIALS);
    let incidence = [from(0.0, 0.0), from(50.0, 0.0), from(75.0, 33.0)];
    // Cells · incidences · wavelengths · methods · (6 one-sided + 2 two-sided cases).
    let bound = bound(216 * 3 * 3 * 3 * (4 + 2 * 2));
    for (name, face) in [
        ("paint", Face::Front),
        ("veil", Face::Front),
        ("plastic", Face::Front),
        ("gold", Face::Front),
        ("gold", Face::Back),
        ("frosted", Face::Back),
    ] {
        let probe = Probe::new(&Subject::find(&job, name).unwrap(), &WAVELENGTHS).unwrap();
        let (bsdf, _) = probe.parts().next().unwrap();
        for method in [Method::Combined, Method::Counting, Method::Integration] {
            // Counting alone fills dim cells slowly.
            let relative = if method == Method::Counting { 0.1 } else { 0.02 };
            let gonio = Goniometer { face, method, ..goniometer(incidence.to_vec()) };
            let reading = read(&gonio, Sample::Material(&probe), &WAVELENGTHS, relative);
            assert_eq!(reading.ending, Ending::Precise, "{name} {method:?}");
            for beam in &reading.beams {
                let light = beam.incidence.direction(&reading.grid, face, Default::default());
                for side in [Side::Reflection, Side::Transmission] {
                    let cells = beam.spectra[0].cells(side).len();
                    assert!(side == Side::Reflection || (cells > 0) == bsdf.lobes().transmission, "{name}");
                    for index in 0..cells {
                        let truth = quadrature(bsdf, light, reading.grid.cell(index), side);
                        for (scattered, truth) in beam.spectra.iter().zip(truth) {
                            let flux = scattered.cells(side)[index].continuous;
                            let t = deviation(&reading, scattered, flux, truth);
                            assert!(
                                t < bound,
                                "{name} {method:?} {:?} {side:?} {index}: {flux:?} {truth} {t}",
                                beam.incidence
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_lambertian_surface_has_rho_over_pi_in_every_cell_and_cos_over_pi_as_probability() {
    let job = job(MATERIALS);
    let probe = Probe::new(&Subject::find(&job, "paint").unwrap(), &[600.0]).unwrap();
    let gonio = Goniometer { method: Method::Integration, ..goniometer(vec![from(40.0, 10.0)]) };
    let reading = read(&gonio, Sample::Material(&probe), &[600.0], 0.01);
    let scattered = &reading.beams[0].spectra[0];
    for (index, flux) in scattered.reflected.iter().enumerate() {
        let f = reading.mean_f(index, flux.continuous);
        assert!((f.value - 0.5 / PI).abs() < 1e-6 && f.half_width < 1e-6, "{index}: {f:?}");
        let cell = reading.grid.cell(index);
        let mean_cosine = cell.projected_solid_angle() / cell.solid_angle();
        let s = scattered.probability(flux, cell.solid_angle()).unwrap();
        assert!((s.value - mean_cosine / PI).abs() < 1e-6, "{index}: {s:?}");
    }
    assert!((scattered.reflectance.value - 0.5).abs() < 1e-6 && scattered.transmitted.is_empty());
}

/// By B (2.12), in f64.
fn fresnel(degrees: f64, eta: f64) -> f64 {
    let (ci, st) = (degrees.to_radians().cos(), degrees.to_radians().sin() / eta);
    let ct = (1.0 - st * st).sqrt();
    let (s, p) = ((ci - eta * ct) / (ci + eta * ct), (eta * ci - ct) / (eta * ci + ct));
    0.5 * (s * s + p * p)
}

#[test]
fn smooth_glass_sends_fresnels_share_into_the_two_cells_of_its_rays() {
    let job = job(MATERIALS);
    let probe = Probe::new(&Subject::find(&job, "glass").unwrap(), &WAVELENGTHS).unwrap();
    let angles = [8.0, 48.0, 73.0];
    let incidence = angles.map(|theta| from(theta, 0.0)).to_vec();
    let reading = read(&goniometer(incidence), Sample::Material(&probe), &WAVELENGTHS, 0.01);
    let bound = bound(3 * 3 * 2);
    for (beam, theta) in reading.beams.iter().zip(angles) {
        let r = fresnel(theta, 1.5);
        let refracted = (theta.to_radians().sin() / 1.5).asin().to_degrees();
        for scattered in &beam.spectra {
            for (side, theta, truth) in
                [(Side::Reflection, theta, r), (Side::Transmission, refracted, 1.0 - r)]
            {
                let hit = reading.grid.index(Angles { theta, phi: 180.0 }.direction());
                for (index, flux) in scattered.cells(side).iter().enumerate() {
                    assert_eq!(flux.continuous, Estimate::exact(0.0));
                    if index == hit {
                        let t = deviation(&reading, scattered, flux.discrete, truth);
                        assert!(t < bound, "{side:?} {theta}: {:?} {truth}", flux.discrete);
                        assert!(flux.discrete.relative() < 0.011);
                    } else {
                        assert_eq!(flux.discrete, Estimate::exact(0.0));
                    }
                }
            }
        }
    }
}

#[test]
fn dispersive_glass_has_rays_of_its_own_for_each_wavelength() {
    let job = job(MATERIALS);
    let probe = Probe::new(&Subject::find(&job, "prism").unwrap(), &WAVELENGTHS).unwrap();
    let reading = read(&goniometer(vec![from(0.0, 0.0)]), Sample::Material(&probe), &WAVELENGTHS, 0.02);
    let r: Vec<f64> = reading.beams[0].spectra.iter().map(|s| s.reflectance.value).collect();
    // SF11: 1.8216 at 450 nm, 1.7919 at 550 nm, 1.7783 at 650 nm (Sellmeier formula of the maker).
    for (r, eta) in r.iter().zip([1.8216, 1.7919, 1.7783]) {
        assert!((r / ((eta - 1.0_f64) / (eta + 1.0)).powi(2) - 1.0).abs() < 0.05, "{r} {eta}");
    }
}

fn small(incidence: Vec<Incidence>) -> Goniometer {
    Goniometer { grid: CellGrid::regular(4, 8), ..goniometer(incidence) }
}

fn from_all_cells() -> Goniometer {
    small((0..32).map(Incidence::Cell).collect())
}

#[test]
fn the_residual_of_reciprocity_is_chance_where_f_is_reciprocal_and_far_beyond_where_it_is_not() {
    let job = job(MATERIALS);
    let residuals = |name: &str| {
        let probe = Probe::new(&Subject::find(&job, name).unwrap(), &[550.0]).unwrap();
        let front = read(&from_all_cells(), Sample::Material(&probe), &[550.0], 0.05);
        let back = (name == "veil").then(|| {
            let back = Goniometer { face: Face::Back, ..from_all_cells() };
            read(&back, Sample::Material(&probe), &[550.0], 0.05)
        });
        reciprocity(&front, back.as_ref()).unwrap()[0]
    };
    let bound = bound(496);
    for name in ["gold", "plastic"] {
        let r = residuals(name);
        assert_eq!(r.reflection.pairs, 496, "{name}");
        assert!(r.reflection.worst < bound && r.reflection.rms < 1.2, "{name}: {r:?}");
        assert!(r.transmission.is_none());
    }
    let veil = residuals("veil").transmission.unwrap();
    assert!(veil.pairs == 1024 && veil.worst < bound, "{veil:?}");
    // Phong's shading divides by a cosine of one of the two directions: f differs by its ratio.
    let legacy = residuals("legacy").reflection;
    assert!(legacy.rms > 2.0 && legacy.worst > 2.0 * bound && legacy.relative > 0.05, "{legacy:?}");
    let probe = Probe::new(&Subject::find(&job, "gold").unwrap(), &[550.0]).unwrap();
    let single = read(&small(vec![from(0.0, 0.0)]), Sample::Material(&probe), &[550.0], 0.1);
    assert!(reciprocity(&single, None).is_none(), "there are no pairs");
}

/// A square of side 2 around the origin, in the plane z = 1, whatever the camera.
fn flat(material: &str) -> String {
    format!(
        "LookAt 3 4 5  0 0 0  0 0 1\nCamera \"perspective\"\n{MATERIALS}\nNamedMaterial \"{material}\"\n\
         Shape \"trianglemesh\" \"point3 P\" [-1 -1 1  1 -1 1  1 1 1  -1 1 1] \"integer indices\" [0 1 2 0 2 3]"
    )
}

#[test]
fn a_flat_piece_of_geometry_is_its_material() {
    let bound = bound(32 * 2 * 2 * 3 * 2);
    for (name, face) in [("veil", Face::Front), ("paint", Face::Front), ("frosted", Face::Back)] {
        let job = job(&flat(name));
        let patch = Patch::new(&job, None).unwrap();
        let probe = Probe::new(&Subject::find(&job, name).unwrap(), &[600.0]).unwrap();
        let gonio = Goniometer { face, ..small(vec![from(30.0, 80.0), Incidence::Cell(20)]) };
        let geometry = read(&gonio, Sample::Geometry(&patch), &[600.0], 0.05);
        let material = read(&gonio, Sample::Material(&probe), &[600.0], 0.02);
        for (a, b) in geometry.beams.iter().zip(&material.beams) {
            let (a, b) = (&a.spectra[0], &b.spectra[0]);
            for side in [Side::Reflection, Side::Transmission] {
                for (index, exact) in b.cells(side).iter().enumerate() {
                    let (x, y) = (a.cells(side)[index].total(), exact.total());
                    let error = geometry.standard_error(a, x).hypot(material.standard_error(b, y));
                    let t = (x.value - y.value).abs() / error.hypot(1e-5 * y.value);
                    assert!(t < bound, "{name} {side:?} {index}: {x:?} {y:?} {t}");
                }
            }
            let rest = a.rest.unwrap();
            assert!((rest.sum.value - 1.0).abs() < 1e-5, "{name}: {rest:?}");
            assert!(rest.edge.value == 0.0 && rest.lost.value == 0.0, "{rest:?}");
            let absorbed = 1.0 - b.reflectance.value - b.transmittance.value;
            assert!((rest.absorbed.value - absorbed).abs() < 0.02, "{rest:?} {absorbed}");
        }
    }
}

/// Right-angled grooves of width 2 along y, of mirrors that reflect 0.8.
fn grooves() -> String {
    let mut points = String::new();
    let mut indices = String::new();
    for i in 0..17 {
        let (x, z) = (f64::from(i) - 8.0, -f64::from(i % 2));
        points += &format!("{x} -9 {z}  {x} 9 {z}  ");
        if i < 16 {
            let a = 2 * i;
            indices += &format!("{a} {} {} {} {} {}  ", a + 2, a + 3, a, a + 3, a + 1);
        }
    }
    format!(
        "WorldBegin\nMaterial \"perfectmirror\" \"spectrum reflectance\" [300 0.8 900 0.8]\n\
         Shape \"trianglemesh\" \"point3 P\" [{points}] \"integer indices\" [{indices}]"
    )
}

/// Light at θ in the plane across the grooves: unfolded at its apex, a groove of width 2 lets the share tan θ out after one
/// reflection, at 90° − θ on the side of the light, and returns the rest after two.
#[test]
fn grooves_of_mirrors_send_light_where_its_images_are() {
    let job = job(&grooves());
    let patch = Patch::new(&job, Some(Port { x: [-4.0, 4.0], y: [-2.0, 2.0] })).unwrap();
    for theta in [0.0, 22.0, 35.0_f64] {
        let reading = read(&goniometer(vec![from(theta, 0.0)]), Sample::Geometry(&patch), &[550.0], 0.01);
        let scattered = &reading.beams[0].spectra[0];
        let once = theta.to_radians().tan();
        let mut expected = vec![0.0; 216];
        let cell = |theta: f64| reading.grid.index(Angles { theta, phi: 0.0 }.direction());
        expected[cell(90.0 - theta)] += 0.8 * once;
        // Straight back, and by rounding into any cell that meets at the pole.
        let back = cell(theta);
        expected[back] += 0.64 * (1.0 - once);
        let pole: f64 = scattered.reflected[..24].iter().map(|c| c.continuous.value).sum();
        for (index, (flux, expected)) in scattered.reflected.iter().zip(&expected).enumerate() {
            let value = if theta == 0.0 && index < 24 { pole } else { flux.continuous.value };
            let expected = if theta == 0.0 && index < 24 { 0.64 } else { *expected };
            // The share of photons is stratified: far better known than the tolerance.
            assert!((value - expected).abs() < 0.004, "{theta} {index}: {value} {expected}");
        }
        let rest = scattered.rest.unwrap();
        assert!((rest.sum.value - 1.0).abs() < 1e-5, "{rest:?}");
        let absorbed = 0.2 * once + 0.36 * (1.0 - once);
        assert!((rest.absorbed.value - absorbed).abs() < 0.002, "{rest:?} {absorbed}");
        assert_eq!(scattered.transmittance.value, 0.0);
    }
}

#[test]
fn light_that_misses_or_leaves_by_the_sides_is_told() {
    let job = job(&grooves());
    // Along the grooves, light that enters at y leaves at their ends after a way of l = (y + 9)/tan 70° across them, when that is
    // less than 2. By then it met one mirror with a probability of min(l, 1), and a second one of max(0, l − 1):
    // ∫ (1 − 0.2 min(l, 1) − 0.16 max(0, l − 1)) dl from 0.5/tan 70° to 2, times tan 70°/17.
    let patch = Patch::new(&job, Some(Port { x: [-4.0, 4.0], y: [-8.5, 8.5] })).unwrap();
    let reading = read(&goniometer(vec![from(70.0, 90.0)]), Sample::Geometry(&patch), &[550.0], 0.05);
    let rest = reading.beams[0].spectra[0].rest.unwrap();
    assert!((rest.edge.value - 0.232_94).abs() < 0.001, "{rest:?}");
    let error = |port| Patch::new(&job, Some(port)).unwrap_err();
    let outside = error(Port { x: [-20.0, 0.0], y: [0.0, 1.0] }).to_string();
    assert_eq!(outside, "the port x -20–0, y 0–1 does not lie within the sample, x -8–8, y -9–9");
    assert_eq!(error(Port { x: [0.0, 0.0], y: [0.0, 1.0] }), PatchError::NoWidth);
    assert_eq!(Patch::new(&self::job(MATERIALS), None).unwrap_err(), PatchError::Empty);
}

#[test]
fn readings_do_not_depend_on_the_number_of_threads() {
    let job = job(MATERIALS);
    let probe = Probe::new(&Subject::find(&job, "coat").unwrap(), &[550.0]).unwrap();
    let cancel = CancelToken::new();
    let precision = Precision { relative: 0.05, ..Precision::default() };
    let values = |threads| {
        let session = Session { precision, seed: 1, threads: Some(threads), cancel: &cancel };
        let reading = small(vec![from(30.0, 0.0)]).measure(Sample::Material(&probe), &[550.0], &session);
        reading.beams[0].spectra[0].reflected.clone()
    };
    assert_eq!(values(1), values(3));
}

/// 400 runs of each: a share that deviates from 95 % by more than 3 % is one of less than a hundred by chance.
#[test]
fn intervals_hold_the_truth_in_about_19_of_20_measurements_that_stop_when_they_know_enough() {
    let job = job(MATERIALS);
    let probe = Probe::new(&Subject::find(&job, "plastic").unwrap(), &[550.0]).unwrap();
    let (bsdf, _) = probe.parts().next().unwrap();
    let light = Angles { theta: 40.0, phi: 0.0 }.direction();
    for (method, relative) in [(Method::Combined, 0.03), (Method::Counting, 0.15)] {
        let grid = CellGrid::regular(2, 6);
        let gonio = Goniometer { grid, method, ..goniometer(vec![from(40.0, 0.0)]) };
        let truth: Vec<f64> =
            gonio.grid.cells().map(|c| quadrature(bsdf, light, c, Side::Reflection)[0]).collect();
        let runs = 400;
        let mut held = vec![0; truth.len()];
        for seed in 0..runs {
            let cancel = CancelToken::new();
            let precision = Precision { relative, ..Precision::default() };
            let session = Session { precision, seed, threads: Some(1), cancel: &cancel };
            let reading = gonio.measure(Sample::Material(&probe), &[550.0], &session);
            let cells = &reading.beams[0].spectra[0].reflected;
            for ((held, cell), truth) in held.iter_mut().zip(cells).zip(&truth) {
                *held += usize::from(cell.continuous.holds(*truth));
            }
        }
        // The brightest cell and a dim one.
        for cell in [3, 6] {
            let share = held[cell] as f64 / runs as f64;
            assert!((0.92..=0.98).contains(&share), "{method:?} {cell}: {share}");
        }
    }
}
