//! `steradian bsdf` and `steradian plot`: numbers that are known beforehand, pictures that can be read, faults that are named.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use serde_json::Value;
use support::desk::Desk;

const SCENE: &str = r#"
WorldBegin
Texture "checks" "spectrum" "checkerboard" "float uscale" 2 "float vscale" 2
  "rgb tex1" [ 0.8 0.8 0.8 ] "rgb tex2" [ 0.2 0.2 0.2 ]
MakeNamedMaterial "paint" "string type" "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ]
MakeNamedMaterial "tiles" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "glass" "string type" "dielectric" "float eta" 1.5
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"
  "float roughness" 0.2
MakeNamedMaterial "varnish" "string type" "coateddiffuse" "float roughness" 0.3 "rgb albedo" [0.5 0.5 0.5]
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "paint" "gold" ]
Shape "plymesh" "string filename" "a-file-that-is-not-there.ply"
"#;

/// Questions to the program about the materials of the scene.
struct Bench(Desk);

impl Bench {
    fn new() -> Self {
        Self(Desk::new(SCENE))
    }

    /// Exit code, standard output and standard error.
    fn run(&self, arguments: &[&str], input: &str) -> (i32, String, String) {
        let said = self.0.run_with(arguments, input);
        (said.code.unwrap(), said.out, said.err)
    }

    #[track_caller]
    fn bsdf(&self, material: &str, more: &[&str]) -> String {
        let mut arguments = vec!["bsdf", "scene.pbrt", "--material", material];
        arguments.extend(more);
        let (code, out, err) = self.run(&arguments, "");
        assert_eq!((code, err.as_str()), (0, ""), "{out}");
        out
    }

    #[track_caller]
    fn json(&self, material: &str, more: &[&str]) -> Value {
        serde_json::from_str(&self.bsdf(material, &[more, &["--json"]].concat())).unwrap()
    }

    /// Failed with that exit code and exactly that message, and printed nothing else.
    #[track_caller]
    fn fails(&self, arguments: &[&str], message: &str) {
        let (code, out, err) = self.run(arguments, "");
        assert_eq!((code, err.trim_end(), out.as_str()), (1, message, ""));
    }

    /// Refused the arguments, with that text in the message.
    #[track_caller]
    fn refuses(&self, arguments: &[&str], text: &str) {
        let (code, out, err) = self.run(arguments, "");
        assert!(code == 2 && err.contains(text) && out.is_empty(), "{code} {err}");
    }
}

/// The numbers of the table's rows.
fn rows(out: &str) -> Vec<Vec<String>> {
    let lines = out.lines().filter(|l| !l.trim_start().starts_with('#') && !l.starts_with("discrete"));
    lines.map(|l| l.split_whitespace().map(str::to_owned).collect()).collect()
}

/// f = ρ/π, pdf = cosθi/π, s = cosθo/π.
#[test]
fn a_lambertian_surface_reads_what_lambert_says() {
    let desk = Bench::new();
    let out = desk.bsdf("paint", &["--wo", "30,0", "--wi", "60,180", "--wavelength", "400,700"]);
    let row = |lambda| ["30", "0", "60", "180", lambda, "0.159155", "0.159155", "0.275664", "0.5", "0"];
    assert_eq!(rows(&out), [row("400"), row("700")]);
    let header = out.lines().nth(1).unwrap();
    for column in ["lambda [nm]", "f [1/sr]", "pdf [1/sr]", "s [1/sr]", "rho [1]", "tau [1]"] {
        assert!(header.contains(column), "{header}");
    }
    // Data reach as far as they reach.
    let ask = ["--wo", "30,0", "--wi", "60,180", "--wavelength", "900"];
    assert_eq!(rows(&desk.bsdf("paint", &ask))[0][8], "0.5");
    // Light from below stays below.
    let out = desk.bsdf("paint", &["--wo", "30,0", "--wi", "120,180", "-l", "550"]);
    assert_eq!(rows(&out)[0][5..], ["0", "0", "0", "0.5", "0"]);
}

