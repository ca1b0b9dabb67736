//! From primitives to the 8-wide tree: obvhs builds a binary tree, which is then collapsed.

use super::contract::{AccelError, Coverage, InstanceId, Layout};
use super::tree::{Child, Item, LANES, MAX_DEPTH, MixedLeaf, Node, Owner, Packet, Tree, WIDTH};
use crate::math::{Bounds3, hash};
use crate::shape::{Primitive, Shape, ShapeId};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::bvh2::{DEFAULT_MAX_STACK_DEPTH, leaf_collapser};
use obvhs::ploc::PlocBuilder;

/// One thing that a tree is built over.
#[derive(Clone, Copy, Debug)]
pub(super) enum Entry {
    Prim { shape: ShapeId, prim: u32 },
    Instance(InstanceId),
}

/// Triangles that a leaf of the binary tree may hold: one packet.
const MAX_PRIMS_PER_LEAF: u32 = LANES as u32;

/// Boxes whose half-area overflows f32 cannot be compared by area.
const MAX_EXTENT: f32 = 1e18;

/// A binary tree in the form that collapsing needs.
struct Binary {
    nodes: Vec<BinaryNode>,
    order: Vec<u32>,
}

#[derive(Clone, Copy)]
struct BinaryNode {
    bounds: Bounds3,
    /// Leaf: first position in `order`. Inner: first of two adjacent children.
    first: u32,
    /// Zero for an inner node.
    count: u32,
}

/// Collects the primitives of `shapes` with their boxes.
pub(super) fn gather(
    shapes: &[Shape],
    ids: &[ShapeId],
    entries: &mut Vec<Entry>,
    boxes: &mut Vec<Bounds3>,
) -> Result<(), AccelError> {
    for &id in ids {
        let shape =
            shapes.get(id.0 as usize).ok_or(AccelError::NoSuchShape { shape: id.0, count: shapes.len() })?;
        for prim in 0..shape.prim_count() {
            let b = shape.primitive(prim).bounds();
            if !(b.min.is_finite() && b.max.is_finite()) {
                return Err(AccelError::UnboundedShape { shape: id.0, prim });
            }
            entries.push(Entry::Prim { shape: id, prim });
            boxes.push(b);
        }
    }
    Ok(())
}

/// Builds the tree over `entries`.
pub(super) fn build(
    shapes: &[Shape],
    layout: &Layout,
    entries: &[Entry],
    boxes: &[Bounds3],
) -> Result<Tree, AccelError> {
    if entries.len() >= Child::MAX_PACKETS {
        return Err(AccelError::TooLarge { count: entries.len() });
    }
    let mut packer = Packer { shapes, layout, entries, tree: Tree::default() };
    if entries.is_empty() {
        packer.tree.nodes.push(Node::EMPTY);
        return Ok(packer.tree);
    }
    let whole = boxes.iter().fold(Bounds3::EMPTY, |a, b| a.union(*b));
    packer.tree.bounds = Some(whole);
    let comparable = whole.min.abs().max(whole.max.abs()).max_element() < MAX_EXTENT;
    if comparable && by_area(boxes).is_some_and(|b| packer.collapse(&b).is_some()) {
        return Ok(packer.tree);
    }
    // Too deep for the traversal stack (many coincident boxes) or not comparable: halve, whatever the shape.
    packer
        .collapse(&by_halving(boxes))
        .map(|()| packer.tree)
        .ok_or(AccelError::TooLarge { count: entries.len() })
}

