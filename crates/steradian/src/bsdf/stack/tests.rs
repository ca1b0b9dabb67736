use super::*;
use crate::bsdf::conformance::albedo;
use crate::bsdf::{Bsdf, Coat, Diffuse, Layered, VarnishedDiffuse};

fn layer(eta: f32, thickness: f32, absorption: f32) -> Layer {
    Layer { thickness, eta: Spectrum::Constant(eta), absorption: Spectrum::Constant(absorption) }
}

fn rough(alpha: f32) -> TrowbridgeReitz {
    TrowbridgeReitz::new(alpha, alpha)
}

fn transparent(layers: Vec<Layer>, alphas: &[f32]) -> Layers {
    let alphas: Vec<_> = alphas.iter().map(|&a| rough(a)).collect();
    Layers::new(layers, &alphas, LastBoundary::Interface).unwrap()
}

fn stack(layers: &Layers, below: Below) -> Stack<'_> {
    Stack::new(layers, below, [550.0; LANES], 1)
}

const AIR: Below = Below::Medium(Sampled::ONE);

fn at(degrees: f32) -> LocalDir {
    LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.3))
}

fn shares(layers: &Layers, below: Below, degrees: f32) -> (f32, f32) {
    let a = stack(layers, below).albedo(at(degrees)).unwrap();
    (a.reflectance[0], a.transmittance[0])
}

#[test]
fn slabs_reproduce_the_checked_values() {
    for (eta, depth, degrees, r, t) in [
        (1.5, 0.0, 0.0, 0.076_923_1, 0.923_076_9),
        (1.5, 0.0, 45.0, 0.092_656, 0.907_344),
        (1.5, 0.0, 60.0, 0.151_872, 0.848_128),
        (1.5, 0.0, 75.0, 0.381_851, 0.618_149),
        (1.5, 0.1, 0.0, 0.070_221, 0.834_992),
        (1.5, 0.1, 60.0, 0.137_917, 0.748_214),
        (1.52, 0.0, 0.0, 1.0 - 0.918_318, 0.918_318),
        (1.52, 0.0, 60.0, 1.0 - 0.843_471, 0.843_471),
    ] {
        // A depth of 0.1 as 2 mm of 50 /m.
        let slab = transparent(vec![layer(eta, 2e-3, depth / 2e-3)], &[]);
        for degrees in [degrees, 180.0 - degrees] {
            let found = shares(&slab, AIR, degrees);
            assert!(
                (found.0 - r).abs() < 8e-7 && (found.1 - t).abs() < 8e-7,
                "{eta} {depth} {degrees}: {found:?} {r} {t}"
            );
        }
    }
}

#[test]
fn absorptance_is_what_neither_reflectance_nor_transmittance_has() {
    let slab = transparent(vec![layer(1.5, 1.0, 0.1)], &[]);
    for (degrees, a) in [(0.0, 0.094_787), (60.0, 0.113_869)] {
        let (r, t) = shares(&slab, AIR, degrees);
        assert!((1.0 - r - t - a).abs() < 8e-7, "{degrees}: {r} {t}");
    }
}

#[test]
fn piles_of_plates_follow_stokes() {
    // m clear plates between air: T = (1 − r)/(1 + (2m − 1) r) per polarisation.
    for m in [1_u16, 2, 5, 32] {
        let mut plates = Vec::new();
        for _ in 0..m {
            plates.push(layer(1.5, 1.0, 0.0));
            plates.push(layer(1.0, 1.0, 0.0));
        }
        let layers = transparent(plates, &[]);
        for degrees in [0.0, 30.0, 56.309_93, 80.0] {
            let f = crate::optics::fresnel::dielectric_polarized(at(degrees).z, 1.5);
            let through = |r: f32| (1.0 - r) / (1.0 + (2.0 * f32::from(m) - 1.0) * r);
            let expected = 0.5 * (through(f.s) + through(f.p));
            let (r, t) = shares(&layers, AIR, degrees);
            assert!(
                (t - expected).abs() < 3e-6 && (r + t - 1.0).abs() < 3e-6,
                "{m} {degrees}: {r} {t} {expected}"
            );
        }
    }
}

