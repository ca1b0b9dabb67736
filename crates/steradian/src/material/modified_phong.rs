//! `Material "modifiedphong"`.

use super::declared::Declared;
use super::inputs::Lookup;
use super::passive::require_passive;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::{Bsdf, ModifiedPhong, PhongLobe, PhongNormalization, PhongSampling};
use crate::texture::SpectrumInput;

/// The modified Phong model, B (2.30)–(2.38).
#[derive(Clone, Debug, PartialEq)]
pub struct ModifiedPhongMaterial {
    /// Diffuse reflectance. Where the sum of both exceeds one by a texture, both are scaled down in proportion.
    pub diffuse: SpectrumInput,
    /// Specular reflectance.
    pub specular: SpectrumInput,
    /// Specular exponent, ≥ 0.
    pub exponent: f32,
    /// Where the lobe is.
    pub lobe: PhongLobe,
    /// How it is normalised.
    pub normalization: PhongNormalization,
    /// How it is sampled.
    pub sampling: PhongSampling,
}

impl Declared for ModifiedPhongMaterial {
    const CLASS: &'static str = "modifiedphong";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::fraction("diffuse", 0.5),
        Parameter::fraction("specular", 0.25),
        // At 10⁴ the lobe is 0.8° wide: what is narrower is a mirror, and more than the suite's cells resolve.
        Parameter::number("exponent", 10.0, 0.0, 1e4),
        Parameter::choice("lobe", &["mirror", "halfway"]),
        Parameter::choice("normalization", &["exact", "printed"]),
        Parameter::choice("sampling", &["lobe", "shirleywang"]),
    ];

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let [diffuse, specular] = ["diffuse", "specular"].map(|name| arguments.spectrum(name));
        // At most one of them is a default, which is no place to point at.
        let stated = if arguments.given("specular") { "specular" } else { "diffuse" };
        require_passive(stated, &[("diffuse", &diffuse), ("specular", &specular)])?;
        Ok(Self {
            exponent: arguments.number("exponent"),
            lobe: match arguments.choice("lobe") {
                "halfway" => PhongLobe::Halfway,
                _ => PhongLobe::Mirror,
            },
            normalization: match arguments.choice("normalization") {
                "printed" => PhongNormalization::Printed,
                _ => PhongNormalization::Exact,
            },
            sampling: match arguments.choice("sampling") {
                "shirleywang" => PhongSampling::ShirleyWang,
                _ => PhongSampling::Lobe,
            },
            diffuse,
            specular,
        })
    }

    fn is_textured(&self) -> bool {
        self.diffuse.is_textured() || self.specular.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        let [diffuse, specular] = [&self.diffuse, &self.specular].map(|input| lookup.reflectance(input));
        let share = (diffuse + specular).map(|sum| 1.0 / sum.max(1.0));
        Some(Bsdf::ModifiedPhong(ModifiedPhong {
            diffuse: diffuse * share,
            specular: specular * share,
            exponent: self.exponent,
            lobe: self.lobe,
            normalization: self.normalization,
            sampling: self.sampling,
        }))
    }
}
