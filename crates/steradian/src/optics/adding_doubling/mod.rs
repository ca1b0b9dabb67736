//! Light in a plane slab that scatters and absorbs: the whole of radiative transport, by adding and doubling layers
//! (van de Hulst 1963; with boundaries, Prahl, van Gemert & Welch 1993).
//!
//! The radiance is followed along a few dozen directions; what it loses and gains in a thin slice is known, and two equal layers
//! make one of twice the thickness, whose internal reflections sum up in closed form.

mod layer;
mod matrix;

use super::fresnel::dielectric_polarized;
use super::quadrature::{Node, gauss, radau};
use super::shares::Shares;
use layer::{Layer, Medium};
use matrix::Matrix;

/// A slab between plane boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Single-scattering albedo, in [0, 1].
    pub albedo: f64,
    /// Optical thickness (natural extinction along the normal), at least 0; may be infinite.
    pub depth: f64,
    /// Mean cosine of scattering in [−0.99, 0.99], after Henyey & Greenstein; 0 for isotropic scattering.
    pub anisotropy: f64,
    /// Index of the slab over that of its surroundings, from 1 to 10.
    pub eta: f64,
    /// What lies below.
    pub below: Below,
}

/// What lies below a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Below {
    /// The same medium as above, behind a smooth boundary.
    Surroundings,
    /// A Lambertian surface of this reflectance, in [0, 1], in optical contact: nothing passes it.
    Lambertian(f64),
}

/// What becomes of light on a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transport {
    /// Of a beam along the normal. Both shares contain the unscattered light, and ρ the first boundary's reflection.
    pub collimated: Shares,
    /// Of diffuse light.
    pub diffuse: Shares,
}

/// Why a slab makes no sense.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SlabError {
    /// The albedo is no share.
    #[error("a single-scattering albedo of {0} is not from 0 to 1")]
    Albedo(f64),
    /// The thickness is negative.
    #[error("an optical thickness of {0} is not from 0 up")]
    Depth(f64),
    /// The mean cosine cannot be, or its peak is too sharp to be resolved.
    #[error("a mean cosine of {0} is not from -0.99 to 0.99")]
    Anisotropy(f64),
    /// The index is out of range.
    #[error("a relative index of {0} is not from 1 to 10")]
    Eta(f64),
    /// The substrate reflects more than arrives.
    #[error("a reflectance of {0} below the slab is not from 0 to 1")]
    Below(f64),
}

/// Reflectance of the boundary beyond the critical angle: a clear slab would keep the light there for ever, which a matrix cannot
/// say.
const TRAPPED: f64 = 1.0 - 1e-13;

/// Directions within each part of the hemisphere, and moments of the phase function.
const DIRECTIONS: usize = 32;

impl Slab {
    /// Solves the transport of unpolarised light, to about 1e-6 without boundaries and 2e-5 within them; to some 1e-4 where
    /// the anisotropy is near its limits.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub fn solve(&self) -> Result<Transport, SlabError> {
        self.check()?;
        // In an infinite slab that absorbs nothing all light comes back, as no number of doublings would show.
        if self.depth.is_infinite() && self.albedo == 1.0 {
            return Ok(Transport { collimated: Shares::REFLECTED, diffuse: Shares::REFLECTED });
        }
        let directions = self.directions();
        let layer =
            Medium::new(self.albedo, self.anisotropy, &directions, DIRECTIONS).layer(self.depth, &directions);
        let faces = Faces::new(self.eta, &directions);
        let mut normal = vec![0.0; directions.len()];
        if let Some(last) = normal.last_mut() {
            *last = 1.0;
        }
        // dν ν = η² dμ μ, by Snell's law.
        let bundle = |(d, r): (&Node, &f64)| {
            if *r < TRAPPED { self.eta * self.eta * 2.0 * d.x * d.weight } else { 0.0 }
        };
        let uniform: Vec<f64> = directions.iter().zip(&faces.reflectance).map(bundle).collect();
        let body = Body::new(&layer, &directions, &faces, self.below);
        Ok(Transport { collimated: body.shares(&normal), diffuse: body.shares(&uniform) })
    }

    fn check(&self) -> Result<(), SlabError> {
        let Self { albedo, depth, anisotropy, eta, below } = *self;
        if !(0.0..=1.0).contains(&albedo) {
            return Err(SlabError::Albedo(albedo));
        }
        if !(depth >= 0.0) {
            return Err(SlabError::Depth(depth));
        }
        if !(-0.99..=0.99).contains(&anisotropy) {
            return Err(SlabError::Anisotropy(anisotropy));
        }
        if !(1.0..=10.0).contains(&eta) {
            return Err(SlabError::Eta(eta));
        }
        match below {
            Below::Lambertian(r) if !(0.0..=1.0).contains(&r) => Err(SlabError::Below(r)),
            _ => Ok(()),
        }
    }

    /// Cosines inside of the slab, up to the normal itself. Beyond the critical angle they have a rule of their own: the
    /// boundary's reflectance has a kink there.
    fn directions(&self) -> Vec<Node> {
        let critical = (1.0 - self.eta.powi(-2)).sqrt();
        let mut all = if critical > 0.0 { gauss(DIRECTIONS, 0.0, critical) } else { Vec::new() };
        all.extend(radau(DIRECTIONS, critical, 1.0));
        all
    }
}

