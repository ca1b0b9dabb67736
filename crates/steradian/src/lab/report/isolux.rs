//! The illuminance on a grid as a plan with isolux lines.

use super::contour::{Field, contours, levels};
use super::grid::Grid;
use crate::color::transfer::srgb_encode;
use crate::image::heat_color;
use crate::lab::plot::{Anchor, Drawing, Ink, Stroke, text_width};
use crate::units::Estimate;

const WIDTH: f64 = 640.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 44.0;
const SMALL: f64 = 11.0;
/// Room right of the plan for the scale [px].
const SCALE: f64 = 110.0;
/// Heights between which the plan's is held [px].
const HEIGHTS: [f64; 2] = [90.0, 620.0];
/// More cells along a side are too small for their number.
const NUMBERED: usize = 12;
/// Levels that are aimed at.
const LEVELS: usize = 7;

/// The plan: cells in false colour, lines of equal illuminance, numbers where they fit, and the least and the greatest reading.
///
/// `u` points to the right, `v` upwards. `meters_per_unit` is the length of a scene unit [m].
pub fn isolux(grid: &Grid, readings: &[Estimate], title: &str, meters_per_unit: f64) -> Drawing {
    let [length_u, length_v] = grid.size().map(|l| l * meters_per_unit);
    let room = WIDTH - LEFT - SCALE - 20.0;
    let natural = room * length_v / length_u;
    let height = natural.clamp(HEIGHTS[0], HEIGHTS[1]);
    // Very tall or flat plans are drawn to scale as far as the sheet allows.
    let width = if natural > HEIGHTS[1] { (height * length_u / length_v).max(90.0) } else { room };
    let plan = Plan { width, height, columns: grid.columns, rows: grid.rows };
    let mut d = Drawing::new(WIDTH, TOP + height + 56.0);
    let values: Vec<f64> = readings.iter().map(|e| e.value).collect();
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
    let shade = Shade { low, high };
    for (i, &v) in values.iter().enumerate() {
        let (x, y) = ((i % grid.columns) as f64, (i / grid.columns) as f64);
        // A little overlap hides the seams of antialiasing.
        let (s, t) = (0.5 + 0.3 * grid.columns as f64 / width, 0.5 + 0.3 * grid.rows as f64 / height);
        let corners = [[-s, -t], [s, -t], [s, t], [-s, t]];
        d.area(corners.map(|c| plan.place([x + c[0], y + c[1]])).to_vec(), shade.ink(v), 1.0);
    }
    let marks = levels(low, high, LEVELS);
    let field = Field { columns: grid.columns, values: &values };
    for &level in &marks {
        for line in contours(&field, level) {
            let points: Vec<_> = line.iter().map(|p| plan.place(*p)).collect();
            d.line(points.clone(), Stroke::solid(Ink::WHITE, 2.6));
            d.line(points, Stroke::solid(Ink::BLACK, 1.2));
        }
    }
    if grid.columns <= NUMBERED && grid.rows <= NUMBERED && width / grid.columns as f64 > 26.0 {
        numbers(&mut d, &plan, &shade, &values);
    } else {
        for &level in &marks {
            label(&mut d, &plan, &field, level);
        }
    }
    extremes(&mut d, &plan, &values);
    frame(&mut d, &plan, [length_u, length_v]);
    scale(&mut d, &plan, &shade, &marks);
    d.text([0.5 * WIDTH, 24.0], title, 14.0, Anchor::Middle, Ink::BLACK);
    d
}

struct Plan {
    width: f64,
    height: f64,
    columns: usize,
    rows: usize,
}

impl Plan {
    /// Where a place of the grid, in cells from the middle of the first, is on paper.
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (u, v) = ((x + 0.5) / self.columns as f64, (y + 0.5) / self.rows as f64);
        [LEFT + u * self.width, TOP + (1.0 - v) * self.height]
    }
}

/// Values as colours that leave room for black lines and numbers.
struct Shade {
    low: f64,
    high: f64,
}

