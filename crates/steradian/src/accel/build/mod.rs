//! From primitives to the 8-wide tree.
//!
//! In the order in which it happens: [`gather`] collects boxes, [`divide`] sorts them into a binary tree from the top down
//! (each [`part`] where [`binning`] finds it best, and [`branch`] holding what one thread makes), [`trunk`] improves its upper part,
//! [`collapse`] makes wide nodes of it as [`gathering`] chooses, and [`pack`] lays out the result.

mod binning;
mod branch;
mod collapse;
mod divide;
mod gather;
mod gathering;
mod pack;
mod part;
mod reference;
mod segments;
#[cfg(test)]
mod tests;
mod trunk;

use super::contract::{AccelError, InstanceId, Layout};
use super::pages;
use super::tree::{LANES, Node, Packet, Tree};
use crate::math::Bounds3;
use crate::shape::{Shape, ShapeId};
use reference::Reference;
use trunk::Trunk;

/// Parts of a tree that are made by one thread each, at least, where there are enough primitives for that.
const BRANCHES: usize = 1024;

/// Primitives of a branch at most, for whatever number of them in all: what fits a core's cache.
const LARGEST_BRANCH: usize = 4096;

/// Primitives of a branch at most, for however few of them in all: moving fewer is not worth it.
const SMALLEST_BRANCH: usize = 32;

/// Primitives above which all threads build one tree together, and below which different trees.
pub(super) const TOGETHER: usize = divide::SHARED;

/// Whether there are enough primitives for all threads.
pub(super) fn is_large(shapes: &[Shape], ids: &[ShapeId]) -> bool {
    let count = |id: &ShapeId| shapes.get(id.0 as usize).map_or(0, |s| s.prim_count() as usize);
    ids.iter().map(count).sum::<usize>() > TOGETHER
}

/// Packets for which memory is taken before it is known how many there will be: enough for most meshes, and to sort
/// `count` references.
fn packets_at_first(count: usize) -> usize {
    let sorting = ((count + 1) * size_of::<Reference>()).div_ceil(size_of::<Packet>());
    sorting.max(count * 7 / (6 * LANES))
}

/// Builds the tree over all primitives of the shapes `ids` and over `instances` with their boxes.
pub(super) fn build(
    shapes: &[Shape],
    layout: &Layout,
    ids: &[ShapeId],
    instances: &[(InstanceId, Bounds3)],
) -> Result<Tree, AccelError> {
    let mut references = gather::gather(shapes, ids, instances)?;
    let count = references.len();
    if count == 0 {
        return Ok(Tree { nodes: vec![Node::EMPTY], ..Tree::default() });
    }
    let grain = (count / BRANCHES).clamp(SMALLEST_BRANCH, LARGEST_BRANCH);
    // The memory of the packets, which come last, is lent until then.
    let mut packets: Vec<Packet> = pages::zeroed(packets_at_first(count));
    let spare = &mut pages::lent(&mut packets)[..count];
    let limb = divide::divide(&mut references, spare, grain);
    let trunk = Trunk::new(limb);
    let bounds = trunk.reach_of(Trunk::ROOT).bounds();
    let branches: usize = trunk.branches.iter().map(branch::Branch::heap_bytes).sum();
    let collapsed = collapse::collapse(&trunk, &references);
    drop(trunk);
    let chunks: usize = collapsed.chunks.iter().map(collapse::Chunk::heap_bytes).sum();
    let nodes: usize = collapsed.chunks.iter().map(|c| size_of_val(&c.nodes[..])).sum();
    let mut tree = pack::pack(shapes, layout, collapsed, references, packets)?;
    tree.bounds = Some(bounds);
    let references = count * size_of::<Reference>();
    // What is held at once at the end of collapsing and of packing, when the chunks' nodes are gone.
    let moments = [2 * references + branches + chunks, references + chunks - nodes + tree.heap_bytes()];
    tree.peak_bytes = moments.into_iter().max().unwrap_or(0);
    Ok(tree)
}
