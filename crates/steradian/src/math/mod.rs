//! Points, directions, frames, transforms, warps, distributions and floating-point error bounds.
//!
//! World-space and local-space directions are different types ([`Dir`], [`LocalDir`]), so that a
//! world vector cannot enter a scattering function.

pub mod animated;
pub mod bounds;
pub mod distribution;
pub mod float;
pub mod frame;
pub mod hash;
pub mod ray;
pub mod surface;
pub mod transform;
pub mod vector;
pub mod warp;

pub use animated::AnimatedTransform;
pub use bounds::Bounds3;
pub use frame::Frame;
pub use ray::{BoundedPoint, Ray};
pub use surface::{Footprint, Shading, SurfacePoint};
pub use transform::Transform;
pub use vector::{Dir, LocalDir, Normal, Point, Vec2, Vec3};
