//! `Material "openpbr"`: OpenPBR Surface 1.1, with the specification's parameters, ranges and defaults.
//!
//! What belongs to media or to light is refused where it would show, with a word on what to use instead. Normals and
//! tangents are those of the shading frame, as for every material.

use super::declared::{Declared, Role};
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::Bsdf;
use crate::bsdf::openpbr::{OpenPbr, Slabs, Wall};
use crate::optics::dispersion::{self, LINE_D};
use crate::spectrum::Spectrum;
use crate::texture::{FloatInput, SpectrumInput};

/// OpenPBR Surface.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenPbrMaterial {
    /// Apart, since there are twice as many as other materials have.
    pub inputs: Box<OpenPbrInputs>,
}

/// Each field is the parameter of its name.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the specification documents its parameters, and Slabs repeats them")]
pub struct OpenPbrInputs {
    pub base_weight: FloatInput,
    pub base_color: SpectrumInput,
    pub base_diffuse_roughness: FloatInput,
    pub base_metalness: FloatInput,
    pub specular_weight: FloatInput,
    pub specular_color: SpectrumInput,
    pub specular_roughness: FloatInput,
    pub specular_roughness_anisotropy: FloatInput,
    pub specular_ior: Spectrum,
    pub transmission_weight: FloatInput,
    pub transmission_color: SpectrumInput,
    /// The Abbe number after its scale; `None` without dispersion.
    pub abbe_number: Option<f32>,
    pub subsurface_weight: FloatInput,
    pub subsurface_color: SpectrumInput,
    pub subsurface_scatter_anisotropy: FloatInput,
    pub coat_weight: FloatInput,
    pub coat_color: SpectrumInput,
    pub coat_roughness: FloatInput,
    pub coat_roughness_anisotropy: FloatInput,
    pub coat_ior: FloatInput,
    pub coat_darkening: FloatInput,
    pub fuzz_weight: FloatInput,
    pub fuzz_color: SpectrumInput,
    pub fuzz_roughness: FloatInput,
    pub thin_film_weight: FloatInput,
    /// In micrometres.
    pub thin_film_thickness: FloatInput,
    pub thin_film_ior: FloatInput,
    pub geometry_opacity: FloatInput,
    pub wall: Wall,
}

/// Indices that no substance exceeds, in either direction: the specification says above 0.
const MIN_IOR: f32 = 0.01;
const MAX_IOR: f32 = 100.0;

const fn share(name: &'static str, default: f32) -> Parameter {
    Parameter::float_in(name, default, 0.0, 1.0)
}

const fn positive(name: &'static str, default: f32) -> Parameter {
    Parameter::float_in(name, default, 0.0, f32::INFINITY)
}

