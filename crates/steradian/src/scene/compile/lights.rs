//! From light statements to lights.

use super::pictures::Reading;
use super::shapes::EmittingShape;
use super::spectra::Meaning;
use super::textures::TextureCompiler;
use super::view::rebase;
use crate::image::Image;
use crate::light::photometric::{self, Luminaire, Outline};
use crate::light::{
    Amount, AreaRadiance, DiffuseAreaLight, DistantLight, EmissionPicture, EmittingOpening, GoniometricLight,
    Handedness, ImageInfiniteLight, Light, LightError, PhotometricLight, PointLight, ProjectionLight, Sides,
    SpotLight, Stated, Total, UniformInfiniteLight, latlong_to_octahedral,
};
use crate::math::Transform;
use crate::scene::desc::{
    self, AreaLightDesc, FileRef, LightDesc, LightKind, Normalization, OpeningDesc, SceneDesc, SpectrumDesc,
};
use crate::scene::diagnostic::{Diagnostic, Quoted};
use crate::scene::files::reason;
use crate::scene::source::Span;
use crate::shape::Shape;
use crate::spectrum::Spectrum;
use std::path::Path;
use std::sync::Arc;

/// Compiles lights.
pub(super) struct LightCompiler<'a, 'b> {
    pub(super) textures: &'b mut TextureCompiler<'a>,
    pub(super) render_from_world: Transform,
    /// Length of a scene unit [m].
    pub(super) meters_per_unit: f32,
    /// Of the picture of render space.
    pub(super) handedness: Handedness,
}

impl LightCompiler<'_, '_> {
    /// The light of an emitting shape; `None` when it is faulty, which is reported.
    pub(super) fn area(
        &mut self,
        scene: &SceneDesc,
        emitting: &EmittingShape,
        shape: &Shape,
    ) -> Option<Light> {
        let desc: &AreaLightDesc = scene.area_lights.get(emitting.light.index())?;
        let mut stated = stated(desc.scale, desc.normalization, desc.total);
        stated.total = stated.total.map(|total| match total {
            // Areas are in scene units.
            Total::Luminous(_) | Total::Radiant(_) => total.scaled(self.per_square_metre()),
            Total::Directional(_) => total,
        });
        let picture = match (&emitting.picture, &desc.radiance) {
            (Some(file), _) | (None, desc::AreaRadiance::Image(file)) => Some(file),
            (None, desc::AreaRadiance::Uniform(_)) => None,
        };
        let radiance = match (picture, &desc.radiance) {
            (Some(file), _) => AreaRadiance::Picture(Box::new(self.emission_picture(file)?)),
            (None, desc::AreaRadiance::Uniform(s)) => AreaRadiance::Uniform(self.spectrum(s)),
            (None, desc::AreaRadiance::Image(_)) => return None,
        };
        if matches!(desc.total, Some(Total::Luminous(_))) && shape.prim_count() > 1 {
            self.textures.diagnostics.notice(
                desc.span,
                format!(
                    "the power is that of the whole shape; pbrt-v4 would give it to each of its {} primitives",
                    shape.prim_count()
                ),
            );
        }
        let sides = if desc.two_sided { Sides::Both } else { Sides::Front };
        let light = DiffuseAreaLight::new(emitting.shape, shape, radiance, sides, &stated);
        self.report(light.map(Light::DiffuseArea), desc.span)
    }

    /// A light that is not a surface; `None` when it is faulty, which is reported.
    pub(super) fn light(&mut self, desc: &LightDesc) -> Option<Light> {
        let placement = rebase(&self.render_from_world, &desc.world_from_light);
        if placement.is_animated() {
            self.textures
                .diagnostics
                .warning(desc.span, "lights do not move: this one stays where the shutter opens");
        }
        let t = *placement.start();
        // Intensity over a squared distance in scene units.
        let scale = match desc.kind.is_at_infinity() {
            true => desc.scale,
            false => desc.scale * self.per_square_metre(),
        };
        let stated = stated(scale, desc.normalization, desc.total);
        let light = match &desc.kind {
            LightKind::Point { intensity, from } => {
                PointLight::new(t, *from, self.spectrum(intensity), &stated).map(Light::Point)
            }
            LightKind::Spot { intensity, from, to, cone_angle, cone_delta_angle } => {
                let intensity = self.spectrum(intensity);
                SpotLight::new(t, *from, *to, *cone_angle, *cone_delta_angle, intensity, &stated)
                    .map(Light::Spot)
            }
            LightKind::Goniometric { intensity, file } => {
                let picture = self.square_picture(file, "y")?;
                let intensity = self.spectrum(intensity);
                GoniometricLight::new(t, picture, intensity, &stated).map(|l| Light::Goniometric(Box::new(l)))
            }
            LightKind::Projection { file, fov } => {
                let slide = self.emission_picture(file)?;
                ProjectionLight::new(t, *fov, slide, &stated).map(|l| Light::Projection(Box::new(l)))
            }
            LightKind::Photometric { spectrum, file, from, opening, interpolation, tilt } => {
                let luminaire = self.luminaire(file)?;
                let factor = match &luminaire.tilt {
                    Some(table) => table.factor(f64::from(*tilt)),
                    None if *tilt != 0.0 => {
                        let message = "\"tilt\" has no effect: the file has no tilt factors";
                        self.textures.diagnostics.warning(desc.span, message);
                        1.0
                    }
                    None => 1.0,
                };
                let opening = match opening {
                    OpeningDesc::Point => EmittingOpening::default(),
                    OpeningDesc::File => EmittingOpening::of(&luminaire.opening, self.meters_per_unit),
                    OpeningDesc::Rectangle { along_c0, along_c90 } => EmittingOpening {
                        half_x: 0.5 * along_c0,
                        half_y: 0.5 * along_c90,
                        outline: Outline::Rectangle,
                    },
                };
                let web = luminaire.web.interpolated(*interpolation).scaled(factor);
                let spectrum = self.spectrum(spectrum);
                PhotometricLight::new(t, *from, web, opening, spectrum, &stated)
                    .map(|l| Light::Photometric(Box::new(l)))
            }
            LightKind::Distant { irradiance, from, to } => {
                let irradiance = self.spectrum(irradiance);
                DistantLight::new(t, *from, *to, irradiance, &stated).map(Light::Distant)
            }
            LightKind::UniformInfinite { radiance } => {
                let radiance = self.spectrum(radiance);
                UniformInfiniteLight::new(radiance, &stated).map(Light::UniformInfinite)
            }
            LightKind::ImageInfinite { file } => {
                if matches!(desc.total, Some(Total::Luminous(_))) {
                    self.textures.diagnostics.notice(
                        desc.span,
                        "the map gives the stated illuminance; pbrt-v4 would make it twice as bright",
                    );
                }
                let map = self.square_picture(file, "z")?;
                let picture = self.emission(map);
                ImageInfiniteLight::new(t, picture, &stated).map(|l| Light::ImageInfinite(Box::new(l)))
            }
            LightKind::Sky(sky) => return self.sky(sky, desc, &t),
            LightKind::Sun(sun) => return self.sun(sun, desc, &t),
        };
        let place = match (&light, &desc.kind) {
            (
                Err(LightError::NotSquare(..) | LightError::Black),
                LightKind::Goniometric { file, .. }
                | LightKind::Projection { file, .. }
                | LightKind::Photometric { file, .. }
                | LightKind::ImageInfinite { file, .. },
            ) => file.span,
            _ => desc.span,
        };
        self.report(light, place)
    }

