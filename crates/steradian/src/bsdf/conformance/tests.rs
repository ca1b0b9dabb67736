use super::scatterer::draw;
use super::statistics::Moments;
use super::*;
use crate::bsdf::specimen::Reciprocity;
use crate::bsdf::{Bsdf, Cabinet, Claims, Coat, Conductor, Dielectric, Diffuse, ExitWeights, Layered, Side};
use crate::math::hash::Pcg32;
use crate::math::{Vec2, Vec3};
use crate::optics::{TrowbridgeReitz, fresnel};
use crate::spectrum::Sampled;
use rayon::prelude::*;

fn at(degrees: f32) -> LocalDir {
    LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.3))
}

fn rough(alpha: f32) -> TrowbridgeReitz {
    TrowbridgeReitz::new(alpha, alpha)
}

/// What contradicts the claims, for messages.
fn contradictions<B: Scatterer>(specimen: &Specimen<B>, effort: &Effort) -> Vec<String> {
    let examination = examine(specimen, effort);
    examination.contradictions().map(|f| format!("{}: {f}\n", specimen.name)).collect()
}

#[test]
fn every_specimen_obeys_every_law_it_claims() {
    let cabinet = Cabinet::default();
    let specimens = Bsdf::specimens(&cabinet);
    let effort = Effort::QUICK.among(specimens.len());
    let report: String =
        specimens.into_par_iter().flat_map_iter(|specimen| contradictions(&specimen, &effort)).collect();
    assert!(report.is_empty(), "\n{report}");
}

#[test]
fn no_specimen_claims_what_its_function_does_not() {
    for Specimen { name, bsdf, claims } in Bsdf::specimens(&Cabinet::default()) {
        let of_function = bsdf.claims();
        assert_eq!(
            (claims.reciprocity, claims.values),
            (of_function.reciprocity, of_function.values),
            "{name}"
        );
        // A specimen may know that it loses nothing where parameters in general do not tell.
        let unbounded = |c: Claims| c.energy == Energy::Unbounded;
        assert_eq!(unbounded(claims), unbounded(of_function), "{name}");
    }
}

#[test]
fn values_and_densities_at_once_are_those_one_by_one() {
    let mut rng = Pcg32::new(4, 4);
    for Specimen { name, bsdf, .. } in Bsdf::specimens(&Cabinet::default()) {
        for _ in 0..50 {
            let mut dir = || {
                let u = Vec2::new(rng.next_f32(), rng.next_f32());
                LocalDir::new_unchecked(warp::uniform_sphere(u))
            };
            let (wo, wi) = (dir(), dir());
            for mode in [Mode::Radiance, Mode::Importance] {
                let both = bsdf.evaluate(wo, wi, mode);
                let f = bsdf.eval(wo, wi, mode);
                let near = |a: f32, b: f32| (a - b).abs() <= 1e-5 * b.abs();
                assert!((0..crate::spectrum::LANES).all(|i| near(both.f[i], f[i])), "{name}: {both:?} {f:?}");
                assert!(near(both.pdf.0, bsdf.pdf(wo, wi, mode).0), "{name}: {both:?}");
            }
        }
    }
}

