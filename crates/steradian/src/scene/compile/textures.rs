//! From texture statements to the arena of textures.

use super::pictures::{self, Pictures};
use super::spectra::{Meaning, SpectrumCompiler};
use crate::color::{ColorSpaceKind, UpsamplingTables};
use crate::image::{ColorEncoding, Pyramid, Wrap};
use crate::math::{Transform, Vec2};
use crate::scene::desc::{
    self, CheckerboardDomain, FileRef, FloatParam, FloatTextureDesc, FloatTextureKind, Id, ImageTextureDesc,
    NoiseDesc, SceneDesc, SpectrumParam, SpectrumTextureDesc, SpectrumTextureKind, TextureId, WrapMode,
};
use crate::scene::diagnostic::Diagnostics;
use crate::scene::files::{FileSystem, reason};
use crate::scene::source::Span;
use crate::spectrum::Spectrum;
use crate::texture::{
    Blend, ColorTableId, Corners, FloatInput, FloatTexture, ImageFilter, ImageId, ImageTexture, Mapping2d,
    Mapping3d, Marble, NoiseKind, Octaves, Pattern, SpectrumInput, SpectrumTexture, SpectrumUse, Textures,
    Weight,
};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Fills the arena. Spectrum textures exist once per meaning that their RGB has for a parameter that uses them.
pub(super) struct TextureCompiler<'a> {
    pub(super) textures: Textures,
    pub(super) spectra: SpectrumCompiler<'a>,
    pub(super) pictures: Pictures<'a>,
    pub(super) diagnostics: &'a mut Diagnostics,
    desc: &'a SceneDesc,
    pub(super) files: &'a dyn FileSystem,
    render_from_world: Transform,
    floats: Vec<Option<FloatInput>>,
    spectrum_textures: BTreeMap<(usize, Meaning), Option<SpectrumInput>>,
    images: BTreeMap<(PathBuf, String), Option<ImageId>>,
    color_tables: [Option<ColorTableId>; 4],
}

/// Stands in for a texture that could not be compiled; its error has been reported.
const FAILED: f32 = 0.0;

impl<'a> TextureCompiler<'a> {
    /// Compiles every texture of the scene, used or not, so that every fault is reported.
    pub(super) fn new(
        desc: &'a SceneDesc,
        files: &'a dyn FileSystem,
        tables: &'a UpsamplingTables,
        render_from_world: Transform,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        let mut compiler = Self {
            textures: Textures::new(),
            spectra: SpectrumCompiler::new(files, tables, &desc.film),
            pictures: Pictures::new(files),
            diagnostics,
            desc,
            files,
            render_from_world,
            floats: vec![None; desc.float_textures.len()],
            spectrum_textures: BTreeMap::new(),
            images: BTreeMap::new(),
            color_tables: [None; 4],
        };
        // In order of definition a texture finds its inputs compiled: chains of any length need no recursion.
        for id in &desc.texture_order {
            match id {
                TextureId::Float(id) => compiler.define_float(*id),
                TextureId::Spectrum(id) => {
                    compiler.define_spectrum(*id, Meaning::Albedo);
                }
            }
        }
        compiler
    }

    /// A number that may be textured.
    pub(super) fn float(&mut self, param: &FloatParam) -> FloatInput {
        match param {
            FloatParam::Value(v) => FloatInput::Constant(*v),
            FloatParam::Texture(id) => {
                self.floats.get(id.index()).copied().flatten().unwrap_or(FloatInput::Constant(FAILED))
            }
        }
    }

    /// A spectrum that may be textured, in the meaning that the parameter gives to RGB.
    pub(super) fn spectrum(&mut self, param: &SpectrumParam, meaning: Meaning) -> SpectrumInput {
        match param {
            SpectrumParam::Value(v) => {
                SpectrumInput::Constant(self.spectra.compile(v, meaning, self.diagnostics))
            }
            SpectrumParam::Texture(id) => self
                .define_spectrum(*id, meaning)
                .unwrap_or(SpectrumInput::Constant(Spectrum::Constant(FAILED))),
        }
    }

    /// A file's bytes.
    pub(super) fn file(&mut self, file: &FileRef) -> Option<Vec<u8>> {
        let read = self.files.read(&file.path);
        read.map(|bytes| bytes.to_vec())
            .map_err(|e| {
                let message = format!("cannot read {}: {}", file.path.display(), reason(&e));
                self.diagnostics.error(file.span, message);
            })
            .ok()
    }

    /// A picture of the arena.
    pub(super) fn image(&mut self, file: &FileRef, encoding: Option<ColorEncoding>) -> Option<ImageId> {
        let key = (file.path.clone(), format!("{encoding:?}"));
        if let Some(known) = self.images.get(&key) {
            return *known;
        }
        let id = pictures::read(self.files, file, encoding, self.diagnostics).and_then(|image| {
            Pyramid::new(image)
                .map_err(|e| self.diagnostics.error(file.span, format!("{}: {e}", file.path.display())))
                .ok()
                .map(|pyramid| self.textures.push_image(pyramid))
        });
        self.images.insert(key, id);
        id
    }

