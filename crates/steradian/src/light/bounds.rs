//! Where emitters are, where they shine, and how much of it may reach a point.

use crate::math::float::{safe_acos, safe_sqrt};
use crate::math::{Bounds3, Dir, Normal, Point, Vec3};
use crate::shape::ReferencePoint;

/// A cone of directions around an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    pub(super) axis: Dir,
    /// Cosine of the half angle.
    pub(super) cos: f32,
}

impl Cone {
    pub(super) const SPHERE: Self = Self { axis: Dir::Z, cos: -1.0 };

    /// The smallest cone around both.
    pub(super) fn union(self, other: Self) -> Self {
        let (ta, tb) = (safe_acos(self.cos), safe_acos(other.cos));
        let between = safe_acos(self.axis.dot(*other.axis));
        if between + tb <= ta {
            return self;
        }
        if between + ta <= tb {
            return other;
        }
        let half = 0.5 * (ta + between + tb);
        if half >= std::f32::consts::PI {
            return Self::SPHERE;
        }
        // Turn the axis from `self` towards `other`; opposite axes have no plane to turn in.
        let across = *other.axis - *self.axis * self.axis.dot(*other.axis);
        let Some(across) = Dir::new(across) else { return Self::SPHERE };
        let turn = half - ta;
        match Dir::new(*self.axis * turn.cos() + *across * turn.sin()) {
            Some(axis) => Self { axis, cos: half.cos() },
            None => Self::SPHERE,
        }
    }
}

/// Bounds of one emitter or of a group (Conty Estévez & Kulla 2018, section 4).
#[derive(Clone, Copy, Debug)]
pub(super) struct EmitterBounds {
    pub(super) bounds: Bounds3,
    /// Surface normals.
    pub(super) normals: Cone,
    /// Cosine of the largest angle to a normal at which light is emitted.
    pub(super) cos_emission: f32,
    /// Largest intensity, up to a common factor.
    pub(super) intensity: f32,
    /// Whether light is emitted to both sides of the normals.
    pub(super) both_sides: bool,
}

impl EmitterBounds {
    pub(super) fn union(&self, other: &Self) -> Self {
        if self.intensity == 0.0 {
            return *other;
        }
        if other.intensity == 0.0 {
            return *self;
        }
        Self {
            bounds: self.bounds.union(other.bounds),
            normals: self.normals.union(other.normals),
            cos_emission: self.cos_emission.min(other.cos_emission),
            intensity: self.intensity + other.intensity,
            both_sides: self.both_sides || other.both_sides,
        }
    }

    /// An estimate of the light that reaches `p`, zero only where none does: intensity over squared distance, times the
    /// largest cosines that the bounds allow at the emitter and, given a normal, at the receiver.
    pub(super) fn importance(&self, from: &ReferencePoint) -> f32 {
        let p = from.p.p;
        let centre = self.bounds.center();
        let radius = 0.5 * self.bounds.diagonal().length();
        // Inside or near the bounds the inverse square of the distance to the centre says nothing.
        let d2 = p.distance_squared(centre).max(radius * radius);
        let Some(wi) = Dir::new(p - centre) else { return self.intensity / d2.max(f32::MIN_POSITIVE) };
        let subtended = subtended_cone(&self.bounds, p);
        let mut cos_w = self.normals.axis.dot(*wi);
        if self.both_sides {
            cos_w = cos_w.abs();
        }
        let (sin_w, sin_o) = (sine(cos_w), sine(self.normals.cos));
        let cos_x = cos_less(sin_w, cos_w, sin_o, self.normals.cos);
        let sin_x = sin_less(sin_w, cos_w, sin_o, self.normals.cos);
        let cos_least = cos_less(sin_x, cos_x, sine(subtended), subtended);
        if cos_least < self.cos_emission {
            return 0.0;
        }
        let mut importance = self.intensity * cos_least / d2;
        if let Some(n) = surface_normal(from) {
            let cos_i = wi.dot(*n).abs();
            importance *= cos_less(sine(cos_i), cos_i, sine(subtended), subtended);
        }
        importance.max(0.0)
    }
}

fn surface_normal(from: &ReferencePoint) -> Option<Normal> {
    from.ns.or(from.ng)
}

