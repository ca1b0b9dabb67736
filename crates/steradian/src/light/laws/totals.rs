//! What a light gives off in all, and what it is stated to.

use super::*;

#[test]
fn power_is_the_integral_of_intensity() {
    let turn = Transform::rotate(40.0, Vec3::new(1.0, 2.0, -0.5)).unwrap();
    let values: Vec<f32> = (0..16 * 16).map(|i| (i * 7 % 11) as f32).collect();
    let chart = Image::from_f32(16, 16, Layout::Gray, values).unwrap();
    let lights = [
        Light::Point(PointLight::new(turn, Point::ORIGIN, one(), &ABSOLUTE).unwrap()),
        Light::Spot(
            SpotLight::new(turn, Point::ORIGIN, Point::new(0.0, 0.0, 1.0), 50.0, 30.0, one(), &ABSOLUTE)
                .unwrap(),
        ),
        Light::Goniometric(Box::new(GoniometricLight::new(turn, chart, one(), &ABSOLUTE).unwrap())),
        luminaire(turn, EmittingOpening::default(), one(), &ABSOLUTE),
    ];
    for light in &lights {
        // The constant 1 has 471 table entries of 1 W·nm⁻¹ over 470 nm.
        let (expected, found) = (light.power(1.0).watts * 470.0 / 471.0, flux(light, 512).watts);
        assert!((found / expected - 1.0).abs() < 2e-3, "{light:?}: {found} {expected}");
    }
    // Spot without a soft edge: 2πI(1 − cos α).
    let hard =
        SpotLight::new(turn, Point::ORIGIN, Point::new(0.0, 1.0, 0.0), 60.0, 0.0, one(), &ABSOLUTE).unwrap();
    assert!((Light::Spot(hard).power(1.0).watts / (TAU * 0.5 * 471.0) - 1.0).abs() < 1e-5);
}

#[test]
fn scale_one_is_one_candela_per_square_metre_whatever_the_spectrum() {
    let space = ColorSpace::new(ColorSpaceKind::Srgb);
    let narrow = Tabulated::new(&[(500.0, 0.0), (550.0, 7.0), (600.0, 0.0)]).unwrap();
    let spectra = [
        named("stdillum-A").unwrap(),
        Spectrum::Tabulated(narrow),
        space.illuminant_rgb(Rgb::new(1.0, 1.0, 1.0)),
    ];
    let shape = disk();
    for spectrum in spectra {
        for scale in [1.0, 12.0] {
            let stated = Stated { scale, ..Stated::default() };
            let light = area_light(&shape, spectrum.clone(), Sides::Front, &stated);
            let from = facing(Vec3::ZERO, Vec3::Z);
            let nit = photometric(|w| {
                light.sample(&from, std::slice::from_ref(&shape), 0, Vec2::splat(0.5), w).unwrap().radiance
            });
            assert!((nit / scale - 1.0).abs() < 3e-3, "{nit} {scale} {spectrum:?}");
        }
    }
    // An RGB triple keeps its size: (5, 5, 5) is 5 cd/m².
    let bright =
        area_light(&shape, space.illuminant_rgb(Rgb::new(5.0, 5.0, 5.0)), Sides::Front, &Stated::default());
    assert!((bright.power(1.0).lumens / (5.0 * PI * PI) - 1.0).abs() < 1e-3, "{:?}", bright.power(1.0));
}

#[test]
fn a_stated_power_or_illuminance_is_what_the_light_gives() {
    let white = || named("stdillum-D65").unwrap();
    let stated = Stated { total: Some(Total::Luminous(800.0)), ..Stated::default() };
    let t = Transform::IDENTITY;
    let (here, there) = (Point::ORIGIN, Point::new(0.0, 0.0, 1.0));
    let chart = Image::from_f32(2, 2, Layout::Gray, vec![0.5, 1.0, 2.0, 0.0]).unwrap();
    let shape = square();
    let lights = [
        Light::Point(PointLight::new(t, here, white(), &stated).unwrap()),
        Light::Spot(SpotLight::new(t, here, there, 30.0, 5.0, white(), &stated).unwrap()),
        Light::Goniometric(Box::new(GoniometricLight::new(t, chart, white(), &stated).unwrap())),
        Light::Projection(Box::new(ProjectionLight::new(t, 50.0, picture([4, 4], sky), &stated).unwrap())),
        luminaire(t, EmittingOpening::default(), white(), &stated),
        area_light(&shape, white(), Sides::Front, &stated),
        area_light(&shape, white(), Sides::Both, &stated),
    ];
    for light in &lights {
        let lumens = light.power(1.0).lumens;
        assert!((lumens / 800.0 - 1.0).abs() < 1e-4, "{light:?}: {lumens}");
    }
    let unscaled = |sides| area_light(&shape, white(), sides, &Stated::default()).power(1.0).lumens;
    assert!((unscaled(Sides::Both) / unscaled(Sides::Front) - 2.0).abs() < 1e-6);
    assert!((unscaled(Sides::Front) / PI - 1.0).abs() < 1e-4, "1 cd/m² over 1 m² is π lm");

    let from = facing(Vec3::ZERO, Vec3::Z);
    let lux = |light: &Light, n: u32| {
        photometric(|w| {
            let mut e = Sampled::ZERO;
            for u in grid(n) {
                let Some(s) = light.sample(&from, &[], 0, u, w) else { continue };
                let cos = s.wi.z.max(0.0) / (n * n) as f32;
                e += match s.density {
                    Density::Delta => s.radiance * cos,
                    Density::SolidAngle(p) => s.radiance * (cos / p.0),
                };
            }
            e
        })
    };
    let overhead = DistantLight::new(t, there, here, white(), &stated).unwrap();
    assert!((lux(&Light::Distant(overhead), 1) / 800.0 - 1.0).abs() < 3e-3);
    let uniform = UniformInfiniteLight::new(white(), &stated).unwrap();
    assert!((lux(&Light::UniformInfinite(uniform), 16) / 800.0 - 1.0).abs() < 5e-3);
    let map = ImageInfiniteLight::new(t, picture([16, 16], sky), &stated).unwrap();
    let found = lux(&Light::ImageInfinite(Box::new(map)), 64);
    assert!((found / 800.0 - 1.0).abs() < 0.02, "{found}");
}

