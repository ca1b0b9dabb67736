//! Collecting what a tree is built over.

use super::reference::{Box4, Reference, Subject};
use super::segments::Segments;
use crate::accel::contract::{AccelError, InstanceId};
use crate::accel::pages;
use crate::accel::tree::Child;
use crate::math::Bounds3;
use crate::shape::{Shape, ShapeId};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Boxes of all primitives of the shapes `ids` and of the given instances, in this order.
pub(super) fn gather(
    shapes: &[Shape],
    ids: &[ShapeId],
    instances: &[(InstanceId, Bounds3)],
) -> Result<Vec<Reference>, AccelError> {
    let missing = |id: &&ShapeId| id.0 as usize >= shapes.len();
    if let Some(id) = ids.iter().find(missing) {
        return Err(AccelError::NoSuchShape { shape: id.0, count: shapes.len() });
    }
    let shape = |list: usize| &shapes[ids[list].0 as usize];
    let counts = (0..ids.len()).map(|list| shape(list).prim_count() as usize);
    let segments = Segments::new(counts.chain([instances.len()]));
    let count = segments.total();
    if count >= Child::MAX_PACKETS || shapes.len() > Reference::MAX_SHAPES {
        return Err(AccelError::TooLarge { count });
    }
    let unbounded = AtomicBool::new(false);
    let mut references = pages::reserved(count);
    (0..count)
        .into_par_iter()
        .map_init(
            || 0,
            |hint, i| {
                let at = segments.locate(i, hint);
                let (b, subject) = match ids.get(at.list) {
                    Some(&id) => {
                        let prim = at.index as u32;
                        match shape(at.list) {
                            Shape::Mesh(s) => {
                                (Box4::around(s.corners(prim)), Subject::Triangle { shape: id, prim })
                            }
                            Shape::Curve(s) => {
                                let b = s.segment(prim).bounds();
                                (Box4::from_bounds(&b), Subject::Strand { shape: id, prim })
                            }
                            s => {
                                let b = s.primitive(prim).bounds();
                                (Box4::from_bounds(&b), Subject::Other { shape: id, prim })
                            }
                        }
                    }
                    None => {
                        let (id, b) = &instances[at.index];
                        (Box4::from_bounds(b), Subject::Instance(*id))
                    }
                };
                if !(b.lo.is_finite() && b.hi.is_finite()) {
                    unbounded.store(true, Ordering::Relaxed);
                }
                Reference::new(b, subject)
            },
        )
        .collect_into_vec(&mut references);
    if unbounded.into_inner() {
        return Err(first_unbounded(&references));
    }
    Ok(references)
}

#[cold]
fn first_unbounded(references: &[Reference]) -> AccelError {
    let finite = |r: &&Reference| r.lo.truncate().is_finite() && r.hi.truncate().is_finite();
    match references.iter().find(|r| !finite(r)).map(Reference::subject) {
        Some(
            Subject::Triangle { shape, prim }
            | Subject::Strand { shape, prim }
            | Subject::Other { shape, prim },
        ) => AccelError::UnboundedShape { shape: shape.0, prim },
        Some(Subject::Instance(id)) => AccelError::UnboundedInstance { instance: id.0 as usize },
        None => AccelError::TooLarge { count: references.len() },
    }
}
