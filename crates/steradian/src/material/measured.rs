//! `Material "measured"`: scattering from a file of measurements.

use super::declared::Declared;
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, Measured, MeasuredTable};
use std::sync::Arc;

/// Scattering as it was measured, without texture. The format of the file is found by its content: RGL `.bsdf`, MERL
/// `.binary`, or a goniometer table in CSV.
#[derive(Clone, Debug)]
pub struct MeasuredMaterial {
    /// The measurement.
    pub table: Arc<MeasuredTable>,
}

impl PartialEq for MeasuredMaterial {
    /// Whether both share one table.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.table, &other.table)
    }
}

impl Declared for MeasuredMaterial {
    const CLASS: &'static str = "measured";
    const PARAMETERS: &'static [Parameter] = &[Parameter::file("filename")];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let file = arguments.file("filename");
        let extension = file.path.extension().and_then(|e| e.to_str());
        let table = MeasuredTable::read(&file.bytes, extension).map_err(|e| {
            Fault::new("filename", format!("cannot read measurement {}: {e}", file.path.display()))
        })?;
        Ok(Self { table: Arc::new(table) })
    }

    fn is_textured(&self) -> bool {
        false
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::Measured(Measured::new(&self.table, lookup.lambda())))
    }
}
