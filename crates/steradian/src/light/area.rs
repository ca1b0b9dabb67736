//! Shapes that emit diffusely.

use super::bounds::{Cone, EmitterBounds};
use super::contract::{LightError, LightPower, LightSample, LightTarget};
use super::normalise::{Emission, Stated};
use super::picture::EmissionPicture;
use crate::math::{Dir, Normal, SurfacePoint, Vec2};
use crate::shape::{ReferencePoint, Shape, ShapeId};
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::{Density, PdfSolidAngle, Radiance};
use std::f32::consts::PI;

/// Which sides of a surface emit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// The side that the normal points to.
    #[default]
    Front,
    /// Both.
    Both,
}

/// What a surface emits, equally in all directions.
#[derive(Clone, Debug)]
pub enum AreaRadiance {
    /// The same everywhere.
    Uniform(Spectrum),
    /// By (u, v), v upwards.
    Picture(Box<EmissionPicture>),
}

#[derive(Clone, Debug)]
enum Surface {
    Uniform(Emission),
    Picture(Box<EmissionPicture>),
}

/// A shape that emits the same radiance in all directions of a side.
#[derive(Clone, Debug)]
pub struct DiffuseAreaLight {
    shape: ShapeId,
    surface: Surface,
    sides: Sides,
    /// Area of the whole shape [scene units²].
    area: f32,
}

impl DiffuseAreaLight {
    /// An emitting shape. A stated total is the flux of the whole shape, both sides together, or its mean luminance.
    pub fn new(
        id: ShapeId,
        shape: &Shape,
        radiance: AreaRadiance,
        sides: Sides,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        let area = (0..shape.prim_count()).map(|prim| f64::from(shape.area(prim))).sum::<f64>() as f32;
        let geometry = Self::geometry(sides, area);
        let surface = match radiance {
            AreaRadiance::Uniform(spectrum) => Surface::Uniform(Emission::new(spectrum, stated, geometry)?),
            AreaRadiance::Picture(mut picture) => {
                let mean = picture.mean(|_| 1.0);
                let yields = picture.yields(mean * geometry, picture.luminance(mean));
                picture.set_factor(stated.multiplier(&yields)?);
                Surface::Picture(picture)
            }
        };
        Ok(Self { shape: id, surface, sides, area })
    }

    /// Power per radiance: M = π L, A (22), over the emitting area.
    fn geometry(sides: Sides, area: f32) -> f32 {
        PI * area
            * match sides {
                Sides::Front => 1.0,
                Sides::Both => 2.0,
            }
    }

    /// The emitting shape.
    pub fn shape(&self) -> ShapeId {
        self.shape
    }

    /// Area of the shape [scene units²].
    pub fn area(&self) -> f32 {
        self.area
    }

    #[inline(always)]
    pub(super) fn sample(
        &self,
        from: &ReferencePoint,
        shapes: &[Shape],
        prim: u32,
        u: Vec2,
        w: &Wavelengths,
    ) -> Option<LightSample> {
        let at = shapes.get(self.shape.0 as usize)?.sample_toward(prim, from, u)?;
        let radiance = self.radiance(at.n, at.uv, -at.wi, w);
        if radiance.is_zero() {
            return None;
        }
        Some(LightSample {
            wi: at.wi,
            radiance,
            density: Density::SolidAngle(at.density),
            target: LightTarget::Point { p: at.p, n: Some(at.n) },
        })
    }

    pub(super) fn density(
        &self,
        from: &ReferencePoint,
        shapes: &[Shape],
        prim: u32,
        wi: Dir,
        hit: &SurfacePoint,
    ) -> PdfSolidAngle {
        shapes.get(self.shape.0 as usize).map_or(PdfSolidAngle(0.0), |s| s.pdf_toward(prim, from, wi, hit))
    }

    #[inline(always)]
    pub(super) fn radiance(&self, n: Normal, uv: Vec2, wo: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        if self.sides == Sides::Front && n.dot(*wo) < 0.0 {
            return Sampled::ZERO;
        }
        match &self.surface {
            Surface::Uniform(e) => e.at(w),
            Surface::Picture(p) => p.light(p.bilinear(Vec2::new(uv.x, 1.0 - uv.y)), w),
        }
    }

    /// Where primitive `prim` is and shines, given that the whole light has `power` up to a common factor.
    pub(super) fn bounds(&self, shape: &Shape, prim: u32, power: f32) -> EmitterBounds {
        // Normals of flat and nearly flat primitives show at a few points; closed ones face everywhere.
        let facets = matches!(shape, Shape::Mesh(_) | Shape::Disk(_) | Shape::Bilinear(_));
        let points =
            (0..if facets { 9 } else { 0 }).map(|i| Vec2::new((i % 3) as f32, (i / 3) as f32) * 0.49 + 0.01);
        let normals = points
            .filter_map(|u| shape.sample_area(prim, u))
            .map(|s| Cone { axis: s.n.into(), cos: 1.0 })
            .reduce(Cone::union)
            .unwrap_or(Cone::SPHERE);
        EmitterBounds {
            bounds: shape.primitive(prim).bounds(),
            normals,
            cos_emission: 0.0,
            intensity: power * shape.area(prim) / Self::geometry(self.sides, self.area),
            both_sides: self.sides == Sides::Both,
        }
    }

    pub(super) fn power(&self) -> LightPower {
        let geometry = Self::geometry(self.sides, self.area);
        let (watts, lumens) = match &self.surface {
            Surface::Uniform(e) => (e.watts(), e.lumens()),
            Surface::Picture(p) => {
                let mean = p.integrals(p.mean(|_| 1.0));
                (mean.watts, mean.lumens)
            }
        };
        LightPower { watts: watts * geometry, lumens: lumens * geometry }
    }
}
