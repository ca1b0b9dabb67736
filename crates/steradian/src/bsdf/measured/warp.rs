//! Densities on the unit square that are bilinear between the nodes of a grid, and depend on parameters.
//!
//! The square is mapped onto itself by inverting the marginal distribution of the rows and then the conditional
//! one within the row, both of the *interpolated* density, so that the map is continuous (Dupuy & Jakob 2018,
//! section 4; pbrt-v4 book, 9.8, "measured BSDFs"). Between parameter nodes, densities and distributions are
//! interpolated linearly: the map remains exact for the interpolated density.

use crate::math::Vec2;
use crate::math::float::{ONE_MINUS_EPSILON, safe_sqrt};

/// A place between two nodes of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Knot {
    /// The node before.
    pub(super) index: u32,
    /// Share of the next node, in [0, 1]; the axis of one node always gives zero.
    pub(super) share: f32,
}

impl Knot {
    /// Where `x` lies among the increasing `nodes`; beyond the ends, at the end.
    pub(super) fn locate(nodes: &[f32], x: f32) -> Self {
        let Some(last) = nodes.len().checked_sub(2) else { return Self::default() };
        let index = nodes.partition_point(|&n| n < x).saturating_sub(1).min(last);
        let share = (x - nodes[index]) / (nodes[index + 1] - nodes[index]);
        Self { index: index as u32, share: unit(share) }
    }
}

/// A weighted sum of slices: the density at a place between parameter nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blend {
    slice: [u32; 4],
    weight: [f32; 4],
    used: usize,
}

impl Blend {
    /// Bilinear between the nodes of an outer and an inner parameter, of which the inner has `inner_count`.
    pub(super) fn new(outer: Knot, inner: Knot, inner_count: usize) -> Self {
        let mut blend = Self { slice: [0; 4], weight: [0.0; 4], used: 0 };
        for (i, wi) in [(0, 1.0 - outer.share), (1, outer.share)] {
            for (j, wj) in [(0, 1.0 - inner.share), (1, inner.share)] {
                // A slice without weight need not exist.
                if wi * wj > 0.0 {
                    blend.slice[blend.used] = (outer.index + i) * inner_count as u32 + inner.index + j;
                    blend.weight[blend.used] = wi * wj;
                    blend.used += 1;
                }
            }
        }
        blend
    }

    /// Of the slices with the weights given, which sum to one.
    pub(super) fn of(parts: impl IntoIterator<Item = (usize, f32)>) -> Self {
        let mut blend = Self { slice: [0; 4], weight: [0.0; 4], used: 0 };
        for (slice, weight) in parts.into_iter().filter(|p| p.1 > 0.0).take(4) {
            blend.slice[blend.used] = slice as u32;
            blend.weight[blend.used] = weight;
            blend.used += 1;
        }
        blend
    }

    /// The slices and their weights.
    pub(super) fn parts(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.slice[..self.used].iter().zip(&self.weight).map(|(&s, &w)| (s as usize, w))
    }
}

/// A place on a grid of nodes that span the unit square.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// Offset of the lower corner within a slice.
    pub(super) corner: usize,
    row: usize,
    /// Position in the patch, in [0, 1]².
    pub(super) at: Vec2,
}

/// Extents of a grid of nodes, at least 2 × 2; x is contiguous.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Grid {
    pub(super) nx: usize,
    pub(super) ny: usize,
}

impl Grid {
    /// Number of nodes.
    pub(super) fn len(self) -> usize {
        self.nx * self.ny
    }

    /// Number of patches, as a float.
    fn patches(self) -> Vec2 {
        Vec2::new((self.nx - 1) as f32, (self.ny - 1) as f32)
    }

    /// Where a point of the unit square lies; points outside move to the edge.
    pub(super) fn locate(self, p: Vec2) -> Patch {
        // In this order NaN becomes zero.
        let p = p.max(Vec2::ZERO).min(Vec2::ONE) * self.patches();
        let (x, y) = ((p.x as usize).min(self.nx - 2), (p.y as usize).min(self.ny - 2));
        Patch { corner: y * self.nx + x, row: y, at: p - Vec2::new(x as f32, y as f32) }
    }

