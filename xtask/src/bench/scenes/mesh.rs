//! Triangle meshes and their PLY files.

type P3 = [f32; 3];

/// A mesh with texture coordinates, and with normals where it is curved.
#[derive(Clone, Debug, Default)]
pub(super) struct Mesh {
    pub(super) positions: Vec<P3>,
    /// One a vertex, or none at all.
    pub(super) normals: Vec<P3>,
    pub(super) uv: Vec<[f32; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Whether it is to be shaded with its vertex normals.
    pub(super) fn is_smooth(&self) -> bool {
        !self.normals.is_empty()
    }

    /// Adds the parallelogram at `corner`; seen from where `u` turns into `v` counterclockwise. Its texture coordinates
    /// start at `uv` and grow by its lengths times `per_length`.
    pub(super) fn quad(&mut self, corner: P3, u: P3, v: P3, uv: [f32; 2], per_length: f32) {
        let first = self.positions.len() as u32;
        let (lu, lv) = (length(u) * per_length, length(v) * per_length);
        for [a, b] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            self.positions.push(std::array::from_fn(|i| corner[i] + a * u[i] + b * v[i]));
            self.uv.push([uv[0] + a * lu, uv[1] + b * lv]);
        }
        self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }

    /// Adds a sheet of `nu` × `nv` cells over the unit square with the normals of its slope.
    pub(super) fn sheet(&mut self, nu: u32, nv: u32, at: impl Fn(f32, f32) -> P3, uv_scale: [f32; 2]) {
        let first = self.positions.len() as u32;
        for j in 0..=nv {
            for i in 0..=nu {
                let (u, v) = (i as f32 / nu as f32, j as f32 / nv as f32);
                // One-sided at the edges of the square, whose outside need not be defined.
                let h = 1e-3;
                let (u0, u1) = ((u - h).max(0.0), (u + h).min(1.0));
                let (v0, v1) = ((v - h).max(0.0), (v + h).min(1.0));
                let along_u = sub(at(u1, v), at(u0, v));
                let along_v = sub(at(u, v1), at(u, v0));
                self.positions.push(at(u, v));
                self.normals.push(normalized(cross(along_u, along_v)));
                self.uv.push([u * uv_scale[0], v * uv_scale[1]]);
            }
        }
        for j in 0..nv {
            for i in 0..nu {
                let a = first + j * (nu + 1) + i;
                let (b, c, d) = (a + 1, a + nu + 2, a + nu + 1);
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// The file, binary and little-endian.
    pub(super) fn to_ply(&self) -> Vec<u8> {
        let normals =
            if self.is_smooth() { "property float nx\nproperty float ny\nproperty float nz\n" } else { "" };
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             {normals}property float u\nproperty float v\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.positions.len(),
            self.triangles.len()
        )
        .into_bytes();
        let mut put = |values: &[f32]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        for (i, p) in self.positions.iter().enumerate() {
            put(p);
            if let Some(n) = self.normals.get(i) {
                put(n);
            }
            put(&self.uv[i]);
        }
        for triangle in &self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
        }
        bytes
    }
}

fn sub(a: P3, b: P3) -> P3 {
    std::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: P3, b: P3) -> P3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: P3) -> f32 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

/// A unit vector; up where there is no direction, as at a pole.
fn normalized(a: P3) -> P3 {
    let l = length(a);
    if l > 0.0 { a.map(|x| x / l) } else { [0.0, 1.0, 0.0] }
}