impl Declared for OpenPbrMaterial {
    const CLASS: &'static str = "openpbr";
    const PARAMETERS: &'static [Parameter] = &[
        share("base_weight", 1.0),
        Parameter::fraction("base_color", 0.8),
        share("base_diffuse_roughness", 0.0),
        share("base_metalness", 0.0),
        positive("specular_weight", 1.0),
        Parameter::fraction("specular_color", 1.0),
        share("specular_roughness", 0.3),
        share("specular_roughness_anisotropy", 0.0),
        Parameter::index("specular_ior", 1.5),
        share("transmission_weight", 0.0),
        Parameter::fraction("transmission_color", 1.0),
        Parameter::number("transmission_depth", 0.0, 0.0, f32::INFINITY),
        Parameter::fraction("transmission_scatter", 0.0),
        Parameter::number("transmission_scatter_anisotropy", 0.0, -1.0, 1.0),
        Parameter::number("transmission_dispersion_scale", 0.0, 0.0, 1.0),
        Parameter::number("transmission_dispersion_abbe_number", 20.0, 0.0, f32::INFINITY),
        share("subsurface_weight", 0.0),
        Parameter::fraction("subsurface_color", 0.8),
        Parameter::number("subsurface_radius", 1.0, 0.0, f32::INFINITY),
        Parameter::fraction_opt("subsurface_radius_scale"),
        Parameter::float_in("subsurface_scatter_anisotropy", 0.0, -1.0, 1.0),
        share("coat_weight", 0.0),
        Parameter::fraction("coat_color", 1.0),
        share("coat_roughness", 0.0),
        share("coat_roughness_anisotropy", 0.0),
        Parameter::float_in("coat_ior", 1.6, MIN_IOR, MAX_IOR),
        share("coat_darkening", 1.0),
        share("fuzz_weight", 0.0),
        Parameter::fraction("fuzz_color", 1.0),
        share("fuzz_roughness", 0.5),
        share("thin_film_weight", 0.0),
        positive("thin_film_thickness", 0.5),
        Parameter::float_in("thin_film_ior", 1.4, MIN_IOR, MAX_IOR),
        Parameter::number("emission_luminance", 0.0, 0.0, f32::INFINITY),
        Parameter::fraction("emission_color", 1.0),
        share("geometry_opacity", 1.0),
        Parameter::flag("geometry_thin_walled", false),
    ];
    const ROLE: Role = Role::Specular;

    fn build(a: &Arguments) -> Result<Self, Fault> {
        let wall = if a.flag("geometry_thin_walled") { Wall::Thin } else { Wall::Solid };
        check_media(a, wall)?;
        if a.number("emission_luminance") > 0.0 {
            let message = "surfaces emit by an AreaLightSource, not by their material";
            return Err(Fault::new("emission_luminance", message));
        }
        let inputs = Box::new(OpenPbrInputs {
            base_weight: a.float("base_weight"),
            base_color: a.spectrum("base_color"),
            base_diffuse_roughness: a.float("base_diffuse_roughness"),
            base_metalness: a.float("base_metalness"),
            specular_weight: a.float("specular_weight"),
            specular_color: a.spectrum("specular_color"),
            specular_roughness: a.float("specular_roughness"),
            specular_roughness_anisotropy: a.float("specular_roughness_anisotropy"),
            specular_ior: a.index("specular_ior"),
            transmission_weight: a.float("transmission_weight"),
            transmission_color: a.spectrum("transmission_color"),
            abbe_number: abbe_number(a)?,
            subsurface_weight: a.float("subsurface_weight"),
            subsurface_color: a.spectrum("subsurface_color"),
            subsurface_scatter_anisotropy: a.float("subsurface_scatter_anisotropy"),
            coat_weight: a.float("coat_weight"),
            coat_color: a.spectrum("coat_color"),
            coat_roughness: a.float("coat_roughness"),
            coat_roughness_anisotropy: a.float("coat_roughness_anisotropy"),
            coat_ior: a.float("coat_ior"),
            coat_darkening: a.float("coat_darkening"),
            fuzz_weight: a.float("fuzz_weight"),
            fuzz_color: a.spectrum("fuzz_color"),
            fuzz_roughness: a.float("fuzz_roughness"),
            thin_film_weight: a.float("thin_film_weight"),
            thin_film_thickness: a.float("thin_film_thickness"),
            thin_film_ior: a.float("thin_film_ior"),
            geometry_opacity: a.float("geometry_opacity"),
            wall,
        });
        Ok(Self { inputs })
    }

    fn is_textured(&self) -> bool {
        self.inputs.is_textured()
    }

    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        Some(Bsdf::OpenPbr(OpenPbr::new(&self.inputs.slabs(lookup))))
    }
}

impl OpenPbrInputs {
    fn is_textured(&self) -> bool {
        let colors = [
            &self.base_color,
            &self.specular_color,
            &self.transmission_color,
            &self.subsurface_color,
            &self.coat_color,
            &self.fuzz_color,
        ];
        let numbers = [
            &self.base_weight,
            &self.base_diffuse_roughness,
            &self.base_metalness,
            &self.specular_weight,
            &self.specular_roughness,
            &self.specular_roughness_anisotropy,
            &self.transmission_weight,
            &self.subsurface_weight,
            &self.subsurface_scatter_anisotropy,
            &self.coat_weight,
            &self.coat_roughness,
            &self.coat_roughness_anisotropy,
            &self.coat_ior,
            &self.coat_darkening,
            &self.fuzz_weight,
            &self.fuzz_roughness,
            &self.thin_film_weight,
            &self.thin_film_thickness,
            &self.thin_film_ior,
            &self.geometry_opacity,
        ];
        colors.iter().any(|c| c.is_textured()) || numbers.iter().any(|n| n.is_textured())
    }

