use super::*;
use crate::bsdf::albedo::Albedo;
use crate::math::hash::Pcg32;
use crate::optics::films::{self, Film};
use crate::spectrum::LANES;

fn at(degrees: f32) -> LocalDir {
    LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.3))
}

/// ρ + τ by `n` random samples, in the mean over the lanes, with its standard error.
fn power(b: &OpenPbr, wi: LocalDir, n: u32) -> (f64, f64) {
    let mut rng = Pcg32::new(3, 9);
    let (mut sum, mut square) = (0.0_f64, 0.0_f64);
    for _ in 0..n {
        let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
        let weight = b.sample(wi, uc, u, Mode::Importance).map_or(0.0, |s| f64::from(s.weight.mean()));
        sum += weight;
        square += weight * weight;
    }
    let n = f64::from(n);
    (sum / n, ((square / n - (sum / n).powi(2)).max(0.0) / n).sqrt())
}

#[test]
fn white_surfaces_return_nearly_all_light_whatever_lies_on_top() {
    let white = Slabs { base_color: Sampled::ONE, ..Slabs::default() };
    let coat = Slabs { coat_weight: 1.0, ..white };
    for (name, least, slabs) in [
        ("plastic", 0.985, white),
        ("smooth plastic", 0.985, Slabs { specular_roughness: 0.0, ..white }),
        ("rough plastic", 0.985, Slabs { specular_roughness: 1.0, ..white }),
        ("chalk", 0.97, Slabs { base_diffuse_roughness: 1.0, ..white }),
        ("dense plastic", 0.98, Slabs { specular_ior: 2.5, ..white }),
        ("varnished", 0.96, coat),
        ("rough varnish", 0.96, Slabs { coat_roughness: 0.6, ..coat }),
        ("varnish undarkened", 0.96, Slabs { coat_darkening: 0.0, ..coat }),
        ("fuzz", 0.95, Slabs { fuzz_weight: 1.0, ..white }),
        ("fuzz on coat", 0.93, Slabs { fuzz_weight: 1.0, fuzz_roughness: 1.0, ..coat }),
        ("metal 0.3", 0.985, Slabs { base_metalness: 1.0, ..white }),
        ("metal 1", 0.985, Slabs { base_metalness: 1.0, specular_roughness: 1.0, ..white }),
        // The coat passes the less inclined of two directions better, and the factor is that of the other one.
        ("coated metal", 0.90, Slabs { base_metalness: 1.0, ..coat }),
    ] {
        let b = OpenPbr::new(&slabs);
        for degrees in [0.0, 40.0, 70.0, 80.0] {
            let (power, error) = power(&b, at(degrees), 20_000);
            let (low, high) = (power + 3.0 * error, power - 3.0 * error);
            assert!(high <= 1.0 && low >= least, "{name} at {degrees}: {power} ± {error}");
        }
    }
}

#[test]
fn no_combination_of_slabs_gains_energy() {
    // One draw of every parameter per case, favouring the ends of its range.
    let mut rng = Pcg32::new(42, 1);
    for case in 0..60 {
        let mut number = || {
            let u = rng.next_f32();
            (1.6 * u - 0.3).clamp(0.0, 1.0)
        };
        let slabs = Slabs {
            base_color: Sampled::splat(1.0 - 0.2 * number()),
            base_diffuse_roughness: number(),
            base_metalness: number(),
            specular_weight: 2.0 * number(),
            specular_roughness: number(),
            specular_roughness_anisotropy: number(),
            specular_ior: 0.7 + 1.8 * number(),
            transmission_weight: number(),
            subsurface_weight: number(),
            subsurface_color: Sampled::ONE,
            subsurface_scatter_anisotropy: 2.0 * number() - 1.0,
            coat_weight: number(),
            coat_roughness: number(),
            coat_roughness_anisotropy: number(),
            coat_ior: 0.8 + 1.5 * number(),
            coat_darkening: number(),
            fuzz_weight: number(),
            fuzz_roughness: number(),
            thin_film_weight: number(),
            thin_film_thickness_nm: 1000.0 * number(),
            thin_film_ior: 1.0 + 1.5 * number(),
            geometry_opacity: 0.5 + 0.5 * number(),
            wall: if case % 3 == 0 { Wall::Thin } else { Wall::Solid },
            ..Slabs::default()
        };
        let b = OpenPbr::new(&slabs);
        for degrees in [10.0, 60.0, 83.0, 115.0, 150.0] {
            let (power, error) = power(&b, at(degrees), 3000);
            // 300 tests at 4 standard errors: a joint level of 1 %.
            assert!(power - 4.0 * error <= 1.0, "{case} at {degrees}: {power} ± {error} {slabs:?}");
        }
    }
}

