//! From statements of skies and the sun to lights.

use super::lights::{LightCompiler, stated};
use super::view::rebase;
use crate::light::{
    Amount, Compass, Daylight, GeneralSky, Ground, Light, LightError, SkyLight, SkyModel, SkyPlacement,
    SolarPosition, Stated, SunLight,
};
use crate::math::{Dir, Transform, Vec3};
use crate::scene::desc::{
    HorizonDesc, LightDesc, LightKind, SkyDesc, SkyKindDesc, SunDesc, SunPlaceDesc, SunPositionDesc,
};

impl LightCompiler<'_, '_> {
    /// The light of a sky; `None` when it is faulty, which is reported.
    pub(super) fn sky(&mut self, desc: &SkyDesc, light: &LightDesc, t: &Transform) -> Option<Light> {
        let made = self.place(&desc.horizon, desc.sun.as_ref(), t).and_then(|placed| match &desc.kind {
            SkyKindDesc::Distribution { model, spectrum } => {
                let spectrum = self.spectrum(spectrum);
                let stated = stated(light.scale, light.normalization, light.total);
                let ground = desc.ground.map(|reflectance| Ground { reflectance, irradiance: None });
                SkyLight::new(&placed.at, *model, spectrum, &stated, ground)
            }
            SkyKindDesc::Cloudless { atmosphere, sun } => {
                let spectra = atmosphere.spectra(&placed.daylight());
                let ground = desc.ground.map(|reflectance| Ground {
                    reflectance,
                    irradiance: sun.map(|_| spectra.global_horizontal.clone()),
                });
                let clear = SkyModel::General(GeneralSky::CLEAR);
                SkyLight::of_irradiance(&placed.at, clear, spectra.diffuse_horizontal, light.scale, ground)
            }
        });
        let place = match (&made, &desc.sun) {
            (Err(LightError::SunBelowHorizon(_)), Some(sun)) => sun.span,
            _ => light.span,
        };
        self.report(made.map(|sky| Light::Sky(Box::new(sky))), place)
    }

    /// The sun that a statement of a sky makes besides it; faults are those of the sky, and reported with it.
    pub(super) fn companion(&self, light: &LightDesc) -> Option<Light> {
        let LightKind::Sky(desc) = &light.kind else { return None };
        let SkyKindDesc::Cloudless { atmosphere, sun: Some(radius) } = &desc.kind else { return None };
        let placement = rebase(&self.render_from_world, &light.world_from_light);
        let placed = self.place(&desc.horizon, desc.sun.as_ref(), placement.start()).ok()?;
        let irradiance = atmosphere.spectra(&placed.daylight()).direct_normal;
        let absolute = Stated { scale: light.scale, amount: Amount::Absolute, total: None };
        SunLight::new(placed.at.sun?, *radius, irradiance, &absolute)
            .map(|sun| Light::Sun(Box::new(sun)))
            .ok()
    }

    /// The light of a sun; `None` when it is faulty, which is reported.
    pub(super) fn sun(&mut self, desc: &SunDesc, light: &LightDesc, t: &Transform) -> Option<Light> {
        let irradiance = self.spectrum(&desc.irradiance);
        let stated = stated(light.scale, light.normalization, light.total);
        let made = self.place(&desc.horizon, Some(&desc.place), t).and_then(|placed| {
            let SkyPlacement { up, sun } = placed.at;
            let centre = sun.ok_or(LightError::NoSun)?;
            let seen_from = matches!(desc.place.position, SunPositionDesc::SeenFrom { .. });
            // A direction is meant as it is given, whether or not the scene says where up is.
            if seen_from && centre.dot(*up) < 0.0 {
                return Err(LightError::SunBelowHorizon(centre.dot(*up).asin().to_degrees()));
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

impl LightCompiler<'_, '_> {
    fn place(
        &self,
        horizon: &HorizonDesc,
        sun: Option<&SunPlaceDesc>,
        render_from_light: &Transform,
    ) -> Result<Placed, LightError> {
        let turned = |v: Vec3| Dir::new(render_from_light.vector(v)).ok_or(LightError::Singular);
        let up = turned(horizon.up)?;
        let mut distance = 1.0;
        let sun = match sun.map(|s| s.position) {
            None => None,
            Some(SunPositionDesc::Towards(v)) => Some(turned(v)?),
            Some(SunPositionDesc::SeenFrom { place, moment }) => {
                let near_y = horizon.up.y.abs() > horizon.up.x.hypot(horizon.up.z);
                let reference = render_from_light.vector(if near_y { Vec3::Z } else { Vec3::Y });
                let compass = Compass::new(up, reference, horizon.north, self.handedness)
                    .ok_or(LightError::Singular)?;
                let seen = SolarPosition::at(&place, &moment);
                distance = seen.distance;
                Some(compass.direction(seen.elevation, seen.azimuth))
            }
        };
        Ok(Placed { at: SkyPlacement { up, sun }, distance })
    }
}

/// Up and the sun in render space.
struct Placed {
    at: SkyPlacement,
    /// Of the sun [astronomical units].
    distance: f64,
}

impl Placed {
    fn daylight(&self) -> Daylight {
        let SkyPlacement { up, sun } = self.at;
        let sine = sun.map_or(0.0, |sun| f64::from(sun.dot(*up)).clamp(0.0, 1.0));
        Daylight { elevation: sine.asin().to_degrees(), distance: self.distance }
    }
}
