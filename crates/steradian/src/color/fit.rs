//! Coefficients of a sigmoid reflectance that shows a given colour: Gauss–Newton in CIE L*a*b*.

use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, Sigmoid, cie};
use glam::{DMat3, DVec3};

/// Quadrature nodes, every 5 nm over 360–830 nm; one more pads them to whole groups of lanes.
const NODES: usize = 96;
/// Spacing of the nodes [nm].
const STEP: usize = 5;
/// Independent partial sums, which let the compiler use vector instructions.
const GROUP: usize = 8;
/// Squared L*a*b* distance below which a fit has converged: 10⁻⁵, far below any visible difference.
const CONVERGED: f64 = 1e-10;

/// Squared L*a*b* distance from which one more step leads closer than interpolation in a table keeps.
const NEAR: f64 = 1e-3;

/// Weights that turn a reflectance into X/Xₙ, Y/Yₙ, Z/Zₙ under one illuminant.
#[derive(Clone, Debug)]
pub(super) struct FitBasis {
    t: [f64; NODES],
    weight: [[f64; NODES]; 3],
}

/// Colour of a reflectance and its derivatives by the three coefficients.
struct Linearised {
    value: DVec3,
    by_coefficient: DMat3,
}

/// A fit and what remains of the colour difference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// c₀, c₁, c₂.
    pub(super) coefficients: DVec3,
    /// Squared L*a*b* distance.
    error: f64,
}

impl FitBasis {
    /// For an illuminant given as a function of wavelength [nm].
    ///
    /// Each entry of the 1 nm table is shared out to the four nodes around it by cubic Lagrange interpolation: the sum
    /// is exact for reflectances that are cubic from node to node.
    pub(super) fn new(illuminant: impl Fn(f32) -> f32) -> Self {
        let mut weight = [[0.0; NODES]; 3];
        for (i, bar) in cie::table().iter().enumerate() {
            let l = f64::from(illuminant(LAMBDA_MIN + i as f32));
            let first = (i / STEP).saturating_sub(1).min(NODES - 5);
            let share = lagrange(i as f64 / STEP as f64 - first as f64);
            for (w, &bar) in weight.iter_mut().zip(bar) {
                for (w, share) in w[first..].iter_mut().zip(share) {
                    *w += l * f64::from(bar) * share;
                }
            }
        }
        for w in &mut weight {
            let white: f64 = w.iter().sum();
            w.iter_mut().for_each(|w| *w /= white);
        }
        let half = f64::from(LAMBDA_MAX - LAMBDA_MIN) / 2.0;
        Self { t: std::array::from_fn(|i| (i * STEP) as f64 / half - 1.0), weight }
    }

    /// X/Xₙ, Y/Yₙ, Z/Zₙ of a reflectance.
    #[cfg(test)]
    pub(super) fn relative_xyz(&self, c: DVec3) -> DVec3 {
        self.linearise(c).value
    }

    fn linearise(&self, c: DVec3) -> Linearised {
        // The reflectance at the nodes and its derivatives by the coefficients; loops, which become vector instructions.
        let [mut value, mut by_c0, mut by_c1, mut by_c2] = [[0.0; NODES]; 4];
        for (i, &t) in self.t.iter().enumerate() {
            let x = (c.x * t + c.y) * t + c.z;
            let q = 1.0 / (1.0 + x * x).sqrt();
            value[i] = 0.5 + 0.5 * x * q;
            by_c2[i] = 0.5 * q * q * q;
            by_c1[i] = by_c2[i] * t;
            by_c0[i] = by_c1[i] * t;
        }
        let gather = |term: &[f64; NODES]| {
            let [x, y, z] = &self.weight;
            DVec3::new(dot(x, term), dot(y, term), dot(z, term))
        };
        Linearised {
            value: gather(&value),
            by_coefficient: DMat3::from_cols(gather(&by_c0), gather(&by_c1), gather(&by_c2)),
        }
    }

    /// The coefficients whose colour comes nearest to `target` (relative XYZ), from any start.
    ///
    /// A first descent begins at the grey of like luminance. Where it ends short of the target, the colour is
    /// approached in steps from that grey, which avoids the local minima of saturated colours.
    pub(super) fn fit(&self, target: DVec3) -> Fit {
        const STEPS: u32 = 8;
        let direct = self.descend(target, grey_start(target));
        if direct.error < ACCEPTED {
            return direct;
        }
        let grey = DVec3::splat(target.y.clamp(0.05, 0.95));
        let mut stepped = Fit { coefficients: grey_start(target), error: 0.0 };
        for i in 1..=STEPS {
            let waypoint = grey.lerp(target, f64::from(i) / f64::from(STEPS));
            stepped = self.descend(waypoint, stepped.coefficients);
        }
        if stepped.error < direct.error { stepped } else { direct }
    }

    /// The coefficients at which a descent from `start` ends.
    pub(super) fn descend(&self, target: DVec3, start: DVec3) -> Fit {
        self.descent(target, start, CONVERGED).0
    }

    /// [`FitBasis::descend`] for tables, from a `start` that is near: where a step begins within [`NEAR`] of the target, its end is
    /// not looked at.
    pub(super) fn approach(&self, target: DVec3, start: DVec3) -> DVec3 {
        let (fit, next) = self.descent(target, start, NEAR);
        next.unwrap_or(fit.coefficients)
    }

