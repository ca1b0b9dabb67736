//! What a quantity measures, where in the spectrum it counts, and the units that follow.

use super::quantity::{Quantity, Radiance};

/// Radiant energy Q, A 12.2.1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Energy;

/// Radiant flux (power) Φ, A (15).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flux;

/// Radiant intensity I, A (19).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Intensity;

/// Irradiance E, A (17).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Irradiance;

impl Quantity for Irradiance {
    const UNIT: &'static str = "W·m⁻²·nm⁻¹";
}

/// Radiant exitance M, A (22).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exitance;

/// All wavelengths, each watt alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Radiant;

/// Per nanometre of wavelength.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spectral;

/// Weighted by the eye's photopic sensitivity, K_m ∫ … V(λ) dλ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Luminous;

/// A kind of quantity in a part of the spectrum, for instance [`Irradiance`] and [`Luminous`]: illuminance.
pub trait Unit<Domain> {
    /// Its name.
    const NAME: &'static str;
    /// Its SI unit.
    const UNIT: &'static str;
}

macro_rules! units {
    ($($kind:ident: $radiant:literal $ru:literal, $spectral:literal $su:literal, $luminous:literal $lu:literal;)*) => {$(
        impl Unit<Radiant> for $kind {
            const NAME: &'static str = $radiant;
            const UNIT: &'static str = $ru;
        }
        impl Unit<Spectral> for $kind {
            const NAME: &'static str = $spectral;
            const UNIT: &'static str = $su;
        }
        impl Unit<Luminous> for $kind {
            const NAME: &'static str = $luminous;
            const UNIT: &'static str = $lu;
        }
    )*};
}

units! {
    Energy: "radiant energy" "J", "spectral radiant energy" "J·nm⁻¹", "luminous energy" "lm·s";
    Flux: "radiant flux" "W", "spectral radiant flux" "W·nm⁻¹", "luminous flux" "lm";
    Intensity: "radiant intensity" "W·sr⁻¹", "spectral radiant intensity" "W·sr⁻¹·nm⁻¹", "luminous intensity" "cd";
    Irradiance: "irradiance" "W·m⁻²", "spectral irradiance" "W·m⁻²·nm⁻¹", "illuminance" "lx";
    Exitance: "radiant exitance" "W·m⁻²", "spectral radiant exitance" "W·m⁻²·nm⁻¹", "luminous exitance" "lm·m⁻²";
    Radiance: "radiance" "W·m⁻²·sr⁻¹", "spectral radiance" "W·m⁻²·sr⁻¹·nm⁻¹", "luminance" "cd·m⁻²";
}
