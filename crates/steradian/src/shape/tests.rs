use super::*;
use crate::math::{Normal, Transform, Vec3, warp};
use std::f64::consts::{PI, TAU};

fn grid(n: u32) -> impl Iterator<Item = Vec2> {
    (0..n * n).map(move |i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32)
}

fn tilted(center: Vec3, scale: Vec3) -> Transform {
    Transform::translate(center)
        * Transform::rotate(50.0, Vec3::new(1.0, -2.0, 0.5)).unwrap()
        * Transform::scale(scale).unwrap()
}

const PLAIN: Orientation = Orientation::AsDefined;

fn sphere(t: &Transform) -> Shape {
    Shape::Sphere(Box::new(Sphere::new(1.0, -1.0, 1.0, 360.0, t, PLAIN).unwrap()))
}

fn disk(t: &Transform) -> Shape {
    Shape::Disk(Box::new(Disk::new(0.0, 1.0, 0.0, 360.0, t, PLAIN).unwrap()))
}

fn triangle(v: [[f32; 3]; 3], t: &Transform) -> Shape {
    let positions = v.map(|p| Point(Vec3::from(p))).to_vec();
    let data = MeshData { indices: vec![[0, 1, 2]], positions, ..Default::default() };
    Shape::Mesh(TriangleMesh::new(data, t, PLAIN).unwrap())
}

fn patch(v: [[f32; 3]; 4], t: &Transform) -> Shape {
    let positions = v.map(|p| Point(Vec3::from(p))).to_vec();
    let data = PatchData { indices: vec![[0, 1, 2, 3]], positions, ..Default::default() };
    Shape::Bilinear(BilinearMesh::new(data, t, PLAIN).unwrap())
}

const SQUARE: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
const RIGHT_ANGLE: [[f32; 3]; 3] = [[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-1.0, 1.5, 0.0]];
const SADDLE: [[f32; 3]; 4] = [[-1.0, -1.0, 0.3], [1.2, -1.0, -0.2], [-0.7, 1.0, -0.3], [1.0, 1.5, 0.4]];

/// Shapes of one primitive, as emitters may be, near and far, stretched and cut.
fn emitters() -> Vec<Shape> {
    let one = Vec3::ONE;
    let near = tilted(Vec3::new(0.5, -0.3, 2.5), one);
    let far = tilted(Vec3::new(3.0, 300.0, -20.0), one * 1.5);
    let stretched = tilted(Vec3::new(-0.5, 0.3, -4.0), Vec3::new(1.0, 2.0, 0.5));
    let mirrored = tilted(Vec3::new(0.5, 3.3, 0.0), Vec3::new(-1.0, 1.0, 1.0));
    let mut out = Vec::new();
    for t in [near, far, stretched, mirrored] {
        out.extend([sphere(&t), disk(&t), triangle(RIGHT_ANGLE, &t), patch(SQUARE, &t), patch(SADDLE, &t)]);
        out.push(Shape::Cylinder(Box::new(Cylinder::new(0.8, -0.5, 1.0, 360.0, &t, PLAIN).unwrap())));
        out.push(Shape::Sphere(Box::new(Sphere::new(1.0, -0.6, 0.8, 250.0, &t, PLAIN).unwrap())));
        out.push(Shape::Disk(Box::new(Disk::new(0.2, 1.0, 0.4, 200.0, &t, PLAIN).unwrap())));
    }
    // The reference point is inside.
    out.push(sphere(&tilted(Vec3::new(0.5, 0.0, 0.0), one * 4.0)));
    out
}

fn references() -> [ReferencePoint; 2] {
    let free = ReferencePoint::free(Point::new(0.1, 0.2, -0.1), 0.0);
    let n = Normal::new(Vec3::new(0.3, 0.2, 1.0));
    [free, ReferencePoint { ng: n, ns: n, ..free }]
}

#[test]
fn samples_lie_on_the_shape_with_the_normal_and_parameters_of_a_hit() {
    for (k, shape) in emitters().iter().enumerate() {
        let from = &references()[0];
        let mut compared = 0;
        for u in grid(12) {
            let s = shape.sample_area(0, u).unwrap();
            // Seen from straight above the sample, so that the nearest hit is the sample.
            let r = Ray { o: s.p.p + s.n * 1e-2, d: *-s.n, time: 0.0 };
            let h = shape.primitive(0).intersect(&r, f32::INFINITY);
            // At the very rim the ray may pass by.
            let Some(h) = h else { continue };
            let at = shape.surface(0, &r, &h);
            assert!((*at.p.p - *s.p.p).length() < 2e-4, "{k} {u}: {at:?} {s:?}");
            assert!(at.ng.dot(*s.n) > 0.999, "{k} {u}: {:?} {:?}", at.ng, s.n);
            assert!(
                (at.uv - s.uv).abs().max_element() < 2e-3 || at.uv.min(s.uv).min_element() < 1e-2,
                "{k} {u}: {} {}",
                at.uv,
                s.uv
            );
            compared += 1;
            let toward = shape.sample_toward(0, from, u).unwrap();
            let expected = (*toward.p.p - *from.p.p).normalize();
            assert!(toward.wi.dot(expected) > 0.999_999);
        }
        assert!(compared > 100, "{k}: {compared}");
    }
}

