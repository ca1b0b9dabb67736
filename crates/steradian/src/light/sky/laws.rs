//! Skies and the sun against closed forms of daylight photometry.

use super::*;
use crate::light::{Amount, Light, LightError, LightPower, Stated, Total};
use crate::math::hash::Pcg32;
use crate::math::warp::{equal_area_square_to_sphere, uniform_sphere};
use crate::math::{Dir, Point, Vec2, Vec3};
use crate::shape::ReferencePoint;
use crate::spectrum::{Spectrum, Wavelengths, named};
use crate::units::{Density, PdfSolidAngle};
use std::f64::consts::{PI, TAU};

fn total(total: Total) -> Stated {
    Stated { total: Some(total), ..Stated::default() }
}

const ABSOLUTE: Stated = Stated { scale: 1.0, amount: Amount::Absolute, total: None };

fn one() -> Spectrum {
    Spectrum::Constant(1.0)
}

fn d65() -> Spectrum {
    named("stdillum-D65").unwrap()
}

fn dir(v: Vec3) -> Dir {
    Dir::new(v).unwrap()
}

fn general(number: usize) -> SkyModel {
    SkyModel::General(GeneralSky::of_type(number).unwrap())
}

/// Neither up nor the sun's azimuth along an axis.
fn placement(sun_elevation: f32) -> SkyPlacement {
    let up = dir(Vec3::new(0.3, 0.8, -0.4));
    let level = dir(up.cross(Vec3::new(0.2, 0.1, 1.0)));
    let (sin, cos) = sun_elevation.to_radians().sin_cos();
    SkyPlacement { up, sun: Some(dir(*up * sin + *level * cos)) }
}

fn sky(model: SkyModel, sun: f32, stated: &Stated, ground: Option<f32>) -> SkyLight {
    let ground = ground.map(|reflectance| Ground { reflectance, irradiance: None });
    SkyLight::new(&placement(sun), model, one(), stated, ground).unwrap()
}

fn specimens() -> Vec<(String, SkyLight)> {
    let mut all = vec![
        ("uniform".to_owned(), sky(SkyModel::Uniform, 30.0, &ABSOLUTE, None)),
        ("overcast".to_owned(), sky(SkyModel::Overcast, 30.0, &ABSOLUTE, None)),
        ("overcast with ground".to_owned(), sky(SkyModel::Overcast, 30.0, &ABSOLUTE, Some(0.4))),
    ];
    for number in 1..=15 {
        for sun in [2.0, 35.0, 89.9] {
            let ground = (number % 2 == 0).then_some(0.2);
            all.push((format!("type {number}, sun {sun}"), sky(general(number), sun, &ABSOLUTE, ground)));
        }
    }
    all
}

/// A point without orientation: skies do not ask for one.
fn anywhere() -> ReferencePoint {
    ReferencePoint::free(Point::ORIGIN, 0.0)
}

fn grid(n: u32) -> impl Iterator<Item = Vec2> {
    (0..n * n).map(move |i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32)
}

/// Irradiance of a plane with normal `n`, first lane, by samples of the light.
fn irradiance(light: &Light, n: Dir, side: u32) -> f64 {
    let w = Wavelengths::sample_visible(0.5);
    let mut sum = 0.0;
    // Jittered: a regular grid would beat with the cells of the density.
    let mut rng = Pcg32::new(5, 1);
    for centre in grid(side) {
        let u = centre + (Vec2::new(rng.next_f32(), rng.next_f32()) - 0.5) / side as f32;
        let Some(s) = light.sample(&anywhere(), &[], 0, u, &w) else { continue };
        let Density::SolidAngle(p) = s.density else { panic!("a sky is no delta light") };
        sum += f64::from(s.radiance[0]) * f64::from(s.wi.dot(*n).max(0.0)) / f64::from(p.0);
    }
    sum / f64::from(side * side)
}

/// The same by a quadrature over directions, for skies that are smooth.
fn irradiance_by_directions(light: &Light, n: Dir, side: u32) -> f64 {
    let w = Wavelengths::sample_visible(0.5);
    let mut sum = 0.0;
    for u in grid(side) {
        let wi = dir(equal_area_square_to_sphere(u));
        sum += f64::from(light.escaped(wi, &w)[0]) * f64::from(wi.dot(*n).max(0.0));
    }
    sum * 4.0 * PI / f64::from(side * side)
}

