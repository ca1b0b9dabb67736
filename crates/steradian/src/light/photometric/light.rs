//! A light with a photometric web.

use super::luminaire::{Opening, Outline};
use super::web::PhotometricWeb;
use crate::light::bounds::{Cone, EmitterBounds};
use crate::light::contract::{LightError, LightPower, LightSample, LightTarget};
use crate::light::normalise::{Emission, Stated};
use crate::math::warp::concentric_disk;
use crate::math::{BoundedPoint, Bounds3, Dir, Point, Transform, Vec2, Vec3};
use crate::shape::ReferencePoint;
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::{Density, Radiance};
use std::f32::consts::PI;
use std::sync::Arc;

/// The opening that a photometric light shines from, in the plane z = 0 of light space [its units]; a point without extent.
///
/// Every point of it emits the web's distribution in its share of the area, so that the far field is the web; a rectangle then
/// has radiance I/(A cos θ). It is found by light samples alone, never by rays: mirrors and cameras do not show it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EmittingOpening {
    /// Half extent along x, the C0 plane.
    pub half_x: f32,
    /// Half extent along y, the C90 plane.
    pub half_y: f32,
    /// Its outline.
    pub outline: Outline,
}

impl EmittingOpening {
    /// The plan of an opening [m] in scene units of `meters_per_unit`.
    pub fn of(opening: &Opening, meters_per_unit: f32) -> Self {
        let half = |metres: f64| (0.5 * metres / f64::from(meters_per_unit)) as f32;
        Self { half_x: half(opening.along_c0), half_y: half(opening.along_c90), outline: opening.outline }
    }

    /// A point of it, uniformly.
    fn sample(&self, u: Vec2) -> Vec2 {
        let unit = match self.outline {
            Outline::Rectangle => 2.0 * u - Vec2::ONE,
            Outline::Ellipse => concentric_disk(u),
        };
        unit * Vec2::new(self.half_x, self.half_y)
    }
}

/// A luminaire by its distribution of luminous intensity.
#[derive(Clone, Debug)]
pub struct PhotometricLight {
    render_from_light: Transform,
    light_from_render: Transform,
    web: Arc<PhotometricWeb>,
    opening: EmittingOpening,
    /// What 1 cd of the web stands for.
    intensity: Emission,
    /// ∫ web dω [cd·sr].
    flux: f32,
    /// Largest value of the web [cd].
    peak: f32,
}

impl PhotometricLight {
    /// A light at `from` in light space with its nadir at −z and its C0 plane at +x.
    ///
    /// The spectrum is a shape: the web's candela are its amount, unless a total is stated.
    pub fn new(
        render_from_light: Transform,
        from: Point,
        web: impl Into<Arc<PhotometricWeb>>,
        opening: EmittingOpening,
        spectrum: Spectrum,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        let web = web.into();
        let (flux, peak) = (web.flux() as f32, web.peak() as f32);
        let intensity = Emission::with_peak(spectrum, stated, flux, peak)?;
        let render_from_light = render_from_light * Transform::translate(*from);
        let light_from_render = render_from_light.inverse();
        Ok(Self { render_from_light, light_from_render, web, opening, intensity, flux, peak })
    }

    /// The luminaire's distribution.
    pub fn web(&self) -> &PhotometricWeb {
        &self.web
    }

    /// Spectral intensity in a direction of render space.
    pub(in crate::light) fn intensity(&self, direction: Dir, w: &Wavelengths) -> Sampled<Radiance> {
        match self.light_from_render.direction(direction) {
            Some(d) => self.intensity.at(w) * (self.web.intensity(*d) as f32),
            None => Sampled::ZERO,
        }
    }

    /// E = I/r², A (20), from a point of the opening that `u` chooses.
    pub(in crate::light) fn sample(
        &self,
        from: &ReferencePoint,
        u: Vec2,
        w: &Wavelengths,
    ) -> Option<LightSample> {
        let p = self.place(u);
        let to = p - from.p.p;
        let wi = Dir::new(to)?;
        let radiance = self.intensity(-wi, w) / to.length_squared();
        if radiance.is_zero() || !radiance.is_finite() {
            return None;
        }
        let target = LightTarget::Point { p: BoundedPoint::exact(p), n: None };
        Some(LightSample { wi, radiance, density: Density::Delta, target })
    }

    /// The point of the opening that `u` chooses, in render space.
    pub(in crate::light) fn place(&self, u: Vec2) -> Point {
        let at = self.opening.sample(u);
        self.render_from_light.point(Point::new(at.x, at.y, 0.0))
    }

    pub(in crate::light) fn power(&self) -> LightPower {
        LightPower { watts: self.intensity.watts() * self.flux, lumens: self.intensity.lumens() * self.flux }
    }

    pub(in crate::light) fn bounds(&self, power: f32) -> EmitterBounds {
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let corner = |(x, y)| Point::new(x * self.opening.half_x, y * self.opening.half_y, 0.0);
        let nadir = Dir::new_unchecked(-Vec3::Z);
        let axis = self.render_from_light.direction(nadir).unwrap_or(nadir);
        EmitterBounds {
            bounds: Bounds3::from_points(corners.map(|c| self.render_from_light.point(corner(c)))),
            normals: Cone { axis, cos: (self.web.reach() as f32).to_radians().min(PI).cos() },
            // What rounds beyond the reach is dark anyway.
            cos_emission: 1e-3_f32.cos(),
            intensity: if self.flux > 0.0 { power * self.peak / self.flux } else { 0.0 },
            both_sides: false,
        }
    }
}
