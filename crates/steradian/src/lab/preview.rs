//! A scene to look at a material in.

use crate::scene::desc::{Id, SceneDesc, ShapeDesc};
use crate::scene::import::pbrt::{Input, import};
use crate::scene::{Diagnostics, MemoryFiles};
use std::fmt::Write as _;
use std::path::Path;

/// Lamp, sky, wall and camera, as pbrt-v4 text.
const STAGE: &str = include_str!("../../data/preview.pbrt");

/// Half the number of floor tiles along each side.
const TILES: i32 = 20;
/// Side of a floor tile [scene units]; the sphere's radius is 1.
const TILE: f32 = 0.5;

/// Why there is no preview.
#[derive(Debug, thiserror::Error)]
pub enum PreviewError {
    /// The description has no material of that name.
    #[error("the scene has no material \"{0}\"")]
    UnknownMaterial(String),
    /// The built-in stage was not understood: a fault of this program.
    #[error("the built-in preview scene is broken: {} errors", .0.error_count())]
    Stage(Diagnostics),
}

/// The scene's materials with their textures, and of everything else only this: a sphere of the material called `label`
/// on a checkered floor, under a soft lamp and a grey sky.
///
/// # Errors
/// When the scene has no such material.
pub fn preview(scene: SceneDesc, label: &str) -> Result<SceneDesc, PreviewError> {
    let wanted = material(&scene, label).ok_or_else(|| PreviewError::UnknownMaterial(label.to_owned()))?;
    let text = stage();
    let input = Input::Text { name: "(built-in)/preview.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    let imported = import(&[input], &MemoryFiles::default());
    let Some(mut stage) = imported.scene else { return Err(PreviewError::Stage(imported.diagnostics)) };

    // The stage's materials go behind the scene's: they refer to nothing else, so that only the shapes need to know.
    let first = scene.materials.len() as u32;
    let moved = |shape: ShapeDesc| ShapeDesc {
        material: Id::new(first + shape.material.index() as u32),
        // All spans point into the text of the scene.
        span: scene.span,
        ..shape
    };
    let mut shapes: Vec<_> = std::mem::take(&mut stage.shapes).into_iter().map(moved).collect();
    // The sphere is the last.
    if let Some(sphere) = shapes.last_mut() {
        sphere.material = wanted;
    }
    let mut materials = scene.materials;
    materials.extend(stage.materials);
    Ok(SceneDesc {
        shapes,
        materials,
        float_textures: scene.float_textures,
        spectrum_textures: scene.spectrum_textures,
        texture_order: scene.texture_order,
        span: scene.span,
        content_hash: scene.content_hash,
        ..stage
    })
}

/// The material that the compiled scene calls by that label.
fn material(scene: &SceneDesc, label: &str) -> Option<Id<crate::scene::desc::MaterialDesc>> {
    let is_it = |(i, m): (usize, &crate::scene::desc::MaterialDesc)| match &m.name {
        Some(name) => name == label,
        None => format!("{}#{i}", m.class.name) == label,
    };
    let index = scene.materials.iter().enumerate().position(is_it)?;
    Some(Id::new(index as u32))
}

fn stage() -> String {
    let mut text = STAGE.to_owned();
    for (reflectance, parity) in [(0.62, 0), (0.16, 1)] {
        let (mut points, mut indices) = (String::new(), String::new());
        let mut n = 0;
        for (i, j) in (-TILES..TILES).flat_map(|i| (-TILES..TILES).map(move |j| (i, j))) {
            if (i + j).rem_euclid(2) != parity {
                continue;
            }
            for [u, v] in [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]] {
                // Writing to a String does not fail.
                let _ = write!(points, "{} {} 0 ", u as f32 * TILE, v as f32 * TILE);
            }
            let _ = write!(indices, "{} {} {} {} {} {} ", n, n + 1, n + 2, n, n + 2, n + 3);
            n += 4;
        }
        let _ = write!(
            text,
            "Material \"diffuse\" \"spectrum reflectance\" [ 300 {reflectance} 900 {reflectance} ]\n\
             Shape \"trianglemesh\" \"point3 P\" [ {points}] \"integer indices\" [ {indices}]\n"
        );
    }
    text.push_str("Translate 0 0 1\nShape \"sphere\" \"float radius\" 1\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::compile;

    #[test]
    fn the_stage_compiles_with_every_kind_of_material_of_the_scene() {
        let text = b"WorldBegin Texture \"t\" \"spectrum\" \"checkerboard\" \
            MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"texture reflectance\" \"t\" \
            Material \"dielectric\" Shape \"sphere\" Shape \"disk\"";
        let input = Input::Text { name: "test", bytes: text, base: Path::new("") };
        let scene = import(&[input], &MemoryFiles::default()).scene.unwrap();
        for label in ["paint", "dielectric#2", "diffuse#0"] {
            let desc = preview(scene.clone(), label).unwrap();
            // The lamp, the wall, two colours of tiles, and the sphere.
            assert_eq!(desc.shapes.len(), 5, "{label}");
            let of_sphere = desc.material(desc.shapes[4].material).unwrap();
            assert_eq!(of_sphere.name.as_deref(), (label == "paint").then_some("paint"));
            let mut diagnostics = Diagnostics::default();
            assert!(compile(desc, &MemoryFiles::default(), &mut diagnostics).is_some(), "{diagnostics:?}");
        }
        assert!(matches!(preview(scene, "pain"), Err(PreviewError::UnknownMaterial(_))));
    }
}
