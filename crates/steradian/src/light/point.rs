//! Lights at a point: isotropic, spot, by a picture of directions, and slide projectors.

use super::bounds::{Cone, EmitterBounds};
use super::contract::{LightError, LightPower, LightSample, LightTarget};
use super::normalise::{Emission, Stated};
use super::picture::EmissionPicture;
use crate::image::Image;
use crate::math::float::smoothstep;
use crate::math::warp::{equal_area_sphere_to_square, equal_area_square_to_sphere};
use crate::math::{BoundedPoint, Bounds3, Dir, Frame, Point, Transform, Vec2, Vec3};
use crate::shape::ReferencePoint;
use crate::spectrum::{Sampled, Spectrum, Wavelengths};
use crate::units::{Density, Radiance};
use glam::{Mat3, Mat4};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

/// Where a point light stands and how directions are measured there.
#[derive(Clone, Copy, Debug)]
struct Stand {
    position: Point,
    light_from_render: Transform,
}

impl Stand {
    fn new(render_from_light: Transform) -> Self {
        Self {
            position: render_from_light.point(Point::ORIGIN),
            light_from_render: render_from_light.inverse(),
        }
    }

    /// Unit direction in light space of light that leaves against `wi`.
    fn outgoing(&self, wi: Dir) -> Option<Vec3> {
        self.light_from_render.direction(-wi).map(Vec3::from)
    }

    /// The sample of a point light with radiant intensity `intensity` towards the receiver, A (20): E = I/r².
    fn sample(
        &self,
        from: &ReferencePoint,
        intensity: impl FnOnce(Dir) -> Option<Sampled<Radiance>>,
    ) -> Option<LightSample> {
        let to = self.position - from.p.p;
        let wi = Dir::new(to)?;
        let radiance = intensity(wi)? / to.length_squared();
        if radiance.is_zero() || !radiance.is_finite() {
            return None;
        }
        let target = LightTarget::Point { p: BoundedPoint::exact(self.position), n: None };
        Some(LightSample { wi, radiance, density: Density::Delta, target })
    }
}

impl Stand {
    /// A light here with the given intensity in directions within `cone` (light space, around +z) and `beyond` [rad] of it.
    fn bounds(&self, intensity: f32, cos: f32, beyond: f32) -> EmitterBounds {
        let axis = self.light_from_render.inverse().direction(Dir::Z).unwrap_or(Dir::Z);
        EmitterBounds {
            bounds: Bounds3::from_points([self.position]),
            normals: Cone { axis, cos },
            cos_emission: beyond.cos(),
            intensity,
            both_sides: false,
        }
    }
}

/// A point that shines equally in all directions.
#[derive(Clone, Debug)]
pub struct PointLight {
    stand: Stand,
    intensity: Emission,
}

impl PointLight {
    /// A light at `from` in light space. A stated total is a flux or the largest intensity.
    pub fn new(
        render_from_light: Transform,
        from: Point,
        intensity: Spectrum,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        let stand = Stand::new(render_from_light * Transform::translate(*from));
        Ok(Self { stand, intensity: Emission::new(intensity, stated, 4.0 * PI)? })
    }

    pub(super) fn sample(&self, from: &ReferencePoint, w: &Wavelengths) -> Option<LightSample> {
        self.stand.sample(from, |_| Some(self.intensity.at(w)))
    }

    pub(super) fn position(&self) -> Point {
        self.stand.position
    }

    pub(super) fn power(&self) -> LightPower {
        power(&self.intensity, 4.0 * PI)
    }

    pub(super) fn bounds(&self, power: f32) -> EmitterBounds {
        self.stand.bounds(power / (4.0 * PI), -1.0, 0.5 * PI)
    }
}

fn power(e: &Emission, geometry: f32) -> LightPower {
    LightPower { watts: e.watts() * geometry, lumens: e.lumens() * geometry }
}

/// A point that shines in a cone with a soft edge.
#[derive(Clone, Debug)]
pub struct SpotLight {
    stand: Stand,
    intensity: Emission,
    /// Cosine of the angle within which the light is full.
    cos_full: f32,
    /// Cosine of the angle beyond which it is dark.
    cos_dark: f32,
}

