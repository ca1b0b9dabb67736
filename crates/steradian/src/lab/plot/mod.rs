//! Plots as drawings and as SVG.
//!
//! ```text
//! Curve ─ Chart  ─┐
//!         Polar  ─┼─ Drawing ─ svg ─→ text of an <svg> element
//!                 └─ (any other writer of lines, areas and text)
//! ```
//!
//! [`curves_svg`] is the short way for reports: one call makes a chart that can stand inside of HTML.

pub mod chart;
pub mod curve;
pub mod drawing;
mod legend;
pub mod palette;
pub mod polar;
mod svg;
mod ticks;

pub use chart::{Axis, Chart, Scale};
pub use curve::Curve;
pub use drawing::{Anchor, Dash, Drawing, Ink, Mark, Run, Stroke, Text, text_width};
pub use palette::{series_ink, wavelength_ink};
pub use polar::{Heading, Polar, Ray, Zero};
pub use svg::svg;

/// A chart of curves over linear axes as an `<svg>` element, for a file of its own or inside of HTML.
///
/// The labels name quantity and unit, such as `wavelength [nm]`. Values that are not finite interrupt their curve.
/// No curves at all make an empty chart.
pub fn curves_svg(title: &str, x_label: &str, y_label: &str, curves: &[Curve]) -> String {
    let chart = Chart {
        title: title.to_owned(),
        x: Axis::new(x_label),
        y: Axis::new(y_label),
        curves: curves.to_vec(),
    };
    svg(&chart.draw())
}
