//! How far readings are from Helmholtz reciprocity, B (2.18): reported, not averaged away.

use super::beam::Incidence;
use super::reading::{Beam, CellFlux, Reading, Scattered};
use crate::bsdf::Side;
use crate::units::Estimate;

/// Rounding of single-precision scattering functions, as a share of f.
const ROUNDING: f64 = 2e-6;

/// Differences f̄(i→j) − f̄(j→i) over pairs of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Number of pairs that something was scattered between.
    pub pairs: u64,
    /// Largest difference in its standard errors: with chance alone, about √(2 ln n) for n pairs.
    pub worst: f64,
    /// Root mean square of the differences in their standard errors: with chance alone, at most about 1. Bounds of cells that
    /// hardly any light came to are wide, and make it less.
    pub rms: f64,
    /// Root mean square of the differences over that of f̄.
    pub relative: f64,
}

/// Residuals of one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reciprocity {
    /// Of reflection.
    pub reflection: Residual,
    /// Of transmission, for a sample between like media; `None` when it was not measured from both sides, or passes nothing.
    pub transmission: Option<Residual>,
}

/// The residuals at each wavelength, for light from every cell of the grid; `None` for other directions of incidence.
///
/// `other` is the same sample with light from the other side.
pub fn reciprocity(reading: &Reading, other: Option<&Reading>) -> Option<Vec<Reciprocity>> {
    let beams = by_cell(reading)?;
    let back = other
        .filter(|o| o.face != reading.face && o.grid == reading.grid)
        .and_then(|o| Some((o, by_cell(o)?)));
    let at = |index: usize| {
        let reflection = residual(reading, &beams, reading, &beams, Side::Reflection, index);
        let passes = beams.iter().any(|b| !b.spectra[index].transmitted.is_empty());
        let back = back.as_ref().filter(|_| passes);
        let transmission =
            back.map(|(o, back)| residual(reading, &beams, o, back, Side::Transmission, index));
        Reciprocity { reflection, transmission }
    };
    Some((0..reading.wavelengths.len()).map(at).collect())
}

/// The beams in the order of the cells that they come from.
fn by_cell(reading: &Reading) -> Option<Vec<&Beam>> {
    let mut beams = vec![None; reading.grid.len()];
    for beam in &reading.beams {
        let Incidence::Cell(cell) = beam.incidence else { return None };
        *beams.get_mut(cell)? = Some(beam).filter(|b| b.spectra.len() == reading.wavelengths.len());
    }
    beams.into_iter().collect()
}

fn residual(a: &Reading, to: &[&Beam], b: &Reading, fro: &[&Beam], side: Side, index: usize) -> Residual {
    let (mut sum, mut difference, mut square) = (0.0, 0.0, 0.0);
    let mut found = Residual::default();
    let one_way = a.face == b.face && side == Side::Reflection;
    for (i, forth) in to.iter().enumerate() {
        for (j, back) in fro.iter().enumerate().skip(if one_way { i + 1 } else { 0 }) {
            let (forth, back) = (&forth.spectra[index], &back.spectra[index]);
            let read = |r: &Reading, s: &Scattered, cell: usize| {
                let flux = s.cells(side).get(cell).map_or(Estimate::exact(0.0), CellFlux::total);
                let f = r.mean_f(cell, flux);
                (f.value, r.standard_error(s, f))
            };
            let ((f, e), (g, h)) = (read(a, forth, j), read(b, back, i));
            let error = e.hypot(h).hypot(ROUNDING * f.max(g));
            if f == 0.0 && g == 0.0 {
                continue;
            }
            let z = (f - g).abs() / error;
            found.pairs += 1;
            found.worst = found.worst.max(z);
            square += z * z;
            difference += (f - g).powi(2);
            sum += 0.5 * (f * f + g * g);
        }
    }
    if found.pairs > 0 {
        found.rms = (square / found.pairs as f64).sqrt();
        found.relative = (difference / sum).sqrt();
    }
    found
}
