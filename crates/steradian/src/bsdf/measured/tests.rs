use super::specimens::{Angles, Metal, goniometer_text, merl_file, metal_file, nodes, spread};
use super::tabulate::{Azimuths, Nodes};
use super::*;
use crate::math::hash::Pcg32;
use crate::math::warp::{spherical_direction, uniform_sphere};
use crate::optics::TrowbridgeReitz;

const LAMBDA: [f32; LANES] = [450.0, 550.0, 600.0, 700.0];

fn at(theta: f32, phi: f32) -> LocalDir {
    LocalDir::new_unchecked(spherical_direction(theta.to_radians(), phi.to_radians()))
}

fn read(bytes: &[u8]) -> MeasuredTable {
    MeasuredTable::read(bytes, None).unwrap()
}

fn brushed() -> TrowbridgeReitz {
    TrowbridgeReitz::new(0.2, 0.5)
}

#[test]
fn a_tabulated_metal_reflects_like_the_metal() {
    for (facets, azimuths, bound) in [
        (TrowbridgeReitz::new(0.3, 0.3), Azimuths::Isotropic, 0.02),
        (TrowbridgeReitz::new(0.8, 0.8), Azimuths::Isotropic, 0.02),
        (brushed(), Azimuths::Quarter(9), 0.04),
    ] {
        let nodes = nodes(azimuths, 64);
        let table = read(&metal_file(facets, &nodes));
        let measured = Measured::new(&table, &LAMBDA);
        let mut rng = Pcg32::new(4, 1);
        let (mut error, mut total) = (0.0, 0.0);
        for _ in 0..4000 {
            let mut draw = || uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let (Some(wo), Some(wi)) = (LocalDir::new(draw().abs()), LocalDir::new(draw())) else { continue };
            if wi.z < 0.1 || wo.z < 0.1 {
                continue;
            }
            let f = measured.eval(wo, wi, Mode::Radiance);
            for (lane, &lambda) in LAMBDA.iter().enumerate() {
                let exact = Metal(facets).f(wo, wi, lambda);
                error += f64::from((f[lane] - exact).abs());
                total += f64::from(exact);
            }
        }
        assert!(error / total < bound, "{facets:?}: mean error {}", error / total);
    }
}

#[test]
fn parts_of_the_circle_stand_for_all_of_it() {
    // The square of normals is cut open at −π, which lies elsewhere in the lobe of a turned direction: values
    // between nodes differ.
    let table = |azimuths| read(&metal_file(brushed(), &nodes(azimuths, 64)));
    let tables = [Azimuths::Full(17), Azimuths::Half(9), Azimuths::Quarter(5)].map(table);
    let mut rng = Pcg32::new(6, 1);
    let (mut total, mut difference) = (0.0, [0.0; 2]);
    for _ in 0..1000 {
        let mut draw = || LocalDir::new(uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32())));
        let (Some(wo), Some(wi)) = (draw(), draw()) else { continue };
        let u = Vec2::new(rng.next_f32(), rng.next_f32());
        let [full, parts @ ..] =
            [0, 1, 2].map(|i| Measured::new(&tables[i], &LAMBDA).eval(wo, wi, Mode::Radiance)[1]);
        if wo.abs_cos_theta() > 0.2 && wi.abs_cos_theta() > 0.2 {
            total += full;
            difference = [0, 1].map(|i| difference[i] + (parts[i] - full).abs());
        }
        for t in &tables {
            let measured = Measured::new(t, &LAMBDA);
            if let Some(s) = measured.sample(wo, 0.5, u, Mode::Radiance) {
                let ratio = measured.eval(wo, s.wi, Mode::Radiance)[1] * s.wi.abs_cos_theta()
                    / measured.pdf(wo, s.wi).0;
                assert!((ratio / s.weight[1] - 1.0).abs() < 2e-3, "{wo:?}: {ratio} {}", s.weight[1]);
            }
        }
    }
    let shares = difference.map(|d| d / total);
    assert!(shares.iter().all(|&s| s < 0.02), "{shares:?}");
}

