//! Cases under daylight: kinds 5.4 and 5.9–5.14.

use super::super::meters::MeterPoint;
use super::contract::{Case, Part, Reading};
use super::text::{BLACK, Room, Surface, Text, rectangle};
use crate::optics::absorption::NaturalAbsorbance;
use crate::optics::slab::Plate;
use crate::radiometry::daylight::{RoofLight, Sky, Window};
use crate::radiometry::opening::Rectangle;
use crate::radiometry::polygon::projected_solid_angle;
use crate::scene::MemoryFiles;
use glam::DVec3;

/// Luminance of the uniform sky, and that of the overcast one at the zenith [cd·m⁻²].
const ZENITH: f64 = 1000.0;
/// Index of the glass.
const GLASS: f64 = 1.52;
/// Luminance of the ground outside: reflectance 0.2 under the uniform sky [cd·m⁻²].
const GROUND: f64 = 200.0;

/// All of them.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = flux_conservation();
    for sky in SKIES {
        cases.extend(roof(sky));
        cases.extend(facade(sky));
        cases.extend(masks(sky));
    }
    cases
}

const SKIES: [Sky; 2] = [Sky::Uniform, Sky::Overcast];

fn name_of(sky: Sky) -> &'static str {
    match sky {
        Sky::Uniform => "uniform sky",
        Sky::Overcast => "overcast sky",
    }
}

fn under(sky: Sky) -> Text {
    match sky {
        Sky::Uniform => Text::new().uniform_sky(ZENITH),
        Sky::Overcast => Text::new().overcast_sky(ZENITH),
    }
}

/// Illuminance in per cent of the unobstructed horizontal illuminance.
fn daylight(
    kind: &'static str,
    name: String,
    formula: &'static str,
    sky: Sky,
    expected: f64,
    scene: &Text,
    point: MeterPoint,
) -> Case {
    Case {
        kind,
        name: format!("{}, {name}", name_of(sky)),
        formula,
        quantity: "daylight factor",
        unit: "%",
        expected: 100.0 * expected / (ZENITH * sky.horizontal()),
        scene: scene.clone().finish(),
        files: MemoryFiles::new(),
        reading: Reading::Illuminance { point, part: Part::Total },
        scale: 100.0 / (ZENITH * sky.horizontal()),
    }
}

fn flux_conservation() -> Vec<Case> {
    let room = Room::STANDARD;
    let mut inside = vec![room.floor()];
    inside.extend(room.walls());
    let area: f64 = inside.iter().map(Rectangle::area).sum();
    let case = |name: String, outdoors: Text, half: f64, arriving: f64| Case {
        kind: "5.4",
        name: format!("roof opening {0} × {0} m of a black room 4 × 4 × 3 m, {name}", 2.0 * half),
        formula: "flux on the faces = flux through the opening",
        quantity: "ratio of fluxes",
        unit: "1",
        expected: 1.0,
        scene: outdoors.with(BLACK, &room.with_roof_opening(half)).finish(),
        files: MemoryFiles::new(),
        reading: Reading::MeanIlluminance { faces: inside.clone(), part: Part::Total },
        scale: area / (arriving * (2.0 * half).powi(2)),
    };
    let mut cases = Vec::new();
    for half in [1.0, 2.0] {
        for sky in SKIES {
            cases.push(case(name_of(sky).to_owned(), under(sky), half, ZENITH * sky.horizontal()));
        }
    }
    let cos = 35.0_f64.to_radians().cos();
    cases.push(case(
        "parallel beam at 35°".to_owned(),
        Text::new().beam(35.0, 10_000.0),
        1.0,
        10_000.0 * cos,
    ));
    cases
}

/// Transmittance of the pane for light that comes from `direction`, the pane's unit normal being given.
fn transmittance(direction: DVec3, normal: DVec3) -> f64 {
    Plate::window(GLASS, NaturalAbsorbance::new(0.0)).unpolarized(direction.dot(normal).abs()).transmittance
}

