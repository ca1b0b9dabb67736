//! Typed access to the parameters of one directive.

use super::context::Context;
use crate::color::ColorSpaceKind;
use crate::math::{Point, Vec2, Vec3};
use crate::scene::desc::{FileRef, FloatParam, TextureId};
use crate::scene::diagnostic::{Diagnostic, nearest};
use crate::scene::source::Span;
use crate::scene::text::{Param, ParamType, Params, Text, Values};
use std::fmt;
use std::rc::Rc;

/// A parameter that an `Attribute` directive set for later entities of its block.
#[derive(Clone, Debug)]
pub(super) struct Preset {
    pub(super) param: Rc<Param>,
    pub(super) color_space: ColorSpaceKind,
}

/// The parameters of one directive, with the shared context.
///
/// An accessor reports what is wrong with its parameter and then answers as if it were absent, so that readers go on
/// and find every error; nobody sees the resulting description.
pub(super) struct Args<'c> {
    pub(super) ctx: &'c mut Context,
    own: Vec<Slot>,
    presets: &'c [Preset],
    asked: Vec<&'static str>,
    damaged: bool,
    /// Whether the class is known, so that other parameters can be called wrong.
    understood: bool,
    color_space: ColorSpaceKind,
    /// What the parameters belong to, for messages: `shape "sphere"`.
    subject: String,
    /// The class name.
    pub(super) span: Span,
    /// Textures that the parameters refer to.
    pub(super) uses: Vec<TextureId>,
}

/// A parameter of the directive; its place outlives its value.
struct Slot {
    name: String,
    span: Span,
    param: Option<Param>,
}

/// A parameter on its way to a reader.
pub(super) struct Taken {
    pub(super) param: Param,
    pub(super) color_space: ColorSpaceKind,
}

/// Several values with their place.
#[derive(Debug)]
pub(super) struct Many<T> {
    pub(super) values: Vec<T>,
    pub(super) span: Span,
}

impl<'c> Args<'c> {
    pub(super) fn new(
        ctx: &'c mut Context,
        params: Params,
        presets: &'c [Preset],
        color_space: ColorSpaceKind,
        subject: String,
        span: Span,
    ) -> Self {
        let list = params.list;
        for (first, again) in repetitions(&list) {
            let d = Diagnostic::error(again.span, format!("parameter \"{}\" is given twice", again.name));
            ctx.diagnostics.push(d.with_related(first.span, "it was given here first"));
        }
        let slot = |p: Param| Slot { name: p.name.clone(), span: p.span, param: Some(p) };
        let own = list.into_iter().map(slot).collect();
        let damaged = params.damaged;
        Self {
            ctx,
            own,
            presets,
            asked: Vec::new(),
            damaged,
            understood: true,
            color_space,
            subject,
            span,
            uses: Vec::new(),
        }
    }

    /// The colour space in force.
    pub(super) fn color_space(&self) -> ColorSpaceKind {
        self.color_space
    }

    /// Names the subject once its class is known.
    pub(super) fn set_subject(&mut self, subject: String) {
        self.subject = subject;
    }

    /// Reports every parameter that no accessor asked for.
    pub(super) fn finish(self) -> Vec<TextureId> {
        for p in self.own.into_iter().filter(|s| s.param.is_some()) {
            if !self.understood || self.asked.contains(&p.name.as_str()) {
                continue;
            }
            let message = format!("{} has no parameter \"{}\"", self.subject, p.name);
            let d = Diagnostic::error(p.span, message).with_nearest(&p.name, self.asked.iter().copied());
            self.ctx.diagnostics.push(d);
        }
        self.uses
    }

    /// Reports a class name that nobody knows; its parameters are then nobody's concern.
    pub(super) fn unknown_class(&mut self, kind: &str, class: &Text, known: &[&str], of_v3: &[&str]) {
        self.understood = false;
        if of_v3.contains(&class.value.as_str()) {
            self.ctx.found_v3(class.span, &format!("which has no {kind} \"{}\"", class.value));
            return;
        }
        let d = Diagnostic::error(class.span, format!("unknown {kind} \"{}\"", class.value));
        self.ctx.diagnostics.push(d.with_nearest(&class.value, known.iter().copied()));
    }

    /// Leaves parameters that nobody asks for unmentioned: what they belong to is not known, which is reported.
    pub(super) fn not_understood(&mut self) {
        self.understood = false;
    }

