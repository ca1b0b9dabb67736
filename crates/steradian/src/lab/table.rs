//! Readings as a table that says its units, for people, spreadsheets and programs.

use crate::units::Estimate;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// What an instrument found, with all that one needs to know about it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What was measured.
    pub title: String,
    /// How: instrument, scene, geometry, rays, level of the intervals, in words.
    pub facts: Vec<Fact>,
    /// What each column holds.
    pub columns: Vec<Column>,
    /// Rows of as many cells as there are columns.
    pub rows: Vec<Vec<Cell>>,
}

/// One thing to know about a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact {
    /// Its name, such as `confidence`.
    pub name: String,
    /// What it is, such as `95 %, statistical only`.
    pub value: String,
}

/// What a column holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Quantity, such as `illuminance`.
    pub name: String,
    /// Unit, such as `lx`; `1` for ratios, `None` for words.
    pub unit: Option<String>,
}

/// One cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number that chance has no part in, such as a coordinate.
    Number(f64),
    /// A reading.
    Estimate(Estimate),
    /// Nothing to say.
    Missing,
}

impl From<Estimate> for Cell {
    fn from(e: Estimate) -> Self {
        Self::Estimate(e)
    }
}

impl From<f64> for Cell {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<&str> for Cell {
    fn from(s: &str) -> Self {
        Self::Text(s.to_owned())
    }
}

impl Column {
    /// A quantity with its unit; `1` for ratios.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: Some(unit.into()) }
    }

    /// A column of words.
    pub fn words(name: impl Into<String>) -> Self {
        Self { name: name.into(), unit: None }
    }

    fn heading(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} [{unit}]", self.name),
            None => self.name.clone(),
        }
    }
}

impl Table {
    /// An empty table.
    pub fn new(title: impl Into<String>, columns: Vec<Column>) -> Self {
        Self { title: title.into(), facts: Vec::new(), columns, rows: Vec::new() }
    }

    /// Adds a fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push(Fact { name: name.into(), value: value.into() });
    }

    /// Whether a column has readings, which take a second column in CSV for their half-width.
    fn has_intervals(&self, column: usize) -> bool {
        self.rows.iter().any(|r| matches!(r.get(column), Some(Cell::Estimate(_))))
    }

    /// Comma-separated values (RFC 4180) below `#` lines with the title and the facts. A column of readings is followed by
    /// one with the half-widths of their intervals.
    pub fn to_csv(&self) -> String {
        let mut text = String::new();
        let line = |s: &str| s.replace(['\n', '\r'], " ");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "# {}", line(&self.title));
        for fact in &self.facts {
            let _ = writeln!(text, "# {}: {}", line(&fact.name), line(&fact.value));
        }
        let intervals: Vec<bool> = (0..self.columns.len()).map(|i| self.has_intervals(i)).collect();
        let mut fields = Vec::new();
        for (column, &has) in self.columns.iter().zip(&intervals) {
            fields.push(quoted(&column.heading()));
            if has {
                let half = Column { name: format!("{} ±", column.name), unit: column.unit.clone() };
                fields.push(quoted(&half.heading()));
            }
        }
        text.push_str(&fields.join(","));
        text.push('\n');
        for row in &self.rows {
            fields.clear();
            for (cell, &has) in row.iter().zip(&intervals) {
                let (value, half) = match cell {
                    Cell::Text(s) => (quoted(s), String::new()),
                    Cell::Number(x) => (number(*x), String::new()),
                    Cell::Estimate(e) => (number(e.value), number(e.half_width)),
                    Cell::Missing => (String::new(), String::new()),
                };
                fields.push(value);
                if has {
                    fields.push(half);
                }
            }
            text.push_str(&fields.join(","));
            text.push('\n');
        }
        text
    }

    /// The table as a JSON value: `title`, `facts`, `columns` with `name` and `unit`, and `rows` of objects by column name, in
    /// which a reading is `{"value", "half_width"}`. A number that is not finite is `null`.
    pub fn to_json(&self) -> Value {
        let facts: Map<String, Value> =
            self.facts.iter().map(|f| (f.name.clone(), Value::from(f.value.as_str()))).collect();
        let columns: Vec<Value> =
            self.columns.iter().map(|c| json!({ "name": c.name, "unit": c.unit })).collect();
        let cell = |cell: &Cell| match cell {
            Cell::Text(s) => Value::from(s.as_str()),
            Cell::Number(x) => Value::from(*x),
            Cell::Estimate(e) => json!({ "value": e.value, "half_width": e.half_width }),
            Cell::Missing => Value::Null,
        };
        let row = |row: &Vec<Cell>| -> Value {
            let named = self.columns.iter().zip(row).map(|(c, x)| (c.name.clone(), cell(x)));
            Value::Object(named.collect())
        };
        let rows: Vec<Value> = self.rows.iter().map(row).collect();
        json!({ "title": self.title, "facts": facts, "columns": columns, "rows": rows })
    }

    /// Aligned columns for a terminal: title, headings, rows, and the facts below.
    pub fn to_text(&self) -> String {
        let shown = |cell: &Cell| match cell {
            Cell::Text(s) => s.clone(),
            Cell::Number(x) => Estimate::exact(*x).to_string(),
            Cell::Estimate(e) => e.to_string(),
            Cell::Missing => "-".to_owned(),
        };
        let mut lines: Vec<Vec<String>> = vec![self.columns.iter().map(Column::heading).collect()];
        lines.extend(self.rows.iter().map(|row| row.iter().map(shown).collect()));
        let width =
            |i: usize| lines.iter().filter_map(|l| l.get(i)).map(|s| s.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let mut text = format!("{}\n", self.title);
        for line in &lines {
            let padded = line.iter().zip(&widths).zip(&self.columns).map(|((s, &w), column)| {
                let pad = " ".repeat(w - s.chars().count());
                // Words begin at the left, numbers end at the right.
                if column.unit.is_none() { format!("{s}{pad}") } else { format!("{pad}{s}") }
            });
            let joined = padded.collect::<Vec<_>>().join("  ");
            let _ = writeln!(text, "  {}", joined.trim_end());
        }
        for fact in &self.facts {
            let _ = writeln!(text, "{}: {}", fact.name, fact.value);
        }
        text
    }
}

