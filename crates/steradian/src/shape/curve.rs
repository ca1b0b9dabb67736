//! Thin curves: hair, grass, fibres.

mod bezier;
mod segment;

pub use bezier::{Basis, Degree};
pub use segment::{Capsule, CurveSegment, Profile};

use super::contract::{Orientation, PrimHit, ShapeError};
use super::validate;
use crate::math::{BoundedPoint, Bounds3, Normal, Point, Ray, Shading, SurfacePoint, Transform, Vec2, Vec3};
use bezier::Bezier;
use glam::Quat;

/// What a curve is made of, in object space.
#[derive(Clone, Debug)]
pub struct CurveData {
    /// Control points.
    pub points: Vec<Point>,
    /// Their basis.
    pub basis: Basis,
    /// Their degree.
    pub degree: Degree,
    /// Cross-section.
    pub profile: Profile,
    /// Ribbon normals, one per piece boundary; empty for other profiles.
    pub normals: Vec<Vec3>,
    /// Width at the start and at the end, linear in between [object units].
    pub widths: [f32; 2],
    /// Each piece becomes 2^`split_depth` primitives, for tighter boxes; at most 10.
    pub split_depth: u32,
}

/// A curve in render space. Its primitives are the parts of its polynomial pieces.
#[derive(Clone, Debug)]
pub struct Curve {
    pieces: Vec<Piece>,
    profile: Profile,
    split_depth: u32,
    flip: bool,
}

/// One cubic polynomial with its widths and ribbon normals.
#[derive(Clone, Copy, Debug)]
struct Piece {
    bezier: Bezier,
    widths: [f32; 2],
    normals: [Normal; 2],
}

