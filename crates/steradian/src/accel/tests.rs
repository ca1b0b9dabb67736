use super::*;
use crate::math::hash::Pcg32;
use crate::math::{AnimatedTransform, Dir, Normal, Point, Transform, Vec2, Vec3, warp};
use crate::shape::curve::{Basis, Degree, Profile};
use crate::shape::{
    BilinearMesh, Curve, CurveData, Cylinder, Disk, MeshData, Orientation, PatchData, ShapeId, Sphere,
    TriangleMesh,
};

const OPAQUE: fn(&Candidate) -> bool = |_| true;

fn ray(o: Vec3, d: Vec3) -> Ray {
    Ray { o: Point(o), d, time: 0.0 }
}

fn mesh(positions: Vec<Point>, indices: Vec<[u32; 3]>) -> Shape {
    mesh_at(positions, indices, &Transform::IDENTITY)
}

fn mesh_at(positions: Vec<Point>, indices: Vec<[u32; 3]>, t: &Transform) -> Shape {
    let data = MeshData { positions, indices, ..Default::default() };
    Shape::Mesh(TriangleMesh::new(data, t, Orientation::AsDefined).unwrap())
}

fn build(shapes: &[Shape]) -> Accel {
    let accel = Accel::build(shapes, &Layout::of_world(shapes.len())).unwrap();
    accel.validate().unwrap();
    accel
}

/// A subdivided icosahedron, outward facing.
fn icosphere(levels: u32) -> (Vec<Point>, Vec<[u32; 3]>) {
    let g = (1.0 + 5.0_f32.sqrt()) / 2.0;
    let mut p: Vec<Vec3> = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .map(|v| Vec3::from(v).normalize())
    .to_vec();
    let mut f: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middle = std::collections::BTreeMap::new();
        let mut next = Vec::new();
        for [a, b, c] in f {
            let mut mid = |i: u32, j: u32| {
                *middle.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    p.push((p[i as usize] + p[j as usize]).normalize());
                    p.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (mid(a, b), mid(b, c), mid(c, a));
            next.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        f = next;
    }
    (p.into_iter().map(Point).collect(), f)
}

fn unit(rng: &mut Pcg32) -> Vec3 {
    warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()))
}

#[test]
fn no_ray_leaks_through_the_edges_and_vertices_of_a_closed_mesh() {
    let (points, faces) = icosphere(3);
    let mut rng = Pcg32::new(1, 1);
    for exponent in -6..=6 {
        let scale = 10.0_f32.powi(exponent);
        for offset in [Vec3::ZERO, Vec3::new(3.0, -5.0, 40.0) * scale] {
            let p: Vec<Point> = points.iter().map(|q| Point(**q * scale + offset)).collect();
            let accel = build(&[mesh(p.clone(), faces.clone())]);
            let portable = accel.clone().portable();
            for i in 0..4000_u32 {
                let [a, b, _] = faces[(rng.next_u32() % faces.len() as u32) as usize];
                let (a, b) = (*p[a as usize], *p[b as usize]);
                // Vertices, edge midpoints and arbitrary points of edges, as well as f32 can hit them.
                let target = match i % 3 {
                    0 => a,
                    1 => (a + b) * 0.5,
                    _ => a + (b - a) * rng.next_f32(),
                };
                let o = if i % 5 == 0 { offset } else { offset + unit(&mut rng) * (0.7 * scale) };
                let d = target - o;
                for d in [d, d.normalize(), d * 1e3] {
                    let r = ray(o, d);
                    let h = accel.intersect(&r, f32::INFINITY, &OPAQUE);
                    assert!(h.is_some(), "leak at scale {scale}, offset {offset}: {r:?}");
                    assert!(accel.occluded(&r, f32::INFINITY, &OPAQUE));
                    assert_eq!(h, portable.intersect(&r, f32::INFINITY, &OPAQUE));
                }
            }
        }
    }
}

