//! Inputs on which the two instruction sets could part: both must meet the same primitive at the same t, to the bit
//! (0 ulps), as must the search through all primitives; and none may let a ray through a closed surface.

use super::*;
use crate::math::hash::Pcg32;
use crate::math::{AnimatedTransform, Point, Transform, Vec2, Vec3, warp};
use crate::shape::curve::{Basis, Degree, Profile};
use crate::shape::{Curve, CurveData, MeshData, Orientation, ShapeId, TriangleMesh};

const OPAQUE: fn(&Candidate) -> bool = |_| true;

fn mesh(triangles: &[[Vec3; 3]]) -> Shape {
    let positions = triangles.iter().flatten().map(|p| Point(*p)).collect();
    let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let data = MeshData { positions, indices, ..MeshData::default() };
    Shape::Mesh(TriangleMesh::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap())
}

fn accels(shapes: &[Shape]) -> [Accel; 2] {
    let accel = Accel::build(shapes, &Layout::of_world(shapes.len())).unwrap();
    accel.validate().unwrap();
    let portable = accel.clone().portable();
    [accel, portable]
}

fn searched(shape: &Shape, ray: &Ray, t_max: f32) -> Option<Hit> {
    let hits = (0..shape.prim_count()).filter_map(|prim| {
        let h = shape.primitive(prim).intersect(ray, t_max).filter(|h| h.t < t_max)?;
        Some(Hit { t: h.t, shape: ShapeId(0), prim, instance: None, u: h.u, v: h.v })
    });
    hits.reduce(|best, h| if h.precedes(&best) { h } else { best })
}

/// Whether the ray meets something: both paths must say so as the search does, also where the ray ends at a hit or next to
/// it.
fn all_agree(accels: &[Accel; 2], shape: &Shape, ray: &Ray, t_max: f32) -> bool {
    let first = searched(shape, ray, t_max);
    let around = |h: Hit| [0.999 * h.t, h.t.next_down(), h.t, h.t.next_up(), 1.001 * h.t];
    for t_max in std::iter::once(t_max).chain(first.into_iter().flat_map(around)) {
        let expected = searched(shape, ray, t_max);
        for accel in accels {
            assert_eq!(accel.intersect(ray, t_max, &OPAQUE), expected, "{ray:?}, {t_max}");
            assert_eq!(accel.occluded(ray, t_max, &OPAQUE), expected.is_some(), "{ray:?}, {t_max}");
        }
    }
    first.is_some()
}

/// A number in (−1, 1), often one of a few: coordinates coincide, planes are shared.
fn coordinate(rng: &mut Pcg32) -> f32 {
    match rng.next_u32() % 8 {
        0 => 0.0,
        1 => -0.0,
        2 => 0.5,
        3 => -0.5,
        _ => rng.next_f32() * 2.0 - 1.0,
    }
}

fn place(rng: &mut Pcg32) -> Vec3 {
    Vec3::new(coordinate(rng), coordinate(rng), coordinate(rng))
}

/// Triangles that share corners and planes, and such without area: points, needles, doubled corners.
fn triangles(rng: &mut Pcg32, count: usize) -> Vec<[Vec3; 3]> {
    let corners: Vec<Vec3> = (0..count / 2).map(|_| place(rng)).collect();
    (0..count)
        .map(|i| {
            let mut pick = || corners[rng.next_u32() as usize % corners.len()];
            let (a, b, c) = (pick(), pick(), pick());
            match i % 12 {
                0 => [a; 3],
                1 => [a, b, b],
                2 => [a, b, a * 0.5 + b * 0.5],
                3 => [a, a + (b - a) * 1e-6, c],
                4 => [Vec3::new(0.5, a.y, a.z), Vec3::new(0.5, b.y, b.z), Vec3::new(0.5, c.y, c.z)],
                5 => [a, a + (b - a) * 1e-3, a + (c - a) * 1e-3],
                _ => [a, b, c],
            }
        })
        .collect()
}

