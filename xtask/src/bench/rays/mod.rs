//! Rays per second of one thread against Embree's: the same triangles, the same rays, alternately.

mod peer;
mod world;

use super::embree::{Edges, Embree};
use super::options::Options;
use super::row::{Row, Target};
use peer::Peer;
use std::path::Path;
use std::time::Instant;
use steradian::accel::contract::ObjectId;
use steradian::accel::{Accel, Candidate, Instance, Layout};
use steradian::math::{AnimatedTransform, Point, Transform, Vec3};
use steradian::shape::curve::{Basis, Degree, Profile};
use steradian::shape::{Curve, CurveData, MeshData, Orientation, Shape, ShapeId, TriangleMesh};
use world::{Query, World};

const SECTION: &str = "Rays";
const UNIT: &str = "Mrays per CPU-second";

/// Rays that one side traces before the other takes its turn.
const TURN: usize = 1 << 15;

/// Width of the curves [scene units].
const WIDTH: f32 = 0.012;

/// What is asked about a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    Nearest,
    Any,
}

/// Rays with a question about them and what the answers must reach against Embree's two modes.
struct Set {
    name: &'static str,
    question: Question,
    queries: Vec<Query>,
    medium: Target,
}

/// Somebody who answers: returns how many rays meet something.
type Answer<'a> = &'a dyn Fn(&[Query]) -> usize;

/// Measures all.
pub(super) fn measure(_root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let embree = options.embree.as_deref().map(Embree::open).transpose()?;
    let repetitions = options.repetitions.unwrap_or(5);
    let world = World::new();
    let shapes = [shape(&world)?];
    let flat = build(&shapes, &Layout::of_world(1))?;
    let sets = sets(&world, &flat);
    let mut rows = match &embree {
        Some(embree) => against_embree(embree, &world, &flat, &sets, repetitions)?,
        None => sets
            .iter()
            .map(|set| {
                let ours = |q: &[Query]| ask(&flat, set.question, q);
                let pairs = interleaved(&ours, &ours, &set.queries, repetitions);
                let mut rates: Vec<f64> = pairs.iter().map(|p| p[0]).collect();
                Row::alone(SECTION, set.name, UNIT, super::row::median(&mut rates), Target::None)
                    .noted("without --embree there is no peer")
            })
            .collect(),
    };
    rows.extend(placed(&shapes, &flat, &sets, repetitions)?);
    rows.extend(curves(embree.as_ref(), repetitions)?);
    Ok(rows)
}

fn against_embree(
    embree: &Embree,
    world: &World,
    flat: &Accel,
    sets: &[Set],
    repetitions: usize,
) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (edges, mode) in [(Edges::Robust, "robust"), (Edges::Fast, "medium")] {
        let scene = embree.scene(&world.positions, &world.indices, edges, 1)?;
        scene.commit()?;
        let peer = Peer::new(embree, &scene)?;
        for set in sets {
            let ours = |q: &[Query]| ask(flat, set.question, q);
            let theirs = |q: &[Query]| match set.question {
                Question::Nearest => peer.nearest(q),
                Question::Any => peer.any(q),
            };
            let (a, b) = (ours(&set.queries), theirs(&set.queries));
            let pairs = interleaved(&ours, &theirs, &set.queries, repetitions);
            let target = if edges == Edges::Robust { Target::RatioAtLeast(1.0) } else { set.medium };
            rows.push(
                Row::compared(SECTION, format!("{}, against Embree {mode}", set.name), UNIT, &pairs, target)
                    .noted(format!(
                        "of {} rays ours meet something {a} times, Embree's {b}",
                        set.queries.len()
                    )),
            );
        }
    }
    Ok(rows)
}

/// The mesh as an instance, at rest and moving, against the same mesh placed in the world.
fn placed(shapes: &[Shape], flat: &Accel, sets: &[Set], repetitions: usize) -> Result<Vec<Row>, String> {
    let moved = Transform::translate(Vec3::new(0.05, 0.02, 0.0));
    let placements = [
        ("an instance", AnimatedTransform::fixed(Transform::IDENTITY)),
        ("in motion", AnimatedTransform::new(Transform::IDENTITY, moved, [0.0, 1.0])),
    ];
    let mut rows = Vec::new();
    for (what, render_from_object) in placements {
        let layout = Layout {
            objects: vec![vec![ShapeId(0)]],
            instances: vec![Instance { object: ObjectId(0), render_from_object }],
            ..Layout::default()
        };
        let accel = build(shapes, &layout)?;
        for set in sets {
            let (ours, peer) =
                (|q: &[Query]| ask(&accel, set.question, q), |q: &[Query]| ask(flat, set.question, q));
            let pairs = interleaved(&ours, &peer, &set.queries, repetitions);
            rows.push(
                Row::compared(
                    SECTION,
                    format!("{}, {what}", set.name),
                    UNIT,
                    &pairs,
                    Target::RatioAtLeast(0.5),
                )
                .noted("the peer is our own mesh, flat and static"),
            );
        }
    }
    Ok(rows)
}

