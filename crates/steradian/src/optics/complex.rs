//! Complex numbers in Cartesian form. Time runs as e^(−j ω t), so that an absorbing index is η + j k with k ≥ 0.

use super::real::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// re + j im.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex<T = f64> {
    /// Real part.
    pub re: T,
    /// Imaginary part.
    pub im: T,
}

impl<T: Real> Complex<T> {
    /// One.
    pub const ONE: Self = Self { re: T::ONE, im: T::ZERO };

    /// re + j im.
    #[inline]
    pub fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// |z|².
    #[inline]
    pub fn norm_squared(self) -> T {
        self.re * self.re + self.im * self.im
    }

    /// The complex conjugate.
    #[inline]
    #[must_use]
    pub fn conjugate(self) -> Self {
        Self { re: self.re, im: -self.im }
    }

    /// j z.
    #[inline]
    #[must_use]
    pub fn times_j(self) -> Self {
        Self { re: -self.im, im: self.re }
    }

    /// z².
    #[inline]
    #[must_use]
    pub fn square(self) -> Self {
        Self { re: (self.re - self.im) * (self.re + self.im), im: (self.re + self.re) * self.im }
    }
}

impl Complex<f64> {
    /// e^(j z).
    #[must_use]
    pub fn exp_j(self) -> Self {
        let (sin, cos) = self.re.sin_cos();
        Self { re: cos, im: sin } * (-self.im).exp()
    }

    /// The argument arg z in (−π, π] [rad].
    pub fn argument(self) -> f64 {
        self.im.atan2(self.re)
    }
}

impl<T: Real> Add for Complex<T> {
    type Output = Self;
    #[inline]
    fn add(self, z: Self) -> Self {
        Self { re: self.re + z.re, im: self.im + z.im }
    }
}

impl<T: Real> Sub for Complex<T> {
    type Output = Self;
    #[inline]
    fn sub(self, z: Self) -> Self {
        Self { re: self.re - z.re, im: self.im - z.im }
    }
}

impl<T: Real> Neg for Complex<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl<T: Real> Mul for Complex<T> {
    type Output = Self;
    #[inline]
    fn mul(self, z: Self) -> Self {
        Self { re: self.re * z.re - self.im * z.im, im: self.re * z.im + self.im * z.re }
    }
}

impl<T: Real> Mul<T> for Complex<T> {
    type Output = Self;
    #[inline]
    fn mul(self, x: T) -> Self {
        Self { re: self.re * x, im: self.im * x }
    }
}

impl<T: Real> Div for Complex<T> {
    type Output = Self;
    #[inline]
    fn div(self, z: Self) -> Self {
        self * z.conjugate() * (T::ONE / z.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn arithmetic_obeys_the_laws_of_a_field(a in -3.0..3.0f64, b in -3.0..3.0f64, c in -3.0..3.0f64, d in 0.1..3.0f64) {
            let (z, w) = (Complex::new(a, b), Complex::new(c, d));
            let near = |x: Complex, y: Complex| (x - y).norm_squared() < 1e-24;
            prop_assert!(near(z / w * w, z) && near(z.square(), z * z) && near(z.times_j(), z * Complex::new(0.0, 1.0)));
            prop_assert!(near(z * z.conjugate(), Complex::ONE * z.norm_squared()) && near(-z + z * 2.0, z));
            // e^(j z) e^(j w) = e^(j (z + w)), and its argument is the real part.
            prop_assert!((z.exp_j() * w.exp_j() - (z + w).exp_j()).norm_squared() < 1e-20 * (z + w).exp_j().norm_squared());
            prop_assert!((z.exp_j().argument() - a).abs() < 1e-12);
        }
    }
}
