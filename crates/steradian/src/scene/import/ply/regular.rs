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

/// Whether every index is below `n`: the difference to the last shows in the sign, and so does an index itself that is
/// beyond the range of `i32`.
fn all_below(n: usize, indices: &[u32]) -> bool {
    match i32::try_from(n) {
        Ok(0) => indices.is_empty(),
        Ok(n) => {
            let last = n.cast_unsigned() - 1;
            indices.iter().fold(0, |signs, i| signs | i | last.wrapping_sub(*i)) & SIGN == 0
        }
        Err(_) => false,
    }
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
    let floats = |bytes: &[u8]| {
        let words = bytes[..4 * N].as_chunks::<4>().0;
        make(std::array::from_fn(|i| f32::from_le_bytes(words[i])))
    };
    let from_start = rows.get(start..)?;
    // Rows of a length that is known beforehand, such as positions have alone, with uv, with normals and with both, take
    // half the instructions.
    Some(match stride {
        12 => fixed_rows::<12, T>(from_start, start, floats),
        20 => fixed_rows::<20, T>(from_start, start, floats),
        24 => fixed_rows::<24, T>(from_start, start, floats),
        32 => fixed_rows::<32, T>(from_start, start, floats),
        _ => from_start.chunks(stride).map(floats).collect(),
    })
}

/// The same for rows of `STRIDE` bytes, the last of which lacks its first `start`.
#[inline(always)]
fn fixed_rows<const STRIDE: usize, T>(rows: &[u8], start: usize, read: impl Fn(&[u8]) -> T) -> Vec<T> {
    let (whole, last) = rows.as_chunks::<STRIDE>();
    let mut values = Vec::with_capacity(whole.len() + 1);
    values.extend(whole.iter().map(|row| read(row)));
    if start > 0 && !last.is_empty() {
        values.push(read(last));
    }
    values
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
    let (mut triangles, mut quads) = (Table::default(), Table::default());
    let mut left = element.count;
    // How many faces of the same kind are looked for at once: more while they are found.
    let mut run = 1;
    while left > 0 {
        let corners = usize::from(*body.first()?);
        let at_once = if extra == 0 { run.min(left) } else { 1 };
        let taken = match corners {
            3 => triangles.read::<13>(body, at_once, left, |face| face),
            4 => quads.read::<17>(body, at_once, left, |[a, b, c, d]| [a, b, d, c]),
            _ => return None,
        };
        let size = 1 + 4 * corners;
        // Fewer than were looked for, of which there is one at least, where the file ends within one.
        let others = body.get(taken * size..taken * size + extra).filter(|_| taken > 0)?;
        let numbers = if corners == 4 { &mut mesh.quad_numbers } else { &mut mesh.triangle_numbers };
        numbers.extend(number.and_then(|at| Some(u32::from_le_bytes(*others[at..].first_chunk()?))));
        run = if taken == at_once { (2 * run).min(LONGEST_RUN) } else { 1 };
        body = &body[taken * size + extra..];
        left -= taken;
    }
    (mesh.triangles, mesh.quads) = (triangles.0, quads.0);
    Some(body)
}

/// The sign of a number of 32 bits.
const SIGN: u32 = 1 << 31;

/// Faces that are read between two looks at whether they were of the expected kind.
const LONGEST_RUN: usize = 256;

/// Faces of `N` corners.
#[derive(Default)]
struct Table<const N: usize>(Vec<[u32; N]>);

impl<const N: usize> Table<N> {
    /// Reads up to `n` faces, as many as there are before the first of another kind, and returns their number. At most
    /// `left` are still to come, `n` included.
    #[inline]
    fn read<const ROW: usize>(
        &mut self,
        body: &[u8],
        n: usize,
        left: usize,
        order: impl Fn([u32; N]) -> [u32; N],
    ) -> usize {
        if self.0.is_empty() {
            self.0.reserve_exact(left);
        }
        let rows = body.as_chunks::<ROW>().0;
        let rows = &rows[..n.min(rows.len())];
        let before = self.0.len();
        // The lengths of all lists, joined by `or` and by `and`: both are N when all are.
        let (mut some, mut every) = (0, u8::MAX);
        self.0.extend(rows.iter().map(|row| {
            some |= row[0];
            every &= row[0];
            let words = row[1..].as_chunks::<4>().0;
            order(std::array::from_fn(|i| u32::from_le_bytes(words[i])))
        }));
        if usize::from(some) == N && usize::from(every) == N {
            return rows.len();
        }
        let taken = rows.iter().take_while(|row| usize::from(row[0]) == N).count();
        self.0.truncate(before + taken);
        taken
    }
}
