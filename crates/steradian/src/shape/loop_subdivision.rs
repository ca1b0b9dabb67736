//! Loop subdivision surfaces (Loop 1987, with the boundary rules of Hoppe et al. 1994), refined to triangle meshes.

use super::contract::ShapeError;
use super::mesh::MeshData;
use super::validate;
use crate::math::{Point, Vec3};
use std::f32::consts::{PI, TAU};

/// A triangle of the cage and its neighbours across its edges; edge k joins corners k and k + 1.
#[derive(Clone, Copy, Debug)]
struct Face {
    corners: [u32; 3],
    neighbours: [Option<u32>; 3],
}

struct Cage {
    positions: Vec<Vec3>,
    faces: Vec<Face>,
    /// Some face of each vertex; `None` for a vertex without faces.
    start: Vec<Option<u32>>,
}

/// The vertices around a vertex. Around an inner vertex they run clockwise seen from the side on which the
/// corners of faces run counter-clockwise; along a boundary they run the other way, from boundary to boundary.
struct Ring {
    is_boundary: bool,
    vertices: Vec<u32>,
}

/// Refines a cage `levels` times and moves its vertices to the limit surface. The result has limit normals and is
/// in the cage's space, ready for [`super::TriangleMesh::new`].
///
/// The normals point to the side from which the corners of faces run clockwise, as in pbrt-v4.
pub fn refine(positions: &[Point], indices: &[[u32; 3]], levels: u32) -> Result<MeshData, ShapeError> {
    validate::check_indices(indices, positions.len())?;
    if let Some(index) = positions.iter().position(|p| !p.is_finite()) {
        return Err(ShapeError::NotFinite { what: "vertex", index });
    }
    // Each level quadruples the faces.
    let grown = 4_usize.checked_pow(levels).and_then(|k| k.checked_mul(indices.len()));
    if grown.is_none_or(|n| n > i32::MAX as usize) {
        return Err(ShapeError::TooLarge { what: "subdivision surface" });
    }
    let mut cage = Cage::new(positions.iter().map(|p| p.0).collect(), indices)?;
    for _ in 0..levels {
        cage = cage.refined()?;
    }
    let limit: Vec<Vec3> = (0..cage.positions.len()).map(|v| cage.limit_position(v)).collect();
    cage.positions = limit;
    let normals = (0..cage.positions.len()).map(|v| cage.limit_normal(v)).collect();
    Ok(MeshData {
        indices: cage.faces.iter().map(|f| f.corners).collect(),
        positions: cage.positions.into_iter().map(Point).collect(),
        normals,
        ..MeshData::default()
    })
}

/// Weight of each neighbour of an inner vertex (Warren's choice).
fn beta(valence: usize) -> f32 {
    if valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * valence as f32) }
}

