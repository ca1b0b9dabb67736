//! Directives that make something: a class, its parameters, and what the graphics state adds.

use super::args::Args;
use super::machine::{Importer, default_material};
use super::state::Target;
use super::{camera, film, integrator, light, material, medium, sampler, shape, texture};
use crate::material::Role;
use crate::scene::desc::{
    CameraDesc, Id, LightDesc, MaterialDesc, MediumDesc, MediumKind, ShapeDesc, TextureDesc, TextureId,
};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::source::Span;
use crate::scene::text::{Entity, Params, Text, TextureStatement};

impl Importer<'_> {
    /// Executes a directive of the form: keyword, class, parameters.
    pub(super) fn entity(&mut self, entity: Entity, class: &Text, params: Params, span: Span) {
        match entity {
            Entity::Camera => self.camera(class, params, span),
            Entity::Film => {
                let film = self.setting("film", class, params, |args| film::film(class, span, args));
                replace(self.film.as_ref().map(|f| f.span), span, "Film", self);
                self.film = film.or(self.film.take());
            }
            Entity::PixelFilter => {
                let filter =
                    self.setting("pixel filter", class, params, |args| film::filter(class, span, args));
                replace(self.filter.map(|f| f.span), span, "PixelFilter", self);
                self.filter = filter.or(self.filter);
            }
            Entity::Sampler => {
                let sampler =
                    self.setting("sampler", class, params, |args| sampler::sampler(class, span, args));
                replace(self.sampler.map(|s| s.span), span, "Sampler", self);
                self.sampler = sampler.or(self.sampler);
            }
            Entity::Integrator => {
                let read = |args: &mut Args<'_>| integrator::integrator(class, span, args);
                let integrator = self.setting("integrator", class, params, read);
                replace(self.integrator.as_ref().map(|i| i.span), span, "Integrator", self);
                self.integrator = integrator.or(self.integrator.take());
            }
            Entity::Accelerator => {
                let known =
                    self.setting("accelerator", class, params, |args| integrator::accelerator(class, args));
                replace(self.accelerator, span, "Accelerator", self);
                self.accelerator = known.map(|()| span).or(self.accelerator);
            }
            Entity::Material => self.material(class, params, span),
            Entity::MakeNamedMaterial => self.named_material(class, params, span),
            Entity::MakeNamedMedium => self.medium(class, params, span),
            Entity::Shape => self.shape(class, params, span),
            Entity::LightSource => self.light(class, params, span),
            Entity::AreaLightSource => self.area_light(class, params, span),
        }
    }

    /// Reads a class to which no `Attribute` applies.
    fn setting<T>(
        &mut self,
        kind: &str,
        class: &Text,
        params: Params,
        read: impl FnOnce(&mut Args<'_>) -> Option<T>,
    ) -> Option<T> {
        let subject = format!("{kind} \"{}\"", class.value);
        let mut args = Args::new(&mut self.ctx, params, &[], self.state.color_space, subject, class.span);
        let value = read(&mut args);
        args.finish();
        value
    }

    fn camera(&mut self, class: &Text, params: Params, span: Span) {
        let settings = self.setting("camera", class, params, |args| camera::camera(class, args));
        replace(self.camera.as_ref().map(|c| c.span), span, "Camera", self);
        self.name_camera_space();
        if let Some(settings) = settings {
            self.camera = Some(CameraDesc {
                kind: settings.kind,
                world_from_camera: self.state.animated_inverse(),
                shutter_open: settings.shutter_open,
                shutter_close: settings.shutter_close,
                medium: self.state.media.and_then(|m| m.outside),
                span,
            });
        }
    }

    fn shape(&mut self, class: &Text, params: Params, span: Span) {
        let presets = self.state.presets(Target::Shape);
        let subject = format!("shape \"{}\"", class.value);
        let mut args =
            Args::new(&mut self.ctx, params, &presets, self.state.color_space, subject, class.span);
        let alpha = args.float_param("alpha", 1.0);
        let kind = shape::shape(class, &mut args);
        args.finish();
        let Some(kind) = kind else { return };
        let mut area_light = self.state.area_light;
        if self.object.is_some() && area_light.take().is_some() {
            let message = "shapes of objects cannot emit light; the area light is ignored";
            self.ctx.diagnostics.warning(span, message);
        }
        let desc = ShapeDesc {
            kind,
            world_from_object: self.state.animated(),
            reverse_orientation: self.state.reverse_orientation,
            material: self.state.material,
            area_light,
            alpha,
            media: self.state.media,
            span,
        };
        match &mut self.object {
            Some(object) => object.desc.shapes.push(desc),
            None => self.shapes.push(desc),
        }
    }

    fn material(&mut self, class: &Text, params: Params, span: Span) {
        let presets = self.state.presets(Target::Material);
        let subject = format!("material \"{}\"", class.value);
        let mut args =
            Args::new(&mut self.ctx, params, &presets, self.state.color_space, subject, class.span);
        let desc = read_material(None, class, &mut args, span);
        args.finish();
        self.state.material = self.ctx.materials.push(desc);
    }

    fn named_material(&mut self, name: &Text, params: Params, span: Span) {
        let id = match self.ctx.materials.define(name) {
            Ok(id) => id,
            Err(first) => {
                let d = Diagnostic::error(name.span, format!("material \"{}\" is defined twice", name.value));
                self.ctx.diagnostics.push(d.with_related(first, "the first definition is here"));
                return;
            }
        };
        let presets = self.state.presets(Target::Material);
        let subject = format!("material \"{}\"", name.value);
        let mut args = Args::new(&mut self.ctx, params, &presets, self.state.color_space, subject, name.span);
        let desc = match class_of(&mut args, "material") {
            Some(class) => {
                let desc = read_material(Some(name), &class, &mut args, span);
                args.finish();
                desc
            }
            None => default_material(span),
        };
        self.ctx.materials.set(id, desc);
    }

    fn medium(&mut self, name: &Text, params: Params, span: Span) {
        let id = match self.ctx.media.define(name) {
            Ok(id) => id,
            Err(first) => {
                let d = Diagnostic::error(name.span, format!("medium \"{}\" is defined twice", name.value));
                self.ctx.diagnostics.push(d.with_related(first, "the first definition is here"));
                return;
            }
        };
        let presets = self.state.presets(Target::Medium);
        let subject = format!("medium \"{}\"", name.value);
        let mut args = Args::new(&mut self.ctx, params, &presets, self.state.color_space, subject, name.span);
        let Some(class) = class_of(&mut args, "medium") else { return };
        let kind = medium::medium(&class, &mut args);
        args.finish();
        if let Some(kind) = kind {
            if matches!(kind, MediumKind::Homogeneous { .. }) {
                self.ctx.unsupported(span, "participating media");
            }
            self.ctx.media.set(id, MediumDesc { name: name.value.clone(), kind, span });
        }
    }

    fn light(&mut self, class: &Text, params: Params, span: Span) {
        let presets = self.state.presets(Target::Light);
        let subject = format!("light \"{}\"", class.value);
        let mut args =
            Args::new(&mut self.ctx, params, &presets, self.state.color_space, subject, class.span);
        let scale = args.float("scale", 1.0);
        let normalization = light::normalization(class, &mut args);
        let total = light::total(class, &mut args);
        let kind = light::light(class, &mut args);
        args.finish();
        let Some(kind) = kind else { return };
        let medium = self.state.media.and_then(|m| m.outside);
        let world_from_light = self.state.animated();
        self.lights.push(LightDesc { kind, scale, normalization, total, world_from_light, medium, span });
    }

    fn area_light(&mut self, class: &Text, params: Params, span: Span) {
        let presets = self.state.presets(Target::Light);
        let subject = format!("area light \"{}\"", class.value);
        let mut args =
            Args::new(&mut self.ctx, params, &presets, self.state.color_space, subject, class.span);
        let desc = light::area_light(class, span, &mut args);
        args.finish();
        if let Some(desc) = desc {
            self.state.area_light = Some(Id::new(self.area_lights.len() as u32));
            self.area_lights.push(desc);
        }
    }

    pub(super) fn texture(&mut self, statement: TextureStatement, span: Span) {
        let TextureStatement { name, value_type, class, params } = statement;
        if self.state.ctm.start != self.state.ctm.end {
            let message = "textures do not move; the transform at the start of the shutter interval is used";
            self.ctx.diagnostics.warning(span, message);
        }
        let world_from_texture = self.state.ctm.start;
        let duplicate = |first: Span| {
            let kind = &value_type.value;
            let d =
                Diagnostic::error(name.span, format!("{kind} texture \"{}\" is defined twice", name.value));
            d.with_related(first, "the first definition is here")
        };
        let presets = self.state.presets(Target::Texture);
        let subject = format!("texture \"{}\"", class.value);
        let color_space = self.state.color_space;
        match value_type.value.as_str() {
            "float" => match self.ctx.float_textures.define(&name) {
                Ok(id) => {
                    let mut args =
                        Args::new(&mut self.ctx, params, &presets, color_space, subject, class.span);
                    let kind = texture::float_texture(&class, &world_from_texture, &mut args);
                    let uses = args.finish();
                    if let Some(kind) = kind {
                        let desc = TextureDesc { name: name.value, world_from_texture, kind, span };
                        self.ctx.float_textures.set(id, desc);
                    }
                    self.ctx.texture_uses.push((TextureId::Float(id), uses));
                }
                Err(first) => self.ctx.diagnostics.push(duplicate(first)),
            },
            "spectrum" => match self.ctx.spectrum_textures.define(&name) {
                Ok(id) => {
                    let mut args =
                        Args::new(&mut self.ctx, params, &presets, color_space, subject, class.span);
                    let kind = texture::spectrum_texture(&class, &world_from_texture, &mut args);
                    let uses = args.finish();
                    if let Some(kind) = kind {
                        let desc = TextureDesc { name: name.value, world_from_texture, kind, span };
                        self.ctx.spectrum_textures.set(id, desc);
                    }
                    self.ctx.texture_uses.push((TextureId::Spectrum(id), uses));
                }
                Err(first) => self.ctx.diagnostics.push(duplicate(first)),
            },
            "color" => self.ctx.found_v3(value_type.span, "which calls \"color\" textures \"spectrum\""),
            other => {
                let d = Diagnostic::error(value_type.span, format!("unknown texture type \"{other}\""));
                self.ctx.diagnostics.push(d.with_help("known are float and spectrum"));
            }
        }
    }
}

