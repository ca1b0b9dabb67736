//! How the luminance of a sky varies over the hemisphere.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A sky's distribution of luminance by name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyModel {
    /// The same luminance everywhere.
    Uniform,
    /// The traditional overcast sky of Moon and Spencer (1942), the CIE's sixteenth: L/Lz = (1 + 2 cos Z)/3.
    Overcast,
    /// One of the fifteen types of the CIE general sky.
    General(GeneralSky),
}

/// Parameters of the CIE standard general sky, ISO 15469:2004 (CIE S 011/E:2003).
///
/// L/Lz = f(χ) φ(Z) / (f(Zs) φ(0)) with the gradation φ(Z) = 1 + a e^(b/cos Z) and the scattering indicatrix
/// f(χ) = 1 + c (e^(dχ) − e^(dπ/2)) + e cos²χ; Z is the angle to the zenith, Zs that of the sun, χ the angle to the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralSky {
    /// Size of the gradation between zenith and horizon.
    pub a: f64,
    /// Its course, negative.
    pub b: f64,
    /// Size of the brightening around the sun.
    pub c: f64,
    /// Its course, negative.
    pub d: f64,
    /// Brightening towards and away from the sun.
    pub e: f64,
}

/// Gradation groups I–VI: a, b.
const GRADATIONS: [[f64; 2]; 6] =
    [[4.0, -0.7], [1.1, -0.8], [0.0, -1.0], [-1.0, -0.55], [-1.0, -0.32], [-1.0, -0.15]];
/// Indicatrix groups 1–6: c, d, e.
const INDICATRICES: [[f64; 3]; 6] = [
    [0.0, -1.0, 0.0],
    [2.0, -1.5, 0.15],
    [5.0, -2.5, 0.30],
    [10.0, -3.0, 0.45],
    [16.0, -3.0, 0.30],
    [24.0, -2.8, 0.15],
];
/// Gradation and indicatrix group of the types 1–15.
const GROUPS: [[usize; 2]; 15] = [
    [1, 1],
    [1, 2],
    [2, 1],
    [2, 2],
    [3, 1],
    [3, 2],
    [3, 3],
    [3, 4],
    [4, 2],
    [4, 3],
    [4, 4],
    [5, 4],
    [5, 5],
    [6, 5],
    [6, 6],
];

impl GeneralSky {
    /// The CIE clear sky, type 12.
    pub const CLEAR: Self = Self { a: -1.0, b: -0.32, c: 10.0, d: -3.0, e: 0.45 };

    /// Type 1 (overcast, steep gradation) to 15 (white-blue, turbid, broad corona) of the standard; 12 is the CIE clear sky
    /// of low turbidity, 13 that of a polluted atmosphere. `None` for any other number.
    pub fn of_type(number: usize) -> Option<Self> {
        let [gradation, indicatrix] = *GROUPS.get(number.checked_sub(1)?)?;
        let [a, b] = *GRADATIONS.get(gradation - 1)?;
        let [c, d, e] = *INDICATRICES.get(indicatrix - 1)?;
        Some(Self { a, b, c, d, e })
    }

    /// φ(Z) for cos Z ≥ 0; 1 on the horizon.
    fn gradation(&self, cos_zenith: f64) -> f64 {
        if cos_zenith > 0.0 { 1.0 + self.a * (self.b / cos_zenith).exp() } else { 1.0 }
    }

    /// f(χ).
    fn indicatrix(&self, cos_sun: f64) -> f64 {
        if self.ignores_sun() {
            return 1.0;
        }
        let chi = cos_sun.clamp(-1.0, 1.0).acos();
        let corona = (self.d * chi).exp() - (self.d * FRAC_PI_2).exp();
        1.0 + self.c * corona + self.e * cos_sun * cos_sun
    }

    fn ignores_sun(&self) -> bool {
        self.c == 0.0 && self.e == 0.0
    }
}

impl SkyModel {
    /// Whether the distribution depends on where the sun stands.
    pub fn needs_sun(&self) -> bool {
        match self {
            Self::Uniform | Self::Overcast => false,
            Self::General(sky) => !sky.ignores_sun(),
        }
    }
}

