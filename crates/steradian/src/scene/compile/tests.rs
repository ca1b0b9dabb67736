use crate::scene::files::{FileBytes, FileSystem, MemoryFiles};
use crate::scene::import::pbrt::{Imported, Input, import};
use crate::scene::{Diagnostics, RenderJob, Severity};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// What compiling a scene gave: the job, and all messages.
struct Compiled {
    job: Option<RenderJob>,
    messages: Vec<(Severity, String)>,
    shown: String,
}

fn compile(world: &str, files: &dyn FileSystem) -> Compiled {
    compile_with_header("", world, files)
}

fn compile_with_header(header: &str, world: &str, files: &dyn FileSystem) -> Compiled {
    let text = format!(
        "{header} Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n{world}\n"
    );
    let input = Input::Text { name: "test.pbrt", bytes: text.as_bytes(), base: Path::new("") };
    let Imported { scene, sources, mut diagnostics } = import(&[input], files);
    let job = scene.and_then(|d| super::compile(d, files, &mut diagnostics));
    let diagnostics: Diagnostics = diagnostics;
    let messages = diagnostics.iter().map(|d| (d.severity, d.message.clone())).collect();
    Compiled { job, messages, shown: diagnostics.display(&sources).to_string() }
}

impl Compiled {
    fn count(&self, severity: Severity, part: &str) -> usize {
        self.messages.iter().filter(|(s, m)| *s == severity && m.contains(part)).count()
    }
}