#[test]
fn both_paths_meet_the_same_primitive_at_the_same_place_on_adversarial_input() {
    let mut rng = Pcg32::new(21, 4);
    let mut met = 0;
    // From where areas vanish to where they are infinite.
    for scale in [1e-36_f32, 1e-27, 1e-18, 1e-9, 1.0, 1e9, 1e18, 1e21, 1e28, 1e36] {
        let plain = triangles(&mut rng, 150);
        let shape = mesh(&plain.iter().map(|t| t.map(|p| p * scale)).collect::<Vec<_>>());
        let shapes = [shape];
        let accels = accels(&shapes);
        for i in 0..2500_u32 {
            let [a, b, c] = plain[rng.next_u32() as usize % plain.len()];
            // At corners, through edges, within planes, along axes, and any way.
            let (o, to) = match i % 6 {
                0 => (place(&mut rng) * 2.0, a),
                1 => (place(&mut rng) * 2.0, a + (b - a) * rng.next_f32()),
                2 => (a + (a - b), b + (c - b) * 0.3),
                3 => (a * 0.3 + b * 0.3 + c * 0.4, place(&mut rng)),
                4 => {
                    let mut o = a;
                    o[i as usize % 3] = 2.0;
                    (o, a)
                }
                _ => (place(&mut rng) * 2.0, place(&mut rng)),
            };
            let mut d = to - o;
            // Components that are nothing to the others, as far down as floats go.
            match i % 7 {
                0 => d[i as usize / 7 % 3] = 0.0,
                1 => d[i as usize / 7 % 3] = -0.0,
                2 => d[i as usize / 7 % 3] *= 1e-20,
                3 => d[i as usize / 7 % 3] = 1e-42,
                _ => {}
            }
            let length = [1.0, scale, 1e-12, 1e12][i as usize / 16 % 4];
            let ray = Ray { o: Point(o * scale), d: d * length, time: 0.0 };
            if ray.d == Vec3::ZERO {
                continue;
            }
            let t_max = if i % 5 == 0 { scale / length } else { f32::INFINITY };
            met += u32::from(all_agree(&accels, &shapes[0], &ray, t_max));
        }
    }
    assert!(met > 4000, "{met}");
}

#[test]
fn both_paths_meet_the_same_curve_at_the_same_place_on_adversarial_input() {
    let mut rng = Pcg32::new(6, 11);
    let mut met = 0;
    for (case, scale) in [1e-18_f32, 1e-9, 1.0, 1e9, 1e18].into_iter().enumerate() {
        let points: Vec<Vec3> = (0..91).map(|_| place(&mut rng)).collect();
        let profile = [Profile::Flat, Profile::Ribbon, Profile::Cylinder][case % 3];
        let data = CurveData {
            points: points.iter().map(|p| Point(*p * scale)).collect(),
            basis: Basis::Bezier,
            degree: Degree::Cubic,
            profile,
            normals: if profile == Profile::Ribbon { vec![Vec3::Z; 31] } else { vec![] },
            widths: [0.1 * scale, 0.0],
            split_depth: 3,
        };
        let shapes = [Shape::Curve(Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap())];
        let accels = accels(&shapes);
        for i in 0..1500_u32 {
            let k = 3 * (rng.next_u32() as usize % 30);
            let [a, b] = [points[k], points[k + 3]];
            // At joints, along chords, along axes, and any way.
            let (o, to) = match i % 4 {
                0 => (place(&mut rng) * 2.0, a),
                1 => (a * 2.0 - b, b),
                2 => (Vec3::new(a.x, a.y, 2.0), a),
                _ => (place(&mut rng) * 2.0, place(&mut rng)),
            };
            let length = [1.0, scale, 1e-12, 1e12][i as usize / 16 % 4];
            let ray = Ray { o: Point(o * scale), d: (to - o) * length, time: 0.0 };
            if ray.d == Vec3::ZERO {
                continue;
            }
            let t_max = if i % 5 == 0 { scale / length } else { f32::INFINITY };
            met += u32::from(all_agree(&accels, &shapes[0], &ray, t_max));
        }
    }
    assert!(met > 1500, "{met}");
}

#[test]
fn rays_that_are_none_meet_nothing_and_end() {
    let mut rng = Pcg32::new(5, 6);
    let [accel, portable] = accels(&[mesh(&triangles(&mut rng, 200))]);
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for accel in [&accel, &portable] {
        for x in odd {
            for axis in 0..3 {
                let mut ray = Ray { o: Point::new(0.1, 0.2, 3.0), d: -Vec3::Z, time: 0.0 };
                ray.o.0[axis] = x;
                assert_eq!(accel.intersect(&ray, f32::INFINITY, &OPAQUE), None, "{ray:?}");
                let mut ray = Ray { o: Point::new(0.1, 0.2, 3.0), d: -Vec3::Z, time: 0.0 };
                ray.d[axis] = x;
                assert_eq!(accel.intersect(&ray, f32::INFINITY, &OPAQUE), None, "{ray:?}");
                assert!(!accel.occluded(&ray, f32::INFINITY, &OPAQUE));
            }
        }
        let still = Ray { o: Point::ORIGIN, d: Vec3::ZERO, time: 0.0 };
        assert_eq!(accel.intersect(&still, f32::INFINITY, &OPAQUE), None);
        let ray = Ray { o: Point::new(0.1, 0.2, 3.0), d: -Vec3::Z, time: 0.0 };
        for t_max in [0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
            assert_eq!(accel.intersect(&ray, t_max, &OPAQUE), None, "{t_max}");
        }
        // The farthest places that a ray can come from.
        for o in [Vec3::splat(3e38), Vec3::new(0.0, 0.0, -3e38)] {
            let ray = Ray { o: Point(o), d: Vec3::new(1e-30, 1e-42, 1.0), time: 0.0 };
            assert_eq!(accel.intersect(&ray, 1.0, &OPAQUE), None);
        }
    }
}

