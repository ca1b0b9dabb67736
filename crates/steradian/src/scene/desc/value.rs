//! Values of parameters: spectra, files.

use crate::color::ColorSpaceKind;
use crate::scene::source::Span;
use std::path::PathBuf;

/// A function of wavelength as the scene states it, not yet converted.
///
/// What an RGB triple means (albedo, unbounded, illuminant) follows from the parameter that holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumDesc {
    /// The statement.
    pub value: SpectrumValue,
    /// The place of the value, or of the entity when the value is a default.
    pub span: Span,
}

/// The ways to state a function of wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumValue {
    /// The same value at every wavelength.
    Constant(f32),
    /// A colour, finite. In [0,1] where it states an albedo, not negative elsewhere.
    Rgb {
        /// Components.
        rgb: [f32; 3],
        /// The space in force at the directive.
        color_space: ColorSpaceKind,
    },
    /// Planck's law, normalised to maximum 1.
    Blackbody {
        /// Temperature [K], > 0.
        kelvin: f32,
    },
    /// Samples, linearly interpolated; wavelengths strictly increasing, at least one.
    Samples {
        /// Wavelengths [nm].
        lambda: Vec<f32>,
        /// Values, as many.
        values: Vec<f32>,
    },
    /// A spectrum that the library knows by name.
    Named(String),
    /// A text file of wavelength-value pairs.
    File(PathBuf),
    /// The white of a colour space: the default of lights.
    Illuminant(ColorSpaceKind),
}

/// A file that the scene refers to, resolved against the folder of the main scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileRef {
    /// Path to open.
    pub path: PathBuf,
    /// The place of the name.
    pub span: Span,
}
