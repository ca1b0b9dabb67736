//! Colour rendering by CIE 13.3-1995.

use super::resampling::Resampling;
use super::temperature::ColorTemperature;
use super::tristimulus::{Tristimulus, Uv1960};
use crate::color::adaptation::daylight;
use crate::spectrum::{LAMBDA_MIN, blackbody};
use crate::units::Kelvin;

/// Number of test colours.
pub const SAMPLES: usize = 14;

/// Spectral radiance factors of the test colours, 360–830 nm at 5 nm.
static TEST_COLORS: [[f32; 95]; SAMPLES] = include!("../../../data/cie_test_colours.rs");

/// From this temperature [K] the reference is daylight, below a black body (CIE 13.3, 5.2).
const DAYLIGHT_FROM: f64 = 5000.0;

/// A source and the test colours under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitSamples {
    /// The source, or a perfect diffuser under it.
    pub white: Tristimulus,
    /// The test colours, in the unit of `white`.
    pub samples: [Tristimulus; SAMPLES],
}

/// How the colours of things under a source differ from those under a reference of the same colour temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorRendering {
    /// Special indices R1 to R14; 100 for no difference, may be negative.
    pub special: [f64; SAMPLES],
    /// Distance of source and reference in the 1960 diagram. Above 5.4·10⁻³ the indices are outside of the method's
    /// range (CIE 13.3, 5.3).
    pub chromaticity_difference: f64,
}

/// Radiance factors of the test colours at every nanometre from 360 to 830 (CIE 13.3, tables 1 and 2; between their 5 nm
/// by Sprague's polynomials).
pub fn test_colors() -> [Vec<f64>; SAMPLES] {
    let wavelengths: Vec<f64> = (0..95).map(|i| f64::from(LAMBDA_MIN) + 5.0 * f64::from(i)).collect();
    let map = Resampling::sprague(&wavelengths).unwrap_or_else(|| Resampling::linear(&wavelengths));
    TEST_COLORS.map(|row| map.apply(&row.map(f64::from)))
}

impl LitSamples {
    /// Under a source that is given at every nanometre from 360 to 830, by index.
    pub fn under(source: impl Fn(usize) -> f64, colors: &[Vec<f64>; SAMPLES]) -> Self {
        let lit = |factor: &Vec<f64>| Tristimulus::of(|i| source(i) * factor[i]);
        Self { white: Tristimulus::of(&source), samples: std::array::from_fn(|k| lit(&colors[k])) }
    }
}

impl ColorRendering {
    /// Mean of R1 to R8: the general index Ra.
    pub fn general(&self) -> f64 {
        self.special[..8].iter().sum::<f64>() / 8.0
    }

    /// The indices of a source, CIE 13.3-1995, 5.4–5.8: differences in the 1964 space U*V*W* after von Kries's adaptation in
    /// the 1960 diagram. `None` for sources without a colour temperature, or with one that daylight does not reach.
    pub fn of(source: &LitSamples, colors: &[Vec<f64>; SAMPLES]) -> Option<Self> {
        let kelvin = ColorTemperature::of(source.white.uv1960()?)?.kelvin;
        let reference = reference(kelvin, colors)?;
        let (white, reference_white) = (source.white.uv1960()?, reference.white.uv1960()?);
        let adaptation = Adaptation::new(white, reference_white);
        let mut special = [0.0; SAMPLES];
        for (k, index) in special.iter_mut().enumerate() {
            let (sample, under_reference) = (source.samples[k], reference.samples[k]);
            let adapted = adaptation.apply(sample.uv1960()?);
            let a = Uvw::new(adapted, reference_white, 100.0 * sample.y / source.white.y);
            let b = Uvw::new(
                under_reference.uv1960()?,
                reference_white,
                100.0 * under_reference.y / reference.white.y,
            );
            *index = 100.0 - 4.6 * a.distance(b);
        }
        let chromaticity_difference = (white.u - reference_white.u).hypot(white.v - reference_white.v);
        Some(Self { special, chromaticity_difference })
    }
}

