//! A furnished room: lit through a window and by panels under the ceiling, or by a sky with its sun through the window alone.

use super::description::{Color, Environment, Material, Object, Scene, View};
use super::mesh::Mesh;
use super::pictures::{AFTERNOON, Picture, carpet, fractal, noise, plaster, tiles, wood};
use std::f32::consts::TAU;
use steradian::math::hash::Pcg32;

/// The room's size [m]; y is up.
const ROOM: [f32; 3] = [6.0, 2.8, 5.0];

pub(super) fn interior() -> Scene {
    let mut scene = room();
    for (name, mesh, radiance) in lights() {
        let black = Material::Diffuse(Color::Rgb([0.0; 3]));
        scene.objects.push(Object { emission: Some(radiance), ..object(name, mesh, black) });
    }
    scene
}

/// The room under a sky whose sun shines onto the table.
pub(super) fn by_day() -> Scene {
    let mut scene = room();
    scene.pictures.push(("afternoon-square.exr", Picture::sky_square(512, &AFTERNOON)));
    scene.pictures.push(("afternoon-latlong.exr", Picture::sky_latlong(512, &AFTERNOON)));
    scene.environment =
        Some(Environment { square: "afternoon-square.exr", latlong: "afternoon-latlong.exr" });
    scene
}

/// Without light.
fn room() -> Scene {
    let mut objects = vec![
        object("floor", floor(), varnished("wood.png")),
        object("walls", walls(), Material::Diffuse(Color::Picture("plaster.png"))),
        object("ceiling", ceiling(), Material::Diffuse(Color::Rgb([0.8, 0.8, 0.78]))),
        object("plinth", plinth(), Material::Coated { base: Color::Rgb([0.75, 0.73, 0.7]), alpha: 0.2 }),
        object("tabletop", table_top(), varnished("wood.png")),
        object("chairs", chairs(), Material::Coated { base: Color::Picture("wood.png"), alpha: 0.15 }),
        object("shelf", shelf(), Material::Coated { base: Color::Rgb([0.3, 0.17, 0.09]), alpha: 0.1 }),
        object("carpet", rug(), Material::Diffuse(Color::Picture("carpet.png"))),
        object("curtains", curtains(), Material::Sheet(Color::Rgb([0.55, 0.35, 0.3]))),
        object("urn", urn(), varnished("tiles.png")),
        object("vase", vase(), Material::Coated { base: Color::Rgb([0.05, 0.18, 0.4]), alpha: 0.0 }),
        object("bowl", bowl(), Material::Coated { base: Color::Picture("plaster.png"), alpha: 0.05 }),
        object("fruit", fruit(), Material::Coated { base: Color::Rgb([0.6, 0.22, 0.04]), alpha: 0.3 }),
        object("legs", table_legs(), STEEL),
    ];
    let [books_a, books_b, books_c, books_d] = books();
    let book = |rgb, alpha| Material::Coated { base: Color::Rgb(rgb), alpha };
    objects.push(object("books-a", books_a, book([0.45, 0.08, 0.06], 0.25)));
    objects.push(object("books-b", books_b, book([0.06, 0.2, 0.14], 0.1)));
    objects.push(object("books-c", books_c, book([0.7, 0.6, 0.4], 0.0)));
    objects.push(object("books-d", books_d, Material::Diffuse(Color::Rgb([0.12, 0.14, 0.3]))));
    let pictures = vec![
        ("wood.png", Picture::texture(1024, wood)),
        ("tiles.png", Picture::texture(512, tiles)),
        ("plaster.png", Picture::texture(1024, plaster)),
        ("carpet.png", Picture::texture(1024, carpet)),
    ];
    let view = View {
        eye: [5.6, 1.55, 4.7],
        target: [1.7, 0.85, 1.0],
        fov: 50.0,
        width: 320,
        height: 240,
        max_depth: 8,
    };
    Scene { view, objects, lamps: Vec::new(), pictures, environment: None }
}

/// A metal with the index of steel, roughly.
const STEEL: Material =
    Material::Conductor { eta: [1.8, 2.3, 2.7, 2.9, 3.2], k: [2.7, 3.0, 3.2, 3.3, 3.9], alpha: 0.2 };

fn varnished(picture: &'static str) -> Material {
    Material::Coated { base: Color::Picture(picture), alpha: 0.0 }
}

fn object(name: &'static str, mesh: Mesh, material: Material) -> Object {
    Object { name, mesh, material, emission: None }
}

