//! Legacy shading against A (26)–(28) and (34)–(40), one ray at a time. Light is stated in absolute units.
#![allow(clippy::expect_used, clippy::panic, reason = "tests fail by panicking")]

mod support;

use std::f64::consts::PI;
use steradian::integrator::{ClassicShading, Integrator, Tally};
use steradian::math::{Point, Ray, Vec3};
use steradian::sampler::{Sampler, SamplerKind};
use steradian::scene::{IntegratorSettings, Overrides};
use steradian::spectrum::Wavelengths;
use support::{SMALL_FILM, assert_luminance, job, render_seeded};

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// A plane at z = 2, seen from the origin: its normal towards the viewer is −z.
const PLANE: &str = r#"AttributeBegin Translate 0 0 2 Shape "disk" "float radius" 50 AttributeEnd"#;
const NORMAL: V = [0.0, 0.0, -1.0];

/// Radiance [W·m⁻²·sr⁻¹·nm⁻¹] along a ray from the origin, at every wavelength of the path.
fn radiance(integrator: &str, world: &str, towards: V) -> f64 {
    let text = format!("{SMALL_FILM}\nIntegrator \"classic\" {integrator}\nWorldBegin\n{world}\n{PLANE}");
    let job = job(&text);
    let IntegratorSettings::Classic(settings) = &job.integrator else { panic!("not classic") };
    let shading = ClassicShading { ambient: settings.ambient.as_deref(), shadows: settings.shadows };
    let [x, y, z] = towards.map(|x| x as f32);
    let ray = Ray { o: Point::ORIGIN, d: Vec3::new(x, y, z), time: 0.0 };
    let mut sampler = Sampler::new(SamplerKind::Independent, 1, [8, 8], 0);
    sampler.start([0, 0], 0);
    let mut w = Wavelengths::sample_visible(0.3);
    let l = shading.radiance(&job.scene, ray, &mut w, &mut sampler, &mut Tally::default(), None);
    assert!(l.max() - l.min() <= 1e-6 * l.max(), "{l:?}");
    f64::from(l[0])
}

#[track_caller]
fn assert_close(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 1e-5 * expected, "{value}, expected {expected}");
}

fn point_light(at: V, intensity: f64) -> String {
    let [x, y, z] = at;
    format!(
        "LightSource \"point\" \"point3 from\" [ {x} {y} {z} ] \"spectrum I\" [ 300 {intensity} 900 {intensity} ]
         \"string unit\" \"intensity\"\n"
    )
}

/// Light of irradiance E from the direction `towards` it.
fn distant_light(towards: V, irradiance: f64) -> String {
    let [x, y, z] = towards;
    format!(
        "LightSource \"distant\" \"point3 from\" [ {x} {y} {z} ] \"point3 to\" [ 0 0 0 ]
         \"spectrum L\" [ 300 {irradiance} 900 {irradiance} ] \"string unit\" \"irradiance\"\n"
    )
}

fn diffuse(rho: f64) -> String {
    format!("Material \"diffuse\" \"spectrum reflectance\" [ 300 {rho} 900 {rho} ]\n")
}

fn phong(rd: f64, ra: f64, rs: f64, alpha: f64) -> String {
    format!(
        "Material \"phong\" \"spectrum diffuse\" [ 300 {rd} 900 {rd} ] \"spectrum ambient\" [ 300 {ra} 900 {ra} ]
         \"spectrum specular\" [ 300 {rs} 900 {rs} ] \"float exponent\" {alpha}\n"
    )
}

fn ambient(radiance: f64) -> String {
    format!("\"spectrum ambient\" [ 300 {radiance} 900 {radiance} ] \"string unit\" \"radiance\"")
}

