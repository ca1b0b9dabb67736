//! Axis-aligned boxes.

use super::vector::{Point, Vec3};

/// An axis-aligned box; empty when `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// Lower corner.
    pub min: Point,
    /// Upper corner.
    pub max: Point,
}

impl Bounds3 {
    /// The box that contains nothing, the neutral element of [`Bounds3::union`].
    pub const EMPTY: Self = Self { min: Point(Vec3::INFINITY), max: Point(Vec3::NEG_INFINITY) };

    /// Smallest box around the given points.
    pub fn from_points(points: impl IntoIterator<Item = Point>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::grow)
    }

    /// The box extended to contain `p`.
    #[must_use]
    pub fn grow(self, p: Point) -> Self {
        Self { min: Point(self.min.min(*p)), max: Point(self.max.max(*p)) }
    }

    /// Smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: Point(self.min.min(*other.min)), max: Point(self.max.max(*other.max)) }
    }

    /// The box extended by `margin` on every side.
    #[must_use]
    pub fn expand(self, margin: f32) -> Self {
        Self { min: self.min - Vec3::splat(margin), max: self.max + Vec3::splat(margin) }
    }

    /// Whether the box contains no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(*self.max).all()
    }

    /// Edge lengths; zero for an empty box.
    pub fn diagonal(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Centre.
    pub fn center(&self) -> Point {
        Point((*self.min + *self.max) * 0.5)
    }

    /// Surface area [scene units²].
    pub fn area(&self) -> f32 {
        let d = self.diagonal();
        2.0 * (d.x * d.y + d.y * d.z + d.z * d.x)
    }

    /// The eight corners.
    pub fn corners(&self) -> [Point; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f32, hi: f32| if i >> bit & 1 == 0 { lo } else { hi };
            Point::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// Centre and radius of a sphere around the box; radius zero when the box is empty.
    pub fn bounding_sphere(&self) -> (Point, f32) {
        if self.is_empty() {
            return (Point::ORIGIN, 0.0);
        }
        (self.center(), 0.5 * self.diagonal().length())
    }
}
