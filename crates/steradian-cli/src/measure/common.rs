//! What all instruments are told and how their readings are handed out.

use crate::Failure;
use crate::args::parse_wavelength;
use crate::load::{self, Verbosity};
use crate::output::{OutputFile, note, print};
use crate::sheet::Sheet;
use clap::Args;
use std::path::{Path, PathBuf};
use steradian::lab::plot::Drawing;
use steradian::lab::{Precision, Session, Table};
use steradian::render::CancelToken;
use steradian::scene::RenderJob;

/// Where readings go.
#[derive(Args, Clone, Debug)]
pub(crate) struct Outputs {
    /// File for the readings: .csv or .json; may be repeated [default: a table on standard output]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// File for a plot of the readings: .svg or .png; may be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Vec<PathBuf>,
    /// Say nothing but errors and readings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// When an instrument that samples has measured enough.
#[derive(Args, Clone, Debug)]
pub(crate) struct Sampling {
    /// Half-width of the confidence interval at which to stop, as a share of the value
    #[arg(long, value_name = "SHARE", default_value = "1%", value_parser = parse_share)]
    pub(crate) precision: f64,
    /// Half-width that is small enough whatever the value, in the unit of the reading
    #[arg(long, value_name = "AMOUNT", default_value = "0", value_parser = parse_amount)]
    pub(crate) floor: f64,
    /// Level of the confidence intervals
    #[arg(long, value_name = "SHARE", default_value = "95%", value_parser = parse_share)]
    pub(crate) confidence: f64,
    /// Most rays for one measurement, precise or not
    #[arg(long, value_name = "N", default_value = "1e9", value_parser = parse_count)]
    pub(crate) max_rays: u64,
    /// Seed of the random numbers; the same seed gives the same readings
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(crate) threads: Option<u32>,
}

impl Sampling {
    pub(crate) fn session<'a>(&self, cancel: &'a CancelToken) -> Session<'a> {
        Session {
            precision: Precision {
                relative: self.precision,
                absolute: self.floor,
                confidence: self.confidence,
                max_rays: self.max_rays,
            },
            seed: self.seed,
            threads: self.threads.map(|n| n as usize),
            cancel,
        }
    }
}

/// Reads and compiles a scene; notices are shown unless `quiet`.
pub(crate) fn scene(paths: &[PathBuf], outputs: &Outputs) -> Result<RenderJob, Failure> {
    load::read(paths)?.compile(if outputs.quiet { Verbosity::ErrorsOnly } else { Verbosity::All })
}

/// The files for readings and plots, known to be writable before the long work begins.
#[derive(Debug)]
pub(crate) struct Desk {
    tables: Vec<(OutputFile, TableFormat)>,
    sheets: Vec<Sheet>,
    quiet: bool,
}

#[derive(Clone, Copy, Debug)]
enum TableFormat {
    Csv,
    Json,
}

impl Desk {
    pub(crate) fn new(outputs: &Outputs) -> Result<Self, Failure> {
        let tables = outputs.output.iter().map(|p| table_file(p)).collect::<Result<_, _>>()?;
        let sheets = outputs.plot.iter().map(|p| Sheet::new(p)).collect::<Result<_, _>>()?;
        Ok(Self { tables, sheets, quiet: outputs.quiet })
    }

    /// Writes readings and plot. Whoever asked for no file for the readings sees them on standard output.
    ///
    /// A measurement that the user stopped is written all the same, and ends the program as an interrupted one.
    pub(crate) fn hand_out(
        self,
        table: &Table,
        drawing: impl FnOnce() -> Drawing,
        cancel: &CancelToken,
    ) -> Result<(), Failure> {
        let mut names = Vec::new();
        for (file, format) in &self.tables {
            match format {
                TableFormat::Csv => file.write(table.to_csv().as_bytes())?,
                TableFormat::Json => file.write(format!("{:#}\n", table.to_json()).as_bytes())?,
            }
            names.push(file.path().display().to_string());
        }
        if !self.sheets.is_empty() {
            let drawing = drawing();
            for sheet in &self.sheets {
                sheet.write(&drawing)?;
                names.push(sheet.path().display().to_string());
            }
        }
        if self.tables.is_empty() {
            print(table.to_text().trim_end())?;
        }
        if !self.quiet && !names.is_empty() {
            note(&format!("{}: {}", table.title, names.join(", ")));
        }
        if cancel.is_cancelled() { Err(Failure::Interrupted) } else { Ok(()) }
    }
}