fn roof(sky: Sky) -> Vec<Case> {
    let room = Room::STANDARD;
    let mut cases = Vec::new();
    let places = [("floor, centre", [0.0, 0.0]), ("floor at (1.5, 1) m", [1.5, 1.0])];
    for half in [0.5, 2.0] {
        let scene = under(sky).with(BLACK, &room.with_roof_opening(half));
        // Beside a small opening few paths find the sky.
        let seen = if half < 1.0 { &places[..1] } else { &places[..] };
        for &(place, [x, y]) in seen {
            let light = RoofLight { height: 3.0, x: [-half - x, half - x], y: [-half - y, half - y] };
            let name = format!("roof opening {0} × {0} m at 3 m: {place}", 2.0 * half);
            let point = MeterPoint { position: [x, y, 0.0], normal: [0.0, 0.0, 1.0] };
            let expected = ZENITH * light.horizontal(sky);
            cases.push(daylight(
                "5.9",
                name,
                "∫L cosθ dω over a rectangle overhead",
                sky,
                expected,
                &scene,
                point,
            ));
        }
    }
    let half = 1.0;
    let pane = rectangle([-half, -half, 3.0], [2.0 * half, 0.0, 0.0], [0.0, 2.0 * half, 0.0]);
    let scene = under(sky).with(BLACK, &room.with_roof_opening(half)).with(Surface::Glass(GLASS), &[pane]);
    for (place, [x, y]) in places {
        let name = format!("glazed roof opening 2 × 2 m at 3 m, n = 1.52: {place}");
        let p = DVec3::new(x, y, 0.0);
        let radiance = |u: DVec3| ZENITH * sky.luminance(u.z) * transmittance(u, DVec3::Z);
        let point = MeterPoint { position: p.to_array(), normal: [0.0, 0.0, 1.0] };
        let expected = pane.irradiance(p, DVec3::Z, radiance);
        cases.push(daylight("5.10", name, "∫Lτ(θ) cosθ dω, by quadrature", sky, expected, &scene, point));
    }
    cases
}

/// Half the width of the window, and its sill and head [m] above the floor.
const WINDOW: (f64, [f64; 2]) = (1.0, [1.0, 2.5]);

/// A part of the façade's window between two heights.
fn window_part([low, high]: [f64; 2]) -> Rectangle {
    let half = WINDOW.0;
    rectangle([2.0, -half, low], [0.0, 2.0 * half, 0.0], [0.0, 0.0, high - low])
}

/// The ground outside, as far as the horizon to 10⁻⁵.
fn ground() -> Rectangle {
    rectangle([2.0, -1e6, 0.0], [1e6, 0.0, 0.0], [0.0, 2e6, 0.0])
}

/// On the working plane, 1 m from the window.
const DESK: MeterPoint = MeterPoint { position: [1.0, 0.0, 0.8], normal: [0.0, 0.0, 1.0] };