#[test]
fn layers_of_one_index_absorb_as_their_sum() {
    let split = transparent((0..MAX_LAYERS).map(|k| layer(1.4, 0.01, k as f32 * 0.1)).collect(), &[]);
    let total: f32 = (0..MAX_LAYERS).map(|k| k as f32 * 1e-3).sum();
    let whole = transparent(vec![layer(1.4, 1.0, total)], &[]);
    for degrees in [0.0, 50.0, 85.0] {
        let (a, b) = (shares(&split, AIR, degrees), shares(&whole, AIR, degrees));
        assert!((a.0 - b.0).abs() < 2e-6 && (a.1 - b.1).abs() < 2e-6, "{degrees}: {a:?} {b:?}");
    }
}

#[test]
fn both_ways_along_a_ray_transmit_alike_and_reflect_differently() {
    let layers = transparent(vec![layer(1.5, 1.0, 0.3), layer(1.8, 1.0, 0.0)], &[]);
    let below = Below::Medium(Sampled::splat(1.33));
    for degrees in [10.0_f32, 50.0, 80.0] {
        let inside = (degrees.to_radians().sin() / 1.33).asin().to_degrees();
        let (there, back) = (shares(&layers, below, degrees), shares(&layers, below, 180.0 - inside));
        assert!((there.1 - back.1).abs() < 2e-6, "{degrees}: {there:?} {back:?}");
        assert!((there.0 - back.0).abs() > 1e-3, "{degrees}: {there:?} {back:?}");
    }
    // Beyond the critical angle of 48.75° nothing leaves to the top, and what the layers absorbed is gone.
    let (r, t) = shares(&layers, below, 180.0 - 60.0);
    assert!(t == 0.0 && r < 0.6 && r > 0.3, "{r} {t}");
}

#[test]
fn metal_under_clear_layers_reflects_as_a_two_beam_sum() {
    // One interface r01, metal r12, per polarisation: R = r01 + (1 − r01)² r12 t² / (1 − r01 r12 t²).
    let layers = transparent(vec![layer(1.5, 1.0, 0.2)], &[]);
    let metal = Below::Conductor { eta: Sampled::splat(0.3), k: Sampled::splat(3.0) };
    for degrees in [0.0_f32, 45.0, 80.0] {
        let cos = degrees.to_radians().cos();
        let inside = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
        let (a, b) = (
            crate::optics::fresnel::dielectric_polarized(cos, 1.5),
            crate::optics::fresnel::conductor_polarized(inside, 0.2, 2.0),
        );
        let t2 = (-0.4 / inside).exp();
        let sum = |a: f32, b: f32| a + (1.0 - a).powi(2) * b * t2 / (1.0 - a * b * t2);
        let expected = 0.5 * (sum(a.s, b.s) + sum(a.p, b.p));
        for degrees in [degrees, 180.0 - degrees] {
            let (r, t) = shares(&layers, metal, degrees);
            assert!((r - expected).abs() < 2e-6 && t == 0.0, "{degrees}: {r} {expected}");
        }
    }
}

#[test]
fn one_layer_over_a_lambertian_base_is_the_varnish() {
    let reflectance = Sampled::from_array([0.1, 0.6, 0.9, 1.0]);
    for (eta, depth) in [(1.5_f32, 0.01_f32), (1.33, 0.5), (0.8, 0.1)] {
        let layers = Layers::new(vec![layer(eta, depth, 1.0)], &[], LastBoundary::Lambertian).unwrap();
        let stack = Stack::new(&layers, Below::Diffuse(reflectance), [550.0; LANES], 1);
        let coat = Coat { thickness: depth, max_depth: 10_000, ..Coat::clear(eta, TrowbridgeReitz::SMOOTH) };
        let varnish =
            VarnishedDiffuse::new(Layered { coat, base: Diffuse { reflectance }, seed: 0 }).unwrap();
        for (a, b) in [(20.0, 70.0), (0.0, 45.0), (120.0, 160.0), (30.0, 150.0)] {
            let (f, g) = (stack.eval(at(a), at(b), Mode::Radiance), varnish.eval(at(a), at(b)));
            for lane in 0..LANES {
                assert!((f[lane] - g[lane]).abs() <= 1e-3 * g[lane], "{eta} {depth} {a} {b}: {f:?} {g:?}");
            }
        }
    }
}

