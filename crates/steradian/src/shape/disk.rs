//! Disks, annuli and sectors of them.

use super::contract::{
    Orientation, PrimHit, ReferencePoint, ShapeError, ShapeSample, ShapeSampleToward, area_density_toward,
};
use super::placement::{self, ObjectSurface, Placement};
use crate::math::{Bounds3, Dir, Ray, SurfacePoint, Transform, Vec2, warp};
use crate::units::{PdfArea, PdfSolidAngle};
use glam::DVec3;
use std::f64::consts::TAU;

/// An annulus in the plane z = height of object space, facing +z; v runs from the rim (0) to the centre (1).
#[derive(Clone, Debug)]
pub struct Disk {
    placement: Placement,
    height: f64,
    radius: f64,
    inner_radius: f64,
    phi_max: f64,
}

impl Disk {
    /// A disk of `radius` at z = `height` without the part nearer than `inner_radius` to the axis, swept over
    /// `phi_max` degrees.
    pub fn new(
        height: f32,
        radius: f32,
        inner_radius: f32,
        phi_max: f32,
        render_from_object: &Transform,
        orientation: Orientation,
    ) -> Result<Self, ShapeError> {
        if !(0.0..radius).contains(&inner_radius) {
            let rule = "at least 0 and less than the radius";
            return Err(ShapeError::Parameter { name: "innerradius", value: inner_radius, rule });
        }
        Ok(Self {
            placement: Placement::new(render_from_object, orientation)?,
            height: placement::finite("height", height)?,
            radius: placement::positive("radius", radius)?,
            inner_radius: f64::from(inner_radius),
            phi_max: placement::sweep(phi_max)?,
        })
    }

    fn object_area(&self) -> f64 {
        0.5 * self.phi_max * (self.radius * self.radius - self.inner_radius * self.inner_radius)
    }

    /// Smallest box in render space around the full disk.
    pub fn bounds(&self) -> Bounds3 {
        let center = DVec3::new(0.0, 0.0, self.height);
        self.placement.ellipsoid_bounds(center, DVec3::new(self.radius, self.radius, 0.0))
    }

    /// Area in render space [scene units²].
    pub fn area(&self) -> f32 {
        (self.object_area() * self.placement.area_factor(DVec3::Z)) as f32
    }

    /// Intersection at 0 < t ≤ `t_max`; coordinates are φ [rad] and the object-space radius. A ray in the plane misses.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        let (o, d) = self.placement.object_ray(ray);
        if d.z == 0.0 {
            return None;
        }
        let t = (self.height - o.z) / d.z;
        placement::first_root((t, t), t_max, |t| {
            let p = o + d * t;
            let r2 = p.x * p.x + p.y * p.y;
            let phi = placement::azimuth(p.x, p.y);
            let inside = r2 <= self.radius * self.radius
                && r2 >= self.inner_radius * self.inner_radius
                && phi <= self.phi_max;
            inside.then(|| [phi, r2.sqrt()])
        })
    }

    /// Differential geometry at a hit of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let (o, d) = self.placement.object_ray(ray);
        let mut p = o + d * f64::from(hit.t);
        p.z = self.height;
        let r = p.x.hypot(p.y);
        // At the very centre the radial direction is arbitrary.
        let radial = if r > 0.0 { DVec3::new(p.x / r, p.y / r, 0.0) } else { DVec3::X };
        let tangential = DVec3::new(-radial.y, radial.x, 0.0);
        // ∂p/∂u vanishes at the centre; its direction is kept for the frames that are built on it.
        let s = ObjectSurface {
            p,
            uv: self.uv(p),
            dpdu: tangential * (self.phi_max * r.max(1e-6 * self.radius)),
            dpdv: radial * (self.inner_radius - self.radius),
            n: DVec3::Z,
            dndu: DVec3::ZERO,
            dndv: DVec3::ZERO,
        };
        self.placement.surface(&s, ray.time)
    }

    fn uv(&self, p: DVec3) -> Vec2 {
        let phi = placement::azimuth(p.x, p.y);
        let v = (self.radius - p.x.hypot(p.y)) / (self.radius - self.inner_radius);
        Vec2::new((phi / self.phi_max) as f32, v as f32)
    }

    /// Chooses a point uniformly by area: concentrically on a full disk, by (r², φ) on a part.
    pub fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let (x, y) = if self.inner_radius == 0.0 && self.phi_max >= TAU {
            let d = warp::concentric_disk(u).as_dvec2() * self.radius;
            (d.x, d.y)
        } else {
            let (r2, i2) = (self.radius * self.radius, self.inner_radius * self.inner_radius);
            let r = (i2 + f64::from(u.x) * (r2 - i2)).sqrt();
            let (sin, cos) = (f64::from(u.y) * self.phi_max).sin_cos();
            (r * cos, r * sin)
        };
        let p = DVec3::new(x, y, self.height);
        self.placement.sample(p, DVec3::Z, self.uv(p), 1.0 / self.object_area())
    }

    /// Chooses a point by area, expressed per solid angle at `from`.
    pub fn sample_toward(&self, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        self.sample_area(u)?.toward(from)
    }

    /// Density of [`Disk::sample_toward`] for the direction `wi`, which meets the disk at `hit`.
    pub fn pdf_toward(&self, from: &ReferencePoint, wi: Dir, hit: &SurfacePoint) -> PdfSolidAngle {
        area_density_toward(PdfArea(1.0 / self.area()), from, wi, hit)
    }
}
