//! The material that the user means, and the wavelengths for which it has data.

use crate::Failure;
use crate::load::{self, Loading, Verbosity};
use std::path::PathBuf;
use steradian::lab::Subject;
use steradian::math::Vec2;
use steradian::scene::{RenderJob, nearest};

/// How many names a message lists.
const SHOWN_NAMES: usize = 20;

/// Reads the scene's materials and nothing else.
pub(crate) fn materials(paths: &[PathBuf]) -> Result<RenderJob, Failure> {
    compile(load::read(paths)?)
}

/// Compiles the materials alone.
pub(crate) fn compile(loading: Loading) -> Result<RenderJob, Failure> {
    // Warnings are about the scene as a picture, for `check` and `render` to tell.
    loading.materials_only().compile(Verbosity::ErrorsOnly)
}

/// The material of that name, or the only one that the scene states, at a point of its textures.
pub(crate) fn subject<'j>(
    job: &'j RenderJob,
    name: Option<&str>,
    [u, v]: [f32; 2],
) -> Result<Subject<'j>, String> {
    let found = match name {
        Some(name) => Subject::find(job, name).map_err(|e| {
            let hint = nearest(name, e.known.iter().map(String::as_str));
            let hint = hint.map_or_else(String::new, |n| format!("; did you mean \"{n}\"?"));
            format!("{e}{hint}\n{}", listed(&e.known))
        })?,
        None => {
            let all = Subject::all(job);
            // The first is the format's default, which nobody stated.
            match all.as_slice() {
                [only] | [_, only] => *only,
                several => {
                    let names: Vec<_> = several.iter().map(|s| s.name().to_owned()).collect();
                    return Err(format!("choose a material with --material\n{}", listed(&names)));
                }
            }
        }
    };
    Ok(found.at_uv(Vec2::new(u, v)))
}

fn listed(names: &[String]) -> String {
    let mut text = "the scene's materials:".to_owned();
    for name in names.iter().take(SHOWN_NAMES) {
        text.push_str(&format!(" \"{name}\""));
    }
    if names.len() > SHOWN_NAMES {
        text.push_str(&format!(" and {} more", names.len() - SHOWN_NAMES));
    }
    text
}

/// Refuses wavelengths for which the material's spectra have no data.
pub(crate) fn check_wavelengths(subject: &Subject<'_>, wavelengths: &[f32]) -> Result<(), String> {
    let (lo, hi) = subject.range();
    let outside = wavelengths.iter().find(|l| !(lo..=hi).contains(*l));
    outside.map_or(Ok(()), |l| {
        let name = subject.name();
        Err(format!("wavelength {l} nm: the data of material \"{name}\" reach from {lo} to {hi} nm"))
    })
}
