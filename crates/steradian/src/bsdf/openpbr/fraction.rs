//! Numbers in [0, 1] in half the space: a scattering function is copied at each vertex of a path.

use crate::spectrum::{LANES, Sampled};
use crate::units::Unitless;

/// A number in [0, 1], stored in steps of 1/65535; both ends are exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Fraction(u16);

impl Fraction {
    pub(super) const ONE: Self = Self(u16::MAX);

    /// The nearest step; numbers outside of [0, 1] are limited to it.
    pub(super) fn new(x: f32) -> Self {
        Self((x.clamp(0.0, 1.0) * f32::from(u16::MAX)).round() as u16)
    }

    /// The step below.
    pub(super) fn floor(x: f32) -> Self {
        Self((x.clamp(0.0, 1.0) * f32::from(u16::MAX)) as u16)
    }

    pub(super) fn get(self) -> f32 {
        f32::from(self.0) / f32::from(u16::MAX)
    }
}

/// One [`Fraction`] per wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Fractions([Fraction; LANES]);

impl Fractions {
    pub(super) const ONE: Self = Self([Fraction::ONE; LANES]);

    pub(super) fn new(s: Sampled<Unitless>) -> Self {
        Self(s.to_array().map(Fraction::new))
    }

    pub(super) fn get(&self) -> Sampled<Unitless> {
        Sampled::from_fn(|lane| self.0[lane].get())
    }

    pub(super) fn is_zero(&self) -> bool {
        *self == Self::default()
    }

    pub(super) fn is_one(&self) -> bool {
        *self == Self::ONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_exact_and_floors_do_not_exceed() {
        assert_eq!((Fraction::new(1.0).get(), Fraction::new(0.0).get()), (1.0, 0.0));
        for i in 0..=1000 {
            let x = i as f32 / 1000.0;
            assert!((Fraction::new(x).get() - x).abs() <= 0.51 / 65535.0);
            assert!(Fraction::floor(x).get() <= x && x - Fraction::floor(x).get() < 1.01 / 65535.0);
        }
    }
}
