//! PLY meshes from bytes: ASCII and both binary orders, triangles and quadrilaterals.

use crate::math::{Point, Vec2, Vec3};
use std::fmt;

/// A mesh as the file states it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlyMesh {
    /// Vertex positions.
    pub positions: Vec<Point>,
    /// Vertex normals, or empty.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, or empty.
    pub uvs: Vec<Vec2>,
    /// Triangles; every index is below the number of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// Quadrilaterals as bilinear patches: corners (0,0), (1,0), (0,1), (1,1), that is the file's v0 v1 v3 v2.
    pub quads: Vec<[u32; 4]>,
    /// The `face_indices` of the triangles, or empty.
    pub triangle_numbers: Vec<u32>,
    /// The `face_indices` of the quadrilaterals, or empty.
    pub quad_numbers: Vec<u32>,
}

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlyError {
    /// The first line is not `ply`.
    #[error("this is not a PLY file")]
    Signature,
    /// A line of the header, counted from 1.
    #[error("line {line} of the header: {problem}")]
    Header {
        /// Which line.
        line: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// The header does not end, or names no format or no vertices.
    #[error("the header {0}")]
    Incomplete(&'static str),
    /// The data end early, or hold something else than numbers.
    #[error("{place}: {problem}")]
    Data {
        /// Element and its index.
        place: Place,
        /// What is wrong.
        problem: String,
    },
    /// Fewer bytes than the header promises.
    #[error("the header promises {count} of element \"{element}\", more than the file has room for")]
    Count {
        /// Name of the element.
        element: String,
        /// Promised number.
        count: usize,
    },
}

/// An element of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the element.
    pub element: String,
    /// Index, counted from 0.
    pub index: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.element, self.index)
    }
}

/// Reads a mesh.
///
/// # Errors
/// Everything that does not follow the format; an index that no vertex has; a coordinate that is not finite; a face
/// that has neither three nor four corners. Nothing larger than the file is allocated on the word of its header.
pub fn parse(bytes: &[u8]) -> Result<PlyMesh, PlyError> {
    let (header, body) = Header::parse(bytes)?;
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

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

#[derive(Clone, Debug)]
struct Property {
    name: String,
    kind: PropertyKind,
}

#[derive(Clone, Copy, Debug)]
enum PropertyKind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Debug)]
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

impl Element {
    /// Bytes that one instance takes at least: lists may be empty, ASCII numbers one digit and a separator.
    fn least_size(&self, format: Format) -> usize {
        let size = |p: &Property| match (format, p.kind) {
            (Format::Ascii, _) => 1,
            (_, PropertyKind::Scalar(s)) => s.size(),
            (_, PropertyKind::List { count, .. }) => count.size(),
        };
        self.properties.iter().map(size).sum()
    }

    fn error(&self, index: usize, problem: impl Into<String>) -> PlyError {
        PlyError::Data { place: Place { element: self.name.clone(), index }, problem: problem.into() }
    }

    fn position(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.contains(&p.name.as_str()))
    }
}

struct Header {
    format: Format,
    elements: Vec<Element>,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), PlyError> {
        let mut rest = bytes;
        let mut line_number = 0;
        let mut format = None;
        let mut elements: Vec<Element> = Vec::new();
        loop {
            let end = rest.iter().position(|&b| b == b'\n').ok_or(PlyError::Incomplete("does not end"))?;
            let line = rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]);
            rest = &rest[end + 1..];
            line_number += 1;
            let error = |problem: &str| PlyError::Header { line: line_number, problem: problem.to_owned() };
            let line = std::str::from_utf8(line).map_err(|_| error("it is not text"))?;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            if line_number == 1 {
                if words != ["ply"] {
                    return Err(PlyError::Signature);
                }
                continue;
            }
            match words[..] {
                [] | ["comment" | "obj_info", ..] => {}
                ["end_header"] => break,
                ["format", "ascii", _] => format = Some(Format::Ascii),
                ["format", "binary_little_endian", _] => format = Some(Format::LittleEndian),
                ["format", "binary_big_endian", _] => format = Some(Format::BigEndian),
                ["element", name, count] => elements.push(Element {
                    name: name.to_owned(),
                    count: count.parse().map_err(|_| error("the count is no number"))?,
                    properties: Vec::new(),
                }),
                ["property", "list", count, item, name] => {
                    let (Some(count), Some(item)) = (Scalar::parse(count), Scalar::parse(item)) else {
                        return Err(error("unknown type"));
                    };
                    if matches!(count, Scalar::F32 | Scalar::F64) {
                        return Err(error("the length of a list must be an integer"));
                    }
                    let kind = PropertyKind::List { count, item };
                    add_property(&mut elements, name, kind)
                        .ok_or_else(|| error("property before any element"))?;
                }
                ["property", scalar, name] => {
                    let kind = Scalar::parse(scalar).map(PropertyKind::Scalar);
                    let kind = kind.ok_or_else(|| error("unknown type"))?;
                    add_property(&mut elements, name, kind)
                        .ok_or_else(|| error("property before any element"))?;
                }
                _ => return Err(error("it is not understood")),
            }
        }
        let format = format.ok_or(PlyError::Incomplete("names no format"))?;
        Ok((Self { format, elements }, rest))
    }
}