#[test]
fn axis_parallel_rays_in_the_planes_of_faces_do_not_leak() {
    // A box of tessellated faces: every axis-parallel ray through a grid vertex runs in many box planes at once.
    const N: u32 = 8;
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for axis in 0..3 {
        for side in [0.0, N as f32] {
            let base = positions.len() as u32;
            for j in 0..=N {
                for i in 0..=N {
                    let mut p = Vec3::ZERO;
                    p[axis] = side;
                    p[(axis + 1) % 3] = i as f32;
                    p[(axis + 2) % 3] = j as f32;
                    positions.push(Point(p));
                }
            }
            for j in 0..N {
                for i in 0..N {
                    let a = base + j * (N + 1) + i;
                    indices.extend([[a, a + 1, a + N + 1], [a + 1, a + N + 2, a + N + 1]]);
                }
            }
        }
    }
    let accel = build(&[mesh(positions, indices)]);
    let portable = accel.clone().portable();
    for axis in 0..3 {
        for i in 0..=2 * N {
            for j in 0..=2 * N {
                for (sign, zero) in [(1.0, 0.0), (-1.0, 0.0), (1.0, -0.0), (-1.0, -0.0)] {
                    let mut o = Vec3::splat(0.0);
                    o[axis] = N as f32 * (0.5 - sign);
                    o[(axis + 1) % 3] = i as f32 * 0.5;
                    o[(axis + 2) % 3] = j as f32 * 0.5;
                    let mut d = Vec3::splat(zero);
                    d[axis] = sign;
                    let r = ray(o, d);
                    let h = accel.intersect(&r, f32::INFINITY, &OPAQUE).expect("leak");
                    assert_eq!(h.t, 0.5 * N as f32, "{r:?}");
                    assert_eq!(Some(h), portable.intersect(&r, f32::INFINITY, &OPAQUE));
                }
            }
        }
    }
}

/// Triangles of all sizes, some degenerate, spread over a cube of the given size.
fn soup(rng: &mut Pcg32, n: u32, scale: f32) -> Shape {
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for i in 0..n {
        let c = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 2.0 - 1.0;
        let size = 0.5 * rng.next_f32().powi(3);
        let v: [Vec3; 3] = match i % 50 {
            0 => [c; 3],
            1 => [c, c + Vec3::X * size, c - Vec3::X * size],
            2 => [c, c + Vec3::X, c + Vec3::Y],
            _ => std::array::from_fn(|_| c + unit(rng) * size),
        };
        let base = positions.len() as u32;
        positions.extend(v.map(|p| Point(p * scale)));
        indices.push([base, base + 1, base + 2]);
    }
    mesh(positions, indices)
}

fn brute_force(shapes: &[Shape], r: &Ray, t_max: f32) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for (s, shape) in shapes.iter().enumerate() {
        for prim in 0..shape.prim_count() {
            let Some(h) = shape.primitive(prim).intersect(r, t_max) else { continue };
            let hit = Hit { t: h.t, shape: ShapeId(s as u32), prim, instance: None, u: h.u, v: h.v };
            if h.t < t_max && best.is_none_or(|b| hit.precedes(&b)) {
                best = Some(hit);
            }
        }
    }
    best
}

#[test]
fn both_kernels_agree_with_brute_force() {
    let mut rng = Pcg32::new(5, 2);
    for scale in [1e-5_f32, 1.0, 1e6, 1e15] {
        let shapes = mixed_scene(&mut rng, scale);
        let accel = build(&shapes);
        let portable = accel.clone().portable();
        for i in 0..1500 {
            let o = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 4.0 - 2.0;
            let mut d = unit(&mut rng);
            match i % 10 {
                0 => d.x = 0.0,
                1 => (d.x, d.z) = (-0.0, 0.0),
                2 => d *= 1e-3,
                _ => {}
            }
            if d == Vec3::ZERO {
                continue;
            }
            let r = ray(o * scale, d * scale);
            let t_max = if i % 3 == 0 { rng.next_f32() * 3.0 } else { f32::INFINITY };
            let expected = brute_force(&shapes, &r, t_max);
            assert_eq!(accel.intersect(&r, t_max, &OPAQUE), expected, "{r:?}");
            assert_eq!(portable.intersect(&r, t_max, &OPAQUE), expected, "{r:?}");
            assert_eq!(accel.occluded(&r, t_max, &OPAQUE), expected.is_some());
            assert_eq!(portable.occluded(&r, t_max, &OPAQUE), expected.is_some());
        }
    }
}

