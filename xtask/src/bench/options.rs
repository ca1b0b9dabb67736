//! What every section of the benchmark may be told.

use std::path::PathBuf;

/// The command line of `bench`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Options {
    /// Names of the sections to run; empty for all.
    pub(crate) sections: Vec<String>,
    /// Embree's shared library.
    pub(crate) embree: Option<PathBuf>,
    /// A Python with `mitsuba` in it.
    pub(crate) python: Option<PathBuf>,
    /// The program to compare time to equal error with.
    pub(crate) baseline: Option<PathBuf>,
    /// A collection of scenes with reference pictures.
    pub(crate) scenes: Option<PathBuf>,
    /// Interleaved repetitions of each comparison; `None` leaves it to the section.
    pub(crate) repetitions: Option<usize>,
    /// Triangles of the large builds; `None` means ten million.
    pub(crate) triangles: Option<usize>,
    /// Where the report goes.
    pub(crate) output: Option<PathBuf>,
}

impl Options {
    /// Reads the arguments after `bench`.
    pub(crate) fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self::default();
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            let Some(name) = argument.strip_prefix("--") else {
                options.sections.push(argument.clone());
                continue;
            };
            let value = rest.next().ok_or_else(|| format!("--{name} needs a value"))?;
            let count = || value.parse().map_err(|_| format!("--{name} needs a number, not `{value}`"));
            match name {
                "embree" => options.embree = Some(value.into()),
                "python" => options.python = Some(value.into()),
                "baseline" => options.baseline = Some(value.into()),
                "scenes" => options.scenes = Some(value.into()),
                "output" => options.output = Some(value.into()),
                "reps" => options.repetitions = Some(count()?),
                "triangles" => options.triangles = Some(count()?),
                _ => return Err(format!("there is no option --{name}")),
            }
        }
        Ok(options)
    }

    /// The Python interpreter to use.
    pub(crate) fn python(&self) -> PathBuf {
        self.python.clone().unwrap_or_else(|| "python3".into())
    }
}
