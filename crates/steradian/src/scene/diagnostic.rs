//! Errors, warnings and notices that point at the text.

use super::source::{Places, SourceMap, Span};
use std::fmt;

/// How serious a diagnostic is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene cannot be rendered as it is.
    Error,
    /// The scene is rendered, but probably not as its author meant it.
    Warning,
    /// Something worth knowing that leaves the picture as it is.
    Notice,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Notice => "notice",
        })
    }
}

/// One message about the scene.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// How serious it is.
    pub severity: Severity,
    /// What is the matter, in lower case and without a full stop.
    pub message: String,
    /// Where; `None` when the message concerns no particular place.
    pub span: Option<Span>,
    /// The place in a data file, such as that of a luminaire, when the fault lies there; `span` then names the file.
    pub quoted: Option<Quoted>,
    /// What to do about it.
    pub help: Option<String>,
    /// Other places that belong to the message, such as an earlier definition.
    pub related: Vec<Related>,
}

/// A place in a text that is not part of the scene's own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quoted {
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Character in the line, from 1.
    pub column: usize,
    /// Number of characters, at least 1.
    pub length: usize,
    /// The line.
    pub text: String,
}

/// Characters of a quoted line that are shown.
const QUOTED_WIDTH: usize = 120;

impl Quoted {
    fn write(&self, f: &mut fmt::Formatter<'_>, message: &str) -> fmt::Result {
        write!(f, "{}:{}:{}: {message}", self.file, self.line, self.column)?;
        if self.text.trim().is_empty() {
            return Ok(());
        }
        // Of a long line the part around the place.
        let before = self.column.saturating_sub(1);
        let skipped =
            if before + self.length > QUOTED_WIDTH { before.saturating_sub(QUOTED_WIDTH / 2) } else { 0 };
        let shown: String = self
            .text
            .chars()
            .skip(skipped)
            .take(QUOTED_WIDTH)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let gutter = self.line.to_string();
        let (pad, caret) = (gutter.len(), before - skipped);
        let marks = "^".repeat(self.length.clamp(1, QUOTED_WIDTH));
        write!(f, "\n {gutter} | {shown}\n {:pad$} | {:caret$}{marks}", "", "")
    }
}

/// A second place that a diagnostic refers to.
#[derive(Clone, Debug)]
pub struct Related {
    /// The place.
    pub span: Span,
    /// What it has to do with the message.
    pub message: String,
}

impl Diagnostic {
    fn new(severity: Severity, span: Span, message: impl Into<String>) -> Self {
        Self {
            severity,
            message: message.into(),
            span: Some(span),
            quoted: None,
            help: None,
            related: Vec::new(),
        }
    }

    /// An error at a place.
    pub fn error(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, span, message)
    }

    /// An error that concerns no place in a file that could be read.
    pub fn unplaced_error(message: impl Into<String>) -> Self {
        let message = message.into();
        Self { severity: Severity::Error, message, span: None, quoted: None, help: None, related: Vec::new() }
    }

    /// A warning at a place.
    pub fn warning(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, span, message)
    }

    /// A notice at a place.
    pub fn notice(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Notice, span, message)
    }

    /// The same diagnostic with advice.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same diagnostic about a place in a data file, which its span names.
    #[must_use]
    pub fn in_file(mut self, quoted: Quoted) -> Self {
        self.quoted = Some(quoted);
        self
    }

    /// The same diagnostic with "did you mean" advice when one of `candidates` is close to `name`.
    #[must_use]
    pub fn with_nearest<'a>(self, name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(name, candidates) {
            Some(n) => self.with_help(format!("did you mean \"{n}\"?")),
            None => self,
        }
    }

    /// The same diagnostic with a second place.
    #[must_use]
    pub fn with_related(mut self, span: Span, message: impl Into<String>) -> Self {
        self.related.push(Related { span, message: message.into() });
        self
    }

    /// The full text of the diagnostic: place, message, source line with underline, help and related places.
    pub fn display<'a>(&'a self, sources: &'a SourceMap) -> impl fmt::Display + 'a {
        Alone { diagnostic: self, sources }
    }

    /// All places that the text mentions.
    fn spans(&self, sources: &SourceMap) -> Vec<Span> {
        let mut spans: Vec<Span> = self.span.into_iter().chain(self.related.iter().map(|r| r.span)).collect();
        spans.extend(self.included_from(sources));
        spans
    }

    /// The directives that brought the file in, from the innermost.
    fn included_from<'a>(&self, sources: &'a SourceMap) -> impl Iterator<Item = Span> + use<'a> {
        let from = |span: Span| sources.file(span.file).and_then(|file| file.included_from);
        std::iter::successors(self.span.and_then(from), move |span| from(*span))
    }
}

