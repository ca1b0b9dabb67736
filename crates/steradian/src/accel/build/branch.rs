//! A branch of the binary tree: so few references that one thread makes all of it, while they are in its cache.

use super::binning::Bins;
use super::gathering::{Choice, Costs};
use super::part::Part;
use super::reference::Box4;
use glam::Vec4;

/// A node of a branch. A fork's first child is the next node.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Twig {
    lo: [f32; 3],
    /// Fork: the bits of its [`Choice`]. Leaf: its first reference.
    a: u32,
    hi: [f32; 3],
    /// Fork: its second child. Leaf: the number of references, marked.
    b: u32,
}

/// What a node of a branch is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Growth {
    Fork { choice: Choice, children: [u32; 2] },
    Leaf { first: u32, count: u32 },
}

impl Twig {
    const LEAF: u32 = 1 << 31;

    fn new(b: &Box4, a: u32, other: u32) -> Self {
        let corner = |v: Vec4| [v.x, v.y, v.z];
        Self { lo: corner(b.lo), a, hi: corner(b.hi), b: other }
    }

    pub(super) fn reach(&self) -> Box4 {
        let corner = |[x, y, z]: [f32; 3]| Vec4::new(x, y, z, 0.0);
        Box4 { lo: corner(self.lo), hi: corner(self.hi) }
    }
}

/// All nodes below one, itself first, parents before children.
#[derive(Debug)]
pub(super) struct Branch {
    twigs: Box<[Twig]>,
    /// What the whole costs in wide nodes.
    pub(super) costs: Costs,
    /// Forks on the longest way down.
    pub(super) depth: u32,
}

impl Branch {
    pub(super) fn reach(&self) -> Box4 {
        self.twigs.first().map_or(Box4::EMPTY, Twig::reach)
    }

    pub(super) fn reach_of(&self, node: u32) -> Box4 {
        self.twigs[node as usize].reach()
    }

    #[inline(always)]
    pub(super) fn growth(&self, node: u32) -> Growth {
        let t = &self.twigs[node as usize];
        if t.b & Twig::LEAF != 0 {
            Growth::Leaf { first: t.a, count: t.b & !Twig::LEAF }
        } else {
            Growth::Fork { choice: Choice::from_bits(t.a), children: [node + 1, t.b] }
        }
    }

    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.twigs[..])
    }
}

/// A branch that is being made.
#[derive(Debug)]
pub(super) struct Grower<'a> {
    twigs: Vec<Twig>,
    bins: &'a mut Bins,
    depth: u32,
}

impl Grower<'_> {
    /// The tree below `part`.
    pub(super) fn grow(part: Part<'_>, bins: &mut Bins) -> Branch {
        let mut grower = Grower { twigs: Vec::with_capacity(part.references.len() * 3 / 4), bins, depth: 0 };
        let costs = grower.node(part, 0);
        Branch { twigs: grower.twigs.into_boxed_slice(), costs, depth: grower.depth }
    }

    fn node(&mut self, part: Part<'_>, depth: u32) -> Costs {
        let reach = part.extent.boxes;
        let index = self.twigs.len();
        if part.is_leaf() {
            let count = part.references.len() as u32;
            self.twigs.push(Twig::new(&reach, part.first, Twig::LEAF | count));
            self.depth = self.depth.max(depth);
            return Costs::LEAF;
        }
        self.twigs.push(Twig::new(&reach, 0, 0));
        let (a, b) = part.split(self.bins);
        let first = self.node(a, depth + 1);
        let second = self.twigs.len() as u32;
        let (choice, costs) = Choice::between(reach.half_area(), &first, &self.node(b, depth + 1));
        let twig = &mut self.twigs[index];
        (twig.a, twig.b) = (choice.to_bits(), second);
        costs
    }
}
