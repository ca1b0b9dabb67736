//! The sky as a light: a distribution of luminance over the upper hemisphere, and the ground below it.

use super::luminance::{SkyIntegrals, SkyLuminance, SkyModel};
use crate::light::contract::{LightError, LightPower, LightSample, LightTarget};
use crate::light::normalise::{Amount, Emission, Stated};
use crate::math::distribution::PiecewiseConstant2D;
use crate::math::warp::UNIFORM_SPHERE_PDF;
use crate::math::{Dir, Frame, LocalDir, Normal, Vec2, Vec3};
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::{Density, Illuminance, LUMENS_PER_WATT, Luminance, PdfSolidAngle, Radiance};
use std::f32::consts::{PI, TAU};

/// Where up is and where the sun stands, in render space.
#[derive(Clone, Copy, Debug)]
pub struct SkyPlacement {
    /// To the zenith.
    pub up: Dir,
    /// To the sun; `None` where it is unknown and of no consequence.
    pub sun: Option<Dir>,
}

/// A diffusely reflecting plain that ends the world below the horizon.
#[derive(Clone, Debug)]
pub struct Ground {
    /// Share of the light that it sends back, in [0, 1].
    pub reflectance: f32,
    /// Irradiance of the plain in W·m⁻²·nm⁻¹, before the light's scale, where it is not that by the sky alone.
    pub irradiance: Option<Spectrum>,
}

/// A sky.
///
/// Its radiance is the zenith's spectrum times the distribution of its model: the colour is the same everywhere.
/// Below the horizon there is the ground's radiance ρE/π, or nothing.
#[derive(Clone, Debug)]
pub struct SkyLight {
    dome: Dome,
    /// Radiance.
    zenith: Emission,
    /// Radiance.
    ground: Option<Emission>,
    /// Over azimuth/2π and (1 − cos Z)/2, of which equal areas are equal solid angles.
    density: PiecewiseConstant2D,
}

/// The geometry of a sky.
#[derive(Clone, Debug)]
struct Dome {
    /// z up, x towards the sun's azimuth.
    frame: Frame,
    /// Of the sun, in `frame`.
    sun: LocalDir,
    luminance: SkyLuminance,
    integrals: SkyIntegrals,
}

/// Cells of the sampling density along each axis; even, so that the horizon lies between two rows.
const CELLS: u32 = 128;

impl SkyLight {
    /// A sky of `model`; `spectrum` is the radiance of the zenith, or its shape, scaled to what is stated.
    ///
    /// A stated total is the illuminance or irradiance of the horizontal plane by the sky alone, or the luminance of the zenith. Without
    /// one, a spectrum that is a shape gives the zenith 1 cd/m².
    pub fn new(
        placement: &SkyPlacement,
        model: SkyModel,
        spectrum: Spectrum,
        stated: &Stated,
        ground: Option<Ground>,
    ) -> Result<Self, LightError> {
        let dome = Dome::new(placement, model)?;
        let horizontal = dome.integrals.horizontal as f32;
        let zenith = Emission::new(stated.measurable(spectrum), stated, horizontal)?;
        let ground = ground.map(|g| g.radiance(&zenith, horizontal, stated.scale)).transpose()?;
        Ok(Self { density: dome.tabulate(&zenith, ground.as_ref()), dome, zenith, ground })
    }

    /// A sky of `model` that gives the horizontal plane `scale` times `irradiance` [W·m⁻²·nm⁻¹].
    pub fn of_irradiance(
        placement: &SkyPlacement,
        model: SkyModel,
        irradiance: Spectrum,
        scale: f32,
        ground: Option<Ground>,
    ) -> Result<Self, LightError> {
        let horizontal = Dome::new(placement, model)?.integrals.horizontal as f32;
        let absolute = Stated { scale, amount: Amount::Absolute, total: None };
        Self::new(placement, model, irradiance.scaled(1.0 / horizontal), &absolute, ground)
    }
}

impl Dome {
    fn new(placement: &SkyPlacement, model: SkyModel) -> Result<Self, LightError> {
        let SkyPlacement { up, sun } = *placement;
        if model.needs_sun() && sun.is_none() {
            return Err(LightError::NoSun);
        }
        let sun = sun.unwrap_or(up);
        let n = Normal::new_unchecked(*up);
        // Twice, because of a sun near the zenith the first pass leaves a few digits only.
        let frame = Frame::from_z_x(n, Frame::from_z_x(n, *sun).s);
        let sun = frame.to_local(sun);
        if model.needs_sun() && !(sun.z >= 0.0) {
            return Err(LightError::SunBelowHorizon(sun.z.clamp(-1.0, 1.0).asin().to_degrees()));
        }
        let luminance = SkyLuminance::new(model, f64::from(sun.z));
        Ok(Self { frame, sun, luminance, integrals: luminance.integrals() })
    }

