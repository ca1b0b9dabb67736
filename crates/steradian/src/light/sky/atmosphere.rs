//! Spectra of sun and sky under a cloudless atmosphere.

use crate::spectrum::{Spectrum, Tabulated};

/// Wavelength [nm], extraterrestrial irradiance [W·m⁻²·nm⁻¹], absorption by water vapour, ozone and the mixed gases.
static TABLE: [[f64; 5]; 122] = include!("../../../data/clear_sky.rs");

/// A cloudless atmosphere as the model of Bird and Riordan takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atmosphere {
    /// Optical depth of the aerosol at 500 nm, towards the zenith.
    pub turbidity: f64,
    /// Ångström's exponent: the optical depth is as λ^-α.
    pub angstrom_exponent: f64,
    /// Precipitable water [cm].
    pub water: f64,
    /// Ozone [atm·cm].
    pub ozone: f64,
    /// Pressure at the ground [Pa].
    pub pressure: f64,
    /// Reflectance of the ground, which brightens the sky.
    pub ground_reflectance: f64,
}

impl Default for Atmosphere {
    /// Clean rural air at sea level over grassland.
    fn default() -> Self {
        Self {
            turbidity: 0.1,
            angstrom_exponent: 1.14,
            water: 1.42,
            ozone: 0.34,
            pressure: 101_300.0,
            ground_reflectance: 0.2,
        }
    }
}

/// Where the light of a cloudless day comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Daylight {
    /// Apparent elevation of the sun [°], in [0, 90].
    pub elevation: f64,
    /// Distance of the sun [astronomical units].
    pub distance: f64,
}

/// Irradiance at one wavelength [W·m⁻²·nm⁻¹].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearSkyIrradiance {
    /// Wavelength [nm], 300–4000.
    pub wavelength: f64,
    /// Of a plane that faces the sun, by the sun.
    pub direct_normal: f64,
    /// Of the horizontal plane, by the sky.
    pub diffuse_horizontal: f64,
    /// Of the horizontal plane, by both.
    pub global_horizontal: f64,
}

/// The spectra of a cloudless day, 300–4000 nm, zero elsewhere [W·m⁻²·nm⁻¹].
#[derive(Clone, Debug)]
pub struct ClearSkySpectra {
    /// Irradiance of a plane that faces the sun, by the sun.
    pub direct_normal: Spectrum,
    /// Irradiance of the horizontal plane by the sky.
    pub diffuse_horizontal: Spectrum,
    /// Irradiance of the horizontal plane by both.
    pub global_horizontal: Spectrum,
}

/// What the atmosphere lets through at one wavelength.
struct Transmittance {
    rayleigh: f64,
    aerosol: f64,
    water: f64,
    ozone: f64,
    mixed: f64,
    aerosol_scattering: f64,
    aerosol_absorption: f64,
}

/// Asymmetry of scattering by rural aerosol, and its albedo at 400 nm with the course that it takes over wavelength.
const ASYMMETRY: f64 = 0.65;
const ALBEDO_400: f64 = 0.945;
const ALBEDO_COURSE: f64 = 0.095;
/// The air mass at which sky light that the ground sent up crosses the atmosphere.
const DIFFUSE_AIR_MASS: f64 = 1.8;

