//! From tokens to directives. Knows the grammar, and no names of classes or parameters.

use super::directive::{
    ActiveTransform, Directive, Entity, Param, ParamType, Params, Statement, Text, TextureStatement, Values,
};
use super::lexer::{Lexer, RunEnd, Token, TokenKind, unquote};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::files::FileBytes;
use crate::scene::source::{FileId, Span};
use std::sync::Arc;

/// Reads the directives of one file, one at a time.
///
/// A directive that cannot be understood is reported and skipped; of one whose parameters cannot all be understood
/// the others are returned, marked as damaged.
#[derive(Debug)]
pub struct Parser {
    file: FileId,
    bytes: Arc<FileBytes>,
    pos: usize,
}

/// The error has been pushed to the diagnostics.
#[derive(Debug)]
struct Reported;

type Parsed<T> = Result<T, Reported>;

impl Parser {
    /// A parser at the start of a file.
    pub fn new(file: FileId, bytes: Arc<FileBytes>) -> Self {
        let pos = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { file, bytes, pos }
    }

    /// The next directive; `None` at the end of the file. Errors on the way go to `diagnostics`.
    pub fn next_directive(&mut self, diagnostics: &mut Diagnostics) -> Option<Directive> {
        let bytes = Arc::clone(&self.bytes);
        let mut cursor = Cursor { lexer: Lexer::new(&bytes, self.pos), file: self.file, diagnostics };
        let directive = cursor.directive();
        self.pos = cursor.lexer.position();
        directive
    }

    /// The place of the file's last byte.
    pub fn end(&self) -> Span {
        Span { file: self.file, start: self.bytes.len() as u64, len: 0 }
    }
}

struct Cursor<'a> {
    lexer: Lexer<'a>,
    file: FileId,
    diagnostics: &'a mut Diagnostics,
}

/// The first words of directives.
const KEYWORDS: &[&str] = &[
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Import",
    "Include",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "Material",
    "MediumInterface",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "Shape",
    "Texture",
    "Transform",
    "TransformBegin",
    "TransformEnd",
    "TransformTimes",
    "Translate",
    "WorldBegin",
    "WorldEnd",
];

fn is_keyword(word: &[u8]) -> bool {
    word.first().is_some_and(u8::is_ascii_uppercase) && KEYWORDS.iter().any(|k| k.as_bytes() == word)
}

fn is_declaration(quoted: &[u8]) -> bool {
    let inner = &quoted[1..];
    let word_len = inner.iter().position(u8::is_ascii_whitespace).unwrap_or(0);
    std::str::from_utf8(&inner[..word_len]).is_ok_and(|w| ParamType::from_name(w).is_some())
}

fn shown(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LONGEST)]);
    let mut chars = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut out: String = chars.by_ref().take(LONGEST).collect();
    if chars.next().is_some() || bytes.len() > 4 * LONGEST {
        out.push('…');
    }
    out
}