impl SpotLight {
    /// A light at `from` shining towards `to` (light space) in a cone of half angle `cone` degrees, of which the outer
    /// `delta` degrees fall off by a smoothstep of the cosine. A stated total is a flux or the largest intensity.
    ///
    /// As in pbrt-v4, a falloff wider than the cone begins at the mirrored angle `delta` − `cone`: the cosine is even.
    /// One wider than twice the cone would begin outside it; such a cone is full up to its edge.
    pub fn new(
        render_from_light: Transform,
        from: Point,
        to: Point,
        cone: f32,
        delta: f32,
        intensity: Spectrum,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        if !(cone > 0.0 && cone <= 180.0 && delta >= 0.0 && delta.is_finite()) {
            return Err(LightError::Cone { cone, delta });
        }
        let axis = Frame::from_z(Dir::new(to - from).ok_or(LightError::NoDirection)?);
        let rotation = Mat4::from_mat3(Mat3::from_cols(axis.s, axis.t, axis.n));
        let rotation = Transform::from_matrix(rotation).ok_or(LightError::Singular)?;
        let stand = Stand::new(render_from_light * Transform::translate(*from) * rotation);
        let full = (cone - delta).abs().min(cone);
        let (cos_full, cos_dark) = (full.to_radians().cos(), cone.to_radians().cos());
        let intensity = Emission::new(intensity, stated, Self::solid_angle(cos_full, cos_dark))?;
        Ok(Self { stand, intensity, cos_full, cos_dark })
    }

    /// ∫ falloff dω: the smoothstep is antisymmetric about the middle of the edge, which therefore counts half.
    fn solid_angle(cos_full: f32, cos_dark: f32) -> f32 {
        TAU * ((1.0 - cos_full) + 0.5 * (cos_full - cos_dark))
    }

    pub(super) fn sample(&self, from: &ReferencePoint, w: &Wavelengths) -> Option<LightSample> {
        self.stand.sample(from, |wi| {
            let falloff = smoothstep(self.stand.outgoing(wi)?.z, self.cos_dark, self.cos_full);
            (falloff > 0.0).then(|| self.intensity.at(w) * falloff)
        })
    }

    pub(super) fn position(&self) -> Point {
        self.stand.position
    }

    pub(super) fn power(&self) -> LightPower {
        power(&self.intensity, Self::solid_angle(self.cos_full, self.cos_dark))
    }

    pub(super) fn bounds(&self, power: f32) -> EmitterBounds {
        let intensity = power / Self::solid_angle(self.cos_full, self.cos_dark);
        let beyond = self.cos_dark.clamp(-1.0, 1.0).acos() - self.cos_full.clamp(-1.0, 1.0).acos();
        // The sum of both angles rounds; what lies on the edge is dark anyway.
        self.stand.bounds(intensity, self.cos_full, beyond + 1e-3)
    }
}

/// A point whose intensity is modulated by a picture of directions.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    stand: Stand,
    intensity: Emission,
    distribution: Arc<Image>,
    /// ∫ distribution dω [sr].
    solid_angle: f32,
}

impl GoniometricLight {
    /// A light at the origin of light space, y up; `distribution` is an equal-area octahedral square of factors, of
    /// which the channels are averaged. A stated total is a flux or the largest intensity.
    pub fn new(
        render_from_light: Transform,
        distribution: impl Into<Arc<Image>>,
        intensity: Spectrum,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        let distribution = distribution.into();
        let (width, height) = (distribution.width(), distribution.height());
        if width != height {
            return Err(LightError::NotSquare(width, height));
        }
        let (mut sum, mut peak) = (0.0_f64, 0.0_f32);
        for y in 0..height {
            for x in 0..width {
                let factor = mean(distribution.rgb(x, y).0);
                sum += f64::from(factor);
                peak = peak.max(factor);
            }
        }
        let solid_angle = (sum / (f64::from(width) * f64::from(height))) as f32 * 4.0 * PI;
        let stand = Stand::new(render_from_light * swap_yz().ok_or(LightError::Singular)?);
        let intensity = Emission::with_peak(intensity, stated, solid_angle, peak)?;
        Ok(Self { stand, intensity, distribution, solid_angle })
    }

