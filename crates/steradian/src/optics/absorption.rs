//! Absorption in a homogeneous medium. What has a base says so in its type: the same medium has a decadic
//! coefficient that is ln 10 times smaller than its natural one, and tables give either.
//!
//! ```
//! use steradian::optics::absorption::{DecadicSpecificAbsorption, NaturalAbsorption};
//! let epsilon = DecadicSpecificAbsorption::new(2.0);
//! let a: NaturalAbsorption = epsilon.at_concentration(0.25).into();
//! assert!((a.over(1.0).transmittance() - 10.0_f64.powf(-0.5)).abs() < 1e-15);
//! ```
//!
//! Both bases do not mix:
//!
//! ```compile_fail
//! use steradian::optics::absorption::{DecadicAbsorption, NaturalAbsorption};
//! let sum = NaturalAbsorption::new(1.0) + DecadicAbsorption::new(1.0);
//! ```
//!
//! ```compile_fail
//! use steradian::optics::absorption::{DecadicAbsorbance, NaturalAbsorption};
//! let depth: DecadicAbsorbance = NaturalAbsorption::new(1.0).over(2.0);
//! ```

use crate::units::Nm;
use std::f32::consts::PI;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, Mul};

/// The number whose powers an absorption counts in: [`Natural`] or [`Decadic`].
pub trait Base: Copy + Debug + PartialEq {
    /// Its natural logarithm.
    const LN: f64;
}

/// Base e, as transport and B (2.21)–(2.23) have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Natural;

/// Base 10, as spectrophotometers and most tables of solutions have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decadic;

impl Base for Natural {
    const LN: f64 = 1.0;
}

impl Base for Decadic {
    const LN: f64 = std::f64::consts::LN_10;
}

/// Declares a quantity that has a base: a number, its conversions, and what both keep.
macro_rules! based {
    ($(#[$doc:meta])* $name:ident, $natural:ident, $decadic:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<B> {
            value: f64,
            base: PhantomData<B>,
        }

        #[doc = concat!("[`", stringify!($name), "`] to base e.")]
        pub type $natural = $name<Natural>;
        #[doc = concat!("[`", stringify!($name), "`] to base 10.")]
        pub type $decadic = $name<Decadic>;

        impl<B: Base> $name<B> {
            /// From its number, at least 0, in the unit of the type.
            pub fn new(value: f64) -> Self {
                Self { value, base: PhantomData }
            }

            /// Its number in the unit of the type.
            pub fn value(self) -> f64 {
                self.value
            }
        }

        impl From<$decadic> for $natural {
            fn from(decadic: $decadic) -> Self {
                Self::new(decadic.value * Decadic::LN)
            }
        }

        impl From<$natural> for $decadic {
            fn from(natural: $natural) -> Self {
                Self::new(natural.value / Decadic::LN)
            }
        }

        impl<B: Base> Add for $name<B> {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self::new(self.value + other.value)
            }
        }

        impl<B: Base> Mul<f64> for $name<B> {
            type Output = Self;
            fn mul(self, factor: f64) -> Self {
                Self::new(self.value * factor)
            }
        }
    };
}

based! {
    /// Absorption coefficient of a medium [length⁻¹]; the unit of length is that of the paths it is used with.
    /// Absorbers in one medium add.
    Absorption, NaturalAbsorption, DecadicAbsorption
}

based! {
    /// Absorption coefficient of a dissolved substance for one unit of its concentration: a mass, an amount (then it is
    /// called molar) or a number per volume [length² · amount⁻¹].
    SpecificAbsorption, NaturalSpecificAbsorption, DecadicSpecificAbsorption
}

based! {
    /// Minus the logarithm of the share of power that passes a path; dimensionless. Successive paths add. To base e it is
    /// the optical depth.
    Absorbance, NaturalAbsorbance, DecadicAbsorbance
}

impl<B: Base> SpecificAbsorption<B> {
    /// The coefficient of a solution of `concentration` [amount · length⁻³], at least 0: Beer's law, B (2.22).
    pub fn at_concentration(self, concentration: f64) -> Absorption<B> {
        Absorption::new(self.value * concentration)
    }
}

impl<B: Base> Absorption<B> {
    /// The absorbance of a path of `length`, at least 0: the law of Bouguer and Lambert, B (2.21). Zero for no path,
    /// in an infinitely absorbing medium too.
    pub fn over(self, length: f64) -> Absorbance<B> {
        Absorbance::new(if length == 0.0 { 0.0 } else { self.value * length })
    }
}

impl NaturalAbsorption {
    /// The coefficient of a medium whose complex index has the imaginary part `mu`, at the vacuum wavelength `lambda`
    /// in the unit of length: a = 4π μ / λ, B (2.23).
    pub fn from_extinction_index(mu: f64, lambda: f64) -> Self {
        Self::new(2.0 * std::f64::consts::TAU * mu / lambda)
    }

