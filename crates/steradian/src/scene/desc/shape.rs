//! Shapes as the scene states them, in object space.

use super::id::Id;
use super::light::AreaLightDesc;
use super::material::MaterialDesc;
use super::medium::MediumInterface;
use super::texture::FloatParam;
use super::value::FileRef;
use crate::math::{AnimatedTransform, Point, Vec2, Vec3};
use crate::scene::source::Span;

/// A shape with everything that the graphics state gave it.
#[derive(Clone, Debug)]
pub struct ShapeDesc {
    /// Geometry.
    pub kind: ShapeKind,
    /// Placement.
    pub world_from_object: AnimatedTransform,
    /// Whether normals are flipped.
    pub reverse_orientation: bool,
    /// Material.
    pub material: Id<MaterialDesc>,
    /// Emission; always `None` inside objects.
    pub area_light: Option<Id<AreaLightDesc>>,
    /// Opacity (1); a hit is ignored with probability 1 − alpha.
    pub alpha: FloatParam,
    /// Media on both sides; `None` where the shape says nothing and the medium of the ray goes on.
    pub media: Option<MediumInterface>,
    /// The directive.
    pub span: Span,
}

/// The kinds of shape; defaults in parentheses.
#[derive(Clone, Debug)]
pub enum ShapeKind {
    /// Triangles and quadrilaterals from a PLY file.
    PlyMesh {
        /// The file.
        file: FileRef,
    },
    /// Triangles.
    TriangleMesh(MeshDesc),
    /// Bilinear patches.
    BilinearMesh {
        /// Four indices a patch, in the order (0,0), (1,0), (0,1), (1,1) of (u, v).
        mesh: MeshDesc,
        /// Picture that modulates emission.
        emission: Option<FileRef>,
    },
    /// (Part of) a sphere around the origin.
    Sphere {
        /// Radius (1), > 0.
        radius: f32,
        /// Lower cut (−radius).
        z_min: f32,
        /// Upper cut (radius).
        z_max: f32,
        /// Azimuth at which it ends [degrees] (360).
        phi_max: f32,
    },
    /// (Part of) a disk perpendicular to z.
    Disk {
        /// z of the disk (0).
        height: f32,
        /// Outer radius (1), > 0.
        radius: f32,
        /// Radius of the hole (0).
        inner_radius: f32,
        /// Azimuth at which it ends [degrees] (360).
        phi_max: f32,
    },
    /// (Part of) the side of a cylinder about z.
    Cylinder {
        /// Radius (1), > 0.
        radius: f32,
        /// Lower end (−1).
        z_min: f32,
        /// Upper end (1).
        z_max: f32,
        /// Azimuth at which it ends [degrees] (360).
        phi_max: f32,
    },
    /// A swept curve.
    Curve(CurveDesc),
    /// A Loop subdivision surface.
    LoopSubdivision {
        /// Number of refinements (3).
        levels: u32,
        /// Control points.
        p: Vec<Point>,
        /// Three indices a face, each below the number of points.
        indices: Vec<u32>,
    },
}

/// Vertices and the indices that join them. Every index is below the number of points; attributes are empty
/// or as many as the points.
#[derive(Clone, Debug, Default)]
pub struct MeshDesc {
    /// Vertex indices, element by element.
    pub indices: Vec<u32>,
    /// Positions.
    pub p: Vec<Point>,
    /// Shading normals, not necessarily of unit length.
    pub n: Vec<Vec3>,
    /// Shading tangents; triangles only.
    pub s: Vec<Vec3>,
    /// Surface parameters.
    pub uv: Vec<Vec2>,
    /// A number for each element, or empty.
    pub face_indices: Vec<i32>,
}

/// A curve of several segments.
#[derive(Clone, Debug)]
pub struct CurveDesc {
    /// Control points.
    pub p: Vec<Point>,
    /// Basis (Bézier).
    pub basis: CurveBasis,
    /// Degree (3): 2 or 3.
    pub degree: u32,
    /// Cross-section (flat).
    pub kind: CurveKind,
    /// Width at both ends (1).
    pub width: [f32; 2],
    /// Normals at the segments' ends, for ribbons: one more than there are segments. Empty otherwise.
    pub n: Vec<Vec3>,
    /// log₂ of the number of pieces each segment is split into (3).
    pub split_depth: u32,
}

/// The basis of a curve's control points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveBasis {
    /// Bézier: n·degree + 1 points.
    Bezier,
    /// Uniform B-spline: at least degree + 1 points.
    BSpline,
}

/// The cross-section of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// A strip that always faces the ray.
    Flat,
    /// A strip that is shaded like a round tube.
    Cylinder,
    /// A strip with given normals.
    Ribbon,
}

/// A group of shapes that is placed by instances.
#[derive(Clone, Debug)]
pub struct ObjectDesc {
    /// Name in the scene.
    pub name: String,
    /// The shapes; their placement includes the transform in force at the definition.
    pub shapes: Vec<ShapeDesc>,
    /// The definition.
    pub span: Span,
}

/// One placement of an object: a point p of the object's shapes (in their "world") appears at
/// `world_from_instance` · p.
#[derive(Clone, Debug)]
pub struct InstanceDesc {
    /// The object.
    pub object: Id<ObjectDesc>,
    /// Placement.
    pub world_from_instance: AnimatedTransform,
    /// The directive.
    pub span: Span,
}
