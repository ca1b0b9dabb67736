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
