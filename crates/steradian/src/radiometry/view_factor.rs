//! View factors: the share of what leaves a diffuse surface of even radiosity that arrives at another one. Numbered as in
//! Howell, Menguc, Daun & Siegel, "A Catalog of Radiation Heat Transfer Configuration Factors".
//!
//! For surfaces i of areas A: Aᵢ Fᵢⱼ = Aⱼ Fⱼᵢ (reciprocity); Σⱼ Fᵢⱼ = 1 in an enclosure (closure); factors to parts of a surface add.

use super::polygon::{above_horizon, edges};
use super::quadrature::tanh_sinh;
use glam::DVec3;
use std::f64::consts::PI;

/// Equal a × b rectangles opposite each other in parallel planes at distance `h` > 0 (C-11): with X = a/h, Y = b/h,
/// F = 2/(πXY) {ln √[(1+X²)(1+Y²)/(1+X²+Y²)] + X√(1+Y²) atan(X/√(1+Y²)) + Y√(1+X²) atan(Y/√(1+X²)) − X atan X − Y atan Y}.
pub fn parallel_rectangles(a: f64, b: f64, h: f64) -> f64 {
    let (x, y) = (a / h, b / h);
    let (p, q) = (1.0_f64.hypot(x), 1.0_f64.hypot(y));
    let logarithm = (p * q / (1.0 + x * x + y * y).sqrt()).ln();
    let sum = logarithm + x * q * (x / q).atan() + y * p * (y / p).atan() - x * x.atan() - y * y.atan();
    2.0 * sum / (PI * x * y)
}

/// From a rectangle of width `w` to one of height `h` that stands at right angles on a common edge of length `l`, all above 0
/// (C-14): with H = h/l, W = w/l,
/// F = 1/(πW) {W atan(1/W) + H atan(1/H) − √(H²+W²) atan(1/√(H²+W²)) + ¼ ln [((1+W²)(1+H²)/(1+W²+H²)) ·
/// (W²(1+W²+H²)/((1+W²)(W²+H²)))^W² · (H²(1+W²+H²)/((1+H²)(W²+H²)))^H²]}.
pub fn perpendicular_rectangles(h: f64, w: f64, l: f64) -> f64 {
    let (h, w) = (h / l, w / l);
    let (h2, w2) = (h * h, w * w);
    let (s2, s) = (h2 + w2, h.hypot(w));
    let logarithms = ((1.0 + w2) * (1.0 + h2) / (1.0 + s2)).ln()
        + w2 * (w2 * (1.0 + s2) / ((1.0 + w2) * s2)).ln()
        + h2 * (h2 * (1.0 + s2) / ((1.0 + h2) * s2)).ln();
    let angles = w * (1.0 / w).atan() + h * (1.0 / h).atan() - s * (1.0 / s).atan();
    (angles + 0.25 * logarithms) / (PI * w)
}

/// From a disk of radius `r1` to one of radius `r2` on the same axis at distance `h`, all above 0 (C-41): with Rᵢ = rᵢ/h and
/// X = 1 + (1 + R₂²)/R₁², F = ½ [X − √(X² − 4 (R₂/R₁)²)].
pub fn coaxial_disks(r1: f64, r2: f64, h: f64) -> f64 {
    let (r1, r2) = (r1 / h, r2 / h);
    let ratio = (r2 / r1).powi(2);
    let x = 1.0 + (1.0 + r2 * r2) / (r1 * r1);
    // ½ [X − √…] without the cancellation that small far disks suffer.
    2.0 * ratio / (x + (x * x - 4.0 * ratio).sqrt())
}

/// From a sphere to a disk of radius `r` whose axis passes through its centre, at distance `h` > 0 from the centre, in front of
/// the sphere (C-117): F = ½ [1 − 1/√(1 + (r/h)²)], whatever the sphere's radius.
pub fn sphere_to_coaxial_disk(r: f64, h: f64) -> f64 {
    let far = h.hypot(r);
    0.5 * r * r / (far * (far + h))
}