/// f and density by Mitsuba 3.9.1 (`measured`, scalar_spectral) of the files that [`write_synthetic_files`] writes, for the
/// angles (θo, φo, θi, φi) in our notation; its `wi` is our `wo`.
#[test]
fn values_and_densities_are_those_of_mitsuba() {
    let angles = [[30.0, 20.0, 45.0, 190.0], [70.0, 100.0, 60.0, 300.0], [10.0, 250.0, 25.0, 40.0]];
    for (facets, azimuths, golden) in [
        (
            TrowbridgeReitz::new(0.3, 0.3),
            Azimuths::Isotropic,
            [
                ([0.499845, 0.5664332, 0.737733, 0.8563152], 0.7720758),
                ([0.4470892, 0.493687, 0.6332446, 0.7316343], 0.4905806),
                ([0.3445292, 0.3915407, 0.5103675, 0.5921737], 0.6739222),
            ],
        ),
        (
            brushed(),
            Azimuths::Full(17),
            [
                ([0.3042791, 0.344801, 0.4490675, 0.5212494], 0.5059962),
                ([0.1467932, 0.1623003, 0.2079482, 0.2399522], 0.1608405),
                ([0.2176637, 0.2473684, 0.3224422, 0.3741245], 0.4621486),
            ],
        ),
        (
            brushed(),
            Azimuths::Quarter(5),
            [
                ([0.3061064, 0.3469232, 0.4518578, 0.5244875], 0.5091584),
                ([0.1467932, 0.1623003, 0.2079482, 0.2399522], 0.1608405),
                ([0.2176637, 0.2473684, 0.3224422, 0.3741245], 0.4621486),
            ],
        ),
    ] {
        let table = read(&metal_file(facets, &nodes(azimuths, 32)));
        let measured = Measured::new(&table, &[450.0, 523.0, 587.0, 700.0]);
        for ([to, po, ti, pi], (f, pdf)) in angles.into_iter().zip(golden) {
            let (wo, wi) = (at(to, po), at(ti, pi));
            let close = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-4;
            let ours = measured.eval(wo, wi, Mode::Radiance);
            assert!((0..LANES).all(|l| close(ours[l], f[l])), "{azimuths:?} {to}: {ours:?} {f:?}");
            assert!(
                close(measured.pdf(wo, wi).0, pdf),
                "{azimuths:?} {to}: {:?} {pdf}",
                measured.pdf(wo, wi)
            );
        }
    }
}

/// Bytes of a file with mistakes in it: changed, cut, or with a piece repeated.
fn damaged(file: &[u8], rng: &mut Pcg32) -> Vec<u8> {
    let mut bytes = file.to_vec();
    let n = bytes.len() as u32;
    // The list of fields is short and the data are long: half of the mistakes go to either.
    let mut place = || {
        let within = if rng.next_u32().is_multiple_of(2) { 500.min(n) } else { n };
        (rng.next_u32() % within) as usize
    };
    match place() % 4 {
        0 => bytes.truncate(place()),
        1 => {
            let (at, from) = (place(), place());
            let piece: Vec<u8> = bytes[from..].iter().take(40).copied().collect();
            bytes.splice(at..at, piece);
        }
        _ => {
            for _ in 0..=place() % 4 {
                let at = place();
                bytes[at] = [0, 0xff, 0x7f, 0x80, b'9', b',', b'-', b'\n'][place() % 8];
            }
        }
    }
    bytes
}