#[test]
fn horizontal_irradiance_of_samples_is_that_of_the_closed_forms() {
    let up = placement(0.0).up;
    for (model, expected) in [(SkyModel::Uniform, PI), (general(5), PI), (SkyModel::Overcast, 7.0 * PI / 9.0)]
    {
        let light = Light::Sky(Box::new(sky(model, 30.0, &ABSOLUTE, None)));
        let e = irradiance(&light, up, 256);
        assert!((e / expected - 1.0).abs() < 2e-4, "{model:?}: {e} {expected}");
        // What stands upright sees half of it; the overcast sky: 1/2 · (1/3)(1 + 8/(3π)) · π of the zenith.
        let side = dir(up.cross(Vec3::X));
        let vertical = match model {
            SkyModel::Overcast => PI / 6.0 * (1.0 + 8.0 / (3.0 * PI)),
            SkyModel::Uniform | SkyModel::General(_) => PI / 2.0,
        };
        let e = irradiance(&light, side, 256);
        assert!((e / vertical - 1.0).abs() < 1e-3, "{model:?}: {e} {vertical}");
    }
}

#[test]
fn samples_of_every_sky_give_its_irradiance_on_any_plane() {
    for (name, light) in specimens() {
        let up = light.up();
        let horizontal = light.horizontal_illuminance().value() / light.zenith_luminance().value();
        let light = Light::Sky(Box::new(light));
        let e = irradiance(&light, up, 128);
        assert!((e / horizontal - 1.0).abs() < 5e-4, "{name}: {e} {horizontal}");
        let tilted = dir(*up + 0.9 * up.cross(Vec3::X));
        let (e, expected) = (irradiance(&light, tilted, 128), irradiance_by_directions(&light, tilted, 512));
        assert!((e / expected - 1.0).abs() < 2e-3, "{name}: {e} {expected}");
    }
}

#[test]
fn the_density_of_every_sky_has_mass_one_and_its_samples_follow_it() {
    let w = Wavelengths::sample_visible(0.4);
    let mut rng = Pcg32::new(11, 1);
    for (name, light) in specimens() {
        let frame = crate::math::Frame::from_z(*light.up());
        let light = Light::Sky(Box::new(light));
        // Cells of a direction: elevation and azimuth about another axis than the table's.
        let cell = |d: Dir| {
            let d = frame.to_local(d);
            let azimuth = (f64::from(d.y).atan2(f64::from(d.x)) / TAU + 1.0).fract();
            usize::from(d.z > 0.5) + 2 * usize::from(d.z > 0.0) + 4 * (azimuth * 6.0) as usize
        };
        let mut expected = [0.0_f64; 24];
        let side = 400;
        for u in grid(side) {
            let d = dir(uniform_sphere(u));
            expected[cell(d)] += f64::from(light.escape_density(d).0) * 4.0 * PI / f64::from(side * side);
        }
        let mass: f64 = expected.iter().sum();
        assert!((mass - 1.0).abs() < 2e-3, "{name}: {mass}");
        let samples = 20_000_u32;
        let (mut counts, mut lost) = ([0_u32; 24], 0);
        for _ in 0..samples {
            let u = Vec2::new(rng.next_f32(), rng.next_f32());
            // A direction within rounding of the horizon may end up below it, where there is nothing.
            let Some(s) = light.sample(&anywhere(), &[], 0, u, &w) else {
                lost += 1;
                continue;
            };
            counts[cell(s.wi)] += 1;
            assert_eq!(s.density, Density::SolidAngle(light.escape_density(s.wi)), "{name}");
            assert_eq!(s.radiance, light.escaped(s.wi, &w), "{name}");
        }
        assert!(lost <= 1, "{name}: {lost}");
        let mut chi2 = 0.0;
        for (&count, p) in counts.iter().zip(expected) {
            let mean = p * f64::from(samples);
            // Pools nothing: a cell is empty because the sky has no ground, or it holds hundreds.
            assert!(mean > 20.0 || count == 0, "{name}: {count} {mean}");
            if mean > 20.0 {
                chi2 += (f64::from(count) - mean).powi(2) / mean;
            }
        }
        // At most 23 degrees of freedom and 48 skies; α = 10⁻⁶ each: 75.
        assert!(chi2 < 75.0, "{name}: {chi2} {counts:?} {expected:?}");
    }
}

