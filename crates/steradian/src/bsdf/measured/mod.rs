//! Scattering as it was measured: RGL `.bsdf` files, MERL `.binary` files and goniometer tables in CSV.
//!
//! A table is read once and shared; a scattering function is the table at a path's wavelengths.

mod axis;
mod csv;
mod error;
pub mod goniometer;
pub mod merl;
pub mod rgl;
mod specimens;
pub mod tabulate;
mod tensor;
mod upsampling;
mod warp;

pub use error::MeasuredError;
pub use goniometer::GoniometerTable;
pub use merl::MerlTable;
pub use rgl::RglTable;
pub use specimens::{Synthetic, tables as synthetic_tables};
pub use tensor::TensorError;

use super::contract::{BsdfSample, Lobes, Mode};
use super::specimen::{Claims, Reciprocity, Specimen};
use crate::math::{LocalDir, Vec2};
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled};
use crate::units::{PdfSolidAngle, PerSteradian};
use warp::Knot;

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
}

impl MeasuredTable {
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

/// A measured scattering function at a path's wavelengths, alike on both sides of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    table: &'a MeasuredTable,
    lambda: [f32; LANES],
    knots: [Knot; LANES],
}

impl<'a> Measured<'a> {
    /// The scattering of `table` at `lambda` [nm]; beyond the table's wavelengths, its first or last value holds.
    pub fn new(table: &'a MeasuredTable, lambda: &[f32; LANES]) -> Self {
        let knots = match table {
            MeasuredTable::Rgl(t) => t.knots(lambda),
            MeasuredTable::Merl(_) => [Knot::default(); LANES],
            MeasuredTable::Goniometer(t) => t.knots(lambda),
        };
        Self { table, lambda: *lambda, knots }
    }

    /// f [sr⁻¹].
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        match self.table {
            MeasuredTable::Rgl(t) => t.eval(wo, wi, &self.lambda, &self.knots),
            MeasuredTable::Merl(t) => t.eval(wo, wi, &self.lambda),
            MeasuredTable::Goniometer(t) => t.eval(wo, wi, mode, &self.knots),
        }
    }

    /// Density of [`Measured::sample`].
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        match self.table {
            MeasuredTable::Rgl(t) => t.pdf(wo, wi),
            MeasuredTable::Merl(t) => t.pdf(wo, wi),
            MeasuredTable::Goniometer(t) => t.pdf(wo, wi),
        }
    }

    /// A direction drawn about in proportion to f cosθ.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        match self.table {
            MeasuredTable::Rgl(t) => t.sample(wo, u, &self.lambda, &self.knots),
            MeasuredTable::Merl(t) => t.sample(wo, uc, u, &self.lambda),
            MeasuredTable::Goniometer(t) => t.sample(wo, u, mode, &self.knots),
        }
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        match self.table {
            MeasuredTable::Rgl(_) | MeasuredTable::Merl(_) => Lobes { reflection: true, transmission: false },
            MeasuredTable::Goniometer(t) => t.lobes(),
        }
    }

    /// What holds for it: passive as any sample of matter, and as reciprocal as the measurement was.
    pub fn claims(&self) -> Claims {
        match self.table {
            MeasuredTable::Rgl(_) | MeasuredTable::Goniometer(_) => {
                Claims::CLOSED_FORM.with_reciprocity(Reciprocity::Reported)
            }
            MeasuredTable::Merl(_) => Claims::CLOSED_FORM,
        }
    }

    /// Examples for the conformance suite.
    pub fn specimens(tables: &'a [Synthetic]) -> impl Iterator<Item = Specimen<Self>> {
        tables.iter().map(|s| {
            let bsdf = Self::new(&s.table, &specimens::WAVELENGTHS);
            Specimen::new(s.name, bsdf.claims(), bsdf)
        })
    }
}

#[cfg(test)]
mod tests;