/// The boundary between the slab and its surroundings, for each direction.
struct Faces {
    /// Alike from both sides along the same path.
    reflectance: Vec<f64>,
}

impl Faces {
    fn new(eta: f64, directions: &[Node]) -> Self {
        let of = |d: &Node| if eta > 1.0 { dielectric_polarized(d.x, 1.0 / eta).unpolarized() } else { 0.0 };
        Self { reflectance: directions.iter().map(|d| of(d).min(TRAPPED)).collect() }
    }
}

/// The slab with its boundaries, as operators on the power of the bundles of light along the directions.
struct Body<'a> {
    faces: &'a Faces,
    below: Below,
    /// From power that enters the slab at its top to power that reaches its bottom.
    down: Matrix,
    /// And to power that comes back to its top.
    back: Matrix,
    /// What the slab's own top reflects of that, again and again: (1 − r R)⁻¹.
    again: Matrix,
}

impl<'a> Body<'a> {
    fn new(layer: &Layer, directions: &[Node], faces: &'a Faces, below: Below) -> Self {
        let n = directions.len();
        let area: Vec<f64> = directions.iter().map(|d| 2.0 * d.x * d.weight).collect();
        let inverse: Vec<f64> = area.iter().map(|a| 1.0 / a).collect();
        // Power is radiance times the projected solid angle.
        let power = |m: &Matrix| m.rows_scaled(&area).columns_scaled(&inverse);
        let (r, t) = (power(&layer.reflection), power(&layer.transmission));
        let ground = Matrix::from_fn(n, |i, j| match below {
            Below::Surroundings if i == j => faces.reflectance[i],
            Below::Surroundings => 0.0,
            Below::Lambertian(reflectance) => reflectance * area[i],
        });
        let identity = Matrix::identity(n);
        let down = identity.plus(&r.times(&ground), -1.0).solve(t.clone());
        let back = r.plus(&t.times(&ground.times(&down)), 1.0);
        let again = identity.plus(&back.rows_scaled(&faces.reflectance), -1.0).solve(identity);
        Self { faces, below, down, back, again }
    }

    /// The shares of the given power per bundle, which adds up to one.
    fn shares(&self, light: &[f64]) -> Shares {
        let r = &self.faces.reflectance;
        let entering: Vec<f64> = light.iter().zip(r).map(|(l, r)| l * (1.0 - r)).collect();
        let inside = self.again.apply(&entering);
        let out = |power: &[f64]| power.iter().zip(r).map(|(p, r)| p * (1.0 - r)).sum::<f64>();
        let mirrored: f64 = light.iter().zip(r).map(|(l, r)| l * r).sum();
        let transmittance = match self.below {
            Below::Surroundings => out(&self.down.apply(&inside)),
            Below::Lambertian(_) => 0.0,
        };
        Shares { reflectance: mirrored + out(&self.back.apply(&inside)), transmittance }
    }
}

#[cfg(test)]
mod tests {
    use super::super::absorption::NaturalAbsorbance;
    use super::super::attenuation::diffuse_transmittance;
    use super::super::hemispherical::diffuse_reflectance;
    use super::super::slab::Plate;
    use super::*;
    use crate::math::hash::Pcg32;

    fn slab(albedo: f64, depth: f64, anisotropy: f64, eta: f64) -> Slab {
        Slab { albedo, depth, anisotropy, eta, below: Below::Surroundings }
    }