    /// How many square scene units a square metre has, of which amounts per unit are made.
    fn per_square_metre(&self) -> f32 {
        (self.meters_per_unit * self.meters_per_unit).recip()
    }

    pub(super) fn report(&mut self, light: Result<Light, LightError>, span: Span) -> Option<Light> {
        light.map_err(|e| self.textures.diagnostics.error(span, e.to_string())).ok()
    }

    pub(super) fn spectrum(&mut self, desc: &SpectrumDesc) -> Spectrum {
        self.textures.spectra.compile(desc, Meaning::Illuminant, self.textures.diagnostics)
    }

    /// What a photometric file says; `None` when it cannot be read, which is reported at its place in the file.
    fn luminaire(&mut self, file: &FileRef) -> Option<Luminaire> {
        let files = self.textures.files;
        let bytes = match files.read(&file.path) {
            Ok(bytes) => bytes,
            Err(e) => {
                let message = format!("cannot read luminaire {}: {}", file.path.display(), reason(&e));
                self.textures.diagnostics.error(file.span, message);
                return None;
            }
        };
        let folder = file.path.parent().unwrap_or(Path::new(""));
        let mut tilt_file =
            |name: &str| files.read(&folder.join(name)).map(|b| b.to_vec()).map_err(|e| reason(&e));
        photometric::read(&bytes, &mut tilt_file)
            .map_err(|e| {
                let path = e.file.as_ref().map_or(file.path.clone(), |name| folder.join(name));
                let quoted = Quoted {
                    file: path.display().to_string(),
                    line: e.line,
                    column: e.column,
                    length: e.length,
                    text: e.text,
                };
                self.textures.diagnostics.push(Diagnostic::error(file.span, e.message).in_file(quoted));
            })
            .ok()
    }

    fn emission_picture(&mut self, file: &FileRef) -> Option<EmissionPicture> {
        let image = self.picture(file)?;
        Some(self.emission(image))
    }

    fn picture(&mut self, file: &FileRef) -> Option<Arc<Image>> {
        self.textures.pictures.get(file, Reading::Color, self.textures.diagnostics)
    }

    fn emission(&mut self, image: Arc<Image>) -> EmissionPicture {
        let kind = image.color_space();
        let table = self.textures.spectra.table(kind);
        EmissionPicture::new(image, table, self.textures.spectra.space(kind))
    }

    /// A picture of all directions, whose pole is the axis `pole` of light space. One of twice the width is taken for
    /// latitude and longitude, which pbrt-v4 refuses.
    fn square_picture(&mut self, file: &FileRef, pole: &str) -> Option<Arc<Image>> {
        let image = self.picture(file)?;
        if image.width() != 2 * image.height() {
            return Some(image);
        }
        let notice = Diagnostic::notice(
            file.span,
            format!(
                "{} is {} × {}: converted from latitude-longitude to the equal-area octahedral square",
                file.path.display(),
                image.width(),
                image.height()
            ),
        );
        self.textures
            .diagnostics
            .push(notice.with_help(format!("+{pole} is the top row, azimuth 0 (+x) the first column")));
        let space = image.color_space();
        latlong_to_octahedral(&image, image.height())
            .map(|square| Arc::new(square.with_color_space(space)))
            .map_err(|e| self.textures.diagnostics.error(file.span, e.to_string()))
            .ok()
    }
}

pub(super) fn stated(scale: f32, normalization: Normalization, total: Option<Total>) -> Stated {
    let amount = match normalization {
        Normalization::Photometric => Amount::Photometric,
        Normalization::Absolute => Amount::Absolute,
    };
    Stated { scale, amount, total }
}
