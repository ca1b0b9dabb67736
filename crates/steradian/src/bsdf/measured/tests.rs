use super::specimens::{Metal, metal_file, nodes};
use super::tabulate::Azimuths;
use super::*;
use crate::bsdf::conformance::{self, Effort, Law};
use crate::bsdf::{Bsdf, Cabinet};
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
fn specimens_obey_the_laws_that_they_claim() {
    let cabinet = Cabinet::default();
    let effort = Effort { samples: 40_000, ..Effort::default() };
    for s in Measured::specimens(&cabinet.measured) {
        let s = s.map(Bsdf::Measured);
        for f in conformance::examine(&s, &effort) {
            assert!(f.holds() || f.law == Law::Reciprocity, "{}: {f:?}", s.name);
        }
    }
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
    // 33 nodes over the circle of normals have its symmetries, 32 have not.
    let table = |azimuths| read(&metal_file(brushed(), &nodes(azimuths, 33)));
    let tables = [Azimuths::Full(17), Azimuths::Half(9), Azimuths::Quarter(5)].map(table);
    let mut rng = Pcg32::new(6, 1);
    for _ in 0..500 {
        let mut draw = || LocalDir::new(uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32())));
        let (Some(wo), Some(wi)) = (draw(), draw()) else { continue };
        let u = Vec2::new(rng.next_f32(), rng.next_f32());
        let [full, half, quarter] =
            [0, 1, 2].map(|i| Measured::new(&tables[i], &LAMBDA).eval(wo, wi, Mode::Radiance)[1]);
        let close = |a: f32, b: f32| (a - b).abs() <= 1e-3 * (a + 1e-3);
        assert!(close(full, half) && close(full, quarter), "{wo:?} {wi:?}: {full} {half} {quarter}");
        for t in &tables {
            let measured = Measured::new(t, &LAMBDA);
            if let Some(s) = measured.sample(wo, 0.5, u, Mode::Radiance) {
                let ratio = measured.eval(wo, s.wi, Mode::Radiance)[1] * s.wi.abs_cos_theta()
                    / measured.pdf(wo, s.wi).0;
                assert!((ratio / s.weight[1] - 1.0).abs() < 2e-3, "{wo:?}: {ratio} {}", s.weight[1]);
            }
        }
    }
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
