//! The material that the user means, and the wavelengths for which it has data.

use crate::Failure;
use crate::args::Sample;
use crate::load::{self, Loading, Verbosity};
use steradian::lab::Subject;
use steradian::math::Vec2;
use steradian::scene::{RenderJob, nearest};

/// How many names a message lists.
const SHOWN_NAMES: usize = 20;

impl Sample {
    /// Reads the scene's materials and nothing else.
    pub(crate) fn job(&self) -> Result<RenderJob, Failure> {
        compile(load::read(&self.scenes)?)
    }

    /// The material that is meant, in what [`Sample::job`] read.
    pub(crate) fn subject<'j>(&self, job: &'j RenderJob) -> Result<Subject<'j>, String> {
        subject(job, self.material.as_deref(), self.uv)
    }
}

/// Compiles the materials alone.
pub(crate) fn compile(loading: Loading) -> Result<RenderJob, Failure> {
    // Warnings are about the scene as a picture, for `check` and `render` to tell.
    loading.materials_only().compile(Verbosity::ErrorsOnly)
}

/// The material of that name, or the only one that the scene states, at a point of its textures.
fn subject<'j>(job: &'j RenderJob, name: Option<&str>, [u, v]: [f32; 2]) -> Result<Subject<'j>, String> {
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
