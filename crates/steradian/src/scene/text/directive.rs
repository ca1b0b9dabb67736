//! What the parser produces: directives with their arguments, still in the words of the file.

use crate::scene::source::Span;

/// A quoted word of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// The word, without quotes and with escapes resolved.
    pub value: String,
    /// Its place, quotes included.
    pub span: Span,
}

/// One directive.
#[derive(Clone, Debug)]
pub struct Directive {
    /// What it says.
    pub statement: Statement,
    /// Its keyword.
    pub span: Span,
}

/// The directives of the language.
#[derive(Clone, Debug)]
pub enum Statement {
    /// `LookAt` eye, target, up.
    LookAt([f32; 9]),
    /// `Translate` x y z.
    Translate([f32; 3]),
    /// `Rotate` angle [degrees] and axis.
    Rotate([f32; 4]),
    /// `Scale` x y z.
    Scale([f32; 3]),
    /// `Transform` column by column.
    Transform(Box<[f32; 16]>),
    /// `ConcatTransform` column by column.
    ConcatTransform(Box<[f32; 16]>),
    /// `Identity`.
    Identity,
    /// `CoordinateSystem` name.
    CoordinateSystem(Text),
    /// `CoordSysTransform` name.
    CoordSysTransform(Text),
    /// `ActiveTransform` which.
    ActiveTransform(ActiveTransform),
    /// `TransformTimes` start end [s].
    TransformTimes([f32; 2]),
    /// `ReverseOrientation`.
    ReverseOrientation,
    /// `AttributeBegin`.
    AttributeBegin,
    /// `AttributeEnd`.
    AttributeEnd,
    /// `TransformBegin`, an old name of `AttributeBegin`.
    TransformBegin,
    /// `TransformEnd`, an old name of `AttributeEnd`.
    TransformEnd,
    /// `Attribute` target parameters.
    Attribute(Text, Params),
    /// A directive that sets or makes one thing: class name and parameters.
    Entity(Entity, Text, Params),
    /// `NamedMaterial` name.
    NamedMaterial(Text),
    /// `Texture` name, value type, class and parameters.
    Texture(Box<TextureStatement>),
    /// `MediumInterface` inside outside; the outside is the inside when left out.
    MediumInterface(Text, Text),
    /// `ObjectBegin` name.
    ObjectBegin(Text),
    /// `ObjectEnd`.
    ObjectEnd,
    /// `ObjectInstance` name.
    ObjectInstance(Text),
    /// `Include` file.
    Include(Text),
    /// `Import` file.
    Import(Text),
    /// `ColorSpace` name.
    ColorSpace(Text),
    /// `Option` name value.
    Option(Param),
    /// `WorldBegin`.
    WorldBegin,
    /// `WorldEnd`, which only pbrt-v3 had.
    WorldEnd,
}

/// The arguments of `Texture`.
#[derive(Clone, Debug)]
pub struct TextureStatement {
    /// Name that refers to it.
    pub name: Text,
    /// `float` or `spectrum`.
    pub value_type: Text,
    /// Class.
    pub class: Text,
    /// Parameters.
    pub params: Params,
}

/// Directives of the form: keyword, class name, parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entity {
    /// `Camera`.
    Camera,
    /// `Film`.
    Film,
    /// `PixelFilter`.
    PixelFilter,
    /// `Sampler`.
    Sampler,
    /// `Integrator`.
    Integrator,
    /// `Accelerator`.
    Accelerator,
    /// `Material`.
    Material,
    /// `MakeNamedMaterial`: the class is a parameter, the name comes first.
    MakeNamedMaterial,
    /// `MakeNamedMedium`: the class is a parameter, the name comes first.
    MakeNamedMedium,
    /// `Shape`.
    Shape,
    /// `LightSource`.
    LightSource,
    /// `AreaLightSource`.
    AreaLightSource,
}