/// A (26)–(28), (34): H = I (n·d)/r², L = Σj ρ₀ Hj with ρ₀ = ρ/π.
#[test]
fn lambertian_surfaces_under_point_lights_sum_their_irradiances() {
    let rho = 0.6;
    let lights: [(V, f64); 3] = [([1.0, 0.0, 0.0], 5.0), ([-1.0, 2.0, -1.0], 3.0), ([0.0, 0.0, 1.5], 0.25)];
    let p = [1.0, 0.5, 2.0];
    let mut expected = 0.0;
    for (at, intensity) in lights {
        let to = [at[0] - p[0], at[1] - p[1], at[2] - p[2]];
        expected += rho / PI * intensity * dot(NORMAL, unit(to)) / dot(to, to);
    }
    // One more from behind: max(0, s·n).
    let behind = point_light([0.0, 0.0, 5.0], 100.0);
    let world: String = lights.iter().map(|&(at, i)| point_light(at, i)).collect();
    assert_close(radiance("", &(world + &behind + &diffuse(rho)), p), expected);
}

/// A (35) with I = E/π.
#[test]
fn lambertian_surfaces_under_a_distant_light_follow_the_cosine() {
    for s in [[0.0, 0.0, -1.0], [3.0, 0.0, -1.0], [-1.0, 4.0, -0.1]] {
        let expected = 0.7 * (5.0 / PI) * dot(NORMAL, unit(s));
        for towards in [[0.0, 0.0, 1.0], [2.0, -1.0, 1.0]] {
            assert_close(radiance("", &(distant_light(s, 5.0) + &diffuse(0.7)), towards), expected);
            assert_close(
                radiance("", &(distant_light(s, 5.0) + &phong(0.7, 0.0, 0.0, 3.0)), towards),
                expected,
            );
        }
    }
    assert_eq!(radiance("", &(distant_light([0.0, 0.0, 1.0], 5.0) + &diffuse(0.7)), [0.0, 0.0, 1.0]), 0.0);
}

/// A (36): ra Ia, where ra is the albedo of a surface that states none.
#[test]
fn surroundings_light_every_surface_by_its_albedo() {
    let towards = [1.0, 0.0, 1.0];
    assert_close(radiance(&ambient(2.0), &phong(0.7, 0.3, 0.2, 5.0), towards), 0.6);
    assert_close(radiance(&ambient(2.0), &diffuse(0.7), towards), 1.4);
    let mirror = "Material \"perfectmirror\" \"spectrum reflectance\" [ 300 0.9 900 0.9 ]";
    assert_close(radiance(&ambient(2.0), mirror, towards), 1.8);
    let clear = "Material \"dielectric\" \"float eta\" 1.5";
    // Below the angle of total reflection: what passes into glass is as bright as what comes out of it.
    assert_close(radiance(&ambient(2.0), clear, [0.1, 0.0, 1.0]), 2.0);
    // The default: ra = rd.
    let plain = "Material \"phong\" \"spectrum diffuse\" [ 300 0.7 900 0.7 ]";
    assert_close(radiance(&ambient(2.0), plain, towards), 1.4);
    // 3 cd/m² of an even spectrum, 1/(683.002 · 106.857) W·m⁻²·sr⁻¹·nm⁻¹ each.
    let lit = radiance("\"spectrum ambient\" [ 300 1 900 1 ] \"float scale\" 3", &diffuse(0.5), towards);
    assert!((lit - 1.5 / (683.002 * 106.857)).abs() < 1e-4 * lit, "{lit}");
}

