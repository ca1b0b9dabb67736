//! What a clear coat does to the light that passes it on its way to a Lambertian base and back.
//!
//! A Lambertian base forgets where light came from, so that a walk under a clear coat has three factors, whatever the coat's
//! roughness: the share that enters from `wo`, the shares that return to the base again and again, and the share that leaves
//! into `wi`. For a rough coat they are the means of the walk's own draws, tabulated once.

use super::contract::{Mode, Sides};
use super::layered::{Coat, ExitWeights, power_heuristic};
use super::quadrature::GAUSS_LEGENDRE;
use crate::math::float::safe_sqrt;
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::spectrum::Sampled;
use crate::units::Unitless;

/// A rough clear coat, alike along both tangents.
#[derive(Clone, Debug, PartialEq)]
pub struct Varnish {
    coat: Coat,
    /// Share of light from outside that arrives at the base; reciprocal to what leaves, up to η².
    passing: Curve,
    /// The same for light that leaves, where a walk weighs its ways out inconsistently.
    leaving: Option<Box<Curve>>,
    /// Share of a Lambertian emission under the coat that returns.
    returned: f32,
}

impl Varnish {
    /// The tables of a coat; `None` where it is smooth, brushed or scatters in its depth.
    pub fn new(coat: &Coat) -> Option<Self> {
        let [x, y] = coat.interface.roughness.alpha();
        if coat.interface.is_specular() || x != y || !coat.albedo.is_zero() {
            return None;
        }
        let leaving = match coat.weights {
            ExitWeights::Consistent => None,
            ExitWeights::Pbrt4 => Some(Box::new(Curve::new(|cos| passed(coat, cos, counted_twice)))),
        };
        Some(Self {
            coat: *coat,
            passing: Curve::new(|cos| passed(coat, cos, |_, _, _, _| 1.0)),
            leaving,
            returned: returned(coat),
        })
    }

    /// The coat that the tables are of.
    pub fn coat(&self) -> &Coat {
        &self.coat
    }

    /// The share of light from `w` outside that arrives at the base.
    #[inline]
    pub(super) fn passing(&self, w: LocalDir) -> f32 {
        self.passing.at(w.abs_cos_theta())
    }

    /// The share, times η², of what the base sends that leaves into `w`, as a walk's values have it.
    #[inline]
    pub(super) fn leaving(&self, w: LocalDir) -> f32 {
        self.leaving.as_deref().unwrap_or(&self.passing).at(w.abs_cos_theta())
    }

    /// What the base with reflectance `rho` sends up of what arrives at it, all returns included.
    #[inline]
    pub(super) fn sent_up(&self, rho: Sampled<Unitless>) -> Sampled<Unitless> {
        sent_up(rho, self.returned, self.coat.max_depth)
    }
}

/// Σ ρ (ρ K)^k for the share K that returns to the base: as many orders as the values of a walk of at most `max_depth`
/// events have. (Its samples have one less where that is odd: a walk whose last event is at the base never leaves.)
#[inline]
pub(super) fn sent_up(rho: Sampled<Unitless>, returned: f32, max_depth: u16) -> Sampled<Unitless> {
    let step = rho * returned;
    let (mut rest, mut square, mut orders) = (Sampled::<Unitless>::ONE, step, max_depth.div_ceil(2));
    while orders > 0 {
        if orders & 1 == 1 {
            rest *= square;
        }
        square *= square;
        orders >>= 1;
    }
    // Both factors of the step are below one.
    Sampled::from_fn(|i| rho[i] * (1.0 - rest[i]) / (1.0 - step[i]))
}

/// Steps of a table over the cosine.
const STEPS: usize = 64;

/// A function of the cosine to the normal in [0, 1], linear between its nodes.
#[derive(Clone, Debug, PartialEq)]
struct Curve([f32; STEPS + 1]);

