//! A scattering function placed on a surface: world directions in, world directions out.

use crate::bsdf::{Bsdf, Lobe, Lobes, Mode, Side};
use crate::math::{Dir, Frame, Normal, Shading, Vec2};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};

/// A [`Bsdf`] in the shading frame of a surface point.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceBsdf<'a> {
    bsdf: Bsdf<'a>,
    frame: Frame,
}

/// A direction drawn from a [`SurfaceBsdf`].
#[derive(Clone, Copy, Debug)]
pub struct SurfaceSample {
    /// The sampled direction.
    pub wi: Dir,
    /// f·|cosθi|/p, with the cosine to the shading normal.
    pub weight: Sampled<Unitless>,
    /// Density of `wi`; `Delta` for a discrete direction.
    pub density: Density,
    /// Side that `wi` leaves to.
    pub side: Side,
    /// Width of the lobe.
    pub lobe: Lobe,
    /// Relative index ηt/ηi that the sample crossed; 1 for reflection.
    pub eta: f32,
}

impl<'a> SurfaceBsdf<'a> {
    /// Places `bsdf` on a surface: z is the shading normal, x the shading ∂p/∂u.
    pub fn new(bsdf: Bsdf<'a>, shading: &Shading) -> Self {
        Self { bsdf, frame: Frame::from_z_x(shading.n, shading.dpdu) }
    }

    /// f [sr⁻¹], without the cosine and without discrete directions.
    pub fn eval(&self, wo: Dir, wi: Dir, mode: Mode) -> Sampled<PerSteradian> {
        self.bsdf.eval(self.frame.to_local(wo), self.frame.to_local(wi), mode)
    }

    /// Density of `wi` among the continuous directions that [`SurfaceBsdf::sample`] draws for `wo`.
    pub fn pdf(&self, wo: Dir, wi: Dir, mode: Mode) -> PdfSolidAngle {
        self.bsdf.pdf(self.frame.to_local(wo), self.frame.to_local(wi), mode)
    }

    /// Draws a direction with `uc` for the choice among lobes and `u` for the direction; `None` when the
    /// light is absorbed.
    pub fn sample(&self, wo: Dir, uc: f32, u: Vec2, mode: Mode) -> Option<SurfaceSample> {
        let s = self.bsdf.sample(self.frame.to_local(wo), uc, u, mode)?;
        Some(SurfaceSample {
            wi: self.frame.to_world(s.wi),
            weight: s.weight,
            density: s.density,
            side: s.side,
            lobe: s.lobe,
            eta: s.eta,
        })
    }

    /// |cosθ| of a direction to the shading normal, the one that belongs to [`SurfaceBsdf::eval`].
    pub fn abs_cos(&self, w: Dir) -> f32 {
        self.frame.n.dot(*w).abs()
    }

    /// The shading normal.
    pub fn n(&self) -> Normal {
        Normal::new_unchecked(self.frame.n)
    }

    /// The shading frame.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The scattering function in local coordinates.
    pub fn bsdf(&self) -> &Bsdf<'a> {
        &self.bsdf
    }

    /// Which continuous lobes are present.
    pub fn lobes(&self) -> Lobes {
        self.bsdf.lobes()
    }

    /// Widens narrow lobes: a named bias, off unless asked for.
    pub fn regularize(&mut self) {
        self.bsdf.regularize();
    }
}