fn floor() -> Mesh {
    let mut mesh = Mesh::default();
    let mut rng = Pcg32::new(11, 1);
    let (rows, width) = (40, ROOM[2] / 40.0);
    for row in 0..rows {
        let z = row as f32 * width;
        let mut x = -2.0 * rng.next_f32();
        while x < ROOM[0] {
            let length = 1.2 + 0.8 * rng.next_f32();
            let lift = 0.002 * rng.next_f32();
            let (low, high) = (x.max(0.0), (x + length - 0.003).min(ROOM[0]));
            if high > low {
                mesh.block([low, -0.03, z], [high, lift, z + width - 0.003], 0.5);
            }
            x += length;
        }
    }
    // What is seen through the joints.
    mesh.quad([0.0, -0.02, ROOM[2]], [ROOM[0], 0.0, 0.0], [0.0, 0.0, -ROOM[2]], [0.0; 2], 0.5);
    mesh
}

/// The window in the wall x = 0: low and high corner in (z, y).
const WINDOW: [[f32; 2]; 2] = [[1.4, 0.9], [3.6, 2.3]];

fn walls() -> Mesh {
    let mut mesh = Mesh::default();
    let [x, y, z] = ROOM;
    mesh.quad([0.0; 3], [x, 0.0, 0.0], [0.0, y, 0.0], [0.0; 2], 0.5);
    mesh.quad([x, 0.0, z], [-x, 0.0, 0.0], [0.0, y, 0.0], [0.3, 0.1], 0.5);
    mesh.quad([x, 0.0, 0.0], [0.0, 0.0, z], [0.0, y, 0.0], [0.6, 0.2], 0.5);
    let [[z0, y0], [z1, y1]] = WINDOW;
    let mut panel = |[za, ya]: [f32; 2], [zb, yb]: [f32; 2]| {
        mesh.quad([0.0, ya, zb], [0.0, 0.0, za - zb], [0.0, yb - ya, 0.0], [zb * 0.5, ya * 0.5], 0.5);
    };
    panel([0.0, 0.0], [z, y0]);
    panel([0.0, y1], [z, y]);
    panel([0.0, y0], [z0, y1]);
    panel([z1, y0], [z, y1]);
    // The reveal, 25 cm deep.
    let depth = -0.25;
    mesh.quad([0.0, y0, z1], [0.0, 0.0, z0 - z1], [depth, 0.0, 0.0], [0.0; 2], 0.5);
    mesh.quad([0.0, y1, z0], [0.0, 0.0, z1 - z0], [depth, 0.0, 0.0], [0.0; 2], 0.5);
    mesh.quad([0.0, y0, z0], [0.0, y1 - y0, 0.0], [depth, 0.0, 0.0], [0.0; 2], 0.5);
    mesh.quad([0.0, y1, z1], [0.0, y0 - y1, 0.0], [depth, 0.0, 0.0], [0.0; 2], 0.5);
    mesh
}

fn ceiling() -> Mesh {
    let mut mesh = Mesh::default();
    let [x, y, z] = ROOM;
    mesh.quad([0.0, y, 0.0], [x, 0.0, 0.0], [0.0, 0.0, z], [0.0; 2], 1.0);
    for beam in 0..4 {
        let z = 0.5 + 1.25 * beam as f32;
        mesh.block([0.0, y - 0.12, z], [x, y + 0.01, z + 0.12], 1.0);
    }
    mesh
}

fn plinth() -> Mesh {
    let mut mesh = Mesh::default();
    let [x, _, z] = ROOM;
    mesh.block([0.0, 0.0, 0.0], [x, 0.1, 0.015], 1.0);
    mesh.block([0.0, 0.0, 0.0], [0.015, 0.1, z], 1.0);
    mesh.block([x - 0.015, 0.0, 0.0], [x, 0.1, z], 1.0);
    let [[z0, y0], [z1, y1]] = WINDOW;
    // The window's frame and cross.
    mesh.block([-0.12, y0, z0], [-0.06, y0 + 0.06, z1], 1.0);
    mesh.block([-0.12, y1 - 0.06, z0], [-0.06, y1, z1], 1.0);
    mesh.block([-0.12, y0, 0.5 * (z0 + z1) - 0.03], [-0.06, y1, 0.5 * (z0 + z1) + 0.03], 1.0);
    mesh.block([-0.12, 0.5 * (y0 + y1) - 0.02, z0], [-0.06, 0.5 * (y0 + y1) + 0.02, z1], 1.0);
    mesh
}

