//! From paths to readings: spectral responses, blocks of samples and their sums.

use super::super::precision::{Moments, Precision, worse};
use super::super::session::{self, Block, Session};
use super::contract::Effort;
use crate::integrator::Tally;
use crate::sampler::Sampler;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled, Wavelengths, photometry};
use crate::units::{Estimate, Nm};

/// Samples of a block, one randomisation of a net: enough for the net to pay, few enough for the 32 blocks of the first stage
/// to be done in a moment.
const BLOCK: u32 = 128;

/// A reading without any light is believed after so many samples.
const DARK: u64 = 1 << 16;

/// That a wavelength is dark while others are not is believed after so many samples: four times as many as the first stage has.
const UNSEEN: u64 = 1 << 14;

/// How a detector responds to wavelengths.
#[derive(Clone, Copy)]
pub(super) enum Response<'a> {
    /// As the eye or one of its receptors.
    Weighted(&'a Efficacies),
    /// Each watt within 360–830 nm alike.
    Radiant,
    /// At single wavelengths [nm], each for itself.
    Lines(&'a [f32]),
}

/// What radiation is worth in a domain, at whole nanometres and linear in between: K_m V(λ) and its like.
pub(super) struct Efficacies(Vec<f32>);

impl Efficacies {
    pub(super) fn of<D: photometry::Response>() -> Self {
        let at = |nm: i32| photometry::efficacy_at::<D>(Nm(nm as f32)).value() as f32;
        Self((LAMBDA_MIN as i32..=LAMBDA_MAX as i32).map(at).collect())
    }

    /// At a wavelength within 360–830 nm.
    pub(super) fn at(&self, lambda: f32) -> f32 {
        let x = (lambda - LAMBDA_MIN).max(0.0);
        let below = (x as usize).min(self.0.len() - 2);
        let t = x - below as f32;
        self.0[below] * (1.0 - t) + self.0[below + 1] * t
    }
}

impl Response<'_> {
    /// Numbers that the detector shows.
    fn channels(self) -> usize {
        match self {
            Self::Weighted(_) | Self::Radiant => 1,
            Self::Lines(lines) => lines.len(),
        }
    }
}

/// Sums over blocks: for each channel, those of the N parts of the light that a meter tells apart.
#[derive(Clone, Debug)]
struct Sums<const N: usize> {
    channels: Vec<[Moments; N]>,
    /// Sums of the block in work.
    block: Vec<[f64; N]>,
    /// The most that one sample brought to a channel.
    largest: Vec<f64>,
    /// Which parts have been found at all.
    found: Vec<[bool; N]>,
    tally: Tally,
    samples: u64,
    lit: u64,
    dropped: u64,
}

impl<const N: usize> session::Tally for Sums<N> {
    fn merge(&mut self, later: &Self) {
        for (sum, more) in self.channels.iter_mut().flatten().zip(later.channels.iter().flatten()) {
            sum.merge(more);
        }
        for (largest, more) in self.largest.iter_mut().zip(&later.largest) {
            *largest = largest.max(*more);
        }
        for (found, more) in self.found.iter_mut().flatten().zip(later.found.iter().flatten()) {
            *found |= more;
        }
        self.tally = self.tally.merge(later.tally);
        self.samples += later.samples;
        self.lit += later.lit;
        self.dropped += later.dropped;
    }

    fn rays(&self) -> u64 {
        self.tally.rays()
    }
}

impl<const N: usize> Sums<N> {
    fn new(channels: usize) -> Self {
        Self {
            channels: vec![[Moments::default(); N]; channels],
            block: vec![[0.0; N]; channels],
            largest: vec![0.0; channels],
            found: vec![[false; N]; channels],
            tally: Tally::default(),
            samples: 0,
            lit: 0,
            dropped: 0,
        }
    }

    /// By which factor the blocks must still grow. Of a part that was not found, what it may have brought unseen must be small
    /// beside the whole.
    fn demand(&self, precision: &Precision, wanted: &[usize]) -> f64 {
        let until = |enough: u64| enough as f64 / self.samples.max(1) as f64;
        if self.lit == 0 {
            return if self.samples < DARK { until(DARK) } else { 0.0 };
        }
        let of_channel = |c: usize| {
            if self.largest[c] == 0.0 {
                return if self.samples < UNSEEN { until(UNSEEN) } else { 0.0 };
            }
            let all = self.estimates(c, precision);
            let of_part = |&part: &usize| match self.found[c][part] {
                true => precision.demand(all[part]),
                false => all[part].half_width / precision.target(all[0].value),
            };
            wanted.iter().map(of_part).fold(0.0, worse)
        };
        (0..self.channels.len()).map(of_channel).fold(0.0, worse)
    }

    /// The parts of a channel, of which the first is the sum of the others if there are any.
    ///
    /// A part that was not found is known to be rare or dim; what it may have brought unseen is bounded. Of a channel
    /// without any light there is nothing to scale the bound by.
    fn estimates(&self, channel: usize, precision: &Precision) -> [Estimate; N] {
        let mut all = self.channels[channel].each_ref().map(|m| m.estimate(precision));
        let unseen = precision.unseen(self.samples, self.largest[channel]);
        for part in 0..N {
            if !self.found[channel][part] {
                all[part].half_width = unseen;
                if part > 0 {
                    all[0].half_width += unseen;
                }
            }
        }
        all
    }

