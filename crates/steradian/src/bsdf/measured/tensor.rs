//! The container of `.bsdf` files: named arrays of numbers of any rank, little-endian.
//!
//! ```text
//! "tensor_file\0"  version 1, 0  u32 number of fields
//! each field:  u16 length, name  u16 rank  u8 type  u64 offset of the data in the file  rank × u64 extents
//! ```
//!
//! The layout is that of Dupuy & Jakob 2018, as their published files and reader have it.

use thiserror::Error;

/// First bytes of a container.
pub(super) const MAGIC: &[u8; 12] = b"tensor_file\0";

/// Largest rank of an array: five are used.
const MAX_RANK: u16 = 16;

/// Why bytes are no container, or lack what is looked for.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TensorError {
    /// The first bytes are others.
    #[error("this is no tensor file: it does not begin with `tensor_file`")]
    Magic,
    /// Only version 1.0 is known.
    #[error("tensor file of version {0}.{1}; only 1.0 is known")]
    Version(u8, u8),
    /// The list of fields ends with the file.
    #[error("the file ends within the list of its fields")]
    Truncated,
    /// A field's data lie beyond the end.
    #[error("the file ends before the data of field `{0}`")]
    DataTruncated(String),
    /// A field has an unknown type of number, or an absurd rank.
    #[error("field `{0}` is of an unknown type")]
    Type(String),
    /// A field is missing.
    #[error("there is no field `{0}`")]
    Missing(&'static str),
    /// A field holds numbers of another type.
    #[error("field `{name}` holds {found}, expected {expected}")]
    WrongType {
        /// The field.
        name: &'static str,
        /// What it holds.
        found: &'static str,
        /// What it should hold.
        expected: &'static str,
    },
    /// A field has another rank or other extents.
    #[error("field `{name}` has the shape {found}, expected {expected}")]
    Shape {
        /// The field.
        name: &'static str,
        /// Its extents.
        found: String,
        /// What they should be.
        expected: String,
    },
}

/// Types of numbers, with the code that stands for them in the file, their size [B] and their name.
const TYPES: [(u8, usize, &str); 11] = [
    (1, 1, "uint8"),
    (2, 1, "int8"),
    (3, 2, "uint16"),
    (4, 2, "int16"),
    (5, 4, "uint32"),
    (6, 4, "int32"),
    (7, 8, "uint64"),
    (8, 8, "int64"),
    (9, 2, "float16"),
    (10, 4, "float32"),
    (11, 8, "float64"),
];
const UINT8: u8 = 1;
const FLOAT32: u8 = 10;

/// A parsed container; data stay in the bytes.
#[derive(Debug)]
pub(super) struct TensorFile<'a> {
    fields: Vec<Field<'a>>,
}

#[derive(Debug)]
struct Field<'a> {
    name: String,
    code: u8,
    shape: Vec<usize>,
    data: &'a [u8],
}

/// An array of single-precision numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Floats {
    /// Extents, the last one contiguous.
    pub(super) shape: Vec<usize>,
    /// The numbers.
    pub(super) values: Vec<f32>,
}

impl<'a> TensorFile<'a> {
    /// Reads the list of fields; nothing larger than the bytes is allocated.
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, TensorError> {
        let mut cursor = Cursor { rest: bytes };
        if cursor.take(MAGIC.len()).is_none_or(|m| m != MAGIC) {
            return Err(TensorError::Magic);
        }
        let truncated = || TensorError::Truncated;
        let [major, minor] = cursor.array().ok_or_else(truncated)?;
        if (major, minor) != (1, 0) {
            return Err(TensorError::Version(major, minor));
        }
        let count = u32::from_le_bytes(cursor.array().ok_or_else(truncated)?);
        let mut fields = Vec::new();
        for _ in 0..count {
            let length = u16::from_le_bytes(cursor.array().ok_or_else(truncated)?);
            let name = cursor.take(usize::from(length)).ok_or_else(truncated)?;
            let name = String::from_utf8_lossy(name).into_owned();
            let rank = u16::from_le_bytes(cursor.array().ok_or_else(truncated)?);
            let [code] = cursor.array().ok_or_else(truncated)?;
            let offset = u64::from_le_bytes(cursor.array().ok_or_else(truncated)?);
            let size = TYPES.iter().find(|t| t.0 == code).map(|t| t.1);
            let Some(size) = size.filter(|_| rank <= MAX_RANK) else { return Err(TensorError::Type(name)) };
            let mut shape = Vec::with_capacity(usize::from(rank));
            let mut length = Some(size);
            for _ in 0..rank {
                let extent = u64::from_le_bytes(cursor.array().ok_or_else(truncated)?);
                let extent = usize::try_from(extent).ok();
                length = length.zip(extent).and_then(|(l, e)| l.checked_mul(e));
                shape.push(extent.unwrap_or(usize::MAX));
            }
            let start = usize::try_from(offset).ok();
            let end = start.zip(length).and_then(|(s, l)| s.checked_add(l));
            let data = start.zip(end).and_then(|(s, e)| bytes.get(s..e));
            let Some(data) = data else { return Err(TensorError::DataTruncated(name)) };
            fields.push(Field { name, code, shape, data });
        }
        Ok(Self { fields })
    }

    /// Whether there is a field `name`.
    pub(super) fn contains(&self, name: &str) -> bool {
        self.fields.iter().any(|f| f.name == name)
    }

    /// The single-precision field `name`, whose extents must be `shape`; `None` there stands for any extent.
    pub(super) fn floats(&self, name: &'static str, shape: &[Option<usize>]) -> Result<Floats, TensorError> {
        let field = self.typed(name, FLOAT32, shape)?;
        let values = field.data.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
        Ok(Floats { shape: field.shape.clone(), values })
    }

