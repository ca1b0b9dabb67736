//! What becomes of the power that reaches a body.

use super::fresnel::Polarized;

/// Shares of the incident power: reflected, transmitted, and the rest absorbed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shares {
    /// ρ, in [0, 1].
    pub reflectance: f64,
    /// τ, in [0, 1].
    pub transmittance: f64,
}

impl Shares {
    /// All light reflected: total reflection, and every surface at grazing incidence.
    pub const REFLECTED: Self = Self { reflectance: 1.0, transmittance: 0.0 };

    /// The absorbed share 1 − ρ − τ, B (2.14)–(2.15).
    pub fn absorptance(self) -> f64 {
        1.0 - self.reflectance - self.transmittance
    }
}

impl Polarized<Shares> {
    /// The shares of unpolarised light: the mean of both polarisations.
    pub fn unpolarized(self) -> Shares {
        Shares {
            reflectance: 0.5 * (self.s.reflectance + self.p.reflectance),
            transmittance: 0.5 * (self.s.transmittance + self.p.transmittance),
        }
    }
}