    pub(super) fn sample(&self, from: &ReferencePoint, w: &Wavelengths) -> Option<LightSample> {
        self.stand.sample(from, |wi| {
            let st = equal_area_sphere_to_square(self.stand.outgoing(wi)?);
            let n = self.distribution.width();
            let index = |x: f32| ((x * n as f32) as u32).min(n - 1);
            Some(self.intensity.at(w) * mean(self.distribution.rgb(index(st.x), index(st.y)).0))
        })
    }

    pub(super) fn position(&self) -> Point {
        self.stand.position
    }

    pub(super) fn power(&self) -> LightPower {
        power(&self.intensity, self.solid_angle)
    }

    pub(super) fn bounds(&self, power: f32) -> EmitterBounds {
        self.stand.bounds(power / (4.0 * PI), -1.0, 0.5 * PI)
    }

    /// Direction in light space of a point of the distribution's square; the inverse of the lookup.
    pub fn direction(st: Vec2) -> Vec3 {
        let d = equal_area_square_to_sphere(st);
        Vec3::new(d.x, d.z, d.y)
    }
}

fn mean(rgb: Vec3) -> f32 {
    (rgb.element_sum() / 3.0).max(0.0)
}

/// The picture's pole is z, that of light space y (pbrt-v4).
fn swap_yz() -> Option<Transform> {
    Transform::from_matrix(Mat4::from_mat3(Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::Y)))
}

/// A slide projector: the picture is thrown along +z of light space.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    stand: Stand,
    slide: EmissionPicture,
    /// Half width and height of the slide at distance 1.
    half: Vec2,
}

impl ProjectionLight {
    /// A projector at the origin of light space with `fov` degrees across the slide's shorter side, its top
    /// towards +y. A stated total is a flux or the largest intensity.
    pub fn new(
        render_from_light: Transform,
        fov: f32,
        mut slide: EmissionPicture,
        stated: &Stated,
    ) -> Result<Self, LightError> {
        if !(fov > 0.0 && fov < 180.0) {
            return Err(LightError::FieldOfView(fov));
        }
        let aspect = slide.image().width() as f32 / slide.image().height() as f32;
        let shape = if aspect > 1.0 { Vec2::new(aspect, 1.0) } else { Vec2::new(1.0, 1.0 / aspect) };
        let half = shape * (fov.to_radians() * 0.5).tan();
        let mut light = Self { stand: Stand::new(render_from_light), slide: slide.clone(), half };
        let yields = slide.yields(light.flux(), slide.peak());
        slide.set_factor(stated.multiplier(&yields)?);
        light.slide = slide;
        Ok(light)
    }

    /// ∫ RGB dω over the slide: dω = cos³θ dA on the plane at distance 1.
    fn flux(&self) -> Vec3 {
        let area = 4.0 * self.half.x * self.half.y;
        let cos3 = |st: Vec2| {
            let p = (2.0 * st - Vec2::ONE) * self.half;
            (1.0 + p.length_squared()).powf(-1.5)
        };
        self.slide.mean(cos3) * area
    }

    pub(super) fn sample(&self, from: &ReferencePoint, w: &Wavelengths) -> Option<LightSample> {
        self.stand.sample(from, |wi| {
            let d = self.stand.outgoing(wi)?;
            if d.z <= 0.0 {
                return None;
            }
            let p = Vec2::new(d.x, -d.y) / (d.z * self.half);
            let inside = p.abs().cmple(Vec2::ONE).all();
            inside.then(|| self.slide.light(self.slide.nearest((p + Vec2::ONE) * 0.5), w))
        })
    }

    pub(super) fn position(&self) -> Point {
        self.stand.position
    }

    pub(super) fn power(&self) -> LightPower {
        self.slide.integrals(self.flux())
    }

    pub(super) fn bounds(&self, power: f32) -> EmitterBounds {
        let cos_corner = (1.0 + self.half.length_squared()).sqrt().recip();
        self.stand.bounds(power / (4.0 * self.half.x * self.half.y), cos_corner, 1e-3)
    }
}
