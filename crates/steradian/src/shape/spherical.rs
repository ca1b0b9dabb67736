//! Uniform sampling of spherical triangles and spherical rectangles.
//!
//! Rectangles are computed in f64: the construction subtracts nearly equal angles when they are small.

use crate::math::{Dir, Point, Vec2, Vec3};
use glam::DVec3;

/// A point of a rectangle chosen uniformly in solid angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct RectangleSample {
    /// Fractions along the two edges.
    pub(super) at: [f64; 2],
    /// Solid angle of the rectangle [sr]; the density is its inverse.
    pub(super) solid_angle: f64,
}

fn to_f64(p: Point) -> DVec3 {
    p.as_dvec3()
}

/// Solid angle of the spherical triangle with unit corners a, b, c [sr] (van Oosterom & Strackee 1983).
pub(super) fn triangle_solid_angle([a, b, c]: [Vec3; 3]) -> f32 {
    // The triple product of edges instead of corners, which are nearly parallel in small triangles.
    let y = a.dot((b - a).cross(c - a));
    let x = 1.0 + a.dot(b) + a.dot(c) + b.dot(c);
    2.0 * y.abs().atan2(x)
}

/// Unit directions from `from` to the corners; `None` when `from` is one of them.
pub(super) fn directions_to<const N: usize>(corners: [Point; N], from: Point) -> Option<[DVec3; N]> {
    let o = to_f64(from);
    let mut out = [DVec3::ZERO; N];
    for (d, c) in out.iter_mut().zip(corners) {
        *d = (to_f64(c) - o).try_normalize()?;
    }
    Some(out)
}

/// A triangle as seen from a point.
///
/// In f32: it is constructed for triangles that fill a fair part of the view only.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalTriangle {
    /// From the point to the corners.
    offsets: [Vec3; 3],
    /// Unit directions to the corners.
    pub(super) corners: [Vec3; 3],
    /// Solid angle [sr].
    pub(super) solid_angle: f32,
}

impl SphericalTriangle {
    /// The triangle with corners at `offsets` from the point; `None` when one of them is zero.
    #[inline]
    pub(super) fn new(offsets: [Vec3; 3]) -> Option<Self> {
        let [a, b, c] = offsets;
        let corners = [*Dir::new(a)?, *Dir::new(b)?, *Dir::new(c)?];
        Some(Self { offsets, corners, solid_angle: triangle_solid_angle(corners) })
    }

    /// Chooses a direction uniformly within the triangle (Arvo 1995) and returns barycentric (b₁, b₂) of the point
    /// of the triangle there; `None` when the triangle degenerates to an arc or a point.
    pub(super) fn sample(&self, u: Vec2) -> Option<[f32; 2]> {
        let [a, b, c] = self.corners;
        // Arvo's inner angle α at a enters by sine and cosine alone: (a×b)·(a×c) and |(a×b)×(a×c)| = |a·(b×c)|.
        let (ab, ac) = (a.cross(b), a.cross(c));
        let scale = 1.0 / (ab.length_squared() * ac.length_squared()).sqrt();
        let (cos_alpha, sin_alpha) = (ab.dot(ac) * scale, ab.dot(c).abs() * scale);
        if !(self.solid_angle > 0.0 && scale.is_finite()) {
            return None;
        }
        // The sub-triangle with the fraction u.x of the area shares the edge ab; its third corner c′ lies on ac.
        // Its sine and cosine − 1 by those of half of it: the f32 functions then err as a slightly different u.x would.
        let (sin_half, cos_half) = (0.5 * u.x * self.solid_angle).sin_cos();
        let unit = 2.0 / (sin_half * sin_half + cos_half * cos_half);
        let (sin_area, cos_area_less_1) = (unit * sin_half * cos_half, -unit * sin_half * sin_half);
        // Sine and cosine of the difference of that area and α, and how far the latter is from cos α.
        let p = cos_area_less_1 * cos_alpha + sin_area * sin_alpha;
        let t = p + cos_alpha;
        let s = sin_area * cos_alpha - (cos_area_less_1 + 1.0) * sin_alpha;
        let q = s + sin_alpha * a.dot(b);
        let denominator = (q * s + p * t) * sin_alpha;
        let cos_b = if denominator == 0.0 { 1.0 } else { ((q * t - p * s) * cos_alpha - q) / denominator };
        let cos_b = cos_b.clamp(-1.0, 1.0);
        // Unit vectors orthogonal to the ends of arcs are never formed: their lengths, sines, join the other factors.
        let sines = ((1.0 - cos_b * cos_b) / ac.length_squared()).sqrt();
        let c_sub = a * cos_b + (c - a * a.dot(c)) * sines;
        // Along the arc from b to c′ the density is uniform in the cosine; 1 − cos by the chord, which does not cancel.
        let cos_arc = c_sub.dot(b);
        let one_minus_cos = u.y * 0.5 * (c_sub - b).length_squared();
        let sines = (u.y * (2.0 - one_minus_cos) / (1.0 + cos_arc)).sqrt();
        self.barycentric(b * (1.0 - one_minus_cos) + (c_sub - b * cos_arc) * sines)
    }