#[test]
fn false_claims_are_rejected() {
    let effort = Effort::QUICK;
    let rejects = |bsdf: Bsdf<'static>, claims, law| {
        let examination = examine(&Specimen::new("", claims, bsdf), &effort);
        assert!(examination.contradictions().any(|f| f.law == law), "{law:?} not found broken in {bsdf:?}");
    };
    let white = Diffuse { reflectance: Sampled::ONE };
    // 1 % absorbed, at one of the wavelengths.
    let grey = Diffuse { reflectance: Sampled::from_array([1.0, 1.0, 0.99, 1.0]) };
    rejects(Bsdf::Diffuse(grey), Claims::LOSSLESS, Law::Lossless);
    // 1 % too bright at one wavelength: a reflectance above one.
    let bright = Diffuse { reflectance: Sampled::from_array([0.1, 0.2, 1.01, 0.3]) };
    rejects(Bsdf::Diffuse(bright), Claims::CLOSED_FORM, Law::Energy);
    // What obeys a law does not show it broken.
    let lawless = Claims::CLOSED_FORM.with_reciprocity(Reciprocity::Broken).with_energy(Energy::Unbounded);
    rejects(Bsdf::Diffuse(white), lawless, Law::Reciprocity);
    rejects(Bsdf::Diffuse(white), lawless, Law::Energy);
    // The approximate density of layers is not that of their samples.
    let layers = Layered { coat: Coat::clear(1.5, rough(0.3)), base: white, seed: 1 };
    rejects(Bsdf::CoatedDiffuse(layers), Claims::CLOSED_FORM, Law::SamplesFollowDensity);
    rejects(Bsdf::CoatedDiffuse(layers), Claims::CLOSED_FORM, Law::WeightIsRatio);
    // pbrt-v4's weights return more than light that entered.
    let coat = Coat { weights: ExitWeights::Pbrt4, ..layers.coat };
    rejects(Bsdf::CoatedDiffuse(Layered { coat, ..layers }), Claims::ESTIMATED, Law::AnswersAgree);
    // A microfacet metal without absorption loses light at roughness 0.5.
    let mirror = Conductor { eta: Sampled::ZERO, k: Sampled::splat(1e4), roughness: rough(0.5) };
    rejects(Bsdf::Conductor(mirror), Claims::LOSSLESS, Law::Lossless);
}

/// ρ + τ were masking and shadowing independent of each other, G = G1(wo) G1(wi): Mitsuba's choice. Ours is correlated.
fn albedo_with_separable_masking(bsdf: Bsdf<'static>, d: TrowbridgeReitz, wo: LocalDir) -> Estimate {
    let mut rng = Pcg32::new(2, 2);
    let mut m = Moments::default();
    for _ in 0..100_000 {
        let weight = draw(&bsdf, wo, Mode::Importance, &mut rng)
            .map_or(0.0, |s| s.weight[0] * d.g1(wo) * d.g1(s.wi) / d.g(wo, s.wi));
        m.add(f64::from(weight));
    }
    Estimate { value: m.mean(), error: m.error() }
}

#[test]
fn rough_metal_without_absorption_agrees_with_an_independent_renderer() {
    // Mitsuba 3.9.1, GGX without compensation, at 0°, 30°, 60°, 80°; its quadrature and sampling agree to 6e-4.
    let table = [
        (0.2, [0.9477, 0.9390, 0.8941, 0.8481]),
        (0.5, [0.6878, 0.6816, 0.6860, 0.7469]),
        (1.0, [0.3069, 0.3289, 0.4091, 0.5229]),
    ];
    for (alpha, expected) in table {
        // Reflectance of one at every angle: an infinite index.
        let mirror = Conductor { eta: Sampled::ZERO, k: Sampled::splat(1e6), roughness: rough(alpha) };
        for (degrees, expected) in [0.0, 30.0, 60.0, 80.0].into_iter().zip(expected) {
            let a = albedo_with_separable_masking(Bsdf::Conductor(mirror), rough(alpha), at(degrees));
            assert!((a.value - expected).abs() < 6e-4 + 4.0 * a.error, "{alpha} {degrees}: {a:?} {expected}");
        }
    }
}

#[test]
fn rough_glass_agrees_with_an_independent_renderer() {
    let table = [
        (0.2, [0.9950, 0.9924, 0.9720, 0.9129]),
        (0.5, [0.9679, 0.9540, 0.8823, 0.7525]),
        (1.0, [0.8927, 0.8479, 0.6716, 0.4590]),
    ];
    for (alpha, expected) in table {
        let glass = Dielectric { eta: 1.5, roughness: rough(alpha) };
        for (degrees, expected) in [0.0, 30.0, 60.0, 80.0].into_iter().zip(expected) {
            let a = albedo_with_separable_masking(Bsdf::Dielectric(glass), rough(alpha), at(degrees));
            assert!((a.value - expected).abs() < 6e-4 + 4.0 * a.error, "{alpha} {degrees}: {a:?} {expected}");
        }
    }
}

