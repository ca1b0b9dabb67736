//! Which nodes of a binary tree become wide nodes, at the least cost of all ways.
//!
//! Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs" (2017), 3.1: C(n, i)
//! is the least cost of the subtree of n as a forest of at most i wide trees. A wide node costs its area. Leaves cost
//! the same however they are gathered and are left out.

use super::super::tree::WIDTH;

/// C(n, i) for i = 1 ... 8 in the order of i.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs([f32; WIDTH]);

impl Costs {
    pub(super) const LEAF: Self = Self([0.0; WIDTH]);

    /// Whether they are those of a leaf, or of a fork without any area, which costs as little.
    #[inline(always)]
    fn is_leaf(&self) -> bool {
        self.0[0] == 0.0
    }
}

/// How a fork is best gathered: for every number of roots that it may have, how many of them lie below its first child.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice(u32);

impl Choice {
    /// Bits per number of roots: three of how many go to the first child, and one that fewer roots are better.
    const BITS: u32 = 4;
    const FEWER: u32 = 8;

    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    pub(super) fn to_bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    fn of(self, roots: usize) -> u32 {
        self.0 >> (Self::BITS * (roots as u32 - 2)) & ((1 << Self::BITS) - 1)
    }

    /// The best for a fork over two leaves, as [`Choice::between`] finds it for every other fork.
    #[inline(always)]
    fn of_leaves(half_area: f32) -> (Self, Costs) {
        let mut costs = Costs::LEAF;
        costs.0[0] = half_area;
        // One root goes to the first child, however many there may be.
        (Self(0x0111_1111), costs)
    }

    /// The best for a fork of the given half area over two children.
    #[inline(always)]
    pub(super) fn between(half_area: f32, first: &Costs, second: &Costs) -> (Self, Costs) {
        if first.is_leaf() && second.is_leaf() {
            return Self::of_leaves(half_area);
        }
        let mut shared = [f32::INFINITY; WIDTH];
        let mut bits = 0;
        let mut least = f32::INFINITY;
        for roots in 2..=WIDTH {
            // Where no cost is finite, one root goes to the first child.
            let (mut best, mut to_first) = (first.0[0] + second.0[roots - 2], 1);
            for j in 2..roots {
                let cost = first.0[j - 1] + second.0[roots - j - 1];
                if cost < best {
                    (best, to_first) = (cost, j as u32);
                }
            }
            shared[roots - 1] = best;
            least = least.min(best);
            bits |= to_first << (Self::BITS * (roots as u32 - 2));
        }
        let mut costs = shared;
        costs[0] = half_area + least;
        for roots in 2..=WIDTH {
            if costs[roots - 2] < costs[roots - 1] {
                costs[roots - 1] = costs[roots - 2];
                bits |= Self::FEWER << (Self::BITS * (roots as u32 - 2));
            }
        }
        (Self(bits), Costs(costs))
    }

    /// How many roots below the first and the second child make the best forest of at most `roots`; `None` if the
    /// fork itself is its only root.
    #[inline(always)]
    pub(super) fn divide(self, mut roots: usize) -> Option<[usize; 2]> {
        while roots > 1 {
            let choice = self.of(roots);
            if choice & Self::FEWER == 0 {
                let first = choice as usize & 7;
                return Some([first, roots - first]);
            }
            roots -= 1;
        }
        None
    }
}

/// The children of a wide node, while it is made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Children<N> {
    nodes: [Option<N>; WIDTH],
    count: usize,
}

impl<N: Copy> Children<N> {
    fn push(&mut self, node: N) {
        self.nodes[self.count] = Some(node);
        self.count += 1;
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = N> {
        self.nodes.into_iter().flatten()
    }
}

/// A binary tree whose forks know their best choice.
pub(super) trait Binary {
    /// A node.
    type Node: Copy;

    /// The choice and the children of a fork; `None` for a leaf.
    fn fork(&self, node: Self::Node) -> Option<(Choice, [Self::Node; 2])>;

    /// The children of the wide node that `node` becomes; a leaf becomes its own only child.
    #[inline]
    fn wide_children(&self, node: Self::Node) -> Children<Self::Node> {
        let mut children = Children { nodes: [None; WIDTH], count: 0 };
        // A fork is never the best forest of up to eight roots by itself: it costs its area more than its children.
        self.forest(node, WIDTH, &mut children);
        children
    }

    /// Appends the best forest of at most `roots`.
    fn forest(&self, node: Self::Node, roots: usize, out: &mut Children<Self::Node>) {
        match self.fork(node).and_then(|(choice, kids)| Some((choice.divide(roots)?, kids))) {
            Some((roots, kids)) => {
                self.forest(kids[0], roots[0], out);
                self.forest(kids[1], roots[1], out);
            }
            None => out.push(node),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_equal_leaves_make_one_node() {
        let leaf = Costs::LEAF;
        let pair = Choice::between(1.0, &leaf, &leaf);
        let four = Choice::between(2.0, &pair.1, &pair.1);
        let eight = Choice::between(4.0, &four.1, &four.1);
        // Two roots are the fours (2 + 2); from four on, one four is replaced by its pairs and then by its leaves.
        assert_eq!(eight.1.0, [4.0, 4.0, 4.0, 3.0, 2.0, 2.0, 1.0, 0.0]);
        assert_eq!(eight.0.divide(8), Some([4, 4]));
        assert_eq!(four.0.divide(4), Some([2, 2]));
        assert_eq!(pair.0.divide(1), None);
    }

    #[test]
    fn two_leaves_are_no_special_case() {
        // A cost that is too small to change anything makes the general case of the same two leaves.
        let nearly = Costs([f32::MIN_POSITIVE; WIDTH]);
        let (special, costs) = Choice::between(3.0, &Costs::LEAF, &Costs::LEAF);
        let (general, same) = Choice::between(3.0, &nearly, &Costs::LEAF);
        assert_eq!(special.divide(WIDTH), Some([1, 7]));
        assert_eq!((special.divide(WIDTH), costs.0[0]), (general.divide(WIDTH), same.0[0]));
    }

    #[test]
    fn boxes_beyond_the_range_of_floats_are_gathered_all_the_same() {
        for area in [f32::INFINITY, f32::NAN] {
            let (_, costs) = Choice::between(area, &Costs::LEAF, &Costs::LEAF);
            let (choice, _) = Choice::between(area, &costs, &costs);
            let roots = choice.divide(WIDTH).unwrap();
            assert!(roots[0] >= 1 && roots[1] >= 1 && roots[0] + roots[1] <= WIDTH);
        }
    }
}
