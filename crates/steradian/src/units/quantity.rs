//! Wavelength and temperature, and the tags that spectral samples carry.

/// A wavelength in vacuum [nm].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Nm(pub f32);

/// A thermodynamic temperature [K].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Kelvin(pub f32);

/// What a spectral sample measures; implemented by zero-sized tags.
pub trait Quantity: Copy + std::fmt::Debug {
    /// SI unit, per nanometre where the quantity is a spectral density.
    const UNIT: &'static str;
}

/// Spectral radiance L_λ, A (21).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Radiance;

/// A ratio of like quantities: reflectance, transmittance, path throughput.
#[derive(Clone, Copy, Debug)]
pub struct Unitless;

/// A scattering function f, A (25): radiance per irradiance.
#[derive(Clone, Copy, Debug)]
pub struct PerSteradian;

impl Quantity for Radiance {
    const UNIT: &'static str = "W·m⁻²·sr⁻¹·nm⁻¹";
}

impl Quantity for Unitless {
    const UNIT: &'static str = "1";
}

impl Quantity for PerSteradian {
    const UNIT: &'static str = "sr⁻¹";
}
