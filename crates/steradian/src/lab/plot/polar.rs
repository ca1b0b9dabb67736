//! Curves around a point of a surface, in one plane that contains its normal.

use super::chart::{HEIGHT, Scale, WIDTH, fitted};
use super::curve::Curve;
use super::drawing::{Anchor, Dash, Drawing, Ink, Stroke, text_width};
use super::legend;
use super::ticks::{Ends, Ticks};

const TITLE: f64 = 14.0;
const SMALL: f64 = 10.5;

/// A discrete direction, or the direction that light comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Ray {
    /// Angle to the normal in the plane [degrees], in (−180, 180]; positive to the right.
    pub angle: f64,
    /// Length in shares of the chart's radius, in [0, 1].
    pub length: f64,
    /// Which way it points.
    pub heading: Heading,
    /// Colour.
    pub ink: Ink,
}

/// Which way an arrow points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// To the surface.
    In,
    /// Away from it.
    Out,
}

/// Where the chart has its angle 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Zero {
    /// At the top, as the normal of a surface that is looked at from the side.
    #[default]
    Top,
    /// At the bottom, as the nadir below a luminaire.
    Bottom,
}

/// A polar chart: angle to the normal, and a radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Polar {
    /// What is seen.
    pub title: String,
    /// Quantity and unit of the radius.
    pub radius: String,
    /// Scale of the radius, which begins at zero where it is linear.
    pub scale: Scale,
    /// Where angle 0 is.
    pub zero: Zero,
    /// Curves of angle to the normal [degrees], in (−180, 180], and radius; one without points is a line of the legend.
    pub curves: Vec<Curve>,
    /// Arrows.
    pub rays: Vec<Ray>,
}

/// Where the chart lies on the sheet.
struct Frame {
    centre: [f64; 2],
    radius: f64,
    /// Largest angle that is drawn [degrees]: 90 or 180.
    reach: f64,
    /// 1 when angle 0 is at the top, −1 at the bottom.
    up: f64,
}

impl Frame {
    fn at(&self, angle: f64, fraction: f64) -> [f64; 2] {
        let (sin, cos) = angle.to_radians().sin_cos();
        let r = fraction * self.radius;
        [self.centre[0] + r * sin, self.centre[1] - self.up * r * cos]
    }

    fn arc(&self, fraction: f64) -> Vec<[f64; 2]> {
        let n = (self.reach / 3.0) as i32;
        (-n..=n).map(|i| self.at(f64::from(i) * 3.0, fraction)).collect()
    }
}

impl Polar {
    /// The chart on a sheet of the nominal size: the half of the circle around angle 0, all of it when something lies
    /// beyond 90°.
    pub fn draw(&self) -> Drawing {
        let mut d = Drawing::new(WIDTH, HEIGHT);
        let largest = Curve::extent(&self.curves, 1).map_or(0.0, |[_, hi]| hi);
        let ticks = match self.scale {
            Scale::Linear => Ticks::linear([0.0, largest], 4, Ends::OnMarks),
            Scale::Logarithmic { decades } => Ticks::logarithmic(largest, decades.min(30) as i32),
        };
        let f = self.frame();
        self.grid(&mut d, &f, &ticks);
        for curve in &self.curves {
            for piece in curve.pieces(|[angle, r]| f.at(angle, ticks.fraction(r.max(0.0)))) {
                d.line(piece, curve.stroke());
            }
        }
        for ray in &self.rays {
            draw_ray(&mut d, &f, ray);
        }
        d.text([0.5 * WIDTH, 24.0], fitted(&self.title, TITLE), TITLE, Anchor::Middle, Ink::BLACK);
        let place = [f.centre[0], HEIGHT - 14.0];
        d.text(place, format!("radius: {}", self.radius), 12.0, Anchor::Middle, Ink::BLACK);
        let x = WIDTH - 20.0 - legend::width(&self.curves) + 14.0;
        legend::draw(&mut d, [x, 40.0], HEIGHT - 92.0, &self.curves);
        d
    }

    fn frame(&self) -> Frame {
        let points = self.curves.iter().flat_map(|c| c.points.iter().map(|p| p[0]));
        let angles = points.chain(self.rays.iter().map(|r| r.angle));
        let reach = if angles.fold(0.0, |a: f64, b| a.max(b.abs())) > 90.5 { 180.0 } else { 90.0 };
        let room = WIDTH - legend::width(&self.curves) - 20.0;
        // Numbers stand around the circle.
        let (top, bottom, side) = (58.0, HEIGHT - 44.0, 34.0);
        let half_width = 0.5 * room - side;
        let up = if self.zero == Zero::Top { 1.0 } else { -1.0 };
        if reach > 90.0 {
            let radius = half_width.min(0.5 * (bottom - top) - 8.0);
            Frame { centre: [0.5 * room + 6.0, 0.5 * (top + bottom)], radius, reach, up }
        } else {
            let radius = half_width.min(bottom - top - 26.0);
            // The numbers of the radius stand on the other side of the straight edge.
            let (lo, hi) = if up > 0.0 { (top, bottom - 26.0) } else { (top + 20.0, bottom) };
            let radius = radius.min(hi - lo);
            Frame { centre: [0.5 * room + 6.0, 0.5 * (lo + hi + up * radius)], radius, reach, up }
        }
    }

