//! A square at sundown: the last sun, a dusky sky and some three hundred lamps that are lit already.

use super::description::{Color, Environment, Lamp, Material, Object, Scene, View};
use super::mesh::Mesh;
use super::pictures::{EVENING, Picture, noise, plaster, tiles};
use std::f32::consts::{PI, TAU};
use steradian::math::hash::Pcg32;

/// Half the side of the square [m].
const HALF: f32 = 16.0;

pub(super) fn plaza() -> Scene {
    let mut rng = Pcg32::new(47, 1);
    let mut ground = Mesh::default();
    ground.quad([-60.0, 0.0, 60.0], [120.0, 0.0, 0.0], [0.0, 0.0, -120.0], [0.0; 2], 0.06);
    let mut lamps = Vec::new();
    let [mut stone, mut walls, mut columns] = [Mesh::default(), Mesh::default(), Mesh::default()];
    let mut panes: [Mesh; 2] = Default::default();
    arcade(&mut walls, &mut columns, &mut lamps, &mut panes, &mut rng);
    tower(&mut walls, &mut panes);
    fountain(&mut stone, &mut lamps);

    let [mut poles, mut parasols, mut tables] = [Mesh::default(), Mesh::default(), Mesh::default()];
    for i in 0..10 {
        let (row, column) = (i / 5, i % 5);
        let at =
            [-12.5 + 3.6 * column as f32 + 0.8 * rng.next_f32(), 7.4 - 4.0 * row as f32 + rng.next_f32()];
        table(&mut poles, &mut parasols, &mut tables, &mut lamps, at);
    }
    let [mut trunks, mut crowns] = [Mesh::default(), Mesh::default()];
    for [x, z] in [[6.5, 10.5], [10.5, 6.0], [11.0, -1.0], [8.5, -6.5]] {
        tree(&mut trunks, &mut crowns, &mut lamps, [x, z], &mut rng);
    }
    for i in 0..12 {
        let a = TAU * (i as f32 + 0.5) / 12.0;
        let [x, z] = [9.0 * a.sin(), 9.0 * a.cos()];
        poles.post([x, 0.0, z], 0.05, 3.0);
        lamps.push(Lamp { center: [x, 3.14, z], radius: 0.14, radiance: [42.0, 30.0, 15.0] });
    }

    let plain = |rgb| Material::Diffuse(Color::Rgb(rgb));
    let mut objects = vec![
        object("plaza-ground", ground, Material::Diffuse(Color::Picture("tiles.png"))),
        object("plaza-walls", walls, Material::Diffuse(Color::Picture("plaster.png"))),
        object("plaza-columns", columns, plain([0.6, 0.55, 0.48])),
        object("plaza-stone", stone, Material::Coated { base: Color::Rgb([0.3, 0.3, 0.28]), alpha: 0.1 }),
        object("plaza-poles", poles, plain([0.06, 0.07, 0.06])),
        object("plaza-parasols", parasols, Material::Sheet(Color::Rgb([0.7, 0.62, 0.45]))),
        object("plaza-tables", tables, BRASS),
        object("plaza-trunks", trunks, plain([0.12, 0.08, 0.05])),
        object("plaza-crowns", crowns, Material::Sheet(Color::Rgb([0.08, 0.16, 0.05]))),
    ];
    let [warm, pale] = panes;
    for (name, mesh, radiance) in
        [("plaza-panes-warm", warm, [2.4, 1.4, 0.6]), ("plaza-panes-pale", pale, [1.0, 0.95, 0.75])]
    {
        objects.push(Object { emission: Some(radiance), ..object(name, mesh, plain([0.0; 3])) });
    }
    let pictures = vec![
        ("tiles.png", Picture::texture(512, tiles)),
        ("plaster.png", Picture::texture(1024, plaster)),
        ("evening-square.exr", Picture::sky_square(512, &EVENING)),
        ("evening-latlong.exr", Picture::sky_latlong(512, &EVENING)),
    ];
    let view = View {
        eye: [-3.0, 2.6, 19.5],
        target: [-0.5, 2.3, 0.0],
        fov: 44.0,
        width: 320,
        height: 240,
        max_depth: 7,
    };
    let environment = Environment { square: "evening-square.exr", latlong: "evening-latlong.exr" };
    Scene { view, objects, lamps, pictures, environment: Some(environment) }
}

/// A metal with the index of brass, roughly.
const BRASS: Material =
    Material::Conductor { eta: [1.4, 1.3, 0.7, 0.45, 0.4], k: [1.8, 1.9, 2.4, 3.4, 5.0], alpha: 0.2 };

fn object(name: &'static str, mesh: Mesh, material: Material) -> Object {
    Object { name, mesh, material, emission: None }
}