/// R(0) = 0.04 for an index of 1.5; radiance that enters is seen divided by its square.
#[test]
fn smooth_glass_has_fresnels_albedo_and_two_discrete_directions() {
    let desk = Bench::new();
    let ask = ["--wo", "0,0", "--wi", "0,0", "--wavelength", "550"];
    let out = desk.bsdf("glass", &ask);
    assert_eq!(rows(&out)[0][5..], ["0", "0", "0", "0.04", "0.96"]);
    assert!(out.contains("discrete: wo = 0,0  wi = 0,0  550 nm  radiance ratio 0.04\n"), "{out}");
    assert!(out.contains("discrete: wo = 0,0  wi = 180,0  550 nm  radiance ratio 0.426667"), "{out}");
    let out = desk.bsdf("glass", &[&ask[..], &["--mode", "importance"]].concat());
    assert!(out.contains("wi = 180,0  550 nm  power ratio 0.96"), "{out}");
    // Beyond the critical angle from inside, everything returns.
    let out = desk.bsdf("glass", &["--wo", "130,0", "--wi", "130,180", "--wavelength", "550"]);
    assert_eq!(rows(&out)[0][8..], ["1", "0"]);
    assert!(out.ends_with("discrete: wo = 130,0  wi = 130,180  550 nm  radiance ratio 1\n"), "{out}");
}

#[test]
fn json_carries_the_same_numbers_with_their_units() {
    let desk = Bench::new();
    let report = desk.json("paint", &["--wo", "30,0", "--wi", "60,180", "--wavelength", "450,550"]);
    for (quantity, unit) in [("f", "1/sr"), ("pdf", "1/sr"), ("s", "1/sr"), ("wavelength", "nm")] {
        assert_eq!(report["units"][quantity], unit);
    }
    assert_eq!((&report["material"], &report["mode"]), (&Value::from("paint"), &Value::from("radiance")));
    assert_eq!(report["estimated"], false);
    let pair = &report["results"][0];
    assert_eq!(pair["wi"], serde_json::json!([60.0, 180.0]));
    assert_eq!(pair["values"].as_array().unwrap().len(), 2);
    let value = &pair["values"][1];
    assert_eq!(value["wavelength"], 550.0);
    let near = |key: &str, expected: f64| (value[key].as_f64().unwrap() / expected - 1.0).abs() < 1e-6;
    assert!(near("f", 0.5 / std::f64::consts::PI) && near("s", 0.275_664_447_7), "{value}");
    assert!(value["f_half_width"].is_null() && value["discrete"] == serde_json::json!([]));
    let glass = desk.json("glass", &["--wo", "0,0", "--wi", "0,0", "--wavelength", "550"]);
    let discrete = glass["results"][0]["values"][0]["discrete"].as_array().unwrap();
    assert_eq!(discrete.len(), 2);
    assert!(discrete.iter().any(|d| d["side"] == "transmission" && d["wi"][0] == 180.0));
}

#[test]
fn estimates_say_so_with_their_uncertainty_and_are_repeatable() {
    let desk = Bench::new();
    let ask = ["--wo", "30,0", "--wi", "45,180", "--wavelength", "550", "--walks", "500"];
    let out = desk.bsdf("varnish", &ask);
    assert!(out.contains("# estimated: f and s are means of 500 random walks"), "{out}");
    assert!(out.lines().nth(2).unwrap().contains("± [1/sr]"), "{out}");
    let row = &rows(&out)[0];
    let [f, half_width] = [5, 6].map(|i| row[i].parse::<f64>().unwrap());
    assert!(f > 0.0 && half_width > 0.0 && half_width < f, "{row:?}");
    assert_eq!(desk.bsdf("varnish", &ask), out);
    let value = &desk.json("varnish", &ask)["results"][0]["values"][0];
    assert!((value["f_half_width"].as_f64().unwrap() / half_width - 1.0).abs() < 0.06, "{value}");
}

#[test]
fn textures_are_read_where_asked() {
    let desk = Bench::new();
    let albedo = |uv| {
        let out = desk.bsdf("tiles", &["--wo", "0,0", "--wi", "0,0", "-l", "550", "--uv", uv]);
        assert!(out.contains("# textured: at u = "), "{out}");
        rows(&out)[0][8].parse::<f64>().unwrap()
    };
    assert!((albedo("0.25,0.25") - 0.8).abs() < 0.01 && (albedo("0.75,0.25") - 0.2).abs() < 0.01);
}