#[test]
fn light_returned_to_a_base_is_what_dense_quadrature_says() {
    // Indices that total-reflect at three angles.
    let media = vec![layer(1.3, 1.0, 0.1), layer(1.1, 1.0, 0.0), layer(1.7, 1.0, 0.05)];
    let layers = Layers::new(media, &[], LastBoundary::Lambertian).unwrap();
    let k = stack(&layers, Below::Diffuse(Sampled::ONE)).returned[0];
    // The layers above the last, seen from a medium like it.
    let whole = transparent(vec![layer(1.3, 1.0, 0.1), layer(1.1, 1.0, 0.0)], &[]);
    let below = Below::Medium(Sampled::splat(1.7));
    let n = 100_000;
    let dense: f64 = (0..n)
        .map(|i| {
            let mu = (i as f32 + 0.5) / n as f32;
            let w = LocalDir::new_unchecked(Vec3::new((1.0 - mu * mu).sqrt(), 0.0, -mu));
            let r = f64::from(stack(&whole, below).albedo(w).unwrap().reflectance[0]);
            2.0 * f64::from(mu) * r * (-0.1 / f64::from(mu)).exp() / f64::from(n)
        })
        .sum();
    assert!((f64::from(k) - dense).abs() < 2e-5, "{k} {dense}");
}

/// Mean and standard error of f over random walks, of the mean over the lanes.
fn mean_of_walks(f: impl Fn(u64) -> f32, n: u64) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for seed in 0..n {
        let x = f64::from(f(seed));
        sum += x;
        squares += x * x;
    }
    let mean = sum / n as f64;
    (mean, ((squares / n as f64 - mean * mean).max(0.0) / n as f64).sqrt())
}

#[test]
fn one_rough_layer_scatters_like_a_coat() {
    // The walks of another file, with other connections: the same integral.
    let reflectance = Sampled::splat(0.8);
    for alpha in [0.1_f32, 0.5] {
        let layers =
            Layers::new(vec![layer(1.5, 0.2, 1.0)], &[rough(alpha)], LastBoundary::Lambertian).unwrap();
        let coat = Coat { thickness: 0.2, max_depth: 1000, ..Coat::clear(1.5, rough(alpha)) };
        for (wo, wi) in [(at(20.0), at(60.0)), (at(70.0), at(50.0)), (at(150.0), at(120.0))] {
            let stack = |seed| Stack::new(&layers, Below::Diffuse(reflectance), [550.0; LANES], seed);
            let coated = |seed| Layered { coat, base: Diffuse { reflectance }, seed };
            let (a, ea) = mean_of_walks(|s| stack(s).eval(wo, wi, Mode::Radiance)[0], 20_000);
            let (b, eb) = mean_of_walks(|s| coated(s).eval(wo, wi, Mode::Radiance)[0], 20_000);
            assert!((a - b).abs() < 4.4 * ea.hypot(eb), "{alpha}: {a} ± {ea}, {b} ± {eb}");
        }
    }
}

#[test]
fn splitting_a_layer_leaves_what_the_stack_scatters() {
    // An inner boundary without contrast, however rough, is none.
    let one = transparent(vec![layer(1.5, 0.3, 1.0)], &[0.3, 0.2]);
    let two = transparent(vec![layer(1.5, 0.1, 1.0), layer(1.5, 0.2, 1.0)], &[0.3, 0.6, 0.2]);
    for (wo, wi) in
        [(at(20.0), at(60.0)), (at(30.0), -at(40.0)), (at(160.0), at(120.0)), (at(130.0), -at(140.0))]
    {
        for mode in [Mode::Radiance, Mode::Importance] {
            let f =
                |layers: &Layers, seed| Stack::new(layers, AIR, [550.0; LANES], seed).eval(wo, wi, mode)[0];
            let (a, ea) = mean_of_walks(|s| f(&one, s), 10_000);
            let (b, eb) = mean_of_walks(|s| f(&two, s + 1_000_000), 10_000);
            assert!(
                (a - b).abs() < 4.4 * ea.hypot(eb) && ea < 0.05 * a,
                "{wo:?} {wi:?}: {a} ± {ea}, {b} ± {eb}"
            );
        }
    }
}