/// The factors of two concentric spheres, or of any convex body of area A₁ in a closed one of area A₂ that is seen by all of it
/// (C-127; by reciprocity and closure): F₁₂ = 1, F₂₁ = A₁/A₂, F₂₂ = 1 − A₁/A₂.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosed {
    /// From the outer surface to the body.
    pub outer_to_inner: f64,
    /// From the outer surface to itself.
    pub outer_to_outer: f64,
}

impl Enclosed {
    /// For radii 0 < inner ≤ outer.
    pub fn concentric_spheres(inner: f64, outer: f64) -> Self {
        let share = (inner / outer).powi(2);
        Self { outer_to_inner: share, outer_to_outer: 1.0 - share }
    }
}

/// From any part of the inside of a sphere to another part of area `area`: F = A/(4πr²), wherever either lies (C-137). This
/// is what makes integrating spheres.
pub fn within_sphere(area: f64, r: f64) -> f64 {
    area / (4.0 * PI * r * r)
}

/// From one planar polygon to another, with nothing between, by Stokes' theorem (Moon 1936; Sparrow 1963):
/// F₁₂ = 1/(2πA₁) |∮ ∮ ln r dr₁·dr₂|; the inner integral in closed form, the outer one numerically, to 10⁻⁸ of the result
/// for polygons of like size, also where they share edges.
///
/// The polygons are simple, with vertices in order, and each lies wholly on the side that the other one's plane faces; the part of
/// `to` below the plane of `from` is cut off, for `from` a triangle or a convex polygon whose vertices run counterclockwise
/// as seen from above.
pub fn polygons(from: &[DVec3], to: &[DVec3]) -> f64 {
    let area = area_vector(from);
    let Some(&origin) = from.first() else { return 0.0 };
    let Some(normal) = area.try_normalize() else { return 0.0 };
    let relative: Vec<_> = to.iter().map(|v| *v - origin).collect();
    let above: Vec<_> = above_horizon(&relative, normal).into_iter().map(|v| v + origin).collect();
    let mut sum = 0.0;
    for (a, b) in edges(&above) {
        let along = b - a;
        let length = along.length();
        for (c, d) in edges(from) {
            let across = d - c;
            let dot = along.dot(across);
            // Edges at right angles contribute nothing, and cancel exactly.
            if dot.abs() < 1e-15 * length * across.length() {
                continue;
            }
            sum += dot * tanh_sinh(|t| mean_logarithm(a + along * t, c, d));
        }
    }
    sum.abs() / (2.0 * PI * area.length())
}

/// The area of a planar polygon, along its normal.
fn area_vector(vertices: &[DVec3]) -> DVec3 {
    let Some(&origin) = vertices.first() else { return DVec3::ZERO };
    0.5 * edges(vertices).map(|(a, b)| (a - origin).cross(b - origin)).sum::<DVec3>()
}

