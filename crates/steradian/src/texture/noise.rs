//! Gradient noise and the textures made of it.

use super::mapping::TexCoord3d;
use crate::math::Vec3;
use crate::math::float::{lerp, smoothstep};

/// Ken Perlin's permutation of 0…255 (Improving Noise, SIGGRAPH 2002), the published order.
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99,
    37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27,
    166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244,
    102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130,
    116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147,
    118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119,
    248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110,
    79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179,
    162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176,
    115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78,
    66, 215, 61, 156, 180,
];

/// Improved gradient noise (Perlin 2002): zero at lattice points, period 256, C² continuous, within ±1.04.
///
/// The gradient of hash 12 and 13 is taken as pbrt-v4 takes it, (±1, ±1, 0); Perlin gives the same vectors
/// to hash 12 and 14.
pub fn noise(p: Vec3) -> f32 {
    let cell = p.floor();
    let d = p - cell;
    // f32 has no fraction bits left long before the cast saturates.
    let [ix, iy, iz] = cell.to_array().map(|v| v as i32 & 255);
    let corner = |i: i32, j: i32, k: i32| {
        let hash = permute(permute(permute(ix + i) + iy + j) + iz + k);
        gradient(hash, d - Vec3::new(i as f32, j as f32, k as f32))
    };
    let [wx, wy, wz] = d.to_array().map(fade);
    let edge = |j, k| lerp(wx, corner(0, j, k), corner(1, j, k));
    let face = |k| lerp(wy, edge(0, k), edge(1, k));
    lerp(wz, face(0), face(1))
}

fn permute(i: i32) -> i32 {
    i32::from(PERMUTATION[(i & 255) as usize])
}

/// Dot product of the offset with one of twelve gradients: two of the three axes, either sign.
fn gradient(hash: i32, d: Vec3) -> f32 {
    let h = hash & 15;
    let flat = h == 12 || h == 13;
    let u = if h < 8 || flat { d.x } else { d.y };
    let v = if h < 4 || flat { d.y } else { d.z };
    let signed = |x: f32, negative: bool| if negative { -x } else { x };
    signed(u, h & 1 != 0) + signed(v, h & 2 != 0)
}

/// 6t⁵ − 15t⁴ + 10t³: first and second derivative vanish at both ends (Perlin 2002).
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// A sum of noises of rising frequency and falling amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octaves {
    /// Number of octaves at most; the footprint removes those that it cannot resolve.
    pub octaves: u32,
    /// Ratio of the amplitudes of successive octaves.
    pub roughness: f32,
}

/// Ratio of successive frequencies; not quite two, so that the lattice points do not coincide.
const LACUNARITY: f32 = 1.99;

/// Mean of |noise|, which stands for the octaves of turbulence that the footprint removes (pbrt-v4 book, 10.6.2).
const MEAN_ABS_NOISE: f32 = 0.2;

impl Octaves {
    /// Fractional Brownian motion: Σ roughnessⁱ · noise(1.99ⁱ p) (pbrt-v4 book, 10.6.2).
    pub fn fbm(self, c: &TexCoord3d) -> f32 {
        let (whole, partial) = self.resolved(c);
        let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
        for _ in 0..whole {
            sum += amplitude * noise(frequency * c.p);
            frequency *= LACUNARITY;
            amplitude *= self.roughness;
        }
        sum + amplitude * smoothstep(partial, 0.3, 0.7) * noise(frequency * c.p)
    }

    /// Turbulence: Σ roughnessⁱ · |noise(1.99ⁱ p)|; removed octaves count with their mean.
    pub fn turbulence(self, c: &TexCoord3d) -> f32 {
        let (whole, partial) = self.resolved(c);
        let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
        for _ in 0..whole {
            sum += amplitude * noise(frequency * c.p).abs();
            frequency *= LACUNARITY;
            amplitude *= self.roughness;
        }
        sum += amplitude * lerp(smoothstep(partial, 0.3, 0.7), MEAN_ABS_NOISE, noise(frequency * c.p).abs());
        for _ in whole..self.octaves {
            sum += amplitude * MEAN_ABS_NOISE;
            amplitude *= self.roughness;
        }
        sum
    }

    /// How many octaves have at least two pixels per period, and the fraction of the next.
    fn resolved(self, c: &TexCoord3d) -> (u32, f32) {
        let extent2 = c.dpdx.length_squared().max(c.dpdy.length_squared());
        let n = (-1.0 - 0.5 * extent2.log2()).clamp(0.0, self.octaves as f32);
        (n as u32, n.fract())
    }
}

/// The number-valued noise textures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKind {
    /// Fractional Brownian motion.
    Fbm(Octaves),
    /// Turbulence.
    Wrinkled(Octaves),
    /// Waves on water: their height, modulated by a slower wind.
    Windy,
}