#[test]
fn lists_of_directions_come_from_a_file_or_from_standard_input() {
    let desk = Bench::new();
    let list = "# wo, wi\n0 0 0 0\n30,0, 60,180\n";
    desk.0.put("directions.txt", list);
    let ask = ["--directions", "directions.txt", "--wavelength", "550"];
    let out = desk.bsdf("paint", &ask);
    assert_eq!(rows(&out).iter().map(|r| r[0].as_str()).collect::<Vec<_>>(), ["0", "30"]);
    let arguments = ["bsdf", "scene.pbrt", "--material", "paint", "--directions", "-", "--wavelength", "550"];
    assert_eq!(desk.run(&arguments, list), (0, out, String::new()));

    desk.0.put("directions.txt", "0 0 0 0\n0 0 oops 0\n");
    let ask = ["bsdf", "scene.pbrt", "--material", "paint", "--directions"];
    let with = |file| [&ask[..], &[file]].concat();
    desk.fails(&with("directions.txt"), "error: directions.txt:2:5: expected a number, found \"oops\"");
    desk.fails(&with("none.txt"), "error: cannot read none.txt: no such file");
    let (code, _, err) = desk.run(&with("-"), "1 2 3\n");
    assert!(code == 1 && err.starts_with("error: (standard input):1:6: expected 4 numbers"), "{err}");
}

#[test]
fn what_cannot_be_asked_is_said_with_what_can() {
    let desk = Bench::new();
    let names = r#"the scene's materials: "diffuse#0" "paint" "tiles" "glass" "gold" "varnish" "both""#;
    let directions = ["--wo", "0,0", "--wi", "0,0"];
    let ask = |more: &[&'static str]| [&["bsdf", "scene.pbrt"][..], more, &directions].concat();
    desk.fails(
        &ask(&["--material", "pain"]),
        &format!("error: the scene has no material \"pain\"; did you mean \"paint\"?\n{names}"),
    );
    desk.fails(&ask(&[]), &format!("error: choose a material with --material\n{names}"));
    desk.fails(
        &ask(&["--material", "both"]),
        "error: material \"both\" is a mix of \"paint\" and \"gold\": ask for one of these",
    );
    desk.fails(
        &ask(&["--material", "paint", "--wavelength", "550,905"]),
        "error: wavelength 905 nm: the data of material \"paint\" reach from 300 to 900 nm",
    );
    desk.refuses(&["bsdf", "scene.pbrt", "--wo", "0,0"], "--wi");
    desk.refuses(&["bsdf", "scene.pbrt", "--wo", "0", "--wi", "0,0"], "such as 30,180");
    desk.refuses(&["bsdf", "scene.pbrt", "--wo", "-5,0", "--wi", "0,0"], "between 0 and 180 degrees, not -5");
    desk.refuses(&["bsdf", "scene.pbrt", "--wavelength", "red"], "such as 550");
    desk.refuses(&["bsdf", "scene.pbrt", "--directions", "a", "--wo", "0,0"], "cannot be used with");
    let (code, _, err) = desk.run(&["bsdf", "-", "--directions", "-"], "");
    assert!(code == 1 && err.contains("standard input holds either"), "{err}");
}

/// Width, height and pixels of a picture of eight bits a channel.
fn decode(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width, info.height, pixels)
}