    /// The field `name` of one byte.
    pub(super) fn byte(&self, name: &'static str) -> Result<u8, TensorError> {
        Ok(self.typed(name, UINT8, &[Some(1)])?.data.first().copied().unwrap_or_default())
    }

    fn typed(
        &self,
        name: &'static str,
        code: u8,
        shape: &[Option<usize>],
    ) -> Result<&Field<'a>, TensorError> {
        let field = self.fields.iter().find(|f| f.name == name).ok_or(TensorError::Missing(name))?;
        if field.code != code {
            let word = |code| TYPES.iter().find(|t| t.0 == code).map_or("?", |t| t.2);
            return Err(TensorError::WrongType { name, found: word(field.code), expected: word(code) });
        }
        let fits = field.shape.len() == shape.len()
            && field.shape.iter().zip(shape).all(|(&n, want)| want.is_none_or(|w| w == n));
        if !fits {
            let found = field.shape.iter().map(usize::to_string).collect::<Vec<_>>().join(" × ");
            let expected: Vec<_> =
                shape.iter().map(|w| w.map_or_else(|| "n".to_owned(), |w| w.to_string())).collect();
            return Err(TensorError::Shape {
                name,
                found: if found.is_empty() { "()".to_owned() } else { found },
                expected: expected.join(" × "),
            });
        }
        Ok(field)
    }
}

struct Cursor<'a> {
    rest: &'a [u8],
}

impl<'a> Cursor<'a> {
    fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (head, rest) = self.rest.split_at_checked(n)?;
        self.rest = rest;
        Some(head)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }
}

/// Puts a container together.
#[derive(Debug, Default)]
pub(super) struct TensorWriter {
    fields: Vec<(String, u8, Vec<usize>, Vec<u8>)>,
}

impl TensorWriter {
    /// Adds an array of single-precision numbers; `values` fill `shape`.
    pub(super) fn floats(&mut self, name: &str, shape: &[usize], values: &[f32]) {
        debug_assert_eq!(shape.iter().product::<usize>(), values.len(), "{name}");
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.fields.push((name.to_owned(), FLOAT32, shape.to_vec(), bytes));
    }

    /// Adds bytes: text, or a flag.
    pub(super) fn bytes(&mut self, name: &str, bytes: &[u8]) {
        self.fields.push((name.to_owned(), UINT8, vec![bytes.len()], bytes.to_vec()));
    }

    /// The file.
    pub(super) fn finish(self) -> Vec<u8> {
        let align = |n: usize| n.next_multiple_of(8);
        let list: usize = self.fields.iter().map(|f| 2 + f.0.len() + 2 + 1 + 8 + 8 * f.2.len()).sum();
        let mut offset = align(MAGIC.len() + 2 + 4 + list);
        let mut out = MAGIC.to_vec();
        out.extend([1, 0]);
        out.extend((self.fields.len() as u32).to_le_bytes());
        for (name, code, shape, data) in &self.fields {
            out.extend((name.len() as u16).to_le_bytes());
            out.extend(name.as_bytes());
            out.extend((shape.len() as u16).to_le_bytes());
            out.push(*code);
            out.extend((offset as u64).to_le_bytes());
            out.extend(shape.iter().flat_map(|&n| (n as u64).to_le_bytes()));
            offset = align(offset + data.len());
        }
        for (_, _, _, data) in &self.fields {
            out.resize(align(out.len()), 0);
            out.extend(data);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn container() -> Vec<u8> {
        let mut w = TensorWriter::default();
        w.floats("theta", &[3], &[0.0, 0.5, 1.0]);
        w.floats("values", &[2, 3], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        w.bytes("flag", &[1]);
        w.bytes("description", b"none");
        w.finish()
    }

    #[test]
    fn written_arrays_are_read_back() {
        let bytes = container();
        let file = TensorFile::parse(&bytes).unwrap();
        let values = file.floats("values", &[Some(2), None]).unwrap();
        assert_eq!(values.shape, [2, 3]);
        assert_eq!(values.values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(file.byte("flag"), Ok(1));
        assert!(file.contains("description") && !file.contains("nothing"));
    }

    #[test]
    fn what_is_not_there_is_named() {
        let bytes = container();
        let file = TensorFile::parse(&bytes).unwrap();
        assert_eq!(file.byte("jacobian"), Err(TensorError::Missing("jacobian")));
        let text = |e: Result<Floats, TensorError>| e.unwrap_err().to_string();
        assert_eq!(text(file.floats("flag", &[None])), "field `flag` holds uint8, expected float32");
        assert_eq!(
            text(file.floats("values", &[Some(3), None])),
            "field `values` has the shape 2 × 3, expected 3 × n"
        );
    }

    #[test]
    fn every_prefix_is_refused() {
        let bytes = container();
        for n in 0..bytes.len() {
            assert!(TensorFile::parse(&bytes[..n]).is_err(), "{n} of {}", bytes.len());
        }
    }

    #[test]
    fn an_array_larger_than_the_address_space_is_refused() {
        let mut w = TensorWriter::default();
        w.floats("x", &[1, 1], &[0.0]);
        let mut bytes = w.finish();
        // Both extents follow the header (18 B), name (3 B), rank, type and offset (11 B).
        for extent in bytes[32..48].chunks_mut(8) {
            extent.copy_from_slice(&(1_u64 << 62).to_le_bytes());
        }
        assert_eq!(TensorFile::parse(&bytes).unwrap_err(), TensorError::DataTruncated("x".to_owned()));
    }
}