fn mixed_scene(rng: &mut Pcg32, scale: f32) -> Vec<Shape> {
    let mut shapes = vec![soup(rng, 800, scale)];
    for _ in 0..30 {
        let c = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 2.0 - 1.0;
        let t = Transform::translate(c * scale)
            * Transform::rotate(360.0 * rng.next_f32(), unit(rng)).unwrap()
            * Transform::scale(Vec3::splat(scale * (0.05 + 0.2 * rng.next_f32()))).unwrap();
        let o = Orientation::AsDefined;
        shapes.push(Shape::Sphere(Box::new(Sphere::new(1.0, -1.0, 0.7, 300.0, &t, o).unwrap())));
        shapes.push(Shape::Disk(Box::new(Disk::new(0.3, 1.0, 0.2, 300.0, &t, o).unwrap())));
        shapes.push(Shape::Cylinder(Box::new(Cylinder::new(0.5, -1.0, 1.0, 300.0, &t, o).unwrap())));
        shapes.push(saddle(&t));
        shapes.push(curve(&t, Vec3::new(0.3, 0.8, -0.2)));
    }
    shapes
}

fn saddle(t: &Transform) -> Shape {
    let corners = [[-1.0, -1.0, 0.1], [1.0, -1.0, -0.1], [-1.0, 1.0, -0.1], [1.0, 1.0, 0.1]];
    let positions = corners.map(|p| Point(Vec3::from(p))).to_vec();
    let data = PatchData { indices: vec![[0, 1, 2, 3]], positions, ..Default::default() };
    Shape::Bilinear(BilinearMesh::new(data, t, Orientation::AsDefined).unwrap())
}

/// From (−1, 0, 0) to (1, 0, 0), bent towards `bend`.
fn curve(t: &Transform, bend: Vec3) -> Shape {
    let points = [Vec3::NEG_X, -Vec3::X / 3.0 + bend, Vec3::X / 3.0 + bend, Vec3::X].map(Point).to_vec();
    let (basis, degree, profile) = (Basis::Bezier, Degree::Cubic, Profile::Cylinder);
    let data =
        CurveData { points, basis, degree, profile, normals: vec![], widths: [0.2, 0.1], split_depth: 2 };
    Shape::Curve(Curve::new(data, t, Orientation::AsDefined).unwrap())
}

