//! The light laboratory: the scene's own materials and lights under virtual instruments.

pub mod color;
pub mod glare;
pub mod gonio;
pub mod luminaire;
pub mod meters;
pub mod plot;
pub mod portrait;
pub mod precision;
pub mod preview;
pub mod probe;
pub mod report;
pub mod session;
pub mod spectro;
pub mod subject;
pub mod table;
pub mod turbid;
pub mod validation;
pub mod verify;

pub use precision::{Moments, Precision};
pub use session::{Block, Ending, Outcome, Session, Tally};
pub use subject::{Subject, UnknownMaterial};
pub use table::{Cell, Column, Table};