impl Atmosphere {
    /// The simple spectral model of Bird and Riordan, "Simple Solar Spectral Model for Direct and Diffuse Irradiance on
    /// Horizontal and Tilted Planes at the Earth's Surface for Cloudless Atmospheres", J. Climate Appl. Meteor. 25, 87 (1986), at
    /// its 122 wavelengths; equation numbers are those of the report SERI/TR-215-2436. Constants follow NREL's later program
    /// (`spectrl2_2.c`), as pvlib does: 1.3366 in (2-4), 118.3 in (2-11), the mixed gases in (3-8), and the air mass of Kasten
    /// and Young (1989).
    pub fn irradiance(&self, light: &Daylight) -> Vec<ClearSkyIrradiance> {
        let zenith = 90.0 - light.elevation;
        let cos_zenith = zenith.to_radians().cos().max(0.0);
        let air_mass = 1.0 / (cos_zenith + 0.505_72 * (96.079_95 - zenith).powf(-1.6364));
        // (2-10): ozone at a height of 22 km.
        let height = 22.0 / 6370.0;
        let ozone_mass = (1.0 + height) / (cos_zenith * cos_zenith + 2.0 * height).sqrt();
        // (3-11) to (3-15): the share of what the aerosol scatters that goes downwards.
        let log = (1.0 - ASYMMETRY).ln();
        let a = log * (1.459 + log * (0.1595 + log * 0.4129));
        let b = log * (0.0783 + log * (-0.3824 - log * 0.5874));
        let downwards = |cos: f64| 1.0 - 0.5 * ((a + b * cos) * cos).exp();
        let (down, down_diffuse) = (downwards(cos_zenith), downwards(1.0 / DIFFUSE_AIR_MASS));
        TABLE
            .iter()
            .map(|&[wavelength, extraterrestrial, water, ozone, mixed]| {
                let albedo = ALBEDO_400 * (-ALBEDO_COURSE * (wavelength / 400.0).ln().powi(2)).exp();
                let through =
                    |mass| self.transmittance(wavelength, [water, ozone, mixed], albedo, mass, ozone_mass);
                let (t, t_up) = (through(air_mass), through(DIFFUSE_AIR_MASS));
                let arriving = extraterrestrial / (light.distance * light.distance);
                // (2-1)
                let direct = arriving * t.rayleigh * t.aerosol * t.water * t.ozone * t.mixed;
                // (3-5), (3-6)
                let common = arriving * cos_zenith * t.ozone * t.mixed * t.water * t.aerosol_absorption;
                let molecules = common * (1.0 - t.rayleigh.powf(0.95)) * 0.5;
                let aerosol = common * t.rayleigh.powf(1.5) * (1.0 - t.aerosol_scattering) * down;
                // (3-7), (3-8): to and fro between ground and sky.
                let sky = t_up.mixed
                    * t_up.water
                    * t_up.aerosol_absorption
                    * (0.5 * (1.0 - t_up.rayleigh)
                        + (1.0 - down_diffuse) * t_up.rayleigh * (1.0 - t_up.aerosol_scattering));
                let both = sky * self.ground_reflectance;
                let returned = (direct * cos_zenith + molecules + aerosol) * both / (1.0 - both);
                // (3-1), (3-17)
                let correction =
                    if wavelength <= 450.0 { ((wavelength + 550.0) / 1000.0).powf(1.8) } else { 1.0 };
                let diffuse_horizontal = (molecules + aerosol + returned) * correction;
                ClearSkyIrradiance {
                    wavelength,
                    direct_normal: direct,
                    diffuse_horizontal,
                    global_horizontal: direct * cos_zenith + diffuse_horizontal,
                }
            })
            .collect()
    }

    /// [`Atmosphere::irradiance`] as functions of wavelength, linear in between.
    pub fn spectra(&self, light: &Daylight) -> ClearSkySpectra {
        let rows = self.irradiance(light);
        let of = |value: fn(&ClearSkyIrradiance) -> f64| {
            let pairs: Vec<(f32, f32)> =
                rows.iter().map(|r| (r.wavelength as f32, value(r) as f32)).collect();
            // The table's wavelengths increase and its values are finite, as a test asserts.
            Tabulated::new(&pairs).map_or(Spectrum::Constant(0.0), Spectrum::Tabulated)
        };
        ClearSkySpectra {
            direct_normal: of(|r| r.direct_normal),
            diffuse_horizontal: of(|r| r.diffuse_horizontal),
            global_horizontal: of(|r| r.global_horizontal),
        }
    }

