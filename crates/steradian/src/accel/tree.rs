//! Memory layout of the 8-wide tree and of its leaves.

use super::bunch::Bunch;
use super::contract::InstanceId;
use crate::math::{Bounds3, Point, Vec3};
use crate::shape::watertight::{Permuted, corner_lanes};
use crate::shape::{Primitive, ShapeId};

/// Children per node.
pub(super) const WIDTH: usize = 8;

/// Triangles per packet.
pub(super) const LANES: usize = 4;

/// Deepest tree that the traversal stack can hold: a node pushes at most seven children per level.
pub(super) const MAX_DEPTH: u32 = 48;

/// Entries of the traversal stack.
pub(super) const STACK: usize = 7 * MAX_DEPTH as usize + 1;

/// An inner node: the boxes of eight children, axis by axis, and where the children are.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Rows lo.x, hi.x, lo.y, hi.y, lo.z, hi.z; vacant children have lo = +∞ and hi = −∞.
    pub(super) bounds: [[f32; WIDTH]; 6],
    pub(super) children: [Child; WIDTH],
}

/// Reference to a child, packed into 32 bits so that eight of them fit a cache line's half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(u32);

/// What a [`Child`] refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    Inner(u32),
    /// Consecutive triangle packets.
    Packets {
        first: u32,
        count: u32,
    },
    /// An entry of [`Tree::items`].
    Item(u32),
    /// An entry of [`Tree::bunches`].
    Bunch(u32),
}

impl Child {
    const LEAF: u32 = 1 << 31;
    /// Leaves without triangles.
    const OTHER: u32 = 1 << 30;
    const BUNCH: u32 = 1 << 29;
    const COUNT_BITS: u32 = 3;
    /// Limits of the encoding.
    pub(super) const MAX_PACKETS: usize = 1 << (30 - Self::COUNT_BITS);
    pub(super) const MAX_PACKETS_PER_LEAF: usize = (1 << Self::COUNT_BITS) - 1;

    pub(super) const ROOT: Self = Self(0);

    pub(super) fn inner(index: u32) -> Self {
        debug_assert!(index < Self::LEAF);
        Self(index)
    }

    pub(super) fn packets(first: u32, count: u32) -> Self {
        debug_assert!((first as usize) < Self::MAX_PACKETS && (count as usize) <= Self::MAX_PACKETS_PER_LEAF);
        Self(Self::LEAF | first << Self::COUNT_BITS | count)
    }

    pub(super) fn item(index: u32) -> Self {
        debug_assert!(index < Self::BUNCH);
        Self(Self::LEAF | Self::OTHER | index)
    }

    pub(super) fn bunch(index: u32) -> Self {
        debug_assert!(index < Self::BUNCH);
        Self(Self::LEAF | Self::OTHER | Self::BUNCH | index)
    }

    #[inline(always)]
    pub(super) fn is_inner(self) -> bool {
        self.0 & Self::LEAF == 0
    }

    /// The 32 bits as they stand on the traversal stack.
    #[inline(always)]
    pub(super) fn code(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) fn from_code(code: u32) -> Self {
        Self(code)
    }

    /// Where the node or what the leaf holds begins, as a hint only.
    #[inline(always)]
    pub(super) fn address(self, tree: &Tree) -> *const i8 {
        let node = tree.nodes.as_ptr().wrapping_add(self.0 as usize).cast();
        let first = ((self.0 & !Self::LEAF) >> Self::COUNT_BITS) as usize;
        let packet = tree.packets.as_ptr().wrapping_add(first).cast();
        if self.is_inner() {
            node
        } else if self.0 & Self::OTHER == 0 {
            packet
        } else {
            self.other_address(tree)
        }
    }

    #[inline(always)]
    fn other_address(self, tree: &Tree) -> *const i8 {
        let index = (self.0 & (Self::BUNCH - 1)) as usize;
        if self.0 & Self::BUNCH == 0 {
            tree.items.as_ptr().wrapping_add(index).cast()
        } else {
            tree.bunches.as_ptr().wrapping_add(index).cast()
        }
    }

