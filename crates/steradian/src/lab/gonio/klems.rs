//! Klems matrices as the XML of LBNL WINDOW, which Radiance and EnergyPlus read.
//!
//! The file holds f̄ [sr⁻¹], without cosine, of power from every cell of the full Klems basis into every cell, for light from
//! either side: the values times the projected solid angles of a column's cells sum to ρ or τ.
//!
//! * In each matrix a row is a cell that light leaves to, a column one that it comes from (`IncidentDataStructure` `Columns`),
//!   and the text runs through the columns of the first row, then of the second, and so on.
//! * Azimuths of outgoing cells are those of their directions; those of incident cells are turned by half a circle, so that
//!   mirror reflection and straight transmission lie on the diagonal.
//! * Our front, the side of +z, is the room's side: WINDOW and the file call it "Back", and Radiance, which turns the names
//!   again, has it as its front (+z). So the file is what Radiance's `genBSDF` writes for the same geometry.
//! * Discrete directions have no f: their flux is spread over the cell that they lie in.

use super::beam::{Face, Incidence};
use super::cells::CellGrid;
use super::reading::Reading;
use crate::bsdf::Side;
use crate::spectrum::{blackbody, cie, named};
use std::fmt::Write as _;

/// Temperature of a black body with the Sun's total exitance [K] (IAU 2015 Resolution B3).
const SUN: f64 = 5772.0;

/// Why no matrices can be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KlemsError {
    /// Matrices need light from all cells of the basis to all of its cells.
    #[error(
        "Klems matrices need readings of the full Klems basis for light from each of its cells, on the {0}"
    )]
    Incomplete(&'static str),
    /// Two readings that do not belong together.
    #[error("the readings of both sides are of different wavelengths")]
    Wavelengths,
    /// No wavelength is visible.
    #[error("no wavelength of the reading is visible, which WINDOW's files begin with")]
    Invisible,
}

/// A weighting of wavelengths.
struct Band {
    name: &'static str,
    source: String,
    detector: &'static str,
    /// Share of each wavelength; they sum to one.
    shares: Vec<f64>,
}

/// The matrices of light from every cell on either side, for one way that light goes.
struct Matrix<'r> {
    direction: &'static str,
    kind: &'static str,
    reading: &'r Reading,
    side: Side,
}

/// The text of the file: the visible matrices, weighted with V(λ) and CIE illuminant D65, and the solar ones, weighted with a
/// black body of 5772 K over the wavelengths of the readings.
///
/// # Errors
/// When either reading is not one of the full Klems basis for light from each of its cells, or nothing is visible.
pub fn klems_xml(name: &str, front: &Reading, back: &Reading) -> Result<String, KlemsError> {
    for (reading, face) in [(front, Face::Front), (back, Face::Back)] {
        let from_all = reading.beams.len() == reading.grid.len()
            && reading.beams.iter().enumerate().all(|(i, b)| b.incidence == Incidence::Cell(i));
        if reading.grid != CellGrid::klems() || !from_all || reading.face != face {
            return Err(KlemsError::Incomplete(face.name()));
        }
    }
    if front.wavelengths != back.wavelengths {
        return Err(KlemsError::Wavelengths);
    }
    let bands = bands(&front.wavelengths).ok_or(KlemsError::Invisible)?;
    let mut xml = String::new();
    // Writing to a String cannot fail.
    let _ = write!(xml, "{}", head(name, &front.grid));
    let matrices = [
        Matrix { direction: "Transmission Front", kind: "BTDF", reading: back, side: Side::Transmission },
        Matrix { direction: "Transmission Back", kind: "BTDF", reading: front, side: Side::Transmission },
        Matrix { direction: "Reflection Front", kind: "BRDF", reading: back, side: Side::Reflection },
        Matrix { direction: "Reflection Back", kind: "BRDF", reading: front, side: Side::Reflection },
    ];
    for band in &bands {
        for matrix in &matrices {
            matrix.write(&mut xml, band);
        }
    }
    xml.push_str("    </Layer>\n  </Optical>\n</WindowElement>\n");
    Ok(xml)
}

