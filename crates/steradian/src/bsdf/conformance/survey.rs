//! One direction under one mode: drawn many times, and integrated.

use super::effort::Effort;
use super::rounding;
use super::scatterer::{Scatterer, draw};
use super::sphere::Partition;
use super::statistics::Moments;
use crate::bsdf::contract::{BsdfSample, Mode, Side};
use crate::bsdf::specimen::Claims;
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, Vec3};
use crate::spectrum::{LANES, Sampled};
use crate::units::Density;

/// Samples per cell of the partition among the pilots.
const PILOTS_PER_CELL: usize = 16;
/// Samples whose weight is compared with f cosθ/p one by one.
const CHECKED: u32 = 1 << 14;
/// Samples of an estimated function stand for random walks and are as many times dearer.
const DEARER: u32 = 2;

/// Share of the arriving power below which a cell of an estimated function is not judged: its walks are too few.
const NEGLIGIBLE: f64 = 1e-3;

/// What is put under the survey.
#[derive(Clone, Copy)]
pub(super) struct Bench<'a, B> {
    pub(super) bsdf: B,
    pub(super) claims: Claims,
    pub(super) effort: &'a Effort,
}

/// A discrepancy between two numbers that should be one, with what rounding accounts for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Discrepancy {
    pub(super) observed: f64,
    pub(super) expected: f64,
    pub(super) tolerance: f64,
    pub(super) wi: LocalDir,
    pub(super) lane: Option<usize>,
}

impl Discrepancy {
    fn strain(&self) -> f64 {
        let strain = (self.observed - self.expected).abs() / self.tolerance;
        if strain.is_nan() { f64::INFINITY } else { strain }
    }

    /// Keeps the worse of two.
    pub(super) fn worse(worst: &mut Option<Self>, other: Self) {
        if worst.is_none_or(|w| other.strain() > w.strain()) {
            *worst = Some(other);
        }
    }
}

/// Powers per wavelength that go to each side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sides<T> {
    pub(super) reflected: [T; LANES],
    pub(super) transmitted: [T; LANES],
}

impl<T> Sides<T> {
    pub(super) fn of(&self, side: Side) -> &[T; LANES] {
        match side {
            Side::Reflection => &self.reflected,
            Side::Transmission => &self.transmitted,
        }
    }

    fn of_mut(&mut self, side: Side) -> &mut [T; LANES] {
        match side {
            Side::Reflection => &mut self.reflected,
            Side::Transmission => &mut self.transmitted,
        }
    }
}

/// An integral with its standard error, zero for adaptive quadrature.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Integral {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// What was found at one direction.
pub(super) struct Survey {
    pub(super) wo: LocalDir,
    pub(super) mode: Mode,
    pub(super) partition: Partition,
    /// Number of draws.
    pub(super) n: u32,
    /// Continuous samples in each cell.
    pub(super) counts: Vec<f64>,
    /// ∫ p dω over each cell, for a closed form.
    pub(super) density: Vec<f64>,
    /// Weights of all samples.
    pub(super) sampled: Sides<Moments>,
    /// Weights of all samples, both sides together.
    pub(super) total: [Moments; LANES],
    /// Weights of discrete samples.
    pub(super) discrete: Sides<Moments>,
    /// ∫ f cosθ dω.
    pub(super) integrated: Sides<Integral>,
    /// The worst weight.
    pub(super) weight: Option<Discrepancy>,
    /// The worst density of a sample.
    pub(super) sample_density: Option<Discrepancy>,
    /// Samples that name their side, index or lobe wrongly.
    pub(super) misfits: u32,
}

