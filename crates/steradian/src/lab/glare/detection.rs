//! Which parts of a picture are sources of glare.

use super::picture::{LuminancePicture, Pixel};
use super::position::position_index;

/// From which luminance a pixel belongs to a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threshold {
    /// A luminance [cd/m²].
    Luminance(f64),
    /// That many times the mean luminance of the picture.
    TimesMean(f64),
}

/// What counts as a source of glare: pixels above the threshold, those that touch (eight neighbours) as one source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareRule {
    /// Threshold.
    pub threshold: Threshold,
}

impl Default for GlareRule {
    /// 2000 cd/m², evalglare's default.
    fn default() -> Self {
        Self { threshold: Threshold::Luminance(2000.0) }
    }
}

impl GlareRule {
    /// The threshold in a picture [cd/m²].
    pub fn luminance(&self, picture: &LuminancePicture) -> f64 {
        match self.threshold {
            Threshold::Luminance(l) => l,
            Threshold::TimesMean(factor) => factor * picture.mean(),
        }
    }

    /// The rule in words.
    pub fn describe(&self) -> String {
        let from = match self.threshold {
            Threshold::Luminance(l) => format!("{l} cd·m⁻²"),
            Threshold::TimesMean(f) => format!("{f} times the mean luminance of the half space"),
        };
        format!("pixels above {from}; those that touch, also at a corner, are one source")
    }
}

/// A source of glare.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GlareSource {
    /// Mean luminance over its solid angle [cd/m²].
    pub luminance: f64,
    /// Largest luminance of its pixels [cd/m²].
    pub peak: f64,
    /// Solid angle [sr].
    pub solid_angle: f64,
    /// Illuminance that it makes on the plane of the picture [lx].
    pub illuminance: f64,
    /// Where its light comes from, on average: right, up, ahead.
    pub direction: [f64; 3],
    /// Position index there [1].
    pub position_index: f64,
    /// Number of its pixels.
    pub pixels: usize,
}

/// The sources of a picture, the one that weighs most (L² ω/p²) first.
pub fn find(picture: &LuminancePicture, rule: &GlareRule) -> Vec<GlareSource> {
    let threshold = rule.luminance(picture);
    let side = picture.fisheye.side() as usize;
    let mut bright: Vec<Option<Pixel>> = vec![None; side * side];
    for p in picture.pixels().filter(|p| p.luminance > threshold) {
        bright[p.index] = Some(p);
    }
    let mut sources = Vec::new();
    let mut open = Vec::new();
    for start in 0..bright.len() {
        let Some(first) = bright[start].take() else { continue };
        let mut sums = Sums::default();
        open.push(first);
        while let Some(pixel) = open.pop() {
            sums.add(&pixel);
            let (x, y) = (pixel.index % side, pixel.index / side);
            for row in y.saturating_sub(1)..(y + 2).min(side) {
                for column in x.saturating_sub(1)..(x + 2).min(side) {
                    open.extend(bright[row * side + column].take());
                }
            }
        }
        sources.push(sums.source());
    }
    let weight = |s: &GlareSource| s.luminance.powi(2) * s.solid_angle / s.position_index.powi(2);
    sources.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    sources
}

#[derive(Default)]
struct Sums {
    solid_angle: f64,
    light: f64,
    illuminance: f64,
    direction: [f64; 3],
    peak: f64,
    pixels: usize,
}

impl Sums {
    fn add(&mut self, p: &Pixel) {
        let light = p.luminance * p.solid_angle;
        self.solid_angle += p.solid_angle;
        self.light += light;
        self.illuminance += light * p.direction[2];
        for (sum, d) in self.direction.iter_mut().zip(p.direction) {
            *sum += light * d;
        }
        self.peak = self.peak.max(p.luminance);
        self.pixels += 1;
    }

    fn source(&self) -> GlareSource {
        let [x, y, z] = self.direction;
        let length = x.hypot(y).hypot(z).max(f64::MIN_POSITIVE);
        let direction = [x / length, y / length, z / length];
        GlareSource {
            luminance: self.light / self.solid_angle,
            peak: self.peak,
            solid_angle: self.solid_angle,
            illuminance: self.illuminance,
            direction,
            position_index: position_index(direction),
            pixels: self.pixels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::picture::Fisheye;
    use super::*;

    /// Disks of angular radius [rad] around directions, in darkness of 10 cd/m².
    fn disks(side: u32, disks: &[([f64; 3], f64, f64)]) -> LuminancePicture {
        let fisheye = Fisheye::new(side);
        let luminance = |d: [f64; 3]| {
            let inside = disks
                .iter()
                .find(|(c, radius, _)| c.iter().zip(d).map(|(a, b)| a * b).sum::<f64>() > radius.cos());
            inside.map_or(10.0, |d| d.2)
        };
        let luminance = (0..(side * side) as usize)
            .map(|i| fisheye.middle(i).map_or(1e9, |d| luminance(d) as f32))
            .collect();
        LuminancePicture { fisheye, luminance }
    }

    fn at(right: f64, up: f64) -> [f64; 3] {
        let length = (1.0 + right * right + up * up).sqrt();
        [right / length, up / length, 1.0 / length]
    }

    #[test]
    fn disks_are_found_with_their_solid_angle_place_and_luminance() {
        let picture = disks(600, &[(at(0.5, 0.5), 0.06, 5000.0), (at(-0.4, -0.3), 0.1, 3000.0)]);
        let sources = find(&picture, &GlareRule::default());
        assert_eq!(sources.len(), 2);
        for (expected, radius, luminance) in [(at(0.5, 0.5), 0.06_f64, 5000.0), (at(-0.4, -0.3), 0.1, 3000.0)]
        {
            let s = sources.iter().find(|s| (s.luminance - luminance).abs() < 1e-6).unwrap();
            let omega = 2.0 * std::f64::consts::PI * (1.0 - radius.cos());
            assert!((s.solid_angle / omega - 1.0).abs() < 0.02, "{s:?}");
            assert!(s.direction.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{s:?}");
            assert!((s.position_index - position_index(expected)).abs() < 0.02, "{s:?}");
            assert!((s.illuminance / (luminance * omega * expected[2]) - 1.0).abs() < 0.02, "{s:?}");
        }
    }

    #[test]
    fn touching_pixels_are_one_source_and_the_rim_does_not_count() {
        let fisheye = Fisheye::new(9);
        let mut luminance = vec![1.0; 81];
        // A diagonal pair, a pixel apart from it, and a corner outside of the circle.
        for (x, y) in [(3, 3), (4, 4), (6, 4), (0, 0)] {
            luminance[y * 9 + x] = 1e4;
        }
        let picture = LuminancePicture { fisheye, luminance };
        let mut counts: Vec<_> = find(&picture, &GlareRule::default()).iter().map(|s| s.pixels).collect();
        counts.sort_unstable();
        assert_eq!(counts, [1, 2]);
    }

    #[test]
    fn a_relative_threshold_follows_the_mean() {
        let picture = disks(200, &[(at(0.0, 0.2), 0.1, 100.0)]);
        let rule = GlareRule { threshold: Threshold::TimesMean(5.0) };
        assert!((rule.luminance(&picture) / picture.mean() - 5.0).abs() < 1e-12);
        assert_eq!(find(&picture, &rule).len(), 1);
        assert!(find(&picture, &GlareRule::default()).is_empty());
        assert!(rule.describe().contains("5 times the mean"));
    }
}
