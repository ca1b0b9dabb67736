//! Spectra as files hold them: two or three columns of numbers, or a table with headings and units.

use crate::spectrum::{LAMBDA_MIN, Spectrum, cie};
use crate::units::Estimate;
use thiserror::Error;

/// A spectrum as it was measured or given.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralData {
    /// What it is called.
    pub name: String,
    /// Unit of the values as the file states it; `None` where it states none.
    pub unit: Option<String>,
    /// Wavelengths [nm], increasing.
    pub wavelengths: Vec<f64>,
    /// Values with their intervals.
    pub values: Vec<Estimate>,
    /// Level of the intervals as the file states it.
    pub confidence: Option<String>,
}

/// Which numbers of a table with several quantities or places are meant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Choice<'a> {
    /// Name of the column of values, without its unit; `None` for the first with intervals after the wavelength, else the first with a unit.
    pub column: Option<&'a str>,
    /// Column and word that rows must have; `None` for all rows.
    pub rows: Option<[&'a str; 2]>,
}

/// Why a text is no spectrum. Lines count from 1.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SpectrumError {
    /// Two rows at most are no spectrum.
    #[error("fewer than two samples: a spectrum needs rows of a wavelength [nm] and a value")]
    TooShort,
    /// A word is not a finite number.
    #[error("line {line}: `{word}` is not a number")]
    NotANumber {
        /// Where.
        line: usize,
        /// The word.
        word: String,
    },
    /// A row has too few or too many numbers.
    #[error(
        "line {line}: expected a wavelength, a value and perhaps the half-width of its interval, found {found} numbers"
    )]
    Columns {
        /// Where.
        line: usize,
        /// How many numbers there are.
        found: usize,
    },
    /// The headings lack a column.
    #[error("line {line}: there is no column \"{name}\" among {known}")]
    NoColumn {
        /// Where the headings stand.
        line: usize,
        /// What was looked for.
        name: String,
        /// The headings.
        known: String,
    },
    /// A wavelength does not follow its predecessor.
    #[error("line {line}: wavelength {lambda} nm follows {previous} nm: choose the rows of one spectrum")]
    NotIncreasing {
        /// Where.
        line: usize,
        /// The wavelength before [nm].
        previous: f64,
        /// The wavelength [nm].
        lambda: f64,
    },
    /// A wavelength is not above zero, or a half-width is negative.
    #[error("line {line}: {value} must not be negative")]
    Negative {
        /// Where.
        line: usize,
        /// The number.
        value: f64,
    },
}

impl SpectralData {
    /// A spectrum of the library at every nanometre from 360 to 830, as numbers without a unit.
    pub fn of(name: impl Into<String>, spectrum: &Spectrum) -> Self {
        let lambda = |i: usize| LAMBDA_MIN + i as f32;
        Self {
            name: name.into(),
            unit: None,
            wavelengths: (0..cie::SAMPLES).map(|i| f64::from(lambda(i))).collect(),
            values: (0..cie::SAMPLES).map(|i| Estimate::exact(spectrum.at(lambda(i)).into())).collect(),
            confidence: None,
        }
    }

    /// Reads text: rows of wavelength [nm], value and perhaps half-width, or comma-separated values below one line of
    /// headings of the form `name [unit]`, in which the half-widths of a column `a` stand in the column `a ±`. `#` begins a remark.
    ///
    /// # Errors
    /// Where the text is neither; the error says in which line.
    pub fn parse(name: &str, text: &str, choice: Choice<'_>) -> Result<Self, SpectrumError> {
        let mut data = Self {
            name: name.to_owned(),
            unit: None,
            wavelengths: Vec::new(),
            values: Vec::new(),
            confidence: None,
        };
        let mut headings: Option<Headings> = None;
        let mut begun = false;
        for (index, content) in text.lines().enumerate() {
            let line = index + 1;
            if let Some(level) = content.strip_prefix("# intervals:") {
                data.confidence = Some(level.trim().to_owned());
            }
            let content = content.trim_start_matches('\u{feff}');
            let content = if headings.is_some() { content } else { content.split('#').next().unwrap_or("") };
            if content.trim().is_empty() || content.starts_with('#') {
                continue;
            }
            if !begun && content.chars().any(|c| c == '[' || c == '"') {
                let found = Headings::read(content, line, choice)?;
                data.unit.clone_from(&found.unit);
                headings = Some(found);
                begun = true;
                continue;
            }
            begun = true;
            let row = match &headings {
                Some(headings) => match headings.row(content, line, choice)? {
                    Some(row) => row,
                    None => continue,
                },
                None => plain(content, line)?,
            };
            if row.lambda <= 0.0 || row.half_width < 0.0 {
                let value = if row.lambda <= 0.0 { row.lambda } else { row.half_width };
                return Err(SpectrumError::Negative { line, value });
            }
            if let Some(&previous) = data.wavelengths.last()
                && row.lambda <= previous
            {
                return Err(SpectrumError::NotIncreasing { line, previous, lambda: row.lambda });
            }
            data.wavelengths.push(row.lambda);
            data.values.push(Estimate { value: row.value, half_width: row.half_width });
        }
        if data.wavelengths.len() < 2 { Err(SpectrumError::TooShort) } else { Ok(data) }
    }
}