#[test]
fn a_total_in_watts_candela_or_nits_is_what_the_light_gives() {
    let stated = |total| Stated { total: Some(total), scale: 2.0, ..Stated::default() };
    let t = Transform::IDENTITY;
    let (here, there) = (Point::ORIGIN, Point::new(0.0, 0.0, 1.0));
    let shape = square();
    let chart = || Image::from_f32(2, 2, Layout::Gray, vec![0.5, 1.0, 4.0, 0.0]).unwrap();
    // Half of the slide at 3 times white, the other half black.
    let slide = || picture([16, 16], |x, _| if x < 8 { [3.0; 3] } else { [0.0; 3] });
    for spectrum in [named("stdillum-D65").unwrap(), named("stdillum-A").unwrap()] {
        let all = |total| {
            let (s, stated) = (|| spectrum.clone(), stated(total));
            [
                Light::Point(PointLight::new(t, here, s(), &stated).unwrap()),
                Light::Spot(SpotLight::new(t, here, there, 30.0, 5.0, s(), &stated).unwrap()),
                Light::Goniometric(Box::new(GoniometricLight::new(t, chart(), s(), &stated).unwrap())),
                Light::Projection(Box::new(ProjectionLight::new(t, 50.0, slide(), &stated).unwrap())),
                area_light(&shape, s(), Sides::Both, &stated),
                Light::Distant(DistantLight::new(t, there, here, s(), &stated).unwrap()),
                Light::UniformInfinite(UniformInfiniteLight::new(s(), &stated).unwrap()),
                Light::ImageInfinite(Box::new(
                    ImageInfiniteLight::new(t, picture([64, 64], |_, _| [2.0; 3]), &stated).unwrap(),
                )),
            ]
        };
        // Of lights at infinity, a sphere of radius 1 receives π E of parallel light and 4π E of a uniform sky.
        let received = [1.0, 1.0, 1.0, 1.0, 1.0, PI, 4.0 * PI, 4.0 * PI];
        for (light, factor) in all(Total::Radiant(7.0)).iter().zip(received) {
            let watts = light.power(1.0).watts;
            // What a map lays on a plane is a sum over its texels.
            assert!((watts / (14.0 * factor) - 1.0).abs() < 2e-3, "{}: {watts}", light.kind());
        }
        // Luminous power of a largest intensity, or a luminance, of 2 · 7.
        let spot = TAU * (1.0 - 0.5 * (25_f32.to_radians().cos() + 30_f32.to_radians().cos()));
        let half = 25_f32.to_radians().tan();
        // Half of a square pyramid: 4 asin(sin²) of its half angle at the middle of the sides.
        let slide = 2.0 * (half * half / (1.0 + half * half)).asin();
        let sky = 4.0 * PI * PI;
        let geometry = [4.0 * PI, spot, 4.0 * PI * 5.5 / 16.0, slide, 2.0 * PI, PI, sky, sky];
        for (light, factor) in all(Total::Directional(7.0)).iter().zip(geometry) {
            let lumens = light.power(1.0).lumens;
            // The projector's flux is a sum over its texels.
            let tolerance = if light.kind() == "projection" { 2e-3 } else { 1e-4 };
            assert!(
                (lumens / (14.0 * factor) - 1.0).abs() < tolerance,
                "{}: {lumens} {factor}",
                light.kind()
            );
        }
    }
    let infrared = Spectrum::Tabulated(Tabulated::new(&[(900.0, 1.0), (1000.0, 1.0)]).unwrap());
    let dark = PointLight::new(t, here, infrared, &stated(Total::Radiant(1.0)));
    assert_eq!(dark.unwrap_err(), LightError::NoRadiantPower);
}