fn table_file(path: &Path) -> Result<(OutputFile, TableFormat), String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let format = match extension.as_str() {
        "csv" => TableFormat::Csv,
        "json" => TableFormat::Json,
        _ => return Err(format!("{}: readings are written as .csv or .json", path.display())),
    };
    Ok((OutputFile::new(path)?, format))
}

/// Wavelengths as one item of a list: `550`, or `400:700:10` for 400, 410 and so on to 700 nm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Comb(pub(crate) Vec<f32>);

/// To be used with `value_delimiter = ','` on a `Vec<Comb>`.
pub(crate) fn parse_comb(text: &str) -> Result<Comb, String> {
    let parts: Vec<&str> = text.split(':').collect();
    match parts.as_slice() {
        [one] => Ok(Comb(vec![parse_wavelength(one)?])),
        [start, end, step] => {
            let (start, end) = (parse_wavelength(start)?, parse_wavelength(end)?);
            let step = step.trim().trim_end_matches("nm").trim().parse::<f32>().ok();
            let step = step
                .filter(|s| *s >= 0.01 && *s <= 2300.0)
                .ok_or("the step must lie between 0.01 and 2300 nm")?;
            if end < start {
                return Err(format!("{end} nm is less than {start} nm"));
            }
            let count = ((end - start) / step + 1e-3) as u32;
            Ok(Comb((0..=count).map(|i| start + i as f32 * step).collect()))
        }
        _ => Err("expected a wavelength such as 550, or a comb such as 400:700:10".to_owned()),
    }
}

pub(crate) fn parse_share(text: &str) -> Result<f64, String> {
    let (number, factor) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let share = number.trim().parse::<f64>().map(|x| x * factor);
    share
        .ok()
        .filter(|x| *x > 0.0 && *x < 1.0)
        .ok_or_else(|| "expected a share such as 1% or 0.01".to_owned())
}

fn parse_amount(text: &str) -> Result<f64, String> {
    let amount = text.trim().parse::<f64>().ok().filter(|x| *x >= 0.0 && x.is_finite());
    amount.ok_or_else(|| "expected a number, at least 0".to_owned())
}

fn parse_count(text: &str) -> Result<u64, String> {
    let count = text.trim().parse::<f64>().ok().filter(|x| (1.0..=1e18).contains(x));
    count.map(|x| x as u64).ok_or_else(|| "expected a count such as 1000000 or 1e6".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn combs_include_both_ends() {
        assert_eq!(parse_comb("550"), Ok(Comb(vec![550.0])));
        assert_eq!(parse_comb("400:420:10"), Ok(Comb(vec![400.0, 410.0, 420.0])));
        assert_eq!(parse_comb("400:425:10"), Ok(Comb(vec![400.0, 410.0, 420.0])));
        assert!(
            parse_comb("400:700").is_err()
                && parse_comb("700:400:10").is_err()
                && parse_comb("400:700:0").is_err()
        );
    }

    #[test]
    fn shares_and_counts_are_checked() {
        assert_eq!(parse_share("1%"), Ok(0.01));
        assert_eq!(parse_share("0.95"), Ok(0.95));
        assert!(parse_share("0").is_err() && parse_share("100%").is_err() && parse_share("nan").is_err());
        assert_eq!(parse_count("1e6"), Ok(1_000_000));
        assert!(parse_count("0").is_err() && parse_count("-3").is_err() && parse_amount("inf").is_err());
    }
}