#[test]
fn nearly_smooth_stack_transmits_what_unpolarised_faces_do() {
    // α = 0.002: directions as of a smooth pane, but a walk that forgets polarisation, T = (1 − r)/(1 + r) without absorption.
    let layers = transparent(vec![layer(1.5, 1.0, 0.0)], &[0.002]);
    let bsdf = Bsdf::Stack(stack(&layers, AIR));
    let r = f64::from(crate::optics::fresnel::dielectric(at(60.0).z, 1.5));
    let mut rng = Pcg32::new(4, 4);
    let n = 40_000;
    let mut through = 0.0;
    for _ in 0..n {
        let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
        let s = bsdf.sample(at(60.0), uc, u, Mode::Importance);
        through +=
            s.filter(|s| s.side == Side::Transmission).map_or(0.0, |s| f64::from(s.weight[0])) / f64::from(n);
    }
    let expected = (1.0 - r) / (1.0 + r);
    assert!((expected - 0.8362).abs() < 1e-4, "{expected}");
    assert!(
        (through - expected).abs() < 4.4 * (expected * (1.0 - expected) / f64::from(n)).sqrt() + 1e-3,
        "{through} {expected}"
    );
}

#[test]
fn deepest_rough_stack_keeps_its_light() {
    // 64 boundaries with little contrast, α = 0.05: masking loses next to nothing, and the walk must not lose more.
    let layers = transparent(
        (0..MAX_LAYERS).map(|k| layer(if k % 2 == 0 { 1.2 } else { 1.1 }, 1.0, 0.0)).collect(),
        &[0.05],
    );
    let a = albedo(&Bsdf::Stack(stack(&layers, AIR)), at(20.0), 2000, 3);
    assert!(a.value <= 1.0 + 1e-5 && a.value > 0.97, "{a:?}");
}

#[test]
fn colours_of_layers_reach_their_wavelengths() {
    let red = crate::spectrum::Tabulated::new(&[(400.0, 5.0), (700.0, 0.0)]).unwrap();
    let layers = transparent(
        vec![Layer { thickness: 1.0, eta: Spectrum::Constant(1.0), absorption: Spectrum::Tabulated(red) }],
        &[],
    );
    let stack = Stack::new(&layers, AIR, [400.0, 520.0, 640.0, 700.0], 1);
    let t = stack.albedo(at(60.0)).unwrap().transmittance;
    for (lane, a) in [5.0_f32, 3.0, 1.0, 0.0].into_iter().enumerate() {
        assert!((t[lane] - (-2.0 * a).exp()).abs() < 2e-6, "{lane}: {t:?}");
    }
}

#[test]
fn dispersive_layers_mirror_every_wavelength_with_its_own_index() {
    let eta = crate::spectrum::Tabulated::new(&[(400.0, 1.6), (700.0, 1.5)]).unwrap();
    let layers = transparent(
        vec![Layer { thickness: 1.0, eta: Spectrum::Tabulated(eta), absorption: Spectrum::Constant(0.0) }],
        &[],
    );
    let stack = Stack::new(&layers, AIR, [400.0, 500.0, 600.0, 700.0], 1);
    let r = stack.albedo(at(0.0)).unwrap().reflectance;
    for (lane, n) in [1.6_f32, 1.566_666_7, 1.533_333_3, 1.5].into_iter().enumerate() {
        let one = ((n - 1.0) / (n + 1.0)).powi(2);
        assert!((r[lane] - 2.0 * one / (1.0 + one)).abs() < 1e-6, "{lane}: {r:?}");
    }
}

#[test]
fn layers_that_are_no_stack_are_refused() {
    let new = |layers, alphas: &[TrowbridgeReitz], last| Layers::new(layers, alphas, last).unwrap_err();
    let one = || layer(1.5, 1.0, 0.0);
    assert_eq!(new(vec![], &[], LastBoundary::Interface), LayersError::Empty);
    assert_eq!(new(vec![one(); 65], &[], LastBoundary::Interface), LayersError::TooMany(65));
    let thin = new(vec![one(), layer(1.5, -1.0, 0.0)], &[], LastBoundary::Interface);
    assert_eq!(thin, LayersError::Thickness { layer: 2, thickness: -1.0 });
    let alphas = [rough(0.1), rough(0.2)];
    let found = |last| new(vec![one(); 3], &alphas, last);
    assert_eq!(found(LastBoundary::Interface), LayersError::Roughness { layers: 3, boundaries: 4, found: 2 });
    assert_eq!(
        found(LastBoundary::Lambertian),
        LayersError::Roughness { layers: 3, boundaries: 3, found: 2 }
    );
}