    /// Reports a class that is known and cannot be rendered yet.
    pub(super) fn unsupported_class(&mut self, kind: &str, class: &Text) {
        self.understood = false;
        self.ctx.unsupported(class.span, &format!("{kind} \"{}\"", class.value));
    }

    /// Reports an error about a parameter or the whole.
    pub(super) fn error(&mut self, span: Span, message: impl Into<String>) {
        self.ctx.diagnostics.error(span, message);
    }

    /// Reports a missing parameter, unless it may be among the unreadable ones.
    pub(super) fn missing(&mut self, name: &str) {
        if !self.damaged {
            self.ctx.diagnostics.error(self.span, format!("{} needs a parameter \"{name}\"", self.subject));
        }
    }

    /// Whether a parameter is given, whatever its type.
    pub(super) fn has(&self, name: &str) -> bool {
        self.own.iter().any(|p| p.name == name) || self.presets.iter().any(|p| p.param.name == name)
    }

    /// The place of a given parameter, or of the class name.
    pub(super) fn span_of(&self, name: &str) -> Span {
        self.own.iter().find(|p| p.name == name).map_or(self.span, |p| p.span)
    }

    /// Takes the parameter of that name when it has one of the expected types, and reports it otherwise.
    pub(super) fn take(&mut self, name: &'static str, types: &[ParamType]) -> Option<Taken> {
        self.asked.push(name);
        let own = self.own.iter_mut().find(|s| s.name == name);
        let taken = match own.and_then(|s| s.param.take()) {
            Some(param) => Taken { param, color_space: self.color_space },
            None => {
                let preset = self.presets.iter().rev().find(|p| p.param.name == name)?;
                Taken { param: (*preset.param).clone(), color_space: preset.color_space }
            }
        };
        if types.contains(&taken.param.ty) {
            return Some(taken);
        }
        let mut expected = String::new();
        for (i, t) in types.iter().enumerate() {
            let joint = match i {
                0 => "",
                i if i + 1 == types.len() => " or ",
                _ => ", ",
            };
            expected.push_str(joint);
            expected.push_str(t.name());
        }
        let found = taken.param.ty.name();
        self.error(taken.param.span, format!("parameter \"{name}\" has type {found}, expected {expected}"));
        None
    }

    /// The single element of a list; reports any other number.
    fn single<T>(&mut self, p: &Param, list: Vec<T>) -> Option<T> {
        let n = list.len();
        let mut it = list.into_iter();
        match (it.next(), n) {
            (Some(v), 1) => Some(v),
            _ => {
                self.error(p.value_span, format!("parameter \"{}\" takes one value, found {n}", p.name));
                None
            }
        }
    }

    fn numbers(&mut self, name: &'static str, ty: ParamType) -> Option<Many<f32>> {
        let t = self.take(name, &[ty])?;
        match t.param.values {
            Values::Numbers(values) => Some(Many { values, span: t.param.value_span }),
            Values::Integers(_) | Values::Bools(_) | Values::Texts(_) => None,
        }
    }

    /// A number.
    pub(super) fn float_opt(&mut self, name: &'static str) -> Option<f32> {
        let t = self.take(name, &[ParamType::Float])?;
        match &t.param.values {
            Values::Numbers(v) => self.single(&t.param, v.clone()),
            Values::Integers(_) | Values::Bools(_) | Values::Texts(_) => None,
        }
    }

    /// A number, or the default.
    pub(super) fn float(&mut self, name: &'static str, default: f32) -> f32 {
        self.float_opt(name).unwrap_or(default)
    }

    /// A number that meets a condition, or the default; `demand` completes "parameter … must be".
    pub(super) fn float_where(
        &mut self,
        name: &'static str,
        default: f32,
        meets: impl Fn(f32) -> bool,
        demand: &str,
    ) -> f32 {
        let span = self.span_of(name);
        let v = self.float(name, default);
        if meets(v) {
            return v;
        }
        let shown = Shown(v);
        self.error(span, format!("parameter \"{name}\" must be {demand}, found {shown}"));
        default
    }

    /// A number > 0, or the default.
    pub(super) fn positive(&mut self, name: &'static str, default: f32) -> f32 {
        self.float_where(name, default, |v| v > 0.0, "positive")
    }

    /// A number ≥ 0, or the default.
    pub(super) fn non_negative(&mut self, name: &'static str, default: f32) -> f32 {
        self.float_where(name, default, |v| v >= 0.0, "at least 0")
    }

