//! The end of an import: names that nobody defined, orders that must not be circular, defaults.

use super::camera::CameraSettings;
use super::context::Context;
use super::film::{default_film, default_filter};
use super::input::Imported;
use super::integrator::default_integrator;
use super::machine::{Importer, Section};
use super::names::Table;
use super::sampler::default_sampler;
use crate::color::ColorSpaceKind;
use crate::math::{AnimatedTransform, Transform};
use crate::scene::desc::{CameraDesc, Id, MaterialDesc, SceneDesc, ShapeDesc, TextureId};
use crate::scene::diagnostic::{Diagnostic, Severity};
use crate::scene::source::Span;

/// Checks what can only be checked at the end, and puts the scene together.
pub(super) fn finish(mut importer: Importer<'_>) -> Imported {
    if !importer.ctx.is_v3 {
        importer.report_open_blocks(0);
        if let Some(end) =
            importer.end.filter(|_| importer.section == Section::Header && !importer.world_too_early)
        {
            importer.ctx.diagnostics.error(end, "the scene ends without `WorldBegin`");
        }
        report_undefined(&mut importer.ctx);
        report_mixes_of_themselves(&mut importer.ctx);
    }
    let order = texture_order(&mut importer.ctx);
    drop_light_of_interfaces(&mut importer);
    let Importer { ctx, sources, .. } = importer;
    let mut diagnostics = ctx.diagnostics;
    let Some(span) = importer.end.map(|s| Span { start: 0, ..s }) else {
        if !diagnostics.has_errors() {
            diagnostics.push(Diagnostic::unplaced_error("there is no scene file"));
        }
        return Imported { scene: None, sources, diagnostics };
    };
    let camera = importer.camera.unwrap_or_else(|| {
        let CameraSettings { kind, shutter_open, shutter_close } = CameraSettings::default();
        let world_from_camera = AnimatedTransform::fixed(Transform::IDENTITY);
        CameraDesc { kind, world_from_camera, shutter_open, shutter_close, medium: None, span }
    });
    let complete = || {
        Some(SceneDesc {
            options: importer.options,
            camera,
            film: importer.film.unwrap_or_else(|| default_film(ColorSpaceKind::Srgb, span)),
            filter: importer.filter.unwrap_or_else(|| default_filter(span)),
            sampler: importer.sampler.unwrap_or_else(|| default_sampler(span)),
            integrator: importer.integrator.unwrap_or_else(|| default_integrator(span)),
            float_textures: ctx.float_textures.into_values()?,
            spectrum_textures: ctx.spectrum_textures.into_values()?,
            texture_order: order,
            materials: ctx.materials.into_values()?,
            media: ctx.media.into_values()?,
            lights: importer.lights,
            area_lights: importer.area_lights,
            shapes: importer.shapes,
            objects: ctx.objects.into_values()?,
            instances: importer.instances,
            span,
            content_hash: sources.content_hash(),
        })
    };
    let scene = if diagnostics.has_errors() { None } else { complete() };
    debug_assert!(scene.is_some() || diagnostics.has_errors(), "a name without a value was not reported");
    Imported { scene, sources, diagnostics }
}

/// The names of one kind of thing.
struct Names<'a> {
    kind: &'static str,
    undefined: Vec<(&'a str, Span)>,
    defined: Vec<&'a str>,
}

fn names<'a, T>(kind: &'static str, table: &'a Table<T>) -> Names<'a> {
    Names { kind, undefined: table.undefined().collect(), defined: table.defined_names().collect() }
}

fn report_undefined(ctx: &mut Context) {
    let Context { diagnostics, float_textures, spectrum_textures, materials, media, objects, .. } = ctx;
    let kinds = [
        names("float texture", float_textures),
        names("spectrum texture", spectrum_textures),
        names("material", materials),
        names("medium", media),
        names("object", objects),
    ];
    let mut found: Vec<(&Names<'_>, &str, Span)> =
        kinds.iter().flat_map(|k| k.undefined.iter().map(move |&(name, span)| (k, name, span))).collect();
    found.sort_by_key(|(.., span)| (span.file, span.start));
    for (Names { kind, defined, .. }, name, span) in found {
        let d = Diagnostic::error(span, format!("{kind} \"{name}\" is not defined"));
        // Many wrong names times many right ones is more than anybody waits for.
        if !diagnostics.keeps(Severity::Error) {
            diagnostics.push(d);
            continue;
        }
        let advice = match *kind {
            "float texture" if kinds[1].defined.contains(&name) => {
                Some("there is a spectrum texture of this name, but numbers are needed here")
            }
            "spectrum texture" if kinds[0].defined.contains(&name) => {
                Some("there is a float texture of this name, but spectra are needed here")
            }
            _ => None,
        };
        diagnostics.push(match advice {
            Some(advice) => d.with_help(advice),
            None => d.with_nearest(name, defined.iter().copied()),
        });
    }
}

/// How far a depth-first visit has come with a node.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visit {
    New,
    Open,
    Done,
}

