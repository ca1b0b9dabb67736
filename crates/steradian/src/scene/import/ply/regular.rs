//! Reads meshes as programs write them, at little more than the cost of looking at every byte: a table of vertices, numbers
//! only, then a table of faces, one list of three or four corners each.
//!
//! `None` is no judgement: the file is then read in the general way, which decides whether and where it is wrong.

use super::header::{Element, FaceLayout, Format, Header, PropertyKind, Scalar, VertexLayout};
use super::mesh::PlyMesh;
use crate::math::{Point, Vec2, Vec3};
use crate::scene::text::number::{scan_f32, scan_u32};

/// The mesh, when nothing about it is out of the ordinary.
pub(super) fn read(header: &Header, body: &[u8]) -> Option<PlyMesh> {
    let [vertices, faces] = &header.elements[..] else { return None };
    if vertices.name != "vertex" || faces.name != "face" {
        return None;
    }
    let vertex_layout = VertexLayout::of(vertices).ok()?;
    let face_layout = FaceLayout::of(faces).ok()?;
    // Nothing larger than the file is allocated on the word of its header.
    let fits = |e: &Element, bytes: &[u8]| e.least_size(header.format).saturating_mul(e.count) <= bytes.len();
    let mut mesh = PlyMesh::default();
    if !fits(vertices, body) {
        return None;
    }
    match header.format {
        Format::Ascii => {
            let mut words = Words { text: body };
            words.vertices(vertices, vertex_layout, &mut mesh)?;
            fits(faces, words.text).then(|| words.faces(faces, face_layout, &mut mesh))??;
        }
        Format::LittleEndian => {
            let body = vertex_rows(vertices, vertex_layout, body, &mut mesh)?;
            fits(faces, body).then(|| face_rows(faces, face_layout, body, &mut mesh))??;
        }
        Format::BigEndian => return None,
    }
    let finite = all_finite(bytemuck::cast_slice(&mesh.positions));
    let n = vertices.count;
    if !finite || !all_below(n, mesh.triangles.as_flattened()) || !all_below(n, mesh.quads.as_flattened()) {
        return None;
    }
    mesh.triangles.shrink_to_fit();
    mesh.quads.shrink_to_fit();
    Some(mesh)
}

/// Whether every value is finite: one more in an exponent of all ones carries into the sign. Without branches, so that the
/// compiler asks of several at once.
fn all_finite(values: &[f32]) -> bool {
    const ONE_MORE: u32 = 0x0080_0000;
    values.iter().fold(0, |signs, v| signs | (v.abs().to_bits() + ONE_MORE)) & SIGN == 0
}

/// Whether every index is below `n`: the difference shows in the sign. Read as unsigned, a negative index has a sign itself.
fn all_below(n: usize, indices: &[u32]) -> bool {
    const TOGETHER: usize = 16;
    let Ok(n) = i32::try_from(n) else { return false };
    let n = n.cast_unsigned();
    let (groups, others) = indices.as_chunks::<TOGETHER>();
    let (mut below, mut signs) = ([u32::MAX; TOGETHER], [0; TOGETHER]);
    for group in groups {
        for ((below, signs), i) in below.iter_mut().zip(&mut signs).zip(group) {
            *below &= i.wrapping_sub(n);
            *signs |= i;
        }
    }
    let in_groups = below.iter().all(|b| b & SIGN != 0) && signs.iter().all(|s| s & SIGN == 0);
    in_groups && others.iter().all(|i| *i < n)
}

impl PlyMesh {
    /// Adds a face, with room for `more` like it when it is the first.
    #[inline]
    fn push(&mut self, corners: &[u32], more: usize) {
        let first = self.triangles.is_empty() && self.quads.is_empty();
        match *corners {
            [a, b, c] => {
                self.triangles.reserve(if first { more } else { 1 });
                self.triangles.push([a, b, c]);
            }
            [a, b, c, d] => {
                self.quads.reserve(if first { more } else { 1 });
                self.quads.push([a, b, d, c]);
            }
            _ => debug_assert!(false, "a face has three or four corners"),
        }
    }
}

/// Numbers between white space.
struct Words<'a> {
    text: &'a [u8],
}