    /// The values of the parameters at a point.
    fn slabs(&self, lookup: &mut Lookup<'_>) -> Slabs {
        let specular_weight = lookup.float(&self.specular_weight).max(0.0);
        let transmission_weight = lookup.float(&self.transmission_weight).clamp(0.0, 1.0);
        let specular_ior = self.ior(transmission_weight > 0.0, lookup);
        let share = |input| lookup.float(input).clamp(0.0, 1.0);
        let index = |input| lookup.float(input).clamp(MIN_IOR, MAX_IOR);
        Slabs {
            lambda_nm: *lookup.lambda(),
            base_color: lookup.reflectance(&self.base_color) * share(&self.base_weight),
            base_diffuse_roughness: share(&self.base_diffuse_roughness),
            base_metalness: share(&self.base_metalness),
            specular_weight,
            specular_color: lookup.reflectance(&self.specular_color),
            specular_roughness: share(&self.specular_roughness),
            specular_roughness_anisotropy: share(&self.specular_roughness_anisotropy),
            specular_ior,
            transmission_weight,
            transmission_color: lookup.reflectance(&self.transmission_color),
            subsurface_weight: share(&self.subsurface_weight),
            subsurface_color: lookup.reflectance(&self.subsurface_color),
            subsurface_scatter_anisotropy: lookup.float(&self.subsurface_scatter_anisotropy).clamp(-1.0, 1.0),
            coat_weight: share(&self.coat_weight),
            coat_color: lookup.reflectance(&self.coat_color),
            coat_roughness: share(&self.coat_roughness),
            coat_roughness_anisotropy: share(&self.coat_roughness_anisotropy),
            coat_ior: index(&self.coat_ior),
            coat_darkening: share(&self.coat_darkening),
            fuzz_weight: share(&self.fuzz_weight),
            fuzz_color: lookup.reflectance(&self.fuzz_color),
            fuzz_roughness: share(&self.fuzz_roughness),
            thin_film_weight: share(&self.thin_film_weight),
            thin_film_thickness_nm: 1000.0 * lookup.float(&self.thin_film_thickness).max(0.0),
            thin_film_ior: index(&self.thin_film_ior),
            geometry_opacity: share(&self.geometry_opacity),
            wall: self.wall,
        }
    }

    /// The index of the base: at the hero wavelength where light refracts and it disperses, else at the d line.
    fn ior(&self, refracts: bool, lookup: &mut Lookup<'_>) -> f32 {
        // A wall without thickness bends no light.
        let bends = refracts && self.wall == Wall::Solid;
        let n = match (bends, self.abbe_number) {
            (false, _) => self.specular_ior.at(LINE_D),
            (true, None) => lookup.index(&self.specular_ior),
            (true, Some(v_d)) => {
                lookup.terminate_companions();
                dispersion::from_abbe(self.specular_ior.at(LINE_D), v_d).at(lookup.lambda()[0])
            }
        };
        n.clamp(MIN_IOR, MAX_IOR)
    }
}

/// The Abbe number over its scale; `None` without dispersion.
fn abbe_number(a: &Arguments) -> Result<Option<f32>, Fault> {
    let scale = a.number("transmission_dispersion_scale");
    if scale == 0.0 {
        return Ok(None);
    }
    if a.index("specular_ior").constant_value().is_none() {
        let message =
            "the spectrum \"specular_ior\" disperses by itself; give the index at 587.6 nm as a number";
        return Err(Fault::new("transmission_dispersion_scale", message));
    }
    let v_d = a.number("transmission_dispersion_abbe_number") / scale;
    if v_d > 0.0 {
        return Ok(Some(v_d));
    }
    Err(Fault::new("transmission_dispersion_abbe_number", "dispersion needs an Abbe number above 0"))
}

