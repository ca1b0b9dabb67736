//! The lighting report of a scene: illuminance on grids, daylight factors, glare.

pub mod contour;
pub mod daylight;
pub mod false_color;
pub mod grid;
mod html;
pub mod isolux;
pub mod room;
pub mod tables;
pub mod uniformity;
pub mod view;

pub use contour::{Field, contours, levels};
pub use daylight::{
    DAYLIGHT_LEVELS, DaylightFactors, DaylightLevel, daylight_factors, is_lit_by_skies, outdoors,
};
pub use false_color::LuminanceScale;
pub use grid::{Grid, GridError};
pub use html::{Page, html};
pub use isolux::isolux;
pub use room::{GridReport, Report, measure_grid};
pub use tables::{grid_table, sources_table, summary_table, view_table};
pub use uniformity::{Interval, Uniformity, uniformity};
pub use view::{Backdrop, ViewReport, false_color_sheet, radiance_header};