impl Entity {
    /// The keyword.
    pub fn keyword(self) -> &'static str {
        match self {
            Self::Camera => "Camera",
            Self::Film => "Film",
            Self::PixelFilter => "PixelFilter",
            Self::Sampler => "Sampler",
            Self::Integrator => "Integrator",
            Self::Accelerator => "Accelerator",
            Self::Material => "Material",
            Self::MakeNamedMaterial => "MakeNamedMaterial",
            Self::MakeNamedMedium => "MakeNamedMedium",
            Self::Shape => "Shape",
            Self::LightSource => "LightSource",
            Self::AreaLightSource => "AreaLightSource",
        }
    }
}

/// Which of the two transforms of a moving scene later directives change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActiveTransform {
    /// The one at the start.
    StartTime,
    /// The one at the end.
    EndTime,
    /// Both.
    All,
}

/// The parameters of a directive.
#[derive(Clone, Debug, Default)]
pub struct Params {
    /// The parameters that could be read.
    pub list: Vec<Param>,
    /// Whether others could not (and were reported), so that absence means nothing.
    pub damaged: bool,
}

/// One parameter: `"type name"` and values.
#[derive(Clone, Debug)]
pub struct Param {
    /// Declared type.
    pub ty: ParamType,
    /// Name.
    pub name: String,
    /// The place of the declaration.
    pub span: Span,
    /// The values, of the kind and in the number that the type demands.
    pub values: Values,
    /// The place of the values, brackets included.
    pub value_span: Span,
}

/// Values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Integers.
    Integers(Vec<i32>),
    /// Finite numbers.
    Numbers(Vec<f32>),
    /// Truth values.
    Bools(Vec<bool>),
    /// Quoted words.
    Texts(Vec<Text>),
}

/// Types of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParamType {
    /// `integer`.
    Integer,
    /// `float`.
    Float,
    /// `bool`.
    Bool,
    /// `string`.
    String,
    /// `point2`.
    Point2,
    /// `vector2`.
    Vector2,
    /// `point3` or `point`.
    Point3,
    /// `vector3` or `vector`.
    Vector3,
    /// `normal3` or `normal`.
    Normal,
    /// `spectrum`.
    Spectrum,
    /// `rgb`.
    Rgb,
    /// `blackbody`.
    Blackbody,
    /// `texture`.
    Texture,
}

impl ParamType {
    /// The names of the types, aliases included.
    pub const NAMES: [&'static str; 16] = [
        "integer",
        "float",
        "bool",
        "string",
        "point2",
        "vector2",
        "point3",
        "point",
        "vector3",
        "vector",
        "normal3",
        "normal",
        "spectrum",
        "rgb",
        "blackbody",
        "texture",
    ];

    /// The type of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "integer" => Self::Integer,
            "float" => Self::Float,
            "bool" => Self::Bool,
            "string" => Self::String,
            "point2" => Self::Point2,
            "vector2" => Self::Vector2,
            "point3" | "point" => Self::Point3,
            "vector3" | "vector" => Self::Vector3,
            "normal3" | "normal" => Self::Normal,
            "spectrum" => Self::Spectrum,
            "rgb" => Self::Rgb,
            "blackbody" => Self::Blackbody,
            "texture" => Self::Texture,
            _ => return None,
        })
    }

    /// The name of the type in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Integer => "integer",
            Self::Float => "float",
            Self::Bool => "bool",
            Self::String => "string",
            Self::Point2 => "point2",
            Self::Vector2 => "vector2",
            Self::Point3 => "point3",
            Self::Vector3 => "vector3",
            Self::Normal => "normal",
            Self::Spectrum => "spectrum",
            Self::Rgb => "rgb",
            Self::Blackbody => "blackbody",
            Self::Texture => "texture",
        }
    }

    /// Number of numbers that make one value.
    pub fn arity(self) -> usize {
        match self {
            Self::Point2 | Self::Vector2 => 2,
            Self::Point3 | Self::Vector3 | Self::Normal | Self::Rgb => 3,
            Self::Integer
            | Self::Float
            | Self::Bool
            | Self::String
            | Self::Spectrum
            | Self::Blackbody
            | Self::Texture => 1,
        }
    }
}
