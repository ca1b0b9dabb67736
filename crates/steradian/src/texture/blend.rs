//! Textures that blend two inputs by a weight that varies over the surface.

use super::input::FloatInput;
use crate::math::Dir;

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
#[derive(Clone, Debug)]
pub enum Weight {
    /// pbrt-v4's `mix`: w is the amount.
    Amount(FloatInput),
    /// pbrt-v4's `directionmix`: 1 − w = |n·d| for the geometric normal n and this direction d in render space.
    Direction(Dir),
}
