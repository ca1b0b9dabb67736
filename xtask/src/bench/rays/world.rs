//! The scene of the ray benchmark: rolling ground, studded balls and a cave around them, so that every ray ends
//! somewhere; and the rays.

use steradian::math::hash::Pcg32;
use steradian::math::{Point, Ray, Vec2, Vec3, warp};

/// A ray and how far it looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Query {
    pub(super) ray: Ray,
    pub(super) t_max: f32,
}

/// Triangles with shared vertices.
#[derive(Debug, Default)]
pub(super) struct World {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) indices: Vec<[u32; 3]>,
}

const EYE: Vec3 = Vec3::new(-8.5, 4.0, -9.0);
const LAMP: Vec3 = Vec3::new(2.0, 9.5, 3.0);
const SIDE: u32 = 1024;

/// Waves of four octaves, in [−2, 2].
fn waves(p: Vec3) -> f32 {
    (0..4)
        .map(|k| {
            let f = 2.03_f32.powi(k);
            (f * p.x + 0.7 * k as f32).sin() * (f * 1.17 * p.z).cos() * (0.6 * f * p.y + 1.0).cos() / f.sqrt()
        })
        .sum()
}

impl World {
    /// About a million triangles.
    pub(super) fn new() -> Self {
        let mut world = Self::default();
        world.sheet(330, 330, |u, v| {
            let p = Vec3::new(26.0 * (u - 0.5), 0.0, 26.0 * (v - 0.5));
            p + Vec3::Y * (0.3 * waves(p * 0.8))
        });
        let mut rng = Pcg32::new(41, 3);
        for k in 0..25 {
            let jitter = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32());
            let place = Vec3::new((k % 5) as f32 * 4.2 - 8.4, 1.4, (k / 5) as f32 * 4.2 - 8.4);
            world.ball(place + jitter, 0.7 + 0.7 * rng.next_f32(), 0.09, 172);
        }
        world.ball(Vec3::ZERO, 21.0, 0.04, 200);
        world
    }

    fn sheet(&mut self, columns: u32, rows: u32, at: impl Fn(f32, f32) -> Vec3) {
        let base = self.positions.len() as u32;
        for j in 0..=rows {
            for i in 0..=columns {
                self.positions.push(at(i as f32 / columns as f32, j as f32 / rows as f32).to_array());
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let a = base + j * (columns + 1) + i;
                let c = a + columns + 1;
                self.indices.extend([[a, a + 1, c], [a + 1, c + 1, c]]);
            }
        }
    }

    fn ball(&mut self, center: Vec3, radius: f32, roughness: f32, columns: u32) {
        use std::f32::consts::{PI, TAU};
        self.sheet(columns, columns / 2, |u, v| {
            let (phi, theta) = (TAU * u, PI * v);
            let d = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            center + d * radius * (1.0 + roughness * waves(d * 5.0 + center))
        });
    }

    /// The normal of a triangle on the side of `toward`.
    fn normal(&self, triangle: u32, toward: Vec3) -> Vec3 {
        let [a, b, c] = self.indices[triangle as usize].map(|i| Vec3::from(self.positions[i as usize]));
        let n = (b - a).cross(c - a).normalize_or_zero();
        if n.dot(toward) < 0.0 { -n } else { n }
    }

    /// Where a ray met a triangle, a little off it, and the normal there.
    fn surface(&self, query: &Query, hit: (u32, f32)) -> (Vec3, Vec3) {
        let n = self.normal(hit.0, -query.ray.d);
        (query.ray.o.0 + query.ray.d * hit.1 + n * 1e-3, n)
    }

    /// A cosine-distributed bounce from each hit, in the order of the hits.
    pub(super) fn bounces(&self, queries: &[Query], hits: &[Option<(u32, f32)>]) -> Vec<Query> {
        let mut rng = Pcg32::new(12, 7);
        queries
            .iter()
            .zip(hits)
            .filter_map(|(q, h)| Some((q, (*h)?)))
            .map(|(q, h)| {
                let (o, n) = self.surface(q, h);
                let d = loop {
                    let d = n * 1.0001 + warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
                    if d.length_squared() > 1e-6 {
                        break d.normalize();
                    }
                };
                Query { ray: Ray { o: Point(o), d, time: rng.next_f32() }, t_max: f32::INFINITY }
            })
            .collect()
    }

    /// From each hit to the lamp.
    pub(super) fn shadows(&self, queries: &[Query], hits: &[Option<(u32, f32)>]) -> Vec<Query> {
        queries
            .iter()
            .zip(hits)
            .filter_map(|(q, h)| Some((q, (*h)?)))
            .map(|(q, h)| {
                let (o, _) = self.surface(q, h);
                let way = LAMP - o;
                Query {
                    ray: Ray { o: Point(o), d: way.normalize(), time: q.ray.time },
                    t_max: way.length() * 0.999,
                }
            })
            .collect()
    }
}

/// Rays of a camera, in tiles of 8 × 8 pixels.
pub(super) fn primaries() -> Vec<Query> {
    let forward = (Vec3::new(0.5, 0.6, 0.3) - EYE).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let mut rng = Pcg32::new(3, 1);
    let pixel = |i: u32| {
        let (tile, inside) = (i / 64, i % 64);
        (tile % (SIDE / 8) * 8 + inside % 8, tile / (SIDE / 8) * 8 + inside / 8)
    };
    (0..SIDE * SIDE)
        .map(|i| {
            let (x, y) = pixel(i);
            let at = |k: u32| (k as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
            let d = (forward + (right * at(x) - up * at(y)) * 0.8).normalize();
            Query { ray: Ray { o: Point(EYE), d, time: rng.next_f32() }, t_max: f32::INFINITY }
        })
        .collect()
}

/// The same in random order: the worst case for caches.
pub(super) fn shuffled(queries: &[Query]) -> Vec<Query> {
    let mut shuffled = queries.to_vec();
    let mut rng = Pcg32::new(77, 2);
    for i in (1..shuffled.len()).rev() {
        shuffled.swap(i, rng.next_u32() as usize % (i + 1));
    }
    shuffled
}

/// A tuft of curves over the ground: control points of cubic Bézier curves, root first.
pub(super) fn tuft(count: u32) -> Vec<[Vec3; 4]> {
    let mut rng = Pcg32::new(8, 5);
    (0..count)
        .map(|_| {
            let mut next = || rng.next_f32() - 0.5;
            let root = Vec3::new(next() * 8.0, 0.0, next() * 8.0);
            let lean = Vec3::new(next(), 0.0, next());
            let bend = Vec3::new(next(), 0.0, next()) * 0.8;
            let up = Vec3::Y * (1.0 + 0.6 * next());
            [root, root + up * 0.35, root + up * 0.7 + lean * 0.5, root + up + lean + bend]
        })
        .collect()
}

/// Rays from a hemisphere around into the tuft.
pub(super) fn over_tuft(count: u32) -> Vec<Query> {
    let mut rng = Pcg32::new(15, 9);
    (0..count)
        .map(|_| {
            let mut next = || rng.next_f32();
            let target = Vec3::new(next() * 8.0 - 4.0, next(), next() * 8.0 - 4.0);
            let side = warp::uniform_sphere(Vec2::new(next(), next()));
            let o = target + Vec3::new(side.x, side.y.abs() + 0.1, side.z) * 9.0;
            Query { ray: Ray { o: Point(o), d: (target - o).normalize(), time: 0.0 }, t_max: f32::INFINITY }
        })
        .collect()
}
