//! Discomfort glare, as the eye meets it: a luminance picture of half of all directions, the bright sources in it, and the
//! indices that follow.
//!
//! ```text
//! scene ─ take ─ Photograph ─ picture ─ LuminancePicture ─ find ─ GlareSource ─ ugr, dgp
//! ```

pub mod detection;
pub mod eye;
pub mod index;
pub mod photograph;
pub mod picture;
pub mod position;
pub mod reading;

pub use detection::{GlareRule, GlareSource, Threshold, find};
pub use eye::{Eye, EyeError, Handedness};
pub use index::{dgp, ugr};
pub use photograph::{Photograph, Shots, take};
pub use picture::{Fisheye, LuminancePicture};
pub use position::position_index;
pub use reading::{GlareReading, read};