    /// The bilinear value of a slice at `patch`.
    pub(super) fn interpolate(self, slice: &[f32], patch: &Patch) -> f32 {
        let (lower, upper) = (&slice[patch.corner..][..2], &slice[patch.corner + self.nx..][..2]);
        let (x, y) = (patch.at.x, patch.at.y);
        let (a, b) = (lower[0] + x * (lower[1] - lower[0]), upper[0] + x * (upper[1] - upper[0]));
        a + y * (b - a)
    }
}

/// A function on the unit square, bilinear between nodes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bilinear {
    pub(super) grid: Grid,
    pub(super) values: Vec<f32>,
}

impl Bilinear {
    /// The value at `p`.
    pub(super) fn at(&self, p: Vec2) -> f32 {
        self.grid.interpolate(&self.values, &self.grid.locate(p))
    }
}

/// A point of the unit square with the density at it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Warped {
    pub(super) p: Vec2,
    /// Density with respect to area on the unit square.
    pub(super) density: f32,
}

/// A family of densities on the unit square; by default, of none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Warp {
    grid: Grid,
    /// Densities at the nodes; each slice integrates to one.
    density: Vec<f32>,
    /// ∫ density dx from the left edge to the node, along each row.
    conditional: Vec<f32>,
    /// ∫∫ density dx dy from the lower edge to each row.
    marginal: Vec<f32>,
}

impl Warp {
    /// From values at the nodes of one slice after another, finite and not negative; each slice is normalised.
    ///
    /// # Errors
    /// The number of the first slice that is zero everywhere.
    pub(super) fn new(grid: Grid, mut values: Vec<f32>) -> Result<Self, usize> {
        let slices = values.len() / grid.len();
        let mut conditional = Vec::with_capacity(values.len());
        let mut marginal = Vec::with_capacity(slices * grid.ny);
        let (dx, dy) = (1.0 / (grid.nx - 1) as f64, 1.0 / (grid.ny - 1) as f64);
        let mut rows = Vec::with_capacity(grid.ny);
        for (i, slice) in values.chunks_exact_mut(grid.len()).enumerate() {
            rows.clear();
            for row in slice.chunks_exact(grid.nx) {
                rows.push(
                    row.windows(2).map(|w| 0.5 * dx * (f64::from(w[0]) + f64::from(w[1]))).sum::<f64>(),
                );
            }
            let total: f64 = rows.windows(2).map(|w| 0.5 * dy * (w[0] + w[1])).sum();
            if !(total > 0.0) {
                return Err(i);
            }
            for row in slice.chunks_exact_mut(grid.nx) {
                let mut sum = 0.0;
                conditional.push(0.0);
                for w in row.windows(2) {
                    sum += 0.5 * dx * (f64::from(w[0]) + f64::from(w[1])) / total;
                    conditional.push(sum as f32);
                }
                row.iter_mut().for_each(|v| *v = (f64::from(*v) / total) as f32);
            }
            let mut sum = 0.0;
            marginal.push(0.0);
            for w in rows.windows(2) {
                sum += 0.5 * dy * (w[0] + w[1]) / total;
                marginal.push(sum as f32);
            }
        }
        Ok(Self { grid, density: values, conditional, marginal })
    }

    /// The density at `p`.
    pub(super) fn density(&self, p: Vec2, blend: &Blend) -> f32 {
        let patch = self.grid.locate(p);
        let n = self.grid.len();
        blend.parts().map(|(s, w)| w * self.grid.interpolate(&self.density[s * n..][..n], &patch)).sum()
    }

