//! Materials as the scene states them.

use super::id::Id;
use super::texture::{FloatParam, SpectrumParam};
use super::value::{FileRef, SpectrumDesc};
use crate::material::{Class, Role};
use crate::scene::source::Span;

/// A material. Named ones keep their name for messages and `info`.
#[derive(Clone, Debug)]
pub struct MaterialDesc {
    /// Name in the scene; `None` for materials stated in place.
    pub name: Option<String>,
    /// What it is.
    pub class: &'static Class,
    /// Values of the parameters of its class, in their order.
    pub arguments: Vec<ArgumentDesc>,
    /// Bump map: height [scene units] along the normal.
    pub displacement: Option<FloatParam>,
    /// Normal map.
    pub normal_map: Option<FileRef>,
    /// The definition.
    pub span: Span,
}

/// The value of one parameter.
#[derive(Clone, Debug)]
pub struct ArgumentDesc {
    /// The parameter's name.
    pub name: &'static str,
    /// Its value.
    pub value: ArgumentValue,
    /// Whether the scene states it; it is a default otherwise.
    pub given: bool,
    /// The place of the parameter, or of the class when it is a default.
    pub span: Span,
}

/// A value as the scene states it, by the kind of parameter; `None` where it is absent and has no default.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "each states a value for the parameter kind of the same name")]
pub enum ArgumentValue {
    Spectrum(Option<SpectrumParam>),
    Index(Option<SpectrumDesc>),
    Float(Option<FloatParam>),
    Number(Option<f32>),
    Numbers(Vec<f32>),
    Spectra(Vec<SpectrumDesc>),
    Flag(bool),
    Count(u32),
    Choice(&'static str),
    File(Option<FileRef>),
    Materials(Vec<Id<MaterialDesc>>),
}

impl MaterialDesc {
    /// The value of a parameter of its class.
    pub fn argument(&self, name: &str) -> Option<&ArgumentDesc> {
        self.arguments.iter().find(|a| a.name == name)
    }

    /// The materials that it refers to.
    pub fn parts(&self) -> impl Iterator<Item = Id<Self>> + '_ {
        self.arguments
            .iter()
            .flat_map(|a| match &a.value {
                ArgumentValue::Materials(ids) => ids.as_slice(),
                _ => &[],
            })
            .copied()
    }

    /// Whether it is a mere boundary of media.
    pub fn is_interface(&self) -> bool {
        self.class.role == Role::Interface
    }
}