#[test]
fn rough_diffuse_bases_use_no_more_of_the_spread_than_is_allowed() {
    // ∫ t f cosθ over the mean of t, for a rough white base under transmissions that fall as those of slabs do.
    for ior in [1.2_f32, 1.5, 2.5] {
        for coat in [0.0_f32, 1.0] {
            for roughness in [0.2_f32, 0.6, 1.0] {
                let slabs = Slabs {
                    base_color: Sampled::ONE,
                    base_diffuse_roughness: roughness,
                    specular_ior: ior,
                    specular_roughness: 0.1,
                    coat_weight: coat,
                    coat_roughness: 0.1,
                    ..Slabs::default()
                };
                let b = OpenPbr::new(&slabs);
                for degrees in [0.0_f32, 30.0, 60.0, 80.0, 88.0] {
                    let wo = at(degrees);
                    let n = 200;
                    let mut sum = 0.0_f64;
                    for i in 0..n * n {
                        let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                        let wi = warp::cosine_hemisphere(u);
                        let (o, i) = (b.above(wo), b.above(wi));
                        let f = b.diffuse_base(&o, &i, wo, wi, Sampled::ONE);
                        sum += f64::from(f[0] * std::f32::consts::PI / (o.fuzz * o.coat * o.gloss));
                    }
                    let returned = sum / f64::from(n * n);
                    assert!(returned <= 1.0, "{ior} {coat} {roughness} {degrees}: {returned}");
                }
            }
        }
    }
}

#[test]
fn defaults_are_those_of_the_specification() {
    let b = OpenPbr::new(&Slabs::default());
    // Widths r² = 0.09 of an interface with 4 % over a base of 80 %: the colour is what is not reflected, times 0.8.
    assert!((b.widths[0] - 0.09).abs() < 1e-6 && b.widths[0] == b.widths[1]);
    let a = Albedo::by_sampling(|uc, u| b.sample(LocalDir::Z, uc, u, Mode::Importance));
    assert!((a.reflectance[0] - (0.04 + 0.96 * 0.8)).abs() < 6e-3, "{a:?}");
    assert_eq!(a.transmittance, Sampled::ZERO);
}

#[test]
fn varnish_over_white_is_the_exact_series_of_reflections() {
    // Saunderson: F + (1 − F) ρ (1 − K)/(1 − ρ K) at 0° for a Lambertian base, K = 0.65087717 for 1.6; here
    // without a gloss of its own.
    let slabs = Slabs { coat_weight: 1.0, specular_weight: 0.0, ..Slabs::default() };
    let f = interface::reflectance(1.0, 1.6);
    for (darkening, k) in [(1.0, 0.650_877_17_f32), (0.0, 0.0)] {
        let b = OpenPbr::new(&Slabs { coat_darkening: darkening, ..slabs });
        let a = Albedo::by_sampling(|uc, u| b.sample(LocalDir::Z, uc, u, Mode::Importance));
        let expected = f + (1.0 - f) * 0.8 * (1.0 - k) / (1.0 - 0.8 * k);
        assert!((a.reflectance[0] - expected).abs() < 8e-3, "{darkening}: {a:?} {expected}");
    }
}

