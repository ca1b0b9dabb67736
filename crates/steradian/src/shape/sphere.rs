//! Spheres, whole or cut by two planes of constant z and a sweep angle.

use super::contract::{
    Orientation, PrimHit, ReferencePoint, ShapeError, ShapeSample, ShapeSampleToward, area_density_toward,
};
use super::placement::{self, ObjectSurface, Placement};
use super::rounding;
use crate::math::{Bounds3, Dir, Frame, Point, Ray, SurfacePoint, Transform, Vec2, Vec3};
use crate::units::{PdfArea, PdfSolidAngle};
use glam::DVec3;
use std::f64::consts::TAU;

/// A sphere about the object-space origin, parametrised by azimuth (u) and polar angle (v, from −z to +z).
#[derive(Clone, Debug)]
pub struct Sphere {
    placement: Placement,
    radius: f64,
    z_min: f64,
    z_max: f64,
    theta_z_min: f64,
    theta_z_max: f64,
    phi_max: f64,
    area: f64,
}

/// How points on a sphere are chosen from a reference point.
enum Strategy {
    /// Uniformly in the cone that the sphere subtends.
    Cone(Cone),
    /// By area: from inside, for a part of a sphere, for an ellipsoid.
    Area,
}

struct Cone {
    center: DVec3,
    radius: f64,
    to_center: DVec3,
    sin2_max: f64,
    one_minus_cos_max: f64,
}

impl Sphere {
    /// A sphere of `radius` between `z_min` and `z_max` (in either order, clamped to the sphere), swept over
    /// `phi_max` degrees.
    pub fn new(
        radius: f32,
        z_min: f32,
        z_max: f32,
        phi_max: f32,
        render_from_object: &Transform,
        orientation: Orientation,
    ) -> Result<Self, ShapeError> {
        let placement = Placement::new(render_from_object, orientation)?;
        let radius = placement::positive("radius", radius)?;
        let cut = |name, z: f32| match z.is_nan() {
            true => Err(ShapeError::Parameter { name, value: z, rule: "a number" }),
            false => Ok(f64::from(z).clamp(-radius, radius)),
        };
        let (a, b) = (cut("zmin", z_min)?, cut("zmax", z_max)?);
        let (z_min, z_max) = (a.min(b), a.max(b));
        let phi_max = placement::sweep(phi_max)?;
        let mut sphere = Self {
            placement,
            radius,
            z_min,
            z_max,
            theta_z_min: (z_min / radius).acos(),
            theta_z_max: (z_max / radius).acos(),
            phi_max,
            area: 0.0,
        };
        sphere.area = sphere.compute_area();
        Ok(sphere)
    }

    fn object_area(&self) -> f64 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    /// Exact under similarities, else by the midpoint rule over (z, φ), in which object-space area is uniform.
    fn compute_area(&self) -> f64 {
        if let Some(s) = self.placement.scale() {
            return self.object_area() * s * s;
        }
        const STEPS: u32 = 64;
        let mut sum = 0.0;
        for i in 0..STEPS {
            for j in 0..STEPS {
                let (fz, fphi) =
                    ((f64::from(i) + 0.5) / f64::from(STEPS), (f64::from(j) + 0.5) / f64::from(STEPS));
                sum += self.placement.area_factor(self.point_by_area(fz, fphi) / self.radius);
            }
        }
        self.object_area() * sum / f64::from(STEPS * STEPS)
    }

    /// The object-space point at fractions of the height and of the sweep.
    fn point_by_area(&self, fz: f64, fphi: f64) -> DVec3 {
        let z = self.z_min + fz * (self.z_max - self.z_min);
        let r = (self.radius * self.radius - z * z).max(0.0).sqrt();
        let (sin, cos) = (fphi * self.phi_max).sin_cos();
        DVec3::new(r * cos, r * sin, z)
    }

    fn is_whole(&self) -> bool {
        self.z_min <= -self.radius && self.z_max >= self.radius && self.phi_max >= TAU
    }

    /// Smallest box in render space around the whole sphere, or around the box of the part.
    pub fn bounds(&self) -> Bounds3 {
        let r = DVec3::splat(self.radius);
        if self.is_whole() {
            return self.placement.ellipsoid_bounds(DVec3::ZERO, r);
        }
        let (lo, hi) = (DVec3::new(-r.x, -r.y, self.z_min), DVec3::new(r.x, r.y, self.z_max));
        self.placement.box_bounds(lo, hi)
    }

    /// Area in render space [scene units²].
    pub fn area(&self) -> f32 {
        self.area as f32
    }

    fn surface_point(&self, (o, d): (DVec3, DVec3), t: f64) -> DVec3 {
        let p = o + d * t;
        p * (self.radius / p.length())
    }

    fn phi(&self, p: DVec3) -> f64 {
        placement::azimuth(p.x, p.y)
    }

    /// Nearest intersection at 0 < t ≤ `t_max`; coordinates are φ [rad] and object-space z.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        let (o, d) = self.placement.object_ray(ray);
        let a = d.length_squared();
        let half_b = o.dot(d);
        // The radicand from the distance of the centre to the line: subtracting squares of long distances instead
        // would cancel (Haines et al. 2019).
        let closest = (o - d * (half_b / a)).length();
        let radicand = a * (self.radius + closest) * (self.radius - closest);
        if !(radicand >= 0.0) {
            return None;
        }
        let c = (o.length() + self.radius) * (o.length() - self.radius);
        let q = -(half_b + radicand.sqrt().copysign(half_b));
        let (t0, t1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
        placement::first_root((t0.min(t1), t0.max(t1)), t_max, |t| {
            let p = self.surface_point((o, d), t);
            let phi = self.phi(p);
            let outside = (self.z_min > -self.radius && p.z < self.z_min)
                || (self.z_max < self.radius && p.z > self.z_max)
                || phi > self.phi_max;
            (!outside).then_some([phi, p.z])
        })
    }

