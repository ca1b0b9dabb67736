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
mod table;
pub mod tabulate;
mod tensor;
mod upsampling;
mod warp;

pub use error::MeasuredError;
pub use goniometer::GoniometerTable;
pub use merl::MerlTable;
pub use rgl::RglTable;
pub use specimens::{Synthetic, tables as synthetic_tables};
pub use table::{Format, MeasuredTable};
pub use tensor::TensorError;

use super::contract::{BsdfSample, Lobes, Mode};
use super::specimen::{Claims, Reciprocity, Specimen};
use crate::math::{LocalDir, Vec2};
use crate::spectrum::{LANES, Sampled};
use crate::units::{PdfSolidAngle, PerSteradian};
use warp::Knot;

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
