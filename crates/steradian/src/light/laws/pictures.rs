//! Where slides, pictures and cones of light lie, and which lights are refused.

use super::*;

#[test]
fn a_projector_throws_its_slide_upright_and_its_power_is_what_leaves() {
    let slide = picture([8, 4], |x, y| match (x < 4, y < 2) {
        (true, true) => [4.0, 0.0, 0.0],
        (false, true) => [0.0, 4.0, 0.0],
        (true, false) => [0.0, 0.0, 4.0],
        (false, false) => [1.0, 1.0, 1.0],
    });
    let light = Light::Projection(Box::new(
        ProjectionLight::new(Transform::IDENTITY, 60.0, slide, &Stated { scale: 2.0, ..Stated::default() })
            .unwrap(),
    ));
    let luminous = |d: Vec3| {
        let from = ReferencePoint::free(Point(d / d.length()), 0.0);
        photometric(|w| light.sample(&from, &[], 0, Vec2::ZERO, w).map_or(Sampled::ZERO, |s| s.radiance))
    };
    // Short side: slope tan 30°; the long side twice that. Luminance of the sRGB primaries: 0.2126, 0.7152, 0.0722.
    let t = 30.0_f32.to_radians().tan();
    for (x, y, expected) in
        [(-1.0, 0.5, 8.0 * 0.2126), (1.0, 0.5, 8.0 * 0.7152), (-1.0, -0.5, 8.0 * 0.0722), (1.0, -0.5, 2.0)]
    {
        let cd = luminous(Vec3::new(x * t, y * t, 1.0));
        assert!((cd / expected - 1.0).abs() < 0.02, "{x} {y}: {cd} {expected}");
    }
    assert_eq!(luminous(Vec3::new(0.0, 1.1 * t, 1.0)) + luminous(Vec3::new(0.0, 0.0, -1.0)), 0.0);
    // Lumens by quadrature over the slide's plane, dω = cos³θ dA.
    let n = 64;
    let lumens: f32 = grid(n)
        .map(|u| (2.0 * u - Vec2::ONE) * Vec2::new(2.0 * t, t))
        .map(|p| {
            let quadrant = match (p.x < 0.0, p.y > 0.0) {
                (true, true) => 8.0 * 0.2126,
                (false, true) => 8.0 * 0.7152,
                (true, false) => 8.0 * 0.0722,
                (false, false) => 2.0,
            };
            quadrant * (1.0 + p.length_squared()).powf(-1.5) * 8.0 * t * t / (n * n) as f32
        })
        .sum();
    let stated = light.power(1.0).lumens;
    assert!((stated / lumens - 1.0).abs() < 0.01, "{stated} {lumens}");
}

#[test]
fn pictures_on_surfaces_are_upright() {
    // Top row red, bottom row green: v = 1 is the top.
    let slide = picture([2, 8], |_, y| if y < 4 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] });
    let shape = square();
    let radiance = AreaRadiance::Picture(Box::new(slide));
    let light =
        DiffuseAreaLight::new(ShapeId(0), &shape, radiance, Sides::Front, &Stated::default()).unwrap();
    for (v, nit) in [(0.9, 0.2126), (0.1, 0.7152)] {
        let found = photometric(|w| light.radiance(Normal::Z, Vec2::new(0.5, v), Dir::Z, w));
        assert!((found / nit - 1.0).abs() < 0.02, "{v}: {found}");
    }
    let total = Light::DiffuseArea(light).power(1.0).lumens;
    assert!((total / (PI * 0.5 * (0.2126 + 0.7152)) - 1.0).abs() < 1e-3, "{total}");
}

#[test]
fn a_spot_narrower_than_its_falloff_begins_to_fall_at_the_mirrored_angle() {
    let at = |cone, delta, angle: f32| {
        let spot = SpotLight::new(
            Transform::IDENTITY,
            Point::ORIGIN,
            Point::new(0.0, 0.0, 1.0),
            cone,
            delta,
            one(),
            &ABSOLUTE,
        );
        let from = Vec3::new(angle.to_radians().sin(), 0.0, angle.to_radians().cos());
        let w = Wavelengths::sample_visible(0.5);
        spot.unwrap().sample(&facing(from, -from), &w).map_or(0.0, |s| s.radiance[0])
    };
    // pbrt-v4's default falloff of 5 degrees on a cone of 4: full within 1 degree, dark beyond 4.
    for angle in [0.0_f32, 0.9, 2.0, 3.0, 3.9, 4.1] {
        let (x, full, dark) = (angle.to_radians().cos(), 1_f32.to_radians().cos(), 4_f32.to_radians().cos());
        let expected = crate::math::float::smoothstep(x, dark, full);
        assert!((at(4.0, 5.0, angle) - expected).abs() < 2e-3, "{angle}: {}", at(4.0, 5.0, angle));
    }
    // A falloff that could only begin outside the cone leaves none.
    assert!((at(2.0, 5.0, 1.9) - 1.0).abs() < 1e-4);
    assert_eq!(at(2.0, 5.0, 2.1), 0.0);
}

#[test]
fn impossible_lights_are_refused() {
    let infrared = Spectrum::Tabulated(Tabulated::new(&[(900.0, 1.0), (1000.0, 1.0)]).unwrap());
    let t = Transform::IDENTITY;
    let origin = Point::ORIGIN;
    assert_eq!(
        PointLight::new(t, origin, infrared.clone(), &Stated::default()).unwrap_err(),
        LightError::Invisible
    );
    assert!(PointLight::new(t, origin, infrared, &ABSOLUTE).is_ok());
    let negative = Stated { scale: -1.0, ..Stated::default() };
    assert_eq!(PointLight::new(t, origin, one(), &negative).unwrap_err(), LightError::Amount(-1.0));
    let black = PointLight::new(t, origin, Spectrum::Constant(0.0), &Stated::default()).unwrap();
    assert_eq!(Light::Point(black).power(1.0), LightPower::default());
    assert_eq!(DistantLight::new(t, origin, origin, one(), &ABSOLUTE).unwrap_err(), LightError::NoDirection);
    assert!(matches!(
        SpotLight::new(t, origin, Point::new(1.0, 0.0, 0.0), 10.0, -1.0, one(), &ABSOLUTE),
        Err(LightError::Cone { .. })
    ));
    let oblong = ImageInfiniteLight::new(t, picture([4, 2], sky), &Stated::default());
    assert_eq!(oblong.unwrap_err(), LightError::NotSquare(4, 2));
}