    /// Mean over four points of each cell of the radiance, up to a factor.
    ///
    /// Nothing is taken off for what scattered rays find by themselves: skies are smooth, and instruments that sample lights alone
    /// rely on this density.
    fn tabulate(&self, zenith: &Emission, ground: Option<&Emission>) -> PiecewiseConstant2D {
        // Brightness counts most, but infrared is to be found as well.
        let strength = |e: &Emission| f64::from(e.lumens() / LUMENS_PER_WATT + 0.05 * e.watts());
        let zenith = strength(zenith);
        let ground = ground.map_or(0.0, strength) as f32;
        let n = f64::from(CELLS);
        let mut cells = Vec::with_capacity((CELLS * CELLS) as usize);
        for row in 0..CELLS {
            for column in 0..CELLS {
                if 2 * row >= CELLS {
                    cells.push(ground);
                    continue;
                }
                let mut sum = 0.0;
                for (dx, dy) in [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)] {
                    let cos_zenith = 1.0 - 2.0 * (f64::from(row) + dy) / n;
                    let azimuth = (f64::from(column) + dx) / n * std::f64::consts::TAU;
                    sum += self.luminance.towards(cos_zenith, azimuth);
                }
                cells.push((0.25 * sum * zenith) as f32);
            }
        }
        PiecewiseConstant2D::new(&cells, CELLS as usize, CELLS as usize)
    }
}

impl SkyLight {
    pub(in crate::light) fn sample(&self, u: Vec2, w: &Wavelengths) -> Option<LightSample> {
        let (st, _) = self.density.sample(u);
        let (sin, cos) = (TAU * st.x).sin_cos();
        // 1 − z² = 4y(1 − y) keeps its digits near the zenith.
        let r = 2.0 * (st.y * (1.0 - st.y)).sqrt();
        let local = LocalDir::new_unchecked(Vec3::new(r * cos, r * sin, 1.0 - 2.0 * st.y));
        let wi = self.dome.frame.to_world(local);
        let radiance = self.escaped(wi, w);
        // By the same path as for a ray that runs into the sky, so that the weights of both always add up to one.
        let density = self.density(wi);
        (density.0 > 0.0 && !radiance.is_zero()).then_some(LightSample {
            wi,
            radiance,
            density: Density::SolidAngle(density),
            target: LightTarget::Infinite,
        })
    }

    pub(in crate::light) fn density(&self, wi: Dir) -> PdfSolidAngle {
        let d = self.dome.frame.to_local(wi);
        let azimuth = d.y.atan2(d.x) / TAU;
        let st = Vec2::new(if azimuth < 0.0 { azimuth + 1.0 } else { azimuth }, 0.5 - 0.5 * d.z);
        PdfSolidAngle(self.density.pdf(st.clamp(Vec2::ZERO, Vec2::ONE)) * UNIFORM_SPHERE_PDF)
    }

    pub(in crate::light) fn escaped(&self, wi: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        let d = self.dome.frame.to_local(wi);
        if d.z < 0.0 {
            return self.ground.as_ref().map_or(Sampled::ZERO, |ground| ground.at(w));
        }
        let relative =
            self.dome.luminance.relative(f64::from(d.z.min(1.0)), f64::from(d.dot(*self.dome.sun)));
        self.zenith.at(w) * relative as f32
    }

    /// Into the scene's bounding sphere: ∫ L dω through its disk.
    pub(in crate::light) fn power(&self, scene_radius: f32) -> LightPower {
        let disk = PI * scene_radius * scene_radius;
        let all = self.dome.integrals.all as f32;
        let total = |of: fn(&Emission) -> f32| {
            disk * (all * of(&self.zenith) + TAU * self.ground.as_ref().map_or(0.0, of))
        };
        LightPower { watts: total(Emission::watts), lumens: total(Emission::lumens) }
    }

    /// Luminance of the zenith.
    pub fn zenith_luminance(&self) -> Luminance {
        Luminance::exact(f64::from(self.zenith.lumens()))
    }

    /// Illuminance of the unobstructed horizontal plane by the sky, without the sun: what a daylight factor refers to.
    pub fn horizontal_illuminance(&self) -> Illuminance {
        Illuminance::exact(f64::from(self.zenith.lumens()) * self.dome.integrals.horizontal)
    }

    /// To the zenith, in render space.
    pub fn up(&self) -> Dir {
        Dir::new_unchecked(self.dome.frame.n)
    }
}

impl Ground {
    /// ρE/π.
    fn radiance(self, zenith: &Emission, horizontal: f32, scale: f32) -> Result<Emission, LightError> {
        let factor = self.reflectance / PI;
        match self.irradiance {
            Some(irradiance) => {
                let absolute = Stated { scale, amount: Amount::Absolute, total: None };
                Emission::new(irradiance.scaled(factor), &absolute, 1.0)
            }
            None => Ok(zenith.times(factor * horizontal)),
        }
    }
}