    /// One more path at the given wavelengths.
    fn count<Q>(&mut self, found: &[Sampled<Q>; N]) -> bool {
        self.samples += 1;
        let finite = found.iter().all(|part| part.is_finite());
        match finite {
            true => self.lit += u64::from(found.iter().any(|part| !part.is_zero())),
            false => self.dropped += 1,
        }
        finite
    }

    /// Adds what one sample brought to a part of a channel.
    fn add(&mut self, channel: usize, part: usize, amount: f64) {
        self.block[channel][part] += amount;
        self.largest[channel] = self.largest[channel].max(amount);
        self.found[channel][part] |= amount != 0.0;
    }

    fn close_block(&mut self) {
        for (moments, sums) in self.channels.iter_mut().zip(&mut self.block) {
            for (moments, sum) in moments.iter_mut().zip(sums) {
                moments.add(*sum / f64::from(BLOCK));
                *sum = 0.0;
            }
        }
    }
}

/// What a measurement came to: for each channel, the parts of the light.
pub(super) struct Raw<const N: usize> {
    pub(super) channels: Vec<[Estimate; N]>,
    pub(super) effort: Effort,
}

impl<const N: usize> Raw<N> {
    /// One part of the first channel.
    pub(super) fn single(&self, part: usize) -> Estimate {
        self.channels.first().map_or(Estimate::exact(0.0), |parts| parts[part])
    }

    /// One part of all channels.
    pub(super) fn all(&self, part: usize) -> impl Iterator<Item = Estimate> {
        self.channels.iter().map(move |parts| parts[part])
    }
}

/// Measures until the `wanted` parts are precise in each channel. `trace` finds one sample of the light at the given wavelengths.
pub(super) fn measure<const N: usize, Q>(
    session: &Session<'_>,
    stream: u64,
    response: Response<'_>,
    wanted: &[usize],
    trace: impl Fn(&mut Wavelengths, &mut Sampler, &mut Tally) -> [Sampled<Q>; N] + Sync,
) -> Raw<N> {
    let precision = &session.precision;
    let outcome = session.run(
        stream,
        || Sums::<N>::new(response.channels()),
        |sums, block| {
            take_block(sums, block, response, &trace);
            sums.close_block();
        },
        |sums| sums.demand(precision, wanted),
    );
    let sums = outcome.tally;
    let effort = Effort {
        rays: sums.tally.rays(),
        samples: sums.samples,
        lit: sums.lit,
        dropped: sums.dropped,
        ending: outcome.ending,
    };
    let channels = (0..sums.channels.len()).map(|c| sums.estimates(c, precision)).collect();
    Raw { channels, effort }
}

fn take_block<const N: usize, Q>(
    sums: &mut Sums<N>,
    block: Block,
    response: Response<'_>,
    trace: &impl Fn(&mut Wavelengths, &mut Sampler, &mut Tally) -> [Sampled<Q>; N],
) {
    let mut sampler = block.sampler(BLOCK);
    for index in 0..BLOCK {
        match response {
            Response::Weighted(weight) => {
                sampler.start([0, 0], index);
                let w = Wavelengths::sample_visible(sampler.next_1d());
                integrate(sums, w, |lambda| weight.at(lambda), |w, tally| trace(w, &mut sampler, tally));
            }
            Response::Radiant => {
                sampler.start([0, 0], index);
                let w = Wavelengths::sample_uniform(sampler.next_1d(), LAMBDA_MIN, LAMBDA_MAX);
                integrate(sums, w, |_| 1.0, |w, tally| trace(w, &mut sampler, tally));
            }
            Response::Lines(lines) => {
                for (group, lines) in lines.chunks(LANES).enumerate() {
                    read_lines(sums, group * LANES, lines, |w, tally| {
                        sampler.start([0, 0], index);
                        // All paths of a sample are one path, as far as wavelengths allow.
                        sampler.next_1d();
                        trace(w, &mut sampler, tally)
                    });
                }
            }
        }
    }
}

/// Adds a sample of the integral over wavelengths. Companions that were dropped have density zero.
fn integrate<const N: usize, Q>(
    sums: &mut Sums<N>,
    mut w: Wavelengths,
    weight: impl Fn(f32) -> f32,
    trace: impl FnOnce(&mut Wavelengths, &mut Tally) -> [Sampled<Q>; N],
) {
    let found = trace(&mut w, &mut sums.tally);
    if !sums.count(&found) {
        return;
    }
    let mut amounts = [0.0; N];
    for lane in 0..LANES {
        let (lambda, pdf) = (w.lambda()[lane], w.pdf()[lane]);
        if pdf > 0.0 {
            let weight = f64::from(weight(lambda)) / (f64::from(pdf) * LANES as f64);
            for (part, found) in found.iter().enumerate() {
                amounts[part] += weight * f64::from(found[lane]);
            }
        }
    }
    for (part, amount) in amounts.into_iter().enumerate() {
        sums.add(0, part, amount);
    }
}