/// Houses over arcades along the sides x < 0, x > 0 and z < 0, lit beneath their vaults and behind some windows.
fn arcade(
    walls: &mut Mesh,
    columns: &mut Mesh,
    lamps: &mut Vec<Lamp>,
    panes: &mut [Mesh; 2],
    rng: &mut Pcg32,
) {
    let (depth, low, high) = (3.5, 3.4, 9.0);
    let outer = HALF + depth + 5.0;
    // Upper floors reach over the arcade, ground floors stand behind it.
    for side in [-1.0_f32, 1.0] {
        let (a, b) = (side * HALF, side * outer);
        walls.block([a.min(b), low, -HALF], [a.max(b), high, HALF + 6.0], 0.25);
        let a = side * (HALF + depth);
        walls.block([a.min(b), 0.0, -HALF], [a.max(b), low, HALF + 6.0], 0.25);
    }
    walls.block([-outer, low, -outer], [outer, high + 1.5, -HALF], 0.25);
    walls.block([-outer, 0.0, -outer], [outer, low, -HALF - depth], 0.25);
    for i in 0..11 {
        let along = -HALF + 3.2 * i as f32;
        for [x, z] in [[-HALF - 0.3, along], [HALF + 0.3, along], [along, -HALF - 0.3]] {
            columns.post([x, 0.0, z], 0.28, low);
            walls.block([x - 0.4, low - 0.35, z - 0.4], [x + 0.4, low + 0.01, z + 0.4], 1.0);
        }
        let under = 0.5 * depth;
        let hung = [[-HALF - under, along + 1.6], [HALF + under, along + 1.6], [along + 1.6, -HALF - under]];
        for [x, z] in hung {
            for dx in [-0.6, 0.6] {
                lamps.push(Lamp { center: [x + dx, 3.0, z], radius: 0.07, radiance: [75.0, 52.0, 27.0] });
            }
        }
    }
    for floor in 0..2 {
        let y = 4.3 + 2.4 * floor as f32;
        for i in 0..10 {
            let along = -HALF + 1.1 + 3.2 * i as f32;
            let mut pane = |corner: [f32; 3], u: [f32; 3]| {
                let lit = rng.next_f32();
                if lit < 0.5 {
                    panes[usize::from(lit < 0.2)].quad(corner, u, [0.0, 1.5, 0.0], [0.0; 2], 1.0);
                }
            };
            pane([-HALF + 0.01, y, along + 1.0], [0.0, 0.0, -1.0]);
            pane([HALF - 0.01, y, along], [0.0, 0.0, 1.0]);
            pane([along, y, -HALF + 0.01], [1.0, 0.0, 0.0]);
        }
    }
}

/// Behind the houses, with a shining clock.
fn tower(walls: &mut Mesh, panes: &mut [Mesh; 2]) {
    walls.block([3.0, 0.0, -26.0], [8.0, 19.0, -21.0], 0.25);
    walls.block([2.6, 19.0, -26.4], [8.4, 19.6, -20.6], 0.25);
    panes[1].quad([4.6, 15.0, -20.98], [1.8, 0.0, 0.0], [0.0, 1.8, 0.0], [0.0; 2], 1.0);
}

/// A basin with a bowl on a foot, and lamps around its rim.
fn fountain(stone: &mut Mesh, lamps: &mut Vec<Lamp>) {
    let outline = |v: f32| {
        let x = v.clamp(0.0, 1.0) * 6.0;
        let corners = [[2.9, 0.0], [2.9, 0.6], [2.6, 0.6], [2.5, 0.25], [0.4, 0.22], [0.25, 1.5], [1.3, 1.9]];
        let i = (x as usize).min(5);
        std::array::from_fn(|c| corners[i][c] + (x - i as f32) * (corners[i + 1][c] - corners[i][c]))
    };
    stone.turned([0.0, 0.0, 0.0], [96, 60], outline, |_, _| 0.0);
    stone.turned([0.0, 1.5, 0.0], [96, 24], |v| [1.3 * (1.0 - v), 0.4 - 0.25 * v], |_, _| 0.0);
    stone.ball([0.0, 2.1, 0.0], 0.35, [64, 32]);
    for i in 0..16 {
        let (sin, cos) = (TAU * i as f32 / 16.0).sin_cos();
        let center = [2.2 * sin, 0.36, 2.2 * cos];
        lamps.push(Lamp { center, radius: 0.05, radiance: [40.0, 60.0, 80.0] });
    }
}

/// A table under a parasol that hides three lamps from above.
fn table(poles: &mut Mesh, parasols: &mut Mesh, tables: &mut Mesh, lamps: &mut Vec<Lamp>, [x, z]: [f32; 2]) {
    poles.post([x, 0.0, z], 0.03, 2.5);
    tables.turned([x, 0.72, z], [32, 6], |v| [0.5 * (1.0 - v), 0.02 * v], |_, _| 0.0);
    parasols.turned([x, 2.0, z], [8, 8], |v| [1.5 * (1.0 - v), 0.55 * v], |_, _| 0.0);
    for i in 0..3 {
        let (sin, cos) = (TAU * i as f32 / 3.0 + x).sin_cos();
        let center = [x + 0.4 * sin, 1.95, z + 0.4 * cos];
        lamps.push(Lamp { center, radius: 0.04, radiance: [90.0, 60.0, 28.0] });
    }
}

/// A tree of separate leaves with small bulbs among them.
fn tree(trunks: &mut Mesh, crowns: &mut Mesh, lamps: &mut Vec<Lamp>, [x, z]: [f32; 2], rng: &mut Pcg32) {
    trunks.post([x, 0.0, z], 0.16, 3.0);
    let mut within = |radius: f32| {
        let (u, v) = (rng.next_f32(), rng.next_f32());
        let r = radius * (0.35 + 0.65 * rng.next_f32());
        let (y, ring) = (2.0 * u - 1.0, 2.0 * (u * (1.0 - u)).sqrt());
        let (sin, cos) = (TAU * v).sin_cos();
        [x + r * ring * sin, 4.1 + 0.8 * r * y, z + r * ring * cos]
    };
    for _ in 0..1400 {
        let at = within(1.9);
        let turn = TAU * noise(at[0] * 31.0, at[2] * 37.0);
        let (sin, cos) = turn.sin_cos();
        let tilt = 0.1 * (PI * turn).sin();
        crowns.quad(at, [0.16 * cos, tilt, 0.16 * sin], [-0.06 * sin, 0.09, 0.06 * cos], [0.0; 2], 1.0);
    }
    for _ in 0..30 {
        lamps.push(Lamp { center: within(2.0), radius: 0.03, radiance: [70.0, 50.0, 26.0] });
    }
}
