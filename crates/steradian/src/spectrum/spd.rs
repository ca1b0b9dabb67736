//! `.spd` text: one wavelength [nm] and one value a line, `#` begins a comment.

use super::tabulated::{TableError, Tabulated};
use thiserror::Error;

/// Why a text is no spectrum. Lines count from 1.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SpdError {
    /// A word is not a number.
    #[error("line {line}: `{word}` is not a number")]
    NotANumber {
        /// Where.
        line: usize,
        /// The word.
        word: String,
    },
    /// The numbers are no table.
    #[error("line {line}: {error}")]
    Table {
        /// Where.
        line: usize,
        /// Why not.
        error: TableError,
    },
    /// There are no numbers.
    #[error("no samples: a spectrum needs at least one wavelength and value")]
    Empty,
}

/// Reads a spectrum; the numbers alternate between wavelength [nm] and value, wherever the lines break.
pub fn parse(text: &str) -> Result<Tabulated, SpdError> {
    let mut numbers = Vec::new();
    let mut lines = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let data = line.split('#').next().unwrap_or_default();
        for word in data.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()) {
            let number: f32 =
                word.parse().map_err(|_| SpdError::NotANumber { line: i + 1, word: word.to_owned() })?;
            numbers.push(number);
            lines.push(i + 1);
        }
    }
    Tabulated::from_interleaved(&numbers).map_err(|error| match error.pair() {
        Some(pair) => SpdError::Table { line: lines[2 * pair], error },
        None => SpdError::Empty,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn comments_blank_lines_and_windows_line_ends_are_skipped() {
        let t = parse("# glass\r\n\r\n400 1.5 # blue\r\n700\t1.4\r\n").unwrap();
        assert_eq!(t.samples().collect::<Vec<_>>(), [(400.0, 1.5), (700.0, 1.4)]);
    }

    #[test]
    fn errors_carry_the_line() {
        let line = |text: &str| match parse(text) {
            Err(SpdError::NotANumber { line, .. } | SpdError::Table { line, .. }) => Some(line),
            Err(SpdError::Empty) => None,
            Ok(t) => panic!("{t:?}"),
        };
        assert_eq!(line("400 1\n500 x\n"), Some(2));
        assert_eq!(line("# head\n400 1\n\n300 1\n"), Some(4));
        assert_eq!(line("400 1\n500\n"), Some(2));
        assert_eq!(line("400 1\n500 NaN\n"), Some(2));
        assert_eq!(line("400 1\n500 1e99\n"), Some(2));
        assert_eq!(line("# nothing\n"), None);
        assert_eq!(parse("400 1\n500 x\n").unwrap_err().to_string(), "line 2: `x` is not a number");
    }

    proptest! {
        #[test]
        fn any_text_gives_a_spectrum_or_an_error(text in ".{0,200}") {
            if let Ok(t) = parse(&text) {
                let (lo, hi) = t.range();
                prop_assert!(lo > 0.0 && lo <= hi && hi.is_finite());
            }
        }

        #[test]
        fn written_samples_are_read_back(
            steps in prop::collection::vec((0.5_f32..50.0, -1e3_f32..1e3), 1..40),
        ) {
            let mut lambda = 100.0;
            let pairs: Vec<_> = steps.iter().map(|&(d, v)| { lambda += d; (lambda, v) }).collect();
            let text: String = pairs.iter().map(|(l, v)| format!("{l} {v}\n")).collect();
            prop_assert_eq!(parse(&text).unwrap().samples().collect::<Vec<_>>(), pairs);
        }
    }
}
