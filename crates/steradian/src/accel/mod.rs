//! Finding what a ray meets: a bounding volume hierarchy with eight children per node.
//!
//! Triangles of all meshes lie in packets of four inside the leaves, parts of curves in bunches of eight; other
//! primitives and instances are leaf entries of their own. A ray runs alone, with AVX2 where the processor has it and
//! portable code elsewhere; both give the same hits.

#[cfg(test)]
mod adversarial;
mod build;
mod bunch;
pub mod contract;
mod kernel;
mod locate;
mod pages;
pub mod structure;
mod traverse;
#[cfg(test)]
mod tests;
mod tree;
pub mod validate;
pub mod wide;

pub use contract::{AccelError, Candidate, Coverage, Hit, Instance, InstanceId, Layout, ObjectId};
pub use structure::Accel;
pub use validate::{AccelStats, Violation};
pub use wide::Work;

use crate::math::{Bounds3, Ray, SurfacePoint};
use crate::shape::{Shape, ShapeId};
use kernel::KernelChoice;
use rayon::prelude::*;
use structure::Placed;
use tree::Owner;

/// Which machine instructions the queries of a structure use; part of an image's provenance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// The target's baseline.
    Portable,
    /// AVX2, found at run time.
    Avx2,
}

impl Accel {
    /// Builds the structure over `shapes` as `layout` places them. Every box must be finite.
    pub fn build(shapes: &[Shape], layout: &Layout) -> Result<Self, AccelError> {
        if shapes.len() > Owner::MAX_SHAPES {
            return Err(AccelError::TooLarge { count: shapes.len() });
        }
        let found = layout.coverage.len();
        if found != 0 && found != shapes.len() {
            return Err(AccelError::CoverageLength { found, expected: shapes.len() });
        }
        let build = |ids: &[ShapeId]| build::build(shapes, layout, ids, &[]);
        // The large ones one after the other: each of them keeps all threads busy, and two would take twice the memory.
        let is_large = |ids: &[ShapeId]| build::is_large(shapes, ids);
        let small: Vec<_> =
            layout.objects.par_iter().map(|ids| (!is_large(ids)).then(|| build(ids))).collect();
        let objects =
            small.into_iter().zip(&layout.objects).map(|(tree, ids)| tree.unwrap_or_else(|| build(ids)));
        let mut accel = Self {
            world: tree::Tree::default(),
            objects: objects.collect::<Result<_, _>>()?,
            instances: layout.instances.iter().map(Placed::new).collect(),
            kernel: KernelChoice::detect(),
        };
        let mut placed = Vec::with_capacity(layout.instances.len());
        for (i, instance) in layout.instances.iter().enumerate() {
            let (object, count) = (instance.object.0, accel.objects.len());
            if object as usize >= count {
                return Err(AccelError::NoSuchObject { instance: i, object, count });
            }
            let id = InstanceId(i as u32);
            // An object without primitives places nothing.
            placed.extend(accel.instance_bounds(id).map(|b| (id, b)));
        }
        accel.world = build::build(shapes, layout, &layout.world, &placed)?;
        Ok(accel)
    }

    /// The box of an instance at every time; `None` for an empty object.
    pub(crate) fn instance_bounds(&self, id: InstanceId) -> Option<Bounds3> {
        let placed = &self.instances[id.0 as usize];
        self.objects[placed.object.0 as usize].bounds.map(|b| placed.bounds(&b))
    }

    /// A box around everything, at every time; empty for an empty scene.
    pub fn bounds(&self) -> Bounds3 {
        self.world.bounds.unwrap_or(Bounds3::EMPTY)
    }

    /// Which instructions queries use.
    pub fn instructions(&self) -> Instructions {
        match self.kernel {
            KernelChoice::Portable => Instructions::Portable,
            #[cfg(target_arch = "x86_64")]
            KernelChoice::Avx2(_) => Instructions::Avx2,
        }
    }

    /// The same structure with portable code only.
    #[must_use]
    pub fn portable(mut self) -> Self {
        self.kernel = KernelChoice::Portable;
        self
    }

    /// The nearest hit with 0 < t < `t_max`. `filter` decides about hits on shapes of [`Coverage::Tested`].
    ///
    /// Among equally near hits the one with the lowest (instance, shape, primitive) wins.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32, filter: &impl Fn(&Candidate) -> bool) -> Option<Hit> {
        traverse::nearest(self, ray, t_max, filter)
    }

    /// Whether anything that `filter` accepts lies at 0 < t < `t_max`.
    #[inline]
    pub fn occluded(&self, ray: &Ray, t_max: f32, filter: &impl Fn(&Candidate) -> bool) -> bool {
        traverse::any(self, ray, t_max, filter)
    }

    /// Differential geometry at `hit`, in render space. `shapes` are those of [`Accel::build`].
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit, shapes: &[Shape]) -> SurfacePoint {
        let shape = &shapes[hit.shape.0 as usize];
        match hit.instance {
            None => shape.surface(hit.prim, ray, &hit.prim_hit()),
            Some(id) => {
                let placed = &self.instances[id.0 as usize];
                placed.render_surface(&shape.surface(hit.prim, &placed.object_ray(ray), &hit.prim_hit()))
            }
        }
    }
}