#[test]
fn empty_and_single_scenes_answer() {
    let r = ray(Vec3::new(0.2, 0.2, 5.0), -Vec3::Z);
    let empty = build(&[]);
    assert_eq!(empty.intersect(&r, f32::INFINITY, &OPAQUE), None);
    assert!(empty.bounds().is_empty());
    let one = build(&[mesh(vec![Point::ORIGIN, Point(Vec3::X), Point(Vec3::Y)], vec![[0, 1, 2]])]);
    assert_eq!(one.intersect(&r, f32::INFINITY, &OPAQUE).map(|h| h.t), Some(5.0));
    assert_eq!(one.intersect(&r, 5.0, &OPAQUE), None);
    let disk = Disk::new(0.0, 1.0, 0.0, 360.0, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
    assert_eq!(build(&[Shape::Disk(Box::new(disk))]).intersect(&r, 9.0, &OPAQUE).map(|h| h.t), Some(5.0));
}

#[test]
fn coincident_primitives_keep_the_tree_within_the_stack() {
    // Identical boxes give the builder nothing to decide by; nested ones tempt it into a chain.
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for i in 0..20_000_u32 {
        let k = if i < 19_000 { 1.0 } else { 1.0002_f32.powi(i as i32 - 19_000) };
        positions.extend([Point::ORIGIN, Point(Vec3::X * k), Point(Vec3::Y * k)]);
        indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let accel = build(&[mesh(positions, indices)]);
    assert!(accel.stats().depth <= tree::MAX_DEPTH && accel.stats().triangles == 20_000);
    let h = accel.intersect(&ray(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z), f32::INFINITY, &OPAQUE).unwrap();
    assert_eq!((h.t, h.prim), (1.0, 0), "ties go to the lowest identifier");
}

#[test]
fn scenes_beyond_comparable_areas_are_still_found() {
    let k = 1e30;
    let p = vec![Point::ORIGIN, Point(Vec3::X * k), Point(Vec3::Y * k), Point(Vec3::ONE * k)];
    let faces = (0..50).flat_map(|_| [[0, 1, 2], [1, 3, 2]]).collect();
    let accel = build(&[mesh(p, faces)]);
    let h = accel.intersect(&ray(Vec3::new(0.2, 0.2, 1.0) * k, -Vec3::Z), f32::INFINITY, &OPAQUE);
    assert!(h.is_some_and(|h| (h.t / k - 1.0).abs() < 1e-6));
}

#[test]
fn layouts_that_refer_to_nothing_are_refused() {
    let t = AnimatedTransform::fixed(Transform::IDENTITY);
    let err = |l: &Layout| Accel::build(&[], l).map(|_| ()).unwrap_err();
    assert_eq!(err(&Layout::of_world(1)), AccelError::NoSuchShape { shape: 0, count: 0 });
    let instances = vec![Instance { object: ObjectId(2), render_from_object: t }];
    let expected = AccelError::NoSuchObject { instance: 0, object: 2, count: 0 };
    assert_eq!(err(&Layout { instances, ..Layout::default() }), expected);
}

#[test]
fn instances_are_met_where_their_copies_would_be() {
    let mut rng = Pcg32::new(9, 3);
    let (points, faces) = icosphere(2);
    let transforms: Vec<Transform> = (0..20)
        .map(|_| {
            Transform::translate(unit(&mut rng) * 5.0)
                * Transform::rotate(360.0 * rng.next_f32(), unit(&mut rng)).unwrap()
                * Transform::scale(Vec3::new(0.3 + rng.next_f32(), 0.5, -0.8)).unwrap()
        })
        .collect();
    let copies: Vec<Shape> = transforms.iter().map(|t| mesh_at(points.clone(), faces.clone(), t)).collect();
    let baked = build(&copies);
    let object = [mesh(points, faces)];
    let instances = transforms
        .iter()
        .map(|t| Instance { object: ObjectId(0), render_from_object: AnimatedTransform::fixed(*t) });
    let layout =
        Layout { objects: vec![vec![ShapeId(0)]], instances: instances.collect(), ..Layout::default() };
    let accel = Accel::build(&object, &layout).unwrap();
    accel.validate().unwrap();
    let mut hits = 0;
    for _ in 0..3000 {
        let o = unit(&mut rng) * 8.0;
        let r = ray(o, unit(&mut rng) * 6.0 - o);
        let (a, b) =
            (baked.intersect(&r, f32::INFINITY, &OPAQUE), accel.intersect(&r, f32::INFINITY, &OPAQUE));
        assert_eq!(b, accel.clone().portable().intersect(&r, f32::INFINITY, &OPAQUE));
        let (Some(a), Some(b)) = (a, b) else { continue };
        if (a.t - b.t).abs() > 1e-4 {
            continue;
        }
        hits += 1;
        assert_eq!(b.instance, Some(InstanceId(a.shape.0)));
        let (sa, sb) = (baked.surface(&r, &a, &copies), accel.surface(&r, &b, &object));
        assert!((*sa.p.p - *sb.p.p).length() < 1e-4);
        // Mirrored: the winding of the baked copy is flipped back by its orientation.
        assert!(a.prim != b.prim || sa.ng.dot(*sb.ng) > 0.9999, "{:?} {:?}", sa.ng, sb.ng);
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn a_moving_instance_is_met_where_it_is_at_the_time_of_the_ray() {
    let end = Transform::translate(Vec3::new(10.0, 0.0, 0.0));
    let render_from_object = AnimatedTransform::new(Transform::IDENTITY, end, [0.0, 1.0]);
    let sphere = Sphere::new(1.0, -1.0, 1.0, 360.0, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
    let shapes = [Shape::Sphere(Box::new(sphere))];
    let layout = Layout {
        objects: vec![vec![ShapeId(0)]],
        instances: vec![Instance { object: ObjectId(0), render_from_object }],
        ..Layout::default()
    };
    let accel = Accel::build(&shapes, &layout).unwrap();
    for time in [0.0, 0.25, 0.5, 1.0] {
        let r = Ray { o: Point::new(10.0 * time, 0.0, 5.0), d: -Vec3::Z, time };
        let h = accel.intersect(&r, f32::INFINITY, &OPAQUE).unwrap();
        assert!((h.t - 4.0).abs() < 1e-5);
        let s = accel.surface(&r, &h, &shapes);
        assert!((*s.p.p - Vec3::new(10.0 * time, 0.0, 1.0)).length() < 1e-5);
        let elsewhere = Ray { time: 1.0 - time, ..r };
        assert_eq!(accel.occluded(&elsewhere, f32::INFINITY, &OPAQUE), time == 0.5);
    }
}

#[test]
fn the_filter_is_asked_about_tested_shapes_only() {
    let layer = |z: f32| {
        let p = vec![Point::new(-1.0, -1.0, z), Point::new(3.0, -1.0, z), Point::new(-1.0, 3.0, z)];
        mesh(p, vec![[0, 1, 2]])
    };
    let shapes = [layer(3.0), layer(2.0), layer(1.0)];
    let coverage = vec![Coverage::Tested, Coverage::Opaque, Coverage::Tested];
    let layout = Layout { coverage, ..Layout::of_world(3) };
    let accel = Accel::build(&shapes, &layout).unwrap();
    let r = ray(Vec3::new(0.0, 0.0, 5.0), -Vec3::Z);
    let refuse = |c: &Candidate| {
        assert_ne!(c.shape, ShapeId(1));
        false
    };
    assert_eq!(accel.intersect(&r, f32::INFINITY, &OPAQUE).map(|h| h.shape), Some(ShapeId(0)));
    assert_eq!(accel.intersect(&r, f32::INFINITY, &refuse).map(|h| h.shape), Some(ShapeId(1)));
    assert!(accel.occluded(&r, f32::INFINITY, &refuse));
    assert!(!accel.occluded(&r, 2.5, &refuse));
}

/// Every ray that leaves a hit outwards from a convex shape must not meet it again, and every ray inwards must
/// not start behind it: on a closed shape it hits the far side.
fn leave_and_enter(shapes: &[Shape], layout: &Layout, center: Vec3, size: f32, closed: bool, seed: u64) {
    let accel = Accel::build(shapes, layout).unwrap();
    let mut rng = Pcg32::new(seed, 4);
    for _ in 0..400 {
        let o = center + unit(&mut rng) * (3.0 * size);
        let target = center + unit(&mut rng) * (0.8 * size * rng.next_f32());
        let r = ray(o, target - o);
        let Some(h) = accel.intersect(&r, f32::INFINITY, &OPAQUE) else { continue };
        let s = accel.surface(&r, &h, shapes);
        let n = s.ng.facing(o - *s.p.p);
        for _ in 0..20 {
            let w = unit(&mut rng);
            let out = Dir::new(if w.dot(*n) > 0.0 { w } else { -w }).unwrap();
            let again = accel.intersect(&s.p.spawn(n, out, 0.0), f32::INFINITY, &OPAQUE);
            if closed {
                assert_eq!(again, None, "left {s:?} towards {out:?}");
            } else if let Some(again) = again
                && out.dot(*n) > 0.1
            {
                // The inside of a cylinder is met again, but not at once unless tangentially.
                assert!(again.t > 1e-3 * size, "left {s:?} towards {out:?}: {again:?}");
            }
            let inward = accel.intersect(&s.p.spawn(n, -out, 0.0), f32::INFINITY, &OPAQUE);
            // Near-tangential rays into a curved surface leave it again at once, rightly.
            let steep = out.dot(*n) > 0.1;
            match inward {
                Some(i) => assert!(
                    !steep || i.prim != h.prim || i.t > 1e-3 * size,
                    "entered {s:?} towards {:?}: {i:?}",
                    -out
                ),
                None => assert!(!(closed && steep), "leak through {s:?} towards {:?}", -out),
            }
        }
    }
}

#[test]
fn spawned_rays_leave_their_surface_at_every_scale_and_place() {
    let (points, faces) = icosphere(1);
    let o = Orientation::AsDefined;
    for (k, size) in [1e-6_f32, 1e-3, 1.0, 1e3, 1e6].into_iter().enumerate() {
        for (j, center) in
            [Vec3::ZERO, Vec3::new(1.0, -2.0, 0.5), Vec3::new(100.0, 1e-3, -1e3)].into_iter().enumerate()
        {
            let center = center * size;
            let t = Transform::translate(center)
                * Transform::rotate(33.0, Vec3::new(1.0, 2.0, 0.3)).unwrap()
                * Transform::scale(Vec3::splat(size)).unwrap();
            let seed = (10 * k + j) as u64;
            let sphere =
                |t: &Transform| Shape::Sphere(Box::new(Sphere::new(1.0, -1.0, 1.0, 360.0, t, o).unwrap()));
            let icosahedron = |t: &Transform| mesh_at(points.clone(), faces.clone(), t);
            let world = Layout::of_world(1);
            leave_and_enter(&[sphere(&t)], &world, center, size, true, seed);
            leave_and_enter(&[icosahedron(&t)], &world, center, size, true, seed);
            let disk = Disk::new(0.1, 1.0, 0.0, 360.0, &t, o).unwrap();
            leave_and_enter(&[Shape::Disk(Box::new(disk))], &world, center, size, false, seed);
            let cylinder = Cylinder::new(0.7, -1.0, 1.0, 360.0, &t, o).unwrap();
            leave_and_enter(&[Shape::Cylinder(Box::new(cylinder))], &world, center, size, false, seed);
            leave_and_enter(&[saddle(&t)], &world, center, size, false, seed);
            leave_and_enter(&[curve(&t, Vec3::ZERO)], &world, center, size, false, seed);
            let instances =
                vec![Instance { object: ObjectId(0), render_from_object: AnimatedTransform::fixed(t) }];
            let layout = Layout { objects: vec![vec![ShapeId(0)]], instances, ..Layout::default() };
            leave_and_enter(&[icosahedron(&Transform::IDENTITY)], &layout, center, size, true, seed);
            leave_and_enter(&[sphere(&Transform::IDENTITY)], &layout, center, size, true, seed);
        }
    }
}

#[test]
fn normals_of_a_closed_mesh_point_outwards() {
    let (points, faces) = icosphere(2);
    let shapes = [mesh(points, faces)];
    let accel = build(&shapes);
    let mut rng = Pcg32::new(2, 2);
    for _ in 0..200 {
        let o = unit(&mut rng) * 3.0;
        let r = ray(o, -o + unit(&mut rng) * 0.5);
        let h = accel.intersect(&r, f32::INFINITY, &OPAQUE).unwrap();
        let s = accel.surface(&r, &h, &shapes);
        let n: Normal = s.ng;
        assert!(n.dot(s.p.p.normalize()) > 0.95);
    }
}
