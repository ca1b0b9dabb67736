//! Why a file is no measurement.

use super::tensor::TensorError;
use thiserror::Error;

/// Why a file was refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeasuredError {
    /// Neither content nor extension is one of the known formats.
    #[error("this is neither an RGL .bsdf file, nor a MERL .binary file, nor a goniometer table in CSV")]
    UnknownFormat,
    /// The container of an RGL file is broken or lacks a field.
    #[error(transparent)]
    Tensor(#[from] TensorError),
    /// A field of an RGL file holds a value that makes no sense there.
    #[error("field `{field}` has {what}")]
    Field {
        /// The field.
        field: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// The extents at the start of a MERL file do not account for its length.
    #[error("this is no MERL file: its first 12 bytes are not the extents of a table of {bytes} bytes")]
    MerlSize {
        /// Length of the file [B].
        bytes: usize,
    },
    /// A MERL file holds a number that is not finite.
    #[error("value {index} of {channel} is not finite")]
    MerlValue {
        /// Red, green or blue.
        channel: &'static str,
        /// Position in the channel, from 0.
        index: usize,
    },
    /// A MERL file holds no light at all.
    #[error("no value is above zero")]
    Black,
    /// Wavelengths are held at the ends of the file's range, which must hold most of the visible light.
    #[error("the wavelengths {first}–{last} nm do not cover 420–680 nm, and nothing is extrapolated")]
    Coverage {
        /// First wavelength [nm].
        first: f32,
        /// Last wavelength [nm].
        last: f32,
    },
    /// A place in a table's text.
    #[error("line {line}, column {column}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Character in the line, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// A table's rows do not fill its grid.
    #[error("{0}")]
    Grid(String),
}

/// Wavelengths [nm] that a measurement must reach; between them lies 99.7 % of the luminance of daylight.
const NEEDED: [f32; 2] = [420.0, 680.0];

/// Whether `wavelengths` [nm], which increase, reach far enough to hold their ends over the rest.
pub(super) fn check_coverage(wavelengths: &[f32]) -> Result<(), MeasuredError> {
    match wavelengths {
        [first, .., last] if *first <= NEEDED[0] && *last >= NEEDED[1] => Ok(()),
        [first, .., last] => Err(MeasuredError::Coverage { first: *first, last: *last }),
        _ => {
            let only = wavelengths.first().copied().unwrap_or_default();
            Err(MeasuredError::Coverage { first: only, last: only })
        }
    }
}