    /// Barycentric (b₁, b₂) of the point of the triangle in direction `w`, kept inside the triangle.
    fn barycentric(&self, w: Vec3) -> Option<[f32; 2]> {
        let [p0, p1, p2] = self.offsets;
        let (e1, e2) = (p1 - p0, p2 - p0);
        let s1 = w.cross(e2);
        let divisor = s1.dot(e1);
        let inverse = 1.0 / divisor;
        let s = -p0;
        let (b1, b2) = (s.dot(s1) * inverse, w.dot(s.cross(e1)) * inverse);
        if !(b1.is_finite() && b2.is_finite()) {
            return None;
        }
        let (b1, b2) = (b1.clamp(0.0, 1.0), b2.clamp(0.0, 1.0));
        let sum = b1 + b2;
        Some(if sum > 1.0 { [b1 / sum, b2 / sum] } else { [b1, b2] })
    }

    /// The sample u that [`SphericalTriangle::sample`] maps to direction `w`, a unit vector through the triangle.
    pub(super) fn invert(&self, w: Vec3) -> Option<Vec2> {
        let [a, b, c] = self.corners;
        // c′ is where the great circle through b and w meets the edge ac.
        let mut c_sub = *Dir::new(b.cross(w).cross(c.cross(a)))?;
        if c_sub.dot(a + c) < 0.0 {
            c_sub = -c_sub;
        }
        let x =
            if self.solid_angle > 0.0 { triangle_solid_angle([a, b, c_sub]) / self.solid_angle } else { 0.0 };
        let span = (c_sub - b).length_squared();
        let y = if span > 0.0 { (w - b).length_squared() / span } else { 0.0 };
        Some(Vec2::new(x.clamp(0.0, 1.0), y.clamp(0.0, 1.0)))
    }
}

/// A planar rectangle as seen from a point: the projection of Ureña, Fajardo and King (2013).
struct Rectangle {
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    b0: f64,
    b1: f64,
    k: f64,
    solid_angle: f64,
}

impl Rectangle {
    fn new(corner: Point, edges: [DVec3; 2], from: Point) -> Option<Self> {
        let lengths = edges.map(DVec3::length);
        let (ex, ey) = (edges[0].try_normalize()?, edges[1].try_normalize()?);
        let d = to_f64(corner) - to_f64(from);
        // z < 0 as in the paper; a point in the plane of the rectangle sees nothing.
        let z = -d.dot(ex.cross(ey)).abs();
        if z == 0.0 {
            return None;
        }
        let (x0, y0) = (d.dot(ex), d.dot(ey));
        let (x1, y1) = (x0 + lengths[0], y0 + lengths[1]);
        let n = |a: f64| -> f64 { -a / (z * z + a * a).sqrt() };
        // z components of the four side-plane normals; the inner angles are between neighbours.
        let (n0, n1, n2, n3) = (n(y0), -n(x1), -n(y1), n(x0));
        let inner = |a: f64, b: f64| (-a * b).clamp(-1.0, 1.0).acos();
        let (g0, g1, g2, g3) = (inner(n0, n1), inner(n1, n2), inner(n2, n3), inner(n3, n0));
        let k = std::f64::consts::TAU - g2 - g3;
        let solid_angle = g0 + g1 - k;
        (solid_angle > 0.0).then_some(Self { x: [x0, x1], y: [y0, y1], z, b0: n0, b1: n2, k, solid_angle })
    }
}

