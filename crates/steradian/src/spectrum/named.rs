//! The built-in spectra: those of pbrt-v4 under its names, and measured indices of refraction under names of our own.

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

/// pbrt's, with pbrt's figures, so that its pictures come out equal.
const PBRT: &[(&str, &str)] = tables![
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

/// More light sources of the CIE, with the same normalisation.
const LIGHTS: &[(&str, &str)] = tables![
    "stdillum-C",
    "stdillum-D55",
    "stdillum-D75",
    "stdillum-HP1",
    "stdillum-HP2",
    "stdillum-HP3",
    "stdillum-HP4",
    "stdillum-HP5",
    "stdillum-LED-B1",
    "stdillum-LED-B2",
    "stdillum-LED-B3",
    "stdillum-LED-B4",
    "stdillum-LED-B5",
    "stdillum-LED-BH1",
    "stdillum-LED-RGB1",
    "stdillum-LED-V1",
    "stdillum-LED-V2",
];

/// Ours. A metal or semiconductor has `-eta` and `-k`; a transparent medium has its index under its own name and, where
/// its absorption is known, `-k`.
const MEASURED: &[(&str, &str)] = tables![
    "metal-Ti-eta",
    "metal-Ti-k",
    "metal-V-eta",
    "metal-V-k",
    "metal-Cr-eta",
    "metal-Cr-k",
    "metal-Mn-eta",
    "metal-Mn-k",
    "metal-Fe-eta",
    "metal-Fe-k",
    "metal-Co-eta",
    "metal-Co-k",
    "metal-Ni-eta",
    "metal-Ni-k",
    "metal-Pd-eta",
    "metal-Pd-k",
    "metal-Pt-eta",
    "metal-Pt-k",
    "metal-W-eta",
    "metal-W-k",
    "metal-Mo-eta",
    "metal-Mo-k",
    "metal-Mg-eta",
    "metal-Mg-k",
    "metal-Be-eta",
    "metal-Be-k",
    "metal-Ir-eta",
    "metal-Ir-k",
    "metal-Rh-eta",
    "metal-Rh-k",
    "metal-Nb-eta",
    "metal-Nb-k",
    "metal-Zr-eta",
    "metal-Zr-k",
    "metal-In-eta",
    "metal-In-k",
    "metal-Pb-eta",
    "metal-Pb-k",
    "metal-Hg-eta",
    "metal-Hg-k",
    "metal-Na-eta",
    "metal-Na-k",
    "metal-K-eta",
    "metal-K-k",
    "metal-Bi-eta",
    "metal-Bi-k",
    "metal-Ag-Johnson-eta",
    "metal-Ag-Johnson-k",
    "metal-Au-Johnson-eta",
    "metal-Au-Johnson-k",
    "metal-Cu-Johnson-eta",
    "metal-Cu-Johnson-k",
    "metal-Al-McPeak-eta",
    "metal-Al-McPeak-k",
    "metal-Cu90Zn10-eta",
    "metal-Cu90Zn10-k",
    "metal-stainless-eta",
    "metal-stainless-k",
    "metal-TiN-eta",
    "metal-TiN-k",
    "metal-AuAl2-eta",
    "metal-AuAl2-k",
    "semiconductor-Si-eta",
    "semiconductor-Si-k",
    "semiconductor-Ge-eta",
    "semiconductor-Ge-k",
    "semiconductor-GaAs-eta",
    "semiconductor-GaAs-k",
    "semiconductor-graphite-eta",
    "semiconductor-graphite-k",
    "glass-F2",
    "glass-K10",
    "glass-LF5",
    "glass-LLF1",
    "glass-SF1",
    "glass-SF2",
    "glass-N-BAK4",
    "glass-N-FK5",
    "glass-N-K5",
    "glass-N-KZFS4",
    "glass-N-LAF2",
    "glass-N-LAK9",
    "glass-N-LASF44",
    "glass-N-PK52A",
    "glass-N-SK16",
    "glass-N-SSK5",
    "glass-silica",
    "glass-soda-lime",
    "glass-soda-lime-k",
    "liquid-water",
    "liquid-water-k",
    "liquid-ethanol",
    "liquid-ethanol-k",
    "liquid-isopropanol",
    "liquid-isopropanol-k",
    "liquid-ethylene-glycol",
    "liquid-ethylene-glycol-k",
    "liquid-carbon-disulfide",
    "liquid-dichloromethane",
    "liquid-dimethyl-sulfoxide",
    "liquid-ethyl-acetate",
    "liquid-tetrahydrofuran",
    "liquid-xylene",
    "crystal-diamond",
    "crystal-ice",
    "crystal-ice-k",
    "crystal-sapphire-o",
    "crystal-sapphire-e",
    "crystal-quartz-o",
    "crystal-quartz-e",
    "crystal-calcite-o",
    "crystal-calcite-e",
    "crystal-CaF2",
    "crystal-MgF2-o",
    "crystal-MgF2-e",
    "crystal-BaF2",
    "crystal-LiF",
    "crystal-NaCl",
    "crystal-KCl",
    "crystal-KBr",
    "crystal-spinel",
    "crystal-BGO",
    "plastic-PMMA",
    "plastic-PDMS",
    "plastic-PVA",
    "plastic-SU8",
    "film-HfO2",
    "film-ITO",
    "film-ITO-k",
    "film-Nb2O5",
    "film-Si3N4",
    "film-Ta2O5",
    "film-TiO2",
];

/// The glasses that go by their melt's full name too.
const ALIASES: &[(&str, &str)] =
    &[("glass-SF5", "glass-F5"), ("glass-SF10", "glass-F10"), ("glass-SF11", "glass-F11")];

/// The built-in spectrum called `name`; `None` if there is none.
///
/// Indices of refraction and extinction coefficients are tables; those of the glasses follow the makers'
/// dispersion formulas. Illuminants are normalised to ∫ l ȳ dλ = 106.856895 nm, that is Y = 1. Those of pbrt and illuminants are held at
/// their end values as far as 360 and 830 nm, pbrt's rule (fluorescent lamps end at 780 nm); the other ones of ours reach that far by
/// themselves, and end where their data end ([`Spectrum::range`]).
pub fn named(name: &str) -> Option<Spectrum> {
    let name = canonical(name);
    if let Some((_, text)) = MEASURED.iter().find(|t| t.0 == name) {
        return spd::parse(text).ok().map(Spectrum::Tabulated);
    }
    let text = PBRT.iter().chain(LIGHTS).find(|t| t.0 == name)?.1;
    let table = spd::parse(text).ok()?.held_to(LAMBDA_MIN, LAMBDA_MAX);
    if !(name.starts_with("stdillum-") || name.starts_with("illum-")) {
        return Some(Spectrum::Tabulated(table));
    }
    let integral = cie::luminous_integral(|l| table.at(l));
    Some(Spectrum::Tabulated(table.scaled(cie::Y_INTEGRAL / integral)))
}

fn canonical(name: &str) -> &str {
    ALIASES.iter().find(|a| a.0 == name).map_or(name, |a| a.1)
}

/// The names that [`named`] knows, aliases last.
pub fn names() -> impl Iterator<Item = &'static str> {
    tables().map(|t| t.0).chain(ALIASES.iter().map(|a| a.0))
}