    /// Reports a number outside of [min, max].
    pub(super) fn demand_range(&mut self, name: &str, value: f32, min: f32, max: f32) {
        if (min..=max).contains(&value) {
            return;
        }
        let demand = match (min.is_finite(), max.is_finite()) {
            (true, false) => format!("at least {}", Shown(min)),
            (false, true) => format!("at most {}", Shown(max)),
            _ => format!("from {} to {}", Shown(min), Shown(max)),
        };
        let span = self.span_of(name);
        self.error(span, format!("parameter \"{name}\" must be {demand}, found {}", Shown(value)));
    }

    /// Numbers.
    pub(super) fn floats(&mut self, name: &'static str) -> Option<Many<f32>> {
        self.numbers(name, ParamType::Float)
    }

    /// Four numbers.
    pub(super) fn four_floats(&mut self, name: &'static str) -> Option<([f32; 4], Span)> {
        let many = self.floats(name)?;
        let n = many.values.len();
        match <[f32; 4]>::try_from(many.values) {
            Ok(v) => Some((v, many.span)),
            Err(_) => {
                self.error(many.span, format!("parameter \"{name}\" takes 4 values, found {n}"));
                None
            }
        }
    }

    /// An integer.
    pub(super) fn int_opt(&mut self, name: &'static str) -> Option<i32> {
        let many = self.ints_of(name)?;
        let (p, v) = many;
        self.single(&p, v)
    }

    fn ints_of(&mut self, name: &'static str) -> Option<(Param, Vec<i32>)> {
        let mut t = self.take(name, &[ParamType::Integer])?;
        match std::mem::replace(&mut t.param.values, Values::Bools(Vec::new())) {
            Values::Integers(v) => Some((t.param, v)),
            Values::Numbers(_) | Values::Bools(_) | Values::Texts(_) => None,
        }
    }

    /// Integers.
    pub(super) fn ints(&mut self, name: &'static str) -> Option<Many<i32>> {
        self.ints_of(name).map(|(p, values)| Many { values, span: p.value_span })
    }

    /// An integer within bounds, or the default.
    pub(super) fn count(
        &mut self,
        name: &'static str,
        default: u32,
        bounds: std::ops::RangeInclusive<u32>,
    ) -> u32 {
        self.count_opt(name, bounds).unwrap_or(default)
    }

    /// An integer within bounds.
    pub(super) fn count_opt(
        &mut self,
        name: &'static str,
        bounds: std::ops::RangeInclusive<u32>,
    ) -> Option<u32> {
        let span = self.span_of(name);
        let v = self.int_opt(name)?;
        if let Some(n) = u32::try_from(v).ok().filter(|n| bounds.contains(n)) {
            return Some(n);
        }
        let demand = match *bounds.end() {
            u32::MAX | 0x7fff_ffff => format!("at least {}", bounds.start()),
            end => format!("from {} to {end}", bounds.start()),
        };
        self.error(span, format!("parameter \"{name}\" must be {demand}, found {v}"));
        None
    }

    /// A truth value, or the default.
    pub(super) fn bool(&mut self, name: &'static str, default: bool) -> bool {
        let Some(t) = self.take(name, &[ParamType::Bool]) else { return default };
        match &t.param.values {
            Values::Bools(v) => self.single(&t.param, v.clone()).unwrap_or(default),
            Values::Integers(_) | Values::Numbers(_) | Values::Texts(_) => default,
        }
    }

    /// Quoted words.
    pub(super) fn texts(&mut self, name: &'static str) -> Option<Many<Text>> {
        let t = self.take(name, &[ParamType::String])?;
        match t.param.values {
            Values::Texts(values) => Some(Many { values, span: t.param.value_span }),
            Values::Integers(_) | Values::Numbers(_) | Values::Bools(_) => None,
        }
    }

    /// A quoted word.
    pub(super) fn text(&mut self, name: &'static str) -> Option<Text> {
        let t = self.take(name, &[ParamType::String])?;
        match &t.param.values {
            Values::Texts(v) => self.single(&t.param, v.clone()),
            Values::Integers(_) | Values::Numbers(_) | Values::Bools(_) => None,
        }
    }