    fn grid(&self, d: &mut Drawing, f: &Frame, ticks: &Ticks) {
        let grid = Stroke::solid(Ink::PALE, 1.0);
        for degrees in (-11..=12).map(|i| 15.0 * f64::from(i)).filter(|a| a.abs() <= f.reach) {
            d.line(vec![f.centre, f.at(degrees, 1.0)], grid);
            if degrees.rem_euclid(30.0) == 0.0 {
                let [x, y] = f.at(degrees, 1.0 + 15.0 / f.radius);
                let label = format!("{:.0}°", degrees.abs());
                d.text([x, y + 0.35 * SMALL], label, SMALL, Anchor::Middle, Ink::GREY);
            }
        }
        for &r in ticks.at.iter().filter(|r| ticks.fraction(**r) > 0.0) {
            d.line(f.arc(ticks.fraction(r)), grid);
        }
        d.line(f.arc(1.0), Stroke::solid(Ink::GREY, 1.0));
        d.line(vec![f.at(-90.0, 1.0), f.at(90.0, 1.0)], Stroke::solid(Ink::BLACK, 1.4));
        d.line(vec![f.centre, f.at(0.0, 1.0)], Stroke { dash: Dash::Dashed, ..grid });
        // Numbers of the radius beyond the straight edge to the right, where a half circle has nothing to show; numbers that
        // would touch the one before are left out.
        let mut free = f.centre[0] - 1.0;
        for &r in &ticks.at {
            let [x, y] = f.at(90.0, ticks.fraction(r));
            let label = ticks.label(r);
            let half = 0.5 * text_width(&label, SMALL);
            let outermost = ticks.fraction(r) > 0.999;
            if x - half < free || outermost && f.reach > 90.0 {
                continue;
            }
            free = x + half + 6.0;
            d.line(vec![[x, y], [x, y + 4.0 * f.up]], Stroke::solid(Ink::BLACK, 1.0));
            d.text(
                [x, y + 16.0 * f.up + if f.up > 0.0 { 0.0 } else { 0.7 * SMALL }],
                label,
                SMALL,
                Anchor::Middle,
                Ink::BLACK,
            );
        }
    }
}

/// A line from the centre with its head.
fn draw_ray(d: &mut Drawing, f: &Frame, ray: &Ray) {
    let end = f.at(ray.angle, ray.length);
    let dash = if ray.heading == Heading::In { Dash::Dashed } else { Dash::Solid };
    d.line(vec![f.centre, end], Stroke { ink: ray.ink, width: 1.6, dash });
    let (tip, towards) = match ray.heading {
        // Off the centre, where the heads of several would meet.
        Heading::In => (f.at(ray.angle, 0.3 * ray.length), ray.angle),
        Heading::Out => (end, ray.angle + 180.0),
    };
    // A short arrow has a small head.
    let head = (0.6 * ray.length * f.radius).min(9.0);
    let wing = |turn: f64| {
        let (sin, cos) = (towards + turn).to_radians().sin_cos();
        [tip[0] + head * sin, tip[1] - head * cos]
    };
    d.area(vec![tip, wing(18.0), wing(-18.0)], ray.ink, 1.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::plot::drawing::Mark;

    /// The curve of a Lambertian lobe as it is drawn.
    fn lambertian(zero: Zero) -> Vec<[f64; 2]> {
        let points = (-90..=90).map(|a| [f64::from(a), f64::from(a).to_radians().cos()]).collect();
        let polar = Polar {
            title: String::new(),
            radius: String::new(),
            scale: Scale::Linear,
            zero,
            curves: vec![Curve::new("", Ink::new(9, 9, 9), points)],
            rays: vec![],
        };
        let lobe = polar.draw().marks.into_iter().find_map(|m| match m {
            Mark::Line { points, stroke } if stroke.ink == Ink::new(9, 9, 9) => Some(points),
            _ => None,
        });
        lobe.unwrap()
    }

    #[test]
    fn a_lambertian_lobe_is_a_circle_that_touches_the_surface() {
        for (zero, up) in [(Zero::Top, 1.0), (Zero::Bottom, -1.0)] {
            let lobe = lambertian(zero);
            let (tip, foot) = (lobe[90], lobe[0]);
            let centre = [foot[0], 0.5 * (tip[1] + foot[1])];
            // Heights of a sheet grow downwards.
            let radius = 0.5 * (foot[1] - tip[1]) * up;
            assert!(radius > 10.0, "{zero:?}");
            for p in lobe {
                let r = (p[0] - centre[0]).hypot(p[1] - centre[1]);
                assert!((r - radius).abs() < 1e-6 * radius, "{p:?}");
            }
        }
    }
}