    /// Differential geometry at a hit of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let p = self.surface_point(self.placement.object_ray(ray), f64::from(hit.t));
        let phi = self.phi(p);
        let sin_theta = ((p.x * p.x + p.y * p.y).sqrt() / self.radius).min(1.0);
        let span = self.theta_z_max - self.theta_z_min;
        let theta = sin_theta.atan2(p.z / self.radius);
        let (sin_phi, cos_phi) = phi.sin_cos();
        let dpdu = DVec3::new(-p.y, p.x, 0.0) * self.phi_max;
        let dpdv = DVec3::new(p.z * cos_phi, p.z * sin_phi, -self.radius * sin_theta) * span;
        let uv = Vec2::new((phi / self.phi_max) as f32, ((theta - self.theta_z_min) / span) as f32);
        let (n, r) = (p / self.radius, self.radius);
        let s = ObjectSurface { p, uv, dpdu, dpdv, n, dndu: dpdu / r, dndv: dpdv / r };
        self.placement.surface(&s, ray.time)
    }

    fn uv(&self, p: DVec3) -> Vec2 {
        let theta = (p.x * p.x + p.y * p.y).sqrt().atan2(p.z);
        let v = (theta - self.theta_z_min) / (self.theta_z_max - self.theta_z_min);
        Vec2::new((self.phi(p) / self.phi_max) as f32, v as f32)
    }

    /// Chooses a point by area, uniformly in object space.
    pub fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let p = self.point_by_area(f64::from(u.x), f64::from(u.y));
        self.placement.sample(p, p / self.radius, self.uv(p), 1.0 / self.object_area())
    }

    fn strategy(&self, from: &ReferencePoint) -> Strategy {
        let (Some(scale), true) = (self.placement.scale(), self.is_whole()) else { return Strategy::Area };
        let center = self.placement.render_point(DVec3::ZERO);
        let radius = self.radius * scale;
        let o = from.offset_origin((center - from.p.p.as_dvec3()).as_vec3()).as_dvec3();
        if o.distance_squared(center) <= radius * radius {
            return Strategy::Area;
        }
        let to_center = center - from.p.p.as_dvec3();
        let sin2_max = (radius * radius / to_center.length_squared()).min(1.0);
        // 1 − cos from sin² without cancellation, for cones of any size.
        let one_minus_cos_max = sin2_max / (1.0 + (1.0 - sin2_max).sqrt());
        Strategy::Cone(Cone { center, radius, to_center, sin2_max, one_minus_cos_max })
    }

    /// Chooses a point by the solid angle at `from`: uniformly in the cone of the sphere from outside, else by area.
    pub fn sample_toward(&self, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        let cone = match self.strategy(from) {
            Strategy::Cone(cone) => cone,
            Strategy::Area => return self.sample_area(u)?.toward(from),
        };
        let one_minus_cos = f64::from(u.x) * cone.one_minus_cos_max;
        let (cos, sin2) = (1.0 - one_minus_cos, one_minus_cos * (2.0 - one_minus_cos));
        // Angle α at the centre between the axis and the point where the direction meets the sphere.
        let sin_max = cone.sin2_max.sqrt();
        let cos_alpha = sin2 / sin_max + cos * (1.0 - sin2 / cone.sin2_max).max(0.0).sqrt();
        let sin_alpha = (1.0 - cos_alpha * cos_alpha).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (f64::from(u.y) * TAU).sin_cos();
        let axis = cone.to_center.try_normalize()?;
        let frame = Frame::from_z(Vec3::from(Dir::new(axis.as_vec3())?));
        let n = frame.s.as_dvec3() * (-sin_alpha * cos_phi) + frame.t.as_dvec3() * (-sin_alpha * sin_phi)
            - axis * cos_alpha;
        let n = n.try_normalize()?;
        let p = rounding::bounded(
            cone.center + n * cone.radius,
            (cone.center.abs() + n.abs() * cone.radius).as_vec3(),
        );
        let object = self.placement.object_point(p.p);
        let object = object * (self.radius / object.length());
        Some(ShapeSampleToward {
            p,
            n: self.placement.oriented_normal(object / self.radius)?,
            uv: self.uv(object),
            wi: Dir::new(p.p - from.p.p)?,
            density: PdfSolidAngle((1.0 / (TAU * cone.one_minus_cos_max)) as f32),
        })
    }

    /// Density of [`Sphere::sample_toward`] for the direction `wi`, which meets the sphere at `hit`.
    pub fn pdf_toward(&self, from: &ReferencePoint, wi: Dir, hit: &SurfacePoint) -> PdfSolidAngle {
        match self.strategy(from) {
            Strategy::Cone(cone) => PdfSolidAngle((1.0 / (TAU * cone.one_minus_cos_max)) as f32),
            Strategy::Area => area_density_toward(self.area_density(hit.p.p), from, wi, hit),
        }
    }

    fn area_density(&self, p: Point) -> PdfArea {
        let n = self.placement.object_point(p) / self.radius;
        PdfArea((1.0 / (self.object_area() * self.placement.area_factor(n))) as f32)
    }
}
