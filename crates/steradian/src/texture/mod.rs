//! Numbers and spectra that vary over surfaces: the closed sets, in arenas.

pub mod input;
pub mod mapping;
pub mod noise;
pub mod pattern;
pub mod blend;
pub mod filter;
pub mod picture;
pub mod upsampling;
pub mod marble;
#[cfg(test)]
mod specimen;

pub use blend::{Blend, Weight};
pub use filter::ImageFilter;
pub use input::{FloatInput, FloatTextureId, SpectrumInput, SpectrumTextureId, TextureContext};
pub use mapping::{Mapping2d, Mapping3d};
pub use marble::Marble;
pub use noise::{NoiseKind, Octaves};
pub use pattern::Pattern;
pub use picture::{ImageId, ImageTexture};
pub use upsampling::{ColorTableId, SpectrumUse};

use crate::color::{ColorSpace, UpsamplingTable};
use crate::image::Pyramid;
use crate::math::Vec2;
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::Unitless;
use std::sync::Arc;
use upsampling::ColorTable;

/// A number-valued texture.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    /// The product of two inputs.
    Scale {
        /// One factor.
        texture: FloatInput,
        /// The other factor.
        scale: FloatInput,
    },
    /// Two inputs, blended.
    Blend(Blend<FloatInput>),
    /// Bilinear interpolation between the corners of the unit square, continued linearly outside.
    Bilinear(Corners<[f32; 4]>),
    /// A picture.
    Image(ImageTexture),
    /// Noise in texture space.
    Noise {
        /// Surface to texture space.
        mapping: Mapping3d,
        /// The kind.
        kind: NoiseKind,
    },
}

/// A spectrum-valued texture.
#[derive(Clone, Debug)]
pub enum SpectrumTexture {
    /// A spectrum times a number.
    Scale {
        /// The spectrum.
        texture: SpectrumInput,
        /// The number.
        scale: FloatInput,
    },
    /// Two inputs, blended.
    Blend(Blend<SpectrumInput>),
    /// Bilinear interpolation between the corners of the unit square, continued linearly outside.
    Bilinear(Corners<Box<[Spectrum; 4]>>),
    /// A picture.
    Image {
        /// The picture and its mapping.
        texture: ImageTexture,
        /// The colour space of its RGB.
        colors: ColorTableId,
        /// What its RGB stands for.
        reading: SpectrumUse,
    },
    /// Bands of colour, displaced by noise.
    Marble(Marble),
}

/// Values at the corners of the unit square of (s, t).
#[derive(Clone, Debug)]
pub struct Corners<V> {
    /// Values at (s, t) = (0, 0), (0, 1), (1, 0) and (1, 1).
    pub values: V,
    /// Where the square lies.
    pub mapping: Mapping2d,
}

impl<V> Corners<V> {
    fn weights(&self, at: &TextureContext) -> [f32; 4] {
        let Vec2 { x: s, y: t } = self.mapping.map(at).st;
        [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t]
    }
}

