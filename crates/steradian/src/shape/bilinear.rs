//! Meshes of bilinear patches: quadrilaterals, planar or not.

use super::contract::{
    Orientation, PrimHit, ReferencePoint, ShapeError, ShapeSample, ShapeSampleToward, area_density_toward,
};
use super::{rounding, spherical, triangle::MIN_CORNER_WEIGHT, validate};
use crate::math::{
    BoundedPoint, Bounds3, Dir, Normal, Point, Ray, Shading, SurfacePoint, Transform, Vec2, Vec3, warp,
};
use crate::units::{PdfArea, PdfSolidAngle};
use glam::{DVec3, Quat};

/// What a mesh of patches is made of, in object space. Empty attribute arrays mean "not given".
#[derive(Clone, Debug, Default)]
pub struct PatchData {
    /// Vertex indices of each patch: the corners (u, v) = (0,0), (1,0), (0,1), (1,1).
    pub indices: Vec<[u32; 4]>,
    /// Vertex positions.
    pub positions: Vec<Point>,
    /// Shading normals per vertex, of any length.
    pub normals: Vec<Vec3>,
    /// Texture coordinates per vertex.
    pub uvs: Vec<Vec2>,
    /// One number per patch for per-face data.
    pub face_indices: Vec<u32>,
}

/// A mesh of bilinear patches in render space.
#[derive(Clone, Debug)]
pub struct BilinearMesh {
    indices: Vec<[u32; 4]>,
    positions: Vec<Point>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    face_indices: Vec<u32>,
    flip: bool,
}

/// The corners of one patch.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Corners (u, v) = (0,0), (1,0), (0,1), (1,1).
    pub corners: [Point; 4],
}

/// Solid angles [sr] above which rectangles are sampled by solid angle, as in pbrt-v4.
const MIN_SPHERICAL_SAMPLING: f64 = 1e-4;

fn bilinear<T>(c: [T; 4], u: f64, v: f64) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let [c00, c10, c01, c11] = c;
    (c00 * (1.0 - u) + c10 * u) * (1.0 - v) + (c01 * (1.0 - u) + c11 * u) * v
}

/// Derivatives of a bilinear quantity by u and v.
fn derivatives(c: [DVec3; 4], u: f64, v: f64) -> (DVec3, DVec3) {
    let [c00, c10, c01, c11] = c;
    ((c10 - c00) * (1.0 - v) + (c11 - c01) * v, (c01 - c00) * (1.0 - u) + (c11 - c10) * u)
}

impl Patch {
    fn corners_f64(&self) -> [DVec3; 4] {
        self.corners.map(|p| p.as_dvec3())
    }

