//! A surface of any number of triangles, and what files say of it.

use std::fmt::Write as _;

/// An undulating square over [−1, 1]² with smooth normals and uv.
pub(super) struct Grid {
    /// Vertices along a side.
    side: usize,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
}

/// How a mesh is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Faces {
    /// As triangles.
    Triangles,
    /// As quadrilaterals.
    Quads,
}

impl Grid {
    pub(super) fn new(side: usize) -> Self {
        let mut grid = Self { side, positions: Vec::new(), normals: Vec::new(), uvs: Vec::new() };
        for j in 0..side {
            for i in 0..side {
                let [u, v] = [i, j].map(|k| k as f32 / (side - 1) as f32);
                let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
                let slope =
                    [-0.7 * (7.0 * x).cos() * (5.0 * y).cos(), 0.5 * (7.0 * x).sin() * (5.0 * y).sin()];
                let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
                grid.positions.push([x, y, 0.1 * (7.0 * x).sin() * (5.0 * y).cos()]);
                grid.normals.push([slope[0] / length, slope[1] / length, 1.0 / length]);
                grid.uvs.push([u, v]);
            }
        }
        grid
    }

    /// Corners of the faces, as triangles or as the quadrilaterals that make two each.
    fn faces(&self, faces: Faces) -> impl Iterator<Item = Vec<usize>> {
        let n = self.side;
        (0..(n - 1) * (n - 1)).flat_map(move |k| {
            let a = k / (n - 1) * n + k % (n - 1);
            match faces {
                Faces::Triangles => vec![vec![a, a + 1, a + n + 1], vec![a, a + n + 1, a + n]],
                Faces::Quads => vec![vec![a, a + 1, a + n + 1, a + n]],
            }
        })
    }

    /// The `Shape` directive of the scene language, with its numbers in the text.
    pub(super) fn pbrt(&self) -> String {
        let mut text = String::from("Shape \"trianglemesh\"\n    \"integer indices\" [ ");
        for face in self.faces(Faces::Triangles) {
            let _ = write!(text, "{} {} {}  ", face[0], face[1], face[2]);
        }
        text.push_str("]\n    \"point3 P\" [ ");
        write_rows(&mut text, &self.positions);
        text.push_str("]\n    \"normal N\" [ ");
        write_rows(&mut text, &self.normals);
        text.push_str("]\n    \"point2 uv\" [ ");
        write_rows(&mut text, &self.uvs);
        text.push_str("]\n");
        text
    }

    fn ply_header(&self, format: &str, faces: Faces) -> String {
        let properties: String =
            ["x", "y", "z", "nx", "ny", "nz", "u", "v"].map(|p| format!("property float {p}\n")).concat();
        format!(
            "ply\nformat {format} 1.0\nelement vertex {}\n{properties}element face {}\n\
             property list uint8 int vertex_indices\nend_header\n",
            self.positions.len(),
            self.faces(faces).count()
        )
    }

    fn rows(&self) -> impl Iterator<Item = [f32; 8]> + '_ {
        self.positions.iter().zip(&self.normals).zip(&self.uvs).map(|((p, n), t)| {
            let mut row = [0.0; 8];
            row[..3].copy_from_slice(p);
            row[3..6].copy_from_slice(n);
            row[6..].copy_from_slice(t);
            row
        })
    }

    pub(super) fn ascii_ply(&self) -> Vec<u8> {
        let mut text = self.ply_header("ascii", Faces::Triangles);
        for row in self.rows() {
            write_rows(&mut text, &[row]);
            text.push('\n');
        }
        for face in self.faces(Faces::Triangles) {
            let _ = writeln!(text, "3 {} {} {}", face[0], face[1], face[2]);
        }
        text.into_bytes()
    }

    pub(super) fn binary_ply(&self, faces: Faces) -> Vec<u8> {
        let mut bytes = self.ply_header("binary_little_endian", faces).into_bytes();
        self.rows().for_each(|row| bytes.extend(row.iter().flat_map(|v| v.to_le_bytes())));
        for face in self.faces(faces) {
            bytes.push(face.len() as u8);
            bytes.extend(face.iter().flat_map(|v| (*v as u32).to_le_bytes()));
        }
        bytes
    }
}

fn write_rows<const N: usize>(text: &mut String, rows: &[[f32; N]]) {
    for v in rows.as_flattened() {
        let _ = write!(text, "{v} ");
    }
}