/// A colour picture of the given size, of which the last texel is `last`.
fn pfm(width: usize, height: usize, last: f32) -> Vec<u8> {
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    for i in 0..width * height {
        // The last texel of the bottom row, which PFM stores first.
        let v = if i == width - 1 { last } else { 0.5 };
        bytes.extend([v; 3].iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

/// Counts how often each file is read.
struct Counting {
    files: MemoryFiles,
    reads: Mutex<BTreeMap<PathBuf, usize>>,
}

impl Counting {
    fn new(files: MemoryFiles) -> Self {
        Self { files, reads: Mutex::default() }
    }

    fn reads(&self, path: &str) -> usize {
        self.reads.lock().unwrap().get(Path::new(path)).copied().unwrap_or(0)
    }
}

impl FileSystem for Counting {
    fn read(&self, path: &Path) -> io::Result<FileBytes> {
        *self.reads.lock().unwrap().entry(path.to_owned()).or_default() += 1;
        self.files.read(path)
    }
}

#[test]
fn a_texel_that_is_no_finite_number_is_an_error_where_its_picture_is_named() {
    for bad in [f32::INFINITY, f32::NAN] {
        let files = MemoryFiles::new().with("a.pfm", pfm(2, 2, bad));
        for user in [
            "LightSource \"infinite\" \"string filename\" \"a.pfm\"",
            "LightSource \"goniometric\" \"string filename\" \"a.pfm\"",
            "LightSource \"projection\" \"string filename\" \"a.pfm\"",
            "AreaLightSource \"diffuse\" \"string filename\" \"a.pfm\" Shape \"sphere\"",
            "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.pfm\"",
            "Material \"diffuse\" \"string normalmap\" \"a.pfm\"",
        ] {
            let c = compile(user, &files);
            assert!(c.job.is_none());
            assert_eq!(c.count(Severity::Error, "the texel in column 1, row 1 is"), 1, "{}", c.shown);
            assert!(c.shown.contains("test.pbrt:3:"), "{}", c.shown);
        }
    }
}

#[test]
fn an_interface_inside_a_mix_is_refused() {
    let c = compile(
        "MakeNamedMaterial \"air\" \"string type\" \"interface\" MakeNamedMaterial \"wall\" \"string type\" \"diffuse\"
         Material \"mix\" \"string materials\" [\"air\" \"wall\"] Shape \"sphere\"",
        &MemoryFiles::new(),
    );
    assert_eq!(c.count(Severity::Error, "an interface inside a mix is not supported"), 1, "{}", c.shown);
}

#[test]
fn the_illuminance_of_a_map_is_the_true_one_and_differs_from_pbrt_with_notice() {
    let files = MemoryFiles::new().with("a.pfm", pfm(2, 2, 0.5));
    let map = |more: &str| format!("LightSource \"infinite\" \"string filename\" \"a.pfm\" {more}");
    let stated = compile(&map("\"float illuminance\" 100"), &files);
    assert_eq!(stated.count(Severity::Notice, "twice as bright"), 1, "{}", stated.shown);
    assert_eq!(compile(&map(""), &files).count(Severity::Notice, "twice as bright"), 0);
}

#[test]
fn files_are_read_once_however_many_use_them() {
    let spd = "400 1\n700 2\n";
    let files = MemoryFiles::new().with("a.pfm", pfm(2, 2, 0.5)).with("a.spd", spd);
    let files = Counting::new(files.with("n.pfm", pfm(2, 2, 0.5)));
    let c = compile(
        "AreaLightSource \"diffuse\" \"string filename\" \"a.pfm\"
         Material \"diffuse\" \"string normalmap\" \"n.pfm\" \"spectrum reflectance\" \"a.spd\" Shape \"sphere\"
         Material \"conductor\" \"string normalmap\" \"n.pfm\" \"spectrum eta\" \"a.spd\" Shape \"sphere\" Shape \"disk\"
         LightSource \"infinite\" \"string filename\" \"a.pfm\"",
        &files,
    );
    assert!(c.job.is_some(), "{}", c.shown);
    assert_eq!([files.reads("a.pfm"), files.reads("n.pfm"), files.reads("a.spd")], [1; 3]);
}

#[test]
fn only_a_scene_without_any_light_statement_is_said_to_have_none() {
    let dark = |world: &str| compile(world, &MemoryFiles::new()).count(Severity::Warning, "no light");
    assert_eq!(dark("Shape \"sphere\""), 1);
    assert_eq!(dark("LightSource \"infinite\" \"string filename\" \"missing.exr\""), 0);
    assert_eq!(dark("AreaLightSource \"diffuse\" \"float scale\" -1 Shape \"sphere\""), 0);
}

#[test]
fn converted_maps_name_the_pole_of_their_light() {
    let files = MemoryFiles::new().with("a.pfm", pfm(4, 2, 0.5));
    for (kind, pole) in [("infinite", "+z is the top row"), ("goniometric", "+y is the top row")] {
        let c = compile(&format!("LightSource \"{kind}\" \"string filename\" \"a.pfm\""), &files);
        assert!(c.shown.contains(pole), "{}", c.shown);
    }
}

#[test]
fn a_constant_texture_costs_no_more_than_its_value() {
    let c = compile(
        "Texture \"one\" \"float\" \"constant\" \"float value\" 1
         Texture \"gray\" \"spectrum\" \"constant\" \"rgb value\" [0.5 0.5 0.5]
         Material \"diffuse\" \"texture reflectance\" \"gray\" \"texture displacement\" \"one\"
         Shape \"sphere\" \"texture alpha\" \"one\"
         LightSource \"point\"",
        &MemoryFiles::new(),
    );
    let scene = c.job.expect("no error").scene;
    assert_eq!(scene.attributes[0].alpha, crate::texture::FloatInput::Constant(1.0));
    assert!(!scene.materials.needs_footprint(scene.attributes[0].material));
}

#[test]
fn legacy_shading_says_what_it_leaves_out() {
    let files = MemoryFiles::new();
    let shown = |integrator: &str, world: &str| {
        let text = format!("Integrator \"{integrator}\"\nWorldBegin\n{world}\n");
        let input = Input::Text { name: "test.pbrt", bytes: text.as_bytes(), base: Path::new("") };
        let Imported { scene, sources, mut diagnostics } = import(&[input], &files);
        scene.and_then(|d| super::compile(d, &files, &mut diagnostics)).expect("no error");
        diagnostics.display(&sources).to_string()
    };
    let sky = "LightSource \"infinite\" AreaLightSource \"diffuse\" Shape \"sphere\"";
    let text = shown("classic", sky);
    assert_eq!(text.matches("leaves out lights that have an extent").count(), 2, "{text}");
    assert!(text.contains("test.pbrt:3:1") && text.contains("test.pbrt:3:24"), "{text}");
    assert_eq!(shown("path", sky), "");
    let phong = "Material \"phong\" Shape \"sphere\" LightSource \"point\"";
    assert!(shown("path", phong).contains("legacy shading, not a BRDF"), "{}", shown("path", phong));
    assert_eq!(shown("classic", phong), "");
    // Surroundings are light.
    let ambient = "classic\" \"spectrum ambient\" [ 400 1 700 1 ] #";
    assert_eq!(shown(ambient, "Shape \"sphere\""), "");
}

#[test]
fn amounts_mean_the_same_in_scenes_of_any_unit() {
    let lumens = |world: &str| {
        let header = "Option \"float metersperunit\" 0.01";
        let c = compile_with_header(header, world, &MemoryFiles::new());
        let job = c.job.unwrap_or_else(|| panic!("{}", c.shown));
        job.scene.lights()[0].power(1.0).lumens * job.meters_per_unit * job.meters_per_unit
    };
    let pi = std::f32::consts::PI;
    let square = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 100 0 0 100 100 0 0 100 0] \"integer indices\" [0 1 2 0 2 3]";
    let area = |amount: &str| format!("AreaLightSource \"diffuse\" {amount} {square}");
    let cases = [
        ("LightSource \"point\" \"float intensity\" 50".to_owned(), 200.0 * pi),
        ("LightSource \"point\" \"float scale\" 50".to_owned(), 200.0 * pi),
        ("LightSource \"point\" \"float power\" 800".to_owned(), 800.0),
        (area("\"float power\" 800"), 800.0),
        // One square metre.
        (area("\"float luminance\" 50"), 50.0 * pi),
    ];
    for (world, expected) in cases {
        let found = lumens(&world);
        assert!((found / expected - 1.0).abs() < 1e-4, "{world}: {found} {expected}");
    }
}

const LAMP: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.6 0.6 0\n1 1 10\n0 45 90\n0\n100 60 0\n";

fn flux_of(world: &str, header: &str) -> f32 {
    let files = MemoryFiles::new().with("lamp.ies", LAMP);
    let c = compile_with_header(header, world, &files);
    let job = c.job.unwrap_or_else(|| panic!("{}", c.shown));
    job.scene.lights()[0].power(1.0).lumens * job.meters_per_unit * job.meters_per_unit
}

#[test]
fn a_luminaire_has_the_flux_of_its_table_or_the_one_that_is_stated() {
    let smooth = "LightSource \"photometric\" \"string filename\" \"lamp.ies\"";
    let lamp = format!("{smooth} \"string interpolation\" \"linear\"");
    // 2π ∫ I sinγ dγ of two straight pieces.
    let piece = |a: f64, b: f64, va: f64, vb: f64| {
        let (a, b) = (a.to_radians(), b.to_radians());
        va * a.cos() - vb * b.cos() + (vb - va) / (b - a) * (b.sin() - a.sin())
    };
    let flux = std::f64::consts::TAU * (piece(0.0, 45.0, 100.0, 60.0) + piece(45.0, 90.0, 60.0, 0.0));
    let cases = [
        ("", flux),
        ("\"float scale\" 0.5", 0.5 * flux),
        ("\"float flux\" 800", 800.0),
        ("\"float power\" 800 \"string opening\" \"file\"", 800.0),
        ("\"float intensity\" 50 \"float width\" 2 \"float length\" 1", 0.5 * flux),
        ("\"blackbody spectrum\" 3000", flux),
    ];
    for (more, expected) in cases {
        for header in ["", "Option \"float metersperunit\" 0.001"] {
            let found = flux_of(&format!("{lamp} {more}"), header);
            assert!((f64::from(found) / expected - 1.0).abs() < 1e-4, "{more}: {found} {expected}");
        }
    }
    let web = crate::light::photometric::read(LAMP.as_bytes(), &mut |_| Err(String::new())).unwrap().web;
    assert!((f64::from(flux_of(smooth, "")) / web.flux() - 1.0).abs() < 1e-6);
    assert!((web.flux() / flux - 1.0).abs() > 1e-3);
}

#[test]
fn a_fault_of_a_luminaire_is_shown_in_its_own_file() {
    let damaged = LAMP.replace("100 60 0", "100 6O 0");
    let c = compile(
        "LightSource \"photometric\" \"string filename\" \"lamp.ies\"",
        &MemoryFiles::new().with("lamp.ies", damaged),
    );
    assert!(c.job.is_none());
    let expected = "lamp.ies:7:5: error: expected an intensity, a number, found `6O` (intensity 2 of horizontal angle 1 of 1)\n \
                    7 | 100 6O 0\n   |     ^^\n\
                    test.pbrt:3:45: note: the file is named here\n";
    assert!(c.shown.starts_with(expected), "{}", c.shown);
    let c = compile("LightSource \"photometric\" \"string filename\" \"none.ies\"", &MemoryFiles::new());
    assert_eq!(c.count(Severity::Error, "cannot read luminaire none.ies: no such file"), 1, "{}", c.shown);
}
