//! Classes of entities: their parameters and pbrt-v4's defaults.

use super::{scene, world};
use crate::color::ColorSpaceKind;
use crate::image::ColorEncoding;
use crate::light::Total;
use crate::math::{Point, Vec3};
use crate::scene::desc::*;
use std::path::Path;

fn constant(p: &SpectrumParam) -> f32 {
    match p {
        SpectrumParam::Value(SpectrumDesc { value: SpectrumValue::Constant(v), .. }) => *v,
        other => panic!("{other:?} is no constant"),
    }
}

fn fraction(m: &MaterialDesc, name: &str) -> f32 {
    match &m.argument(name).unwrap().value {
        ArgumentValue::Spectrum(Some(p)) => constant(p),
        other => panic!("{other:?} is no spectrum"),
    }
}

#[test]
fn an_empty_world_has_the_defaults_of_pbrt() {
    let s = scene("WorldBegin");
    let lens = ProjectionDesc {
        lens_radius: 0.0,
        focal_distance: 1e6,
        frame_aspect_ratio: None,
        screen_window: None,
    };
    assert_eq!(s.camera.kind, CameraKind::Perspective { fov: 90.0, projection: lens });
    assert_eq!((s.camera.shutter_open, s.camera.shutter_close), (0.0, 1.0));
    assert_eq!((s.film.kind, s.film.resolution), (FilmKind::Rgb, [1280, 720]));
    assert_eq!(s.film.filename, "pbrt.exr");
    assert_eq!((s.film.sensor.iso, s.film.sensor.white_balance), (100.0, None));
    assert_eq!((s.filter.kind, s.filter.radius), (FilterKind::Gaussian { sigma: 0.5 }, [1.5, 1.5]));
    assert_eq!((s.sampler.kind, s.sampler.pixel_samples), (SamplerKind::ZSobol(Randomization::FastOwen), 16));
    let path = PathDesc { max_depth: 5, regularize: false, light_sampler: None };
    assert_eq!(s.integrator.kind, IntegratorKind::VolPath(path));
    assert_eq!(s.options, OptionsDesc::default());
    assert_eq!((s.materials[0].class.name, fraction(&s.materials[0], "reflectance")), ("diffuse", 0.5));
}

#[test]
fn cameras() {
    let camera = |text: &str| scene(&format!("Camera {text} WorldBegin")).camera;
    let c = camera(
        "\"perspective\" \"float fov\" 40 \"float lensradius\" .1 \"float focaldistance\" 3 \"float frameaspectratio\" 2 \
         \"float screenwindow\" [-1 1 -2 2] \"float shutteropen\" .25 \"float shutterclose\" .5",
    );
    let projection = ProjectionDesc {
        lens_radius: 0.1,
        focal_distance: 3.0,
        frame_aspect_ratio: Some(2.0),
        screen_window: Some([-1.0, 1.0, -2.0, 2.0]),
    };
    assert_eq!(c.kind, CameraKind::Perspective { fov: 40.0, projection });
    assert_eq!((c.shutter_open, c.shutter_close), (0.25, 0.5));
    assert!(matches!(
        camera("\"perspective\" \"float halffov\" 20").kind,
        CameraKind::Perspective { fov: 40.0, .. }
    ));
    assert!(matches!(camera("\"orthographic\"").kind, CameraKind::Orthographic { .. }));
    assert_eq!(camera("\"spherical\"").kind, CameraKind::Spherical { mapping: SphericalMapping::EqualArea });
    let c = camera("\"spherical\" \"string mapping\" \"equirectangular\"");
    assert_eq!(c.kind, CameraKind::Spherical { mapping: SphericalMapping::Equirectangular });
}