impl Curve {
    /// Transforms a curve to render space and cuts it into pieces. Widths scale with the cube root of the
    /// transform's determinant: exact for similarities, a mean otherwise.
    pub fn new(
        data: CurveData,
        render_from_object: &Transform,
        orientation: Orientation,
    ) -> Result<Self, ShapeError> {
        let CurveData { mut points, basis, degree, profile, mut normals, widths, split_depth } = data;
        let order = if degree == Degree::Cubic { 3 } else { 2 };
        let expected = match basis {
            Basis::Bezier => points.len() > order && (points.len() - 1).is_multiple_of(order),
            Basis::BSpline => points.len() > order,
        };
        if !expected {
            let rule = "degree + 1 plus, for a Bézier basis, multiples of the degree";
            return Err(ShapeError::Parameter { name: "number of P", value: points.len() as f32, rule });
        }
        let count = match basis {
            Basis::Bezier => (points.len() - 1) / order,
            Basis::BSpline => points.len() - order,
        };
        for (name, value) in [("width0", widths[0]), ("width1", widths[1])] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ShapeError::Parameter { name, value, rule: "finite and not negative" });
            }
        }
        if split_depth > 10 {
            let value = split_depth as f32;
            return Err(ShapeError::Parameter { name: "splitdepth", value, rule: "at most 10" });
        }
        if profile == Profile::Ribbon && normals.len() != count + 1 {
            return Err(ShapeError::WrongLength { what: "N", found: normals.len(), expected: count + 1 });
        }
        validate::transform_positions(&mut points, render_from_object)?;
        validate::transform_normals(&mut normals, render_from_object, Orientation::AsDefined)?;
        let linear = glam::DMat3::from_mat4(render_from_object.matrix().as_dmat4());
        let scale = linear.determinant().abs().cbrt() as f32;
        let width = |k: usize| {
            let x = k as f32 / count as f32;
            crate::math::float::lerp(x, widths[0], widths[1]) * scale
        };
        let normal = |k: usize| normals.get(k).and_then(|&n| Normal::new(n)).unwrap_or(Normal::Z);
        let pieces = (0..count)
            .map(|k| Piece {
                bezier: Bezier::from_basis(&points, basis, degree, k),
                widths: [width(k), width(k + 1)],
                normals: [normal(k), normal(k + 1)],
            })
            .collect();
        let flip = orientation.flips_normals(render_from_object);
        Ok(Self { pieces, profile, split_depth, flip })
    }

    /// Number of primitives.
    pub fn segment_count(&self) -> u32 {
        (self.pieces.len() as u32) << self.split_depth
    }

    /// Bytes held on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.pieces[..])
    }

    fn locate(&self, prim: u32) -> (&Piece, [f32; 2]) {
        let parts = 1 << self.split_depth;
        let part = (prim % parts) as f32;
        let piece = &self.pieces[(prim / parts) as usize];
        (piece, [part / parts as f32, (part + 1.0) / parts as f32])
    }

    /// A primitive with all that intersecting it takes.
    pub fn segment(&self, prim: u32) -> CurveSegment {
        let (piece, u) = self.locate(prim);
        let normals = (self.profile == Profile::Ribbon).then(|| Box::new(piece.normals));
        CurveSegment::new(piece.bezier.part(u[0], u[1]), u, piece.widths, normals)
    }

    /// Smallest box around the boxes of all primitives.
    pub fn bounds(&self) -> Bounds3 {
        (0..self.segment_count()).map(|k| self.segment(k).bounds()).fold(Bounds3::EMPTY, Bounds3::union)
    }

    /// Length times mean width of a primitive [scene units²], by chords.
    pub fn area(&self, prim: u32) -> f32 {
        let (piece, u) = self.locate(prim);
        let part = piece.bezier.part(u[0], u[1]);
        let width = |u: f32| crate::math::float::lerp(u, piece.widths[0], piece.widths[1]);
        part.control_length() * 0.5 * (width(u[0]) + width(u[1]))
    }

    /// Differential geometry at a hit: ∂p/∂v spans the visible width, turned with v for a round profile so that
    /// the normals are those of a cylinder.
    pub fn surface(&self, prim: u32, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let (piece, _) = self.locate(prim);
        let dpdu = piece.bezier.derivative(hit.u);
        let d = ray.d.normalize_or_zero();
        let width = piece.width(hit.u);
        let (width, dpdv) = match self.profile {
            Profile::Ribbon => {
                let n = segment::ribbon_normal(&piece.normals, hit.u);
                let width = width * n.dot(d).abs();
                (width, n.cross(dpdu).normalize_or_zero() * width)
            }
            Profile::Flat => (width, d.cross(dpdu).normalize_or_zero() * width),
            Profile::Cylinder => {
                let flat = d.cross(dpdu).normalize_or_zero() * width;
                let angle = (90.0 - 180.0 * hit.v).to_radians();
                let axis = dpdu.normalize_or_zero();
                (width, if axis == Vec3::ZERO { flat } else { Quat::from_axis_angle(axis, angle) * flat })
            }
        };
        // Seen end-on, a curve has no width: any normal across the ray will do.
        let n = Normal::new(dpdu.cross(dpdv)).or_else(|| Normal::new(-d)).unwrap_or(Normal::Z);
        let n = if self.flip { -n } else { n };
        let o = ray.o.as_dvec3() + ray.d.as_dvec3() * f64::from(hit.t);
        SurfacePoint {
            p: BoundedPoint { p: Point(o.as_vec3()), error: Vec3::splat(width) },
            ng: n,
            uv: Vec2::new(hit.u, hit.v),
            dpdu,
            dpdv,
            shading: Shading { n, dpdu, dpdv, dndu: Vec3::ZERO, dndv: Vec3::ZERO },
            time: ray.time,
            face: 0,
        }
    }
}

