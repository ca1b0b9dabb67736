//! Lights at infinity: parallel light, a uniform sky, and environment maps.

use super::contract::{Escaped, LightError, LightPower, LightSample, LightTarget};
use super::normalise::{Emission, Stated};
use super::picture::{EmissionPicture, TexelLight};
use crate::math::distribution::PiecewiseConstant2D;
use crate::math::warp::{
    UNIFORM_SPHERE_PDF, equal_area_sphere_to_square, equal_area_square_to_sphere, uniform_sphere,
};
use crate::math::{Dir, Point, Transform, Vec2, Vec3};
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::{Density, PdfSolidAngle, Radiance};
use rayon::prelude::*;
use std::f32::consts::PI;

/// Parallel light.
#[derive(Clone, Debug)]
pub struct DistantLight {
    wi: Dir,
    /// On a plane perpendicular to it.
    irradiance: Emission,
}

impl DistantLight {
    /// Light that travels from `from` towards `to` (light space). A stated total is that of a plane perpendicular to
    /// it.
    pub fn new(
        render_from_light: Transform,
        from: Point,
        to: Point,
        irradiance: Spectrum,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        let wi = Dir::new(from - to).ok_or(LightError::NoDirection)?;
        let wi = render_from_light.direction(wi).ok_or(LightError::Singular)?;
        Ok(Self { wi, irradiance: Emission::new(irradiance, stated, 1.0)? })
    }

    pub(super) fn sample(&self, w: &Wavelengths) -> Option<LightSample> {
        let radiance = self.irradiance.at(w);
        (!radiance.is_zero()).then_some(LightSample {
            wi: self.wi,
            radiance,
            density: Density::Delta,
            target: LightTarget::Infinite,
        })
    }

    /// Through the disk that the scene's bounding sphere shows.
    pub(super) fn power(&self, scene_radius: f32) -> LightPower {
        let area = PI * scene_radius * scene_radius;
        LightPower { watts: self.irradiance.watts() * area, lumens: self.irradiance.lumens() * area }
    }
}

/// The same radiance from every direction.
#[derive(Clone, Debug)]
pub struct UniformInfiniteLight {
    radiance: Emission,
}

impl UniformInfiniteLight {
    /// A stated total is that of a plane, π times the radiance, or the luminance.
    pub fn new(radiance: Spectrum, stated: &Stated) -> Result<Self, LightError> {
        Ok(Self { radiance: Emission::new(radiance, stated, PI)? })
    }

    pub(super) fn sample(&self, u: Vec2, w: &Wavelengths) -> Option<LightSample> {
        let radiance = self.escaped(w);
        let density = Density::SolidAngle(self.density());
        let wi = Dir::new_unchecked(uniform_sphere(u));
        (!radiance.is_zero()).then_some(LightSample { wi, radiance, density, target: LightTarget::Infinite })
    }

    pub(super) fn escaped(&self, w: &Wavelengths) -> Sampled<Radiance> {
        self.radiance.at(w)
    }

    pub(super) fn density(&self) -> PdfSolidAngle {
        PdfSolidAngle(UNIFORM_SPHERE_PDF)
    }

    /// Into the scene's bounding sphere: π L over its surface 4πr².
    pub(super) fn power(&self, scene_radius: f32) -> LightPower {
        let geometry = 4.0 * PI * PI * scene_radius * scene_radius;
        LightPower { watts: self.radiance.watts() * geometry, lumens: self.radiance.lumens() * geometry }
    }
}

/// Share of the radiance below the mean that is kept in the sampling density.
///
/// What is dim and spread out is found well enough by sampling the scattering function; in combination with that,
/// the best density is what stands out from the mean (Karlík et al. 2019). A rest is kept so that light samples
/// alone remain unbiased.
const KEPT: f32 = 0.1;

/// Radiance by direction from an equal-area octahedral square (Clarberg 2008), z up.
#[derive(Clone, Debug)]
pub struct ImageInfiniteLight {
    render_from_light: Transform,
    light_from_render: Transform,
    picture: EmissionPicture,
    /// The texels' spectra in the picture's order; none for pictures too large to keep them.
    texels: Vec<TexelLight>,
    density: PiecewiseConstant2D,
    mean: Vec3,
}

