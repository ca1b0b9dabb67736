//! `steradian bsdf`: how a material scatters, as numbers.

use crate::args::{self, Transport};
use crate::output::{print, reason};
use crate::{Failure, pick};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Read as _;
use std::path::Path;
use steradian::bsdf::{Mode, Side};
use steradian::lab::Subject;
use steradian::lab::probe::{AlbedoReading, Angles, Discrete, Probe, Reading};
use steradian::units::Estimate;

pub(crate) fn run(arguments: &args::Bsdf) -> Result<(), Failure> {
    let stdin = Path::new("-");
    if arguments.directions.as_deref() == Some(stdin) && arguments.sample.scenes.iter().any(|s| s == stdin) {
        return Err(Failure::Message("standard input holds either the scene or the directions".to_owned()));
    }
    let pairs = pairs(arguments)?;
    let job = arguments.sample.job()?;
    let subject = arguments.sample.subject(&job)?;
    pick::check_wavelengths(&subject, &arguments.wavelength)?;
    let probe = Probe::new(&subject, &arguments.wavelength).map_err(|e| e.to_string())?;
    let mode = match arguments.mode {
        Transport::Radiance => Mode::Radiance,
        Transport::Importance => Mode::Importance,
    };
    let mut table = Table { arguments, subject, probe, mode, albedo: None, discrete: None };
    let report = if arguments.json { table.json(&pairs) } else { table.text(&pairs) };
    Ok(print(report.trim_end())?)
}

/// Two directions to look at.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    wo: Angles,
    wi: Angles,
}

fn pairs(arguments: &args::Bsdf) -> Result<Vec<Pair>, String> {
    let Some(path) = &arguments.directions else {
        // The parser of arguments asks for both.
        return Ok(arguments.wo.zip(arguments.wi).map(|(wo, wi)| Pair { wo, wi }).into_iter().collect());
    };
    let mut bytes = Vec::new();
    let name = if path == Path::new("-") {
        std::io::stdin()
            .read_to_end(&mut bytes)
            .map_err(|e| format!("cannot read standard input: {}", reason(&e)))?;
        "(standard input)".to_owned()
    } else {
        bytes = std::fs::read(path).map_err(|e| format!("cannot read {}: {}", path.display(), reason(&e)))?;
        path.display().to_string()
    };
    parse_pairs(&String::from_utf8_lossy(&bytes)).map_err(|e| format!("{name}:{e}"))
}

/// Four numbers a line, parted by blanks or commas; `#` begins a comment. Errors begin with line and column.
fn parse_pairs(text: &str) -> Result<Vec<Pair>, String> {
    let mut pairs = Vec::new();
    for (number, line) in text.lines().enumerate().map(|(i, l)| (i + 1, l)) {
        let code = line.split('#').next().unwrap_or_default();
        let mut words: Vec<(usize, &str)> = Vec::new();
        let mut rest = code;
        while let Some(start) = rest.find(|c: char| !(c.is_whitespace() || c == ',')) {
            let word = &rest[start..];
            let end = word.find(|c: char| c.is_whitespace() || c == ',').unwrap_or(word.len());
            let column = code[..code.len() - word.len()].chars().count() + 1;
            words.push((column, &word[..end]));
            rest = &word[end..];
        }
        if words.is_empty() {
            continue;
        }
        let mut values = Vec::with_capacity(4);
        for (column, word) in &words {
            let value = word.parse::<f64>().ok().filter(|x| x.is_finite());
            values.push(
                value.ok_or_else(|| format!("{number}:{column}: expected a number, found \"{word}\""))?,
            );
        }
        let [wo_theta, wo_phi, wi_theta, wi_phi] = values[..] else {
            let column = words.get(4).map_or_else(|| code.trim_end().chars().count() + 1, |w| w.0);
            return Err(format!(
                "{number}:{column}: expected 4 numbers (wo theta, wo phi, wi theta, wi phi), found {}",
                values.len()
            ));
        };
        let angles = |theta, phi, word: usize| {
            args::angles(theta, phi).map_err(|e| format!("{number}:{}: {e}", words[word].0))
        };
        pairs.push(Pair { wo: angles(wo_theta, wo_phi, 0)?, wi: angles(wi_theta, wi_phi, 2)? });
    }
    if pairs.is_empty() {
        return Err("1:1: no directions".to_owned());
    }
    Ok(pairs)
}

/// What is asked about one material. What depends on one direction only is kept for pairs that share it.
struct Table<'a> {
    arguments: &'a args::Bsdf,
    subject: Subject<'a>,
    probe: Probe<'a>,
    mode: Mode,
    albedo: Option<(Angles, Vec<AlbedoReading>)>,
    discrete: Option<(Angles, Vec<Vec<Discrete>>)>,
}

