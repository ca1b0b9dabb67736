//! Settings of the execution.

use super::schedule::TileOrder;
use std::time::Duration;

/// How to execute a render; none of it changes the picture, except that a time limit may end it early.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderOptions {
    /// Threads; `None` uses all that the machine offers.
    pub threads: Option<usize>,
    /// Order in which tiles are handed to threads.
    pub tile_order: TileOrder,
    /// Ends the render after the pass in which this time has passed.
    pub time_limit: Option<Duration>,
}
