//! `Material "phong"`: legacy shading, not a BRDF.

use super::declared::Declared;
use super::inputs::Lookup;
use super::passive::require_passive;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, LegacyPhong};
use crate::texture::SpectrumInput;

/// Phong's model, A (40): not a BRDF. For `Integrator "classic"`; others render it as if it were one.
#[derive(Clone, Debug, PartialEq)]
pub struct LegacyPhongMaterial {
    /// Diffuse reflection coefficient, limited to [0, 1].
    pub diffuse: SpectrumInput,
    /// Ambient reflection coefficient, limited to [0, 1]; the diffuse one where it is not given.
    pub ambient: Option<SpectrumInput>,
    /// Specular reflection coefficient, limited to [0, 1].
    pub specular: SpectrumInput,
    /// Exponent, ≥ 0.
    pub exponent: f32,
}

impl Declared for LegacyPhongMaterial {
    const CLASS: &'static str = "phong";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::fraction("diffuse", 0.5),
        Parameter::fraction_opt("ambient"),
        Parameter::fraction("specular", 0.5),
        Parameter::number("exponent", 10.0, 0.0, 1e4),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let [diffuse, specular] = ["diffuse", "specular"].map(|name| arguments.spectrum(name));
        let ambient = arguments.spectrum_opt("ambient");
        // Each for itself: the text bounds no sum.
        require_passive("diffuse", &[("diffuse", &diffuse)])?;
        require_passive("specular", &[("specular", &specular)])?;
        if let Some(ambient) = &ambient {
            require_passive("ambient", &[("ambient", ambient)])?;
        }
        Ok(Self { diffuse, ambient, specular, exponent: arguments.number("exponent") })
    }

    fn is_textured(&self) -> bool {
        self.diffuse.is_textured()
            || self.specular.is_textured()
            || self.ambient.as_ref().is_some_and(SpectrumInput::is_textured)
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let diffuse = lookup.reflectance(&self.diffuse);
        Some(Bsdf::LegacyPhong(LegacyPhong {
            diffuse,
            ambient: self.ambient.as_ref().map_or(diffuse, |ambient| lookup.reflectance(ambient)),
            specular: lookup.reflectance(&self.specular),
            exponent: self.exponent,
        }))
    }
}