impl Shade {
    fn ink(&self, v: f64) -> Ink {
        if !v.is_finite() {
            return Ink::PALE;
        }
        let t = if self.high > self.low { (v - self.low) / (self.high - self.low) } else { 1.0 };
        // The upper two thirds of the map: dark violet would swallow black lines.
        let rgb = heat_color((0.35 + 0.65 * t) as f32);
        let encoded = rgb.map(|c| (srgb_encode(c.clamp(0.0, 1.0)) * 255.0).round() as u8);
        Ink::new(encoded[0], encoded[1], encoded[2])
    }
}

fn short(v: f64) -> String {
    match v.abs() {
        a if a >= 100.0 => format!("{v:.0}"),
        a if a >= 10.0 => format!("{v:.1}"),
        a if a >= 0.1 => format!("{v:.2}"),
        0.0 => "0".to_owned(),
        _ => format!("{v:.1e}"),
    }
}

fn level_text(v: f64) -> String {
    let text = format!("{v:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn numbers(d: &mut Drawing, plan: &Plan, shade: &Shade, values: &[f64]) {
    for (i, &v) in values.iter().enumerate() {
        let [x, y] = plan.place([(i % plan.columns) as f64, (i / plan.columns) as f64]);
        let Ink { r, g, b } = shade.ink(v);
        let brightness = 0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b);
        let ink = if brightness < 110.0 { Ink::WHITE } else { Ink::BLACK };
        d.text([x, y + 0.35 * 10.0], short(v), 10.0, Anchor::Middle, ink);
    }
}

/// A number on the longest line of a level.
fn label(d: &mut Drawing, plan: &Plan, field: &Field<'_>, level: f64) {
    let lines = contours(field, level);
    let Some(longest) = lines.iter().max_by_key(|l| l.len()) else { return };
    let [x, y] = plan.place(longest[longest.len() / 2]);
    let text = level_text(level);
    let half = 0.5 * text_width(&text, 10.0) + 2.0;
    d.area(
        vec![[x - half, y - 7.0], [x + half, y - 7.0], [x + half, y + 6.0], [x - half, y + 6.0]],
        Ink::WHITE,
        0.85,
    );
    d.text([x, y + 3.5], text, 10.0, Anchor::Middle, Ink::BLACK);
}

/// Triangles at the least (pointing down) and the greatest reading (pointing up).
fn extremes(d: &mut Drawing, plan: &Plan, values: &[f64]) {
    let finite = || values.iter().enumerate().filter(|v| v.1.is_finite());
    let least = finite().min_by(|a, b| a.1.total_cmp(b.1));
    let greatest = finite().max_by(|a, b| a.1.total_cmp(b.1));
    for (found, sign) in [(least, 1.0), (greatest, -1.0)] {
        let Some((i, _)) = found else { continue };
        let [x, y] = plan.place([(i % plan.columns) as f64, (i / plan.columns) as f64]);
        // Above the cell's number.
        let y = y - 11.0;
        let corners = vec![[x - 4.5, y - 3.5 * sign], [x + 4.5, y - 3.5 * sign], [x, y + 4.5 * sign]];
        d.area(corners.clone(), Ink::WHITE, 1.0);
        let outline = corners.iter().chain(corners.first()).copied().collect();
        d.line(outline, Stroke::solid(Ink::BLACK, 1.2));
    }
}

fn frame(d: &mut Drawing, plan: &Plan, [length_u, length_v]: [f64; 2]) {
    let (right, bottom) = (LEFT + plan.width, TOP + plan.height);
    let outline = vec![[LEFT, TOP], [right, TOP], [right, bottom], [LEFT, bottom], [LEFT, TOP]];
    d.line(outline, Stroke::solid(Ink::BLACK, 1.0));
    let steps = |length: f64| levels(0.0, length * 1.000_001, 6).into_iter().chain([0.0]);
    for u in steps(length_u) {
        let x = LEFT + u / length_u * plan.width;
        d.line(vec![[x, bottom], [x, bottom + 4.0]], Stroke::solid(Ink::BLACK, 1.0));
        d.text([x, bottom + 16.0], level_text(u), SMALL, Anchor::Middle, Ink::BLACK);
    }
    for v in steps(length_v) {
        let y = bottom - v / length_v * plan.height;
        d.line(vec![[LEFT - 4.0, y], [LEFT, y]], Stroke::solid(Ink::BLACK, 1.0));
        d.text([LEFT - 7.0, y + 0.35 * SMALL], level_text(v), SMALL, Anchor::End, Ink::BLACK);
    }
    d.text([LEFT + 0.5 * plan.width, bottom + 36.0], "u [m]", 12.0, Anchor::Middle, Ink::BLACK);
    d.text_up([20.0, TOP + 0.5 * plan.height], "v [m]", 12.0, Anchor::Middle, Ink::BLACK);
}