impl NoiseKind {
    /// The value at a point of texture space.
    pub fn at(self, c: &TexCoord3d) -> f32 {
        match self {
            Self::Fbm(octaves) => octaves.fbm(c),
            Self::Wrinkled(octaves) => octaves.turbulence(c),
            Self::Windy => {
                let slow = TexCoord3d { p: 0.1 * c.p, dpdx: 0.1 * c.dpdx, dpdy: 0.1 * c.dpdy };
                let wind = Octaves { octaves: 3, roughness: 0.5 }.fbm(&slow);
                let waves = Octaves { octaves: 6, roughness: 0.5 }.fbm(c);
                wind.abs() * waves
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    fn random_points(n: usize) -> impl Iterator<Item = Vec3> {
        let mut rng = Pcg32::new(3, 5);
        (0..n).map(move |_| Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 512.0 - 256.0)
    }

    fn unfiltered(p: Vec3) -> TexCoord3d {
        TexCoord3d { p, dpdx: Vec3::ZERO, dpdy: Vec3::ZERO }
    }

    #[test]
    fn the_permutation_is_one() {
        let mut seen = [false; 256];
        PERMUTATION.iter().for_each(|&v| seen[usize::from(v)] = true);
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn noise_vanishes_on_the_lattice() {
        for p in random_points(1000) {
            assert_eq!(noise(p.floor()), 0.0, "{p}");
        }
    }

    #[test]
    fn noise_has_mean_zero_and_stays_within_its_bound() {
        let n = 200_000;
        let (mut sum, mut sum2) = (0.0_f64, 0.0_f64);
        for p in random_points(n) {
            let v = noise(p);
            assert!(v.abs() <= 1.04, "{v} at {p}");
            sum += f64::from(v);
            sum2 += f64::from(v * v);
        }
        let (mean, variance) = (sum / n as f64, sum2 / n as f64);
        // Opposite gradients occur equally often except for the two doubled pairs: |E| is below 4 standard errors.
        assert!(mean.abs() < 4.0 * (variance / n as f64).sqrt() + 1e-3, "{mean}");
        assert!(variance > 0.03, "{variance}");
    }

    #[test]
    fn noise_and_its_slope_are_continuous_across_cells() {
        for p in random_points(500) {
            let face = Vec3::new(p.x.floor(), p.y, p.z);
            let h = 1.0 / 256.0;
            let v = |s: f32| noise(face + Vec3::X * (s * h));
            assert!((v(1e-2) - v(-1e-2)).abs() < 3e-4, "{face}");
            // A C² function has one-sided slopes that agree to O(h).
            let (left, right) = ((v(0.0) - v(-1.0)) / h, (v(1.0) - v(0.0)) / h);
            assert!((left - right).abs() < 0.1, "{face}: {left} {right}");
        }
    }

    #[test]
    fn noise_repeats_every_256_cells_and_survives_any_distance() {
        for p in random_points(100) {
            let p = (p * 64.0).round() / 64.0;
            assert_eq!(noise(p), noise(p + Vec3::new(256.0, -256.0, 512.0)));
        }
        for p in [Vec3::splat(1e30), Vec3::new(-1e30, 3.5, f32::MAX)] {
            assert!(noise(p).abs() <= 1.04);
        }
    }

    #[test]
    fn the_first_octave_is_the_noise_itself() {
        let one = Octaves { octaves: 1, roughness: 0.5 };
        for p in random_points(100) {
            assert_eq!(one.fbm(&unfiltered(p)), noise(p));
            assert_eq!(one.turbulence(&unfiltered(p)), noise(p).abs() + 0.5 * MEAN_ABS_NOISE);
        }
    }

    #[test]
    fn a_wide_footprint_leaves_the_mean_only() {
        let c = TexCoord3d { p: Vec3::new(0.3, 0.6, 0.8), dpdx: Vec3::X * 100.0, dpdy: Vec3::ZERO };
        let octaves = Octaves { octaves: 8, roughness: 0.5 };
        assert_eq!(octaves.fbm(&c), 0.0);
        // 0.2 · (1 + Σ_{i<8} 2⁻ⁱ)
        let expected = 0.2 * (1.0 + (2.0 - 1.0 / 128.0));
        assert!((octaves.turbulence(&c) - expected).abs() < 1e-6, "{}", octaves.turbulence(&c));
    }

    #[test]
    fn the_removed_octaves_have_the_mean_that_stands_for_them() {
        let n = 100_000;
        let mean = random_points(n).map(|p| f64::from(noise(p).abs())).sum::<f64>() / n as f64;
        assert!((mean - f64::from(MEAN_ABS_NOISE)).abs() < 0.03, "{mean}");
    }
}