fn sine(cos: f32) -> f32 {
    safe_sqrt(1.0 - cos * cos)
}

/// cos(max(0, a − b)).
fn cos_less(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    if cos_a > cos_b { 1.0 } else { cos_a * cos_b + sin_a * sin_b }
}

/// sin(max(0, a − b)).
fn sin_less(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    if cos_a > cos_b { 0.0 } else { sin_a * cos_b - cos_a * sin_b }
}

/// Cosine of the half angle of a cone from `p` around the sphere around `b`; −1 from inside.
fn subtended_cone(b: &Bounds3, p: Point) -> f32 {
    let (centre, radius) = b.bounding_sphere();
    let d2 = p.distance_squared(centre);
    let r2 = radius * radius;
    if d2 <= r2 { -1.0 } else { safe_sqrt(1.0 - r2 / d2) }
}

/// Cost of a group in a tree: what it emits, over the surface and the directions that it may be confused with.
pub(super) fn cost(b: &EmitterBounds, whole: Vec3, axis: usize) -> f32 {
    let (o, e) = (safe_acos(b.normals.cos), safe_acos(b.cos_emission));
    let wide = (o + e).min(std::f32::consts::PI);
    let (sin_o, cos_o) = (o.sin(), b.normals.cos);
    // Solid angle of the normals' cone and, weighted by the cosine, of the emission beyond it (eq. 1 of the paper).
    let directions = std::f32::consts::TAU * (1.0 - cos_o)
        + std::f32::consts::FRAC_PI_2
            * (2.0 * wide * sin_o - (o - 2.0 * wide).cos() - 2.0 * o * sin_o + cos_o);
    // Thin boxes cut along their short side help least.
    let regularity = whole.max_element() / whole[axis].max(f32::MIN_POSITIVE);
    b.intensity * directions * regularity * b.bounds.area()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    fn random_dir(rng: &mut Pcg32) -> Dir {
        let u = crate::math::Vec2::new(rng.next_f32(), rng.next_f32());
        Dir::new(crate::math::warp::uniform_sphere(u)).unwrap()
    }

    #[test]
    fn the_union_of_cones_contains_both() {
        let mut rng = Pcg32::new(1, 1);
        for _ in 0..2000 {
            let mut cone = || Cone { axis: random_dir(&mut rng), cos: 0.6 + 0.4 * rng.next_f32() };
            let (a, b) = (cone(), cone());
            let both = a.union(b);
            for part in [a, b] {
                let reach = safe_acos(both.axis.dot(*part.axis)) + safe_acos(part.cos);
                assert!(reach <= safe_acos(both.cos) + 2e-3, "{a:?} {b:?} {both:?}");
            }
        }
    }

    #[test]
    fn nothing_that_is_lit_has_importance_zero() {
        let mut rng = Pcg32::new(2, 1);
        let mut lit = 0;
        for _ in 0..3000 {
            // A small emitter somewhere in a box, with a normal of a cone.
            let mut corner = || Point(Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()));
            let bounds = Bounds3::from_points([corner(), corner()]);
            let emitter = bounds.min + bounds.diagonal() * *corner();
            let normals = Cone { axis: random_dir(&mut rng), cos: 0.9 };
            let tilt = Cone { axis: random_dir(&mut rng), cos: 1.0 };
            let n = Dir::new(*normals.axis + *tilt.axis * 0.3).unwrap();
            if n.dot(*normals.axis) < normals.cos {
                continue;
            }
            let p = Point(*random_dir(&mut rng) * (3.0 * rng.next_f32()));
            let receiver = Normal::new(*random_dir(&mut rng)).unwrap();
            let from =
                ReferencePoint { ng: Some(receiver), ns: Some(receiver), ..ReferencePoint::free(p, 0.0) };
            let to = emitter - p;
            if to.dot(*n) >= 0.0 {
                continue;
            }
            lit += 1;
            let b = EmitterBounds { bounds, normals, cos_emission: 0.0, intensity: 1.0, both_sides: false };
            assert!(b.importance(&from) > 0.0, "{b:?} {from:?}");
        }
        assert!(lit > 500, "{lit}");
    }
}