/// Visits a graph depth-first: nodes come out after those they use. The second list has nodes that lie on a circle.
fn depth_first(count: usize, uses: impl Fn(usize) -> Vec<usize>) -> (Vec<usize>, Vec<usize>) {
    let mut state = vec![Visit::New; count];
    let (mut order, mut circular) = (Vec::with_capacity(count), Vec::new());
    for root in 0..count {
        if state[root] != Visit::New {
            continue;
        }
        state[root] = Visit::Open;
        let mut stack = vec![(root, uses(root))];
        while let Some((node, pending)) = stack.last_mut() {
            let node = *node;
            match pending.pop() {
                Some(next) if state[next] == Visit::New => {
                    state[next] = Visit::Open;
                    stack.push((next, uses(next)));
                }
                Some(next) => {
                    if state[next] == Visit::Open && circular.last() != Some(&node) {
                        circular.push(node);
                    }
                }
                None => {
                    state[node] = Visit::Done;
                    order.push(node);
                    stack.pop();
                }
            }
        }
    }
    (order, circular)
}

/// The textures, each after those it uses; reports circles.
fn texture_order(ctx: &mut Context) -> Vec<TextureId> {
    let floats = ctx.float_textures.len();
    let node = |t: &TextureId| match t {
        TextureId::Float(id) => id.index(),
        TextureId::Spectrum(id) => floats + id.index(),
    };
    let count = floats + ctx.spectrum_textures.len();
    let mut uses = vec![Vec::new(); count];
    for (texture, used) in &ctx.texture_uses {
        uses[node(texture)] = used.iter().map(node).collect();
    }
    let (order, circular) = depth_first(count, |n| uses[n].clone());
    for n in circular {
        let place = match n.checked_sub(floats) {
            None => ctx.float_textures.get(Id::new(n as u32)).map(|t| (t.name.clone(), t.span)),
            Some(n) => ctx.spectrum_textures.get(Id::new(n as u32)).map(|t| (t.name.clone(), t.span)),
        };
        if let Some((name, span)) = place {
            ctx.diagnostics.error(span, format!("texture \"{name}\" is made of itself"));
        }
    }
    let id = |n: usize| match n.checked_sub(floats) {
        None => TextureId::Float(Id::new(n as u32)),
        Some(n) => TextureId::Spectrum(Id::new(n as u32)),
    };
    order.into_iter().map(id).collect()
}

fn report_mixes_of_themselves(ctx: &mut Context) {
    let materials = &ctx.materials;
    let uses = |n: usize| {
        materials
            .get(Id::new(n as u32))
            .map_or(Vec::new(), |m: &MaterialDesc| m.parts().map(|m| m.index()).collect())
    };
    let (_, circular) = depth_first(materials.len(), uses);
    for n in circular {
        if let Some(m) = ctx.materials.get(Id::new(n as u32)) {
            let name = m.name.clone().unwrap_or_default();
            ctx.diagnostics.error(m.span, format!("material \"{name}\" is a mix of itself"));
        }
    }
}

/// A boundary of media emits nothing, whatever the graphics state says.
fn drop_light_of_interfaces(importer: &mut Importer<'_>) {
    let Importer { shapes, ctx, .. } = importer;
    let is_interface = |s: &ShapeDesc| ctx.materials.get(s.material).is_some_and(MaterialDesc::is_interface);
    for shape in shapes {
        if shape.area_light.is_some() && is_interface(shape) {
            shape.area_light = None;
            let message = "shapes of material \"interface\" cannot emit light; the area light is ignored";
            ctx.diagnostics.warning(shape.span, message);
        }
    }
}
