//! Reads any mesh that follows the format, number by number, and says what is wrong with the others.

use super::header::{Element, FaceLayout, Format, Header, Property, PropertyKind, Scalar, VertexLayout};
use super::mesh::{Place, PlyError, PlyMesh};
use crate::math::{Point, Vec2, Vec3};
use std::str::FromStr;

/// Reads the tables behind the header.
pub(super) fn read(header: &Header, body: &[u8]) -> Result<PlyMesh, PlyError> {
    let mut mesh = PlyMesh::default();
    let mut data = Data { bytes: body, format: header.format };
    let mut n_vertices = None;
    for element in &header.elements {
        if element.least_size(header.format).saturating_mul(element.count) > data.bytes.len() {
            return Err(PlyError::Count { element: element.name.clone(), count: element.count });
        }
        match element.name.as_str() {
            "vertex" => {
                read_vertices(element, &mut data, &mut mesh)?;
                n_vertices = Some(element.count);
            }
            "face" => read_faces(element, &mut data, &mut mesh)?,
            _ => {
                for index in 0..element.count {
                    for property in &element.properties {
                        data.skip(property).map_err(|problem| element.error(index, problem))?;
                    }
                }
            }
        }
    }
    let n = n_vertices.ok_or(PlyError::Incomplete("states no vertices"))?;
    check_indices(&mesh, n)?;
    Ok(mesh)
}

/// The part of the file that has not been read yet.
struct Data<'a> {
    bytes: &'a [u8],
    format: Format,
}

impl Data<'_> {
    fn scalar(&mut self, scalar: Scalar) -> Result<f64, String> {
        if self.format == Format::Ascii {
            return self.ascii();
        }
        let size = scalar.size();
        let (raw, rest) = self.bytes.split_at_checked(size).ok_or("the file ends here")?;
        self.bytes = rest;
        let mut b = [0; 8];
        b[..size].copy_from_slice(raw);
        if self.format == Format::BigEndian {
            b[..size].reverse();
        }
        let [b0, b1, b2, b3, ..] = b;
        Ok(match scalar {
            Scalar::I8 => f64::from(b0.cast_signed()),
            Scalar::U8 => f64::from(b0),
            Scalar::I16 => f64::from(i16::from_le_bytes([b0, b1])),
            Scalar::U16 => f64::from(u16::from_le_bytes([b0, b1])),
            Scalar::I32 => f64::from(i32::from_le_bytes([b0, b1, b2, b3])),
            Scalar::U32 => f64::from(u32::from_le_bytes([b0, b1, b2, b3])),
            Scalar::F32 => f64::from(f32::from_le_bytes([b0, b1, b2, b3])),
            Scalar::F64 => f64::from_le_bytes(b),
        })
    }

    /// The number, rounded once.
    fn float(&mut self, scalar: Scalar) -> Result<f32, String> {
        if self.format == Format::Ascii { self.ascii() } else { self.scalar(scalar).map(|v| v as f32) }
    }

    fn ascii<T: FromStr>(&mut self) -> Result<T, String> {
        let bytes = self.bytes.trim_ascii_start();
        let end = bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len());
        let (word, rest) = bytes.split_at(end);
        self.bytes = rest;
        if word.is_empty() {
            return Err("the file ends here".to_owned());
        }
        std::str::from_utf8(word)
            .ok()
            .and_then(|w| w.parse().ok())
            .ok_or_else(|| format!("\"{}\" is no number", String::from_utf8_lossy(word)))
    }

    fn list_length(&mut self, count: Scalar, item: Scalar) -> Result<usize, String> {
        let n = self.scalar(count)?;
        let least = if self.format == Format::Ascii { 1 } else { item.size() };
        if !(0.0..=self.bytes.len() as f64 / least as f64).contains(&n) || n.fract() != 0.0 {
            return Err(format!("a list of {n} entries, more than the file has room for"));
        }
        Ok(n as usize)
    }

    fn skip(&mut self, property: &Property) -> Result<(), String> {
        match property.kind {
            PropertyKind::Scalar(s) => self.scalar(s).map(|_| ()),
            PropertyKind::List { count, item } => {
                let n = self.list_length(count, item)?;
                (0..n).try_for_each(|_| self.scalar(item).map(|_| ()))
            }
        }
    }
}

