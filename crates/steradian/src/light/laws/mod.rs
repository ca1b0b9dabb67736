//! Lights against closed forms of radiometry and photometry.

mod pictures;
mod received;
mod sampling;
mod totals;

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
