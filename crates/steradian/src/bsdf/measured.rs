//! Scattering as it was measured.

use super::contract::{BsdfSample, Lobes};
use super::specimen::{Claims, Specimen};
use crate::math::{LocalDir, Vec2};
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian};

/// Tabulated scattering.
#[derive(Debug)]
pub enum MeasuredTable {}

/// A measured scattering function at a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    table: &'a MeasuredTable,
}

impl<'a> Measured<'a> {
    /// f [sr⁻¹].
    pub fn eval(&self, _wo: LocalDir, _wi: LocalDir) -> Sampled<PerSteradian> {
        match *self.table {}
    }

    /// Density of [`Measured::sample`].
    pub fn pdf(&self, _wo: LocalDir, _wi: LocalDir) -> PdfSolidAngle {
        match *self.table {}
    }

    /// A direction drawn about in proportion to f cosθ.
    pub fn sample(&self, _wo: LocalDir, _u: Vec2) -> Option<BsdfSample> {
        match *self.table {}
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        match *self.table {}
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        match *self.table {}
    }

    /// Examples for the conformance suite.
    pub fn specimens(tables: &'a [MeasuredTable]) -> impl Iterator<Item = Specimen<Self>> {
        tables.iter().map(|t| match *t {})
    }
}