#[test]
fn regularised_interfaces_have_no_discrete_directions() {
    let mut rng = Pcg32::new(6, 1);
    for specimen in Bsdf::specimens(&Cabinet::default()) {
        let mut bsdf = specimen.bsdf;
        bsdf.regularize();
        let contrast =
            !matches!(bsdf, Bsdf::ThinDielectric(_) | Bsdf::Dielectric(Dielectric { eta: 1.0, .. }));
        for _ in 0..100 {
            let discrete =
                draw(&bsdf, at(30.0), Mode::Radiance, &mut rng).is_some_and(|s| s.density.is_delta());
            assert!(!(contrast && discrete), "{}", specimen.name);
        }
        assert_eq!(bsdf.lobes().is_continuous(), contrast, "{}", specimen.name);
    }
}

#[test]
fn smooth_glass_is_chosen_to_reflect_as_often_as_fresnel_says() {
    let glass = Bsdf::Dielectric(Dielectric { eta: 1.5, roughness: TrowbridgeReitz::SMOOTH });
    let mut rng = Pcg32::new(5, 1);
    let n = 100_000;
    for degrees in [0.0, 60.0, 80.0, 110.0, 145.0] {
        let wo = at(degrees);
        let mut reflected = 0;
        for _ in 0..n {
            let s = draw(&glass, wo, Mode::Radiance, &mut rng).unwrap();
            reflected += u32::from(s.side == Side::Reflection);
            let scale = if s.side == Side::Reflection { 1.0 } else { 1.0 / (s.eta * s.eta) };
            assert!((s.weight[0] - scale).abs() < 1e-5, "{degrees}: {s:?}");
        }
        let r = f64::from(fresnel::dielectric(wo.z, 1.5));
        let share = f64::from(reflected) / f64::from(n);
        let error = (r * (1.0 - r) / f64::from(n)).sqrt();
        assert!((share - r).abs() <= 4.0 * error, "{degrees}: {share} {r}");
    }
}

#[test]
fn radiance_through_a_slab_of_glass_is_that_of_power() {
    // (ηo/ηi)² into the glass and out again cancel: both modes transmit (1 − R)² along the straight path.
    let glass = Bsdf::Dielectric(Dielectric { eta: 1.5, roughness: TrowbridgeReitz::SMOOTH });
    for mode in [Mode::Radiance, Mode::Importance] {
        let into = glass.sample(at(40.0), 0.999, Vec2::splat(0.5), mode).unwrap();
        // The far face looks down: in its frame the ray arrives from below.
        let inside = LocalDir::new_unchecked(Vec3::new(-into.wi.x, -into.wi.y, into.wi.z));
        let out = glass.sample(inside, 0.999, Vec2::splat(0.5), mode).unwrap();
        assert!(
            (into.weight[0] * out.weight[0] - 1.0).abs() < 1e-5 && (into.eta * out.eta - 1.0).abs() < 1e-6
        );
        assert!((out.wi.z - at(40.0).z).abs() < 1e-5, "{:?}", out.wi);
    }
}

#[test]
fn thin_pane_transmits_what_a_slab_does_after_all_internal_reflections() {
    // R = 2r/(1 + r) for the reflectance r of each polarisation at both faces (Stokes 1862), by sines and tangents (Fresnel).
    let cabinet = Cabinet::default();
    let pane = Bsdf::specimens(&cabinet)
        .into_iter()
        .find(|s| matches!(s.bsdf, Bsdf::ThinDielectric(_)))
        .unwrap()
        .bsdf;
    for degrees in [0.0, 50.0, 80.0] {
        let expected = match f64::from(degrees).to_radians() {
            0.0 => 2.0 * 0.04 / 1.04,
            i => {
                let t = (i.sin() / 1.5).asin();
                let [s, p] = [(i - t).sin() / (i + t).sin(), (i - t).tan() / (i + t).tan()].map(|r| r * r);
                s / (1.0 + s) + p / (1.0 + p)
            }
        } as f32;
        let side = |uc| pane.sample(at(degrees), uc, Vec2::ZERO, Mode::Radiance).unwrap().side;
        assert_eq!(side(expected - 1e-5), Side::Reflection);
        assert_eq!(side(expected + 1e-5), Side::Transmission);
    }
}

