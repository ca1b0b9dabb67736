//! Source files and places in them.

use super::files::FileBytes;
use crate::math::hash;
use std::sync::Arc;

/// Index of a file in a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(u32);

/// A stretch of bytes in a source file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// Offset of the first byte.
    pub start: u64,
    /// Number of bytes.
    pub len: u32,
}

impl Span {
    /// The stretch from the start of `self` to the end of `end`, in the file of `self`.
    #[must_use]
    pub fn to(self, end: Self) -> Self {
        let stop = (end.start + u64::from(end.len)).max(self.start);
        Self { len: u32::try_from(stop - self.start).unwrap_or(u32::MAX), ..self }
    }
}

/// One file of a scene: its name as the user wrote it and its (decompressed) bytes.
#[derive(Debug)]
pub struct SourceFile {
    /// Name for messages.
    pub name: String,
    /// Contents.
    pub bytes: Arc<FileBytes>,
    /// The Include or Import that brought the file in; `None` for a file named by the user.
    pub included_from: Option<Span>,
}

/// The files that a scene was read from; owns what spans point into.
#[derive(Debug, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

/// A place in human terms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location<'a> {
    /// File name.
    pub file: &'a str,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// Where the starts of some spans are, in order of file and offset.
#[derive(Debug)]
pub(super) struct Places {
    found: Vec<((FileId, u64), Place)>,
}

/// Line and column, from 1.
#[derive(Clone, Copy, Debug)]
struct Place {
    line: usize,
    column: usize,
}

impl Place {
    /// The place that follows `text`, when `text` begins here.
    fn after(self, text: &[u8]) -> Self {
        let start = line_start(text);
        let columns = String::from_utf8_lossy(&text[start..]).chars().count();
        match text[..start].iter().filter(|&&b| b == b'\n').count() {
            0 => Self { column: self.column + columns, ..self },
            lines => Self { line: self.line + lines, column: 1 + columns },
        }
    }
}

/// The part of a source line that a message shows, with the underlined columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Excerpt {
    pub(super) text: String,
    pub(super) caret: usize,
    pub(super) len: usize,
}

impl SourceMap {
    /// No files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file and returns its id.
    pub fn add(
        &mut self,
        name: impl Into<String>,
        bytes: Arc<FileBytes>,
        included_from: Option<Span>,
    ) -> FileId {
        let id = FileId(u32::try_from(self.files.len()).unwrap_or(u32::MAX));
        self.files.push(SourceFile { name: name.into(), bytes, included_from });
        id
    }

    /// The file of that id; `None` for an id of another map.
    pub fn file(&self, id: FileId) -> Option<&SourceFile> {
        self.files.get(id.0 as usize)
    }

    /// Hash of the contents of all files, in the order in which they were read.
    pub fn content_hash(&self) -> u64 {
        self.files.iter().fold(0, |hash, file| {
            let hash = hash::combine(hash, file.bytes.len() as u64);
            let (words, rest) = file.bytes.as_chunks::<8>();
            let hash = words.iter().fold(hash, |h, &word| hash::combine(h, u64::from_le_bytes(word)));
            let mut last = [0; 8];
            last[..rest.len()].copy_from_slice(rest);
            if rest.is_empty() { hash } else { hash::combine(hash, u64::from_le_bytes(last)) }
        })
    }

    /// A span at the very start of the file, for errors about the file as a whole.
    pub fn start_of(&self, file: FileId) -> Span {
        Span { file, start: 0, len: 0 }
    }