impl Table<'_> {
    fn read(&mut self, pair: Pair) -> Vec<Reading> {
        let (wo, wi) = (pair.wo.direction(), pair.wi.direction());
        let albedo = match self.albedo.take() {
            Some((of, albedo)) if of == pair.wi => albedo,
            _ => self.probe.albedo(wi),
        };
        let readings = self.probe.read(wo, wi, self.mode, self.arguments.walks, &albedo);
        self.albedo = Some((pair.wi, albedo));
        readings
    }

    fn discrete(&mut self, wo: Angles) -> Vec<Vec<Discrete>> {
        let found = match self.discrete.take() {
            Some((of, found)) if of == wo => found,
            _ => self.probe.discrete(wo.direction(), self.mode),
        };
        self.discrete = Some((wo, found.clone()));
        found
    }

    /// What the ratio of a discrete direction is a ratio of.
    fn ratio_name(&self) -> &'static str {
        match self.mode {
            Mode::Radiance => "radiance ratio",
            Mode::Importance => "power ratio",
        }
    }

    fn mode_name(&self) -> &'static str {
        match self.mode {
            Mode::Radiance => "radiance",
            Mode::Importance => "importance",
        }
    }

    fn text(&mut self, pairs: &[Pair]) -> String {
        let estimated = self.probe.is_estimated();
        let mut rows = vec![header(estimated)];
        let mut discrete = String::new();
        let mut asked: Option<Angles> = None;
        for &pair in pairs {
            for (lambda, r) in self.arguments.wavelength.clone().into_iter().zip(self.read(pair)) {
                rows.push(row(pair, lambda, &r, estimated));
            }
            if asked != Some(pair.wo) {
                asked = Some(pair.wo);
                let found = self.discrete(pair.wo);
                self.discrete_text(&mut discrete, pair.wo, &found);
            }
        }
        // Writing to a String does not fail.
        let mut out = String::new();
        let _ = writeln!(
            out,
            "# material \"{}\", {}; angles in degrees; rho and tau for light from wi; s = f |cos theta_o| / (rho + tau)",
            self.subject.name(),
            self.mode_name()
        );
        if self.subject.is_textured() {
            let [u, v] = self.arguments.sample.uv;
            let _ = writeln!(out, "# textured: at u = {u}, v = {v}");
        }
        if estimated {
            let _ = writeln!(
                out,
                "# estimated: f and s are means of {} random walks, each followed by the half-width of its 95 % interval",
                self.arguments.walks
            );
        }
        out.push_str(&aligned(&rows));
        out + &discrete
    }

    fn discrete_text(&self, out: &mut String, wo: Angles, found: &[Vec<Discrete>]) {
        for (lambda, found) in self.arguments.wavelength.iter().zip(found) {
            for d in found {
                let wi = Angles::of(d.direction);
                let _ = writeln!(
                    out,
                    "discrete: wo = {},{}  wi = {},{}  {lambda} nm  {} {}",
                    wo.theta,
                    wo.phi,
                    significant(rounded(wi.theta)),
                    significant(rounded(wi.phi)),
                    self.ratio_name(),
                    significant(d.ratio)
                );
            }
        }
    }

    fn json(&mut self, pairs: &[Pair]) -> String {
        let wavelengths = self.arguments.wavelength.clone();
        let mut results = Vec::with_capacity(pairs.len());
        for &pair in pairs {
            let readings = self.read(pair);
            let discrete = self.discrete(pair.wo);
            let values: Vec<_> = wavelengths
                .iter()
                .zip(readings)
                .zip(discrete)
                .map(|((lambda, r), discrete)| value(*lambda, &r, &discrete))
                .collect();
            results.push(json!({
                "wo": [pair.wo.theta, pair.wo.phi],
                "wi": [pair.wi.theta, pair.wi.phi],
                "values": values,
            }));
        }
        json!({
            "material": self.subject.name(),
            "mode": self.mode_name(),
            "uv": self.arguments.sample.uv,
            "estimated": self.probe.is_estimated(),
            "walks": self.probe.is_estimated().then_some(self.arguments.walks),
            "units": {
                "wo": "degrees (theta, phi)",
                "wi": "degrees (theta, phi)",
                "wavelength": "nm",
                "f": "1/sr",
                "pdf": "1/sr",
                "s": "1/sr",
                "reflectance": "1, for light from wi",
                "transmittance": "1, for light from wi",
                "half_width": "of the 95 % interval, in the unit of the value",
                "ratio": format!("1, {}", self.ratio_name()),
            },
            "results": results,
        })
        .to_string()
    }
}