    /// The imaginary part μ of the medium's complex index, as [`NaturalAbsorption::from_extinction_index`] reads it.
    pub fn extinction_index(self, lambda: f64) -> f64 {
        self.value * lambda / (2.0 * std::f64::consts::TAU)
    }
}

impl<B: Base> Absorbance<B> {
    /// The absorbance that lets the share `transmittance` in [0, 1] pass; infinite for zero.
    pub fn from_transmittance(transmittance: f64) -> Self {
        Self::new(-transmittance.ln() / B::LN)
    }

    /// The share of power that passes, in [0, 1].
    pub fn transmittance(self) -> f64 {
        (-self.value * B::LN).exp()
    }
}

/// The share of power that passes a path of length `h` [length] in a medium with the natural absorption coefficient
/// `a` [1/length]: e^(−a h), Bouguer–Lambert, B (2.21), for rendering. One for a zero path, whatever `a`.
pub fn bouguer(a: f32, h: f32) -> f32 {
    if h == 0.0 { 1.0 } else { (-a * h).exp() }
}

/// The share of power that passes a path of length `h` [length] in a solution of concentration `c`
/// [amount/volume] whose natural specific absorption is `a` [area/amount]: e^(−a c h), Beer, B (2.22), for rendering.
pub fn beer(a: f32, c: f32, h: f32) -> f32 {
    bouguer(a * c, h)
}

/// The imaginary part μ of the complex index of refraction of a medium with the natural absorption coefficient
/// `a` [nm⁻¹] at the vacuum wavelength `lambda`: a λ / 4π, B (2.23), for rendering. Dimensionless.
pub fn extinction_index(a: f32, lambda: Nm) -> f32 {
    a * lambda.0 / (4.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn successive_layers_multiply() {
        let (a, h0, h1) = (1.7, 0.4, 1.1);
        assert!((bouguer(a, h0) * bouguer(a, h1) - bouguer(a, h0 + h1)).abs() < 1e-6);
        assert_eq!(bouguer(f32::INFINITY, 0.0), 1.0);
        let a = NaturalAbsorption::new(1.7);
        let both = a.over(0.4) + a.over(1.1);
        assert!((both.transmittance() - a.over(1.5).transmittance()).abs() < 1e-15);
        assert_eq!(DecadicAbsorption::new(f64::INFINITY).over(0.0).transmittance(), 1.0);
    }

    #[test]
    fn half_of_the_power_is_left_after_ln_2_absorption_lengths() {
        assert!((beer(0.5, 2.0, std::f32::consts::LN_2) - 0.5).abs() < 1e-7);
        let a = NaturalSpecificAbsorption::new(0.5).at_concentration(2.0);
        assert!((a.over(std::f64::consts::LN_2).transmittance() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_decadic_absorbance_counts_factors_of_ten_and_is_ln_10_times_smaller_than_the_natural_one() {
        let a = DecadicAbsorbance::new(2.0);
        assert!((a.transmittance() - 0.01).abs() < 1e-16);
        let natural = NaturalAbsorbance::from(a);
        assert!((natural.value() - 4.605_170_185_988_091).abs() < 1e-14);
        assert!((natural.transmittance() - a.transmittance()).abs() < 1e-16);
        assert!((DecadicAbsorbance::from(natural).value() - 2.0).abs() < 1e-15);
        assert!((DecadicAbsorbance::from_transmittance(1e-3).value() - 3.0).abs() < 1e-14);
        assert!((NaturalAbsorbance::from_transmittance(0.2).transmittance() - 0.2).abs() < 1e-16);
    }

    #[test]
    fn bases_convert_before_or_after_concentration_and_path() {
        let molar = DecadicSpecificAbsorption::new(15.0);
        let first = NaturalSpecificAbsorption::from(molar).at_concentration(0.2).over(3.0);
        let middle = NaturalAbsorption::from(molar.at_concentration(0.2)).over(3.0);
        let last = NaturalAbsorbance::from(molar.at_concentration(0.2).over(3.0));
        for other in [middle, last] {
            assert!((first.value() / other.value() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_wave_decays_by_e_over_one_absorption_length_of_its_own_index() {
        // Intensity along z is e^(−4π μ z / λ): with μ from a, that is e^(−a z).
        let (a, lambda) = (0.01, 550.0);
        let mu = extinction_index(a, Nm(lambda));
        let z = 1.0 / a;
        assert!(((-4.0 * PI * mu * z / lambda).exp() - (-1.0_f32).exp()).abs() < 1e-6);
        let a = NaturalAbsorption::from_extinction_index(f64::from(mu), f64::from(lambda));
        assert!((a.value() - 0.01).abs() < 1e-8);
        assert!((a.extinction_index(f64::from(lambda)) - f64::from(mu)).abs() < 1e-16);
    }
}
