//! Reciprocity, with a search for the pair of directions that breaks it most.

use super::effort::Coverage;
use super::evidence::{Evidence, Expectation, Finding, Law};
use super::rounding;
use super::scatterer::{Scatterer, draw};
use super::statistics::Moments;
use super::survey::Bench;
use crate::bsdf::contract::{Mode, Side};
use crate::bsdf::specimen::Reciprocity;
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, warp};
use crate::spectrum::{LANES, Sampled};
use crate::units::PerSteradian;
use std::f32::consts::{PI, TAU};

/// Accepted relative difference beyond what rounding of directions explains.
const RELATIVE: f64 = 2e-3;
/// Values below are no light [sr⁻¹].
const FLOOR: f64 = 1e-6;

/// Most sweeps of a search over its four angles.
const SWEEPS: u32 = 100;

/// A pair of directions and how unlike its two ways are.
#[derive(Clone, Copy, Debug)]
struct Pair {
    /// (θo, φo, θi, φi).
    angles: [f32; 4],
    defect: Defect,
}

/// The two ways along a pair of directions, at the wavelength where they differ most.
#[derive(Clone, Copy, Debug)]
struct Defect {
    there: f64,
    back: f64,
    tolerance: f64,
    lane: usize,
}

impl Defect {
    const NONE: Self = Self { there: 0.0, back: 0.0, tolerance: FLOOR, lane: 0 };

    fn strain(&self) -> f64 {
        let strain = (self.there - self.back).abs() / self.tolerance;
        if strain.is_nan() { f64::INFINITY } else { strain }
    }

    /// Whether this is the worse one; of two that are alike, the one with more light.
    fn is_worse_than(&self, other: &Self) -> bool {
        let (a, b) = (self.strain(), other.strain());
        a > b || (a == b && self.there > other.there)
    }

    fn worse_of(self, other: Self) -> Self {
        if other.is_worse_than(&self) { other } else { self }
    }
}

impl Pair {
    fn worse_of(self, other: Self) -> Self {
        if other.defect.is_worse_than(&self.defect) { other } else { self }
    }
}

/// Which two values are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    /// Radiance both ways.
    Reciprocity,
    /// Radiance one way with power the other way.
    Adjoint,
}

