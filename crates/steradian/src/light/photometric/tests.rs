//! Files: what is written reads back, what is measured keeps its flux, what is damaged is refused at its place.

use super::ies::Edition;
use super::*;
use std::f64::consts::{PI, TAU};

const EDITIONS: [Edition; 5] =
    [Edition::Of1986, Edition::Of1991, Edition::Of1995, Edition::Of2002, Edition::Of2019];

fn no_tilt(_: &str) -> Result<Vec<u8>, String> {
    Err("no such file".to_owned())
}

fn read_text(text: &str) -> Result<Luminaire, PhotometricError> {
    read(text.as_bytes(), &mut no_tilt)
}

fn lobe(f: impl Fn(f64) -> f64) -> PhotometricWeb {
    let gamma: Vec<f64> = (0..=180).map(f64::from).collect();
    let candela = gamma.iter().map(|g| f(g.to_radians())).collect();
    PhotometricWeb::type_c(vec![0.0], gamma, candela).unwrap()
}

/// A web of each symmetry, and of types A and B, with numbers that a file holds exactly.
fn webs() -> Vec<PhotometricWeb> {
    let c = |planes: &[f64]| {
        let gamma = vec![0.0, 22.5, 60.0, 90.0, 180.0];
        let candela = (0..planes.len() * 5).map(|i| f64::from((i * 37 % 101) as u32) * 0.25).collect();
        PhotometricWeb::type_c(planes.to_vec(), gamma, candela).unwrap()
    };
    let h = vec![-90.0, -30.0, 0.0, 45.0, 90.0];
    let v = vec![-90.0, 0.0, 12.5, 90.0];
    let candela: Vec<f64> = (0..20).map(|i| f64::from(i) * 1.5).collect();
    vec![
        c(&[0.0]),
        c(&[0.0, 15.0, 90.0]),
        c(&[0.0, 15.0, 90.0, 150.0, 180.0]),
        c(&[90.0, 120.0, 180.0, 225.0, 270.0]),
        c(&[0.0, 45.0, 180.0, 300.0, 360.0]),
        PhotometricWeb::type_a(h.clone(), v.clone(), candela.clone()).unwrap(),
        PhotometricWeb::type_b(h, v, candela).unwrap(),
        PhotometricWeb::type_b(vec![0.0, 90.0], vec![-90.0, 0.0, 90.0], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
            .unwrap(),
    ]
}

#[test]
fn written_and_read_back_known_distributions_have_their_flux() {
    for edition in EDITIONS {
        let through_file = |web: PhotometricWeb| {
            let text = ies::write(&Luminaire::of(web.clone()), edition);
            let ldt = eulumdat::write(&Luminaire::of(web)).unwrap();
            [read_text(&text).unwrap().web.flux(), read_text(&ldt).unwrap().web.flux()]
        };
        let check = |fluxes: [f64; 2], expected: f64| {
            for flux in fluxes {
                assert!((flux / expected - 1.0).abs() < 1e-4, "{edition:?}: {flux} {expected}");
            }
        };
        let i0 = 123.0;
        check(through_file(lobe(|_| i0)), 4.0 * PI * i0);
        check(through_file(lobe(|g| i0 * g.cos().max(0.0))), PI * i0);
        for m in 1..=5 {
            check(through_file(lobe(|g| i0 * g.cos().max(0.0).powi(m))), TAU * i0 / f64::from(m + 1));
        }
    }
}

#[test]
fn every_edition_reads_back_what_it_wrote() {
    let label = Label {
        name: "Downlight \"A\"".into(),
        number: "17".into(),
        maker: "Steradian".into(),
        report: "T1".into(),
        date: "2026-11-22".into(),
        lamp: "LED".into(),
    };
    let tilt = Tilt {
        geometry: TiltGeometry::HorizontalAlong90,
        angles: vec![0.0, 45.0, 90.0],
        factors: vec![1.0, 0.75, 0.5],
    };
    for edition in EDITIONS {
        for (i, web) in webs().into_iter().enumerate() {
            let luminaire = Luminaire {
                label: label.clone(),
                lamps: 2,
                lamp_lumens: (i % 2 == 0).then_some(2600.0),
                input_watts: 21.5,
                opening: Opening {
                    along_c0: 0.5,
                    along_c90: 0.25 * (1 + i % 2) as f64,
                    height: 0.0,
                    outline: if i % 3 == 0 { Outline::Ellipse } else { Outline::Rectangle },
                },
                tilt: (i % 2 == 1).then(|| tilt.clone()),
                web,
            };
            let text = ies::write(&luminaire, edition);
            let back = read_text(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
            let kept = if edition == Edition::Of1986 { Label::default() } else { label.clone() };
            let date = if edition >= Edition::Of2002 { label.date.clone() } else { String::new() };
            assert_eq!(back, Luminaire { label: Label { date, ..kept }, ..luminaire }, "{edition:?}\n{text}");
            assert!(text.lines().all(|l| l.len() <= 130), "{text}");
        }
    }
}

#[test]
fn eulumdat_reads_back_what_it_wrote_in_every_symmetry() {
    let indicators = ["1", "4", "2", "3", "0"];
    for (web, isym) in webs().into_iter().zip(indicators) {
        let luminaire = Luminaire {
            label: Label {
                name: "Wall washer".into(),
                maker: "Steradian".into(),
                lamp: "LED".into(),
                ..Label::default()
            },
            lamps: 3,
            lamp_lumens: Some(1000.0),
            input_watts: 9.5,
            opening: Opening { along_c0: 0.125, along_c90: 0.5, height: 0.02, outline: Outline::Rectangle },
            tilt: None,
            web,
        };
        let text = eulumdat::write(&luminaire).unwrap();
        assert_eq!(text.lines().nth(2), Some(isym));
        assert_eq!(read_text(&text).unwrap_or_else(|e| panic!("{e}\n{text}")), luminaire, "{text}");
    }
    // The same with even planes.
    for (range, isym) in [([0, 12], "0"), ([0, 3], "4"), ([0, 6], "2"), ([3, 9], "3")] {
        let planes: Vec<f64> = (range[0]..=range[1]).map(|i| 30.0 * f64::from(i)).collect();
        let candela = (0..planes.len() * 3).map(|i| f64::from((i * i % 23) as u32)).collect();
        let web = PhotometricWeb::type_c(planes, vec![0.0, 45.0, 90.0], candela).unwrap();
        let text =
            eulumdat::write(&Luminaire { lamp_lumens: Some(1000.0), ..Luminaire::of(web.clone()) }).unwrap();
        assert_eq!(text.lines().nth(2), Some(isym));
        assert_eq!(text.lines().nth(4), Some("30"));
        assert_eq!(read_text(&text).unwrap().web, web, "{isym}");
        // Without lamps the flux of the luminaire is what intensities refer to.
        let bare = eulumdat::write(&Luminaire::of(web.clone())).unwrap();
        let back = read_text(&bare).unwrap();
        assert_eq!(back.lamp_lumens, None);
        assert!((back.web.flux() / web.flux() - 1.0).abs() < 1e-7);
    }
    let floodlight = Luminaire::of(webs().pop().unwrap());
    assert_eq!(eulumdat::write(&floodlight), Err(eulumdat::WriteError::Planes(Planes::B)));
}

const IES: &str = "IESNA:LM-63-1995\r\n[TEST] 42\r\n[LUMINAIRE] Batten, open\r\n[MORE] and long\r\nTILT=INCLUDE\r\n1\r\n3\r\n\
     0 45 90\r\n1.0 .95 0.9\r\n2 1500 2.0 3,2 1 1\r\n0.5 4 0\r\n0.9 .8 64\r\n0 45 90\r\n0 90\r\n100 50 0\r\n100.0,5.e1 1E1\r\n";

#[test]
fn a_file_of_1995_is_read_with_all_its_factors() {
    let mut luminaire = read_text(IES).unwrap();
    luminaire.web = luminaire.web.interpolated(Interpolation::Linear);
    assert_eq!((luminaire.lamps, luminaire.lamp_lumens, luminaire.input_watts), (2, Some(3000.0), 64.0));
    assert_eq!(luminaire.label.name, "Batten, open");
    let o = luminaire.opening;
    assert!((o.along_c0 - 4.0 * 0.3048).abs() < 1e-12 && (o.along_c90 - 0.1524).abs() < 1e-12, "{o:?}");
    let tilt = luminaire.tilt.unwrap();
    assert!(
        (tilt.factor(22.5) - 0.975).abs() < 1e-12 && tilt.factor(180.0) == 0.9 && tilt.factor(-1.0) == 1.0
    );
    // 2 · 0.9 · 0.8 = 1.44.
    assert!((luminaire.web.at(0.0, 0.0) - 144.0).abs() < 1e-9);
    assert!((luminaire.web.at(270.0, 90.0) - 14.4).abs() < 1e-9, "a quadrant stands for all four");
    assert!((luminaire.web.at(45.0, 67.5) - 0.5 * (36.0 + 43.2)).abs() < 1e-9);
    // Since 2019 the second factor codes how the file was made.
    let later = IES.replace("IESNA:LM-63-1995", "IES:LM-63-2019").replace(" .8 64", " 1.10000 64");
    assert!((read_text(&later).unwrap().web.at(0.0, 0.0) - 180.0).abs() < 1e-9);
    // Factors may stand in a file of their own.
    let apart = IES.replace("TILT=INCLUDE\r\n1\r\n3\r\n0 45 90\r\n1.0 .95 0.9", "TILT=lamp.tlt");
    let mut names = Vec::new();
    let mut file = |name: &str| {
        names.push(name.to_owned());
        Ok(b"1 3 0 45 90 1.0 .95 0.9".to_vec())
    };
    assert_eq!(read(apart.as_bytes(), &mut file).unwrap(), read_text(IES).unwrap());
    assert_eq!(names, ["lamp.tlt"]);
    let damaged = read(apart.as_bytes(), &mut |_| Ok(b"1 3 0 45\n40 1.0 .95 0.9".to_vec())).unwrap_err();
    assert_eq!((damaged.file.as_deref(), damaged.line, damaged.column), (Some("lamp.tlt"), 2, 1));
}

#[test]
fn round_openings_are_told_by_their_signs() {
    let with = |edition: &str, size: &str| {
        read_text(
            &IES.replace("IESNA:LM-63-1995", edition).replace("1 1\r\n0.5 4 0", &format!("1 2\r\n{size}")),
        )
        .unwrap()
        .opening
    };
    let opening = |x: f64, y: f64, z: f64, outline| Opening { along_c0: x, along_c90: y, height: z, outline };
    let disk = opening(0.2, 0.2, 0.0, Outline::Ellipse);
    assert_eq!(with("IESNA:LM-63-1995", "-0.2 0 0"), disk);
    assert_eq!(with("IESNA:LM-63-2002", "-0.2 -0.2 0"), disk);
    assert_eq!(with("IESNA91", "-0.2 0.4 0"), opening(0.4, 0.2, 0.0, Outline::Ellipse));
    assert_eq!(with("IESNA:LM-63-2002", "-0.2 0.4 -0.2"), opening(0.4, 0.2, 0.2, Outline::Rectangle));
    assert_eq!(with("IESNA:LM-63-2002", "0 0 0"), Opening::default());
}

/// A wall washer: symmetric about C90–C270, four planes, three angles; data from C270 over C0 to C90.
fn ldt() -> String {
    let head = "Steradian\n3\n3\n4\n90\n3\n45\nT1\nWasher\nW1\nw.ldt\n2026\n600\n100\n50\n500\n0\n0\n0\n0\n0\n100\n80\n2\n0\n2\n";
    let lamps = "1\nLED\n500\n3000\n80\n6,5 W\n2\nother\n900\n4000\n90\n11\n";
    let ratios = "0\n".repeat(10);
    let angles = "0\n90\n180\n270\n0\n45\n90\n";
    format!("{head}{lamps}{ratios}{angles}100\n10\n1\n100\n20\n2\n100\n30,5\n3\n")
}

#[test]
fn a_eulumdat_file_of_symmetry_3_is_read_with_all_its_factors() {
    let luminaire = read_text(&ldt()).unwrap();
    assert_eq!((luminaire.lamps, luminaire.lamp_lumens, luminaire.input_watts), (1, Some(500.0), 6.5));
    assert_eq!(
        luminaire.opening,
        Opening { along_c0: 0.5, along_c90: 0.5, height: 0.0, outline: Outline::Ellipse }
    );
    // 2 · 500 lm / 1000 lm = 1: the numbers are candela.
    let at = |c: f64| luminaire.web.at(c, 45.0);
    assert_eq!([at(270.0), at(0.0), at(90.0), at(180.0)], [10.0, 20.0, 30.5, 20.0]);
    assert_eq!(luminaire.web.symmetry(), Symmetry::AboutC90);
}

/// Where and what is wrong.
fn fault(text: &str) -> (usize, usize, String) {
    let e = read_text(text).unwrap_err();
    (e.line, e.column, e.message)
}

#[test]
fn malformed_files_are_refused_at_the_place_of_the_fault() {
    let ies = |from: &str, to: &str| {
        assert!(IES.contains(from), "{from}");
        fault(&IES.replacen(from, to, 1))
    };
    let at = |line: usize, column: usize, message: &str| (line, column, message.to_owned());
    assert_eq!(
        ies("TILT=INCLUDE", "TILT INCLUDE"),
        at(16, 15, "no line begins with TILT=, as one of every IES LM-63 file does")
    );
    assert_eq!(
        ies("100.0,5.e1 1E1\r\n", "100.0,5.e1"),
        at(16, 11, "the file ends where an intensity should follow (intensity 3 of horizontal angle 2 of 2)")
    );
    assert_eq!(
        ies("100 50 0", "100 5O 0"),
        at(15, 5, "expected an intensity, a number, found `5O` (intensity 2 of horizontal angle 1 of 2)")
    );
    assert_eq!(
        ies("64\r\n0 45 90", "64\r\n0 -45 90"),
        at(13, 3, "the angle must lie from 0 to 180 degrees, found -45")
    );
    assert_eq!(ies("64\r\n0 45 90", "64\r\n0 90 45"), at(13, 6, "angles must increase, found 45 after 90"));
    assert_eq!(
        ies("3,2 1 1", "3,-2 1 1"),
        at(10, 14, "the number of horizontal angles must be a whole number from 1 to 3601, found -2")
    );
    assert_eq!(
        ies("3,2 1 1", "3,2000000000 1 1"),
        at(10, 14, "the number of horizontal angles must be a whole number from 1 to 3601, found 2000000000")
    );
    assert_eq!(
        ies("\r\n0 90\r\n", "\r\n0 80\r\n"),
        at(14, 3, "planes from 0 to 80 degrees: they must reach from 0 to 90, 180 or 360, or from 90 to 270")
    );
    assert_eq!(ies("100 50 0", "100 -50 0").2, "an intensity must be finite and not negative, found -50");
    assert_eq!(ies("1500 2.0", "1500 1e40"), at(10, 8, "intensities exceed 1e30 cd"));
    assert_eq!(ies("1E1", "1E1 7"), at(16, 16, "the file goes on after its 6 intensities (2 × 3)"));
    assert_eq!(
        ies("INCLUDE\r\n1\r\n3\r\n0 45 90\r\n1.0 .95 0.9", "a.tlt"),
        at(5, 1, "cannot read the file of tilt factors: no such file")
    );
    let e = read_text(&IES.replacen("100 50 0", "100 5O 0", 1)).unwrap_err();
    assert_eq!((e.text.as_str(), e.length), ("100 5O 0", 2));

    let whole = ldt();
    let ldt = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        fault(&whole.replacen(from, to, 1))
    };
    assert_eq!(
        ldt("\n3\n3\n4", "\n3\n5\n4"),
        at(3, 1, "the symmetry indicator Isym must be a whole number from 0 to 4, found `5`")
    );
    assert_eq!(
        ldt("\n4\n90\n3", "\n6\n90\n3"),
        at(4, 1, "with this symmetry the number of C-planes must be a multiple of 4, found 6")
    );
    assert_eq!(
        ldt("LED\n500", "LED\nbright"),
        at(29, 1, "expected the total luminous flux of the lamps, a number, found `bright`")
    );
    assert_eq!(ldt("\n0\n45\n90\n", "\n0\n90\n45\n"), at(55, 1, "angles must increase, found 45 after 90"));
    assert_eq!(ldt("30,5\n3\n", "30,5\n"), at(63, 5, "the file ends where intensity 9 of 9 should follow"));
    assert_eq!(
        ldt("30,5\n3\n", "30,5\n3\n4\n"),
        at(65, 1, "the file goes on after its 9 intensities (3 × 3)")
    );
    assert_eq!(fault("").2, "no line begins with TILT=, as one of every IES LM-63 file does");
}

#[test]
fn damaged_files_are_read_or_refused_and_never_more() {
    let originals = [
        IES.as_bytes().to_vec(),
        ldt().into_bytes(),
        ies::write(&Luminaire::of(webs().remove(1)), Edition::Of2019).into_bytes(),
    ];
    let mut rng = crate::math::hash::Pcg32::new(11, 1);
    let mut below = |n: usize| ((rng.next_f32() * n as f32) as usize).min(n - 1);
    let (mut read_well, mut refused) = (0, 0);
    for i in 0..2000 {
        let mut bytes = originals[i % originals.len()].clone();
        for _ in 0..1 + below(4) {
            let (at, other) = (below(bytes.len()), below(bytes.len()));
            match below(6) {
                0 => bytes[at] = below(256) as u8,
                1 => bytes.truncate(at.max(1)),
                2 => drop(bytes.remove(at)),
                3 => bytes.insert(at, b"0123456789-.,eE \r\n\x1a"[below(19)]),
                4 => bytes.swap(at, other),
                _ => {
                    let piece = bytes[at.min(other)..at.max(other)].to_vec();
                    bytes.splice(at..at, piece);
                }
            }
            if bytes.is_empty() {
                bytes.push(b'0');
            }
        }
        match read(&bytes, &mut no_tilt) {
            Ok(l) => {
                read_well += 1;
                let flux = l.web.flux();
                assert!(flux.is_finite() && flux >= -1e-9 * l.web.peak(), "{flux}");
            }
            Err(e) => {
                refused += 1;
                let text = text::decode(&bytes);
                assert!(e.line <= text.split(['\n', '\r']).count(), "{e:?}");
                assert!(e.column <= e.text.chars().count() + 1 && e.length >= 1, "{e:?}");
            }
        }
    }
    assert!(read_well > 100 && refused > 1000, "{read_well} {refused}");
}