    #[test]
    fn slabs_have_the_checked_shares() {
        // van de Hulst (1980) has .09739/.66096 for the first, Giovanelli (1955) .2600 for the sixth. Within boundaries these
        // are limits over the number of directions, which 16 of them miss by 7e-4.
        let inf = f64::INFINITY;
        for (albedo, depth, g, eta, [rc, tc, rd, td]) in [
            (0.9, 2.0, 0.75, 1.0, [0.09740, 0.66096, 0.19109, 0.50182]),
            (1.0, 1.0, 0.0, 1.0, [0.34133, 0.65867, 0.44659, 0.55341]),
            (0.9, 1.0, 0.0, 1.0, [0.26741, 0.59163, 0.35271, 0.47475]),
            (0.5, 1.0, 0.0, 1.0, [0.09912, 0.44606, 0.13417, 0.30671]),
            (1.0, 5.0, 0.0, 1.0, [0.73872, 0.26128, 0.79234, 0.20766]),
            (0.9, inf, 0.0, 1.5, [0.25992, 0.0, 0.30789, 0.0]),
            (0.9, 2.0, 0.75, 1.5, [0.12682, 0.49315, 0.19000, 0.39475]),
            (0.99, 10.0, 0.9, 1.4, [0.25908, 0.46299, 0.31716, 0.40241]),
        ] {
            let s = slab(albedo, depth, g, eta).solve().unwrap();
            let (c, d) = (s.collimated, s.diffuse);
            let found = [c.reflectance, c.transmittance, d.reflectance, d.transmittance];
            for (found, expected) in found.iter().zip([rc, tc, rd, td]) {
                assert!(
                    (found - expected).abs() < 2.5e-5,
                    "{albedo} {depth} {g} {eta}: {s:?}, expected {expected}"
                );
            }
        }
    }

