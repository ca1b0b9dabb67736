//! Job files: lists of measurements in TOML, with the words of the command line.
//!
//! A key is the long form of an option, an array repeats it, `true` switches it on. Keys before the first measurement hold for
//! all of them.

use super::{Measure, execute};
use crate::Failure;
use crate::output::{note, reason};
use clap::{Args, Command, FromArgMatches as _, Subcommand as _};
use std::ops::Range;
use std::path::PathBuf;
use steradian::render::CancelToken;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Series {
    /// Job file
    #[arg(value_name = "JOB.toml")]
    file: PathBuf,
    /// Check the job file and print the command of each measurement, without measuring
    #[arg(long)]
    dry_run: bool,
}

const NOTES: &str = "\
A job file has one [[measure]] table for each measurement: `instrument`, and the instrument's options by their
long names. Options that stand above the first table hold for every instrument that has them.
File names are relative to the current folder, as on the command line.

Example job.toml:
  precision = \"2%\"

  [[measure]]
  instrument = \"lux\"
  scene = \"room.pbrt\"
  grid = \"0,0,0.8,4,0,0,0,3,0,9,7\"
  output = [\"lux.csv\", \"lux.json\"]

  [[measure]]
  instrument = \"color\"
  spectrum = \"stdillum-D65\"
  output = \"d65.csv\"

  steradian measure series job.toml";

/// One measurement of the file.
struct Step {
    measure: Measure,
    command: String,
}

pub(crate) fn run(series: &Series, cancel: &CancelToken) -> Result<(), Failure> {
    let name = series.file.display();
    let text = std::fs::read_to_string(&series.file).map_err(|e| match e.kind() {
        std::io::ErrorKind::InvalidData => format!("{name} is not a text file"),
        _ => format!("cannot read {name}: {}", reason(&e)),
    })?;
    // All of the file is checked before the first measurement, which may take hours.
    let steps = steps(&text).map_err(|fault| fault.shown(&name.to_string(), &text))?;
    for (i, step) in steps.iter().enumerate() {
        note(&format!("[{}/{}] {}", i + 1, steps.len(), step.command));
        if !series.dry_run {
            execute(&step.measure, cancel)?;
        }
    }
    Ok(())
}

/// What is wrong with a job file, and where [bytes].
#[derive(Debug, PartialEq)]
pub(super) struct Fault {
    message: String,
    span: Range<usize>,
}

impl Fault {
    pub(super) fn new(message: impl Into<String>, span: Range<usize>) -> Self {
        Self { message: message.into(), span }
    }

    /// `file:line:column`, the line and a caret.
    pub(super) fn shown(&self, name: &str, text: &str) -> String {
        let start = self.span.start.min(text.len());
        let before = text.get(..start).unwrap_or(text);
        let (line_number, line_start) =
            (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |i| i + 1));
        let line = text[line_start..].lines().next().unwrap_or("");
        let column = before[line_start..].chars().count();
        let number = line_number.to_string();
        let margin = " ".repeat(number.len());
        format!(
            "{}\n{margin}--> {name}:{line_number}:{}\n{margin} |\n{number} | {line}\n{margin} | {}^",
            self.message,
            column + 1,
            " ".repeat(column)
        )
    }
}

fn steps(text: &str) -> Result<Vec<Step>, Fault> {
    let document = DeTable::parse(text)
        .map_err(|e| Fault::new(format!("not TOML: {}", e.message().trim()), e.span().unwrap_or(0..0)))?;
    let mut defaults = Vec::new();
    let mut measures = None;
    for (key, value) in document.get_ref() {
        if key.get_ref() == "measure" {
            measures = Some(value);
        } else {
            defaults.push((key, value));
        }
    }
    let Some(measures) = measures else {
        return Err(Fault::new("a job file needs at least one [[measure]] table", 0..0));
    };
    let DeValue::Array(tables) = measures.get_ref() else {
        return Err(Fault::new("`measure` is a list of tables: write [[measure]]", measures.span()));
    };
    let commands = Measure::augment_subcommands(Command::new("steradian measure").no_binary_name(true));
    let mut used = vec![false; defaults.len()];
    let mut steps = Vec::new();
    for table in tables.iter() {
        let DeValue::Table(own) = table.get_ref() else {
            return Err(Fault::new("`measure` is a list of tables: write [[measure]]", table.span()));
        };
        steps.push(step(&commands, own, table.span(), &defaults, &mut used)?);
    }
    if let Some(i) = used.iter().position(|used| !used) {
        let key = defaults[i].0;
        let message = format!("`{}` is an option of none of the instruments of this file", key.get_ref());
        return Err(Fault::new(message, key.span()));
    }
    Ok(steps)
}

