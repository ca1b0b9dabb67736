//! From scene text to a scene: description, diagnostics, import (and compilation).
//!
//! ```text
//! bytes ─ text (lexer, parser: knows the grammar, no plugin names)
//!       ─ import (knows plugin names and parameters, resolves names)
//!       ─ desc (typed plain data) ─ compile
//! ```
//!
//! Every stage that can find fault with a scene takes a [`Diagnostics`] collection, so that a user sees
//! all errors of a scene at once, each at its place in the text.

pub mod desc;
pub mod diagnostic;
pub mod files;
pub mod import;
pub mod source;
pub mod text;

pub use desc::{NoiseTarget, SceneDesc};
pub use diagnostic::{Diagnostic, Diagnostics, Severity, nearest};
pub use files::{Disk, FileBytes, FileSystem, MemoryFiles};
pub use source::{FileId, Location, SourceMap, Span};

pub mod compile;
pub mod compiled;
pub mod job;
pub mod overrides;

pub use compile::{compile, compile_with_tables};
pub use compiled::{Scene, SceneHit, SceneLightSample, ShapeAttributes};
pub use job::{ClassicSettings, IntegratorSettings, Jitter, PathSettings, RenderJob, Sampling};
pub use overrides::{OverrideError, Overrides};

/// The Cornell box with its measured reflectances and emission, as pbrt-v4 text.
pub const CORNELL_BOX: &str = include_str!("../../data/cornell-box.pbrt");
