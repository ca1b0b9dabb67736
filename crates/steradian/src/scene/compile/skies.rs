//! From statements of skies and the sun to lights.

use super::lights::{LightCompiler, stated};
use crate::light::{
    Compass, Ground, Handedness, Light, LightError, SkyLight, SkyPlacement, SolarPosition, SunLight,
};
use crate::math::{Dir, Transform, Vec3};
use crate::scene::desc::{HorizonDesc, LightDesc, SkyDesc, SunDesc, SunPlaceDesc, SunPositionDesc};

impl LightCompiler<'_, '_> {
    /// The light of a sky; `None` when it is faulty, which is reported.
    pub(super) fn sky(&mut self, desc: &SkyDesc, light: &LightDesc, t: &Transform) -> Option<Light> {
        let spectrum = self.spectrum(&desc.spectrum);
        let stated = stated(light.scale, light.normalization, light.total);
        let ground = desc.ground.map(|reflectance| Ground { reflectance, irradiance: None });
        let made = placement(&desc.horizon, desc.sun.as_ref(), t, self.handedness)
            .and_then(|p| SkyLight::new(&p, desc.model, spectrum, &stated, ground));
        let place = match (&made, &desc.sun) {
            (Err(LightError::SunBelowHorizon(_)), Some(sun)) => sun.span,
            _ => light.span,
        };
        self.report(made.map(|sky| Light::Sky(Box::new(sky))), place)
    }

    /// The light of a sun; `None` when it is faulty, which is reported.
    pub(super) fn sun(&mut self, desc: &SunDesc, light: &LightDesc, t: &Transform) -> Option<Light> {
        let irradiance = self.spectrum(&desc.irradiance);
        let stated = stated(light.scale, light.normalization, light.total);
        let made = placement(&desc.horizon, Some(&desc.place), t, self.handedness).and_then(|p| {
            let centre = p.sun.ok_or(LightError::NoSun)?;
            let seen_from = matches!(desc.place.position, SunPositionDesc::SeenFrom { .. });
            // A direction is meant as it is given, whether or not the scene says where up is.
            if seen_from && centre.dot(*p.up) < 0.0 {
                return Err(LightError::SunBelowHorizon(centre.dot(*p.up).asin().to_degrees()));
            }
            SunLight::new(centre, desc.angular_radius, irradiance, &stated)
        });
        let place = match made {
            Err(LightError::SunBelowHorizon(_)) => desc.place.span,
            _ => light.span,
        };
        self.report(made.map(|sun| Light::Sun(Box::new(sun))), place)
    }
}

/// Up and the sun in render space.
fn placement(
    horizon: &HorizonDesc,
    sun: Option<&SunPlaceDesc>,
    render_from_light: &Transform,
    handedness: Handedness,
) -> Result<SkyPlacement, LightError> {
    let turned = |v: Vec3| Dir::new(render_from_light.vector(v)).ok_or(LightError::Singular);
    let up = turned(horizon.up)?;
    let sun = match sun.map(|s| s.position) {
        None => None,
        Some(SunPositionDesc::Towards(v)) => Some(turned(v)?),
        Some(SunPositionDesc::SeenFrom { place, moment }) => {
            let near_y = horizon.up.y.abs() > horizon.up.x.hypot(horizon.up.z);
            let reference = render_from_light.vector(if near_y { Vec3::Z } else { Vec3::Y });
            let compass =
                Compass::new(up, reference, horizon.north, handedness).ok_or(LightError::Singular)?;
            let seen = SolarPosition::at(&place, &moment);
            Some(compass.direction(seen.elevation, seen.azimuth))
        }
    };
    Ok(SkyPlacement { up, sun })
}
