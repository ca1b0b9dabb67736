//! Kirchhoff's law: in an enclosure at one temperature the radiance is Planck's, whatever the walls are made of.
//!
//! Every surface emits what it does not reflect or transmit, ε(ω) = 1 − (ρ + τ) for light that arrives from ω. A
//! scattering function that is not reciprocal, forgets η² or whose albedo is wrong breaks the balance.
#![allow(clippy::expect_used, reason = "tests fail by panicking")]

mod support;

use steradian::bsdf::Mode;
use steradian::math::hash::Pcg32;
use steradian::math::{Dir, Point, Ray, Vec2, warp};
use steradian::scene::Scene;
use steradian::spectrum::{Blackbody, LANES, Wavelengths};
use steradian::units::Kelvin;

/// A box with one mirror-like and one rough wall of gold, that holds two balls of glass, one of them frosted, a
/// varnished ball and a ball of rough aluminium.
const ENCLOSURE: &str = r#"
WorldBegin
Material "diffuse" "spectrum reflectance" [ 300 0.3 900 0.8 ]
Shape "trianglemesh"
    "point3 P" [ -3 -3 -3  3 -3 -3  -3 3 -3  3 3 -3  -3 -3 3  3 -3 3  -3 3 3  3 3 3 ]
    "integer indices" [ 0 1 3 0 3 2  4 7 5 4 6 7  0 5 1 0 4 5  2 3 7 2 7 6 ]
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.4 "bool remaproughness" false
Shape "trianglemesh" "integer indices" [ 0 2 3 0 3 1 ]
    "point3 P" [ -3 -3 -3  -3 -3 3  -3 3 -3  -3 3 3 ]
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"
Shape "trianglemesh" "integer indices" [ 0 2 3 0 3 1 ]
    "point3 P" [ 3 -3 -3  3 -3 3  3 3 -3  3 3 3 ]
AttributeBegin
    Translate 1.2 0 1.2
    Material "dielectric" "float eta" 1.5
    Shape "sphere" "float radius" 0.9
AttributeEnd
AttributeBegin
    Translate -1.2 0 1.2
    Material "dielectric" "float eta" 1.5 "float roughness" 0.3 "bool remaproughness" false
    Shape "sphere" "float radius" 0.9
AttributeEnd
AttributeBegin
    Translate -1.2 0 -1.2
    Material "coateddiffuse" "spectrum reflectance" [ 300 0.2 900 0.9 ]
    Shape "sphere" "float radius" 0.9
AttributeEnd
AttributeBegin
    Translate 1.2 0 -1.2
    Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float roughness" 0.7 "bool remaproughness" false
    Shape "sphere" "float radius" 0.9
AttributeEnd
"#;

/// One estimate of the radiance from the far end of `ray` over that of a black body in vacuum, for a ray that starts in a
/// medium of the given index.
fn relative_radiance(
    scene: &Scene,
    mut ray: Ray,
    mut index: f32,
    w: &mut Wavelengths,
    seed: u64,
) -> [f64; LANES] {
    let mut rng = Pcg32::new(seed, 3);
    let mut sum = [0.0; LANES];
    let mut throughput = [1.0_f32; LANES];
    loop {
        let direction = Dir::new(ray.d).expect("rays have a direction");
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the enclosure is closed");
        let wo = -direction;
        let surface = scene.shade(&hit, wo, w, rng.next_u32().into()).expect("there are no mere boundaries");
        let mut sample = |mode| {
            let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
            surface.sample(wo, uc, u, mode)
        };
        // What light from there keeps: the mean of the weights is the albedo.
        let kept = (0..KEPT).filter_map(|_| sample(Mode::Importance)).fold([0.0; LANES], |mut sum, s| {
            sum.iter_mut().enumerate().for_each(|(lane, k)| *k += s.weight[lane] / KEPT as f32);
            sum
        });
        for lane in 0..LANES {
            sum[lane] += f64::from(throughput[lane] * (1.0 - kept[lane]) * index * index);
        }
        let Some(s) = sample(Mode::Radiance) else { return sum };
        index *= s.eta;
        let mut carried = 0.0_f32;
        for (lane, t) in throughput.iter_mut().enumerate() {
            *t *= s.weight[lane];
            // Radiance over η² is what is conserved.
            carried = carried.max(*t * index * index);
        }
        // What is emitted and what is carried on sum to one as they go: roulette late leaves little noise.
        if carried < 0.05 {
            if rng.next_f32() >= 0.5 {
                return sum;
            }
            throughput = throughput.map(|t| t / 0.5);
        }
        ray = hit.point.p.spawn(hit.point.ng, s.wi, 0.0);
    }
}

/// Samples that estimate what a surface keeps of the light from one direction.
const KEPT: usize = 4;

/// Student's t for 15 degrees of freedom at α = 0.001, two-sided.
const T_15: f64 = 4.0728;

fn assert_isothermal(from: Point, index: f32, expected_over_planck: f64) {
    let job = support::job(ENCLOSURE);
    let kelvin = 2856.0;
    let planck = Blackbody::absolute(Kelvin(kelvin));
    let (runs, paths) = (16_u64, 4_000_u64);
    let mut means = vec![[0.0; LANES]; runs as usize];
    for (run, mean) in means.iter_mut().enumerate() {
        let mut rng = Pcg32::new(run as u64, 1);
        for i in 0..paths {
            let mut w = Wavelengths::exactly([420.0, 530.0, 620.0, 700.0]);
            let d = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32()));
            let ray = Ray { o: from, d, time: 0.0 };
            let relative = relative_radiance(&job.scene, ray, index, &mut w, run as u64 * paths + i);
            for lane in 0..LANES {
                // [W·m⁻²·sr⁻¹·nm⁻¹]
                mean[lane] += relative[lane] * f64::from(planck.at(w.lambda()[lane])) / paths as f64;
            }
        }
    }
    let lambda = [420.0, 530.0, 620.0, 700.0];
    for lane in 0..LANES {
        let n = runs as f64;
        let mean = means.iter().map(|m| m[lane]).sum::<f64>() / n;
        let variance = means.iter().map(|m| (m[lane] - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let margin = T_15 * (variance / n).sqrt();
        let expected = expected_over_planck * f64::from(planck.at(lambda[lane]));
        assert!(margin < 0.005 * expected, "too noisy to detect 0.5 %: {margin} of {expected}");
        assert!(
            (mean - expected).abs() < margin + 1e-3 * expected,
            "{} nm: {mean} ± {margin} W·m⁻²·sr⁻¹·nm⁻¹, expected {expected}",
            lambda[lane]
        );
    }
}

#[test]
fn radiance_in_the_vacuum_of_an_isothermal_enclosure_is_planck_s() {
    assert_isothermal(Point::new(0.0, 0.0, 0.0), 1.0, 1.0);
}

#[test]
fn radiance_in_the_glass_of_an_isothermal_enclosure_is_eta_squared_as_large() {
    assert_isothermal(Point::new(1.1, 0.1, 1.3), 1.5, 2.25);
}
