//! What a fisheye picture says about glare, with intervals.

use super::detection::{GlareRule, GlareSource, find};
use super::index::{dgp, dgp_in_low_light, ugr};
use super::photograph::Photograph;
use super::picture::LuminancePicture;
use crate::lab::Precision;
use crate::units::{Estimate, Illuminance, Luminance};

/// Readings of a picture.
#[derive(Clone, Debug)]
pub struct GlareReading {
    /// Vertical illuminance at the eye.
    pub vertical_illuminance: Illuminance,
    /// Background luminance: what is left of that without the sources, over π.
    pub background: Luminance,
    /// Mean luminance of the half space.
    pub mean: Luminance,
    /// Threshold of the sources [cd/m²].
    pub threshold: f64,
    /// Unified Glare Rating; `None` without sources.
    pub ugr: Option<Estimate>,
    /// Daylight Glare Probability; `None` in the dark.
    pub dgp: Option<Estimate>,
    /// The same with evalglare's correction below 1000 lx.
    pub dgp_low_light: Option<Estimate>,
    /// The sources, the most disturbing first.
    pub sources: Vec<GlareSource>,
}

/// Numbers of one picture; NaN where there is none.
fn numbers(picture: &LuminancePicture, rule: &GlareRule) -> ([f64; 6], Vec<GlareSource>) {
    let sources = find(picture, rule);
    let vertical = picture.vertical_illuminance();
    let direct: f64 = sources.iter().map(|s| s.illuminance).sum();
    let background = (vertical - direct).max(0.0) / std::f64::consts::PI;
    let probability = dgp(&sources, vertical);
    let numbers = [
        vertical,
        background,
        picture.mean(),
        ugr(&sources, background).unwrap_or(f64::NAN),
        probability.unwrap_or(f64::NAN),
        probability.map_or(f64::NAN, |p| dgp_in_low_light(p, vertical)),
    ];
    (numbers, sources)
}

/// Reads a photograph. Intervals at the level of `precision` by the jackknife (Tukey 1958): the spread of the readings
/// with one exposure left out, Student's t for the number of exposures.
pub fn read(photograph: &Photograph, rule: &GlareRule, precision: &Precision) -> GlareReading {
    let all = photograph.without(None);
    let (value, sources) = numbers(&all, rule);
    let n = photograph.exposures.len();
    let partial: Vec<[f64; 6]> = (0..n).map(|k| numbers(&photograph.without(Some(k)), rule).0).collect();
    let estimate = |i: usize| {
        let mean = partial.iter().map(|p| p[i]).sum::<f64>() / n as f64;
        let squares: f64 = partial.iter().map(|p| (p[i] - mean).powi(2)).sum();
        let error = (squares * (n as f64 - 1.0) / n as f64).sqrt();
        let half_width = precision.half_width(error, n as u64 - 1);
        // An index that only some of the partial pictures have is not known.
        let half_width = if half_width.is_nan() { f64::INFINITY } else { half_width };
        Estimate { value: value[i], half_width }
    };
    let some = |i: usize| (!value[i].is_nan()).then(|| estimate(i));
    GlareReading {
        vertical_illuminance: Illuminance::new(estimate(0)),
        background: Luminance::new(estimate(1)),
        mean: Luminance::new(estimate(2)),
        threshold: rule.luminance(&all),
        ugr: some(3),
        dgp: some(4),
        dgp_low_light: some(5),
        sources,
    }
}

#[cfg(test)]
mod tests {
    use super::super::eye::{Eye, Handedness};
    use super::super::photograph::EXPOSURES;
    use super::super::picture::Fisheye;
    use super::*;
    use crate::color::Xyz;
    use std::f64::consts::PI;

    /// A photograph of which exposure k has luminance `levels[k]` everywhere but in one bright spot.
    fn photograph(levels: [f32; EXPOSURES], spot: f32) -> Photograph {
        let fisheye = Fisheye::new(40);
        let luminance = |level: f32| {
            let mut picture = vec![level; 1600];
            picture[15 * 40 + 20] = spot;
            LuminancePicture { fisheye, luminance: picture }
        };
        Photograph {
            eye: Eye::new([0.0; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], Handedness::Left).unwrap(),
            fisheye,
            color: vec![Xyz::default(); 1600],
            exposures: levels.map(luminance).to_vec(),
            samples: 8,
            rays: 0,
            dropped: 0,
        }
    }

    #[test]
    fn intervals_of_sums_are_those_of_students_t() {
        // Levels 1 to 8: variance 6, standard error of the mean √(6/8); t₇(0.975) = 2.364624.
        let p = photograph([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], 4.5);
        let r = read(&p, &GlareRule::default(), &Precision::default());
        let e = r.vertical_illuminance.estimate();
        assert!((e.value - 4.5 * PI).abs() < 0.01 * PI, "{e}");
        let expected = 2.364_624 * PI * (6.0_f64 / 8.0).sqrt();
        assert!((e.half_width / expected - 1.0).abs() < 0.01, "{e} {expected}");
        assert!(r.ugr.is_none() && r.sources.is_empty() && r.dgp.is_some());
    }

    #[test]
    fn the_background_is_what_the_sources_leave() {
        let p = photograph([10.0; EXPOSURES], 50_000.0);
        let r = read(&p, &GlareRule::default(), &Precision::default());
        assert!((r.background.value() - 10.0).abs() < 0.1, "{:?}", r.background);
        let [source] = r.sources.as_slice() else { panic!("{:?}", r.sources) };
        let expected = 8.0
            * (0.25 / r.background.value() * 50_000_f64.powi(2) * source.solid_angle
                / source.position_index.powi(2))
            .log10();
        assert!((r.ugr.unwrap().value - expected).abs() < 1e-9 && r.ugr.unwrap().half_width == 0.0);
    }
}