    /// The arena's table of a colour space.
    fn color_table(&mut self, kind: ColorSpaceKind) -> ColorTableId {
        if let Some(id) = self.color_tables[kind as usize] {
            return id;
        }
        let table = self.spectra.table(kind);
        let id = self.textures.push_color_space(self.spectra.space(kind), table);
        self.color_tables[kind as usize] = Some(id);
        id
    }

    /// The colour space that a picture's file names; sRGB where it names none.
    fn picture_space(&self, id: ImageId) -> ColorSpaceKind {
        self.textures.image(id).map_or(ColorSpaceKind::Srgb, |p| p.level(0).color_space())
    }

    fn define_float(&mut self, id: Id<FloatTextureDesc>) {
        let desc = self.desc;
        let Some(d) = desc.float_texture(id) else { return };
        self.floats[id.index()] = self.float_texture(d);
    }

    fn float_texture(&mut self, d: &FloatTextureDesc) -> Option<FloatInput> {
        let space = self.texture_from_render(&d.world_from_texture);
        let texture = match &d.kind {
            FloatTextureKind::Constant { value } => return Some(self.float(value)),
            FloatTextureKind::Scale { tex, scale } => {
                FloatTexture::Scale { texture: self.float(tex), scale: self.float(scale) }
            }
            FloatTextureKind::Mix { tex1, tex2, amount } => {
                let weight = Weight::Amount(self.float(amount));
                self.float_blend(tex1, tex2, weight)
            }
            FloatTextureKind::DirectionMix { tex1, tex2, dir } => {
                let weight = self.direction(*dir, d.span)?;
                self.float_blend(tex1, tex2, weight)
            }
            FloatTextureKind::Checkerboard { tex1, tex2, domain } => {
                let weight = Weight::Pattern(checkerboard(domain, &space));
                self.float_blend(tex1, tex2, weight)
            }
            // The weight is that of the second input: what lies inside the dots.
            FloatTextureKind::Dots { inside, outside, mapping } => {
                let weight = Weight::Pattern(Pattern::Dots(mapping_2d(mapping, &space)));
                self.float_blend(outside, inside, weight)
            }
            FloatTextureKind::Bilerp { v, mapping } => {
                FloatTexture::Bilinear(Corners { values: *v, mapping: mapping_2d(mapping, &space) })
            }
            FloatTextureKind::Image(image) => FloatTexture::Image(self.image_texture(image, &space)?),
            FloatTextureKind::Fbm(noise) => noise_texture(NoiseKind::Fbm(octaves(noise)), space),
            FloatTextureKind::Wrinkled(noise) => noise_texture(NoiseKind::Wrinkled(octaves(noise)), space),
            FloatTextureKind::Windy => noise_texture(NoiseKind::Windy, space),
        };
        let pushed = self.textures.push_float(texture).map(FloatInput::Texture);
        pushed.map_err(|e| self.diagnostics.error(d.span, e.to_string())).ok()
    }

    fn float_blend(&mut self, first: &FloatParam, second: &FloatParam, weight: Weight) -> FloatTexture {
        FloatTexture::Blend(Blend { first: self.float(first), second: self.float(second), weight })
    }

    fn define_spectrum(&mut self, id: Id<SpectrumTextureDesc>, meaning: Meaning) -> Option<SpectrumInput> {
        let key = (id.index(), meaning);
        if let Some(known) = self.spectrum_textures.get(&key) {
            return known.clone();
        }
        // Another meaning of a texture that failed fails alike; its error is known already.
        let failed = meaning != Meaning::Albedo
            && matches!(self.spectrum_textures.get(&(id.index(), Meaning::Albedo)), Some(None));
        let desc = self.desc;
        let defined = if failed {
            None
        } else {
            desc.spectrum_texture(id).and_then(|d| self.spectrum_texture(d, meaning))
        };
        self.spectrum_textures.insert(key, defined.clone());
        defined
    }

