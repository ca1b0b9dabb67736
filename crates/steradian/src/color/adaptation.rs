//! White: daylight, thermal white, and the adaptation from one white to another.

use super::triple::{Chromaticity, Xyz};
use crate::spectrum::{LAMBDA_MIN, Tabulated, blackbody, cie};
use crate::units::Kelvin;
use glam::DMat3;

/// Components S₀, S₁, S₂ of daylight, 300–830 nm at 5 nm.
static DAYLIGHT: [[f32; 3]; 107] = include!("../../data/cie_daylight.rs");

/// Daylight of a correlated colour temperature: relative spectral power, 100 at 560 nm.
///
/// CIE 15:2018, 4.1.2, for 4000–25000 K; below, down to 1000 K, as far as the formula stays positive, else
/// `None`. The temperature counts on today's scale: D65 is 6504 K.
pub fn daylight(temperature: Kelvin) -> Option<Tabulated> {
    let Chromaticity { x, y } = daylight_chromaticity(temperature)?;
    let (x, y) = (f64::from(x), f64::from(y));
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    let pairs: Vec<_> = DAYLIGHT
        .iter()
        .enumerate()
        .map(|(i, s)| {
            let [s0, s1, s2] = s.map(f64::from);
            (300.0 + 5.0 * i as f32, (s0 + m1 * s1 + m2 * s2) as f32)
        })
        .collect();
    if pairs.iter().any(|p| p.1 < 0.0) {
        return None;
    }
    Tabulated::new(&pairs).ok()
}

/// Chromaticity of daylight, CIE 15:2018, 4.1.2; `None` outside 1000–25000 K.
pub fn daylight_chromaticity(temperature: Kelvin) -> Option<Chromaticity> {
    let t = f64::from(temperature.0);
    if !(1000.0..=25_000.0).contains(&t) {
        return None;
    }
    let x = if t <= 7000.0 {
        -4.6070e9 / (t * t * t) + 2.9678e6 / (t * t) + 0.09911e3 / t + 0.244_063
    } else {
        -2.0064e9 / (t * t * t) + 1.9018e6 / (t * t) + 0.24748e3 / t + 0.237_040
    };
    let y = -3.000 * x * x + 2.870 * x - 0.275;
    Some(Chromaticity::new(x as f32, y as f32))
}

/// Chromaticity of a black body; `None` at or below 0 K.
pub fn planck_chromaticity(temperature: Kelvin) -> Option<Chromaticity> {
    let t = f64::from(temperature.0);
    let mut sum = [0.0_f64; 3];
    for (i, bar) in cie::table().iter().enumerate() {
        let l = blackbody::planck(f64::from(LAMBDA_MIN) + i as f64, t);
        for (s, &b) in sum.iter_mut().zip(bar) {
            *s += l * f64::from(b);
        }
    }
    let total: f64 = sum.iter().sum();
    (total > 0.0).then(|| Chromaticity::new((sum[0] / total) as f32, (sum[1] / total) as f32))
}

/// Cone responses by which whites are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConeModel {
    /// Bradford (Lam 1985), pbrt's choice.
    Bradford,
    /// Hunt–Pointer–Estévez, normalised to D65: von Kries' own idea.
    VonKries,
}

impl ConeModel {
    /// Rows: responses to X, Y, Z.
    fn from_xyz(self) -> DMat3 {
        let rows = match self {
            Self::Bradford => {
                [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
            }
            Self::VonKries => {
                [[0.40024, 0.70760, -0.08081], [-0.22630, 1.16532, 0.04570], [0.0, 0.0, 0.91822]]
            }
        };
        DMat3::from_cols_array_2d(&rows).transpose()
    }
}

/// The change of XYZ by which a stimulus looks under white `to` as it did under `from`.
///
/// Scales cone responses (von Kries 1902); luminances of the whites do not enter. `None` if a white has y = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation {
    matrix: DMat3,
}

impl Adaptation {
    /// From one white to another.
    pub fn new(model: ConeModel, from: Chromaticity, to: Chromaticity) -> Option<Self> {
        if from.y == 0.0 || to.y == 0.0 {
            return None;
        }
        let cone = model.from_xyz();
        let source = cone * from.with_luminance(1.0).0.as_dvec3();
        let target = cone * to.with_luminance(1.0).0.as_dvec3();
        Some(Self { matrix: cone.inverse() * DMat3::from_diagonal(target / source) * cone })
    }

    /// The adapted stimulus.
    pub fn apply(&self, xyz: Xyz) -> Xyz {
        Xyz((self.matrix * xyz.0.as_dvec3()).as_vec3())
    }

    /// The matrix, row by row, for embedding in a longer product.
    pub fn matrix(&self) -> &DMat3 {
        &self.matrix
    }
}