    /// Smallest box around the patch, which lies in the hull of its corners.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::from_points(self.corners)
    }

    /// Nearest intersection at 0 < t ≤ `t_max`, with patch coordinates (Reshetov 2019), in f64.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimHit> {
        let (o, d) = (ray.o.as_dvec3(), ray.d.as_dvec3());
        let [q00, q10, q01, q11] = self.corners_f64().map(|p| p - o);
        let (e00, e11) = (q01 - q00, q11 - q10);
        // u where the ruling lines of constant u meet the ray's line: a + b u + c u² = 0.
        let a = q00.cross(d).dot(e00);
        let c = (q10 - q00).cross(q01 - q11).dot(d);
        let b = q10.cross(d).dot(e11) - a - c;
        let (u0, u1) = quadratic(a, b, c)?;
        // Nearer than the rounding of f64 a hit is that of the surface which the ray leaves: where a coordinate is exactly zero,
        // its error bound is too, and the ray begins in the patch itself.
        const NEAREST: f64 = 1e-12;
        let reach = [q00, q10, q01, q11].map(|q| q.abs().max_element()).into_iter().fold(0.0, f64::max);
        let nearest = NEAREST * reach / d.length();
        let mut best: Option<PrimHit> = None;
        // Both roots, if they differ.
        for u in [Some(u0), (u1 != u0).then_some(u1)].into_iter().flatten() {
            // Wide enough for the rounding of u, so that neighbours overlap instead of gaping.
            const MARGIN: f64 = 1e-12;
            if !(-MARGIN..=1.0 + MARGIN).contains(&u) {
                continue;
            }
            let u = u.clamp(0.0, 1.0);
            let from = q00 + (q10 - q00) * u;
            let along = e00 + (e11 - e00) * u;
            let n = d.cross(along);
            let det = n.length_squared();
            if det == 0.0 {
                continue;
            }
            let m = n.cross(from);
            let (t, v) = (m.dot(along) / det, m.dot(d) / det);
            let rounded = t as f32;
            let inside = (-MARGIN..=1.0 + MARGIN).contains(&v);
            let limit = best.map_or(t_max, |h| h.t);
            if inside && t > nearest && rounded > 0.0 && rounded <= limit {
                best = Some(PrimHit { t: rounded, u: u as f32, v: v.clamp(0.0, 1.0) as f32 });
            }
        }
        best
    }

    fn is_rectangle(&self) -> bool {
        let [p00, p10, p01, p11] = self.corners_f64();
        if p00 == p01 || p01 == p11 || p11 == p10 || p10 == p00 {
            return false;
        }
        let Some(n) = (p10 - p00).cross(p01 - p00).try_normalize() else { return false };
        if (p11 - p00).normalize_or_zero().dot(n).abs() > 1e-5 {
            return false;
        }
        let center = (p00 + p10 + p01 + p11) * 0.25;
        let distances = [p00, p10, p01, p11].map(|p| p.distance_squared(center));
        distances.iter().all(|d| (d - distances[0]).abs() <= 1e-4 * distances[0])
    }

    /// A corner and two edges if the patch is a planar rectangle, within the tolerance of pbrt-v4.
    fn rectangle(&self) -> Option<(Point, [DVec3; 2])> {
        let [p00, p10, p01, _] = self.corners_f64();
        self.is_rectangle().then(|| (self.corners[0], [p10 - p00, p01 - p00]))
    }

    fn area(&self) -> f64 {
        if let Some((_, e)) = self.rectangle() {
            return e[0].length() * e[1].length();
        }
        const STEPS: u32 = 16;
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let cells = (0..STEPS * STEPS).map(|k| self.area_density(at(k % STEPS), at(k / STEPS)));
        cells.sum::<f64>() / f64::from(STEPS * STEPS)
    }

    /// Area per unit of (u, v).
    fn area_density(&self, u: f64, v: f64) -> f64 {
        let (dpdu, dpdv) = derivatives(self.corners_f64(), u, v);
        dpdu.cross(dpdv).length()
    }

    /// Weights of the (u, v) warp that approximates uniform area: the area density at the corners.
    fn area_weights(&self) -> [f32; 4] {
        let at = |u: f64, v: f64| self.area_density(u, v) as f32;
        [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)]
    }

    fn point_at(&self, u: f64, v: f64) -> BoundedPoint {
        let c = self.corners_f64();
        rounding::bounded(bilinear(c, u, v), bilinear(c.map(DVec3::abs), u, v).as_vec3())
    }

    /// Directions to the corners in the order of (u, v), and the rectangle, if it is to be sampled by solid angle.
    fn spherical(&self, from: &ReferencePoint) -> Option<SphericalPatch> {
        let (corner, edges) = self.rectangle()?;
        let solid_angle = spherical::rectangle_solid_angle(corner, edges, from.p.p);
        if solid_angle <= MIN_SPHERICAL_SAMPLING {
            return None;
        }
        let weights = match from.ns {
            Some(ns) => {
                let directions = spherical::directions_to(self.corners, from.p.p)?;
                Some(directions.map(|d| d.as_vec3().dot(*ns).abs().max(MIN_CORNER_WEIGHT)))
            }
            None => None,
        };
        Some(SphericalPatch { corner, edges, solid_angle, weights })
    }
}

struct SphericalPatch {
    corner: Point,
    edges: [DVec3; 2],
    solid_angle: f64,
    /// Cosines to the shading normal at the corners, if there is one.
    weights: Option<[f32; 4]>,
}

/// Real roots of a + b u + c u² = 0, which may be linear; `None` without roots.
fn quadratic(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    // A parallelogram seen from anywhere has c = 0 but for rounding.
    if c.abs() <= 1e-14 * (a.abs() + b.abs()) {
        return (b != 0.0).then(|| (-a / b, -a / b));
    }
    crate::math::float::solve_quadratic(c, b, a)
}