struct Alone<'a> {
    diagnostic: &'a Diagnostic,
    sources: &'a SourceMap,
}

impl fmt::Display for Alone<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { diagnostic, sources } = *self;
        let places = sources.places(diagnostic.spans(sources));
        Rendered { diagnostic, sources, places: &places }.fmt(f)
    }
}

struct Rendered<'a> {
    diagnostic: &'a Diagnostic,
    sources: &'a SourceMap,
    places: &'a Places,
}

impl fmt::Display for Rendered<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let d = self.diagnostic;
        let message = format!("{}: {}", d.severity, d.message);
        match (&d.quoted, d.span) {
            (Some(quoted), span) => {
                quoted.write(f, &message)?;
                if let Some(span) = span {
                    writeln!(f)?;
                    self.place(f, span, "note: the file is named here")?;
                }
            }
            (None, Some(span)) => self.place(f, span, &message)?,
            (None, None) => f.write_str(&message)?,
        }
        if let Some(help) = &d.help {
            write!(f, "\n  help: {help}")?;
        }
        for r in &d.related {
            writeln!(f)?;
            self.place(f, r.span, &format!("note: {}", r.message))?;
        }
        for span in d.included_from(self.sources) {
            let l = self.sources.locate(self.places, span);
            write!(f, "\n  included from {}:{}:{}", l.file, l.line, l.column)?;
        }
        Ok(())
    }
}

impl Rendered<'_> {
    fn place(&self, f: &mut fmt::Formatter<'_>, span: Span, message: &str) -> fmt::Result {
        let l = self.sources.locate(self.places, span);
        write!(f, "{}:{}:{}: {message}", l.file, l.line, l.column)?;
        if let Some(e) = self.sources.excerpt(span).filter(|e| !e.text.trim().is_empty()) {
            let gutter = l.line.to_string();
            write!(f, "\n {gutter} | {}", e.text)?;
            let pad = gutter.len();
            write!(f, "\n {:pad$} | {:caret$}{}", "", "", "^".repeat(e.len), caret = e.caret)?;
        }
        Ok(())
    }
}

/// The diagnostics of one scene, in the order in which they were found.
///
/// At most [`Diagnostics::LIMIT`] errors and as many others are kept; the rest are counted.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    kept: Vec<Diagnostic>,
    errors: usize,
    others: usize,
    dropped: usize,
}

impl Diagnostics {
    /// Number of errors that are kept, and of other diagnostics.
    pub const LIMIT: usize = 100;

    /// No diagnostics.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether one more diagnostic of that severity would be kept.
    pub fn keeps(&self, severity: Severity) -> bool {
        let seen = if severity == Severity::Error { self.errors } else { self.others };
        seen < Self::LIMIT
    }

    /// Adds a diagnostic; beyond the limit it is only counted.
    pub fn push(&mut self, d: Diagnostic) {
        let keeps = self.keeps(d.severity);
        *(if d.severity == Severity::Error { &mut self.errors } else { &mut self.others }) += 1;
        if keeps {
            self.kept.push(d);
        } else {
            self.dropped += 1;
        }
    }

    /// Adds an error at a place.
    pub fn error(&mut self, span: Span, message: impl Into<String>) {
        self.push(Diagnostic::error(span, message));
    }

    /// Adds a warning at a place.
    pub fn warning(&mut self, span: Span, message: impl Into<String>) {
        self.push(Diagnostic::warning(span, message));
    }

    /// Adds a notice at a place.
    pub fn notice(&mut self, span: Span, message: impl Into<String>) {
        self.push(Diagnostic::notice(span, message));
    }

    /// Whether any of them, kept or dropped, is an error.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Number of errors, kept or dropped.
    pub fn error_count(&self) -> usize {
        self.errors
    }