    /// Maps uniform `u` ∈ [0, 1]² to a point with the density of the blend.
    pub(super) fn sample(&self, u: Vec2, blend: &Blend) -> Warped {
        let Grid { nx, ny } = self.grid;
        let u = u.clamp(Vec2::splat(f32::EPSILON * 0.5), Vec2::splat(ONE_MINUS_EPSILON));
        let marginal = |row| self.blended(&self.marginal, ny, row, blend);
        let row = last_below(ny, u.y, marginal);
        let ends = [self.row_end(row, blend), self.row_end(row + 1, blend)];
        let step = 1.0 / (ny - 1) as f32;
        let y = ramp_inverse((u.y - marginal(row)) / step, ends);
        let within = u.x * lerp(ends, y);
        let conditional = |x| lerp([self.running(row, x, blend), self.running(row + 1, x, blend)], y);
        let column = last_below(nx, within, conditional);
        let corner = |x, row| self.blended(&self.density, self.grid.len(), row * nx + x, blend);
        let side = |x| lerp([corner(x, row), corner(x, row + 1)], y);
        let sides = [side(column), side(column + 1)];
        let x = ramp_inverse((within - conditional(column)) * (nx - 1) as f32, sides);
        let p = Vec2::new(column as f32 + x, row as f32 + y) / self.grid.patches();
        Warped { p, density: lerp(sides, x) }
    }

    /// The point of the square that [`Warp::sample`] maps to `p`, with the density at `p`.
    pub(super) fn invert(&self, p: Vec2, blend: &Blend) -> Warped {
        let Grid { nx, ny } = self.grid;
        let patch = self.grid.locate(p);
        let (row, column, at) = (patch.row, patch.corner - patch.row * nx, patch.at);
        let corner = |i| self.blended(&self.density, self.grid.len(), i, blend);
        let side = |x| lerp([corner(patch.corner + x), corner(patch.corner + nx + x)], at.y);
        let sides = [side(0), side(1)];
        let ends = [self.row_end(row, blend), self.row_end(row + 1, blend)];
        let before = lerp([self.running(row, column, blend), self.running(row + 1, column, blend)], at.y);
        let x = before + ramp_integral(at.x, sides) / (nx - 1) as f32;
        let y = self.blended(&self.marginal, ny, row, blend) + ramp_integral(at.y, ends) / (ny - 1) as f32;
        // A row without density is never drawn; where in it a point came from is without meaning.
        let length = lerp(ends, at.y);
        let x = if length > 0.0 { (x / length).min(1.0) } else { at.x };
        Warped { p: Vec2::new(x, y.min(1.0)), density: lerp(sides, at.x) }
    }

    fn blended(&self, values: &[f32], length: usize, i: usize, blend: &Blend) -> f32 {
        blend.parts().map(|(s, w)| w * values[s * length + i]).sum()
    }

    /// ∫ density dx along a row up to node `x`.
    fn running(&self, row: usize, x: usize, blend: &Blend) -> f32 {
        self.blended(&self.conditional, self.grid.len(), row * self.grid.nx + x, blend)
    }

    fn row_end(&self, row: usize, blend: &Blend) -> f32 {
        self.running(row, self.grid.nx - 1, blend)
    }
}

