//! Tokens of scene text, over bytes and without allocation.

use super::number::{IntegerError, scan_f32, scan_i32};

/// A token with its place in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    /// Offset of the first byte.
    pub(super) start: usize,
    /// Offset behind the last byte.
    pub(super) end: usize,
}

/// The kinds of token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A bare word: a keyword, a number, true, false, or something wrong.
    Word,
    /// A quoted string, quotes included.
    Quoted,
    /// A quoted string without its second quote; ends at the end of the line.
    Unclosed,
    /// `[`.
    Open,
    /// `]`.
    Close,
    /// The end of the file.
    End,
}

/// Why a run of numbers ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RunEnd {
    /// The next token is no number; it has not been consumed.
    Other,
    /// A number is malformed.
    Malformed(Token),
    /// A number does not fit its type.
    OutOfRange(Token),
}

/// A position in scene text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lexer<'a> {
    text: &'a [u8],
    pos: usize,
}

/// What separates tokens: one table look-up a byte.
static DELIMITER: [bool; 256] = members(b" \t\r\n\x0b\x0c\"[]#");

/// What numbers begin with.
static BEGINS_NUMBER: [bool; 256] = members(b"0123456789-+.");

const fn members(set: &[u8]) -> [bool; 256] {
    let mut t = [false; 256];
    let mut i = 0;
    while i < set.len() {
        t[set[i] as usize] = true;
        i += 1;
    }
    t
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a [u8], pos: usize) -> Self {
        Self { text, pos }
    }

    /// Offset of the next unread byte.
    pub(super) fn position(&self) -> usize {
        self.pos
    }

    /// The bytes of a token.
    pub(super) fn bytes(&self, t: Token) -> &'a [u8] {
        &self.text[t.start..t.end]
    }

    /// The next token, which is consumed.
    pub(super) fn next(&mut self) -> Token {
        let t = self.peek();
        self.pos = t.end;
        t
    }

    /// The next token, which stays; the white space and comments before it are consumed.
    pub(super) fn peek(&mut self) -> Token {
        self.skip_blank();
        let start = self.pos;
        let token = |kind, end| Token { kind, start, end };
        match self.text.get(start) {
            None => token(TokenKind::End, start),
            Some(b'[') => token(TokenKind::Open, start + 1),
            Some(b']') => token(TokenKind::Close, start + 1),
            Some(b'"') => {
                let mut i = start + 1;
                loop {
                    match self.text.get(i) {
                        Some(b'"') => return token(TokenKind::Quoted, i + 1),
                        Some(b'\\') if self.text.get(i + 1).is_some_and(|&b| b != b'\n') => i += 2,
                        None | Some(b'\n') => return token(TokenKind::Unclosed, i),
                        Some(_) => i += 1,
                    }
                }
            }
            Some(_) => token(TokenKind::Word, self.word_end(start)),
        }
    }

    /// Appends the numbers that follow until there are `limit`.
    pub(super) fn numbers(&mut self, out: &mut Vec<f32>, limit: usize) -> RunEnd {
        let text = self.text;
        while self.finds_number() && out.len() < limit {
            match text.get(self.pos..).and_then(scan_f32) {
                Some(n) if self.ends_at(self.pos + n.len) => {
                    if !n.value.is_finite() {
                        return RunEnd::OutOfRange(self.next());
                    }
                    out.push(n.value);
                    self.pos += n.len;
                }
                _ => return RunEnd::Malformed(self.next()),
            }
        }
        RunEnd::Other
    }

    /// Appends the integers that follow until there are `limit`.
    pub(super) fn integers(&mut self, out: &mut Vec<i32>, limit: usize) -> RunEnd {
        let text = self.text;
        while self.finds_number() && out.len() < limit {
            match text.get(self.pos..).map_or(Err(IntegerError::NotAnInteger), scan_i32) {
                Ok(n) if self.ends_at(self.pos + n.len) => {
                    out.push(n.value);
                    self.pos += n.len;
                }
                Err(IntegerError::OutOfRange) => return RunEnd::OutOfRange(self.next()),
                _ => return RunEnd::Malformed(self.next()),
            }
        }
        RunEnd::Other
    }

    /// Skips what is blank, and says whether a number begins there.
    #[inline]
    fn finds_number(&mut self) -> bool {
        // One blank before a number is the rule.
        if let Some(b' ') = self.text.get(self.pos) {
            self.pos += 1;
        }
        match self.text.get(self.pos) {
            Some(&b) if BEGINS_NUMBER[usize::from(b)] => true,
            None => false,
            Some(_) => {
                self.skip_blank();
                self.text.get(self.pos).is_some_and(|&b| BEGINS_NUMBER[usize::from(b)])
            }
        }
    }

    #[inline]
    fn ends_at(&self, i: usize) -> bool {
        self.text.get(i).is_none_or(|&b| DELIMITER[usize::from(b)])
    }

    fn word_end(&self, start: usize) -> usize {
        let rest = &self.text[start..];
        start + rest.iter().position(|&b| DELIMITER[usize::from(b)]).unwrap_or(rest.len())
    }

    fn skip_blank(&mut self) {
        loop {
            match self.text.get(self.pos) {
                Some(b' ' | b'\t' | b'\r' | b'\n' | b'\x0b' | b'\x0c') => self.pos += 1,
                Some(b'#') => {
                    let rest = &self.text[self.pos..];
                    self.pos += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
                }
                _ => return,
            }
        }
    }
}