impl BilinearMesh {
    /// Transforms a mesh of patches to render space and checks it as [`super::TriangleMesh::new`] does.
    pub fn new(
        data: PatchData,
        render_from_object: &Transform,
        orientation: Orientation,
    ) -> Result<Self, ShapeError> {
        let PatchData { indices, mut positions, mut normals, uvs, face_indices } = data;
        let count = positions.len();
        validate::check_length("normals", normals.len(), count)?;
        validate::check_length("uvs", uvs.len(), count)?;
        validate::check_length("face indices", face_indices.len(), indices.len())?;
        validate::check_indices(&indices, count)?;
        validate::transform_positions(&mut positions, render_from_object)?;
        validate::transform_normals(&mut normals, render_from_object, orientation)?;
        validate::check_uvs(&uvs)?;
        let flip = orientation.flips_normals(render_from_object);
        Ok(Self { indices, positions, normals, uvs, face_indices, flip })
    }

    /// Number of patches.
    pub fn patch_count(&self) -> u32 {
        self.indices.len() as u32
    }

    /// Bytes held on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.indices[..])
            + size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.uvs[..])
            + size_of_val(&self.face_indices[..])
    }

    fn gather<T: Copy>(&self, values: &[T], patch: u32) -> [T; 4] {
        self.indices[patch as usize].map(|i| values[i as usize])
    }

    /// The corners of a patch.
    pub fn patch(&self, patch: u32) -> Patch {
        Patch { corners: self.gather(&self.positions, patch) }
    }

    /// Smallest box around all patches.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::from_points(self.indices.iter().flatten().map(|&i| self.positions[i as usize]))
    }

    /// Area of a patch [scene units²]; a patch that is not a rectangle is integrated numerically.
    pub fn area(&self, patch: u32) -> f32 {
        self.patch(patch).area() as f32
    }

    fn uv_at(&self, patch: u32, u: f64, v: f64) -> Vec2 {
        if self.uvs.is_empty() {
            return Vec2::new(u as f32, v as f32);
        }
        bilinear(self.gather(&self.uvs, patch).map(|t| t.as_dvec2()), u, v).as_vec2()
    }

    fn corner_normals(&self, patch: u32) -> Option<[DVec3; 4]> {
        (!self.normals.is_empty()).then(|| self.gather(&self.normals, patch).map(|n| n.as_dvec3()))
    }

    /// The geometric normal, on the side of the shading normal if the mesh has normals, else by orientation.
    fn geometric_normal(&self, patch: u32, u: f64, v: f64) -> Option<Normal> {
        let (dpdu, dpdv) = derivatives(self.patch(patch).corners_f64(), u, v);
        let n = rounding::normalized(dpdu.cross(dpdv))?;
        Some(match self.corner_normals(patch) {
            Some(c) => n.facing(bilinear(c, u, v).as_vec3()),
            None if self.flip => -n,
            None => n,
        })
    }

    /// Differential geometry at a hit.
    pub fn surface(&self, patch: u32, hit: &PrimHit, time: f32) -> SurfacePoint {
        let (u, v) = (f64::from(hit.u), f64::from(hit.v));
        let shape = self.patch(patch);
        let corners = shape.corners_f64();
        let (mut dpdu, mut dpdv) = derivatives(corners, u, v);
        // Where the parametrisation collapses (two corners coincide) the patch's own plane serves.
        let ng =
            self.geometric_normal(patch, u, v).or_else(|| self.plane_normal(&corners)).unwrap_or(Normal::Z);
        let (mut dndu, mut dndv) = weingarten(&corners, dpdu, dpdv, ng.as_dvec3());
        let mut shading_normal = None;
        if let Some(c) = self.corner_normals(patch) {
            shading_normal = Normal::new(bilinear(c, u, v).as_vec3());
            (dndu, dndv) = derivatives(c, u, v);
        }
        if let Some(inverse) = self.uv_inverse(patch, u, v) {
            let [[duds, dvds], [dudt, dvdt]] = inverse;
            let (dpds, mut dpdt) = (dpdu * duds + dpdv * dvds, dpdu * dudt + dpdv * dvdt);
            let turned = dpdu.cross(dpdv).dot(dpds.cross(dpdt));
            if turned != 0.0 {
                let sign = turned.signum();
                dpdt *= sign;
                (dndu, dndv) = (dndu * duds + dndv * dvds, (dndu * dudt + dndv * dvdt) * sign);
                (dpdu, dpdv) = (dpds, dpdt);
            }
        }
        let (dpdu, dpdv) = (dpdu.as_vec3(), dpdv.as_vec3());
        let (mut shading_dpdu, mut shading_dpdv) = (dpdu, dpdv);
        if let Some(ns) = shading_normal {
            let turn = Quat::from_rotation_arc(*ng, *ns);
            (shading_dpdu, shading_dpdv) = (turn * dpdu, turn * dpdv);
        }
        SurfacePoint {
            p: shape.point_at(u, v),
            ng,
            uv: self.uv_at(patch, u, v),
            dpdu,
            dpdv,
            shading: Shading {
                n: shading_normal.unwrap_or(ng),
                dpdu: shading_dpdu,
                dpdv: shading_dpdv,
                dndu: dndu.as_vec3(),
                dndv: dndv.as_vec3(),
            },
            time,
            face: self.face_indices.get(patch as usize).copied().unwrap_or(0),
        }
    }

    fn plane_normal(&self, c: &[DVec3; 4]) -> Option<Normal> {
        let n = rounding::normalized((c[3] - c[0]).cross(c[2] - c[1]))?;
        Some(if self.flip { -n } else { n })
    }

    /// ∂(u, v)/∂(s, t) where (s, t) are the mesh's texture coordinates; `None` without them or when singular.
    fn uv_inverse(&self, patch: u32, u: f64, v: f64) -> Option<[[f64; 2]; 2]> {
        if self.uvs.is_empty() {
            return None;
        }
        let (du, dv) = derivatives(self.gather(&self.uvs, patch).map(|t| t.as_dvec2().extend(0.0)), u, v);
        let det = du.x * dv.y - du.y * dv.x;
        (det.abs() > 1e-12).then(|| [[dv.y / det, -du.y / det], [-dv.x / det, du.x / det]])
    }

    /// Chooses a point by area: uniformly on a rectangle, approximately so on other patches.
    pub fn sample_area(&self, patch: u32, u: Vec2) -> Option<ShapeSample> {
        let shape = self.patch(patch);
        let uv = if shape.is_rectangle() { u } else { warp::bilinear(u, shape.area_weights()) };
        let (u, v) = (f64::from(uv.x), f64::from(uv.y));
        let n = self.geometric_normal(patch, u, v)?;
        let density = area_pdf(&shape, uv);
        Some(ShapeSample { p: shape.point_at(u, v), n, uv: self.uv_at(patch, u, v), density })
    }

    /// Chooses a point by solid angle for a rectangle that appears large enough, else by area.
    pub fn sample_toward(&self, patch: u32, from: &ReferencePoint, u: Vec2) -> Option<ShapeSampleToward> {
        let shape = self.patch(patch);
        let Some(s) = shape.spherical(from) else {
            return self.sample_area(patch, u)?.toward(from);
        };
        let (u, warp_pdf) = match s.weights {
            Some(w) => {
                let warped = warp::bilinear(u, w);
                (warped, warp::bilinear_pdf(warped, w))
            }
            None => (u, 1.0),
        };
        let sample = spherical::sample_rectangle(s.corner, s.edges, from.p.p, u)?;
        let [a, b] = sample.at;
        let p = shape.point_at(a, b);
        Some(ShapeSampleToward {
            p,
            n: self.geometric_normal(patch, a, b)?,
            uv: self.uv_at(patch, a, b),
            wi: Dir::new(p.p - from.p.p)?,
            density: PdfSolidAngle(warp_pdf / sample.solid_angle as f32),
        })
    }

    /// Density of [`BilinearMesh::sample_toward`] for the direction `wi`, which meets the patch at `hit`.
    pub fn pdf_toward(
        &self,
        patch: u32,
        from: &ReferencePoint,
        wi: Dir,
        hit: &SurfacePoint,
    ) -> PdfSolidAngle {
        let shape = self.patch(patch);
        let Some(s) = shape.spherical(from) else {
            let uv = shape.parameters_at(hit.p.p);
            return area_density_toward(area_pdf(&shape, uv), from, wi, hit);
        };
        let uniform = (1.0 / s.solid_angle) as f32;
        let Some(w) = s.weights else { return PdfSolidAngle(uniform) };
        let q = hit.p.p.as_dvec3() - s.corner.as_dvec3();
        let at = s.edges.map(|e| (q.dot(e) / e.length_squared()).clamp(0.0, 1.0));
        let pdf = spherical::invert_rectangle(s.corner, s.edges, from.p.p, at)
            .map_or(1.0, |u| warp::bilinear_pdf(u, w));
        PdfSolidAngle(uniform * pdf)
    }
}

