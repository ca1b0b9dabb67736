//! Execution: threads, tiles, progress, cancellation.

pub mod progress;
pub mod schedule;

pub use progress::{CancelToken, Progress, ProgressSink, Silent};
pub use schedule::TileOrder;
