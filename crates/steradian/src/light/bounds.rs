//! Where emitters are and where they shine.

use crate::math::float::safe_acos;
use crate::math::{Bounds3, Dir};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

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
        // Most cones of a large tree's upper levels are whole spheres.
        if self.cos <= -1.0 || other.cos <= -1.0 {
            return Self::SPHERE;
        }
        let (ta, tb) = (safe_acos(self.cos), safe_acos(other.cos));
        let between = safe_acos(self.axis.dot(*other.axis));
        if between + tb <= ta {
            return self;
        }
        if between + ta <= tb {
            return other;
        }
        let half = 0.5 * (ta + between + tb);
        if half >= PI {
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
}

/// Cost of a group in a tree: what it emits, times the extent and the directions over which an estimate for the group as
/// a whole can be wrong.
///
/// Conty Estévez & Kulla 2018, section 4.4, with three deviations, each of which lowered the variance of the choice on scattered, aligned
/// and directed lamps alike: extent is the squared diagonal, for a row of lamps has no area; half a hemisphere is added to the
/// directions, for equally directed lamps still differ; nothing is added for cuts along a short side.
pub(super) fn cost(b: &EmitterBounds) -> f32 {
    let (o, e) = (safe_acos(b.normals.cos), safe_acos(b.cos_emission));
    let wide = (o + e).min(PI);
    let (sin_o, cos_o) = (o.sin(), b.normals.cos);
    // Solid angle of the normals' cone and, weighted by the cosine, of the emission beyond it (eq. 1 of the paper).
    let directions = TAU * (1.0 - cos_o)
        + FRAC_PI_2 * (2.0 * wide * sin_o - (o - 2.0 * wide).cos() - 2.0 * o * sin_o + cos_o);
    b.intensity * (directions + PI) * b.bounds.diagonal().length_squared()
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
}