#[test]
fn clear_layers_over_white_lose_nothing() {
    // Nothing absorbs and nothing is masked under a smooth coat: every photon comes back.
    let coat =
        Coat { thickness: f32::MIN_POSITIVE, max_depth: 1000, ..Coat::clear(1.5, TrowbridgeReitz::SMOOTH) };
    let layers = Layered { coat, base: Diffuse { reflectance: Sampled::ONE }, seed: 4 };
    for degrees in [0.0, 50.0, 80.0] {
        let a = albedo(&Bsdf::CoatedDiffuse(layers), at(degrees), 20_000, 3);
        assert!((a.value - 1.0).abs() < 1e-4 + 4.0 * a.error, "{degrees}: {a:?}");
    }
    // A lossless scattering medium between them changes directions, not the sum.
    let milky = Coat { thickness: 0.7, albedo: Sampled::ONE, g: 0.5, ..coat };
    for degrees in [0.0, 50.0, 80.0] {
        let a = albedo(&Bsdf::CoatedDiffuse(Layered { coat: milky, ..layers }), at(degrees), 20_000, 3);
        assert!((a.value - 1.0).abs() < 1e-4 + 4.0 * a.error, "{degrees}: {a:?}");
    }
}

#[test]
fn absorbing_layer_over_black_shows_its_surface_only() {
    let coat = Coat::clear(1.5, TrowbridgeReitz::SMOOTH);
    let layers = Layered { coat, base: Diffuse { reflectance: Sampled::ZERO }, seed: 4 };
    let a = albedo(&Bsdf::CoatedDiffuse(layers), at(60.0), 20_000, 3);
    let r = f64::from(fresnel::dielectric(at(60.0).z, 1.5));
    assert!((a.value - r).abs() < 4.0 * a.error, "{a:?} {r}");
}

#[test]
fn scattering_layer_over_black_matches_adding_doubling() {
    // Slab without interfaces (η = 1), black below: reflectance for normal and for diffuse incidence by an independent
    // adding–doubling code, the second slab also after van de Hulst 1980.
    let table = [
        (0.5_f32, 1.0_f32, 0.0, 0.099_12, 0.134_17),
        (0.9, 2.0, 0.75, 0.097_40, 0.191_09),
        (1.0, 5.0, 0.0, 0.738_72, 0.792_34),
    ];
    for (albedo_value, tau, g, normal, diffuse) in table {
        let coat = Coat {
            thickness: tau,
            albedo: Sampled::splat(albedo_value),
            g,
            max_depth: 1000,
            ..Coat::clear(1.0, TrowbridgeReitz::SMOOTH)
        };
        let layers = Layered { coat, base: Diffuse { reflectance: Sampled::ZERO }, seed: 4 };
        let bsdf = Bsdf::CoatedDiffuse(layers);
        let a = albedo(&bsdf, at(0.0), 60_000, 3);
        assert!((a.value - normal).abs() < 1e-4 + 4.0 * a.error, "{a:?} {normal}");
        let mut rng = Pcg32::new(8, 8);
        let mut m = Moments::default();
        for _ in 0..60_000 {
            let wi = warp::cosine_hemisphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            m.add(draw(&bsdf, wi, Mode::Importance, &mut rng).map_or(0.0, |s| f64::from(s.weight[0])));
        }
        assert!((m.mean() - diffuse).abs() < 1e-4 + 4.0 * m.error(), "{} {diffuse}", m.mean());
    }
}
