//! Random walks through a pile with rough boundaries, or with a rough or Lambertian base.
//!
//! A walk from `wo` is joined, at each element that it meets, to a straight way out to `wi`, which is drawn backwards through
//! the boundaries above. Paths that rise through k boundaries can be made in k + 1 ways; the power heuristic weighs them by the
//! densities of both directions (Veach 1997, 10.2.1), so that the estimate is unbiased and narrow lobes are found from
//! whichever side finds them.

use super::layers::MAX_LAYERS;
use super::pile::Pile;
use crate::bsdf::contract::{Mode, Sides};
use crate::math::hash::Pcg32;
use crate::math::{LocalDir, Vec2};
use crate::spectrum::Sampled;
use crate::units::{PerSteradian, Unitless};

/// Most events of one walk: a bound on time that roulette reaches first unless hardly anything absorbs.
const MAX_EVENTS: usize = 10_000;

/// Light that left the stack.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    pub(super) wi: LocalDir,
    pub(super) weight: Sampled<Unitless>,
    /// Whether every event had a discrete direction.
    pub(super) specular: bool,
}

/// The way out from an element to `wi`, drawn backwards.
#[derive(Clone, Copy)]
struct WayOut {
    /// Up from the element.
    leg: LocalDir,
    /// Product of f·|cosθ|/p of the boundaries above, and of what the layers between leave.
    weight: Sampled<Unitless>,
    /// Σ (p/q)² over the ways to make this path that join it further up, but for the density p of `leg` at this element.
    others: f64,
}

/// A walk from `wo` until it leaves on either side.
pub(super) fn leave(
    pile: &Pile,
    wo: LocalDir,
    uc: f32,
    u: Vec2,
    mode: Mode,
    rng: &mut Pcg32,
) -> Option<Left> {
    let mut element = if wo.z > 0.0 { 0 } else { pile.len() - 1 };
    let (mut known, mut weight, mut specular) = (wo, Sampled::ONE, true);
    let (mut uc, mut u) = (uc, u);
    for event in 0..MAX_EVENTS {
        let drawn = pile.draw(element, known, uc, u, mode, Sides::Both)?;
        weight *= drawn.weight;
        specular &= drawn.pdf.is_none();
        let Some(next) = next_element(pile, element, drawn.wi) else {
            return Some(Left { wi: drawn.wi, weight, specular });
        };
        weight *= pile.transmittance_below(element.min(next), drawn.wi.abs_cos_theta());
        if !survives(event, pile, &mut weight, rng) {
            return None;
        }
        (element, known) = (next, -drawn.wi);
        (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
    }
    None
}

/// An unbiased estimate of f [sr⁻¹] for light from `wi` above the pile, without discrete directions.
pub(super) fn estimate(
    pile: &Pile,
    wo: LocalDir,
    wi: LocalDir,
    mode: Mode,
    rng: &mut Pcg32,
    max_events: Option<usize>,
) -> Sampled<PerSteradian> {
    let mut ways = [WayOut { leg: wi, weight: Sampled::ONE, others: 0.0 }; MAX_LAYERS + 1];
    let n_ways = draw_ways_out(pile, &mut ways, mode.adjoint(), rng);
    let mut f = Sampled::<PerSteradian>::ZERO;
    let mut beta = Sampled::<Unitless>::ONE;
    let mut element = if wo.z > 0.0 { 0 } else { pile.len() - 1 };
    let mut known = wo;
    // Σ (q/p)² over the ways to make the rise that `known` belongs to, that join it further down.
    let mut others = 0.0_f64;
    for event in 0..max_events.unwrap_or(MAX_EVENTS) {
        if let Some(way) = ways[..n_ways].get(element)
            && let Some(value) = pile.evaluate(element, known, way.leg, mode)
            && !value.is_zero()
        {
            let up = square(value.pdf) * way.others;
            // A path that turns here can be joined no further down.
            let down = if known.z < 0.0 { square(value.reverse_pdf) * others } else { 0.0 };
            f += beta * way.weight * (value.f * (1.0 / (1.0 + up + down)) as f32);
        }
        let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
        let Some(drawn) = pile.draw(element, known, uc, u, mode, Sides::Both) else { break };
        let Some(next) = next_element(pile, element, drawn.wi) else { break };
        others = if drawn.wi.z < 0.0 {
            0.0
        } else {
            match drawn.pdf {
                None if known.z > 0.0 => 0.0,
                None => others * square64(pile.solid_angle_ratio(element, drawn.wi, known)),
                Some(p) if known.z > 0.0 => 1.0 / square(p),
                Some(p) => {
                    let reverse =
                        pile.evaluate(element, known, drawn.wi, mode).map_or(0.0, |v| v.reverse_pdf);
                    (1.0 + square(reverse) * others) / square(p)
                }
            }
        };
        beta *= drawn.weight;
        beta *= pile.transmittance_below(element.min(next), drawn.wi.abs_cos_theta());
        if !survives(event, pile, &mut beta, rng) {
            break;
        }
        (element, known) = (next, -drawn.wi);
    }
    f
}

/// Draws the way out from each element; returns to how many elements, from the top, it was found.
fn draw_ways_out(pile: &Pile, ways: &mut [WayOut], adjoint: Mode, rng: &mut Pcg32) -> usize {
    for element in 0..pile.len() - 1 {
        let way = ways[element];
        let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
        let Some(drawn) = pile.draw(element, way.leg, uc, u, adjoint, Sides::Transmission) else {
            return element + 1;
        };
        let others = match drawn.pdf {
            None => way.others * square64(pile.solid_angle_ratio(element, way.leg, drawn.wi)).recip(),
            Some(q) => {
                let forward =
                    pile.evaluate(element, drawn.wi, way.leg, adjoint.adjoint()).map_or(0.0, |v| v.pdf);
                (1.0 + square(forward) * way.others) / square(q)
            }
        };
        let passed = pile.transmittance_below(element, drawn.wi.abs_cos_theta());
        ways[element + 1] = WayOut { leg: -drawn.wi, weight: way.weight * drawn.weight * passed, others };
    }
    pile.len()
}

/// The element that a direction leads to; `None` outside.
fn next_element(pile: &Pile, element: usize, w: LocalDir) -> Option<usize> {
    if w.z > 0.0 { element.checked_sub(1) } else { Some(element + 1).filter(|&e| e < pile.len()) }
}

/// Russian roulette once a walk could have crossed the pile and come back: a dim one goes on with the probability that is its
/// weight.
fn survives(event: usize, pile: &Pile, beta: &mut Sampled<Unitless>, rng: &mut Pcg32) -> bool {
    let p = beta.max();
    if p == 0.0 {
        return false;
    }
    if event < 2 * pile.len() || p >= 0.25 {
        return true;
    }
    if rng.next_f32() >= p {
        return false;
    }
    *beta = *beta / p;
    true
}

fn square(x: f32) -> f64 {
    square64(f64::from(x))
}

fn square64(x: f64) -> f64 {
    x * x
}
