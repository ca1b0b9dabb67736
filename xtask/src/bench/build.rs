//! Building hierarchies: time and memory against Embree's medium build, and how both grow with triangles.

use super::embree::{Edges, Embree};
use super::options::Options;
use super::row::{Row, Target, median};
use super::scaling::processor_seconds;
use std::path::Path;
use std::time::Instant;
use steradian::accel::{Accel, Candidate, Layout};
use steradian::lab::plot::{Axis, Chart, Curve, Scale, series_ink, svg};
use steradian::math::{Point, Ray, Transform, Vec3};
use steradian::shape::{MeshData, Orientation, Shape, TriangleMesh};

const SECTION: &str = "Build";

/// Threads of both builders.
const THREADS: usize = 2;

/// Measures all.
pub(super) fn measure(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let count = options.triangles.unwrap_or(10_000_000);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build().map_err(|e| e.to_string())?;
    let mut rows = pool.install(|| against_embree(count, options))?;
    rows.extend(pool.install(|| growth(root, count))?);
    Ok(rows)
}

fn against_embree(count: usize, options: &Options) -> Result<Vec<Row>, String> {
    let mesh = Mesh::of(count);
    let count = mesh.indices.len();
    let shapes = [mesh.shape()?];
    let embree = options.embree.as_deref().map(Embree::open).transpose()?;
    let rate = |seconds: f64| count as f64 / seconds * 1e-6;
    let (mut wall, mut processor) = (Vec::new(), Vec::new());
    let (mut ours, mut peer) = ([0; 2], [0; 2]);
    for _ in 0..options.repetitions.unwrap_or(5) {
        let (accel, time) = timed(|| build(&shapes))?;
        let stats = accel.stats();
        ours = [stats.heap_bytes, stats.peak_bytes].map(|b| b + shapes[0].heap_bytes());
        drop(accel);
        let Some(embree) = &embree else {
            wall.push([rate(time.wall), f64::NAN]);
            processor.push([rate(time.processor), f64::NAN]);
            continue;
        };
        let scene = embree.scene(&mesh.positions, &mesh.indices, Edges::Fast, THREADS)?;
        let ((), peers) = timed(|| scene.commit())?;
        peer = scene.bytes();
        wall.push([rate(time.wall), rate(peers.wall)]);
        processor.push([rate(time.processor), rate(peers.processor)]);
    }
    let (target, note) = match &embree {
        Some(_) => (Target::RatioAtLeast(1.0), "against Embree, build quality medium"),
        None => (Target::None, "without --embree there is no peer"),
    };
    let millions = count as f64 * 1e-6;
    let name = |what: &str| format!("{millions:.1} M triangles, {THREADS} threads, {what}");
    let each = |bytes: usize| bytes as f64 / count as f64;
    let memory = |what: &str, i: usize, most: f64| {
        let peers = match &embree {
            Some(_) => format!("; Embree {:.1}", each(peer[i])),
            None => String::new(),
        };
        Row::alone(SECTION, name(what), "B per triangle", each(ours[i]), Target::AtMost(most))
            .noted(format!("vertices and indices included, no normals, no uv{peers}"))
    };
    Ok(vec![
        Row::compared(SECTION, name("by the clock"), "Mtriangles/s", &wall, target).noted(note),
        Row::compared(
            SECTION,
            name("by processor time"),
            "Mtriangles per CPU-second",
            &processor,
            Target::None,
        )
        .noted("what other work on the machine disturbs less"),
        memory("memory", 0, 120.0),
        memory("memory at most while building", 1, 220.0),
    ])
}

/// Time of building and of rays against the number of triangles.
fn growth(root: &Path, most: usize) -> Result<Vec<Row>, String> {
    let sizes =
        std::iter::successors(Some(10_000_usize), |n| Some(n * 10)).take_while(|n| *n <= most.max(100_000));
    let (mut rows, mut builds, mut queries) = (Vec::new(), Vec::new(), Vec::new());
    for size in sizes {
        let mesh = Mesh::of(size);
        let count = mesh.indices.len() as f64;
        let shapes = [mesh.shape()?];
        let accel = build(&shapes)?;
        // Processor time is told in hundredths of a second: small meshes are built as often as fills some of them.
        let times = (2_000_000 / size).max(1);
        let ((), time) = timed(|| (0..times).try_for_each(|_| build(&shapes).map(drop)))?;
        let per_triangle = time.processor / (times as f64 * count) * 1e9;
        rows.push(Row::alone(
            SECTION,
            format!("{} triangles, building", shapes[0].prim_count()),
            "ns processor time per triangle",
            per_triangle,
            Target::None,
        ));
        let mut seconds =
            (0..3).map(|_| Ok(timed(|| view(&accel))?.1.processor)).collect::<Result<Vec<_>, String>>()?;
        let per_ray = median(&mut seconds) / f64::from(SIDE * SIDE * 2) * 1e9;
        rows.push(Row::alone(
            SECTION,
            format!("{} triangles, a frame of first hits and their shadows", shapes[0].prim_count()),
            "ns processor time per ray",
            per_ray,
            Target::None,
        ));
        builds.push([count.log10(), per_triangle]);
        queries.push([count.log10(), per_ray]);
    }
    let ([first, ..], [.., last]) = (&queries[..], &queries[..]) else { return Ok(rows) };
    let exponent = (last[1] / first[1]).log10() / (last[0] - first[0]);
    rows.push(
        Row::alone(SECTION, "growth of a frame: cost ∝ triangles^x", "x", exponent, Target::AtMost(0.3))
            .noted("target/bench/triangles.svg"),
    );
    let chart = Chart {
        title: "Cost against the number of triangles".into(),
        x: Axis::new("log₁₀ triangles"),
        y: Axis::new("processor time [ns]").including(&[0.0]).scaled(Scale::Linear),
        curves: vec![
            Curve::new("building, per triangle", series_ink(0), builds),
            Curve::new("a frame, per ray", series_ink(1), queries),
        ],
    };
    let folder = root.join("target/bench");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    std::fs::write(folder.join("triangles.svg"), svg(&chart.draw())).map_err(|e| e.to_string())?;
    Ok(rows)
}