struct Row {
    lambda: f64,
    value: f64,
    half_width: f64,
}

/// Where the wanted numbers stand in a row.
struct Headings {
    lambda: usize,
    /// Nanometres per unit of that column.
    scale: f64,
    value: usize,
    half_width: Option<usize>,
    condition: Option<usize>,
    unit: Option<String>,
}

impl Headings {
    fn read(text: &str, line: usize, choice: Choice<'_>) -> Result<Self, SpectrumError> {
        let cells: Vec<(String, Option<String>)> = cells(text).iter().map(|c| heading(c)).collect();
        let known = cells.iter().map(|c| format!("\"{}\"", c.0)).collect::<Vec<_>>().join(", ");
        let find =
            |name: &str| {
                cells.iter().position(|c| c.0.eq_ignore_ascii_case(name)).ok_or_else(|| {
                    SpectrumError::NoColumn { line, name: name.to_owned(), known: known.clone() }
                })
            };
        let lambda = find("wavelength")?;
        let scale = match cells[lambda].1.as_deref() {
            Some("µm" | "μm" | "um") => 1000.0,
            _ => 1.0,
        };
        let value = match choice.column {
            Some(name) => find(name)?,
            // The wavelength may stand beside words, angles and coordinates: a quantity with intervals is what was measured,
            // else the first with a unit after the wavelength.
            None => {
                let after = || (lambda + 1..cells.len()).filter(|&i| cells[i].1.is_some());
                let measured = after().find(|&i| find(&format!("{} ±", cells[i].0)).is_ok());
                measured.or_else(|| after().find(|&i| cells[i].1.as_deref() != Some("°"))).ok_or_else(
                    || SpectrumError::NoColumn {
                        line,
                        name: "value [unit]".to_owned(),
                        known: known.clone(),
                    },
                )?
            }
        };
        let half_width = find(&format!("{} ±", cells[value].0)).ok();
        let condition = choice.rows.map(|[name, _]| find(name)).transpose()?;
        Ok(Self { lambda, scale, value, half_width, condition, unit: cells[value].1.clone() })
    }

    fn row(&self, text: &str, line: usize, choice: Choice<'_>) -> Result<Option<Row>, SpectrumError> {
        let cells = cells(text);
        let cell = |i: usize| cells.get(i).map_or("", |c| c.trim());
        if let (Some(column), Some([_, wanted])) = (self.condition, choice.rows)
            && cell(column) != wanted
        {
            return Ok(None);
        }
        let half_width = match self.half_width.map(cell) {
            None | Some("") => 0.0,
            Some(word) => number(word, line)?,
        };
        Ok(Some(Row {
            lambda: number(cell(self.lambda), line)? * self.scale,
            value: number(cell(self.value), line)?,
            half_width,
        }))
    }
}

/// Cells of a line of comma-separated values (RFC 4180).
fn cells(line: &str) -> Vec<String> {
    let mut out = vec![String::new()];
    let mut quoted = false;
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        let Some(last) = out.last_mut() else { break };
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                last.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => out.push(String::new()),
            c => last.push(c),
        }
    }
    out
}

/// `name [unit]`.
fn heading(cell: &str) -> (String, Option<String>) {
    let cell = cell.trim();
    match cell.strip_suffix(']').and_then(|c| c.rsplit_once('[')) {
        Some((name, unit)) => (name.trim().to_owned(), Some(unit.trim().to_owned())),
        None => (cell.to_owned(), None),
    }
}