impl<B: Scatterer> Bench<'_, B> {
    /// Draws and integrates for the direction `wo`; `index` names the stream of random numbers.
    pub(super) fn survey(&self, wo: LocalDir, mode: Mode, index: u64) -> Survey {
        let closed = self.claims.is_closed_form();
        let n = if closed { self.effort.samples } else { self.effort.samples / DEARER };
        let mut rng = Pcg32::new(hash::combine(self.effort.seed, index), 5);
        let pilots: Vec<LocalDir> = (0..n / 8)
            .filter_map(|_| draw(&self.bsdf, wo, mode, &mut rng))
            .filter(|s| !s.density.is_delta())
            .map(|s| s.wi)
            .collect();
        let mirrored = LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z));
        let beacons = [mirrored, -mirrored, wo, -wo];
        let partition = Partition::adapted(&pilots, PILOTS_PER_CELL, if closed { &beacons } else { &[] });
        let mut survey = Survey {
            wo,
            mode,
            n,
            counts: vec![0.0; partition.len()],
            density: Vec::new(),
            sampled: Sides::default(),
            total: Default::default(),
            discrete: Sides::default(),
            integrated: Sides::default(),
            weight: None,
            sample_density: None,
            misfits: 0,
            partition,
        };
        let by_group = self.draw_all(&mut survey, &mut rng);
        if closed {
            self.integrate(&mut survey);
        } else {
            self.estimate_integral(&mut survey, &by_group, &mut rng);
        }
        survey
    }

    /// Draws all samples; returns the weights of continuous ones by coarse cell.
    fn draw_all(&self, survey: &mut Survey, rng: &mut Pcg32) -> Vec<[Sums; LANES]> {
        let closed = self.claims.is_closed_form();
        let lobes = self.bsdf.lobes();
        let mut by_group = vec![[Sums::default(); LANES]; survey.partition.groups()];
        for i in 0..survey.n {
            let sample = draw(&self.bsdf, survey.wo, survey.mode, rng);
            let weight = sample.map_or(Sampled::ZERO, |s| s.weight);
            let side = sample.map_or(Side::Reflection, |s| s.side);
            let discrete = sample.is_some_and(|s| s.density.is_delta());
            for lane in 0..LANES {
                let w = f64::from(weight[lane]);
                survey.total[lane].add(w);
                for which in [Side::Reflection, Side::Transmission] {
                    let w = if which == side { w } else { 0.0 };
                    survey.sampled.of_mut(which)[lane].add(w);
                    survey.discrete.of_mut(which)[lane].add(if discrete { w } else { 0.0 });
                }
            }
            let Some(s) = sample else { continue };
            let crossed = survey.wo.z * s.wi.z < 0.0;
            let lobe = if crossed { lobes.transmission } else { lobes.reflection };
            let misfit = crossed != (s.side == Side::Transmission)
                || !(discrete || lobe)
                || !(s.eta > 0.0 && s.eta.is_finite())
                || !(crossed || s.eta == 1.0);
            // In the surface a direction has no side.
            survey.misfits += u32::from(misfit && s.wi.abs_cos_theta() > 1e-6);
            let Density::SolidAngle(pdf) = s.density else { continue };
            let cell = survey.partition.cell(s.wi);
            survey.counts[cell] += 1.0;
            if closed {
                if i < CHECKED {
                    self.check(survey, &s, pdf.0);
                }
            } else {
                for (sums, w) in by_group[survey.partition.group(cell)].iter_mut().zip(weight.to_array()) {
                    sums.add(f64::from(w));
                }
            }
        }
        by_group
    }

    /// Compares one sample with the function's values there.
    fn check(&self, survey: &mut Survey, s: &BsdfSample, pdf: f32) {
        let (wo, mode) = (survey.wo, survey.mode);
        let f = self.bsdf.eval(wo, s.wi, mode);
        let reported = self.bsdf.pdf(wo, s.wi, mode).0;
        let relative = 2e-3;
        let mut found = Discrepancy {
            observed: f64::from(pdf),
            expected: f64::from(reported),
            tolerance: relative * f64::from(pdf.max(reported)),
            wi: s.wi,
            lane: None,
        };
        // Rounding is looked into only where it may be to blame.
        if !(found.strain() < 1.0) {
            found.tolerance += rounding::spread(s.wi, reported, |wi| self.bsdf.pdf(wo, wi, mode).0);
        }
        Discrepancy::worse(&mut survey.sample_density, found);
        for lane in 0..LANES {
            let scale = s.wi.abs_cos_theta() / pdf;
            let (ratio, weight) = (f[lane] * scale, s.weight[lane]);
            let mut found = Discrepancy {
                observed: f64::from(weight),
                expected: f64::from(ratio),
                tolerance: relative * f64::from(weight.max(ratio)) + 1e-5,
                wi: s.wi,
                lane: Some(lane),
            };
            if !(found.strain() < 1.0) {
                found.tolerance += rounding::spread(s.wi, ratio, |wi| {
                    self.bsdf.eval(wo, wi, mode)[lane] * wi.abs_cos_theta() / pdf
                });
            }
            Discrepancy::worse(&mut survey.weight, found);
        }
    }

    /// Adaptive quadrature of p and f cosθ.
    fn integrate(&self, survey: &mut Survey) {
        let (wo, mode) = (survey.wo, survey.mode);
        let cells = survey.partition.integrate(&mut |wi| {
            let f = self.bsdf.eval(wo, wi, mode) * wi.abs_cos_theta();
            let mut values = [f64::from(self.bsdf.pdf(wo, wi, mode).0); LANES + 1];
            for (value, f) in values[1..].iter_mut().zip(f.to_array()) {
                *value = f64::from(f);
            }
            values
        });
        for (cell, values) in cells.iter().enumerate() {
            survey.density.push(values[0]);
            let side = survey.side_of(cell);
            for lane in 0..LANES {
                survey.integrated.of_mut(side)[lane].value += values[lane + 1];
            }
        }
    }

    /// Stratified estimate of ∫ f cosθ dω for a function whose values are estimates, and of what the weights average
    /// to in each coarse cell.
    fn estimate_integral(&self, survey: &mut Survey, by_group: &[[Sums; LANES]], rng: &mut Pcg32) {
        let per_cell = (survey.n as usize / survey.partition.len()).clamp(4, 4096);
        let mut groups = vec![[Integral::default(); LANES]; survey.partition.groups()];
        for cell in 0..survey.partition.len() {
            let mut moments = [Moments::default(); LANES];
            for _ in 0..per_cell {
                let u = [f64::from(rng.next_f32()), f64::from(rng.next_f32())];
                let (wi, solid_angle) = survey.partition.point(cell, u);
                let f = self.bsdf.eval(survey.wo, wi, survey.mode) * wi.abs_cos_theta();
                for (m, f) in moments.iter_mut().zip(f.to_array()) {
                    m.add(f64::from(f) * solid_angle);
                }
            }
            let side = survey.side_of(cell);
            for lane in 0..LANES {
                for integral in [
                    &mut survey.integrated.of_mut(side)[lane],
                    &mut groups[survey.partition.group(cell)][lane],
                ] {
                    integral.value += moments[lane].mean();
                    integral.error = integral.error.hypot(moments[lane].error());
                }
            }
        }
        for (group, (sums, integrals)) in by_group.iter().zip(&groups).enumerate() {
            for lane in 0..LANES {
                let sampled = sums[lane].over(survey.n);
                // Few samples say nothing of their spread.
                if sums[lane].count < 100 {
                    continue;
                }
                let error = sampled.error.hypot(integrals[lane].error);
                let found = Discrepancy {
                    observed: sampled.value,
                    expected: integrals[lane].value,
                    tolerance: self.effort.sigmas() * error + 5e-3 * sampled.value + NEGLIGIBLE,
                    wi: survey.middle_of_group(group),
                    lane: Some(lane),
                };
                Discrepancy::worse(&mut survey.weight, found);
            }
        }
    }
}

