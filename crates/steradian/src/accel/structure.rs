//! The structure itself: a tree over the world, one per object, and the placements of objects.

use super::contract::{Instance, ObjectId};
use super::kernel::KernelChoice;
use super::tree::Tree;
use crate::math::{
    AnimatedTransform, BoundedPoint, Bounds3, Point, Ray, Shading, SurfacePoint, Transform, Vec3, float,
};
use glam::{DAffine3, Mat3};

/// A spatial index over shapes and instances that answers ray queries. Built by [`Accel::build`].
#[derive(Clone, Debug)]
pub struct Accel {
    pub(super) world: Tree,
    pub(super) objects: Vec<Tree>,
    pub(super) instances: Vec<Placed>,
    pub(super) kernel: KernelChoice,
}

/// An instance with what its rays need.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) object: ObjectId,
    render_from_object: AnimatedTransform,
    /// The inverse, in f64 so that going back and forth does not lose the margin of spawned rays; `None` while
    /// the instance moves.
    fixed: Option<DAffine3>,
}

impl Placed {
    pub(super) fn new(instance: &Instance) -> Self {
        let t = &instance.render_from_object;
        let fixed = (!t.is_animated()).then(|| t.inverse_at(0.0));
        Self { object: instance.object, render_from_object: t.clone(), fixed }
    }

    /// The ray in object space at its time; parametric distances are kept.
    pub(super) fn object_ray(&self, ray: &Ray) -> Ray {
        let m = match self.fixed {
            Some(m) => m,
            None => self.render_from_object.inverse_at(ray.time),
        };
        Ray {
            o: Point(m.transform_point3(ray.o.as_dvec3()).as_vec3()),
            d: m.transform_vector3(ray.d.as_dvec3()).as_vec3(),
            time: ray.time,
        }
    }

    /// A box in render space around the object's box at every time, with room for the rounding of transforms.
    pub(super) fn bounds(&self, object: &Bounds3) -> Bounds3 {
        let b = self.render_from_object.motion_bounds(object);
        let reach = b.min.abs().max(b.max.abs()).max_element();
        // What the corners are sums of, which cancel where an object far from its own origin is taken back.
        let corner = object.min.abs().max(object.max.abs());
        let terms = |t: &Transform| {
            let m = t.matrix();
            (Mat3::from_mat4(*m).abs() * corner + m.w_axis.truncate().abs()).max_element()
        };
        let terms = terms(self.render_from_object.start()).max(terms(self.render_from_object.end()));
        // 16 roundings of numbers no larger than the sum of extent and reach, or than those.
        b.expand((reach + b.diagonal().max_element()).max(terms) * float::gamma(16))
    }

    /// An object-space surface point in render space.
    pub(super) fn render_surface(&self, s: &SurfacePoint) -> SurfacePoint {
        let t = self.render_from_object.at(s.time);
        let moved = t.bounded_point(&s.p);
        // The origin of a ray that leaves here is rounded once more when it is taken back to object space.
        let back = Mat3::from_mat4(*t.matrix()).abs() * (s.p.p.abs() * float::gamma(2));
        // Invertible transforms keep the length of normals positive.
        let ng = t.normal(s.ng).unwrap_or(s.ng);
        let shading = &s.shading;
        let moved_n = t.normal_vector(*shading.n);
        let n = t.normal(shading.n).unwrap_or(ng);
        let derivative = |dn: Vec3| {
            // d(N/|N|) for N = M⁻ᵀ n.
            let change = t.normal_vector(dn) / moved_n.length();
            change - *n * n.dot(change)
        };
        SurfacePoint {
            p: BoundedPoint { p: moved.p, error: moved.error + back },
            ng,
            uv: s.uv,
            dpdu: t.vector(s.dpdu),
            dpdv: t.vector(s.dpdv),
            shading: Shading {
                n: n.facing(*ng),
                dpdu: t.vector(shading.dpdu),
                dpdv: t.vector(shading.dpdv),
                dndu: derivative(shading.dndu),
                dndv: derivative(shading.dndv),
            },
            time: s.time,
            face: s.face,
        }
    }
}
