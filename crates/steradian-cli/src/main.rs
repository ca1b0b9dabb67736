//! The `steradian` command: renders, inspects, checks, compares, and looks at materials.

mod args;
mod bsdf;
mod compare;
mod inspect;
mod interrupt;
mod load;
mod measure;
mod output;
mod pick;
mod plot;
mod progress;
mod raster;
mod render;
mod report;
mod sheet;
mod verify;

use args::{Cli, Command};
use clap::Parser as _;
use clap::error::{ContextKind, ContextValue};
use std::process::ExitCode;

/// Why a command did not succeed.
enum Failure {
    /// The message has been shown already.
    Reported,
    /// Stopped by the user; what was done so far is saved.
    Interrupted,
    /// To be shown.
    Message(String),
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self::Message(message)
    }
}

fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|e| {
        // Whoever names a scene and no command most likely wants to see it.
        if let Some(ContextValue::String(given)) = e.get(ContextKind::InvalidSubcommand)
            && (given.ends_with(".pbrt") || given.ends_with(".pbrt.gz"))
        {
            output::note(&format!("error: a command is missing; try: steradian render {given}"));
            std::process::exit(2);
        }
        e.exit()
    });
    let outcome = match cli.command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Info(arguments) => inspect::info(&arguments),
        Command::Check(arguments) => inspect::check(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Bsdf(arguments) => bsdf::run(&arguments),
        Command::Plot(arguments) => plot::run(&arguments),
        Command::Measure(measure) => measure::run(&measure),
        Command::Report(arguments) => report::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Reported) => ExitCode::FAILURE,
        // The shells' convention for a program ended by SIGINT.
        Err(Failure::Interrupted) => ExitCode::from(130),
        Err(Failure::Message(message)) => {
            output::note(&format!("error: {message}"));
            ExitCode::FAILURE
        }
    }
}
