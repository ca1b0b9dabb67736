//! What a photometric file says of a luminaire.

use super::web::PhotometricWeb;

/// A luminaire as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Luminaire {
    /// What it is.
    pub label: Label,
    /// Number of lamps, at least 1.
    pub lamps: u32,
    /// Luminous flux of all bare lamps [lm]; `None` when the intensities were measured without reference to it.
    pub lamp_lumens: Option<f64>,
    /// Electric power [W]; 0 where it is not known.
    pub input_watts: f64,
    /// The luminous opening.
    pub opening: Opening,
    /// How the lamps' output depends on the tilt of the luminaire.
    pub tilt: Option<Tilt>,
    /// Intensities, with all factors of the file applied [cd].
    pub web: PhotometricWeb,
}

/// Words about a luminaire; empty where the file says nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Label {
    /// Its name or description.
    pub name: String,
    /// Its number in the maker's catalogue.
    pub number: String,
    /// Who makes it.
    pub maker: String,
    /// The measurement: number of the report.
    pub report: String,
    /// When the file was issued.
    pub date: String,
    /// The lamps.
    pub lamp: String,
}

/// The luminous opening in plan [m]; a point when both extents are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Opening {
    /// Extent along the C0–C180 plane, light space x.
    pub along_c0: f64,
    /// Extent along the C90–C270 plane, light space y.
    pub along_c90: f64,
    /// Height of luminous sides.
    pub height: f64,
    /// Outline in plan.
    pub outline: Outline,
}

/// Outline of an opening.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outline {
    /// A rectangle; a line or a point where extents are zero.
    #[default]
    Rectangle,
    /// An ellipse or circle.
    Ellipse,
}

/// How the output of a lamp depends on its tilt (IES LM-63, TILT).
#[derive(Clone, Debug, PartialEq)]
pub struct Tilt {
    /// How the lamp stands in the luminaire while that is aimed at the nadir.
    pub geometry: TiltGeometry,
    /// Angles [°], increasing.
    pub angles: Vec<f64>,
    /// Factors on the intensities, as many.
    pub factors: Vec<f64>,
}

/// Attitude of a lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TiltGeometry {
    /// Base up or down: the lamp tilts with the luminaire in any direction.
    Vertical,
    /// Horizontal, and still so when the luminaire tilts about the 90° plane's normal.
    HorizontalAlong0,
    /// Horizontal; it tilts when the luminaire does.
    HorizontalAlong90,
}

impl Tilt {
    /// The factor at a tilt of `degrees`, interpolated; beyond the table its last value.
    pub fn factor(&self, degrees: f64) -> f64 {
        let i = self.angles.partition_point(|a| *a <= degrees);
        match (i.checked_sub(1), self.angles.get(i)) {
            (None, _) => self.factors.first().copied().unwrap_or(1.0),
            (Some(last), None) => self.factors[last],
            (Some(lo), Some(hi)) => {
                let t = (degrees - self.angles[lo]) / (hi - self.angles[lo]);
                self.factors[lo] + t * (self.factors[i] - self.factors[lo])
            }
        }
    }
}

impl Luminaire {
    /// A luminaire of which only the intensities are known.
    pub fn of(web: PhotometricWeb) -> Self {
        Self {
            label: Label::default(),
            lamps: 1,
            lamp_lumens: None,
            input_watts: 0.0,
            opening: Opening::default(),
            tilt: None,
            web,
        }
    }
}

/// A number as both formats have it: the shortest decimal form that reads back the same, without an exponent.
pub(super) fn decimal(x: f64) -> String {
    // At most nine significant digits: files are for people and for readers of single precision.
    let rounded: f64 = format!("{x:.8e}").parse().unwrap_or(x);
    format!("{rounded}")
}

/// A label as one line.
pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
