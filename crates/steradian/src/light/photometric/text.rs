//! The text of a photometric file: lines, words, and places for messages.

use thiserror::Error;

/// Why a file is no luminaire; it points at the text.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}, column {column}: {message}")]
pub struct PhotometricError {
    /// The file of tilt factors that the fault lies in; `None` for the luminaire's own file.
    pub file: Option<String>,
    /// Line, from 1.
    pub line: usize,
    /// Character in the line, from 1.
    pub column: usize,
    /// Number of characters that the message is about, at least 1.
    pub length: usize,
    /// The line.
    pub text: String,
    /// What is wrong.
    pub message: String,
}

/// A word and its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'t> {
    pub(super) text: &'t str,
    /// Index of the line.
    pub(super) line: usize,
    /// Offset in the line [bytes].
    pub(super) start: usize,
}

/// A file as lines.
#[derive(Clone, Debug)]
pub(super) struct Lines<'t> {
    lines: Vec<&'t str>,
}

/// The text of a file: UTF-8, or else Latin-1, as which older programs wrote names.
pub(super) fn decode(bytes: &[u8]) -> String {
    // What follows the end-of-file mark of DOS is no text.
    let bytes = bytes.split(|b| *b == 0x1a).next().unwrap_or_default();
    match std::str::from_utf8(bytes) {
        Ok(text) => text.trim_start_matches('\u{feff}').to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

impl<'t> Lines<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        let unix = text.split('\n').map(|l| l.strip_suffix('\r').unwrap_or(l));
        // Files of old Macintosh programs have carriage returns alone.
        Self { lines: unix.flat_map(|l| l.split('\r')).collect() }
    }

    pub(super) fn len(&self) -> usize {
        self.lines.len()
    }

    /// A line without the spaces around it; `None` after the last.
    pub(super) fn line(&self, index: usize) -> Option<Word<'t>> {
        let line = *self.lines.get(index)?;
        let start = line.len() - line.trim_start().len();
        Some(Word { text: line.trim(), line: index, start })
    }

    /// Whether there are only blank lines from that one on.
    pub(super) fn is_blank_from(&self, index: usize) -> bool {
        self.lines.iter().skip(index).all(|l| l.trim().is_empty())
    }

    /// The words of a line, which spaces and commas part.
    pub(super) fn words(&self, index: usize) -> impl Iterator<Item = Word<'t>> + use<'t> {
        let line = self.lines.get(index).copied().unwrap_or_default();
        let is_gap = |c: char| c.is_whitespace() || c == ',';
        let mut at = 0;
        std::iter::from_fn(move || {
            let rest = &line[at..];
            let start = at + rest.find(|c| !is_gap(c))?;
            let length = line[start..].find(is_gap).unwrap_or(line.len() - start);
            at = start + length;
            Some(Word { text: &line[start..at], line: index, start })
        })
    }

    /// An error about a word.
    pub(super) fn error(&self, word: Word<'_>, message: impl Into<String>) -> PhotometricError {
        let text = self.lines.get(word.line).copied().unwrap_or_default();
        PhotometricError {
            file: None,
            line: word.line + 1,
            column: text.get(..word.start).unwrap_or(text).chars().count() + 1,
            length: word.text.chars().count().max(1),
            text: text.to_owned(),
            message: message.into(),
        }
    }

    /// An error about what is missing at the end of the file: after its last line that is not blank.
    pub(super) fn error_at_end(&self, message: impl Into<String>) -> PhotometricError {
        let last = (0..self.lines.len()).rev().find(|i| !self.lines[*i].trim().is_empty()).unwrap_or(0);
        let end = self.lines.get(last).map_or(0, |l| l.trim_end().len());
        self.error(Word { text: "", line: last, start: end }, message)
    }
}

/// A number; its decimal mark may be a comma.
pub(super) fn number(text: &str) -> Option<f64> {
    let plain = text.parse().ok().or_else(|| text.replace(',', ".").parse().ok());
    // "inf" and "nan" are words.
    plain.filter(|x: &f64| x.is_finite() && !text.contains(['n', 'N']))
}

/// A whole number within bounds, which may be written with decimals.
pub(super) fn whole(text: &str, bounds: std::ops::RangeInclusive<i64>) -> Option<i64> {
    let x = number(text)?;
    (x.fract() == 0.0 && x.abs() < 1e15).then_some(x as i64).filter(|i| bounds.contains(i))
}
