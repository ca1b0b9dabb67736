//! Which emitter to sample.

use super::bounds::EmitterBounds;
use super::contract::{Emitter, LightId};
use super::tree::{Leaf, LightTree};
use crate::math::distribution::AliasTable;
use crate::math::float::ONE_MINUS_EPSILON;
use crate::shape::ReferencePoint;

/// An emitter and the probability with which it was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// The emitter.
    pub emitter: Emitter,
    /// Its probability, positive.
    pub probability: f32,
}

/// What the selection knows of one light.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) light: LightId,
    /// Whether it shines from infinity, without a place of its own.
    pub(super) infinite: bool,
    /// Power of each of its primitives, up to a common factor; one entry for a light without a shape.
    pub(super) weights: Vec<f32>,
    /// Where each of them is and shines; empty when the selection shall not depend on the place.
    pub(super) bounds: Vec<EmitterBounds>,
}

/// Chooses emitters: lights at infinity with equal probability, all others together once as often as one of
/// those; among themselves by power, in constant time, or by what they may contribute at a point, in logarithmic time.
///
/// Power does not compare across the two groups: that of a sky grows with the size of the scene, and would
/// starve every lamp of an interior.
#[derive(Clone, Debug, Default)]
pub struct LightSampler {
    infinite: Vec<LightId>,
    emitters: Vec<Emitter>,
    /// `None` when no local emitter emits.
    local: Option<AliasTable>,
    /// Probability of choosing the group of local emitters.
    local_share: f32,
    /// `None` when the choice does not depend on the place.
    tree: Option<LightTree>,
    /// Where each light's entries begin.
    places: Vec<Place>,
}

/// What a number has chosen.
enum Group<'a> {
    /// A light at infinity.
    Infinite(Chosen),
    /// Some other emitter, of this distribution of powers, with the stretched rest of the number.
    Local { table: &'a AliasTable, u: f32 },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Never chosen.
    Nowhere,
    Infinite,
    Local(u32),
}

impl LightSampler {
    /// A selection among `candidates`; weights that are not positive and finite are never chosen.
    pub(super) fn new(candidates: impl IntoIterator<Item = Candidate>) -> Self {
        let mut sampler = Self::default();
        let mut weights = Vec::new();
        let mut bounds = Vec::new();
        for candidate in candidates {
            let usable = |w: f32| if w > 0.0 && w.is_finite() { w } else { 0.0 };
            let slot = candidate.light.0 as usize;
            if sampler.places.len() <= slot {
                sampler.places.resize(slot + 1, Place::Nowhere);
            }
            if candidate.infinite {
                if candidate.weights.iter().any(|&w| usable(w) > 0.0) {
                    sampler.infinite.push(candidate.light);
                    sampler.places[slot] = Place::Infinite;
                }
                continue;
            }
            sampler.places[slot] = Place::Local(sampler.emitters.len() as u32);
            for (prim, &w) in (0..).zip(&candidate.weights) {
                sampler.emitters.push(Emitter { light: candidate.light, prim });
                weights.push(usable(w));
                bounds.push(candidate.bounds.get(prim as usize).copied());
            }
        }
        sampler.local = AliasTable::new(&weights);
        sampler.local_share =
            sampler.local.as_ref().map_or(0.0, |_| 1.0 / (1.0 + sampler.infinite.len() as f32));
        // The halves of one quadrilateral contribute alike: asking the tree would cost a seventh of a Cornell box's time.
        let is_quadrilateral = match sampler.emitters[..] {
            [_] => true,
            [a, b] => a.light == b.light,
            _ => false,
        };
        sampler.tree = if is_quadrilateral { None } else { LightTree::build(&bounds) };
        sampler
    }

    /// Chooses an emitter with `u` in [0, 1), for no place in particular; `None` when nothing emits.
    #[inline(always)]
    pub fn sample(&self, u: f32) -> Option<Chosen> {
        match self.group(u)? {
            Group::Infinite(chosen) => Some(chosen),
            Group::Local { table, u } => {
                let d = table.sample(u);
                Some(Chosen { emitter: self.emitters[d.index], probability: d.p * self.local_share })
            }
        }
    }

    /// Probability with which [`LightSampler::sample`] chooses `emitter`; zero for one that is never.
    pub fn probability(&self, emitter: Emitter) -> f32 {
        match self.place(emitter) {
            Place::Infinite => (1.0 - self.local_share) / self.infinite.len() as f32,
            Place::Local(index) => {
                self.local.as_ref().map_or(0.0, |table| table.probability(index as usize) * self.local_share)
            }
            Place::Nowhere => 0.0,
        }
    }