    /// File, line and column of the start of a span; takes time linear in the offset. A span that lies
    /// outside its file is located at the file's end, a span of another map at an unnamed file.
    pub fn location(&self, span: Span) -> Location<'_> {
        self.locate(&self.places([span]), span)
    }

    /// Lines and columns of the starts of many spans, in one pass over each of their files.
    pub(super) fn places(&self, spans: impl IntoIterator<Item = Span>) -> Places {
        let mut starts: Vec<(FileId, u64)> = spans.into_iter().map(|s| (s.file, s.start)).collect();
        starts.sort_unstable();
        starts.dedup();
        let mut found = Vec::with_capacity(starts.len());
        for of_file in starts.chunk_by(|a, b| a.0 == b.0) {
            let bytes: &[u8] = self.file(of_file[0].0).map_or(&[], |f| &f.bytes);
            let (mut read, mut place) = (0, Place { line: 1, column: 1 });
            for &(file, start) in of_file {
                let (before, _) = split(bytes, start);
                place = place.after(&before[read..]);
                read = before.len();
                found.push(((file, start), place));
            }
        }
        Places { found }
    }

    /// The start of a span, which was among those that `places` was made of.
    pub(super) fn locate(&self, places: &Places, span: Span) -> Location<'_> {
        let name = self.file(span.file).map_or("", |f| f.name.as_str());
        let wanted = (span.file, span.start);
        let found = places.found.binary_search_by_key(&wanted, |(start, _)| *start);
        debug_assert!(found.is_ok(), "the span is not among those that were looked for");
        let place = found.map_or(Place { line: 1, column: 1 }, |i| places.found[i].1);
        Location { file: name, line: place.line, column: place.column }
    }

    /// The source line around a span, cut to about a hundred characters around it.
    pub(super) fn excerpt(&self, span: Span) -> Option<Excerpt> {
        const BEFORE: usize = 60;
        const TOTAL: usize = 110;
        let bytes = &self.file(span.file)?.bytes;
        let (before, after) = split(bytes, span.start);
        // A line may be as long as the file.
        let near = before.len().saturating_sub(4 * BEFORE + 1);
        let start = near + line_start(&before[near..]);
        let line_len = after.iter().take(4 * TOTAL).position(|&b| b == b'\n' || b == b'\r');
        let (rest, cut_right) = match line_len {
            Some(n) => (&after[..n], false),
            None => (&after[..after.len().min(4 * TOTAL)], after.len() > 4 * TOTAL),
        };
        let clean = |b: &[u8]| -> Vec<char> {
            String::from_utf8_lossy(b).chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
        };
        let left = clean(&before[start.max(before.len().saturating_sub(4 * BEFORE))..]);
        let cut_left = left.len() > BEFORE || before.len() - start > 4 * BEFORE;
        let left = &left[left.len().saturating_sub(BEFORE)..];
        let right = clean(rest);
        let cut_right = cut_right || right.len() > TOTAL - left.len();
        let right = &right[..right.len().min(TOTAL - left.len())];
        let mut text = String::new();
        text.extend(cut_left.then_some('…'));
        text.extend(left);
        let caret = text.chars().count();
        text.extend(right);
        text.extend(cut_right.then_some('…'));
        let spanned = &rest[..rest.len().min(span.len as usize)];
        let len = String::from_utf8_lossy(spanned).chars().count().clamp(1, right.len().max(1));
        Some(Excerpt { text: text.trim_end().to_owned(), caret, len })
    }
}

fn split(bytes: &[u8], at: u64) -> (&[u8], &[u8]) {
    bytes.split_at(usize::try_from(at).unwrap_or(usize::MAX).min(bytes.len()))
}

fn line_start(before: &[u8]) -> usize {
    before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn map(text: &str) -> (SourceMap, FileId) {
        let mut m = SourceMap::new();
        let id = m.add("a.pbrt", Arc::new(FileBytes::Owned(text.as_bytes().to_vec())), None);
        (m, id)
    }

    #[test]
    fn location_counts_lines_and_characters_from_one() {
        let (m, file) = map("Scale 1 1 1\n\tä \"x\"\n");
        let at = |start| {
            let l = m.location(Span { file, start, len: 1 });
            (l.line, l.column)
        };
        assert_eq!(at(0), (1, 1));
        assert_eq!(at(6), (1, 7));
        assert_eq!(at(12), (2, 1));
        // ä takes two bytes and one column
        assert_eq!(at(16), (2, 4));
        assert_eq!(at(1000), (3, 1));
    }

    proptest! {
        #[test]
        fn places_found_together_are_those_found_alone(
            text in "[aä\n]{0,60}",
            starts in prop::collection::vec(0_u64..100, 0..20),
        ) {
            let (mut m, file) = map(&text);
            let other = m.add("b.pbrt", Arc::new(FileBytes::Owned(b"x\ny".to_vec())), None);
            let boundary = |s: &u64| usize::try_from(*s).is_ok_and(|s| s >= text.len() || text.is_char_boundary(s));
            let in_a = starts.into_iter().filter(boundary).map(|start| Span { file, start, len: 1 });
            let spans: Vec<Span> = in_a.chain([Span { file: other, start: 2, len: 1 }]).collect();
            let places = m.places(spans.iter().copied());
            for &span in &spans {
                prop_assert_eq!(m.locate(&places, span), m.location(span));
                if span.file == file {
                    let before: String = text.bytes().take(span.start as usize).map(char::from).collect();
                    prop_assert_eq!(m.location(span).line, before.split('\n').count());
                }
            }
        }
    }

    #[test]
    fn excerpt_of_a_long_line_is_a_window_around_the_span() {
        let text = format!("{}BAD{}\nnext", "1 ".repeat(4000), " 2".repeat(4000));
        let (m, file) = map(&text);
        let e = m.excerpt(Span { file, start: 8000, len: 3 }).unwrap();
        assert!(e.text.starts_with('…') && e.text.ends_with('…'));
        let chars: Vec<char> = e.text.chars().collect();
        assert_eq!(chars[e.caret..e.caret + e.len].iter().collect::<String>(), "BAD");
        assert!(chars.len() <= 112);
    }

    #[test]
    fn excerpt_at_the_end_of_the_file_and_of_another_file() {
        let (m, file) = map("Scale");
        let e = m.excerpt(Span { file, start: 5, len: 1 }).unwrap();
        assert_eq!((e.text.as_str(), e.caret, e.len), ("Scale", 5, 1));
        assert!(m.excerpt(Span { file: FileId(3), start: 0, len: 0 }).is_none());
    }
}
