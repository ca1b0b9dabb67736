//! What every shape answers with: identifiers, hits, samples, and the errors of construction.

use crate::math::{BoundedPoint, Dir, Normal, Point, Ray, SurfacePoint, Transform, Vec2};
use crate::units::{PdfArea, PdfSolidAngle};

/// Index of a shape in the scene's list of shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ShapeId(pub u32);

/// A point from which a shape is seen and towards which it is sampled.
#[derive(Clone, Copy, Debug)]
pub struct ReferencePoint {
    /// Position with its rounding bound.
    pub p: BoundedPoint,
    /// Geometric normal; `None` in a medium or for a bare point.
    pub ng: Option<Normal>,
    /// Shading normal; when present, samples are weighted by the cosine to it where a warp exists.
    pub ns: Option<Normal>,
    /// Normal of the only side from which light matters, that of an opaque surface's viewer; `None` where it is both.
    pub lit_side: Option<Normal>,
    /// Time [s].
    pub time: f32,
}

impl ReferencePoint {
    /// A bare point: in a medium, or on no surface that matters.
    pub fn free(p: Point, time: f32) -> Self {
        Self { p: BoundedPoint::exact(p), ng: None, ns: None, lit_side: None, time }
    }

    /// A point of a surface with both of its normals.
    pub fn from_surface(point: &SurfacePoint) -> Self {
        let (ng, ns) = (Some(point.ng), Some(point.shading.n));
        Self { p: point.p, ng, ns, lit_side: None, time: point.time }
    }

    /// Origin of a ray that leaves towards `w`, off the surface where there is one.
    #[inline]
    pub fn offset_origin(&self, w: crate::math::Vec3) -> Point {
        match self.ng {
            Some(n) => self.p.offset_origin(n, w),
            None => self.p.p,
        }
    }

    /// Ray that leaves in direction `w`.
    #[inline]
    pub fn spawn(&self, w: Dir) -> Ray {
        Ray { o: self.offset_origin(*w), d: *w, time: self.time }
    }

    /// Ray towards `to`, where t = 1 is the target, off both surfaces.
    #[inline]
    pub fn spawn_to(&self, to: &BoundedPoint, to_n: Option<Normal>) -> Ray {
        let o = self.offset_origin(to.p - self.p.p);
        let target = match to_n {
            Some(n) => to.offset_origin(n, o - to.p),
            None => to.p,
        };
        Ray { o, d: target - o, time: self.time }
    }
}

/// A point chosen on a shape by surface area.
#[derive(Clone, Copy, Debug)]
pub struct ShapeSample {
    /// Position with its rounding bound.
    pub p: BoundedPoint,
    /// Geometric normal, oriented as a hit there would report it.
    pub n: Normal,
    /// Surface parameters.
    pub uv: Vec2,
    /// Density per unit of area.
    pub density: PdfArea,
}

/// A point chosen on a shape by the solid angle that it subtends.
#[derive(Clone, Copy, Debug)]
pub struct ShapeSampleToward {
    /// Position with its rounding bound.
    pub p: BoundedPoint,
    /// Geometric normal, oriented as a hit there would report it.
    pub n: Normal,
    /// Surface parameters.
    pub uv: Vec2,
    /// Direction from the reference point.
    pub wi: Dir,
    /// Density per unit of solid angle at the reference point.
    pub density: PdfSolidAngle,
}

impl ShapeSample {
    /// Expresses the sample's density per solid angle at `from`; `None` when the point is seen edge-on or
    /// coincides with the reference point.
    #[inline]
    pub fn toward(&self, from: &ReferencePoint) -> Option<ShapeSampleToward> {
        let to = self.p.p - from.p.p;
        let wi = Dir::new(to)?;
        let density = self.density.to_solid_angle(to.length_squared(), self.n.dot(*wi));
        let usable = density.0.is_finite() && density.0 > 0.0;
        usable.then_some(ShapeSampleToward { p: self.p, n: self.n, uv: self.uv, wi, density })
    }
}

/// Density per solid angle at `from` of having chosen the point `hit` with `area_density`.
///
/// Zero when the conversion has no finite value (edge-on): such a point is never sampled either.
pub fn area_density_toward(
    area_density: PdfArea,
    from: &ReferencePoint,
    wi: Dir,
    hit: &SurfacePoint,
) -> PdfSolidAngle {
    let density = area_density.to_solid_angle(hit.p.p.distance_squared(from.p.p), hit.ng.dot(*wi));
    if density.0.is_finite() { density } else { PdfSolidAngle(0.0) }
}

/// Where a ray meets one primitive, in the primitive's own terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimHit {
    /// Parametric distance along the ray, in units of |d|; positive.
    pub t: f32,
    /// First coordinate: barycentric b₁, patch u, curve u, or azimuth φ [rad].
    pub u: f32,
    /// Second coordinate: barycentric b₂, patch v, curve v, or the quadric's z (disk: radius), object space.
    pub v: f32,
}

/// Which side of a shape is its outside, as the scene states it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orientation {
    /// As the shape's own definition has it.
    #[default]
    AsDefined,
    /// The other side (`ReverseOrientation`).
    Reversed,
}

impl Orientation {
    /// Whether normals derived from the shape's parametrisation are flipped: reversal XOR a mirroring transform.
    pub fn flips_normals(self, render_from_object: &Transform) -> bool {
        (self == Self::Reversed) != render_from_object.swaps_handedness()
    }
}

/// Why a shape was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A coordinate is NaN or infinite, or becomes so in render space.
    #[error("{what} {index} is not finite in render space")]
    NotFinite {
        /// What kind of datum: "vertex", "normal", ...
        what: &'static str,
        /// Its index.
        index: usize,
    },
    /// An index refers past the end of the vertices.
    #[error("face {face} refers to vertex {vertex}, but there are {count} vertices")]
    IndexOutOfRange {
        /// The face.
        face: usize,
        /// The offending index.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A per-vertex or per-face array has the wrong length.
    #[error("{what} has {found} entries, expected {expected}")]
    WrongLength {
        /// The array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The required length.
        expected: usize,
    },
    /// A scalar parameter is outside its domain.
    #[error("{name} = {value} must be {rule}")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f32,
        /// The admissible values in words.
        rule: &'static str,
    },
    /// The mesh is not a 2-manifold with boundary, which subdivision requires.
    #[error("edge ({a}, {b}) belongs to more than two faces or is traversed twice in the same sense")]
    NotManifold {
        /// First vertex of the edge.
        a: u32,
        /// Second vertex of the edge.
        b: u32,
    },
    /// More primitives than 32-bit indices can address.
    #[error("{what}: too many elements")]
    TooLarge {
        /// What overflowed.
        what: &'static str,
    },
}