impl Words<'_> {
    /// The next number; `None` for what is none, ends elsewhere than at white space, or is not finite.
    #[inline]
    fn float(&mut self) -> Option<f32> {
        self.skip_blank();
        let n = scan_f32(self.text)?;
        self.consume(n.len)?;
        n.value.is_finite().then_some(n.value)
    }

    /// The next number, digits only.
    #[inline]
    fn index(&mut self) -> Option<u32> {
        self.skip_blank();
        let n = scan_u32(self.text)?;
        self.consume(n.len)?;
        Some(n.value)
    }

    #[inline]
    fn skip_blank(&mut self) {
        while let [b, rest @ ..] = self.text
            && b.is_ascii_whitespace()
        {
            self.text = rest;
        }
    }

    #[inline]
    fn consume(&mut self, len: usize) -> Option<()> {
        self.text = self.text.get(len..)?;
        self.text.first().is_none_or(u8::is_ascii_whitespace).then_some(())
    }

    fn vertices(&mut self, element: &Element, layout: VertexLayout, mesh: &mut PlyMesh) -> Option<()> {
        if element.properties.iter().any(|p| matches!(p.kind, PropertyKind::List { .. })) {
            return None;
        }
        mesh.positions.reserve_exact(element.count);
        mesh.normals.reserve_exact(if layout.normal.is_some() { element.count } else { 0 });
        mesh.uvs.reserve_exact(if layout.uv.is_some() { element.count } else { 0 });
        let mut row = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            for value in &mut row {
                *value = self.float()?;
            }
            mesh.positions.push(Point(Vec3::from_array(layout.position.map(|i| row[i]))));
            mesh.normals.extend(layout.normal.map(|n| Vec3::from_array(n.map(|i| row[i]))));
            mesh.uvs.extend(layout.uv.map(|uv| Vec2::from_array(uv.map(|i| row[i]))));
        }
        Some(())
    }

    fn faces(&mut self, element: &Element, layout: FaceLayout, mesh: &mut PlyMesh) -> Option<()> {
        for _ in 0..element.count {
            let (mut corners, mut length, mut number) = ([0; 4], 0, None);
            for (i, property) in element.properties.iter().enumerate() {
                match property.kind {
                    PropertyKind::List { .. } if i == layout.corners => {
                        length = self.index().filter(|n| (3..=4).contains(n))? as usize;
                        for corner in &mut corners[..length] {
                            *corner = self.index()?;
                        }
                    }
                    PropertyKind::Scalar(_) if Some(i) == layout.number => number = Some(self.index()?),
                    PropertyKind::Scalar(_) => drop(self.float()?),
                    PropertyKind::List { .. } => return None,
                }
            }
            let numbers = if length == 4 { &mut mesh.quad_numbers } else { &mut mesh.triangle_numbers };
            numbers.extend(number);
            mesh.push(&corners[..length], element.count);
        }
        Some(())
    }
}

/// Offsets of the properties in a row of scalars, and at last the length of the row.
fn offsets(kinds: impl Iterator<Item = PropertyKind>) -> Option<Vec<usize>> {
    let mut offsets = vec![0];
    for kind in kinds {
        let PropertyKind::Scalar(s) = kind else { return None };
        offsets.push(offsets.last()? + s.size());
    }
    Some(offsets)
}

/// Reads the vertices and returns what follows.
fn vertex_rows<'a>(
    element: &Element,
    layout: VertexLayout,
    body: &'a [u8],
    mesh: &mut PlyMesh,
) -> Option<&'a [u8]> {
    let offsets = offsets(element.properties.iter().map(|p| p.kind))?;
    // Where `N` properties, all of them floats, lie side by side.
    let start = |properties: &[usize]| {
        let float = |&i: &usize| matches!(element.properties[i].kind, PropertyKind::Scalar(Scalar::F32));
        let adjacent = properties.windows(2).all(|w| w[1] == w[0] + 1);
        (adjacent && properties.iter().all(float)).then(|| offsets[properties[0]])
    };
    let stride = *offsets.last()?;
    let (rows, rest) = body.split_at_checked(stride.checked_mul(element.count)?)?;
    let position = start(&layout.position)?;
    mesh.positions = columns(rows, stride, position, |p| Point(Vec3::from_array(p)))?;
    if let Some(normal) = layout.normal {
        mesh.normals = columns(rows, stride, start(&normal)?, Vec3::from_array)?;
    }
    if let Some(uv) = layout.uv {
        mesh.uvs = columns(rows, stride, start(&uv)?, Vec2::from_array)?;
    }
    Some(rest)
}

/// What `N` floats that lie side by side at `start` in each row make.
fn columns<const N: usize, T>(
    rows: &[u8],
    stride: usize,
    start: usize,
    make: impl Fn([f32; N]) -> T,
) -> Option<Vec<T>> {
    if stride < start || stride - start < 4 * N {
        return None;
    }
    let floats = move |row: &[u8]| {
        let words = row[start..][..4 * N].as_chunks::<4>().0;
        make(std::array::from_fn(|i| f32::from_le_bytes(words[i])))
    };
    Some(rows.chunks_exact(stride).map(floats).collect())
}

