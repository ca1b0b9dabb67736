//! How a quadric stands in render space: its affine transform in f64, its orientation, its scale.

use super::contract::{Orientation, PrimHit, ShapeError, ShapeSample};
use super::rounding;
use crate::math::{BoundedPoint, Bounds3, Normal, Point, Ray, Shading, SurfacePoint, Transform, Vec2, Vec3};
use crate::units::PdfArea;
use glam::{DAffine3, DMat3, DMat4, DVec3};

/// Object space to render space for shapes that keep their analytic form.
///
/// The inverse is the f64 inverse of the stored matrix, so that a point carried to render space and back moves by
/// f64 rounding only; f32 inverses would lose the margin that keeps spawned rays off their own surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    render_from_object: DAffine3,
    object_from_render: DAffine3,
    /// Inverse transpose of the linear part: acts on normals.
    normal: DMat3,
    flip: bool,
    /// The uniform scale factor if the transform is a similarity.
    scale: Option<f64>,
}

/// Object-space differential geometry of a parametric surface.
pub(super) struct ObjectSurface {
    pub(super) p: DVec3,
    pub(super) uv: Vec2,
    pub(super) dpdu: DVec3,
    pub(super) dpdv: DVec3,
    /// Unit, on the side of ∂p/∂u × ∂p/∂v.
    pub(super) n: DVec3,
    pub(super) dndu: DVec3,
    pub(super) dndv: DVec3,
}

impl Placement {
    /// An error when the transform is not affine.
    pub(super) fn new(t: &Transform, orientation: Orientation) -> Result<Self, ShapeError> {
        let m: DMat4 = t.matrix().as_dmat4();
        let projective = [m.x_axis.w, m.y_axis.w, m.z_axis.w].iter().any(|&w| w != 0.0) || m.w_axis.w != 1.0;
        if projective {
            return Err(ShapeError::Parameter {
                name: "transform bottom row",
                value: m.w_axis.w as f32,
                rule: "0 0 0 1",
            });
        }
        let render_from_object = DAffine3::from_mat4(m);
        let object_from_render = render_from_object.inverse();
        let linear = render_from_object.matrix3;
        let gram = linear.transpose() * linear;
        let s2 = gram.x_axis.x;
        let difference = gram - DMat3::from_diagonal(DVec3::splat(s2));
        // Scene-file rotations are given with about six digits.
        let is_similarity = difference.to_cols_array().iter().all(|d| d.abs() <= 1e-5 * s2);
        Ok(Self {
            render_from_object,
            object_from_render,
            normal: object_from_render.matrix3.transpose(),
            flip: orientation.flips_normals(t),
            scale: is_similarity.then(|| s2.sqrt()),
        })
    }

    /// The uniform scale factor if the transform is a similarity.
    pub(super) fn scale(&self) -> Option<f64> {
        self.scale
    }

    /// Origin and direction of a ray in object space; parametric distances are kept.
    pub(super) fn object_ray(&self, ray: &Ray) -> (DVec3, DVec3) {
        (
            self.object_from_render.transform_point3(ray.o.as_dvec3()),
            self.object_from_render.transform_vector3(ray.d.as_dvec3()),
        )
    }

    /// A render-space point in object space.
    pub(super) fn object_point(&self, p: Point) -> DVec3 {
        self.object_from_render.transform_point3(p.as_dvec3())
    }

    /// An object-space point in render space, not rounded.
    pub(super) fn render_point(&self, p: DVec3) -> DVec3 {
        self.render_from_object.transform_point3(p)
    }

    /// An object-space point in render space with its rounding bound.
    pub(super) fn bounded_point(&self, p: DVec3) -> BoundedPoint {
        let m = &self.render_from_object;
        let abs = m.matrix3.abs();
        rounding::bounded(self.render_point(p), (abs * p.abs() + m.translation.abs()).as_vec3())
    }

    /// The oriented render-space normal of an object-space normal; `None` when it has no length.
    pub(super) fn oriented_normal(&self, n: DVec3) -> Option<Normal> {
        rounding::normalized(self.orient(self.normal * n))
    }

    fn orient(&self, n: DVec3) -> DVec3 {
        if self.flip { -n } else { n }
    }

    /// Render-space area per object-space area around a point with unit normal `n`.
    pub(super) fn area_factor(&self, n: DVec3) -> f64 {
        // Nanson: dA' n' = det(M) M⁻ᵀ n dA.
        self.render_from_object.matrix3.determinant().abs() * (self.normal * n).length()
    }

    /// A sample with `object_density` per unit of object-space area, in render space.
    pub(super) fn sample(&self, p: DVec3, n: DVec3, uv: Vec2, object_density: f64) -> Option<ShapeSample> {
        let density = PdfArea((object_density / self.area_factor(n)) as f32);
        Some(ShapeSample { p: self.bounded_point(p), n: self.oriented_normal(n)?, uv, density })
    }