/// What a task took [s].
#[derive(Clone, Copy, Debug)]
struct Time {
    wall: f64,
    processor: f64,
}

fn timed<T>(task: impl FnOnce() -> Result<T, String>) -> Result<(T, Time), String> {
    let (start, before) = (Instant::now(), processor_seconds()?);
    let result = task()?;
    Ok((result, Time { wall: start.elapsed().as_secs_f64(), processor: processor_seconds()? - before }))
}

fn build(shapes: &[Shape]) -> Result<Accel, String> {
    Accel::build(shapes, &Layout::of_world(shapes.len())).map_err(|e| e.to_string())
}

/// Side of the frame [px].
const SIDE: u32 = 512;

/// A frame of first hits, and a ray to a lamp from each of them.
fn view(accel: &Accel) -> Result<u32, String> {
    let (eye, lamp) = (Vec3::new(-9.0, 5.5, -10.5), Vec3::new(3.0, 9.0, -4.0));
    let forward = (Vec3::new(0.5, 0.8, 0.0) - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let all = |_: &Candidate| true;
    let mut lit = 0;
    for i in 0..SIDE * SIDE {
        let [x, y] = [i % SIDE, i / SIDE].map(|k| 1.4 * (k as f32 + 0.5) / SIDE as f32 - 0.7);
        let ray = Ray { o: Point(eye), d: forward + right * x - up * y, time: 0.0 };
        let t = accel.intersect(&ray, f32::INFINITY, &all).map_or(10.0, |h| h.t);
        let o = eye + ray.d * (t * 0.999);
        lit += u32::from(!accel.occluded(&Ray { o: Point(o), d: lamp - o, time: 0.0 }, 1.0, &all));
    }
    Ok(lit)
}

/// A landscape with bumpy balls above it, inside a cave, of about as many triangles as asked for.
struct Mesh {
    positions: Vec<[f32; 3]>,
    indices: Vec<[u32; 3]>,
}

impl Mesh {
    fn of(triangles: usize) -> Self {
        let mut mesh = Self { positions: Vec::new(), indices: Vec::new() };
        // Quads along the circumference of the smaller things, in a scene with 25 of them and a landscape.
        let n = ((triangles as f64 / 32.0).sqrt() as u32).max(4);
        mesh.grid(2 * n, n, |u, v| {
            let p = Vec3::new(24.0 * (u - 0.5), 0.0, 24.0 * (v - 0.5));
            p + Vec3::Y * (0.35 * bumps(p, 0.9))
        });
        for i in 0..24_u8 {
            let (column, row) = (f32::from(i % 6) - 2.5, f32::from(i / 6) - 1.5);
            let jitter = |k: f32| (k * f32::from(i + 1)).fract();
            let center =
                Vec3::new(3.4 * column + jitter(0.37), 1.5 + 1.2 * jitter(0.61), 3.4 * row - jitter(0.83));
            mesh.ball(center, 0.8 + 0.6 * jitter(0.29), 0.12, 3.0 + 4.0 * jitter(0.47), n);
        }
        mesh.ball(Vec3::ZERO, 20.0, 0.05, 1.0, 2 * n);
        mesh
    }

    fn ball(&mut self, center: Vec3, radius: f32, height: f32, frequency: f32, n: u32) {
        use std::f32::consts::PI;
        self.grid(n, n / 2, |u, v| {
            let (phi, theta) = (2.0 * PI * u, PI * v);
            let d = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            center + d * (radius * (1.0 + height * bumps(d * 3.0 + center, frequency)))
        });
    }

    fn grid(&mut self, columns: u32, rows: u32, point: impl Fn(f32, f32) -> Vec3) {
        let base = self.positions.len() as u32;
        let vertices = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
        let at = |(i, j): (u32, u32)| point(i as f32 / columns as f32, j as f32 / rows as f32).to_array();
        self.positions.extend(vertices.map(at));
        let quads = (0..rows).flat_map(|j| (0..columns).map(move |i| base + j * (columns + 1) + i));
        self.indices.extend(quads.flat_map(|a| {
            let (b, c) = (a + 1, a + columns + 1);
            [[a, b, c], [b, c + 1, c]]
        }));
    }

    fn shape(&self) -> Result<Shape, String> {
        let positions = self.positions.iter().map(|p| Point(Vec3::from(*p))).collect();
        let data = MeshData { positions, indices: self.indices.clone(), ..MeshData::default() };
        let mesh = TriangleMesh::new(data, &Transform::IDENTITY, Orientation::AsDefined);
        mesh.map(Shape::Mesh).map_err(|e| e.to_string())
    }
}

/// Some octaves of waves.
fn bumps(p: Vec3, frequency: f32) -> f32 {
    let octave = |i: i32| {
        let (f, shift) = (frequency * 2.1_f32.powi(i), 1.7 * i as f32);
        (f * p.x + shift).sin()
            * (1.13 * f * p.y - shift).sin()
            * (0.91 * f * p.z + 0.5 * shift).cos()
            * 0.5_f32.powi(i)
    };
    (0..4).map(octave).sum()
}
