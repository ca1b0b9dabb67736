//! Spectrum-valued parameters.

use super::args::{Args, Taken};
use crate::color::ColorSpaceKind;
use crate::scene::desc::{SpectrumDesc, SpectrumParam, SpectrumValue, TextureId};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::source::Span;
use crate::scene::text::{Param, ParamType, Values};
use crate::spectrum::named;

/// What the RGB values of a parameter mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Fractions: in [0,1].
    Albedo,
    /// Quantities: not negative.
    Unbounded,
    /// Light: not negative, relative to the colour space's white.
    Illuminant,
}

/// Indices of refraction, either way through an interface; what lies outside is taken for a slip.
const INDICES: std::ops::RangeInclusive<f32> = 0.01..=100.0;

const SPECTRAL: [ParamType; 3] = [ParamType::Spectrum, ParamType::Rgb, ParamType::Blackbody];

impl Args<'_> {
    /// A spectrum that is a default, located at the class name.
    pub(super) fn default_spectrum(&self, value: SpectrumValue) -> SpectrumDesc {
        SpectrumDesc { value, span: self.span }
    }

    /// A spectrum.
    pub(super) fn spectrum_opt(&mut self, name: &'static str, role: Role) -> Option<SpectrumDesc> {
        let taken = self.take(name, &SPECTRAL)?;
        self.spectrum_value(taken, role)
    }

    /// The spectrum of a light, or the colour space's white.
    pub(super) fn light_spectrum(&mut self, name: &'static str) -> SpectrumDesc {
        let white = self.default_spectrum(SpectrumValue::Illuminant(self.color_space()));
        self.spectrum_opt(name, Role::Illuminant).unwrap_or(white)
    }

    /// A spectrum or a texture of spectra.
    pub(super) fn spectrum_param_opt(&mut self, name: &'static str, role: Role) -> Option<SpectrumParam> {
        let taken = self
            .take(name, &[ParamType::Texture, ParamType::Spectrum, ParamType::Rgb, ParamType::Blackbody])?;
        if taken.param.ty != ParamType::Texture {
            return self.spectrum_value(taken, role).map(SpectrumParam::Value);
        }
        let Values::Texts(list) = &taken.param.values else { return None };
        let [texture] = list.as_slice() else {
            let n = list.len();
            self.error(taken.param.value_span, format!("parameter \"{name}\" takes one value, found {n}"));
            return None;
        };
        let id = self.ctx.spectrum_textures.refer(texture);
        self.uses.push(TextureId::Spectrum(id));
        Some(SpectrumParam::Texture(id))
    }

    /// A spectrum or a texture of spectra, or a constant.
    pub(super) fn spectrum_param(&mut self, name: &'static str, role: Role, default: f32) -> SpectrumParam {
        let fallback = SpectrumParam::Value(self.default_spectrum(SpectrumValue::Constant(default)));
        self.spectrum_param_opt(name, role).unwrap_or(fallback)
    }

    /// An index of refraction: a number > 0 or a spectrum.
    pub(super) fn refractive_index_opt(&mut self, name: &'static str) -> Option<SpectrumDesc> {
        let types = [ParamType::Float, ParamType::Spectrum, ParamType::Rgb, ParamType::Blackbody];
        let taken = self.take(name, &types)?;
        if taken.param.ty != ParamType::Float {
            return self.spectrum_value(taken, Role::Unbounded);
        }
        let span = taken.param.value_span;
        match &taken.param.values {
            Values::Numbers(v) if v.len() == 1 && INDICES.contains(&v[0]) => {
                Some(SpectrumDesc { value: SpectrumValue::Constant(v[0]), span })
            }
            _ => {
                let (low, high) = (INDICES.start(), INDICES.end());
                let demand = format!("must be one number from {low} to {high} or a spectrum");
                self.error(span, format!("parameter \"{name}\" {demand}"));
                None
            }
        }
    }

    /// A list of spectra: numbers, or names.
    pub(super) fn spectra(&mut self, name: &'static str) -> Vec<SpectrumDesc> {
        let Some(taken) = self.take(name, &[ParamType::Float, ParamType::Spectrum]) else {
            return Vec::new();
        };
        let span = taken.param.value_span;
        match &taken.param.values {
            Values::Numbers(v) if taken.param.ty == ParamType::Float => {
                v.iter().map(|&v| SpectrumDesc { value: SpectrumValue::Constant(v), span }).collect()
            }
            Values::Numbers(v) => {
                let samples = self.samples(&taken.param, v);
                samples.map(|value| SpectrumDesc { value, span }).into_iter().collect()
            }
            Values::Texts(names) => {
                let mut all = Vec::new();
                for n in names {
                    all.extend(
                        self.named(&n.value, n.span).map(|value| SpectrumDesc { value, span: n.span }),
                    );
                }
                all
            }
            Values::Integers(_) | Values::Bools(_) => Vec::new(),
        }
    }

    fn spectrum_value(&mut self, taken: Taken, role: Role) -> Option<SpectrumDesc> {
        let Taken { param, color_space } = taken;
        let span = param.value_span;
        let value = match (param.ty, &param.values) {
            (ParamType::Rgb, Values::Numbers(v)) => self.rgb(&param, v, color_space, role)?,
            (ParamType::Blackbody, Values::Numbers(v)) => self.blackbody(&param, v)?,
            (ParamType::Spectrum, Values::Numbers(v)) => self.samples(&param, v)?,
            (ParamType::Spectrum, Values::Texts(v)) => {
                let [name] = v.as_slice() else {
                    let message =
                        format!("parameter \"{}\" takes one spectrum, found {}", param.name, v.len());
                    self.error(span, message);
                    return None;
                };
                self.named(&name.value, name.span)?
            }
            _ => return None,
        };
        Some(SpectrumDesc { value, span })
    }

    fn rgb(
        &mut self,
        p: &Param,
        v: &[f32],
        color_space: ColorSpaceKind,
        role: Role,
    ) -> Option<SpectrumValue> {
        let Ok(rgb) = <[f32; 3]>::try_from(v) else {
            let n = v.len() / 3;
            self.error(p.value_span, format!("parameter \"{}\" takes one rgb value, found {n}", p.name));
            return None;
        };
        let fault = match role {
            _ if rgb.iter().any(|&c| c < 0.0) => "rgb components must not be negative",
            Role::Albedo if rgb.iter().any(|&c| c > 1.0) => {
                "rgb components must be from 0 to 1: they are fractions"
            }
            Role::Albedo | Role::Unbounded | Role::Illuminant => {
                return Some(SpectrumValue::Rgb { rgb, color_space });
            }
        };
        self.error(p.value_span, format!("parameter \"{}\": {fault}", p.name));
        None
    }

    fn blackbody(&mut self, p: &Param, v: &[f32]) -> Option<SpectrumValue> {
        match *v {
            [kelvin] if kelvin > 0.0 => Some(SpectrumValue::Blackbody { kelvin }),
            [_] => {
                self.error(p.value_span, format!("parameter \"{}\": a temperature must be positive", p.name));
                None
            }
            _ => {
                let message =
                    format!("parameter \"{}\" takes one temperature, found {} numbers", p.name, v.len());
                let d = Diagnostic::error(p.value_span, message);
                self.ctx
                    .diagnostics
                    .push(d.with_help("pbrt-v3's second number is now the parameter \"scale\""));
                None
            }
        }
    }

    fn samples(&mut self, p: &Param, v: &[f32]) -> Option<SpectrumValue> {
        let (lambda, values): (Vec<f32>, Vec<f32>) = v.chunks_exact(2).map(|c| (c[0], c[1])).unzip();
        let fault = if lambda.is_empty() {
            "at least one pair of wavelength and value is needed".to_owned()
        } else if let Some(w) = lambda.windows(2).find(|w| w[0] >= w[1]) {
            format!("wavelengths must increase, found {} after {}", w[1], w[0])
        } else if lambda[0] <= 0.0 {
            format!("wavelengths must be positive, found {}", lambda[0])
        } else if let Some(negative) = values.iter().find(|v| **v < 0.0) {
            format!("values must not be negative, found {negative}")
        } else {
            return Some(SpectrumValue::Samples { lambda, values });
        };
        self.error(p.value_span, format!("parameter \"{}\": {fault}", p.name));
        None
    }

    fn named(&mut self, name: &str, span: Span) -> Option<SpectrumValue> {
        if named::names().any(|n| n == name) {
            return Some(SpectrumValue::Named(name.to_owned()));
        }
        if name.contains(['.', '/']) {
            return Some(SpectrumValue::File(self.ctx.base.join(name)));
        }
        let d = Diagnostic::error(span, format!("unknown spectrum \"{name}\""));
        self.ctx.diagnostics.push(d.with_nearest(name, named::names()));
        None
    }
}
