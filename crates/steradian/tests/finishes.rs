//! Finishes of metals and glass, from scene text to the scattering function.
#![allow(clippy::expect_used, reason = "tests fail by panicking")]

#[path = "support/errors.rs"]
mod errors;

use errors::expect;
use std::path::Path;
use steradian::bsdf::{Bsdf, Energy};
use steradian::lab::Subject;
use steradian::scene::RenderJob;
use steradian::scene::diagnostic::Diagnostics;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{MemoryFiles, compile};
use steradian::spectrum::Wavelengths;

fn job(material: &str) -> RenderJob {
    let text = format!("WorldBegin MakeNamedMaterial \"m\" {material}");
    let files = MemoryFiles::default();
    let input = Input::Text { name: "test", bytes: text.as_bytes(), base: Path::new("") };
    let imported = import(&[input], &files);
    let mut diagnostics: Diagnostics = imported.diagnostics;
    compile(imported.scene.expect("a scene"), &files, &mut diagnostics).expect("compiles")
}

fn with_scatterer<R>(material: &str, look: impl FnOnce(Bsdf<'_>) -> R) -> R {
    let job = job(material);
    let subject = Subject::find(&job, "m").expect("exists");
    let mut w = Wavelengths::exactly([450.0, 520.0, 580.0, 650.0]);
    look(subject.scatterer(&mut w, 0).expect("scatters"))
}

#[test]
fn plain_materials_scatter_as_they_always_did() {
    with_scatterer(r#""string type" "conductor" "float roughness" 0.3 "string distribution" "ggx""#, |b| {
        assert!(matches!(b, Bsdf::Conductor(_)));
    });
    with_scatterer(r#""string type" "dielectric" "bool multiscatter" false "float film.thickness" 0"#, |b| {
        assert!(matches!(b, Bsdf::Dielectric(_)));
    });
    // Nothing to compensate for.
    with_scatterer(r#""string type" "dielectric" "bool multiscatter" true"#, |b| {
        assert!(matches!(b, Bsdf::Dielectric(_)));
    });
}

#[test]
fn compensated_glass_claims_to_lose_nothing() {
    let lossless = Energy::Lossless { tolerance: 0.01 };
    for material in [
        r#""string type" "dielectric" "float roughness" 1 "bool multiscatter" true"#,
        r#""string type" "dielectric" "spectrum eta" "glass-F11" "float roughness" 0.3 "bool multiscatter" true"#,
        r#""string type" "dielectric" "float uroughness" 0.2 "float vroughness" 0.5 "bool multiscatter" true
           "string distribution" "beckmann" "bool remaproughness" false"#,
        r#""string type" "dielectric" "float roughness" 0.3 "bool multiscatter" true
           "float film.thickness" 400 "float film.eta" 1.8"#,
        r#""string type" "conductor" "spectrum eta" [ 300 0 900 0 ]
           "spectrum k" [ 300 10000 900 10000 ] "float roughness" 1 "bool multiscatter" true"#,
    ] {
        with_scatterer(material, |b| {
            assert!(matches!(b, Bsdf::FinishedDielectric(_) | Bsdf::FinishedConductor(_)), "{material}");
            assert_eq!(b.claims().energy, lossless, "{material}");
        });
    }
    // An absorbing metal does not.
    let gold = r#""string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"
        "float roughness" 0.3 "bool multiscatter" true "float film.thickness" 100"#;
    with_scatterer(gold, |b| assert_eq!(b.claims().energy, Energy::Passive));
}

#[test]
fn a_film_has_a_thickness() {
    expect(
        r#"WorldBegin
Material "conductor" "float film.eta" 1.5
"#,
        r#"
scene.pbrt:2:22: error: "film.eta" without "film.thickness": a film has both
 2 | Material "conductor" "float film.eta" 1.5
   |                      ^^^^^^^^^^^^^^^^
"#,
    );
}

#[test]
fn the_losses_under_a_film_need_its_thickness() {
    expect(
        r#"WorldBegin
Texture "t" "float" "checkerboard"
Material "dielectric" "float roughness" 0.3 "texture film.thickness" "t"
  "bool multiscatter" true
"#,
        r#"
scene.pbrt:4:3: error: "multiscatter" needs a film of the same "film.thickness" everywhere
 4 |   "bool multiscatter" true
   |   ^^^^^^^^^^^^^^^^^^^
"#,
    );
}
