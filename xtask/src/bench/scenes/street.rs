//! A street market at night: a thousand lamps and lit windows, most of them hidden from any one place.

use super::description::{Color, Lamp, Material, Object, Scene, View};
use super::mesh::Mesh;
use super::pictures::{Picture, plaster, tiles, wood};
use std::f32::consts::PI;
use steradian::math::hash::Pcg32;

/// Length of the street along +z and half its width [m].
const LENGTH: f32 = 66.0;
const HALF_WIDTH: f32 = 5.0;
/// Depth of the houses; behind them, on either side, a parallel alley with lamps of its own [m].
const DEPTH: f32 = 7.0;

pub(super) fn street() -> Scene {
    let mut rng = Pcg32::new(31, 1);
    let mut ground = Mesh::default();
    ground.quad([-25.0, 0.0, LENGTH + 8.0], [50.0, 0.0, 0.0], [0.0, 0.0, -LENGTH - 16.0], [0.0; 2], 0.12);
    let mut lamps = Vec::new();
    let mut houses: [Mesh; 3] = Default::default();
    let mut roofs = Mesh::default();
    let mut panes: [Mesh; 4] = Default::default();
    for side in [-1.0, 1.0] {
        let mut z = 0.0;
        while z < LENGTH {
            let (width, height) = (6.5 + 3.0 * rng.next_f32(), 5.5 + 4.0 * rng.next_f32());
            let house = House { side, z, width, height };
            house.build(&mut houses[(rng.next_f32() * 3.0) as usize % 3], &mut roofs);
            house.windows(&mut panes, &mut rng);
            // A passage to the alley behind, with a lamp above it now and then.
            if rng.next_f32() < 0.7 {
                let at = [side * (HALF_WIDTH + 0.5 * DEPTH), 2.8, z + width + 0.8];
                lamps.push(lamp(at, 0.09, [1.0, 0.75, 0.4], 60.0 * spread(&mut rng)));
            }
            z += width + 1.6;
        }
    }
    // The houses at the end of the street, across it.
    houses[0].block([-16.0, 0.0, LENGTH + 5.0], [16.0, 9.0, LENGTH + 7.0], 0.3);

    let [mut posts, mut stalls, mut awnings] = [Mesh::default(), Mesh::default(), Mesh::default()];
    let mut goods = Mesh::default();
    for i in 0..11 {
        let z = 3.0 + 6.0 * i as f32;
        for side in [-1.0, 1.0] {
            lantern(&mut posts, &mut roofs, &mut lamps, [side * 4.3, 0.0, z]);
            if (i + usize::from(side > 0.0)) % 6 != 4 {
                stall(&mut stalls, &mut awnings, &mut goods, &mut lamps, [side * 2.7, z + 2.8], &mut rng);
            }
        }
    }
    garlands(&mut lamps, &mut rng);
    // Lamps of the alleys: they reach the street only through the passages.
    for i in 0..400 {
        let side = if i % 2 == 0 { -1.0 } else { 1.0 };
        let x = side * (HALF_WIDTH + DEPTH + 0.6 + 4.0 * rng.next_f32());
        let at = [x, 1.6 + 2.4 * rng.next_f32(), LENGTH * rng.next_f32()];
        lamps.push(lamp(at, 0.05, color(&mut rng), 70.0 * spread(&mut rng)));
    }

    let plain = |rgb| Material::Diffuse(Color::Rgb(rgb));
    let mut objects = vec![
        object("street-ground", ground, Material::Coated { base: Color::Picture("tiles.png"), alpha: 0.15 }),
        object("street-roofs", roofs, plain([0.12, 0.08, 0.07])),
        object("street-posts", posts, plain([0.05, 0.06, 0.05])),
        object("street-stalls", stalls, Material::Diffuse(Color::Picture("wood.png"))),
        object("street-awnings", awnings, Material::Sheet(Color::Rgb([0.55, 0.16, 0.12]))),
        object("street-goods", goods, Material::Coated { base: Color::Rgb([0.55, 0.3, 0.06]), alpha: 0.2 }),
    ];
    let [a, b, c] = houses;
    objects.push(object("street-houses-a", a, Material::Diffuse(Color::Picture("plaster.png"))));
    objects.push(object("street-houses-b", b, plain([0.42, 0.3, 0.22])));
    objects.push(object("street-houses-c", c, plain([0.32, 0.36, 0.38])));
    let [warm, pale, blue, dark] = panes;
    for (name, mesh, radiance) in [
        ("street-panes-warm", warm, [2.6, 1.6, 0.7]),
        ("street-panes-pale", pale, [1.4, 1.3, 1.0]),
        ("street-panes-blue", blue, [0.25, 0.4, 0.8]),
    ] {
        objects.push(Object { emission: Some(radiance), ..object(name, mesh, plain([0.0; 3])) });
    }
    let glazed = Material::Coated { base: Color::Rgb([0.01; 3]), alpha: 0.0 };
    objects.push(object("street-panes-dark", dark, glazed));
    let pictures = vec![
        ("wood.png", Picture::texture(1024, wood)),
        ("tiles.png", Picture::texture(512, tiles)),
        ("plaster.png", Picture::texture(1024, plaster)),
    ];
    let view = View {
        eye: [0.7, 1.75, -3.5],
        target: [-0.3, 2.1, 14.0],
        fov: 46.0,
        width: 320,
        height: 240,
        max_depth: 7,
    };
    Scene { view, objects, lamps, pictures, environment: None }
}

fn object(name: &'static str, mesh: Mesh, material: Material) -> Object {
    Object { name, mesh, material, emission: None }
}

