//! Intersecting a part of a curve: subdivision in a space where the ray is the z axis (Nakamaru & Ohno 2002).

use super::bezier::Bezier;
use crate::math::float::gamma;
use crate::math::{Bounds3, Frame, Normal, Point, Ray, Vec3};
use crate::shape::contract::PrimHit;
use glam::Mat3;

/// Cross-section of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// A strip that always faces the ray.
    #[default]
    Flat,
    /// A strip that faces the ray, with the normals of a cylinder.
    Cylinder,
    /// A strip with given normals.
    Ribbon,
}

/// A part of one polynomial piece, with its widths and, for a ribbon, its normals.
#[derive(Clone, Debug)]
pub struct CurveSegment {
    part: Bezier,
    /// Parameters of the piece where the part starts and ends.
    u: [f32; 2],
    /// Widths of the whole piece at u = 0 and 1.
    widths: [f32; 2],
    /// Ribbon normals of the whole piece.
    normals: Option<Box<[Normal; 2]>>,
}

/// All points within a distance of a chord, and the ball around it.
#[derive(Clone, Copy, Debug)]
pub struct Capsule {
    /// Middle of the chord.
    pub middle: Point,
    /// From one end of the chord to the other.
    pub chord: Vec3,
    /// Largest distance from the chord [scene units].
    pub reach: f32,
    /// Largest distance from the middle [scene units].
    pub radius: f32,
}

/// Normal of a ribbon between those at its ends: spherically interpolated.
pub(super) fn ribbon_normal(normals: &[Normal; 2], u: f32) -> Normal {
    let angle = normals[0].dot(*normals[1]).clamp(-1.0, 1.0).acos();
    let sin = angle.sin();
    if sin < 1e-6 {
        return normals[0];
    }
    let n = normals[0] * (((1.0 - u) * angle).sin() / sin) + normals[1] * ((u * angle).sin() / sin);
    Normal::new(n).unwrap_or(normals[0])
}

/// A part in the ray's space, with its parameters of the piece.
#[derive(Clone, Copy)]
struct Stretch {
    part: Bezier,
    u: [f32; 2],
}

/// The ray as its own space sees it, and the best hit so far.
struct Search {
    /// Unit direction.
    z: Vec3,
    /// Length of the ray's direction.
    length: f32,
    /// Largest t of interest, and a bound on its z.
    t_max: f32,
    z_max: f32,
    best: Option<PrimHit>,
}

impl Search {
    /// Nothing beyond `t_max` is of interest, but what is as far away: which of equally near hits wins is not decided here.
    ///
    /// Between the hull of a part and the product are nine roundings of a point on the curve and three of its distance.
    fn limit(&mut self, t_max: f32) {
        self.t_max = t_max;
        self.z_max = t_max * self.length * (1.0 + gamma(14));
    }
}

/// Deepest subdivision: 2¹⁰ parts.
const MAX_DEPTH: u32 = 10;

impl CurveSegment {
    pub(super) fn new(
        part: Bezier,
        u: [f32; 2],
        widths: [f32; 2],
        normals: Option<Box<[Normal; 2]>>,
    ) -> Self {
        Self { part, u, widths, normals }
    }

    fn width(&self, u: f32) -> f32 {
        crate::math::float::lerp(u, self.widths[0], self.widths[1])
    }

    fn max_width(&self, u: [f32; 2]) -> f32 {
        self.width(u[0]).max(self.width(u[1]))
    }

    /// The hull of the control points, widened by half the width.
    pub fn bounds(&self) -> Bounds3 {
        let hull = Bounds3::from_points(self.part.0.map(Point));
        let reach = hull.min.abs().max(hull.max.abs()).max_element();
        hull.expand(0.5 * self.max_width(self.u) + reach * gamma(8))
    }

    /// A capsule around the surface as any ray may see it.
    pub fn capsule(&self) -> Capsule {
        let [a, b, c, d] = self.part.0;
        // How far the inner control points are from the thirds of the chord; the curve follows them by 3/4 at most.
        let bulge = b.distance(a.lerp(d, 1.0 / 3.0)).max(c.distance(a.lerp(d, 2.0 / 3.0)));
        let rounding = self.part.0.map(|p| p.abs().max_element()).into_iter().fold(0.0, f32::max) * gamma(8);
        let reach = 0.75 * bulge + 0.5 * self.max_width(self.u) + rounding;
        let chord = d - a;
        Capsule { middle: Point(a * 0.5 + d * 0.5), chord, reach, radius: 0.5 * chord.length() + reach }
    }

