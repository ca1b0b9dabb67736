//! One text for formulas that rendering evaluates in `f32` and instruments in `f64`.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `f32` or `f64`, as far as the optics of one interface needs them.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + From<f32>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// One half.
    const HALF: Self;
    /// The smallest normal number above zero.
    const TINY: Self;

    /// The magnitude.
    fn abs(self) -> Self;
    /// The square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// The smaller of both; the other one if one is NaN.
    fn min(self, other: Self) -> Self;
    /// η² − k² − sin²θ for the given η, k and cosθ, to the rounding of the type.
    ///
    /// Near the critical angle the terms cancel, and the reflectance has a root of the difference in it: `f32` forms it
    /// in `f64`, which holds the products exactly.
    fn refracted_square(eta: Self, k: Self, cos_theta: Self) -> Self;
    /// 1/η² − sin²θ for the given η and cosθ: the same from below a dielectric, without the rounding of 1/η.
    fn refracted_square_from_below(eta: Self, cos_theta: Self) -> Self;
}

/// What reads the same for both types.
macro_rules! what_both_have {
    () => {
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;
        const HALF: Self = 0.5;
        const TINY: Self = Self::MIN_POSITIVE;

        #[inline]
        fn abs(self) -> Self {
            self.abs()
        }

        #[inline]
        fn sqrt(self) -> Self {
            self.sqrt()
        }

        #[inline]
        fn min(self, other: Self) -> Self {
            self.min(other)
        }
    };
}

impl Real for f32 {
    what_both_have!();

    #[inline]
    fn refracted_square(eta: Self, k: Self, cos_theta: Self) -> Self {
        f64::refracted_square(eta.into(), k.into(), cos_theta.into()) as Self
    }

    #[inline]
    fn refracted_square_from_below(eta: Self, cos_theta: Self) -> Self {
        f64::refracted_square_from_below(eta.into(), cos_theta.into()) as Self
    }
}

impl Real for f64 {
    what_both_have!();

    #[inline]
    fn refracted_square(eta: Self, k: Self, cos_theta: Self) -> Self {
        (eta - 1.0) * (eta + 1.0) + (cos_theta - k) * (cos_theta + k)
    }

    #[inline]
    fn refracted_square_from_below(eta: Self, cos_theta: Self) -> Self {
        cos_theta * cos_theta - (eta - 1.0) * (eta + 1.0) / (eta * eta)
    }
}
