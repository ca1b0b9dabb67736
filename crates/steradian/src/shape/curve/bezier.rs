//! Cubic Bézier curves and the conversions to them.

use crate::math::{Point, Vec3};

/// Which polynomial basis control points refer to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// Bézier pieces that share their end points.
    #[default]
    Bezier,
    /// A uniform B-spline.
    BSpline,
}

/// Polynomial degree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Degree {
    /// Two.
    Quadratic,
    /// Three.
    #[default]
    Cubic,
}

/// A cubic by its control points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bezier(pub(super) [Vec3; 4]);

impl Bezier {
    /// Piece `k` of the curve that `points` describe.
    pub(super) fn from_basis(points: &[Point], basis: Basis, degree: Degree, k: usize) -> Self {
        let at = |i: usize| points[i].0;
        match (basis, degree) {
            (Basis::Bezier, Degree::Cubic) => Self([0, 1, 2, 3].map(|i| at(3 * k + i))),
            (Basis::Bezier, Degree::Quadratic) => Self::elevated([0, 1, 2].map(|i| at(2 * k + i))),
            (Basis::BSpline, Degree::Quadratic) => {
                let [p, q, r] = [0, 1, 2].map(|i| at(k + i));
                Self::elevated([(p + q) * 0.5, q, (q + r) * 0.5])
            }
            (Basis::BSpline, Degree::Cubic) => {
                let [p, q, r, s] = [0, 1, 2, 3].map(|i| at(k + i));
                let (a, b) = ((q * 2.0 + r) / 3.0, (q + r * 2.0) / 3.0);
                Self([((p + q * 2.0) / 3.0 + a) * 0.5, a, b, (b + (r * 2.0 + s) / 3.0) * 0.5])
            }
        }
    }

    /// The cubic that equals a quadratic.
    fn elevated([p, q, r]: [Vec3; 3]) -> Self {
        Self([p, (p + q * 2.0) / 3.0, (q * 2.0 + r) / 3.0, r])
    }

    #[inline]
    pub(super) fn point(&self, u: f32) -> Vec3 {
        self.blossom(u, u, u)
    }

    #[inline]
    pub(super) fn derivative(&self, u: f32) -> Vec3 {
        let [a, b, c, d] = self.0;
        let (x, y) = ((b - a).lerp(c - b, u), (c - b).lerp(d - c, u));
        let derivative = x.lerp(y, u) * 3.0;
        // Coincident control points: the chord still has a direction.
        if derivative.length_squared() > 0.0 { derivative } else { d - a }
    }

    /// The polar form: affine in each argument, the curve where they are equal.
    #[inline]
    fn blossom(&self, u: f32, v: f32, w: f32) -> Vec3 {
        let [a, b, c, d] = self.0;
        let (p, q, r) = (a.lerp(b, u), b.lerp(c, u), c.lerp(d, u));
        let (p, q) = (p.lerp(q, v), q.lerp(r, v));
        p.lerp(q, w)
    }

    /// The part between two parameters as a curve of its own.
    pub(super) fn part(&self, lo: f32, hi: f32) -> Self {
        Self([
            self.blossom(lo, lo, lo),
            self.blossom(lo, lo, hi),
            self.blossom(lo, hi, hi),
            self.blossom(hi, hi, hi),
        ])
    }

    /// The two halves.
    #[inline]
    pub(super) fn halves(&self) -> [Self; 2] {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = ((a + b) * 0.5, (b + c) * 0.5, (c + d) * 0.5);
        let (abc, bcd) = ((ab + bc) * 0.5, (bc + cd) * 0.5);
        let middle = (abc + bcd) * 0.5;
        [Self([a, ab, abc, middle]), Self([middle, bcd, cd, d])]
    }

    /// Length of the control polygon, not less than that of the curve.
    pub(super) fn control_length(&self) -> f32 {
        self.0.windows(2).map(|w| w[0].distance(w[1])).sum()
    }
}
