//! Scene text: lexer and parser of the pbrt-v4 language. Gigabytes of numbers are normal, so numbers go
//! straight from the bytes into the vectors that the description keeps.

pub mod directive;
mod lexer;
pub(super) mod number;
pub mod parser;

pub use directive::{
    ActiveTransform, Directive, Entity, Param, ParamType, Params, Statement, Text, TextureStatement, Values,
};
pub use parser::Parser;