#[test]
fn damaged_files_are_refused_or_harmless() {
    let small = Nodes { theta: 3, directions: 5, ..nodes(Azimuths::Quarter(3), 6) };
    let mut rng = Pcg32::new(9, 1);
    let merl = merl_file(merl::Extents { theta_h: 3, theta_d: 4, phi_d: 5 });
    // Whole MERL files fit a table of half a second each: cut by one byte, damage seldom mends them.
    let cut = merl[..merl.len() - 1].to_vec();
    for file in [metal_file(brushed(), &small), cut, small_table().into_bytes()] {
        for _ in 0..2000 {
            let bytes = damaged(&file, &mut rng);
            for extension in [Some("bsdf"), Some("binary"), Some("csv"), None] {
                let Ok(table) = MeasuredTable::read(&bytes, extension) else { continue };
                let measured = Measured::new(&table, &LAMBDA);
                let mut draw = || uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
                let (Some(wo), Some(wi)) = (LocalDir::new(draw()), LocalDir::new(draw())) else { continue };
                let f = measured.eval(wo, wi, Mode::Radiance);
                assert!(f.is_finite() && f.min() >= 0.0, "{f:?}");
                assert!(measured.pdf(wo, wi).0 >= 0.0);
                let u = Vec2::new(rng.next_f32(), rng.next_f32());
                if let Some(s) = measured.sample(wo, 0.5, u, Mode::Radiance) {
                    assert!(s.weight.is_finite(), "{s:?}");
                }
            }
        }
    }
}

/// A sheet measured at two incident angles, three scattered ones and five azimuths: f tells the place.
fn small_table() -> String {
    let angles = Angles {
        theta_i: vec![0.0, 60.0],
        phi_i: vec![0.0],
        theta_o: vec![0.0, 45.0, 120.0],
        phi_o: spread(5, 0.0, 180.0),
        wavelengths: vec![400.0, 700.0],
    };
    goniometer_text(&angles, |light, seen, lambda| {
        0.1 + 0.1 * light.z + 0.01 * seen.x + 1e-4 * (lambda - 400.0)
    })
}

#[test]
fn a_goniometer_table_is_read_at_its_nodes_and_linearly_between_them() {
    let table = read(small_table().as_bytes());
    let measured = Measured::new(&table, &[400.0, 550.0, 700.0, 800.0]);
    let f = |wi, wo| measured.eval(wo, wi, Mode::Radiance).to_array();
    let expect = |found: [f32; 4], first: f32| {
        let steps = [0.0, 0.015, 0.03, 0.03];
        assert!((0..4).all(|l| (found[l] - first - steps[l]).abs() < 1e-5), "{found:?}, expected {first}");
    };
    let x45 = 45.0_f32.to_radians().sin();
    expect(f(at(0.0, 0.0), at(45.0, 0.0)), 0.2 + 0.01 * x45);
    expect(f(at(60.0, 0.0), at(45.0, 180.0)), 0.15 - 0.01 * x45);
    // Turned together; on the other side of the plane of incidence; from below.
    expect(f(at(60.0, 77.0), at(45.0, 257.0)), 0.15 - 0.01 * x45);
    expect(f(at(60.0, 0.0), at(45.0, 225.0)), 0.15 - 0.01 * x45 * x45);
    expect(f(-at(60.0, 0.0), -at(45.0, 180.0)), 0.15 - 0.01 * x45);
    // Halfway in the incident angle; beyond the last scattered angle, which holds; through the sheet.
    expect(f(at(30.0, 0.0), at(45.0, 0.0)), 0.175 + 0.01 * x45);
    expect(f(at(0.0, 0.0), at(85.0, 0.0)), 0.2 + 0.01 * x45);
    expect(f(at(0.0, 0.0), at(170.0, 90.0)), 0.2);
    // Light is where it was measured, whichever end a path starts from.
    let (a, b) = (at(20.0, 10.0), at(50.0, 100.0));
    assert_eq!(measured.eval(a, b, Mode::Radiance), measured.eval(b, a, Mode::Importance));
    assert_eq!(measured.lobes(), Lobes { reflection: true, transmission: true });
}