/// Texels whose spectra are kept, at 16 bytes each: finding one takes longer than all else that a lookup does.
const MOST_KEPT_SPECTRA: usize = 1 << 22;

impl ImageInfiniteLight {
    /// A stated total is that of a plane facing +z of light space, by the upper half of the picture.
    pub fn new(
        render_from_light: Transform,
        mut picture: EmissionPicture,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        let (width, height) = (picture.image().width(), picture.image().height());
        if width != height {
            return Err(LightError::NotSquare(width, height));
        }
        // Every texel subtends 4π over their number.
        let horizontal = picture.mean(|st| equal_area_square_to_sphere(st).z.max(0.0)) * (4.0 * PI);
        let mean = picture.mean(|_| 1.0);
        let yields = picture.yields(horizontal, picture.luminance(mean));
        picture.set_factor(stated.multiplier(&yields)?);
        let average = mean.element_sum() / 3.0;
        let mut importance = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let value = picture.image().rgb(x, y).0.max(Vec3::ZERO).element_sum() / 3.0;
                importance.push((value - average).max(0.0) + KEPT * value);
            }
        }
        let density = PiecewiseConstant2D::new(&importance, width as usize, height as usize);
        let n = width as usize * height as usize;
        let texels = if n > MOST_KEPT_SPECTRA {
            Vec::new()
        } else {
            let texel = |i: usize| {
                let (x, y) = (i as u32 % width, i as u32 / width);
                picture.emitted(picture.image().rgb(x, y).0.max(Vec3::ZERO))
            };
            (0..n).into_par_iter().map(texel).collect()
        };
        let light_from_render = render_from_light.inverse();
        Ok(Self { render_from_light, light_from_render, picture, texels, density, mean })
    }

    pub(super) fn sample(&self, u: Vec2, w: &Wavelengths) -> Option<LightSample> {
        let (st, area_density) = self.density.sample(u);
        let wi = Dir::new(self.render_from_light.vector(equal_area_square_to_sphere(st)))?;
        let radiance = self.radiance(st, w);
        if area_density <= 0.0 || radiance.is_zero() {
            return None;
        }
        let density = Density::SolidAngle(PdfSolidAngle(area_density * UNIFORM_SPHERE_PDF));
        Some(LightSample { wi, radiance, density, target: LightTarget::Infinite })
    }

    fn radiance(&self, st: Vec2, w: &Wavelengths) -> Sampled<Radiance> {
        let [x, y] = self.picture.nearest_index(st);
        match self.texels.get(y as usize * self.picture.image().width() as usize + x as usize) {
            Some(texel) => self.picture.texel_light(texel, w),
            None => self.picture.light(self.picture.nearest(st), w),
        }
    }

    fn square(&self, wi: Dir) -> Option<Vec2> {
        self.light_from_render.direction(wi).map(|d| equal_area_sphere_to_square(*d))
    }

    pub(super) fn escaped(&self, wi: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        self.square(wi).map_or(Sampled::ZERO, |st| self.radiance(st, w))
    }

    pub(super) fn escaped_with_density(&self, wi: Dir, w: &Wavelengths) -> Escaped {
        match self.square(wi) {
            Some(st) => Escaped { radiance: self.radiance(st, w), density: self.density_at(st) },
            None => Escaped { radiance: Sampled::ZERO, density: PdfSolidAngle(0.0) },
        }
    }

    pub(super) fn density(&self, wi: Dir) -> PdfSolidAngle {
        self.square(wi).map_or(PdfSolidAngle(0.0), |st| self.density_at(st))
    }

    fn density_at(&self, st: Vec2) -> PdfSolidAngle {
        PdfSolidAngle(self.density.pdf(st) * UNIFORM_SPHERE_PDF)
    }

    /// Into the scene's bounding sphere.
    pub(super) fn power(&self, scene_radius: f32) -> LightPower {
        let mean = self.picture.integrals(self.mean);
        let geometry = 4.0 * PI * PI * scene_radius * scene_radius;
        LightPower { watts: mean.watts * geometry, lumens: mean.lumens * geometry }
    }
}
