//! The text of a goniometer table, whose format [`super::goniometer`] describes.

use super::error::{MeasuredError, check_coverage};

/// The columns of angles.
const ANGLES: [&str; 4] = ["theta_i", "phi_i", "theta_o", "phi_o"];
/// What their values must lie in [°].
const RANGES: [[f32; 2]; 4] = [[0.0, 89.999], [-360.0, 360.0], [0.0, 180.0], [-360.0, 360.0]];
/// No f comes near; products of such values stay finite.
const LARGEST: f32 = 1e9;

/// One line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// θi, φi, θo, φo [°].
    pub(super) angles: [f32; 4],
    /// Number of the line, from 1.
    pub(super) line: usize,
}

/// All lines.
#[derive(Debug)]
pub(super) struct Text {
    /// Wavelengths of the columns [nm], increasing; empty where f has no colour.
    pub(super) wavelengths: Vec<f32>,
    pub(super) rows: Vec<Row>,
    /// f of row after row [sr⁻¹].
    pub(super) values: Vec<f32>,
}

impl Text {
    /// Number of columns of f.
    pub(super) fn channels(&self) -> usize {
        self.wavelengths.len().max(1)
    }

    /// Reads a table.
    pub(super) fn parse(text: &str) -> Result<Self, MeasuredError> {
        let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line)).filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let Some((number, header)) = lines.next() else {
            return Err(MeasuredError::Grid("the table is empty".to_owned()));
        };
        let wavelengths = wavelengths(number, header)?;
        let mut table = Self { wavelengths, rows: Vec::new(), values: Vec::new() };
        let columns = ANGLES.len() + table.channels();
        for (line, text) in lines {
            let mut angles = [0.0; 4];
            let mut count = 0;
            for cell in cells(line, text) {
                let value = cell.number()?;
                if count < ANGLES.len() {
                    let [min, max] = RANGES[count];
                    if !(min..=max).contains(&value) {
                        let name = ANGLES[count];
                        return Err(cell.error(format!("{name} = {value}° is not in [{min}°, {max}°]")));
                    }
                    // Zero has two signs; angles are compared.
                    angles[count] = value + 0.0;
                } else if !(0.0..=LARGEST).contains(&value) {
                    return Err(cell.error(format!("f = {value} is not a number from zero up")));
                } else if count < columns {
                    table.values.push(value);
                }
                count += 1;
            }
            if count != columns {
                let message = format!("{count} values, but the header names {columns} columns");
                return Err(MeasuredError::Text { line, column: 1, message });
            }
            table.rows.push(Row { angles, line });
        }
        if table.rows.is_empty() {
            return Err(MeasuredError::Grid("there are no rows below the header".to_owned()));
        }
        Ok(table)
    }

    /// Whether the text begins like a table.
    pub(super) fn is_one(bytes: &[u8]) -> bool {
        let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
        let mut lines = head.lines().map(str::trim);
        lines.find(|l| !l.is_empty() && !l.starts_with('#')).is_some_and(|l| l.starts_with(ANGLES[0]))
    }
}

/// A comma-separated piece of a line.
struct Cell<'a> {
    text: &'a str,
    line: usize,
    /// Character where the text begins, from 1.
    column: usize,
}

impl Cell<'_> {
    fn error(&self, message: String) -> MeasuredError {
        MeasuredError::Text { line: self.line, column: self.column, message }
    }

    fn number(&self) -> Result<f32, MeasuredError> {
        self.text.parse().map_err(|_| self.error(format!("`{}` is not a number", self.text)))
    }
}

fn cells(line: usize, text: &str) -> impl Iterator<Item = Cell<'_>> {
    let mut before = 0;
    text.split(',').map(move |piece| {
        let indent = piece.chars().take_while(|c| c.is_whitespace()).count();
        let column = before + indent + 1;
        before += piece.chars().count() + 1;
        Cell { text: piece.trim(), line, column }
    })
}