#[test]
fn rows_of_a_goniometer_table_come_in_any_order_once_each() {
    let text = small_table();
    let (header, rows) = text.split_once('\n').unwrap();
    let mut rows: Vec<&str> = rows.lines().collect();
    let said = |rows: &[&str]| {
        let text = format!("{header}\n{}\n", rows.join("\n"));
        MeasuredTable::read(text.as_bytes(), None).unwrap_err().to_string()
    };
    let removed = rows.remove(7);
    assert_eq!(said(&rows), "there is no row for theta_i 0°, phi_i 0°, theta_o 45°, phi_o 90°");
    rows.extend([removed, removed]);
    assert_eq!(said(&rows), "line 32, column 1: the angles are those of line 31");
    rows.pop();
    rows.reverse();
    let shuffled = read(format!("{header}\n{}", rows.join("\n")).as_bytes());
    let ordered = read(text.as_bytes());
    let (wo, wi) = (at(33.0, 50.0), at(21.0, 300.0));
    let f = |table| Measured::new(table, &LAMBDA).eval(wo, wi, Mode::Radiance);
    assert_eq!(f(&shuffled), f(&ordered));
}

#[test]
fn azimuths_that_leave_most_of_the_circle_open_are_refused() {
    let angles = Angles {
        theta_i: vec![0.0, 60.0],
        phi_i: vec![0.0, 90.0],
        theta_o: vec![0.0, 45.0],
        phi_o: spread(4, 0.0, 270.0),
        wavelengths: vec![400.0, 700.0],
    };
    let said = |angles: &Angles| {
        let text = goniometer_text(angles, |_, _, _| 0.1);
        MeasuredTable::read(text.as_bytes(), None).unwrap_err().to_string()
    };
    assert_eq!(said(&angles), "phi_i leaves a gap of 270° in its circle");
    let angles = Angles { phi_i: vec![0.0], phi_o: vec![0.0, 100.0, 200.0], ..angles };
    assert_eq!(said(&angles), "phi_o leaves a gap of 160° in its circle");
}

#[test]
fn a_merl_file_reflects_what_was_written_and_both_ways_alike() {
    let table = read(&merl_file(merl::Extents { theta_h: 60, theta_d: 60, phi_d: 90 }));
    let measured = Measured::new(&table, &LAMBDA);
    let metal = Metal(TrowbridgeReitz::new(0.25, 0.25));
    let mut rng = Pcg32::new(4, 1);
    let (mut error, mut total) = (0.0, 0.0);
    for _ in 0..2000 {
        let mut draw = || uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32())).abs();
        let (Some(wo), Some(wi)) = (LocalDir::new(draw()), LocalDir::new(draw())) else { continue };
        let f = measured.eval(wo, wi, Mode::Radiance);
        let back = measured.eval(wi, wo, Mode::Radiance);
        assert!((0..LANES).all(|l| (f[l] - back[l]).abs() <= 1e-3 * f[l]), "{wo:?} {wi:?}: {f:?} {back:?}");
        if wo.z > 0.2 && wi.z > 0.2 {
            // The upsampled reflectance at 700 nm is near that of red.
            let exact = f64::from(0.3 * metal.f(wo, wi, 550.0) + 0.4 * std::f32::consts::FRAC_1_PI);
            error += (f64::from(f[3]) - exact).abs();
            total += exact;
        }
    }
    assert!(error / total < 0.1, "{}", error / total);
}

#[test]
fn the_format_is_known_by_the_content() {
    let merl = merl_file(merl::Extents { theta_h: 2, theta_d: 2, phi_d: 2 });
    let rgl = metal_file(brushed(), &Nodes { theta: 2, directions: 2, ..nodes(Azimuths::Isotropic, 6) });
    for extension in [None, Some("txt"), Some("CSV"), Some("bsdf"), Some("binary")] {
        assert_eq!(Format::of(&merl, extension), Some(Format::Merl));
        assert_eq!(Format::of(&rgl, extension), Some(Format::Rgl));
        assert_eq!(Format::of(small_table().as_bytes(), extension), Some(Format::Goniometer));
    }
    assert_eq!(Format::of(b"GIF89a", Some("binary")), Some(Format::Merl));
    assert_eq!(Format::of(b"GIF89a", Some("gif")), None);
}