    #[inline(always)]
    pub(super) fn target(self) -> Target {
        if self.is_inner() {
            Target::Inner(self.0)
        } else if self.0 & Self::OTHER == 0 {
            let code = self.0 & !Self::LEAF;
            Target::Packets { first: code >> Self::COUNT_BITS, count: code & ((1 << Self::COUNT_BITS) - 1) }
        } else if self.0 & Self::BUNCH == 0 {
            Target::Item(self.0 & (Self::BUNCH - 1))
        } else {
            Target::Bunch(self.0 & (Self::BUNCH - 1))
        }
    }
}

impl Node {
    pub(super) const EMPTY: Self = {
        let (hi, lo) = ([f32::NEG_INFINITY; WIDTH], [f32::INFINITY; WIDTH]);
        Self { bounds: [lo, hi, lo, hi, lo, hi], children: [Child::ROOT; WIDTH] }
    };

    pub(super) fn set(&mut self, slot: usize, b: &Bounds3, child: Child) {
        for axis in 0..3 {
            self.bounds[2 * axis][slot] = b.min[axis];
            self.bounds[2 * axis + 1][slot] = b.max[axis];
        }
        self.children[slot] = child;
    }

    /// The box of a child; `None` for a vacant slot.
    pub(super) fn child_bounds(&self, slot: usize) -> Option<Bounds3> {
        let row = |r: usize| self.bounds[r][slot];
        let b = Bounds3 {
            min: Point(Vec3::new(row(0), row(2), row(4))),
            max: Point(Vec3::new(row(1), row(3), row(5))),
        };
        (!b.is_empty()).then_some(b)
    }
}

/// Four triangles: corner by corner, axis by axis.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(16))]
pub(super) struct Packet {
    pub(super) corners: [[[f32; LANES]; 3]; 3],
    pub(super) owners: [Owner; LANES],
    pub(super) prims: [u32; LANES],
}

/// The shape of a packet's lane, and whether its hits are filtered; or nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(super) struct Owner(u32);

impl Owner {
    const TESTED: u32 = 1 << 31;
    pub(super) const MAX_SHAPES: usize = (Self::TESTED - 1) as usize;
    /// Marks an unused lane, which repeats the corners of a used one.
    pub(super) const NONE: Self = Self(u32::MAX);

    pub(super) fn new(shape: ShapeId, tested: bool) -> Self {
        Self(shape.0 | if tested { Self::TESTED } else { 0 })
    }

    #[inline(always)]
    pub(super) fn is_tested(self) -> bool {
        self.0 & Self::TESTED != 0
    }

    #[inline(always)]
    pub(super) fn shape(self) -> ShapeId {
        ShapeId(self.0 & !Self::TESTED)
    }
}

impl Packet {
    #[inline(always)]
    pub(super) fn triangle(&self, lane: usize) -> [Point; 3] {
        let c = &self.corners;
        [0, 1, 2].map(|k| Point::new(c[k][0][lane], c[k][1][lane], c[k][2][lane]))
    }

    /// The corners with their coordinates in the order of `axes`.
    #[inline(always)]
    pub(super) fn permuted_triangle(&self, lane: usize, axes: [usize; 3]) -> Permuted {
        axes.map(|axis| corner_lanes(|k| self.corners[k][axis][lane]))
    }

    pub(super) fn used_lanes(&self) -> usize {
        self.owners.iter().filter(|o| **o != Owner::NONE).count()
    }
}

/// Consecutive entries of [`Tree::items`]: the parts of curves in a [`Bunch`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Members {
    pub(super) first: u32,
    pub(super) count: u32,
}

/// Something that is intersected on its own.
#[derive(Clone, Debug)]
pub(super) enum Item {
    Prim { owner: Owner, prim: u32, primitive: Primitive },
    Instance(InstanceId),
}

/// A tree over the world or over one object.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) packets: Vec<Packet>,
    pub(super) items: Vec<Item>,
    pub(super) bunches: Vec<Bunch>,
    /// What the bunches hold, in their order.
    pub(super) members: Vec<Members>,
    pub(super) depth: u32,
    pub(super) bounds: Option<Bounds3>,
    /// Held at most while it was built, itself included.
    pub(super) peak_bytes: usize,
}

impl Tree {
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.packets[..])
            + size_of_val(&self.items[..])
            + size_of_val(&self.bunches[..])
            + size_of_val(&self.members[..])
    }
}
