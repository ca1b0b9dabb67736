//! Cells of the sphere of directions that follow the lobes, and quadrature over them.
//!
//! A fixed grid of cells pools a narrow lobe into one cell and integrates it wrongly. Here the cells are the leaves of
//! a k-d tree over (θ, φ) that splits pilot samples at their median and cuts empty margins off, so that each
//! cell holds a like share of the samples, however narrow the lobe; and each cell is integrated adaptively.

use crate::math::{LocalDir, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A cell never spans more [rad]: what no pilot sample finds is still seen.
const LARGEST: f64 = 0.3;
/// Size of the cells around beacons [rad].
const BEACON: f64 = 0.02;
/// Abscissae and weights of Gauss' three-point rule on [0, 1].
const GAUSS: [[f64; 2]; 3] =
    [[0.112_701_665_379_258_3, 5.0 / 18.0], [0.5, 8.0 / 18.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];

/// A direction in polar coordinates, in which a lobe around the pole is an analytic function.
#[derive(Clone, Copy, Debug)]
struct Angles([f64; 2]);

impl Angles {
    fn of(w: LocalDir) -> Self {
        let (x, y, z) = (f64::from(w.x), f64::from(w.y), f64::from(w.z));
        Self([x.hypot(y).atan2(z), y.atan2(x).rem_euclid(TAU)])
    }

    fn direction(self) -> LocalDir {
        let ((r, z), (y, x)) = (self.0[0].sin_cos(), self.0[1].sin_cos());
        LocalDir::new_unchecked(Vec3::new((r * x) as f32, (r * y) as f32, z as f32))
    }
}

/// A rectangle in (θ, φ).
#[derive(Clone, Copy, Debug)]
struct Cell {
    lo: [f64; 2],
    hi: [f64; 2],
}

impl Cell {
    fn extent(&self, axis: usize) -> f64 {
        self.hi[axis] - self.lo[axis]
    }

    /// Sides as arcs [rad].
    fn size(&self) -> [f64; 2] {
        let nearest_equator = FRAC_PI_2.clamp(self.lo[0], self.hi[0]);
        [self.extent(0), self.extent(1) * nearest_equator.sin()]
    }

    fn split(&self, axis: usize, at: f64) -> [Self; 2] {
        let (mut low, mut high) = (*self, *self);
        low.hi[axis] = at;
        high.lo[axis] = at;
        [low, high]
    }

    fn quarters(&self) -> [Self; 4] {
        let middle = |axis| 0.5 * (self.lo[axis] + self.hi[axis]);
        let [a, b] = self.split(0, middle(0));
        let ([a, c], [b, d]) = (a.split(1, middle(1)), b.split(1, middle(1)));
        [a, b, c, d]
    }

    fn contains(&self, a: &Angles) -> bool {
        (0..2).all(|i| self.lo[i] <= a.0[i] && a.0[i] <= self.hi[i])
    }

    /// Gauss' rule with 3 × 3 nodes over solid angle.
    fn gauss<const M: usize>(&self, f: &mut impl FnMut(LocalDir) -> [f64; M]) -> [f64; M] {
        let mut sum = [0.0; M];
        for [x, wx] in GAUSS {
            let theta = self.lo[0] + x * self.extent(0);
            for [y, wy] in GAUSS {
                let phi = self.lo[1] + y * self.extent(1);
                let weight = wx * wy * theta.sin();
                for (sum, value) in sum.iter_mut().zip(f(Angles([theta, phi]).direction())) {
                    *sum += weight * value;
                }
            }
        }
        sum.map(|s| s * self.extent(0) * self.extent(1))
    }

    /// Refines until four quarters say what the whole says, and no witness speaks of a peak that the nodes did not see.
    fn adaptive<const M: usize>(
        &self,
        f: &mut impl FnMut(LocalDir) -> [f64; M],
        whole: [f64; M],
        witnesses: &[(Angles, [f64; M])],
        absolute: f64,
        depth: u32,
        budget: &mut u32,
    ) -> [f64; M] {
        let quarters = self.quarters();
        let values = quarters.map(|q| q.gauss(f));
        let fine: [f64; M] = std::array::from_fn(|m| values.iter().map(|v| v[m]).sum());
        let settled = (0..M).all(|m| !((fine[m] - whole[m]).abs() > absolute.max(RELATIVE * fine[m].abs())));
        let size = self.size();
        let unseen = witnesses
            .iter()
            .filter(|(at, _)| self.contains(at))
            .any(|(_, value)| (0..M).any(|m| value[m] * size[0] * size[1] > PEAK * fine[m].abs() + absolute));
        if (settled && !unseen) || depth == 0 || *budget == 0 {
            return fine;
        }
        *budget -= 1;
        let mut sum = [0.0; M];
        for (quarter, value) in quarters.iter().zip(values) {
            let refined = quarter.adaptive(f, value, witnesses, 0.5 * absolute, depth - 1, budget);
            for (sum, value) in sum.iter_mut().zip(refined) {
                *sum += value;
            }
        }
        sum
    }
}

/// Accepted difference between two levels of refinement; the finer one is better by more than an order.
const RELATIVE: f64 = 4e-3;
const DEPTH: u32 = 9;
/// How far a value may exceed the mean over its cell.
const PEAK: f64 = 10.0;
/// Pilot samples of a cell at which the function is looked at.
const WITNESSES: usize = 8;
/// Most refinements of one integral: more would chase noise.
const REFINEMENTS: u32 = 8_000;

enum Node {
    Leaf(usize),
    Split { axis: usize, at: f64, children: [usize; 2] },
}

/// Cells that together cover the sphere.
pub(super) struct Partition {
    nodes: Vec<Node>,
    leaves: Vec<Cell>,
    /// The pilot samples in the order of the leaves, and where those of each leaf end.
    points: Vec<Angles>,
    ends: Vec<usize>,
    /// The coarse cell that each leaf belongs to.
    group: Vec<usize>,
    groups: usize,
}

impl Partition {
    /// Cells that hold about `per_leaf` of the pilot samples each and are small around `beacons`: directions where
    /// something may be hidden that the samples miss.
    pub(super) fn adapted(pilots: &[LocalDir], per_leaf: usize, beacons: &[LocalDir]) -> Self {
        let mut points: Vec<Angles> = pilots.iter().map(|&w| Angles::of(w)).collect();
        let beacons: Vec<Angles> = beacons.iter().map(|&w| Angles::of(w)).collect();
        let mut partition = Self {
            nodes: Vec::new(),
            leaves: Vec::new(),
            points: Vec::new(),
            ends: Vec::new(),
            group: Vec::new(),
            groups: 0,
        };
        let builder = Builder { per_leaf, per_group: (points.len() / 32).max(per_leaf), beacons };
        // The horizon is a boundary: functions jump there.
        let sphere = Cell { lo: [0.0, 0.0], hi: [PI, TAU] };
        builder.split(&mut partition, sphere, &mut points, Some((0, FRAC_PI_2)), None, 64);
        partition.points = points;
        partition
    }

    fn pilots(&self, leaf: usize) -> &[Angles] {
        let start = leaf.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[start..self.ends[leaf]]
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.leaves.len()
    }

    /// The cell that a direction lies in.
    pub(super) fn cell(&self, w: LocalDir) -> usize {
        let angles = Angles::of(w);
        // The root is the last node made.
        let mut node = self.nodes.len() - 1;
        loop {
            match self.nodes[node] {
                Node::Leaf(leaf) => return leaf,
                Node::Split { axis, at, children } => node = children[usize::from(angles.0[axis] >= at)],
            }
        }
    }

    /// Whether a cell lies above the surface.
    pub(super) fn is_above(&self, cell: usize) -> bool {
        self.leaves[cell].lo[0] < FRAC_PI_2 - 1e-9
    }

    /// Number of coarse cells, a few dozen where samples are.
    pub(super) fn groups(&self) -> usize {
        self.groups
    }

    /// The coarse cell that a cell belongs to.
    pub(super) fn group(&self, cell: usize) -> usize {
        self.group[cell]
    }

    /// Sums values of cells over the coarse cells.
    pub(super) fn grouped(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.groups];
        for (value, &group) in values.iter().zip(&self.group) {
            sums[group] += value;
        }
        sums
    }

    /// ∫ f dω over each cell, adaptively, for a smooth f with an integral of the order of one.
    pub(super) fn integrate<const M: usize>(
        &self,
        f: &mut impl FnMut(LocalDir) -> [f64; M],
    ) -> Vec<[f64; M]> {
        let absolute = 1e-3 / self.leaves.len() as f64;
        let mut budget = REFINEMENTS;
        self.leaves
            .iter()
            .enumerate()
            .map(|(leaf, cell)| {
                let whole = cell.gauss(f);
                let witnesses: Vec<(Angles, [f64; M])> =
                    self.pilots(leaf).iter().take(WITNESSES).map(|&at| (at, f(at.direction()))).collect();
                cell.adaptive(f, whole, &witnesses, absolute, DEPTH, &mut budget)
            })
            .collect()
    }

    /// A direction in a cell for `u` ∈ [0, 1)², and the solid angle [sr] that it stands for as the only one there.
    pub(super) fn point(&self, cell: usize, u: [f64; 2]) -> (LocalDir, f64) {
        let c = &self.leaves[cell];
        let angles = std::array::from_fn(|i| c.lo[i] + u[i] * c.extent(i));
        (Angles(angles).direction(), angles[0].sin() * c.extent(0) * c.extent(1))
    }
}

struct Builder {
    per_leaf: usize,
    per_group: usize,
    beacons: Vec<Angles>,
}

impl Builder {
    /// Makes the nodes below a cell and returns the topmost.
    fn split(
        &self,
        partition: &mut Partition,
        cell: Cell,
        points: &mut [Angles],
        forced: Option<(usize, f64)>,
        group: Option<usize>,
        depth: u32,
    ) -> usize {
        let group = group.or_else(|| {
            (points.len() <= self.per_group && forced.is_none()).then(|| {
                partition.groups += 1;
                partition.groups - 1
            })
        });
        let cut = forced.or_else(|| if depth > 0 { self.cut(&cell, points) } else { None });
        let node = if let Some((axis, at)) = cut {
            let [low, high] = cell.split(axis, at);
            let middle = partition_in_place(points, |p| p.0[axis] < at);
            let (below, above) = points.split_at_mut(middle);
            let children = [
                self.split(partition, low, below, None, group, depth - 1),
                self.split(partition, high, above, None, group, depth - 1),
            ];
            Node::Split { axis, at, children }
        } else {
            let group = group.unwrap_or_else(|| {
                partition.groups += 1;
                partition.groups - 1
            });
            partition.leaves.push(cell);
            let before = partition.ends.last().copied().unwrap_or(0);
            partition.ends.push(before + points.len());
            partition.group.push(group);
            Node::Leaf(partition.leaves.len() - 1)
        };
        partition.nodes.push(node);
        partition.nodes.len() - 1
    }

    /// Where to cut a cell; `None` for a leaf.
    fn cut(&self, cell: &Cell, points: &mut [Angles]) -> Option<(usize, f64)> {
        let size = cell.size();
        let longer = usize::from(size[1] > size[0]);
        if points.len() >= 4 {
            let mut spread = [0.0; 2];
            let mut median = [0.0; 2];
            for axis in 0..2 {
                points.sort_unstable_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
                // Stragglers do not keep a margin alive where there are many points.
                let tail = if points.len() >= 64 { points.len() / 20 } else { 0 };
                let (first, last) = (points[tail].0[axis], points[points.len() - 1 - tail].0[axis]);
                // Of a Gaussian lobe, less than 10⁻⁴ lie beyond: quadrature over a wide margin would not see them.
                let pad = 0.75 * (last - first) + 1e-6;
                let (low, high) = (first - pad - cell.lo[axis], cell.hi[axis] - last - pad);
                if low.max(high) > 0.5 * cell.extent(axis) {
                    return Some((axis, if low > high { first - pad } else { last + pad }));
                }
                spread[axis] = (last - first) * size[axis] / cell.extent(axis);
                median[axis] = points[points.len() / 2].0[axis];
            }
            let axis = usize::from(spread[1] > spread[0]);
            let inside = |at: f64| cell.lo[axis] < at && at < cell.hi[axis];
            if points.len() > self.per_leaf && spread[axis] > 1e-6 && inside(median[axis]) {
                return Some((axis, median[axis]));
            }
        }
        let watched = self.beacons.iter().any(|b| cell.contains(b));
        let largest = if watched { BEACON } else { LARGEST };
        (size[longer] > largest).then(|| (longer, 0.5 * (cell.lo[longer] + cell.hi[longer])))
    }
}

/// Moves the points that satisfy `low` to the front and returns their number.
fn partition_in_place(points: &mut [Angles], low: impl Fn(&Angles) -> bool) -> usize {
    let mut n = 0;
    for i in 0..points.len() {
        if low(&points[i]) {
            points.swap(i, n);
            n += 1;
        }
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::math::{Vec2, warp};

    fn cosine_samples(n: usize) -> Vec<LocalDir> {
        let mut rng = Pcg32::new(1, 1);
        (0..n).map(|_| warp::cosine_hemisphere(Vec2::new(rng.next_f32(), rng.next_f32()))).collect()
    }

    #[test]
    fn cells_cover_the_sphere_once() {
        let partition = Partition::adapted(&cosine_samples(4096), 16, &[LocalDir::Z]);
        let total: f64 = partition.integrate(&mut |_| [1.0]).iter().map(|v| v[0]).sum();
        assert!((total - 4.0 * PI).abs() < 1e-6, "{total}");
        for cell in 0..partition.len() {
            let (w, _) = partition.point(cell, [0.5, 0.5]);
            assert_eq!(partition.cell(w), cell);
            assert_eq!(partition.is_above(cell), w.z > 0.0);
        }
    }

    #[test]
    fn a_narrow_lobe_is_seen_among_wide_ones() {
        // Half of the samples from a lobe some milliradians wide, half from the cosine.
        let (n, axis) = (1e5_f64, LocalDir::new(Vec3::new(0.6, 0.3, 0.742)).unwrap());
        let frame = crate::math::Frame::from_z(*axis);
        let mut rng = Pcg32::new(1, 1);
        let mut pilots = cosine_samples(2048);
        pilots.extend((0..2048).map(|_| {
            let cos = rng.next_f32().powf(1.0 / (n as f32 + 1.0));
            let w = warp::uniform_cone(Vec2::new(1.0, rng.next_f32()), 1.0 - cos);
            LocalDir::new(frame.s * w.x + frame.t * w.y + frame.n * w.z).unwrap()
        }));
        let partition = Partition::adapted(&pilots, 16, &[]);
        let values = partition.integrate(&mut |w| {
            let cos = 1.0 - 0.5 * f64::from((*w - *axis).length_squared());
            let lobe = if cos > 0.0 { cos.powf(n) * (n + 1.0) / TAU } else { 0.0 };
            [0.5 * lobe + 0.5 * f64::from(w.z.max(0.0)) / PI]
        });
        let total: f64 = values.iter().map(|v| v[0]).sum();
        assert!((total - 1.0).abs() < 5e-4, "{total}");
    }

    #[test]
    fn lobes_of_any_width_integrate_to_their_closed_forms() {
        // ∫ cosⁿ over a hemisphere about an axis in it: 2π/(n + 1).
        let axis = LocalDir::new(Vec3::new(0.6, 0.3, 0.742)).unwrap();
        for n in [1.0, 30.0, 1e3, 1e5, 1e7] {
            let frame = crate::math::Frame::from_z(*axis);
            let mut rng = Pcg32::new(1, 1);
            let pilots: Vec<LocalDir> = (0..4096)
                .map(|_| {
                    let cos = rng.next_f32().powf(1.0 / (n as f32 + 1.0));
                    let w = warp::uniform_cone(Vec2::new(1.0, rng.next_f32()), 1.0 - cos);
                    LocalDir::new(frame.s * w.x + frame.t * w.y + frame.n * w.z).unwrap()
                })
                .collect();
            let partition = Partition::adapted(&pilots, 16, &[]);
            let mut evaluations = 0;
            let lobe = partition.integrate(&mut |w| {
                evaluations += 1;
                // cos² = 1 − |difference|² (1 − …/4): accurate for narrow lobes.
                let d2 = f64::from((*w - *axis).length_squared());
                let cos = 1.0 - 0.5 * d2;
                [if cos > 0.0 { cos.powf(n) } else { 0.0 }]
            });
            let total: f64 = lobe.iter().map(|v| v[0]).sum();
            let expected = TAU / (n + 1.0);
            assert!((total / expected - 1.0).abs() < 1e-3, "{n}: {total} {expected} with {evaluations}");
            assert!(evaluations < 400_000, "{n}: {evaluations}");
        }
    }
}