#[test]
fn plots_are_well_formed_and_name_their_quantities() {
    let desk = Bench::new();
    let arguments = ["plot", "scene.pbrt", "--material", "gold", "-o", "gold.svg", "-o", "gold.png"];
    let (code, out, err) = desk.run(&arguments, "");
    assert_eq!((code, out.as_str(), err.trim_end()), (0, "", "material \"gold\": gold.svg, gold.png"));
    let text = String::from_utf8(desk.0.read("gold.svg")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "svg");
    let texts: Vec<&str> = root.descendants().filter_map(|n| n.text()).collect();
    let has = |wanted: &str| texts.iter().any(|t| t.contains(wanted));
    for wanted in ["gold", "sr⁻¹", "wavelength λ [nm]", "angle of incidence", "550 nm", "Fresnel", "η", "k"]
    {
        assert!(has(wanted), "{wanted} in {texts:?}");
    }
    let size = |name: &str| root.attribute(name).unwrap().parse::<u32>().unwrap();
    let (width, height, pixels) = decode(&desk.0.read("gold.png"));
    assert_eq!((width, height), (2 * size("width"), 2 * size("height")));
    let dark = pixels.chunks_exact(3).filter(|p| p.iter().all(|c| *c < 100)).count();
    let white = pixels.chunks_exact(3).filter(|p| p.iter().all(|c| *c == 255)).count();
    assert!(dark > 2000 && white > pixels.len() / 3 / 2, "{dark} {white}");
    // Partial files do not stay behind.
    assert!(desk.0.files().iter().all(|n| !n.contains(".part")));
}

#[test]
fn every_kind_of_plot_is_drawn_for_what_scatters_in_every_way() {
    let desk = Bench::new();
    for (material, kind, wanted) in [
        ("glass", "lobes", "share of the power in discrete directions"),
        ("varnish", "lobes", "f |cos θo| [sr⁻¹]"),
        ("paint", "spectrum", "albedo over wavelength"),
        ("glass", "spectrum", "index of refraction"),
        ("glass", "fresnel", "Fresnel reflectance"),
        ("tiles", "albedo", "albedo over the angle"),
    ] {
        let arguments =
            ["plot", "scene.pbrt", "--material", material, "--kind", kind, "--walks", "50", "-o", "a.svg"];
        let (code, _, err) = desk.run(&arguments, "");
        assert_eq!(code, 0, "{err}");
        let text = String::from_utf8(desk.0.read("a.svg")).unwrap();
        roxmltree::Document::parse(&text).unwrap();
        assert!(text.contains(wanted), "{material} {kind}");
        assert!(!text.contains("NaN") && !text.contains("inf\""), "{material} {kind}");
    }
    let ask = |material: &'static str, file: &'static str| {
        ["plot", "scene.pbrt", "--material", material, "--kind", "fresnel", "-o", file]
    };
    desk.fails(&ask("paint", "b.svg"), "error: material \"paint\" has no single index of refraction");
    desk.fails(&ask("glass", "b.pdf"), "error: b.pdf: plots are written as .svg or .png");
    desk.fails(&ask("glass", "none/b.svg"), "error: none/b.svg: the folder none does not exist");
    desk.refuses(&["plot", "scene.pbrt", "--theta", "200"], "between 0 and 180 degrees");
    desk.refuses(&["plot", "scene.pbrt", "--sphere", "--kind", "lobes"], "cannot be used with");
}

#[test]
fn a_sphere_shows_the_scenes_own_material() {
    let desk = Bench::new();
    let mean = |material: &str| {
        let name = format!("{material}.png");
        let size = ["--resolution", "48x48", "--spp", "4", "--quiet"];
        let arguments = [&["plot", "scene.pbrt", "--material", material, "--sphere"][..], &size].concat();
        let (code, out, err) = desk.run(&arguments, "");
        assert_eq!((code, out.as_str(), err.as_str()), (0, "", ""));
        let (width, height, pixels) = decode(&desk.0.read(&name));
        assert_eq!((width, height), (48, 48));
        // The middle of the picture is the sphere.
        let inside = (18..30).flat_map(|y| (18..30).map(move |x| 48 * y + x));
        let mut sum = [0.0; 3];
        for i in inside {
            for (c, sum) in sum.iter_mut().enumerate() {
                *sum += f64::from(pixels[pixels.len() / (48 * 48) * i + c]) / 144.0;
            }
        }
        sum
    };
    let [paint, gold] = ["paint", "gold"].map(mean);
    assert!((paint[0] - paint[2]).abs() < 20.0 && paint[0] > 30.0, "{paint:?}");
    assert!(gold[0] > 1.3 * gold[2], "{gold:?}");
}
