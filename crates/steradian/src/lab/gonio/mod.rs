//! A virtual goniophotometer: where light from chosen directions is scattered to.
//!
//! ```text
//!                 ┌ material ┐
//! cells ─ census ─┤          ├─ instrument ─→ Reading ─┬ reciprocity ─ sheet (table, plot)
//!    └─── beam ───┴ patch ───┘                         └ export (table of a material), klems (matrices in XML)
//! ```
//!
//! The hemisphere is divided into cells, and each reading is the mean over a cell: f̄ = (1/Ω) ∫ f cosθ dω with the projected
//! solid angle Ω = ∫ cosθ dω, which is the flux that arrives in the cell over the incident flux and Ω. That is what an
//! instrument with an opening of that size reads. Discrete directions have no f; what they bring to a cell is kept apart as
//! a share of the incident flux.
//!
//! f is that of power, for a fixed direction of the *incident* light, also through a boundary of media with different indices.

mod beam;
mod cells;
mod census;
mod export;
mod instrument;
mod klems;
mod material;
mod patch;
mod reading;
mod reciprocity;
mod sheet;
#[cfg(test)]
mod tests;

pub use beam::{Face, Incidence};
pub use cells::{Cell, CellGrid, Ring};
pub use export::{ExportError, check_table_wavelengths, material_table, table_incidence};
pub use instrument::{Goniometer, Sample};
pub use klems::{KlemsError, klems_xml};
pub use material::Method;
pub use patch::{Patch, PatchError, Port};
pub use reading::{Beam, CellFlux, Reading, Rest, Scattered};
pub use reciprocity::{Reciprocity, Residual, reciprocity};
pub use sheet::{Detail, plot, table};