/// PLOC with reinsertion, on one thread: the result is the same for any number of them. `None` when the tree is
/// deeper than the fixed stacks of the optimisation.
fn by_area(boxes: &[Bounds3]) -> Option<Binary> {
    let aabbs: Vec<Aabb> = boxes.iter().enumerate().map(|(i, b)| untied(i, b)).collect();
    let params = BvhBuildParams::medium_build();
    let mut bvh = PlocBuilder::with_capacity(aabbs.len()).build(
        params.ploc_search_distance,
        &aabbs,
        (0..aabbs.len() as u32).collect(),
        params.sort_precision,
        params.search_depth_threshold,
    );
    if bvh.max_depth > DEFAULT_MAX_STACK_DEPTH {
        return None;
    }
    let mut optimizer = ReinsertionOptimizer::default();
    let ratio = params.reinsertion_batch_ratio;
    optimizer.run(&mut bvh, ratio, None);
    leaf_collapser::collapse(&mut bvh, MAX_PRIMS_PER_LEAF, params.collapse_traversal_cost);
    optimizer.run(&mut bvh, ratio * params.post_collapse_reinsertion_batch_ratio_multiplier, None);
    let node = |n: &obvhs::bvh2::node::Bvh2Node| BinaryNode {
        bounds: Bounds3::EMPTY,
        first: n.first_index,
        count: n.prim_count,
    };
    let mut binary = Binary { nodes: bvh.nodes.iter().map(node).collect(), order: bvh.primitive_indices };
    binary.fit(boxes);
    Some(binary)
}

/// A box a little larger than `b` by an amount that depends on its index. Clustering merges mutually nearest
/// neighbours; among identical boxes no two need be, and it degenerates to one merge per pass.
fn untied(index: usize, b: &Bounds3) -> Aabb {
    let random = hash::to_unit(hash::mix_bits(index as u64 + 1));
    let size = b.diagonal().max_element() + 1e-2 * b.min.abs().max(b.max.abs()).max_element();
    let b = b.expand(1e-5 * size * (0.5 + random));
    Aabb::new(b.min.0.into(), b.max.0.into())
}

impl Binary {
    /// Computes the boxes of all nodes from those of the primitives.
    fn fit(&mut self, boxes: &[Bounds3]) {
        let mut preorder = vec![0];
        let mut next = 0;
        while let Some(&i) = preorder.get(next) {
            next += 1;
            let n = &self.nodes[i];
            if n.count == 0 {
                preorder.extend([n.first as usize, n.first as usize + 1]);
            }
        }
        for &i in preorder.iter().rev() {
            let n = self.nodes[i];
            let (lo, hi) = (n.first as usize, (n.first + n.count) as usize);
            self.nodes[i].bounds = if n.count == 0 {
                self.nodes[lo].bounds.union(self.nodes[lo + 1].bounds)
            } else {
                self.order[lo..hi].iter().fold(Bounds3::EMPTY, |a, &k| a.union(boxes[k as usize]))
            };
        }
    }
}

/// Halves at the median along the longest axis of the centres: depth ⌈log₂ n⌉ whatever the input.
fn by_halving(boxes: &[Bounds3]) -> Binary {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let empty = BinaryNode { bounds: Bounds3::EMPTY, first: 0, count: 0 };
    let mut nodes = vec![empty];
    let mut work = vec![(0_usize, 0_usize, boxes.len())];
    // Halved before adding, so that the centre of a box of any size is finite.
    let center = |i: u32| boxes[i as usize].min.0 * 0.5 + boxes[i as usize].max.0 * 0.5;
    while let Some((node, lo, hi)) = work.pop() {
        let range = &mut order[lo..hi];
        nodes[node].bounds = range.iter().fold(Bounds3::EMPTY, |a, &i| a.union(boxes[i as usize]));
        if range.len() <= MAX_PRIMS_PER_LEAF as usize {
            (nodes[node].first, nodes[node].count) = (lo as u32, range.len() as u32);
            continue;
        }
        let centers = Bounds3::from_points(range.iter().map(|&i| crate::math::Point(center(i))));
        let extent = centers.max.0 * 0.5 - centers.min.0 * 0.5;
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        let half = range.len() / 2;
        range.select_nth_unstable_by(half, |&a, &b| {
            center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b))
        });
        nodes[node].first = nodes.len() as u32;
        let first = nodes.len();
        nodes.extend([empty, empty]);
        work.push((first, lo, lo + half));
        work.push((first + 1, lo + half, hi));
    }
    Binary { nodes, order }
}

struct Packer<'a> {
    shapes: &'a [Shape],
    layout: &'a Layout,
    entries: &'a [Entry],
    tree: Tree,
}

