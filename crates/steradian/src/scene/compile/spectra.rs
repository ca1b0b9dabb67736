//! From the ways to state a spectrum to functions of wavelength.

use crate::color::{ColorSpace, ColorSpaceKind, Rgb, UpsamplingTable, UpsamplingTables};
use crate::math::Vec3;
use crate::scene::desc::{FilmDesc, FilmKind, SpectrumDesc, SpectrumValue};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};
use crate::scene::files::{FileSystem, reason};
use crate::spectrum::blackbody::Blackbody;
use crate::spectrum::named::{named, names};
use crate::spectrum::tabulated::Tabulated;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, spd};
use crate::units::Kelvin;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What an RGB triple stands for, by the parameter that holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meaning {
    /// A reflectance or transmittance, in [0, 1].
    Albedo,
    /// A quantity without upper bound, such as an index of refraction.
    Unbounded,
    /// Light.
    Illuminant,
}

/// Converts spectra; colour spaces and tables are set up once, when they are first met.
pub(super) struct SpectrumCompiler<'a> {
    files: &'a dyn FileSystem,
    tables: &'a UpsamplingTables,
    spaces: [Option<ColorSpace>; 4],
    named: BTreeMap<String, Spectrum>,
    files_read: BTreeMap<PathBuf, Spectrum>,
    /// Wavelengths beyond 360–830 nm that the film records [nm]; data must reach as far.
    beyond_visible: Option<[f32; 2]>,
}

impl<'a> SpectrumCompiler<'a> {
    pub(super) fn new(files: &'a dyn FileSystem, tables: &'a UpsamplingTables, film: &FilmDesc) -> Self {
        let beyond_visible = match film.kind {
            FilmKind::Spectral { lambda_min, lambda_max, .. }
                if lambda_min < LAMBDA_MIN || lambda_max > LAMBDA_MAX =>
            {
                Some([lambda_min, lambda_max])
            }
            FilmKind::Spectral { .. } | FilmKind::Rgb | FilmKind::GBuffer { .. } => None,
        };
        Self {
            files,
            tables,
            spaces: [const { None }; 4],
            named: BTreeMap::new(),
            files_read: BTreeMap::new(),
            beyond_visible,
        }
    }

    /// A colour space, set up when it is first asked for.
    pub(super) fn space(&mut self, kind: ColorSpaceKind) -> &ColorSpace {
        self.spaces[kind as usize].get_or_insert_with(|| ColorSpace::new(kind))
    }

    /// The film's range [nm] where it reaches beyond 360–830 nm.
    pub(super) fn beyond_visible(&self) -> Option<[f32; 2]> {
        self.beyond_visible
    }

    /// The upsampling table of a colour space, built when the first coloured picture needs it.
    pub(super) fn table(&mut self, kind: ColorSpaceKind) -> Arc<UpsamplingTable> {
        let tables = self.tables;
        tables.get(self.space(kind))
    }

    /// The spectrum that `desc` states; an error is reported and replaced by zero, so that all others are found, too.
    pub(super) fn compile(
        &mut self,
        desc: &SpectrumDesc,
        meaning: Meaning,
        diagnostics: &mut Diagnostics,
    ) -> Spectrum {
        match self.try_compile(desc, meaning) {
            Ok(spectrum) => {
                self.check_range(desc, &spectrum, diagnostics);
                spectrum
            }
            Err(diagnostic) => {
                diagnostics.push(*diagnostic);
                Spectrum::Constant(0.0)
            }
        }
    }

    /// Outside 360–830 nm nothing is extrapolated, and nothing is taken to be black that was merely not measured.
    fn check_range(&self, desc: &SpectrumDesc, spectrum: &Spectrum, diagnostics: &mut Diagnostics) {
        if let (Some([from, to]), Some((min, max))) = (self.beyond_visible, spectrum.range())
            && (from < min || to > max)
        {
            let message =
                format!("the film records {from}–{to} nm, but there are data for {min}–{max} nm only");
            diagnostics.error(desc.span, message);
        }
    }

    fn try_compile(&mut self, desc: &SpectrumDesc, meaning: Meaning) -> Result<Spectrum, Box<Diagnostic>> {
        let error = |message: String| Box::new(Diagnostic::error(desc.span, message));
        Ok(match &desc.value {
            SpectrumValue::Constant(v) => Spectrum::Constant(*v),
            SpectrumValue::Rgb { rgb, color_space } => {
                let space = self.space(*color_space);
                let rgb = Rgb(Vec3::from_array(*rgb));
                match meaning {
                    Meaning::Albedo => space.albedo(rgb).map_err(|e| error(e.to_string()))?,
                    Meaning::Unbounded => space.unbounded(rgb),
                    Meaning::Illuminant => space.illuminant_rgb(rgb),
                }
            }
            SpectrumValue::Blackbody { kelvin } => {
                Spectrum::Blackbody(Blackbody::normalized(Kelvin(*kelvin)))
            }
            SpectrumValue::Samples { lambda, values } => {
                let pairs: Vec<_> = lambda.iter().copied().zip(values.iter().copied()).collect();
                tabulated(Tabulated::new(&pairs).map_err(|e| error(e.to_string()))?)
            }
            SpectrumValue::Named(name) => self.named(name).ok_or_else(|| {
                let unknown = Diagnostic::error(desc.span, format!("unknown spectrum \"{name}\""));
                Box::new(unknown.with_nearest(name, names()))
            })?,
            SpectrumValue::File(path) => self
                .file(path)
                .map_err(|e| error(format!("cannot read spectrum file {}: {e}", path.display())))?,
            SpectrumValue::Illuminant(kind) => self.space(*kind).illuminant().clone(),
        })
    }
}

impl SpectrumCompiler<'_> {
    fn named(&mut self, name: &str) -> Option<Spectrum> {
        if let Some(known) = self.named.get(name) {
            return Some(known.clone());
        }
        let spectrum = dense(named(name)?);
        self.named.insert(name.to_owned(), spectrum.clone());
        Some(spectrum)
    }

    fn file(&mut self, path: &Path) -> Result<Spectrum, String> {
        if let Some(known) = self.files_read.get(path) {
            return Ok(known.clone());
        }
        let bytes = self.files.read(path).map_err(|e| reason(&e))?;
        let text = std::str::from_utf8(&bytes).map_err(|e| e.to_string())?;
        let spectrum = tabulated(spd::parse(text).map_err(|e| e.to_string())?);
        self.files_read.insert(path.to_owned(), spectrum.clone());
        Ok(spectrum)
    }
}

/// Tables are resampled at 1 nm where that loses nothing that the film could see: within 360–830 nm a lookup then costs
/// the same whatever the table's spacing. Tables that reach beyond are kept as they are.
fn dense(spectrum: Spectrum) -> Spectrum {
    match spectrum {
        Spectrum::Tabulated(t) => tabulated(t),
        other => other,
    }
}

fn tabulated(table: Tabulated) -> Spectrum {
    let (min, max) = table.range();
    let is_visible = min == LAMBDA_MIN && max == LAMBDA_MAX;
    // Samples on whole nanometres are met exactly.
    let on_grid = table.samples().all(|(lambda, _)| lambda.fract() == 0.0);
    let spectrum = Spectrum::Tabulated(table);
    if is_visible && on_grid { Spectrum::Dense(spectrum.densely_sampled()) } else { spectrum }
}