    /// Photons through the slab: reflected, transmitted.
    fn walked(slab: &Slab, is_diffuse: bool, photons: u32) -> [f64; 2] {
        let Slab { albedo, depth, anisotropy: g, eta, .. } = *slab;
        let mut rng = Pcg32::new(7, 1);
        let mut u = || f64::from(rng.next_f32());
        let mut counts = [0_u32; 2];
        let inside = |mu: f64| dielectric_polarized(mu, 1.0 / eta).unpolarized();
        for _ in 0..photons {
            let outside: f64 = if is_diffuse { (1.0 - u()).sqrt() } else { 1.0 };
            let mut mu = (1.0 - (1.0 - outside * outside) / (eta * eta)).sqrt();
            if u() < inside(mu) {
                counts[0] += 1;
                continue;
            }
            let mut z = 0.0;
            'walk: loop {
                z -= (1.0 - u()).ln() * mu;
                while !(0.0..=depth).contains(&z) {
                    let face = usize::from(z > 0.0);
                    if u() >= inside(mu.abs()) {
                        counts[face] += 1;
                        break 'walk;
                    }
                    z = if face == 0 { -z } else { 2.0 * depth - z };
                    mu = -mu;
                }
                if u() >= albedo {
                    break;
                }
                let cos = if g == 0.0 {
                    2.0 * u() - 1.0
                } else {
                    let k = (1.0 - g * g) / (1.0 - g + 2.0 * g * u());
                    (1.0 + g * g - k * k) / (2.0 * g)
                };
                let turn = (std::f64::consts::TAU * u()).cos();
                mu = mu * cos + ((1.0 - mu * mu) * (1.0 - cos * cos)).max(0.0).sqrt() * turn;
            }
        }
        counts.map(|c| f64::from(c) / f64::from(photons))
    }

    #[test]
    fn random_walks_find_the_same() {
        let photons = 150_000;
        for (albedo, depth, g, eta) in [(0.9, 2.0, 0.75, 1.5), (0.97, 4.0, 0.0, 1.33), (0.8, 1.0, -0.4, 1.2)]
        {
            let slab = slab(albedo, depth, g, eta);
            let s = slab.solve().unwrap();
            for (is_diffuse, expected) in [(false, s.collimated), (true, s.diffuse)] {
                let found = walked(&slab, is_diffuse, photons);
                for (found, expected) in found.into_iter().zip([expected.reflectance, expected.transmittance])
                {
                    // 4.5 standard errors: twelve numbers leave them by chance once in 12 000 seeds.
                    let margin = 4.5 * (expected * (1.0 - expected) / f64::from(photons)).sqrt();
                    assert!((found - expected).abs() < margin, "{slab:?} {is_diffuse}: {found} {expected}");
                }
            }
        }
    }

    /// Chandrasekhar's H functions give the albedos of isotropic half-spaces.
    #[test]
    fn half_spaces_have_the_albedos_of_h_functions() {
        for (albedo, plane, spherical) in [
            (0.5, 0.115_226, 0.146_544),
            (0.8, 0.285_255, 0.341_867),
            (0.9, 0.414_947, 0.478_024),
            (0.99, 0.752_721, 0.794_564),
        ] {
            let s = slab(albedo, f64::INFINITY, 0.0, 1.0).solve().unwrap();
            assert!((s.collimated.reflectance - plane).abs() < 2e-6, "{albedo}: {s:?}");
            assert!((s.diffuse.reflectance - spherical).abs() < 2e-6, "{albedo}: {s:?}");
        }
        assert_eq!(slab(1.0, f64::INFINITY, 0.0, 1.5).solve().unwrap().diffuse, Shares::REFLECTED);
    }

    #[test]
    fn without_scattering_it_is_bouguers_law_between_fresnels_faces() {
        for (depth, eta) in [(0.0, 1.0), (0.7, 1.0), (0.0, 1.5), (0.7, 1.5), (3.0, 1.33)] {
            let s = slab(0.0, depth, 0.0, eta).solve().unwrap();
            let plate = Plate::window(eta, NaturalAbsorbance::new(depth)).unpolarized(1.0);
            assert!((s.collimated.reflectance - plate.reflectance).abs() < 1e-6, "{depth} {eta}: {s:?}");
            assert!((s.collimated.transmittance - plate.transmittance).abs() < 1e-6);
            if eta == 1.0 {
                let expected = diffuse_transmittance(NaturalAbsorbance::new(depth));
                assert!((s.diffuse.transmittance - expected).abs() < 1e-6, "{depth}: {s:?}");
            }
        }
        // The first face alone, above what absorbs all.
        let black = slab(0.0, f64::INFINITY, 0.0, 1.5).solve().unwrap();
        assert!((black.diffuse.reflectance - diffuse_reflectance(1.5)).abs() < 2e-5, "{black:?}");
        assert!((black.collimated.reflectance - 0.04).abs() < 1e-9);
    }

    #[test]
    fn what_does_not_absorb_loses_nothing() {
        for (depth, g, eta) in [(0.3, 0.0, 1.0), (4.0, 0.8, 1.4), (20.0, -0.5, 1.2)] {
            let s = slab(1.0, depth, g, eta).solve().unwrap();
            assert!(s.collimated.absorptance().abs() < 1e-6 && s.diffuse.absorptance().abs() < 1e-6, "{s:?}");
            let white = Slab { below: Below::Lambertian(1.0), ..slab(1.0, depth, g, eta) }.solve().unwrap();
            assert!((white.diffuse.reflectance - 1.0).abs() < 1e-6, "{white:?}");
        }
    }

    #[test]
    fn a_clear_slab_shows_what_lies_below() {
        let over = |reflectance, eta| {
            let clear = Slab { below: Below::Lambertian(reflectance), ..slab(0.0, 0.0, 0.0, eta) };
            clear.solve().unwrap().diffuse.reflectance
        };
        assert!((over(0.5, 1.0) - 0.5).abs() < 1e-12);
        // Saunderson's correction is exact for a Lambertian surface under a smooth boundary.
        let [k1, k2] = [1.5, 1.0 / 1.5].map(diffuse_reflectance);
        assert!((over(0.5, 1.5) - (k1 + (1.0 - k1) * (1.0 - k2) * 0.5 / (1.0 - 0.5 * k2))).abs() < 3e-5);
    }

    #[test]
    fn nonsense_is_refused() {
        let said = |s: Slab| s.solve().unwrap_err().to_string();
        assert!(said(slab(1.1, 1.0, 0.0, 1.0)).contains("albedo of 1.1"));
        assert!(said(slab(0.5, -1.0, 0.0, 1.0)).contains("thickness of -1"));
        assert!(said(slab(0.5, f64::NAN, 0.0, 1.0)).contains("thickness"));
        assert!(said(slab(0.5, 1.0, 1.0, 1.0)).contains("cosine of 1"));
        assert!(said(slab(0.5, 1.0, 0.0, 0.9)).contains("index of 0.9"));
        assert!(
            said(Slab { below: Below::Lambertian(2.0), ..slab(0.5, 1.0, 0.0, 1.0) })
                .contains("reflectance of 2")
        );
    }
}