/// A ball of triangles whose corners are shared exactly.
fn ball(columns: u32, scale: f32) -> Vec<[Vec3; 3]> {
    use std::f32::consts::{PI, TAU};
    let rows = columns / 2;
    let corner = |i: u32, j: u32| {
        let (phi, theta) = (TAU * (i % columns) as f32 / columns as f32, PI * j as f32 / rows as f32);
        // At the poles all columns meet in one point.
        let sin = if j.is_multiple_of(rows) { 0.0 } else { theta.sin() };
        Vec3::new(sin * phi.cos(), sin * phi.sin(), theta.cos()) * scale
    };
    let mut faces = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)];
            faces.extend([[a, b, c], [b, d, c]]);
        }
    }
    faces
}

#[test]
fn no_ray_escapes_from_a_ball_at_the_ends_of_the_range_of_floats() {
    let mut rng = Pcg32::new(3, 8);
    for scale in [1e-18_f32, 1e18] {
        let faces = ball(24, scale);
        let both = accels(&[mesh(&faces)]);
        for i in 0..3000_u32 {
            let [a, b, _] = faces[rng.next_u32() as usize % faces.len()];
            let inside = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32())) * (0.6 * scale);
            let (o, d) = match i % 4 {
                0 => (inside, a - inside),
                1 => (inside, a + (b - a) * rng.next_f32() - inside),
                // Parallel to an axis through a corner: two components of the direction are zero.
                2 => (Vec3::new(a.x, a.y, 0.0) * 0.99, Vec3::new(0.0, -0.0, 1.0)),
                _ => (Vec3::new(0.0, a.y, a.z) * 0.99, Vec3::new(-1.0, 1e-25, 0.0)),
            };
            let ray = Ray { o: Point(o), d, time: 0.0 };
            for accel in &both {
                assert!(accel.occluded(&ray, f32::INFINITY, &OPAQUE), "scale {scale}: {ray:?}");
                assert!(accel.intersect(&ray, f32::INFINITY, &OPAQUE).is_some());
            }
        }
    }
}

#[test]
fn rays_that_start_in_or_next_to_the_plane_of_a_triangle_are_answered_alike() {
    let mut rng = Pcg32::new(22, 1);
    let mut met = 0;
    for scale in [1e-9_f32, 1.0, 1e9] {
        // Whole numbers: a corner and multiples of 1/32 of two edges are in the plane without rounding.
        let mut whole =
            |n: u32| Vec3::from_array([0; 3].map(|_| (rng.next_u32() % (2 * n)) as f32 - n as f32));
        let scale = 2.0_f32.powi(scale.log2() as i32);
        let origins: Vec<[Vec3; 3]> =
            (0..40).map(|_| [whole(1 << 22), whole(1 << 17), whole(1 << 17)].map(|p| p * scale)).collect();
        let shapes =
            [mesh(&origins.iter().map(|[a, e, f]| [*a, a + e * 32.0, a + f * 32.0]).collect::<Vec<_>>())];
        let accels = accels(&shapes);
        for i in 0..4000_usize {
            let k = i % origins.len();
            let [a, e, f] = origins[k];
            let inside = [0; 2].map(|_| (1 + rng.next_u32() % 15) as f32);
            let mut o = a + e * inside[0] + f * inside[1];
            let mut d = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            if i % 3 == 0 {
                // Grazing.
                d = (e * (rng.next_f32() - 0.5) + f * (rng.next_f32() - 0.5)).normalize() + d * 1e-4;
            }
            let steps = i / 3 % 4;
            for _ in 0..steps {
                o[i % 3] = if i % 2 == 0 { o[i % 3].next_up() } else { o[i % 3].next_down() };
            }
            let ray = Ray { o: Point(o), d, time: 0.0 };
            if steps == 0 {
                let own = shapes[0].primitive(k as u32).intersect(&ray, f32::INFINITY);
                assert_eq!(own, None, "{ray:?}");
            }
            met += u32::from(all_agree(&accels, &shapes[0], &ray, f32::INFINITY));
            // Where it is met, if at all, next to the origin.
            all_agree(&accels, &shapes[0], &ray, 0.1 * e.length());
        }
    }
    assert!(met > 1500, "{met}");
}