impl Packer<'_> {
    /// Fills the tree from a binary one; `None` (with an empty tree) when it would be deeper than the stack allows
    /// or does not hold every entry once.
    fn collapse(&mut self, binary: &Binary) -> Option<()> {
        let bounds = self.tree.bounds;
        self.tree = Tree { bounds, ..Tree::default() };
        self.tree.nodes.push(Node::EMPTY);
        let mut work = vec![(0_usize, 0_usize, 1_u32)];
        let mut placed = vec![false; self.entries.len()];
        let mut count = 0;
        while let Some((source, target, depth)) = work.pop() {
            if depth > MAX_DEPTH {
                self.tree = Tree { bounds, ..Tree::default() };
                return None;
            }
            self.tree.depth = self.tree.depth.max(depth);
            let mut node = Node::EMPTY;
            for (slot, &kid) in opened(binary, source).iter().enumerate() {
                let b = &binary.nodes[kid];
                let child = if b.count > 0 {
                    let range = b.first as usize..(b.first + b.count) as usize;
                    let prims = &binary.order[range];
                    for &i in prims {
                        count += usize::from(!std::mem::replace(&mut placed[i as usize], true));
                    }
                    self.leaf(prims)
                } else {
                    let index = self.tree.nodes.len();
                    self.tree.nodes.push(Node::EMPTY);
                    work.push((kid, index, depth + 1));
                    Child::inner(index as u32)
                };
                node.set(slot, &b.bounds, child);
            }
            self.tree.nodes[target] = node;
        }
        (count == placed.len()).then_some(())
    }

    fn leaf(&mut self, prims: &[u32]) -> Child {
        let first_packet = self.tree.packets.len() as u32;
        let first_item = self.tree.items.len() as u32;
        let mut lanes = Vec::with_capacity(LANES);
        for &i in prims {
            match self.entries[i as usize] {
                Entry::Instance(id) => self.tree.items.push(Item::Instance(id)),
                Entry::Prim { shape, prim } => {
                    let owner = Owner::new(shape, self.is_tested(shape));
                    match self.shapes[shape.0 as usize].primitive(prim) {
                        Primitive::Triangle(corners) => lanes.push((owner, prim, corners)),
                        primitive => self.tree.items.push(Item::Prim { owner, prim, primitive }),
                    }
                }
            }
        }
        self.tree.packets.extend(lanes.chunks(LANES).map(packet));
        let packet_count = self.tree.packets.len() as u32 - first_packet;
        let item_count = self.tree.items.len() as u32 - first_item;
        if item_count == 0 && packet_count as usize <= Child::MAX_PACKETS_PER_LEAF {
            return Child::packets(first_packet, packet_count);
        }
        self.tree.mixed.push(MixedLeaf { first_packet, packet_count, first_item, item_count });
        Child::mixed(self.tree.mixed.len() as u32 - 1)
    }

    fn is_tested(&self, shape: ShapeId) -> bool {
        self.layout.coverage.get(shape.0 as usize) == Some(&Coverage::Tested)
    }
}

/// The up to eight descendants that become the children of one wide node: the child with the largest area is
/// opened until there are eight. A root that is a leaf becomes its own only child.
fn opened(binary: &Binary, source: usize) -> Vec<usize> {
    let mut kids = Vec::with_capacity(WIDTH);
    kids.push(source);
    while kids.len() < WIDTH {
        let inner = kids.iter().enumerate().filter(|(_, k)| binary.nodes[**k].count == 0);
        let largest = inner
            .max_by(|a, b| binary.nodes[*a.1].bounds.area().total_cmp(&binary.nodes[*b.1].bounds.area()));
        let Some((i, &k)) = largest else { break };
        let first = binary.nodes[k].first as usize;
        kids[i] = first;
        kids.push(first + 1);
    }
    kids
}

fn packet(lanes: &[(Owner, u32, [crate::math::Point; 3])]) -> Packet {
    let mut p = Packet { corners: [[[0.0; LANES]; 3]; 3], owners: [Owner::NONE; LANES], prims: [0; LANES] };
    for lane in 0..LANES {
        // Unused lanes repeat the last triangle: they pass the packet test only when it does.
        let (owner, prim, corners) = lanes[lane.min(lanes.len() - 1)];
        for (k, corner) in corners.iter().enumerate() {
            for axis in 0..3 {
                p.corners[k][axis][lane] = corner[axis];
            }
        }
        if lane < lanes.len() {
            (p.owners[lane], p.prims[lane]) = (owner, prim);
        }
    }
    p
}
