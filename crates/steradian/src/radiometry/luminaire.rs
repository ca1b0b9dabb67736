//! Point luminaires whose intensity distribution has a closed form.

use crate::units::{Cosine, LuminousFlux, LuminousIntensity, SolidAngle};
use std::f64::consts::PI;

/// A rotationally symmetric distribution of luminous intensity about an axis, with the intensity I₀ on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// Intensity on the axis.
    pub peak: LuminousIntensity,
    /// How it falls off.
    pub falloff: Falloff,
}

/// How intensity depends on the angle γ to the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// The same in all directions.
    Isotropic,
    /// I₀ cosᵐγ in front, nothing behind; m = 1 for a small Lambertian panel. The exponent is at least 0.
    CosinePower(f64),
    /// I₀ up to the angle from the axis [rad], in (0, π], and nothing beyond.
    Cone(f64),
}

impl Lobe {
    /// The intensity in a direction whose angle to the axis has the cosine.
    pub fn intensity(&self, to_axis: Cosine) -> LuminousIntensity {
        let share = match self.falloff {
            Falloff::Isotropic => 1.0,
            Falloff::CosinePower(m) => to_axis.facing().powf(m) * f64::from(to_axis.value() > 0.0),
            Falloff::Cone(half_angle) => f64::from(to_axis.value() >= half_angle.cos()),
        };
        self.peak.scaled(share)
    }

    /// All of its flux, ∫ I dω: 4πI₀ (isotropic), 2πI₀/(m + 1) (cosᵐ), 2πI₀(1 − cosα) (cone).
    pub fn flux(&self) -> LuminousFlux {
        let directions = match self.falloff {
            Falloff::Isotropic => SolidAngle::SPHERE,
            Falloff::CosinePower(m) => SolidAngle(2.0 * PI / (m + 1.0)),
            Falloff::Cone(half_angle) => super::solid_angle::cap(half_angle),
        };
        self.peak.into_solid_angle(directions)
    }

    /// The lobe of this shape that has the flux.
    pub fn of_flux(flux: LuminousFlux, falloff: Falloff) -> Self {
        let unit = Self { peak: LuminousIntensity::exact(1.0), falloff };
        Self { peak: flux.over_solid_angle(SolidAngle(unit.flux().value())), falloff }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radiometry::solid_angle::Patch;
    use crate::units::Metres;

    #[test]
    fn fluxes_are_the_sums_over_patches_of_the_sphere() {
        let peak = LuminousIntensity::exact(100.0);
        for falloff in [
            Falloff::Isotropic,
            Falloff::CosinePower(1.0),
            Falloff::CosinePower(7.5),
            Falloff::Cone(0.5 * PI),
        ] {
            let lobe = Lobe { peak, falloff };
            let step = PI / 20_000.0;
            let sum: f64 = (0..20_000)
                .map(|i| {
                    let theta = [f64::from(i) * step, f64::from(i + 1) * step];
                    let ring = Patch { theta, phi: [0.0, 2.0 * PI] }.solid_angle();
                    let middle = Cosine::new((0.5 * (theta[0] + theta[1])).cos()).unwrap();
                    lobe.intensity(middle).into_solid_angle(ring).value()
                })
                .sum();
            assert!((sum / lobe.flux().value() - 1.0).abs() < 1e-6, "{falloff:?}");
        }
        let lambert = Lobe::of_flux(LuminousFlux::exact(PI), Falloff::CosinePower(1.0));
        assert!((lambert.peak.value() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_downlight_lights_a_desk_by_the_fourth_power_of_the_cosine() {
        // Lambertian lobe above a horizontal desk: E = I₀ cosγ · cosγ / (h/cosγ)² = I₀ cos⁴γ/h².
        let lobe = Lobe { peak: LuminousIntensity::exact(900.0), falloff: Falloff::CosinePower(1.0) };
        let (h, cos) = (3.0, Cosine::of_degrees(30.0));
        let lux = lobe.intensity(cos).at(Metres(h / cos.value()), cos);
        assert!((lux.value() - 100.0 * 0.5625).abs() < 1e-10);
    }
}
