//! `steradian verify`.

mod json;
mod table;

use crate::Failure;
use crate::args;
use crate::load::{self, Verbosity};
use crate::output::{note, print, reason};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;
use steradian::bsdf::conformance::Effort;
use steradian::lab::verify::{self, Acceptance, DEFAULT_WAVELENGTHS, Options, Report};
use steradian::lab::{Subject, UnknownMaterial};

/// Verifies, reports, and fails where a subject does.
pub(crate) fn run(arguments: &args::Verify) -> Result<(), Failure> {
    let options = options(arguments);
    let built_in = arguments.scenes.is_empty();
    let acceptance = if built_in || arguments.declared { Acceptance::AsDeclared } else { Acceptance::Lawful };
    if let Some(path) = &arguments.html {
        // Not after minutes of work.
        std::fs::write(path, "").map_err(|e| format!("cannot write {}: {}", path.display(), reason(&e)))?;
    }
    let report = if built_in {
        with_progress(arguments, |p| verify::specimens(&options, p))
    } else {
        scene(arguments, &options)?
    };
    if let Some(path) = &arguments.html {
        let title = match arguments.scenes.first() {
            Some(scene) => format!("Scattering of the materials of {}", scene.display()),
            None => "Scattering of the built-in specimens".to_owned(),
        };
        std::fs::write(path, verify::html(&report, &title))
            .map_err(|e| format!("cannot write {}: {}", path.display(), reason(&e)))?;
    }
    let text =
        if arguments.json { json::text(&report, acceptance) } else { table::text(&report, acceptance) };
    print(&text)?;
    if report.passes(acceptance) { Ok(()) } else { Err(Failure::Reported) }
}

fn options(arguments: &args::Verify) -> Options {
    let effort = match arguments.effort {
        args::Effort::Quick => Effort::QUICK,
        args::Effort::Normal => Effort::NORMAL,
        args::Effort::Thorough => Effort::THOROUGH,
    };
    let given = !arguments.wavelengths.is_empty();
    Options {
        effort: effort.with_seed(arguments.seed),
        wavelengths: if given { arguments.wavelengths.clone() } else { DEFAULT_WAVELENGTHS.to_vec() },
        threads: arguments.threads.map(|n| n as usize),
    }
}

fn scene(arguments: &args::Verify, options: &Options) -> Result<Report, Failure> {
    let job = load::read(&arguments.scenes)?.compile(Verbosity::ErrorsOnly)?;
    let mut subjects = Vec::new();
    for name in &arguments.material {
        let subject = Subject::find(&job, name).map_err(|e| Failure::Message(unknown(&e)))?;
        with_parts(subject, &mut subjects);
    }
    if arguments.material.is_empty() {
        subjects = Subject::all(&job);
        // The first is the format's default: of interest only where the scene has no other.
        if subjects.len() > 1 {
            subjects.remove(0);
        }
    }
    Ok(with_progress(arguments, |progress| verify::subjects(&subjects, options, progress)))
}

/// A mix is verified through what it mixes.
fn with_parts<'j>(subject: Subject<'j>, subjects: &mut Vec<Subject<'j>>) {
    if subjects.iter().any(|s| s.name() == subject.name()) {
        return;
    }
    subjects.push(subject);
    for part in subject.parts() {
        with_parts(part, subjects);
    }
}

fn unknown(e: &UnknownMaterial) -> String {
    const SHOWN: usize = 20;
    let more = if e.known.len() > SHOWN { ", …" } else { "" };
    let known: Vec<&str> = e.known.iter().skip(1).take(SHOWN).map(String::as_str).collect();
    if known.is_empty() { format!("{e}") } else { format!("{e}; it has {}{more}", known.join(", ")) }
}

fn with_progress(arguments: &args::Verify, work: impl FnOnce(verify::Progress<'_>) -> Report) -> Report {
    if arguments.quiet || !std::io::stderr().is_terminal() {
        if !arguments.quiet {
            note("verifying; this takes about a second for each material");
        }
        return work(&|_, _| {});
    }
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr_with_hz(10));
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos} of {len} materials") {
        bar.set_style(style);
    }
    let report = work(&|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    report
}