#[test]
fn films_and_filters() {
    let s = scene(
        "Film \"spectral\" \"integer nbuckets\" 8 \"float lambdamin\" 400 \"float lambdamax\" 700 \"integer xresolution\" 40 \
         \"integer yresolution\" 30 \"integer pixelbounds\" [-5 20 10 99] \"string filename\" \"o.exr\" \"float diagonal\" 43 \
         \"float iso\" 200 \"float whitebalance\" 5000 \"float maxcomponentvalue\" 9 \"bool savefp16\" false \"string sensor\" \"cie1931\"\n\
         PixelFilter \"mitchell\" \"float xradius\" 1 \"float B\" .5 WorldBegin",
    );
    assert_eq!(s.film.kind, FilmKind::Spectral { n_buckets: 8, lambda_min: 400.0, lambda_max: 700.0 });
    assert_eq!((s.film.resolution, s.film.pixel_bounds), ([40, 30], Some([0, 20, 10, 30])));
    assert_eq!(s.film.filename, "o.exr");
    let sensor = SensorDesc { response: SensorResponse::Cie1931, iso: 200.0, white_balance: Some(5000.0) };
    assert_eq!(s.film.sensor, sensor);
    assert_eq!(s.film.max_component_value, Some(9.0));
    assert_eq!((s.filter.kind, s.filter.radius), (FilterKind::Mitchell { b: 0.5, c: 1.0 / 3.0 }, [1.0, 2.0]));
    let s = scene(
        "Film \"gbuffer\" \"string coordinatesystem\" \"world\" \"float cropwindow\" [.5 .25 0 2] WorldBegin",
    );
    assert_eq!(s.film.kind, FilmKind::GBuffer { space: GBufferSpace::World });
    assert_eq!(s.film.crop_window, Some([0.25, 0.5, 0.0, 1.0]));
    let filter = |name: &str| {
        let f = scene(&format!("PixelFilter \"{name}\" WorldBegin")).filter;
        (f.kind, f.radius[0])
    };
    assert_eq!(filter("box"), (FilterKind::Box, 0.5));
    assert_eq!(filter("triangle"), (FilterKind::Triangle, 2.0));
    assert_eq!(filter("gaussian"), (FilterKind::Gaussian { sigma: 0.5 }, 1.5));
    assert_eq!(filter("sinc"), (FilterKind::Sinc { tau: 3.0 }, 4.0));
}

#[test]
fn samplers() {
    let sampler = |text: &str| {
        let s = scene(&format!("Sampler {text} WorldBegin")).sampler;
        (s.kind, s.pixel_samples, s.seed)
    };
    use Randomization::{FastOwen, None as Plain, Owen, PermuteDigits};
    assert_eq!(sampler("\"independent\""), (SamplerKind::Independent, 4, None));
    assert_eq!(sampler("\"halton\""), (SamplerKind::Halton(PermuteDigits), 16, None));
    assert_eq!(sampler("\"sobol\" \"integer seed\" 7"), (SamplerKind::Sobol(FastOwen), 16, Some(7)));
    assert_eq!(
        sampler("\"paddedsobol\" \"string randomization\" \"owen\""),
        (SamplerKind::PaddedSobol(Owen), 16, None)
    );
    assert_eq!(
        sampler("\"zsobol\" \"string randomization\" \"none\""),
        (SamplerKind::ZSobol(Plain), 16, None)
    );
    assert_eq!(sampler("\"pmj02bn\" \"integer pixelsamples\" 64"), (SamplerKind::Pmj02bn, 64, None));
    let strata = SamplerKind::Stratified { x: 3, y: 4, jitter: false };
    assert_eq!(sampler("\"stratified\" \"integer xsamples\" 3 \"bool jitter\" false"), (strata, 12, None));
}

