//! Textures that blend two inputs by a weight that varies over the surface.

use super::input::FloatInput;
use super::pattern::Pattern;

/// Two inputs and what decides between them: value = (1 − w)·first + w·second.
#[derive(Clone, Debug)]
pub struct Blend<I> {
    /// The input at w = 0.
    pub first: I,
    /// The input at w = 1.
    pub second: I,
    /// The weight w of the second input, in [0, 1] unless an amount lies outside.
    pub weight: Weight,
}

/// What decides between the inputs of a [`Blend`].
#[derive(Clone, Copy, Debug)]
pub enum Weight {
    /// An amount: pbrt-v4's `mix`.
    Amount(FloatInput),
    /// A pattern: pbrt-v4's `checkerboard`, `dots` and `directionmix`.
    Pattern(Pattern),
}