impl Cursor<'_> {
    fn span(&self, t: Token) -> Span {
        Span {
            file: self.file,
            start: t.start as u64,
            len: u32::try_from(t.end - t.start).unwrap_or(u32::MAX),
        }
    }

    fn report<T>(&mut self, d: Diagnostic) -> Parsed<T> {
        self.diagnostics.push(d);
        Err(Reported)
    }

    fn describe(&self, t: Token) -> String {
        match t.kind {
            TokenKind::Word => format!("`{}`", shown(self.lexer.bytes(t))),
            TokenKind::Quoted => format!("the string {}", shown(self.lexer.bytes(t))),
            TokenKind::Unclosed => "an unclosed string".to_owned(),
            TokenKind::Open => "`[`".to_owned(),
            TokenKind::Close => "`]`".to_owned(),
            TokenKind::End => "the end of the file".to_owned(),
        }
    }

    fn expected<T>(&mut self, what: &str, found: Token) -> Parsed<T> {
        let span = self.span(found);
        if found.kind == TokenKind::Unclosed {
            return self.report(Diagnostic::error(span, "this string is not closed on its line"));
        }
        let d = Diagnostic::error(span, format!("expected {what}, found {}", self.describe(found)));
        let word = self.lexer.bytes(found).to_ascii_lowercase();
        let d = match word.strip_prefix(b"-").unwrap_or(&word) {
            b"nan" | b"inf" | b"infinity" => d.with_help("numbers must be finite"),
            _ => d,
        };
        self.report(d)
    }

    fn at_keyword(&self, t: Token) -> bool {
        t.kind == TokenKind::Word && is_keyword(self.lexer.bytes(t))
    }

    fn at_declaration(&self, t: Token) -> bool {
        t.kind == TokenKind::Quoted && is_declaration(self.lexer.bytes(t))
    }

    fn directive(&mut self) -> Option<Directive> {
        loop {
            let t = self.lexer.next();
            let span = self.span(t);
            let statement = match t.kind {
                TokenKind::End => return None,
                TokenKind::Word => self.statement(t),
                _ => self.expected("a directive", t),
            };
            match statement {
                Ok(statement) => return Some(Directive { statement, span }),
                Err(Reported) => self.skip_to_keyword(),
            }
        }
    }

    fn skip_to_keyword(&mut self) {
        loop {
            let t = self.lexer.peek();
            if t.kind == TokenKind::End || self.at_keyword(t) {
                return;
            }
            self.lexer.next();
        }
    }

    fn statement(&mut self, keyword: Token) -> Parsed<Statement> {
        let entity = |s: &mut Self, e: Entity| {
            let name = s.text(keyword)?;
            Ok(Statement::Entity(e, name, s.params()))
        };
        Ok(match self.lexer.bytes(keyword) {
            b"LookAt" => Statement::LookAt(self.numbers(keyword)?),
            b"Translate" => Statement::Translate(self.numbers(keyword)?),
            b"Rotate" => Statement::Rotate(self.numbers(keyword)?),
            b"Scale" => Statement::Scale(self.numbers(keyword)?),
            b"Transform" => Statement::Transform(Box::new(self.numbers(keyword)?)),
            b"ConcatTransform" => Statement::ConcatTransform(Box::new(self.numbers(keyword)?)),
            b"Identity" => Statement::Identity,
            b"CoordinateSystem" => Statement::CoordinateSystem(self.text(keyword)?),
            b"CoordSysTransform" => Statement::CoordSysTransform(self.text(keyword)?),
            b"ActiveTransform" => Statement::ActiveTransform(self.active_transform()?),
            b"TransformTimes" => Statement::TransformTimes(self.numbers(keyword)?),
            b"ReverseOrientation" => Statement::ReverseOrientation,
            b"AttributeBegin" => Statement::AttributeBegin,
            b"AttributeEnd" => Statement::AttributeEnd,
            b"TransformBegin" => Statement::TransformBegin,
            b"TransformEnd" => Statement::TransformEnd,
            b"Attribute" => {
                let target = self.text(keyword)?;
                Statement::Attribute(target, self.params())
            }
            b"Camera" => entity(self, Entity::Camera)?,
            b"Film" => entity(self, Entity::Film)?,
            b"PixelFilter" => entity(self, Entity::PixelFilter)?,
            b"Sampler" => entity(self, Entity::Sampler)?,
            b"Integrator" => entity(self, Entity::Integrator)?,
            b"Accelerator" => entity(self, Entity::Accelerator)?,
            b"Material" => entity(self, Entity::Material)?,
            b"MakeNamedMaterial" => entity(self, Entity::MakeNamedMaterial)?,
            b"MakeNamedMedium" => entity(self, Entity::MakeNamedMedium)?,
            b"Shape" => entity(self, Entity::Shape)?,
            b"LightSource" => entity(self, Entity::LightSource)?,
            b"AreaLightSource" => entity(self, Entity::AreaLightSource)?,
            b"NamedMaterial" => Statement::NamedMaterial(self.text(keyword)?),
            b"Texture" => {
                let (name, value_type, class) =
                    (self.text(keyword)?, self.text(keyword)?, self.text(keyword)?);
                let params = self.params();
                Statement::Texture(Box::new(TextureStatement { name, value_type, class, params }))
            }
            b"MediumInterface" => {
                let inside = self.text(keyword)?;
                let outside = match self.lexer.peek().kind {
                    TokenKind::Quoted | TokenKind::Unclosed => self.text(keyword)?,
                    _ => inside.clone(),
                };
                Statement::MediumInterface(inside, outside)
            }
            b"ObjectBegin" => Statement::ObjectBegin(self.text(keyword)?),
            b"ObjectEnd" => Statement::ObjectEnd,
            b"ObjectInstance" => Statement::ObjectInstance(self.text(keyword)?),
            b"Include" => Statement::Include(self.text(keyword)?),
            b"Import" => Statement::Import(self.text(keyword)?),
            b"ColorSpace" => Statement::ColorSpace(self.text(keyword)?),
            b"Option" => Statement::Option(self.option(keyword)?),
            b"WorldBegin" => Statement::WorldBegin,
            b"WorldEnd" => Statement::WorldEnd,
            word => {
                let name = shown(word);
                let span = self.span(keyword);
                let is_value = matches!(word.first(), Some(b'0'..=b'9' | b'-' | b'+' | b'.'));
                let d = if is_value {
                    Diagnostic::error(span, format!("expected a directive, found `{name}`"))
                        .with_help("several values of a parameter need brackets: [ 1 2 3 ]")
                } else {
                    Diagnostic::error(span, format!("unknown directive `{name}`"))
                        .with_nearest(&name, KEYWORDS.iter().copied())
                };
                return self.report(d);
            }
        })
    }

    fn text(&mut self, keyword: Token) -> Parsed<Text> {
        let t = self.lexer.peek();
        if t.kind != TokenKind::Quoted {
            let what = format!("a quoted name after `{}`", shown(self.lexer.bytes(keyword)));
            return self.expected(&what, t);
        }
        self.lexer.next();
        self.unquoted(t)
    }

    fn unquoted(&mut self, t: Token) -> Parsed<Text> {
        match unquote(self.lexer.bytes(t)) {
            Ok(value) => Ok(Text { value, span: self.span(t) }),
            Err(at) => {
                let span = self.span(Token { kind: t.kind, start: t.start + at, end: t.start + at + 2 });
                let d = Diagnostic::error(span, "unknown escape in a string");
                self.report(d.with_help("write `\\\\` for a backslash; in file names use `/`"))
            }
        }
    }

    /// Exactly `N` numbers, in brackets or not.
    fn numbers<const N: usize>(&mut self, keyword: Token) -> Parsed<[f32; N]> {
        let open = self.open_bracket();
        let mut list = Vec::with_capacity(N);
        let end = self.lexer.numbers(&mut list, usize::MAX);
        let next = self.lexer.peek();
        self.run_end(end, "a number")?;
        let count = list.len();
        if count < N && next.kind == TokenKind::Word && !self.at_keyword(next) {
            return self.expected("a number", next);
        }
        let Ok(array) = <[f32; N]>::try_from(list) else {
            let name = shown(self.lexer.bytes(keyword));
            let span = self.span(keyword);
            return self
                .report(Diagnostic::error(span, format!("`{name}` takes {N} numbers, found {count}")));
        };
        if let Some(open) = open {
            if next.kind != TokenKind::Close {
                return self.not_closed(open, "a number", next);
            }
            self.lexer.next();
        }
        Ok(array)
    }

    fn active_transform(&mut self) -> Parsed<ActiveTransform> {
        let t = self.lexer.peek();
        let which = match self.lexer.bytes(t) {
            b"StartTime" => ActiveTransform::StartTime,
            b"EndTime" => ActiveTransform::EndTime,
            b"All" => ActiveTransform::All,
            _ => return self.expected("`StartTime`, `EndTime` or `All`", t),
        };
        self.lexer.next();
        Ok(which)
    }

    fn open_bracket(&mut self) -> Option<Token> {
        let t = self.lexer.peek();
        (t.kind == TokenKind::Open).then(|| self.lexer.next())
    }

    fn run_end(&mut self, end: RunEnd, what: &str) -> Parsed<()> {
        match end {
            RunEnd::Other => Ok(()),
            RunEnd::Malformed(t) => self.expected(what, t),
            RunEnd::OutOfRange(t) => {
                let text = shown(self.lexer.bytes(t));
                let span = self.span(t);
                self.report(Diagnostic::error(span, format!("`{text}` does not fit 32 bits")))
            }
        }
    }

    /// Reports what stands where a bracket should close: the bracket is to blame when the next thing cannot be a value.
    fn not_closed<T>(&mut self, open: Token, what: &str, next: Token) -> Parsed<T> {
        if next.kind == TokenKind::End || self.at_keyword(next) || self.at_declaration(next) {
            let span = self.span(open);
            return self.report(Diagnostic::error(span, "this `[` is never closed"));
        }
        self.expected(&format!("{what} or `]`"), next)
    }

    fn params(&mut self) -> Params {
        let mut params = Params::default();
        while matches!(self.lexer.peek().kind, TokenKind::Quoted | TokenKind::Unclosed) {
            match self.param() {
                Ok(p) => params.list.push(p),
                Err(Reported) => {
                    params.damaged = true;
                    self.skip_to_declaration();
                }
            }
        }
        params
    }

    fn skip_to_declaration(&mut self) {
        loop {
            let t = self.lexer.peek();
            if t.kind == TokenKind::End || self.at_keyword(t) || self.at_declaration(t) {
                return;
            }
            self.lexer.next();
        }
    }

    fn param(&mut self) -> Parsed<Param> {
        let t = self.lexer.next();
        if t.kind == TokenKind::Unclosed {
            return self.expected("a parameter", t);
        }
        let declaration = self.unquoted(t)?;
        let mut words = declaration.value.split_whitespace();
        let (Some(ty), Some(name), None) = (words.next(), words.next(), words.next()) else {
            let d = Diagnostic::error(
                declaration.span,
                format!("expected a parameter \"type name\", found {}", self.describe(t)),
            );
            return self.report(d);
        };
        let ty = self.param_type(ty, declaration.span)?;
        self.param_values(ty, name.to_owned(), declaration.span)
    }

    fn param_type(&mut self, name: &str, span: Span) -> Parsed<ParamType> {
        match ParamType::from_name(name) {
            Some(ty) => Ok(ty),
            None => {
                let d =
                    Diagnostic::error(span, format!("unknown parameter type \"{}\"", shown(name.as_bytes())));
                self.report(match name {
                    "color" => d.with_help("pbrt-v4 writes \"rgb\" where pbrt-v3 wrote \"color\""),
                    _ => d.with_nearest(name, ParamType::NAMES),
                })
            }
        }
    }

    fn param_values(&mut self, ty: ParamType, name: String, span: Span) -> Parsed<Param> {
        let first = self.lexer.peek();
        let open = self.open_bracket();
        let limit = if open.is_some() { usize::MAX } else { 1 };
        let values = match ty {
            ParamType::Integer => {
                let mut list = Vec::new();
                let end = self.lexer.integers(&mut list, limit);
                self.run_end(end, "an integer")?;
                self.check_single(open, list.len(), "an integer")?;
                Values::Integers(list)
            }
            ParamType::Bool => Values::Bools(self.bools(open.is_some())?),
            ParamType::String | ParamType::Texture => Values::Texts(self.texts(open.is_some())?),
            ParamType::Spectrum if self.lexer.peek().kind == TokenKind::Quoted => {
                Values::Texts(self.texts(open.is_some())?)
            }
            _ => {
                let mut list = Vec::new();
                let end = self.lexer.numbers(&mut list, limit);
                self.run_end(end, "a number")?;
                self.check_single(open, list.len(), "a number")?;
                Values::Numbers(list)
            }
        };
        let mut last = first;
        if let Some(open) = open {
            last = self.lexer.peek();
            if last.kind != TokenKind::Close {
                let what = match values {
                    Values::Integers(_) => "an integer",
                    Values::Numbers(_) => "a number",
                    Values::Bools(_) => "true, false",
                    Values::Texts(_) => "a quoted string",
                };
                return self.not_closed(open, what, last);
            }
            self.lexer.next();
        }
        let value_span = self.span(first).to(self.span(last));
        let param = Param { ty, name, span, values, value_span };
        self.check_arity(&param, open.is_some())?;
        Ok(param)
    }

    /// Without brackets a parameter has one value, no less.
    fn check_single(&mut self, open: Option<Token>, count: usize, what: &str) -> Parsed<()> {
        if open.is_none() && count == 0 {
            let t = self.lexer.peek();
            return self.expected(what, t);
        }
        Ok(())
    }

    fn check_arity(&mut self, p: &Param, bracketed: bool) -> Parsed<()> {
        let (n, arity) = match &p.values {
            Values::Numbers(v) => (v.len(), p.ty.arity()),
            _ => return Ok(()),
        };
        let fault = if p.ty == ParamType::Spectrum && n % 2 != 0 {
            format!("\"{}\" needs pairs of wavelength and value, found {n} numbers", p.name)
        } else if n % arity != 0 {
            format!("\"{}\" is of type {}: it needs {arity} numbers a value, found {n}", p.name, p.ty.name())
        } else {
            return Ok(());
        };
        let d = Diagnostic::error(p.value_span, fault);
        self.report(if bracketed {
            d
        } else {
            d.with_help("several values of a parameter need brackets: [ 1 2 3 ]")
        })
    }

    fn bools(&mut self, bracketed: bool) -> Parsed<Vec<bool>> {
        let mut list = Vec::new();
        loop {
            let t = self.lexer.peek();
            match self.lexer.bytes(t) {
                b"true" => list.push(true),
                b"false" => list.push(false),
                quoted @ (b"\"true\"" | b"\"false\"") => {
                    let plain = shown(&quoted[1..quoted.len() - 1]);
                    let d =
                        Diagnostic::error(self.span(t), format!("expected true or false, found \"{plain}\""))
                            .with_help(format!("write {plain} without quotes, which only pbrt-v3 had"));
                    return self.report(d);
                }
                _ if bracketed && t.kind != TokenKind::Word => return Ok(list),
                _ => return self.expected("true or false", t),
            }
            self.lexer.next();
            if !bracketed {
                return Ok(list);
            }
        }
    }

    fn texts(&mut self, bracketed: bool) -> Parsed<Vec<Text>> {
        let mut list = Vec::new();
        loop {
            let t = self.lexer.peek();
            if t.kind == TokenKind::Quoted {
                self.lexer.next();
                list.push(self.unquoted(t)?);
                if !bracketed {
                    return Ok(list);
                }
            } else if bracketed && t.kind != TokenKind::Unclosed {
                return Ok(list);
            } else {
                return self.expected("a quoted string", t);
            }
        }
    }

    /// `Option` takes a name and a value of any kind, or a declared parameter like everybody else.
    fn option(&mut self, keyword: Token) -> Parsed<Param> {
        let name = self.text(keyword)?;
        let mut words = name.value.split_whitespace();
        if let (Some(ty), Some(plain)) = (words.next(), words.next()) {
            let ty = self.param_type(ty, name.span)?;
            return self.param_values(ty, plain.to_owned(), name.span);
        }
        let mut ahead = self.lexer;
        let mut t = ahead.next();
        if t.kind == TokenKind::Open {
            t = ahead.next();
        }
        let word = self.lexer.bytes(t);
        let ty = match (t.kind, word) {
            (TokenKind::Quoted, _) => ParamType::String,
            (_, b"true" | b"false") => ParamType::Bool,
            (_, w) if w.iter().all(|b| b.is_ascii_digit() || *b == b'-') => ParamType::Integer,
            _ => ParamType::Float,
        };
        self.param_values(ty, name.value, name.span)
    }
}