/// Warns that a setting is stated again.
fn replace(earlier: Option<Span>, span: Span, keyword: &str, importer: &mut Importer<'_>) {
    if let Some(earlier) = earlier {
        let d = Diagnostic::warning(span, format!("this `{keyword}` replaces an earlier one"));
        importer.ctx.diagnostics.push(d.with_related(earlier, "the earlier one is here"));
    }
}

/// The class that a named entity states as its parameter "type".
fn class_of(args: &mut Args<'_>, kind: &str) -> Option<Text> {
    let given = args.has("type");
    let Some(class) = args.text("type") else {
        if !given {
            args.missing("type");
        }
        return None;
    };
    args.set_subject(format!("{kind} \"{}\"", class.value));
    Some(class)
}

fn read_material(name: Option<&Text>, class: &Text, args: &mut Args<'_>, span: Span) -> MaterialDesc {
    let name = name.map(|n| n.value.clone());
    let Some(class) = material::class(class, args) else {
        return MaterialDesc { name, ..default_material(span) };
    };
    let scatters = matches!(class.role, Role::Surface | Role::Specular);
    MaterialDesc {
        name,
        class,
        arguments: material::arguments(class, args),
        displacement: if scatters { args.float_param_opt("displacement") } else { None },
        normal_map: if scatters { args.file("normalmap") } else { None },
        span,
    }
}
