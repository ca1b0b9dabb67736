//! What arrives at a surface.

use super::*;

#[test]
fn irradiance_from_shapes_is_that_of_the_closed_forms() {
    let origin = facing(Vec3::ZERO, Vec3::Z);
    // Disk on axis: πL R²/(R² + h²), R = 1, h = 2. Sphere: πL (R/d)² cosθ. Square of side 1 at height 1:
    // πL times the configuration factor 0.23945647046 (four corners of ½ × ½).
    let tilted = facing(Vec3::ZERO, Vec3::new(1.0_f32.sin(), 0.0, 1.0_f32.cos()));
    let slanted = facing(Vec3::ZERO, Vec3::new(0.5_f32.sin(), 0.0, 0.5_f32.cos()));
    let cases = [
        ("disk", disk(), origin, 0.628_318_53),
        ("sphere", sphere_at(2.0), origin, QUARTER),
        ("tilted sphere", sphere_at(2.0), tilted, QUARTER * 1.0_f64.cos()),
        ("slanted sphere", sphere_at(2.0), slanted, QUARTER * 0.5_f64.cos()),
        // Half below the horizon (lightlab: σ = 30°, θ = 90°).
        ("setting sphere", sphere_at(2.0), facing(Vec3::ZERO, Vec3::X), 0.090_586_07),
        ("square", square(), origin, 0.239_456_470_46 * std::f64::consts::PI),
    ];
    for (name, shape, from, expected) in cases {
        let light = area_light(&shape, one(), Sides::Front, &ABSOLUTE);
        let e = irradiance(&light, std::slice::from_ref(&shape), &from, 128);
        assert!((e / expected - 1.0).abs() < 2e-3, "{name}: {e} {expected}");
        // Seen from behind there is nothing, unless both sides emit.
        let behind = facing(Vec3::new(0.0, 0.0, 30.0), -Vec3::Z);
        if !name.contains("sphere") {
            assert_eq!(irradiance(&light, std::slice::from_ref(&shape), &behind, 4), 0.0, "{name}");
            let both = area_light(&shape, one(), Sides::Both, &ABSOLUTE);
            assert!(irradiance(&both, std::slice::from_ref(&shape), &behind, 4) > 0.0, "{name}");
        }
    }
}

#[test]
fn irradiance_from_points_and_from_infinity_is_that_of_the_closed_forms() {
    let from = facing(Vec3::new(0.0, 3.0, 0.0), Vec3::Y);
    let lamp = Point::new(4.0, 6.0, 0.0);
    // I cosθ / r² with r = 5, cosθ = 3/5; A (20), (23).
    let point = Light::Point(PointLight::new(Transform::IDENTITY, lamp, one(), &ABSOLUTE).unwrap());
    assert!((irradiance(&point, &[], &from, 1) - 0.6 / 25.0).abs() < 1e-7);
    let spot = |to, cone, delta| {
        let t = Transform::translate(Vec3::new(0.0, 3.0, 0.0));
        Light::Spot(SpotLight::new(t, Point::new(4.0, 3.0, 0.0), to, cone, delta, one(), &ABSOLUTE).unwrap())
    };
    assert!((irradiance(&spot(Point::ORIGIN, 20.0, 5.0), &[], &from, 1) - 0.6 / 25.0).abs() < 1e-7);
    assert_eq!(irradiance(&spot(Point::new(8.0, 0.0, 0.0), 20.0, 5.0), &[], &from, 1), 0.0);
    let distant = DistantLight::new(Transform::IDENTITY, lamp, Point::new(0.0, 3.0, 0.0), one(), &ABSOLUTE);
    assert!((irradiance(&Light::Distant(distant.unwrap()), &[], &from, 1) - 0.6).abs() < 1e-6);
    // A uniform sky: πL, A (22).
    let sky = Light::UniformInfinite(UniformInfiniteLight::new(one(), &ABSOLUTE).unwrap());
    let e = irradiance(&sky, &[], &from, 256);
    // The kink at the horizon costs a midpoint grid of n² nodes about 1/n².
    assert!((e / std::f64::consts::PI - 1.0).abs() < 2e-4, "{e}");
}

#[test]
fn illuminance_under_a_luminaire_is_that_of_its_table() {
    let light = luminaire(
        Transform::translate(Vec3::new(0.0, 0.0, 3.0)),
        EmittingOpening::default(),
        one(),
        &Stated::default(),
    );
    let Light::Photometric(lamp) = &light else { unreachable!() };
    for (x, y) in [(0.0_f64, 0.0_f64), (1.0, 0.0), (0.3, 2.0), (-2.0, 1.1), (-0.7, -4.0), (5.0, -0.1)] {
        let from = facing(Vec3::new(x as f32, y as f32, 0.0), Vec3::Z);
        let lux = photometric(|w| {
            let s = light.sample(&from, &[], 0, Vec2::ZERO, w).unwrap();
            s.radiance * s.wi.dot(*Normal::Z)
        });
        // E = I(C, γ) cosγ / r².
        let r2 = x * x + y * y + 9.0;
        let (c, g) = (y.atan2(x).to_degrees(), (3.0 / r2.sqrt()).acos().to_degrees());
        let expected = lamp.web().at(c, g) * 3.0 / r2.powf(1.5);
        assert!((f64::from(lux) / expected - 1.0).abs() < 2e-3, "{x} {y}: {lux} {expected}");
    }
    // Upside down and turned: the nadir points up, C0 to −x.
    let turned = luminaire(
        Transform::rotate(180.0, Vec3::Y).unwrap(),
        EmittingOpening::default(),
        one(),
        &Stated::default(),
    );
    let at = |d: Vec3| {
        let from = ReferencePoint::free(Point(d), 0.0);
        photometric(|w| turned.sample(&from, &[], 0, Vec2::ZERO, w).map_or(Sampled::ZERO, |s| s.radiance))
    };
    assert!((f64::from(at(Vec3::Z)) / lamp.web().at(0.0, 0.0) - 1.0).abs() < 2e-3);
    assert!((f64::from(at(-Vec3::X)) / lamp.web().at(0.0, 90.0) - 1.0).abs() < 2e-3);
}

#[test]
fn a_lambertian_opening_lights_its_near_field_as_a_surface_does() {
    use photometric::Outline;
    let at = |z: f32| facing(Vec3::new(0.0, 0.0, -z), Vec3::Z);
    // 1 cd over area A is luminance 1/A: πL R²/(R² + h²) = 1/(R² + h²), and πL times the factor 0.23945647046 of a square.
    let disk = lambertian(EmittingOpening { half_x: 1.0, half_y: 1.0, outline: Outline::Ellipse });
    let square = lambertian(EmittingOpening { half_x: 0.5, half_y: 0.5, outline: Outline::Rectangle });
    let cases = [
        ("disk", &disk, 2.0, 0.2),
        ("close disk", &disk, 0.5, 0.8),
        ("square", &square, 1.0, 0.239_456_470_46 * std::f64::consts::PI),
        ("far square", &square, 200.0, 1.0 / 40_000.0),
    ];
    for (name, light, distance, expected) in cases {
        let e = irradiance(light, &[], &at(distance), 128);
        assert!((e / expected - 1.0).abs() < 1e-3, "{name}: {e} {expected}");
    }
}
