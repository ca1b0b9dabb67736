//! Tristimulus values and the diagrams that are made of them.

use crate::spectrum::cie;

/// CIE 1931 tristimulus values; the unit is that of the sum that they were made from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tristimulus {
    /// X.
    pub x: f64,
    /// Y: a luminance, an illuminance, or a luminous reflectance.
    pub y: f64,
    /// Z.
    pub z: f64,
}

/// A point of the CIE 1931 chromaticity diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Xy {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
}

/// A point of the CIE 1960 uniform chromaticity scale diagram, obsolete but for colour temperatures and CIE 13.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uv1960 {
    /// u.
    pub u: f64,
    /// v.
    pub v: f64,
}

/// A point of the CIE 1976 uniform chromaticity scale diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uv1976 {
    /// u′.
    pub u: f64,
    /// v′.
    pub v: f64,
}

/// Coordinates of the CIE 1976 L*a*b* space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    /// L*, 0 for black, 100 for the white.
    pub l: f64,
    /// a*, from green to red.
    pub a: f64,
    /// b*, from blue to yellow.
    pub b: f64,
}

impl Tristimulus {
    /// From X, Y, Z.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    /// Σ s x̄, Σ s ȳ, Σ s z̄ over every nanometre from 360 to 830, CIE 15:2018 (7.1); `spectrum` is asked by index,
    /// 0 for 360 nm.
    pub fn of(spectrum: impl Fn(usize) -> f64) -> Self {
        let mut sum = [0.0; 3];
        for (i, bars) in cie::table().iter().enumerate() {
            let s = spectrum(i);
            for (sum, bar) in sum.iter_mut().zip(bars) {
                *sum += s * f64::from(*bar);
            }
        }
        Self::new(sum[0], sum[1], sum[2])
    }

    /// Times a number.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }

    /// x and y, CIE 15:2018 (7.5); `None` where X + Y + Z is not above 0.
    pub fn xy(self) -> Option<Xy> {
        let sum = self.x + self.y + self.z;
        (sum > 0.0).then(|| Xy { x: self.x / sum, y: self.y / sum })
    }

    /// u and v of 1960; `None` where X + 15 Y + 3 Z is not above 0.
    pub fn uv1960(self) -> Option<Uv1960> {
        let sum = self.x + 15.0 * self.y + 3.0 * self.z;
        (sum > 0.0).then(|| Uv1960 { u: 4.0 * self.x / sum, v: 6.0 * self.y / sum })
    }

    /// u′ and v′, CIE 15:2018 (8.1); `None` where X + 15 Y + 3 Z is not above 0.
    pub fn uv1976(self) -> Option<Uv1976> {
        self.uv1960().map(|p| Uv1976 { u: p.u, v: 1.5 * p.v })
    }

    /// L*, a*, b* under a white, CIE 15:2018 (8.3)–(8.11); `None` for a white that is not above 0 in each of its values.
    pub fn lab(self, white: Self) -> Option<Lab> {
        if !(white.x > 0.0 && white.y > 0.0 && white.z > 0.0) {
            return None;
        }
        let f = |t: f64| {
            let edge: f64 = 24.0 / 116.0;
            if t > edge.powi(3) { t.cbrt() } else { 841.0 / 108.0 * t + 16.0 / 116.0 }
        };
        let (x, y, z) = (f(self.x / white.x), f(self.y / white.y), f(self.z / white.z));
        Some(Lab { l: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equal_energy_spectrum_is_in_the_middle() {
        let e = Tristimulus::of(|_| 1.0);
        let (xy, uv) = (e.xy().unwrap(), e.uv1976().unwrap());
        assert!((xy.x - 1.0 / 3.0).abs() < 5e-5 && (xy.y - 1.0 / 3.0).abs() < 5e-5);
        // u′ = 4x/(−2x + 12y + 3), v′ = 9y/(−2x + 12y + 3).
        let d = -2.0 * xy.x + 12.0 * xy.y + 3.0;
        assert!((uv.u - 4.0 * xy.x / d).abs() < 1e-15 && (uv.v - 9.0 * xy.y / d).abs() < 1e-15);
    }

    #[test]
    fn black_has_no_chromaticity() {
        let black = Tristimulus::default();
        assert!(black.xy().is_none() && black.uv1960().is_none() && black.uv1976().is_none());
        assert!(Tristimulus::new(1.0, 1.0, 1.0).lab(black).is_none());
    }

    #[test]
    fn lab_knows_white_and_mid_grey() {
        let white = Tristimulus::new(95.047, 100.0, 108.883);
        let lab = |factor: f64| white.scaled(factor).lab(white).unwrap();
        assert!((lab(1.0).l - 100.0).abs() < 1e-12 && lab(0.3).a.abs() < 1e-12 && lab(0.3).b.abs() < 1e-12);
        // L* = 116·0.18^⅓ − 16, and 903.3 t below 0.008856.
        assert!((lab(0.18).l - 49.496).abs() < 1e-3 && (lab(0.004).l - 903.296_296 * 0.004).abs() < 1e-6);
    }
}