    /// Object-space differential geometry in render space.
    pub(super) fn surface(&self, s: &ObjectSurface, time: f32) -> SurfacePoint {
        let linear = self.render_from_object.matrix3;
        let (dpdu, dpdv) = ((linear * s.dpdu).as_vec3(), (linear * s.dpdv).as_vec3());
        // The transform is invertible and n a unit vector: the product has length.
        let n = self.oriented_normal(s.n).unwrap_or(Normal::Z);
        let length = (self.normal * s.n).length();
        let derivative = |dn: DVec3| {
            // d(N/|N|) for N = M⁻ᵀ n.
            let change = self.orient(self.normal * dn) / length;
            (change - n.as_dvec3() * n.as_dvec3().dot(change)).as_vec3()
        };
        let (dndu, dndv): (Vec3, Vec3) = (derivative(s.dndu), derivative(s.dndv));
        SurfacePoint {
            p: self.bounded_point(s.p),
            ng: n,
            uv: s.uv,
            dpdu,
            dpdv,
            shading: Shading { n, dpdu, dpdv, dndu, dndv },
            time,
            face: 0,
        }
    }

    /// Box around the object-space ellipsoid with the given centre and half axes along x, y, z.
    pub(super) fn ellipsoid_bounds(&self, center: DVec3, half: DVec3) -> Bounds3 {
        let m = self.render_from_object.matrix3 * DMat3::from_diagonal(half);
        let rows = m.transpose();
        let extent = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        outward(self.render_point(center), extent)
    }

    /// Box around the object-space box with the given corners.
    pub(super) fn box_bounds(&self, min: DVec3, max: DVec3) -> Bounds3 {
        let half = (max - min) * 0.5;
        let extent = self.render_from_object.matrix3.abs() * half;
        outward(self.render_point((min + max) * 0.5), extent)
    }
}

/// A box rounded outwards, by more than f64 can have erred on the way.
fn outward(center: DVec3, extent: DVec3) -> Bounds3 {
    let slack = (center.abs() + extent) * (64.0 * f64::EPSILON);
    let (lo, hi) = ((center - extent - slack).as_vec3(), (center + extent + slack).as_vec3());
    Bounds3 {
        min: Point::new(lo.x.next_down(), lo.y.next_down(), lo.z.next_down()),
        max: Point::new(hi.x.next_up(), hi.y.next_up(), hi.z.next_up()),
    }
}

/// The first root inside (0, `t_max`] that `accept` takes, as a hit with the coordinates that it returns.
pub(super) fn first_root(
    roots: (f64, f64),
    t_max: f32,
    accept: impl Fn(f64) -> Option<[f64; 2]>,
) -> Option<PrimHit> {
    for t in [roots.0, roots.1] {
        let rounded = t as f32;
        if rounded > t_max {
            return None;
        }
        if rounded > 0.0
            && let Some([u, v]) = accept(t)
        {
            return Some(PrimHit { t: rounded, u: u as f32, v: v as f32 });
        }
    }
    None
}

/// Azimuth of (x, y) in [0, 2π).
pub(super) fn azimuth(x: f64, y: f64) -> f64 {
    let phi = y.atan2(x);
    if phi < 0.0 { phi + std::f64::consts::TAU } else { phi }
}

/// A sweep angle given in degrees, clamped to (0, 360], in radians.
pub(super) fn sweep(degrees: f32) -> Result<f64, ShapeError> {
    if degrees > 0.0 {
        Ok(f64::from(degrees.min(360.0)).to_radians())
    } else {
        Err(ShapeError::Parameter { name: "phimax", value: degrees, rule: "positive" })
    }
}

/// `value` if it is positive and finite, as f64.
pub(super) fn positive(name: &'static str, value: f32) -> Result<f64, ShapeError> {
    if value > 0.0 && value.is_finite() {
        Ok(f64::from(value))
    } else {
        Err(ShapeError::Parameter { name, value, rule: "positive and finite" })
    }
}

/// `value` if it is finite, as f64.
pub(super) fn finite(name: &'static str, value: f32) -> Result<f64, ShapeError> {
    if value.is_finite() {
        Ok(f64::from(value))
    } else {
        Err(ShapeError::Parameter { name, value, rule: "finite" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::warp;

    #[test]
    fn the_box_of_an_ellipsoid_reaches_its_farthest_points_on_every_side() {
        let mut rng = Pcg32::new(3, 14);
        for _ in 0..1000 {
            let mut place = || warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let t = Transform::translate(place() * 30.0)
                * Transform::rotate(200.0 * place().x, place()).unwrap()
                * Transform::scale(place().abs() + 0.1).unwrap();
            let placement = Placement::new(&t, Orientation::AsDefined).unwrap();
            let (center, half) = (place().as_dvec3(), place().abs().as_dvec3());
            let b = placement.ellipsoid_bounds(center, half);
            for axis in 0..3 {
                // The point of the unit sphere that goes farthest along the axis.
                let along = (placement.render_from_object.matrix3.row(axis) * half).normalize();
                let reach = |p: DVec3| placement.render_point(center + half * p)[axis];
                assert!(f64::from(b.max[axis]) >= reach(along) && f64::from(b.min[axis]) <= reach(-along));
                // And no more than two roundings beyond.
                let slack = f64::from(b.max[axis].abs().max(b.min[axis].abs()) * 2.0 * f32::EPSILON);
                let (hi, lo) =
                    (f64::from(b.max[axis]) - reach(along), reach(-along) - f64::from(b.min[axis]));
                assert!(hi <= slack && lo <= slack, "{hi} {lo} {slack}");
            }
        }
    }
}