#[test]
fn area_samples_integrate_to_the_area() {
    // E[1/density] is the area whatever the density, and ∫ dA over a stretched sphere is its surface.
    for (k, shape) in emitters().iter().enumerate() {
        let n = 64;
        let sum: f64 = grid(n).map(|u| 1.0 / f64::from(shape.sample_area(0, u).unwrap().density.0)).sum();
        let (mean, area) = (sum / f64::from(n * n), f64::from(shape.area(0)));
        assert!((mean / area - 1.0).abs() < 2e-3, "{k}: {mean} {area}");
    }
    // Prolate spheroid a = 1, c = 2 (Beyer): 2πa² (1 + c/(a e) asin e), e² = 1 − a²/c².
    let e = 0.75_f64.sqrt();
    let expected = TAU * (1.0 + 2.0 / e * e.asin());
    let t = tilted(Vec3::ZERO, Vec3::new(1.0, 1.0, 2.0));
    assert!((f64::from(sphere(&t).area(0)) / expected - 1.0).abs() < 1e-3);
}

#[test]
fn the_density_of_a_hit_is_the_density_of_the_sample_there() {
    for (k, shape) in emitters().iter().enumerate() {
        for from in references() {
            let mut compared = 0;
            for u in grid(16) {
                let Some(s) = shape.sample_toward(0, &from, u) else { continue };
                let r = from.spawn(s.wi);
                let Some(h) = shape.primitive(0).intersect(&r, f32::INFINITY) else { continue };
                let hit = shape.surface(0, &r, &h);
                let distance = (*s.p.p - *from.p.p).length();
                // Far sides are sampled too; there the nearest hit is another point.
                if (*hit.p.p - *s.p.p).length() > 2e-5 * distance {
                    continue;
                }
                compared += 1;
                let pdf = shape.pdf_toward(0, &from, s.wi, &hit);
                // The rounding of the direction shifts a grazing hit by distance·ε/cos on the surface, which turns
                // the normal of a curved shape and so changes the cosine by as much again.
                let tolerance = 2e-3 + 3e-7 * distance / hit.ng.dot(*s.wi).powi(2);
                assert!((pdf.0 / s.density.0 - 1.0).abs() < tolerance, "{k} {u}: {pdf:?} {:?}", s.density);
            }
            assert!(compared > 60, "{k}: {compared}");
        }
    }
}

#[test]
fn densities_integrate_to_one_over_the_directions() {
    // Each direction meets a flat or half-seen shape once: the integral of the density over all directions is one.
    let t = tilted(Vec3::new(0.3, -0.2, 1.6), Vec3::ONE);
    let shapes = [sphere(&t), disk(&t), triangle(RIGHT_ANGLE, &t), patch(SQUARE, &t)];
    for (k, shape) in shapes.iter().enumerate() {
        for from in references() {
            let n = 500;
            let (mut mass, mut omega) = (0.0_f64, 0.0_f64);
            for u in grid(n) {
                let wi = Dir::new(warp::equal_area_square_to_sphere(u)).unwrap();
                let r = from.spawn(wi);
                let Some(h) = shape.primitive(0).intersect(&r, f32::INFINITY) else { continue };
                mass += f64::from(shape.pdf_toward(0, &from, wi, &shape.surface(0, &r, &h)).0);
                omega += 1.0;
            }
            let cell = 2.0 * TAU / f64::from(n * n);
            // The rim crosses about √(4πΩ)/√cell cells; each is right or wrong by half, independently: 3σ < 0.5 %.
            assert!((mass * cell - 1.0).abs() < 5e-3, "{k}: {}", mass * cell);
            // And the samples' mean of 1/density is the solid angle that the directions found.
            let m = 128;
            let inverse = |u| shape.sample_toward(0, &from, u).map_or(0.0, |s| 1.0 / f64::from(s.density.0));
            let sampled = grid(m).map(inverse).sum::<f64>() / f64::from(m * m);
            assert!((sampled / (omega * cell) - 1.0).abs() < 6e-3, "{k}: {sampled} {}", omega * cell);
        }
    }
}

