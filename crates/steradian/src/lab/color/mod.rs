//! The colour of light and of things, from their spectra.

pub mod diagram;
pub mod input;

pub use diagram::{Spot, diagram};
pub use input::{Choice, SpectralData, SpectrumError};

use super::table::{Cell, Column, Table};
use crate::color::colorimetry::{
    ColorRendering, ColorTemperature, LitSamples, Resampling, SAMPLES, Tristimulus, rendering::test_colors,
};
use crate::spectrum::cie;
use crate::units::{Estimate, LUMENS_PER_WATT};

/// The colour of a light source.
#[derive(Clone, Debug, PartialEq)]
pub struct LightColor {
    /// Unit of X, Y and Z: `lx`, `cd·m⁻²`, … where the spectrum states amounts; `None` for a shape, whose Y is 100.
    pub unit: Option<&'static str>,
    /// X, Y, Z.
    pub xyz: [Estimate; 3],
    /// x, y, u′, v′; `None` for no light.
    pub chromaticity: Option<[Estimate; 4]>,
    /// Correlated colour temperature [K] and Duv [1]; `None` too far from the Planckian locus.
    pub temperature: Option<[Estimate; 2]>,
    /// Colour rendering; `None` without a temperature, or above 25000 K.
    pub rendering: Option<Rendering>,
    /// What spectrum this is.
    pub extent: Extent,
}

/// Colour rendering with intervals, CIE 13.3-1995.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Ra.
    pub general: Estimate,
    /// R1 to R14.
    pub special: [Estimate; SAMPLES],
    /// Distance of source and reference in the 1960 diagram; the method wants at most 5.4·10⁻³.
    pub chromaticity_difference: f64,
}

/// The colour of a thing under an illuminant.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectColor {
    /// X, Y, Z; the perfect diffuser has Y = 100.
    pub xyz: [Estimate; 3],
    /// x, y, u′, v′; `None` for black.
    pub chromaticity: Option<[Estimate; 4]>,
    /// L*, a*, b* under the illuminant; `None` for an illuminant that is black in a channel.
    pub lab: Option<[Estimate; 3]>,
    /// The reflectance's wavelengths.
    pub extent: Extent,
}

/// How the errors of the rows of a spectrum go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Noise {
    /// In a way that is not known: intervals of results are as wide as the least favourable way makes them. Readings of one
    /// simulation share their paths, so that their errors rise and fall together.
    #[default]
    Unknown,
    /// Each by itself, as those of a detector behind a monochromator.
    Independent,
}

/// What a spectrum covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// First and last wavelength [nm].
    pub range: [f64; 2],
    /// How values between its wavelengths are found.
    pub interpolation: &'static str,
    /// Whether its values have intervals.
    pub has_intervals: bool,
}

/// A chromaticity difference above which colour rendering indices lie outside of their method (CIE 13.3, 5.3).
const RENDERING_TOLERANCE: f64 = 5.4e-3;

