//! The graphics state: what directives inherit from those before them.

use super::args::Preset;
use crate::color::ColorSpaceKind;
use crate::math::{AnimatedTransform, Transform};
use crate::scene::desc::{AreaLightDesc, Id, MaterialDesc, MediumInterface};
use std::rc::Rc;

/// The current transform at the two ends of the shutter interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ctm {
    pub(super) start: Transform,
    pub(super) end: Transform,
}

impl Ctm {
    pub(super) const IDENTITY: Self = Self { start: Transform::IDENTITY, end: Transform::IDENTITY };

    pub(super) fn inverse(&self) -> Self {
        Self { start: self.start.inverse(), end: self.end.inverse() }
    }
}

/// What an `Attribute` directive can preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    Shape,
    Light,
    Material,
    Medium,
    Texture,
}

impl Target {
    pub(super) const NAMES: [(&'static str, Self); 5] = [
        ("shape", Self::Shape),
        ("light", Self::Light),
        ("material", Self::Material),
        ("medium", Self::Medium),
        ("texture", Self::Texture),
    ];
}

/// Everything that `AttributeBegin` saves.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) ctm: Ctm,
    /// Whether transforms apply at the start, at the end.
    pub(super) active: [bool; 2],
    /// Times of the two transforms [s].
    pub(super) times: [f32; 2],
    pub(super) reverse_orientation: bool,
    pub(super) color_space: ColorSpaceKind,
    pub(super) material: Id<MaterialDesc>,
    pub(super) area_light: Option<Id<AreaLightDesc>>,
    pub(super) media: Option<MediumInterface>,
    presets: [Rc<Vec<Preset>>; 5],
}

impl State {
    pub(super) fn new(material: Id<MaterialDesc>) -> Self {
        Self {
            ctm: Ctm::IDENTITY,
            active: [true, true],
            times: [0.0, 1.0],
            reverse_orientation: false,
            color_space: ColorSpaceKind::Srgb,
            material,
            area_light: None,
            media: None,
            presets: Default::default(),
        }
    }

    /// The presets for a kind of entity.
    pub(super) fn presets(&self, target: Target) -> Rc<Vec<Preset>> {
        Rc::clone(&self.presets[target as usize])
    }

    /// Adds presets for a kind of entity.
    pub(super) fn add_presets(&mut self, target: Target, more: impl IntoIterator<Item = Preset>) {
        Rc::make_mut(&mut self.presets[target as usize]).extend(more);
    }

    /// Replaces the transforms that are active; `false` when a result cannot be inverted in floating point,
    /// which leaves everything as it was.
    #[must_use]
    pub(super) fn change_ctm(&mut self, change: impl Fn(&Transform) -> Transform) -> bool {
        let mut next = self.ctm;
        if self.active[0] {
            next.start = change(&next.start);
        }
        if self.active[1] {
            next.end = change(&next.end);
        }
        let sound = |t: &Transform| t.matrix().is_finite() && t.inverse_matrix().is_finite();
        let fine = sound(&next.start) && sound(&next.end);
        if fine {
            self.ctm = next;
        }
        fine
    }

    /// The current transform as something that moves.
    pub(super) fn animated(&self) -> AnimatedTransform {
        AnimatedTransform::new(self.ctm.start, self.ctm.end, self.times)
    }

    /// The inverse of the current transform as something that moves.
    pub(super) fn animated_inverse(&self) -> AnimatedTransform {
        let inverse = self.ctm.inverse();
        AnimatedTransform::new(inverse.start, inverse.end, self.times)
    }
}