fn curves(embree: Option<&Embree>, repetitions: usize) -> Result<Vec<Row>, String> {
    let tuft = world::tuft(20_000);
    let shapes = tuft
        .iter()
        .map(|points| {
            let data = CurveData {
                points: points.map(Point).to_vec(),
                basis: Basis::Bezier,
                degree: Degree::Cubic,
                profile: Profile::Flat,
                normals: Vec::new(),
                widths: [WIDTH; 2],
                split_depth: 3,
            };
            Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).map(Shape::Curve)
        })
        .collect::<Result<Vec<_>, _>>()
        .map_err(|e| e.to_string())?;
    let accel = build(&shapes, &Layout::of_world(shapes.len()))?;
    let queries = world::over_tuft(1 << 18);
    let ours = |q: &[Query]| ask(&accel, Question::Nearest, q);
    let name = "curves, 20 000 flat Bézier curves";
    let peer = embree.map(|e| Peer::of_curves(e, &tuft, WIDTH)).transpose()?;
    let Some(peer) = peer else {
        let pairs = interleaved(&ours, &ours, &queries, repetitions);
        let mut rates: Vec<f64> = pairs.iter().map(|p| p[0]).collect();
        let row = Row::alone(SECTION, name, UNIT, super::row::median(&mut rates), Target::None);
        return Ok(vec![row.noted("without --embree there is no peer")]);
    };
    let theirs = |q: &[Query]| peer.nearest(q);
    let (a, b) = (ours(&queries), theirs(&queries));
    let pairs = interleaved(&ours, &theirs, &queries, repetitions);
    Ok(vec![Row::compared(SECTION, name, UNIT, &pairs, Target::RatioAtLeast(0.8)).noted(format!(
        "against Embree's flat Bézier curves; of {} rays ours meet something {a} times, Embree's {b}",
        queries.len()
    ))])
}

fn shape(world: &World) -> Result<Shape, String> {
    let data = MeshData {
        positions: world.positions.iter().map(|p| Point(Vec3::from(*p))).collect(),
        indices: world.indices.clone(),
        ..MeshData::default()
    };
    TriangleMesh::new(data, &Transform::IDENTITY, Orientation::AsDefined)
        .map(Shape::Mesh)
        .map_err(|e| e.to_string())
}

fn build(shapes: &[Shape], layout: &Layout) -> Result<Accel, String> {
    Accel::build(shapes, layout).map_err(|e| e.to_string())
}

fn sets(world: &World, accel: &Accel) -> [Set; 4] {
    let reached = Target::RatioAtLeast(1.0);
    let primary = world::primaries();
    let hits: Vec<_> = primary
        .iter()
        .map(|q| accel.intersect(&q.ray, q.t_max, &everything).map(|h| (h.prim, h.t)))
        .collect();
    let bounce = world.bounces(&primary, &hits);
    let shadow = world.shadows(&primary, &hits);
    let shuffled = world::shuffled(&bounce);
    let nearest = Question::Nearest;
    [
        Set { name: "primary", question: nearest, queries: primary, medium: reached },
        Set { name: "bounce", question: nearest, queries: bounce, medium: Target::None },
        Set { name: "shuffled", question: nearest, queries: shuffled, medium: Target::None },
        Set { name: "shadow", question: Question::Any, queries: shadow, medium: reached },
    ]
}

fn everything(_: &Candidate) -> bool {
    true
}

#[inline(never)]
fn ask(accel: &Accel, question: Question, queries: &[Query]) -> usize {
    match question {
        Question::Nearest => {
            queries.iter().filter(|q| accel.intersect(&q.ray, q.t_max, &everything).is_some()).count()
        }
        Question::Any => queries.iter().filter(|q| accel.occluded(&q.ray, q.t_max, &everything)).count(),
    }
}

/// Millions of rays per second of this thread's time, `[ours, peer]` for each repetition; the two take turns within it.
fn interleaved(ours: Answer<'_>, peer: Answer<'_>, queries: &[Query], repetitions: usize) -> Vec<[f64; 2]> {
    let timed = |answer: Answer<'_>, turn: &[Query]| {
        let clock = Clock::start();
        std::hint::black_box(answer(turn));
        clock.seconds()
    };
    (0..repetitions)
        .map(|repetition| {
            let mut seconds = [0.0; 2];
            for (i, turn) in queries.chunks(TURN).enumerate() {
                let order = if (i + repetition) % 2 == 0 { [0, 1] } else { [1, 0] };
                for who in order {
                    seconds[who] += timed([ours, peer][who], turn);
                }
            }
            seconds.map(|s| queries.len() as f64 / s * 1e-6)
        })
        .collect()
}

/// Processor time of this thread where the system tells it, else the time that passes.
struct Clock {
    wall: Instant,
    processor: Option<f64>,
}

impl Clock {
    fn start() -> Self {
        Self { processor: thread_seconds(), wall: Instant::now() }
    }

    fn seconds(&self) -> f64 {
        match (self.processor, thread_seconds()) {
            (Some(a), Some(b)) if b > a => b - a,
            _ => self.wall.elapsed().as_secs_f64(),
        }
    }
}

/// Nanoseconds that this thread has run are the first number of Linux's `schedstat`.
fn thread_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}