/// A texture that cannot be part of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// An input, picture or colour space is not (yet) in the arena: textures refer to earlier ones only, so that
    /// they cannot form a cycle.
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
    images: Vec<Pyramid>,
    colors: Vec<ColorTable>,
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

    /// Adds a picture, which any number of textures may show.
    pub fn push_image(&mut self, pyramid: Pyramid) -> ImageId {
        self.images.push(pyramid);
        ImageId(self.images.len() as u32 - 1)
    }

    /// Adds a colour space with the table that was built from it.
    pub fn push_color_space(&mut self, space: &ColorSpace, table: Arc<UpsamplingTable>) -> ColorTableId {
        self.colors.push(ColorTable::new(space, table));
        ColorTableId(self.colors.len() as u32 - 1)
    }

    /// A picture of the arena; `None` for an id of another.
    pub fn image(&self, id: ImageId) -> Option<&Pyramid> {
        self.images.get(id.0 as usize)
    }

    /// Memory of all pictures [B].
    pub fn image_bytes(&self) -> usize {
        self.images.iter().map(Pyramid::bytes).sum()
    }

    /// Adds a number-valued texture.
    ///
    /// # Errors
    /// When an input does not exist yet or textures are nested too deeply.
    pub fn push_float(&mut self, texture: FloatTexture) -> Result<FloatTextureId, TextureError> {
        let depth = 1 + match &texture {
            FloatTexture::Bilinear(_) | FloatTexture::Noise { .. } => 0,
            FloatTexture::Image(texture) => self.check_image(texture)?,
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
            SpectrumTexture::Bilinear(_) => 0,
            SpectrumTexture::Image { texture, colors, .. } => {
                self.check_colors(*colors)?;
                self.check_image(texture)?
            }
            SpectrumTexture::Marble(marble) => self.check_colors(marble.colors)?,
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
            FloatTexture::Bilinear(corners) => {
                corners.weights(at).iter().zip(&corners.values).map(|(w, v)| w * v).sum()
            }
            FloatTexture::Image(texture) => texture.scalar(&self.images[texture.image.0 as usize], at),
            FloatTexture::Noise { mapping, kind } => kind.at(&mapping.map(at)),
        }
    }

    /// The value of a spectrum-valued texture at a path's wavelengths. An id of another arena is a broken invariant.
    #[inline(never)]
    pub fn spectrum(&self, id: SpectrumTextureId, at: &TextureContext, w: &Wavelengths) -> Sampled<Unitless> {
        match &self.spectra[id.0 as usize].texture {
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
            SpectrumTexture::Bilinear(corners) => corners
                .weights(at)
                .iter()
                .zip(corners.values.iter())
                .fold(Sampled::ZERO, |sum, (&weight, s)| sum + s.sample::<Unitless>(w) * weight),
            SpectrumTexture::Image { texture, colors, reading } => {
                let rgb = texture.rgb(&self.images[texture.image.0 as usize], at);
                self.colors[colors.0 as usize].sample(rgb, *reading, w)
            }
            SpectrumTexture::Marble(marble) => {
                self.colors[marble.colors.0 as usize].sample(marble.rgb(at), SpectrumUse::Albedo, w)
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
    #[inline(always)]
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

    /// The depth of a picture's inputs: none.
    fn check_image(&self, texture: &ImageTexture) -> Result<u32, TextureError> {
        self.image(texture.image).map(|_| 0).ok_or(TextureError::UnknownInput)
    }

    /// The depth of a colour space's inputs: none.
    fn check_colors(&self, id: ColorTableId) -> Result<u32, TextureError> {
        self.colors.get(id.0 as usize).map(|_| 0).ok_or(TextureError::UnknownInput)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{ColorSpaceKind, Rgb};
    use crate::image::{ColorEncoding, Image, Layout, Wrap};
    use crate::math::{Dir, Footprint, Point, SurfacePoint, Transform, Vec3};

    fn evaluate<T>(uv: Vec2, f: impl FnOnce(&TextureContext) -> T) -> T {
        let point: SurfacePoint = specimen::surface_point(Point(uv.extend(0.0)), uv);
        f(&TextureContext { point: &point, footprint: &Footprint::ZERO })
    }

    fn wavelengths() -> Wavelengths {
        Wavelengths::sample_visible(0.3)
    }

    #[test]
    fn textures_refer_to_earlier_ones_only() {
        let mut t = Textures::new();
        let unknown = FloatInput::Texture(FloatTextureId(0));
        let scale = |texture| FloatTexture::Scale { texture, scale: 1.25.into() };
        assert_eq!(t.push_float(scale(unknown)), Err(TextureError::UnknownInput));
        let image = ImageTexture::new(ImageId(0));
        assert_eq!(t.push_float(FloatTexture::Image(image)), Err(TextureError::UnknownInput));
        let spectrum =
            SpectrumTexture::Image { texture: image, colors: ColorTableId(0), reading: SpectrumUse::Albedo };
        assert_eq!(t.push_spectrum(spectrum), Err(TextureError::UnknownInput));
        let mut id = t.push_float(scale(1.0.into())).unwrap();
        for _ in 1..MAX_DEPTH {
            id = t.push_float(scale(FloatInput::Texture(id))).unwrap();
        }
        assert_eq!(t.push_float(scale(FloatInput::Texture(id))), Err(TextureError::TooDeep));
        let value = evaluate(Vec2::ZERO, |at| t.float(id, at));
        let ratio = value / 1.25_f32.powi(MAX_DEPTH as i32);
        assert!((ratio - 1.0).abs() < 1e-4, "the deepest texture is evaluated within the stack: {ratio}");
    }

    #[test]
    fn blends_weigh_as_pbrt_does() {
        let mut t = Textures::new();
        let mut float = |weight| {
            let blend =
                Blend { first: FloatInput::Constant(10.0), second: FloatInput::Constant(20.0), weight };
            t.push_float(FloatTexture::Blend(blend)).unwrap()
        };
        let mix = float(Weight::Amount(0.25.into()));
        let checker = float(Weight::Pattern(Pattern::Checkerboard(Mapping2d::UV)));
        let along = float(Weight::Pattern(Pattern::Direction(Dir::Z)));
        assert_eq!(evaluate(Vec2::ZERO, |at| t.float(mix, at)), 12.5);
        assert_eq!(
            evaluate(Vec2::new(0.5, 0.5), |at| t.float(checker, at)),
            10.0,
            "the even cell shows the first"
        );
        assert_eq!(evaluate(Vec2::new(1.5, 0.5), |at| t.float(checker, at)), 20.0);
        assert_eq!(
            evaluate(Vec2::ZERO, |at| t.float(along, at)),
            10.0,
            "along the direction the first is seen"
        );

        let one = SpectrumInput::Constant(Spectrum::Constant(0.2));
        let two = SpectrumInput::Constant(Spectrum::Constant(0.6));
        let blend = Blend { first: one, second: two, weight: Weight::Amount(FloatInput::Texture(mix)) };
        let id = t.push_spectrum(SpectrumTexture::Blend(blend)).unwrap();
        let v = evaluate(Vec2::ZERO, |at| t.spectrum(id, at, &wavelengths()));
        assert!((v[0] - (0.2 + 12.5 * 0.4)).abs() < 1e-5, "an amount beyond one extrapolates: {v:?}");
    }

    #[test]
    fn a_zero_scale_hides_whatever_is_scaled() {
        let mut t = Textures::new();
        let id = t.push_float(FloatTexture::Scale { texture: f32::NAN.into(), scale: 0.0.into() }).unwrap();
        assert_eq!(evaluate(Vec2::ZERO, |at| t.float(id, at)), 0.0);
    }

    #[test]
    fn corners_are_met_and_the_first_digit_counts_s() {
        let mut t = Textures::new();
        let corners = Corners { values: [1.0, 2.0, 3.0, 4.0], mapping: Mapping2d::UV };
        let id = t.push_float(FloatTexture::Bilinear(corners)).unwrap();
        for (s, tt, expected) in
            [(0.0, 0.0, 1.0), (0.0, 1.0, 2.0), (1.0, 0.0, 3.0), (1.0, 1.0, 4.0), (0.5, 0.5, 2.5)]
        {
            assert_eq!(evaluate(Vec2::new(s, tt), |at| t.float(id, at)), expected);
        }
    }

    fn one_texel(layout: Layout, codes: Vec<u8>) -> Pyramid {
        Pyramid::new(Image::from_u8(1, 1, layout, codes, ColorEncoding::Linear).unwrap()).unwrap()
    }

    #[test]
    fn scaling_comes_before_inversion_and_light_is_never_negative() {
        let mut t = Textures::new();
        let image = t.push_image(one_texel(Layout::Gray, vec![51]));
        let mut value = |scale, invert| {
            let texture = ImageTexture { scale, invert, ..ImageTexture::new(image) };
            let id = t.push_float(FloatTexture::Image(texture)).unwrap();
            evaluate(Vec2::ZERO, |at| t.float(id, at))
        };
        assert!((value(2.0, false) - 0.4).abs() < 1e-6);
        assert!((value(2.0, true) - 0.6).abs() < 1e-6);
        assert_eq!(value(10.0, true), 0.0);
    }

    #[test]
    fn a_cut_out_mask_reads_alpha_and_an_opaque_picture_does_not() {
        let mut t = Textures::new();
        let mut value = |codes| {
            let image = t.push_image(one_texel(Layout::Rgba, codes));
            let id = t.push_float(FloatTexture::Image(ImageTexture::new(image))).unwrap();
            evaluate(Vec2::ZERO, |at| t.float(id, at))
        };
        assert_eq!(value(vec![255, 255, 255, 51]), 0.2);
        assert!(
            (value(vec![51, 51, 51, 255]) - 0.2).abs() < 1e-6,
            "alpha that is one everywhere is no channel"
        );
    }

    #[test]
    fn pictures_of_colour_become_the_spectra_of_their_colour() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let mut t = Textures::new();
        let colors = t.push_color_space(&space, Arc::new(UpsamplingTable::build(&space)));
        let image = t.push_image(one_texel(Layout::Rgb, vec![204, 51, 102]));
        let rgb = Rgb::new(0.8, 0.2, 0.4);
        let w = wavelengths();
        let mut value = |scale, reading| {
            let texture = ImageTexture { scale, ..ImageTexture::new(image) };
            let id = t.push_spectrum(SpectrumTexture::Image { texture, colors, reading }).unwrap();
            evaluate(Vec2::ZERO, |at| t.spectrum(id, at, &w))
        };
        for (reading, exact) in [
            (SpectrumUse::Albedo, space.albedo(rgb).unwrap()),
            (SpectrumUse::Unbounded, space.unbounded(rgb)),
            (SpectrumUse::Illuminant, space.illuminant_rgb(rgb)),
        ] {
            let exact = exact.sample::<Unitless>(&w);
            let got = value(1.0, reading);
            // The table interpolates the direct fit.
            assert!(
                (0..4).all(|i| (got[i] - exact[i]).abs() < 0.03 * exact.max()),
                "{reading:?} {got:?} {exact:?}"
            );
        }
        assert!(value(100.0, SpectrumUse::Albedo).max() <= 1.0, "a reflectance is clamped");
        assert!(
            (value(3.0, SpectrumUse::Unbounded)[1] / value(1.0, SpectrumUse::Unbounded)[1] - 3.0).abs()
                < 1e-4
        );

        let marble = Marble {
            mapping: Mapping3d { texture_from_render: Transform::IDENTITY },
            octaves: Octaves { octaves: 8, roughness: 0.5 },
            scale: 1.0,
            variation: 0.2,
            colors,
        };
        let id = t.push_spectrum(SpectrumTexture::Marble(marble)).unwrap();
        for i in 0..50 {
            let v = evaluate(Vec2::splat(i as f32 * 0.17), |at| t.spectrum(id, at, &w));
            assert!(v.min() > 0.2 && v.max() < 0.95, "within the palette's 0.3 … 0.9, as spectra: {v:?}");
        }
    }

    #[test]
    fn noise_is_read_in_texture_space() {
        let mut t = Textures::new();
        let texture_from_render = Transform::translate(Vec3::new(3.25, 1.5, 0.75));
        let kind = NoiseKind::Fbm(Octaves { octaves: 1, roughness: 0.5 });
        let id =
            t.push_float(FloatTexture::Noise { mapping: Mapping3d { texture_from_render }, kind }).unwrap();
        let v = evaluate(Vec2::new(0.1, 0.2), |at| t.float(id, at));
        assert_eq!(v, noise::noise(Vec3::new(3.35, 1.7, 0.75)));
    }

    #[test]
    fn black_beyond_the_edge_is_black() {
        let mut t = Textures::new();
        let image = t.push_image(one_texel(Layout::Gray, vec![255]));
        let texture =
            ImageTexture { wrap: Wrap::BLACK, filter: ImageFilter::Point, ..ImageTexture::new(image) };
        let id = t.push_float(FloatTexture::Image(texture)).unwrap();
        // One texel is the top of its pyramid: whatever is asked, the footprint covers the picture.
        assert_eq!(evaluate(Vec2::new(0.5, 0.5), |at| t.float(id, at)), 1.0);
        let image =
            t.push_image(Pyramid::new(Image::from_f32(2, 2, Layout::Gray, vec![1.0; 4]).unwrap()).unwrap());
        let id = t.push_float(FloatTexture::Image(ImageTexture { image, ..texture })).unwrap();
        assert_eq!(evaluate(Vec2::new(1.9, 0.5), |at| t.float(id, at)), 0.0);
    }
}
