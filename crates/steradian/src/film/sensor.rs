//! From spectral radiance to colour: the CIE 1931 observer behind an adjustable exposure.

use crate::color::adaptation::{daylight_chromaticity, planck_chromaticity};
use crate::color::{Adaptation, ColorSpace, ConeModel, Rgb, Xyz, cie};
use crate::math::Vec3;
use crate::spectrum::{LANES, Sampled, Wavelengths};
use crate::units::{Kelvin, LUMENS_PER_WATT, Radiance};
use glam::{DMat3, DVec3, Vec4};

/// How radiance is turned into numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSettings {
    /// Factor on all values; see [`SensorSettings::exposure`].
    pub imaging_ratio: f32,
    /// Colour temperature of the light that shall look white; `None` leaves colours as they are.
    pub white_balance: Option<Kelvin>,
    /// Largest tristimulus value of one sample; greater samples are scaled down. Biased: darkens. `None` for no limit.
    pub max_component: Option<f32>,
}

impl Default for SensorSettings {
    fn default() -> Self {
        Self { imaging_ratio: 1.0, white_balance: None, max_component: None }
    }
}

impl SensorSettings {
    /// The imaging ratio of pbrt-v4: exposure time [s] × ISO / 100. The aperture does not enter.
    pub fn exposure(shutter: [f32; 2], iso: f32) -> f32 {
        (shutter[1] - shutter[0]) * iso / 100.0
    }
}

/// What makes a sensor impossible.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SensorError {
    /// Colour temperature [K].
    #[error("no white has a colour temperature of {} K", .0.0)]
    WhiteBalance(Kelvin),
    /// The imaging ratio.
    #[error("imaging ratio must be positive, not {0}")]
    ImagingRatio(f32),
}

/// A sensor with the sensitivities of the CIE 1931 standard observer.
///
/// With an imaging ratio of 1 its Y is luminance in cd/m².
#[derive(Clone, Debug)]
pub struct Sensor {
    settings: SensorSettings,
    /// Output RGB from the sensor's tristimulus values, white balance included.
    rgb_from_sensor: DMat3,
}

impl Sensor {
    /// A sensor that writes RGB of `space`. Fails when the ratio is not positive or the white does not exist.
    pub fn new(settings: SensorSettings, space: &ColorSpace) -> Result<Self, SensorError> {
        if !(settings.imaging_ratio > 0.0 && settings.imaging_ratio.is_finite()) {
            return Err(SensorError::ImagingRatio(settings.imaging_ratio));
        }
        let to_rgb = space.rgb_from_xyz_matrix().as_dmat3();
        let balance = match settings.white_balance {
            None => DMat3::IDENTITY,
            Some(t) => {
                // Below 4000 K there is no daylight; pbrt-v4 takes thermal light there as well.
                let white =
                    if t.0 < 4000.0 { planck_chromaticity(t) } else { daylight_chromaticity(rescaled(t)) };
                let adaptation =
                    white.and_then(|white| Adaptation::new(ConeModel::Bradford, white, space.white()));
                *adaptation.ok_or(SensorError::WhiteBalance(t))?.matrix()
            }
        };
        Ok(Self { settings, rgb_from_sensor: to_rgb * balance })
    }

    /// The settings, for the picture's metadata.
    pub fn settings(&self) -> &SensorSettings {
        &self.settings
    }

    /// Tristimulus values [cd/m² × imaging ratio] of one sample: K_m Σ L x̄ / p over the wavelengths that still count.
    pub fn expose(&self, radiance: Sampled<Radiance>, w: &Wavelengths) -> Xyz {
        let xyz = tristimulus(radiance, w) * (LUMENS_PER_WATT * self.settings.imaging_ratio);
        match self.settings.max_component {
            Some(limit) if xyz.max_element() > limit => Xyz(xyz * (limit / xyz.max_element())),
            _ => Xyz(xyz),
        }
    }

    /// Output RGB of (sums of) exposures.
    pub fn rgb(&self, sensor: [f64; 3]) -> Rgb {
        Rgb((self.rgb_from_sensor * DVec3::from_array(sensor)).as_vec3())
    }
}