impl Cage {
    /// Finds neighbours; an error when an edge has more than two faces or two that run along it alike.
    fn new(positions: Vec<Vec3>, indices: &[[u32; 3]]) -> Result<Self, ShapeError> {
        let mut faces: Vec<Face> =
            indices.iter().map(|&corners| Face { corners, neighbours: [None; 3] }).collect();
        let mut start = vec![None; positions.len()];
        let mut edges = Vec::with_capacity(3 * faces.len());
        for (f, face) in faces.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (face.corners[k], face.corners[(k + 1) % 3]);
                start[a as usize] = Some(f as u32);
                edges.push((a.min(b), a.max(b), f as u32, k));
            }
        }
        edges.sort_unstable();
        for same in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let &[(a, b, f, k), ref rest @ ..] = same else { continue };
            match rest {
                _ if a == b => return Err(ShapeError::NotManifold { a, b }),
                [] => {}
                [(_, _, g, l)] if faces[f as usize].corners[k] != faces[*g as usize].corners[*l] => {
                    faces[f as usize].neighbours[k] = Some(*g);
                    faces[*g as usize].neighbours[*l] = Some(f);
                }
                _ => return Err(ShapeError::NotManifold { a, b }),
            }
        }
        Ok(Self { positions, faces, start })
    }

    fn corner(&self, face: u32, vertex: u32) -> usize {
        self.faces[face as usize].corners.iter().position(|&c| c == vertex).unwrap_or(0)
    }

    /// The one-ring of a vertex; `None` for a vertex without faces.
    fn ring(&self, vertex: usize) -> Option<Ring> {
        let first = self.start[vertex]?;
        let v = vertex as u32;
        let after = |f: u32| self.faces[f as usize].corners[(self.corner(f, v) + 1) % 3];
        let before = |f: u32| self.faces[f as usize].corners[(self.corner(f, v) + 2) % 3];
        let across_after = |f: u32| self.faces[f as usize].neighbours[self.corner(f, v)];
        let across_before = |f: u32| self.faces[f as usize].neighbours[(self.corner(f, v) + 2) % 3];
        let mut vertices = vec![after(first)];
        let mut face = first;
        while let Some(next) = across_after(face) {
            if next == first {
                return Some(Ring { is_boundary: false, vertices });
            }
            face = next;
            vertices.push(after(face));
        }
        // A boundary: start over from its end.
        vertices = vec![after(face)];
        let mut current = Some(face);
        while let Some(f) = current {
            vertices.push(before(f));
            current = across_before(f);
        }
        Some(Ring { is_boundary: true, vertices })
    }

    fn at(&self, v: u32) -> Vec3 {
        self.positions[v as usize]
    }

    /// (1 − n·w) v + w Σ ring, or the boundary rule with its own weight.
    fn smoothed(&self, vertex: usize, inner: impl Fn(usize) -> f32, boundary: f32) -> Vec3 {
        let p = self.positions[vertex];
        let Some(ring) = self.ring(vertex) else { return p };
        if ring.is_boundary {
            let (a, b) = (ring.vertices[0], ring.vertices[ring.vertices.len() - 1]);
            return p * (1.0 - 2.0 * boundary) + (self.at(a) + self.at(b)) * boundary;
        }
        let n = ring.vertices.len();
        let w = inner(n);
        let sum: Vec3 = ring.vertices.iter().map(|&r| self.at(r)).sum();
        p * (1.0 - n as f32 * w) + sum * w
    }

    fn limit_position(&self, vertex: usize) -> Vec3 {
        self.smoothed(vertex, |n| 1.0 / (n as f32 + 3.0 / (8.0 * beta(n))), 0.2)
    }

    /// Cross product of the limit tangents (pbrt-v4's masks along boundaries); zero without faces.
    fn limit_normal(&self, vertex: usize) -> Vec3 {
        let Some(ring) = self.ring(vertex) else { return Vec3::ZERO };
        let p = self.positions[vertex];
        let r: Vec<Vec3> = ring.vertices.iter().map(|&v| self.at(v)).collect();
        let n = r.len();
        let (mut s, mut t) = (Vec3::ZERO, Vec3::ZERO);
        if !ring.is_boundary {
            for (j, &q) in r.iter().enumerate() {
                let (sin, cos) = (TAU * j as f32 / n as f32).sin_cos();
                s += q * cos;
                t += q * sin;
            }
            return s.cross(t);
        }
        s = r[n - 1] - r[0];
        match n {
            2 => t = r[0] + r[1] - p * 2.0,
            3 => t = r[1] - p,
            4 => t = -r[0] + r[1] * 2.0 + r[2] * 2.0 - r[3] - p * 2.0,
            _ => {
                let theta = PI / (n - 1) as f32;
                t = (r[0] + r[n - 1]) * theta.sin();
                for (k, &q) in r.iter().enumerate().take(n - 1).skip(1) {
                    t += q * ((2.0 * theta.cos() - 2.0) * (k as f32 * theta).sin());
                }
                t = -t;
            }
        }
        s.cross(t)
    }

    /// One level finer: every vertex moves, every edge gets a vertex, every face becomes four.
    fn refined(&self) -> Result<Self, ShapeError> {
        let mut positions: Vec<Vec3> =
            (0..self.positions.len()).map(|v| self.smoothed(v, beta, 0.125)).collect();
        let mut middles = vec![[u32::MAX; 3]; self.faces.len()];
        for (f, face) in self.faces.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (face.corners[k], face.corners[(k + 1) % 3]);
                let neighbour = face.neighbours[k];
                // The face with the lower number makes the edge's vertex.
                if neighbour.is_some_and(|g| (g as usize) < f) {
                    continue;
                }
                let index = positions.len() as u32;
                middles[f][k] = index;
                positions.push(match neighbour {
                    None => (self.at(a) + self.at(b)) * 0.5,
                    Some(g) => {
                        // In the neighbour the edge runs from b to a.
                        let l = self.corner(g, b);
                        middles[g as usize][l] = index;
                        let other = self.faces[g as usize].corners[(l + 2) % 3];
                        let apex = face.corners[(k + 2) % 3];
                        (self.at(a) + self.at(b)) * 0.375 + (self.at(apex) + self.at(other)) * 0.125
                    }
                });
            }
        }
        let mut indices = Vec::with_capacity(4 * self.faces.len());
        for (face, &[ab, bc, ca]) in self.faces.iter().zip(&middles) {
            let [a, b, c] = face.corners;
            indices.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self::new(positions, &indices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn octahedron() -> (Vec<Point>, Vec<[u32; 3]>) {
        let p = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].map(Point).to_vec();
        let f = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        (p, f)
    }

    #[test]
    fn limit_positions_do_not_depend_on_the_level() {
        // The limit of a cage vertex can be computed at once or after refining: the surface is the same.
        let (p, f) = octahedron();
        let coarse = refine(&p, &f, 0).unwrap();
        let fine = refine(&p, &f, 3).unwrap();
        assert_eq!(fine.indices.len(), 8 * 64);
        for v in 0..6 {
            assert!((*coarse.positions[v] - *fine.positions[v]).length() < 1e-6, "{v}");
        }
        // Valence 4: γ = 1/(4 + 3/(8·3/32)) = 1/8, so the apex (0,0,1) goes to (1 − 4/8)·z = z/2.
        assert!((coarse.positions[4].z - 0.5).abs() < 1e-6);
    }

    #[test]
    fn normals_are_perpendicular_to_the_limit_surface() {
        let (p, f) = octahedron();
        let m = refine(&p, &f, 4).unwrap();
        // Compare with the mean of the adjacent faces' normals, which point the other way.
        let mut sums = vec![Vec3::ZERO; m.positions.len()];
        for t in &m.indices {
            let [a, b, c] = t.map(|i| *m.positions[i as usize]);
            for &i in t {
                sums[i as usize] += (b - a).cross(c - a);
            }
        }
        for (n, s) in m.normals.iter().zip(&sums) {
            assert!(n.normalize().dot(-s.normalize()) > 0.99, "{n} {s}");
        }
    }

    #[test]
    fn a_flat_sheet_stays_flat_and_keeps_its_outline_straight() {
        let p: Vec<Point> = (0..16).map(|i| Point::new((i % 4) as f32, (i / 4) as f32, 0.0)).collect();
        let quads = (0..9).map(|q| (q / 3) * 4 + q % 3);
        let f: Vec<[u32; 3]> = quads.flat_map(|a| [[a, a + 1, a + 4], [a + 1, a + 5, a + 4]]).collect();
        let m = refine(&p, &f, 2).unwrap();
        assert!(m.positions.iter().all(|q| q.z == 0.0
            && q.x >= 0.0
            && q.x <= 3.0
            && q.y >= 0.0
            && q.y <= 3.0));
        for n in &m.normals {
            assert!(n.normalize().z < -0.9999, "{n}");
        }
        let on_bottom = m.positions.iter().filter(|q| q.y == 0.0).count();
        // The corners are rounded, which reaches one edge of the cage far: the middle one keeps its 4 + 1 vertices.
        assert_eq!(on_bottom, 5);
    }

    #[test]
    fn cages_that_are_not_manifold_are_refused() {
        let p = vec![Point::ORIGIN; 5];
        let fan = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
        assert_eq!(refine(&p, &fan, 1).unwrap_err(), ShapeError::NotManifold { a: 0, b: 1 });
        let twisted = [[0, 1, 2], [0, 1, 3]];
        assert_eq!(refine(&p, &twisted, 1).unwrap_err(), ShapeError::NotManifold { a: 0, b: 1 });
        assert!(matches!(refine(&p, &[[0, 1, 2]], 31), Err(ShapeError::TooLarge { .. })));
    }
}