/// Reads the faces and returns what follows.
fn face_rows<'a>(
    element: &Element,
    layout: FaceLayout,
    mut body: &'a [u8],
    mesh: &mut PlyMesh,
) -> Option<&'a [u8]> {
    let [corners, others @ ..] = &element.properties[..] else { return None };
    let PropertyKind::List { count: Scalar::U8 | Scalar::I8, item: Scalar::I32 | Scalar::U32 } = corners.kind
    else {
        return None;
    };
    if layout.corners != 0 {
        return None;
    }
    let offsets = offsets(others.iter().map(|p| p.kind))?;
    let number = match layout.number {
        None => None,
        Some(i) => match element.properties[i].kind {
            PropertyKind::Scalar(Scalar::I32 | Scalar::U32) => Some(offsets[i - 1]),
            _ => return None,
        },
    };
    let extra = *offsets.last()?;
    let mut left = element.count;
    // How many faces of the same kind are looked for at once: more while they are found.
    let mut run = 1;
    while left > 0 {
        let corners = usize::from(*body.first()?);
        let at_once = if extra == 0 && run > 1 { run.min(left) } else { 1 };
        let taken = match (corners, at_once) {
            (3 | 4, 1) => {
                let size = 1 + 4 * corners;
                let row = body.get(..size + extra)?;
                let (words, tail) = row.split_at(size);
                let words = words[1..].as_chunks::<4>().0;
                let mut face = [0; 4];
                for (corner, word) in face.iter_mut().zip(words) {
                    *corner = u32::from_le_bytes(*word);
                }
                let numbers = if corners == 4 { &mut mesh.quad_numbers } else { &mut mesh.triangle_numbers };
                numbers.extend(number.and_then(|at| Some(u32::from_le_bytes(*tail[at..].first_chunk()?))));
                mesh.push(&face[..corners], left);
                1
            }
            (3, n) => run_of::<3, 13>(body, n, &mut mesh.triangles, |face| face),
            (4, n) => run_of::<4, 17>(body, n, &mut mesh.quads, |[a, b, c, d]| [a, b, d, c]),
            _ => return None,
        };
        run = if taken == at_once { (2 * run).min(LONGEST_RUN) } else { 1 };
        body = &body[taken * (1 + 4 * corners) + taken * extra..];
        left -= taken;
    }
    Some(body)
}

/// The sign of a number of 32 bits.
const SIGN: u32 = 1 << 31;

/// Faces that are read between two looks at whether they were of the expected kind.
const LONGEST_RUN: usize = 256;

/// Appends up to `n` faces of `N` corners, as many as there are before the first of another kind, and returns their number.
#[inline]
fn run_of<const N: usize, const ROW: usize>(
    body: &[u8],
    n: usize,
    faces: &mut Vec<[u32; N]>,
    order: impl Fn([u32; N]) -> [u32; N],
) -> usize {
    const AT_ONCE: usize = 4;
    let rows = body.as_chunks::<ROW>().0;
    let rows = &rows[..n.min(rows.len()).min(LONGEST_RUN)];
    let before = faces.len();
    // Room as a copy of zeros, which is cheaper than a value at a time.
    faces.extend_from_slice(&[[0; N]; LONGEST_RUN][..rows.len()]);
    // The lengths of all lists, joined by `or` and by `and`: both are N when all are.
    let (mut some, mut every) = (0, u8::MAX);
    let mut read = |row: &[u8; ROW], face: &mut [u32; N]| {
        some |= row[0];
        every &= row[0];
        let words = row[1..].as_chunks::<4>().0;
        *face = order(std::array::from_fn(|i| u32::from_le_bytes(words[i])));
    };
    let (fours, others) = rows.as_chunks::<AT_ONCE>();
    let (four_faces, other_faces) = faces[before..].as_chunks_mut::<AT_ONCE>();
    for (rows, faces) in fours.iter().zip(four_faces) {
        for i in 0..AT_ONCE {
            read(&rows[i], &mut faces[i]);
        }
    }
    for (row, face) in others.iter().zip(other_faces) {
        read(row, face);
    }
    if usize::from(some) == N && usize::from(every) == N {
        return rows.len();
    }
    let taken = rows.iter().take_while(|row| usize::from(row[0]) == N).count();
    faces.truncate(before + taken);
    taken
}
