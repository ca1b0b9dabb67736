//! The upper part of the binary tree, above the branches, improved by moving subtrees.
//!
//! Division from the top decides early about what matters most. Taking subtrees out and putting them back where they
//! enlarge the tree least (Bittner, Hapala and Havran, "Fast insertion-based optimization of bounding volume
//! hierarchies", 2013) repairs that; above the branches there are few enough nodes to try all of them.

use super::branch::{Branch, Growth};
use super::divide::Limb;
use super::gathering::{Binary, Choice, Costs};
use super::reference::Box4;
use crate::accel::tree::MAX_DEPTH;
use std::cmp::Ordering;

/// Times that all subtrees are tried, the largest first.
const PASSES: usize = 2;

/// Part of the cost by which a new place must be better, so that rounding moves nothing.
const WORTHWHILE: f32 = 1.0 - 1e-5;

/// A node of the trunk.
#[derive(Clone, Copy, Debug)]
struct Knot {
    reach: Box4,
    half_area: f32,
    /// `None` for a branch.
    children: Option<[u32; 2]>,
    /// `None` for the root.
    parent: Option<u32>,
}

/// The forks above the branches; node 0 is the root.
#[derive(Clone, Debug)]
struct Knots(Vec<Knot>);

/// The upper part of a binary tree and the branches that it holds.
#[derive(Debug)]
pub(super) struct Trunk {
    knots: Knots,
    /// The choice of a fork.
    choices: Vec<Choice>,
    /// The branch of a knot without children.
    bearers: Vec<Option<u32>>,
    pub(super) branches: Vec<Branch>,
}

/// A node of the whole binary tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Knot(u32),
    Twig { branch: u32, node: u32 },
}

impl Trunk {
    pub(super) const ROOT: Place = Place::Knot(0);

    /// Lays out a tree, moves what is better elsewhere and chooses how to gather the nodes.
    pub(super) fn new(limb: Limb) -> Self {
        let mut trunk = Self { knots: Knots(vec![]), choices: vec![], bearers: vec![], branches: vec![] };
        trunk.lay(limb, None);
        let mut moved = trunk.knots.clone();
        moved.improve();
        if trunk.depth(&moved) <= MAX_DEPTH {
            trunk.knots = moved;
        }
        trunk.choices = vec![Choice::from_bits(0); trunk.bearers.len()];
        trunk.choose(0);
        trunk
    }

    fn lay(&mut self, limb: Limb, parent: Option<u32>) -> u32 {
        let index = self.bearers.len() as u32;
        let reach = match &limb {
            Limb::Fork(fork) => fork.0.boxes,
            Limb::Branch(branch) => branch.reach(),
        };
        self.knots.0.push(Knot { reach, half_area: reach.half_area(), children: None, parent });
        self.bearers.push(None);
        match limb {
            Limb::Fork(fork) => {
                let (_, a, b) = *fork;
                let children = [self.lay(a, Some(index)), self.lay(b, Some(index))];
                self.knots.0[index as usize].children = Some(children);
            }
            Limb::Branch(branch) => {
                self.bearers[index as usize] = Some(self.branches.len() as u32);
                self.branches.push(branch);
            }
        }
        index
    }

    /// Forks on the longest way down, if the forks above the branches were these.
    fn depth(&self, knots: &Knots) -> u32 {
        let mut deepest = 0;
        let mut work = vec![(0_u32, 0_u32)];
        while let Some((node, depth)) = work.pop() {
            match (knots.0[node as usize].children, self.bearers[node as usize]) {
                (Some(children), _) => work.extend(children.map(|c| (c, depth + 1))),
                (None, Some(branch)) => deepest = deepest.max(depth + self.branches[branch as usize].depth),
                (None, None) => {}
            }
        }
        deepest
    }

    fn choose(&mut self, node: u32) -> Costs {
        let knot = self.knots.0[node as usize];
        match (knot.children, self.bearers[node as usize]) {
            (Some([a, b]), _) => {
                let (a, b) = (self.choose(a), self.choose(b));
                let (choice, costs) = Choice::between(knot.half_area, &a, &b);
                self.choices[node as usize] = choice;
                costs
            }
            (None, Some(branch)) => self.branches[branch as usize].costs,
            (None, None) => Costs::LEAF,
        }
    }

    pub(super) fn reach_of(&self, place: Place) -> Box4 {
        match place {
            Place::Knot(node) => self.knots.0[node as usize].reach,
            Place::Twig { branch, node } => self.branches[branch as usize].reach_of(node),
        }
    }