impl<B: Scatterer> Bench<'_, B> {
    /// Searches for the worst pairs of directions, continuous and discrete.
    pub(super) fn judge_reciprocity(&self, findings: &mut Vec<Finding>) {
        for comparison in [Comparison::Reciprocity, Comparison::Adjoint] {
            let index = self.relative_index();
            let worst = if self.claims.is_closed_form() {
                self.worst_pair(comparison, index)
            } else {
                self.worst_estimated_pair(comparison, index)
            };
            let (law, expectation) = match (comparison, self.claims.reciprocity) {
                (Comparison::Adjoint, Reciprocity::Reported) => (Law::Adjoint, Expectation::Reported),
                (Comparison::Adjoint, _) => (Law::Adjoint, self.of_values()),
                (_, Reciprocity::Exact) if self.claims.has_named_bias() => {
                    (Law::Reciprocity, Expectation::Reported)
                }
                (_, Reciprocity::Exact) => (Law::Reciprocity, Expectation::Holds),
                (_, Reciprocity::Reported) => (Law::Reciprocity, Expectation::Reported),
                (_, Reciprocity::Broken) => (Law::Reciprocity, Expectation::Broken),
            };
            if let Some(Pair { angles, defect }) = worst {
                let [wo, wi] = directions(angles);
                let evidence = Evidence::Equality {
                    observed: defect.back,
                    expected: defect.there,
                    tolerance: defect.tolerance,
                };
                let mut finding = Finding::new(law, wo, Mode::Radiance, evidence).expecting(expectation);
                (finding.wi, finding.lane) = (Some(wi), Some(defect.lane));
                findings.push(finding);
            }
        }
        self.judge_discrete(findings);
    }

    /// Index below the surface over the index above it, as samples tell; one where nothing passes.
    fn relative_index(&self) -> f32 {
        let mut rng = Pcg32::new(self.effort.seed, 31);
        for i in 0..2000 {
            let wo = LocalDir::new_unchecked(warp::spherical_direction(0.3 + 0.0005 * i as f32, 1.0));
            if let Some(s) = draw(&self.bsdf, wo, Mode::Importance, &mut rng)
                && s.side == Side::Transmission
            {
                return s.eta;
            }
        }
        1.0
    }

    /// f one way times η² and f the other way.
    fn both_ways(
        &self,
        bsdf: &B,
        w: [LocalDir; 2],
        comparison: Comparison,
        index: f32,
    ) -> [Sampled<PerSteradian>; 2] {
        let [wo, wi] = w;
        let there = bsdf.eval(wo, wi, Mode::Radiance);
        match comparison {
            Comparison::Reciprocity => {
                let eta = match (wo.z * wi.z < 0.0, wo.z > 0.0) {
                    (false, _) => 1.0,
                    (true, true) => index,
                    (true, false) => 1.0 / index,
                };
                [there * (eta * eta), bsdf.eval(wi, wo, Mode::Radiance)]
            }
            Comparison::Adjoint => [there, bsdf.eval(wi, wo, Mode::Importance)],
        }
    }

    fn defect(&self, angles: [f32; 4], comparison: Comparison, index: f32) -> Defect {
        let w = directions(angles);
        let [there, back] = self.both_ways(&self.bsdf, w, comparison, index);
        let mut worst = Defect::NONE;
        let mut suspicious = false;
        for lane in 0..LANES {
            let (a, b) = (f64::from(there[lane]), f64::from(back[lane]));
            let d = Defect { there: a, back: b, tolerance: RELATIVE * a.abs().max(b.abs()) + FLOOR, lane };
            suspicious |= !(d.strain() < 0.5);
            worst = worst.worse_of(d);
        }
        if suspicious {
            // What rounding of either direction does to either value.
            let lane = worst.lane;
            let mut spread = 0.0_f64;
            let pairs = rounding::neighbours(w[0])
                .map(|o| [o, w[1]])
                .chain(rounding::neighbours(w[1]).map(|i| [w[0], i]));
            for pair in pairs {
                let [a, b] = self.both_ways(&self.bsdf, pair, comparison, index);
                spread = spread
                    .max((f64::from(a[lane]) - worst.there).abs())
                    .max((f64::from(b[lane]) - worst.back).abs());
            }
            worst.tolerance += 4.0 * spread;
        }
        worst
    }

    /// Random pairs, pairs that sampling finds, grazing pairs; then a pattern search from the worst of them
    /// (Hooke & Jeeves 1961).
    fn worst_pair(&self, comparison: Comparison, index: f32) -> Option<Pair> {
        let mut rng = Pcg32::new(self.effort.seed, 9);
        let starts = match self.effort.coverage {
            Coverage::Few => 600,
            Coverage::Full => 3000,
        };
        let mut found: Vec<Pair> = (0..starts)
            .filter_map(|i| self.start(i, &mut rng))
            .map(|angles| Pair { angles, defect: self.defect(angles, comparison, index) })
            .collect();
        found.sort_by(|a, b| {
            let (a, b) = (a.defect, b.defect);
            b.strain().total_cmp(&a.strain()).then(b.there.total_cmp(&a.there))
        });
        found.truncate(8);
        for pair in &mut found {
            let mut step = 0.2_f32;
            for _ in 0..SWEEPS {
                if step < 1e-3 {
                    break;
                }
                let mut improved = false;
                for axis in 0..4 {
                    for sign in [step, -step] {
                        let mut angles = pair.angles;
                        angles[axis] += sign;
                        if axis % 2 == 0 {
                            angles[axis] = off_horizon(angles[axis]);
                        }
                        let defect = self.defect(angles, comparison, index);
                        if defect.is_worse_than(&pair.defect) {
                            *pair = Pair { angles, defect };
                            improved = true;
                        }
                    }
                }
                if !improved {
                    step *= 0.5;
                }
            }
        }
        found.into_iter().reduce(Pair::worse_of)
    }

    /// The i-th start of a search.
    fn start(&self, i: u32, rng: &mut Pcg32) -> Option<[f32; 4]> {
        let mut direction = |grazing: bool| {
            let theta = if grazing {
                0.5 * PI + (rng.next_f32() - 0.5) * 0.2
            } else {
                (1.0 - 2.0 * rng.next_f32()).acos()
            };
            [off_horizon(theta), TAU * rng.next_f32()]
        };
        let [to, po] = direction(i % 4 == 1);
        if i.is_multiple_of(2) {
            let [ti, pi] = direction(i % 4 == 2);
            return Some([to, po, ti, pi]);
        }
        let wo = LocalDir::new_unchecked(warp::spherical_direction(to, po));
        let s = draw(&self.bsdf, wo, Mode::Radiance, rng)?;
        let (ti, pi) = warp::spherical_angles(*s.wi);
        (!s.density.is_delta()).then(|| [to, po, off_horizon(ti), pi])
    }

    /// The same for values that are estimates: pairs are screened with few walks, and the most suspicious ones
    /// get fresh and many.
    fn worst_estimated_pair(&self, comparison: Comparison, index: f32) -> Option<Pair> {
        let mut rng = Pcg32::new(self.effort.seed, 9);
        let (screened, kept) = match self.effort.coverage {
            Coverage::Few => (24, 3),
            Coverage::Full => (100, 6),
        };
        let judged = |angles: [f32; 4], walks: u64, stream: u64| {
            let mut moments = [[Moments::default(); LANES]; 2];
            for i in 0..walks {
                let bsdf = self.bsdf.with_seed(hash::combine(self.effort.seed ^ stream, i));
                let values = self.both_ways(&bsdf, directions(angles), comparison, index);
                for (moments, f) in moments.iter_mut().zip(values) {
                    for (m, f) in moments.iter_mut().zip(f.to_array()) {
                        m.add(f64::from(f));
                    }
                }
            }
            let mut worst = Defect::NONE;
            for (lane, (a, b)) in moments[0].iter().zip(&moments[1]).enumerate() {
                let error = a.error().hypot(b.error());
                let tolerance = self.effort.sigmas() * error + RELATIVE * a.mean().max(b.mean()) + FLOOR;
                let d = Defect { there: a.mean(), back: b.mean(), tolerance, lane };
                worst = worst.worse_of(d);
            }
            Pair { angles, defect: worst }
        };
        let mut found: Vec<Pair> =
            (0..screened).filter_map(|i| self.start(i, &mut rng)).map(|a| judged(a, 200, 1)).collect();
        found.sort_by(|a, b| b.defect.strain().total_cmp(&a.defect.strain()));
        found
            .iter()
            .take(kept)
            .map(|p| judged(p.angles, u64::from(self.effort.samples / 16), 2))
            .reduce(Pair::worse_of)
    }

    /// Discrete directions: the power from `wo` to `wi` is that from `wi` to `wo`, and η² times that of radiance.
    fn judge_discrete(&self, findings: &mut Vec<Finding>) {
        let n = self.effort.samples / 8;
        for (stream, theta) in [0.0_f32, 0.6, 1.4, 2.0, 2.7].into_iter().enumerate() {
            let wo = LocalDir::new_unchecked(warp::spherical_direction(theta, 1.0));
            let mut rng = Pcg32::new(self.effort.seed, 40 + stream as u64);
            let there = self.atoms(wo, Mode::Importance, n, &mut rng);
            if there.is_empty() {
                continue;
            }
            let radiance = self.atoms(wo, Mode::Radiance, n, &mut rng);
            for atom in &there {
                let scale = f64::from(atom.eta * atom.eta);
                let back = self.atoms(atom.wi, Mode::Importance, n, &mut rng);
                for (law, other, scale) in [
                    (Law::Reciprocity, toward(&back, wo), 1.0),
                    (Law::Adjoint, toward(&radiance, atom.wi), scale),
                ] {
                    let mut worst = Defect::NONE;
                    for lane in 0..LANES {
                        let (a, b) = (atom.power[lane], other.map_or(Moments::default(), |o| o.power[lane]));
                        let error = a.error().hypot(scale * b.error());
                        // A rare direction that was not met once has no spread to show: that of one meeting.
                        let tolerance =
                            self.effort.sigmas() * error.max(1.0 / f64::from(n)) + 2e-3 * a.mean();
                        let d = Defect { there: a.mean(), back: scale * b.mean(), tolerance, lane };
                        worst = worst.worse_of(d);
                    }
                    let evidence = Evidence::Equality {
                        observed: worst.back,
                        expected: worst.there,
                        tolerance: worst.tolerance,
                    };
                    let expectation = match (law, self.claims.reciprocity) {
                        (Law::Adjoint, _) | (_, Reciprocity::Exact) => Expectation::Holds,
                        (_, Reciprocity::Reported | Reciprocity::Broken) => Expectation::Reported,
                    };
                    let mut finding =
                        Finding::new(law, wo, Mode::Importance, evidence).expecting(expectation);
                    (finding.wi, finding.lane) = (Some(atom.wi), Some(worst.lane));
                    findings.push(finding);
                }
            }
        }
    }

    /// The discrete directions that samples for `wo` take, with their power; at most eight.
    fn atoms(&self, wo: LocalDir, mode: Mode, n: u32, rng: &mut Pcg32) -> Vec<Atom> {
        let mut atoms: Vec<Atom> = Vec::new();
        for drawn in 0..n {
            let sample = draw(&self.bsdf, wo, mode, rng).filter(|s| s.density.is_delta());
            let met = sample.and_then(|s| {
                let known = atoms.iter().position(|a| near(a.wi, s.wi));
                known.or_else(|| {
                    (atoms.len() < 8).then(|| {
                        let power = [Moments::zeros(drawn); LANES];
                        atoms.push(Atom { wi: s.wi, eta: s.eta, power });
                        atoms.len() - 1
                    })
                })
            });
            for (i, atom) in atoms.iter_mut().enumerate() {
                let weight =
                    if met == Some(i) { sample.map_or(Sampled::ZERO, |s| s.weight) } else { Sampled::ZERO };
                for (m, w) in atom.power.iter_mut().zip(weight.to_array()) {
                    m.add(f64::from(w));
                }
            }
        }
        atoms
    }
}

/// A discrete direction.
#[derive(Clone, Copy, Debug)]
struct Atom {
    wi: LocalDir,
    eta: f32,
    /// Share times weight per wavelength.
    power: [Moments; LANES],
}

fn toward(atoms: &[Atom], w: LocalDir) -> Option<&Atom> {
    atoms.iter().find(|a| near(a.wi, w))
}

fn near(a: LocalDir, b: LocalDir) -> bool {
    (*a - *b).length_squared() < 1e-6
}

fn directions([to, po, ti, pi]: [f32; 4]) -> [LocalDir; 2] {
    [(to, po), (ti, pi)].map(|(t, p)| LocalDir::new_unchecked(warp::spherical_direction(t, p)))
}

/// Half a degree from the horizon at least, and between the poles.
fn off_horizon(theta: f32) -> f32 {
    let theta = theta.clamp(0.0, PI);
    let gap = 0.5_f32.to_radians();
    if (theta - 0.5 * PI).abs() < gap { 0.5 * PI + gap.copysign(theta - 0.5 * PI) } else { theta }
}