#[test]
fn integrators_and_accelerators() {
    let kind = |text: &str| scene(&format!("Integrator {text} WorldBegin")).integrator.kind;
    let path = PathDesc { max_depth: 65, regularize: true, light_sampler: Some(LightSamplerKind::Power) };
    assert_eq!(
        kind("\"path\" \"integer maxdepth\" 65 \"bool regularize\" true \"string lightsampler\" \"power\""),
        IntegratorKind::Path(path)
    );
    assert!(matches!(kind("\"volpath\""), IntegratorKind::VolPath(_)));
    let simple = IntegratorKind::SimplePath { max_depth: 5 };
    assert_eq!(kind("\"simplepath\" \"bool samplelights\" true \"bool samplebsdf\" true"), simple);
    assert_eq!(kind("\"simplevolpath\""), IntegratorKind::SimpleVolPath { max_depth: 5 });
    assert_eq!(kind("\"lightpath\""), IntegratorKind::LightPath { max_depth: 5 });
    assert_eq!(kind("\"randomwalk\" \"integer maxdepth\" 2"), IntegratorKind::RandomWalk { max_depth: 2 });
    assert_eq!(kind("\"bdpt\""), IntegratorKind::Bdpt { max_depth: 5, regularize: false });
    let mlt = "\"mlt\" \"integer bootstrapsamples\" 9 \"integer chains\" 2 \"integer mutationsperpixel\" 7 \"float sigma\" .1 \
               \"float largestepprobability\" 1 \"bool regularize\" true";
    assert_eq!(kind(mlt), IntegratorKind::Mlt { max_depth: 5, regularize: true });
    let sppm = "\"sppm\" \"float radius\" .5 \"integer photonsperiteration\" -1 \"integer seed\" 3";
    assert_eq!(kind(sppm), IntegratorKind::Sppm { max_depth: 5 });
    let ao = "\"ambientocclusion\" \"bool cossample\" false \"float maxdistance\" 2";
    assert_eq!(kind(ao), IntegratorKind::AmbientOcclusion);
    assert_eq!(kind("\"classic\" \"float scale\" 2"), IntegratorKind::Classic(ClassicDesc::default()));
    let classic = "\"classic\" \"spectrum ambient\" [ 400 1 700 1 ] \"float scale\" 2 \"string unit\" \"radiance\" \"bool shadows\" true";
    let IntegratorKind::Classic(ClassicDesc { ambient: Some(ambient), shadows: true }) = kind(classic) else {
        panic!("{:?}", kind(classic))
    };
    assert_eq!((ambient.scale, ambient.normalization), (2.0, Normalization::Absolute));
    scene("Accelerator \"bvh\" \"string splitmethod\" \"hlbvh\" \"integer maxnodeprims\" 2 WorldBegin");
    scene("Accelerator \"kdtree\" \"integer intersectcost\" 5 \"float emptybonus\" .5 WorldBegin");
}

#[test]
fn options_with_and_without_types() {
    let s = scene(
        "Option \"disablepixeljitter\" true Option \"bool disable-wavelength_Jitter\" true Option \"seed\" 17 \
         Option \"integer seed\" 18 Option \"float metersperunit\" 0.01 Option \"displacementedgescale\" 2 \
         Option \"rendercoordsys\" \"world\" Option \"disabletexturefiltering\" [ true ] Option \"forcediffuse\" true WorldBegin",
    );
    let expected = OptionsDesc {
        disable_pixel_jitter: true,
        disable_wavelength_jitter: true,
        disable_texture_filtering: true,
        force_diffuse: true,
        seed: 18,
        rendering_space: RenderingSpace::World,
        displacement_edge_scale: 2.0,
        meters_per_unit: 0.01,
    };
    assert_eq!(s.options, expected);
}

#[test]
fn quadrics_and_files() {
    let s = world(
        "Shape \"sphere\" \"float radius\" 2 \"float zmax\" 1 Shape \"disk\" \"float innerradius\" .5 \
         Shape \"cylinder\" \"float phimax\" 400 Shape \"plymesh\" \"string filename\" [ \"m/a.ply\" ] \"float alpha\" .5",
    );
    let kinds: Vec<&ShapeKind> = s.shapes.iter().map(|s| &s.kind).collect();
    assert!(matches!(kinds[0], ShapeKind::Sphere { radius: 2.0, z_min: -2.0, z_max: 1.0, phi_max: 360.0 }));
    assert!(matches!(
        kinds[1],
        ShapeKind::Disk { height: 0.0, radius: 1.0, inner_radius: 0.5, phi_max: 360.0 }
    ));
    assert!(matches!(kinds[2], ShapeKind::Cylinder { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 360.0 }));
    assert!(matches!(kinds[3], ShapeKind::PlyMesh { file } if file.path == Path::new("m/a.ply")));
    assert_eq!((s.shapes[0].alpha, s.shapes[3].alpha), (FloatParam::Value(1.0), FloatParam::Value(0.5)));
}