fn plain(text: &str, line: usize) -> Result<Row, SpectrumError> {
    let separator = |c: char| c.is_whitespace() || c == ',' || c == ';';
    let words = text.split(separator).filter(|w| !w.is_empty());
    let numbers = words.map(|w| number(w, line)).collect::<Result<Vec<_>, _>>()?;
    match *numbers.as_slice() {
        [lambda, value] => Ok(Row { lambda, value, half_width: 0.0 }),
        [lambda, value, half_width] => Ok(Row { lambda, value, half_width }),
        _ => Err(SpectrumError::Columns { line, found: numbers.len() }),
    }
}

fn number(word: &str, line: usize) -> Result<f64, SpectrumError> {
    let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
    number.ok_or_else(|| SpectrumError::NotANumber { line, word: word.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::{Cell, Column, Table};

    fn parse(text: &str) -> Result<SpectralData, SpectrumError> {
        SpectralData::parse("s", text, Choice::default())
    }

    #[test]
    fn plain_columns_are_read_with_or_without_intervals() {
        let data = parse("# a spectrum\n400 0.5\n410, 0.6 # peak\n420\t0.7 0.1\n").unwrap();
        assert_eq!(data.wavelengths, [400.0, 410.0, 420.0]);
        assert_eq!(data.values[1], Estimate::exact(0.6));
        assert_eq!(data.values[2], Estimate { value: 0.7, half_width: 0.1 });
        assert_eq!(data.unit, None);
    }

    #[test]
    fn our_own_tables_are_read_back_with_unit_interval_and_level() {
        let mut table = Table::new(
            "light, \"spectral\"",
            vec![
                Column::new("x", "m"),
                Column::new("wavelength", "nm"),
                Column::new("spectral irradiance", "W·m⁻²·nm⁻¹"),
            ],
        );
        table.fact("intervals", "95 % confidence, statistical only");
        for x in [0.5, 1.5] {
            for l in [400.0, 500.0, 600.0] {
                let e = Estimate { value: l * x, half_width: 0.5 };
                table.rows.push(vec![Cell::Number(x), Cell::Number(l), Cell::Estimate(e)]);
            }
        }
        let text = table.to_csv();
        let choice = Choice { column: None, rows: Some(["x", "1.5"]) };
        let data = SpectralData::parse("lux.csv", &text, choice).unwrap();
        assert_eq!(data.wavelengths, [400.0, 500.0, 600.0]);
        assert_eq!(data.values[2], Estimate { value: 900.0, half_width: 0.5 });
        assert_eq!(data.unit.as_deref(), Some("W·m⁻²·nm⁻¹"));
        assert_eq!(data.confidence.as_deref(), Some("95 % confidence, statistical only"));
        assert!(matches!(parse(&text), Err(SpectrumError::NotIncreasing { line: 7, .. })));
        let choice = Choice { column: Some("flux"), rows: None };
        let missing = SpectralData::parse("lux.csv", &text, choice);
        assert!(matches!(missing, Err(SpectrumError::NoColumn { line: 3, .. })), "{missing:?}");
    }

    #[test]
    fn micrometres_become_nanometres() {
        let data = parse("wavelength [µm],reflectance [1]\n0.4,0.1\n0.5,0.2\n").unwrap();
        assert!((data.wavelengths[1] - 500.0).abs() < 1e-9 && data.unit.as_deref() == Some("1"));
    }

    #[test]
    fn faults_are_located() {
        assert_eq!(parse(""), Err(SpectrumError::TooShort));
        assert_eq!(parse("400 1\n"), Err(SpectrumError::TooShort));
        let word = "five".to_owned();
        assert_eq!(parse("400 1\n500 five\n"), Err(SpectrumError::NotANumber { line: 2, word }));
        assert_eq!(parse("400 1 2 3\n"), Err(SpectrumError::Columns { line: 1, found: 4 }));
        assert_eq!(parse("-4 1\n"), Err(SpectrumError::Negative { line: 1, value: -4.0 }));
        assert!(matches!(parse("400 1\n400 2\n"), Err(SpectrumError::NotIncreasing { line: 2, .. })));
        assert!(matches!(parse("400 nan\n"), Err(SpectrumError::NotANumber { .. })));
    }
}