/// The test colours under the reference of a colour temperature [K].
fn reference(kelvin: f64, colors: &[Vec<f64>; SAMPLES]) -> Option<LitSamples> {
    let lambda = |i: usize| f64::from(LAMBDA_MIN) + i as f64;
    if kelvin < DAYLIGHT_FROM {
        let scale = blackbody::planck(560.0, kelvin);
        return Some(LitSamples::under(|i| blackbody::planck(lambda(i), kelvin) / scale, colors));
    }
    let daylight = daylight(Kelvin(kelvin as f32))?;
    Some(LitSamples::under(|i| f64::from(daylight.at(lambda(i) as f32)), colors))
}

/// Von Kries's adaptation as CIE 13.3 has it, 5.7: cone responses as ratios c and d in the 1960 diagram.
struct Adaptation {
    c: f64,
    d: f64,
}

impl Adaptation {
    fn new(from: Uv1960, to: Uv1960) -> Self {
        let (a, b) = (Self::responses(from), Self::responses(to));
        Self { c: b[0] / a[0], d: b[1] / a[1] }
    }

    fn responses(p: Uv1960) -> [f64; 2] {
        [(4.0 - p.u - 10.0 * p.v) / p.v, (1.708 * p.v + 0.404 - 1.481 * p.u) / p.v]
    }

    fn apply(&self, p: Uv1960) -> Uv1960 {
        let [c, d] = Self::responses(p);
        let (c, d) = (c * self.c, d * self.d);
        let sum = 16.518 + 1.481 * c - d;
        Uv1960 { u: (10.872 + 0.404 * c - 4.0 * d) / sum, v: 5.520 / sum }
    }
}

/// Coordinates of the CIE 1964 uniform space.
#[derive(Clone, Copy)]
struct Uvw {
    u: f64,
    v: f64,
    w: f64,
}

impl Uvw {
    /// `y` is the luminance factor in percent.
    fn new(p: Uv1960, white: Uv1960, y: f64) -> Self {
        let w = 25.0 * y.cbrt() - 17.0;
        Self { u: 13.0 * w * (p.u - white.u), v: 13.0 * w * (p.v - white.v), w }
    }