    fn spectrum_texture(&mut self, d: &SpectrumTextureDesc, meaning: Meaning) -> Option<SpectrumInput> {
        let space = self.texture_from_render(&d.world_from_texture);
        let texture = match &d.kind {
            SpectrumTextureKind::Constant { value } => return Some(self.spectrum(value, meaning)),
            SpectrumTextureKind::Scale { tex, scale } => {
                SpectrumTexture::Scale { texture: self.spectrum(tex, meaning), scale: self.float(scale) }
            }
            SpectrumTextureKind::Mix { tex1, tex2, amount } => {
                let weight = Weight::Amount(self.float(amount));
                self.spectrum_blend(tex1, tex2, weight, meaning)
            }
            SpectrumTextureKind::DirectionMix { tex1, tex2, dir } => {
                let weight = self.direction(*dir, d.span)?;
                self.spectrum_blend(tex1, tex2, weight, meaning)
            }
            SpectrumTextureKind::Checkerboard { tex1, tex2, domain } => {
                let weight = Weight::Pattern(checkerboard(domain, &space));
                self.spectrum_blend(tex1, tex2, weight, meaning)
            }
            SpectrumTextureKind::Dots { inside, outside, mapping } => {
                let weight = Weight::Pattern(Pattern::Dots(mapping_2d(mapping, &space)));
                self.spectrum_blend(outside, inside, weight, meaning)
            }
            SpectrumTextureKind::Bilerp { v, mapping } => {
                let values = v.each_ref().map(|p| match self.spectrum(p, meaning) {
                    SpectrumInput::Constant(s) => s,
                    // The importer admits constants only.
                    SpectrumInput::Texture(_) => Spectrum::Constant(FAILED),
                });
                let mapping = mapping_2d(mapping, &space);
                SpectrumTexture::Bilinear(Corners { values: Box::new(values), mapping })
            }
            SpectrumTextureKind::Image(image) => {
                let texture = self.image_texture(image, &space)?;
                let reading = match meaning {
                    Meaning::Albedo => SpectrumUse::Albedo,
                    Meaning::Unbounded => SpectrumUse::Unbounded,
                    Meaning::Illuminant => SpectrumUse::Illuminant,
                };
                let colors = self.color_table(self.picture_space(texture.image));
                SpectrumTexture::Image { texture, colors, reading }
            }
            SpectrumTextureKind::Marble { noise, scale, variation } => SpectrumTexture::Marble(Marble {
                mapping: Mapping3d { texture_from_render: space },
                octaves: octaves(noise),
                scale: *scale,
                variation: *variation,
                colors: self.color_table(ColorSpaceKind::Srgb),
            }),
        };
        let pushed = self.textures.push_spectrum(texture).map(SpectrumInput::Texture);
        pushed.map_err(|e| self.diagnostics.error(d.span, e.to_string())).ok()
    }

    fn spectrum_blend(
        &mut self,
        first: &SpectrumParam,
        second: &SpectrumParam,
        weight: Weight,
        meaning: Meaning,
    ) -> SpectrumTexture {
        let (first, second) = (self.spectrum(first, meaning), self.spectrum(second, meaning));
        SpectrumTexture::Blend(Blend { first, second, weight })
    }

    fn direction(&mut self, world: crate::math::Dir, span: Span) -> Option<Weight> {
        let direction = self.render_from_world.direction(world);
        if direction.is_none() {
            self.diagnostics.error(span, "the direction has no length in the space of the camera");
        }
        direction.map(|d| Weight::Pattern(Pattern::Direction(d)))
    }

    fn texture_from_render(&self, world_from_texture: &Transform) -> Transform {
        world_from_texture.inverse() * self.render_from_world.inverse()
    }

    fn image_texture(&mut self, d: &ImageTextureDesc, space: &Transform) -> Option<ImageTexture> {
        Some(ImageTexture {
            image: self.image(&d.file, d.encoding)?,
            mapping: mapping_2d(&d.mapping, space),
            filter: match d.filter {
                desc::ImageFilter::Point => ImageFilter::Point,
                desc::ImageFilter::Bilinear => ImageFilter::Bilinear,
                desc::ImageFilter::Trilinear => ImageFilter::Trilinear,
                desc::ImageFilter::Ewa => ImageFilter::Ewa { max_anisotropy: d.max_anisotropy },
            },
            wrap: match d.wrap {
                WrapMode::Repeat => Wrap::REPEAT,
                WrapMode::Black => Wrap::BLACK,
                WrapMode::Clamp => Wrap::CLAMP,
                WrapMode::OctahedralSphere => Wrap::OctahedralSphere,
            },
            scale: d.scale,
            invert: d.invert,
        })
    }
}

fn checkerboard(domain: &CheckerboardDomain, space: &Transform) -> Pattern {
    match domain {
        CheckerboardDomain::Plane(mapping) => Pattern::Checkerboard(mapping_2d(mapping, space)),
        CheckerboardDomain::Space => Pattern::Checkerboard3d(Mapping3d { texture_from_render: *space }),
    }
}

fn noise_texture(kind: NoiseKind, texture_from_render: Transform) -> FloatTexture {
    FloatTexture::Noise { mapping: Mapping3d { texture_from_render }, kind }
}

fn octaves(noise: &NoiseDesc) -> Octaves {
    Octaves { octaves: noise.octaves, roughness: noise.roughness }
}

fn mapping_2d(mapping: &desc::Mapping2d, texture_from_render: &Transform) -> Mapping2d {
    let texture_from_render = *texture_from_render;
    match mapping {
        desc::Mapping2d::Uv { scale, delta } => {
            Mapping2d::Uv { scale: Vec2::from_array(*scale), delta: Vec2::from_array(*delta) }
        }
        desc::Mapping2d::Spherical => Mapping2d::Spherical { texture_from_render },
        desc::Mapping2d::Cylindrical => Mapping2d::Cylindrical { texture_from_render },
        desc::Mapping2d::Planar { v1, v2, delta } => {
            Mapping2d::Planar { texture_from_render, v1: *v1, v2: *v2, delta: Vec2::from_array(*delta) }
        }
    }
}
