//! Checks of a built structure, for tests and for reports.

use super::build;
use super::structure::Accel;
use super::tree::{Child, Item, LANES, Members, Owner, Packet, Target, Tree};
use crate::math::Bounds3;

/// What a structure consists of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AccelStats {
    /// Inner nodes.
    pub nodes: usize,
    /// Triangles.
    pub triangles: usize,
    /// Packets of four triangles, not all of them full.
    pub packets: usize,
    /// Quadrics, patches and curve segments.
    pub other_prims: usize,
    /// Instances.
    pub instances: usize,
    /// Levels of the deepest tree.
    pub depth: u32,
    /// Bytes on the heap, the structure's own copies of the geometry included.
    pub heap_bytes: usize,
    /// Of these, in inner nodes.
    pub node_bytes: usize,
    /// Of these, in packets of triangles.
    pub packet_bytes: usize,
    /// Bytes that were held at once while building, itself included and the shapes not: a bound, from the sizes of
    /// what the builder keeps at each stage.
    pub peak_bytes: usize,
}

/// A broken invariant of the structure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// A child or primitive reaches out of the box that its parent holds for it.
    #[error("tree {tree}, node {node}, child {slot}: content reaches out of its box")]
    NotContained {
        /// 0: the world; i + 1: object i.
        tree: usize,
        /// The node.
        node: usize,
        /// The child.
        slot: usize,
    },
    /// A node or leaf is referred to more than once, or never.
    #[error("tree {tree}: {what} {index} is referred to {times} times")]
    References {
        /// 0: the world; i + 1: object i.
        tree: usize,
        /// What kind of element.
        what: &'static str,
        /// Its index.
        index: usize,
        /// How often.
        times: usize,
    },
}

impl Accel {
    /// Counts and memory.
    pub fn stats(&self) -> AccelStats {
        let mut total = AccelStats {
            heap_bytes: size_of_val(&self.instances[..]) + size_of_val(&self.objects[..]),
            ..AccelStats::default()
        };
        for tree in std::iter::once(&self.world).chain(&self.objects) {
            total.nodes += tree.nodes.len();
            total.packets += tree.packets.len();
            total.triangles += tree.packets.iter().map(Packet::used_lanes).sum::<usize>();
            for item in &tree.items {
                match item {
                    Item::Prim { .. } => total.other_prims += 1,
                    Item::Instance(_) => total.instances += 1,
                }
            }
            total.depth = total.depth.max(tree.depth);
            total.heap_bytes += tree.heap_bytes();
            total.node_bytes += size_of_val(&tree.nodes[..]);
            total.packet_bytes += size_of_val(&tree.packets[..]);
        }
        total.peak_bytes = total.heap_bytes + self.building_bytes();
        total
    }

    /// Bytes beyond the finished trees that were held at once: the world comes last, large objects are built one after
    /// the other, small ones perhaps all together.
    fn building_bytes(&self) -> usize {
        let passing = |tree: &Tree| tree.peak_bytes.saturating_sub(tree.heap_bytes());
        let (large, small): (Vec<&Tree>, Vec<&Tree>) =
            self.objects.iter().partition(|tree| tree.packets.len() > build::TOGETHER / LANES);
        let alone = large.into_iter().chain([&self.world]).map(passing).max().unwrap_or(0);
        alone.max(small.into_iter().map(passing).sum())
    }

    /// Checks that every element is referred to exactly once and that boxes contain what is below them.
    pub fn validate(&self) -> Result<AccelStats, Vec<Violation>> {
        let mut violations = Vec::new();
        for (index, tree) in std::iter::once(&self.world).chain(&self.objects).enumerate() {
            self.check_tree(index, tree, &mut violations);
        }
        if violations.is_empty() { Ok(self.stats()) } else { Err(violations) }
    }

    fn check_tree(&self, index: usize, tree: &Tree, violations: &mut Vec<Violation>) {
        let mut nodes = vec![0_usize; tree.nodes.len()];
        let mut packets = vec![0_usize; tree.packets.len()];
        let mut items = vec![0_usize; tree.items.len()];
        nodes[0] = 1;
        for (i, node) in tree.nodes.iter().enumerate() {
            for slot in 0..super::tree::WIDTH {
                let Some(b) = node.child_bounds(slot) else { continue };
                let content = self.content(tree, node.children[slot], &mut nodes, &mut packets, &mut items);
                if content.union(b) != b {
                    violations.push(Violation::NotContained { tree: index, node: i, slot });
                }
            }
        }
        for (what, counts) in [("node", nodes), ("packet", packets), ("item", items)] {
            for (i, &times) in counts.iter().enumerate().filter(|(_, n)| **n != 1) {
                violations.push(Violation::References { tree: index, what, index: i, times });
            }
        }
    }

    /// The box of what a child refers to, counting the references.
    fn content(
        &self,
        tree: &Tree,
        child: Child,
        nodes: &mut [usize],
        packets: &mut [usize],
        items: &mut [usize],
    ) -> Bounds3 {
        let mut b = Bounds3::EMPTY;
        let held = match child.target() {
            Target::Inner(i) => {
                nodes[i as usize] += 1;
                let n = &tree.nodes[i as usize];
                return (0..super::tree::WIDTH).filter_map(|s| n.child_bounds(s)).fold(b, Bounds3::union);
            }
            Target::Packets { first, count } => {
                for k in first..first + count {
                    packets[k as usize] += 1;
                    let p = &tree.packets[k as usize];
                    for lane in (0..LANES).filter(|&l| p.owners[l] != Owner::NONE) {
                        b = b.union(Bounds3::from_points(p.triangle(lane)));
                    }
                }
                return b;
            }
            Target::Item(first) => Members { first, count: 1 },
            Target::Bunch(i) => tree.members[i as usize],
        };
        for k in held.first..held.first + held.count {
            items[k as usize] += 1;
            b = b.union(match &tree.items[k as usize] {
                Item::Prim { primitive, .. } => primitive.bounds(),
                Item::Instance(id) => self.instance_bounds(*id).unwrap_or(Bounds3::EMPTY),
            });
        }
        b
    }
}
