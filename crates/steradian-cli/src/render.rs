//! `steradian render`.

use crate::args;
use crate::load::{self, Verbosity};
use crate::output::{Target, note};
use crate::progress::{Reporter, clock};
use crate::{Failure, interrupt};
use std::path::{Path, PathBuf};
use steradian::render::{Adaptive, RenderOptions, Report};
use steradian::scene::{Overrides, SceneDesc};

pub(crate) fn run(arguments: &args::Render) -> Result<(), Failure> {
    let verbosity = if arguments.quiet { Verbosity::ErrorsOnly } else { Verbosity::All };
    let mut loading = load::read(&arguments.scenes)?;
    let mut outputs = arguments.output.clone();
    if let Some(desc) = &mut loading.imported.scene {
        overrides(arguments).apply(desc).map_err(|e| Failure::Message(e.to_string()))?;
        if outputs.is_empty() {
            outputs = default_outputs(desc, arguments.scenes.is_empty());
        }
    }
    // A mistyped name must not cost the hours that the picture takes.
    let targets = outputs.iter().map(|p| Target::new(p)).collect::<Result<Vec<_>, _>>()?;
    let job = loading.compile(verbosity)?;

    let cancel = interrupt::token("stopping after this pass; press Ctrl-C again to stop at once");
    let reporter = Reporter::new(arguments.quiet);
    reporter.begin(&job);
    let options = RenderOptions {
        threads: arguments.threads.map(|n| n as usize),
        time_limit: arguments.time,
        ..RenderOptions::default()
    };
    let rendered = steradian::render::render(&job, &options, &reporter, &cancel)
        .map_err(|e| Failure::Message(e.to_string()))?;
    reporter.finish();

    for target in &targets {
        target.write(&rendered.frame)?;
    }
    let report = &rendered.report;
    warn_of_dropped(report);
    // Whoever stopped it knows.
    if !cancel.is_cancelled() && !arguments.quiet {
        warn_of_maximum(report);
    }
    if !arguments.quiet {
        let names: Vec<_> = targets.iter().map(|t| t.path().display().to_string()).collect();
        note(&format!(
            "{}: {} in {}, {:.2} Mrays/s",
            names.join(", "),
            report.adaptive.map_or_else(|| format!("{} spp", report.spp), |adaptive| adaptive.to_string()),
            clock(report.elapsed),
            report.mrays_per_second()
        ));
    }
    if arguments.stats {
        note(&report.to_string());
    }
    if cancel.is_cancelled() {
        note(&format!("stopped after {} of {} samples per pixel", report.spp, report.spp_requested));
        return Err(Failure::Interrupted);
    }
    Ok(())
}

fn overrides(a: &args::Render) -> Overrides {
    Overrides {
        spp: a.spp,
        noise: a.noise,
        resolution: a.resolution,
        crop: a.crop,
        seed: a.seed,
        integrator: a.integrator.clone(),
        max_depth: a.max_depth,
    }
}

/// The scene's own file name; the built-in scene also makes a PNG, to be looked at.
fn default_outputs(desc: &SceneDesc, built_in: bool) -> Vec<PathBuf> {
    let named = PathBuf::from(&desc.film.filename);
    if built_in {
        let png = Path::new(&desc.film.filename).with_extension("png");
        vec![named, png]
    } else {
        vec![named]
    }
}

/// Says that more samples would have been needed, and how many.
fn warn_of_maximum(report: &Report) {
    if let Some(adaptive) = report.adaptive.filter(Adaptive::stopped_by_maximum) {
        note(&format!(
            "warning: {:.1} % of the pixels took all {} samples that they may; allow more with --spp to come closer to the noise asked for",
            100.0 * adaptive.share_at_maximum,
            report.spp_requested
        ));
    }
}

fn warn_of_dropped(report: &Report) {
    if report.dropped.count > 0 {
        let places: Vec<_> = report
            .dropped
            .first
            .iter()
            .map(|d| format!("pixel ({}, {}) sample {}", d.pixel[0], d.pixel[1], d.sample))
            .collect();
        note(&format!(
            "warning: {} samples were not finite and were dropped; the first: {}",
            report.dropped.count,
            places.join(", ")
        ));
    }
}
