//! What the readers of all classes share: diagnostics, the folder of the scene, the tables of names.

use super::names::Table;
use crate::scene::desc::{
    FileRef, FloatTextureDesc, MaterialDesc, MediumDesc, MediumInterface, ObjectDesc, SpectrumTextureDesc,
    TextureId,
};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::source::Span;
use crate::scene::text::Text;
use std::path::PathBuf;

/// Shared state of an import.
#[derive(Debug, Default)]
pub(super) struct Context {
    pub(super) diagnostics: Diagnostics,
    /// Folder that file names are relative to.
    pub(super) base: PathBuf,
    pub(super) float_textures: Table<FloatTextureDesc>,
    pub(super) spectrum_textures: Table<SpectrumTextureDesc>,
    /// Textures in order of definition, each with those it uses.
    pub(super) texture_uses: Vec<(TextureId, Vec<TextureId>)>,
    pub(super) materials: Table<MaterialDesc>,
    pub(super) media: Table<MediumDesc>,
    pub(super) objects: Table<ObjectDesc>,
    /// The file turned out to be of pbrt-v3: everything else would be noise.
    pub(super) is_v3: bool,
}

impl Context {
    /// The file of that name, relative to the scene's folder.
    pub(super) fn file(&self, name: &Text) -> FileRef {
        FileRef { path: self.base.join(&name.value), span: name.span }
    }

    /// The media of that name on both sides; an empty name is vacuum.
    pub(super) fn media(&mut self, inside: &Text, outside: &Text) -> MediumInterface {
        let mut side = |t: &Text| (!t.value.is_empty()).then(|| self.media.refer(t));
        MediumInterface { inside: side(inside), outside: side(outside) }
    }

    /// Reports a class that is known but would not be rendered rightly.
    pub(super) fn unsupported(&mut self, span: Span, what: &str) {
        self.diagnostics.error(span, format!("unsupported: {what}"));
    }

    /// Reports, once, that the file is of the older language.
    pub(super) fn found_v3(&mut self, span: Span, because: &str) {
        if !self.is_v3 {
            self.is_v3 = true;
            let message = format!("this looks like a pbrt-v3 file; the language here is pbrt-v4, {because}");
            let d = Diagnostic::error(span, message);
            self.diagnostics
                .push(d.with_help("convert it with pbrt-v4: `pbrt --upgrade old.pbrt > new.pbrt`"));
        }
    }
}