fn value(lambda: f32, r: &Reading, discrete: &[Discrete]) -> Value {
    let half_width = |e: Estimate| (e.half_width > 0.0).then_some(e.half_width);
    let discrete: Vec<_> = discrete
        .iter()
        .map(|d| {
            let wi = Angles::of(d.direction);
            let side = if d.side == Side::Reflection { "reflection" } else { "transmission" };
            json!({ "wi": [wi.theta, wi.phi], "ratio": d.ratio, "side": side })
        })
        .collect();
    json!({
        "wavelength": lambda,
        "f": r.f.value,
        "f_half_width": half_width(r.f),
        "pdf": r.pdf,
        "s": r.s.map(|s| s.value),
        "s_half_width": r.s.and_then(half_width),
        "reflectance": r.albedo.reflectance,
        "transmittance": r.albedo.transmittance,
        "discrete": discrete,
    })
}

fn header(estimated: bool) -> Vec<String> {
    let with = if estimated { &["± [1/sr]"][..] } else { &[] };
    let mut columns = vec!["# wo theta", "wo phi", "wi theta", "wi phi", "lambda [nm]", "f [1/sr]"];
    columns.extend(with);
    columns.extend(["pdf [1/sr]", "s [1/sr]"]);
    columns.extend(with);
    columns.extend(["rho [1]", "tau [1]"]);
    columns.into_iter().map(str::to_owned).collect()
}

fn row(pair: Pair, lambda: f32, r: &Reading, estimated: bool) -> Vec<String> {
    let mut columns: Vec<String> =
        [pair.wo.theta, pair.wo.phi, pair.wi.theta, pair.wi.phi].iter().map(f64::to_string).collect();
    let with = |columns: &mut Vec<String>, e: Option<Estimate>| {
        columns.push(e.map_or_else(|| "-".to_owned(), |e| significant(e.value)));
        if estimated {
            columns.push(e.map_or_else(|| "-".to_owned(), |e| format!("{:.1e}", e.half_width)));
        }
    };
    columns.push(lambda.to_string());
    with(&mut columns, Some(r.f));
    columns.push(significant(r.pdf));
    with(&mut columns, r.s);
    columns.extend([significant(r.albedo.reflectance), significant(r.albedo.transmittance)]);
    columns
}

/// Columns as wide as their widest entry, to the right.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |c: usize| rows.iter().filter_map(|r| r.get(c)).map(|w| w.chars().count()).max().unwrap_or(0);
    let widths: Vec<_> = (0..columns).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let cells: Vec<_> = row.iter().zip(&widths).map(|(cell, w)| format!("{cell:>w$}")).collect();
        out.push_str(&cells.join("  "));
        out.push('\n');
    }
    out
}

/// Angles that come from f32 directions, without the digits that mean nothing.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e4).round() / 1e4
}

/// Six significant digits: with a point where that is short, else with an exponent.
fn significant(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let exponent = x.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        return format!("{x:.5e}");
    }
    let text = format!("{x:.*}", (5 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_are_written_the_short_way() {
        let cases = [
            (0.0, "0"),
            (0.04, "0.04"),
            (0.318_309_886, "0.31831"),
            (1.0 / 3.0, "0.333333"),
            (12345.678, "12345.7"),
            (123_456_789.0, "1.23457e8"),
            (2.5e-7, "2.50000e-7"),
            (60.0, "60"),
        ];
        for (x, expected) in cases {
            assert_eq!(significant(x), expected);
        }
    }

    #[test]
    fn a_list_of_directions_may_have_comments_and_commas_and_faults_are_located() {
        let pairs = parse_pairs("# header\n\n 30 0  45 180 # one\n1,2,3,-4\n").unwrap();
        assert_eq!(pairs.len(), 2);
        assert_eq!(pairs[1].wi, Angles { theta: 3.0, phi: -4.0 });
        let fault = |text| parse_pairs(text).unwrap_err();
        assert_eq!(fault("0 0 0 0\n 1 x 3 4"), "2:4: expected a number, found \"x\"");
        assert!(fault("1 2 3").starts_with("1:6: expected 4 numbers"));
        assert!(fault("1 2 3 4 5").starts_with("1:9: expected 4 numbers"));
        assert_eq!(fault("0 0 200 0"), "1:5: theta must lie between 0 and 180 degrees, not 200");
        assert_eq!(fault("# nothing"), "1:1: no directions");
        assert!(fault("0 inf 0 0").starts_with("1:3: expected a number"));
    }
}
