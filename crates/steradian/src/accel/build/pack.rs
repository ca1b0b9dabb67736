//! The tree as traversal wants it: chunks end to end, triangles copied into packets.

use super::collapse::{Bundle, Chunk, Collapsed};
use super::reference::{Reference, Subject};
use super::segments::Segments;
use crate::accel::bunch::Bunch;
use crate::accel::contract::{AccelError, Coverage, Layout};
use crate::accel::pages;
use crate::accel::tree::{Child, Item, LANES, Members, Owner, Packet, Target, Tree};
use crate::math::Point;
use crate::shape::{Primitive, Shape, ShapeId};
use rayon::prelude::*;

/// Where the elements of each chunk begin.
struct Offsets {
    nodes: Segments,
    packets: Segments,
    items: Segments,
    members: Segments,
}

impl Offsets {
    fn new(chunks: &[Chunk]) -> Self {
        Self {
            nodes: Segments::new(chunks.iter().map(|c| c.nodes.len())),
            packets: Segments::new(chunks.iter().map(|c| c.bundles.len())),
            items: Segments::new(chunks.iter().map(|c| c.items.len())),
            members: Segments::new(chunks.iter().map(|c| c.members.len())),
        }
    }

    fn rebased(&self, chunk: usize, child: Child) -> Child {
        match child.target() {
            Target::Inner(i) => Child::inner(i + self.nodes.start(chunk) as u32),
            Target::Packets { first, count } => {
                Child::packets(first + self.packets.start(chunk) as u32, count)
            }
            Target::Item(i) => Child::item(i + self.items.start(chunk) as u32),
            Target::Bunch(i) => Child::bunch(i + self.members.start(chunk) as u32),
        }
    }
}

/// Fills the tree. `collapsed` and `references` are released as soon as they have served; `room` is where the packets go,
/// if they fit.
pub(super) fn pack(
    shapes: &[Shape],
    layout: &Layout,
    mut collapsed: Collapsed,
    references: Vec<Reference>,
    room: Vec<Packet>,
) -> Result<Tree, AccelError> {
    let offsets = Offsets::new(&collapsed.chunks);
    let (nodes, packets) = (offsets.nodes.total(), offsets.packets.total());
    if nodes > Child::MAX_PACKETS || packets > Child::MAX_PACKETS {
        return Err(AccelError::TooLarge { count: references.len() });
    }
    let mut tree = Tree { nodes: pages::reserved(nodes), depth: collapsed.depth, ..Tree::default() };
    let chunks = &collapsed.chunks;
    (0..nodes)
        .into_par_iter()
        .map_init(
            || 0,
            |hint, i| {
                let at = offsets.nodes.locate(i, hint);
                let mut node = chunks[at.list].nodes[at.index];
                for (slot, child) in node.children.iter_mut().enumerate() {
                    if node.bounds[0][slot] <= node.bounds[1][slot] {
                        *child = offsets.rebased(at.list, *child);
                    }
                }
                node
            },
        )
        .collect_into_vec(&mut tree.nodes);
    for (joint, chunk) in collapsed.joints.iter().zip(1..) {
        tree.nodes[joint.node].children[joint.slot] = Child::inner(offsets.nodes.start(chunk) as u32);
    }
    collapsed.chunks.iter_mut().for_each(|c| c.nodes = Vec::new());
    let packer = Packer { shapes, layout, references: &references };
    let chunks = &collapsed.chunks;
    let mut room = if room.len() < packets {
        drop(room);
        pages::zeroed(packets)
    } else {
        room
    };
    room.truncate(packets);
    room.par_iter_mut().enumerate().for_each_init(
        || 0,
        |hint, (i, packet)| {
            let at = offsets.packets.locate(i, hint);
            *packet = packer.packet(chunks[at.list].bundles[at.index]);
        },
    );
    room.shrink_to_fit();
    tree.packets = room;
    tree.items.reserve_exact(offsets.items.total());
    tree.members.reserve_exact(offsets.members.total());
    for (i, chunk) in chunks.iter().enumerate() {
        let base = offsets.items.start(i) as u32;
        tree.items.extend(chunk.items.iter().map(|&r| packer.item(&references[r as usize])));
        tree.members.extend(chunk.members.iter().map(|m| Members { first: m.first + base, ..*m }));
    }
    let capsule = |item: &Item| match item {
        Item::Prim { primitive: Primitive::Segment(part), .. } => Some(part.capsule()),
        Item::Prim { .. } | Item::Instance(_) => None,
    };
    let bunch = |m: &Members| {
        Bunch::new(tree.items[m.first as usize..][..m.count as usize].iter().filter_map(capsule))
    };
    tree.bunches = tree.members.iter().map(bunch).collect();
    Ok(tree)
}

struct Packer<'a> {
    shapes: &'a [Shape],
    layout: &'a Layout,
    references: &'a [Reference],
}

impl Packer<'_> {
    fn owner(&self, shape: ShapeId) -> Owner {
        let tested = self.layout.coverage.get(shape.0 as usize) == Some(&Coverage::Tested);
        Owner::new(shape, tested)
    }

    fn packet(&self, bundle: Bundle) -> Packet {
        let mut p =
            Packet { corners: [[[0.0; LANES]; 3]; 3], owners: [Owner::NONE; LANES], prims: [0; LANES] };
        let references = &self.references[bundle.first as usize..][..bundle.count as usize];
        let mut last = [Point::ORIGIN; 3];
        for lane in 0..LANES {
            if let Some(Subject::Triangle { shape, prim }) = references.get(lane).map(Reference::subject) {
                (p.owners[lane], p.prims[lane]) = (self.owner(shape), prim);
                if let Shape::Mesh(mesh) = &self.shapes[shape.0 as usize] {
                    last = mesh.corners(prim);
                }
            }
            // Unused lanes repeat the last triangle: they pass the packet test only when it does.
            for (k, corner) in last.iter().enumerate() {
                for axis in 0..3 {
                    p.corners[k][axis][lane] = corner[axis];
                }
            }
        }
        p
    }

    fn item(&self, reference: &Reference) -> Item {
        match reference.subject() {
            Subject::Triangle { shape, prim }
            | Subject::Strand { shape, prim }
            | Subject::Other { shape, prim } => {
                let primitive = self.shapes[shape.0 as usize].primitive(prim);
                Item::Prim { owner: self.owner(shape), prim, primitive }
            }
            Subject::Instance(id) => Item::Instance(id),
        }
    }
}