    /// Number of diagnostics beyond the limit.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// The diagnostics that were kept.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.kept.iter()
    }

    /// The text of all diagnostics, each followed by a line end; reads every file once at most.
    pub fn display<'a>(&'a self, sources: &'a SourceMap) -> impl fmt::Display + 'a {
        self.display_where(sources, |_| true)
    }

    /// The same as [`Diagnostics::display`] for the diagnostics that meet a condition.
    pub fn display_where<'a>(
        &'a self,
        sources: &'a SourceMap,
        shown: impl Fn(&Diagnostic) -> bool,
    ) -> impl fmt::Display + 'a {
        let shown = self.iter().filter(|d| shown(d)).collect();
        RenderedAll { shown, dropped: self.dropped, sources }
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

struct RenderedAll<'a> {
    shown: Vec<&'a Diagnostic>,
    dropped: usize,
    sources: &'a SourceMap,
}

impl fmt::Display for RenderedAll<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shown, sources, dropped } = self;
        let places = sources.places(shown.iter().flat_map(|d| d.spans(sources)));
        for diagnostic in shown {
            writeln!(f, "{}", Rendered { diagnostic, sources, places: &places })?;
        }
        match dropped {
            0 => Ok(()),
            n => writeln!(f, "… and {n} more messages"),
        }
    }
}

/// The candidate closest to `name` by edit distance, ignoring case; `None` when none is close enough to be a slip
/// (a third of the name's length, at least one edit). Of equally close candidates the first wins.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = name.to_lowercase();
    let limit = (name.chars().count() / 3).max(1);
    let mut best: Option<(usize, &str)> = None;
    for c in candidates {
        let d = strsim::osa_distance(&wanted, &c.to_lowercase());
        if d <= limit && best.is_none_or(|(b, _)| d < b) {
            best = Some((d, c));
        }
    }
    best.map(|(_, c)| c)
}

#[cfg(test)]
mod tests {
    use super::super::files::FileBytes;
    use super::*;
    use std::sync::Arc;

    fn bytes(text: &str) -> Arc<FileBytes> {
        Arc::new(FileBytes::Owned(text.as_bytes().to_vec()))
    }

    #[test]
    fn a_diagnostic_shows_place_line_caret_help_and_include_chain() {
        let mut sources = SourceMap::new();
        let main = sources.add("main.pbrt", bytes("WorldBegin\nInclude \"g.pbrt\"\n"), None);
        let include = Span { file: main, start: 11, len: 7 };
        let inner = sources.add("g.pbrt", bytes("  Shape \"spheer\" \"float radius\" 1\n"), Some(include));
        let d = Diagnostic::error(Span { file: inner, start: 8, len: 8 }, "unknown shape \"spheer\"")
            .with_nearest("spheer", ["disk", "sphere"])
            .with_related(Span { file: main, start: 0, len: 10 }, "the world begins here");
        assert_eq!(
            d.display(&sources).to_string(),
            "g.pbrt:1:9: error: unknown shape \"spheer\"\n\
             \x201 |   Shape \"spheer\" \"float radius\" 1\n\
             \x20  |         ^^^^^^^^\n\
             \x20 help: did you mean \"sphere\"?\n\
             main.pbrt:1:1: note: the world begins here\n\
             \x201 | WorldBegin\n\
             \x20  | ^^^^^^^^^^\n\
             \x20 included from main.pbrt:2:1"
        );
    }

    #[test]
    fn diagnostics_beyond_the_limit_are_counted() {
        let mut sources = SourceMap::new();
        let file = sources.add("a", bytes("x"), None);
        let mut all = Diagnostics::new();
        all.warning(Span { file, start: 0, len: 1 }, "w");
        for i in 0..Diagnostics::LIMIT + 7 {
            all.error(Span { file, start: 0, len: 1 }, format!("e{i}"));
        }
        assert_eq!((all.iter().count(), all.error_count(), all.dropped()), (101, 107, 7));
        let shown = all.display(&sources).to_string();
        assert!(shown.ends_with("… and 7 more messages\n"));
        let errors = all.display_where(&sources, |d| d.severity == Severity::Error).to_string();
        assert_eq!(shown.split_once(" | ^\n").map(|(_, rest)| rest), Some(errors.as_str()));
    }

    #[test]
    fn nearest_suggests_slips_only() {
        let names = ["sphere", "disk", "cylinder"];
        assert_eq!(nearest("Spehre", names), Some("sphere"));
        assert_eq!(nearest("disc", names), Some("disk"));
        assert_eq!(nearest("torus", names), None);
    }
}
