//! White: daylight, thermal white, and the adaptation from one white to another.

use super::triple::{Chromaticity, Xyz};
use crate::spectrum::{Blackbody, LAMBDA_MIN, Spectrum, Tabulated, blackbody, cie};
use crate::units::Kelvin;
use glam::DMat3;

/// Components S₀, S₁, S₂ of daylight, 300–830 nm at 5 nm.
static DAYLIGHT: [[f32; 3]; 107] = include!("../../data/cie_daylight.rs");

/// Daylight of a correlated colour temperature: relative spectral power, 100 at 560 nm, over 300–830 nm.
///
/// CIE 15:2018, 4.1.2, which defines it for 4000–25000 K; `None` outside. The temperature counts on today's scale:
/// D65 is 6504 K.
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
    Tabulated::new(&pairs).ok()
}

/// Chromaticity of daylight, CIE 15:2018, 4.1.2; `None` outside 4000–25000 K.
pub fn daylight_chromaticity(temperature: Kelvin) -> Option<Chromaticity> {
    let t = f64::from(temperature.0);
    if !(4000.0..=25_000.0).contains(&t) {
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

/// The white that a nominal temperature names, as in `"float whitebalance" 6500`.
///
/// Daylight of T · 1.4388 / 1.4380, which corrects for the older radiation constant, where daylight is defined, else a
/// black body (pbrt's rule below 4000 K).
pub fn nominal_white(temperature: Kelvin) -> Spectrum {
    let corrected = Kelvin(temperature.0 * (1.4388 / 1.4380));
    daylight(corrected)
        .map_or_else(|| Spectrum::Blackbody(Blackbody::normalized(corrected)), Spectrum::Tabulated)
}

/// Chromaticity of any spectrum over 360–830 nm; `None` if it is black there.
pub fn spectrum_chromaticity(spectrum: &Spectrum) -> Option<Chromaticity> {
    chromaticity(cie::tristimulus_integral(|l| spectrum.at(l)))
}

fn chromaticity(xyz: [f64; 3]) -> Option<Chromaticity> {
    let total: f64 = xyz.iter().sum();
    (total > 0.0).then(|| Chromaticity::new((xyz[0] / total) as f32, (xyz[1] / total) as f32))
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
    chromaticity(sum)
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
    /// Responses of the three kinds of cone (rows) to X, Y, Z.
    fn matrix(self) -> DMat3 {
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
        let cone = model.matrix();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::named;

    fn near(c: Option<Chromaticity>, x: f32, y: f32, tolerance: f32) {
        let c = c.unwrap();
        assert!((c.x - x).abs() < tolerance && (c.y - y).abs() < tolerance, "{c:?}, expected {x} {y}");
    }

    #[test]
    fn standard_illuminants_have_the_published_chromaticities() {
        // CIE 15:2018, table T.3 (to four digits of x, y); the fifth digit as colour-science integrates them.
        for (name, x, y, tolerance) in [
            ("stdillum-A", 0.447_58, 0.407_45, 2e-5),
            ("stdillum-D50", 0.345_68, 0.358_50, 1e-5),
            ("stdillum-D65", 0.312_73, 0.329_02, 1e-5),
            ("stdillum-F2", 0.372_08, 0.375_28, 1e-5),
            // The ACES white was rounded before its spectrum was made.
            ("illum-acesD60", 0.321_68, 0.337_67, 6e-5),
        ] {
            near(spectrum_chromaticity(&named(name).unwrap()), x, y, tolerance);
        }
    }

    #[test]
    fn fluorescent_lamps_have_the_published_chromaticities() {
        // CIE 15:2018, table T.8.1, four digits.
        let published = [
            (0.3131, 0.3371),
            (0.3721, 0.3751),
            (0.4091, 0.3941),
            (0.4402, 0.4031),
            (0.3138, 0.3452),
            (0.3779, 0.3882),
            (0.3129, 0.3292),
            (0.3458, 0.3586),
            (0.3741, 0.3727),
            (0.3458, 0.3588),
            (0.3805, 0.3769),
            (0.4370, 0.4042),
        ];
        for (i, (x, y)) in published.into_iter().enumerate() {
            let lamp = named(&format!("stdillum-F{}", i + 1)).unwrap();
            near(spectrum_chromaticity(&lamp), x, y, 2.5e-4);
        }
    }

    #[test]
    fn daylight_meets_its_own_chromaticity_and_the_d_illuminants() {
        for t in [4000.0, 5003.0, 6504.0, 10_000.0, 25_000.0] {
            let spectrum = Spectrum::Tabulated(daylight(Kelvin(t)).unwrap());
            let c = daylight_chromaticity(Kelvin(t)).unwrap();
            // The components reproduce the locus to about 10⁻⁴ (CIE 15:2018, note to 4.1.2).
            near(spectrum_chromaticity(&spectrum), c.x, c.y, 3e-4);
            assert!((spectrum.at(560.0) - 100.0).abs() < 1e-3);
        }
        let (ours, table) = (daylight(Kelvin(6504.0)).unwrap(), named("stdillum-D65").unwrap());
        let scale = 100.0 / table.at(560.0);
        for lambda in (360..=830).step_by(5) {
            let l = lambda as f32;
            assert!(
                (ours.at(l) - scale * table.at(l)).abs() < 0.1,
                "{l}: {} {}",
                ours.at(l),
                scale * table.at(l)
            );
        }
        assert!(daylight(Kelvin(3999.0)).is_none() && daylight(Kelvin(25_001.0)).is_none());
        assert!(daylight(Kelvin(f32::NAN)).is_none());
    }

    #[test]
    fn nominal_white_is_daylight_where_defined_and_thermal_below() {
        near(spectrum_chromaticity(&nominal_white(Kelvin(6500.0))), 0.312_73, 0.329_02, 2e-4);
        let thermal = planck_chromaticity(Kelvin(2700.0 * 1.4388 / 1.4380)).unwrap();
        near(spectrum_chromaticity(&nominal_white(Kelvin(2700.0))), thermal.x, thermal.y, 1e-5);
    }

    #[test]
    fn thermal_white_of_2856_k_is_illuminant_a() {
        // A is defined as a Planckian radiator at 2855.5 K on today's scale.
        near(planck_chromaticity(Kelvin(2855.54)), 0.447_58, 0.407_45, 3e-5);
        assert!(planck_chromaticity(Kelvin(0.0)).is_none());
    }

    #[test]
    fn adaptation_maps_white_to_white_and_inverts() {
        let (d65, a) = (Chromaticity::new(0.3127, 0.3290), Chromaticity::new(0.44758, 0.40745));
        for model in [ConeModel::Bradford, ConeModel::VonKries] {
            let there = Adaptation::new(model, d65, a).unwrap();
            let back = Adaptation::new(model, a, d65).unwrap();
            let white = there.apply(d65.with_luminance(0.7));
            assert!((white.0 - a.with_luminance(0.7).0).abs().max_element() < 1e-6, "{white:?}");
            let stimulus = Xyz::new(0.3, 0.2, 0.1);
            assert!((back.apply(there.apply(stimulus)).0 - stimulus.0).abs().max_element() < 1e-6);
        }
        assert!(Adaptation::new(ConeModel::Bradford, Chromaticity::new(0.3, 0.0), a).is_none());
    }

    #[test]
    fn bradford_from_d65_to_d50_is_the_published_matrix() {
        // ICC profile specification v4 (the `chad` tag of sRGB).
        let published = [[1.0478, 0.0229, -0.0502], [0.0295, 0.9905, -0.0171], [-0.0092, 0.0150, 0.7517]];
        let d65 = Chromaticity::new(0.3127, 0.3290);
        let d50 = Chromaticity::new(0.34567, 0.35850);
        let m = *Adaptation::new(ConeModel::Bradford, d65, d50).unwrap().matrix();
        for (r, row) in published.iter().enumerate() {
            for (c, &v) in row.iter().enumerate() {
                assert!((m.col(c)[r] - v).abs() < 5e-4, "{r} {c}: {}", m.col(c)[r]);
            }
        }
    }
}
