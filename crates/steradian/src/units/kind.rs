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

/// Weighted by the eye's sensitivity in daylight, K_m ∫ … V(λ) dλ (CIE S 010 / ISO 23539).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Luminous;

/// Weighted by the eye's sensitivity in the dark, K′_m ∫ … V′(λ) dλ (CIE S 010 / ISO 23539).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scotopic;

/// Weighted by the sensitivity of the S cones, ∫ … s_sc(λ) dλ (CIE S 026).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SCone;

/// Weighted by the sensitivity of the M cones, ∫ … s_mc(λ) dλ (CIE S 026).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MCone;

/// Weighted by the sensitivity of the L cones, ∫ … s_lc(λ) dλ (CIE S 026).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LCone;

/// Weighted by the sensitivity of the rods, ∫ … s_rh(λ) dλ (CIE S 026).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rhodopic;

/// Weighted by the sensitivity of the ganglion cells that hold melanopsin, ∫ … s_mel(λ) dλ (CIE S 026).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Melanopic;

/// As much daylight (D65) as would have the same α-opic effect, in photometric units (CIE S 026: EDI, EDL).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EquivalentDaylight<A>(A);

/// A kind of quantity in a part of the spectrum, for instance [`Irradiance`] and [`Luminous`]: illuminance.
pub trait Unit<Domain> {
    /// Its name.
    const NAME: &'static str;
    /// Its SI unit.
    const UNIT: &'static str;
}

/// A domain that weights the spectrum of radiant power with an action spectrum, so that a constant converts watts of
/// given spectral composition.
pub trait Weighted {
    /// Unit of what one watt counts for.
    const EFFICACY_UNIT: &'static str;
}

/// A domain of CIE S 026: one of the five kinds of light-sensitive cells of the human eye.
pub trait AlphaOpic: Weighted {
    /// α-opic efficacy of luminous radiation for daylight, K_α,v(D65) [W·lm⁻¹] (CIE S 026, 3.10): α-opic watts over lumens
    /// of the illuminant D65.
    const DAYLIGHT_EFFICACY: f64;
}

macro_rules! units {
    ($domain:ty: $($kind:ident: $name:expr, $unit:expr;)*) => {$(
        impl Unit<$domain> for $kind {
            const NAME: &'static str = $name;
            const UNIT: &'static str = $unit;
        }
    )*};
}

/// The units of power, with words before the name and after the unit.
macro_rules! in_watts {
    ($($domain:ty: $prefix:literal, $suffix:literal;)*) => {$(
        units! { $domain:
            Energy: concat!($prefix, "radiant energy"), concat!("J", $suffix);
            Flux: concat!($prefix, "radiant flux"), concat!("W", $suffix);
            Intensity: concat!($prefix, "radiant intensity"), concat!("W·sr⁻¹", $suffix);
            Irradiance: concat!($prefix, "irradiance"), concat!("W·m⁻²", $suffix);
            Exitance: concat!($prefix, "radiant exitance"), concat!("W·m⁻²", $suffix);
            Radiance: concat!($prefix, "radiance"), concat!("W·m⁻²·sr⁻¹", $suffix);
        }
    )*};
}

/// The units of light.
macro_rules! in_lumens {
    ($($domain:ty: $prefix:literal;)*) => {$(
        units! { $domain:
            Energy: concat!($prefix, "luminous energy"), "lm·s";
            Flux: concat!($prefix, "luminous flux"), "lm";
            Intensity: concat!($prefix, "luminous intensity"), "cd";
            Irradiance: concat!($prefix, "illuminance"), "lx";
            Exitance: concat!($prefix, "luminous exitance"), "lm·m⁻²";
            Radiance: concat!($prefix, "luminance"), "cd·m⁻²";
        }
        impl Weighted for $domain {
            const EFFICACY_UNIT: &'static str = "lm·W⁻¹";
        }
    )*};
}

macro_rules! alpha_opic {
    ($($domain:ty: $prefix:literal, $milliwatts_per_lumen:literal;)*) => {$(
        in_watts! { $domain: $prefix, ""; }
        units! { EquivalentDaylight<$domain>:
            Irradiance: concat!($prefix, "equivalent daylight (D65) illuminance"), "lx";
            Radiance: concat!($prefix, "equivalent daylight (D65) luminance"), "cd·m⁻²";
        }
        impl Weighted for $domain {
            const EFFICACY_UNIT: &'static str = "W·W⁻¹";
        }
        impl AlphaOpic for $domain {
            const DAYLIGHT_EFFICACY: f64 = 1e-3 * $milliwatts_per_lumen;
        }
    )*};
}

in_watts! {
    Radiant: "", "";
    Spectral: "spectral ", "·nm⁻¹";
}

in_lumens! {
    Luminous: "";
    Scotopic: "scotopic ";
}

// The constants of CIE S 026, table 2.
alpha_opic! {
    SCone: "S-cone-opic ", 0.8173;
    MCone: "M-cone-opic ", 1.4558;
    LCone: "L-cone-opic ", 1.6289;
    Rhodopic: "rhodopic ", 1.4497;
    Melanopic: "melanopic ", 1.3262;
}