/// ∫ cosθ dω over a shape at the origin with normal +z, per unit of radiance.
fn irradiance(shape: &Shape, ns: Option<Normal>, n: u32) -> f64 {
    let from = ReferencePoint { ng: ns, ns, ..ReferencePoint::free(Point::ORIGIN, 0.0) };
    let term = |u| shape.sample_toward(0, &from, u).map_or(0.0, |s| f64::from(s.wi.z.max(0.0) / s.density.0));
    grid(n).map(term).sum::<f64>() / f64::from(n * n)
}

#[test]
fn irradiance_from_uniform_emitters_has_its_closed_form() {
    let up = Some(Normal::Z);
    let at = |z: f32| Transform::translate(Vec3::new(0.0, 0.0, z));
    for ns in [None, up] {
        let check = |shape: Shape, expected: f64, what: &str| {
            let e = irradiance(&shape, ns, 256);
            assert!((e / expected - 1.0).abs() < 1e-3, "{what}: {e} {expected}");
        };
        // E = πL R²/(R² + h²) and E = πL (R/d)² cosθ.
        check(disk(&at(2.0)), 0.628_318_53, "disk");
        check(sphere(&at(2.0)), 0.25 * PI, "sphere");
        // Centred unit square at h = 1, and one corner of it; F = E/π (Lambert's polygon formula).
        let square = |c: Vec3| {
            patch(
                [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [-0.5, 0.5, 0.0], [0.5, 0.5, 0.0]],
                &Transform::translate(c),
            )
        };
        check(square(Vec3::Z), PI * 0.239_456_470_46, "square");
        check(square(Vec3::new(0.5, 0.5, 1.0)), PI * 0.138_531_605_99, "corner");
        // A triangle against Lambert's formula, from its solid-angle and its area regime.
        for scale in [1.0_f32, 0.01] {
            let v = [[0.3, -0.2, 1.0], [1.1, 0.1, 1.4], [-0.2, 0.9, 0.8]].map(|p| (Vec3::from(p)).to_array());
            let small = v.map(|p| [p[0] * scale, p[1] * scale, 1.0 + (p[2] - 1.0) * scale]);
            check(triangle(small, &Transform::IDENTITY), lambert(&small), "triangle");
        }
    }
}

/// E/L = ½ Σ Θᵢ Γᵢ·n for a polygon above the horizon.
fn lambert(v: &[[f32; 3]]) -> f64 {
    let d: Vec<glam::DVec3> = v.iter().map(|p| Vec3::from(*p).as_dvec3().normalize()).collect();
    let edges = (0..d.len()).map(|i| (d[i], d[(i + 1) % d.len()]));
    edges.map(|(a, b)| a.cross(b).normalize().z * a.dot(b).acos()).sum::<f64>().abs() * 0.5
}

#[test]
fn tiny_distant_spheres_keep_their_solid_angle() {
    for d in [1e2_f32, 1e4, 1e6] {
        let shape = sphere(&Transform::translate(Vec3::new(0.0, 0.0, d)));
        let s = shape.sample_toward(0, &references()[0], Vec2::new(0.3, 0.6)).unwrap();
        // Ω = π (R/d)² to relative accuracy (R/d)²/4.
        let omega = PI / (f64::from(d) * f64::from(d));
        assert!((1.0 / (f64::from(s.density.0) * omega) - 1.0).abs() < 2e-3, "{d}");
    }
}

#[test]
fn parametric_derivatives_match_finite_differences() {
    // Walk from a hit along ∂p/∂u and ∂p/∂v: the parameters there must have changed accordingly.
    for shape in emitters() {
        // Even, so that the centre of a disk, where u is undefined, is not among them.
        for u in grid(4) {
            let s = shape.sample_area(0, u).unwrap();
            let look = |target: Vec3| {
                let r = Ray { o: Point(target + *s.n * 1e-2), d: *-s.n, time: 0.0 };
                shape.primitive(0).intersect(&r, 0.1).map(|h| shape.surface(0, &r, &h))
            };
            let Some(at) = look(*s.p.p) else { continue };
            let h = 2e-3;
            for (direction, expected) in [(at.dpdu, Vec2::X), (at.dpdv, Vec2::Y)] {
                let (Some(a), Some(b)) = (look(*at.p.p + direction * h), look(*at.p.p - direction * h))
                else {
                    continue;
                };
                let change = (a.uv - b.uv) / (2.0 * h);
                // The seam of the azimuth.
                if change.length() > 10.0 {
                    continue;
                }
                // f32 positions at distance 300 resolve uv to about 1e-2 of this step.
                assert!((change - expected).length() < 5e-2, "{change} {expected} {u} {shape:?}");
                let dn = (*a.shading.n - *b.shading.n) / (2.0 * h);
                let expected = if expected == Vec2::X { at.shading.dndu } else { at.shading.dndv };
                assert!(
                    (dn - expected).length() < 5e-2 * (1.0 + expected.length()),
                    "{dn} {expected} {u} {shape:?}"
                );
            }
        }
    }
}