    /// (2-4) to (2-11), (3-9), (3-10); `absorption` of water vapour, ozone and the mixed gases.
    fn transmittance(
        &self,
        wavelength: f64,
        absorption: [f64; 3],
        albedo: f64,
        air_mass: f64,
        ozone_mass: f64,
    ) -> Transmittance {
        let [water, ozone, mixed] = absorption;
        let depth = self.turbidity * (wavelength / 500.0).powf(-self.angstrom_exponent) * air_mass;
        let pressure_mass = air_mass * self.pressure / 101_300.0;
        let squared = (wavelength / 1000.0).powi(2);
        let wet = water * self.water * air_mass;
        let gases = mixed * pressure_mass;
        Transmittance {
            rayleigh: (-pressure_mass / (squared * squared * (115.6406 - 1.3366 / squared))).exp(),
            aerosol: (-depth).exp(),
            water: (-0.2385 * wet / (1.0 + 20.07 * wet).powf(0.45)).exp(),
            ozone: (-ozone * self.ozone * ozone_mass).exp(),
            mixed: (-1.41 * gases / (1.0 + 118.3 * gases).powf(0.45)).exp(),
            aerosol_scattering: (-albedo * depth).exp(),
            aerosol_absorption: (-(1.0 - albedo) * depth).exp(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_are_those_of_pvlib() {
        // Direct normal and diffuse horizontal by pvlib 0.16.1, `spectrum.spectrl2`; printed by xtask/tables/make_atmosphere.py.
        let report = Atmosphere { turbidity: 0.27, ozone: 0.344, ..Atmosphere::default() };
        let overhead = Atmosphere {
            turbidity: 0.05,
            angstrom_exponent: 1.3,
            water: 2.0,
            ozone: 0.30,
            ground_reflectance: 0.0,
            ..Atmosphere::default()
        };
        let low = Atmosphere {
            water: 0.5,
            ozone: 0.40,
            pressure: 84_000.0,
            ground_reflectance: 0.6,
            ..Atmosphere::default()
        };
        let day = |elevation, distance| Daylight { elevation, distance };
        let cases = [
            (
                report,
                day(90.0 - 48.19, 1.001_949_250),
                [
                    (300.0, 2.4244657e-04, 7.2737469e-04),
                    (400.0, 5.0687921e-01, 3.3708717e-01),
                    (450.0, 9.0403560e-01, 4.5153026e-01),
                    (460.0, 9.5755253e-01, 4.4995186e-01),
                    (550.0, 1.0833589e+00, 3.3238010e-01),
                    (690.0, 9.1944237e-01, 1.8117450e-01),
                    (762.5, 5.8561614e-01, 9.5205217e-02),
                    (937.0, 2.7997324e-01, 3.2208474e-02),
                    (1395.0, 4.7864686e-03, 2.9447386e-04),
                    (2100.0, 7.7803005e-02, 2.7156168e-03),
                    (4000.0, 8.0306038e-03, 1.0341511e-04),
                ],
            ),
            (
                overhead,
                day(90.0, 0.982_909_635),
                [
                    (300.0, 7.3651160e-03, 7.3000866e-03),
                    (400.0, 9.9512483e-01, 2.4789351e-01),
                    (450.0, 1.5656706e+00, 2.6816441e-01),
                    (460.0, 1.6276756e+00, 2.5728412e-01),
                    (550.0, 1.6556976e+00, 1.4498242e-01),
                    (690.0, 1.2739282e+00, 5.9551596e-02),
                    (762.5, 8.4081147e-01, 3.0803439e-02),
                    (937.0, 3.5878411e-01, 8.3385186e-03),
                    (1395.0, 6.4097429e-03, 6.9563055e-05),
                    (2100.0, 8.7855837e-02, 4.6746416e-04),
                    (4000.0, 8.6875194e-03, 1.5182425e-05),
                ],
            ),
            (
                low,
                day(10.0, 1.017_135_919),
                [
                    (300.0, 5.7682575e-13, 3.6992341e-11),
                    (400.0, 1.2880406e-01, 1.1020624e-01),
                    (450.0, 3.6406155e-01, 1.4050003e-01),
                    (460.0, 4.0955878e-01, 1.3834475e-01),
                    (550.0, 5.8873130e-01, 8.6344273e-02),
                    (690.0, 6.3653196e-01, 4.6418628e-02),
                    (762.5, 3.2272273e-01, 1.8065984e-02),
                    (937.0, 2.1197402e-01, 7.7469009e-03),
                    (1395.0, 2.2354687e-03, 3.9642993e-05),
                    (2100.0, 6.9493306e-02, 6.7909764e-04),
                    (4000.0, 7.4933229e-03, 2.6494697e-05),
                ],
            ),
        ];
        for (atmosphere, light, goldens) in cases {
            let spectrum = atmosphere.irradiance(&light);
            let cos_zenith = light.elevation.to_radians().sin();
            for (wavelength, direct, diffuse) in goldens {
                let found = spectrum.iter().find(|s| s.wavelength == wavelength).unwrap();
                assert!((found.direct_normal / direct - 1.0).abs() < 1e-6, "{direct} {found:?}");
                assert!((found.diffuse_horizontal / diffuse - 1.0).abs() < 1e-6, "{diffuse} {found:?}");
                let global = found.direct_normal * cos_zenith + found.diffuse_horizontal;
                assert!((found.global_horizontal / global - 1.0).abs() < 1e-9, "{found:?}");
            }
        }
    }

    #[test]
    fn spectra_are_tables_of_the_irradiance() {
        let light = Daylight { elevation: 30.0, distance: 1.0 };
        let spectra = Atmosphere::default().spectra(&light);
        for row in Atmosphere::default().irradiance(&light) {
            let at = row.wavelength as f32;
            for (spectrum, expected) in [
                (&spectra.direct_normal, row.direct_normal),
                (&spectra.diffuse_horizontal, row.diffuse_horizontal),
                (&spectra.global_horizontal, row.global_horizontal),
            ] {
                assert!((f64::from(spectrum.at(at)) - expected).abs() <= 1e-6 * expected, "{row:?}");
            }
        }
        // The clear-day formula of the IES: 127.5 klx e^(-0.21 m) at the air mass m = 2.
        let lux = crate::units::LUMENS_PER_WATT * spectra.direct_normal.photometric_integral();
        assert!((lux / (127_500.0 * (-0.42_f32).exp()) - 1.0).abs() < 0.1, "{lux}");
    }

    #[test]
    fn nothing_is_more_than_what_arrives_from_space() {
        for elevation in [0.0, 0.5, 20.0, 90.0] {
            for turbidity in [0.0, 0.3, 1.0] {
                let atmosphere = Atmosphere { turbidity, ground_reflectance: 1.0, ..Atmosphere::default() };
                let light = Daylight { elevation, distance: 1.0 };
                for (s, row) in atmosphere.irradiance(&light).iter().zip(TABLE) {
                    assert!(s.direct_normal >= 0.0 && s.diffuse_horizontal >= 0.0, "{s:?}");
                    assert!(s.direct_normal <= row[1], "{s:?}");
                }
            }
        }
    }
}
