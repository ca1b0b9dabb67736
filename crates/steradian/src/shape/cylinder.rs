//! Open cylinders and sectors of them.

use super::contract::{
    Orientation, PrimHit, ReferencePoint, ShapeError, ShapeSample, ShapeSampleToward, area_density_toward,
};
use super::placement::{self, ObjectSurface, Placement};
use crate::math::{Bounds3, Dir, Point, Ray, SurfacePoint, Transform, Vec2};
use crate::units::{PdfArea, PdfSolidAngle};
use glam::DVec3;

/// A cylinder about the object-space z axis, parametrised by azimuth (u) and height (v).
#[derive(Clone, Debug)]
pub struct Cylinder {
    placement: Placement,
    radius: f64,
    z_min: f64,
    z_max: f64,
    phi_max: f64,
    area: f64,
}

impl Cylinder {
    /// A cylinder of `radius` between `z_min` and `z_max` (in either order), swept over `phi_max` degrees.
    pub fn new(
        radius: f32,
        z_min: f32,
        z_max: f32,
        phi_max: f32,
        render_from_object: &Transform,
        orientation: Orientation,
    ) -> Result<Self, ShapeError> {
        let (a, b) = (placement::finite("zmin", z_min)?, placement::finite("zmax", z_max)?);
        if a == b {
            return Err(ShapeError::Parameter { name: "zmax", value: z_max, rule: "different from zmin" });
        }
        let mut cylinder = Self {
            placement: Placement::new(render_from_object, orientation)?,
            radius: placement::positive("radius", radius)?,
            z_min: a.min(b),
            z_max: a.max(b),
            phi_max: placement::sweep(phi_max)?,
            area: 0.0,
        };
        cylinder.area = cylinder.compute_area();
        Ok(cylinder)
    }

    fn object_area(&self) -> f64 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    /// Exact under similarities; else by the midpoint rule over φ, on which alone the stretch depends.
    fn compute_area(&self) -> f64 {
        if let Some(s) = self.placement.scale() {
            return self.object_area() * s * s;
        }
        const STEPS: u32 = 1024;
        let sum: f64 = (0..STEPS)
            .map(|i| {
                let (sin, cos) = ((f64::from(i) + 0.5) / f64::from(STEPS) * self.phi_max).sin_cos();
                self.placement.area_factor(DVec3::new(cos, sin, 0.0))
            })
            .sum();
        self.object_area() * sum / f64::from(STEPS)
    }

    /// Smallest box in render space around the object-space box of the full cylinder.
    pub fn bounds(&self) -> Bounds3 {
        let r = self.radius;
        self.placement.box_bounds(DVec3::new(-r, -r, self.z_min), DVec3::new(r, r, self.z_max))
    }

    /// Area in render space [scene units²].
    pub fn area(&self) -> f32 {
        self.area as f32
    }

    fn surface_point(&self, (o, d): (DVec3, DVec3), t: f64) -> DVec3 {
        let p = o + d * t;
        let k = self.radius / p.x.hypot(p.y);
        DVec3::new(p.x * k, p.y * k, p.z)
    }

    /// Nearest intersection at 0 < t ≤ `t_max`; coordinates are φ [rad] and object-space z.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        let (o, d) = self.placement.object_ray(ray);
        let a = d.x * d.x + d.y * d.y;
        if a == 0.0 {
            return None;
        }
        let half_b = o.x * d.x + o.y * d.y;
        // As for the sphere: the radicand from the distance of the axis to the line.
        let closest = (o.x - d.x * (half_b / a)).hypot(o.y - d.y * (half_b / a));
        let radicand = a * (self.radius + closest) * (self.radius - closest);
        if !(radicand >= 0.0) {
            return None;
        }
        let r_o = o.x.hypot(o.y);
        let c = (r_o + self.radius) * (r_o - self.radius);
        let q = -(half_b + radicand.sqrt().copysign(half_b));
        let (t0, t1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
        placement::first_root((t0.min(t1), t0.max(t1)), t_max, |t| {
            let p = self.surface_point((o, d), t);
            let phi = placement::azimuth(p.x, p.y);
            let inside = p.z >= self.z_min && p.z <= self.z_max && phi <= self.phi_max;
            inside.then_some([phi, p.z])
        })
    }

    /// Differential geometry at a hit of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let p = self.surface_point(self.placement.object_ray(ray), f64::from(hit.t));
        let n = DVec3::new(p.x, p.y, 0.0) / self.radius;
        let dpdu = DVec3::new(-p.y, p.x, 0.0) * self.phi_max;
        let s = ObjectSurface {
            p,
            uv: self.uv(p),
            dpdu,
            dpdv: DVec3::new(0.0, 0.0, self.z_max - self.z_min),
            n,
            dndu: dpdu / self.radius,
            dndv: DVec3::ZERO,
        };
        self.placement.surface(&s, ray.time)
    }

    fn uv(&self, p: DVec3) -> Vec2 {
        let phi = placement::azimuth(p.x, p.y);
        Vec2::new((phi / self.phi_max) as f32, ((p.z - self.z_min) / (self.z_max - self.z_min)) as f32)
    }

    /// Chooses a point by area, uniformly in object space.
    pub fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let z = self.z_min + f64::from(u.x) * (self.z_max - self.z_min);
        let (sin, cos) = (f64::from(u.y) * self.phi_max).sin_cos();
        let p = DVec3::new(self.radius * cos, self.radius * sin, z);
        self.placement.sample(p, DVec3::new(cos, sin, 0.0), self.uv(p), 1.0 / self.object_area())
    }

    /// Chooses a point by area, expressed per solid angle at `from`.
    pub fn sample_toward(&self, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        self.sample_area(u)?.toward(from)
    }

    /// Density of [`Cylinder::sample_toward`] for the direction `wi`, which meets the cylinder at `hit`.
    pub fn pdf_toward(&self, from: &ReferencePoint, wi: Dir, hit: &SurfacePoint) -> PdfSolidAngle {
        area_density_toward(self.area_density(hit.p.p), from, wi, hit)
    }

    fn area_density(&self, p: Point) -> PdfArea {
        let p = self.placement.object_point(p);
        let n = DVec3::new(p.x, p.y, 0.0) / self.radius;
        PdfArea((1.0 / (self.object_area() * self.placement.area_factor(n))) as f32)
    }
}
