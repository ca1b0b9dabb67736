//! A view as it is shown and written.

use super::false_color::LuminanceScale;
use crate::image::{FisheyeView, RadianceHeader};
use crate::lab::glare::{GlareReading, GlareRule, Handedness, LuminancePicture, Photograph};
use crate::lab::plot::{Anchor, Drawing, Ink, Stroke};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A fisheye view of a scene with its glare.
#[derive(Clone, Debug)]
pub struct ViewReport {
    /// What it is called.
    pub name: String,
    /// The picture.
    pub photograph: Photograph,
    /// What counts as a source.
    pub rule: GlareRule,
    /// What the picture says.
    pub reading: GlareReading,
}

/// Pixels that lie behind a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Backdrop {
    /// Pixels along a side of the square.
    pub side: u32,
    /// Linear sRGB, row by row from the top.
    pub pixels: Vec<[f32; 3]>,
    /// Where its upper left corner is on the drawing [px].
    pub at: [f64; 2],
    /// Length of its sides on the drawing [px].
    pub size: f64,
}

const SIZE: f64 = 520.0;
const MARGIN: f64 = 20.0;
const TOP: f64 = 40.0;
/// Sources that get a number.
const NUMBERED: usize = 9;

/// The picture in false colour, with the rim of the field of view, the sources in rings with their numbers, and the scale.
pub fn false_color_sheet(view: &ViewReport) -> (Drawing, Backdrop) {
    let picture = view.photograph.without(None);
    let scale = LuminanceScale::of(&picture);
    let backdrop = backdrop(&picture, scale.as_ref());
    let mut d = Drawing::new(2.0 * MARGIN + SIZE + 128.0, TOP + SIZE + MARGIN);
    let middle = [MARGIN + 0.5 * SIZE, TOP + 0.5 * SIZE];
    d.line(ring(middle, 0.5 * SIZE), Stroke::solid(Ink::BLACK, 1.2));
    for (i, source) in view.reading.sources.iter().enumerate().take(NUMBERED) {
        let [x, y, z] = source.direction;
        let across = x.hypot(y).max(1e-12);
        let r = across.atan2(z) / FRAC_PI_2 * 0.5 * SIZE;
        let at = [middle[0] + x / across * r, middle[1] - y / across * r];
        // As large as the source, where that can be seen.
        let radius = (source.solid_angle / std::f64::consts::PI).sqrt() / FRAC_PI_2 * 0.5 * SIZE + 5.0;
        d.line(ring(at, radius), Stroke::solid(Ink::BLACK, 2.6));
        d.line(ring(at, radius), Stroke::solid(Ink::new(90, 220, 255), 1.4));
        // A number on its own disk, on the side of the middle.
        let place = [at[0] + (radius + 8.0) * if x > 0.0 { -1.0 } else { 1.0 }, at[1]];
        d.area(ring(place, 7.0), Ink::BLACK, 0.8);
        let text = [place[0], place[1] + 4.0];
        d.text(text, format!("{}", i + 1), 11.0, Anchor::Middle, Ink::WHITE);
    }
    if let Some(scale) = scale {
        d.place(scale.legend(SIZE), [2.0 * MARGIN + SIZE, TOP]);
    }
    let title = format!("{}: luminance, angular fisheye 180°", view.name);
    d.text([0.5 * d.width, 24.0], title, 14.0, Anchor::Middle, Ink::BLACK);
    (d, backdrop)
}

fn backdrop(picture: &LuminancePicture, scale: Option<&LuminanceScale>) -> Backdrop {
    let side = picture.fisheye.side();
    let mut pixels = vec![[1.0; 3]; side as usize * side as usize];
    for p in picture.pixels() {
        pixels[p.index] = scale.map_or([0.0; 3], |s| s.color(p.luminance));
    }
    Backdrop { side, pixels, at: [MARGIN, TOP], size: SIZE }
}

fn ring([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    (0..=72)
        .map(|i| {
            let (sin, cos) = (f64::from(i) / 72.0 * TAU).sin_cos();
            [x + radius * cos, y + radius * sin]
        })
        .collect()
}

/// The header of the view as a Radiance picture; Radiance's worlds are right-handed.
pub fn radiance_header(view: &ViewReport, handedness: Handedness, title: &str) -> RadianceHeader {
    let eye = view.photograph.eye;
    let mut remarks = vec![
        format!("steradian report {title}: view {}", view.name),
        format!(
            "{} samples per pixel; luminance [cd/m2] = 179 (0.265 R + 0.670 G + 0.065 B)",
            view.photograph.samples
        ),
    ];
    if handedness == Handedness::Left {
        // A mirrored world has the same picture and the same glare.
        remarks.push("the scene's world is left-handed: x of -vp, -vd and -vu is negated here".to_owned());
    }
    let turned = |[x, y, z]: [f64; 3]| match handedness {
        Handedness::Left => [0.0 - x, y, z],
        Handedness::Right => [x, y, z],
    };
    let view = FisheyeView { point: turned(eye.point), direction: turned(eye.ahead), up: turned(eye.up) };
    RadianceHeader { remarks, view: Some(view) }
}
