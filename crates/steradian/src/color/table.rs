//! Precomputed sigmoid coefficients, for texels.

use super::space::{ColorSpace, ColorSpaceKind, clamped};
use super::triple::Rgb;
use crate::spectrum::Sigmoid;
use glam::{DVec3, Vec3A};
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Nodes along each axis.
const N: usize = 32;

/// Sigmoid coefficients over a whole RGB cube: a lookup costs tens of nanoseconds and allocates nothing.
///
/// Three slabs, one for each component that can be the largest, over (largest component, ratios of the other two to
/// it), as Jakob & Hanika 2019, section 3.3. Two deviations let 32 nodes do where the paper has 64: ratios are denser
/// toward 0 and 1, and interpolation along the largest component is linear in the sigmoid's argument for a grey of that
/// size, which is exact for greys and keeps the relative error of dark colours small.
#[derive(Clone, Debug)]
pub struct UpsamplingTable {
    magnitudes: Axis,
    ratios: Axis,
    /// By the largest component and its size; within, by the ratios of the two that follow it, the first varying fastest.
    slabs: Box<[Slab]>,
}

/// Coefficients for one size of the largest component.
type Slab = [[Vec3A; N]; N];

/// Nodes over [0, 1], found in constant time, and the coordinate in which to interpolate between them.
#[derive(Clone, Debug)]
struct Axis {
    nodes: [f32; N],
    coordinate: [f32; N],
    /// Reciprocal of the distance to the next node, in the coordinate.
    per_step: [f32; N],
    /// Last node at or before each of `GUIDES` equal parts of [0, 1].
    guide: [u8; GUIDES],
}

const GUIDES: usize = 256;

/// A place between a node and the next.
#[derive(Clone, Copy)]
struct Between {
    node: usize,
    fraction: f32,
}

impl Axis {
    fn new(nodes: [f32; N], coordinate: impl Fn(f32) -> f32) -> Self {
        let coordinate = nodes.map(coordinate);
        let per_step =
            std::array::from_fn(|i| if i + 1 < N { 1.0 / (coordinate[i + 1] - coordinate[i]) } else { 0.0 });
        let guide = std::array::from_fn(|g| {
            let start = g as f32 / GUIDES as f32;
            (nodes[1..N - 1].partition_point(|&p| p <= start)) as u8
        });
        Self { nodes, coordinate, per_step, guide }
    }

    /// Where `v` ∈ [0, 1] lies, given its own coordinate.
    #[inline]
    fn locate(&self, v: f32, coordinate: f32) -> Between {
        let mut node = usize::from(self.guide[((v * GUIDES as f32) as usize).min(GUIDES - 1)]);
        while node + 2 < N && self.nodes[node + 1] <= v {
            node += 1;
        }
        let fraction = (coordinate - self.coordinate[node]) * self.per_step[node];
        Between { node, fraction: fraction.clamp(0.0, 1.0) }
    }
}