fn tables() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    PBRT.iter().chain(LIGHTS).chain(MEASURED)
}

/// Where a built-in spectrum comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// What it is, with the range of the original data.
    pub about: &'static str,
    /// The collection that it was taken from, with its version.
    pub source: &'static str,
    /// The publication of the measurement, where the collection names one.
    pub reference: Option<&'static str>,
    /// The licence of the figures, where the collection states one.
    pub licence: Option<&'static str>,
    /// State, preparation or composition of the sample, where it is known.
    pub sample: Option<&'static str>,
}

/// Where the built-in spectrum called `name` comes from; `None` if there is no such spectrum.
pub fn provenance(name: &str) -> Option<Provenance> {
    let text = tables().find(|t| t.0 == canonical(name))?.1;
    let mut comments = text.lines().map_while(|l| l.strip_prefix("# "));
    let about = comments.next()?;
    let line = |label: &str| comments.clone().find_map(|l| l.strip_prefix(label)).map(str::trim);
    Some(Provenance {
        about,
        source: line("Source:")?,
        reference: line("Reference:"),
        licence: line("Licence:"),
        sample: line("Sample:"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_data_over_the_visible_range() {
        assert_eq!(names().count(), 7 + 14 + 15 + 1 + LIGHTS.len() + 3 + MEASURED.len());
        for name in names() {
            let (lo, hi) = named(name).unwrap_or_else(|| panic!("{name}")).range().unwrap();
            assert!(lo <= 360.0 && hi >= 830.0, "{name}: {lo}..{hi}");
        }
        assert_eq!(named("glass-F5"), named("glass-SF5"));
        assert_eq!(named("metal-Unobtainium-k"), None);
    }

    #[test]
    fn every_table_names_its_source_and_the_script_that_wrote_it() {
        for (name, text) in tables() {
            assert!(provenance(name).is_some(), "{name}");
            assert!(text.contains("# Source: ") && text.contains("# Written by xtask/tables/"), "{name}");
        }
        assert_eq!(provenance("glass-SF11"), provenance("glass-F11"));
        assert_eq!(provenance("metal-Unobtainium-k"), None);
    }

    #[test]
    fn every_measured_table_names_its_publication_and_licence() {
        for (name, _) in MEASURED {
            let from = provenance(name).unwrap();
            assert!(from.reference.is_some_and(|r| r.len() > 15), "{name}: {from:?}");
            assert_eq!(from.licence, Some("CC0-1.0."), "{name}");
            assert!(from.source.contains("refractiveindex.info"), "{name}");
        }
        let titanium = provenance("metal-Ti-eta").unwrap();
        assert!(titanium.reference.unwrap().contains("doi:10.1103/PhysRevB.9.5056"), "{titanium:?}");
        assert_eq!(titanium.about, "Titanium: refractive index, measured or compiled over 188-1937 nm.");
    }

    #[test]
    fn measured_tables_are_not_extrapolated_and_every_eta_of_a_metal_has_its_k() {
        for (name, _) in MEASURED {
            let s = named(name).unwrap();
            let (lo, hi) = s.range().unwrap();
            assert!(lo >= 200.0 && hi <= 2500.0 && s.at(lo - 1.0) == 0.0 && s.at(hi + 1.0) == 0.0, "{name}");
            let bounds = if name.ends_with("-k") { 0.0..30.0 } else { 0.02..12.0 };
            assert!((lo as u32 + 1..hi as u32).all(|l| bounds.contains(&s.at(l as f32))), "{name}");
            if let Some(stem) = name.strip_suffix("-eta") {
                let k = named(&format!("{stem}-k")).unwrap();
                assert!(k.range().unwrap().0 <= 360.0 && k.range().unwrap().1 >= 830.0, "{name}");
            }
        }
    }

    #[test]
    fn newer_measurements_of_pbrts_metals_reflect_as_the_older_ones() {
        let reflectance = |metal: &str, l: f32| {
            let n = named(&format!("{metal}-eta")).unwrap().at(l);
            let k = named(&format!("{metal}-k")).unwrap().at(l);
            ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
        };
        // They differ by up to a tenth in the blue, where silver tarnishes and gold absorbs.
        for (new, old) in [
            ("metal-Ag-Johnson", "metal-Ag"),
            ("metal-Au-Johnson", "metal-Au"),
            ("metal-Cu-Johnson", "metal-Cu"),
            ("metal-Al-McPeak", "metal-Al"),
        ] {
            for l in [450.0, 500.0, 600.0, 700.0] {
                let (a, b) = (reflectance(new, l), reflectance(old, l));
                assert!((a - b).abs() < 0.1, "{new} at {l} nm: {a} {b}");
            }
        }
        // Chromium 0.55, nickel 0.64, iron 0.51, platinum 0.7, rhodium 0.77, mercury 0.78, tungsten 0.5 in the green.
        for (metal, expected) in
            [("Cr", 0.55), ("Ni", 0.63), ("Fe", 0.52), ("Pt", 0.72), ("Rh", 0.77), ("Hg", 0.78), ("W", 0.49)]
        {
            let r = reflectance(&format!("metal-{metal}"), 550.0);
            assert!((r - expected).abs() < 0.03, "{metal}: {r}");
        }
    }

    #[test]
    fn clear_media_have_their_handbook_indices() {
        // At the sodium D line (589.3 nm), CRC Handbook and the data sheets of the makers.
        for (name, n_d, tolerance) in [
            ("liquid-water", 1.333_0, 5e-4),
            ("liquid-ethanol", 1.361, 2e-3),
            ("liquid-carbon-disulfide", 1.627, 3e-3),
            ("crystal-diamond", 2.417, 2e-3),
            ("crystal-ice", 1.309, 2e-3),
            ("crystal-quartz-o", 1.544_2, 5e-4),
            ("crystal-quartz-e", 1.553_3, 5e-4),
            ("crystal-calcite-o", 1.658_4, 5e-4),
            ("crystal-calcite-e", 1.486_4, 5e-4),
            ("crystal-sapphire-o", 1.768, 1e-3),
            ("crystal-sapphire-e", 1.760, 1e-3),
            ("crystal-NaCl", 1.544_3, 5e-4),
            ("crystal-CaF2", 1.433_8, 2e-4),
            ("glass-silica", 1.458_5, 2e-4),
            ("glass-F2", 1.619_9, 2e-4),
            ("glass-soda-lime", 1.52, 5e-3),
        ] {
            let n = named(name).unwrap().at(589.3);
            assert!((n - n_d).abs() < tolerance, "{name}: {n}");
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
        for name in names().filter(|n| n.starts_with("glass-") && !n.ends_with("-k")) {
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
