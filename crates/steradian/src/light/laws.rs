//! Lights against closed forms of radiometry and photometry.

use super::*;
use crate::color::{ColorSpace, ColorSpaceKind, Rgb, UpsamplingTable};
use crate::image::{Image, Layout};
use crate::math::warp::{UNIFORM_SPHERE_PDF, equal_area_square_to_sphere};
use crate::math::{BoundedPoint, Normal, Ray, Transform, Vec3};
use crate::shape::{Disk, MeshData, Orientation, ShapeId, Sphere, TriangleMesh};
use crate::spectrum::{LANES, Spectrum, Tabulated, cie, named};
use crate::units::Density;
use std::f32::consts::{PI, TAU};
use std::f64::consts::FRAC_PI_4 as QUARTER;
use std::sync::{Arc, LazyLock};

/// Built once for all tests: it takes half a second.
static TABLE: LazyLock<Arc<UpsamplingTable>> =
    LazyLock::new(|| Arc::new(UpsamplingTable::build(&ColorSpace::new(ColorSpaceKind::Srgb))));

const ABSOLUTE: Stated = Stated { scale: 1.0, amount: Amount::Absolute, total: None };

fn one() -> Spectrum {
    Spectrum::Constant(1.0)
}

fn grid(n: u32) -> impl Iterator<Item = Vec2> {
    (0..n * n).map(move |i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32)
}

fn facing(p: Vec3, n: Vec3) -> ReferencePoint {
    let n = Normal::new(n).unwrap();
    ReferencePoint { p: BoundedPoint::exact(Point(p)), ng: Some(n), ns: Some(n), lit_side: None, time: 0.0 }
}

/// Irradiance at a point from `n` × `n` samples per primitive, first lane.
fn irradiance(light: &Light, shapes: &[Shape], from: &ReferencePoint, n: u32) -> f64 {
    let w = Wavelengths::sample_visible(0.5);
    let prims = shapes.first().map_or(1, Shape::prim_count);
    let mut sum = 0.0;
    for prim in 0..prims {
        for u in grid(n) {
            let Some(s) = light.sample(from, shapes, prim, u, &w) else { continue };
            let cos = f64::from(s.wi.dot(*from.ns.unwrap()).max(0.0));
            let density = match s.density {
                Density::Delta => 1.0,
                Density::SolidAngle(p) => f64::from(p.0),
            };
            sum += f64::from(s.radiance[0]) * cos / density / f64::from(n * n);
        }
    }
    sum
}

/// K_m ∫ f ȳ dλ.
fn photometric(f: impl Fn(&Wavelengths) -> Sampled<Radiance>) -> f32 {
    let n = 500;
    let mut sum = 0.0_f64;
    for i in 0..n {
        let w = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
        let l = f(&w);
        for lane in 0..LANES {
            sum += f64::from(l[lane] * cie::y_bar(w.lambda()[lane]) / w.pdf()[lane]);
        }
    }
    LUMENS_PER_WATT * (sum / f64::from(n * LANES as i32)) as f32
}

fn area_light(shape: &Shape, spectrum: Spectrum, sides: Sides, stated: &Stated) -> Light {
    let radiance = AreaRadiance::Uniform(spectrum);
    Light::DiffuseArea(DiffuseAreaLight::new(ShapeId(0), shape, radiance, sides, stated).unwrap())
}

/// A disk of radius 1 at height 2 that faces down.
fn disk() -> Shape {
    Shape::Disk(Box::new(
        Disk::new(2.0, 1.0, 0.0, 360.0, &Transform::IDENTITY, Orientation::Reversed).unwrap(),
    ))
}

fn sphere_at(z: f32) -> Shape {
    let t = Transform::translate(Vec3::new(0.0, 0.0, z));
    Shape::Sphere(Box::new(Sphere::new(1.0, -1.0, 1.0, 360.0, &t, Orientation::AsDefined).unwrap()))
}

/// A unit square at height 1 that faces down.
fn square() -> Shape {
    let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)];
    let data = MeshData {
        indices: vec![[0, 1, 2], [0, 2, 3]],
        positions: corners.map(|(x, y)| Point::new(x, y, 1.0)).to_vec(),
        ..MeshData::default()
    };
    Shape::Mesh(TriangleMesh::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap())
}