fn add_property(elements: &mut [Element], name: &str, kind: PropertyKind) -> Option<()> {
    elements.last_mut()?.properties.push(Property { name: name.to_owned(), kind });
    Some(())
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

    fn ascii(&mut self) -> Result<f64, String> {
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
    const UV_NAMES: [[&str; 2]; 4] =
        [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];
    let triple = |names: [&str; 3]| {
        Some(names.map(|n| element.position(&[n])))
            .filter(|p| p.iter().all(Option::is_some))
            .map(|p| p.map(|i| i.unwrap_or(0)))
    };
    let xyz = triple(["x", "y", "z"]).ok_or(PlyError::Incomplete("gives vertices no x, y and z"))?;
    let normal = triple(["nx", "ny", "nz"]);
    let uv = UV_NAMES.iter().find_map(|[u, v]| Some([element.position(&[u])?, element.position(&[v])?]));

    mesh.positions.reserve(element.count);
    mesh.normals.reserve(if normal.is_some() { element.count } else { 0 });
    mesh.uvs.reserve(if uv.is_some() { element.count } else { 0 });
    let mut row = vec![0.0_f32; element.properties.len()];
    for index in 0..element.count {
        for (value, property) in row.iter_mut().zip(&element.properties) {
            match property.kind {
                PropertyKind::Scalar(s) => {
                    *value = data.scalar(s).map_err(|problem| element.error(index, problem))? as f32;
                }
                PropertyKind::List { .. } => {
                    data.skip(property).map_err(|problem| element.error(index, problem))?;
                }
            }
        }
        let p = Vec3::from_array(xyz.map(|i| row[i]));
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
    let corners = element
        .position(&["vertex_indices", "vertex_index"])
        .ok_or(PlyError::Incomplete("gives faces no vertex_indices"))?;
    let number = element.position(&["face_indices"]);
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

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property double s\nproperty double t\nproperty uchar red\nelement face 2\n\
        property list uchar int vertex_indices\nproperty int face_indices\nend_header\n";
    const VERTICES: [[f64; 5]; 4] = [
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 1.0, 0.0],
        [1.0, 1.0, 0.5, 1.0, 1.0],
        [0.0, 1.0, 0.0, 0.0, 1.0],
    ];

    fn ascii() -> String {
        let mut text = format!("ply\nformat ascii 1.0\ncomment made by hand\n{HEADER}");
        for [x, y, z, s, t] in VERTICES {
            text += &format!("{x} {y} {z} {s} {t} 255\n");
        }
        text + "3 0 1 2 7\n4 0 1 2 3 9\n"
    }

    fn binary(little: bool) -> Vec<u8> {
        let name = if little { "binary_little_endian" } else { "binary_big_endian" };
        let mut out = format!("ply\r\nformat {name} 1.0\r\n{}", HEADER.replace('\n', "\r\n")).into_bytes();
        let mut put = |le: &[u8]| {
            if little { out.extend(le) } else { out.extend(le.iter().rev()) }
        };
        for [x, y, z, s, t] in VERTICES {
            [x, y, z].iter().for_each(|v| put(&(*v as f32).to_le_bytes()));
            [s, t].iter().for_each(|v| put(&v.to_le_bytes()));
            put(&[255]);
        }
        for (face, number) in [(&[0, 1, 2][..], 7), (&[0, 1, 2, 3][..], 9)] {
            put(&[face.len() as u8]);
            face.iter().for_each(|v: &i32| put(&v.to_le_bytes()));
            put(&i32::to_le_bytes(number));
        }
        out
    }

    #[test]
    fn all_three_encodings_give_the_same_mesh() {
        let mesh = parse(ascii().as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.quads, [[0, 1, 3, 2]], "a quad becomes a patch with corners in (u, v) order");
        assert_eq!((&mesh.triangle_numbers[..], &mesh.quad_numbers[..]), (&[7][..], &[9][..]));
        assert_eq!(mesh.positions[2], Point::new(1.0, 1.0, 0.5));
        assert_eq!(mesh.uvs[3], Vec2::new(0.0, 1.0));
        assert!(mesh.normals.is_empty());
        assert_eq!(parse(&binary(true)).unwrap(), mesh);
        assert_eq!(parse(&binary(false)).unwrap(), mesh);
    }

    fn message(text: &str) -> String {
        parse(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn faults_are_named_with_their_place() {
        let good = ascii();
        assert_eq!(message("solid"), "the header does not end");
        assert_eq!(message("solid x\n"), "this is not a PLY file");
        assert_eq!(
            message(&good.replace("3 0 1 2 7", "3 0 1 4 7")),
            "face 0: vertex index 4 is out of range: there are 4 vertices"
        );
        assert_eq!(
            message(&good.replace("3 0 1 2 7", "3 0 -1 2 7")),
            "face 0: vertex index -1 is out of range"
        );
        assert_eq!(
            message(&good.replace("3 0 1 2 7", "2 0 1 7")),
            "face 0: 2 corners; only 3 and 4 are supported"
        );
        assert_eq!(message(&good.replace("0.5", "nan")), "vertex 2: position [1, 1, NaN] is not finite");
        assert_eq!(message(&good.replace("0.5", "half")), "vertex 2: \"half\" is no number");
        assert_eq!(message(good.trim_end_matches("9\n")), "face 1: the file ends here");
        assert_eq!(
            message(&good.replace("property float z\n", "")),
            "the header gives vertices no x, y and z"
        );
        assert_eq!(message(&good.replace("float x", "quad x")), "line 5 of the header: unknown type");
        assert_eq!(
            message(&good.replace("element face 2", "element face 999999999999")),
            "the header promises 999999999999 of element \"face\", more than the file has room for"
        );
    }

    #[test]
    fn no_truncation_and_no_flipped_byte_panics() {
        for little in [true, false] {
            let good = binary(little);
            for end in 0..good.len() {
                assert!(parse(&good[..end]).is_err(), "a file cut at {end} must not pass");
            }
            for i in 0..good.len() {
                let mut bad = good.clone();
                bad[i] ^= 0xff;
                let _ = parse(&bad);
            }
        }
    }
}
