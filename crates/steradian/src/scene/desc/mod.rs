//! What the user wrote, validated and typed. Holds no textures, no hierarchy, no converted spectra, and no names
//! past the point where they are resolved: entities refer to each other by [`Id`].

pub mod camera;
pub mod film;
pub mod id;
pub mod integrator;
pub mod light;
pub mod material;
pub mod medium;
pub mod options;
pub mod sampler;
pub mod shape;
pub mod sky;
pub mod texture;
pub mod value;

pub use camera::{CameraDesc, CameraKind, ProjectionDesc, SphericalMapping};
pub use film::{FilmDesc, FilmKind, FilterDesc, FilterKind, GBufferSpace, SensorDesc, SensorResponse};
pub use id::Id;
pub use integrator::{AmbientDesc, ClassicDesc, IntegratorDesc, IntegratorKind, LightSamplerKind, PathDesc};
pub use light::{AreaLightDesc, AreaRadiance, LightDesc, LightKind, Normalization, OpeningDesc};
pub use material::{ArgumentDesc, ArgumentValue, MaterialDesc};
pub use medium::{MediumCoefficients, MediumDesc, MediumEmission, MediumInterface, MediumKind};
pub use options::{OptionsDesc, RenderingSpace};
pub use sampler::{MAX_SAMPLES, NoiseTarget, Randomization, SamplerDesc, SamplerKind};
pub use shape::{CurveBasis, CurveDesc, CurveKind, InstanceDesc, MeshDesc, ObjectDesc, ShapeDesc, ShapeKind};
pub use sky::{HorizonDesc, SkyDesc, SkyKindDesc, SunDesc, SunPlaceDesc, SunPositionDesc};
pub use texture::{
    CheckerboardDomain, FloatParam, FloatTextureDesc, FloatTextureKind, ImageFilter, ImageTextureDesc,
    Mapping2d, NoiseDesc, SpectrumParam, SpectrumTextureDesc, SpectrumTextureKind, TextureDesc, TextureId,
    WrapMode,
};
pub use value::{FileRef, SpectrumDesc, SpectrumValue};

use crate::scene::source::Span;

/// A whole scene as plain data. Every [`Id`] in it is in range.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// Settings.
    pub options: OptionsDesc,
    /// Camera.
    pub camera: CameraDesc,
    /// Film.
    pub film: FilmDesc,
    /// Pixel filter.
    pub filter: FilterDesc,
    /// Sampler.
    pub sampler: SamplerDesc,
    /// Integrator.
    pub integrator: IntegratorDesc,
    /// Textures of numbers.
    pub float_textures: Vec<FloatTextureDesc>,
    /// Textures of spectra.
    pub spectrum_textures: Vec<SpectrumTextureDesc>,
    /// All textures in order of definition: a texture refers only to earlier ones of this list.
    pub texture_order: Vec<TextureId>,
    /// Materials; the first is the default of shapes that state none.
    pub materials: Vec<MaterialDesc>,
    /// Media.
    pub media: Vec<MediumDesc>,
    /// Lights that are not surfaces.
    pub lights: Vec<LightDesc>,
    /// Emission of surfaces; one entry may serve many shapes.
    pub area_lights: Vec<AreaLightDesc>,
    /// Shapes that stand in the world.
    pub shapes: Vec<ShapeDesc>,
    /// Groups of shapes that instances place.
    pub objects: Vec<ObjectDesc>,
    /// Placements of objects.
    pub instances: Vec<InstanceDesc>,
    /// The start of the last main file, for what concerns the scene as a whole.
    pub span: Span,
    /// Hash of the text that this was read from.
    pub content_hash: u64,
}

impl SceneDesc {
    /// The material of that id; `None` for an id of another scene.
    pub fn material(&self, id: Id<MaterialDesc>) -> Option<&MaterialDesc> {
        self.materials.get(id.index())
    }

    /// The texture of numbers of that id; `None` for an id of another scene.
    pub fn float_texture(&self, id: Id<FloatTextureDesc>) -> Option<&FloatTextureDesc> {
        self.float_textures.get(id.index())
    }

    /// The texture of spectra of that id; `None` for an id of another scene.
    pub fn spectrum_texture(&self, id: Id<SpectrumTextureDesc>) -> Option<&SpectrumTextureDesc> {
        self.spectrum_textures.get(id.index())
    }
}