#[test]
fn a_stated_illuminance_or_zenith_luminance_is_what_the_sky_has() {
    let green = Spectrum::RgbIlluminant(crate::spectrum::RgbIlluminant {
        scale: 3.0,
        sigmoid: crate::spectrum::Sigmoid { c0: 3.0, c1: -2.0, c2: -0.5 },
        illuminant: d65().densely_sampled(),
    });
    for spectrum in [d65(), named("stdillum-A").unwrap(), green] {
        for model in [SkyModel::Uniform, SkyModel::Overcast, general(12), general(15)] {
            let new =
                |of| SkyLight::new(&placement(40.0), model, spectrum.clone(), &total(of), None).unwrap();
            let lit = new(Total::Luminous(20_000.0));
            assert!((lit.horizontal_illuminance().value() / 20_000.0 - 1.0).abs() < 1e-5, "{model:?}");
            // By quadrature of the luminance over directions, at each nanometre of the table of ȳ.
            let light = Light::Sky(Box::new(lit));
            let spectral = |lambda: f32| {
                let w = Wavelengths::exactly([lambda; 4]);
                f64::from(light.escaped(placement(0.0).up, &w)[0])
            };
            let luminance: f64 = (360..=830)
                .map(|l| spectral(l as f32) * f64::from(crate::spectrum::cie::y_bar(l as f32)))
                .sum::<f64>()
                * f64::from(crate::units::LUMENS_PER_WATT);
            let w = Wavelengths::exactly([560.0; 4]);
            let per_zenith = irradiance_at(&light, placement(0.0).up, &w)
                / f64::from(light.escaped(placement(0.0).up, &w)[0]);
            assert!((luminance * per_zenith / 20_000.0 - 1.0).abs() < 1e-4, "{model:?}");
            let zenith = new(Total::Directional(20_000.0));
            assert!((zenith.zenith_luminance().value() / 20_000.0 - 1.0).abs() < 1e-5, "{model:?}");
        }
    }
    let unit = sky(SkyModel::Overcast, 0.0, &Stated::default(), None);
    assert!((unit.zenith_luminance().value() - 1.0).abs() < 1e-5);
    // Absolute: 1 W·m⁻²·nm⁻¹ on the horizontal plane is 9/7π of radiance at the zenith.
    let absolute = SkyLight::of_irradiance(&placement(40.0), SkyModel::Overcast, one(), 1.0, None);
    let light = Light::Sky(Box::new(absolute.unwrap()));
    let found = light.escaped(placement(0.0).up, &Wavelengths::sample_visible(0.1))[0];
    assert!((f64::from(found) * 7.0 * PI / 9.0 - 1.0).abs() < 1e-5, "{found}");
}

/// Midpoints over cos² Z and azimuth around `up`, which make horizontal irradiance a mean of radiance.
fn irradiance_at(light: &Light, up: Dir, w: &Wavelengths) -> f64 {
    let frame = crate::math::Frame::from_z(*up);
    let side = 256;
    let mean: f64 = grid(side)
        .map(|u| {
            let (sin, cos) = (TAU as f32 * u.x).sin_cos();
            let local = Vec3::new((1.0 - u.y).sqrt() * cos, (1.0 - u.y).sqrt() * sin, u.y.sqrt());
            f64::from(light.escaped(dir(frame.s * local.x + frame.t * local.y + frame.n * local.z), w)[0])
        })
        .sum();
    PI * mean / f64::from(side * side)
}

#[test]
fn the_ground_returns_its_share_of_what_the_sky_sends() {
    let w = Wavelengths::sample_visible(0.3);
    for (name, light) in [
        ("overcast", sky(SkyModel::Overcast, 30.0, &ABSOLUTE, Some(0.4))),
        ("type 13", sky(general(13), 30.0, &ABSOLUTE, Some(0.4))),
    ] {
        let down = -light.up();
        let light = Light::Sky(Box::new(light));
        let e = irradiance_at(&light, -down, &w);
        let ground = f64::from(light.escaped(down, &w)[0]);
        assert!((ground / (0.4 * e / PI) - 1.0).abs() < 1e-4, "{name}: {ground} {e}");
        // Seen from above: ρ E.
        assert!((irradiance(&light, down, 128) / (0.4 * e) - 1.0).abs() < 1e-3, "{name}");
    }
    // Lit by more than the sky.
    let lit = Ground { reflectance: 0.5, irradiance: Some(Spectrum::Constant(8.0)) };
    let double = Stated { scale: 2.0, ..ABSOLUTE };
    let light = SkyLight::new(&placement(9.0), SkyModel::Uniform, one(), &double, Some(lit));
    let light = Light::Sky(Box::new(light.unwrap()));
    assert!((f64::from(light.escaped(-placement(9.0).up, &w)[0]) - 8.0 / PI).abs() < 1e-5);
}