fn picture(side: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 3]) -> EmissionPicture {
    let [width, height] = side;
    let values = (0..width * height).flat_map(|i| texel(i % width, i / width)).collect();
    let space = ColorSpace::new(ColorSpaceKind::Srgb);
    let table = Arc::clone(&TABLE);
    EmissionPicture::new(Image::from_f32(width, height, Layout::Rgb, values).unwrap(), table, &space)
}

fn sky(x: u32, y: u32) -> [f32; 3] {
    // One bright texel, a dark one and a gradient.
    match (x, y) {
        (3, 5) => [80.0, 60.0, 20.0],
        (9, 9) => [0.0; 3],
        _ => [0.2 + 0.1 * x as f32, 0.5, 0.3 + 0.1 * y as f32],
    }
}

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

/// A lamp with a downlight's distribution and a little light upwards, different in each quadrant [cd].
fn luminaire(turn: Transform, opening: EmittingOpening, spectrum: Spectrum, stated: &Stated) -> Light {
    let planes: Vec<f64> = (0..8).map(|i| 45.0 * f64::from(i)).collect();
    let gamma: Vec<f64> = (0..=12).map(|i| 15.0 * f64::from(i)).collect();
    // Planes agree at the poles.
    let intensity = |c: f64, g: f64| (2.0 + c / 90.0 * g.to_radians().sin()) * (1.2 + g.to_radians().cos());
    let candela = planes.iter().flat_map(|&c| gamma.iter().map(move |&g| intensity(c, g))).collect();
    let web = photometric::PhotometricWeb::type_c(planes, gamma, candela).unwrap();
    let light = PhotometricLight::new(turn, Point::ORIGIN, web, opening, spectrum, stated);
    Light::Photometric(Box::new(light.unwrap()))
}