/// Refuses what needs a participating medium under the surface.
fn check_media(a: &Arguments, wall: Wall) -> Result<(), Fault> {
    let on = |name| a.float(name) != FloatInput::Constant(0.0);
    let is = |name, value| match a.spectrum(name) {
        SpectrumInput::Constant(s) => s.constant_value() == Some(value),
        _ => false,
    };
    if wall == Wall::Thin {
        // Of the media, a sheet has transmission_color and the subsurface parameters, without their lengths.
        return Ok(());
    }
    if on("subsurface_weight") {
        let message = "scattering under the surface is not supported, except with \"geometry_thin_walled\"; \
                       use \"base_color\" for dense materials";
        return Err(Fault::new("subsurface_weight", message));
    }
    if !on("transmission_weight") || a.number("transmission_depth") == 0.0 {
        return Ok(());
    }
    if !is("transmission_scatter", 0.0) {
        let message = "scattering inside of the body is not supported; leave it at 0";
        return Err(Fault::new("transmission_scatter", message));
    }
    if !is("transmission_color", 1.0) {
        let message =
            "absorption over a depth is not supported; leave it at 0, which tints light at the surface";
        return Err(Fault::new("transmission_depth", message));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::schema::{Argument, ParameterKind, SpectrumDefault, Value};
    use super::*;
    use crate::math::{BoundedPoint, Footprint, Normal, Point, Shading, SurfacePoint, Vec2, Vec3};
    use crate::spectrum::Wavelengths;
    use crate::texture::Textures;

    /// The schema's defaults, but for the numbers given.
    fn material(numbers: &[(&str, f32)], thin: bool) -> OpenPbrMaterial {
        let of = |p: &Parameter| {
            let number = numbers.iter().find(|n| n.0 == p.name).map(|n| n.1);
            match p.kind {
                ParameterKind::Float { default, .. } => {
                    Value::Float(number.or(default).map(FloatInput::Constant))
                }
                ParameterKind::Number { default, .. } => Value::Number(number.or(default)),
                ParameterKind::Index { default } => Value::Index(number.or(default).map(Spectrum::Constant)),
                ParameterKind::Spectrum { default: SpectrumDefault::Constant(v), .. } => {
                    Value::Spectrum(Some(SpectrumInput::Constant(Spectrum::Constant(v))))
                }
                ParameterKind::Flag { .. } => Value::Flag(thin),
                _ => Value::Spectrum(None),
            }
        };
        let given = |name| numbers.iter().any(|n| n.0 == name);
        let values = OpenPbrMaterial::PARAMETERS
            .iter()
            .map(|p| Argument { name: p.name, value: of(p), given: given(p.name) })
            .collect();
        OpenPbrMaterial::build(&Arguments::new(values)).unwrap()
    }

    fn slabs(material: &OpenPbrMaterial, w: &mut Wavelengths) -> Slabs {
        let shading =
            Shading { n: Normal::Z, dpdu: Vec3::X, dpdv: Vec3::Y, dndu: Vec3::ZERO, dndv: Vec3::ZERO };
        let point = SurfacePoint {
            p: BoundedPoint::exact(Point::ORIGIN),
            ng: Normal::Z,
            uv: Vec2::ZERO,
            dpdu: Vec3::X,
            dpdv: Vec3::Y,
            shading,
            time: 0.0,
            face: 0,
        };
        let textures = Textures::new();
        material.inputs.slabs(&mut Lookup::new(&textures, &point, &Footprint::ZERO, w))
    }

    #[test]
    fn defaults_are_those_of_the_specification() {
        let mut w = Wavelengths::sample_visible(0.3);
        let found = slabs(&material(&[], false), &mut w);
        assert_eq!(found, Slabs { lambda_nm: *w.lambda(), ..Slabs::default() });
        assert!(!w.companions_terminated());
    }

    #[test]
    fn light_disperses_where_it_is_bent() {
        let dispersive = [("transmission_dispersion_scale", 0.5), ("specular_ior", 1.6)];
        let translucent = [&dispersive[..], &[("transmission_weight", 0.4)]].concat();
        for (numbers, thin, disperses) in
            [(&dispersive[..], false, false), (&translucent, true, false), (&translucent, false, true)]
        {
            let mut w = Wavelengths::sample_visible(0.2);
            let found = slabs(&material(numbers, thin), &mut w).specular_ior;
            assert_eq!(w.companions_terminated(), disperses);
            // The Abbe number of 20 over the scale.
            let n = if disperses { dispersion::from_abbe(1.6, 40.0).at(w.lambda()[0]) } else { 1.6 };
            assert_eq!(found, n);
        }
    }
}