/// The contents of a quoted token: quotes removed, escapes resolved, bytes that are not UTF-8 replaced.
/// `Err` carries the offset of an unknown escape inside the token.
pub(super) fn unquote(token: &[u8]) -> Result<String, usize> {
    let inner = &token[1..token.len().max(2) - 1];
    if !inner.contains(&b'\\') {
        return Ok(String::from_utf8_lossy(inner).into_owned());
    }
    let mut out = Vec::with_capacity(inner.len());
    let mut i = 0;
    while i < inner.len() {
        if inner[i] == b'\\' {
            i += 1;
            out.push(match inner.get(i) {
                Some(b'n') => b'\n',
                Some(b't') => b'\t',
                Some(b'r') => b'\r',
                Some(b'b') => 8,
                Some(b'f') => 12,
                Some(&c @ (b'\\' | b'"' | b'\'')) => c,
                _ => return Err(i),
            });
        } else {
            out.push(inner[i]);
        }
        i += 1;
    }
    Ok(String::from_utf8_lossy(&out).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(TokenKind, String)> {
        let mut l = Lexer::new(text.as_bytes(), 0);
        let mut out = Vec::new();
        loop {
            let t = l.next();
            if t.kind == TokenKind::End {
                return out;
            }
            out.push((t.kind, String::from_utf8_lossy(l.bytes(t)).into_owned()));
        }
    }

    #[test]
    fn text_splits_into_tokens() {
        use TokenKind::{Close, Open, Quoted, Unclosed, Word};
        let expected: Vec<(TokenKind, &str)> = vec![
            (Word, "Shape"),
            (Quoted, "\"a b\""),
            (Open, "["),
            (Word, "1"),
            (Close, "]"),
            (Word, "x"),
            (Quoted, "\"q\\\"#y\""),
            (Unclosed, "\"open"),
            (Word, "End"),
        ];
        let got = kinds("Shape\"a b\"[1]x # comment \"\n\"q\\\"#y\" \"open\nEnd");
        assert_eq!(got.iter().map(|(k, s)| (*k, s.as_str())).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn runs_stop_at_the_first_thing_that_is_no_number() {
        let mut l = Lexer::new(b"1 2.5#c\n-3e1] 4x 5", 0);
        let mut v = Vec::new();
        assert_eq!(l.numbers(&mut v, usize::MAX), RunEnd::Other);
        assert_eq!(v, [1.0, 2.5, -30.0]);
        assert_eq!(l.next().kind, TokenKind::Close);
        let RunEnd::Malformed(t) = l.numbers(&mut v, usize::MAX) else { panic!("4x is malformed") };
        assert_eq!(l.bytes(t), b"4x");
        let mut ints = Vec::new();
        let mut l = Lexer::new(b"7 1.5", 0);
        let RunEnd::Malformed(t) = l.integers(&mut ints, usize::MAX) else { panic!("1.5 is no integer") };
        assert_eq!((ints.as_slice(), l.bytes(t)), (&[7][..], &b"1.5"[..]));
        let mut l = Lexer::new(b"1e39", 0);
        assert!(matches!(l.numbers(&mut v, usize::MAX), RunEnd::OutOfRange(_)));
    }

    #[test]
    fn escapes_resolve_and_unknown_ones_are_refused() {
        assert_eq!(unquote(br#""a\"b\\c\n""#).as_deref(), Ok("a\"b\\c\n"));
        assert_eq!(unquote(br#""a\qb""#), Err(2));
        assert_eq!(unquote(b"\"\""), Ok(String::new()));
    }
}