/// The colour of light from its spectrum.
///
/// Between wavelengths by straight lines, beyond the ends by holding the end values (CIE 15:2018, 7.2), summed at 1 nm over
/// 360–830 nm. Intervals of the values are carried on to first order.
pub fn light(data: &SpectralData, noise: Noise) -> LightColor {
    let map = Resampling::linear(&data.wavelengths);
    let spectrum = map.apply(&values(data));
    let colors = test_colors();
    let lit = LitSamples::under(|i| spectrum[i], &colors);
    let numbers: Vec<f64> =
        std::iter::once(lit.white).chain(lit.samples).flat_map(|t| [t.x, t.y, t.z]).collect();
    let line = Linear::new(data, noise, numbers, |k| {
        let (sample, channel) = (k / 3, k % 3);
        map.weights(|i| {
            let factor = if sample == 0 { 1.0 } else { colors[sample - 1][i] };
            factor * f64::from(cie::table()[i][channel])
        })
    });
    let white = |n: &[f64]| Tristimulus::new(n[0], n[1], n[2]);
    let unit = photometric(data.unit.as_deref());
    let xyz = match unit {
        Some(_) => line.estimate(|n| {
            let w = white(n).scaled(LUMENS_PER_WATT.into());
            Some([w.x, w.y, w.z])
        }),
        None => line.estimate(|n| {
            let w = white(n);
            (w.y > 0.0).then(|| [100.0 * w.x / w.y, 100.0, 100.0 * w.z / w.y])
        }),
    };
    let temperature = |n: &[f64]| {
        let t = ColorTemperature::of(white(n).uv1960()?)?;
        Some([t.kelvin, t.duv])
    };
    let rendering = |n: &[f64]| {
        let sample = |k: usize| Tristimulus::new(n[3 * k + 3], n[3 * k + 4], n[3 * k + 5]);
        let lit = LitSamples { white: white(n), samples: std::array::from_fn(sample) };
        ColorRendering::of(&lit, &colors)
    };
    let indices = line.estimate(|n| {
        let r = rendering(n)?;
        let mut all = [r.general(); SAMPLES + 1];
        all[1..].copy_from_slice(&r.special);
        Some(all)
    });
    let difference = rendering(&line.numbers).map_or(0.0, |r| r.chromaticity_difference);
    LightColor {
        unit,
        xyz: xyz.unwrap_or_default(),
        chromaticity: line.estimate(|n| chromaticity(white(n))),
        temperature: line.estimate(temperature),
        rendering: indices.map(|all| Rendering {
            general: all[0],
            special: std::array::from_fn(|k| all[k + 1]),
            chromaticity_difference: difference,
        }),
        extent: extent(data, "straight lines"),
    }
}

/// The colour of a reflectance (or transmittance) under an illuminant, CIE 15:2018 (7.1)–(7.4).
///
/// Equidistant reflectances are interpolated by Sprague's polynomials, others by straight lines; the illuminant counts as exact.
pub fn object(reflectance: &SpectralData, illuminant: &SpectralData, noise: Noise) -> ObjectColor {
    let source = Resampling::linear(&illuminant.wavelengths).apply(&values(illuminant));
    let (map, interpolation) = match Resampling::sprague(&reflectance.wavelengths) {
        Some(map) => (map, "Sprague's polynomials"),
        None => (Resampling::linear(&reflectance.wavelengths), "straight lines"),
    };
    let white = Tristimulus::of(|i| source[i]);
    let scale = if white.y > 0.0 { 100.0 / white.y } else { 0.0 };
    let white = white.scaled(scale);
    let factors = map.apply(&values(reflectance));
    let xyz = Tristimulus::of(|i| source[i] * factors[i]).scaled(scale);
    let line = Linear::new(reflectance, noise, vec![xyz.x, xyz.y, xyz.z], |k| {
        map.weights(|i| scale * source[i] * f64::from(cie::table()[i][k]))
    });
    let color = |n: &[f64]| Tristimulus::new(n[0], n[1], n[2]);
    ObjectColor {
        xyz: line.estimate(|n| Some([n[0], n[1], n[2]])).unwrap_or_default(),
        chromaticity: line.estimate(|n| chromaticity(color(n))),
        lab: line.estimate(|n| color(n).lab(white).map(|c| [c.l, c.a, c.b])),
        extent: extent(reflectance, interpolation),
    }
}

fn values(data: &SpectralData) -> Vec<f64> {
    data.values.iter().map(|e| e.value).collect()
}

fn extent(data: &SpectralData, interpolation: &'static str) -> Extent {
    let [first, last] =
        [data.wavelengths.first(), data.wavelengths.last()].map(|l| l.copied().unwrap_or(0.0));
    let has_intervals = data.values.iter().any(|e| e.half_width > 0.0);
    Extent { range: [first, last], interpolation, has_intervals }
}