/// At the rims of boxes far from the origin, on rays that hardly move along one axis: there the rounding of the box counts,
/// and not that of the ray.
#[test]
fn curves_far_from_the_origin_are_met_up_to_their_edges() {
    let mut rng = Pcg32::new(18, 7);
    let mut met = 0;
    for far in [100.0_f32, 1e4] {
        // Straight pieces along the axes in turn.
        let corners: Vec<Vec3> = (0..40_usize)
            .scan(Vec3::new(far, -0.9 * far, 0.7 * far), |p, k| {
                p[k % 3] += far * 1e-3 * (1.0 + rng.next_f32());
                Some(*p)
            })
            .collect();
        let points =
            corners.windows(2).flat_map(|c| [c[0], c[0].lerp(c[1], 1.0 / 3.0), c[0].lerp(c[1], 2.0 / 3.0)]);
        let width = 1e-4 * far;
        let data = CurveData {
            points: points.chain(corners.last().copied()).map(Point).collect(),
            basis: Basis::Bezier,
            degree: Degree::Cubic,
            profile: Profile::Flat,
            normals: vec![],
            widths: [width; 2],
            split_depth: 1,
        };
        let shapes = [Shape::Curve(Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap())];
        let accels = accels(&shapes);
        for i in 0..3000 {
            let k = rng.next_u32() as usize % 39;
            let (along, across, axis) = match i % 2 {
                0 => ((k + 1) % 3, (k + 2) % 3, (k + 3) % 3),
                _ => ((k + 1) % 3, (k + 3) % 3, (k + 2) % 3),
            };
            let mut target = corners[k].lerp(corners[k + 1], rng.next_f32());
            let mut d = Vec3::ZERO;
            d[axis] = 1.0 - 2.0 * (i / 2 % 2) as f32;
            d[across] = 2e-3 * (rng.next_f32() - 0.5);
            target[across] +=
                width * (0.5 + 4e-3 * (rng.next_f32() - 0.5)) * (1.0 - 2.0 * (i / 4 % 2) as f32);
            debug_assert_ne!(along, across);
            let ray = Ray { o: Point(target - d * (0.1 * far)), d, time: 0.0 };
            met += u32::from(all_agree(&accels, &shapes[0], &ray, f32::INFINITY));
        }
    }
    assert!((1500..4500).contains(&met), "{met}");
}

#[test]
fn an_instance_is_met_wherever_its_object_is_up_to_the_rim_of_its_box() {
    let mut rng = Pcg32::new(19, 3);
    let mut met = 0;
    for case in 0..300 {
        let mut unit = || warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
        // A square that is far from the origin of the world, or from its own and taken back.
        let (away, back) = [(0.0, 1e4), (1e4, 1.0), (1.0, 1.0)][case / 3 % 3];
        // In the plane of two axes, so that its own box is no larger.
        let (middle, x, y) = (unit() * away, Vec3::AXES[case % 3], Vec3::AXES[(case + 1) % 3]);
        let square =
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| middle + x * a + y * b);
        let [a, b, c, d] = square;
        let shapes = [mesh(&[[a, b, c], [a, c, d]])];
        let turned = Transform::rotate(360.0 * unit().x, unit()).unwrap();
        let t = Transform::translate(unit() * back - *turned.point(Point(middle))) * turned;
        // Another one, so that there are boxes to test.
        let beyond = Transform::translate(unit() * 1e6);
        let instances = [t, beyond]
            .map(|t| Instance { object: ObjectId(0), render_from_object: AnimatedTransform::fixed(t) });
        let layout =
            Layout { objects: vec![vec![ShapeId(0)]], instances: instances.to_vec(), ..Layout::default() };
        let accel = Accel::build(&shapes, &layout).unwrap();
        let portable = accel.clone().portable();
        let object = Accel::build(&shapes, &Layout::of_world(1)).unwrap();
        for i in 0..60 {
            let axis = i % 3;
            // The corner that goes farthest along the axis.
            let sign = 1.0 - 2.0 * (i / 3 % 2) as f32;
            let corners = square.map(|p| t.point(Point(p)));
            let Some(corner) =
                corners.into_iter().max_by(|p, q| (p[axis] * sign).total_cmp(&(q[axis] * sign)))
            else {
                continue;
            };
            let rounding = (away + back) * 1e-7;
            let mut d = unit();
            d[axis] *= 1e-4;
            let mut o = *corner - d;
            o[axis] += rounding * 6.0 * unit().x;
            let ray = Ray { o: Point(o), d, time: 0.0 };
            let expected = object.intersect(&accel.instances[0].object_ray(&ray), f32::INFINITY, &OPAQUE);
            for accel in [&accel, &portable] {
                let h = accel.intersect(&ray, f32::INFINITY, &OPAQUE);
                assert_eq!(
                    h.map(|h| (h.t, h.prim)),
                    expected.map(|h| (h.t, h.prim)),
                    "case {case}: {ray:?} {square:?} {t:?}"
                );
            }
            met += u32::from(expected.is_some());
        }
    }
    assert!(met > 1000, "{met}");
}
