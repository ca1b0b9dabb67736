//! Light of any distribution through a rectangle, by quadrature: where a weight has no closed form, such as that of glass.

use super::quadrature::tanh_sinh;
use glam::DVec3;

/// A rectangle, or any parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// One of its corners.
    pub corner: DVec3,
    /// Its edges from there.
    pub edges: [DVec3; 2],
}

impl Rectangle {
    /// The vertices, in order.
    pub fn vertices(&self) -> [DVec3; 4] {
        let ([u, v], a) = (self.edges, self.corner);
        [a, a + u, a + u + v, a + v]
    }

    /// Its unit normal: that of a right-handed turn from the first edge to the second.
    pub fn normal(&self) -> DVec3 {
        self.edges[0].cross(self.edges[1]).normalize()
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        self.edges[0].cross(self.edges[1]).length()
    }

    /// ∫ L(u) cosθ dω over the directions u in which it is seen from `p`, A (24) with A (14), to 10⁻¹⁰ of smooth L; θ is taken to the unit
    /// `normal`, below whose horizon nothing counts and no part of the rectangle may lie.
    pub fn irradiance(&self, p: DVec3, normal: DVec3, radiance: impl Fn(DVec3) -> f64) -> f64 {
        let ([u, v], own) = (self.edges, self.normal());
        let at = |s: f64, t: f64| {
            let to = self.corner + s * u + t * v - p;
            let squared = to.length_squared();
            let direction = to / squared.sqrt();
            radiance(direction) * direction.dot(normal).max(0.0) * direction.dot(own).abs() / squared
        };
        self.area() * tanh_sinh(|s| tanh_sinh(|t| at(s, t)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::daylight::{RoofLight, Sky, Window};
    use super::super::polygon::projected_solid_angle;
    use super::*;

    #[test]
    fn quadrature_agrees_with_the_closed_forms() {
        let roof = Rectangle { corner: DVec3::new(-0.5, 0.2, 3.0), edges: [DVec3::X, 2.0 * DVec3::Y] };
        let lambert = projected_solid_angle(DVec3::ZERO, DVec3::Z, &roof.vertices()).0;
        assert!((roof.irradiance(DVec3::ZERO, DVec3::Z, |_| 1.0) / lambert - 1.0).abs() < 1e-10);
        let overcast = |u: DVec3| Sky::Overcast.luminance(u.z);
        let closed = RoofLight { height: 3.0, x: [-0.5, 0.5], y: [0.2, 2.2] }.horizontal(Sky::Overcast);
        assert!((roof.irradiance(DVec3::ZERO, DVec3::Z, overcast) / closed - 1.0).abs() < 1e-10);
        let window =
            Rectangle { corner: DVec3::new(1.0, -1.0, 0.2), edges: [2.0 * DVec3::Y, 1.5 * DVec3::Z] };
        let closed =
            Window { distance: 1.0, sides: [-1.0, 1.0], heights: [0.2, 1.7] }.horizontal(Sky::Overcast);
        assert!((window.irradiance(DVec3::ZERO, DVec3::Z, overcast) / closed - 1.0).abs() < 1e-10);
    }
}
