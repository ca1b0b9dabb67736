//! The parameters that a class of materials takes, and their values once the scene's textures, spectra and files are
//! resolved. Importers and the compiler read the schema, so that a new class is no concern of theirs.

use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, Spectrum};
use crate::texture::{FloatInput, SpectrumInput};
use std::path::PathBuf;

/// A material of a collection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// One parameter of a class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in scene files.
    pub name: &'static str,
    /// What it takes.
    pub kind: ParameterKind,
}

/// What a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterKind {
    /// A spectrum or a texture of spectra.
    Spectrum {
        /// What an RGB triple stands for.
        quantity: Quantity,
        /// The value when it is not given.
        default: SpectrumDefault,
    },
    /// An index of refraction: a number or a spectrum, no texture.
    Index {
        /// The value when it is not given.
        default: Option<f32>,
    },
    /// A number or a texture of numbers; numbers lie in [min, max].
    Float {
        /// The value when it is not given.
        default: Option<f32>,
        /// Smallest number.
        min: f32,
        /// Largest number.
        max: f32,
    },
    /// A number in [min, max], no texture.
    Number {
        /// The value when it is not given.
        default: Option<f32>,
        /// Smallest number.
        min: f32,
        /// Largest number.
        max: f32,
    },
    /// A list of numbers; empty when it is not given.
    Numbers,
    /// A list of spectra: numbers, or names of spectra; empty when it is not given.
    Spectra,
    /// A truth value.
    Flag {
        /// The value when it is not given.
        default: bool,
    },
    /// An integer in [min, max].
    Count {
        /// The value when it is not given.
        default: u32,
        /// Smallest number.
        min: u32,
        /// Largest number.
        max: u32,
    },
    /// One of several words; the first when it is not given.
    Choice {
        /// The words.
        options: &'static [&'static str],
    },
    /// The bytes of a file.
    File {
        /// Whether it must be given.
        required: bool,
    },
    /// The names of other materials; must be given.
    Materials {
        /// How many.
        count: usize,
    },
}

/// What an RGB triple stands for, by the parameter that holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A reflectance or transmittance, in [0, 1].
    Fraction,
    /// A quantity without upper bound.
    Unbounded,
}

/// The value of a spectrum that is not given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectrumDefault {
    /// The same value at every wavelength.
    Constant(f32),
    /// A spectrum that the library knows by name.
    Named(&'static str),
    /// None.
    Absent,
}

impl Parameter {
    const fn of(name: &'static str, kind: ParameterKind) -> Self {
        Self { name, kind }
    }

    const fn spectrum(name: &'static str, quantity: Quantity, default: SpectrumDefault) -> Self {
        Self::of(name, ParameterKind::Spectrum { quantity, default })
    }

    /// A reflectance or transmittance: spectrum or texture.
    pub const fn fraction(name: &'static str, default: f32) -> Self {
        Self::spectrum(name, Quantity::Fraction, SpectrumDefault::Constant(default))
    }

    /// A reflectance or transmittance that may be absent.
    pub const fn fraction_opt(name: &'static str) -> Self {
        Self::spectrum(name, Quantity::Fraction, SpectrumDefault::Absent)
    }

    /// A spectrum without upper bound, or a texture; by default one that the library knows by name.
    pub const fn quantity(name: &'static str, default: &'static str) -> Self {
        Self::spectrum(name, Quantity::Unbounded, SpectrumDefault::Named(default))
    }

    /// A spectrum without upper bound, or a texture.
    pub const fn quantity_of(name: &'static str, default: f32) -> Self {
        Self::spectrum(name, Quantity::Unbounded, SpectrumDefault::Constant(default))
    }

    /// A spectrum without upper bound, or a texture, that may be absent.
    pub const fn quantity_opt(name: &'static str) -> Self {
        Self::spectrum(name, Quantity::Unbounded, SpectrumDefault::Absent)
    }

    /// An index of refraction: number or spectrum.
    pub const fn index(name: &'static str, default: f32) -> Self {
        Self::of(name, ParameterKind::Index { default: Some(default) })
    }

