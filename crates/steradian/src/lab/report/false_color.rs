//! Luminances as colours, with their scale.

use crate::color::transfer::srgb_encode;
use crate::image::heat_color;
use crate::lab::glare::LuminancePicture;
use crate::lab::plot::{Anchor, Drawing, Ink, Stroke};

/// A logarithmic scale of luminances [cd/m²], from black over violet and orange to nearly white: brighter is more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuminanceScale {
    /// What is black.
    pub low: f64,
    /// What is white, above `low`.
    pub high: f64,
}

/// Most decades of a scale: below a thousandth of the brightest part nothing counts for the eye.
const DECADES: f64 = 4.0;

impl LuminanceScale {
    /// A scale for a picture: from its thousandth part that is darkest to its brightest pixel, in whole thirds of decades, over
    /// four decades at most. `None` for a black picture.
    pub fn of(picture: &LuminancePicture) -> Option<Self> {
        let mut values: Vec<f64> = picture.pixels().map(|p| p.luminance).filter(|l| *l > 0.0).collect();
        values.sort_by(f64::total_cmp);
        let (last, dark) = (*values.last()?, values[values.len() / 1000]);
        let third = |x: f64, round: fn(f64) -> f64| 10_f64.powf(round(3.0 * x.log10()) / 3.0);
        let high = third(last, f64::ceil);
        let low = third(dark, f64::floor).max(high / 10_f64.powf(DECADES));
        Some(Self { low: low.min(high / 10.0), high })
    }

    /// The place of a luminance on the scale, in [0, 1].
    pub fn fraction(&self, luminance: f64) -> f64 {
        if luminance > 0.0 {
            ((luminance / self.low).ln() / (self.high / self.low).ln()).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// Linear sRGB of a luminance.
    pub fn color(&self, luminance: f64) -> [f32; 3] {
        heat_color(self.fraction(luminance) as f32)
    }

    /// Values to be marked: 1, 2 and 5 times powers of ten, or powers of ten alone on a long scale.
    fn marks(&self) -> Vec<f64> {
        let leads: &[f64] = if self.high / self.low > 2e3 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let all = (first..=last).flat_map(|e| leads.iter().map(move |l| l * 10_f64.powi(e)));
        all.filter(|v| (self.low * 0.999..=self.high * 1.001).contains(v)).collect()
    }

    /// The scale as a drawing of that height [px], at least 120.
    pub fn legend(&self, height: f64) -> Drawing {
        let height = height.max(120.0);
        let mut d = Drawing::new(128.0, height);
        let (left, width, top, bottom) = (14.0, 22.0, 40.0, height - 16.0);
        d.text([left, 18.0], "L [cd·m⁻²]", 12.0, Anchor::Start, Ink::BLACK);
        let y = |fraction: f64| bottom - fraction * (bottom - top);
        let steps = 128;
        for i in 0..steps {
            let at = |k: u32| f64::from(k) / f64::from(steps);
            let rgb = heat_color((0.5 * (at(i) + at(i + 1))) as f32);
            let [r, g, b] = rgb.map(|c| (srgb_encode(c.clamp(0.0, 1.0)) * 255.0).round() as u8);
            // A little overlap hides the seams of antialiasing.
            let (lower, upper) = (y(at(i)), (y(at(i + 1)) - 0.6).max(top));
            let corners = vec![[left, lower], [left + width, lower], [left + width, upper], [left, upper]];
            d.area(corners, Ink::new(r, g, b), 1.0);
        }
        for mark in self.marks() {
            let place = y(self.fraction(mark));
            d.line(vec![[left + width, place], [left + width + 5.0, place]], Stroke::solid(Ink::BLACK, 1.0));
            let at = [left + width + 9.0, place + 4.0];
            d.text(at, written(mark), 11.0, Anchor::Start, Ink::BLACK);
        }
        let outline =
            vec![[left, top], [left + width, top], [left + width, bottom], [left, bottom], [left, top]];
        d.line(outline, Stroke::solid(Ink::BLACK, 1.0));
        d
    }
}

fn written(v: f64) -> String {
    if (0.01..1e6).contains(&v) {
        let text = format!("{v:.2}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{v:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::glare::Fisheye;

    #[test]
    fn the_scale_covers_the_picture_and_rises() {
        let fisheye = Fisheye::new(20);
        let luminance = (0..400).map(|i| 3.0 + i as f32).collect();
        let scale = LuminanceScale::of(&LuminancePicture { fisheye, luminance }).unwrap();
        assert!(scale.low <= 13.0 && scale.high >= 400.0 && scale.high < 1000.0, "{scale:?}");
        let f: Vec<f64> = [5.0, 50.0, 400.0].iter().map(|l| scale.fraction(*l)).collect();
        assert!(f[0] < f[1] && f[1] < f[2] && f[2] <= 1.0, "{f:?}");
        assert_eq!((scale.fraction(0.0), scale.fraction(1e9)), (0.0, 1.0));
        assert!(scale.marks().contains(&100.0), "{:?}", scale.marks());
        assert_eq!(LuminanceScale::of(&LuminancePicture { fisheye, luminance: vec![0.0; 400] }), None);
    }
}