fn chromaticity(t: Tristimulus) -> Option<[f64; 4]> {
    let (xy, uv) = (t.xy()?, t.uv1976()?);
    Some([xy.x, xy.y, uv.u, uv.v])
}

/// The photometric unit that belongs to a spectral one.
fn photometric(unit: Option<&str>) -> Option<&'static str> {
    match unit? {
        "W·m⁻²·nm⁻¹" => Some("lx"),
        "W·m⁻²·sr⁻¹·nm⁻¹" => Some("cd·m⁻²"),
        "W·sr⁻¹·nm⁻¹" => Some("cd"),
        "W·nm⁻¹" => Some("lm"),
        _ => None,
    }
}

/// Numbers that depend linearly on the rows of a table, and what follows from them.
struct Linear {
    numbers: Vec<f64>,
    /// Half-width of each row times its weight in each number.
    spread: Vec<Vec<f64>>,
    noise: Noise,
}

impl Linear {
    /// `weights` gives the weight of each row in a number.
    fn new(
        data: &SpectralData,
        noise: Noise,
        numbers: Vec<f64>,
        weights: impl Fn(usize) -> Vec<f64>,
    ) -> Self {
        let mut spread = Vec::new();
        if data.values.iter().any(|e| e.half_width > 0.0) {
            let scaled = |w: Vec<f64>| w.iter().zip(&data.values).map(|(w, e)| w * e.half_width).collect();
            spread.extend((0..numbers.len()).map(|k| scaled(weights(k))));
        }
        Self { numbers, spread, noise }
    }

    /// Functions of the numbers, their intervals by the slopes of the functions; `None` where there is no value.
    fn estimate<const N: usize>(&self, f: impl Fn(&[f64]) -> Option<[f64; N]>) -> Option<[Estimate; N]> {
        let value = f(&self.numbers)?;
        if self.spread.is_empty() {
            return Some(value.map(Estimate::exact));
        }
        let size = self.numbers.iter().map(|n| n.abs()).fold(0.0, f64::max);
        let mut rows = vec![[0.0; N]; self.spread[0].len()];
        let mut moved = self.numbers.clone();
        for (k, spread) in self.spread.iter().enumerate() {
            let step = 1e-5 * size;
            moved[k] = self.numbers[k] + step;
            let above = f(&moved);
            moved[k] = self.numbers[k] - step;
            let below = f(&moved);
            moved[k] = self.numbers[k];
            // Where a neighbour has no value, nothing is known about the width.
            let (Some(above), Some(below)) = (above, below) else {
                return Some(value.map(|value| Estimate { value, half_width: f64::INFINITY }));
            };
            for (row, s) in rows.iter_mut().zip(spread) {
                for (sum, (a, b)) in row.iter_mut().zip(above.iter().zip(&below)) {
                    *sum += s * (a - b) / (2.0 * step);
                }
            }
        }
        Some(std::array::from_fn(|j| {
            let half_width = match self.noise {
                Noise::Unknown => rows.iter().map(|r| r[j].abs()).sum(),
                Noise::Independent => rows.iter().map(|r| r[j] * r[j]).sum::<f64>().sqrt(),
            };
            Estimate { value: value[j], half_width }
        }))
    }
}

