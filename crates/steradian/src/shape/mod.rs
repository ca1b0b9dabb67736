//! Surfaces in render space: where rays meet them, what they look like there, and how to choose points on them.
//!
//! A shape consists of one or more primitives (triangles of a mesh, segments of a curve), numbered from 0; emitters,
//! hits and acceleration structures refer to them as (shape, primitive).

pub mod bilinear;
pub mod contract;
pub mod curve;
pub mod cylinder;
pub mod disk;
pub mod loop_subdivision;
pub mod mesh;
mod placement;
mod rounding;
pub mod sphere;
mod spherical;
#[cfg(test)]
mod tests;
mod triangle;
mod validate;
pub mod watertight;

pub use bilinear::{BilinearMesh, Patch, PatchData};
pub use contract::{
    Orientation, PrimHit, ReferencePoint, ShapeError, ShapeId, ShapeSample, ShapeSampleToward,
};
pub use curve::{Curve, CurveData, CurveSegment};
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use mesh::{MeshData, TriangleMesh};
pub use sphere::Sphere;

use crate::math::{Bounds3, Dir, Point, Ray, SurfacePoint, Vec2};
use crate::units::PdfSolidAngle;

/// A surface in render space.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Triangles with shared vertices.
    Mesh(TriangleMesh),
    /// Bilinear patches with shared vertices.
    Bilinear(BilinearMesh),
    /// A sphere or a part of one.
    Sphere(Box<Sphere>),
    /// A disk, an annulus or a sector.
    Disk(Box<Disk>),
    /// An open cylinder or a sector of one.
    Cylinder(Box<Cylinder>),
    /// A thin curve in parts.
    Curve(Curve),
}

/// One primitive with all that intersecting it takes, independent of the shape's other data.
#[derive(Clone, Debug)]
pub enum Primitive {
    /// A triangle by its corners.
    Triangle([Point; 3]),
    /// A bilinear patch by its corners.
    Patch(Patch),
    /// A sphere.
    Sphere(Box<Sphere>),
    /// A disk.
    Disk(Box<Disk>),
    /// A cylinder.
    Cylinder(Box<Cylinder>),
    /// A part of a curve.
    Segment(CurveSegment),
}

impl Primitive {
    /// Nearest intersection at 0 < t ≤ `t_max`.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        match self {
            Self::Triangle(v) => watertight::Shear::new(ray).intersect(*v, t_max),
            Self::Patch(s) => s.intersect(ray, t_max),
            Self::Sphere(s) => s.intersect(ray, t_max),
            Self::Disk(s) => s.intersect(ray, t_max),
            Self::Cylinder(s) => s.intersect(ray, t_max),
            Self::Segment(s) => s.intersect(ray, t_max),
        }
    }

    /// A box that contains the primitive.
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Triangle(v) => Bounds3::from_points(*v),
            Self::Patch(s) => s.bounds(),
            Self::Sphere(s) => s.bounds(),
            Self::Disk(s) => s.bounds(),
            Self::Cylinder(s) => s.bounds(),
            Self::Segment(s) => s.bounds(),
        }
    }
}