fn number(x: f64) -> String {
    // Shortest form that reads back the same; the exponent form where the plain one has many zeros.
    let (plain, exponent) = (format!("{x}"), format!("{x:e}"));
    if plain.len() <= exponent.len() + 6 { plain } else { exponent }
}

fn quoted(s: &str) -> String {
    if s.contains([',', '"', '\n', '\r']) { format!("\"{}\"", s.replace('"', "\"\"")) } else { s.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns = vec![Column::words("point"), Column::new("x", "m"), Column::new("illuminance", "lx")];
        let mut table = Table::new("illuminance", columns);
        table.fact("confidence", "95 %, statistical only");
        let reading = Estimate { value: 104.167, half_width: 0.21 };
        table.rows.push(vec!["desk, \"left\"".into(), 0.5.into(), reading.into()]);
        table.rows.push(vec!["door".into(), 1.25.into(), Cell::Missing]);
        table
    }

    #[test]
    fn csv_has_a_column_for_the_half_width_and_units_in_the_header() {
        let expected = "# illuminance\n# confidence: 95 %, statistical only\n\
             point,x [m],illuminance [lx],illuminance ± [lx]\n\
             \"desk, \"\"left\"\"\",0.5,104.167,0.21\ndoor,1.25,,\n";
        assert_eq!(table().to_csv(), expected);
        assert_eq!((number(1.0 / 3.0), number(2.5e-30)), ("0.3333333333333333".into(), "2.5e-30".into()));
    }

    #[test]
    fn json_names_columns_and_units() {
        let json = table().to_json();
        assert_eq!(json["columns"][2], json!({ "name": "illuminance", "unit": "lx" }));
        assert_eq!(json["rows"][0]["illuminance"], json!({ "value": 104.167, "half_width": 0.21 }));
        assert_eq!(json["rows"][1]["illuminance"], Value::Null);
        assert_eq!(json["facts"]["confidence"], "95 %, statistical only");
    }

    #[test]
    fn text_is_aligned() {
        let expected = "illuminance\n  point         x [m]  illuminance [lx]\n  desk, \"left\"    0.5       104.2 ± 0.2\n  \
             door           1.25                 -\nconfidence: 95 %, statistical only\n";
        assert_eq!(table().to_text(), expected);
    }
}
