//! Daylight factors, and what EN 17037 asks of them.

use crate::lab::{Block, Moments, Session, Tally};
use crate::light::Light;
use crate::math::warp::cosine_hemisphere;
use crate::math::{Dir, Frame};
use crate::scene::RenderJob;
use crate::spectrum::{LANES, Wavelengths, cie};
use crate::units::{Estimate, Illuminance, LUMENS_PER_WATT};
use glam::DVec3;
use std::f64::consts::PI;

/// Whether all light of the scene comes from skies, for which daylight factors are defined: no lamps, no sun.
pub fn is_lit_by_skies(job: &RenderJob) -> bool {
    let lights = job.scene.lights();
    let sky = |l: &Light| l.is_infinite() && !l.is_delta() && !l.kind().contains("sun");
    !lights.is_empty() && lights.iter().all(sky)
}

/// Whether a direction (in the scene's world) is that of the zenith, within a degree: daylight factors are ratios to the
/// unobstructed *horizontal* plane (CIE S 017, EN 17037). Skies without a zenith of their own leave the choice to the scene.
pub fn faces_zenith(job: &RenderJob, up: [f64; 3]) -> bool {
    let Some(up) = DVec3::from(up).try_normalize() else { return false };
    let Some(up) = Dir::new(job.world_from_render.inverse().vector(up.as_vec3())) else { return false };
    let cos = 1.0_f32.to_radians().cos();
    job.scene.lights().iter().filter_map(Light::zenith).all(|zenith| zenith.dot(*up) >= cos)
}

/// Samples of a block.
const BLOCK: u32 = 256;

#[derive(Clone, Default)]
struct Sum(Moments, u64);

impl Tally for Sum {
    fn merge(&mut self, later: &Self) {
        self.0.merge(&later.0);
        self.1 += later.1;
    }

    fn rays(&self) -> u64 {
        self.1
    }
}

/// Illuminance by the skies of a plane that faces `up` (in the scene's world), with nothing in between; ten times as precise as
/// the session asks, since all points share it. `None` when up has no direction.
pub fn outdoors(job: &RenderJob, up: [f64; 3], session: &Session<'_>) -> Option<Illuminance> {
    let up = DVec3::from(up).try_normalize()?.as_vec3();
    let normal = Dir::new(job.world_from_render.inverse().vector(up))?;
    let frame = Frame::from_z(*normal);
    let skies: Vec<_> = job.scene.infinite_lights().collect();
    let luminance = |direction: Dir, w: &Wavelengths| {
        let mut sum = 0.0;
        for light in &skies {
            let l = job.scene.escaped(*light, direction, w);
            for lane in 0..LANES {
                let weight = f64::from(cie::y_bar(w.lambda()[lane])) / f64::from(w.pdf()[lane]);
                sum += weight * f64::from(l[lane]) / LANES as f64;
            }
        }
        sum * f64::from(LUMENS_PER_WATT)
    };
    let block = |sum: &mut Sum, block: Block| {
        let mut sampler = block.sampler(BLOCK);
        let mut total = 0.0;
        for index in 0..BLOCK {
            sampler.start([0, 0], index);
            let w = Wavelengths::sample_visible(sampler.next_1d());
            // cosθ over its density cosθ/π.
            total += PI * luminance(frame.to_world(cosine_hemisphere(sampler.next_2d())), &w);
        }
        sum.0.add(total / f64::from(BLOCK));
        sum.1 += u64::from(BLOCK);
    };
    let mut precision = session.precision;
    precision.relative *= 0.1;
    precision.absolute *= 0.1;
    let finer = Session { precision, ..*session };
    // A stream that no point of a grid has.
    let outcome = finer.run(u64::MAX, Sum::default, block, |s| precision.demand(s.0.estimate(&precision)));
    Some(Illuminance::new(outcome.tally.0.estimate(&precision)))
}

/// Daylight factors of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct DaylightFactors {
    /// E_in/E_out of each point [1].
    pub factors: Vec<Estimate>,
    /// Mean [1].
    pub mean: Estimate,
    /// What half of the points reach or exceed [1].
    pub median: f64,
    /// What 95 % of the points reach or exceed [1].
    pub nearly_all: f64,
}

/// `None` without readings or without light outdoors.
pub fn daylight_factors(readings: &[Estimate], outdoors: Illuminance) -> Option<DaylightFactors> {
    let outside = outdoors.estimate();
    if readings.is_empty() || !(outside.value > 0.0) {
        return None;
    }
    let factors: Vec<Estimate> = readings.iter().map(|e| e.over_independent(outside)).collect();
    let n = readings.len() as f64;
    let sum = readings.iter().copied().reduce(Estimate::plus_independent)?;
    let mut values: Vec<f64> = factors.iter().map(|f| f.value).collect();
    values.sort_by(|a, b| b.total_cmp(a));
    let reached = |share: f64| values[((share * n).ceil() as usize).clamp(1, values.len()) - 1];
    Some(DaylightFactors {
        mean: sum.scaled(1.0 / n).over_independent(outside),
        median: reached(0.5),
        nearly_all: reached(0.95),
        factors,
    })
}

/// A level of EN 17037:2018, table A.1: the target illuminance that half of the plane shall have, and the least one that 95 %
/// shall have, for half of the daylight hours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DaylightLevel {
    /// Its name.
    pub name: &'static str,
    /// Target illuminance [lx].
    pub target: f64,
    /// Minimum target illuminance [lx].
    pub least: f64,
}

/// The levels of recommendation.
pub const DAYLIGHT_LEVELS: [DaylightLevel; 3] = [
    DaylightLevel { name: "minimum", target: 300.0, least: 100.0 },
    DaylightLevel { name: "medium", target: 500.0, least: 300.0 },
    DaylightLevel { name: "high", target: 750.0, least: 500.0 },
];

impl DaylightFactors {
    /// The median diffuse horizontal illuminance outdoors [lx] that a place must have for this level to be met, by method 1 of
    /// EN 17037 (B.2): D ≥ E_target/E_v,d,med for both targets.
    pub fn outdoors_for(&self, level: &DaylightLevel) -> f64 {
        (level.target / self.median).max(level.least / self.nearly_all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_and_levels_follow_from_the_readings() {
        // Ten points from 1 % to 10 % under 10 klx.
        let readings: Vec<_> = (1..=10).map(|i| Estimate::exact(100.0 * f64::from(i))).collect();
        let d = daylight_factors(&readings, Illuminance::exact(10_000.0)).unwrap();
        assert!((d.mean.value - 0.055).abs() < 1e-12);
        assert!((d.median - 0.06).abs() < 1e-12 && (d.nearly_all - 0.01).abs() < 1e-12);
        // 300 lx of 6 % need 5000 lx outdoors, 100 lx of 1 % need 10000 lx.
        assert!((d.outdoors_for(&DAYLIGHT_LEVELS[0]) - 10_000.0).abs() < 1e-6);
        assert!(daylight_factors(&readings, Illuminance::exact(0.0)).is_none());
    }
}