/// Solid angle [sr] of the planar rectangle `corner` + s·e₀ + t·e₁; zero when seen edge-on.
pub(super) fn rectangle_solid_angle(corner: Point, edges: [DVec3; 2], from: Point) -> f64 {
    Rectangle::new(corner, edges, from).map_or(0.0, |r| r.solid_angle)
}

/// Chooses a direction uniformly within the rectangle as seen from `from` and returns the fractions along the edges.
pub(super) fn sample_rectangle(
    corner: Point,
    edges: [DVec3; 2],
    from: Point,
    u: Vec2,
) -> Option<RectangleSample> {
    let r = Rectangle::new(corner, edges, from)?;
    let au = f64::from(u.x) * r.solid_angle + r.k;
    let (sin_au, cos_au) = au.sin_cos();
    let fu = (cos_au * r.b0 - r.b1) / sin_au;
    let cu = (1.0 / (fu * fu + r.b0 * r.b0).sqrt()).copysign(fu).clamp(-1.0, 1.0);
    let xu = (-(cu * r.z) / (1.0 - cu * cu).max(0.0).sqrt()).clamp(r.x[0], r.x[1]);
    let xu = if xu.is_nan() { r.x[0] } else { xu };
    let d2 = xu * xu + r.z * r.z;
    let h = r.y.map(|y| y / (d2 + y * y).sqrt());
    let hv = h[0] + f64::from(u.y) * (h[1] - h[0]);
    let hv2 = hv * hv;
    let yv = if hv2 < 1.0 - 1e-12 { hv * d2.sqrt() / (1.0 - hv2).sqrt() } else { r.y[1] };
    let fraction = |a: f64, [lo, hi]: [f64; 2]| ((a - lo) / (hi - lo)).clamp(0.0, 1.0);
    Some(RectangleSample { at: [fraction(xu, r.x), fraction(yv, r.y)], solid_angle: r.solid_angle })
}