/// One sample of ∫ L x̄, ∫ L ȳ, ∫ L z̄ dλ. Companions that were dropped have density zero and do not count,
/// whatever they carry.
pub(super) fn tristimulus(l: Sampled<Radiance>, w: &Wavelengths) -> Vec3 {
    let mut sum = Vec4::ZERO;
    for lane in 0..LANES {
        let pdf = w.pdf()[lane];
        if pdf > 0.0 {
            sum += cie::bars_at(w, lane) * (l[lane] / pdf);
        }
    }
    sum.truncate() / LANES as f32
}

/// Nominal daylight temperatures (D65: 6500 K) predate the present second radiation constant.
fn rescaled(nominal: Kelvin) -> Kelvin {
    Kelvin(nominal.0 * 1.4388 / 1.4380)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorSpaceKind;
    use crate::spectrum::Spectrum;

    /// Mean exposure of `l` [W·m⁻²·sr⁻¹·nm⁻¹] over a fine grid of u.
    fn mean(sensor: &Sensor, l: impl Fn(f32) -> f32, draw: impl Fn(f32) -> Wavelengths) -> [f64; 3] {
        let n = 20_000;
        let mut sum = [0.0; 3];
        for i in 0..n {
            let w = draw((i as f32 + 0.5) / n as f32);
            let xyz = sensor.expose(Sampled::from_array(w.lambda().map(&l)), &w);
            (0..3).for_each(|c| sum[c] += f64::from(xyz.0[c]) / f64::from(n));
        }
        sum
    }

    #[test]
    fn unit_luminance_is_one_whatever_the_wavelengths() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let white: &Spectrum = space.illuminant();
        let scale = 1.0 / (LUMENS_PER_WATT * white.photometric_integral());
        let sensor = Sensor::new(SensorSettings::default(), &space).unwrap();
        let light = |l: f32| scale * white.at(l);
        let dropped = |u: f32| {
            let mut w = Wavelengths::sample_visible(u);
            w.terminate_companions();
            w
        };
        for xyz in [
            mean(&sensor, light, Wavelengths::sample_visible),
            mean(&sensor, light, dropped),
            mean(&sensor, light, |u| Wavelengths::sample_uniform(u, 360.0, 830.0)),
        ] {
            assert!((xyz[1] - 1.0).abs() < 1e-3, "{xyz:?}");
            // White of luminance 1 is RGB (1, 1, 1).
            assert!((sensor.rgb(xyz).0 - Vec3::ONE).abs().max_element() < 2e-3, "{:?}", sensor.rgb(xyz));
        }
        let iso200 = SensorSettings {
            imaging_ratio: SensorSettings::exposure([1.0, 1.5], 200.0),
            ..Default::default()
        };
        assert_eq!(iso200.imaging_ratio, 1.0);
    }

    #[test]
    fn white_balance_makes_its_light_white() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        for t in [2856.0, 5000.0] {
            let settings = SensorSettings { white_balance: Some(Kelvin(t)), ..Default::default() };
            let sensor = Sensor::new(settings, &space).unwrap();
            let white = if t < 4000.0 {
                planck_chromaticity(Kelvin(t))
            } else {
                daylight_chromaticity(rescaled(Kelvin(t)))
            };
            let xyz = white.unwrap().with_luminance(3.0).0;
            let rgb = sensor.rgb(xyz.as_dvec3().to_array()).0;
            assert!((rgb / rgb.y - Vec3::ONE).abs().max_element() < 1e-4, "{t}: {rgb}");
        }
        let impossible = SensorSettings { white_balance: Some(Kelvin(50_000.0)), ..Default::default() };
        assert!(Sensor::new(impossible, &space).is_err());
    }

    #[test]
    fn the_limit_scales_bright_samples_and_keeps_their_hue() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let free = Sensor::new(SensorSettings::default(), &space).unwrap();
        let limited =
            Sensor::new(SensorSettings { max_component: Some(2.0), ..Default::default() }, &space).unwrap();
        let w = Wavelengths::sample_visible(0.3);
        for l in [1e-5, 1.0] {
            let radiance = Sampled::splat(l);
            let (a, b) = (free.expose(radiance, &w).0, limited.expose(radiance, &w).0);
            let expected = if a.max_element() > 2.0 { a * (2.0 / a.max_element()) } else { a };
            assert!((b - expected).abs().max_element() < 1e-6);
        }
    }
}