/// The table's low and high corner in (x, z), and its height.
const TABLE: [[f32; 2]; 2] = [[2.0, 1.7], [3.8, 2.7]];
const TABLE_HEIGHT: f32 = 0.74;

fn table_top() -> Mesh {
    let mut mesh = Mesh::default();
    let [[x0, z0], [x1, z1]] = TABLE;
    mesh.block([x0, TABLE_HEIGHT - 0.04, z0], [x1, TABLE_HEIGHT, z1], 0.8);
    mesh
}

fn table_legs() -> Mesh {
    let mut mesh = Mesh::default();
    let [[x0, z0], [x1, z1]] = TABLE;
    for [x, z] in [[x0, z0], [x1, z0], [x0, z1], [x1, z1]] {
        let inset = |a: f32, low: f32| if a == low { a + 0.08 } else { a - 0.08 };
        mesh.post([inset(x, x0), 0.002, inset(z, z0)], 0.03, TABLE_HEIGHT - 0.042);
    }
    mesh.ball([4.6, 0.26, 3.0], 0.25, [64, 32]);
    mesh
}

fn chairs() -> Mesh {
    let mut mesh = Mesh::default();
    for (x, z, back) in [(2.3, 1.2, -1.0), (3.2, 1.15, -1.0), (2.4, 2.9, 1.0), (3.3, 3.0, 1.0)] {
        let (w, d) = (0.42_f32, 0.4_f32);
        mesh.block([x, 0.42, z], [x + w, 0.46, z + d], 1.3);
        for [i, j] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
            let (lx, lz) = (x + i * (w - 0.04), z + j * (d - 0.04));
            let rear = (j > 0.5) == (back > 0.0);
            mesh.block([lx, 0.003, lz], [lx + 0.04, if rear { 0.95 } else { 0.42 }, lz + 0.04], 1.3);
        }
        let zb = if back > 0.0 { z + d - 0.03 } else { z + 0.01 };
        for slat in 0..5 {
            let y = 0.52 + 0.09 * slat as f32;
            mesh.block([x + 0.04, y, zb], [x + w - 0.04, y + 0.05, zb + 0.015], 1.3);
        }
    }
    mesh
}

/// Where the shelf stands: against the wall z = 0.
const SHELF: [f32; 2] = [0.6, 3.4];
const BOARDS: u32 = 6;

fn shelf() -> Mesh {
    let mut mesh = Mesh::default();
    let [x0, x1] = SHELF;
    for board in 0..=BOARDS {
        let y = 0.1 + 0.36 * board as f32;
        mesh.block([x0, y, 0.02], [x1, y + 0.025, 0.34], 1.0);
    }
    for i in 0..4 {
        let x = x0 + (x1 - x0 - 0.025) * i as f32 / 3.0;
        mesh.block([x, 0.003, 0.02], [x + 0.025, 0.1 + 0.36 * BOARDS as f32, 0.34], 1.0);
    }
    mesh.block([x0, 0.1, 0.01], [x1, 0.1 + 0.36 * BOARDS as f32, 0.02], 1.0);
    mesh
}

/// Books with rounded backs, sorted into four piles by what binds them.
fn books() -> [Mesh; 4] {
    let mut meshes: [Mesh; 4] = Default::default();
    let mut rng = Pcg32::new(5, 2);
    for board in 0..BOARDS {
        let y = 0.1 + 0.36 * board as f32 + 0.026;
        for bay in 0..3 {
            let span = (SHELF[1] - SHELF[0]) / 3.0;
            let mut x = SHELF[0] + span * bay as f32 + 0.035;
            let end = SHELF[0] + span * (bay as f32 + 1.0) - 0.09;
            while x < end - 0.05 * rng.next_f32() {
                let thick = 0.018 + 0.035 * rng.next_f32();
                let (height, depth) = (0.2 + 0.12 * rng.next_f32(), 0.16 + 0.08 * rng.next_f32());
                let mesh = &mut meshes[(rng.next_f32() * 4.0) as usize % 4];
                let middle = x + 0.5 * thick;
                let outline = |u: f32| {
                    // An ellipse with a flattened front.
                    let (sin, cos) = (TAU * u).sin_cos();
                    let soft = |a: f32| a.signum() * a.abs().powf(0.35);
                    [middle + 0.5 * thick * soft(sin), 0.05 + 0.5 * depth * (1.0 + soft(cos))]
                };
                let at = |u: f32, v: f32| {
                    let [ox, oz] = outline(u);
                    // The last tenth closes the top.
                    let shrink = ((1.0 - v) * 10.0).min(1.0);
                    [
                        middle + (ox - middle) * shrink,
                        y + height * (v / 0.9).min(1.0),
                        0.15 + (oz - 0.15) * shrink,
                    ]
                };
                mesh.sheet(24, 10, at, [1.0, 1.0]);
                x += thick + 0.002;
            }
        }
    }
    meshes
}