    fn distance(self, other: Self) -> f64 {
        (self.u - other.u).hypot(self.v - other.v).hypot(self.w - other.w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::named;

    fn rendering(name: &str) -> ColorRendering {
        let spectrum = named(name).unwrap();
        let colors = test_colors();
        let lit = LitSamples::under(|i| f64::from(spectrum.at(LAMBDA_MIN + i as f32)), &colors);
        ColorRendering::of(&lit, &colors).unwrap()
    }

    type Golden = (&'static str, f64, f64, f64, f64, f64, [f64; 8]);

    /// Chromaticity, temperature, Duv, Ra and R1 to R8 by colour-science 0.4.7
    /// (`xtask/tables/make_colorimetry.py --goldens`).
    const GOLDENS: [Golden; 32] = [
        (
            "A",
            0.44756,
            0.40743,
            2855.7,
            -0.00000,
            100.00,
            [100.00, 100.00, 100.00, 99.99, 100.00, 100.00, 100.00, 99.99],
        ),
        (
            "C",
            0.31009,
            0.31622,
            6771.6,
            -0.00214,
            97.56,
            [96.93, 97.33, 99.43, 97.84, 96.90, 97.17, 99.28, 95.60],
        ),
        (
            "D50",
            0.34568,
            0.35850,
            5001.3,
            0.00320,
            99.99,
            [99.99, 100.00, 99.99, 99.99, 99.99, 100.00, 99.99, 99.99],
        ),
        (
            "D55",
            0.33244,
            0.34744,
            5502.0,
            0.00325,
            99.98,
            [99.98, 100.00, 99.97, 99.97, 99.99, 99.99, 99.98, 99.96],
        ),
        (
            "D65",
            0.31273,
            0.32902,
            6502.7,
            0.00321,
            100.00,
            [100.00, 100.00, 100.00, 100.00, 100.00, 100.00, 100.00, 100.00],
        ),
        (
            "D75",
            0.29904,
            0.31487,
            7504.7,
            0.00313,
            100.00,
            [100.00, 100.00, 100.00, 100.00, 100.00, 100.00, 100.00, 100.00],
        ),
        (
            "FL1",
            0.31309,
            0.33726,
            6425.6,
            0.00719,
            75.85,
            [69.20, 83.65, 92.14, 72.67, 73.89, 79.62, 82.27, 53.39],
        ),
        (
            "FL2",
            0.37208,
            0.37528,
            4225.2,
            0.00186,
            64.23,
            [56.05, 76.72, 90.32, 57.09, 59.03, 67.25, 74.15, 33.25],
        ),
        (
            "FL3",
            0.40910,
            0.39429,
            3447.3,
            0.00074,
            56.79,
            [47.80, 72.28, 89.80, 46.65, 48.80, 58.96, 69.12, 20.90],
        ),
        (
            "FL4",
            0.44018,
            0.40329,
            2939.5,
            -0.00074,
            51.48,
            [42.19, 69.91, 90.45, 37.96, 41.00, 53.81, 64.99, 11.51],
        ),
        (
            "FL5",
            0.31379,
            0.34530,
            6342.9,
            0.01080,
            71.71,
            [63.30, 80.09, 90.77, 67.31, 68.53, 75.16, 80.77, 47.73],
        ),
        (
            "FL6",
            0.37790,
            0.38835,
            4149.0,
            0.00610,
            59.11,
            [49.35, 72.04, 88.37, 51.13, 52.13, 60.28, 72.69, 26.89],
        ),
        (
            "FL7",
            0.31292,
            0.32932,
            6490.3,
            0.00326,
            90.21,
            [89.18, 91.92, 90.87, 90.75, 90.35, 88.84, 92.60, 87.19],
        ),
        (
            "FL8",
            0.34588,
            0.35875,
            4994.8,
            0.00324,
            95.53,
            [96.98, 96.37, 91.32, 97.08, 96.11, 93.46, 96.21, 96.74],
        ),
        (
            "FL9",
            0.37417,
            0.37282,
            4148.0,
            0.00004,
            90.32,
            [89.63, 92.58, 90.55, 90.19, 89.46, 87.96, 93.67, 88.52],
        ),
        (
            "FL10",
            0.34579,
            0.35896,
            4998.8,
            0.00338,
            80.98,
            [93.05, 89.49, 53.50, 85.90, 83.07, 73.63, 88.99, 80.24],
        ),
        (
            "FL11",
            0.38052,
            0.37712,
            4000.7,
            0.00015,
            82.86,
            [98.23, 92.72, 51.09, 88.43, 87.21, 77.37, 88.62, 79.20],
        ),
        (
            "FL12",
            0.43694,
            0.40441,
            3002.6,
            0.00013,
            83.06,
            [98.82, 95.03, 54.73, 89.41, 87.90, 82.58, 88.62, 67.41],
        ),
        (
            "HP1",
            0.53278,
            0.41517,
            1962.2,
            0.00083,
            8.50,
            [-2.66, 61.52, 40.44, -26.21, -3.47, 51.94, 21.43, -75.01],
        ),
        (
            "HP2",
            0.47784,
            0.41586,
            2505.9,
            0.00072,
            82.69,
            [97.09, 88.50, 73.01, 89.02, 88.15, 71.34, 81.30, 73.11],
        ),
        (
            "HP3",
            0.43011,
            0.40754,
            3146.3,
            0.00240,
            82.39,
            [86.27, 91.78, 87.09, 88.49, 84.21, 89.90, 81.74, 49.63],
        ),
        (
            "HP4",
            0.38108,
            0.37970,
            4004.4,
            0.00119,
            76.04,
            [76.87, 85.59, 83.98, 79.86, 76.54, 80.19, 79.25, 46.00],
        ),
        (
            "HP5",
            0.37753,
            0.37136,
            4041.1,
            -0.00169,
            89.14,
            [89.25, 95.31, 97.43, 90.51, 90.24, 94.80, 87.05, 68.49],
        ),
        (
            "LED-B1",
            0.45592,
            0.40790,
            2734.7,
            -0.00066,
            81.79,
            [79.79, 90.44, 96.60, 77.95, 79.33, 87.56, 82.84, 59.77],
        ),
        (
            "LED-B2",
            0.43565,
            0.40129,
            2998.8,
            -0.00094,
            82.79,
            [80.95, 90.33, 96.42, 79.43, 80.37, 86.58, 84.72, 63.50],
        ),
        (
            "LED-B3",
            0.37566,
            0.37245,
            4102.5,
            -0.00060,
            84.84,
            [83.61, 89.28, 93.24, 84.76, 83.74, 84.84, 88.21, 71.07],
        ),
        (
            "LED-B4",
            0.34227,
            0.35035,
            5105.8,
            0.00052,
            76.85,
            [75.40, 81.54, 83.39, 76.56, 75.02, 72.59, 84.84, 65.48],
        ),
        (
            "LED-B5",
            0.31190,
            0.32385,
            6590.7,
            0.00095,
            80.28,
            [79.09, 84.45, 85.05, 80.18, 78.96, 76.41, 87.49, 70.63],
        ),
        (
            "LED-BH1",
            0.44741,
            0.40673,
            2852.3,
            -0.00026,
            91.81,
            [98.63, 93.54, 81.37, 89.41, 95.36, 92.76, 92.13, 91.28],
        ),
        (
            "LED-RGB1",
            0.45576,
            0.42110,
            2839.5,
            0.00426,
            57.39,
            [48.87, 79.97, 83.24, 36.40, 47.98, 62.67, 70.99, 29.00],
        ),
        (
            "LED-V1",
            0.45453,
            0.40417,
            2725.1,
            -0.00195,
            95.33,
            [95.19, 96.35, 98.26, 92.53, 92.94, 91.21, 97.81, 98.34],
        ),
        (
            "LED-V2",
            0.37797,
            0.37729,
            4072.0,
            0.00098,
            95.70,
            [95.60, 96.07, 96.23, 95.20, 94.92, 92.67, 97.19, 97.70],
        ),
    ];

    #[test]
    fn illuminants_have_their_chromaticity_temperature_and_rendering() {
        for (name, x, y, kelvin, duv, ra, special) in GOLDENS {
            let spectrum = named(&format!("stdillum-{}", name.replace("FL", "F"))).unwrap();
            let white = Tristimulus::of(|i| f64::from(spectrum.at(LAMBDA_MIN + i as f32)));
            let xy = white.xy().unwrap();
            assert!((xy.x - x).abs() < 8e-6 && (xy.y - y).abs() < 8e-6, "{name}: {xy:?}");
            let t = ColorTemperature::of(white.uv1960().unwrap()).unwrap();
            assert!((t.kelvin - kelvin).abs() < 0.25 && (t.duv - duv).abs() < 1e-5, "{name}: {t:?}");
            // They find the temperature of the reference by Robertson's table, which is off by up to 0.7 K.
            let r = rendering(&format!("stdillum-{}", name.replace("FL", "F")));
            assert!((r.general() - ra).abs() < 0.015, "{name}: Ra {}", r.general());
            for (k, expected) in special.iter().enumerate() {
                assert!((r.special[k] - expected).abs() < 0.05, "{name}: R{} {}", k + 1, r.special[k]);
            }
        }
    }

    #[test]
    fn a_reference_renders_perfectly() {
        let colors = test_colors();
        for kelvin in [2000.0, 4999.0, 5010.0, 9000.0] {
            let r = ColorRendering::of(&reference(kelvin, &colors).unwrap(), &colors).unwrap();
            // Daylight lies beside the locus: its correlated temperature is not quite its own.
            let slack = if kelvin < DAYLIGHT_FROM { 1e-3 } else { 0.05 };
            assert!(r.special.iter().all(|i| (i - 100.0).abs() < slack), "{kelvin}: {r:?}");
        }
    }

    #[test]
    fn sources_without_a_temperature_have_no_rendering() {
        let colors = test_colors();
        let laser = LitSamples::under(|i| f64::from(u8::from(i == 532 - 360)), &colors);
        assert_eq!(ColorRendering::of(&laser, &colors), None);
        let black = LitSamples::under(|_| 0.0, &colors);
        assert_eq!(ColorRendering::of(&black, &colors), None);
    }
}