impl Curve {
    fn new(f: impl Fn(f32) -> f32) -> Self {
        // Directions in the surface do not meet it.
        Self(std::array::from_fn(|i| f((i as f32 / STEPS as f32).max(1e-4))))
    }

    #[inline]
    fn at(&self, cos: f32) -> f32 {
        let x = cos * STEPS as f32;
        let i = (x as usize).min(STEPS - 1);
        let (a, b) = (self.0[i], self.0[i + 1]);
        a + (b - a) * (x - i as f32)
    }
}

/// The mean, over the facets seen from outside at `cos`, of what a drawn transmission carries to the base, times a weight of
/// (coat, outside, drawn, cosine inside).
fn passed(
    coat: &Coat,
    cos: f32,
    weight: impl Fn(&Coat, LocalDir, &super::dielectric::Draw, f32) -> f32,
) -> f32 {
    let w = inclined(cos);
    over_facets(|u| {
        let Some(drawn) = coat.interface.draw(w, 0.5, u, Mode::Importance, Sides::Transmission) else {
            return 0.0;
        };
        let inside = drawn.wi.abs_cos_theta();
        drawn.weight * coat.transmittance(coat.thickness, drawn.wi) * weight(coat, w, &drawn, inside)
    })
}

/// The sum of both weights that pbrt-v4 gives to a way out: of connecting to it, and of finding it from the base.
fn counted_twice(coat: &Coat, w: LocalDir, drawn: &super::dielectric::Draw, inside: f32) -> f32 {
    let base = warp::cosine_hemisphere_pdf(inside);
    let connected = coat.interface.density(w, drawn).map_or(1.0, |p| power_heuristic(p, base));
    let found = coat
        .interface
        .evaluate_at(drawn.wi, w, Mode::Importance, Sides::Transmission)
        .map_or(0.0, |e| power_heuristic(base, e.pdf));
    connected + found
}

/// ∫ 2μ of what the coat reflects of an emission from below at μ, absorbed on its way up and down.
fn returned(coat: &Coat) -> f32 {
    let at = |cos: f32| {
        let w = inclined(-cos);
        let up = coat.transmittance(coat.thickness, w);
        over_facets(|u| {
            let drawn = coat.interface.draw(w, 0.0, u, Mode::Importance, Sides::Reflection);
            drawn.map_or(0.0, |d| up * d.weight * coat.transmittance(coat.thickness, d.wi))
        })
    };
    // Up to the critical angle nearly all is reflected.
    let eta = f64::from(coat.interface.eta);
    let critical = if eta > 1.0 { (1.0 - 1.0 / (eta * eta)).sqrt() } else { 0.5 };
    let ends = [0.0, 0.5 * critical, critical, 0.5 * (1.0 + critical), 1.0];
    let panels = ends.windows(2).flat_map(|ends| {
        let (start, width) = (ends[0], ends[1] - ends[0]);
        GAUSS_LEGENDRE.map(|[x, weight]| (start + width * x, width * weight))
    });
    panels.map(|(mu, weight)| 2.0 * mu * weight * f64::from(at(mu as f32))).sum::<f64>() as f32
}

/// The mean over the unit square of facet samples, of which the first coordinate is an azimuth.
fn over_facets(f: impl Fn(Vec2) -> f32) -> f32 {
    const AZIMUTHS: usize = 16;
    let mut sum = 0.0_f64;
    for half in [0.0, 0.5] {
        for [x, weight] in GAUSS_LEGENDRE {
            let mut ring = 0.0_f64;
            for i in 0..AZIMUTHS {
                ring += f64::from(f(Vec2::new((i as f32 + 0.5) / AZIMUTHS as f32, (half + 0.5 * x) as f32)));
            }
            sum += 0.5 * weight * ring / AZIMUTHS as f64;
        }
    }
    sum as f32
}

fn inclined(cos: f32) -> LocalDir {
    LocalDir::new_unchecked(Vec3::new(safe_sqrt(1.0 - cos * cos), 0.0, cos))
}