/// A sky's luminance relative to its zenith, for one place of the sun.
#[derive(Clone, Copy, Debug)]
pub struct SkyLuminance {
    model: SkyModel,
    /// Of the sun.
    cos_zenith: f64,
    /// 1 / (f(Zs) φ(0)).
    normalisation: f64,
}

impl SkyLuminance {
    /// For a sun at the zenith angle arccos `sun_cos_zenith`, in [0, 1]; models that do not need the sun ignore it.
    pub fn new(model: SkyModel, sun_cos_zenith: f64) -> Self {
        let normalisation = match &model {
            SkyModel::Uniform | SkyModel::Overcast => 1.0,
            SkyModel::General(sky) => 1.0 / (sky.indicatrix(sun_cos_zenith) * sky.gradation(1.0)),
        };
        Self { model, cos_zenith: sun_cos_zenith, normalisation }
    }

    /// L/Lz in a direction of the upper hemisphere that makes arccos `cos_zenith` with the zenith and arccos `cos_sun`
    /// with the sun.
    pub fn relative(&self, cos_zenith: f64, cos_sun: f64) -> f64 {
        match &self.model {
            SkyModel::Uniform => 1.0,
            SkyModel::Overcast => (1.0 + 2.0 * cos_zenith) / 3.0,
            SkyModel::General(sky) => {
                sky.indicatrix(cos_sun) * sky.gradation(cos_zenith) * self.normalisation
            }
        }
    }

    /// L/Lz at `azimuth` [rad] from the sun's.
    pub(super) fn towards(&self, cos_zenith: f64, azimuth: f64) -> f64 {
        let sines = ((1.0 - cos_zenith * cos_zenith) * (1.0 - self.cos_zenith * self.cos_zenith)).max(0.0);
        self.relative(cos_zenith, cos_zenith * self.cos_zenith + sines.sqrt() * azimuth.cos())
    }

    /// The integrals over the upper hemisphere, exact for skies without a sun, otherwise good to 10⁻⁶.
    pub fn integrals(&self) -> SkyIntegrals {
        match &self.model {
            SkyModel::Uniform => return SkyIntegrals { horizontal: PI, all: TAU },
            SkyModel::Overcast => {
                return SkyIntegrals { horizontal: 7.0 * PI / 9.0, all: 4.0 * PI / 3.0 };
            }
            SkyModel::General(_) => {}
        }
        // Midpoints in cos Z, over which solid angle is uniform, and in azimuth over half the sky, of which the other
        // half is the image.
        let (rows, columns) = (400_u32, if self.model.needs_sun() { 400_u32 } else { 1 });
        let (mut horizontal, mut all) = (0.0, 0.0);
        for row in 0..rows {
            let cos_zenith = (f64::from(row) + 0.5) / f64::from(rows);
            let mut sum = 0.0;
            for column in 0..columns {
                sum += self.towards(cos_zenith, (f64::from(column) + 0.5) / f64::from(columns) * PI);
            }
            let ring = sum / f64::from(columns) * TAU / f64::from(rows);
            horizontal += ring * cos_zenith;
            all += ring;
        }
        SkyIntegrals { horizontal, all }
    }
}