/// ∫₀¹ ln|p − (a + t(b − a))| dt: with the foot of the perpendicular at distance q and the ends at u₀, u₁ from it along the edge,
/// [u ln √(u² + q²) − u + q atan(u/q)] between them over the edge's length.
fn mean_logarithm(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let edge = b - a;
    let length = edge.length();
    let direction = edge / length;
    let u0 = (a - p).dot(direction);
    let q = ((a - p) - direction * u0).length();
    let primitive = |u: f64| {
        let r = u.hypot(q);
        let logarithm = if r > 0.0 { u * r.ln() } else { 0.0 };
        logarithm - u + q * u.atan2(q)
    };
    (primitive(u0 + length) - primitive(u0)) / length
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(f: f64, expected: f64) {
        assert!((f - expected).abs() < 1e-11, "{f} {expected}");
    }

    #[test]
    fn the_catalogue_has_the_checked_factors() {
        close(parallel_rectangles(1.0, 1.0, 1.0), 0.199_824_895_70);
        close(parallel_rectangles(2.0, 1.0, 1.0), 0.285_875_384_85);
        close(parallel_rectangles(10.0, 10.0, 1.0), 0.826_994_522_40);
        close(perpendicular_rectangles(1.0, 1.0, 1.0), 0.200_043_776_08);
        close(perpendicular_rectangles(0.5, 1.0, 1.0), 0.146_186_679_11);
        close(coaxial_disks(1.0, 1.0, 1.0), 0.381_966_011_25);
        close(coaxial_disks(1.0, 2.0, 1.0), 0.763_932_022_50);
    }

    #[test]
    fn a_cube_is_closed() {
        close(parallel_rectangles(1.0, 1.0, 1.0) + 4.0 * perpendicular_rectangles(1.0, 1.0, 1.0), 1.0);
    }

    #[test]
    fn a_sphere_in_a_sphere_sees_only_the_outer_one() {
        let f = Enclosed::concentric_spheres(1.0, 2.0);
        assert_eq!((f.outer_to_inner, f.outer_to_outer), (0.25, 0.75));
        close(within_sphere(4.0 * PI, 1.0), 1.0);
        // Half of what a sphere sends towards a plane's side arrives at an endless disk.
        close(sphere_to_coaxial_disk(1e12, 1.0), 0.5);
    }

    fn rectangle(corner: DVec3, a: DVec3, b: DVec3) -> [DVec3; 4] {
        [corner, corner + a, corner + a + b, corner + b]
    }

    #[test]
    fn contour_integrals_agree_with_the_catalogue_also_at_common_edges() {
        let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        let ceiling = rectangle(DVec3::Z, DVec3::X, DVec3::Y);
        let wall = rectangle(DVec3::ZERO, DVec3::Y, DVec3::Z);
        assert!((polygons(&floor, &ceiling) - 0.199_824_895_70).abs() < 1e-9);
        assert!((polygons(&floor, &wall) - 0.200_043_776_08).abs() < 1e-9);
        // The wall goes on below the floor, where it is not seen.
        let sunk = rectangle(-DVec3::Z, DVec3::Y, 2.0 * DVec3::Z);
        assert!((polygons(&floor, &sunk) - 0.200_043_776_08).abs() < 1e-9);
    }

    #[test]
    fn a_tetrahedron_is_closed() {
        let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y * 1.3, DVec3::new(0.2, 0.3, 0.9)];
        let faces = [[a, b, c], [a, d, b], [b, d, c], [a, c, d]];
        for (i, from) in faces.iter().enumerate() {
            let sum: f64 = faces
                .iter()
                .enumerate()
                .filter(|(j, _)| *j != i)
                .map(|(_, to)| {
                    let there = polygons(from, to);
                    let back = polygons(to, from) * area_vector(to).length() / area_vector(from).length();
                    assert!((there - back).abs() < 1e-8, "{there} {back}");
                    there
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-8, "{sum}");
        }
    }

    proptest! {
        #[test]
        fn a_box_is_closed_and_reciprocal(a in 0.05..20.0_f64, b in 0.05..20.0_f64, h in 0.05..20.0_f64) {
            let (to_long, to_short) = (perpendicular_rectangles(h, b, a), perpendicular_rectangles(h, a, b));
            let closure = parallel_rectangles(a, b, h) + 2.0 * (to_long + to_short);
            prop_assert!((closure - 1.0).abs() < 1e-10, "{closure}");
            // b × a floor and h × a wall on the common edge a.
            let back = perpendicular_rectangles(b, h, a);
            prop_assert!((b * a * to_long - h * a * back).abs() < 1e-10 * a * (b + h));
        }

        #[test]
        fn disks_are_reciprocal(r1 in 0.05..5.0_f64, r2 in 0.05..5.0_f64, h in 0.05..5.0_f64) {
            let (there, back) = (coaxial_disks(r1, r2, h), coaxial_disks(r2, r1, h));
            prop_assert!((r1 * r1 * there / (r2 * r2 * back) - 1.0).abs() < 1e-10);
            prop_assert!(there > 0.0 && there < 1.0);
        }

        #[test]
        fn factors_to_parts_add(split in 0.1..0.9_f64) {
            let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
            let part = |z0: f64, z1: f64| rectangle(DVec3::Z * z0, DVec3::Y, DVec3::Z * (z1 - z0));
            let sum = polygons(&floor, &part(0.0, split)) + polygons(&floor, &part(split, 1.0));
            prop_assert!((sum - 0.200_043_776_08).abs() < 1e-9);
        }
    }
}