/// A (39), (40) with I = E/π: L = rd I (s·n) + ra Ia + rs I max(0, m·d)^α, m = 2(n·s)n − s.
#[test]
fn phong_surfaces_show_the_radiance_of_the_text() {
    let (rd, ra, rs, ia, irradiance) = (0.4, 0.3, 0.5, 0.2, 7.0);
    for alpha in [1.0, 12.0, 300.0] {
        for (s, towards) in [
            ([0.0, 0.0, -1.0], [0.2, 0.1, 1.0]),
            ([1.0, 0.3, -1.0], [1.1, 0.2, 1.0]),
            ([4.0, 0.0, -1.0], [3.0, 0.5, 1.0]),
            // A view on the light's own side: no highlight.
            ([4.0, 0.0, -1.0], [-4.0, 0.0, 1.0]),
        ] {
            let (s, d) = (unit(s), unit([-towards[0], -towards[1], -towards[2]]));
            let ns = dot(NORMAL, s);
            let m = [0, 1, 2].map(|i| 2.0 * ns * NORMAL[i] - s[i]);
            let i = irradiance / PI;
            let highlight = dot(m, d).max(0.0).powf(alpha);
            let expected = rd * i * ns.max(0.0) + ra * ia + rs * i * highlight;
            let world = distant_light(s, irradiance) + &phong(rd, ra, rs, alpha);
            let l = radiance(&ambient(ia), &world, towards);
            assert!((l - expected).abs() < 1e-5 * alpha.max(10.0) / 10.0 * expected, "{l} {expected}");
        }
    }
}

#[test]
fn surfaces_cast_shadows_only_when_asked() {
    let screen = "AttributeBegin Translate 3 0 0 Rotate 90 0 1 0 Shape \"disk\" AttributeEnd\n";
    let world = diffuse(0.5) + &point_light([6.0, 0.0, -2.0], 10.0) + screen;
    let towards = [0.0, 0.0, 1.0];
    let lit = radiance("", &world, towards);
    // r² = 36 + 16, cosθ = 4/√52.
    assert_close(lit, 0.5 / PI * 10.0 * 4.0 / 52.0_f64.powf(1.5));
    assert_eq!(radiance("\"bool shadows\" true", &world, towards), 0.0);
}

/// A Lambertian sphere under 1 lx from the viewer: L = ρ nz/π, of which the mean over the picture is 2/3 on π/4 of it.
#[test]
fn pictures_are_made_of_it_and_say_so() {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64 \"bool savefp16\" false
         PixelFilter \"box\"
         Camera \"orthographic\" \"float screenwindow\" [ -1 1 -1 1 ]
         Sampler \"zsobol\" \"integer pixelsamples\" 16
         Integrator \"classic\"
         WorldBegin
         LightSource \"distant\" \"spectrum L\" [ 300 1 900 1 ]
         {} AttributeBegin Translate 0 0 3 Shape \"sphere\" AttributeEnd",
        diffuse(0.6)
    );
    assert_luminance(&text, 0.6 / 6.0, 0.002);
    let frame = render_seeded(&mut job(&text), 1);
    let name = "classic (legacy shading, not light transport)";
    assert_eq!(frame.attribute("renderer.integrator"), Some(name));
    assert_eq!(frame.attribute("renderer.maxDepth"), None);
}

#[test]
fn the_integrator_can_be_chosen_from_outside() {
    use std::path::Path;
    use steradian::scene::import::pbrt::{Input, import};
    use steradian::scene::{MemoryFiles, compile};
    let files = MemoryFiles::new();
    let classic = Overrides { integrator: Some("classic".to_owned()), ..Overrides::default() };
    let path = Overrides { integrator: Some("path".to_owned()), ..Overrides::default() };
    for (integrator, overrides, expected, has_ambient) in [
        ("path", &classic, "classic (legacy shading, not light transport)", false),
        (
            "classic\" \"rgb ambient\" [ 1 1 1 ] #",
            &classic,
            "classic (legacy shading, not light transport)",
            true,
        ),
        ("classic", &path, "path", false),
    ] {
        let text = format!("Integrator \"{integrator}\"\nWorldBegin LightSource \"point\"");
        let input = Input::Text { name: "test.pbrt", bytes: text.as_bytes(), base: Path::new("") };
        let mut imported = import(&[input], &files);
        let mut desc = imported.scene.expect("a description");
        overrides.apply(&mut desc).expect("known integrators");
        let job = compile(desc, &files, &mut imported.diagnostics).expect("a scene");
        assert_eq!(job.integrator.name(), expected);
        let ambient = matches!(&job.integrator, IntegratorSettings::Classic(c) if c.ambient.is_some());
        assert_eq!(ambient, has_ambient);
    }
}
