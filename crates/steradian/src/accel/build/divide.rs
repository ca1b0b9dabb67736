//! From references to a binary tree, from the top down: whole at first, by all threads, then branch by branch.

use super::binning::Bins;
use super::branch::{Branch, Grower};
use super::part::Part;
use super::reference::{Extent, Reference};

/// References that are divided by several threads together; below, each part is the work of one.
pub(super) const SHARED: usize = 1 << 17;

/// Part of the whole area from which a part counts as wide, and the depth from which it no longer does.
const WIDE: f32 = 1.0 / 512.0;
const WIDE_DEPTH: u32 = 12;

/// The binary tree: forks down to the branches.
#[derive(Debug)]
pub(super) enum Limb {
    Fork(Box<(Extent, Limb, Limb)>),
    Branch(Branch),
}

/// Divides `references`, which end up in the order of the leaves; `spare` is room for as many. Branches have at most
/// `grain` references.
pub(super) fn divide(references: &mut [Reference], spare: &mut [Reference], grain: usize) -> Limb {
    let part = Part::whole(references, spare);
    let least_area = part.extent.boxes.half_area() * WIDE;
    limb(part, grain, least_area, &mut Bins::new())
}

fn limb(mut part: Part<'_>, grain: usize, least_area: f32, bins: &mut Bins) -> Limb {
    let count = part.references.len();
    // What few primitives cover much is above the branches, too, as far as it is not too deep: to move a wall matters.
    let is_wide = part.depth < WIDE_DEPTH && part.extent.boxes.half_area() > least_area;
    let is_done = if is_wide { part.is_leaf() && !part.gains_by_division(bins) } else { count <= grain };
    if is_done {
        part.settle();
        return Limb::Branch(Grower::grow(part, bins));
    }
    let extent = part.extent;
    let (a, b) = if count > SHARED { part.split_by_all() } else { part.split(bins) };
    // A number of tasks that grows with the work alone; rayon spreads them.
    let (a, b) = rayon::join(
        || limb(a, grain, least_area, &mut Bins::new()),
        || limb(b, grain, least_area, &mut Bins::new()),
    );
    Limb::Fork(Box::new((extent, a, b)))
}
