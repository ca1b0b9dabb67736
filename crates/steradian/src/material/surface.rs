//! A scattering function placed on a surface: world directions in, world directions out.

use crate::bsdf::{Bsdf, Evaluated, Lobe, Lobes, Mode, Side};
use crate::math::warp::cosine_hemisphere_pdf;
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

/// What a pair of directions makes of a [`SurfaceBsdf`].
#[derive(Clone, Copy, Debug)]
pub struct Evaluation {
    /// f [sr⁻¹], as [`SurfaceBsdf::eval`] gives it.
    pub f: Sampled<PerSteradian>,
    /// Density as [`SurfaceBsdf::pdf`] gives it.
    pub pdf: PdfSolidAngle,
}

impl<'a> SurfaceBsdf<'a> {
    /// Places a `bsdf` that looks alike from all sides on a surface with shading normal `n`.
    #[inline]
    pub(super) fn isotropic(bsdf: Bsdf<'a>, n: Normal) -> Self {
        Self { bsdf, frame: Frame::from_z(n) }
    }

    /// Places `bsdf` on a surface: z is the shading normal, x the shading ∂p/∂u.
    #[inline]
    pub fn new(bsdf: Bsdf<'a>, shading: &Shading) -> Self {
        Self { bsdf, frame: Frame::from_z_x(shading.n, shading.dpdu) }
    }

    /// f [sr⁻¹], without the cosine and without discrete directions.
    pub fn eval(&self, wo: Dir, wi: Dir, mode: Mode) -> Sampled<PerSteradian> {
        self.bsdf.eval(self.frame.to_local(wo), self.frame.to_local(wi), mode)
    }

    /// [`SurfaceBsdf::eval`] and [`SurfaceBsdf::pdf`] at once.
    #[inline(always)]
    pub fn evaluate(&self, wo: Dir, wi: Dir, mode: Mode) -> Evaluation {
        if let Bsdf::Diffuse(diffuse) = &self.bsdf {
            // Lambert's law asks for the cosines alone.
            let (cos_o, cos_i) = (self.frame.n.dot(*wo), self.frame.n.dot(*wi));
            return match cos_o * cos_i > 0.0 {
                true => {
                    Evaluation { f: diffuse.value(), pdf: PdfSolidAngle(cosine_hemisphere_pdf(cos_i.abs())) }
                }
                false => Evaluation { f: Sampled::ZERO, pdf: PdfSolidAngle(0.0) },
            };
        }
        let (wo, wi) = (self.frame.to_local(wo), self.frame.to_local(wi));
        let Evaluated { f, pdf } = self.bsdf.evaluate(wo, wi, mode);
        Evaluation { f, pdf }
    }

    /// Density of `wi` among the continuous directions that [`SurfaceBsdf::sample`] draws for `wo`.
    pub fn pdf(&self, wo: Dir, wi: Dir, mode: Mode) -> PdfSolidAngle {
        self.bsdf.pdf(self.frame.to_local(wo), self.frame.to_local(wi), mode)
    }

    /// Draws a direction with `uc` for the choice among lobes and `u` for the direction; `None` when the
    /// light is absorbed.
    #[inline(always)]
    pub fn sample(&self, wo: Dir, uc: f32, u: Vec2, mode: Mode) -> Option<SurfaceSample> {
        let wo = self.frame.to_local(wo);
        let s = match &self.bsdf {
            // The commonest, in the caller's loop.
            Bsdf::Diffuse(diffuse) => diffuse.sample(wo, u)?,
            bsdf => bsdf.sample(wo, uc, u, mode)?,
        };
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
    #[inline]
    pub fn abs_cos(&self, w: Dir) -> f32 {
        self.frame.n.dot(*w).abs()
    }

    /// The shading normal.
    #[inline]
    pub fn n(&self) -> Normal {
        Normal::new_unchecked(self.frame.n)
    }

    /// The shading frame.
    #[inline]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The scattering function in local coordinates.
    pub fn bsdf(&self) -> &Bsdf<'a> {
        &self.bsdf
    }

    /// Which continuous lobes are present.
    #[inline(always)]
    pub fn lobes(&self) -> Lobes {
        match &self.bsdf {
            Bsdf::Diffuse(diffuse) => diffuse.lobes(),
            bsdf => bsdf.lobes(),
        }
    }

    /// Widens narrow lobes: a named bias, off unless asked for.
    pub fn regularize(&mut self) {
        self.bsdf.regularize();
    }
}
