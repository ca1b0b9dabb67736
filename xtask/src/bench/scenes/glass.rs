//! Glass and metal on tiles, under the sky.

use super::description::{Color, Environment, Material, Object, Scene, View};
use super::mesh::Mesh;
use super::pictures::{HAZE, Picture, tiles};
use std::f32::consts::{PI, TAU};

pub(super) fn glass() -> Scene {
    let of = |name, mesh, material| Object { name, mesh, material, emission: None };
    let mut ground = Mesh::default();
    ground.quad([-12.0, 0.0, 12.0], [24.0, 0.0, 0.0], [0.0, 0.0, -24.0], [0.0; 2], 0.25);
    let mut clear = Mesh::default();
    clear.ball([-1.5, 0.75, 0.6], 0.75, [128, 64]);
    goblet(&mut clear, [0.3, 0.0, 1.7]);
    let mut frosted = Mesh::default();
    frosted.ball([1.65, 0.65, 1.0], 0.65, [128, 64]);
    let mut slab = Mesh::default();
    slab.block([-0.7, 0.02, -1.9], [1.5, 1.1, -1.65], 1.0);
    let mut gold = Mesh::default();
    knot(&mut gold, [0.1, 1.0, -0.3]);
    let mut silver = Mesh::default();
    silver.ball([-2.3, 0.9, -1.7], 0.9, [128, 64]);
    let mut copper = Mesh::default();
    let profile = |v: f32| [0.18 + 0.38 * (PI * v).sin().powi(2) + 0.1 * v, 1.5 * v];
    copper.turned([2.5, 0.0, -1.0], [160, 80], profile, |u, v| 0.08 * (TAU * (9.0 * u + v)).sin());
    let metal = |eta, k, alpha| Material::Conductor { eta, k, alpha };
    let objects = vec![
        of("ground", ground, Material::Diffuse(Color::Picture("tiles.png"))),
        of("clear", clear, Material::Dielectric { eta: 1.5, alpha: 0.0 }),
        of("frosted", frosted, Material::Dielectric { eta: 1.5, alpha: 0.15 }),
        of("slab", slab, Material::Dielectric { eta: 1.6, alpha: 0.0 }),
        of("gold", gold, metal([1.7, 1.5, 0.5, 0.2, 0.18], [1.9, 1.9, 2.2, 3.3, 5.1], 0.1)),
        of("silver", silver, metal([0.2, 0.14, 0.13, 0.14, 0.2], [1.4, 2.5, 3.3, 4.1, 5.6], 0.0)),
        of("copper", copper, metal([1.2, 1.15, 1.0, 0.3, 0.25], [1.9, 2.4, 2.6, 3.4, 5.2], 0.25)),
    ];
    let pictures = vec![
        ("tiles.png", Picture::texture(512, tiles)),
        ("sky-square.exr", Picture::sky_square(512, &HAZE)),
        ("sky-latlong.exr", Picture::sky_latlong(512, &HAZE)),
    ];
    let view = View {
        eye: [0.4, 2.6, 7.2],
        target: [0.0, 0.7, 0.0],
        fov: 36.0,
        width: 320,
        height: 240,
        max_depth: 12,
    };
    let environment = Environment { square: "sky-square.exr", latlong: "sky-latlong.exr" };
    Scene { view, objects, lamps: Vec::new(), pictures, environment: Some(environment) }
}

/// A glass on a foot: up the outside, down the inside.
fn goblet(mesh: &mut Mesh, base: [f32; 3]) {
    let outline = [
        [0.002, 0.01],
        [0.3, 0.01],
        [0.3, 0.03],
        [0.05, 0.06],
        [0.04, 0.4],
        [0.2, 0.52],
        [0.3, 0.8],
        [0.26, 1.1],
        [0.245, 1.1],
        [0.28, 0.8],
        [0.18, 0.55],
        [0.002, 0.48],
    ];
    let profile = |v: f32| {
        let x = v.clamp(0.0, 1.0) * (outline.len() - 1) as f32;
        let i = (x as usize).min(outline.len() - 2);
        std::array::from_fn(|c| outline[i][c] + (x - i as f32) * (outline[i + 1][c] - outline[i][c]))
    };
    mesh.turned(base, [96, 110], profile, |_, _| 0.0);
}

/// A tube along a trefoil.
fn knot(mesh: &mut Mesh, center: [f32; 3]) {
    let path = |t: f32| {
        let a = TAU * t;
        let r = 0.5 + 0.22 * (3.0 * a).cos();
        [r * (2.0 * a).cos(), 0.45 * (3.0 * a).sin(), r * (2.0 * a).sin()]
    };
    let at = |u: f32, v: f32| {
        let (p, q) = (path(u), path(u + 1e-3));
        let along = unit([q[0] - p[0], q[1] - p[1], q[2] - p[2]]);
        // Any frame that never flips: the tube stays clear of the vertical.
        let side = unit([along[2], 0.0, -along[0]]);
        let up = [
            along[1] * side[2] - along[2] * side[1],
            along[2] * side[0] - along[0] * side[2],
            along[0] * side[1] - along[1] * side[0],
        ];
        // Against the clock, so that it faces outwards.
        let (sin, cos) = (-TAU * v).sin_cos();
        std::array::from_fn(|i| center[i] + p[i] + 0.13 * (cos * side[i] + sin * up[i]))
    };
    mesh.sheet(320, 40, at, [8.0, 1.0]);
}

fn unit(a: [f32; 3]) -> [f32; 3] {
    let l = a.iter().map(|x| x * x).sum::<f32>().sqrt();
    a.map(|x| x / l)
}
