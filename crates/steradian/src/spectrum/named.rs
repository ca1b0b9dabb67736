//! The built-in spectra, under pbrt-v4's names.

use super::cie;
use super::function::Spectrum;
use super::sampled::{LAMBDA_MAX, LAMBDA_MIN};
use super::spd;

/// Pairs each name with the text of its table.
macro_rules! tables {
    ($($name:literal,)*) => {
        &[$(($name, include_str!(concat!("../../data/spectra/", $name, ".spd"))),)*]
    };
}

const TABLES: &[(&str, &str)] = tables![
    "glass-BK7",
    "glass-BAF10",
    "glass-FK51A",
    "glass-LASF9",
    "glass-F5",
    "glass-F10",
    "glass-F11",
    "metal-Ag-eta",
    "metal-Ag-k",
    "metal-Al-eta",
    "metal-Al-k",
    "metal-Au-eta",
    "metal-Au-k",
    "metal-Cu-eta",
    "metal-Cu-k",
    "metal-CuZn-eta",
    "metal-CuZn-k",
    "metal-MgO-eta",
    "metal-MgO-k",
    "metal-TiO2-eta",
    "metal-TiO2-k",
    "stdillum-A",
    "stdillum-D50",
    "stdillum-D65",
    "stdillum-F1",
    "stdillum-F2",
    "stdillum-F3",
    "stdillum-F4",
    "stdillum-F5",
    "stdillum-F6",
    "stdillum-F7",
    "stdillum-F8",
    "stdillum-F9",
    "stdillum-F10",
    "stdillum-F11",
    "stdillum-F12",
    "illum-acesD60",
];

/// The glasses that go by their melt's full name too.
const ALIASES: &[(&str, &str)] =
    &[("glass-SF5", "glass-F5"), ("glass-SF10", "glass-F10"), ("glass-SF11", "glass-F11")];

/// The built-in spectrum called `name`; `None` if there is none.
///
/// Indices of refraction and extinction coefficients are tables; those of the glasses follow the makers'
/// dispersion formulas. Illuminants are normalised to ∫ l ȳ dλ = 106.856895 nm, that is Y = 1. All are held at
/// their end values as far as 360 and 830 nm, pbrt's rule (its fluorescent lamps end at 780 nm).
pub fn named(name: &str) -> Option<Spectrum> {
    let name = ALIASES.iter().find(|a| a.0 == name).map_or(name, |a| a.1);
    let text = TABLES.iter().find(|t| t.0 == name)?.1;
    let table = spd::parse(text).ok()?.held_to(LAMBDA_MIN, LAMBDA_MAX);
    if !(name.starts_with("stdillum-") || name.starts_with("illum-")) {
        return Some(Spectrum::Tabulated(table));
    }
    let integral = cie::luminous_integral(|l| table.at(l));
    Some(Spectrum::Tabulated(table.scaled(cie::Y_INTEGRAL / integral)))
}

/// The names that [`named`] knows, aliases last.
pub fn names() -> impl Iterator<Item = &'static str> {
    TABLES.iter().map(|t| t.0).chain(ALIASES.iter().map(|a| a.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_data_over_the_visible_range() {
        assert_eq!(names().count(), 7 + 14 + 15 + 1 + 3);
        for name in names() {
            let (lo, hi) = named(name).unwrap_or_else(|| panic!("{name}")).range().unwrap();
            assert!(lo <= 360.0 && hi >= 830.0, "{name}: {lo}..{hi}");
        }
        assert_eq!(named("glass-F5"), named("glass-SF5"));
        assert_eq!(named("metal-Unobtainium-k"), None);
    }

    #[test]
    fn every_table_names_its_source_and_the_script_that_wrote_it() {
        for (name, text) in TABLES {
            assert!(text.contains("# Source: ") && text.contains("# Written by xtask/tables/"), "{name}");
        }
    }

    #[test]
    fn glasses_have_their_catalogue_indices() {
        // Schott data sheets: n_d at 587.5618 nm, then n_F' at 479.9914 nm and n_C' at 643.8469 nm for N-BK7.
        for (name, n_d) in [
            ("glass-BK7", 1.516_80),
            ("glass-BAF10", 1.670_03),
            ("glass-FK51A", 1.486_56),
            ("glass-LASF9", 1.850_25),
            ("glass-F5", 1.672_71),
            ("glass-F10", 1.728_28),
            ("glass-F11", 1.784_72),
        ] {
            assert!((named(name).unwrap().at(587.5618) - n_d).abs() < 2e-5, "{name}");
        }
        let bk7 = named("glass-BK7").unwrap();
        assert!((bk7.at(479.9914) - 1.522_83).abs() < 2e-5 && (bk7.at(643.8469) - 1.514_72).abs() < 2e-5);
    }

    #[test]
    fn glasses_disperse_normally() {
        for name in names().filter(|n| n.starts_with("glass-")) {
            let s = named(name).unwrap();
            assert!((380..830).all(|l| s.at(l as f32) > s.at((l + 1) as f32)), "{name}");
        }
    }

    #[test]
    fn metals_reflect_as_measured() {
        // Normal-incidence Fresnel reflectance at 633 nm (Johnson & Christy; Rakić): silver and gold above 0.92, copper
        // 0.93–0.96, aluminium 0.91; gold and copper lose the blue.
        let reflectance = |metal: &str, l: f32| {
            let n = named(&format!("metal-{metal}-eta")).unwrap().at(l);
            let k = named(&format!("metal-{metal}-k")).unwrap().at(l);
            ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
        };
        for (metal, lo, hi) in
            [("Ag", 0.96, 0.99), ("Au", 0.92, 0.97), ("Cu", 0.92, 0.97), ("Al", 0.89, 0.93)]
        {
            let r = reflectance(metal, 633.0);
            assert!((lo..hi).contains(&r), "{metal}: {r}");
        }
        assert!(
            reflectance("Au", 450.0) < 0.5
                && reflectance("Cu", 450.0) < 0.65
                && reflectance("CuZn", 450.0) < 0.6
        );
        for name in names().filter(|n| n.starts_with("metal-")) {
            let s = named(name).unwrap();
            assert!((360..=830).all(|l| (0.0..12.0).contains(&s.at(l as f32))), "{name}");
        }
    }

    #[test]
    fn illuminants_have_unit_luminance_and_no_negative_power() {
        for name in names().filter(|n| n.contains("illum-")) {
            let s = named(name).unwrap();
            assert!((s.photometric_integral() / cie::Y_INTEGRAL - 1.0).abs() < 1e-6, "{name}");
            assert!((360..=830).all(|l| s.at(l as f32) >= 0.0), "{name}");
        }
    }

    #[test]
    fn illuminant_a_follows_its_definition() {
        // CIE 15:2018, 4.1.1: Planck at 2848 K with c₂ = 1.435·10⁷ nm·K, 100 at 560 nm.
        let planck = |l: f32| {
            (560.0 / l).powi(5) * (1.435e7_f32 / (2848.0 * 560.0)).exp_m1()
                / (1.435e7 / (2848.0 * l)).exp_m1()
        };
        let a = named("stdillum-A").unwrap();
        for l in [360.0, 400.0, 500.0, 780.0, 830.0] {
            assert!((a.at(l) / a.at(560.0) / planck(l) - 1.0).abs() < 1e-4, "{l}");
        }
    }
}