#[test]
fn meshes() {
    let s = world(
        "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 2 1 3] \
         \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1] \"vector3 S\" [1 0 0 1 0 0 1 0 0 1 0 0] \"point2 uv\" [0 0 1 0 0 1 1 1] \
         \"integer faceIndices\" [5 6] \
         Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [ ] \
         Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    );
    let ShapeKind::TriangleMesh(m) = &s.shapes[0].kind else { panic!("triangles") };
    assert_eq!(m.indices, [0, 1, 2, 2, 1, 3]);
    assert_eq!((m.p[3], m.n[0], m.s[0]), (Point::new(1.0, 1.0, 0.0), Vec3::Z, Vec3::X));
    assert_eq!((m.uv.len(), m.face_indices.as_slice()), (4, &[5, 6][..]));
    let ShapeKind::TriangleMesh(m) = &s.shapes[1].kind else { panic!("triangles") };
    assert_eq!((m.indices.as_slice(), m.n.len()), (&[0, 1, 2][..], 0));
    let ShapeKind::BilinearMesh { mesh, emission: None } = &s.shapes[2].kind else { panic!("patches") };
    assert_eq!(mesh.indices, [0, 1, 2, 3]);
}

#[test]
fn curves_and_subdivision_surfaces() {
    let s = world(
        "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0] \"string basis\" \"bspline\" \"float width\" 2 \
         \"float width1\" 1 \"string type\" \"cylinder\" \
         Shape \"curve\" \"integer degree\" 2 \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0] \"string type\" \"ribbon\" \
         \"normal N\" [0 0 1 0 0 1 0 0 1] \
         Shape \"loopsubdiv\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer levels\" 2",
    );
    let ShapeKind::Curve(c) = &s.shapes[0].kind else { panic!("a curve") };
    assert_eq!((c.basis, c.degree, c.kind), (CurveBasis::BSpline, 3, CurveKind::Cylinder));
    assert_eq!((c.width, c.split_depth, c.p.len()), ([2.0, 1.0], 3, 5));
    let ShapeKind::Curve(c) = &s.shapes[1].kind else { panic!("a curve") };
    assert_eq!((c.basis, c.degree, c.kind, c.n.len()), (CurveBasis::Bezier, 2, CurveKind::Ribbon, 3));
    let ShapeKind::LoopSubdivision { levels, indices, p } = &s.shapes[2].kind else { panic!("a surface") };
    assert_eq!((*levels, indices.len(), p.len()), (2, 3, 3));
}

#[test]
fn every_material_reads_its_parameters() {
    let material = |text: &str| {
        let mut s = world(&format!("Texture \"f\" \"float\" \"constant\" Material {text}"));
        s.materials.remove(1)
    };
    let value = |m: &MaterialDesc, name: &str| m.argument(name).unwrap().value.clone();
    let float = |v| ArgumentValue::Float(Some(FloatParam::Value(v)));
    let m = material("\"diffusetransmission\"");
    assert_eq!((fraction(&m, "reflectance"), fraction(&m, "transmittance")), (0.25, 0.25));
    assert_eq!(value(&m, "scale"), ArgumentValue::Number(Some(1.0)));
    let m = material(
        "\"conductor\" \"float roughness\" .2 \"float vroughness\" .3 \"bool remaproughness\" false",
    );
    let ArgumentValue::Spectrum(Some(SpectrumParam::Value(eta))) = value(&m, "eta") else { panic!() };
    assert_eq!(eta.value, SpectrumValue::Named("metal-Cu-eta".to_owned()));
    assert_eq!(value(&m, "roughness"), float(0.2));
    assert_eq!(value(&m, "uroughness"), ArgumentValue::Float(None));
    assert_eq!(value(&m, "vroughness"), float(0.3));
    assert_eq!(value(&m, "remaproughness"), ArgumentValue::Flag(false));
    assert!(m.argument("roughness").unwrap().given && !m.argument("eta").unwrap().given);
    let index = |m: &MaterialDesc| match value(m, "eta") {
        ArgumentValue::Index(Some(eta)) => eta.value,
        other => panic!("{other:?}"),
    };
    assert_eq!(index(&material("\"dielectric\" \"float eta\" 1.33")), SpectrumValue::Constant(1.33));
    let m = material("\"thindielectric\" \"spectrum eta\" \"glass-BK7\"");
    assert_eq!(index(&m), SpectrumValue::Named("glass-BK7".to_owned()));
    let m = material(
        "\"coateddiffuse\" \"texture thickness\" \"f\" \"float g\" .5 \"integer maxdepth\" 3 \"integer nsamples\" 2",
    );
    assert_eq!(value(&m, "roughness"), float(0.0));
    assert!(matches!(value(&m, "thickness"), ArgumentValue::Float(Some(FloatParam::Texture(_)))));
    assert_eq!(value(&m, "g"), float(0.5));
    assert_eq!(value(&m, "maxdepth"), ArgumentValue::Count(3));
    assert_eq!(value(&m, "nsamples"), ArgumentValue::Count(2));
    let m = material(
        "\"coatedconductor\" \"float interface.roughness\" .1 \"float conductor.uroughness\" .4 \"rgb reflectance\" [.5 .5 .5]",
    );
    assert_eq!(value(&m, "interface.roughness"), float(0.1));
    assert_eq!(value(&m, "conductor.uroughness"), float(0.4));
    assert!(matches!(value(&m, "reflectance"), ArgumentValue::Spectrum(Some(_))));
    assert!(material("\"interface\"").is_interface());
    let s = world(
        "MakeNamedMaterial \"mix\" \"string type\" \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .25 \
         MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"texture displacement\" \"h\" \"string normalmap\" \"n.png\" \
         MakeNamedMaterial \"b\" \"string type\" \"dielectric\" Texture \"h\" \"float\" \"wrinkled\"",
    );
    assert_eq!(value(&s.materials[1], "amount"), float(0.25));
    let parts: Vec<_> = s.materials[1].parts().map(|m| s.material(m).unwrap()).collect();
    let [a, b] = parts[..] else { panic!("two parts") };
    assert_eq!((a.name.as_deref(), b.name.as_deref()), (Some("a"), Some("b")));
    assert!(a.displacement.is_some());
    assert_eq!(a.normal_map.as_ref().unwrap().path, Path::new("n.png"));
}

#[test]
fn spectra_of_every_form() {
    let value = |param: &str| {
        let s = world(&format!("LightSource \"point\" {param}"));
        let LightKind::Point { intensity, .. } = &s.lights[0].kind else { panic!() };
        intensity.value.clone()
    };
    let rgb = SpectrumValue::Rgb { rgb: [10.0, 0.5, 0.0], color_space: ColorSpaceKind::Srgb };
    assert_eq!(value("\"rgb I\" [10 .5 0]"), rgb);
    assert_eq!(value("\"blackbody I\" 5500"), SpectrumValue::Blackbody { kelvin: 5500.0 });
    assert_eq!(value("\"spectrum I\" \"stdillum-A\""), SpectrumValue::Named("stdillum-A".to_owned()));
    assert_eq!(value("\"spectrum I\" [ \"lamp.spd\" ]"), SpectrumValue::File("lamp.spd".into()));
    let samples = SpectrumValue::Samples { lambda: vec![400.0, 700.0], values: vec![1.0, 2.0] };
    assert_eq!(value("\"spectrum I\" [400 1 700 2]"), samples);
    assert_eq!(value(""), SpectrumValue::Illuminant(ColorSpaceKind::Srgb));
}

#[test]
fn every_light_reads_its_parameters() {
    let s = world(
        "LightSource \"point\" \"point3 from\" [1 2 3] \"float power\" 100 \"float scale\" 2 \
         LightSource \"spot\" \"point3 to\" [0 1 0] \"float coneangle\" 20 \"float conedeltaangle\" 4 \
         LightSource \"goniometric\" \"string filename\" \"g.exr\" LightSource \"projection\" \"string filename\" \"p.png\" \"float fov\" 30 \
         LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"float illuminance\" 1000 \
         LightSource \"infinite\" \"string filename\" \"sky.exr\" \"float illuminance\" 10 \
         LightSource \"infinite\" \"rgb L\" [1 1 1] \"string unit\" \"radiance\"",
    );
    let kinds: Vec<&LightKind> = s.lights.iter().map(|l| &l.kind).collect();
    assert!(matches!(kinds[0], LightKind::Point { from, .. } if *from == Point::new(1.0, 2.0, 3.0)));
    assert_eq!((s.lights[0].scale, s.lights[1].scale), (2.0, 1.0));
    assert!(matches!(kinds[1], LightKind::Spot { cone_angle: 20.0, cone_delta_angle: 4.0, .. }));
    assert!(matches!(kinds[2], LightKind::Goniometric { file, .. } if file.path == Path::new("g.exr")));
    assert!(matches!(kinds[3], LightKind::Projection { fov: 30.0, .. }));
    assert!(matches!(kinds[4], LightKind::Distant { .. }));
    assert!(matches!(kinds[5], LightKind::ImageInfinite { .. }));
    assert!(matches!(kinds[6], LightKind::UniformInfinite { .. }));
    let lm = Some(Total::Luminous(100.0));
    let (lx, dim) = (Some(Total::Luminous(1000.0)), Some(Total::Luminous(10.0)));
    let totals: Vec<_> = s.lights.iter().map(|l| l.total).collect();
    assert_eq!(totals, [lm, None, None, None, lx, dim, None]);
    let absolute = [false, false, false, false, false, false, true];
    assert_eq!(
        s.lights.iter().map(|l| l.normalization == Normalization::Absolute).collect::<Vec<_>>(),
        absolute
    );
}

#[test]
fn area_lights_serve_the_shapes_that_follow() {
    let s = world(
        "AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" true \"float power\" 60 Shape \"sphere\" Shape \"disk\" \
         AreaLightSource \"diffuse\" \"string filename\" \"e.png\" \"float scale\" 3 Shape \"sphere\"",
    );
    let light = |n: usize| s.shapes[n].area_light.unwrap().index();
    assert_eq!([light(0), light(1), light(2)], [0, 0, 1]);
    let [a, b] = s.area_lights.as_slice() else { panic!("two") };
    assert_eq!((a.two_sided, a.total, a.scale), (true, Some(Total::Luminous(60.0)), 1.0));
    assert!(matches!(&b.radiance, AreaRadiance::Image(f) if f.path == Path::new("e.png")));
    assert_eq!((b.two_sided, b.total, b.scale), (false, None, 3.0));
}

#[test]
fn every_texture_class_reads_its_parameters() {
    let float = |text: &str| world(&format!("Texture \"t\" \"float\" {text}")).float_textures.remove(0).kind;
    let spectrum =
        |text: &str| world(&format!("Texture \"t\" \"spectrum\" {text}")).spectrum_textures.remove(0).kind;
    use FloatTextureKind as F;
    use SpectrumTextureKind as S;
    let v = FloatParam::Value;
    assert!(matches!(float("\"constant\" \"float value\" 3"), F::Constant { value } if value == v(3.0)));
    assert!(matches!(float("\"scale\""), F::Scale { tex, scale } if tex == v(1.0) && scale == v(1.0)));
    assert!(
        matches!(float("\"mix\""), F::Mix { tex1, tex2, amount } if (tex1, tex2, amount) == (v(0.0), v(1.0), v(0.5)))
    );
    assert!(
        matches!(float("\"directionmix\" \"vector3 dir\" [0 0 2]"), F::DirectionMix { dir, .. } if *dir == Vec3::Z)
    );
    assert!(matches!(float("\"bilerp\""), F::Bilerp { v, .. } if v == [0.0, 1.0, 0.0, 1.0]));
    assert!(matches!(
        float("\"fbm\" \"integer octaves\" 4"),
        F::Fbm(NoiseDesc { octaves: 4, roughness: 0.5 })
    ));
    assert!(matches!(
        float("\"wrinkled\" \"float roughness\" .25"),
        F::Wrinkled(NoiseDesc { octaves: 8, roughness: 0.25 })
    ));
    assert!(matches!(float("\"windy\""), F::Windy));
    assert!(matches!(float("\"dots\" \"float inside\" 2"), F::Dots { inside, .. } if inside == v(2.0)));
    let solid = float("\"checkerboard\" \"integer dimension\" 3");
    assert!(matches!(solid, F::Checkerboard { domain: CheckerboardDomain::Space, .. }));
    let F::Image(image) = float(
        "\"imagemap\" \"string filename\" \"t/a.png\" \"string encoding\" \"gamma 2.2\" \"string filter\" \"ewa\" \"string wrap\" \"clamp\" \
         \"float scale\" 2 \"bool invert\" true \"float maxanisotropy\" 4 \"string mapping\" \"planar\" \"vector3 v1\" [2 0 0] \"float vdelta\" .5",
    ) else {
        panic!("a picture")
    };
    assert_eq!(
        (image.file.path.as_path(), image.encoding),
        (Path::new("t/a.png"), Some(ColorEncoding::Gamma(2.2)))
    );
    assert_eq!(
        (image.filter, image.wrap, image.scale, image.invert),
        (ImageFilter::Ewa, WrapMode::Clamp, 2.0, true)
    );
    assert_eq!(
        image.mapping,
        Mapping2d::Planar { v1: Vec3::new(2.0, 0.0, 0.0), v2: Vec3::Y, delta: [0.0, 0.5] }
    );
    let S::Image(image) = spectrum("\"imagemap\" \"string filename\" \"a.png\" \"float uscale\" 4") else {
        panic!()
    };
    assert_eq!((image.encoding, image.filter, image.wrap), (None, ImageFilter::Bilinear, WrapMode::Repeat));
    assert_eq!(image.mapping, Mapping2d::Uv { scale: [4.0, 1.0], delta: [0.0, 0.0] });
    assert!(matches!(spectrum("\"constant\""), S::Constant { value } if constant(&value) == 1.0));
    assert!(matches!(spectrum("\"scale\" \"float scale\" 2"), S::Scale { scale, .. } if scale == v(2.0)));
    assert!(
        matches!(spectrum("\"mix\" \"rgb tex1\" [1 0 0]"), S::Mix { tex2, .. } if constant(&tex2) == 1.0)
    );
    assert!(matches!(spectrum("\"directionmix\""), S::DirectionMix { dir, .. } if *dir == Vec3::Y));
    assert!(
        matches!(spectrum("\"bilerp\" \"rgb v00\" [1 1 1]"), S::Bilerp { v, .. } if constant(&v[1]) == 1.0)
    );
    assert!(matches!(
        spectrum("\"checkerboard\" \"string mapping\" \"spherical\""),
        S::Checkerboard { domain: CheckerboardDomain::Plane(Mapping2d::Spherical), .. }
    ));
    assert!(matches!(
        spectrum("\"dots\" \"string mapping\" \"cylindrical\""),
        S::Dots { mapping: Mapping2d::Cylindrical, .. }
    ));
    assert!(matches!(
        spectrum("\"marble\" \"float variation\" .5"),
        S::Marble { scale: 1.0, variation: 0.5, .. }
    ));
}
