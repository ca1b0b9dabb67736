//! The sun as a disk of the sky.

use crate::light::contract::{LightError, LightPower, LightSample, LightTarget};
use crate::light::normalise::{Emission, Stated};
use crate::math::warp::{uniform_cone, uniform_cone_pdf};
use crate::math::{Dir, Frame, LocalDir, Vec2};
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::{Density, PdfSolidAngle, Radiance};
use std::f32::consts::PI;

/// Mean angular radius of the sun seen from the earth [°]; it varies by 1.7 % over the year.
pub const SUN_ANGULAR_RADIUS: f32 = 0.2666;

/// A disk of uniform radiance at infinity.
#[derive(Clone, Debug)]
pub struct SunLight {
    /// Around its centre.
    frame: Frame,
    /// 1 − cos of the angular radius.
    one_minus_cos: f32,
    radiance: Emission,
    irradiance: Emission,
}

impl SunLight {
    /// A sun in the direction `centre` (render space) of the given angular radius [°], in [0.01, 10]. `irradiance` is that of a plane
    /// perpendicular to its centre, and a stated total its illuminance [lx].
    pub fn new(
        centre: Dir,
        angular_radius: f32,
        irradiance: Spectrum,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        if !(0.01..=10.0).contains(&angular_radius) {
            return Err(LightError::AngularRadius(angular_radius));
        }
        let irradiance = Emission::new(stated.measurable(irradiance), stated, 1.0)?;
        let alpha = angular_radius.to_radians();
        // E = ∫ L cosθ dω = π sin²α L, A (22) over a cone.
        let radiance = irradiance.times(1.0 / (PI * alpha.sin().powi(2)));
        let one_minus_cos = 2.0 * (0.5 * alpha).sin().powi(2);
        Ok(Self { frame: Frame::from_z(*centre), one_minus_cos, radiance, irradiance })
    }

    pub(in crate::light) fn sample(&self, u: Vec2, w: &Wavelengths) -> Option<LightSample> {
        let radiance: Sampled<Radiance> = self.radiance.at(w);
        let local = LocalDir::new_unchecked(uniform_cone(u, self.one_minus_cos));
        (!radiance.is_zero()).then_some(LightSample {
            wi: self.frame.to_world(local),
            radiance,
            density: Density::SolidAngle(PdfSolidAngle(uniform_cone_pdf(self.one_minus_cos))),
            target: LightTarget::Infinite,
        })
    }

    /// Whether the disk covers a direction: |wi − s|² = 2(1 − cos χ), a difference that keeps the digits which 1 − cos χ
    /// would lose.
    fn covers(&self, wi: Dir) -> bool {
        (*wi - self.frame.n).length_squared() <= 2.0 * self.one_minus_cos
    }

    pub(in crate::light) fn density(&self, wi: Dir) -> PdfSolidAngle {
        PdfSolidAngle(if self.covers(wi) { uniform_cone_pdf(self.one_minus_cos) } else { 0.0 })
    }

    pub(in crate::light) fn escaped(&self, wi: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        if self.covers(wi) { self.radiance.at(w) } else { Sampled::ZERO }
    }

    /// Through the disk that the scene's bounding sphere shows.
    pub(in crate::light) fn power(&self, scene_radius: f32) -> LightPower {
        let area = PI * scene_radius * scene_radius;
        LightPower { watts: self.irradiance.watts() * area, lumens: self.irradiance.lumens() * area }
    }
}