impl Piece {
    fn width(&self, u: f32) -> f32 {
        crate::math::float::lerp(u, self.widths[0], self.widths[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;

    fn straight(profile: Profile, widths: [f32; 2]) -> Curve {
        let points = (0..4).map(|k| Point::new(k as f32, 0.0, 0.0)).collect();
        let normals = if profile == Profile::Ribbon { vec![Vec3::Z; 2] } else { vec![] };
        let (basis, degree) = (Basis::Bezier, Degree::Cubic);
        let data = CurveData { points, basis, degree, profile, normals, widths, split_depth: 2 };
        Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap()
    }

    fn meet(c: &Curve, r: &Ray) -> Option<(u32, PrimHit)> {
        let hits =
            (0..c.segment_count()).filter_map(|k| c.segment(k).intersect(r, f32::INFINITY).map(|h| (k, h)));
        hits.min_by(|a, b| a.1.t.total_cmp(&b.1.t))
    }

    #[test]
    fn a_straight_curve_is_as_wide_as_it_says() {
        let c = straight(Profile::Flat, [0.2, 0.4]);
        for (x, half) in [(0.3, 0.11), (1.5, 0.15), (2.7, 0.19)] {
            let at = |y: f32| Ray { o: Point::new(x, y, 2.0), d: Vec3::new(0.0, 0.0, -2.0), time: 0.0 };
            let (_, h) = meet(&c, &at(half - 1e-3)).expect("inside");
            assert!((h.u - x / 3.0).abs() < 1e-3 && (h.t - 1.0).abs() < 1e-5, "{h:?}");
            assert!(meet(&c, &at(half + 1e-3)).is_none());
            assert!(meet(&c, &at(-half + 1e-3)).is_some() && meet(&c, &at(-half - 1e-3)).is_none());
            let (_, other) = meet(&c, &at(-half + 1e-3)).unwrap();
            assert!((h.v + other.v - 1.0).abs() < 1e-3 && (h.v - 0.5).abs() > 0.45, "{h:?} {other:?}");
        }
    }

    #[test]
    fn the_frame_spans_the_visible_width() {
        let c = straight(Profile::Flat, [0.2, 0.2]);
        let r = Ray { o: Point::new(1.2, 0.03, 2.0), d: Vec3::new(0.1, 0.0, -1.0), time: 0.0 };
        let (k, h) = meet(&c, &r).unwrap();
        let s = c.surface(k, &r, &h);
        assert!((s.dpdv.length() - 0.2).abs() < 1e-5 && s.dpdv.dot(s.dpdu).abs() < 1e-5);
        assert!(s.dpdv.dot(r.d).abs() < 1e-5);
        // v grows along ∂p/∂v.
        let offset = (*s.p.p - Vec3::new(s.p.p.x, 0.0, 0.0)).dot(s.dpdv.normalize());
        assert!((h.v - 0.5 - offset / 0.2).abs() < 1e-3, "{h:?} {offset}");
    }

    #[test]
    fn a_ribbon_narrows_with_the_angle_of_view() {
        let c = straight(Profile::Ribbon, [0.2, 0.2]);
        // 60° off the ribbon's normal: half as wide.
        let d = Vec3::new(0.0, 3.0_f32.sqrt() * 0.5, -0.5);
        let across = Vec3::new(0.0, 0.5, 3.0_f32.sqrt() * 0.5);
        let at = |y: f32| Ray { o: Point(Vec3::X * 1.5 + across * y - d * 5.0), d, time: 0.0 };
        assert!(meet(&c, &at(0.049)).is_some() && meet(&c, &at(0.051)).is_none());
    }

    #[test]
    fn curves_are_met_at_every_point_of_their_axis() {
        let mut rng = Pcg32::new(8, 1);
        for (basis, degree, n) in [
            (Basis::Bezier, Degree::Cubic, 7),
            (Basis::Bezier, Degree::Quadratic, 5),
            (Basis::BSpline, Degree::Cubic, 6),
            (Basis::BSpline, Degree::Quadratic, 6),
        ] {
            let mut coordinate = || rng.next_f32() * 2.0 - 1.0;
            let points = (0..n).map(|_| Point::new(coordinate(), coordinate(), coordinate())).collect();
            let profile = Profile::Cylinder;
            let data = CurveData {
                points,
                basis,
                degree,
                profile,
                normals: vec![],
                widths: [0.05, 0.02],
                split_depth: 3,
            };
            let c = Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
            for i in 0..500 {
                let piece = &c.pieces[i % c.pieces.len()];
                let target = piece.bezier.point(rng.next_f32());
                let o = Vec3::new(3.0, rng.next_f32() * 4.0, -2.0);
                let r = Ray { o: Point(o), d: target - o, time: 0.0 };
                let (k, h) = meet(&c, &r).expect("aimed at the axis");
                let b = c.segment(k).bounds();
                assert!(
                    h.t < 1.1 && b.expand(1e-4).union(Bounds3::from_points([r.at(h.t)])) == b.expand(1e-4)
                );
            }
        }
    }

    #[test]
    fn pieces_of_a_spline_join_smoothly() {
        let points: Vec<Point> =
            [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, -1.0, 1.0], [4.0, 0.5, 0.0], [6.0, 1.0, 2.0]]
                .map(|p| Point(Vec3::from(p)))
                .to_vec();
        for degree in [Degree::Quadratic, Degree::Cubic] {
            let a = Bezier::from_basis(&points, Basis::BSpline, degree, 0);
            let b = Bezier::from_basis(&points, Basis::BSpline, degree, 1);
            assert!((a.point(1.0) - b.point(0.0)).length() < 1e-6);
            assert!((a.derivative(1.0) - b.derivative(0.0)).length() < 1e-5);
        }
    }

    #[test]
    fn impossible_curves_are_refused() {
        let data = |n: usize, width: f32| CurveData {
            points: vec![Point::ORIGIN; n],
            basis: Basis::Bezier,
            degree: Degree::Cubic,
            profile: Profile::Flat,
            normals: vec![],
            widths: [width; 2],
            split_depth: 3,
        };
        let new = |d| Curve::new(d, &Transform::IDENTITY, Orientation::AsDefined).map(|c| c.segment_count());
        assert_eq!(new(data(7, 1.0)), Ok(16));
        assert!(matches!(new(data(5, 1.0)), Err(ShapeError::Parameter { name: "number of P", .. })));
        assert!(matches!(new(data(4, -1.0)), Err(ShapeError::Parameter { name: "width0", .. })));
        let ribbon = CurveData { profile: Profile::Ribbon, ..data(4, 1.0) };
        assert_eq!(new(ribbon), Err(ShapeError::WrongLength { what: "N", found: 0, expected: 2 }));
    }

    #[test]
    fn a_capsule_holds_the_whole_curve_and_is_as_wide_as_its_bulge() {
        let mut rng = Pcg32::new(20, 6);
        let mut coordinate = || rng.next_f32() * 2.0 - 1.0;
        for case in 0..500 {
            let mut points = [0; 4].map(|_| Vec3::new(coordinate(), coordinate(), coordinate()));
            if case % 2 == 0 {
                // Both inner points to the same side of the thirds: the middle follows by exactly three quarters.
                let ([a, b, _, d], third) = (points, (points[3] - points[0]) / 3.0);
                let bulge = (b - a).cross(d - a);
                (points[1], points[2]) = (a + third + bulge, d - third + bulge);
            }
            let data = CurveData {
                points: points.map(Point).to_vec(),
                basis: Basis::Bezier,
                degree: Degree::Cubic,
                profile: Profile::Flat,
                normals: vec![],
                widths: [0.1, 0.2],
                split_depth: 0,
            };
            let c = Curve::new(data, &Transform::IDENTITY, Orientation::AsDefined).unwrap();
            let capsule = c.segment(0).capsule();
            let (along, mut most) = (capsule.chord.normalize(), 0.0_f32);
            for i in 0..=64 {
                let from_middle = c.pieces[0].bezier.point(i as f32 / 64.0) - *capsule.middle;
                let aside = from_middle.reject_from_normalized(along).length() + 0.1;
                most = most.max(aside);
                assert!(aside <= capsule.reach && from_middle.length() + 0.1 <= capsule.radius, "{points:?}");
            }
            assert!(case % 2 != 0 || capsule.reach < most * (1.0 + 1e-5), "{points:?}: {most} {capsule:?}");
        }
    }
}