fn facade(sky: Sky) -> Vec<Case> {
    let (half, heights) = WINDOW;
    let room = Room::STANDARD.with_window(half, heights);
    let open = under(sky).with(BLACK, &room).with(Surface::Bright(GROUND), &[ground()]);
    let glazed = open.clone().with(Surface::Glass(GLASS), &[window_part(heights)]);
    let desk = DVec3::from(DESK.position);
    let window = Window { distance: 1.0, sides: [-half, half], heights: heights.map(|z| z - desk.z) };
    let mut cases = vec![daylight(
        "5.11",
        "window 2 × 1.5 m: desk 1 m inside, sky component".to_owned(),
        "∫L cosθ dω over a rectangle at the side",
        sky,
        ZENITH * window.horizontal(sky),
        &open,
        DESK,
    )];
    let through = |point: MeterPoint, tau: &dyn Fn(DVec3) -> f64| {
        let (p, n) = (DVec3::from(point.position), DVec3::from(point.normal));
        let eye = p.z.clamp(heights[0], heights[1]);
        let above = window_part([eye, heights[1]]);
        let below = window_part([heights[0], eye]);
        let sky_part = if eye < heights[1] {
            above.irradiance(p, n, |u| ZENITH * sky.luminance(u.z.max(0.0)) * tau(u))
        } else {
            0.0
        };
        let ground_part = if eye > heights[0] { below.irradiance(p, n, |u| GROUND * tau(u)) } else { 0.0 };
        sky_part + ground_part
    };
    let ceiling = MeterPoint { position: [1.0, 0.5, 3.0], normal: [0.0, 0.0, -1.0] };
    let seen = projected_solid_angle(ceiling.position.into(), -DVec3::Z, &window_part(heights).vertices());
    cases.push(daylight(
        "5.11",
        "window 2 × 1.5 m, ground of 200 cd/m²: ceiling 1 m inside, externally reflected component"
            .to_owned(),
        "Lambert's polygon formula",
        sky,
        GROUND * seen.0,
        &open,
        ceiling,
    ));
    let wall = MeterPoint { position: [-2.0, 0.0, 1.5], normal: [1.0, 0.0, 0.0] };
    cases.push(daylight(
        "5.11",
        "window 2 × 1.5 m, ground of 200 cd/m²: opposite wall, both components".to_owned(),
        "∫L cosθ dω, by quadrature",
        sky,
        through(wall, &|_| 1.0),
        &open,
        wall,
    ));
    for (place, point) in
        [("desk 1 m inside", DESK), ("ceiling 1 m inside", ceiling), ("opposite wall", wall)]
    {
        cases.push(daylight(
            "5.12",
            format!("glazed window 2 × 1.5 m, n = 1.52, ground of 200 cd/m²: {place}"),
            "∫Lτ(θ) cosθ dω, by quadrature",
            sky,
            through(point, &|u| transmittance(u, DVec3::X)),
            &glazed,
            point,
        ));
    }
    cases
}

fn masks(sky: Sky) -> Vec<Case> {
    let (half, heights) = WINDOW;
    let room = Room::STANDARD.with_window(half, heights);
    let desk = DVec3::from(DESK.position);
    let [sill, head] = heights.map(|z| z - desk.z);
    let window = |heights| Window { distance: 1.0, sides: [-half, half], heights };
    let formula = "window up to, or from, the mask's edge as projected on it";
    // An overhang 0.8 m deep at the head hides what is above its edge.
    let overhang = rectangle([2.0, -500.0, heights[1]], [0.8, 0.0, 0.0], [0.0, 1000.0, 0.0]);
    let scene = under(sky).with(BLACK, &room).with(BLACK, &[overhang]);
    let seen = window([sill, head / 1.8]).horizontal(sky);
    let name = "window 2 × 1.5 m under an overhang of 0.8 m: desk 1 m inside".to_owned();
    let horizontal = daylight("5.13", name, formula, sky, ZENITH * seen, &scene, DESK);
    // A wall 4 m in front of the window, up to 3 m above the desk.
    let bright = 100.0;
    let opposite = rectangle([6.0, -500.0, desk.z - 10.0], [0.0, 0.0, 13.0], [0.0, 1000.0, 0.0]);
    let scene = under(sky).with(BLACK, &room).with(Surface::Bright(bright), &[opposite]);
    let edge = 3.0 / 5.0;
    let seen = ZENITH * window([edge, head]).horizontal(sky);
    let mask = bright * window([sill, edge]).horizontal(Sky::Uniform);
    let name =
        "window 2 × 1.5 m, wall of 100 cd/m² 4 m in front, to 3 m above the desk: desk 1 m inside".to_owned();
    let vertical = daylight("5.14", name, formula, sky, seen + mask, &scene, DESK);
    vec![horizontal, vertical]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_ground_is_as_bright_as_the_uniform_sky_makes_it() {
        assert!((GROUND - 0.2 * ZENITH * Sky::Uniform.horizontal() / PI).abs() < 1e-9);
    }
}