#[test]
fn the_sun_lights_a_facing_plane_with_what_is_stated_and_subtends_its_cone() {
    let centre = dir(Vec3::new(0.3, -0.7, 0.5));
    let w = Wavelengths::sample_visible(0.3);
    for radius in [0.05, SUN_ANGULAR_RADIUS, 5.0] {
        let sun = Light::Sun(Box::new(SunLight::new(centre, radius, one(), &ABSOLUTE).unwrap()));
        let e = irradiance(&sun, centre, 32);
        assert!((e - 1.0).abs() < 1e-4, "{radius}: {e}");
        let tilted = dir(*centre + centre.cross(Vec3::X));
        let e = irradiance(&sun, tilted, 32);
        assert!((e / f64::from(centre.dot(*tilted)) - 1.0).abs() < 1e-4, "{radius}: {e}");
        let frame = crate::math::Frame::from_z(*centre);
        for i in 0..64 {
            let phi = i as f32 * 0.1;
            let at = |share: f32| {
                let (sin, cos) = (share * radius).to_radians().sin_cos();
                dir(frame.s * (phi.cos() * sin) + frame.t * (phi.sin() * sin) + frame.n * cos)
            };
            assert!(sun.escape_density(at(0.9995)).0 > 0.0 && !sun.escaped(at(0.9995), &w).is_zero());
            assert!(sun.escape_density(at(1.0005)).0 == 0.0 && sun.escaped(at(1.0005), &w).is_zero());
        }
        for u in grid(16) {
            let s = sun.sample(&anywhere(), &[], 0, u, &w).unwrap();
            assert_eq!(s.density, Density::SolidAngle(sun.escape_density(s.wi)), "{radius} {u}");
        }
    }
    let stated = total(Total::Luminous(100_000.0));
    let sun = SunLight::new(centre, SUN_ANGULAR_RADIUS, d65(), &stated).unwrap();
    // Through a disk of 1 m².
    let power = Light::Sun(Box::new(sun)).power((1.0 / PI).sqrt() as f32);
    assert!((power.lumens / 100_000.0 - 1.0).abs() < 1e-5, "{power:?}");
    // 6.80·10⁻⁵ sr: 1.47·10⁹ cd/m².
    let sun = SunLight::new(centre, SUN_ANGULAR_RADIUS, one(), &ABSOLUTE).unwrap();
    let PdfSolidAngle(p) = Light::Sun(Box::new(sun)).escape_density(centre);
    assert!((1.0 / p - 6.801e-5).abs() < 1e-8, "{}", 1.0 / p);
}

#[test]
fn power_is_what_enters_the_bounding_sphere() {
    let w = Wavelengths::sample_visible(0.5);
    for (name, sky) in specimens() {
        let light = Light::Sky(Box::new(sky));
        let side = 128;
        let mean: f64 =
            grid(side).map(|u| f64::from(light.escaped(dir(equal_area_square_to_sphere(u)), &w)[0])).sum();
        let expected = mean / f64::from(side * side) * 4.0 * PI * PI * 9.0;
        // The constant 1 has 471 table entries of 1 W·nm⁻¹.
        let LightPower { watts, .. } = light.power(3.0);
        assert!((f64::from(watts) / 471.0 / expected - 1.0).abs() < 5e-3, "{name}: {watts} {expected}");
        assert!(light.is_infinite() && !light.is_delta());
    }
}

#[test]
fn skies_that_cannot_be_are_refused() {
    let new =
        |placement: &SkyPlacement, model| SkyLight::new(placement, model, one(), &ABSOLUTE, None).map(|_| ());
    let nowhere = SkyPlacement { up: Dir::Z, sun: None };
    assert_eq!(new(&nowhere, general(12)), Err(LightError::NoSun));
    assert_eq!(new(&nowhere, general(3)), Ok(()));
    let set = SkyPlacement { up: Dir::Z, sun: Some(dir(Vec3::new(1.0, 0.0, -0.5))) };
    assert!(
        matches!(new(&set, general(12)), Err(LightError::SunBelowHorizon(h)) if (h + 26.565).abs() < 1e-3)
    );
    assert_eq!(new(&set, SkyModel::Overcast), Ok(()));
    let sun = SunLight::new(Dir::Z, 0.0, one(), &ABSOLUTE);
    assert_eq!(sun.unwrap_err(), LightError::AngularRadius(0.0));
}
