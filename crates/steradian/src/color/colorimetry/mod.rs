//! Colorimetry of spectra: tristimulus values, chromaticities, correlated colour temperature and colour rendering,
//! in double precision and by the rules of the CIE.
//!
//! ```text
//! values of a table ─ Resampling ─ 471 values at 1 nm ─┬─ Tristimulus ─ Xy, Uv1960, Uv1976, Lab ─ ColorTemperature
//!                                                      └─ LitSamples ─ ColorRendering
//! ```

pub mod rendering;
pub mod resampling;
pub mod temperature;
pub mod tristimulus;

pub use rendering::{ColorRendering, LitSamples, SAMPLES};
pub use resampling::Resampling;
pub use temperature::{ColorTemperature, planckian_uv};
pub use tristimulus::{Lab, Tristimulus, Uv1960, Uv1976, Xy};
