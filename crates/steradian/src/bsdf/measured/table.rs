//! A measurement in any of the formats.

use super::csv;
use super::error::MeasuredError;
use super::goniometer::GoniometerTable;
use super::merl::{self, MerlTable};
use super::rgl::RglTable;
use super::tensor;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN};

/// Tabulated scattering.
#[derive(Clone, Debug)]
pub enum MeasuredTable {
    /// In the adaptive parameterisation of the RGL database.
    Rgl(RglTable),
    /// In half and difference angles, as of the MERL database.
    Merl(MerlTable),
    /// On a grid of incident and scattered angles.
    Goniometer(GoniometerTable),
}

/// The formats of measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// RGL `.bsdf`.
    Rgl,
    /// MERL `.binary`.
    Merl,
    /// A goniometer table in CSV.
    Goniometer,
}

impl Format {
    /// The format that the bytes show, else the one that the `extension` of the file's name claims.
    pub fn of(bytes: &[u8], extension: Option<&str>) -> Option<Self> {
        if bytes.starts_with(tensor::MAGIC) {
            return Some(Self::Rgl);
        }
        if merl::Extents::of(bytes).is_some() {
            return Some(Self::Merl);
        }
        if csv::Text::is_one(bytes) {
            return Some(Self::Goniometer);
        }
        match extension?.to_ascii_lowercase().as_str() {
            "bsdf" => Some(Self::Rgl),
            "binary" => Some(Self::Merl),
            "csv" => Some(Self::Goniometer),
            _ => None,
        }
    }
}

impl MeasuredTable {
    /// Reads a file, given the `extension` of its name without the dot.
    ///
    /// # Errors
    /// When the bytes are no measurement of a known format, or a broken one.
    pub fn read(bytes: &[u8], extension: Option<&str>) -> Result<Self, MeasuredError> {
        match Format::of(bytes, extension) {
            Some(Format::Rgl) => Ok(Self::Rgl(RglTable::parse(bytes)?)),
            Some(Format::Merl) => Ok(Self::Merl(MerlTable::parse(bytes)?)),
            Some(Format::Goniometer) => Ok(Self::Goniometer(GoniometerTable::parse(bytes)?)),
            None => Err(MeasuredError::UnknownFormat),
        }
    }

    /// The wavelengths for which there are values [nm]: those of the file, and the film's, over which the first and the last
    /// value are held. Red, green and blue stand for the film's; a table without colour for all.
    pub fn range(&self) -> (f32, f32) {
        let nodes = match self {
            Self::Rgl(t) => t.wavelengths(),
            Self::Merl(_) => &[],
            Self::Goniometer(t) if t.wavelengths().is_empty() => return (0.0, f32::INFINITY),
            Self::Goniometer(t) => t.wavelengths(),
        };
        let (first, last) = (nodes.first().copied(), nodes.last().copied());
        (first.map_or(LAMBDA_MIN, |l| l.min(LAMBDA_MIN)), last.map_or(LAMBDA_MAX, |l| l.max(LAMBDA_MAX)))
    }
}
