//! A tree over emitters: chooses among many lights by what they may contribute at a point, in logarithmic time.

use super::bounds::{EmitterBounds, cost};
use crate::math::Bounds3;
use crate::math::float::ONE_MINUS_EPSILON;
use crate::shape::ReferencePoint;

/// A binary tree, nodes in depth-first order: the left child follows its parent.
#[derive(Clone, Debug)]
pub(super) struct LightTree {
    nodes: Vec<Node>,
    /// Per emitter its path from the root, one bit per level from the lowest, with a leading one; zero if it is not
    /// in the tree.
    paths: Vec<u64>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: EmitterBounds,
    next: Next,
}

#[derive(Clone, Copy, Debug)]
enum Next {
    /// Index of the right child.
    Right(u32),
    /// Index of the emitter.
    Emitter(u32),
}

/// An emitter by its index in the list that the tree was built from, and its probability.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub(super) index: u32,
    pub(super) probability: f32,
}

struct Item {
    bounds: EmitterBounds,
    index: u32,
}

/// Candidate planes along each axis.
const BUCKETS: usize = 12;
/// Longest path: deeper splits would not fit the bits.
const MAX_DEPTH: u32 = 62;

impl LightTree {
    /// A tree over the emitters with bounds; `None` when there are none.
    pub(super) fn build(emitters: &[Option<EmitterBounds>]) -> Option<Self> {
        let mut items: Vec<Item> = (0..)
            .zip(emitters)
            .filter_map(|(index, bounds)| bounds.map(|bounds| Item { bounds, index }))
            .filter(|item| item.bounds.intensity > 0.0 && item.bounds.intensity.is_finite())
            .collect();
        let mut tree = Self { nodes: Vec::with_capacity(2 * items.len()), paths: vec![0; emitters.len()] };
        if items.is_empty() {
            return None;
        }
        tree.add(&mut items, 0, 0);
        Some(tree)
    }

    /// Adds the subtree of `items` and returns its bounds.
    fn add(&mut self, items: &mut [Item], path: u64, depth: u32) -> EmitterBounds {
        let at = self.nodes.len();
        if let [item] = items {
            self.paths[item.index as usize] = path | 1 << depth;
            self.nodes.push(Node { bounds: item.bounds, next: Next::Emitter(item.index) });
            return item.bounds;
        }
        // Halving from here on reaches single emitters within 32 more levels.
        let middle = if depth + 33 > MAX_DEPTH { items.len() / 2 } else { split(items) };
        let (left, right) = items.split_at_mut(middle);
        self.nodes.push(Node { bounds: left[0].bounds, next: Next::Right(0) });
        let a = self.add(left, path, depth + 1);
        let place = self.nodes.len() as u32;
        let b = self.add(right, path | 1 << depth, depth + 1);
        let bounds = a.union(&b);
        self.nodes[at] = Node { bounds, next: Next::Right(place) };
        bounds
    }

    /// Probabilities of the two children of a node at `from`; `None` when neither contributes.
    fn shares(&self, left: usize, right: usize, from: &ReferencePoint) -> Option<[f32; 2]> {
        let a = self.nodes[left].bounds.importance(from);
        let b = self.nodes[right].bounds.importance(from);
        let sum = a + b;
        (sum > 0.0 && sum.is_finite()).then(|| [a / sum, b / sum])
    }

    /// Chooses an emitter with `u` in [0, 1); `None` when none contributes at `from` along this path.
    pub(super) fn sample(&self, from: &ReferencePoint, mut u: f32) -> Option<Leaf> {
        let mut at = 0;
        let mut probability = 1.0;
        loop {
            match self.nodes[at].next {
                Next::Emitter(index) => {
                    let alone = at == 0 && self.nodes[at].bounds.importance(from) <= 0.0;
                    return (!alone).then_some(Leaf { index, probability });
                }
                Next::Right(right) => {
                    let [a, b] = self.shares(at + 1, right as usize, from)?;
                    if u < a {
                        (at, u, probability) = (at + 1, u / a, probability * a);
                    } else {
                        (at, u, probability) = (right as usize, (u - a) / b, probability * b);
                    }
                    u = u.min(ONE_MINUS_EPSILON);
                }
            }
        }
    }

    /// Probability with which [`LightTree::sample`] chooses an emitter at `from`.
    pub(super) fn probability(&self, from: &ReferencePoint, index: usize) -> f32 {
        let Some(mut path) = self.paths.get(index).copied().filter(|&p| p != 0) else { return 0.0 };
        let mut at = 0;
        let mut probability = 1.0;
        loop {
            match self.nodes[at].next {
                Next::Emitter(_) => {
                    let alone = at == 0 && self.nodes[at].bounds.importance(from) <= 0.0;
                    return if alone { 0.0 } else { probability };
                }
                Next::Right(right) => {
                    let Some([a, b]) = self.shares(at + 1, right as usize, from) else { return 0.0 };
                    (at, probability) = if path & 1 == 0 {
                        (at + 1, probability * a)
                    } else {
                        (right as usize, probability * b)
                    };
                    path >>= 1;
                }
            }
        }
    }
}

/// Orders `items` such that those before the returned index (neither 0 nor the end) form the left child: the
/// cheapest of the bucket planes, or the median where no plane separates them.
fn split(items: &mut [Item]) -> usize {
    let centres = Bounds3::from_points(items.iter().map(|i| i.bounds.bounds.center()));
    let whole = items.iter().fold(Bounds3::EMPTY, |b, i| b.union(i.bounds.bounds)).diagonal();
    let extent = centres.diagonal();
    let bucket = |item: &Item, axis: usize| {
        let x = (item.bounds.bounds.center()[axis] - centres.min[axis]) / extent[axis];
        ((x * BUCKETS as f32) as usize).min(BUCKETS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if extent[axis] <= 0.0 {
            continue;
        }
        let mut buckets: [Option<EmitterBounds>; BUCKETS] = [None; BUCKETS];
        for item in items.iter() {
            let b = &mut buckets[bucket(item, axis)];
            *b = Some(b.map_or(item.bounds, |b| b.union(&item.bounds)));
        }
        let join = |part: &[Option<EmitterBounds>]| part.iter().flatten().copied().reduce(|a, b| a.union(&b));
        for plane in 1..BUCKETS {
            let (Some(a), Some(b)) = (join(&buckets[..plane]), join(&buckets[plane..])) else { continue };
            let cost = cost(&a, whole, axis) + cost(&b, whole, axis);
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, plane));
            }
        }
    }
    let middle = items.len() / 2;
    let Some((_, axis, plane)) = best else { return middle };
    items.sort_by_key(|item| bucket(item, axis) >= plane);
    items.partition_point(|item| bucket(item, axis) < plane)
}
