//! Cases under artificial light: kinds 5.2–5.8.

use super::super::meters::{MeterPoint, luminance::MeterRay};
use super::contract::{Case, Part, Reading};
use super::text::{BLACK, Room, Surface, Text, rectangle};
use crate::optics::absorption::NaturalAbsorbance;
use crate::optics::slab::Plate;
use crate::radiometry::enclosure::mean_reflected_irradiance;
use crate::radiometry::polygon::projected_solid_angle;
use crate::scene::MemoryFiles;
use crate::units::{Cosine, LuminousIntensity, Metres};
use glam::DVec3;
use std::f64::consts::PI;

/// All of them.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = point_sources();
    cases.extend(luminaire());
    cases.extend(area_source());
    cases.extend(glass());
    cases.extend(reflection());
    cases.extend(obstructed_reflection());
    cases.extend(cube());
    cases
}

pub(super) fn lux(point: MeterPoint, part: Part) -> Reading {
    Reading::Illuminance { point, part }
}

pub(super) fn facing(position: [f64; 3], normal: [f64; 3]) -> MeterPoint {
    MeterPoint { position, normal }
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
/// Out of the façade's wall, into the room.
const INWARDS: [f64; 3] = [-1.0, 0.0, 0.0];

fn illuminance(
    kind: &'static str,
    name: String,
    formula: &'static str,
    expected: f64,
    scene: &Text,
    reading: Reading,
) -> Case {
    Case {
        kind,
        name,
        formula,
        quantity: "illuminance",
        unit: "lx",
        expected,
        scene: scene.clone().finish(),
        files: MemoryFiles::new(),
        reading,
        scale: 1.0,
    }
}

/// E = I cosθ/r².
fn from_point(source: [f64; 3], candela: f64, at: &MeterPoint) -> f64 {
    let to = DVec3::from(source) - DVec3::from(at.position);
    let cosine = Cosine::new(to.normalize().dot(DVec3::from(at.normal)).clamp(-1.0, 1.0));
    let intensity = LuminousIntensity::exact(candela);
    cosine.map_or(0.0, |cosine| intensity.at(Metres(to.length()), cosine).value())
}

fn point_sources() -> Vec<Case> {
    let (source, candela) = ([0.0, 0.0, 3.0], 1000.0);
    let formula = "E = I cosθ/r²";
    let all_round = Text::new().point(source, candela);
    let points = [
        ("floor below", facing([0.0, 0.0, 0.0], UP)),
        ("floor at (1.5, 1) m", facing([1.5, 1.0, 0.0], UP)),
        ("wall at (2, 1, 1) m", facing([2.0, 1.0, 1.0], INWARDS)),
    ];
    let mut cases: Vec<_> = points
        .iter()
        .map(|(name, point)| {
            let name = format!("isotropic 1000 cd at 3 m: {name}");
            illuminance(
                "5.2",
                name,
                formula,
                from_point(source, candela, point),
                &all_round,
                lux(*point, Part::Total),
            )
        })
        .collect();
    let cone = Text::new().downlight(source, 35.0, candela);
    for (name, point, lit) in
        [("inside", facing([1.5, 1.0, 0.0], UP), 1.0), ("outside", facing([2.0, 1.0, 0.0], UP), 0.0)]
    {
        let expected = lit * from_point(source, candela, &point);
        let name = format!("1000 cd within 35°, at 3 m: floor {name} the cone");
        cases.push(illuminance("5.2", name, formula, expected, &cone, lux(point, Part::Total)));
    }
    cases
}

/// A quarter of a distribution [cd]: angles from nadir in the planes C0, C45, C90.
const DISTRIBUTION: [(u32, [f64; 7]); 3] = [
    (0, [900.0, 880.0, 790.0, 600.0, 310.0, 90.0, 0.0]),
    (45, [900.0, 850.0, 700.0, 450.0, 200.0, 50.0, 0.0]),
    (90, [900.0, 820.0, 620.0, 350.0, 120.0, 20.0, 0.0]),
];

fn luminaire() -> Vec<Case> {
    let words = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let rows = DISTRIBUTION.map(|(_, values)| words(&values)).join("\n");
    let file = format!(
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 7 3 1 2 0 0 0\n1 1 50\n0 15 30 45 60 75 90\n0 45 90\n{rows}\n"
    );
    let source = [0.0, 0.0, 3.0];
    let scene = Text::new().photometric(source, "lamp.ies");
    let mut cases = Vec::new();
    // Where tabulated directions meet the floor and a wall, so that no interpolation takes part.
    for (plane, angle, index) in [(0_u32, 0.0_f64, 0), (0, 45.0, 3), (45, 30.0, 2), (90, 60.0, 4)] {
        let candela = DISTRIBUTION.iter().find(|(c, _)| *c == plane).map_or(0.0, |(_, values)| values[index]);
        let ((sin, cos), r) = (f64::from(plane).to_radians().sin_cos(), 3.0 * angle.to_radians().tan());
        let floor = facing([r * cos, r * sin, 0.0], UP);
        let name = format!("lamp with a distribution (IES), at 3 m: floor, C = {plane}°, γ = {angle}°");
        let reading = lux(floor, Part::Total);
        let expected = from_point(source, candela, &floor);
        let case = illuminance("5.2", name, "E = I(C, γ) cosθ/r²", expected, &scene, reading);
        cases.push(Case { files: MemoryFiles::new().with("lamp.ies", file.as_bytes()), ..case });
    }
    cases
}

fn area_source() -> Vec<Case> {
    let lamp = rectangle([-0.5, -0.5, 3.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
    let luminance = 1000.0;
    let mut room = vec![Room::STANDARD.floor()];
    room.extend(Room::STANDARD.walls());
    let scene = Text::new().with(BLACK, &room).with(Surface::Bright(luminance), &[lamp]);
    let points = [
        ("floor, centre", facing([0.0, 0.0, 0.0], UP)),
        ("floor at (1, 0.5) m", facing([1.0, 0.5, 0.0], UP)),
        ("floor, corner at (1.9, 1.9) m", facing([1.9, 1.9, 0.0], UP)),
        ("wall, height 0.5 m", facing([2.0, 0.0, 0.5], INWARDS)),
        ("wall, height 1.5 m", facing([2.0, 0.0, 1.5], INWARDS)),
        ("wall, height 2.5 m, 1 m aside", facing([2.0, 1.0, 2.5], INWARDS)),
    ];
    points
        .iter()
        .map(|(name, point)| {
            let seen = projected_solid_angle(point.position.into(), point.normal.into(), &lamp.vertices());
            let name = format!("ceiling panel 1 × 1 m, 1000 cd/m², black room 4 × 4 × 3 m: {name}");
            let reading = lux(*point, Part::Total);
            illuminance("5.3", name, "Lambert's polygon formula", luminance * seen.0, &scene, reading)
        })
        .collect()
}

fn glass() -> Vec<Case> {
    let (index, luminance) = (1.52, 1000.0);
    // A black box that is open towards +x, where the pane is: what the pane reflects is black.
    let (r, d) = (60.0, 2.0);
    let pane = rectangle([0.0, -r, -r], [0.0, 2.0 * r, 0.0], [0.0, 0.0, 2.0 * r]);
    let back = rectangle([-d, -r, -r], [0.0, 2.0 * r, 0.0], [0.0, 0.0, 2.0 * r]);
    let side = |y: f64| rectangle([-d, y, -r], [d, 0.0, 0.0], [0.0, 0.0, 2.0 * r]);
    let lid = |z: f64| rectangle([-d, -r, z], [d, 0.0, 0.0], [0.0, 2.0 * r, 0.0]);
    let scene = Text::new()
        .uniform_sky(luminance)
        .with(BLACK, &[back, side(-r), side(r), lid(-r), lid(r)])
        .with(Surface::Glass(index), &[pane]);
    let plate = Plate::window(index, NaturalAbsorbance::new(0.0));
    [0.0_f64, 30.0, 45.0, 60.0, 70.0, 80.0]
        .iter()
        .map(|&degrees| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let direction = [cos, 0.6 * sin, 0.8 * sin];
            Case {
                kind: "5.5",
                name: format!("clear glass, n = 1.52, at {degrees}°"),
                formula: "Fresnel, all reflections between the faces",
                quantity: "transmittance",
                unit: "1",
                expected: plate.unpolarized(cos).transmittance,
                scene: scene.clone().finish(),
                files: MemoryFiles::new(),
                reading: Reading::Luminance(MeterRay { position: [-1.0, 0.0, 0.0], direction }),
                scale: 1.0 / luminance,
            }
        })
        .collect()
}

/// The beam's angle to the zenith [degrees], the illuminance across it [lx], and the reflectance of what it lights.
const BEAM: (f64, f64, f64) = (35.0, 10_000.0, 0.6);

/// Luminance of the lit patch: ρE/π.
fn patch_luminance() -> f64 {
    let (zenith, lux, rho) = BEAM;
    rho * lux * zenith.to_radians().cos() / PI
}

fn reflection() -> Vec<Case> {
    let (zenith, lx, rho) = BEAM;
    let mut cases = Vec::new();
    for (size, height, above) in [(0.5, 0.2, 0.4), (4.0, 1.0, 3.0), (500.0, 1.0, 100.0)] {
        let patch = rectangle([-0.5 * size, -0.5 * size, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]);
        let scene = Text::new().beam(zenith, lx).with(Surface::Diffuse(rho), &[patch]);
        let points = [
            (format!("wall at its edge, {height} m up"), facing([0.5 * size, 0.0, height], INWARDS)),
            (format!("ceiling {above} m above its centre"), facing([0.0, 0.0, above], DOWN)),
        ];
        for (place, point) in points {
            let seen = projected_solid_angle(point.position.into(), point.normal.into(), &patch.vertices());
            let name = format!("diffuse patch {size} × {size} m, ρ = 0.6, beam of 10 klx at 35°: {place}");
            let expected = patch_luminance() * seen.0;
            cases.push(illuminance(
                "5.6",
                name,
                "ρE times configuration factor",
                expected,
                &scene,
                lux(point, Part::Reflected),
            ));
        }
    }
    cases
}

fn obstructed_reflection() -> Vec<Case> {
    let (zenith, lx, rho) = BEAM;
    let floor = rectangle([-2.0, -2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]);
    // In the plane of the beam, so that it casts no shadow.
    let screen = rectangle([-20.0, 0.0, 0.0], [40.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let scene = Text::new().beam(zenith, lx).with(Surface::Diffuse(rho), &[floor]).with(BLACK, &[screen]);
    let points = [
        ("ceiling at (0, 1, 3) m", facing([0.0, 1.0, 3.0], DOWN)),
        ("wall at (0, 2, 2.5) m", facing([0.0, 2.0, 2.5], [0.0, -1.0, 0.0])),
    ];
    points
        .iter()
        .map(|(place, point)| {
            let [_, y, z] = point.position;
            // Over the screen's edge one sees the floor from −t on, where z t/(y + t) = 1.
            let t = y / (z - 1.0);
            let near = rectangle([-2.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
            let far = rectangle([-2.0, -2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 2.0 - t, 0.0]);
            let seen = [near, far].map(|part| {
                projected_solid_angle(point.position.into(), point.normal.into(), &part.vertices()).0
            });
            let name =
                format!("diffuse floor 4 × 4 m, screen 1 m high across its middle, beam of 10 klx: {place}");
            let expected = patch_luminance() * (seen[0] + seen[1]);
            illuminance(
                "5.7",
                name,
                "configuration factor of what is seen",
                expected,
                &scene,
                lux(*point, Part::Reflected),
            )
        })
        .collect()
}

/// Where the pointwise values of the cube are known: x and y [m] from the centre of its floor.
const CUBE_POINTS: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0], [1.9, 0.0], [1.9, 1.9]];

/// Reflected illuminance [lx] there, for reflectances 0.2, 0.5, 0.8: collocation with exact polygon factors on a graded mesh of 20, 40, 60
/// nodes per edge, extrapolated; its mean holds the exact mean to 10⁻³ lx.
const CUBE: [(f64, [f64; 6]); 3] = [
    (0.2, [28.877, 28.431, 27.302, 28.149, 24.845, 17.297]),
    (0.5, [112.038, 110.879, 107.783, 110.107, 101.259, 77.032]),
    (0.8, [430.959, 429.024, 423.496, 427.648, 412.482, 359.811]),
];

fn cube() -> Vec<Case> {
    let room = Room { width: 4.0, floor: -2.0, ceiling: 2.0 };
    let lumens = 10_000.0;
    let scene = |rho: f64| {
        Text::new().point([0.0; 3], lumens / (4.0 * PI)).with(Surface::Diffuse(rho), &room.faces())
    };
    let mut cases = Vec::new();
    for rho in [0.05, 0.2, 0.5, 0.8, 0.95] {
        let name = format!("cube 4 m, ρ = {rho}, 10 klm at its centre: mean of all faces, reflected light");
        let reading = Reading::MeanIlluminance { faces: room.faces(), part: Part::Reflected };
        let expected = mean_reflected_irradiance(lumens, 96.0, rho);
        cases.push(illuminance("5.8", name, "Φρ/(A(1 − ρ))", expected, &scene(rho), reading));
    }
    for (rho, values) in CUBE {
        for ([x, y], expected) in CUBE_POINTS.into_iter().zip(values) {
            let name =
                format!("cube 4 m, ρ = {rho}, 10 klm at its centre: floor at ({x}, {y}) m, reflected light");
            let point = facing([x, y, -2.0], UP);
            let reading = lux(point, Part::Reflected);
            cases.push(illuminance(
                "5.8",
                name,
                "radiosity with exact factors",
                expected,
                &scene(rho),
                reading,
            ));
        }
    }
    cases
}