    /// Chooses an emitter for the light that arrives at `from`; `None` when nothing reaches it. By power if the
    /// selection does not know places.
    #[inline(always)]
    pub fn sample_at(&self, from: &ReferencePoint, u: f32) -> Option<Chosen> {
        let Some(tree) = &self.tree else { return self.sample(u) };
        match self.group(u)? {
            Group::Infinite(chosen) => Some(chosen),
            Group::Local { u, .. } => {
                let Leaf { index, probability } = tree.sample(from, u)?;
                let probability = probability * self.local_share;
                let emitter = self.emitters[index as usize];
                (probability > 0.0).then_some(Chosen { emitter, probability })
            }
        }
    }

    /// Probability with which [`LightSampler::sample_at`] chooses `emitter`; zero for one that is never.
    #[inline(always)]
    pub fn probability_at(&self, from: &ReferencePoint, emitter: Emitter) -> f32 {
        match (&self.tree, self.place(emitter)) {
            (Some(tree), Place::Local(index)) => tree.probability(from, index as usize) * self.local_share,
            _ => self.probability(emitter),
        }
    }

    /// Chooses between the lights at infinity, one by one, and all others.
    #[inline(always)]
    fn group(&self, u: f32) -> Option<Group<'_>> {
        let share = self.local_share;
        match &self.local {
            Some(table) if u < share || self.infinite.is_empty() => {
                Some(Group::Local { table, u: (u / share).min(ONE_MINUS_EPSILON) })
            }
            _ => {
                let n = self.infinite.len();
                let index =
                    (((u - share) / (1.0 - share) * n as f32).max(0.0) as usize).min(n.checked_sub(1)?);
                let emitter = Emitter { light: self.infinite[index], prim: 0 };
                Some(Group::Infinite(Chosen { emitter, probability: (1.0 - share) / n as f32 }))
            }
        }
    }

    /// Where an emitter is listed; of a local one, its own index.
    #[inline(always)]
    fn place(&self, emitter: Emitter) -> Place {
        match self.places.get(emitter.light.0 as usize) {
            Some(&Place::Local(first)) => Place::Local(first + emitter.prim),
            Some(&place) => place,
            None => Place::Nowhere,
        }
    }

    /// The lights at infinity that emit.
    pub fn infinite(&self) -> &[LightId] {
        &self.infinite
    }

    /// Number of emitters that may be chosen, including those of weight zero.
    pub fn len(&self) -> usize {
        self.infinite.len() + self.emitters.len()
    }

    /// Whether there is nothing to choose.
    pub fn is_empty(&self) -> bool {
        self.infinite.is_empty() && self.local.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(light: u32, infinite: bool, weights: &[f32]) -> Candidate {
        Candidate { light: LightId(light), infinite, weights: weights.to_vec(), bounds: Vec::new() }
    }

    #[test]
    fn choices_follow_their_probabilities() {
        let s = LightSampler::new([
            candidate(0, false, &[1.0]),
            candidate(1, true, &[5.0]),
            candidate(2, false, &[2.0, 0.0, f32::NAN, 1.0]),
            candidate(3, true, &[0.0]),
            candidate(4, true, &[1e9]),
        ]);
        let n = 90_000;
        let mut counts = std::collections::BTreeMap::new();
        for i in 0..n {
            let c = s.sample((i as f32 + 0.5) / n as f32).unwrap();
            assert_eq!(c.probability, s.probability(c.emitter));
            *counts.entry(c.emitter).or_insert(0) += 1;
        }
        // Two lights at infinity and one group of lamps, a third each; within it 1 : 2 : 1.
        let expected =
            [(0, 0, 1.0 / 12.0), (1, 0, 1.0 / 3.0), (2, 0, 1.0 / 6.0), (2, 3, 1.0 / 12.0), (4, 0, 1.0 / 3.0)];
        assert_eq!(counts.len(), expected.len());
        for (light, prim, p) in expected {
            let e = Emitter { light: LightId(light), prim };
            assert!(
                (counts[&e] as f32 / n as f32 - p).abs() < 1e-3 && (s.probability(e) - p).abs() < 1e-6,
                "{e:?}"
            );
        }
        let zero =
            [(2, 1), (2, 2), (3, 0), (9, 0)].map(|(light, prim)| Emitter { light: LightId(light), prim });
        assert!(zero.iter().all(|&e| s.probability(e) == 0.0));
    }

    #[test]
    fn nothing_is_chosen_when_nothing_emits() {
        let s = LightSampler::new([candidate(0, false, &[0.0]), candidate(1, true, &[0.0])]);
        assert!(s.sample(0.3).is_none() && s.is_empty());
        let only_sky = LightSampler::new([candidate(0, true, &[1.0])]);
        assert_eq!(only_sky.sample(0.999_999).unwrap().probability, 1.0);
        let only_lamp = LightSampler::new([candidate(0, false, &[1.0])]);
        assert_eq!(only_lamp.sample(0.999_999).unwrap().probability, 1.0);
    }
}