/// The sample u that [`sample_rectangle`] maps to the point at fractions `at` of the edges.
pub(super) fn invert_rectangle(corner: Point, edges: [DVec3; 2], from: Point, at: [f64; 2]) -> Option<Vec2> {
    let r = Rectangle::new(corner, edges, from)?;
    let lerp = |t: f64, [lo, hi]: [f64; 2]| lo + t * (hi - lo);
    let (x, y) = (lerp(at[0], r.x), lerp(at[1], r.y));
    let d2 = x * x + r.z * r.z;
    let h = r.y.map(|y| y / (d2 + y * y).sqrt());
    let v = (y / (d2 + y * y).sqrt() - h[0]) / (h[1] - h[0]);
    // The part of the rectangle left of x is itself a rectangle; its share of the solid angle is u.
    let part = Rectangle::new(corner, [edges[0] * at[0], edges[1]], from).map_or(0.0, |p| p.solid_angle);
    let u = part / r.solid_angle;
    Some(Vec2::new(u.clamp(0.0, 1.0) as f32, v.clamp(0.0, 1.0) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: u32) -> impl Iterator<Item = Vec2> {
        (0..n * n).map(move |i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32)
    }

    fn triangle() -> [Point; 3] {
        [Point::new(-1.0, 0.2, 2.0), Point::new(1.5, -0.4, 1.0), Point::new(0.3, 1.7, 3.0)]
    }

    #[test]
    fn an_octant_subtends_half_pi() {
        let octant = [Vec3::X, Vec3::Y, Vec3::Z];
        assert!((triangle_solid_angle(octant) - std::f32::consts::FRAC_PI_2).abs() < 2e-7);
        // One face of a cube seen from its centre: 4π/6.
        let face = rectangle_solid_angle(
            Point::new(-1.0, -1.0, 1.0),
            [DVec3::X * 2.0, DVec3::Y * 2.0],
            Point::ORIGIN,
        );
        assert!((face - std::f64::consts::PI * 2.0 / 3.0).abs() < 1e-14, "{face}");
    }

    #[test]
    fn triangle_samples_are_uniform_in_solid_angle_and_invert() {
        // Uniform in solid angle: E[f] of an area integrand equals its quadrature with weight cosθ/r².
        let (v, from) = (triangle(), Point::ORIGIN);
        let p = |b: [f64; 2]| {
            let [a, c, d] = v.map(to_f64);
            a + (c - a) * b[0] + (d - a) * b[1]
        };
        let (e1, e2) = (to_f64(v[1]) - to_f64(v[0]), to_f64(v[2]) - to_f64(v[0]));
        let n = e1.cross(e2);
        let seen = SphericalTriangle::new(v.map(|p| p - from)).unwrap();
        let f = |b: [f64; 2]| DVec3::new(b[0], b[1] * b[1], b[0] * b[1]);
        let k = 200;
        let (mut quadrature, mut omega) = (DVec3::ZERO, 0.0);
        let mut sampled = DVec3::ZERO;
        for u in grid(k) {
            // Square to triangle with constant Jacobian 1/2, folded.
            let (mut x, mut y) = (f64::from(u.x), f64::from(u.y));
            if x + y > 1.0 {
                (x, y) = (1.0 - x, 1.0 - y);
            }
            let q = p([x, y]);
            let weight = 0.5 * (q.dot(n)).abs() / q.length().powi(3) / f64::from(k * k);
            quadrature += f([x, y]) * weight;
            omega += weight;
            let at = seen.sample(u).unwrap().map(f64::from);
            sampled += f(at) / f64::from(k * k);
            let back = seen.invert(p(at).normalize().as_vec3()).unwrap();
            assert!((back - u).abs().max_element() < 1e-4, "{u} {back}");
        }
        let expected = f64::from(seen.solid_angle);
        assert!((omega / expected - 1.0).abs() < 1e-4, "{omega} {expected}");
        assert!((sampled - quadrature / omega).abs().max_element() < 1e-4, "{sampled} {quadrature}");
    }

    #[test]
    fn rectangle_samples_are_uniform_in_solid_angle_and_invert() {
        let edges = [DVec3::new(1.2, 0.0, 0.5), DVec3::new(0.0, 2.0, 0.0)];
        let (corner, from) = (Point::new(0.1, -0.3, 0.7), Point(Vec3::new(0.4, -0.2, 0.1)));
        let n = edges[0].cross(edges[1]);
        let f = |b: [f64; 2]| DVec3::new(b[0], b[1] * b[1], b[0] * b[1]);
        let k = 200;
        let (mut quadrature, mut omega, mut sampled) = (DVec3::ZERO, 0.0, DVec3::ZERO);
        for u in grid(k) {
            let at = [f64::from(u.x), f64::from(u.y)];
            let q = to_f64(corner) + edges[0] * at[0] + edges[1] * at[1] - to_f64(from);
            let weight = q.dot(n).abs() / q.length().powi(3) / f64::from(k * k);
            quadrature += f(at) * weight;
            omega += weight;
            let s = sample_rectangle(corner, edges, from, u).unwrap();
            sampled += f(s.at) / f64::from(k * k);
            let back = invert_rectangle(corner, edges, from, s.at).unwrap();
            assert!((back - u).abs().max_element() < 1e-4, "{u} {back}");
        }
        let expected = rectangle_solid_angle(corner, edges, from);
        assert!((omega / expected - 1.0).abs() < 1e-4, "{omega} {expected}");
        assert!((sampled - quadrature / omega).abs().max_element() < 1e-4, "{sampled} {quadrature}");
    }
}
