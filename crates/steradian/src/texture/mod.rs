//! Numbers and spectra that vary over surfaces: the closed sets, in arenas.

pub mod input;
pub mod mapping;
pub mod noise;
pub mod pattern;
pub mod blend;
#[cfg(test)]
mod specimen;

pub use blend::{Blend, Weight};
pub use input::{FloatInput, FloatTextureId, SpectrumInput, SpectrumTextureId, TextureContext};
pub use mapping::{Mapping2d, Mapping3d};
pub use noise::{NoiseKind, Octaves};
pub use pattern::Pattern;

use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::Unitless;

/// A number-valued texture.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    /// The same everywhere.
    Constant(f32),
    /// The product of two inputs.
    Scale {
        /// One factor.
        texture: FloatInput,
        /// The other factor.
        scale: FloatInput,
    },
    /// Two inputs, blended.
    Blend(Blend<FloatInput>),
}

/// A spectrum-valued texture.
#[derive(Clone, Debug)]
pub enum SpectrumTexture {
    /// The same everywhere.
    Constant(Spectrum),
    /// A spectrum times a number.
    Scale {
        /// The spectrum.
        texture: SpectrumInput,
        /// The number.
        scale: FloatInput,
    },
    /// Two inputs, blended.
    Blend(Blend<SpectrumInput>),
}

/// A texture that cannot be part of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// An input is not (yet) in the arena: textures refer to earlier ones only, so that they cannot form a cycle.
    #[error("a texture refers to one that is not defined before it")]
    UnknownInput,
    /// Textures of textures are nested too deeply to be evaluated.
    #[error("textures are nested more than {MAX_DEPTH} deep")]
    TooDeep,
}

/// Evaluation recurses; this depth fits into the stack of any worker thread.
const MAX_DEPTH: u32 = 256;

/// All textures of a scene.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    floats: Vec<Node<FloatTexture>>,
    spectra: Vec<Node<SpectrumTexture>>,
}

/// A texture and how deep its inputs are nested.
#[derive(Clone, Debug)]
struct Node<T> {
    texture: T,
    depth: u32,
}

impl Textures {
    /// An empty arena.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a number-valued texture.
    ///
    /// # Errors
    /// When an input does not exist yet or textures are nested too deeply.
    pub fn push_float(&mut self, texture: FloatTexture) -> Result<FloatTextureId, TextureError> {
        let depth = 1 + match &texture {
            FloatTexture::Constant(_) => 0,
            FloatTexture::Scale { texture, scale } => {
                self.float_depth(texture)?.max(self.float_depth(scale)?)
            }
            FloatTexture::Blend(b) => self
                .float_depth(&b.first)?
                .max(self.float_depth(&b.second)?)
                .max(self.weight_depth(&b.weight)?),
        };
        push(&mut self.floats, texture, depth).map(FloatTextureId)
    }

    /// Adds a spectrum-valued texture.
    ///
    /// # Errors
    /// When an input does not exist yet or textures are nested too deeply.
    pub fn push_spectrum(&mut self, texture: SpectrumTexture) -> Result<SpectrumTextureId, TextureError> {
        let depth = 1 + match &texture {
            SpectrumTexture::Constant(_) => 0,
            SpectrumTexture::Scale { texture, scale } => {
                self.spectrum_depth(texture)?.max(self.float_depth(scale)?)
            }
            SpectrumTexture::Blend(b) => self
                .spectrum_depth(&b.first)?
                .max(self.spectrum_depth(&b.second)?)
                .max(self.weight_depth(&b.weight)?),
        };
        push(&mut self.spectra, texture, depth).map(SpectrumTextureId)
    }

    /// The value of a number-valued texture. An id of another arena is a broken invariant.
    pub fn float(&self, id: FloatTextureId, at: &TextureContext) -> f32 {
        match &self.floats[id.0 as usize].texture {
            FloatTexture::Constant(v) => *v,
            FloatTexture::Scale { texture, scale } => {
                let scale = self.float_input(scale, at);
                if scale == 0.0 { 0.0 } else { scale * self.float_input(texture, at) }
            }
            FloatTexture::Blend(b) => {
                let w = self.weight(&b.weight, at);
                let first = if w == 1.0 { 0.0 } else { self.float_input(&b.first, at) };
                let second = if w == 0.0 { 0.0 } else { self.float_input(&b.second, at) };
                (1.0 - w) * first + w * second
            }
        }
    }

    /// The value of a spectrum-valued texture at a path's wavelengths. An id of another arena is a broken invariant.
    pub fn spectrum(&self, id: SpectrumTextureId, at: &TextureContext, w: &Wavelengths) -> Sampled<Unitless> {
        match &self.spectra[id.0 as usize].texture {
            SpectrumTexture::Constant(s) => s.sample(w),
            SpectrumTexture::Scale { texture, scale } => {
                let scale = self.float_input(scale, at);
                if scale == 0.0 { Sampled::ZERO } else { self.spectrum_input(texture, at, w) * scale }
            }
            SpectrumTexture::Blend(b) => {
                let weight = self.weight(&b.weight, at);
                let part = |input, weight| match weight {
                    0.0 => Sampled::ZERO,
                    _ => self.spectrum_input(input, at, w) * weight,
                };
                part(&b.first, 1.0 - weight) + part(&b.second, weight)
            }
        }
    }

    /// The value of a number that may be textured.
    pub fn float_input(&self, input: &FloatInput, at: &TextureContext) -> f32 {
        match input {
            FloatInput::Constant(v) => *v,
            FloatInput::Texture(id) => self.float(*id, at),
        }
    }

    /// The value of a spectrum that may be textured, at a path's wavelengths.
    pub fn spectrum_input(
        &self,
        input: &SpectrumInput,
        at: &TextureContext,
        w: &Wavelengths,
    ) -> Sampled<Unitless> {
        match input {
            SpectrumInput::Constant(s) => s.sample(w),
            SpectrumInput::Texture(id) => self.spectrum(*id, at, w),
        }
    }

    fn weight(&self, weight: &Weight, at: &TextureContext) -> f32 {
        match weight {
            Weight::Amount(amount) => self.float_input(amount, at),
            Weight::Pattern(pattern) => pattern.weight(at),
        }
    }

    fn float_depth(&self, input: &FloatInput) -> Result<u32, TextureError> {
        match input {
            FloatInput::Constant(_) => Ok(0),
            FloatInput::Texture(id) => depth(&self.floats, id.0),
        }
    }

    fn spectrum_depth(&self, input: &SpectrumInput) -> Result<u32, TextureError> {
        match input {
            SpectrumInput::Constant(_) => Ok(0),
            SpectrumInput::Texture(id) => depth(&self.spectra, id.0),
        }
    }

    fn weight_depth(&self, weight: &Weight) -> Result<u32, TextureError> {
        match weight {
            Weight::Amount(amount) => self.float_depth(amount),
            Weight::Pattern(_) => Ok(0),
        }
    }
}

fn push<T>(nodes: &mut Vec<Node<T>>, texture: T, depth: u32) -> Result<u32, TextureError> {
    if depth > MAX_DEPTH {
        return Err(TextureError::TooDeep);
    }
    nodes.push(Node { texture, depth });
    Ok(nodes.len() as u32 - 1)
}

fn depth<T>(nodes: &[Node<T>], id: u32) -> Result<u32, TextureError> {
    nodes.get(id as usize).map(|node| node.depth).ok_or(TextureError::UnknownInput)
}
