//! What is put into an acceleration structure, and what comes out of a query.

use crate::math::AnimatedTransform;
use crate::shape::{PrimHit, ShapeId};

/// Index of a placed object in [`Layout::instances`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct InstanceId(pub u32);

/// Index of a group of shapes in [`Layout::objects`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// Whether a shape is solid everywhere or has holes that a filter decides about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coverage {
    /// Every hit counts.
    #[default]
    Opaque,
    /// Each hit is put before the query's filter (alpha textures).
    Tested,
}

/// An object placed in the world; a moving shape is an object with a single instance.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The object.
    pub object: ObjectId,
    /// Where it stands; the object's shapes are in object space instead of render space.
    pub render_from_object: AnimatedTransform,
}

/// Which shapes stand where.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// Coverage per shape, parallel to the list of shapes; empty when all are opaque.
    pub coverage: Vec<Coverage>,
    /// Shapes that stand in render space.
    pub world: Vec<ShapeId>,
    /// Groups of shapes that appear only through instances.
    pub objects: Vec<Vec<ShapeId>>,
    /// Placements of objects.
    pub instances: Vec<Instance>,
}

impl Layout {
    /// All of `count` shapes in render space, opaque, without instances.
    pub fn of_world(count: usize) -> Self {
        Self { world: (0..count as u32).map(ShapeId).collect(), ..Self::default() }
    }
}

/// Where a ray meets the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parametric distance in units of |d|.
    pub t: f32,
    /// The shape.
    pub shape: ShapeId,
    /// The primitive of the shape.
    pub prim: u32,
    /// The instance through which it was met.
    pub instance: Option<InstanceId>,
    /// First coordinate, as in [`PrimHit`].
    pub u: f32,
    /// Second coordinate, as in [`PrimHit`].
    pub v: f32,
}

/// A hit on a shape of [`Coverage::Tested`] that the filter has not accepted yet.
pub type Candidate = Hit;

impl Hit {
    /// The part that is in the primitive's own terms.
    pub fn prim_hit(&self) -> PrimHit {
        PrimHit { t: self.t, u: self.u, v: self.v }
    }

    /// Whether this hit wins over `other`: nearer, or equally near with the lower identifiers, so that the
    /// answer does not depend on the order of traversal.
    pub(super) fn precedes(&self, other: &Self) -> bool {
        let key = |h: &Self| (h.instance, h.shape, h.prim);
        self.t < other.t || (self.t == other.t && key(self) < key(other))
    }
}

/// Why an acceleration structure could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AccelError {
    /// The layout names a shape that does not exist.
    #[error("there is no shape {shape}: the scene has {count}")]
    NoSuchShape {
        /// Its index.
        shape: u32,
        /// Number of shapes.
        count: usize,
    },
    /// An instance names an object that does not exist.
    #[error("instance {instance} refers to object {object}, but there are {count}")]
    NoSuchObject {
        /// The instance.
        instance: usize,
        /// The object's index.
        object: u32,
        /// Number of objects.
        count: usize,
    },
    /// The list of coverages does not match the list of shapes.
    #[error("{found} coverages for {expected} shapes")]
    CoverageLength {
        /// Number of coverages.
        found: usize,
        /// Number of shapes.
        expected: usize,
    },
    /// A primitive's box is not finite.
    #[error("primitive {prim} of shape {shape} extends to infinity")]
    UnboundedShape {
        /// The shape.
        shape: u32,
        /// The primitive.
        prim: u32,
    },
    /// An instance's box is not finite.
    #[error("instance {instance} extends to infinity")]
    UnboundedInstance {
        /// The instance.
        instance: usize,
    },
    /// More primitives than the structure can number (2²⁷ packets of four triangles).
    #[error("{count} primitives are more than the acceleration structure can hold")]
    TooLarge {
        /// Their number.
        count: usize,
    },
}
