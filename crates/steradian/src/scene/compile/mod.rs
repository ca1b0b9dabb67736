//! From description to scene: the only stage that reads pictures, meshes and spectra and builds the hierarchy.
//!
//! All faults are collected; a scene comes out only when there is none.

mod film;
mod geometry;
mod integrator;
mod lights;
mod materials;
mod pictures;
mod shapes;
mod skies;
mod spectra;
mod textures;
mod view;

use super::compiled::Scene;
use super::desc::SceneDesc;
use super::diagnostic::Diagnostics;
use super::files::FileSystem;
use super::job::{Jitter, RenderJob, Sampling};
use crate::accel::Accel;
use crate::color::{ColorSpace, UpsamplingTables};
use crate::light::{Light, LightId, LightSampler};
use crate::material::Role;
use integrator::CausticRisk;
use lights::LightCompiler;
use shapes::{Geometry, ShapeCompiler, ShapeSet};
use textures::TextureCompiler;

/// Compiles a description. `None` when there are errors, all of which are added to `diagnostics`.
pub fn compile(desc: SceneDesc, files: &dyn FileSystem, diagnostics: &mut Diagnostics) -> Option<RenderJob> {
    compile_with_tables(desc, files, &UpsamplingTables::new(), diagnostics)
}

/// The same as [`compile`], with tables that earlier scenes have built: they cost a tenth of a second each.
pub fn compile_with_tables(
    mut desc: SceneDesc,
    files: &dyn FileSystem,
    tables: &UpsamplingTables,
    diagnostics: &mut Diagnostics,
) -> Option<RenderJob> {
    let geometry = Geometry::take(&mut desc);
    let desc = &desc;
    let render_from_world = view::render_from_world(&desc.camera, desc.options.rendering_space);
    let camera = view::camera(&desc.camera, desc.film.resolution, &render_from_world)
        .map_err(|e| diagnostics.error(desc.camera.span, e.to_string()))
        .ok();
    film::check(&desc.film, &desc.camera, diagnostics);
    let kind = view::sampler_kind(&desc.sampler, diagnostics);

    let mut textures = TextureCompiler::new(desc, files, tables, render_from_world, diagnostics);
    let materials = materials::compile(&desc.materials, &mut textures);
    let mut set = ShapeCompiler {
        files,
        textures: &mut textures,
        materials: &materials,
        material_descs: &desc.materials,
        render_from_world,
        set: ShapeSet::default(),
    }
    .compile(geometry);

    let mut lights: Vec<Light> = Vec::new();
    let mut compiler = LightCompiler {
        textures: &mut textures,
        render_from_world,
        meters_per_unit: desc.options.meters_per_unit,
        handedness: view::handedness(&desc.camera, &render_from_world),
    };
    for emitting in &set.emitters {
        let index = emitting.shape.0 as usize;
        if let Some(light) = compiler.area(desc, emitting, &set.shapes[index]) {
            set.attributes[index].light = Some(LightId(lights.len() as u32));
            lights.push(light);
        }
    }
    lights.extend(desc.lights.iter().filter_map(|d| compiler.light(d)));
    lights.extend(desc.lights.iter().filter_map(|d| compiler.companion(d)));
    let ambient = integrator::surroundings(&desc.integrator).and_then(|d| compiler.light(&d));

    let TextureCompiler { textures, spectra: _, diagnostics, .. } = textures;
    let risk = CausticRisk {
        delta_lights: lights.iter().any(Light::is_delta),
        specular_surfaces: desc.materials.iter().any(|m| m.class.role == Role::Specular),
    };
    let no_light = desc.lights.is_empty() && set.emitters.is_empty() && ambient.is_none();
    let integrator = integrator::choose(desc, risk, ambient, diagnostics);
    let selection = integrator::selection(&desc.integrator, diagnostics);
    let accel =
        Accel::build(&set.shapes, &set.layout).map_err(|e| set.report(&e, desc.span, diagnostics)).ok();
    // A light that was refused has an error already.
    if no_light {
        diagnostics.warning(desc.span, "the scene has no light: the picture will be black");
    }
    let (camera, accel) = (camera?, accel?);
    if diagnostics.has_errors() {
        return None;
    }
    // Without geometry a sky has no surface to light, but is seen all the same.
    let radius = Some(accel.bounds().bounding_sphere().1).filter(|r| *r > 0.0).unwrap_or(1.0);
    let light_sampler = LightSampler::for_scene(&lights, &set.shapes, radius, selection);
    let options = &desc.options;
    let jitter = |off: bool| if off { Jitter::Off } else { Jitter::On };
    Some(RenderJob {
        scene: Scene {
            shapes: set.shapes,
            attributes: set.attributes,
            accel,
            textures,
            materials: materials.materials,
            lights,
            light_sampler,
            camera,
            footprint_samples: (!options.disable_texture_filtering).then_some(desc.sampler.pixel_samples),
        },
        film: desc.film.clone(),
        output_space: ColorSpace::new(desc.film.color_space),
        filter: desc.filter,
        sampling: Sampling {
            kind,
            spp: desc.sampler.pixel_samples,
            noise: desc.sampler.noise,
            seed: seed(desc),
            pixel_jitter: jitter(options.disable_pixel_jitter),
            wavelength_jitter: jitter(options.disable_wavelength_jitter),
        },
        integrator,
        world_from_render: render_from_world.inverse(),
        meters_per_unit: options.meters_per_unit,
        scene_hash: desc.content_hash,
    })
}

/// The sampler's own seed wins over that of the options.
fn seed(desc: &SceneDesc) -> u64 {
    u64::from(desc.sampler.seed.unwrap_or(desc.options.seed).cast_unsigned())
}

#[cfg(test)]
mod tests;