/// The wavelengths of the columns of f.
fn wavelengths(line: usize, header: &str) -> Result<Vec<f32>, MeasuredError> {
    let mut cells = cells(line, header);
    for name in ANGLES {
        let expected = format!("{name} [deg]");
        match cells.next() {
            Some(cell) if compact(cell.text) == compact(&expected) => {}
            Some(cell) => {
                return Err(cell.error(format!("column `{}`, expected `{expected}`", cell.text)));
            }
            None => {
                let message = format!("the header ends before `{expected}`");
                return Err(MeasuredError::Text { line, column: 1, message });
            }
        }
    }
    let columns: Vec<Cell<'_>> = cells.collect();
    if let [only] = columns.as_slice()
        && compact(only.text) == "f[1/sr]"
    {
        return Ok(Vec::new());
    }
    let mut wavelengths = Vec::with_capacity(columns.len());
    for cell in &columns {
        let name = compact(cell.text);
        let number = name.strip_prefix("f_").and_then(|n| n.strip_suffix("nm[1/sr]"));
        let Some(lambda) = number.and_then(|n| n.parse::<f32>().ok()).filter(|l| (1.0..1e5).contains(l))
        else {
            return Err(cell.error(format!("column `{}`, expected one like `f_550nm [1/sr]`", cell.text)));
        };
        if wavelengths.last().is_some_and(|&last| last >= lambda) {
            return Err(cell.error(format!("wavelength {lambda} nm does not follow the one before it")));
        }
        wavelengths.push(lambda);
    }
    if wavelengths.is_empty() {
        let message = "there is no column of f, like `f_550nm [1/sr]` or `f [1/sr]`".to_owned();
        return Err(MeasuredError::Text { line, column: 1, message });
    }
    check_coverage(&wavelengths)?;
    Ok(wavelengths)
}

fn compact(text: &str) -> String {
    text.split_whitespace().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str =
        "theta_i [deg], phi_i [deg], theta_o [deg], phi_o [deg], f_400nm [1/sr], f_700nm [1/sr]";

    #[test]
    fn rows_follow_a_header_among_comments() {
        let t = Text::parse(&format!(
            "# by hand\r\n\n{HEADER}\r\n0,0,10,90,0.1,0.2\n# more\n0, 0, 20, 90, 3e-1, 0\n"
        ));
        let t = t.unwrap();
        assert_eq!(t.wavelengths, [400.0, 700.0]);
        assert_eq!(t.values, [0.1, 0.2, 0.3, 0.0]);
        assert_eq!((t.rows[1].angles, t.rows[1].line), ([0.0, 0.0, 20.0, 90.0], 6));
        assert!(Text::is_one(format!("# x\n{HEADER}").as_bytes()));
    }

    #[test]
    fn mistakes_are_located() {
        let said = |text: String| Text::parse(&text).unwrap_err().to_string();
        let row = |row: &str| said(format!("{HEADER}\n{row}\n"));
        assert_eq!(row("0,0,10,90,0.1, zero"), "line 2, column 16: `zero` is not a number");
        assert_eq!(row("95,0,10,90,0.1,0"), "line 2, column 1: theta_i = 95° is not in [0°, 89.999°]");
        assert_eq!(row("0,0,10,90,0.1,-1"), "line 2, column 15: f = -1 is not a number from zero up");
        assert_eq!(row("0,0,10,90,NaN,1"), "line 2, column 11: f = NaN is not a number from zero up");
        assert_eq!(row("0,0,10,90,0.1"), "line 2, column 1: 5 values, but the header names 6 columns");
        assert_eq!(
            said(HEADER.replace("phi_i [deg]", "phi_i [rad]")),
            "line 1, column 16: column `phi_i [rad]`, expected `phi_i [deg]`"
        );
        assert_eq!(
            said(HEADER.replace("f_700nm", "f_300nm")),
            "line 1, column 73: wavelength 300 nm does not follow the one before it"
        );
        assert_eq!(
            said(HEADER.replace("f_700nm", "f_red")),
            "line 1, column 73: column `f_red [1/sr]`, expected one like `f_550nm [1/sr]`"
        );
        assert_eq!(
            said(HEADER.replace("700", "600")),
            "the wavelengths 400–600 nm do not cover 420–680 nm, and nothing is extrapolated"
        );
        assert_eq!(said(HEADER.to_owned()), "there are no rows below the header");
        assert_eq!(said("# nothing\n".to_owned()), "the table is empty");
    }
}