impl Patch {
    /// The (u, v) of a point of the patch, by Newton's iteration on the least-squares residual.
    fn parameters_at(&self, p: Point) -> Vec2 {
        let (c, p) = (self.corners_f64(), p.as_dvec3());
        let (mut u, mut v) = (0.5, 0.5);
        for _ in 0..8 {
            let r = p - bilinear(c, u, v);
            let (du, dv) = derivatives(c, u, v);
            let (a, b, d) = (du.dot(du), du.dot(dv), dv.dot(dv));
            let det = a * d - b * b;
            if det == 0.0 {
                break;
            }
            let (x, y) = (du.dot(r), dv.dot(r));
            u = (u + (d * x - b * y) / det).clamp(0.0, 1.0);
            v = (v + (a * y - b * x) / det).clamp(0.0, 1.0);
        }
        Vec2::new(u as f32, v as f32)
    }
}

/// Density per area of [`BilinearMesh::sample_area`] at patch parameters `uv`.
fn area_pdf(shape: &Patch, uv: Vec2) -> PdfArea {
    let warp_pdf = if shape.is_rectangle() { 1.0 } else { warp::bilinear_pdf(uv, shape.area_weights()) };
    PdfArea(warp_pdf / shape.area_density(f64::from(uv.x), f64::from(uv.y)) as f32)
}