/// The last of `n` nodes but one at most, whose non-decreasing `value` is below `x`; the first where there is none.
fn last_below(n: usize, x: f32, value: impl Fn(usize) -> f32) -> usize {
    let (mut low, mut high) = (0, n - 1);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if value(middle) < x {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn lerp(ends: [f32; 2], t: f32) -> f32 {
    ends[0] + t * (ends[1] - ends[0])
}

/// ∫ over [0, t] of the ramp between `ends`.
fn ramp_integral(t: f32, ends: [f32; 2]) -> f32 {
    t * (ends[0] + 0.5 * t * (ends[1] - ends[0]))
}

/// The t ∈ [0, 1] at which [`ramp_integral`] reaches `area`.
pub(super) fn ramp_inverse(area: f32, ends: [f32; 2]) -> f32 {
    let [a, b] = ends;
    // The root in the form that does not cancel where the ramp is flat: 2c / (a + √(a² + 2(b − a)c)).
    let divisor = a + safe_sqrt(a * a + 2.0 * (b - a) * area);
    let t = if divisor > 0.0 { 2.0 * area / divisor } else { 0.0 };
    unit(t)
}

/// Limits x to [0, 1]; NaN becomes zero.
fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    /// Two parameters with two nodes each; densities that vanish along edges and have a flat row.
    fn family() -> Warp {
        let grid = Grid { nx: 5, ny: 4 };
        let mut rng = Pcg32::new(3, 1);
        let mut values = Vec::new();
        for slice in 0..4 {
            for y in 0..grid.ny {
                for x in 0..grid.nx {
                    let v = if x == 0 || slice == 2 && y == 3 { 0.0 } else { 0.1 + rng.next_f32() };
                    values.push(if slice == 1 && y == 1 { 0.7 } else { v });
                }
            }
        }
        Warp::new(grid, values).unwrap()
    }

    fn blends() -> Vec<Blend> {
        let knot = |share| Knot { index: 0, share };
        [(0.0, 0.0), (0.3, 0.8), (1.0, 0.5)].map(|(a, b)| Blend::new(knot(a), knot(b), 2)).to_vec()
    }

    #[test]
    fn densities_between_parameter_nodes_integrate_to_one() {
        let warp = family();
        for blend in blends() {
            let n = 240;
            let mut sum = 0.0;
            for i in 0..n * n {
                let p = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                sum += f64::from(warp.density(p, &blend)) / f64::from(n * n);
            }
            // The midpoint rule is exact on bilinear patches that its cells do not straddle.
            assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        }
    }

    #[test]
    fn inversion_undoes_sampling_and_all_three_agree_on_the_density() {
        let warp = family();
        let mut rng = Pcg32::new(1, 1);
        for blend in blends() {
            for _ in 0..2000 {
                let u = Vec2::new(rng.next_f32(), rng.next_f32());
                let drawn = warp.sample(u, &blend);
                let back = warp.invert(drawn.p, &blend);
                assert!((back.p - u).abs().max_element() < 2e-5, "{u:?} {drawn:?} {back:?}");
                assert!((back.density - drawn.density).abs() < 1e-4 * (0.1 + drawn.density));
                assert!((warp.density(drawn.p, &blend) - drawn.density).abs() < 1e-4 * (0.1 + drawn.density));
            }
        }
    }

    #[test]
    fn the_map_stretches_area_by_the_inverse_of_the_density() {
        let warp = family();
        let h = 1e-3;
        let mut rng = Pcg32::new(2, 1);
        for blend in blends() {
            for _ in 0..300 {
                let u = Vec2::new(rng.next_f32(), rng.next_f32()).clamp(Vec2::splat(0.01), Vec2::splat(0.98));
                let at = |dx, dy| warp.sample(u + Vec2::new(dx, dy) * h, &blend);
                let (a, b, c) = (at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0));
                let area = (b.p - a.p).perp_dot(c.p - a.p) / (h * h);
                let density = warp.density(a.p + (b.p - a.p + c.p - a.p) * 0.5, &blend);
                // First differences across a patch's edge err by the change of slope.
                assert!((area * density - 1.0).abs() < 0.04, "{u:?}: {area} {density}");
            }
        }
    }

    #[test]
    fn a_slice_without_density_is_refused() {
        let grid = Grid { nx: 2, ny: 2 };
        assert_eq!(Warp::new(grid, vec![1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]).unwrap_err(), 1);
    }

    #[test]
    fn places_beyond_an_axis_are_its_ends() {
        let nodes = [1.0, 2.0, 4.0];
        assert_eq!(Knot::locate(&nodes, 0.0), Knot { index: 0, share: 0.0 });
        assert_eq!(Knot::locate(&nodes, 3.0), Knot { index: 1, share: 0.5 });
        assert_eq!(Knot::locate(&nodes, 9.0), Knot { index: 1, share: 1.0 });
        assert_eq!(Knot::locate(&[5.0], 9.0), Knot { index: 0, share: 0.0 });
    }
}
