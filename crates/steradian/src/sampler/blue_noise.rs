//! The spectrum of errors over the picture.

use super::{Randomization, Sampler, SamplerKind};
use std::f64::consts::TAU;

/// Side of the picture [px].
const SIDE: usize = 64;

/// Frequencies up to an eighth of the sampling rate along each axis, a quarter of what a picture can show.
const LOW: i32 = SIDE as i32 / 8;

/// Mean power of the low frequencies of a picture of errors, relative to white noise of the same variance.
fn low_power(errors: &[f64]) -> f64 {
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let variance = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n;
    let (mut power, mut count) = (0.0, 0.0);
    for ky in 0..=LOW {
        // The other half-plane holds the complex conjugates.
        for kx in if ky == 0 { 1..=LOW } else { -LOW..=LOW } {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, e) in errors.iter().enumerate() {
                let turns = f64::from(kx) * (i % SIDE) as f64 + f64::from(ky) * (i / SIDE) as f64;
                let (sin, cos) = (TAU * turns / SIDE as f64).sin_cos();
                re += (e - mean) * cos;
                im += (e - mean) * sin;
            }
            power += (re * re + im * im) / (n * variance);
            count += 1.0;
        }
    }
    power / count
}

/// Errors of estimates of the mean of (½ + x)(½ + y) over the pair that follows `skip` others.
fn errors(kind: SamplerKind, spp: u32, skip: u32) -> Vec<f64> {
    let mut s = Sampler::new(kind, spp, [SIDE as u32; 2], 7);
    let pixel = |i: usize| [(i % SIDE) as i32, (i / SIDE) as i32];
    let estimate = |i: usize| {
        let sum: f64 = (0..spp)
            .map(|index| {
                s.start(pixel(i), index);
                (0..skip).for_each(|_| {
                    s.next_2d();
                });
                let u = s.next_2d();
                (0.5 + f64::from(u.x)) * (0.5 + f64::from(u.y))
            })
            .sum();
        sum / f64::from(spp)
    };
    (0..SIDE * SIDE).map(estimate).collect()
}

#[test]
fn errors_of_z_ordered_points_are_blue_in_every_pair_of_dimensions() {
    for spp in [1, 2, 4] {
        for skip in [0, 3, 12] {
            let power = |kind| low_power(&errors(kind, spp, skip));
            // 144 frequencies of white noise, each exponential with mean 1: 1 ± 0.083, so 0.5 is six deviations off.
            let white = power(SamplerKind::Independent);
            assert!((0.5..1.5).contains(&white), "{spp} spp, pair {skip}: {white}");
            for randomization in [Randomization::FastOwen, Randomization::Owen] {
                let blue = power(SamplerKind::ZSobol(randomization));
                assert!(blue < 0.3, "{randomization:?}, {spp} spp, pair {skip}: {blue}");
            }
        }
    }
}