impl Survey {
    fn side_of(&self, cell: usize) -> Side {
        if self.partition.is_above(cell) == (self.wo.z > 0.0) { Side::Reflection } else { Side::Transmission }
    }

    fn middle_of_group(&self, group: usize) -> LocalDir {
        let cell = (0..self.partition.len()).find(|&c| self.partition.group(c) == group).unwrap_or(0);
        self.partition.point(cell, [0.5, 0.5]).0
    }

    /// Power to a side by quadrature of the continuous part, and by sampling of the discrete one.
    pub(super) fn by_quadrature(&self, side: Side, lane: usize) -> Integral {
        let (continuous, discrete) = (self.integrated.of(side)[lane], self.discrete.of(side)[lane]);
        Integral {
            value: continuous.value + discrete.mean(),
            error: continuous.error.hypot(discrete.error()),
        }
    }

    /// Power to a side by sampling.
    pub(super) fn by_sampling(&self, side: Side, lane: usize) -> Integral {
        let m = self.sampled.of(side)[lane];
        Integral { value: m.mean(), error: m.error() }
    }
}

/// Sums of the weights that fell into a cell; all other samples count as zero.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: u32,
    sum: f64,
    squares: f64,
}

impl Sums {
    fn add(&mut self, x: f64) {
        self.count += 1;
        self.sum += x;
        self.squares += x * x;
    }

    fn over(&self, n: u32) -> Integral {
        let n = f64::from(n);
        let value = self.sum / n;
        Integral { value, error: ((self.squares / n - value * value).max(0.0) / n).sqrt() }
    }
}