#[test]
fn mirror_under_a_mirror_sums_all_reflections() {
    // F + (1 − F)² R/(1 − R F) with R of Schlick's curve.
    let slabs = Slabs {
        base_metalness: 1.0,
        base_color: Sampled::splat(0.6),
        specular_roughness: 0.0,
        coat_weight: 1.0,
        ..Slabs::default()
    };
    let b = OpenPbr::new(&slabs);
    for degrees in [0.0_f32, 45.0, 70.0] {
        let mu = degrees.to_radians().cos();
        let f = interface::reflectance(mu, 1.6);
        let r = 0.6 + 0.4 * (1.0 - mu).powi(5);
        let expected = f + (1.0 - f).powi(2) * r / (1.0 - 0.6 * f);
        let a = Albedo::by_sampling(|uc, u| b.sample(at(degrees), uc, u, Mode::Importance));
        assert!((a.reflectance[0] - expected).abs() < 1.5e-2, "{degrees}: {a:?} {expected}");
    }
}

#[test]
fn coat_color_is_the_transmittance_of_both_passes_face_on() {
    let slabs = Slabs { coat_weight: 1.0, coat_darkening: 0.0, specular_weight: 0.0, ..Slabs::default() };
    let colour = Sampled::from_array([0.2, 0.5, 0.9, 1.0]);
    let (clear, tinted) = (OpenPbr::new(&slabs), OpenPbr::new(&Slabs { coat_color: colour, ..slabs }));
    let [o, i] = [at(5e-3), LocalDir::Z];
    let (f, g) = (clear.eval(o, i, Mode::Radiance), tinted.eval(o, i, Mode::Radiance));
    for lane in 0..LANES {
        assert!((g[lane] / f[lane] - colour[lane]).abs() < 1e-3, "{lane}");
    }
}

#[test]
fn holes_pass_light_straight_in_their_share() {
    let b = OpenPbr::new(&Slabs { geometry_opacity: 0.3, base_color: Sampled::ZERO, ..Slabs::default() });
    let a = Albedo::by_sampling(|uc, u| b.sample(at(30.0), uc, u, Mode::Importance));
    assert!((a.transmittance[0] - 0.7).abs() < 2e-3, "{a:?}");
    let s = b.sample(at(30.0), 0.999, Vec2::splat(0.5), Mode::Radiance).unwrap();
    assert!(s.density.is_delta() && (*s.wi + *at(30.0)).length() < 1e-6);
}

#[test]
fn paths_refract_by_the_base_whether_it_is_coated_or_not() {
    let glass = Slabs { transmission_weight: 1.0, specular_roughness: 0.0, ..Slabs::default() };
    for coat_weight in [0.0, 1.0] {
        let b = OpenPbr::new(&Slabs { coat_weight, ..glass });
        let s = b.sample(at(50.0), 0.999, Vec2::splat(0.5), Mode::Radiance).unwrap();
        let sine = (1.0 - s.wi.z * s.wi.z).sqrt();
        assert!((sine - 50.0_f32.to_radians().sin() / 1.5).abs() < 1e-5 && s.eta == 1.5, "{s:?}");
    }
}

#[test]
fn film_colours_glass_as_its_interference_does() {
    let slabs = Slabs {
        transmission_weight: 1.0,
        specular_roughness: 0.0,
        thin_film_weight: 1.0,
        thin_film_thickness_nm: 300.0,
        ..Slabs::default()
    };
    let b = OpenPbr::new(&slabs);
    let a = Albedo::by_sampling(|uc, u| b.sample(at(20.0), uc, u, Mode::Importance));
    let film = Film { eta: 1.4, thickness_nm: 300.0 };
    for lane in 0..LANES {
        let mu = at(20.0).z;
        let r = films::reflectance_dielectric(mu, film, 1.5, slabs.lambda_nm[lane]);
        assert!((a.reflectance[lane] - r).abs() < 1e-3, "{lane}: {a:?} {r}");
    }
}