impl UpsamplingTable {
    /// Fits the table of a colour space on all cores; some 0.15 s on one for sRGB.
    pub fn build(space: &ColorSpace) -> Self {
        let magnitudes: [f32; N] = std::array::from_fn(|i| {
            let s = smoothstep(unit(i));
            0.5 * (s + smoothstep(s))
        });
        let ratios: [f32; N] = std::array::from_fn(|i| smoothstep(unit(i)));
        let fit = |largest: usize, [x, y, z]: [usize; 3], start: DVec3| {
            // Black and white have infinite coefficients; the nearest finite greys stand in.
            let magnitude = magnitudes[z].clamp(DARKEST, BRIGHTEST);
            let mut rgb = [0.0; 3];
            rgb[largest] = magnitude;
            rgb[(largest + 1) % 3] = magnitude * ratios[x];
            rgb[(largest + 2) % 3] = magnitude * ratios[y];
            let target = space.relative_xyz(Rgb::new(rgb[0], rgb[1], rgb[2]));
            space.basis().approach(target, start)
        };
        // Neighbours start from each other, outward from grey: the coefficients of a slab are then one branch of the
        // solution, without jumps where several sets show the same colour. First the middle of each slab; from there
        // every column goes its own way.
        let middle = |largest: usize| {
            let mut middle = vec![DVec3::ZERO; N * N];
            for y in (0..N).rev() {
                for x in (0..N).rev() {
                    let start = if x + 1 < N {
                        middle[y * N + x + 1]
                    } else if y + 1 < N {
                        middle[(y + 1) * N + x]
                    } else {
                        DVec3::ZERO
                    };
                    middle[y * N + x] = fit(largest, [x, y, N / 2], start);
                }
            }
            middle
        };
        let levels = magnitudes.map(|m| f64::from(level(m)));
        let middles: Vec<Vec<DVec3>> = (0..3).into_par_iter().map(middle).collect();
        let column = |i: usize| {
            let (largest, y, x) = (i / (N * N), i / N % N, i % N);
            let middle = middles[largest][y * N + x];
            let mut column = [middle.as_vec3a(); N];
            let mut follow = |zs: &mut dyn Iterator<Item = usize>| {
                let (mut previous, mut last) = (None, (levels[N / 2], middle));
                for z in zs {
                    let start = previous.map_or(middle, |previous| continued(previous, last, levels[z]));
                    let c = fit(largest, [x, y, z], start);
                    column[z] = c.as_vec3a();
                    (previous, last) = (Some(last), (levels[z], c));
                }
            };
            follow(&mut (N / 2 + 1..N));
            follow(&mut (0..N / 2).rev());
            column
        };
        let columns: Vec<[Vec3A; N]> = (0..3 * N * N).into_par_iter().map(column).collect();
        let mut slabs = vec![[[Vec3A::ZERO; N]; N]; 3 * N].into_boxed_slice();
        for (i, column) in columns.iter().enumerate() {
            for (z, c) in column.iter().enumerate() {
                slabs[i / (N * N) * N + z][i / N % N][i % N] = *c;
            }
        }
        Self { magnitudes: Axis::new(magnitudes, level), ratios: Axis::new(ratios, |r| r), slabs }
    }

    /// The reflectance that shows `rgb`; components are clamped to [0, 1]. Greys are exact.
    pub fn sigmoid(&self, rgb: Rgb) -> Sigmoid {
        let v = clamped(rgb).0.to_array();
        if v[0] == v[1] && v[1] == v[2] {
            return Sigmoid::constant(v[0]);
        }
        let largest = if v[0] >= v[1] && v[0] >= v[2] {
            0
        } else if v[1] >= v[2] {
            1
        } else {
            2
        };
        let magnitude = v[largest];
        let [rx, ry] = [1, 2].map(|k| v[(largest + k) % 3] / magnitude);
        let z = self.magnitudes.locate(magnitude, level(magnitude));
        let (x, y) = (self.ratios.locate(rx, rx), self.ratios.locate(ry, ry));
        // Nodes end one before the last; the remainder says so to the compiler.
        let (x0, y0) = (x.node % (N - 1), y.node % (N - 1));
        let in_slab = |slab: &Slab| {
            let in_row = |row: &[Vec3A; N]| row[x0].lerp(row[x0 + 1], x.fraction);
            in_row(&slab[y0]).lerp(in_row(&slab[y0 + 1]), y.fraction)
        };
        let first = largest * N + z.node;
        let c = in_slab(&self.slabs[first]).lerp(in_slab(&self.slabs[first + 1]), z.fraction);
        Sigmoid { c0: c.x, c1: c.y, c2: c.z }
    }
}

/// The tables of all colour spaces, each fitted when it is first asked for and shared from then on: by pictures and lights,
/// and by as many scenes as are compiled with the same value. Clones share.
#[derive(Clone, Debug, Default)]
pub struct UpsamplingTables(Arc<Mutex<[Option<Arc<UpsamplingTable>>; ColorSpaceKind::ALL.len()]>>);

impl UpsamplingTables {
    /// No tables yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The table of a colour space.
    pub fn get(&self, space: &ColorSpace) -> Arc<UpsamplingTable> {
        // A table is complete once it is in its slot, whatever happened to the thread that put it there.
        let slots = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(table) = &slots()[space.kind() as usize] {
            return Arc::clone(table);
        }
        // Not under the lock: threads that help to fit may come here for another scene meanwhile.
        let table = Arc::new(UpsamplingTable::build(space));
        Arc::clone(slots()[space.kind() as usize].get_or_insert(table))
    }
}

/// Where the line through two points is at `t`.
fn continued((t0, c0): (f64, DVec3), (t1, c1): (f64, DVec3), t: f64) -> DVec3 {
    c1 + (c1 - c0) * ((t - t1) / (t1 - t0))
}

const DARKEST: f32 = 1e-5;
const BRIGHTEST: f32 = 1.0 - 1e-5;

