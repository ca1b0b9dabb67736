//! What goes into an import and what comes out.

use crate::scene::desc::SceneDesc;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::source::SourceMap;
use std::path::Path;

/// What an import yields: always the messages, and the scene when none of them is an error.
#[derive(Debug)]
pub struct Imported {
    /// The scene; `None` when there are errors.
    pub scene: Option<SceneDesc>,
    /// The files that were read: what the spans of scene and messages point into.
    pub sources: SourceMap,
    /// Everything found on the way.
    pub diagnostics: Diagnostics,
}

/// A main scene file.
#[derive(Clone, Copy, Debug)]
pub enum Input<'a> {
    /// A file to read; names in it are relative to its folder.
    File(&'a Path),
    /// Text at hand, such as standard input.
    Text {
        /// Name for messages.
        name: &'a str,
        /// The text.
        bytes: &'a [u8],
        /// Folder that names in it are relative to.
        base: &'a Path,
    },
}