/// A source of Lambert's distribution towards −z [cd], peak 1 cd, from a given opening at the origin.
fn lambertian(opening: EmittingOpening) -> Light {
    let gamma: Vec<f64> = (0..=900).map(|i| 0.1 * f64::from(i)).collect();
    let candela = gamma.iter().map(|g| g.to_radians().cos()).collect();
    let web = photometric::PhotometricWeb::type_c(vec![0.0], gamma, candela).unwrap();
    let light = PhotometricLight::new(Transform::IDENTITY, Point::ORIGIN, web, opening, one(), &ABSOLUTE);
    Light::Photometric(Box::new(light.unwrap()))
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

/// ∫ I dω over the sphere around a light at the origin.
fn flux(light: &Light, n: u32) -> LightPower {
    let mut power = LightPower::default();
    let w = Wavelengths::sample_uniform(0.5, 360.0, 830.0);
    for st in grid(n) {
        let from = ReferencePoint::free(Point(equal_area_square_to_sphere(st)), 0.0);
        if let Some(s) = light.sample(&from, &[], 0, Vec2::ZERO, &w) {
            power.watts += s.radiance[0] * 470.0 * 4.0 * PI / (n * n) as f32;
        }
    }
    power
}

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

#[test]
fn environment_maps_are_sampled_by_their_density() {
    let turn = Transform::rotate(77.0, Vec3::new(0.3, 1.0, 0.2)).unwrap();
    let map = ImageInfiniteLight::new(turn, picture([16, 16], sky), &Stated::default()).unwrap();
    let light = Light::ImageInfinite(Box::new(map));
    let w = Wavelengths::sample_visible(0.4);
    let from = facing(Vec3::ZERO, Vec3::Z);
    // χ² over octants of the sphere: counts of random samples against the density's integral.
    let octant = |d: Vec3| usize::from(d.x > 0.0) + 2 * usize::from(d.y > 0.0) + 4 * usize::from(d.z > 0.0);
    let mut expected = [0.0_f64; 8];
    let fine = 512;
    for st in grid(fine) {
        let d = equal_area_square_to_sphere(st);
        let p = light.escape_density(Dir::new(d).unwrap()).0;
        expected[octant(d)] += f64::from(p) * f64::from(4.0 * PI) / f64::from(fine * fine);
    }
    // The edges of the brightest texel fall between the nodes: 512² of them resolve it to half a percent.
    let mass: f64 = expected.iter().sum();
    assert!((mass - 1.0).abs() < 5e-3, "{mass}");
    let mut counts = [0_u32; 8];
    let samples = 20_000;
    let mut rng = crate::math::hash::Pcg32::new(7, 1);
    for _ in 0..samples {
        let u = Vec2::new(rng.next_f32(), rng.next_f32());
        let s = light.sample(&from, &[], 0, u, &w).unwrap();
        counts[octant(*s.wi)] += 1;
        let Density::SolidAngle(density) = s.density else { panic!("a map is no delta light") };
        assert!((density.0 / light.escape_density(s.wi).0 - 1.0).abs() < 1e-3, "{s:?}");
        assert!((s.radiance - light.escaped(s.wi, &w)).to_array().iter().all(|d| d.abs() < 1e-9), "{s:?}");
    }
    let chi2: f64 = (0..8)
        .map(|i| {
            (f64::from(counts[i]) - expected[i] * f64::from(samples)).powi(2)
                / (expected[i] * f64::from(samples))
        })
        .sum();
    // 7 degrees of freedom, α = 10⁻⁴: 29.9.
    assert!(chi2 < 29.9, "{chi2}: {counts:?} {expected:?}");
    assert!(
        (Light::UniformInfinite(UniformInfiniteLight::new(one(), &ABSOLUTE).unwrap())
            .escape_density(Dir::Z)
            .0
            - UNIFORM_SPHERE_PDF)
            .abs()
            < 1e-9
    );
}

#[test]
fn a_hit_on_an_emitter_reports_the_density_and_radiance_of_its_sample() {
    let w = Wavelengths::sample_visible(0.2);
    let from = facing(Vec3::new(0.1, -0.2, 0.0), Vec3::Z);
    for shape in [disk(), sphere_at(2.5), square()] {
        let shapes = std::slice::from_ref(&shape);
        let light = area_light(&shape, one(), Sides::Front, &ABSOLUTE);
        for prim in 0..shape.prim_count() {
            for u in grid(5) {
                let Some(s) = light.sample(&from, shapes, prim, u, &w) else { continue };
                let Density::SolidAngle(density) = s.density else { panic!("a shape is no delta light") };
                let ray = Ray { o: from.p.p, d: *s.wi, time: 0.0 };
                let hit = shape.primitive(prim).intersect(&ray, f32::INFINITY).unwrap();
                let point = shape.surface(prim, &ray, &hit);
                let found = light.hit_density(&from, shapes, prim, s.wi, &point);
                assert!((found.0 / density.0 - 1.0).abs() < 1e-2, "{shape:?} {u}: {found:?} {density:?}");
                assert_eq!(light.emitted(&point, -s.wi, &w), s.radiance);
            }
        }
    }
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
fn selection_by_power_follows_area_and_luminance() {
    let shapes = [square(), disk()];
    let area = |id: u32, scale| {
        let shape = &shapes[id as usize];
        let stated = Stated { scale, ..Stated::default() };
        let radiance = AreaRadiance::Uniform(named("stdillum-D65").unwrap());
        Light::DiffuseArea(
            DiffuseAreaLight::new(ShapeId(id), shape, radiance, Sides::Front, &stated).unwrap(),
        )
    };
    let lights = [area(0, 4.0 * PI), area(1, 1.0)];
    let sampler = LightSampler::by_power(&lights, &shapes, 10.0);
    // Fluxes 4π·π·1 and π·π: four fifths for the square, half of that for each triangle.
    for (light, prim, p) in [(0, 0, 0.4), (0, 1, 0.4), (1, 0, 0.2)] {
        let found = sampler.probability(Emitter { light: LightId(light), prim });
        assert!((found - p).abs() < 1e-4, "{light} {prim}: {found}");
    }
}

#[test]
fn selection_by_position_finds_every_light_with_its_probability_and_favours_the_near() {
    let mut rng = crate::math::hash::Pcg32::new(5, 1);
    let mut random = |lo: f32, hi: f32| lo + (hi - lo) * rng.next_f32();
    let mut shapes = Vec::new();
    for _ in 0..12 {
        let turn =
            Transform::rotate(random(0.0, 360.0), Vec3::new(random(-1.0, 1.0), 1.0, random(-1.0, 1.0)))
                .unwrap();
        let to = Vec3::new(random(-5.0, 5.0), random(-5.0, 5.0), random(-5.0, 5.0));
        let t = Transform::translate(to) * turn;
        let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)];
        let data = MeshData {
            indices: vec![[0, 1, 2], [0, 2, 3]],
            positions: corners.map(|(x, y)| Point::new(x, y, 1.0)).to_vec(),
            ..MeshData::default()
        };
        shapes.push(Shape::Mesh(TriangleMesh::new(data, &t, Orientation::AsDefined).unwrap()));
    }
    let mut lights: Vec<Light> = (0..)
        .zip(&shapes)
        .map(|(id, shape)| {
            let sides = if id % 3 == 0 { Sides::Both } else { Sides::Front };
            let radiance = AreaRadiance::Uniform(one());
            Light::DiffuseArea(DiffuseAreaLight::new(ShapeId(id), shape, radiance, sides, &ABSOLUTE).unwrap())
        })
        .collect();
    let spot = |to: Vec3| {
        SpotLight::new(Transform::IDENTITY, Point::ORIGIN, Point(to), 30.0, 0.0, one(), &ABSOLUTE)
            .map(Light::Spot)
    };
    lights.push(spot(Vec3::X).unwrap());
    lights.push(spot(-Vec3::Z).unwrap());
    lights.push(Light::Point(
        PointLight::new(Transform::IDENTITY, Point::new(2.0, 1.0, 0.0), one(), &ABSOLUTE).unwrap(),
    ));
    lights.push(lambertian(EmittingOpening { half_x: 0.5, half_y: 0.2, ..EmittingOpening::default() }));
    lights.push(Light::UniformInfinite(UniformInfiniteLight::new(one(), &ABSOLUTE).unwrap()));
    let sampler = LightSampler::for_scene(&lights, &shapes, 10.0, Selection::Position);
    let by_power = LightSampler::by_power(&lights, &shapes, 10.0);
    let w = Wavelengths::sample_visible(0.5);
    let mut variances = [0.0_f64; 2];
    for i in 0..40 {
        let n = Vec3::new(random(-1.0, 1.0), random(-1.0, 1.0), random(-1.0, 1.0));
        let from = facing(Vec3::new(random(-4.0, 4.0), random(-4.0, 4.0), random(-4.0, 4.0)), n);
        // The irradiance of every emitter by itself, by quadrature.
        let own = |e: Emitter| {
            let light = &lights[e.light.0 as usize];
            let mut sum = 0.0;
            for u in grid(8) {
                let Some(s) = light.sample(&from, &shapes, e.prim, u, &w) else { continue };
                let cos = f64::from(s.wi.dot(*from.ns.unwrap()).max(0.0));
                let density = match s.density {
                    Density::Delta => 1.0,
                    Density::SolidAngle(p) => f64::from(p.0),
                };
                sum += f64::from(s.radiance[0]) * cos / density / 64.0;
            }
            sum
        };
        let emitters: Vec<Emitter> = (0..lights.len() as u32)
            .flat_map(|light| {
                let prims = shapes.get(light as usize).map_or(1, Shape::prim_count);
                (0..prims).map(move |prim| Emitter { light: LightId(light), prim })
            })
            .collect();
        let contributions: Vec<f64> = emitters.iter().map(|&e| own(e)).collect();
        let is_local = |e: Emitter| !lights[e.light.0 as usize].is_infinite();
        let mut mass = 0.0;
        for (&e, &c) in emitters.iter().zip(&contributions) {
            let p = sampler.probability_at(&from, e);
            mass += p;
            assert!(c == 0.0 || p > 0.0, "{i}: {e:?} contributes {c} and is never chosen");
            if c > 0.0 && is_local(e) {
                variances[0] += c * c / f64::from(p);
                variances[1] += c * c / f64::from(by_power.probability(e));
            }
        }
        assert!(mass < 1.0 + 1e-4, "{mass}");
        let draws = 2000;
        let mut counts = vec![0_u32; emitters.len()];
        for k in 0..draws {
            let Some(c) = sampler.sample_at(&from, (k as f32 + 0.5) / draws as f32) else { continue };
            let found = sampler.probability_at(&from, c.emitter);
            assert!((found / c.probability - 1.0).abs() < 1e-4, "{found} {c:?}");
            counts[emitters.iter().position(|&e| e == c.emitter).unwrap()] += 1;
        }
        for (&e, &count) in emitters.iter().zip(&counts) {
            let p = sampler.probability_at(&from, e);
            // A grid of u resolves each interval to one draw at each end.
            assert!((count as f32 - p * draws as f32).abs() < 2.0, "{e:?}: {count} {p}");
        }
    }
    // Second moment of the estimate of local light, summed over places.
    assert!(variances[0] < 0.75 * variances[1], "{variances:?}");
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