    /// The place in a branch of a knot that bears one.
    pub(super) fn settled(&self, place: Place) -> Place {
        match place {
            Place::Knot(node) => match self.bearers[node as usize] {
                Some(branch) => Place::Twig { branch, node: 0 },
                None => place,
            },
            Place::Twig { .. } => place,
        }
    }
}

impl Binary for Trunk {
    type Node = Place;

    fn fork(&self, place: Place) -> Option<(Choice, [Place; 2])> {
        match self.settled(place) {
            Place::Knot(node) => {
                let children = self.knots.0[node as usize].children?;
                Some((self.choices[node as usize], children.map(Place::Knot)))
            }
            Place::Twig { branch, node } => match self.branches[branch as usize].growth(node) {
                Growth::Fork { choice, children } => {
                    Some((choice, children.map(|node| Place::Twig { branch, node })))
                }
                Growth::Leaf { .. } => None,
            },
        }
    }
}

impl Knots {
    /// Moves every subtree to where it enlarges the boxes above it least.
    fn improve(&mut self) {
        let mut pending = Vec::new();
        for _ in 0..PASSES {
            let mut order: Vec<u32> = (1..self.0.len() as u32).collect();
            let area = |i: u32| self.0[i as usize].half_area;
            order.sort_unstable_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
            let mut moved = false;
            for subtree in order {
                moved |= self.reinsert(subtree, &mut pending) == Some(Ordering::Less);
            }
            if !moved {
                break;
            }
        }
    }

    /// Takes a subtree out and puts it where it is cheapest: `Less` where that is cheaper than where it was. `None`
    /// for children of the root, which have no place to leave.
    fn reinsert(&mut self, subtree: u32, pending: &mut Vec<(u32, f32)>) -> Option<Ordering> {
        let parent = self.0[subtree as usize].parent?;
        let grandparent = self.0[parent as usize].parent?;
        let sibling = self.0[parent as usize].children?.into_iter().find(|&c| c != subtree)?;
        self.replace(grandparent, parent, sibling);
        self.refit(Some(grandparent));
        let place = self.cheapest_place(subtree, sibling, pending);
        let above = self.0[place as usize].parent?;
        self.replace(above, place, parent);
        self.0[parent as usize].children = Some([subtree, place]);
        self.0[place as usize].parent = Some(parent);
        self.refit(Some(parent));
        Some(if place == sibling { Ordering::Equal } else { Ordering::Less })
    }

    /// Lets `new` be the child of `parent` in place of `old`.
    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        if let Some(children) = &mut self.0[parent as usize].children {
            *children = children.map(|c| if c == old { new } else { c });
        }
        self.0[new as usize].parent = Some(parent);
    }

    fn refit(&mut self, mut node: Option<u32>) {
        while let Some(i) = node {
            let knot = &self.0[i as usize];
            node = knot.parent;
            let Some([a, b]) = knot.children else { continue };
            let reach = self.0[a as usize].reach.union(self.0[b as usize].reach);
            let knot = &mut self.0[i as usize];
            (knot.reach, knot.half_area) = (reach, reach.half_area());
        }
    }

    /// The node whose sibling `subtree` becomes at the least growth of area, by branch and bound; `former` unless
    /// another is better.
    fn cheapest_place(&self, subtree: u32, former: u32, pending: &mut Vec<(u32, f32)>) -> u32 {
        let Knot { reach, half_area, .. } = self.0[subtree as usize];
        let joined = |node: u32| self.0[node as usize].reach.union(reach).half_area();
        let growth = |node: u32| joined(node) - self.0[node as usize].half_area;
        let mut least = joined(former);
        let mut above = self.0[former as usize].parent;
        while let Some(i) = above {
            least += growth(i);
            above = self.0[i as usize].parent;
        }
        least *= WORTHWHILE;
        let mut place = former;
        pending.clear();
        pending.push((0, 0.0));
        while let Some((node, inherited)) = pending.pop() {
            if inherited + half_area >= least {
                continue;
            }
            let here = inherited + joined(node);
            if here < least && node != 0 {
                (least, place) = (here, node);
            }
            let passed_on = inherited + growth(node);
            if let Some(children) = self.0[node as usize].children
                && passed_on + half_area < least
            {
                pending.extend(children.map(|c| (c, passed_on)));
            }
        }
        place
    }
}