    /// One of several words, or the default.
    pub(super) fn choice<T: Copy>(&mut self, name: &'static str, default: T, choices: &[(&str, T)]) -> T {
        let Some(text) = self.text(name) else { return default };
        if let Some((_, v)) = choices.iter().find(|(word, _)| *word == text.value) {
            return *v;
        }
        let words: Vec<&str> = choices.iter().map(|(w, _)| *w).collect();
        let d = Diagnostic::error(text.span, format!("unknown {name} \"{}\"", text.value));
        self.ctx.diagnostics.push(match nearest(&text.value, words.iter().copied()) {
            Some(n) => d.with_help(format!("did you mean \"{n}\"?")),
            None => d.with_help(format!("known are {}", words.join(", "))),
        });
        default
    }

    /// A file; an empty name is none.
    pub(super) fn file(&mut self, name: &'static str) -> Option<FileRef> {
        let text = self.text(name)?;
        (!text.value.is_empty()).then(|| self.ctx.file(&text))
    }

    /// A number or a texture of numbers.
    pub(super) fn float_param_opt(&mut self, name: &'static str) -> Option<FloatParam> {
        let t = self.take(name, &[ParamType::Float, ParamType::Texture])?;
        match &t.param.values {
            Values::Numbers(v) => self.single(&t.param, v.clone()).map(FloatParam::Value),
            Values::Texts(v) => {
                let texture = self.single(&t.param, v.clone())?;
                let id = self.ctx.float_textures.refer(&texture);
                self.uses.push(TextureId::Float(id));
                Some(FloatParam::Texture(id))
            }
            Values::Integers(_) | Values::Bools(_) => None,
        }
    }

    /// A number or a texture of numbers, or the default.
    pub(super) fn float_param(&mut self, name: &'static str, default: f32) -> FloatParam {
        self.float_param_opt(name).unwrap_or(FloatParam::Value(default))
    }

    /// Positions.
    pub(super) fn points(&mut self, name: &'static str) -> Option<Many<Point>> {
        let m = self.numbers(name, ParamType::Point3)?;
        Some(Many { values: groups(m.values), span: m.span })
    }

    /// Vectors or normals.
    pub(super) fn vectors(&mut self, name: &'static str, ty: ParamType) -> Option<Many<Vec3>> {
        let m = self.numbers(name, ty)?;
        Some(Many { values: groups(m.values), span: m.span })
    }

    /// Points of the plane.
    pub(super) fn points2(&mut self, name: &'static str) -> Option<Many<Vec2>> {
        let m = self.numbers(name, ParamType::Point2)?;
        Some(Many { values: groups(m.values), span: m.span })
    }

    /// A position, or the default.
    pub(super) fn point(&mut self, name: &'static str, default: Point) -> Point {
        match self.points(name) {
            Some(m) if m.values.len() == 1 => m.values[0],
            Some(m) => {
                let n = m.values.len();
                self.error(m.span, format!("parameter \"{name}\" takes one value, found {n}"));
                default
            }
            None => default,
        }
    }

    /// A vector, or the default.
    pub(super) fn vector(&mut self, name: &'static str, default: Vec3) -> Vec3 {
        match self.vectors(name, ParamType::Vector3) {
            Some(m) if m.values.len() == 1 => m.values[0],
            Some(m) => {
                let n = m.values.len();
                self.error(m.span, format!("parameter \"{name}\" takes one value, found {n}"));
                default
            }
            None => default,
        }
    }
}

/// The parameters that repeat an earlier name, in their order, each after the first of that name.
fn repetitions(list: &[Param]) -> Vec<(&Param, &Param)> {
    let mut by_name: Vec<usize> = (0..list.len()).collect();
    by_name.sort_by(|&a, &b| list[a].name.cmp(&list[b].name));
    let mut found: Vec<(usize, usize)> = by_name
        .chunk_by(|&a, &b| list[a].name == list[b].name)
        .flat_map(|same| same[1..].iter().map(|&again| (again, same[0])))
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(again, first)| (&list[first], &list[again])).collect()
}

/// A number as people write it: with an exponent where it would need many zeros.
struct Shown(f32);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.abs() {
            0.0 | 1e-4..1e7 => write!(f, "{}", self.0),
            _ => write!(f, "{:e}", self.0),
        }
    }
}

/// The values in whole groups, in the same memory; the parser has already refused any remainder.
fn groups<T: bytemuck::Pod>(mut values: Vec<f32>) -> Vec<T> {
    let length = size_of::<T>() / size_of::<f32>();
    debug_assert!(values.len().is_multiple_of(length));
    values.truncate(values.len() / length * length);
    values.shrink_to_fit();
    bytemuck::try_cast_vec(values).unwrap_or_else(|(_, values)| bytemuck::cast_slice(&values).to_vec())
}