fn bands(wavelengths: &[f32]) -> Option<[Band; 2]> {
    let daylight = named("stdillum-D65")?;
    let visible = shares(wavelengths, |l| f64::from(daylight.at(l)) * f64::from(cie::y_bar(l)))?;
    let solar = shares(wavelengths, |l| blackbody::planck(f64::from(l), SUN))?;
    let [first, last] = [wavelengths.first()?, wavelengths.last()?];
    Some([
        Band {
            name: "Solar",
            source: format!("Black body of {SUN} K, {first} to {last} nm"),
            detector: "None",
            shares: solar,
        },
        Band {
            name: "Visible",
            source: "CIE Illuminant D65".to_owned(),
            detector: "CIE 1931 Y",
            shares: visible,
        },
    ])
}

/// Weights at the wavelengths by the trapezoidal rule, which sum to one; `None` when all are zero.
fn shares(wavelengths: &[f32], weight: impl Fn(f32) -> f64) -> Option<Vec<f64>> {
    let n = wavelengths.len();
    let width = |i: usize| match n {
        1 => 1.0,
        _ => f64::from(wavelengths[(i + 1).min(n - 1)] - wavelengths[i.saturating_sub(1)]),
    };
    let all: Vec<f64> = (0..n).map(|i| weight(wavelengths[i]) * width(i)).collect();
    let sum = all.iter().sum::<f64>();
    (sum > 0.0).then(|| all.iter().map(|w| w / sum).collect())
}

impl Matrix<'_> {
    fn write(&self, xml: &mut String, band: &Band) {
        let _ = write!(
            xml,
            "      <WavelengthData>
        <LayerNumber>System</LayerNumber>
        <Wavelength unit=\"Integral\">{}</Wavelength>
        <SourceSpectrum>{}</SourceSpectrum>
        <DetectorSpectrum>{}</DetectorSpectrum>
        <WavelengthDataBlock>
          <WavelengthDataDirection>{}</WavelengthDataDirection>
          <ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis>
          <RowAngleBasis>LBNL/Klems Full</RowAngleBasis>
          <ScatteringDataType>{}</ScatteringDataType>
          <ScatteringData>\n",
            band.name, band.source, band.detector, self.direction, self.kind
        );
        let n = self.reading.grid.len();
        for row in 0..n {
            let values: Vec<String> =
                (0..n).map(|column| format!("{:.6e}", self.value(row, column, band))).collect();
            let _ = writeln!(xml, "{}", values.join(","));
        }
        xml.push_str(
            "          </ScatteringData>\n        </WavelengthDataBlock>\n      </WavelengthData>\n",
        );
    }

    fn value(&self, row: usize, column: usize, band: &Band) -> f64 {
        // Every ring of the basis has an even number of cells, but for the cap.
        let from = self.reading.grid.opposite(column).unwrap_or(column);
        let flux: f64 = self.reading.beams[from]
            .spectra
            .iter()
            .zip(&band.shares)
            .map(|(s, share)| s.cells(self.side).get(row).map_or(0.0, |c| c.total().value) * share)
            .sum();
        // Random walks may weigh less than nothing by chance; a file may not.
        flux.max(0.0) / self.reading.grid.projected_solid_angle(row)
    }
}

fn head(name: &str, grid: &CellGrid) -> String {
    let name = name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut blocks = String::new();
    for ring in grid.rings() {
        let [lower, upper] = ring.theta;
        let theta = if ring.cells == 1 { lower } else { 0.5 * (lower + upper) };
        let _ = write!(
            blocks,
            "          <AngleBasisBlock>
            <Theta>{theta}</Theta>
            <nPhis>{}</nPhis>
            <ThetaBounds>
              <LowerTheta>{lower}</LowerTheta>
              <UpperTheta>{upper}</UpperTheta>
            </ThetaBounds>
          </AngleBasisBlock>\n",
            ring.cells
        );
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<WindowElement xmlns=\"http://windows.lbl.gov\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">
  <!-- Written by Steradian. Values in 1/sr, without cosine. \"Back\" is the side of the sample's +z. -->
  <WindowElementType>System</WindowElementType>
  <FileType>BSDF</FileType>
  <Optical>
    <Layer>
      <Material>
        <Name>{name}</Name>
        <Manufacturer>unknown</Manufacturer>
        <DeviceType>Other</DeviceType>
      </Material>
      <DataDefinition>
        <IncidentDataStructure>Columns</IncidentDataStructure>
        <AngleBasis>
          <AngleBasisName>LBNL/Klems Full</AngleBasisName>
{blocks}        </AngleBasis>
      </DataDefinition>\n"
    )
}
