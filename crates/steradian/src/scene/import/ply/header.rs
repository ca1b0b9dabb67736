//! The header: which tables the file has, and how their numbers are written.

use super::mesh::{Place, PlyError};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Types of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
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

    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// A number, or list of numbers, that each instance of an element has.
#[derive(Clone, Debug)]
pub(super) struct Property {
    name: String,
    pub(super) kind: PropertyKind,
}

/// What a property consists of.
#[derive(Clone, Copy, Debug)]
pub(super) enum PropertyKind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// A table of the file, such as that of the vertices.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Bytes that one instance takes at least: lists may be empty, ASCII numbers one digit and a separator.
    pub(super) fn least_size(&self, format: Format) -> usize {
        let size = |p: &Property| match (format, p.kind) {
            (Format::Ascii, _) => 1,
            (_, PropertyKind::Scalar(s)) => s.size(),
            (_, PropertyKind::List { count, .. }) => count.size(),
        };
        self.properties.iter().map(size).sum()
    }

    pub(super) fn error(&self, index: usize, problem: impl Into<String>) -> PlyError {
        PlyError::Data { place: Place { element: self.name.clone(), index }, problem: problem.into() }
    }

    fn position(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.contains(&p.name.as_str()))
    }
}

/// What the file says about itself.
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
}

impl Header {
    /// The header, and the bytes behind it.
    pub(super) fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), PlyError> {
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

/// Which properties of the vertices are used, by their positions.
#[derive(Clone, Copy, Debug)]
pub(super) struct VertexLayout {
    pub(super) position: [usize; 3],
    pub(super) normal: Option<[usize; 3]>,
    pub(super) uv: Option<[usize; 2]>,
}

impl VertexLayout {
    pub(super) fn of(element: &Element) -> Result<Self, PlyError> {
        const UV_NAMES: [[&str; 2]; 4] =
            [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];
        let triple = |[x, y, z]: [&str; 3]| {
            Some([element.position(&[x])?, element.position(&[y])?, element.position(&[z])?])
        };
        Ok(Self {
            position: triple(["x", "y", "z"]).ok_or(PlyError::Incomplete("gives vertices no x, y and z"))?,
            normal: triple(["nx", "ny", "nz"]),
            uv: UV_NAMES.iter().find_map(|[u, v]| Some([element.position(&[u])?, element.position(&[v])?])),
        })
    }
}

/// Which properties of the faces are used, by their positions.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceLayout {
    pub(super) corners: usize,
    pub(super) number: Option<usize>,
}

impl FaceLayout {
    pub(super) fn of(element: &Element) -> Result<Self, PlyError> {
        let corners = element.position(&["vertex_indices", "vertex_index"]);
        Ok(Self {
            corners: corners.ok_or(PlyError::Incomplete("gives faces no vertex_indices"))?,
            number: element.position(&["face_indices"]),
        })
    }
}