/// Colours of lights as a table with one column for each of them.
pub fn light_table(lights: &[(&SpectralData, LightColor)], noise: Noise) -> Table {
    let mut table = sheet("colour of light", lights.iter().map(|(data, _)| data.name.as_str()));
    let unit = match lights {
        [(_, first), rest @ ..] if rest.iter().all(|l| l.1.unit == first.unit) => {
            first.unit.unwrap_or("1, Y = 100")
        }
        _ => "see units",
    };
    let row = |quantity: &str, unit: &str, value: &dyn Fn(&LightColor) -> Option<Estimate>| -> Vec<Cell> {
        let cells = lights.iter().map(|(_, l)| value(l).map_or(Cell::Missing, Cell::from));
        [quantity.into(), unit.into()].into_iter().chain(cells).collect()
    };
    for (k, name) in ["X", "Y", "Z"].into_iter().enumerate() {
        table.rows.push(row(name, unit, &|l| Some(l.xyz[k])));
    }
    for (k, name) in ["x", "y", "u′", "v′"].into_iter().enumerate() {
        table.rows.push(row(name, "1", &|l| l.chromaticity.map(|c| c[k])));
    }
    table.rows.push(row("correlated colour temperature", "K", &|l| l.temperature.map(|t| t[0])));
    table.rows.push(row("Duv", "1", &|l| l.temperature.map(|t| t[1])));
    table.rows.push(row("Ra", "1", &|l| l.rendering.as_ref().map(|r| r.general)));
    for k in 0..SAMPLES {
        let name = format!("R{}", k + 1);
        table.rows.push(row(&name, "1", &|l| l.rendering.as_ref().map(|r| r.special[k])));
    }
    table.fact("observer", "CIE 1931 (2°), sums at 1 nm over 360–830 nm");
    for (data, l) in lights {
        describe(&mut table, data, &l.extent);
        if unit == "see units" {
            table.fact(format!("{}: unit of X, Y, Z", data.name), l.unit.unwrap_or("1, Y = 100"));
        }
        if let Some(r) = &l.rendering
            && r.chromaticity_difference > RENDERING_TOLERANCE
        {
            let text = format!(
                "{:.4} from the reference in the 1960 diagram, beyond the 0.0054 of CIE 13.3: read Ra with care",
                r.chromaticity_difference
            );
            table.fact(format!("{}: chromaticity", data.name), text);
        }
        if l.temperature.is_none() {
            let text = "none: farther than 0.05 from the Planckian locus, or beyond 1000–1000000 K";
            table.fact(format!("{}: colour temperature", data.name), text);
        }
    }
    table
        .fact("colour temperature", "nearest point of the Planckian locus in the 1960 diagram (CIE 15:2018)");
    table.fact("colour rendering", "CIE 13.3-1995");
    level(&mut table, noise, lights.iter().map(|l| (l.0, &l.1.extent)));
    table
}

/// Colours of things under one illuminant as a table with one column for each of them.
pub fn object_table(objects: &[(&SpectralData, ObjectColor)], illuminant: &str, noise: Noise) -> Table {
    let title = format!("colour under {illuminant}");
    let mut table = sheet(&title, objects.iter().map(|(data, _)| data.name.as_str()));
    let row = |quantity: &str, value: &dyn Fn(&ObjectColor) -> Option<Estimate>| -> Vec<Cell> {
        let cells = objects.iter().map(|(_, o)| value(o).map_or(Cell::Missing, Cell::from));
        [quantity.into(), "1".into()].into_iter().chain(cells).collect()
    };
    for (k, name) in ["X", "Y", "Z"].into_iter().enumerate() {
        table.rows.push(row(name, &|o| Some(o.xyz[k])));
    }
    for (k, name) in ["x", "y", "u′", "v′"].into_iter().enumerate() {
        table.rows.push(row(name, &|o| o.chromaticity.map(|c| c[k])));
    }
    for (k, name) in ["L*", "a*", "b*"].into_iter().enumerate() {
        table.rows.push(row(name, &|o| o.lab.map(|c| c[k])));
    }
    table.fact("observer", "CIE 1931 (2°), sums at 1 nm over 360–830 nm; the perfect diffuser has Y = 100");
    table.fact("illuminant", illuminant);
    for (data, o) in objects {
        describe(&mut table, data, &o.extent);
    }
    level(&mut table, noise, objects.iter().map(|o| (o.0, &o.1.extent)));
    table
}

fn sheet<'a>(title: &str, names: impl ExactSizeIterator<Item = &'a str>) -> Table {
    let single = names.len() == 1;
    let mut columns = vec![Column::words("quantity"), Column::words("unit")];
    // One column needs no name of its own, and scripts find it without knowing the file.
    columns.extend(names.map(|name| Column::words(if single { "value" } else { name })));
    Table::new(title, columns)
}