impl Shape {
    /// A box that contains the shape.
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Mesh(s) => s.bounds(),
            Self::Bilinear(s) => s.bounds(),
            Self::Sphere(s) => s.bounds(),
            Self::Disk(s) => s.bounds(),
            Self::Cylinder(s) => s.bounds(),
            Self::Curve(s) => s.bounds(),
        }
    }

    /// Bytes held on the heap.
    pub fn heap_bytes(&self) -> usize {
        match self {
            Self::Mesh(s) => s.heap_bytes(),
            Self::Bilinear(s) => s.heap_bytes(),
            Self::Sphere(_) => size_of::<Sphere>(),
            Self::Disk(_) => size_of::<Disk>(),
            Self::Cylinder(_) => size_of::<Cylinder>(),
            Self::Curve(s) => s.heap_bytes(),
        }
    }

    /// Number of primitives.
    pub fn prim_count(&self) -> u32 {
        match self {
            Self::Mesh(s) => s.triangle_count(),
            Self::Bilinear(s) => s.patch_count(),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => 1,
            Self::Curve(s) => s.segment_count(),
        }
    }

    /// What intersecting primitive `prim` takes.
    pub fn primitive(&self, prim: u32) -> Primitive {
        match self {
            Self::Mesh(s) => Primitive::Triangle(s.corners(prim)),
            Self::Bilinear(s) => Primitive::Patch(s.patch(prim)),
            Self::Sphere(s) => Primitive::Sphere(s.clone()),
            Self::Disk(s) => Primitive::Disk(s.clone()),
            Self::Cylinder(s) => Primitive::Cylinder(s.clone()),
            Self::Curve(s) => Primitive::Segment(s.segment(prim)),
        }
    }

    /// Differential geometry where `ray` meets primitive `prim`.
    #[inline(always)]
    pub fn surface(&self, prim: u32, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        match self {
            Self::Mesh(s) => s.surface(prim, hit, ray.time),
            _ => self.surface_of_rarer(prim, ray, hit),
        }
    }

    /// Out of line, so that meshes have the caller's loop for themselves.
    #[inline(never)]
    fn surface_of_rarer(&self, prim: u32, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        match self {
            Self::Mesh(s) => s.surface(prim, hit, ray.time),
            Self::Bilinear(s) => s.surface(prim, hit, ray.time),
            Self::Sphere(s) => s.surface(ray, hit),
            Self::Disk(s) => s.surface(ray, hit),
            Self::Cylinder(s) => s.surface(ray, hit),
            Self::Curve(s) => s.surface(prim, ray, hit),
        }
    }

    /// Area of primitive `prim` [scene units²].
    pub fn area(&self, prim: u32) -> f32 {
        match self {
            Self::Mesh(s) => s.area(prim),
            Self::Bilinear(s) => s.area(prim),
            Self::Sphere(s) => s.area(),
            Self::Disk(s) => s.area(),
            Self::Cylinder(s) => s.area(),
            Self::Curve(s) => s.area(prim),
        }
    }

    /// Chooses a point of primitive `prim` by area; `None` when it has none, and for curves, which face every ray
    /// and cannot be sampled.
    pub fn sample_area(&self, prim: u32, u: Vec2) -> Option<ShapeSample> {
        match self {
            Self::Mesh(s) => s.sample_area(prim, u),
            Self::Bilinear(s) => s.sample_area(prim, u),
            Self::Sphere(s) => s.sample_area(u),
            Self::Disk(s) => s.sample_area(u),
            Self::Cylinder(s) => s.sample_area(u),
            Self::Curve(_) => None,
        }
    }

    /// Chooses a point of primitive `prim` for a reference point, by solid angle where the shape allows it;
    /// `None` when no usable direction results.
    #[inline(always)]
    pub fn sample_toward(&self, prim: u32, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        match self {
            Self::Mesh(s) => s.sample_toward(prim, from, u),
            _ => self.sample_toward_rarer(prim, from, u),
        }
    }

    #[inline(never)]
    fn sample_toward_rarer(&self, prim: u32, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        match self {
            Self::Mesh(s) => s.sample_toward(prim, from, u),
            Self::Bilinear(s) => s.sample_toward(prim, from, u),
            Self::Sphere(s) => s.sample_toward(from, u),
            Self::Disk(s) => s.sample_toward(from, u),
            Self::Cylinder(s) => s.sample_toward(from, u),
            Self::Curve(_) => None,
        }
    }

    /// Density of [`Shape::sample_toward`] for the unit direction `wi` from `from`, which meets primitive `prim`
    /// at `hit`.
    pub fn pdf_toward(&self, prim: u32, from: &ReferencePoint, wi: Dir, hit: &SurfacePoint) -> PdfSolidAngle {
        match self {
            Self::Mesh(s) => s.pdf_toward(prim, from, wi, hit),
            Self::Bilinear(s) => s.pdf_toward(prim, from, wi, hit),
            Self::Sphere(s) => s.pdf_toward(from, wi, hit),
            Self::Disk(s) => s.pdf_toward(from, wi, hit),
            Self::Cylinder(s) => s.pdf_toward(from, wi, hit),
            Self::Curve(_) => PdfSolidAngle(0.0),
        }
    }
}