/// Adds a sample at each of up to four wavelengths, the first of which is channel `first`.
///
/// A path that disperses is the hero's alone. Its companions then take the same random numbers again, each as the hero. Up to the
/// dispersive event they all take the same path, since what is chosen before it treats the wavelengths alike: whether a path
/// disperses does not depend on the hero, and each wavelength is estimated without bias.
fn read_lines<const N: usize, Q>(
    sums: &mut Sums<N>,
    first: usize,
    lines: &[f32],
    mut trace: impl FnMut(&mut Wavelengths, &mut Tally) -> [Sampled<Q>; N],
) {
    for hero in 0..lines.len() {
        // Lanes without a wavelength of their own repeat the hero.
        let order: [usize; LANES] = std::array::from_fn(|i| {
            let line = (hero + i) % LANES;
            if line < lines.len() { line } else { hero }
        });
        let mut w = Wavelengths::exactly(order.map(|line| lines[line]));
        let found = trace(&mut w, &mut sums.tally);
        let finite = sums.count(&found);
        let together = hero == 0 && !w.companions_terminated();
        let own = if together { LANES } else { 1 };
        if finite {
            for (lane, &line) in order.iter().enumerate().take(own) {
                // Each wavelength once, where it is in its own place.
                if (hero + lane) % LANES == line {
                    for (part, found) in found.iter().enumerate() {
                        sums.add(first + line, part, f64::from(found[lane]));
                    }
                }
            }
        }
        if together {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::CancelToken;
    use crate::spectrum::cie;
    use crate::units::{LUMENS_PER_WATT, Luminous, Unitless};

    fn session(cancel: &CancelToken) -> Session<'_> {
        Session { precision: Precision::default(), seed: 1, threads: Some(1), cancel }
    }

    #[test]
    fn each_line_is_read_in_its_own_channel_whether_paths_disperse_or_not() {
        let lines: Vec<f32> = (0..11).map(|i| 400.0 + 10.0 * i as f32).collect();
        let cancel = CancelToken::new();
        for share in [0.0, 0.4, 1.0] {
            let raw = measure(&session(&cancel), 0, Response::Lines(&lines), &[0], |w, sampler, _| {
                if sampler.next_1d() < share {
                    w.terminate_companions();
                    // What companions carry then must not count.
                    return [Sampled::<Unitless>::from_fn(|i| {
                        if i == 0 { w.lambda()[0] } else { f32::MAX / 4.0 }
                    })];
                }
                [Sampled::from_array(*w.lambda())]
            });
            for (line, read) in lines.iter().zip(raw.all(0)) {
                assert!((read.value / f64::from(*line) - 1.0).abs() < 1e-9, "{share}: {line} {read}");
            }
        }
    }

    #[test]
    fn photopic_and_radiant_responses_are_their_integrals_over_wavelengths() {
        let cancel = CancelToken::new();
        for share in [0.0, 0.5] {
            let trace = |w: &mut Wavelengths, sampler: &mut Sampler, _: &mut Tally| {
                if sampler.next_1d() < share {
                    w.terminate_companions();
                }
                [Sampled::<Unitless>::ONE]
            };
            let photopic = Efficacies::of::<Luminous>();
            let response = Response::Weighted(&photopic);
            let lumens = measure(&session(&cancel), 0, response, &[0], trace).single(0);
            let expected = f64::from(LUMENS_PER_WATT * cie::Y_INTEGRAL);
            assert!((lumens.value / expected - 1.0).abs() < 0.01 && lumens.half_width < 0.01 * expected);
            let watts = measure(&session(&cancel), 0, Response::Radiant, &[0], trace).single(0);
            assert!((watts.value / 470.0 - 1.0).abs() < 1e-5, "{watts}");
        }
    }

    #[test]
    fn darkness_is_believed_late_and_rare_light_is_found() {
        let cancel = CancelToken::new();
        let dark = |_: &mut Wavelengths, _: &mut Sampler, tally: &mut Tally| {
            tally.closest_rays += 1;
            [Sampled::<Unitless>::ZERO]
        };
        let raw = measure(&session(&cancel), 0, Response::Radiant, &[0], dark);
        assert!(raw.effort.samples >= DARK && raw.effort.note().is_some_and(|n| n.starts_with("dark")));
        // One path of 2¹³ carries light: the first stage, of 2¹² paths, finds it more often not than so.
        let rare = |_: &mut Wavelengths, sampler: &mut Sampler, tally: &mut Tally| {
            tally.closest_rays += 1;
            [Sampled::<Unitless>::splat(if sampler.next_1d() < 1.0 / 8192.0 { 8192.0 } else { 0.0 })]
        };
        let rough =
            Session { precision: Precision { relative: 0.2, ..Precision::default() }, ..session(&cancel) };
        for stream in 0..8 {
            let raw = measure(&rough, stream, Response::Lines(&[500.0]), &[0], rare);
            assert!((raw.single(0).value - 1.0).abs() < 0.4, "{}", raw.single(0));
        }
    }
}