    /// Levenberg–Marquardt: Gauss–Newton as in Jakob & Hanika 2019, section 3.2, damped, and with a penalty that keeps
    /// the coefficients of colours that no reflectance shows (and of black and white) finite.
    ///
    /// Ends once the error is below `near`, with the step that would come next.
    fn descent(&self, target: DVec3, start: DVec3, near: f64) -> (Fit, Option<DVec3>) {
        const MAX_ITERATIONS: usize = 60;
        let goal = Lab::new(target).value;
        let mut c = start;
        let mut here = self.linearise(c);
        let mut shown = Lab::new(here.value);
        let mut residual = shown.value - goal;
        let mut error = residual.length_squared();
        let mut cost = error + penalty(c).length_squared();
        let mut damping = 1e-8;
        for _ in 0..MAX_ITERATIONS {
            let jacobian = shown.by_xyz * here.by_coefficient;
            let stiffness = penalty_slope(c);
            let normal = jacobian.transpose() * jacobian + DMat3::from_diagonal(stiffness * stiffness);
            let gradient = jacobian.transpose() * residual + stiffness * penalty(c);
            let scale = normal.x_axis.x.max(normal.y_axis.y).max(normal.z_axis.z);
            let damped = normal + DMat3::from_diagonal(DVec3::splat(damping * scale));
            let next = c - damped.inverse() * gradient;
            if error < near {
                return (Fit { coefficients: c, error }, next.is_finite().then_some(next));
            }
            let there = self.linearise(next);
            let next_shown = Lab::new(there.value);
            let next_residual = next_shown.value - goal;
            let next_error = next_residual.length_squared();
            let next_cost = next_error + penalty(next).length_squared();
            // A comparison that a NaN fails: an overflowed step is a rejected step.
            if next_cost < cost {
                let stalled = next_cost > cost * (1.0 - 1e-6);
                (c, here, shown) = (next, there, next_shown);
                (residual, error, cost) = (next_residual, next_error, next_cost);
                damping = (damping * 0.1).max(1e-12);
                if stalled {
                    break;
                }
            } else {
                damping *= 8.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        (Fit { coefficients: c, error }, None)
    }
}

/// Sum of products, in independent partial sums.
fn dot(a: &[f64; NODES], b: &[f64; NODES]) -> f64 {
    let mut sum = [0.0; GROUP];
    for (a, b) in a.as_chunks::<GROUP>().0.iter().zip(b.as_chunks::<GROUP>().0) {
        for (sum, (a, b)) in sum.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sum.iter().sum()
}

/// Cubic Lagrange basis on the nodes 0, 1, 2, 3, at x.
fn lagrange(x: f64) -> [f64; 4] {
    let (a, b, c, d) = (x, x - 1.0, x - 2.0, x - 3.0);
    [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0]
}

/// Squared L*a*b* distance up to which a descent found its target rather than a local minimum.
const ACCEPTED: f64 = 1e-4;

/// Size of the coefficients beyond which the penalty is felt: the reflectance then passes from 0.1 to 0.9 within
/// some nanometres, about the spacing of the nodes.
const LARGE: f64 = 200.0;
/// The penalty there, in units of L*a*b*.
const PENALTY: f64 = 0.1;

fn penalty(c: DVec3) -> DVec3 {
    let r = c / LARGE;
    PENALTY * r * r * r
}

fn penalty_slope(c: DVec3) -> DVec3 {
    let r = c / LARGE;
    3.0 * PENALTY / LARGE * r * r
}

/// Start of a fit: the grey of the target's luminance, kept off the flat ends of the sigmoid.
pub(super) fn grey_start(target: DVec3) -> DVec3 {
    let y = target.y.clamp(0.05, 0.95);
    DVec3::new(0.0, 0.0, (y - 0.5) / (y * (1.0 - y)).sqrt())
}

/// The coefficients as single precision.
pub(super) fn to_sigmoid(c: DVec3) -> Sigmoid {
    Sigmoid { c0: c.x as f32, c1: c.y as f32, c2: c.z as f32 }
}

const DELTA: f64 = 6.0 / 29.0;

/// CIE L*a*b* (CIE 15:2018, 8.2.1) and its derivatives by relative XYZ.
struct Lab {
    value: DVec3,
    by_xyz: DMat3,
}

impl Lab {
    fn new(v: DVec3) -> Self {
        // The function under L*, a* and b*, and its slope.
        let f = |t: f64| {
            if t > DELTA * DELTA * DELTA {
                let root = t.cbrt();
                (root, 1.0 / (3.0 * root * root))
            } else {
                let slope = 1.0 / (3.0 * DELTA * DELTA);
                (t * slope + 4.0 / 29.0, slope)
            }
        };
        let ((x, dx), (y, dy), (z, dz)) = (f(v.x), f(v.y), f(v.z));
        Self {
            value: DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)),
            by_xyz: DMat3::from_cols(
                DVec3::new(0.0, 500.0 * dx, 0.0),
                DVec3::new(116.0 * dy, -500.0 * dy, 200.0 * dy),
                DVec3::new(0.0, 0.0, -200.0 * dz),
            ),
        }
    }
}
