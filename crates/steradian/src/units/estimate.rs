//! A number and how well it is known.

use std::fmt;

/// A number with the half-width of its confidence interval.
///
/// The interval is statistical only: it says how far chance may have moved the number, nothing about the model. Its level,
/// 95 % unless another was asked for, is stated beside the numbers that share it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Half the width of its interval; 0 for closed forms.
    pub half_width: f64,
}

impl Estimate {
    /// A number that chance has no part in.
    pub const fn exact(value: f64) -> Self {
        Self { value, half_width: 0.0 }
    }

    /// Times a number that is known exactly.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, half_width: self.half_width * factor.abs() }
    }

    /// The sum with an estimate that was made from other samples: variances add.
    #[must_use]
    pub fn plus_independent(self, other: Self) -> Self {
        Self { value: self.value + other.value, half_width: self.half_width.hypot(other.half_width) }
    }

    /// The ratio to an estimate that was made from other samples, to first order in both relative widths.
    #[must_use]
    pub fn over_independent(self, other: Self) -> Self {
        let value = self.value / other.value;
        let half_width = (self.half_width / other.value).hypot(value * other.half_width / other.value);
        Self { value, half_width }
    }

    /// Half-width over the absolute value; infinite at zero, unless exact.
    pub fn relative(self) -> f64 {
        if self.half_width == 0.0 { 0.0 } else { self.half_width / self.value.abs() }
    }

    /// Whether the interval holds `truth`.
    pub fn holds(self, truth: f64) -> bool {
        (self.value - truth).abs() <= self.half_width
    }
}

/// `3.142 ± 0.004`: the width with one significant digit (two where it begins with 1), the value to the same place.
/// An exact number has its shortest decimal form with at most seven digits and no `±`.
impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, half_width } = *self;
        if half_width == 0.0 || !half_width.is_finite() || !value.is_finite() {
            write!(f, "{}", plain(value))?;
            return if half_width == 0.0 { Ok(()) } else { write!(f, " ± {half_width}") };
        }
        // Rounding may carry into the next decade (0.0096 → 0.010), where the width begins with 1.
        let text = format!("{half_width:.0e}");
        let exponent = |s: &str| s.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
        let begins_with_one = text.starts_with('1') || format!("{half_width:e}").starts_with('1');
        let last = exponent(&text) - i32::from(begins_with_one);
        let leading = exponent(&format!("{value:e}")).max(exponent(&text));
        if (-4..=0).contains(&last) || (last > 0 && leading < 6) {
            let places = (-last).max(0) as usize;
            let round = |x: f64| if last > 0 { (x / 10f64.powi(last)).round() * 10f64.powi(last) } else { x };
            return write!(f, "{:.places$} ± {:.places$}", round(value), round(half_width));
        }
        let power = 10f64.powi(leading);
        let places = (leading - last).max(0) as usize;
        write!(f, "({:.places$} ± {:.places$})e{leading}", value / power, half_width / power)
    }
}

/// At most seven significant digits, without trailing zeros.
fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size == 0.0 || (1e-4..1e7).contains(&size) || !size.is_finite() {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(value: f64, half_width: f64) -> String {
        Estimate { value, half_width }.to_string()
    }

    #[test]
    fn the_width_decides_the_digits() {
        assert_eq!(shown(3.141_59, 0.004_4), "3.142 ± 0.004");
        assert_eq!(shown(3.141_59, 0.012_4), "3.142 ± 0.012");
        assert_eq!(shown(3.141_59, 0.009_7), "3.142 ± 0.010");
        assert_eq!(shown(437.62, 23.0), "440 ± 20");
        assert_eq!(shown(437.62, 15.0), "438 ± 15");
        assert_eq!(shown(3.141_59, 0.019_9), "3.142 ± 0.020");
        assert_eq!(shown(437.62, 2.7), "438 ± 3");
        assert_eq!(shown(-0.25, 0.5), "-0.2 ± 0.5");
        assert_eq!(shown(0.0, 0.003), "0.000 ± 0.003");
        assert_eq!(shown(1.234_56e-7, 3e-10), "(1.235 ± 0.003)e-7");
        assert_eq!(shown(1.234_56e9, 3e6), "(1.235 ± 0.003)e9");
        assert_eq!(shown(0.1 + 0.2, 0.0), "0.3");
        assert_eq!(shown(6.02e23, 0.0), "6.02e23");
        assert_eq!(shown(1.0, f64::INFINITY), "1 ± inf");
    }

    #[test]
    fn widths_of_independent_estimates_add_in_squares() {
        let (a, b) = (Estimate { value: 10.0, half_width: 0.3 }, Estimate { value: 5.0, half_width: 0.4 });
        assert!((a.plus_independent(b).half_width - 0.5).abs() < 1e-12);
        // Relative widths 3 % and 8 %.
        let ratio = a.over_independent(b);
        assert!((ratio.value - 2.0).abs() < 1e-12 && (ratio.relative() - 0.0073f64.sqrt()).abs() < 1e-12);
        assert!(a.holds(9.71) && !a.holds(10.31) && a.scaled(-2.0).holds(-20.0));
    }
}