/// ∫ L/Lz dω over the upper hemisphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyIntegrals {
    /// Weighted by cos Z: horizontal irradiance over zenith radiance [sr].
    pub horizontal: f64,
    /// Without a weight [sr].
    pub all: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn general(number: usize) -> SkyModel {
        SkyModel::General(GeneralSky::of_type(number).unwrap())
    }

    /// Horizontal irradiance by rings around the sun: other nodes than the implementation's.
    fn around_the_sun(sky: &SkyLuminance, sun_zenith: f64) -> f64 {
        let n = 600;
        let mut sum = 0.0;
        for i in 0..n {
            let chi = (f64::from(i) + 0.5) / f64::from(n) * PI;
            for j in 0..n {
                let azimuth = (f64::from(j) + 0.5) / f64::from(n) * PI;
                let cos_zenith = chi.cos() * sun_zenith.cos() + chi.sin() * sun_zenith.sin() * azimuth.cos();
                if cos_zenith > 0.0 {
                    sum += sky.relative(cos_zenith, chi.cos()) * cos_zenith * chi.sin();
                }
            }
        }
        sum * (PI / f64::from(n)) * (TAU / f64::from(n))
    }

    #[test]
    fn every_type_is_one_at_the_zenith_and_positive_everywhere() {
        for number in 1..=15 {
            for sun in [0.0_f64, 0.5, 1.2, 1.55] {
                let sky = SkyLuminance::new(general(number), sun.cos());
                assert!((sky.towards(1.0, 0.3) - 1.0).abs() < 1e-12, "{number} {sun}");
                for i in 0..50 {
                    for azimuth in [0.0, 1.0, 2.0, PI] {
                        assert!(sky.towards(f64::from(i) / 50.0, azimuth) > 0.0, "{number} {sun} {i}");
                    }
                }
            }
        }
        assert_eq!(GeneralSky::of_type(12), Some(GeneralSky::CLEAR));
        assert_eq!((GeneralSky::of_type(0), GeneralSky::of_type(16)), (None, None));
    }

    #[test]
    fn horizon_and_sun_are_as_bright_as_the_formulas_of_the_standard_say() {
        // Type 1 on the horizon: 1/(1 + 4 e^-0.7) of the zenith, near the traditional third.
        let steep = SkyLuminance::new(general(1), 0.5);
        assert!((steep.towards(0.0, 1.0) - 1.0 / (1.0 + 4.0 * (-0.7_f64).exp())).abs() < 1e-12);
        // Type 5 is uniform.
        assert!((SkyLuminance::new(general(5), 0.5).towards(0.0, 1.0) - 1.0).abs() < 1e-12);
        // The CIE clear sky in Kittler's form of 1973: (0.91 + 10 e^-3χ + 0.45 cos²χ)(1 − e^(-0.32/cos Z)) over
        // (0.91 + 10 e^-3Zs + 0.45 cos²Zs) · 0.27385; 0.91 is 1 − 10 e^(-3π/2) rounded.
        let zs = 60_f64.to_radians();
        let clear = SkyLuminance::new(general(12), zs.cos());
        let f = |chi: f64| 0.91 + 10.0 * (-3.0 * chi).exp() + 0.45 * chi.cos().powi(2);
        for (z, azimuth) in [(20.0_f64, 0.0_f64), (60.0, 0.1), (80.0, 3.0), (45.0, 1.5)] {
            let z = z.to_radians();
            let chi = (z.cos() * zs.cos() + z.sin() * zs.sin() * azimuth.cos()).acos();
            let kittler = f(chi) * (1.0 - (-0.32 / z.cos()).exp()) / (f(zs) * 0.27385);
            let found = clear.towards(z.cos(), azimuth);
            assert!((found / kittler - 1.0).abs() < 2e-3, "{z} {azimuth}: {found} {kittler}");
        }
    }

    #[test]
    fn horizontal_irradiance_is_that_of_the_closed_forms_and_of_another_quadrature() {
        let uniform = SkyLuminance::new(general(5), 0.3).integrals();
        assert!((uniform.horizontal / PI - 1.0).abs() < 1e-6 && (uniform.all / TAU - 1.0).abs() < 1e-12);
        // The closed form of the traditional sky by the same rule: ∫ (1 + 2μ)/3 μ dμ = 7/18.
        let n = 400;
        let rule: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n))
            .map(|mu| SkyLuminance::new(SkyModel::Overcast, 1.0).relative(mu, 0.0) * mu * TAU / f64::from(n))
            .sum();
        assert!(
            (rule / SkyLuminance::new(SkyModel::Overcast, 1.0).integrals().horizontal - 1.0).abs() < 1e-5
        );
        for number in [2, 7, 12, 14, 15] {
            for sun in [0.3, 1.3_f64] {
                let sky = SkyLuminance::new(general(number), sun.cos());
                let (found, expected) = (sky.integrals().horizontal, around_the_sun(&sky, sun));
                assert!((found / expected - 1.0).abs() < 2e-5, "{number} {sun}: {found} {expected}");
            }
        }
    }
}