fn describe(table: &mut Table, data: &SpectralData, extent: &Extent) {
    let [lo, hi] = extent.range;
    let mut text = format!("{lo}–{hi} nm, {} rows, {}", data.wavelengths.len(), extent.interpolation);
    if lo > 360.0 || hi < 830.0 {
        text.push_str(", end values held to 360 and 830 nm");
    }
    match &data.unit {
        Some(unit) => text.push_str(&format!(", {unit}")),
        None => text.push_str(", relative"),
    }
    table.fact(format!("spectrum {}", data.name), text);
}

fn level<'a>(table: &mut Table, noise: Noise, all: impl Iterator<Item = (&'a SpectralData, &'a Extent)>) {
    for (data, _) in all.filter(|(_, extent)| extent.has_intervals) {
        let level = data.confidence.as_deref().unwrap_or("as in the file");
        let together = match noise {
            Noise::Unknown => "as wide as the least favourable correlation of the rows makes them",
            Noise::Independent => "rows taken as independent",
        };
        let text = format!("{level}; carried on to first order, {together}");
        table.fact(format!("intervals of {}", data.name), text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
    use crate::spectrum::named;

    fn builtin(name: &str) -> SpectralData {
        SpectralData::of(name, &named(name).unwrap())
    }

    #[test]
    fn absolute_spectra_have_photometric_units() {
        // 1 lx of equal energy: 1/(683.002·∫ȳ) W·m⁻²·nm⁻¹.
        let level = 1.0 / (f64::from(LUMENS_PER_WATT) * f64::from(cie::Y_INTEGRAL));
        let mut data = SpectralData::of("e", &crate::spectrum::Spectrum::Constant(level as f32));
        data.unit = Some("W·m⁻²·nm⁻¹".to_owned());
        let color = light(&data, Noise::Unknown);
        assert_eq!(color.unit, Some("lx"));
        assert!((color.xyz[1].value - 1.0).abs() < 1e-6, "{:?}", color.xyz);
        data.unit = Some("W·m⁻²·sr⁻¹·nm⁻¹".to_owned());
        assert_eq!(light(&data, Noise::Unknown).unit, Some("cd·m⁻²"));
        data.unit = None;
        assert_eq!(light(&data, Noise::Unknown).xyz[1], Estimate::exact(100.0));
    }

    #[test]
    fn patches_under_d65_have_the_published_tristimulus_values() {
        // BabelColor's averages of the ColorChecker (colour-science 0.4.7): dark skin, 380–730 nm at 10 nm.
        let skin = "0.055 0.058 0.061 0.062 0.062 0.062 0.062 0.062 0.062 0.062 0.062 0.063 0.065 0.07 0.076 0.079 0.081 \
                    0.084 0.091 0.103 0.119 0.134 0.143 0.147 0.151 0.158 0.168 0.179 0.188 0.19 0.186 0.181 0.182 \
                    0.187 0.196 0.209";
        let rows: String =
            skin.split_whitespace().enumerate().map(|(i, v)| format!("{} {v}\n", 380 + 10 * i)).collect();
        let data = SpectralData::parse("dark skin", &rows, Choice::default()).unwrap();
        let color = object(&data, &builtin("stdillum-D65"), Noise::Unknown);
        for (found, expected) in color.xyz.iter().zip([11.148, 10.073, 6.804]) {
            assert!((found.value - expected).abs() < 2e-3, "{:?}", color.xyz);
        }
        assert_eq!(color.extent.interpolation, "Sprague's polynomials");
        let lab = color.lab.unwrap();
        assert!((lab[0].value - 37.97).abs() < 0.05, "{lab:?}");
    }

    #[test]
    fn a_perfect_diffuser_is_white_under_anything() {
        let white = SpectralData::parse("white", "360 1\n830 1\n", Choice::default()).unwrap();
        for name in ["stdillum-A", "stdillum-F11"] {
            let color = object(&white, &builtin(name), Noise::Unknown);
            let lab = color.lab.unwrap();
            assert!((color.xyz[1].value - 100.0).abs() < 1e-9 && (lab[0].value - 100.0).abs() < 1e-9);
            assert!(lab[1].value.abs() < 1e-9 && lab[2].value.abs() < 1e-9, "{name}: {lab:?}");
        }
    }

    #[test]
    fn intervals_cover_what_noise_does() {
        // FL2 at 5 nm with 3 % noise, half-width two standard deviations: of 400 noisy spectra, as many readings lie
        // within the predicted half-width of the truth as of a Gaussian, 95.4 %; a binomial interval at α = 0.001 is
        // 95.4 ± 3.4 %. Ra is tested by the mean square, because its distribution is skewed.
        let text: String = (76..=156).map(|i| format!("{} 0\n", 5 * i)).collect();
        let truth = named("stdillum-F2").unwrap();
        let mut data = SpectralData::parse("f2", &text, Choice::default()).unwrap();
        for (l, e) in data.wavelengths.iter().zip(&mut data.values) {
            let value = f64::from(truth.at(*l as f32));
            *e = Estimate { value, half_width: 2.0 * 0.03 * value };
        }
        let exact = light(&data, Noise::Independent);
        let picked = |c: &LightColor| {
            let (t, xy) = (c.temperature.unwrap(), c.chromaticity.unwrap());
            [xy[0], xy[3], t[0], t[1], c.xyz[0]]
        };
        let predicted = picked(&exact);
        let mut rng = Pcg32::new(11, 1);
        let mut normal = || (0..12).map(|_| f64::from(rng.next_f32())).sum::<f64>() - 6.0;
        let mut inside = [0; 5];
        let runs = 400;
        for _ in 0..runs {
            let mut noisy = data.clone();
            for e in &mut noisy.values {
                *e = Estimate::exact(e.value * (1.0 + 0.03 * normal()));
            }
            for ((count, p), found) in
                inside.iter_mut().zip(predicted).zip(picked(&light(&noisy, Noise::Independent)))
            {
                *count += i32::from((found.value - p.value).abs() <= p.half_width);
            }
        }
        let share = inside.map(|c| f64::from(c) / f64::from(runs));
        assert!(share.iter().all(|s| (s - 0.954).abs() < 0.035), "{share:?}");
    }

    #[test]
    fn errors_that_rise_and_fall_together_change_the_amount_and_are_covered() {
        // 5 % on every row at once: Y changes by 5 %, which only the wide intervals say.
        let rows: String = (38..=78).map(|i| format!("{} 2 0.1\n", 10 * i)).collect();
        let mut data = SpectralData::parse("e", &rows, Choice::default()).unwrap();
        data.unit = Some("W·m⁻²·nm⁻¹".to_owned());
        let relative = |noise| light(&data, noise).xyz[1].relative();
        assert!((relative(Noise::Unknown) - 0.05).abs() < 1e-9, "{}", relative(Noise::Unknown));
        assert!(relative(Noise::Independent) < 0.02);
    }

    #[test]
    fn what_has_no_colour_temperature_says_so() {
        let laser = SpectralData::parse("laser", "531 0\n532 1\n533 0\n", Choice::default()).unwrap();
        let color = light(&laser, Noise::Unknown);
        assert!(color.temperature.is_none() && color.rendering.is_none() && color.chromaticity.is_some());
        let table = light_table(&[(&laser, color)], Noise::Unknown);
        assert!(table.to_text().contains("none: farther than 0.05"), "{}", table.to_text());
        let black = SpectralData::parse("black", "400 0\n700 0\n", Choice::default()).unwrap();
        assert!(light(&black, Noise::Unknown).chromaticity.is_none());
    }
}