    /// An index of refraction that may be absent.
    pub const fn index_opt(name: &'static str) -> Self {
        Self::of(name, ParameterKind::Index { default: None })
    }

    /// Any number, or a texture.
    pub const fn float(name: &'static str, default: f32) -> Self {
        Self::float_in(name, default, f32::NEG_INFINITY, f32::INFINITY)
    }

    /// A number in [min, max], or a texture.
    pub const fn float_in(name: &'static str, default: f32, min: f32, max: f32) -> Self {
        Self::of(name, ParameterKind::Float { default: Some(default), min, max })
    }

    /// A number in [min, max] or a texture, that may be absent.
    pub const fn float_opt(name: &'static str, min: f32, max: f32) -> Self {
        Self::of(name, ParameterKind::Float { default: None, min, max })
    }

    /// A number in [min, max].
    pub const fn number(name: &'static str, default: f32, min: f32, max: f32) -> Self {
        Self::of(name, ParameterKind::Number { default: Some(default), min, max })
    }

    /// A number in [min, max] that may be absent.
    pub const fn number_opt(name: &'static str, min: f32, max: f32) -> Self {
        Self::of(name, ParameterKind::Number { default: None, min, max })
    }

    /// A list of numbers, empty by default.
    pub const fn numbers(name: &'static str) -> Self {
        Self::of(name, ParameterKind::Numbers)
    }

    /// A list of spectra, empty by default.
    pub const fn spectra(name: &'static str) -> Self {
        Self::of(name, ParameterKind::Spectra)
    }

    /// A truth value.
    pub const fn flag(name: &'static str, default: bool) -> Self {
        Self::of(name, ParameterKind::Flag { default })
    }

    /// An integer in [min, max].
    pub const fn count(name: &'static str, default: u32, min: u32, max: u32) -> Self {
        Self::of(name, ParameterKind::Count { default, min, max })
    }

    /// One of several words, the first by default.
    pub const fn choice(name: &'static str, options: &'static [&'static str]) -> Self {
        Self::of(name, ParameterKind::Choice { options })
    }

    /// A file that must be given.
    pub const fn file(name: &'static str) -> Self {
        Self::of(name, ParameterKind::File { required: true })
    }

    /// A file that may be absent.
    pub const fn file_opt(name: &'static str) -> Self {
        Self::of(name, ParameterKind::File { required: false })
    }

    /// The names of `count` materials.
    pub const fn materials(name: &'static str, count: usize) -> Self {
        Self::of(name, ParameterKind::Materials { count })
    }
}

/// A file with its contents.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct File {
    /// The path that was opened.
    pub path: PathBuf,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The value of a parameter; `None` where it was not given and has no default.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "each is the resolved value of the kind of the same name")]
pub enum Value {
    Spectrum(Option<SpectrumInput>),
    Index(Option<Spectrum>),
    Float(Option<FloatInput>),
    Number(Option<f32>),
    Numbers(Vec<f32>),
    Spectra(Vec<Spectrum>),
    Flag(bool),
    Count(u32),
    Choice(&'static str),
    File(Option<File>),
    Materials(Vec<MaterialId>),
}

/// A parameter with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// The parameter's name.
    pub name: &'static str,
    /// Its value.
    pub value: Value,
    /// Whether the scene states it.
    pub given: bool,
}

/// What is wrong with a combination of parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The parameter to point at.
    pub parameter: &'static str,
    /// What is wrong.
    pub message: String,
}

impl Fault {
    /// A fault of the named parameter.
    pub fn new(parameter: &'static str, message: impl Into<String>) -> Self {
        Self { parameter, message: message.into() }
    }
}

/// The values of all parameters of a class.
///
/// Asking for a name or kind that the schema does not have is a broken invariant; the answer is then empty.
#[derive(Clone, Debug, Default)]
pub struct Arguments(Vec<Argument>);

macro_rules! get {
    ($self:ident, $name:ident, $kind:ident) => {
        match $self.value($name) {
            Some(Value::$kind(v)) => Some(v),
            _ => {
                debug_assert!(false, "no such parameter: {}", $name);
                None
            }
        }
    };
}

