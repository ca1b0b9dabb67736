//! What a PLY file holds, and what can be wrong with it.

use crate::math::{Point, Vec2, Vec3};
use std::fmt;

/// A mesh as the file states it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlyMesh {
    /// Vertex positions.
    pub positions: Vec<Point>,
    /// Vertex normals, or empty.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, or empty.
    pub uvs: Vec<Vec2>,
    /// Triangles; every index is below the number of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// Quadrilaterals as bilinear patches: corners (0,0), (1,0), (0,1), (1,1), that is the file's v0 v1 v3 v2.
    pub quads: Vec<[u32; 4]>,
    /// The `face_indices` of the triangles, or empty.
    pub triangle_numbers: Vec<u32>,
    /// The `face_indices` of the quadrilaterals, or empty.
    pub quad_numbers: Vec<u32>,
}

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlyError {
    /// The first line is not `ply`.
    #[error("this is not a PLY file")]
    Signature,
    /// A line of the header, counted from 1.
    #[error("line {line} of the header: {problem}")]
    Header {
        /// Which line.
        line: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// The header does not end, or names no format or no vertices.
    #[error("the header {0}")]
    Incomplete(&'static str),
    /// The data end early, or hold something else than numbers.
    #[error("{place}: {problem}")]
    Data {
        /// Element and its index.
        place: Place,
        /// What is wrong.
        problem: String,
    },
    /// Fewer bytes than the header promises.
    #[error("the header promises {count} of element \"{element}\", more than the file has room for")]
    Count {
        /// Name of the element.
        element: String,
        /// Promised number.
        count: usize,
    },
}

/// An element of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the element.
    pub element: String,
    /// Index, counted from 0.
    pub index: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.element, self.index)
    }
}
