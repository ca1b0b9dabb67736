//! Checks and transformations that meshes of triangles, of patches and control cages share.

use super::contract::{Orientation, ShapeError};
use crate::math::{Point, Transform, Vec2, Vec3};

/// An attribute array is either absent or complete.
pub(super) fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), ShapeError> {
    if found == 0 || found == expected {
        Ok(())
    } else {
        Err(ShapeError::WrongLength { what, found, expected })
    }
}

/// Every index refers to a vertex, and faces and vertices can be numbered with 32 bits.
pub(super) fn check_indices<const N: usize>(faces: &[[u32; N]], count: usize) -> Result<(), ShapeError> {
    if u32::try_from(faces.len()).is_err() || u32::try_from(count).is_err() {
        return Err(ShapeError::TooLarge { what: "mesh" });
    }
    for (face, indices) in faces.iter().enumerate() {
        if let Some(&vertex) = indices.iter().find(|&&i| i as usize >= count) {
            return Err(ShapeError::IndexOutOfRange { face, vertex, count });
        }
    }
    Ok(())
}

/// Moves positions to render space; an error when one is not finite there.
pub(super) fn transform_positions(positions: &mut [Point], t: &Transform) -> Result<(), ShapeError> {
    let identity = t.is_identity();
    for (index, p) in positions.iter_mut().enumerate() {
        if !identity {
            *p = t.point(*p);
        }
        if !p.is_finite() {
            return Err(ShapeError::NotFinite { what: "vertex", index });
        }
    }
    Ok(())
}

/// Moves normals to render space and turns them to the side that `orientation` asks for. A normal without
/// length stays zero: interpolation copes with it.
pub(super) fn transform_normals(
    normals: &mut [Vec3],
    t: &Transform,
    orientation: Orientation,
) -> Result<(), ShapeError> {
    let sign = if orientation == Orientation::Reversed { -1.0 } else { 1.0 };
    for (index, n) in normals.iter_mut().enumerate() {
        *n = t.normal_vector(*n) * sign;
        if !n.is_finite() {
            return Err(ShapeError::NotFinite { what: "normal", index });
        }
        *n = n.normalize_or_zero();
    }
    Ok(())
}

/// Texture coordinates are finite.
pub(super) fn check_uvs(uvs: &[Vec2]) -> Result<(), ShapeError> {
    match uvs.iter().position(|uv| !uv.is_finite()) {
        Some(index) => Err(ShapeError::NotFinite { what: "texture coordinate", index }),
        None => Ok(()),
    }
}
