//! Probability densities that say their measure.

/// Density with respect to solid angle [sr⁻¹].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PdfSolidAngle(pub f32);

/// Density with respect to surface area [m⁻²; scene units⁻²].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PdfArea(pub f32);

impl PdfArea {
    /// Converts at a point `distance_squared` away whose normal makes `cos` with the connecting line:
    /// dω = dA cosθ / r², A (14). A grazing surface (cos = 0) subtends nothing: the density is infinite.
    pub fn to_solid_angle(self, distance_squared: f32, cos: f32) -> PdfSolidAngle {
        PdfSolidAngle(self.0 * distance_squared / cos.abs())
    }
}

/// How a direction was chosen: from a density, or as the only one possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// From a continuum of directions.
    SolidAngle(PdfSolidAngle),
    /// A discrete direction; the probability of having chosen it is part of the sample's weight.
    Delta,
}

impl Density {
    /// Whether the direction is discrete.
    pub fn is_delta(self) -> bool {
        matches!(self, Self::Delta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn area_density_converts_by_foreshortening() {
        // A patch of 4 m² at 10 m, tilted by 60°, subtends 4·0.5/100 = 0.02 sr.
        let pdf = PdfArea(1.0 / 4.0).to_solid_angle(100.0, 0.5);
        assert!((pdf.0 - 50.0).abs() < 1e-4);
    }
}