    /// Nearest intersection at 0 < t ≤ `t_max`; coordinates are the piece's u and v across the width.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        let length = ray.d.length();
        let z = ray.d / length;
        // y across the chord makes the boxes of the projected parts thin.
        let y =
            z.cross(self.part.0[3] - self.part.0[0]).try_normalize().unwrap_or_else(|| Frame::from_z(z).s);
        let x = y.cross(z);
        let to_ray = Mat3::from_cols(x, y, z).transpose();
        let [a, b, c, d] = self.part.0;
        let [a, b, c, d] = [a - ray.o.0, b - ray.o.0, c - ray.o.0, d - ray.o.0];
        let whole = Stretch { part: Bezier([to_ray * a, to_ray * b, to_ray * c, to_ray * d]), u: self.u };
        let mut search = Search { z, length, t_max, z_max: 0.0, best: None };
        search.limit(t_max);
        if self.overlaps(&whole, search.z_max) {
            self.subdivide(&whole, self.depth(&whole.part), &mut search);
        }
        search.best
    }

    /// Depth at which the chords of a projected part are within 5 % of the width (pbrt-v4 book, 6.7).
    #[inline(always)]
    fn depth(&self, part: &Bezier) -> u32 {
        let [a, b, c, d] = part.0;
        let bend = (a - b * 2.0 + c).abs().max((b - c * 2.0 + d).abs()).max_element();
        let tolerance = self.widths[0].max(self.widths[1]) * 0.05;
        let parts_squared = std::f32::consts::SQRT_2 * 6.0 * bend / (8.0 * tolerance);
        if tolerance > 0.0 && parts_squared >= 1.0 {
            // Half of the logarithm, rounded down, is half of the exponent.
            let exponent = (parts_squared.to_bits() >> 23) - 127;
            (exponent / 2).min(MAX_DEPTH)
        } else {
            0
        }
    }

    fn subdivide(&self, stretch: &Stretch, depth: u32, search: &mut Search) {
        if depth == 0 {
            if let Some(h) = self.meet(stretch, search) {
                search.limit(h.t);
                search.best = Some(h);
            }
            return;
        }
        let [first, second] = stretch.part.halves();
        let [start, end] = stretch.u;
        let middle = 0.5 * (start + end);
        for half in [Stretch { part: first, u: [start, middle] }, Stretch { part: second, u: [middle, end] }]
        {
            if self.overlaps(&half, search.z_max) {
                self.subdivide(&half, depth - 1, search);
            }
        }
    }

    /// Whether the widened hull of a projected part meets the ray, which is z from 0 to `z_max`.
    #[inline(always)]
    fn overlaps(&self, stretch: &Stretch, z_max: f32) -> bool {
        let half = 0.5 * self.max_width(stretch.u);
        let [a, b, c, d] = stretch.part.0;
        let (lo, hi) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        lo.x <= half
            && hi.x >= -half
            && lo.y <= half
            && hi.y >= -half
            && hi.z >= -half
            && lo.z <= z_max + half
    }

    /// Intersects a part that is nearly straight.
    #[inline(always)]
    fn meet(&self, stretch: &Stretch, search: &Search) -> Option<PrimHit> {
        let [a, b, c, d] = stretch.part.0;
        let (a, b, c, d) = (a.truncate(), b.truncate(), c.truncate(), d.truncate());
        // The ray must pass between the lines through the ends, perpendicular to the curve there.
        if (b - a).dot(-a) < 0.0 || (c - d).dot(-d) < 0.0 {
            return None;
        }
        let chord = d - a;
        let denominator = chord.length_squared();
        if denominator == 0.0 {
            return None;
        }
        let w = (-a).dot(chord) / denominator;
        let u = crate::math::float::lerp(w, stretch.u[0], stretch.u[1]).clamp(stretch.u[0], stretch.u[1]);
        let mut width = self.width(u);
        if let Some(normals) = &self.normals {
            width *= ribbon_normal(normals, u).dot(search.z).abs();
        }
        let w = w.clamp(0.0, 1.0);
        let p = stretch.part.point(w);
        let distance_squared = p.truncate().length_squared();
        let t = p.z / search.length;
        if distance_squared > 0.25 * width * width || !(t > 0.0 && t <= search.t_max) {
            return None;
        }
        let tangent = stretch.part.derivative(w).truncate();
        let side = tangent.perp_dot(-p.truncate());
        let across = if width > 0.0 { (distance_squared.sqrt() / width).copysign(side) } else { 0.0 };
        Some(PrimHit { t, u, v: 0.5 + across })
    }
}
