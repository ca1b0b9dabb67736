//! The graphics state: transforms, blocks, attributes, names, files within files.

use super::{import_with, messages, scene, world};
use crate::color::ColorSpaceKind;
use crate::math::{Point, Transform, Vec3};
use crate::scene::desc::{
    ArgumentValue, FloatTextureKind, ShapeKind, SpectrumParam, SpectrumValue, TextureId,
};
use crate::scene::files::MemoryFiles;
use crate::scene::import::pbrt::{Input, import};
use std::path::Path;

/// Where the origin of the n-th shape is in the world.
fn origin(text: &str, n: usize) -> Vec3 {
    world(text).shapes[n].world_from_object.start().point(Point::ORIGIN).0
}

fn near(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 1e-5, "{a} against {b}");
}

#[test]
fn transforms_apply_to_what_follows_innermost_last() {
    near(origin("Translate 1 2 3 Scale 2 2 2 Translate 1 0 0 Shape \"sphere\"", 0), Vec3::new(3.0, 2.0, 3.0));
    near(origin("Rotate 90 0 0 1 Translate 1 0 0 Shape \"sphere\"", 0), Vec3::Y);
    near(origin("Translate 9 9 9 Identity Shape \"sphere\"", 0), Vec3::ZERO);
    near(
        origin("Scale 7 7 7 Transform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1] Shape \"sphere\"", 0),
        Vec3::new(4.0, 5.0, 6.0),
    );
    let concat = "Scale 2 2 2 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1] Shape \"sphere\"";
    near(origin(concat, 0), Vec3::new(8.0, 10.0, 12.0));
    // The eye is the origin of the space that LookAt leads into.
    let eye =
        world("LookAt 1 2 3 0 0 0 0 1 0 Shape \"sphere\"").shapes[0].world_from_object.start().inverse();
    near(eye.point(Point::ORIGIN).0, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn attribute_blocks_restore_the_whole_state() {
    let s = world(
        "AttributeBegin Translate 1 0 0 ReverseOrientation Material \"conductor\" AreaLightSource \"diffuse\" Shape \"sphere\" \
         AttributeEnd Shape \"sphere\"",
    );
    let (inner, outer) = (&s.shapes[0], &s.shapes[1]);
    assert!(inner.reverse_orientation && inner.area_light.is_some());
    assert_eq!(s.materials[inner.material.index()].class.name, "conductor");
    assert!(!outer.reverse_orientation && outer.area_light.is_none());
    assert_eq!(outer.material.index(), 0);
    assert_eq!(*outer.world_from_object.start(), Transform::IDENTITY);
}

#[test]
fn active_transforms_and_times_make_motion() {
    let s = scene(
        "TransformTimes 0.25 0.5 WorldBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All \
         Translate 0 1 0 Shape \"sphere\" ActiveTransform StartTime Identity ActiveTransform All Shape \"sphere\"",
    );
    let t = &s.shapes[0].world_from_object;
    assert!(t.is_animated());
    assert_eq!(t.times(), [0.25, 0.5]);
    near(t.start().point(Point::ORIGIN).0, Vec3::Y);
    near(t.end().point(Point::ORIGIN).0, Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(*s.shapes[1].world_from_object.start(), Transform::IDENTITY);
}

#[test]
fn the_camera_defines_its_space_and_the_world_begins_at_the_identity() {
    let s = scene(
        "Translate 0 0 -5 Camera \"perspective\" WorldBegin Shape \"sphere\" \
         AttributeBegin CoordSysTransform \"camera\" Shape \"sphere\" AttributeEnd \
         Translate 1 1 1 CoordinateSystem \"mine\" Identity CoordSysTransform \"mine\" Shape \"sphere\" \
         CoordSysTransform \"world\" Shape \"sphere\"",
    );
    let at = |n: usize| s.shapes[n].world_from_object.start().point(Point::ORIGIN).0;
    near(s.camera.world_from_camera.start().point(Point::ORIGIN).0, Vec3::new(0.0, 0.0, 5.0));
    near(at(0), Vec3::ZERO);
    near(at(1), Vec3::new(0.0, 0.0, 5.0));
    near(at(2), Vec3::ONE);
    near(at(3), Vec3::ZERO);
}

#[test]
fn color_space_holds_for_what_follows_and_the_film_remembers_its_own() {
    let s = scene(
        "ColorSpace \"rec2020\" Film \"rgb\" ColorSpace \"srgb\" WorldBegin ColorSpace \"aces2065-1\" \
         Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3] AttributeBegin ColorSpace \"dci-p3\" AttributeEnd \
         LightSource \"point\"",
    );
    assert_eq!(s.film.color_space, ColorSpaceKind::Rec2020);
    let reflectance = &s.materials[1].argument("reflectance").unwrap().value;
    let ArgumentValue::Spectrum(Some(SpectrumParam::Value(v))) = reflectance else { panic!() };
    assert_eq!(v.value, SpectrumValue::Rgb { rgb: [0.1, 0.2, 0.3], color_space: ColorSpaceKind::Aces2065_1 });
    let crate::scene::desc::LightKind::Point { intensity, .. } = &s.lights[0].kind else { panic!() };
    assert_eq!(intensity.value, SpectrumValue::Illuminant(ColorSpaceKind::Aces2065_1));
}

#[test]
fn attributes_preset_parameters_inside_their_block() {
    let radius = |s: &crate::scene::SceneDesc, n: usize| match s.shapes[n].kind {
        ShapeKind::Sphere { radius, .. } => radius,
        _ => panic!("a sphere"),
    };
    let s = world(
        "AttributeBegin Attribute \"shape\" \"float radius\" 2 Shape \"sphere\" Attribute \"shape\" \"float radius\" 3 Shape \"sphere\" \
         Shape \"sphere\" \"float radius\" 4 Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] AttributeEnd Shape \"sphere\"",
    );
    assert_eq!([radius(&s, 0), radius(&s, 1), radius(&s, 2), radius(&s, 4)], [2.0, 3.0, 4.0, 1.0]);
}

#[test]
fn materials_and_objects_may_be_named_before_they_are_defined() {
    let s = world(
        "NamedMaterial \"later\" Shape \"sphere\" ObjectInstance \"o\" \
         MakeNamedMaterial \"later\" \"string type\" \"thindielectric\" Translate 1 0 0 ObjectBegin \"o\" Shape \"disk\" ObjectEnd",
    );
    let material = &s.materials[s.shapes[0].material.index()];
    assert_eq!(material.name.as_deref(), Some("later"));
    assert_eq!(material.class.name, "thindielectric");
    assert_eq!((s.shapes.len(), s.objects.len(), s.instances.len()), (1, 1, 1));
    // The transform of the definition belongs to the shapes, that of the instance to the instance.
    near(s.objects[0].shapes[0].world_from_object.start().point(Point::ORIGIN).0, Vec3::X);
    assert_eq!(*s.instances[0].world_from_instance.start(), Transform::IDENTITY);
}

#[test]
fn textures_come_after_those_they_use() {
    let s = world(
        "Material \"diffuse\" \"texture displacement\" \"a\" \
         Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\" \"texture scale\" \"c\" \
         Texture \"s\" \"spectrum\" \"scale\" \"texture scale\" \"a\" Texture \"c\" \"float\" \"fbm\" Texture \"b\" \"float\" \"windy\"",
    );
    let place = |t: TextureId| s.texture_order.iter().position(|o| *o == t).unwrap();
    let float = |name: &str| {
        let i = s.float_textures.iter().position(|t| t.name == name).unwrap();
        place(TextureId::Float(crate::scene::desc::Id::new(i as u32)))
    };
    let spectrum = place(TextureId::Spectrum(crate::scene::desc::Id::new(0)));
    assert!(float("b") < float("a") && float("c") < float("a") && float("a") < spectrum);
    assert!(matches!(s.float_textures[0].kind, FloatTextureKind::Scale { .. }));
}

#[test]
fn include_shares_the_state_and_import_does_not() {
    let part = "Translate 1 0 0 Material \"conductor\" MakeNamedMaterial \"m\" \"string type\" \"diffuse\" Shape \"sphere\"";
    let files = MemoryFiles::new()
        .with("parts/a.pbrt", part)
        .with("parts/b.pbrt", "Include \"parts/c.pbrt\"")
        .with("parts/c.pbrt", "Shape \"disk\"");
    for (directive, x) in [("Include", 2.0), ("Import", 1.0)] {
        let text = format!(
            "WorldBegin Translate 1 0 0 {directive} \"parts/a.pbrt\" Shape \"sphere\" NamedMaterial \"m\""
        );
        let s = import_with(&text, &files).scene.unwrap();
        let at = |n: usize| s.shapes[n].world_from_object.start().point(Point::ORIGIN).0.x;
        assert_eq!((at(0), at(1)), (2.0, x), "{directive}");
        assert_eq!(s.shapes[1].material.index() == 0, directive == "Import");
    }
    // Names are relative to the main file's folder, also inside included files.
    assert_eq!(import_with("WorldBegin Include \"parts/b.pbrt\"", &files).scene.unwrap().shapes.len(), 1);
}

#[test]
fn blocks_may_span_included_files_but_not_imported_ones() {
    let files = MemoryFiles::new().with("open.pbrt", "AttributeBegin").with("close.pbrt", "AttributeEnd");
    let spanning = import_with("WorldBegin Include \"open.pbrt\" Include \"close.pbrt\"", &files);
    assert!(spanning.scene.is_some());
    let imported = import_with("WorldBegin Import \"open.pbrt\"", &files);
    assert_eq!(messages(&imported), ["open.pbrt:1:1: error: this `AttributeBegin` is never closed"]);
    let imported = import_with("WorldBegin AttributeBegin Import \"close.pbrt\" AttributeEnd", &files);
    assert_eq!(messages(&imported), ["close.pbrt:1:1: error: `AttributeEnd` without `AttributeBegin`"]);
}

#[test]
fn several_files_are_one_scene_each_with_its_own_folder() {
    let files = MemoryFiles::new()
        .with("a/header.pbrt", "Camera \"orthographic\" WorldBegin Include \"x.pbrt\"")
        .with("a/x.pbrt", "Shape \"sphere\"")
        .with("b/rest.pbrt", "Include \"y.pbrt\" Shape \"plymesh\" \"string filename\" \"m.ply\"")
        .with("b/y.pbrt", "Shape \"disk\"");
    let inputs = [Input::File(Path::new("a/header.pbrt")), Input::File(Path::new("b/rest.pbrt"))];
    let s = import(&inputs, &files).scene.unwrap();
    assert_eq!(s.shapes.len(), 3);
    let ShapeKind::PlyMesh { file } = &s.shapes[2].kind else { panic!("a mesh") };
    assert_eq!(file.path, Path::new("b/m.ply"));
}

#[test]
fn media_interfaces_reach_shapes_lights_and_the_camera() {
    // Media are refused as a whole for now, so only vacuum can be seen in a scene.
    let s = world("Shape \"sphere\" MediumInterface \"\" \"\" Shape \"sphere\" LightSource \"point\"");
    assert_eq!(s.shapes[0].media, None);
    assert_eq!(s.shapes[1].media, Some(crate::scene::desc::MediumInterface::default()));
    assert_eq!(s.lights[0].medium, None);
}