fn scale(d: &mut Drawing, plan: &Plan, shade: &Shade, marks: &[f64]) {
    let (left, width) = (LEFT + plan.width + 24.0, 14.0);
    let (top, bottom) = (TOP + 16.0, TOP + plan.height.max(HEIGHTS[0]));
    let (low, high) = (shade.low, shade.high);
    d.text([left, TOP + 6.0], "E [lx]", SMALL, Anchor::Start, Ink::BLACK);
    if !(high > low) {
        return;
    }
    let y = |v: f64| bottom - (v - low) / (high - low) * (bottom - top);
    let steps = 64;
    for i in 0..steps {
        let at = |k: usize| low + (high - low) * k as f64 / f64::from(steps as u32);
        // A little overlap hides the seams of antialiasing.
        let (a, b) = (y(at(i)), (y(at(i + 1)) - 0.6).max(top));
        let corners = vec![[left, a], [left + width, a], [left + width, b], [left, b]];
        d.area(corners, shade.ink(0.5 * (at(i) + at(i + 1))), 1.0);
    }
    for &mark in marks {
        let place = y(mark);
        d.line(vec![[left, place], [left + width + 4.0, place]], Stroke::solid(Ink::BLACK, 1.0));
        let at = [left + width + 7.0, place + 0.35 * SMALL];
        d.text(at, level_text(mark), SMALL, Anchor::Start, Ink::BLACK);
    }
    let outline = vec![[left, top], [left + width, top], [left + width, bottom], [left, bottom], [left, top]];
    d.line(outline, Stroke::solid(Ink::BLACK, 1.0));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::plot::Mark;

    #[test]
    fn a_slope_has_its_lines_where_the_values_are() {
        // 10 × 5 cells over 5 m × 2.5 m, E = 100 lx per column: the line of 400 lx runs upright through column 4.
        let grid = Grid {
            name: "g".to_owned(),
            corner: [0.0; 3],
            u: [5.0, 0.0, 0.0],
            v: [0.0, 2.5, 0.0],
            columns: 10,
            rows: 5,
        };
        let readings: Vec<_> = (0..50).map(|i| Estimate::exact(100.0 * f64::from(i % 10))).collect();
        let d = isolux(&grid, &readings, "t", 1.0);
        let width = WIDTH - LEFT - SCALE - 20.0;
        let x = LEFT + 4.5 / 10.0 * width;
        let found = d.marks.iter().any(|m| match m {
            Mark::Line { points, stroke } => {
                stroke.width == 1.2 && points.len() == 5 && points.iter().all(|p| (p[0] - x).abs() < 1e-6)
            }
            _ => false,
        });
        assert!(found);
        // Two metres are as long across as upwards.
        let texts = |s: &str| {
            d.marks.iter().find_map(|m| match m {
                Mark::Text(t) if t.text == s && t.anchor == Anchor::Middle => Some(t.at[0]),
                _ => None,
            })
        };
        assert!((texts("2").unwrap() - LEFT - 0.4 * width).abs() < 1e-6);
    }

    #[test]
    fn a_single_dark_cell_can_be_drawn() {
        let grid = Grid {
            name: "g".to_owned(),
            corner: [0.0; 3],
            u: [1.0, 0.0, 0.0],
            v: [0.0, 1.0, 0.0],
            columns: 1,
            rows: 1,
        };
        let d = isolux(&grid, &[Estimate::exact(0.0)], "t", 1.0);
        assert!(d.marks.iter().all(|m| match m {
            Mark::Line { points, .. } | Mark::Area { points, .. } => {
                points.iter().flatten().all(|c| c.is_finite())
            }
            Mark::Text(t) => t.at.iter().all(|c| c.is_finite()),
        }));
    }
}