/// Argument at which the sigmoid has the value `magnitude`.
fn level(magnitude: f32) -> f32 {
    Sigmoid::constant(magnitude.clamp(DARKEST, BRIGHTEST)).c2
}

fn unit(i: usize) -> f32 {
    i as f32 / (N - 1) as f32
}

fn smoothstep(x: f32) -> f32 {
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::super::space::ColorSpaceKind;
    use super::*;
    use crate::math::hash::Pcg32;

    /// Errors of the largest component that differs, sorted, for triples uniform in a cube of side `side`.
    fn errors(space: &ColorSpace, table: &UpsamplingTable, side: f32) -> Vec<f32> {
        let mut rng = Pcg32::new(1, 1);
        let mut errors: Vec<f32> = (0..20_000)
            .map(|_| {
                let rgb = Rgb::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * side;
                (space.shown_by(table.sigmoid(rgb)).0 - rgb.0).abs().max_element()
            })
            .collect();
        errors.sort_by(f32::total_cmp);
        errors
    }

    #[test]
    fn srgb_texels_show_their_triples() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let table = UpsamplingTable::build(&space);
        // Measured: median 6e-4, 99 % 1.1e-3, worst 2.4e-3, at a bright near-white.
        let e = errors(&space, &table, 1.0);
        assert!(
            e[e.len() / 2] < 1e-3 && e[e.len() * 99 / 100] < 2e-3 && e[e.len() - 1] < 4e-3,
            "{:?}",
            e.last()
        );
        // Dark triples keep about the same relative error.
        let e = errors(&space, &table, 0.05);
        assert!(e[e.len() / 2] < 1e-3 * 0.05 && e[e.len() * 99 / 100] < 1e-2 * 0.05, "{:?}", e.last());
    }

    #[test]
    fn lookup_is_continuous_through_grey_and_across_slabs() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let table = UpsamplingTable::build(&space);
        for i in 1..50 {
            let v = i as f32 / 50.0;
            let d = 1e-5;
            for (a, b) in [
                (Rgb::new(v, v, v), Rgb::new(v, v, v - d)),
                (Rgb::new(v, v + d, 0.3 * v), Rgb::new(v + d, v, 0.3 * v)),
                (Rgb::new(0.1 * v, v, v + d), Rgb::new(0.1 * v, v + d, v)),
            ] {
                let (a, b) = (table.sigmoid(a), table.sigmoid(b));
                for lambda in [380.0, 450.0, 520.0, 600.0, 700.0] {
                    assert!((a.at(lambda) - b.at(lambda)).abs() < 6e-3, "{v} {lambda}: {a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn any_triple_gives_a_reflectance() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let table = UpsamplingTable::build(&space);
        let odd = [0.0, 1.0, 1e-30, 0.999_999, -1.0, 2.0, f32::NAN, f32::INFINITY];
        for r in odd {
            for g in odd {
                for b in odd {
                    let s = table.sigmoid(Rgb::new(r, g, b));
                    for lambda in [360.0, 555.0, 830.0] {
                        assert!((0.0..=1.0).contains(&s.at(lambda)), "{r} {g} {b}: {s:?}");
                    }
                }
            }
        }
        assert_eq!(table.sigmoid(Rgb::new(1.0, 1.0, 1.0)).at(500.0), 1.0);
        assert_eq!(table.sigmoid(Rgb::default()).at(500.0), 0.0);
    }

    #[test]
    fn tables_of_the_wide_spaces_agree_with_direct_fits() {
        // Over the whole cube, imaginary colours included. Measured at the 90th percentile: 1.1e-3 and 3.0e-3.
        for (kind, limit) in [(ColorSpaceKind::DciP3, 2e-3), (ColorSpaceKind::Rec2020, 5e-3)] {
            let space = ColorSpace::new(kind);
            let table = UpsamplingTable::build(&space);
            let mut rng = Pcg32::new(2, 1);
            let mut differences: Vec<f32> = (0..1000)
                .map(|_| {
                    let rgb = Rgb::new(rng.next_f32(), rng.next_f32(), rng.next_f32());
                    let (a, b) = (space.shown_by(table.sigmoid(rgb)), space.shown_by(space.sigmoid(rgb)));
                    (a.0 - b.0).abs().max_element()
                })
                .collect();
            differences.sort_by(f32::total_cmp);
            assert!(differences[900] < limit, "{kind:?}: {}", differences[900]);
        }
    }
}