impl Arguments {
    /// The values in the order of the schema.
    pub fn new(values: Vec<Argument>) -> Self {
        Self(values)
    }

    fn value(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|a| a.name == name).map(|a| &a.value)
    }

    /// The wavelengths for which all spectra have data [nm]. Textures have them over the film's range.
    pub fn range(&self) -> (f32, f32) {
        let of = |value: &Value| match value {
            Value::Spectrum(Some(SpectrumInput::Constant(s))) | Value::Index(Some(s)) => vec![s.range()],
            Value::Spectrum(Some(SpectrumInput::Texture(_))) => vec![Some((LAMBDA_MIN, LAMBDA_MAX))],
            Value::Spectra(spectra) => spectra.iter().map(Spectrum::range).collect(),
            _ => Vec::new(),
        };
        let ranges = self.0.iter().flat_map(|a| of(&a.value)).flatten();
        ranges.fold((0.0, f32::INFINITY), |(lo, hi), (a, b)| (a.max(lo), b.min(hi)))
    }

    /// Whether the scene states the parameter.
    pub fn given(&self, name: &str) -> bool {
        self.0.iter().any(|a| a.name == name && a.given)
    }

    /// A spectrum, zero where it is absent.
    pub fn spectrum(&self, name: &str) -> SpectrumInput {
        self.spectrum_opt(name).unwrap_or(SpectrumInput::Constant(Spectrum::Constant(0.0)))
    }

    /// A spectrum that may be absent.
    pub fn spectrum_opt(&self, name: &str) -> Option<SpectrumInput> {
        get!(self, name, Spectrum)?.clone()
    }

    /// An index of refraction, one where it is absent.
    pub fn index(&self, name: &str) -> Spectrum {
        self.index_opt(name).unwrap_or(Spectrum::Constant(1.0))
    }

    /// An index of refraction that may be absent.
    pub fn index_opt(&self, name: &str) -> Option<Spectrum> {
        get!(self, name, Index)?.clone()
    }

    /// A number that may be textured, zero where it is absent.
    pub fn float(&self, name: &str) -> FloatInput {
        self.float_opt(name).unwrap_or(FloatInput::Constant(0.0))
    }

    /// A number that may be textured and may be absent.
    pub fn float_opt(&self, name: &str) -> Option<FloatInput> {
        *get!(self, name, Float)?
    }

    /// A number, zero where it is absent.
    pub fn number(&self, name: &str) -> f32 {
        self.number_opt(name).unwrap_or(0.0)
    }

    /// A number that may be absent.
    pub fn number_opt(&self, name: &str) -> Option<f32> {
        *get!(self, name, Number)?
    }

    /// A list of numbers.
    pub fn numbers(&self, name: &str) -> &[f32] {
        get!(self, name, Numbers).map_or(&[], Vec::as_slice)
    }

    /// A list of spectra.
    pub fn spectra(&self, name: &str) -> &[Spectrum] {
        get!(self, name, Spectra).map_or(&[], Vec::as_slice)
    }

    /// A truth value.
    pub fn flag(&self, name: &str) -> bool {
        get!(self, name, Flag).is_some_and(|v| *v)
    }

    /// An integer.
    pub fn count(&self, name: &str) -> u32 {
        get!(self, name, Count).map_or(0, |v| *v)
    }

    /// One of the words of the schema.
    pub fn choice(&self, name: &str) -> &'static str {
        get!(self, name, Choice).map_or("", |v| *v)
    }

    /// A file that must be given.
    pub fn file(&self, name: &str) -> &File {
        const NONE: &File = &File { path: PathBuf::new(), bytes: Vec::new() };
        self.file_opt(name).unwrap_or(NONE)
    }

    /// A file that may be absent.
    pub fn file_opt(&self, name: &str) -> Option<&File> {
        get!(self, name, File)?.as_ref()
    }

    /// Other materials.
    pub fn materials(&self, name: &str) -> &[MaterialId] {
        get!(self, name, Materials).map_or(&[], Vec::as_slice)
    }
}
