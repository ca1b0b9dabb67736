//! From the binary tree to wide nodes: the trunk first, then each branch by itself.

use super::branch::Growth;
use super::gathering::Binary;
use super::reference::{Reference, Subject};
use super::trunk::{Place, Trunk};
use crate::accel::tree::{Child, Members, Node};
use rayon::prelude::*;

/// Consecutive references that become one packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bundle {
    pub(super) first: u32,
    pub(super) count: u32,
}

/// Some wide nodes with the leaves below them, numbered from zero.
#[derive(Debug, Default)]
pub(super) struct Chunk {
    /// The first is the root.
    pub(super) nodes: Vec<Node>,
    pub(super) bundles: Vec<Bundle>,
    /// References that become items.
    pub(super) items: Vec<u32>,
    /// Items that become bunches.
    pub(super) members: Vec<Members>,
    /// Levels of nodes.
    pub(super) depth: u32,
}

impl Chunk {
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.bundles[..])
            + size_of_val(&self.items[..])
            + size_of_val(&self.members[..])
    }
}

/// A node whose child is the root of another chunk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub(super) node: usize,
    pub(super) slot: usize,
}

/// All wide nodes of a tree.
#[derive(Debug)]
pub(super) struct Collapsed {
    /// The nodes above the branches come first; the others in the order of `joints`.
    pub(super) chunks: Vec<Chunk>,
    /// Where the chunks after the first are joined to it.
    pub(super) joints: Vec<Joint>,
    pub(super) depth: u32,
}

/// Makes the wide nodes.
pub(super) fn collapse(trunk: &Trunk, references: &[Reference]) -> Collapsed {
    let maker = Maker { trunk, references };
    let (mut top, mut joints, mut tasks) = (Chunk::default(), Vec::new(), Vec::new());
    top.nodes.push(Node::EMPTY);
    let mut work = vec![(Trunk::ROOT, 0_usize, 1_u32)];
    while let Some((place, index, depth)) = work.pop() {
        top.depth = top.depth.max(depth);
        let mut node = Node::EMPTY;
        for (slot, kid) in trunk.wide_children(place).iter().enumerate() {
            let kid = trunk.settled(kid);
            let child = maker.leaf(kid, &mut top).unwrap_or_else(|| {
                if let Place::Knot(_) = kid {
                    top.nodes.push(Node::EMPTY);
                    work.push((kid, top.nodes.len() - 1, depth + 1));
                    return Child::inner(top.nodes.len() as u32 - 1);
                }
                joints.push(Joint { node: index, slot });
                tasks.push((kid, depth));
                Child::ROOT
            });
            node.set(slot, &trunk.reach_of(kid).bounds(), child);
        }
        top.nodes[index] = node;
    }
    let below: Vec<Chunk> = tasks
        .into_par_iter()
        .map(|(place, depth)| {
            let mut chunk = Chunk::default();
            maker.inner(place, depth + 1, &mut chunk);
            chunk.nodes.shrink_to_fit();
            chunk.bundles.shrink_to_fit();
            chunk
        })
        .collect();
    let depth = below.iter().map(|c| c.depth).max().unwrap_or(0).max(top.depth);
    let chunks = std::iter::once(top).chain(below).collect();
    Collapsed { chunks, joints, depth }
}

struct Maker<'a> {
    trunk: &'a Trunk,
    references: &'a [Reference],
}

impl Maker<'_> {
    /// The wide node at `place` and all below it.
    fn inner(&self, place: Place, depth: u32, chunk: &mut Chunk) -> Child {
        let index = chunk.nodes.len();
        chunk.nodes.push(Node::EMPTY);
        chunk.depth = chunk.depth.max(depth);
        let mut node = Node::EMPTY;
        for (slot, kid) in self.trunk.wide_children(place).iter().enumerate() {
            let child = self.leaf(kid, chunk).unwrap_or_else(|| self.inner(kid, depth + 1, chunk));
            node.set(slot, &self.trunk.reach_of(kid).bounds(), child);
        }
        chunk.nodes[index] = node;
        Child::inner(index as u32)
    }

    /// The leaf at `place`; `None` if a fork is there.
    fn leaf(&self, place: Place, chunk: &mut Chunk) -> Option<Child> {
        let Place::Twig { branch, node } = place else { return None };
        let Growth::Leaf { first, count } = self.trunk.branches[branch as usize].growth(node) else {
            return None;
        };
        let first_item = chunk.items.len() as u32;
        Some(match self.references[first as usize].subject() {
            Subject::Triangle { .. } => {
                chunk.bundles.push(Bundle { first, count });
                Child::packets(chunk.bundles.len() as u32 - 1, 1)
            }
            Subject::Strand { .. } => {
                chunk.items.extend(first..first + count);
                chunk.members.push(Members { first: first_item, count });
                Child::bunch(chunk.members.len() as u32 - 1)
            }
            Subject::Other { .. } | Subject::Instance(_) => {
                debug_assert!(count == 1, "other primitives lie alone");
                chunk.items.push(first);
                Child::item(first_item)
            }
        })
    }
}