fn rug() -> Mesh {
    let mut mesh = Mesh::default();
    let at = |u: f32, v: f32| {
        let pile = 0.006 * fractal(u * 90.0, v * 60.0, 2);
        [1.4 + 3.2 * u, 0.008 + pile, 3.6 - 2.6 * v]
    };
    mesh.sheet(140, 110, at, [2.0, 1.5]);
    mesh
}

fn curtains() -> Mesh {
    let mut mesh = Mesh::default();
    for (low, high) in [(1.0, 1.6), (3.4, 4.0)] {
        let at = |u: f32, v: f32| {
            let wave = 0.035 * (TAU * 7.0 * u + 0.8 * (TAU * v).sin()).sin() * (1.0 - 0.4 * v);
            [0.09 + wave, 0.15 + 2.3 * v, low + (high - low) * (1.0 - u)]
        };
        mesh.sheet(140, 30, at, [1.0, 1.0]);
    }
    mesh
}

fn urn() -> Mesh {
    let mut mesh = Mesh::default();
    let profile = |v: f32| [0.1 + 0.14 * (std::f32::consts::PI * v.powf(0.8)).sin() + 0.03 * v, 0.75 * v];
    let relief = |u: f32, v: f32| 0.06 * (TAU * 12.0 * u).sin() * (TAU * 5.0 * v).sin();
    mesh.turned([4.5, 0.004, 0.7], [180, 90], profile, relief);
    mesh
}

fn vase() -> Mesh {
    let mut mesh = Mesh::default();
    let profile = |v: f32| [0.035 + 0.06 * (TAU * 0.62 * v).sin().abs(), 0.34 * v];
    let relief = |u: f32, v: f32| 0.12 * (TAU * (8.0 * u + 2.0 * v)).sin();
    mesh.turned([2.5, TABLE_HEIGHT, 2.3], [160, 80], profile, relief);
    mesh
}

fn bowl() -> Mesh {
    let mut mesh = Mesh::default();
    // Up the outside and down the inside.
    let profile = |v: f32| {
        let (w, gap) = if v < 0.5 { (2.0 * v, 0.0) } else { (2.0 - 2.0 * v, 0.012) };
        [0.05 + 0.14 * w.sqrt() - gap, 0.1 * w + gap]
    };
    mesh.turned([3.15, TABLE_HEIGHT, 2.2], [96, 48], profile, |u, v| 0.02 * noise(40.0 * u, 20.0 * v));
    mesh
}

fn fruit() -> Mesh {
    let mut mesh = Mesh::default();
    let places =
        [[3.1, 0.08, 2.17], [3.21, 0.085, 2.25], [3.14, 0.16, 2.24], [3.55, 0.05, 2.45], [2.2, 0.05, 2.0]];
    for [x, y, z] in places {
        mesh.ball([x, TABLE_HEIGHT + y, z], 0.05, [48, 24]);
    }
    mesh
}

/// The sky behind the window and the panels under the ceiling.
fn lights() -> [(&'static str, Mesh, [f32; 3]); 3] {
    let [[z0, y0], [z1, y1]] = WINDOW;
    let mut sky = Mesh::default();
    sky.quad([-0.24, y0, z1], [0.0, 0.0, z0 - z1], [0.0, y1 - y0, 0.0], [0.0; 2], 1.0);
    let [mut panels, mut lamp] = [Mesh::default(), Mesh::default()];
    for [x, z] in [[1.8, 1.15], [3.6, 3.65]] {
        panels.quad([x, ROOM[1] - 0.05, z], [0.6, 0.0, 0.0], [0.0, 0.0, 0.3], [0.0; 2], 1.0);
    }
    lamp.ball([5.3, 1.3, 0.6], 0.09, [24, 12]);
    [("sky", sky, [5.0, 6.2, 8.5]), ("panels", panels, [9.0, 7.6, 5.6]), ("lamp", lamp, [16.0, 11.0, 6.0])]
}
