//! `Material "leaf"`: what a leaf reflects and transmits, from what it holds.

use super::declared::Declared;
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, DiffuseTransmission};
use crate::optics::plate::{Absorber, Coefficients, Leaf};
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, Tabulated};
use crate::texture::SpectrumInput;

/// Wavelengths [nm] that a table must reach for a material, as those of measurements must: its ends are held over the rest of
/// the film's range.
const NEEDED: [f64; 2] = [420.0, 680.0];

/// Wavelengths [nm] between rows are taken at whole nanometres, within what instruments ask for.
const FINE: std::ops::RangeInclusive<u16> = 200..=2500;

/// A leaf by the generalised plate model, [`crate::optics::plate`], with its shares of power given to Lambert's law on both
/// sides: the model is silent about directions. Both sides are alike.
#[derive(Clone, Debug, PartialEq)]
pub struct LeafMaterial {
    /// Reflectance over wavelength, with its ends held over 360–830 nm.
    reflectance: SpectrumInput,
    /// Transmittance, likewise.
    transmittance: SpectrumInput,
    /// First and last wavelength [nm] of the coefficients.
    range: (f32, f32),
}

/// An amount among the parameters.
struct Amount {
    parameter: &'static str,
    absorber: Absorber,
    /// That of a healthy leaf, where nothing is stated.
    default: f64,
}

const AMOUNTS: [Amount; 8] = [
    Amount::of("chlorophyll", Absorber::Chlorophyll, 40.0),
    Amount::of("carotenoids", Absorber::Carotenoids, 8.0),
    Amount::of("anthocyanins", Absorber::Anthocyanins, 0.0),
    Amount::of("brown", Absorber::Brown, 0.0),
    Amount::of("water", Absorber::Water, 0.015),
    Amount::of("drymatter", Absorber::DryMatter, 0.009),
    Amount::of("proteins", Absorber::Proteins, 0.0),
    Amount::of("carbonbased", Absorber::CarbonBased, 0.0),
];

impl Amount {
    const fn of(parameter: &'static str, absorber: Absorber, default: f64) -> Self {
        Self { parameter, absorber, default }
    }
}

impl Declared for LeafMaterial {
    const CLASS: &'static str = "leaf";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::file("coefficients"),
        Parameter::number("structure", 1.5, 1.0, 10.0),
        Parameter::number_opt("chlorophyll", 0.0, 1000.0),
        Parameter::number_opt("carotenoids", 0.0, 1000.0),
        Parameter::number_opt("anthocyanins", 0.0, 1000.0),
        Parameter::number_opt("brown", 0.0, 100.0),
        Parameter::number_opt("water", 0.0, 10.0),
        Parameter::number_opt("drymatter", 0.0, 10.0),
        Parameter::number_opt("proteins", 0.0, 10.0),
        Parameter::number_opt("carbonbased", 0.0, 10.0),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let table = coefficients(arguments)?;
        let leaf = leaf(arguments, &table)?;
        Ok(Self::new(&leaf, &table))
    }

    fn is_textured(&self) -> bool {
        false
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::DiffuseTransmission(DiffuseTransmission {
            reflectance: lookup.reflectance(&self.reflectance),
            transmittance: lookup.reflectance(&self.transmittance),
        }))
    }
}

impl LeafMaterial {
    /// The leaf at the wavelengths of the table.
    pub fn new(leaf: &Leaf, table: &Coefficients) -> Self {
        let mut wavelengths: Vec<f64> =
            FINE.map(f64::from).chain(table.wavelengths().iter().copied()).collect();
        wavelengths.sort_by(f64::total_cmp);
        // Neighbours that f32 cannot tell apart would make a step without width.
        wavelengths.dedup_by_key(|l| *l as f32);
        let (mut reflectance, mut transmittance) = (Vec::new(), Vec::new());
        for lambda in wavelengths {
            if let Some(shares) = leaf.shares(table, lambda) {
                reflectance.push((lambda as f32, shares.reflectance as f32));
                transmittance.push((lambda as f32, shares.transmittance as f32));
            }
        }
        let (first, last) = table.range();
        Self {
            reflectance: held(&reflectance),
            transmittance: held(&transmittance),
            range: (first as f32, last as f32),
        }
    }

    /// The wavelengths for which there are coefficients [nm]. Over the rest of 360–830 nm pictures see the values at the ends.
    pub fn range(&self) -> (f32, f32) {
        self.range
    }
}

fn held(pairs: &[(f32, f32)]) -> SpectrumInput {
    // Tables have two rows at least, and their wavelengths increase.
    let spectrum = Tabulated::new(pairs)
        .map_or(Spectrum::Constant(0.0), |t| Spectrum::Tabulated(t.held_to(LAMBDA_MIN, LAMBDA_MAX)));
    SpectrumInput::Constant(spectrum)
}

fn coefficients(arguments: &Arguments) -> Result<Coefficients, Fault> {
    let file = arguments.file("coefficients");
    let name = file.path.display();
    let fault = |e: &dyn std::fmt::Display| {
        Fault::new("coefficients", format!("cannot read coefficients {name}: {e}"))
    };
    let text = std::str::from_utf8(&file.bytes).map_err(|_| fault(&"this is not a text file"))?;
    let table = Coefficients::parse(text).map_err(|e| fault(&e))?;
    let (first, last) = table.range();
    if first > NEEDED[0] || last < NEEDED[1] {
        let [from, to] = NEEDED;
        return Err(fault(&format_args!(
            "the wavelengths {first}–{last} nm do not cover {from}–{to} nm, and nothing is extrapolated"
        )));
    }
    Ok(table)
}

fn leaf(arguments: &Arguments, table: &Coefficients) -> Result<Leaf, Fault> {
    let parts = ["proteins", "carbonbased"];
    let in_parts = parts.iter().any(|name| arguments.given(name));
    if in_parts && arguments.given("drymatter") {
        let message = "\"drymatter\" is all of it: give it, or \"proteins\" and \"carbonbased\", not both";
        return Err(Fault::new("drymatter", message));
    }
    let mut leaf = Leaf::new(f64::from(arguments.number("structure")));
    for Amount { parameter, absorber, default } in AMOUNTS {
        let stated = arguments.number_opt(parameter).map(f64::from);
        if stated.is_some_and(|x| x > 0.0) && !table.has(absorber) {
            let message = format!(
                "the table of coefficients has no column `{}` for \"{parameter}\"",
                absorber.column()
            );
            return Err(Fault::new(parameter, message));
        }
        let default = if in_parts && absorber == Absorber::DryMatter { 0.0 } else { default };
        leaf = leaf.with(absorber, stated.unwrap_or(default));
    }
    Ok(leaf)
}