fn read_vertices(element: &Element, data: &mut Data, mesh: &mut PlyMesh) -> Result<(), PlyError> {
    let VertexLayout { position, normal, uv } = VertexLayout::of(element)?;
    mesh.positions.reserve(element.count);
    mesh.normals.reserve(if normal.is_some() { element.count } else { 0 });
    mesh.uvs.reserve(if uv.is_some() { element.count } else { 0 });
    let mut row = vec![0.0_f32; element.properties.len()];
    for index in 0..element.count {
        for (value, property) in row.iter_mut().zip(&element.properties) {
            match property.kind {
                PropertyKind::Scalar(s) => {
                    *value = data.float(s).map_err(|problem| element.error(index, problem))?;
                }
                PropertyKind::List { .. } => {
                    data.skip(property).map_err(|problem| element.error(index, problem))?;
                }
            }
        }
        let p = Vec3::from_array(position.map(|i| row[i]));
        if !p.is_finite() {
            return Err(element.error(index, format!("position {p} is not finite")));
        }
        mesh.positions.push(Point(p));
        mesh.normals.extend(normal.map(|n| Vec3::from_array(n.map(|i| row[i]))));
        mesh.uvs.extend(uv.map(|uv| Vec2::from_array(uv.map(|i| row[i]))));
    }
    Ok(())
}

fn read_faces(element: &Element, data: &mut Data, mesh: &mut PlyMesh) -> Result<(), PlyError> {
    let FaceLayout { corners, number } = FaceLayout::of(element)?;
    mesh.triangles.reserve(element.count);
    for index in 0..element.count {
        let mut face = [0_u32; 4];
        let (mut length, mut face_number) = (0, 0);
        for (i, property) in element.properties.iter().enumerate() {
            let located = |problem: String| element.error(index, problem);
            match property.kind {
                PropertyKind::List { count, item } if i == corners => {
                    length = data.list_length(count, item).map_err(located)?;
                    if !(3..=4).contains(&length) {
                        return Err(located(format!("{length} corners; only 3 and 4 are supported")));
                    }
                    for corner in &mut face[..length] {
                        let v = data.scalar(item).map_err(located)?;
                        if !(0.0..=f64::from(u32::MAX)).contains(&v) || v.fract() != 0.0 {
                            return Err(located(format!("vertex index {v} is out of range")));
                        }
                        *corner = v as u32;
                    }
                }
                PropertyKind::Scalar(s) if Some(i) == number => {
                    face_number = data.scalar(s).map_err(located)? as i64 as u32;
                }
                PropertyKind::Scalar(_) | PropertyKind::List { .. } => {
                    data.skip(property).map_err(located)?
                }
            }
        }
        let [a, b, c, d] = face;
        if length == 4 {
            mesh.quads.push([a, b, d, c]);
            mesh.quad_numbers.extend(number.map(|_| face_number));
        } else if length == 3 {
            mesh.triangles.push([a, b, c]);
            mesh.triangle_numbers.extend(number.map(|_| face_number));
        } else {
            return Err(element.error(index, "vertex_indices is not a list"));
        }
    }
    Ok(())
}

/// Faces may come before vertices, so indices are checked at the end.
fn check_indices(mesh: &PlyMesh, n: usize) -> Result<(), PlyError> {
    let out_of_range = |index: usize, v: u32| PlyError::Data {
        place: Place { element: "face".to_owned(), index },
        problem: format!("vertex index {v} is out of range: there are {n} vertices"),
    };
    let triangles = mesh.triangles.iter().enumerate().flat_map(|(i, f)| f.map(|v| (i, v)));
    let quads = mesh.quads.iter().enumerate().flat_map(|(i, f)| f.map(|v| (i, v)));
    match triangles.chain(quads).find(|(_, v)| *v as usize >= n) {
        Some((index, v)) => Err(out_of_range(index, v)),
        None => Ok(()),
    }
}