type Entry<'d, 'i> = (&'d Spanned<std::borrow::Cow<'i, str>>, &'d Spanned<DeValue<'i>>);

/// One table as the command that it stands for.
fn step<'d, 'i>(
    commands: &Command,
    own: &'d DeTable<'i>,
    span: Range<usize>,
    defaults: &[Entry<'d, 'i>],
    used: &mut [bool],
) -> Result<Step, Fault> {
    let named = own.iter().find(|(key, _)| key.get_ref() == "instrument");
    let Some((_, instrument)) = named else {
        return Err(Fault::new("this measurement names no `instrument`", span));
    };
    let names = || commands.get_subcommands().map(Command::get_name).filter(|n| *n != "series");
    let known = match instrument.get_ref() {
        DeValue::String(name) => names().find(|n| n == name).map(str::to_owned),
        _ => None,
    };
    let Some(name) = known else {
        let list = names().collect::<Vec<_>>().join(", ");
        return Err(Fault::new(format!("expected an instrument, one of {list}"), instrument.span()));
    };
    let command = commands.find_subcommand(&name);
    let is =
        |a: &clap::Arg, key: &str| a.get_long() == Some(key) || (key == "scene" && a.get_id() == "scenes");
    let has = |key: &str| command.is_some_and(|c| c.get_arguments().any(|a| is(a, key)));
    let mut words = vec![name.clone()];
    let mut scenes = Vec::new();
    let mut places = Vec::new();
    let mut add = |key: &str, value: &Spanned<DeValue<'_>>, place: Range<usize>| -> Result<(), Fault> {
        for text in texts(value)? {
            match (key, text) {
                ("scene", Text::Word(word)) => scenes.push(word),
                (_, Text::Word(word)) => words.push(format!("--{key}={word}")),
                (_, Text::Switch(true)) => words.push(format!("--{key}")),
                (_, Text::Switch(false)) => {}
            }
        }
        places.push((key.to_owned(), place));
        Ok(())
    };
    for ((key, value), used) in defaults.iter().zip(used) {
        if has(key.get_ref()) {
            *used = true;
            if !own.contains_key(key.get_ref().as_ref()) {
                add(key.get_ref(), value, key.span())?;
            }
        }
    }
    for (key, value) in own.iter().filter(|(key, _)| key.get_ref() != "instrument") {
        if !has(key.get_ref()) {
            let message = format!("instrument \"{name}\" has no option `{}`", key.get_ref());
            return Err(Fault::new(message, key.span()));
        }
        add(key.get_ref(), value, key.span())?;
    }
    words.extend(scenes);
    let parsed = commands.clone().try_get_matches_from(&words).and_then(|m| Measure::from_arg_matches(&m));
    let measure = parsed.map_err(|e| {
        let text = e.to_string();
        // The first paragraph is the message; below it stand tips and the usage.
        let lines = text.lines().map(str::trim).take_while(|l| !l.is_empty());
        let message = lines.collect::<Vec<_>>().join(" ").trim_start_matches("error: ").to_owned();
        // The option that the message is about, else the measurement.
        let place = places.iter().find(|(key, _)| message.contains(&format!("--{key} ")));
        Fault::new(message, place.map_or(span, |(_, p)| p.clone()))
    })?;
    Ok(Step { measure, command: words.join(" ") })
}

/// A value as the command line has it.
enum Text {
    Word(String),
    Switch(bool),
}

fn texts(value: &Spanned<DeValue<'_>>) -> Result<Vec<Text>, Fault> {
    match value.get_ref() {
        DeValue::String(s) => Ok(vec![Text::Word(s.to_string())]),
        DeValue::Integer(i) => Ok(vec![Text::Word(i.as_str().replace('_', ""))]),
        DeValue::Float(x) => Ok(vec![Text::Word(x.as_str().replace('_', ""))]),
        DeValue::Boolean(b) => Ok(vec![Text::Switch(*b)]),
        DeValue::Array(all) => {
            let nested = all.iter().map(texts).collect::<Result<Vec<_>, _>>()?;
            Ok(nested.into_iter().flatten().collect())
        }
        DeValue::Datetime(d) => Ok(vec![Text::Word(d.to_string())]),
        DeValue::Table(_) => {
            Err(Fault::new("an option is a text, a number, true, false or a list", value.span()))
        }
    }
}