fn lamp(center: [f32; 3], radius: f32, tint: [f32; 3], radiance: f32) -> Lamp {
    Lamp { center, radius, radiance: tint.map(|c| c * radiance) }
}

/// A factor around one that spans about two orders of magnitude.
fn spread(rng: &mut Pcg32) -> f32 {
    // The sum of three uniform numbers is close to normal.
    let normal = 2.0 * (rng.next_f32() + rng.next_f32() + rng.next_f32() - 1.5);
    (0.9 * normal).exp()
}

/// A bulb's colour: warm as a rule.
fn color(rng: &mut Pcg32) -> [f32; 3] {
    match (rng.next_f32() * 10.0) as u32 {
        0 => [1.0, 0.15, 0.1],
        1 => [0.15, 0.9, 0.25],
        2 => [0.2, 0.35, 1.0],
        3 => [0.9, 0.95, 1.0],
        _ => [1.0, 0.72, 0.38],
    }
}

/// One of the row of houses on the side x < 0 or x > 0.
struct House {
    side: f32,
    z: f32,
    width: f32,
    height: f32,
}

impl House {
    fn build(&self, walls: &mut Mesh, roofs: &mut Mesh) {
        let (front, back) = (self.side * HALF_WIDTH, self.side * (HALF_WIDTH + DEPTH));
        let (low, high) = (front.min(back), front.max(back));
        walls.block([low, 0.0, self.z], [high, self.height, self.z + self.width], 0.3);
        let eaves = 0.35;
        let (y, z0, z1) = (self.height, self.z - eaves, self.z + self.width + eaves);
        roofs.block([low - eaves, y, z0], [high + eaves, y + 0.25, z1], 1.0);
        roofs.block([low + 1.5, y + 0.25, z0 + 1.2], [high - 1.5, y + 1.4, z1 - 1.2], 1.0);
    }

    /// Rows of windows towards the street; more than a half of them are lit.
    fn windows(&self, panes: &mut [Mesh; 4], rng: &mut Pcg32) {
        let columns = (self.width / 1.9) as u32;
        let step = self.width / columns as f32;
        let rows = ((self.height - 1.0) / 2.6) as u32;
        for row in 0..rows {
            for column in 0..columns {
                let kind = match (rng.next_f32() * 10.0) as u32 {
                    0..=2 => 0,
                    3..=4 => 1,
                    5 => 2,
                    _ => 3,
                };
                let y = 1.2 + 2.6 * row as f32;
                let z = self.z + step * (column as f32 + 0.5);
                let x = self.side * (HALF_WIDTH - 0.01);
                // Facing the middle of the street.
                let along = [0.0, 0.0, self.side * 0.9];
                panes[kind].quad([x, y, z - self.side * 0.45], along, [0.0, 1.3, 0.0], [0.0; 2], 1.0);
            }
        }
    }
}

/// A post with a ball of light beneath a hood.
fn lantern(posts: &mut Mesh, hoods: &mut Mesh, lamps: &mut Vec<Lamp>, [x, y, z]: [f32; 3]) {
    posts.post([x, y, z], 0.06, 3.4);
    lamps.push(lamp([x, 3.62, z], 0.13, [1.0, 0.68, 0.32], 55.0));
    hoods.block([x - 0.3, 3.85, z - 0.3], [x + 0.3, 3.9, z + 0.3], 1.0);
}

/// A stall: a counter with goods beneath an awning, and bulbs that the awning hides from above.
fn stall(
    wood: &mut Mesh,
    awnings: &mut Mesh,
    goods: &mut Mesh,
    lamps: &mut Vec<Lamp>,
    [x, z]: [f32; 2],
    rng: &mut Pcg32,
) {
    wood.block([x - 0.7, 0.0, z - 1.2], [x + 0.7, 0.9, z + 1.2], 0.7);
    for [dx, dz] in [[-0.75, -1.3], [0.75, -1.3], [-0.75, 1.3], [0.75, 1.3]] {
        wood.block([x + dx - 0.03, 0.0, z + dz - 0.03], [x + dx + 0.03, 2.3, z + dz + 0.03], 0.7);
    }
    let sag = |u: f32, v: f32| {
        let y = 2.5 - 1.2 * (u - 0.5).powi(2) - 0.12 * (PI * v).sin();
        [x + 2.0 * (u - 0.5), y, z + 3.0 * (0.5 - v)]
    };
    awnings.sheet(12, 12, sag, [1.0, 1.0]);
    for i in 0..7 {
        let at = [x + 0.9 * (rng.next_f32() - 0.5), 0.99, z - 1.0 + 0.33 * i as f32];
        goods.ball(at, 0.07 + 0.05 * rng.next_f32(), [24, 12]);
    }
    for i in 0..6 {
        let at = [x - 0.4 + 0.8 * (i % 2) as f32, 2.0, z - 1.0 + 0.4 * i as f32];
        lamps.push(lamp(at, 0.035, color(rng), 110.0 * spread(rng)));
    }
}

/// Strings of bulbs across the street.
fn garlands(lamps: &mut Vec<Lamp>, rng: &mut Pcg32) {
    for string in 0..20 {
        let z = 1.5 + 3.1 * string as f32;
        let slope = 1.5 * (rng.next_f32() - 0.5);
        for bulb in 0..17 {
            let u = bulb as f32 / 16.0 * 2.0 - 1.0;
            let at = [u * (HALF_WIDTH - 0.2), 3.9 + 0.9 * u * u, z + slope * u];
            lamps.push(lamp(at, 0.04, color(rng), 30.0 * spread(rng)));
        }
    }
}
