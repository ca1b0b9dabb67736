//! Scenes as pbrt-v4 text, in metres with z upwards, with lights of stated photometric amounts.

use crate::radiometry::opening::Rectangle;
use glam::DVec3;
use std::fmt::Write as _;

/// A scene under construction.
#[derive(Clone, Debug)]
pub(super) struct Text(String);

/// A diffuse surface or light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Surface {
    /// Of the reflectance.
    Diffuse(f64),
    /// Black, of the luminance [cd·m⁻²] on the side of its normal.
    Bright(f64),
    /// Thin clear glass of the index.
    Glass(f64),
}

pub(super) const BLACK: Surface = Surface::Diffuse(0.0);

impl Text {
    pub(super) fn new() -> Self {
        Self(
            "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
             Camera \"orthographic\"\nWorldBegin\n"
                .to_owned(),
        )
    }

    pub(super) fn finish(self) -> String {
        self.0
    }

    /// An isotropic point light [cd].
    pub(super) fn point(self, from: [f64; 3], candela: f64) -> Self {
        self.line(&format!("LightSource \"point\" {} {}", place("from", from), amount("I", candela)))
    }

    /// A luminaire by its file, nadir downwards and C0 towards +x.
    pub(super) fn photometric(self, from: [f64; 3], file: &str) -> Self {
        self.line(&format!(
            "LightSource \"photometric\" {} \"string filename\" \"{file}\"",
            place("from", from)
        ))
    }

    /// Even light [cd] within an angle [degrees] about the downward direction.
    pub(super) fn downlight(self, from: [f64; 3], angle: f64, candela: f64) -> Self {
        let to = place("to", [from[0], from[1], from[2] - 1.0]);
        let cone = format!("\"float coneangle\" {angle} \"float conedeltaangle\" 0");
        self.line(&format!(
            "LightSource \"spot\" {} {to} {cone} {}",
            place("from", from),
            amount("I", candela)
        ))
    }

    /// A parallel beam of an illuminance across it [lx], at an angle [degrees] to the zenith towards +x.
    pub(super) fn beam(self, zenith: f64, lux: f64) -> Self {
        let (sin, cos) = zenith.to_radians().sin_cos();
        let from = place("from", [sin, 0.0, cos]);
        self.line(&format!("LightSource \"distant\" {from} \"point3 to\" [0 0 0] {}", amount("L", lux)))
    }

    /// The same luminance [cd·m⁻²] from all directions.
    pub(super) fn uniform_sky(self, luminance: f64) -> Self {
        self.line(&format!("LightSource \"infinite\" {}", amount("L", luminance)))
    }

    /// The traditional overcast sky of a zenith luminance [cd·m⁻²]; black below the horizon.
    pub(super) fn overcast_sky(self, zenith: f64) -> Self {
        self.line(&format!(
            "LightSource \"sky\" \"string model\" \"overcast\" \"float zenithluminance\" {zenith}"
        ))
    }

    /// Surfaces, lights or panes.
    pub(super) fn with(mut self, surface: Surface, faces: &[Rectangle]) -> Self {
        self.0 += "AttributeBegin\n";
        match surface {
            Surface::Diffuse(rho) => {
                self = self.line(&format!("Material \"diffuse\" \"spectrum reflectance\" {}", flat(rho)));
            }
            Surface::Bright(luminance) => {
                let black = flat(0.0);
                self = self.line(&format!("Material \"diffuse\" \"spectrum reflectance\" {black}"));
                self = self.line(&format!("AreaLightSource \"diffuse\" {}", amount("L", luminance)));
            }
            Surface::Glass(index) => {
                self = self.line(&format!("Material \"thindielectric\" \"float eta\" {index}"));
            }
        }
        for face in faces {
            let points = face.vertices().map(|v| format!("{} {} {}", v.x, v.y, v.z)).join("  ");
            let line =
                format!("Shape \"trianglemesh\" \"point3 P\" [{points}] \"integer indices\" [0 1 2 0 2 3]");
            self = self.line(&line);
        }
        self.0 += "AttributeEnd\n";
        self
    }

    pub(super) fn line(mut self, line: &str) -> Self {
        let _ = writeln!(self.0, "{line}");
        self
    }
}

fn place(name: &str, p: [f64; 3]) -> String {
    format!("\"point3 {name}\" [{} {} {}]", p[0], p[1], p[2])
}

fn flat(value: f64) -> String {
    format!("[300 {value} 900 {value}]")
}

/// Lights of scale 1 have an amount of 1 cd, 1 lx or 1 cd·m⁻².
fn amount(name: &str, amount: f64) -> String {
    format!("\"spectrum {name}\" {} \"float scale\" {amount}", flat(1.0))
}