/// ∂n/∂u and ∂n/∂v of a patch from its fundamental forms; its pure second derivatives vanish.
fn weingarten(c: &[DVec3; 4], dpdu: DVec3, dpdv: DVec3, n: DVec3) -> (DVec3, DVec3) {
    let d2puv = (c[0] - c[2]) + (c[3] - c[1]);
    let (ee, ff, gg) = (dpdu.dot(dpdu), dpdu.dot(dpdv), dpdv.dot(dpdv));
    let f = n.dot(d2puv);
    let det = ee * gg - ff * ff;
    if det == 0.0 {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    ((dpdu * (f * ff) - dpdv * (f * ee)) / det, (dpdv * (f * ff) - dpdu * (f * gg)) / det)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    fn patch() -> PatchData {
        PatchData {
            indices: vec![[0, 1, 2, 3]],
            positions: vec![
                Point::new(0.0, 0.0, 0.0),
                Point::new(2.0, 0.1, 0.5),
                Point::new(-0.2, 1.0, 0.7),
                Point::new(1.5, 1.4, -0.3),
            ],
            ..Default::default()
        }
    }

    #[test]
    fn a_ray_that_begins_in_a_flat_patch_does_not_meet_it() {
        // z is exactly zero and so is its error bound: nothing lifts the origin off the patch.
        let corners = [(-0.3, -0.3), (0.3, -0.3), (-0.3, 0.3), (0.3, 0.3)];
        let patch = Patch { corners: corners.map(|(x, y)| Point::new(x, y, 0.0)) };
        let mut rng = Pcg32::new(3, 1);
        for _ in 0..10_000 {
            let mut at = || 0.6 * rng.next_f32() - 0.3;
            let (o, d) = (Point::new(at(), at(), 0.0), Vec3::new(at(), at(), 0.7));
            for d in [d, -d] {
                assert!(patch.intersect(&Ray { o, d, time: 0.0 }, f32::INFINITY).is_none(), "{o:?} {d}");
                let before = Ray { o: o - d * 1e-6, d, time: 0.0 };
                assert!(patch.intersect(&before, f32::INFINITY).is_some_and(|h| h.t < 2e-6), "{o:?} {d}");
            }
        }
    }

    #[test]
    fn rays_aimed_at_a_patch_meet_it_at_the_parameters_aimed_at() {
        let m = BilinearMesh::new(patch(), &Transform::IDENTITY, Orientation::AsDefined).unwrap();
        let p = m.patch(0);
        let mut rng = Pcg32::new(3, 3);
        for _ in 0..2000 {
            let (u, v) = (rng.next_f32(), rng.next_f32());
            let target = bilinear(p.corners_f64(), f64::from(u), f64::from(v)).as_vec3();
            let o = warp::uniform_sphere(Vec2::new(rng.next_f32(), rng.next_f32())) * 4.0;
            let r = Ray { o: Point(o), d: target - o, time: 0.0 };
            // A saddle may be met earlier elsewhere; then at least it is met.
            let h = p.intersect(&r, f32::INFINITY).unwrap();
            assert!(h.t < 1.0 + 1e-5);
            if h.t > 1.0 - 1e-5 {
                assert!((h.u - u).abs() < 1e-3 && (h.v - v).abs() < 1e-3, "{h:?} {u} {v}");
            }
            let s = m.surface(0, &h, 0.0);
            assert!((*s.p.p - *r.at(h.t)).length() < 1e-5);
        }
    }

    #[test]
    fn a_planar_rectangle_is_recognised_and_a_twisted_one_is_not() {
        let m = BilinearMesh::new(patch(), &Transform::IDENTITY, Orientation::AsDefined).unwrap();
        assert!(!m.patch(0).is_rectangle());
        let mut d = patch();
        d.positions =
            [(0.0, 0.0), (3.0, 0.0), (0.0, 2.0), (3.0, 2.0)].map(|(x, y)| Point::new(x, y, 1.0)).to_vec();
        let t = Transform::rotate(40.0, Vec3::new(1.0, 2.0, 3.0)).unwrap();
        let m = BilinearMesh::new(d, &t, Orientation::AsDefined).unwrap();
        assert!(m.patch(0).is_rectangle());
        assert!((m.area(0) - 6.0).abs() < 1e-5);
    }

    #[test]
    fn the_normal_is_that_of_the_parametrisation() {
        let mut d = patch();
        d.positions =
            [(0.0, 0.0), (3.0, 0.0), (0.0, 2.0), (3.0, 2.0)].map(|(x, y)| Point::new(x, y, 1.0)).to_vec();
        // s = v and t = u: mirrored texture coordinates must not turn the surface over.
        d.uvs = vec![Vec2::ZERO, Vec2::Y, Vec2::X, Vec2::ONE];
        let hit = PrimHit { t: 1.0, u: 0.25, v: 0.5 };
        let s = BilinearMesh::new(d.clone(), &Transform::IDENTITY, Orientation::AsDefined)
            .unwrap()
            .surface(0, &hit, 0.0);
        assert_eq!((s.ng, s.uv), (Normal::Z, Vec2::new(0.5, 0.25)));
        assert!((s.dpdu - Vec3::Y * 2.0).length() < 1e-6, "{}", s.dpdu);
        let s =
            BilinearMesh::new(d, &Transform::IDENTITY, Orientation::Reversed).unwrap().surface(0, &hit, 0.0);
        assert_eq!(s.ng, -Normal::Z);
    }

    #[test]
    fn curvature_derivatives_match_finite_differences() {
        let m = BilinearMesh::new(patch(), &Transform::IDENTITY, Orientation::AsDefined).unwrap();
        let at = |u: f32, v: f32| m.surface(0, &PrimHit { t: 1.0, u, v }, 0.0);
        let (s, h) = (at(0.3, 0.6), 1e-2);
        let du = (*at(0.3 + h, 0.6).ng - *at(0.3 - h, 0.6).ng) / (2.0 * h);
        let dv = (*at(0.3, 0.6 + h).ng - *at(0.3, 0.6 - h).ng) / (2.0 * h);
        assert!((s.shading.dndu - du).length() < 2e-3, "{} {du}", s.shading.dndu);
        assert!((s.shading.dndv - dv).length() < 2e-3, "{} {dv}", s.shading.dndv);
    }
}
