//! `steradian plot`: how a material scatters, as pictures.

use crate::args::{self, LobeRadius, LobeScale, PlotKind};
use crate::load;
use crate::output::{Target, note};
use crate::sheet::Sheet;
use crate::{Failure, pick};
use std::path::PathBuf;
use steradian::lab::plot::{Drawing, Scale};
use steradian::lab::preview::preview;
use steradian::lab::probe::ProbeError;
use steradian::lab::{Subject, portrait};
use steradian::render::{CancelToken, RenderOptions};
use steradian::scene::{Diagnostics, Disk, Overrides, RenderJob, SceneDesc};

pub(crate) fn run(arguments: &args::Plot) -> Result<(), Failure> {
    let loading = load::read(&arguments.sample.scenes)?;
    let scene = loading.imported.scene.clone();
    let job = pick::compile(loading)?;
    let subject = arguments.sample.subject(&job)?;
    pick::check_wavelengths(&subject, &arguments.wavelength)?;
    let written = match scene {
        Some(scene) if arguments.sphere => sphere(arguments, scene, subject.name())?,
        _ => figures(arguments, &subject)?,
    };
    if !arguments.quiet {
        let names: Vec<_> = written.iter().map(|p| p.display().to_string()).collect();
        note(&format!("material \"{}\": {}", subject.name(), names.join(", ")));
    }
    Ok(())
}

fn figures(arguments: &args::Plot, subject: &Subject<'_>) -> Result<Vec<PathBuf>, Failure> {
    let outputs = outputs(arguments, subject.name(), "svg");
    let sheets = outputs.iter().map(|p| Sheet::new(p)).collect::<Result<Vec<_>, _>>()?;
    let drawings = draw(arguments, subject).map_err(|e| e.to_string())?;
    if drawings.is_empty() {
        let name = subject.name();
        return Err(Failure::Message(format!("material \"{name}\" has no single index of refraction")));
    }
    let drawing = Drawing::grid(drawings, 2);
    for sheet in &sheets {
        sheet.write(&drawing)?;
    }
    Ok(outputs)
}

fn draw(arguments: &args::Plot, subject: &Subject<'_>) -> Result<Vec<Drawing>, ProbeError> {
    let view = portrait::View {
        wavelengths: arguments.wavelength.clone(),
        thetas: arguments.theta.clone(),
        radius: match arguments.radius {
            LobeRadius::Intensity => portrait::LobeRadius::Intensity,
            LobeRadius::F => portrait::LobeRadius::F,
        },
        scale: match arguments.scale {
            LobeScale::Linear => Scale::Linear,
            LobeScale::Log => Scale::Logarithmic { decades: 4 },
        },
        walks: arguments.walks,
    };
    let wants = |kind| arguments.kind == kind || arguments.kind == PlotKind::All;
    let mut drawings = Vec::new();
    if wants(PlotKind::Lobes) {
        drawings.push(portrait::lobes(subject, &view)?.draw());
    }
    if wants(PlotKind::Albedo) {
        drawings.push(portrait::albedo_over_angle(subject, &view)?.draw());
        drawings.push(portrait::albedo_over_wavelength(subject, &view)?.draw());
    }
    if wants(PlotKind::Fresnel) {
        drawings.extend(portrait::fresnel(subject, &view)?.map(|c| c.draw()));
    }
    if wants(PlotKind::Spectrum) {
        let index = portrait::index_over_wavelength(subject)?;
        drawings.extend(index.map(|c| c.draw()));
        if arguments.kind == PlotKind::Spectrum && drawings.is_empty() {
            drawings.push(portrait::albedo_over_wavelength(subject, &view)?.draw());
        }
    }
    Ok(drawings)
}

fn sphere(arguments: &args::Plot, scene: SceneDesc, name: &str) -> Result<Vec<PathBuf>, Failure> {
    let outputs = outputs(arguments, name, "png");
    let targets = outputs.iter().map(|p| Target::new(p)).collect::<Result<Vec<_>, _>>()?;
    let mut desc = preview(scene, name).map_err(|e| e.to_string())?;
    let overrides = Overrides {
        spp: Some(arguments.spp),
        resolution: Some(arguments.resolution),
        ..Overrides::default()
    };
    overrides.apply(&mut desc).map_err(|e| e.to_string())?;
    // The materials have been compiled before, and what is around them is always the same.
    let job: RenderJob = steradian::scene::compile(desc, &Disk, &mut Diagnostics::default())
        .ok_or_else(|| format!("material \"{name}\" cannot be put on a sphere"))?;
    let reporter = crate::progress::Reporter::new(arguments.quiet);
    let rendered = steradian::render::render(&job, &RenderOptions::default(), &reporter, &CancelToken::new())
        .map_err(|e| e.to_string())?;
    reporter.finish();
    for target in &targets {
        target.write(&rendered.frame)?;
    }
    Ok(outputs)
}

/// The files that were asked for, or one that is called like the material.
fn outputs(arguments: &args::Plot, name: &str, extension: &str) -> Vec<PathBuf> {
    if !arguments.output.is_empty() {
        return arguments.output.clone();
    }
    // Names of materials may hold anything, also the separators of folders.
    let safe = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' };
    let stem: String = name.chars().map(safe).collect();
    vec![PathBuf::from(format!("{}.{extension}", if stem.is_empty() { "material" } else { &stem }))]
}