#[test]
fn values_are_held_over_the_film_s_range_and_no_further() {
    let table = read(small_table().as_bytes());
    assert_eq!(table.range(), (360.0, 830.0));
    let f = |lambda| {
        let measured = Measured::new(&table, &[lambda; LANES]);
        measured.eval(at(20.0, 0.0), at(30.0, 50.0), Mode::Radiance)[0]
    };
    assert_eq!(f(360.0), f(400.0));
    assert_eq!(f(830.0), f(700.0));
    let text = small_table().replace("f_400nm", "f_350nm").replace("f_700nm", "f_2500nm");
    assert_eq!(read(text.as_bytes()).range(), (350.0, 2500.0));
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let file = metal_file(brushed(), &Nodes { theta: 3, directions: 5, ..nodes(Azimuths::Half(3), 6) });
    let said = |bytes: &[u8]| MeasuredTable::read(bytes, Some("bsdf")).unwrap_err().to_string();
    let renamed = |from: &str, to: &str| {
        let at = file.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        let mut bytes = file.clone();
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
        said(&bytes)
    };
    for name in
        ["theta_i", "phi_i", "ndf", "sigma", "vndf", "luminance", "spectra", "jacobian", "wavelengths"]
    {
        let other = "x".repeat(name.len());
        assert_eq!(renamed(name, &other), format!("there is no field `{name}`"));
    }
    assert_eq!(said(b"\x89PNG\r\n\x1a\n"), "this is no tensor file: it does not begin with `tensor_file`");
    assert_eq!(said(&file[..file.len() - 1]), "the file ends before the data of field `spectra`");
    assert_eq!(said(&file[..30]), "the file ends within the list of its fields");
    let with = |at: usize, v: f32| {
        let mut bytes = file.clone();
        bytes[at..at + 4].copy_from_slice(&v.to_le_bytes());
        said(&bytes)
    };
    let last = file.len() - 4;
    assert_eq!(with(last, f32::NAN), "field `spectra` has a value of NaN");
    assert_eq!(with(last, -1.0), "field `spectra` has a value of -1");
    assert_eq!(with(last, f32::INFINITY), "field `spectra` has a value of inf");
}

/// Writes the files that are compared with Mitsuba's `measured` plugin, with our values of f and the density.
#[test]
#[ignore = "writes to /tmp for a comparison by hand"]
fn write_synthetic_files() {
    use std::fmt::Write;
    for (name, facets, azimuths) in [
        ("synthetic", TrowbridgeReitz::new(0.3, 0.3), Azimuths::Isotropic),
        ("synthetic_full", brushed(), Azimuths::Full(17)),
        ("synthetic_quarter", brushed(), Azimuths::Quarter(5)),
    ] {
        let file = metal_file(facets, &nodes(azimuths, 32));
        std::fs::write(format!("/tmp/{name}.bsdf"), &file).unwrap();
        let table = read(&file);
        let measured = Measured::new(&table, &[450.0, 523.0, 587.0, 700.0]);
        let mut dirs = String::new();
        let mut ours = String::new();
        let mut rng = Pcg32::new(8, 1);
        for _ in 0..400 {
            let mut angle = |scale: f32| rng.next_f32() * scale;
            let angles = [angle(88.0), angle(360.0), angle(88.0), angle(360.0)];
            let (wo, wi) = (at(angles[0], angles[1]), at(angles[2], angles[3]));
            let f = measured.eval(wo, wi, Mode::Radiance);
            let pdf = measured.pdf(wo, wi).0;
            writeln!(dirs, "{} {} {} {}", angles[0], angles[1], angles[2], angles[3]).unwrap();
            writeln!(ours, "{} {} {} {} {pdf}", f[0], f[1], f[2], f[3]).unwrap();
        }
        std::fs::write(format!("/tmp/{name}.dirs"), dirs).unwrap();
        std::fs::write(format!("/tmp/{name}.ours"), ours).unwrap();
    }
}
