//! Intersecting a part of a curve: subdivision in a space where the ray is the z axis (Nakamaru & Ohno 2002).

use super::bezier::Bezier;
use crate::math::{Bounds3, Frame, Normal, Point, Ray, Vec3};
use crate::shape::contract::PrimHit;

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

/// A part in ray space, with its parameters.
#[derive(Clone, Copy)]
struct Task {
    part: Bezier,
    u: [f32; 2],
    depth: u32,
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
        hull.expand(0.5 * self.max_width(self.u) + reach * crate::math::float::gamma(8))
    }

    /// Nearest intersection at 0 < t ≤ `t_max`; coordinates are the piece's u and v across the width.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        let length = ray.d.length();
        let z = ray.d / length;
        // y across the chord makes the boxes of the projected parts thin.
        let chord = self.part.0[3] - self.part.0[0];
        let y = z.cross(chord).try_normalize().unwrap_or_else(|| Frame::from_z(z).s);
        let x = y.cross(z);
        let origin = ray.o.as_dvec3();
        let project = |p: Vec3| {
            let p = (p.as_dvec3() - origin).as_vec3();
            Vec3::new(p.dot(x), p.dot(y), p.dot(z))
        };
        let part = Bezier(self.part.0.map(project));
        let mut z_max = length * t_max;
        if !self.overlaps(&part, self.u, z_max) {
            return None;
        }
        // Depth at which chords are within 5 % of the width (pbrt-v4 book, 6.7).
        let [a, b, c, d] = part.0;
        let bend = (a - b * 2.0 + c).abs().max((b - c * 2.0 + d).abs()).max_element();
        let tolerance = self.widths[0].max(self.widths[1]) * 0.05;
        let depth = if bend > 0.0 && tolerance > 0.0 {
            let levels = 0.5 * (std::f32::consts::SQRT_2 * 6.0 * bend / (8.0 * tolerance)).log2();
            (levels.max(0.0) as u32).min(MAX_DEPTH)
        } else {
            0
        };
        let mut best = None;
        let mut stack = [Task { part, u: self.u, depth }; MAX_DEPTH as usize + 2];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let task = stack[height];
            if task.depth == 0 {
                if let Some(h) = self.meet(&task, z, length, z_max) {
                    z_max = h.t * length;
                    best = Some(h);
                }
                continue;
            }
            let middle = 0.5 * (task.u[0] + task.u[1]);
            let halves = task.part.halves().into_iter().zip([[task.u[0], middle], [middle, task.u[1]]]);
            for (part, u) in halves {
                if self.overlaps(&part, u, z_max) {
                    stack[height] = Task { part, u, depth: task.depth - 1 };
                    height += 1;
                }
            }
        }
        best
    }

    /// Whether the widened hull of a projected part meets the ray, which is z from 0 to `z_max`.
    fn overlaps(&self, part: &Bezier, u: [f32; 2], z_max: f32) -> bool {
        let half = 0.5 * self.max_width(u);
        let [a, b, c, d] = part.0;
        let (lo, hi) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        lo.x <= half
            && hi.x >= -half
            && lo.y <= half
            && hi.y >= -half
            && hi.z >= -half
            && lo.z <= z_max + half
    }

    /// Intersects a part that is nearly straight.
    fn meet(&self, task: &Task, z: Vec3, length: f32, z_max: f32) -> Option<PrimHit> {
        let [a, b, c, d] = task.part.0.map(|p| p.truncate());
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
        let u = crate::math::float::lerp(w, task.u[0], task.u[1]).clamp(task.u[0], task.u[1]);
        let mut width = self.width(u);
        if let Some(normals) = &self.normals {
            width *= ribbon_normal(normals, u).dot(z).abs();
        }
        let w = w.clamp(0.0, 1.0);
        let p = task.part.point(w);
        let distance_squared = p.truncate().length_squared();
        if distance_squared > 0.25 * width * width || !(p.z > 0.0 && p.z <= z_max) {
            return None;
        }
        let tangent = task.part.derivative(w).truncate();
        let side = tangent.perp_dot(-p.truncate());
        let across = if width > 0.0 { (distance_squared.sqrt() / width).copysign(side) } else { 0.0 };
        let t = p.z / length;
        (t > 0.0).then_some(PrimHit { t, u, v: 0.5 + across })
    }
}