/// A rectangle from its corner and edges.
pub(super) fn rectangle(corner: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Rectangle {
    Rectangle { corner: DVec3::from(corner), edges: [DVec3::from(u), DVec3::from(v)] }
}

/// A room [m] about the z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Room {
    /// Along x and y.
    pub(super) width: f64,
    /// Height of the floor.
    pub(super) floor: f64,
    /// Height of the ceiling.
    pub(super) ceiling: f64,
}

impl Room {
    /// 4 × 4 × 3 m with the floor at 0.
    pub(super) const STANDARD: Self = Self { width: 4.0, floor: 0.0, ceiling: 3.0 };

    /// The floor, facing upwards.
    pub(super) fn floor(&self) -> Rectangle {
        let (r, w) = (0.5 * self.width, self.width);
        rectangle([-r, -r, self.floor], [w, 0.0, 0.0], [0.0, w, 0.0])
    }

    /// The ceiling, facing downwards.
    pub(super) fn ceiling(&self) -> Rectangle {
        let (r, w) = (0.5 * self.width, self.width);
        rectangle([-r, -r, self.ceiling], [0.0, w, 0.0], [w, 0.0, 0.0])
    }

    /// The walls, facing inwards; the first one, at +x, is the façade, whose edges run along y and z.
    pub(super) fn walls(&self) -> [Rectangle; 4] {
        let (r, w, z, h) = (0.5 * self.width, self.width, self.floor, self.ceiling - self.floor);
        let up = [0.0, 0.0, h];
        [
            rectangle([r, r, z], [0.0, -w, 0.0], up),
            rectangle([-r, -r, z], [0.0, w, 0.0], up),
            rectangle([r, -r, z], [-w, 0.0, 0.0], up),
            rectangle([-r, r, z], [w, 0.0, 0.0], up),
        ]
    }

    /// All faces.
    pub(super) fn faces(&self) -> Vec<Rectangle> {
        let mut faces = vec![self.floor(), self.ceiling()];
        faces.extend(self.walls());
        faces
    }

    /// All faces but for a hole in the roof from −half to half along x and y.
    pub(super) fn with_roof_opening(&self, half: f64) -> Vec<Rectangle> {
        let middle = 0.5 * self.width;
        let mut faces = vec![self.floor()];
        faces.extend(self.walls());
        faces.extend(pierced(self.ceiling(), [middle - half, middle + half], [middle - half, middle + half]));
        faces
    }

    /// All faces but for a hole in the façade from −half to half along y, and between two heights.
    pub(super) fn with_window(&self, half: f64, heights: [f64; 2]) -> Vec<Rectangle> {
        let middle = 0.5 * self.width;
        let mut faces = vec![self.floor(), self.ceiling()];
        let [facade, rest @ ..] = self.walls();
        faces.extend(rest);
        let z = heights.map(|h| h - self.floor);
        faces.extend(pierced(facade, [middle - half, middle + half], z));
        faces
    }
}

/// What is left of a rectangle beside a hole, which is given by distances [m] along its edges from its corner.
fn pierced(whole: Rectangle, u: [f64; 2], v: [f64; 2]) -> Vec<Rectangle> {
    let lengths = whole.edges.map(DVec3::length);
    let [du, dv] = whole.edges.map(DVec3::normalize);
    let part = |u: [f64; 2], v: [f64; 2]| Rectangle {
        corner: whole.corner + du * u[0] + dv * v[0],
        edges: [du * (u[1] - u[0]), dv * (v[1] - v[0])],
    };
    let all_v = [0.0, lengths[1]];
    let parts = [
        part([0.0, u[0]], all_v),
        part([u[1], lengths[0]], all_v),
        part(u, [0.0, v[0]]),
        part(u, [v[1], lengths[1]]),
    ];
    parts.into_iter().filter(|p| p.edges.iter().all(|e| e.length() > 1e-9)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faces_of_a_room_look_inwards_and_close_it() {
        let room = Room::STANDARD;
        let middle = DVec3::new(0.0, 0.0, 1.5);
        let area: f64 = room.faces().iter().map(Rectangle::area).sum();
        assert!((area - 80.0).abs() < 1e-12);
        for faces in [room.faces(), room.with_roof_opening(0.5), room.with_window(1.0, [1.0, 2.5])] {
            for face in &faces {
                assert!(face.normal().dot(middle - face.corner) > 0.0, "{face:?}");
            }
        }
        let sum = |faces: Vec<Rectangle>| faces.iter().map(Rectangle::area).sum::<f64>();
        assert!((sum(room.with_roof_opening(0.5)) - 79.0).abs() < 1e-12);
        assert!((sum(room.with_roof_opening(2.0)) - 64.0).abs() < 1e-12);
        assert!((sum(room.with_window(1.0, [1.0, 2.5])) - 77.0).abs() < 1e-12);
    }
}
