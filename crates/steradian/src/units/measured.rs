//! Estimates that know what they measure.

use super::estimate::Estimate;
use super::kind::{
    Energy, EquivalentDaylight, Exitance, Flux, Intensity, Irradiance, Luminous, Melanopic, Radiant,
    Spectral, Unit,
};
use super::quantity::Radiance;
use std::fmt;
use std::marker::PhantomData;

/// A reading of quantity `K` in domain `D`, with its unit and interval.
///
/// Readings of different quantities do not mix:
///
/// ```compile_fail
/// use steradian::units::{Illuminance, Luminance};
/// let sum = Illuminance::exact(1.0).plus_independent(Luminance::exact(1.0));
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct Measured<K, D> {
    estimate: Estimate,
    tag: PhantomData<(K, D)>,
}

/// Φ_v [lm].
pub type LuminousFlux = Measured<Flux, Luminous>;
/// I_v [cd].
pub type LuminousIntensity = Measured<Intensity, Luminous>;
/// E_v [lx].
pub type Illuminance = Measured<Irradiance, Luminous>;
/// L_v [cd·m⁻²].
pub type Luminance = Measured<Radiance, Luminous>;
/// M_v [lm·m⁻²].
pub type LuminousExitance = Measured<Exitance, Luminous>;
/// Melanopic EDI, E_v,mel(D65) [lx].
pub type MelanopicIlluminance = Measured<Irradiance, EquivalentDaylight<Melanopic>>;
/// Φ_e [W].
pub type RadiantFlux = Measured<Flux, Radiant>;
/// Q_e [J].
pub type RadiantEnergy = Measured<Energy, Radiant>;
/// M_e [W·m⁻²].
pub type RadiantExitance = Measured<Exitance, Radiant>;
/// E_λ [W·m⁻²·nm⁻¹].
pub type SpectralIrradiance = Measured<Irradiance, Spectral>;

impl<K: Unit<D>, D> Measured<K, D> {
    /// The SI unit.
    pub const UNIT: &'static str = K::UNIT;
    /// The quantity's name.
    pub const NAME: &'static str = K::NAME;

    /// A reading in the SI unit.
    pub const fn new(estimate: Estimate) -> Self {
        Self { estimate, tag: PhantomData }
    }

    /// A value that chance has no part in, in the SI unit.
    pub const fn exact(value: f64) -> Self {
        Self::new(Estimate::exact(value))
    }

    /// The number with its interval, in the SI unit.
    pub const fn estimate(self) -> Estimate {
        self.estimate
    }

    /// The number, in the SI unit.
    pub const fn value(self) -> f64 {
        self.estimate.value
    }

    /// Times a pure number.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self::new(self.estimate.scaled(factor))
    }

    /// The sum with a reading of other samples.
    #[must_use]
    pub fn plus_independent(self, other: Self) -> Self {
        Self::new(self.estimate.plus_independent(other.estimate))
    }
}

/// `3.142 ± 0.004 W·m⁻²`.
impl<K: Unit<D>, D> fmt::Display for Measured<K, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.estimate, K::UNIT)
    }
}

impl<K: Unit<D>, D> fmt::Debug for Measured<K, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {self}", K::NAME)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_print_with_their_unit() {
        let e = Measured::<Irradiance, Radiant>::new(Estimate { value: 3.141_6, half_width: 0.004 });
        assert_eq!(e.to_string(), "3.142 ± 0.004 W·m⁻²");
        assert_eq!(format!("{:?}", Luminance::exact(60.0)), "luminance 60 cd·m⁻²");
    }
}
